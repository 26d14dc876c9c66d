//! Bakes on the CPU, of programs made by hand: texels, levels, when they are drawn again, what is
//! refused. Their twins on the GPU are in `gpu/bakes.rs`.

mod common;

use common::bakes::{
    Step, bake_of_a_bake, baked, constant, pattern, program_of, shown, single, smooth, tinted,
};
use common::folds::{endless, floats};
use common::programs::VEC2;
use texgraph_compiler::Program;
use texgraph_compiler::graph::{Builder, Constant, FunctionId};
use texgraph_compiler::manifest::{Format, Recipe, Value};
use texgraph_runtime::bake::render_fixed;
use texgraph_runtime::cpu;
use texgraph_runtime::picture::Picture;
use texgraph_runtime::render::{Backend, RenderError, Renderer, Request};
use texgraph_runtime::resource::Tables;

fn render(program: &Program, request: &Request) -> Picture {
    cpu::render(program, &Tables::default(), request, &|_| {}).expect("it renders")
}

fn set(program: &Program, mut request: Request, name: &str, value: &[f32]) -> Request {
    request.settings.set(&program.manifest, name, Value::Float(value.to_vec())).expect("it is set");
    request
}

/// The texels of resource 0, drawn ahead of time.
fn texels(program: &Program) -> Vec<u8> {
    let mut tables = Tables::default();
    render_fixed(program, &mut tables).expect("it is drawn");
    tables.get(0, "pixels").expect("it depends on no param").to_vec()
}

fn halves(bytes: &[u8]) -> Vec<f32> {
    bytes.chunks_exact(2).map(|pair| half::f16::from_le_bytes([pair[0], pair[1]]).to_f32()).collect()
}

#[test]
fn a_texel_is_the_value_at_its_centre() {
    let program = single(pattern(0), [8, 4], Format::Rgba16Float);
    let picture = render(&program, &set(&program, Request::new([8, 4]), "scale", &[2.0, 1.0]));
    for (i, pixel) in picture.pixels.iter().enumerate() {
        let [u, v] = [(i % 8) as f32 / 8.0 + 1.0 / 16.0, (i / 8) as f32 / 4.0 + 1.0 / 8.0];
        let expected = [(2.0 * u).fract(), v, u * v, 1.0];
        assert_eq!(*pixel, expected, "texel {i}: these are exact in 16 bits");
    }
}

#[test]
fn levels_are_means_of_unrounded_texels() {
    let side = 32;
    let found = halves(&texels(&single(smooth(), [side as u32; 2], Format::Rgba16Float)));
    let mut level_0 = Vec::new();
    for i in 0..side * side {
        let [u, v] = [i % side, i / side].map(|k| (k as f64 + 0.5) / side as f64);
        level_0.push([u * u, u * v, v, 1.0]);
    }
    let mut next = 0;
    for level in 0..6 {
        let (across, block) = (side >> level, 1 << level);
        for i in 0..across * across {
            let (x, y) = (i % across * block, i / across * block);
            for channel in 0..4 {
                let texels = (0..block * block).map(|k| level_0[(y + k / block) * side + x + k % block]);
                let mean = texels.map(|texel| texel[channel]).sum::<f64>() / (block * block) as f64;
                let found = f64::from(found[next]);
                next += 1;
                // Half a step of 16 bits, and a little for sums in 32.
                assert!((found - mean).abs() <= mean * 0.000_49, "level {level}, texel {i}: {found}, {mean}");
            }
        }
    }
    assert_eq!(next, found.len());
}

#[test]
fn a_side_may_be_odd() {
    let found = halves(&texels(&single(smooth(), [5, 3], Format::Rgba16Float)));
    assert_eq!(found.len(), (15 + 2 + 1) * 4);
    let last = &found[found.len() - 4..];
    // The mean of v over the levels is ½, of u² over five centres 0.33.
    assert!((last[2] - 0.5).abs() < 1e-3 && (last[0] - 0.33).abs() < 1e-3, "{last:?}");
}

#[test]
fn formats_hold_what_they_can() {
    let texel = |components: &[f32], format| texels(&single(constant(components), [2, 2], format));
    let [large, small] = [1e30, -1e30];
    assert_eq!(texel(&[0.5, -3.0, 7.0, 0.2], Format::Rgba8Unorm), [128, 0, 255, 51].repeat(5));
    assert_eq!(texel(&[0.5, large, small, 0.5], Format::Rgba8UnormSrgb), [188, 255, 0, 128].repeat(5));
    assert_eq!(texel(&[-0.5, small, large, 1.0], Format::Rgba8Snorm), [-64i8 as u8, 129, 127, 127].repeat(5));
    let float = halves(&texel(&[large, small, 0.1, -2.0], Format::Rgba16Float));
    assert_eq!(float, [65504.0, -65504.0, 0.099_975_586, -2.0].repeat(5));
}

