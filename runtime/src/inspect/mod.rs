//! Whether a picture suits tiling and blending by example (Deliot & Heitz, Procedural Stochastic
//! Textures by Tiling and Blending, GPU Zen 2, 2019), with the evidence.
//!
//! ```text
//!  picture ─blended─▶ repeated, linear, variance, histogram ─sheet─▶ to be looked at
//!     │                  ├─colors──▶ do the colours stay?
//!     │                  └─edges───▶ do its lines stay?
//!     ├─exemplar::steps─▶ does it wrap?
//!     └─field─▶ autocorrelation ─structure─▶ does it repeat? how wide are its features?
//!                       evenness ──────────▶ is its light even?        all of it ─verdict─▶ in words
//! ```
//!
//! The method is for stochastic pictures; "strong pattern-like organization" is what breaks (§1.7). The
//! blends are drawn by the library's own node on the CPU renderer, so what is measured is what users
//! get. Pictures of any size take about the same time, but for their exemplar.

mod autocorrelation;
mod blended;
mod colors;
mod field;
mod sheet;
mod structure;
mod verdict;

pub use autocorrelation::Autocorrelation;
pub use colors::Distances;
pub use field::Field;
pub use structure::{Peak, Structure};
pub use verdict::{Advice, Doubt, LEAST_EDGES, LEAST_SIDE, MOST_DISTANCE, MOST_UNEVEN, STRONG, Verdict};

use crate::picture::Picture;
use crate::project::Project;
use crate::render::RenderError;
use crate::resource::exemplar::{self, Wanted};
use crate::resource::{Decoded, decode};
use blended::Blended;
use std::path::Path;
use texgraph_compiler::diagnostic::{Diagnostic, Place};
use texgraph_compiler::manifest::{Borders, Compression, Encoding};
use texgraph_compiler::{Failure, Library};

/// Edges are looked for in what is blurred by one part in so many of the shorter side: there features
/// count and grains don't.
const EDGE: f64 = 64.0;

/// How a picture is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// How its numbers are read.
    pub encoding: Encoding,
    /// Whether it is a grey picture, of one channel.
    pub is_grey: bool,
    /// The height of a hexagon in pictures, above 0 to 1.
    pub tile: f32,
}

impl Default for Asked {
    fn default() -> Asked {
        Asked { encoding: Encoding::Srgb, is_grey: false, tile: 0.5 }
    }
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Report {
    /// Texels across and down.
    pub size: [u32; 2],
    /// The height of a hexagon, in texels along the picture's shorter side.
    pub tile: f64,
    /// How many times the mean step between neighbours the step across the borders is, across and down:
    /// more than [`exemplar::SEAM`] is seen. 1 where there is nothing to compare.
    pub steps: [f64; 2],
    /// How far the colours of each blend are from the picture's.
    pub colors: Distances,
    /// What repeats, and how wide features are.
    pub structure: Structure,
    /// The share of the variance that is between the means of the picture's sixteen parts, 0 to 1.
    pub unevenness: f64,
    /// How much of its edges the blend keeps: 1 for all.
    pub edges: f64,
    /// What follows.
    pub verdict: Verdict,
    /// Four panels: the picture repeated, and blended linearly, with its variance, with its histogram.
    pub sheet: Picture,
}

/// Why a picture can't be looked at.
#[derive(Debug)]
pub enum InspectError {
    /// It can't be read, or is no picture.
    Picture(Vec<Diagnostic>),
    /// The program that blends it is refused: a bug.
    Program(Failure),
    /// It can't be drawn.
    Render(RenderError),
}

impl From<RenderError> for InspectError {
    fn from(error: RenderError) -> InspectError {
        InspectError::Render(error)
    }
}

/// Looks at a picture file: PNG, JPEG, TGA, OpenEXR or HDR.
///
/// # Errors
/// It can't be read, is too large for a texture, or there is no memory to draw it.
pub fn inspect(library: &Library, path: &Path, asked: &Asked) -> Result<Report, InspectError> {
    let project = Project::new(path, true);
    let picture = decoded(&project).map_err(InspectError::Picture)?;
    let blended = Blended::new(library, &project, picture.size, asked)?;
    let wanted = wanted(asked);
    let axes = exemplar::axes(&picture, &wanted);
    let [across, down, _] = exemplar::steps(&picture, &wanted);
    let steps = [across, down].map(|[inside, across]| ratio(across, inside));
    drop(picture);
    let blends = [blended.draw(0)?, blended.draw(1)?, blended.draw(2)?, blended.draw(3)?];
    let [repeated, .., histogram] = &blends;
    // Normals have two axes of like weight; of colours the first carries nearly all.
    let shown = if asked.encoding == Encoding::Normal { 2 } else { 1 };
    let fields: Vec<[Field; 2]> =
        axes.iter().take(shown).map(|axis| [repeated.view.along(axis), histogram.view.along(axis)]).collect();
    let structure = Structure::of(fields.iter().map(|[whole, _]| whole), blended.size);
    let mean =
        |of: &dyn Fn(&[Field; 2]) -> f64| fields.iter().map(of).sum::<f64>() / fields.len().max(1) as f64;
    let mut report = Report {
        size: blended.size,
        tile: f64::from(asked.tile) * f64::from(blended.size[0].min(blended.size[1])),
        steps,
        colors: Distances::between(&blends, &axes),
        structure,
        unevenness: mean(&|[whole, _]| whole.unevenness()),
        edges: mean(&|[whole, wide]| {
            let deviation = (whole.side() as f64 / EDGE).max(1.0);
            ratio(wide.edges(deviation), whole.edges(deviation))
        }),
        verdict: Verdict::Suits,
        sheet: sheet::of(&blends, asked.encoding),
    };
    report.verdict = Verdict::of(&report);
    Ok(report)
}

fn decoded(project: &Project) -> Result<Decoded, Vec<Diagnostic>> {
    decode::open(project, project.main(), Place::default())?.decode()
}

/// The exemplar that is looked at.
fn wanted(asked: &Asked) -> Wanted {
    let channels = match (asked.encoding, asked.is_grey) {
        (Encoding::Normal, _) => 2,
        (_, true) => 1,
        (_, false) => 3,
    };
    Wanted {
        encoding: asked.encoding,
        channels,
        slices: 1,
        borders: Borders::Auto,
        lut: 256,
        compress: Compression::None,
    }
}

/// 1 where both are nothing.
fn ratio(one: f64, other: f64) -> f64 {
    if other > 0.0 {
        one / other
    } else if one > 0.0 {
        f64::INFINITY
    } else {
        1.0
    }
}
