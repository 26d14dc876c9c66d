//! Programs with folds: WGSL, and the graph that means the same.

use super::programs::{VEC2, VEC4, intrinsic, program, scale_param, set_resources};
use super::{project, resource};
use std::path::Path;
use texgraph_compiler::Program;
use texgraph_compiler::graph::{
    Axis, Builder, Constant, Fold, Function, FunctionId, Graph, Level, Operation, ParamId, Sampled, Texel,
    Type, Value, View, ViewDimension, ViewId,
};
use texgraph_compiler::manifest::{Filter, IndicesSource, Recipe, Tileable, Wrap};
use texgraph_runtime::resource::{Tables, load};

fn operator(b: &mut Builder, name: &str, signature: &str, x: Value, y: Value) -> Value {
    b.builtin(intrinsic(name, signature), &[x, y])
}

/// An operator of two ints or vectors of them.
pub fn ints(b: &mut Builder, name: &str, x: Value, y: Value) -> Value {
    operator(b, name, "a: ivec<n>", x, y)
}

/// An operator of two floats or vectors of them.
pub fn floats(b: &mut Builder, name: &str, x: Value, y: Value) -> Value {
    operator(b, name, "a: vec<n>", x, y)
}

/// A known int.
pub fn int(b: &mut Builder, i: i32) -> Value {
    b.constant(Constant::ints(&[i]))
}

/// A known float.
pub fn number(b: &mut Builder, x: f32) -> Value {
    b.constant(Constant::floats(&[x]))
}

/// `uv`, and the numbers of its cells, 16 along a side.
fn place(b: &mut Builder) -> (Value, [Value; 2]) {
    let uv = b.input("uv", VEC2);
    let sixteen = b.constant(Constant::floats(&[16.0; 2]));
    let wide = floats(b, "*", uv, sixteen);
    let cell = b.builtin(intrinsic("ifloor", "vec<"), &[wide]);
    (uv, [0, 1].map(|i| b.extract(cell, i)))
}

/// The output `color` of three floats.
fn finish(mut b: Builder, parts: [Value; 3]) -> Function {
    let one = number(&mut b, 1.0);
    let color = b.compose(&[parts[0], parts[1], parts[2], one]);
    b.output("color", color);
    b.finish()
}

fn graph(functions: Vec<Function>) -> Graph {
    Graph { functions, params: vec![scale_param()], ..Graph::default() }
}

/// `cell.x` steps, 7 at most: `next = last + u · step, last = next, number = step` from (1, ½, −1).
pub fn counted() -> Program {
    let mut body = Builder::new("step");
    let next = body.input("next", Type::FLOAT);
    let last = body.input("last", Type::FLOAT);
    body.input("number", Type::INT);
    let step = body.input("step", Type::INT);
    let u = body.input("u", Type::FLOAT);
    let factor = body.to_float(step);
    let more = floats(&mut body, "*", u, factor);
    let sum = floats(&mut body, "+", last, more);
    body.output("next", sum);
    body.output("last", next);
    body.output("number", step);
    let mut b = Builder::new("test");
    let (uv, [x, _]) = place(&mut b);
    let u = b.extract(uv, 0);
    let starts = vec![number(&mut b, 1.0), number(&mut b, 0.5), int(&mut b, -1)];
    let fold = Fold { body: FunctionId(0), condition: None, starts, steps: x, most: 7, captures: vec![u] };
    let [next, last, count] = b.fold(fold)[..] else { panic!("three accumulators") };
    let count = b.to_float(count);
    let entry = finish(b, [next, last, count]);
    let wgsl = "
        @fragment fn main(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
            var next = 1.0;
            var last = 0.5;
            var number = -1;
            let steps = clamp(i32(floor(uv.x * 16.0)), 0, 7);
            for (var s = 0; s < steps; s++) {
                let sum = last + uv.x * f32(s);
                last = next;
                next = sum;
                number = s;
            }
            return vec4<f32>(next, last, f32(number), 1.0);
        }";
    program(graph(vec![body.finish(), entry]), wgsl)
}