/// A level stands for what is stored: of 8 and 0, in a format of 0..1, the mean is ½.
#[test]
fn values_saturate_before_they_are_averaged() {
    let mut b = Builder::new("wide");
    let uv = b.input("uv", VEC2);
    let [factor, offset] = [-16.0, 12.0].map(|x| b.constant(Constant::floats(&[x, x])));
    let wide = floats(&mut b, "*", uv, factor);
    let value = floats(&mut b, "+", wide, offset);
    b.output("value", value);
    let step = Step { entry: b.finish(), ..constant(&[0.0]) };
    let found = texels(&single(step, [2, 1], Format::Rgba8Unorm));
    assert_eq!([found[0], found[4], found[8]], [255, 0, 128]);
}

#[test]
fn outputs_are_widened() {
    let cases: [(&[f32], [f32; 4]); 4] = [
        (&[0.25], [0.25, 0.25, 0.25, 1.0]),
        (&[0.25, 0.5], [0.25, 0.5, 0.0, 1.0]),
        (&[0.25, 0.5, 0.75], [0.25, 0.5, 0.75, 1.0]),
        (&[0.25, 0.5, 0.75, 0.125], [0.25, 0.5, 0.75, 0.125]),
    ];
    for (components, expected) in cases {
        let program = single(constant(components), [2, 2], Format::Rgba16Float);
        assert_eq!(render(&program, &Request::new([1, 1])).pixels, [expected]);
    }
}

/// The second bake has a fourth of the texels along a side, so it samples level 2 of the first.
#[test]
fn a_bake_samples_the_levels_of_another() {
    let program = single(smooth(), [64, 64], Format::Rgba16Float);
    let resources = vec![program.manifest.resources[0].clone(), baked(1, [16, 16], Format::Rgba16Float)];
    let program = program_of(vec![smooth(), tinted(1), shown(1)], resources);
    let picture = render(&program, &Request::new([16, 16]));
    for (i, pixel) in picture.pixels.iter().enumerate() {
        let centres = |i: usize| (0..4).map(move |k| (i as f32 * 4.0 + k as f32 + 0.5) / 64.0);
        let mean_of_squares = centres(i % 16).map(|u| u * u).sum::<f32>() / 4.0;
        let mean = centres(i / 16).sum::<f32>() / 4.0;
        // The tint is (1, ½, ¼, 1). A sample of level 0 would give less: the square of the mean.
        assert!((pixel[0] - mean_of_squares).abs() <= mean_of_squares * 0.001, "{i}: {pixel:?}");
        assert!((pixel[2] - 0.25 * mean).abs() <= mean * 0.001, "{i}: {pixel:?}");
    }
}

#[test]
fn bakes_are_drawn_again_only_for_their_params() {
    let program = bake_of_a_bake();
    let renderer = Renderer::new(Backend::Cpu).expect("it needs nothing");
    let mut scene = renderer.scene(&program, &Tables::default(), 0).expect("it is ready");
    let mut expect = |request: &Request, drawn: u64, why: &str| {
        let picture = scene.render(request, &|_| {}).expect("it renders");
        assert_eq!(scene.bakes_drawn(), drawn, "{why}");
        assert_eq!(picture, render(&program, request), "{why}: as a scene that keeps nothing");
        picture
    };
    let request = Request::new([20, 20]);
    let first = expect(&request, 2, "the first picture draws both");
    expect(&request, 2, "nothing has changed");
    let moved = Request { time: 3.0, region: [0.25, 0.0, 0.5, 0.25], ..request.clone() };
    expect(&moved, 2, "no bake knows of time or region");
    let request = set(&program, request, "gain", &[0.75]);
    let gained = expect(&request, 2, "only the texture reads gain");
    assert_ne!(first, gained);
    let request = set(&program, request, "tint", &[1.0, 1.0, 0.0, 1.0]);
    let tinted = expect(&request, 3, "the second bake reads tint");
    assert_ne!(gained, tinted);
    let request = set(&program, request, "scale", &[5.0, 1.0]);
    let scaled = expect(&request, 5, "the second bake reads the first, which reads scale");
    assert_ne!(tinted, scaled);
    let request = set(&program, request, "scale", &[5.0, 1.0]);
    expect(&request, 5, "it is set to what it was");
    expect(&Request::new([20, 20]), 7, "the defaults again");
}

