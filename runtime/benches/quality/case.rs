//! What is drawn: a graph on a view at a zoom.

use crate::Outcome;
use std::path::Path;
use texgraph_compiler::manifest::Gradients;
use texgraph_compiler::{Library, Options, Plane, Program, compile, diagnostic::render};
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, load};

/// The graphs, by the names of their files in `graphs/` and in `benches/handwritten/`. Each has a texture
/// `t`, evaluated for several parts of a pixel, and one `once`, which is not.
pub const GRAPHS: [&str; 9] =
    ["tiles", "scattered", "nested", "indirection", "priority", "choice", "baked", "families", "mosaic"];

/// Pixels along the side of a cell, which has 128 texels: from 16 times magnified to 64 cells a pixel.
/// On the plane, at its lower edge. None divides a cell evenly.
pub const ZOOMS: [f64; 11] = [2048.3, 251.0, 67.3, 16.3, 8.1, 4.1, 2.03, 1.02, 0.49, 0.127, 1.0 / 64.3];

/// How a texture is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// From straight above.
    Flat,
    /// A ground in perspective, up to shortly below the horizon: there it is 16 times as far away.
    Plane,
}

impl View {
    /// Both.
    pub const ALL: [View; 2] = [View::Flat, View::Plane];

    /// In a word.
    pub fn name(self) -> &'static str {
        match self {
            View::Flat => "flat",
            View::Plane => "plane",
        }
    }
}

/// A view at a zoom.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// How it is looked at.
    pub view: View,
    /// Pixels a cell.
    pub pixels: f64,
}

impl Case {
    /// Sub-samples along the side of a pixel.
    pub fn samples(self) -> u32 {
        if self.is_far() { 64 } else { 16 }
    }

    /// Whether some pixels see two cells or more.
    pub fn is_far(self) -> bool {
        match self.view {
            View::Flat => self.pixels <= 0.5,
            View::Plane => self.pixels < 12.0,
        }
    }

    /// Pixels across and down: fewer where there are more samples in each.
    pub fn size(self) -> [u32; 2] {
        let side = if self.is_far() { 128 } else { 256 };
        match self.view {
            View::Flat => [side, side],
            View::Plane => [side, side * 45 / 64],
        }
    }

    /// The camera, for the compiler.
    pub fn plane(self) -> Option<Plane> {
        let repeat = (f64::from(self.size()[0]) / self.pixels) as f32;
        (self.view == View::Plane).then_some(Plane { repeat, aspect: 1.0 })
    }

    /// What fills the picture: not aligned to the cells, with a corner of some in it.
    pub fn request(self) -> Request {
        let [width, height] = self.size().map(f64::from);
        let region = match self.view {
            View::Flat => {
                let side = width / self.pixels;
                [-0.4037 * side, -0.3019 * side, 0.5963 * side, 0.6981 * side]
            }
            View::Plane => [0.0, 1.0 - height / width, 1.0, 1.0],
        };
        Request { region, ..Request::new(self.size()) }
    }
}

/// A compiled graph with its tables.
pub struct Loaded {
    /// Its shaders.
    pub program: Program,
    /// The bytes of its textures.
    pub tables: Tables,
}

/// Compiles a texture of a graph.
pub fn loaded(graph: &str, texture: &str, case: Case, gradients: Gradients) -> Outcome<Loaded> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("benches/quality/graphs/{graph}.tex"));
    let project = Project::new(&file, true);
    let texture = Some(texture.to_owned());
    let options = Options { texture, gradients, plane: case.plane(), ..Options::default() };
    let compiled = compile(&Library::standard()?, project.main(), &project, &options);
    let compiled = compiled.map_err(|f| render::human(&f.sources, &f.diagnostics))?;
    let mut program = compiled.program;
    let tables = load(&mut program, &project).map_err(|d| render::human(&compiled.sources, &d))?;
    Ok(Loaded { program, tables })
}
