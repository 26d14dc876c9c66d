//! Programs made by hand: WGSL, and the graph that means the same.

use super::{graph_of, manifest, project, resource};
use std::path::Path;
use texgraph_compiler::graph::{
    Axis, Builder, Constant, Function, FunctionId, Graph, Level, Operation, ParamId, ResourceView, Sampled,
    Scalar, Texel, Type, Value, View, ViewDimension, ViewId,
};
use texgraph_compiler::intrinsic::Intrinsic;
use texgraph_compiler::manifest::{self, Filter, Input, Output, Param, Recipe, Source, Uniform, Wrap};
use texgraph_compiler::{Pass, Program};
use texgraph_runtime::resource::{Tables, load};

pub const VEC2: Type = Type::Vector(Scalar::Float, 2);
pub const VEC4: Type = Type::Vector(Scalar::Float, 4);

pub fn float(width: u8) -> manifest::Type {
    manifest::Type { scalar: manifest::Scalar::Float, width }
}

/// The intrinsic of a name whose signature has a text in it.
pub fn intrinsic(name: &str, signature: &str) -> Intrinsic {
    let fits = |i: &Intrinsic| i.row().name == name && i.row().signature.contains(signature);
    Intrinsic::all().find(fits).expect("there is such an intrinsic")
}

pub fn varying(name: &str, width: u8, location: u32) -> Input {
    Input { name: name.into(), ty: float(width), source: Source::Varying(location) }
}

pub fn output(name: &str, width: u8, location: u32) -> Output {
    Output { name: name.into(), ty: float(width), location, is_color: name == "color" }
}

/// A program with the input `uv`, a param `scale` in its uniform block, and one output.
pub fn program(graph: Graph, wgsl: &str) -> Program {
    let mut manifest = manifest();
    manifest.inputs = vec![varying("uv", 2, 0)];
    manifest.outputs = vec![output("color", 4, 0)];
    manifest.params = vec![Param {
        name: "scale".into(),
        label: String::new(),
        ty: float(2),
        default: manifest::Value::Float(vec![1.0, 1.0]),
        range: None,
        offset: Some(0),
    }];
    manifest.uniform = Some(Uniform { name: "params".into(), group: 0, binding: 0, size: 16 });
    Program { passes: vec![Pass { graph, wgsl: wgsl.into() }], manifest }
}

pub fn scale_param() -> texgraph_compiler::graph::Param {
    texgraph_compiler::graph::Param {
        name: "scale".into(),
        label: String::new(),
        ty: VEC2,
        default: Constant::floats(&[1.0, 1.0]),
        range: None,
    }
}

/// Gives a program one resource, read through view 0, and loads it.
fn with_resource(
    mut program: Program,
    folder: &Path,
    recipe: Recipe,
    wrap: Wrap,
    filter: Filter,
) -> (Program, Tables) {
    set_resources(&mut program, vec![resource(recipe, 0, wrap, filter)]);
    let tables = load(&mut program, &project(folder)).expect("the resource loads");
    (program, tables)
}

/// Gives a program its resources, resource n read through view n by all its passes.
pub fn set_resources(program: &mut Program, resources: Vec<manifest::Resource>) {
    let views: Vec<ResourceView> = (0..).zip(&resources).map(|(n, resource)| view_of(n, resource)).collect();
    let reads: Vec<(u32, String)> = views.iter().map(|view| (view.resource, view.field.to_owned())).collect();
    program.manifest.resources = resources;
    let described = graph_of(&program.manifest).resources;
    for (pass, described_pass) in program.passes.iter_mut().zip(&mut program.manifest.passes) {
        pass.graph.views.clone_from(&views);
        pass.graph.resources.clone_from(&described);
        described_pass.reads.clone_from(&reads);
    }
}

/// The view of a resource's only texture.
fn view_of(n: u32, resource: &manifest::Resource) -> ResourceView {
    let texture = &resource.textures[0];
    let view = View {
        dimension: match texture.view {
            manifest::ViewDimension::D2 => ViewDimension::D2,
            manifest::ViewDimension::D2Array => ViewDimension::D2Array,
            manifest::ViewDimension::D3 => ViewDimension::D3,
        },
        texel: match texture.sample {
            manifest::SampleKind::Float => Texel::Sampled,
            manifest::SampleKind::Int => Texel::Integer,
        },
        anisotropy: 1,
    };
    let field = ["pixels", "layers", "table", "map"].into_iter().find(|field| *field == texture.field);
    ResourceView { resource: n, field: field.expect("a known field"), view }
}