/// Collatz's sequence from `cell.x + 16 cell.y + 1`, in a function that is called: how long it is,
/// the length times `scale.x` as the body knows it, and its peak.
pub fn collatz() -> Program {
    let mut body = Builder::new("step");
    let inputs = ["n", "count", "peak"].map(|name| body.input(name, Type::INT));
    let weighed = body.input("weighed", Type::FLOAT);
    body.input("step", Type::INT);
    let [one, two, three, zero] = [1, 2, 3, 0].map(|i| int(&mut body, i));
    let rest = ints(&mut body, "%", inputs[0], two);
    let even = ints(&mut body, "==", rest, zero);
    let half = ints(&mut body, "/", inputs[0], two);
    let triple = ints(&mut body, "*", inputs[0], three);
    let odd = ints(&mut body, "+", triple, one);
    let next = body.select(even, half, odd);
    let count = ints(&mut body, "+", inputs[1], one);
    let peak = ints(&mut body, "max", inputs[2], next);
    let scale = body.push(Operation::Param(ParamId(0)), VEC2);
    let scale = body.extract(scale, 0);
    let weighed = floats(&mut body, "+", weighed, scale);
    for (name, value) in [("n", next), ("count", count), ("peak", peak), ("weighed", weighed)] {
        body.output(name, value);
    }
    let mut condition = Builder::new("test");
    let n = condition.input("n", Type::INT);
    for (name, ty) in [("count", Type::INT), ("peak", Type::INT), ("weighed", Type::FLOAT)] {
        condition.input(name, ty);
    }
    let one = int(&mut condition, 1);
    let holds = condition.builtin(intrinsic(">", "a: int"), &[n, one]);
    condition.output("holds", holds);
    let mut called = Builder::new("collatz");
    let n = called.input("n", Type::INT);
    let (zero, nothing, most) = (int(&mut called, 0), number(&mut called, 0.0), int(&mut called, 200));
    let (body_id, condition_id) = (FunctionId(0), Some(FunctionId(1)));
    let starts = vec![n, zero, n, nothing];
    let fold =
        Fold { body: body_id, condition: condition_id, starts, steps: most, most: 200, captures: vec![] };
    let results = called.fold(fold);
    for (name, result) in ["count", "peak", "weighed"].into_iter().zip(&results[1..]) {
        called.output(name, *result);
    }
    let called = called.finish();
    let mut b = Builder::new("test");
    let (_, [x, y]) = place(&mut b);
    let (one, sixteen) = (int(&mut b, 1), int(&mut b, 16));
    let row = ints(&mut b, "*", y, sixteen);
    let n = ints(&mut b, "+", x, row);
    let n = ints(&mut b, "+", n, one);
    let results = b.call(FunctionId(2), &called, vec![n]);
    let [count, peak] = [0, 1].map(|i| b.to_float(results[i]));
    let entry = finish(b, [count, peak, results[2]]);
    let wgsl = "
        struct Params { scale: vec2<f32>, pad: vec2<f32> }
        @group(0) @binding(0) var<uniform> params: Params;
        @fragment fn main(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
            let cell = vec2<i32>(floor(uv * 16.0));
            var n = cell.x + 16 * cell.y + 1;
            var count = 0;
            var peak = n;
            var weighed = 0.0;
            for (var s = 0; s < 200; s++) {
                if n <= 1 { break; }
                n = select(3 * n + 1, n / 2, n % 2 == 0);
                count += 1;
                peak = max(peak, n);
                weighed += params.scale.x;
            }
            return vec4<f32>(f32(count), f32(peak), weighed, 1.0);
        }";
    program(graph(vec![body.finish(), condition.finish(), called, entry]), wgsl)
}