#[test]
fn fixed_bakes_are_drawn_ahead_of_time() {
    let program = single(smooth(), [16, 16], Format::Rgba8Unorm);
    let mut tables = Tables::default();
    render_fixed(&program, &mut tables).expect("it is drawn");
    let request = Request::new([16, 16]);
    let mut scene = cpu::Scene::new(&program, &tables, 0).expect("it is ready");
    assert_eq!(scene.render(&request, &|_| {}).expect("it renders"), render(&program, &request));
    assert_eq!(scene.bakes_drawn(), 0, "its texels were in the tables");
    let program = bake_of_a_bake();
    let mut tables = Tables::default();
    render_fixed(&program, &mut tables).expect("there is nothing to draw");
    assert_eq!(tables.iter().count(), 0, "both depend on a param, the second through the first too");
}

#[test]
fn bakes_that_read_a_param_through_another_are_not_fixed() {
    let mut second = tinted(1);
    second.params.clear();
    let resources = vec![baked(0, [4, 4], Format::Rgba16Float), baked(1, [4, 4], Format::Rgba16Float)];
    let program = program_of(vec![pattern(0), second, shown(1)], resources);
    let mut tables = Tables::default();
    render_fixed(&program, &mut tables).expect("there is nothing to draw");
    assert_eq!(tables.iter().count(), 0);
}

#[test]
fn progress_counts_bakes() {
    let program = single(pattern(0), [32, 32], Format::Rgba16Float);
    let heard = std::sync::Mutex::new(Vec::new());
    let tell = |share: f32| heard.lock().expect("no panic").push(share);
    let mut scene = cpu::Scene::new(&program, &Tables::default(), 0).expect("it is ready");
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    one.install(|| scene.render(&Request::new([32, 32]), &tell)).expect("it renders");
    let heard = heard.into_inner().expect("no panic");
    assert_eq!((heard.len(), heard[31], heard[63]), (64, 0.5, 1.0));
    assert!(heard.is_sorted());
}

fn refused(program: &Program) -> RenderError {
    cpu::render(program, &Tables::default(), &Request::new([1, 1]), &|_| {}).expect_err("it must not render")
}

#[test]
fn errors_name_the_bake() {
    for size in [[8193, 1], [1, 8193], [0, 4]] {
        let mut program = single(constant(&[1.0]), [2, 2], Format::Rgba8Unorm);
        program.manifest.resources[0].recipe = Recipe::Bake { size, format: Format::Rgba8Unorm };
        let expected = Box::new(RenderError::TextureSize { size });
        assert_eq!(refused(&program), RenderError::Bake { name: "r0".into(), error: expected });
    }
    let mut program = single(pattern(0), [2, 2], Format::Rgba8Unorm);
    let functions = &mut program.passes[0].graph.functions;
    functions.splice(0..0, endless());
    let last = functions.len() - 1;
    let mut b = Builder::new("slow");
    let uv = b.input("uv", VEC2);
    let u = b.extract(uv, 0);
    let value = b.call(FunctionId(last as u32 - 1), &functions[last - 1], vec![u])[0];
    b.output("value", value);
    functions[last] = b.finish();
    let RenderError::Bake { name, error } = refused(&program) else { panic!("it names the bake") };
    assert!(name == "r0" && matches!(*error, RenderError::TooMuchWork { .. }), "{error}");
}

#[test]
fn tables_that_are_not_as_the_recipe_says_are_errors() {
    let good = single(constant(&[1.0]), [4, 4], Format::Rgba8Unorm);
    let missing = RenderError::NoTable { resource: "r0".into(), field: "pixels".into() };
    let with = |change: fn(&mut Program)| {
        let mut program = good.clone();
        change(&mut program);
        refused(&program)
    };
    assert_eq!(with(|p| p.manifest.resources[0].textures[0].table = None), missing);
    let other = |p: &mut Program| {
        p.manifest.resources[0].textures[0].table =
            baked(0, [2, 2], Format::Rgba8Unorm).textures[0].table.clone();
    };
    assert_eq!(with(other), missing);
    let integers = |p: &mut Program| {
        p.manifest.resources[0] = baked(0, [4, 4], Format::R32Sint);
    };
    assert_eq!(with(integers), missing);
    assert_eq!(render(&good, &Request::new([1, 1])).pixels[0], [1.0; 4]);
}