/// `color = image.sample(uv * scale)`, with the gradient of its coordinate.
pub fn sampled(folder: &Path, recipe: Recipe, wrap: Wrap, filter: Filter) -> (Program, Tables) {
    let mut b = Builder::new("test");
    let uv = b.input("uv", VEC2);
    let scale = b.push(Operation::Param(ParamId(0)), VEC2);
    let view = View { dimension: ViewDimension::D2, texel: Texel::Sampled, anisotropy: 1 };
    let view = b.push(Operation::View(ViewId(0)), Type::View(view));
    let mul = intrinsic("*", ": vec<");
    let at = b.builtin(mul, &[uv, scale]);
    let [dx, dy] = [Axis::X, Axis::Y].map(|axis| {
        let d = b.push(Operation::Derivative(uv, axis, Sampled::Constant), VEC2);
        b.builtin(mul, &[d, scale])
    });
    let color = b.sample(view, at, None, Level::Gradient(dx, dy));
    b.output("color", color);
    let graph = Graph { functions: vec![b.finish()], params: vec![scale_param()], ..Graph::default() };
    let wgsl = "
        struct Params { scale: vec2<f32>, pad: vec2<f32> }
        @group(0) @binding(0) var<uniform> params: Params;
        @group(0) @binding(1) var t0_: texture_2d<f32>;
        @group(0) @binding(2) var s0_: sampler;
        @fragment fn main(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
            let s = params.scale;
            return textureSampleGrad(t0_, s0_, uv * s, dpdx(uv) * s, dpdy(uv) * s);
        }";
    with_resource(program(graph, wgsl), folder, recipe, wrap, filter)
}

/// Four tiles across and down, of layers 0, 1, 2, …: `layers.sample(fract(4 uv), layer: …)` with
/// the gradient of `4 uv · scale`.
pub fn tiled(folder: &Path, recipe: Recipe, wrap: Wrap, filter: Filter) -> (Program, Tables) {
    let mut b = Builder::new("test");
    let uv = b.input("uv", VEC2);
    let scale = b.push(Operation::Param(ParamId(0)), VEC2);
    let view = View { dimension: ViewDimension::D2Array, texel: Texel::Sampled, anisotropy: 1 };
    let view = b.push(Operation::View(ViewId(0)), Type::View(view));
    let mul = intrinsic("*", ": vec<");
    let four = b.constant(Constant::floats(&[4.0, 4.0]));
    let wide = b.builtin(mul, &[uv, four]);
    let at = b.builtin(intrinsic("fract", "vec<"), &[wide]);
    let cell = b.builtin(intrinsic("ifloor", "vec<"), &[wide]);
    let [x, y] = [0, 1].map(|i| b.extract(cell, i));
    let int_four = b.constant(Constant::ints(&[4]));
    let row = b.builtin(intrinsic("*", ": ivec<"), &[y, int_four]);
    let layer = b.builtin(intrinsic("+", ": ivec<"), &[row, x]);
    let [dx, dy] = [Axis::X, Axis::Y].map(|axis| {
        let d = b.push(Operation::Derivative(uv, axis, Sampled::Constant), VEC2);
        let d = b.builtin(mul, &[d, four]);
        b.builtin(mul, &[d, scale])
    });
    let color = b.sample(view, at, Some(layer), Level::Gradient(dx, dy));
    b.output("color", color);
    let graph = Graph { functions: vec![b.finish()], params: vec![scale_param()], ..Graph::default() };
    let wgsl = "
        struct Params { scale: vec2<f32>, pad: vec2<f32> }
        @group(0) @binding(0) var<uniform> params: Params;
        @group(0) @binding(1) var t0_: texture_2d_array<f32>;
        @group(0) @binding(2) var s0_: sampler;
        @fragment fn main(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
            let s = params.scale;
            let cell = vec2<i32>(floor(uv * 4.0));
            let layer = cell.y * 4 + cell.x;
            let at = uv * 4.0 - floor(uv * 4.0);
            return textureSampleGrad(t0_, s0_, at, layer, dpdx(uv) * 4.0 * s, dpdy(uv) * 4.0 * s);
        }";
    with_resource(program(graph, wgsl), folder, recipe, wrap, filter)
}

