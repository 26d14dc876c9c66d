//! How fast the CPU renderer evaluates the library's noises, in Mpixel/s on one core, and beside
//! them, in the same run, what the crates `noise` and `fastnoise-lite` take for the same kind of
//! noise at the same places. All are drawn in turns; the least of [`ROUNDS`] rounds counts, in CPU
//! time of the thread. Ours writes four floats a pixel, as any picture; theirs one.
//!
//! Run with `cargo bench -p texgraph-runtime --no-default-features --bench noise`.

use cpu_time::ThreadTime;
use fastnoise_lite::{CellularDistanceFunction, CellularReturnType, FastNoiseLite, FractalType, NoiseType};
use noise::core::worley::{ReturnType, distance_functions::euclidean, worley_2d};
use noise::permutationtable::PermutationTable;
use noise::{Fbm, MultiFractal, NoiseFn, Perlin, Simplex, Value};
use std::collections::HashMap;
use std::hint::black_box;
use std::path::Path;
use texgraph_compiler::module::Loader;
use texgraph_compiler::{Library, Options, Program, compile};
use texgraph_runtime::cpu::Scene;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::Tables;

const ROUNDS: usize = 9;
const SIDE: u32 = 512;
/// Cells of noise across the picture.
const CELLS: f64 = 32.0;
/// Where space is cut.
const DEPTH: f64 = 0.37;

/// A kind of noise, by all three.
struct Case {
    name: &'static str,
    /// The value in `.tex`, of a place `p` in the plane or `s` in space.
    ours: &'static str,
    /// Of the crate `noise`.
    noise: Work,
    /// Of `fastnoise-lite`.
    lite: Work,
}

/// Fills a picture.
type Work = Box<dyn Fn() + Send + Sync>;

fn main() {
    println!("{SIDE}², {CELLS} cells, one thread, Mpixel/s, the best of {ROUNDS} rounds");
    println!("{:24} {:>8} {:>8} {:>14} {:>8} {:>8}", "", "ours", "noise", "fastnoise-lite", "", "");
    for case in cases() {
        measure(&case);
    }
}

fn cases() -> Vec<Case> {
    vec![
        Case {
            name: "gradient, 2D",
            ours: "noise(p)",
            noise: plane(Perlin::new(1)),
            lite: lite_plane(lite(NoiseType::Perlin)),
        },
        Case {
            name: "gradient, 3D",
            ours: "noise(s)",
            noise: space(Perlin::new(1)),
            lite: lite_space(lite(NoiseType::Perlin)),
        },
        Case {
            name: "value, 2D",
            ours: "value_noise(p)",
            noise: plane(Value::new(1)),
            lite: lite_plane(lite(NoiseType::Value)),
        },
        Case {
            name: "simplex, 2D",
            ours: "simplex(p)",
            noise: plane(Simplex::new(1)),
            lite: lite_plane(lite(NoiseType::OpenSimplex2)),
        },
        Case {
            name: "cellular F1, 2D",
            ours: "voronoi(p).f1",
            noise: cells(),
            lite: lite_plane(cellular(lite(NoiseType::Cellular))),
        },
        Case {
            name: "fBm of 5 octaves, 2D",
            ours: "fbm(p)",
            noise: plane(Fbm::<Perlin>::new(1).set_octaves(5)),
            lite: lite_plane(octaves(lite(NoiseType::Perlin))),
        },
    ]
}

fn plane(f: impl NoiseFn<f64, 2> + Send + Sync + 'static) -> Work {
    Box::new(move || fill(|x, y| f.get([x, y])))
}

fn space(f: impl NoiseFn<f64, 3> + Send + Sync + 'static) -> Work {
    Box::new(move || fill(|x, y| f.get([x, y, DEPTH])))
}

fn lite(kind: NoiseType) -> FastNoiseLite {
    let mut lite = FastNoiseLite::with_seed(1);
    lite.set_noise_type(Some(kind));
    lite.set_frequency(Some(1.0));
    lite
}

fn octaves(mut lite: FastNoiseLite) -> FastNoiseLite {
    lite.set_fractal_type(Some(FractalType::FBm));
    lite.set_fractal_octaves(Some(5));
    lite
}

/// The distance to the nearest point, by the crate `noise`, whose `Worley` stays on its thread.
fn cells() -> Work {
    let table = PermutationTable::new(1);
    Box::new(move || fill(|x, y| worley_2d(&table, euclidean, ReturnType::Distance, [x, y].into())))
}

/// The distance to the nearest of nine cells' points.
fn cellular(mut lite: FastNoiseLite) -> FastNoiseLite {
    lite.set_cellular_distance_function(Some(CellularDistanceFunction::Euclidean));
    lite.set_cellular_return_type(Some(CellularReturnType::Distance));
    lite
}

fn lite_plane(lite: FastNoiseLite) -> Work {
    Box::new(move || fill(|x, y| lite.get_noise_2d(x as f32, y as f32)))
}

fn lite_space(lite: FastNoiseLite) -> Work {
    Box::new(move || fill(|x, y| lite.get_noise_3d(x as f32, y as f32, DEPTH as f32)))
}

/// What a function is worth at the centres of all pixels.
fn fill<T>(f: impl Fn(f64, f64) -> T) {
    let place = |i: u32| (f64::from(i) + 0.5) * CELLS / f64::from(SIDE);
    let mut field = Vec::with_capacity((SIDE * SIDE) as usize);
    for y in 0..SIDE {
        field.extend((0..SIDE).map(|x| f(place(x), place(y))));
    }
    black_box(field);
}

fn compiled(ours: &str) -> Program {
    let text = format!(
        "texture t(uv: vec2) -> (height: float) {{\n\
         let p = uv * {CELLS:.1}\n\
         let s = vec3(p, {DEPTH})\n\
         height = {ours}\n}}"
    );
    let library = Library::standard().expect("the library parses");
    let project = Project::new(Path::new("bench.tex"), false);
    let files: HashMap<String, String> = [(project.main().to_owned(), text)].into();
    let compiled = compile(&library, project.main(), &files as &dyn Loader, &Options::default());
    compiled.unwrap_or_else(|failure| panic!("{ours}: {:?}", failure.diagnostics)).program
}

fn measure(case: &Case) {
    let program = compiled(case.ours);
    let tables = Tables::default();
    let mut scene = Scene::new(&program, &tables, 0).expect("it has an output");
    let request = Request::new([SIDE, SIDE]);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let mut least = [f64::INFINITY; 3];
    one.install(|| {
        for _ in 0..ROUNDS {
            let taken = [
                seconds(|| {
                    black_box(scene.render(&request, &|_| {}).expect("the CPU renders").pixels.len());
                }),
                seconds(&case.noise),
                seconds(&case.lite),
            ];
            least = [0, 1, 2].map(|i| least[i].min(taken[i]));
        }
    });
    let [ours, noise, lite] = least.map(|seconds| f64::from(SIDE * SIDE) / seconds / 1e6);
    println!(
        "{:24} {ours:8.1} {noise:8.1} {lite:14.1} {:8.1}x {:7.1}x",
        case.name,
        ours / noise,
        ours / lite
    );
}

/// The CPU time of this thread that some work takes.
fn seconds(work: impl FnOnce()) -> f64 {
    let start = ThreadTime::now();
    work();
    start.elapsed().as_secs_f64()
}
