//! The cost of a pixel does not depend on how large the virtual texture is: regions that show the
//! same number of cells, out of 64² and out of 65,536², drawn in turns.
//!
//! Each round draws A (64²), B (65,536²) and A again; the ratio B/A is compared with the bench's
//! own noise, A/A. CPU time of the whole process, so a software adapter counts too.
//! Run with `cargo bench -p texgraph-runtime --bench cost`.

use cpu_time::ProcessTime;
use std::path::Path;
use texgraph_compiler::{Library, Options, Program, compile};
use texgraph_runtime::cpu;
use texgraph_runtime::gpu::{Gpu, Preference};
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, load};
use texgraph_runtime::settings::Settings;

const ROUNDS: usize = 40;
const SIDE: u32 = 512;
/// Cells shown along a side.
const SHOWN: f64 = 32.0;

fn main() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/tiling.tex");
    let (program, tables) = loaded(&file);
    let requests = [64, 65_536].map(|cells| request(&program, cells));
    compare("CPU renderer", |i| {
        cpu::render(&program, &tables, &requests[i], &|_| {}).expect("the CPU renders");
    });
    match Gpu::new(Preference::Hardware) {
        Ok(gpu) => {
            let mut scene = gpu.prepare(&program, &tables, 0).expect("the program is prepared");
            compare(&gpu.name(), |i| {
                scene.render(&requests[i], &|_| {}).expect("the GPU renders");
            });
        }
        Err(error) => println!("no GPU: {error}"),
    }
}

fn loaded(file: &Path) -> (Program, Tables) {
    let library = Library::standard().expect("the library parses");
    let project = Project::new(file, false);
    let compiled = compile(&library, project.main(), &project, &Options::default());
    let mut program = compiled.expect("the example compiles").program;
    let tables = load(&mut program, &project).expect("the example loads");
    (program, tables)
}

/// The same number of cells in the same number of pixels, somewhere inside.
fn request(program: &Program, cells: u32) -> Request {
    let mut settings = Settings::new();
    settings.parse(&program.manifest, &format!("cells={cells}")).expect("cells is a param");
    let side = SHOWN / f64::from(cells);
    let start = 0.25;
    Request { region: [start, start, start + side, start + side], settings, ..Request::new([SIDE, SIDE]) }
}

fn timed(mut f: impl FnMut()) -> f64 {
    let start = ProcessTime::now();
    f();
    start.elapsed().as_secs_f64()
}

fn compare(name: &str, mut draw: impl FnMut(usize)) {
    draw(0);
    draw(1);
    let mut between = Vec::new();
    let mut noise = Vec::new();
    let mut time = 0.0;
    for _ in 0..ROUNDS {
        let first = timed(|| draw(0));
        let other = timed(|| draw(1));
        let again = timed(|| draw(0));
        between.push(2.0 * other / (first + again));
        noise.push(again / first);
        time += first + again;
    }
    let per_pixel = time / (2 * ROUNDS) as f64 / f64::from(SIDE * SIDE) * 1e9;
    let (ratio, interval) = mean_and_interval(&between);
    let (own, own_interval) = mean_and_interval(&noise);
    println!("{name}: {per_pixel:.1} ns of CPU time a pixel");
    println!("  65,536² over 64²: {ratio:.3} ± {interval:.3}, the same twice: {own:.3} ± {own_interval:.3}");
}

/// The mean with half the width of its 95 % interval.
fn mean_and_interval(ratios: &[f64]) -> (f64, f64) {
    let count = ratios.len() as f64;
    let mean = ratios.iter().sum::<f64>() / count;
    let variance = ratios.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean, 1.96 * (variance / count).sqrt())
}
