//! The CPU renderer runs batches of pixels; this compares it, bit for bit, with the compiler's own
//! evaluation of each pixel by itself. Branches and loops that part the lanes of a batch, and
//! pictures that end inside one, must not show.

#[path = "generated/mod.rs"]
mod generated;

use generated::choices::Choices;
use generated::features::Features;
use generated::program::{Known, program};
use std::collections::HashMap;
use std::path::Path;
use texgraph_compiler::graph::evaluate::evaluate;
use texgraph_compiler::graph::{Axis, Constant, FunctionId, Graph, Operation, Scalar};
use texgraph_compiler::manifest::{self, Input, Manifest};
use texgraph_compiler::{Library, Options, Program, compile, textures};
use texgraph_runtime::cpu;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, load};
use texgraph_runtime::settings::Settings;

/// Three batches, the last of them not full; no row is one.
const SIZE: [u32; 2] = [13, 11];
/// Operations of one pixel of the evaluation; what takes more is left out.
const BUDGET: u64 = 50_000;

fn request(output: usize) -> Request {
    Request { output, time: 1.25, region: [-2.25, -1.5, 3.5, 2.0], ..Request::new(SIZE) }
}

/// A program's textures with their tables.
fn programs(library: &Library, main: &str, files: &HashMap<String, String>) -> Vec<(Program, Tables)> {
    let project = Project::new(&Path::new("nowhere").join(main), false);
    let names = textures(library, main, files).unwrap_or_default();
    let compiled = names.into_iter().filter_map(|texture| {
        let options = Options { texture: Some(texture), ..Options::default() };
        let mut program = compile(library, main, files, &options).ok()?.program;
        let tables = load(&mut program, &project).ok()?;
        Some((program, tables))
    });
    compiled.collect()
}

/// The graph with numbers for its params, and for the derivatives of its inputs.
fn numbered(graph: &Graph, manifest: &Manifest, request: &Request) -> Graph {
    let mut graph = graph.clone();
    let settings = Settings::new();
    for function in &mut graph.functions {
        for i in 0..function.values.len() {
            let number = match function.values[i] {
                Operation::Param(id) => {
                    let name = &graph.params[id.0 as usize].name;
                    let param = manifest.params.iter().find(|param| param.name == *name);
                    param.map(|param| constant(&settings.value(param)))
                }
                Operation::Derivative(of, axis, _) => match function.values[of.0 as usize] {
                    Operation::Input(n) => Some(derivative(&manifest.inputs[n as usize], axis, request)),
                    _ => None,
                },
                _ => None,
            };
            if let Some(number) = number {
                function.values[i] = Operation::Constant(number);
            }
        }
    }
    graph
}

fn constant(value: &manifest::Value) -> Constant {
    match value {
        manifest::Value::Float(components) => Constant::floats(components),
        manifest::Value::Int(components) => Constant::ints(components),
        manifest::Value::Bool(components) => Constant::bools(components),
    }
}

/// An input of a flat picture: at its upper left corner, and the change to the right and down.
fn flat(name: &str, request: &Request) -> [[f64; 4]; 3] {
    let [x0, y0, x1, y1] = request.region;
    let [right, down] = [(x1 - x0) / f64::from(SIZE[0]), (y1 - y0) / f64::from(SIZE[1])];
    let same = |value| [value, [0.0; 4], [0.0; 4]];
    match name {
        "uv" | "uv2" | "position" => [[x0, y0, 0.0, 0.0], [right, 0.0, 0.0, 0.0], [0.0, down, 0.0, 0.0]],
        "normal" | "view" => same([0.0, 0.0, 1.0, 0.0]),
        "tangent" => same([1.0, 0.0, 0.0, 1.0]),
        "vertex_color" => same([1.0; 4]),
        _ => same([0.0; 4]),
    }
}

fn derivative(input: &Input, axis: Axis, request: &Request) -> Constant {
    let [_, right, down] = flat(&input.name, request);
    let change = if axis == Axis::X { right } else { down };
    Constant::floats(&change.map(|x| x as f32)[..usize::from(input.ty.width)])
}