/// `color = vec4(texel(ivec2(uv * scale))) / 255`: an integer table, 16 texels across.
pub fn fetched(folder: &Path, recipe: Recipe) -> (Program, Tables) {
    let mut b = Builder::new("test");
    let uv = b.input("uv", VEC2);
    let scale = b.push(Operation::Param(ParamId(0)), VEC2);
    let view = View { dimension: ViewDimension::D2, texel: Texel::Integer, anisotropy: 1 };
    let view = b.push(Operation::View(ViewId(0)), Type::View(view));
    let wide = b.builtin(intrinsic("*", ": vec<"), &[uv, scale]);
    let cell = b.builtin(intrinsic("ifloor", "vec<"), &[wide]);
    let texel = b.texel(view, cell, None);
    let number = b.to_float(texel);
    let size = b.size(view);
    let size = b.to_float(size);
    let [w, h] = [0, 1].map(|i| b.extract(size, i));
    let one = b.constant(Constant::floats(&[1.0]));
    let size = b.compose(&[w, h, one, one]);
    let color = b.builtin(intrinsic("+", ": vec<"), &[number, size]);
    b.output("color", color);
    let graph = Graph { functions: vec![b.finish()], params: vec![scale_param()], ..Graph::default() };
    let wgsl = "
        struct Params { scale: vec2<f32>, pad: vec2<f32> }
        @group(0) @binding(0) var<uniform> params: Params;
        @group(0) @binding(1) var t0_: texture_2d<i32>;
        @fragment fn main(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
            let cell = vec2<i32>(floor(uv * params.scale));
            let size = vec2<f32>(textureDimensions(t0_));
            return vec4<f32>(textureLoad(t0_, cell, 0)) + vec4<f32>(size, 1.0, 1.0);
        }";
    with_resource(program(graph, wgsl), folder, recipe, Wrap::Repeat, Filter::Nearest)
}

/// All inputs, a call, a choice and two outputs: `color` marks the left half by `a`, `data` is
/// (uv, time).
pub fn arithmetic() -> Program {
    let mut callee = Builder::new("stripe");
    let x = callee.input("x", Type::FLOAT);
    let eight = callee.constant(Constant::floats(&[8.0]));
    let wide = callee.builtin(intrinsic("*", ": vec<"), &[x, eight]);
    let part = callee.builtin(intrinsic("fract", "vec<"), &[wide]);
    let unused = callee.builtin(intrinsic("+", ": vec<"), &[x, wide]);
    callee.output("part", part);
    callee.output("unused", unused);
    let callee: Function = callee.finish();
    let mut b = Builder::new("test");
    let uv = b.input("uv", VEC2);
    let time = b.input("time", Type::FLOAT);
    let normal = b.input("normal", Type::Vector(Scalar::Float, 3));
    let tint = b.input("vertex_color", VEC4);
    let scale = b.push(Operation::Param(ParamId(0)), VEC2);
    let [u, v] = [0, 1].map(|i| b.extract(uv, i));
    let part = b.call(FunctionId(0), &callee, vec![v])[0];
    let threshold = b.extract(scale, 0);
    let left = b.builtin(intrinsic("<", "a: float"), &[u, threshold]);
    let [nz, alpha] = [b.extract(normal, 2), b.extract(tint, 3)];
    let yes = b.compose(&[part, u, nz, alpha]);
    let no = b.compose(&[u, part, time, alpha]);
    let color = b.select(left, yes, no);
    let data: Value = b.compose(&[u, v, time]);
    b.output("color", color);
    b.output("data", data);
    let graph =
        Graph { functions: vec![callee, b.finish()], params: vec![scale_param()], ..Graph::default() };
    let wgsl = "
        struct Params { scale: vec2<f32>, time: f32, pad: f32 }
        @group(1) @binding(3) var<uniform> params: Params;
        struct Outputs { @location(0) color: vec4<f32>, @location(1) data: vec4<f32> }
        @fragment fn main(
            @location(0) uv: vec2<f32>, @location(1) normal: vec3<f32>, @location(3) tint: vec4<f32>,
        ) -> Outputs {
            let part = fract(uv.y * 8.0);
            let yes = vec4<f32>(part, uv.x, normal.z, tint.w);
            let no = vec4<f32>(uv.x, part, params.time, tint.w);
            return Outputs(select(no, yes, uv.x < params.scale.x), vec4<f32>(uv, params.time, 1.0));
        }";
    let mut program = program(graph, wgsl);
    program.manifest.inputs = vec![
        varying("uv", 2, 0),
        Input { name: "time".into(), ty: float(1), source: Source::Uniform(8) },
        varying("normal", 3, 1),
        varying("vertex_color", 4, 3),
    ];
    program.manifest.outputs = vec![output("color", 4, 0), output("data", 3, 1)];
    program.manifest.uniform = Some(Uniform { name: "params".into(), group: 1, binding: 3, size: 16 });
    program
}
