//! The compiler's shader for basic tiling beside the one an expert writes by hand, and that for daisies
//! and a stochastic texture beside the published listings, on a software adapter: CPU time of the process
//! a pixel, drawn in turns. The ratio of each round's two times is
//! one number of the sample; its mean with a 95 % interval is what counts, and beside it the same of
//! the compiler's shader against itself, which shows what this machine can tell apart.
//!
//! Run with `cargo bench -p texgraph-runtime --bench handwritten`; `-- daisies` for one file only.

use cpu_time::ProcessTime;
use std::path::Path;
use texgraph_compiler::{Library, Options, Program, compile};
use texgraph_runtime::gpu::{Gpu, Preference, Scene};
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, load};

const ROUNDS: usize = 60;
const SIDE: u32 = 1024;
/// Pictures that one time is taken of.
const PICTURES: usize = 2;
/// A texture, and the same by hand with the tables of another.
struct Pair {
    file: &'static str,
    ours: &'static str,
    tables: &'static str,
    by_hand: &'static str,
}

const PAIRS: &[Pair] = &[
    Pair {
        file: "examples/tiling.tex",
        ours: "tiling",
        tables: "tiling",
        by_hand: "benches/handwritten/tiling.wgsl",
    },
    Pair {
        file: "benches/bombing/daisies.tex",
        ours: "daisies",
        tables: "listing",
        by_hand: "benches/bombing/listing.wgsl",
    },
    Pair {
        file: "benches/stochastic/stochastic.tex",
        ours: "stochastic",
        tables: "listing",
        by_hand: "benches/stochastic/listing.wgsl",
    },
    Pair {
        file: "benches/stochastic/stochastic.tex",
        ours: "automatic",
        tables: "listing",
        by_hand: "benches/stochastic/listing.wgsl",
    },
    Pair {
        file: "benches/stochastic/stochastic.tex",
        ours: "stochastic",
        tables: "repeated",
        by_hand: "benches/stochastic/repeated.wgsl",
    },
];

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let gpu = match Gpu::new(Preference::Software) {
        Ok(gpu) => gpu,
        Err(error) => return println!("no software adapter: {error}"),
    };
    println!("{}, {SIDE}², {ROUNDS} rounds", gpu.name());
    let only = std::env::args().skip(1).find(|argument| argument != "--bench");
    for Pair { file, ours: texture, tables, by_hand } in PAIRS {
        if only.as_ref().is_some_and(|only| !file.contains(only)) {
            continue;
        }
        let ours = loaded(&root.join(file), texture);
        let mut twin = loaded(&root.join(file), tables);
        let text = std::fs::read_to_string(root.join(by_hand)).expect("the shader is there");
        twin.0.passes.last_mut().expect("a program has a pass").wgsl = text;
        compare(&gpu, &format!("{file}:{texture} and {by_hand}"), [&ours, &twin]);
    }
}

fn loaded(file: &Path, texture: &str) -> (Program, Tables) {
    let library = Library::standard().expect("the library parses");
    let project = Project::new(file, true);
    let options = Options { texture: Some(texture.to_owned()), ..Options::default() };
    let compiled = compile(&library, project.main(), &project, &options);
    let mut program = compiled.unwrap_or_else(|failure| panic!("{:?}", failure.diagnostics)).program;
    let tables = load(&mut program, &project).expect("the pictures load");
    (program, tables)
}

/// Ours, by hand, and ours again, in turns; each round begins with the next of them.
fn compare(gpu: &Gpu, name: &str, [ours, by_hand]: [&(Program, Tables); 2]) {
    let mut scenes =
        [ours, by_hand, ours].map(|(program, tables)| gpu.prepare(program, tables, 0).expect("it draws"));
    scenes.iter_mut().for_each(|scene| {
        draw(scene);
    });
    let (mut paired, mut noise, mut costs) = (Vec::new(), Vec::new(), [0.0; 2]);
    for round in 0..ROUNDS {
        let mut taken = [0.0; 3];
        for turn in 0..3 {
            let i = (round + turn) % 3;
            taken[i] = draw(&mut scenes[i]);
        }
        let [first, hand, second] = taken;
        paired.push((first + second) / 2.0 / hand);
        noise.push(first / second);
        costs[0] += (first + second) / 2.0 / ROUNDS as f64;
        costs[1] += hand / ROUNDS as f64;
    }
    let [ours, by_hand] = costs.map(|seconds| seconds * 1e9 / f64::from(SIDE * SIDE));
    println!("{name}: {ours:.1} ns of CPU time a pixel, by hand {by_hand:.1}");
    for (what, ratios) in [("ours over by hand", paired), ("ours over ours", noise)] {
        let (mean, half) = interval(&ratios);
        println!("  {what:18} {mean:.4}, 95 % within {:.4} to {:.4}", mean - half, mean + half);
    }
}

/// Seconds of CPU time for one picture.
fn draw(scene: &mut Scene<'_>) -> f64 {
    let request = Request::new([SIDE, SIDE]);
    let start = ProcessTime::now();
    for _ in 0..PICTURES {
        scene.render(&request, &|_| {}).expect("the adapter renders");
    }
    start.elapsed().as_secs_f64() / PICTURES as f64
}

/// Mean, and half the 95 % interval of it.
fn interval(sample: &[f64]) -> (f64, f64) {
    let count = sample.len() as f64;
    let mean = sample.iter().sum::<f64>() / count;
    let variance = sample.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0);
    // Student's t of 59 degrees of freedom.
    (mean, 2.0 * (variance / count).sqrt())
}