/// What an input is at a pixel.
fn input(input: &Input, request: &Request, pixel: usize) -> Constant {
    if let Some(value) = request.draw().value(&input.name, input.ty) {
        return constant(&value);
    }
    let width = SIZE[0] as usize;
    let [x, y] = [pixel % width, pixel / width].map(|i| i as f64 + 0.5);
    let [corner, right, down] = flat(&input.name, request);
    let components = [0, 1, 2, 3].map(|i| (corner[i] + right[i] * x + down[i] * y) as f32);
    Constant::floats(&components[..usize::from(input.ty.width)])
}

/// What a pixel should be; none where that needs a texture, or too long.
fn alone(graph: &Graph, manifest: &Manifest, request: &Request, pixel: usize) -> Option<[f32; 4]> {
    let arguments: Vec<Constant> = manifest.inputs.iter().map(|slot| input(slot, request, pixel)).collect();
    let entry = FunctionId(graph.functions.len() as u32 - 1);
    let value = *evaluate(&graph.functions, entry, &arguments, &mut BUDGET.clone()).ok()?.first()?;
    let component = |i: usize| match value.scalar() {
        Scalar::Float => value.float(i),
        Scalar::Int => value.int(i) as f32,
        Scalar::Bool => f32::from(u8::from(value.bool(i))),
    };
    Some(match value.width() {
        1 => [component(0), component(0), component(0), 1.0],
        2 => [component(0), component(1), 0.0, 1.0],
        3 => [component(0), component(1), component(2), 1.0],
        _ => [0, 1, 2, 3].map(component),
    })
}

/// Compares all outputs; how many pixels could be compared.
fn compare(program: &Program, tables: &Tables, name: &str) -> usize {
    let mut compared = 0;
    for output in 0..program.manifest.outputs.len() {
        let request = request(output);
        let mut graph = numbered(&program.texture().graph, &program.manifest, &request);
        if let Some(entry) = graph.functions.last_mut() {
            entry.outputs = vec![entry.outputs[output].clone()];
        }
        let picture = cpu::render(program, tables, &request, &|_| {}).expect("it renders");
        for (n, found) in picture.pixels.iter().enumerate() {
            if let Some(wanted) = alone(&graph, &program.manifest, &request, n) {
                let [found, wanted] = [*found, wanted].map(|pixel| pixel.map(f32::to_bits));
                assert_eq!(found, wanted, "{name}, output {output}, pixel {n}");
                compared += 1;
            }
        }
    }
    compared
}

#[test]
fn generated_programs_are_what_each_pixel_is_alone() {
    let library = Library::standard().expect("the library parses");
    let known = Known::new(&library);
    let features = Features { pictures: false, bakes: false, ..Features::NOW };
    let mut compared = 0;
    for seed in 0..200 {
        let made = program(&mut Choices::Seed(seed), features, &known);
        for (program, tables) in programs(&library, &made.main, &made.files) {
            compared += compare(&program, &tables, &format!("seed {seed}"));
        }
    }
    assert!(compared > 40_000, "only {compared} pixels could be compared");
}

/// Loops of as many steps as a lane says, in branches that lanes take by themselves, in a node that
/// is called from both arms, in a loop with a condition.
const PARTED: &str = "
node climb(n: int, most: int) -> (steps: int, top: int) {
    let walk = fold (at = n, steps = 0, top = n) for i in 0..most max 200 while at > 1 {
        let next = if at % 2 == 0 { at / 2 } else { at * 3 + 1 }
        at    = next
        steps = steps + 1
        top   = max(top, next)
    }
    steps = walk.steps
    top   = walk.top
}

node parted(cell: ivec2) -> (value: vec4) {
    let seed = cell.x * 7 + cell.y * 13 + 40
    let a = climb(seed, 150)
    let nested = fold (sum = 0.0, count = 0) for j in 0..bits(seed, 0, 3) max 9 {
        let inner = fold (s = sum) for k in 0..(cell.y + j) max 9 while s < 40.0 {
            s = if k % 3 == j % 3 { s + climb(k + j + 1, cell.x + 3).steps } else { s * 1.25 + sin(s + k) }
        }
        sum   = inner
        count = count + (if inner > 20.0 { climb(count + 5, 60).top } else { 1 })
    }
    let none = fold (s = 1) for i in 0..(cell.x - 100) max 5 { s = s + climb(i, 5).steps }
    value = if cell.x > 1 {
        if cell.y > 0 { vec4(a.steps, a.top, nested.sum, nested.count) } else { vec4(nested.sum, none, a.top, climb(a.steps, 9).top) }
    } else {
        vec4(climb(seed + 3, 20).top, 0.0, if cell.y == 1 { nested.sum } else { float(climb(9, cell.y).steps) }, none)
    }
}

