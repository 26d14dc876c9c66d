//! The four textures of the table in §6 of Lefebvre & Neyret 2003 (`benches/paper`) beside a plain
//! repeated picture, at about a texel a pixel.
//!
//! All are drawn in turns in every round; a texture's time over the plain one's of the same round is
//! one number of the sample, whose median counts, and beside it the ratio of the least times. CPU
//! time of the whole process, so a software adapter counts too.
//! Run with `cargo bench -p texgraph-runtime --bench patterns`, with `--no-default-features` for the CPU
//! renderer alone.

use cpu_time::ProcessTime;
use std::path::Path;
use texgraph_compiler::{Library, Options, Program, compile};
use texgraph_runtime::cpu;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, load};

const ROUNDS: usize = 60;
const SIDE: u32 = 1024;
/// The part of the virtual texture that is drawn: eight tiles of 128 texels a side.
const REGION: [f64; 4] = [0.25, 0.25, 0.375, 0.375];
/// A file and a texture of it; the first is what the others are compared with.
const CASES: &[(&str, &str)] = &[
    ("plain", "plain"),
    ("basic", "hashed"),
    ("areas", "hashed"),
    ("dithered", "hashed"),
    ("transitions", "hashed"),
    ("basic", "walked"),
    ("areas", "walked"),
    ("dithered", "walked"),
    ("transitions", "walked"),
];

fn main() {
    let library = Library::standard().expect("the library parses");
    let cases: Vec<_> = CASES.iter().map(|(file, texture)| loaded(&library, file, texture)).collect();
    let request = Request { region: REGION, ..Request::new([SIDE, SIDE]) };
    compare("CPU renderer", |i| {
        let (program, tables) = &cases[i];
        cpu::render(program, tables, &request, &|_| {}).expect("the CPU renders");
    });
    #[cfg(feature = "gpu")]
    on_an_adapter(&cases, &request);
}

#[cfg(feature = "gpu")]
fn on_an_adapter(cases: &[(Program, Tables)], request: &Request) {
    use texgraph_runtime::gpu::{Gpu, Preference};
    match Gpu::new(Preference::Software) {
        Ok(gpu) => {
            let mut scenes: Vec<_> = cases
                .iter()
                .map(|(program, tables)| gpu.prepare(program, tables, 0).expect("it is prepared"))
                .collect();
            compare(&gpu.name(), |i| {
                scenes[i].render(request, &|_| {}).expect("the adapter renders");
            });
        }
        Err(error) => println!("no software adapter: {error}"),
    }
}

fn loaded(library: &Library, file: &str, texture: &str) -> (Program, Tables) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../benches/paper/{file}.tex"));
    let project = Project::new(&path, true);
    let options = Options { texture: Some(texture.to_owned()), ..Options::default() };
    let compiled = compile(library, project.main(), &project, &options);
    let mut program = compiled.unwrap_or_else(|failure| panic!("{:?}", failure.diagnostics)).program;
    let tables = load(&mut program, &project).expect("the pictures load");
    (program, tables)
}

/// Draws all cases in turns, each round from the next one on, and prints what they take.
fn compare(name: &str, mut draw: impl FnMut(usize)) {
    let count = CASES.len();
    (0..count).for_each(&mut draw);
    let mut taken = vec![Vec::new(); count];
    for round in 0..ROUNDS {
        for turn in 0..count {
            let case = (round + turn) % count;
            let start = ProcessTime::now();
            draw(case);
            taken[case].push(start.elapsed().as_secs_f64());
        }
    }
    println!("{name}, {SIDE}², {ROUNDS} rounds");
    for ((file, texture), times) in CASES.iter().zip(&taken) {
        let ratios = times.iter().zip(&taken[0]).map(|(time, plain)| time / plain).collect();
        let least = |times: &[f64]| times.iter().copied().fold(f64::INFINITY, f64::min);
        println!(
            "  {file:12} {texture:7} {:6.1} ns a pixel, {:.2} times plain (of the least times {:.2})",
            least(times) * 1e9 / f64::from(SIDE * SIDE),
            median(ratios),
            least(times) / least(&taken[0]),
        );
    }
}

fn median(mut sample: Vec<f64>) -> f64 {
    sample.sort_by(f64::total_cmp);
    sample[sample.len() / 2]
}
