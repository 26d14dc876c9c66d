//! No seam: the level of detail that is read does not change across the borders of cells, for every
//! graph of the quality bench, from above and in perspective, on the CPU and on the GPU.
//!
//! Each graph is evaluated once a pixel: `oversampled` takes the mean of four such evaluations.
//! Every picture gets levels of one colour each, so what a pixel shows is the level it read. The step
//! from a pixel to its neighbour in another cell is then no greater than the steps inside cells nearby,
//! or, where the view brings the cells closer, than that of the level which the continuous place asks
//! for: the logarithm of the footprint of `uv`.
//! GPU tests are shown as ignored where there is no adapter; `TEXGRAPH_GPU=required` makes that a
//! failure.

use libtest_mimic::{Arguments, Failed, Trial};
use std::path::Path;
use std::sync::Arc;
use texgraph_compiler::manifest::{Format, Table};
use texgraph_compiler::{Library, Options, Plane, Program, compile, diagnostic::render};
use texgraph_runtime::cpu;
use texgraph_runtime::gpu::{Gpu, Preference};
use texgraph_runtime::picture::Picture;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, load};

const GRAPHS: [&str; 10] = [
    "tiles",
    ANISOTROPIC,
    "scattered",
    "nested",
    "indirection",
    "priority",
    "choice",
    "baked",
    "families",
    "mosaic",
];
/// The tiles, filtered by up to eight taps.
const ANISOTROPIC: &str = "tiles_anisotropic";
const SIDE: u32 = 96;
/// Sides of one cell in pixels, on the plane along the lower edge.
const PIXELS_A_CELL: [f64; 10] = [512.0, 130.0, 47.3, 13.7, 8.0, 5.3, 3.1, 1.4, 0.77, 0.1];
/// A level is off by no more than this where it is the same.
const TOLERANCE: f32 = 1e-3;
/// How much steeper the logarithm of a GPU may be, which a software adapter makes of straight pieces.
const OWN_SLOPE: f32 = 1.4;
/// How far, in pixels, steps inside cells are looked for.
const NEARBY: usize = 4;
/// Greys of the levels: level l is l / 16, exact in 16 bits.
const LEVELS: f32 = 16.0;

/// A program and the bytes of its textures.
type Loaded = (Program, Tables);

fn main() {
    let arguments = Arguments::from_args();
    let required = std::env::var("TEXGRAPH_GPU").is_ok_and(|value| value == "required");
    let gpu = Gpu::new(Preference::Hardware).map(Arc::new);
    let mut trials = vec![Trial::test("a_seam_is_seen", a_seam_is_seen)];
    for (graph, view) in GRAPHS.into_iter().flat_map(|graph| [(graph, "flat"), (graph, "plane")]) {
        let is_plane = view == "plane";
        let run = move || the_level_has_no_seam(None, graph, is_plane);
        trials.push(Trial::test(format!("cpu::{graph}::{view}"), run));
        let gpu = gpu.clone();
        let ignored = gpu.is_err() && !required;
        let run = move || {
            let gpu = gpu.map_err(|error| error.to_string())?;
            the_level_has_no_seam(Some(&*gpu), graph, is_plane)
        };
        trials.push(Trial::test(format!("gpu::{graph}::{view}"), run).with_ignored_flag(ignored));
    }
    libtest_mimic::run(&arguments, trials).exit();
}

fn the_level_has_no_seam(gpu: Option<&Gpu>, graph: &str, is_plane: bool) -> Result<(), Failed> {
    has_no_seam(gpu, &source(graph)?, is_plane)
}

/// Cells that are sampled with gradients of their own.
fn a_seam_is_seen() -> Result<(), Failed> {
    let source =
        source("baked")?.replace("virtual_random(cell).xy)", "0.0, gradient: uv * (2 + cell.x % 2))");
    match has_no_seam(None, &source, false) {
        Ok(()) => Err("a seam of most of a level is not seen".into()),
        Err(_) => Ok(()),
    }
}