texture main(uv: vec2) -> (value: vec4) {
    value = parted(ifloor(uv * 3.0))
}
";

#[test]
fn lanes_that_part_are_what_each_pixel_is_alone() {
    let library = Library::standard().expect("the library parses");
    let files: HashMap<String, String> = [("main.tex".to_owned(), PARTED.to_owned())].into();
    let programs = programs(&library, "main.tex", &files);
    assert_eq!(programs.len(), 1, "it compiles");
    for (program, tables) in programs {
        assert_eq!(compare(&program, &tables, "parted lanes"), 143);
    }
}

/// A program with its tables, from a file.
fn loaded(file: &Path) -> (Program, Tables) {
    let library = Library::standard().expect("the library parses");
    let project = Project::new(file, true);
    let compiled = compile(&library, project.main(), &project, &Options::default());
    let mut program = compiled.expect("the file compiles").program;
    let tables = load(&mut program, &project).expect("the file loads");
    (program, tables)
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// One pixel of 256 a unit, in a picture of its own.
fn single(scene: &mut cpu::Scene<'_>, [x, y]: [u32; 2]) -> [u32; 4] {
    let [x0, y0, x1, y1] = [x, y, x + 1, y + 1].map(|i| f64::from(i) / 256.0);
    let request = Request { region: [x0, y0, x1, y1], time: 1.25, ..Request::new([1, 1]) };
    scene.render(&request, &|_| {}).expect("it renders").pixels[0].map(f32::to_bits)
}

/// A corner of 256 pixels a unit.
fn corner(size: [u32; 2]) -> Request {
    let [x, y] = size.map(|side| f64::from(side) / 256.0);
    Request { region: [0.0, 0.0, x, y], time: 1.25, ..Request::new(size) }
}

/// Textures included: a batch of one lane is what a lane of a full batch is.
#[test]
fn examples_are_what_each_pixel_is_in_a_picture_of_its_own() {
    let size = [97, 5];
    for folder in ["examples", "tests/golden"] {
        for entry in std::fs::read_dir(root().join(folder)).expect("there is a folder") {
            let file = entry.expect("it can be read").path();
            if file.extension().is_none_or(|extension| extension != "tex") {
                continue;
            }
            let (program, tables) = loaded(&file);
            for output in 0..program.manifest.outputs.len() {
                let mut scene = cpu::Scene::new(&program, &tables, output).expect("the tables are whole");
                let pixels = scene.render(&corner(size), &|_| {}).expect("it renders").pixels;
                for at in (0..size[0] * size[1]).step_by(13) {
                    let alone = single(&mut scene, [at % size[0], at / size[0]]);
                    let found = pixels[at as usize].map(f32::to_bits);
                    assert_eq!(found, alone, "{}, output {output}, pixel {at}", file.display());
                }
            }
        }
    }
}

/// Sizes at which pictures end at, before and after the end of a batch, in one row and in many.
#[test]
fn a_picture_may_end_anywhere_in_a_batch_and_have_any_threads() {
    let (program, tables) = loaded(&root().join("examples/tiling.tex"));
    let mut scene = cpu::Scene::new(&program, &tables, 0).expect("the tables are whole");
    for size in [[1, 1], [63, 1], [64, 1], [65, 1], [1, 129], [64, 3], [67, 70], [200, 33]] {
        let draw = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let draw = || cpu::render(&program, &tables, &corner(size), &|_| {});
            pool.install(draw).expect("it renders").pixels
        };
        let pixels = draw(1);
        assert_eq!(pixels.len() as u32, size[0] * size[1]);
        assert!([2, 3].into_iter().all(|threads| draw(threads) == pixels), "{size:?}");
        for at in [0, pixels.len() / 2, pixels.len() - 1] {
            let place = [at as u32 % size[0], at as u32 / size[0]];
            let found = pixels[at].map(f32::to_bits);
            assert_eq!(found, single(&mut scene, place), "{size:?}, pixel {at}");
        }
    }
}
