//! Graphs made by hand, counted by hand.

use super::count::{Count, entry};
use super::{cost, known};
use crate::graph::{
    Builder, Constant, Fold, Function, FunctionId, Graph, Level, Operation, Param, ParamId, Texel, Type,
    Value, View, ViewDimension, ViewId,
};
use crate::intrinsic::{ADD, ADD_INT, LESS};
use crate::{Library, Options, compile};
use std::collections::HashMap;

/// A function in the making, with an input `x` and a picture.
struct Test {
    b: Builder,
    x: Value,
    picture: Value,
}

impl Test {
    fn new(name: &str) -> Test {
        let mut b = Builder::new(name);
        let x = b.input("x", Type::FLOAT);
        let view = View { dimension: ViewDimension::D2, texel: Texel::Sampled, anisotropy: 1 };
        let picture = b.push(Operation::View(ViewId(0)), Type::View(view));
        Test { b, x, picture }
    }

    fn number(&mut self, number: f32) -> Value {
        self.b.constant(Constant::floats(&[number]))
    }

    /// `x + n`: one sum.
    fn sum(&mut self, n: f32) -> Value {
        let n = self.number(n);
        self.b.builtin(ADD, &[self.x, n])
    }

    /// A sample at a place that nothing else samples.
    fn sample(&mut self, n: f32) -> Value {
        let at = self.number(n);
        let at = self.b.compose(&[self.x, at]);
        let level = self.number(0.0);
        let color = self.b.sample(self.picture, at, None, Level::Level(level));
        self.b.extract(color, 0)
    }

    /// A fetch at a place that nothing else fetches.
    fn fetch(&mut self, n: i32) -> Value {
        let at = self.b.constant(Constant::ints(&[n, n]));
        let texel = self.b.texel(self.picture, at, None);
        self.b.extract(texel, 0)
    }

    fn param(&mut self, i: u32, ty: Type) -> Value {
        self.b.push(Operation::Param(ParamId(i)), ty)
    }

    fn less(&mut self, a: Value, b: Value) -> Value {
        self.b.builtin(LESS, &[a, b])
    }

    fn done(self, outputs: &[Value]) -> Function {
        let mut b = self.b;
        outputs.iter().for_each(|value| b.output("out", *value));
        b.finish()
    }
}

fn param(name: &str, default: Constant) -> Param {
    Param { name: name.to_owned(), label: String::new(), ty: default.ty(), default, range: None }
}

fn count(functions: Vec<Function>, params: Vec<Param>) -> Count {
    let graph = Graph { functions, params, ..Graph::default() };
    entry(&graph, &known::at_defaults(&graph))
}

/// Samples in the worst and in the typical case.
fn samples(count: &Count) -> (f64, f64) {
    (count.worst.samples, count.typical.samples)
}

/// The body of a fold over one accumulator that adds a sample: with `captures` more inputs.
fn sampling_body(captures: usize) -> Function {
    let mut b = Builder::new("body");
    let sum = b.input("sum", Type::FLOAT);
    b.input("i", Type::INT);
    for i in 0..captures {
        b.input(format!("c{i}"), Type::FLOAT);
    }
    let view = View { dimension: ViewDimension::D2, texel: Texel::Sampled, anisotropy: 1 };
    let picture = b.push(Operation::View(ViewId(0)), Type::View(view));
    let level = b.constant(Constant::floats(&[0.0]));
    let at = b.compose(&[sum, sum]);
    let color = b.sample(picture, at, None, Level::Level(level));
    let red = b.extract(color, 0);
    let next = b.builtin(ADD, &[sum, red]);
    b.output("sum", next);
    b.finish()
}

/// (sum) → sum < 1
fn condition() -> Function {
    let mut b = Builder::new("condition");
    let sum = b.input("sum", Type::FLOAT);
    let one = b.constant(Constant::floats(&[1.0]));
    let less = b.builtin(LESS, &[sum, one]);
    b.output("less", less);
    b.finish()
}

fn fold(steps: Value, most: u32, start: Value, condition: Option<FunctionId>) -> Fold {
    Fold { body: FunctionId(0), condition, starts: vec![start], steps, most, captures: Vec::new() }
}

#[test]
fn what_nobody_needs_is_not_counted() {
    let mut t = Test::new("t");
    let sum = t.sum(1.0);
    t.sample(0.5);
    let count = count(vec![t.done(&[sum])], vec![]);
    assert_eq!((samples(&count), count.worst.arithmetic.add), ((0.0, 0.0), 1.0));
}

