//! Programs that bake: WGSL, and the graphs that mean the same.

use super::folds::floats;
use super::programs::{VEC2, VEC4, intrinsic, output, program, set_resources};
use super::resource;
use texgraph_compiler::graph::{
    Axis, Builder, Constant, Function, Graph, Level, Operation, ParamId, Sampled, Scalar, Texel, Type, Value,
    View, ViewDimension, ViewId,
};
use texgraph_compiler::manifest::{self, Filter, Format, Gradients, Recipe, Resource, Table, Uniform, Wrap};
use texgraph_compiler::{Pass, Program};

const PARAMS: &str = "
    struct Params { scale: vec2<f32>, tint: vec4<f32>, gain: f32 }
    @group(0) @binding(0) var<uniform> params: Params;";

/// A bake's resource, its table filled in as the compiler does.
pub fn baked(n: u32, size: [u32; 2], format: Format) -> Resource {
    let mut resource = resource(Recipe::Bake { size, format }, n, Wrap::Repeat, Filter::Linear);
    let mut offset = 0;
    let levels = (0..=size[0].max(size[1]).ilog2()).map(|l| {
        let [width, height] = size.map(|side| (side >> l).max(1));
        let bytes_per_row = width * format.bytes();
        let level = manifest::Level { offset, width, height, layers: 1, bytes_per_row };
        offset += u64::from(bytes_per_row) * u64::from(height);
        level
    });
    let levels = levels.collect();
    resource.textures[0].table =
        Some(Table { file: None, key: None, format, width: size[0], height: size[1], layers: 1, levels });
    resource
}

/// A pass: its entry, its WGSL, which resource it fills, which it reads, and its params.
pub struct Step {
    pub entry: Function,
    pub wgsl: String,
    pub fills: Option<u32>,
    pub reads: Vec<u32>,
    pub params: Vec<&'static str>,
}

/// A program of passes, with the params `scale: vec2`, `tint: vec4` and `gain: float`.
pub fn program_of(steps: Vec<Step>, resources: Vec<Resource>) -> Program {
    let mut program = program(Graph::default(), "");
    let params = [("scale", vec![3.0, 2.0]), ("tint", vec![1.0, 0.5, 0.25, 1.0]), ("gain", vec![0.5])];
    let offsets = [0, 16, 32];
    program.manifest.params =
        params.iter().zip(offsets).map(|((n, v), offset)| param(n, v, offset)).collect();
    program.manifest.uniform = Some(Uniform { name: "params".into(), group: 0, binding: 0, size: 48 });
    let known: Vec<texgraph_compiler::graph::Param> = params.iter().map(|(n, v)| graph_param(n, v)).collect();
    let template = program.manifest.passes.remove(0);
    program.passes.clear();
    for step in &steps {
        let name = step.fills.map_or("test".to_owned(), |n| format!("r{n}"));
        program.manifest.passes.push(manifest::Pass {
            name,
            bake: step.fills,
            params: step.params.iter().map(|name| (*name).to_owned()).collect(),
            call: None,
            gradients: Gradients::Derive,
            ..template.clone()
        });
        let graph = Graph { functions: vec![step.entry.clone()], params: known.clone(), ..Graph::default() };
        program.passes.push(Pass { graph, wgsl: step.wgsl.clone() });
    }
    set_resources(&mut program, resources);
    for (step, pass) in steps.iter().zip(&mut program.manifest.passes) {
        pass.reads = step.reads.iter().map(|n| (*n, "pixels".to_owned())).collect();
    }
    program.manifest.outputs = vec![output("color", 4, 0)];
    program
}

fn param(name: &str, default: &[f32], offset: u32) -> manifest::Param {
    manifest::Param {
        name: name.into(),
        label: String::new(),
        ty: manifest::Type { scalar: manifest::Scalar::Float, width: default.len() as u8 },
        default: manifest::Value::Float(default.to_vec()),
        range: None,
        offset: Some(offset),
    }
}

fn graph_param(name: &str, default: &[f32]) -> texgraph_compiler::graph::Param {
    texgraph_compiler::graph::Param {
        name: name.into(),
        label: String::new(),
        ty: Type::Vector(Scalar::Float, default.len() as u8),
        default: Constant::floats(default),
        range: None,
    }
}

