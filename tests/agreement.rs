//! CPU and GPU draw the same: every example, every golden file and every node of the library, in a
//! flat view and on the ground in perspective, at three zoom levels. At the end stands which agrees
//! least.
//!
//! GPU tests are shown as ignored where there is no adapter; `TEXGRAPH_GPU=required` makes that a
//! failure.

use libtest_mimic::{Arguments, Failed, Trial};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use texgraph_compiler::pass::share_level;
use texgraph_compiler::{Library, Options, Plane, Program, compile, textures};
use texgraph_compiler::{contract, diagnostic::render, emit, lower};
use texgraph_runtime::cpu;
use texgraph_runtime::gpu::{Gpu, Preference};
use texgraph_runtime::picture::{Content, Picture};
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, load};

/// A channel may differ by this much between CPU and GPU.
const TOLERANCE: f32 = 2.0 / 255.0;
/// The share of pixels that must agree.
const AGREE: f64 = 0.999;
/// Flat views of every texture: whole, four times nearer, far, and farther.
/// Their bounds keep pixel centres off the borders of cells, where rounding decides.
const ZOOMS: [[f64; 4]; 4] = [
    [0.0, 0.0, 1.0, 1.0],
    [0.3037, 0.4019, 0.5541, 0.6523],
    [-1.7013, -2.1091, 2.3177, 1.9099],
    [0.0, 0.0, 16.0, 16.0],
];
/// Units of `uv` along the lower edge of the ground: near, one, and far. No row lies on a border of cells.
const REPEATS: [f32; 3] = [0.173, 1.03, 4.71];
/// The pictures that are compared.
const FLAT: [u32; 2] = [251, 251];
/// Sides that are powers of two give both the same `uv` to the last bit. Near the horizon the last bit is
/// much of a cell.
const GROUND: [u32; 2] = [256, 256];

/// Where a software adapter's own level of detail is off by so much that it shows (docs/quality.md). The
/// same graph with the levels worked out in the shader agrees as all others do, which is tested here.
const LISTED: &[&str] = &[
    "examples/signboard.tex:signboard::flat, color",
    "examples/stamps.tex:stamps::ground, color",
    "examples/terrain.tex:terrain::flat, color",
    "examples/terrain.tex:terrain::ground, color",
    "tests/golden/bakes.tex:bakes::flat, color",
    "tests/golden/bakes.tex:bakes::ground, color",
    "tests/golden/sampled.tex:sampled::ground, color",
    "tests/golden/tiles.tex:tiles::ground, color",
    "tests/golden/tiling_far.tex:tiling_far::ground, color",
];

/// What has been compared, and the share that agrees.
static SHARES: Mutex<Vec<(f64, String)>> = Mutex::new(Vec::new());

/// How a texture is seen.
#[derive(Clone, Copy, Debug)]
enum View {
    Flat,
    Ground,
}

/// A texture of a file.
#[derive(Clone)]
struct Case {
    file: PathBuf,
    texture: String,
    view: View,
}

fn main() {
    let arguments = Arguments::from_args();
    let required = std::env::var("TEXGRAPH_GPU").is_ok_and(|value| value == "required");
    let gpu = Gpu::new(Preference::Hardware).map(Arc::new);
    let mut trials = vec![Trial::test("every_node_is_drawn", every_node_is_drawn)];
    for case in cases() {
        let gpu = gpu.clone();
        let ignored = gpu.is_err() && !required;
        let name = case.name();
        let run = move || agrees(&*gpu.map_err(|error| error.to_string())?, &case);
        trials.push(Trial::test(name, run).with_ignored_flag(ignored));
    }
    let conclusion = libtest_mimic::run(&arguments, trials);
    worst();
    conclusion.exit();
}

fn worst() {
    let mut shares = SHARES.lock().map(|mut shares| std::mem::take(&mut *shares)).unwrap_or_default();
    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, name) in shares.iter().take(12) {
        println!("{name}");
    }
    println!("{} pictures compared; the first of these lines agrees least", shares.len());
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The `.tex` files of a folder, in order.
fn files(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join(folder)).into_iter().flatten().flatten();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "tex"));
    files.sort();
    files
}

/// The names of a file's textures.
fn textures_of(file: &Path) -> Vec<String> {
    let project = Project::new(file, true);
    let library = Library::standard();
    library.ok().and_then(|library| textures(&library, project.main(), &project).ok()).unwrap_or_default()
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for file in ["examples", "tests/golden", "tests/nodes"].into_iter().flat_map(files) {
        for texture in textures_of(&file) {
            for view in [View::Flat, View::Ground] {
                cases.push(Case { file: file.clone(), texture: texture.clone(), view });
            }
        }
    }
    cases
}

/// Every node of the library that programs can call has a texture `NODE_alone` in `tests/nodes`.
fn every_node_is_drawn() -> Result<(), Failed> {
    for file in files("compiler/std") {
        let text = std::fs::read_to_string(&file)?;
        let nodes = text.lines().filter_map(|line| line.strip_prefix("node "));
        let names = nodes.map(|rest| rest.split(['(', '<']).next().unwrap_or_default());
        let drawn = root().join("tests/nodes").join(file.file_name().unwrap_or_default());
        let drawn: BTreeSet<String> = textures_of(&drawn).into_iter().collect();
        for name in names.filter(|name| !name.starts_with('_')) {
            assert!(drawn.contains(&format!("{name}_alone")), "`{name}` of {} is not drawn", file.display());
        }
    }
    Ok(())
}