/// A fold in a fold: `total = (3 total + 7 x + 5 y + cell.x) % 101` for x in 0..y + 2, while it is
/// not `cell.y`, for y in 0..5; and how often that was.
pub fn nested() -> Program {
    let mut inner = Builder::new("inner");
    let [total, count, x, y, cell_x, _] =
        ["total", "count", "x", "y", "cell_x", "stop"].map(|name| inner.input(name, Type::INT));
    let [one, three, five, seven, prime] = [1, 3, 5, 7, 101].map(|i| int(&mut inner, i));
    let terms = [(total, three), (x, seven), (y, five), (cell_x, one)];
    let terms = terms.map(|(value, factor)| ints(&mut inner, "*", value, factor));
    let sum = terms[1..].iter().fold(terms[0], |sum, term| ints(&mut inner, "+", sum, *term));
    let next = ints(&mut inner, "%", sum, prime);
    let counted = ints(&mut inner, "+", count, one);
    inner.output("total", next);
    inner.output("count", counted);
    let mut condition = Builder::new("condition");
    let [total, _, _, _, stop] =
        ["total", "count", "y", "cell_x", "stop"].map(|name| condition.input(name, Type::INT));
    let goes_on = ints(&mut condition, "!=", total, stop);
    condition.output("goes_on", goes_on);
    let mut outer = Builder::new("outer");
    let [total, count, y, cell_x, stop] =
        ["total", "count", "y", "cell_x", "stop"].map(|name| outer.input(name, Type::INT));
    let two = int(&mut outer, 2);
    let steps = ints(&mut outer, "+", y, two);
    let fold = Fold {
        body: FunctionId(0),
        condition: Some(FunctionId(1)),
        starts: vec![total, count],
        steps,
        most: 6,
        captures: vec![y, cell_x, stop],
    };
    let results = outer.fold(fold);
    outer.output("total", results[0]);
    outer.output("count", results[1]);
    let mut b = Builder::new("test");
    let (_, [x, y]) = place(&mut b);
    let (zero, five) = (int(&mut b, 0), int(&mut b, 5));
    let fold = Fold {
        body: FunctionId(2),
        condition: None,
        starts: vec![x, zero],
        steps: five,
        most: 5,
        captures: vec![x, y],
    };
    let results = b.fold(fold);
    let [total, count] = [0, 1].map(|i| b.to_float(results[i]));
    let nothing = number(&mut b, 0.0);
    let entry = finish(b, [total, count, nothing]);
    let wgsl = "
        @fragment fn main(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
            let cell = vec2<i32>(floor(uv * 16.0));
            var total = cell.x;
            var count = 0;
            for (var y = 0; y < 5; y++) {
                for (var x = 0; x < y + 2; x++) {
                    if total == cell.y { break; }
                    total = (3 * total + 7 * x + 5 * y + cell.x) % 101;
                    count += 1;
                }
            }
            return vec4<f32>(f32(total), f32(count), 0.0, 1.0);
        }";
    program(graph(vec![inner.finish(), condition.finish(), outer.finish(), entry]), wgsl)
}