#[test]
fn a_fold_takes_its_bound_and_at_defaults_its_steps() {
    let mut t = Test::new("t");
    let count_param = t.param(0, Type::INT);
    let two = t.b.constant(Constant::ints(&[2]));
    let steps = t.b.builtin(ADD_INT, &[count_param, two]);
    let out = t.b.fold(fold(steps, 20, t.x, None))[0];
    let functions = vec![sampling_body(0), t.done(&[out])];
    let of = |default: i32| count(functions.clone(), vec![param("n", Constant::ints(&[default]))]);
    assert_eq!(samples(&of(5)), (20.0, 7.0));
    assert_eq!(samples(&of(500)), (20.0, 20.0));
    assert_eq!(samples(&of(-9)), (20.0, 0.0));
    assert_eq!(of(5).worst.arithmetic.add, 20.0);
    assert_eq!(of(5).typical.arithmetic.integer, 1.0);
}

#[test]
fn a_while_takes_half_and_its_test_counts() {
    let mut t = Test::new("t");
    let steps = t.b.constant(Constant::ints(&[8]));
    let out = t.b.fold(fold(steps, 20, t.x, Some(FunctionId(1))))[0];
    let count = count(vec![sampling_body(0), condition(), t.done(&[out])], vec![]);
    assert_eq!(samples(&count), (8.0, 4.0));
    assert_eq!((count.worst.arithmetic.compare, count.typical.arithmetic.compare), (8.0, 4.0));
}

#[test]
fn an_unknown_number_of_steps_is_the_bound() {
    let mut t = Test::new("t");
    let steps = t.b.to_int(t.x);
    let out = t.b.fold(fold(steps, 6, t.x, None))[0];
    assert_eq!(samples(&count(vec![sampling_body(0), t.done(&[out])], vec![])), (6.0, 6.0));
}

#[test]
fn folds_inside_folds_multiply() {
    let mut middle = Builder::new("middle");
    let sum = middle.input("sum", Type::FLOAT);
    middle.input("i", Type::INT);
    let steps = middle.constant(Constant::ints(&[3]));
    let inner = middle.fold(fold(steps, 3, sum, None))[0];
    middle.output("sum", inner);
    let mut t = Test::new("t");
    let steps = t.b.constant(Constant::ints(&[5]));
    let out = t.b.fold(Fold { body: FunctionId(1), ..fold(steps, 5, t.x, None) })[0];
    let count = count(vec![sampling_body(0), middle.finish(), t.done(&[out])], vec![]);
    assert_eq!(samples(&count), (15.0, 15.0));
}

#[test]
fn a_branch_takes_its_dearer_arm_figure_by_figure() {
    let mut t = Test::new("t");
    let (a, b) = (t.sample(1.0), t.sample(2.0));
    let sampled = t.b.builtin(ADD, &[a, b]);
    let fetched = (1..=3).map(|i| t.fetch(i)).collect::<Vec<_>>();
    let fetched = fetched.into_iter().reduce(|a, b| t.b.builtin(ADD, &[a, b])).expect("three");
    let half = t.number(0.5);
    let c = t.less(t.x, half);
    let chosen = t.b.select(c, sampled, fetched);
    let count = count(vec![t.done(&[chosen])], vec![]);
    assert_eq!((count.worst.samples, count.worst.fetches, count.worst.reads), (2.0, 3.0, 3.0));
    assert_eq!((count.typical.samples, count.typical.fetches, count.typical.reads), (1.0, 1.5, 2.5));
    assert_eq!((count.worst.arithmetic.add, count.typical.arithmetic.add), (2.0, 1.5));
}

#[test]
fn a_choice_without_reads_computes_both_arms() {
    let mut t = Test::new("t");
    let (a, b, half) = (t.sum(1.0), t.sum(2.0), t.number(0.5));
    let c = t.less(t.x, half);
    let chosen = t.b.select(c, a, b);
    let count = count(vec![t.done(&[chosen])], vec![]);
    assert_eq!((count.worst.arithmetic.add, count.typical.arithmetic.add), (2.0, 2.0));
    assert_eq!(count.worst.arithmetic.compare, 2.0);
}

#[test]
fn defaults_decide_branches() {
    let mut t = Test::new("t");
    let (p, half) = (t.param(0, Type::FLOAT), t.number(0.5));
    let c = t.less(p, half);
    let (a, b, sum) = (t.sample(1.0), t.sample(2.0), t.sum(1.0));
    let near = t.b.builtin(ADD, &[a, b]);
    let chosen = t.b.select(c, near, sum);
    let functions = vec![t.done(&[chosen])];
    let of = |default: f32| count(functions.clone(), vec![param("p", Constant::floats(&[default]))]);
    assert_eq!(samples(&of(0.25)), (2.0, 2.0));
    assert_eq!(samples(&of(0.75)), (2.0, 0.0));
}

