//! How fast the CPU renderer is: Mpixel/s of a picture that repeats and of basic tiling, on one
//! thread and on two, and beside them, in the same run, what a software adapter takes for the same
//! pictures. The least of [`ROUNDS`] rounds, drawn in turns; beside the time by the clock the
//! process's CPU time, which other work on the machine disturbs less.
//!
//! Run with `cargo bench -p texgraph-runtime --bench render`.

use cpu_time::ProcessTime;
use std::collections::HashMap;
use std::path::Path;
use std::time::{Duration, Instant};
use texgraph_compiler::module::Loader;
use texgraph_compiler::{Library, Options, Program, compile};
use texgraph_runtime::cpu;
use texgraph_runtime::gpu::{Gpu, Preference};
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, load};

const ROUNDS: usize = 15;
const SIDE: u32 = 1024;

/// A picture that repeats, its texels somewhat smaller than pixels, so that two levels are read.
const REPEATED: &str = "
let rock = image(\"photos/rock.jpg\", wrap: repeat)
texture repeated(uv: vec2) -> (color: color) { color = rock.sample(uv * 3.0) }
";

/// What is drawn, and how fast it should be on two cores.
struct Case {
    name: &'static str,
    text: String,
    goal: f64,
}

fn main() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
    let tiling = std::fs::read_to_string(examples.join("tiling.tex")).expect("the example is there");
    let cases = [
        Case { name: "repeated picture", text: REPEATED.into(), goal: 40.0 },
        Case { name: "tiling.tex", text: tiling, goal: 15.0 },
    ];
    println!("{SIDE}², the least time of {ROUNDS} rounds");
    for case in cases {
        let (program, tables) = loaded(&examples, &case.text);
        measure(&case, &program, &tables);
    }
}

fn loaded(folder: &Path, text: &str) -> (Program, Tables) {
    let library = Library::standard().expect("the library parses");
    let project = Project::new(&folder.join("bench.tex"), false);
    let files: HashMap<String, String> = [(project.main().to_owned(), text.to_owned())].into();
    let compiled = compile(&library, project.main(), &files as &dyn Loader, &Options::default());
    let mut program = compiled.unwrap_or_else(|failure| panic!("{:?}", failure.diagnostics)).program;
    let tables = load(&mut program, &project).expect("the pictures load");
    (program, tables)
}

fn measure(case: &Case, program: &Program, tables: &Tables) {
    let request = Request::new([SIDE, SIDE]);
    let gpu = Gpu::new(Preference::Software);
    let mut runs: Vec<(String, Box<dyn FnMut() + '_>)> = Vec::new();
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let mut scene = cpu::Scene::new(program, tables, 0).expect("the tables are whole");
        let request = &request;
        let draw = move || {
            pool.install(|| scene.render(request, &|_| {}).expect("the CPU renders"));
        };
        runs.push((format!("CPU renderer, {threads} thread(s)"), Box::new(draw)));
    }
    match &gpu {
        Ok(gpu) => {
            let mut scene = gpu.prepare(program, tables, 0).expect("the program is prepared");
            let request = &request;
            let draw = move || {
                scene.render(request, &|_| {}).expect("the adapter renders");
            };
            runs.push((gpu.name(), Box::new(draw)));
        }
        Err(error) => println!("no software adapter: {error}"),
    }
    let mut least = vec![[Duration::MAX; 2]; runs.len()];
    for _ in 0..ROUNDS {
        for ((_, draw), least) in runs.iter_mut().zip(&mut least) {
            let (clock, process) = (Instant::now(), ProcessTime::now());
            draw();
            let taken = [clock.elapsed(), process.elapsed()];
            *least = [0, 1].map(|i| least[i].min(taken[i]));
        }
    }
    println!("{} (goal: {} on two cores)", case.name, case.goal);
    for ((name, _), [clock, process]) in runs.iter().zip(least) {
        let pixels = f64::from(SIDE * SIDE);
        let rate = pixels / clock.as_secs_f64() / 1e6;
        let cost = process.as_secs_f64() / pixels * 1e9;
        println!("  {rate:6.1} Mpixel/s, {cost:5.1} ns of CPU time a pixel  {name}");
    }
}