/// Samples a picture at `uv + step / 16`, the view and the gradient captured, while a map, which the
/// condition reads by itself, is 0 at `cell.x + step`.
pub fn gathered(folder: &Path, picture: &str) -> (Program, Tables) {
    let sampled = Type::View(View { dimension: ViewDimension::D2, texel: Texel::Sampled, anisotropy: 1 });
    let integers = Type::View(View { dimension: ViewDimension::D2, texel: Texel::Integer, anisotropy: 1 });
    let mut body = Builder::new("tap");
    let sum = body.input("sum", VEC4);
    let count = body.input("count", Type::INT);
    let step = body.input("step", Type::INT);
    let view = body.input("view", sampled);
    let [uv, dx, dy] = ["uv", "dx", "dy"].map(|name| body.input(name, VEC2));
    body.input("x", Type::INT);
    let sixteenth = number(&mut body, 1.0 / 16.0);
    let (along, one) = (body.to_float(step), int(&mut body, 1));
    let along = floats(&mut body, "*", along, sixteenth);
    let along = body.splat(along, 2);
    let at = floats(&mut body, "+", uv, along);
    let tap = body.sample(view, at, None, Level::Gradient(dx, dy));
    let sum = floats(&mut body, "+", sum, tap);
    let count = ints(&mut body, "+", count, one);
    body.output("sum", sum);
    body.output("count", count);
    let mut condition = Builder::new("goes_on");
    condition.input("sum", VEC4);
    let count = condition.input("count", Type::INT);
    condition.input("view", sampled);
    for name in ["uv", "dx", "dy"] {
        condition.input(name, VEC2);
    }
    let x = condition.input("x", Type::INT);
    let map = condition.push(Operation::View(ViewId(1)), integers);
    let zero = int(&mut condition, 0);
    let at = ints(&mut condition, "+", count, x);
    let at = condition.compose(&[at, zero]);
    let texel = condition.texel(map, at, None);
    let found = condition.extract(texel, 0);
    let is_free = ints(&mut condition, "==", found, zero);
    condition.output("is_free", is_free);
    let mut b = Builder::new("test");
    let (uv, [x, _]) = place(&mut b);
    let view = b.push(Operation::View(ViewId(0)), sampled);
    let [dx, dy] =
        [Axis::X, Axis::Y].map(|axis| b.push(Operation::Derivative(uv, axis, Sampled::Constant), VEC2));
    let (start, zero, nine) = (b.constant(Constant::floats(&[0.0; 4])), int(&mut b, 0), int(&mut b, 9));
    let fold = Fold {
        body: FunctionId(0),
        condition: Some(FunctionId(1)),
        starts: vec![start, zero],
        steps: nine,
        most: 9,
        captures: vec![view, uv, dx, dy, x],
    };
    let results = b.fold(fold);
    let part = b.constant(Constant::floats(&[1.0 / 9.0; 4]));
    let color = floats(&mut b, "*", results[0], part);
    b.output("color", color);
    let wgsl = "
        @group(0) @binding(1) var t0_: texture_2d<f32>;
        @group(0) @binding(2) var s0_: sampler;
        @group(0) @binding(3) var t1_: texture_2d<i32>;
        @fragment fn main(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
            let dx = dpdx(uv);
            let dy = dpdy(uv);
            let x = i32(floor(uv.x * 16.0));
            var sum = vec4<f32>(0.0);
            for (var s = 0; s < 9; s++) {
                if textureLoad(t1_, vec2<i32>(s + x, 0), 0).x != 0 { break; }
                sum += textureSampleGrad(t0_, s0_, uv + f32(s) / 16.0, dx, dy);
            }
            return sum / 9.0;
        }";
    let mut program = program(graph(vec![body.finish(), condition.finish(), b.finish()]), wgsl);
    let picture = Recipe::Image {
        path: picture.into(),
        encoding: texgraph_compiler::manifest::Encoding::Linear,
        tileable: Tileable::None,
    };
    let row = (0..32).map(|i| i32::from(i % 7 == 6)).collect();
    let map = Recipe::Indices { source: IndicesSource::Rows(vec![row]), levels: 2 };
    let resources = (0..).zip([picture, map]);
    let resources = resources.map(|(n, recipe)| resource(recipe, n, Wrap::Repeat, Filter::Linear)).collect();
    set_resources(&mut program, resources);
    let tables = load(&mut program, &project(folder)).expect("the resources load");
    (program, tables)
}

/// `x + 1`, so often that no one can wait for it: each function calls the one before twice.
pub fn endless() -> Vec<Function> {
    let mut functions: Vec<Function> = Vec::new();
    for id in 0..40 {
        let mut b = Builder::new("f");
        let mut x = b.input("x", Type::FLOAT);
        for _ in 0..2 {
            x = match functions.last() {
                Some(last) => b.call(FunctionId(id - 1), last, vec![x])[0],
                None => {
                    let one = number(&mut b, 1.0);
                    floats(&mut b, "+", x, one)
                }
            };
        }
        b.output("y", x);
        functions.push(b.finish());
    }
    functions
}
