//! The CPU renderer on graphs made by hand.

mod common;

use common::programs::{arithmetic, fetched, sampled, tiled};
use common::{folder, manifest, write_picture};
use texgraph_compiler::graph::{Builder, Constant, Function, FunctionId, Graph, Scalar, Type, Value};
use texgraph_compiler::intrinsic::Intrinsic;
use texgraph_compiler::manifest::{
    self, Encoding, Filter, Format, Input, Level, Output, Recipe, Source, Table, Tileable, Wrap,
};
use texgraph_compiler::{Pass, Program};
use texgraph_runtime::cpu;
use texgraph_runtime::picture::{Content, Picture};
use texgraph_runtime::render::{RenderError, Request};
use texgraph_runtime::resource::Tables;
use texgraph_runtime::settings::Settings;

fn render(program: &Program, tables: &Tables, request: &Request) -> Picture {
    cpu::render(program, tables, request, &|_| {}).expect("it renders")
}

fn scaled(program: &Program, size: [u32; 2], scale: [f32; 2]) -> Request {
    let mut request = Request::new(size);
    let value = manifest::Value::Float(scale.to_vec());
    request.settings.set(&program.manifest, "scale", value).expect("it is set");
    request
}

fn image(path: &str) -> Recipe {
    Recipe::Image { path: path.into(), encoding: Encoding::Linear, tileable: Tileable::None }
}

#[test]
fn a_texel_a_pixel_gives_the_texels() {
    let folder = folder();
    let samples: Vec<u8> = (0..5 * 3 * 4).map(|i| i * 4).collect();
    write_picture(&folder.path().join("a.png"), [5, 3], &samples);
    for filter in [Filter::Linear, Filter::Nearest] {
        let (program, tables) = sampled(folder.path(), image("a.png"), Wrap::Repeat, filter);
        let picture = render(&program, &tables, &Request::new([5, 3]));
        for (pixel, texel) in picture.pixels.iter().zip(samples.chunks(4)) {
            for (x, sample) in pixel.iter().zip(texel) {
                assert!((x - f32::from(*sample) / 255.0).abs() < 1e-5, "{filter:?}: {pixel:?}, {texel:?}");
            }
        }
    }
}

#[test]
fn wraps_continue_the_picture() {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [4, 1], &[0, 50, 100, 250]);
    // Twelve pixels from one picture before it to one after it.
    let expected = [
        (Wrap::Repeat, [0, 50, 100, 250, 0, 50, 100, 250, 0, 50, 100, 250]),
        (Wrap::Clamp, [0, 0, 0, 0, 0, 50, 100, 250, 250, 250, 250, 250]),
        (Wrap::Mirror, [250, 100, 50, 0, 0, 50, 100, 250, 250, 100, 50, 0]),
    ];
    for (wrap, samples) in expected {
        for filter in [Filter::Linear, Filter::Nearest] {
            let (program, tables) = sampled(folder.path(), image("a.png"), wrap, filter);
            let request = Request { region: [-1.0, 0.0, 2.0, 1.0], ..Request::new([12, 1]) };
            let picture = render(&program, &tables, &request);
            let found: Vec<i32> =
                picture.pixels.iter().map(|pixel| (pixel[0] * 255.0).round() as i32).collect();
            assert_eq!(found, samples, "{wrap:?}, {filter:?}");
        }
    }
}

/// Level l of 8×8 texels is grey l / 8.
fn levels() -> (Table, Vec<u8>) {
    let (mut bytes, mut levels) = (Vec::new(), Vec::new());
    for l in 0..4u8 {
        let side = 8u32 >> l;
        levels.push(Level {
            offset: bytes.len() as u64,
            width: side,
            height: side,
            layers: 1,
            bytes_per_row: side * 8,
        });
        let grey = half::f16::from_f32(f32::from(l) / 8.0).to_le_bytes();
        bytes.extend(grey.repeat(4 * (side * side) as usize));
    }
    (
        Table { file: None, key: None, format: Format::Rgba16Float, width: 8, height: 8, layers: 1, levels },
        bytes,
    )
}