/// The text of a graph, with its pictures by their whole paths. Where cells differ in scale they
/// rightly differ in level, so they get one scale;
/// and a picture that fades in far away has levels of its own, so it is left out.
fn source(graph: &str) -> Result<String, Failed> {
    if graph == ANISOTROPIC {
        let round = source("tiles")?;
        let width = "max(min(length(dx(uv)), length(dy(uv))), footprint(uv) / 8.0)";
        return Ok(round
            .replace("ivec2(4, 4))", "ivec2(4, 4), anisotropy: 8)")
            .replace("footprint(uv)", width));
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let source = std::fs::read_to_string(root.join(format!("runtime/benches/quality/graphs/{graph}.tex")))?;
    Ok(source
        .replace("../../../../", &format!("{}/", root.display()))
        .replace("mix(0.2, 0.35, random.w)", "0.25")
        .replace(", anisotropy: 8", "")
        .replace("clamp(footprint(p) - 1.0, 0.0, 1.0)", "0.0"))
}

fn has_no_seam(gpu: Option<&Gpu>, source: &str, is_plane: bool) -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let slope = if gpu.is_some() { OWN_SLOPE } else { 1.0 };
    let mut crossed = 0;
    for pixels in PIXELS_A_CELL {
        let plane = is_plane.then_some(Plane { repeat: (f64::from(SIDE) / pixels) as f32, aspect: 1.0 });
        let mut made = loaded(folder.path(), source, "once", plane)?;
        flatten(&mut made);
        let levels = draw(gpu, &made, &view(pixels, is_plane))?;
        let cells = draw(None, &loaded(folder.path(), source, "borders", plane)?, &view(pixels, is_plane))?;
        for across in [[1, 0], [0, 1]] {
            let steps = steps(&levels, &cells, across);
            crossed += steps.iter().filter(|step| step.is_some_and(|step| step.is_border)).count();
            if let Some((place, step, inside)) = worst(&steps, slope) {
                let [x, y] = [place % SIDE as usize, place / SIDE as usize];
                return Err(format!(
                    "{pixels} pixels a cell: at ({x}, {y}) the level steps by {step}, not {inside}"
                )
                .into());
            }
        }
    }
    if crossed < 1000 { Err(format!("only {crossed} borders were seen").into()) } else { Ok(()) }
}

/// A view that is not aligned to the cells; of the plane what is below the horizon.
fn view(pixels: f64, is_plane: bool) -> Request {
    let side = f64::from(SIDE) / pixels;
    let region = match is_plane {
        true => [0.0, 0.3, 1.0, 1.0],
        false => [-0.4037 * side, -0.3019 * side, 0.5963 * side, 0.6981 * side],
    };
    Request { region, ..Request::new([SIDE, SIDE]) }
}

fn loaded(folder: &Path, source: &str, texture: &str, plane: Option<Plane>) -> Result<Loaded, Failed> {
    let file = folder.join("main.tex");
    std::fs::write(&file, source)?;
    let project = Project::new(&file, true);
    let options = Options { texture: Some(texture.to_owned()), plane, ..Options::default() };
    let compiled = compile(&Library::standard()?, project.main(), &project, &options);
    let compiled = compiled.map_err(|f| render::human(&f.sources, &f.diagnostics))?;
    let mut program = compiled.program;
    let tables = load(&mut program, &project).map_err(|d| render::human(&compiled.sources, &d))?;
    Ok((program, tables))
}