impl Case {
    fn name(&self) -> String {
        let file = self.file.strip_prefix(root()).unwrap_or(&self.file);
        format!("{}:{}::{:?}", file.display(), self.texture, self.view).to_lowercase()
    }

    /// The views: each the program's plane, and what is asked of it.
    fn requests(&self) -> Vec<(Option<Plane>, Request)> {
        match self.view {
            View::Flat => ZOOMS.map(|region| (None, Request { region, ..Request::new(FLAT) })).into(),
            View::Ground => {
                let aspect = GROUND[0] as f32 / GROUND[1] as f32;
                REPEATS.map(|repeat| (Some(Plane { repeat, aspect }), Request::new(GROUND))).into()
            }
        }
    }

    /// The program with its tables.
    fn loaded(&self, plane: Option<Plane>) -> Result<(Program, Tables), Failed> {
        let project = Project::new(&self.file, true);
        let options = Options { texture: Some(self.texture.clone()), plane, ..Options::default() };
        let compiled = compile(&Library::standard()?, project.main(), &project, &options);
        let compiled = compiled.map_err(|f| render::human(&f.sources, &f.diagnostics))?;
        let mut program = compiled.program;
        let tables = load(&mut program, &project);
        Ok((program, tables.map_err(|diagnostics| render::human(&compiled.sources, &diagnostics))?))
    }
}

fn agrees(gpu: &Gpu, case: &Case) -> Result<(), Failed> {
    let mut failures = Vec::new();
    for (zoom, (plane, request)) in case.requests().into_iter().enumerate() {
        let (program, tables) = case.loaded(plane)?;
        for (output, described) in program.manifest.outputs.iter().enumerate() {
            let request = Request { time: 1.25, output, ..request.clone() };
            let ours =
                cpu::render(&program, &tables, &request, &|_| {}).map_err(|error| error.to_string())?;
            let share = agreement(&ours, &drawn(gpu, &program, &tables, &request)?)?;
            let output = format!("{}, {}", case.name(), described.name);
            let mut line = format!("{:.3} % {output}, zoom {zoom}", share * 100.0);
            if share < AGREE {
                let twin = drawn(gpu, &with_levels(&program)?, &tables, &request)?;
                let exact = agreement(&ours, &twin)?;
                line += &format!("; {:.3} % with levels worked out in the shader", exact * 100.0);
                if exact < AGREE || !LISTED.contains(&output.as_str()) {
                    failures.push(format!("{line}; {:?}", ours.difference(&twin, TOLERANCE)));
                }
            }
            println!("{line}");
            SHARES.lock().map_err(|_| "a test panicked")?.push((share, line));
        }
    }
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n").into()) }
}

fn drawn(gpu: &Gpu, program: &Program, tables: &Tables, request: &Request) -> Result<Picture, String> {
    let mut scene = gpu.prepare(program, tables, request.output).map_err(|error| error.to_string())?;
    scene.render(request, &|_| {}).map_err(|error| error.to_string())
}

/// The same program with every level of detail worked out in its shaders, by the definition.
fn with_levels(program: &Program) -> Result<Program, String> {
    let mut twin = program.clone();
    for (i, pass) in twin.passes.iter_mut().enumerate() {
        let graph = share_level::everywhere(pass.graph.clone());
        let manifest = contract::of_pass(&program.manifest, i);
        pass.wgsl = emit::wgsl(&lower::lower(&graph, &manifest, &lower::Objects::default()))?;
    }
    Ok(twin)
}

/// The share of pixels that agree: of colour as it is written, in 8 bits; of data as it is, what
/// lies beyond 1 relative to its size.
fn agreement(ours: &Picture, theirs: &Picture) -> Result<f64, Failed> {
    if ours.content != Content::Color {
        let near = |a: f32, b: f32| (a - b).abs() <= TOLERANCE * a.abs().max(b.abs()).max(1.0);
        let pairs = ours.pixels.iter().zip(&theirs.pixels);
        let agreeing = pairs.filter(|(a, b)| a.iter().zip(*b).all(|(a, b)| near(*a, *b))).count();
        return Ok(agreeing as f64 / ours.pixels.len() as f64);
    }
    let (ours, theirs) = (written(ours)?, written(theirs)?);
    let near =
        |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| a.0.iter().zip(b.0).all(|(a, b)| a.abs_diff(b) <= 2);
    let agreeing = ours.pixels().zip(theirs.pixels()).filter(|pair| near(*pair)).count();
    Ok(agreeing as f64 / f64::from(ours.width() * ours.height()))
}

/// A picture through its file.
fn written(picture: &Picture) -> Result<image::RgbaImage, Failed> {
    let png = picture.to_png().map_err(|error| error.to_string())?;
    Ok(image::load_from_memory(&png).map_err(|error| error.to_string())?.to_rgba8())
}