#[test]
fn the_level_follows_the_longer_gradient() {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [8, 8], &[0; 64]);
    let cases = [
        (Filter::Linear, [1.0, 1.0], 0.0),
        (Filter::Linear, [0.1, 0.1], 0.0),
        (Filter::Linear, [2.0, 1.0], 1.0),
        (Filter::Linear, [1.0, 4.0], 2.0),
        (Filter::Linear, [2.828_427, 0.0], 1.5),
        (Filter::Linear, [1e9, 1.0], 3.0),
        (Filter::Linear, [0.0, 0.0], 0.0),
        (Filter::Nearest, [2.7, 1.0], 1.0),
        (Filter::Nearest, [3.0, 1.0], 2.0),
        (Filter::Nearest, [1e30, 1e30], 3.0),
    ];
    for (filter, scale, level) in cases {
        let (mut program, mut tables) = sampled(folder.path(), image("a.png"), Wrap::Repeat, filter);
        let (table, bytes) = levels();
        program.manifest.resources[0].textures[0].table = Some(table);
        tables.insert(0, "pixels", bytes);
        let picture = render(&program, &tables, &scaled(&program, [8, 8], scale));
        let found = picture.pixels[0][0] * 8.0;
        assert!((found - level).abs() < 1e-3, "{filter:?} {scale:?}: {found}, not {level}");
    }
}

#[test]
fn coordinates_that_are_no_numbers_do_no_harm() {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [4, 4], &[100; 16]);
    for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
        for filter in [Filter::Linear, Filter::Nearest] {
            let (program, tables) = sampled(folder.path(), image("a.png"), wrap, filter);
            for bound in [f64::MAX, 1e38, -1e38, 1e10] {
                let request = Request { region: [bound, 0.0, -bound, bound], ..Request::new([3, 3]) };
                let picture = render(&program, &tables, &request);
                let grey = 100.0 / 255.0;
                assert!(
                    picture.pixels.iter().all(|pixel| (pixel[0] - grey).abs() < 1e-3),
                    "{wrap:?} {bound}"
                );
            }
        }
    }
}

#[test]
fn layers_are_chosen_and_clamped() {
    let folder = folder();
    let grey: Vec<u8> = (0..4).map(|layer| layer * 80).collect();
    write_picture(&folder.path().join("a.png"), [4, 1], &grey);
    let recipe = Recipe::Patterns { paths: vec!["a.png".into()], grid: [4, 1], encoding: Encoding::Linear };
    let (program, tables) = tiled(folder.path(), recipe, Wrap::Clamp, Filter::Linear);
    let picture = render(&program, &tables, &Request::new([4, 4]));
    let found: Vec<i32> = picture.pixels.iter().map(|pixel| (pixel[0] * 255.0).round() as i32).collect();
    assert_eq!(found, [0, 80, 160, 240, 240, 240, 240, 240, 240, 240, 240, 240, 240, 240, 240, 240]);
}

#[test]
fn texels_and_sizes_are_integers() {
    let folder = folder();
    let (program, tables) = fetched(folder.path(), Recipe::Permutation { size: 16, seed: 3 });
    let picture = render(&program, &tables, &scaled(&program, [16, 1], [16.0, 1.0]));
    for channel in 0..4 {
        let size = [16.0, 1.0, 1.0, 1.0][channel];
        let mut numbers: Vec<i32> =
            picture.pixels.iter().map(|pixel| (pixel[channel] - size) as i32).collect();
        numbers.sort_unstable();
        assert!(numbers.into_iter().eq(0..16), "channel {channel}");
    }
}

#[test]
fn calls_choices_inputs_and_outputs() {
    let program = arithmetic();
    let mut request = scaled(&program, [4, 4], [0.5, 0.0]);
    request.time = 7.0;
    let color = render(&program, &Tables::default(), &request);
    assert_eq!(color.content, Content::Color);
    assert_eq!(color.pixels[0], [0.0, 0.125, 1.0, 1.0], "fract(8 · 1/8), u, normal.z, alpha");
    assert_eq!(color.pixels[2], [0.625, 0.0, 7.0, 1.0]);
    request.output = 1;
    let data = render(&program, &Tables::default(), &request);
    assert_eq!(data.content, Content::Vector);
    assert_eq!(data.pixels[5], [0.375, 0.375, 7.0, 1.0]);
}

/// `value = f(u)` for the last of some functions of one float.
fn program_of(mut functions: Vec<Function>) -> Program {
    let mut b = Builder::new("test");
    let uv = b.input("uv", Type::Vector(Scalar::Float, 2));
    let u = b.extract(uv, 0);
    let last = functions.len() - 1;
    let value = b.call(FunctionId(last as u32), &functions[last], vec![u])[0];
    b.output("value", value);
    functions.push(b.finish());
    let mut manifest = manifest();
    let float = |width| manifest::Type { scalar: manifest::Scalar::Float, width };
    manifest.inputs = vec![Input { name: "uv".into(), ty: float(2), source: Source::Varying(0) }];
    manifest.outputs = vec![Output { name: "value".into(), ty: float(1), location: 0, is_color: false }];
    let pass = Pass { graph: Graph { functions, ..Graph::default() }, wgsl: String::new() };
    Program { passes: vec![pass], manifest }
}

