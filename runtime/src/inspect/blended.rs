//! The picture as users get it: repeated and blended, by the library's node.

use super::field::Field;
use super::{Asked, InspectError};
use crate::cpu::Scene;
use crate::picture::Picture;
use crate::project::Project;
use crate::render::Request;
use crate::resource::exemplar::cumulative;
use crate::resource::{self, Tables};
use crate::settings::Settings;
use rayon::slice::ParallelSliceMut;
use std::collections::HashMap;
use texgraph_compiler::diagnostic::Place;
use texgraph_compiler::manifest::{Encoding, Recipe, Value};
use texgraph_compiler::{Failure, Library, Options, Program, compile};

/// The blends, in the order of the outputs: the picture itself first.
pub const BLENDS: usize = 4;

/// Pixels along a panel of the sheet.
pub const PANEL: u32 = 512;

/// Pictures across a panel, along their longer side.
const SHOWN: f64 = 2.5;

/// Texels along the longer side of what structure is looked for in: it is wider than a few of them.
const SIDE: u32 = 512;

/// Pixels along the square of samples of colours: 2¹⁸ are told apart to 0.004.
const SAMPLES: u32 = 512;

/// Pictures across the area that samples are of: a thousand hexagons of the usual size.
const SPREAD: f32 = 16.0;

/// Deviations on each side of a normal distribution that are told apart, and in how many steps.
const FAR: f64 = 5.0;
const TABLE: u32 = 4096;

/// With `spread` each pixel shows another place, with the footprint that it has: colours of a wide area
/// at the cost of a small one. The resources, and which CHANNELS are shown, depend on the picture.
const TEXTURE: &str = "
param tile: float = 0.5 in 0.0..=1.0
param spread: float = 0.0 in 0.0..=64.0

texture inspected(uv: vec2) -> (repeated: vec4, linear: vec4, variance: vec4, histogram: vec4) {
    let at    = uv + spread * hash(ifloor(uv * photo.pixels.size)).xy
    repeated  = photo.sample(at)
    linear    = example.stochastic(at, tile: tile, blend: linear).CHANNELS
    variance  = example.stochastic(at, tile: tile, blend: variance).CHANNELS
    histogram = example.stochastic(at, tile: tile).CHANNELS
}
";

/// The program over a picture.
pub struct Blended {
    program: Program,
    tables: Tables,
    /// Texels of the picture.
    pub size: [u32; 2],
    asked: Asked,
}

/// What is drawn of one of the blends.
pub struct Blend {
    /// For the sheet: so many pictures as fit.
    pub panel: Picture,
    /// Texels at places all over the plane.
    pub samples: Shown,
    /// Made smaller; of the picture itself once, of its blends twice as wide and high.
    pub view: Shown,
}

/// The numbers that were drawn: colours in linear light, data, or slopes.
pub struct Shown {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Row by row.
    pub numbers: Vec<[f32; 3]>,
}

impl Blended {
    /// Loads a picture, which is the project's main file.
    pub fn new(
        library: &Library,
        project: &Project,
        size: [u32; 2],
        asked: &Asked,
    ) -> Result<Blended, InspectError> {
        let program = program(library, asked).map_err(InspectError::Program)?;
        let mut program = named(program, project.main());
        let tables = resource::load(&mut program, project).map_err(|mut diagnostics| {
            // There is no text that they could point into.
            diagnostics.iter_mut().for_each(|diagnostic| diagnostic.place = Place::default());
            // Both resources are of one file.
            diagnostics.dedup();
            InspectError::Picture(diagnostics)
        })?;
        Ok(Blended { program, tables, size, asked: *asked })
    }

    /// Draws a blend; the first is the picture itself.
    pub fn draw(&self, blend: usize) -> Result<Blend, InspectError> {
        let mut scene = Scene::new(&self.program, &self.tables, blend)?;
        let mut drawn = |size, region, spread| scene.render(&self.request(size, region, spread), &|_| {});
        let [width, height] = self.size.map(f64::from);
        let panel = drawn([PANEL; 2], [width, height].map(|side| SHOWN * width.max(height) / side), 0.0)?;
        let texels = [width, height].map(|side| f64::from(SAMPLES) / side);
        let mut samples = drawn([SAMPLES; 2], texels, SPREAD)?;
        // What is nearly clear has no colour that is seen.
        samples.pixels.retain(|pixel| self.asked.encoding != Encoding::Srgb || pixel[3] >= 0.5);
        let pictures = if blend == 0 { 1 } else { 2 };
        let view = drawn(self.reduced().map(|side| pictures * side), [f64::from(pictures); 2], 0.0)?;
        Ok(Blend { panel, samples: self.shown(&samples), view: self.shown(&view) })
    }