#[test]
fn defaults_reach_through_calls_as_far_as_callers_agree() {
    // node(x, far) = if far < 0.5 { sample } else { x }
    let mut node = Test::new("node");
    let far = node.b.input("far", Type::FLOAT);
    let half = node.number(0.5);
    let c = node.less(far, half);
    let sample = node.sample(1.0);
    let chosen = node.b.select(c, sample, node.x);
    let node = node.done(&[chosen]);
    let calls = |others: &[f32]| {
        let mut t = Test::new("t");
        let p = t.param(0, Type::FLOAT);
        let mut sum = t.b.call(FunctionId(0), &node, vec![t.x, p])[0];
        for other in others {
            let other = t.number(*other);
            let more = t.b.call(FunctionId(0), &node, vec![t.x, other])[0];
            sum = t.b.builtin(ADD, &[sum, more]);
        }
        count(vec![node.clone(), t.done(&[sum])], vec![param("p", Constant::floats(&[0.75]))])
    };
    assert_eq!(samples(&calls(&[])), (1.0, 0.0));
    assert_eq!(samples(&calls(&[0.25])), (2.0, 1.0), "callers differ: half for each");
}

#[test]
fn outputs_of_calls_are_known_where_their_inputs_are() {
    let mut add = Builder::new("add");
    let x = add.input("x", Type::INT);
    let one = add.constant(Constant::ints(&[1]));
    let y = add.builtin(ADD_INT, &[x, one]);
    add.output("y", y);
    let add = add.finish();
    let mut t = Test::new("t");
    let p = t.param(0, Type::INT);
    let steps = t.b.call(FunctionId(1), &add, vec![p])[0];
    let out = t.b.fold(fold(steps, 9, t.x, None))[0];
    let count = count(vec![sampling_body(0), add, t.done(&[out])], vec![param("p", Constant::ints(&[2]))]);
    assert_eq!(samples(&count), (9.0, 3.0));
}

#[test]
fn functions_that_double_each_other_stay_finite() {
    let mut t = Test::new("f0");
    let sample = t.sample(1.0);
    let mut functions = vec![t.done(&[sample])];
    for i in 1..2_000 {
        let mut b = Builder::new(format!("f{i}"));
        let x = b.input("x", Type::FLOAT);
        let once = b.call(FunctionId(i - 1), &functions[i as usize - 1], vec![x])[0];
        let twice = b.call(FunctionId(i - 1), &functions[i as usize - 1], vec![once])[0];
        b.output("y", twice);
        functions.push(b.finish());
    }
    assert_eq!(samples(&count(functions[..11].to_vec(), vec![])), (1024.0, 1024.0));
    assert_eq!(samples(&count(functions, vec![])), (1e15, 1e15));
}

#[test]
fn a_program_says_where_its_loops_are_written() {
    let text = "param n: int = 3 in 0..=9\nlet field = bake(wave, size: ivec2(16, 8))\nnode wave(at: vec2) -> (value: float) {\n    value = fold (s = 0.0) for i in 0..7 {\n        s = s + sin(at.x * float(i) + s)\n    }\n}\ntexture t(uv: vec2) -> (color: color) {\n    let sum = fold (s = 0.0) for i in 0..n max 9 while s < 1.0 {\n        s = s + field.sample(uv * float(i)).r\n    }\n    color = vec4(sum)\n}\n";
    let files = HashMap::from([("t.tex".to_owned(), text.to_owned())]);
    let library = Library::standard().expect("the library parses");
    let compiled = compile(&library, "t.tex", &files, &Options::default()).expect("it compiles");
    let cost = cost(&compiled);
    let [bake, texture] = cost.passes.as_slice() else { panic!("two passes: {cost:#?}") };
    assert_eq!((bake.name.as_str(), bake.texels, bake.textures), ("field", Some(128), 0));
    assert_eq!(bake.worst.arithmetic.transcendental, 7.0);
    assert_eq!((texture.texels, texture.textures, texture.samplers), (None, 1, 1));
    assert_eq!((texture.worst.samples, texture.typical.samples), (9.0, 1.5));
    let lines = |loops: &[super::Loop]| -> Vec<(u32, f64, String, usize)> {
        loops.iter().map(|l| (l.most, l.typical, l.file.clone(), l.line)).collect()
    };
    assert_eq!(lines(&bake.loops), [(7, 7.0, "t.tex".to_owned(), 4)]);
    assert_eq!(lines(&texture.loops), [(9, 1.5, "t.tex".to_owned(), 9)]);
    assert_eq!(cost.tables.len(), 1);
    assert_eq!((cost.tables[0].name.as_str(), cost.uniform_bytes), ("field.pixels", 16));
    assert_eq!(cost.table_bytes, cost.tables[0].bytes.expect("the size of a bake is known"));
}