/// A function of one float that sums some calls of an earlier one, each of another argument, and 1.
fn summing(callee: Option<(FunctionId, &Function)>, calls: usize) -> Function {
    let add = Intrinsic::all().find(|i| i.row().name == "+" && i.row().signature.contains(": vec<"));
    let add = add.expect("there is a sum");
    let mut b = Builder::new("f");
    let x = b.input("x", Type::FLOAT);
    let mut sum = b.constant(Constant::floats(&[1.0]));
    let mut argument = x;
    for _ in 0..calls {
        let value: Value = callee.map_or(argument, |(id, function)| b.call(id, function, vec![argument])[0]);
        sum = b.builtin(add, &[sum, value]);
        argument = b.builtin(add, &[argument, sum]);
    }
    b.output("y", sum);
    b.finish()
}

fn chain(length: u32, calls: usize) -> Program {
    let mut functions = vec![summing(None, 1)];
    for id in 0..length - 1 {
        let next = summing(Some((FunctionId(id), &functions[id as usize])), calls);
        functions.push(next);
    }
    program_of(functions)
}

#[test]
fn deep_calls_need_no_stack() {
    let program = chain(4096, 1);
    let small = std::thread::Builder::new().stack_size(128 << 10);
    let run = move || {
        let pool =
            rayon::ThreadPoolBuilder::new().num_threads(1).stack_size(128 << 10).build().expect("a pool");
        let picture = pool.install(|| render(&program, &Tables::default(), &Request::new([2, 1])));
        assert_eq!(picture.pixels[0], [4096.25, 4096.25, 4096.25, 1.0]);
    };
    small.spawn(run).expect("a thread").join().expect("no overflow");
}

#[test]
fn work_without_end_is_refused() {
    let program = chain(64, 2);
    let result = cpu::render(&program, &Tables::default(), &Request::new([1, 1]), &|_| {});
    assert!(matches!(result, Err(RenderError::TooMuchWork { .. })), "{result:?}");
}

#[test]
fn work_that_no_pixel_changes_is_refused_too() {
    let mut program = chain(64, 2);
    let entry = program.passes[0].graph.functions.len() - 1;
    let mut b = Builder::new("test");
    b.input("uv", Type::Vector(Scalar::Float, 2));
    let one = b.constant(Constant::floats(&[1.0]));
    let value =
        b.call(FunctionId(entry as u32 - 1), &program.passes[0].graph.functions[entry - 1], vec![one])[0];
    b.output("value", value);
    program.passes[0].graph.functions[entry] = b.finish();
    let result = cpu::render(&program, &Tables::default(), &Request::new([1, 1]), &|_| {});
    assert!(matches!(result, Err(RenderError::TooMuchWork { .. })), "{result:?}");
}

#[test]
fn requests_that_cannot_be_met_are_errors() {
    let program = arithmetic();
    let refuse = |request: Request| {
        cpu::render(&program, &Tables::default(), &request, &|_| {}).expect_err("it must not render")
    };
    assert!(matches!(refuse(Request::new([0, 4])), RenderError::Size { .. }));
    assert!(matches!(refuse(Request::new([4, 32_769])), RenderError::Size { .. }));
    assert_eq!(
        refuse(Request { region: [0.0, f64::NAN, 1.0, 1.0], ..Request::new([1, 1]) }),
        RenderError::NotFinite
    );
    assert!(matches!(refuse(Request { output: 2, ..Request::new([1, 1]) }), RenderError::NoOutput { .. }));
}

#[test]
fn tables_that_do_not_fit_are_errors() {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [4, 4], &[100; 16]);
    let (mut program, mut tables) = sampled(folder.path(), image("a.png"), Wrap::Repeat, Filter::Linear);
    let refuse = |program: &Program, tables: &Tables| {
        cpu::render(program, tables, &Request::new([1, 1]), &|_| {}).expect_err("it must not render")
    };
    assert!(matches!(refuse(&program, &Tables::default()), RenderError::NoTable { .. }));
    tables.insert(0, "pixels", vec![0; 60]);
    assert!(matches!(refuse(&program, &tables), RenderError::NoTable { .. }));
    program.manifest.resources[0].textures[0].table = None;
    assert!(matches!(refuse(&program, &tables), RenderError::NoTable { .. }));
}

#[test]
fn the_number_of_threads_changes_no_picture() {
    let program = arithmetic();
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| render(&program, &Tables::default(), &Request::new([33, 21])))
    };
    assert_eq!(run(1), run(5));
}

#[test]
fn a_program_without_functions_is_black() {
    let mut program = arithmetic();
    program.passes[0].graph = Graph::default();
    let picture =
        render(&program, &Tables::default(), &Request { settings: Settings::new(), ..Request::new([2, 2]) });
    assert!(picture.pixels.iter().all(|pixel| *pixel == [0.0; 4]));
}