    /// The picture's size, divided by a whole number that makes it small enough.
    fn reduced(&self) -> [u32; 2] {
        let by = self.size[0].max(self.size[1]).div_ceil(SIDE);
        self.size.map(|side| (side / by).max(1))
    }

    /// So many pictures across and down.
    fn request(&self, size: [u32; 2], [across, down]: [f64; 2], spread: f32) -> Request {
        let mut settings = Settings::new();
        for (name, value) in [("tile", self.asked.tile), ("spread", spread)] {
            // Both are params of the program above, and finite.
            let _ = settings.set(&self.program.manifest, name, Value::Float(vec![value]));
        }
        Request { settings, region: [0.0, 0.0, across, down], ..Request::new(size) }
    }

    fn shown(&self, picture: &Picture) -> Shown {
        let encoding = self.asked.encoding;
        let numbers = picture.pixels.iter().map(|pixel| numbers(encoding, *pixel)).collect();
        Shown { size: picture.size, numbers }
    }
}

impl Shown {
    /// The numbers along an axis, made Gaussian: what the method works on.
    pub fn along(&self, axis: &[f32; 3]) -> Field {
        let place = |[x, y, z]: &[f32; 3]| x * axis[0] + y * axis[1] + z * axis[2];
        let values: Vec<f32> = self.numbers.iter().map(place).collect();
        Field::new(self.size.map(|side| side as usize), scores(&values))
    }
}

/// The numbers of which the exemplar is made.
fn numbers(encoding: Encoding, [x, y, z, alpha]: [f32; 4]) -> [f32; 3] {
    match encoding {
        Encoding::Normal => [-x / z.max(0.05), -y / z.max(0.05), 0.0],
        Encoding::Linear => [x, y, z],
        Encoding::Srgb => [x, y, z].map(|light| if alpha > 0.0 { light / alpha } else { 0.0 }),
    }
}

/// Compiles the texture for one kind of picture.
fn program(library: &Library, asked: &Asked) -> Result<Program, Failure> {
    let word = match asked.encoding {
        Encoding::Srgb => "srgb",
        Encoding::Linear => "linear",
        Encoding::Normal => "normal",
    };
    let is_grey = asked.is_grey && asked.encoding != Encoding::Normal;
    // Of a grey picture red alone is blended.
    let (channels, shown) = if is_grey { (", channels: 1", "rrra") } else { ("", "rgba") };
    let texture = TEXTURE.replace("CHANNELS", shown);
    let text = format!(
        "let photo = image(\"\", encoding: {word})\nlet example = exemplar(\"\", encoding: {word}{channels})\n{texture}"
    );
    let files: HashMap<String, String> = [("inspect.tex".to_owned(), text)].into();
    let options = Options { exact_levels: true, ..Options::default() };
    Ok(compile(library, "inspect.tex", &files, &options)?.program)
}

/// The program over a file: a name may hold what a text would have to escape.
fn named(mut program: Program, file: &str) -> Program {
    for resource in &mut program.manifest.resources {
        if let Recipe::Image { path, .. } | Recipe::Exemplar { path, .. } = &mut resource.recipe {
            file.clone_into(path);
        }
    }
    program
}

/// Numbers of the same ranks with a normal distribution, mean 0 and deviation 1: the method's Gaussian
/// picture. Equal numbers get equal ones.
fn scores(values: &[f32]) -> Vec<f32> {
    let below: Vec<f64> =
        (0..=TABLE).map(|i| cumulative(-FAR + 2.0 * FAR * f64::from(i) / f64::from(TABLE))).collect();
    let score = |share: f64| {
        let next = below.partition_point(|below| *below < share).clamp(1, TABLE as usize);
        let within = (share - below[next - 1]) / (below[next] - below[next - 1]);
        (2.0 * FAR * (next as f64 - 1.0 + within.clamp(0.0, 1.0)) / f64::from(TABLE) - FAR) as f32
    };
    let value = |i: &u32| values[*i as usize];
    let mut order: Vec<u32> = (0..values.len() as u32).collect();
    order.par_sort_unstable_by(|i, j| value(i).total_cmp(&value(j)).then(i.cmp(j)));
    let mut scores = vec![0.0; values.len()];
    let mut before = 0;
    for run in order.chunk_by(|i, j| value(i) == value(j)) {
        let found = score((f64::from(before) + run.len() as f64 / 2.0) / values.len() as f64);
        run.iter().for_each(|i| scores[*i as usize] = found);
        before += run.len() as u32;
    }
    scores
}
