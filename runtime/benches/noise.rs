//! How fast the CPU renderer evaluates the library's noises, in Mpixel/s on one core, and beside
//! them, in the same run, what the crates `noise` and `fastnoise-lite` take for the same kind of
//! noise at the same places. All are drawn in turns; the least of [`ROUNDS`] rounds counts, in CPU
//! time of the thread. Ours writes four floats a pixel, as any picture; theirs one.
//!
//! Run with `cargo bench -p texgraph-runtime --no-default-features --bench noise`.

use cpu_time::ThreadTime;
use fastnoise_lite::{CellularDistanceFunction, CellularReturnType, FastNoiseLite, FractalType, NoiseType};
use noise::core::worley::{ReturnType, distance_functions::euclidean, worley_2d, worley_3d};
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

/// As the command does.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const ROUNDS: usize = 25;
const SIDE: u32 = 512;
/// Cells of noise across the picture.
const CELLS: f64 = 32.0;
/// Where space is cut.
const DEPTH: f64 = 0.37;
/// When.
const TIME: f64 = 0.61;

/// A kind of noise, by all three.
struct Case {
    name: &'static str,
    /// The value in `.tex`, of a place `p` in the plane, `s` in space or `t` in time, too.
    ours: &'static str,
    /// Of the crate `noise`, if it does the same.
    noise: Option<Work>,
    /// Of `fastnoise-lite`.
    lite: Option<Work>,
}

/// Fills a picture.
type Work = Box<dyn Fn() + Send + Sync>;

fn main() {
    println!("{SIDE}², {CELLS} cells, one thread, Mpixel/s, the best of {ROUNDS} rounds");
    println!("{:24} {:>8} {:>8} {:>7} {:>8}", "", "ours", "noise", "", "fastnoise-lite");
    for case in cases() {
        measure(&case);
    }
}

fn cases() -> Vec<Case> {
    vec![
        Case {
            name: "gradient, 2D",
            ours: "noise(p)",
            noise: Some(plane(Perlin::new(1))),
            lite: Some(lite_plane(lite(NoiseType::Perlin))),
        },
        Case {
            name: "gradient, 3D",
            ours: "noise(s)",
            noise: Some(space(Perlin::new(1))),
            lite: Some(lite_space(lite(NoiseType::Perlin))),
        },
        Case { name: "gradient, 4D", ours: "noise(t)", noise: Some(moment(Perlin::new(1))), lite: None },
        Case {
            name: "value, 2D",
            ours: "value_noise(p)",
            noise: Some(plane(Value::new(1))),
            lite: Some(lite_plane(lite(NoiseType::Value))),
        },
        Case {
            name: "value, 3D",
            ours: "value_noise(s)",
            noise: Some(space(Value::new(1))),
            lite: Some(lite_space(lite(NoiseType::Value))),
        },
        Case { name: "value, 4D", ours: "value_noise(t)", noise: Some(moment(Value::new(1))), lite: None },
        Case {
            name: "simplex, 2D",
            ours: "simplex(p)",
            noise: Some(plane(Simplex::new(1))),
            lite: Some(lite_plane(lite(NoiseType::OpenSimplex2))),
        },
        Case {
            name: "simplex, 3D",
            ours: "simplex(s)",
            noise: Some(space(Simplex::new(1))),
            lite: Some(lite_space(lite(NoiseType::OpenSimplex2))),
        },
        Case { name: "simplex, 4D", ours: "simplex(t)", noise: Some(moment(Simplex::new(1))), lite: None },
        Case {
            name: "cellular, 2D, 4 cells",
            ours: "voronoi(p, search: near).f1",
            noise: Some(cells()),
            lite: None,
        },
        Case {
            name: "cellular, 2D, 9 cells",
            ours: "worley(p)",
            noise: None,
            lite: Some(lite_plane(cellular(lite(NoiseType::Cellular)))),
        },
        Case {
            name: "cellular, 3D, 8 cells",
            ours: "voronoi(s, search: near).f1",
            noise: Some(cells_in_space()),
            lite: None,
        },
        Case {
            name: "cellular, 3D, 27 cells",
            ours: "worley(s)",
            noise: None,
            lite: Some(lite_space(cellular(lite(NoiseType::Cellular)))),
        },
        Case {
            name: "fBm of 5 octaves, 2D",
            ours: "fbm(p)",
            noise: Some(plane(Fbm::<Perlin>::new(1).set_octaves(5))),
            lite: Some(lite_plane(octaves(lite(NoiseType::Perlin)))),
        },
    ]
}

fn plane(f: impl NoiseFn<f64, 2> + Send + Sync + 'static) -> Work {
    Box::new(move || fill(|x, y| f.get([x, y])))
}

fn space(f: impl NoiseFn<f64, 3> + Send + Sync + 'static) -> Work {
    Box::new(move || fill(|x, y| f.get([x, y, DEPTH])))
}

fn moment(f: impl NoiseFn<f64, 4> + Send + Sync + 'static) -> Work {
    Box::new(move || fill(|x, y| f.get([x, y, DEPTH, TIME])))
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

/// The distance to the nearest of four cells' points, by the crate `noise`, whose `Worley` stays on its
/// thread.
fn cells() -> Work {
    let table = PermutationTable::new(1);
    Box::new(move || fill(|x, y| worley_2d(&table, euclidean, ReturnType::Distance, [x, y].into())))
}

/// The same in space.
fn cells_in_space() -> Work {
    let table = PermutationTable::new(1);
    let far = move |x, y| worley_3d(&table, euclidean, ReturnType::Distance, [x, y, DEPTH].into());
    Box::new(move || fill(far))
}

/// The distance to the nearest of the points of nine cells, in space 27.
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
         let t = vec4(s, {TIME})\n\
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
            let ours = seconds(|| {
                black_box(scene.render(&request, &|_| {}).expect("the CPU renders").pixels.len());
            });
            let theirs = [&case.noise, &case.lite].map(|work| work.as_ref().map_or(f64::INFINITY, seconds));
            let taken = [ours, theirs[0], theirs[1]];
            least = [0, 1, 2].map(|i| least[i].min(taken[i]));
        }
    });
    let speed = least.map(|seconds| f64::from(SIDE * SIDE) / seconds / 1e6);
    let beside = |k: usize| match speed[k] {
        0.0 => format!("{:>8} {:>7}", "", ""),
        other => format!("{other:8.1} {:6.1}x", speed[0] / other),
    };
    println!("{:24} {:8.1} {} {}", case.name, speed[0], beside(1), beside(2));
}

/// The CPU time of this thread that some work takes.
fn seconds(work: impl FnOnce()) -> f64 {
    let start = ThreadTime::now();
    work();
    start.elapsed().as_secs_f64()
}