/// `(fract(u · scale.x), fract(v · scale.y), u · v, 1)`
pub fn pattern(fills: u32) -> Step {
    let mut b = Builder::new("pattern");
    let uv = b.input("uv", VEC2);
    let scale = b.push(Operation::Param(ParamId(0)), VEC2);
    let wide = floats(&mut b, "*", uv, scale);
    let part = b.builtin(intrinsic("fract", "vec<"), &[wide]);
    let [x, y] = [0, 1].map(|i| b.extract(part, i));
    let [u, v] = [0, 1].map(|i| b.extract(uv, i));
    let product = floats(&mut b, "*", u, v);
    let one = b.constant(Constant::floats(&[1.0]));
    let value = b.compose(&[x, y, product, one]);
    b.output("value", value);
    let wgsl = format!(
        "{PARAMS}
        @fragment fn main(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {{
            return vec4<f32>(fract(uv * params.scale), uv.x * uv.y, 1.0);
        }}"
    );
    Step { entry: b.finish(), wgsl, fills: Some(fills), reads: vec![], params: vec!["scale"] }
}

/// A sample of view `n` at `uv`, with the gradient of `uv`.
fn sample(b: &mut Builder, n: u32, uv: Value) -> Value {
    let view = View { dimension: ViewDimension::D2, texel: Texel::Sampled, anisotropy: 1 };
    let view = b.push(Operation::View(ViewId(n)), Type::View(view));
    let [dx, dy] =
        [Axis::X, Axis::Y].map(|axis| b.push(Operation::Derivative(uv, axis, Sampled::Constant), VEC2));
    b.sample(view, uv, None, Level::Gradient(dx, dy))
}

/// `tint` times a sample of resource 0.
pub fn tinted(fills: u32) -> Step {
    let mut b = Builder::new("tinted");
    let uv = b.input("uv", VEC2);
    let below = sample(&mut b, 0, uv);
    let tint = b.push(Operation::Param(ParamId(1)), VEC4);
    let value = floats(&mut b, "*", below, tint);
    b.output("value", value);
    let wgsl = format!(
        "{PARAMS}
        @group(0) @binding(1) var t0_: texture_2d<f32>;
        @group(0) @binding(2) var s0_: sampler;
        @fragment fn main(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {{
            return params.tint * textureSampleGrad(t0_, s0_, uv, dpdx(uv), dpdy(uv));
        }}"
    );
    Step { entry: b.finish(), wgsl, fills: Some(fills), reads: vec![0], params: vec!["tint"] }
}

/// A sample of a resource, in the texture.
pub fn shown(n: u32) -> Step {
    let mut b = Builder::new("test");
    let uv = b.input("uv", VEC2);
    let color = sample(&mut b, n, uv);
    b.output("color", color);
    let (t, s) = (2 * n + 1, 2 * n + 2);
    let wgsl = format!(
        "@group(0) @binding({t}) var t{n}_: texture_2d<f32>;
        @group(0) @binding({s}) var s{n}_: sampler;
        @fragment fn main(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {{
            return textureSampleGrad(t{n}_, s{n}_, uv, dpdx(uv), dpdy(uv));
        }}"
    );
    Step { entry: b.finish(), wgsl, fills: None, reads: vec![n], params: vec![] }
}

/// `sample(r1) + gain · sample(r0)`, in the texture.
fn both() -> Step {
    let mut b = Builder::new("test");
    let uv = b.input("uv", VEC2);
    let [below, above] = [0, 1].map(|n| sample(&mut b, n, uv));
    let gain = b.push(Operation::Param(ParamId(2)), Type::FLOAT);
    let gain = b.splat(gain, 4);
    let below = floats(&mut b, "*", below, gain);
    let color = floats(&mut b, "+", above, below);
    b.output("color", color);
    let wgsl = format!(
        "{PARAMS}
        @group(0) @binding(1) var t0_: texture_2d<f32>;
        @group(0) @binding(2) var s0_: sampler;
        @group(0) @binding(3) var t1_: texture_2d<f32>;
        @group(0) @binding(4) var s1_: sampler;
        @fragment fn main(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {{
            let dx = dpdx(uv);
            let dy = dpdy(uv);
            let below = textureSampleGrad(t0_, s0_, uv, dx, dy);
            return textureSampleGrad(t1_, s1_, uv, dx, dy) + params.gain * below;
        }}"
    );
    Step { entry: b.finish(), wgsl, fills: None, reads: vec![0, 1], params: vec!["gain"] }
}

/// One bake, shown.
pub fn single(bake: Step, size: [u32; 2], format: Format) -> Program {
    program_of(vec![bake, shown(0)], vec![baked(0, size, format)])
}

/// A bake of 64 × 64 texels by `scale`, another of 16 × 16 of it by `tint`, and both with `gain`.
pub fn bake_of_a_bake() -> Program {
    let resources = vec![baked(0, [64, 64], Format::Rgba16Float), baked(1, [16, 16], Format::Rgba16Float)];
    program_of(vec![pattern(0), tinted(1), both()], resources)
}

/// A constant, of 1 to 4 components, that reads no param.
pub fn constant(components: &[f32]) -> Step {
    let mut b = Builder::new("constant");
    b.input("uv", VEC2);
    let value = b.constant(Constant::floats(components));
    b.output("value", value);
    let all = [0, 1, 2, 3].map(|i| match (components.len(), i) {
        (_, 3) if components.len() < 4 => 1.0,
        (1, _) => components[0],
        (count, i) if i < count => components[i],
        _ => 0.0,
    });
    let wgsl = format!(
        "@fragment fn main() -> @location(0) vec4<f32> {{
            return vec4<f32>({:?}, {:?}, {:?}, {:?});
        }}",
        all[0], all[1], all[2], all[3]
    );
    Step { entry: b.finish(), wgsl, fills: Some(0), reads: vec![], params: vec![] }
}

/// `(u², uv, v, 1)`, which reads no param, and calls its input by another name.
pub fn smooth() -> Step {
    let mut b = Builder::new("smooth");
    let uv = b.input("place", VEC2);
    let [u, v] = [0, 1].map(|i| b.extract(uv, i));
    let (square, product) = (floats(&mut b, "*", u, u), floats(&mut b, "*", u, v));
    let value = b.compose(&[square, product, v]);
    b.output("value", value);
    let wgsl = "@fragment fn main(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
            return vec4<f32>(uv.x * uv.x, uv.x * uv.y, uv.y, 1.0);
        }";
    Step { entry: b.finish(), wgsl: wgsl.into(), fills: Some(0), reads: vec![], params: vec![] }
}