/// Gives every picture levels of one grey each, and bakes too, which then are not drawn. The means of
/// patterns are as their coarsest level.
fn flatten((program, tables): &mut Loaded) {
    let passes = program.passes.len() - 1;
    program.passes.drain(..passes);
    program.manifest.passes.drain(..passes);
    let coarsest = program.manifest.resources.iter().map(|resource| {
        let fields = resource.textures.iter().filter(|texture| texture.field != "means");
        fields.filter_map(|texture| texture.table.as_ref()).map(|table| table.levels.len() - 1).max()
    });
    let coarsest: Vec<usize> = coarsest.map(Option::unwrap_or_default).collect();
    for (index, resource) in program.manifest.resources.iter_mut().enumerate() {
        for texture in &mut resource.textures {
            let Some(old) = &texture.table else { continue };
            if matches!(old.format, Format::R32Sint | Format::Rgba32Sint) {
                continue;
            }
            let table = Table::mipmapped(Format::Rgba16Float, [old.width, old.height], old.layers);
            let first = if texture.field == "means" { coarsest[index] } else { 0 };
            let mut bytes = Vec::new();
            for (level, described) in (first..).zip(&table.levels) {
                let grey = half_float(level as f32 / LEVELS);
                bytes.extend(grey.to_le_bytes().repeat(described.bytes(table.format) as usize / 2));
            }
            texture.table = Some(table);
            tables.insert(index, &texture.field, bytes);
        }
    }
}

/// The bits of a 16-bit float that has the number exactly.
fn half_float(number: f32) -> u16 {
    let bits = number.to_bits();
    if number == 0.0 { 0 } else { (((bits >> 23) - 112) << 10) as u16 | (bits >> 13 & 0x3ff) as u16 }
}

fn draw(gpu: Option<&Gpu>, (program, tables): &Loaded, request: &Request) -> Result<Picture, Failed> {
    let drawn = match gpu {
        None => cpu::render(program, tables, request, &|_| {}),
        Some(gpu) => gpu.prepare(program, tables, 0).and_then(|mut scene| scene.render(request, &|_| {})),
    };
    drawn.map_err(|error| error.to_string().into())
}

/// From a pixel to its neighbour.
#[derive(Clone, Copy)]
struct Step {
    /// Levels that are read.
    levels: f32,
    /// Levels that the continuous place asks for.
    asked: f32,
    is_border: bool,
}

/// From each pixel to the next across or down; none where there is none, or where one of the two is
/// no level: the bare ground between discs is the only thing here that is not grey.
fn steps(levels: &Picture, cells: &Picture, [right, down]: [usize; 2]) -> Vec<Option<Step>> {
    let side = SIDE as usize;
    let step = |place: usize| {
        let next = (place % side + right < side).then_some(place + right + down * side)?;
        let [from, to] = [levels.pixels.get(place)?, levels.pixels.get(next)?];
        let [here, there] = [cells.pixels[place], cells.pixels[next]];
        let is_grey = |pixel: &[f32; 4]| (pixel[0] - pixel[2]).abs() < 1e-5;
        (is_grey(from) && is_grey(to)).then(|| Step {
            levels: (from[0] - to[0]).abs() * LEVELS,
            asked: (here[2] / there[2]).log2().abs(),
            is_border: here[..2] != there[..2],
        })
    };
    (0..side * side).map(step).collect()
}

/// The border whose level steps by most more than it should: where, how far, and how far it should.
fn worst(steps: &[Option<Step>], slope: f32) -> Option<(usize, f32, f32)> {
    let borders = steps.iter().enumerate().filter_map(|(place, step)| Some((place, (*step)?)));
    let beyond = borders.filter(|(_, step)| step.is_border).filter_map(|(place, step)| {
        let most = inside_nearby(steps, place).max(step.asked * slope);
        (step.levels > most + TOLERANCE).then_some((place, step.levels, most))
    });
    beyond.max_by(|a, b| (a.1 - a.2).total_cmp(&(b.1 - b.2)))
}

/// The greatest step inside cells near a place; 0 where all are borders.
fn inside_nearby(steps: &[Option<Step>], place: usize) -> f32 {
    let side = SIDE as usize;
    let [x, y] = [place % side, place / side];
    let around = |at: usize| at.saturating_sub(NEARBY)..(at + NEARBY + 1).min(side);
    let places = around(y).flat_map(|y| around(x).map(move |x| y * side + x));
    let inside = places.filter_map(|place| steps[place].filter(|step| !step.is_border));
    inside.map(|step| step.levels).fold(0.0, f32::max)
}
