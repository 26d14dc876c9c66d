//! Graphs made by hand, lowered: branches, loops and tables as they stand in the shader.
//!
//! naga reads every text back. Where `TEXGRAPH_WGSL` names a folder, the texts are also written
//! there, for `tests/tint/check.mjs`.

use std::sync::Arc;
use texgraph_compiler::graph::{
    Builder, Constant, Fold, Function, FunctionId, Graph, Level, Operation, Param, ParamId, PassGraph,
    ResourceView, Scalar, Texel, Type, Value, View, ViewDimension, ViewId,
};
use texgraph_compiler::intrinsic::{ADD, ADD_INT, Intrinsic, LESS, MINIMUM_INT, MULTIPLY, SUBTRACT};
use texgraph_compiler::manifest::{Filter, Recipe, Wrap};
use texgraph_compiler::resource::{Resource, SamplerState};
use texgraph_compiler::{Options, contract, emit, lower};

const VEC2: Type = Type::Vector(Scalar::Float, 2);

/// A function in the making that can sample a picture.
struct Test {
    b: Builder,
}

impl Test {
    fn new(name: &str) -> Test {
        Test { b: Builder::new(name) }
    }

    /// The texture's own function, with its coordinate.
    fn entry() -> (Test, Value) {
        let mut test = Test::new("test");
        let uv = test.b.input("uv", VEC2);
        let x = test.b.extract(uv, 0);
        (test, x)
    }

    fn number(&mut self, number: f32) -> Value {
        self.b.constant(Constant::floats(&[number]))
    }

    fn int(&mut self, number: i32) -> Value {
        self.b.constant(Constant::ints(&[number]))
    }

    fn with(&mut self, intrinsic: Intrinsic, a: Value, number: f32) -> Value {
        let number = self.number(number);
        self.b.builtin(intrinsic, &[a, number])
    }

    /// The first component of a sample at (x, x).
    fn sample(&mut self, x: Value) -> Value {
        let view = View { dimension: ViewDimension::D2, texel: Texel::Sampled, anisotropy: 1 };
        let picture = self.b.push(Operation::View(ViewId(0)), Type::View(view));
        let at = self.b.compose(&[x, x]);
        let level = self.number(0.0);
        let color = self.b.sample(picture, at, None, Level::Level(level));
        self.b.extract(color, 0)
    }

    fn named(&mut self, name: &str, value: Value) -> Value {
        self.b.name(value, name);
        value
    }

    fn gives(mut self, outputs: &[(&str, Value)]) -> Function {
        outputs.iter().for_each(|(name, value)| self.b.output(*name, *value));
        self.b.finish()
    }
}

fn graph(functions: Vec<Function>) -> Graph {
    let view = View { dimension: ViewDimension::D2, texel: Texel::Sampled, anisotropy: 1 };
    let picture = Resource {
        name: "photo".into(),
        label: String::new(),
        place: Default::default(),
        recipe: Recipe::Permutation { size: 4, seed: 0 },
        sampler: Some(SamplerState { wrap: Wrap::Repeat, filter: Filter::Linear, anisotropy: 1 }),
        bake: None,
    };
    let one = Constant::floats(&[1.0]);
    let speed =
        Param { name: "speed".into(), label: String::new(), ty: Type::FLOAT, default: one, range: None };
    let count = Param { name: "count".into(), ty: Type::INT, default: Constant::ints(&[3]), ..speed.clone() };
    Graph {
        functions,
        params: vec![speed, count],
        resources: vec![picture],
        views: vec![ResourceView { resource: 0, field: "pixels", view }],
    }
}

/// The shader; the texture's own function stands without its head.
fn shader(name: &str, functions: Vec<Function>) -> String {
    let graphs = [PassGraph { graph: graph(functions), bake: None }];
    let manifest = contract::manifest(&graphs, "", &Options::default());
    let lowered =
        lower::lower(&graphs[0].graph, &contract::of_pass(&manifest, 0), &lower::Objects::default());
    let text = emit::wgsl(&lowered).unwrap_or_else(|error| panic!("{name}: {error}"));
    if let Ok(folder) = std::env::var("TEXGRAPH_WGSL") {
        std::fs::create_dir_all(&folder).expect("the folder is made");
        std::fs::write(format!("{folder}/{name}.wgsl"), &text).expect("the text is written");
    }
    let module = naga::front::wgsl::parse_str(&text)
        .unwrap_or_else(|error| panic!("{name}: {}\n{text}", error.emit_to_string(&text)));
    let flags = naga::valid::ValidationFlags::all();
    let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::empty());
    validator.validate(&module).unwrap_or_else(|error| panic!("{name}: {error:?}\n{text}"));
    text
}

/// What stands between the braces of a function of that name.
fn block<'t>(text: &'t str, name: &str) -> &'t str {
    let (_, from) = text.split_once(&format!("fn {name}(")).unwrap_or_else(|| panic!("no {name} in\n{text}"));
    let (_, from) = from.split_once("{\n").expect("a function has a block");
    from.split_once("\n}\n").expect("and it ends").0
}

fn lines(text: &str) -> String {
    let lines: Vec<&str> = text.lines().skip_while(|line| line.trim().is_empty()).collect();
    lines.join("\n")
}

#[track_caller]
fn assert_block(text: &str, wanted: &str) {
    assert_eq!(block(text, "test_texture"), lines(wanted).trim_end(), "\n{text}");
}

#[test]
fn choices_of_samples_share_a_branch() {
    let (mut t, x) = Test::entry();
    let condition = t.with(LESS, x, 0.5);
    let far = t.with(MULTIPLY, x, 8.0);
    let (sample, other) = (t.sample(far), t.with(ADD, x, 1.0));
    let color = t.b.select(condition, sample, other);
    t.named("height", color);
    let far = t.named("far", far);
    let second = t.b.select(condition, far, x);
    let sum = t.b.builtin(ADD, &[color, second]);
    let text = shader("branch", vec![t.gives(&[("sum", sum)])]);
    assert_block(
        &text,
        "
    var height: f32;
    var chosen: f32;

    if (uv.x < 0.5f) {
        let far = (uv.x * 8f);
        let sampled = textureSampleLevel(photo_pixels, photo_sampler, vec2(far), 0f);
        height = sampled.x;
        chosen = far;
    } else {
        height = (uv.x + 1f);
        chosen = uv.x;
    }
    return (height + chosen);
",
    );
}

#[test]
fn a_chain_of_choices_writes_one_variable() {
    let (mut t, x) = Test::entry();
    let mut chosen = t.number(0.0);
    for i in [3.0, 2.0, 1.0] {
        let (condition, far) = (t.with(LESS, x, i), t.with(MULTIPLY, x, i));
        let sample = t.sample(far);
        chosen = t.b.select(condition, sample, chosen);
    }
    t.named("pick", chosen);
    let text = shader("chain", vec![t.gives(&[("pick", chosen)])]);
    assert_eq!(text.matches("var ").count(), 3, "two globals and one variable\n{text}");
    assert_eq!(text.matches("pick = ").count(), 4);
    assert_eq!(text.matches("} else {").count(), 3);
}

#[test]
fn choices_deeper_than_shader_compilers_take_select() {
    let (mut t, x) = Test::entry();
    let mut chosen = t.number(0.0);
    for i in 0..200_u8 {
        let (condition, far) = (t.with(LESS, x, f32::from(i)), t.with(MULTIPLY, x, f32::from(i) + 2.0));
        let sample = t.sample(far);
        chosen = t.b.select(condition, sample, chosen);
    }
    let text = shader("deep_choices", vec![t.gives(&[("pick", chosen)])]);
    assert_eq!(text.matches("} else {").count(), 32);
    assert_eq!(text.matches("select(").count(), 200 - 32);
}

/// `sum += at · weight; weight *= 0.5`, the step's number unused; the capture is `at`.
fn halving() -> Function {
    let mut t = Test::new("halving");
    let sum = t.b.input("sum", Type::FLOAT);
    let weight = t.b.input("weight", Type::FLOAT);
    t.b.input("i", Type::INT);
    let at = t.b.input("at", Type::FLOAT);
    let part = t.b.builtin(MULTIPLY, &[at, weight]);
    let next_sum = t.b.builtin(ADD, &[sum, part]);
    let next_weight = t.with(MULTIPLY, weight, 0.5);
    t.named("sum", next_sum);
    t.named("weight", next_weight);
    t.gives(&[("sum", next_sum), ("weight", next_weight)])
}

#[test]
fn a_fold_is_a_loop_over_variables() {
    let mut condition = Test::new("enough");
    let sum = condition.b.input("sum", Type::FLOAT);
    let weight = condition.b.input("weight", Type::FLOAT);
    condition.b.input("at", Type::FLOAT);
    let low = condition.with(LESS, sum, 2.0);
    let _ = weight;
    let condition = condition.gives(&[("holds", low)]);
    let (mut t, x) = Test::entry();
    let count = t.b.push(Operation::Param(ParamId(1)), Type::INT);
    let starts = vec![t.number(0.0), t.number(1.0)];
    let at = t.with(ADD, x, 0.25);
    let fold = Fold {
        body: FunctionId(0),
        condition: Some(FunctionId(1)),
        starts,
        steps: count,
        most: 9,
        captures: vec![at],
    };
    let sum = t.b.fold(fold)[0];
    let text = shader("fold", vec![halving(), condition, t.gives(&[("sum", sum)])]);
    assert_block(
        &text,
        "
    let t = (uv.x + 0.25f);
    let steps = min(count, 9i);
    var sum = 0f;
    var weight = 1f;
    var i = 0i;
    loop {
        if (i >= steps) {
            break;
        }
        if !((sum < 2f)) {
            break;
        }
        sum = (sum + (t * weight));
        weight = (weight * 0.5f);
        continuing {
            i = (i + 1i);
        }
    }
    return sum;
",
    );
}

#[test]
fn next_values_read_the_previous_ones() {
    // Exchange, and a sum that reads what is exchanged.
    let mut t = Test::new("exchange");
    let inputs = ["a", "b", "sum"].map(|name| t.b.input(name, Type::FLOAT));
    t.b.input("i", Type::INT);
    let sum = t.b.builtin(ADD, &[inputs[2], inputs[0]]);
    let body = t.gives(&[("a", inputs[1]), ("b", inputs[0]), ("sum", sum)]);
    let (mut t, x) = Test::entry();
    let starts = vec![x, t.number(1.0), t.number(0.0)];
    let steps = t.int(5);
    let fold = Fold { body: FunctionId(0), condition: None, starts, steps, most: 5, captures: Vec::new() };
    let out = t.b.fold(fold);
    let color = t.b.compose(&out);
    let text = shader("exchange", vec![body, t.gives(&[("color", color)])]);
    let inner = block(&text, "test_texture");
    let wanted = "
        let next_sum = (sum + a);
        let next_b = a;
        a = b;
        b = next_b;
        sum = next_sum;
        continuing {";
    assert!(inner.contains(wanted), "{text}");
}

#[test]
fn bounds_that_are_known_are_not_tested_again() {
    let fold = |steps: Value, t: &mut Test| Fold {
        body: FunctionId(0),
        condition: None,
        starts: vec![t.number(0.0), t.number(1.0)],
        steps,
        most: 8,
        captures: vec![t.number(0.5)],
    };
    let (mut t, _) = Test::entry();
    let count = t.b.push(Operation::Param(ParamId(1)), Type::INT);
    let eight = t.int(8);
    let bounded = t.b.builtin(MINIMUM_INT, &[count, eight]);
    let fold_of_bounded = fold(bounded, &mut t);
    let sum = t.b.fold(fold_of_bounded)[0];
    let text = shader("bounded", vec![halving(), t.gives(&[("sum", sum)])]);
    assert_eq!(text.matches("min(").count(), 1, "{text}");
    for (steps, written) in [(3, "3i"), (900, "8i")] {
        let (mut t, _) = Test::entry();
        let steps = t.int(steps);
        let fold = fold(steps, &mut t);
        let sum = t.b.fold(fold)[0];
        let text = shader(&format!("steps_{written}"), vec![halving(), t.gives(&[("sum", sum)])]);
        assert!(text.contains(&format!("if (i >= {written}) {{")), "{text}");
    }
}

#[test]
fn steps_may_branch_sample_read_params_and_fold_again() {
    let mut inner = Test::new("inner");
    let sum = inner.b.input("sum", Type::FLOAT);
    inner.b.input("j", Type::INT);
    let at = inner.b.input("at", Type::FLOAT);
    let speed = inner.b.push(Operation::Param(ParamId(0)), Type::FLOAT);
    let (wide, condition) = (inner.b.builtin(MULTIPLY, &[at, speed]), inner.with(LESS, sum, 0.5));
    let sample = inner.sample(wide);
    let (more, less) = (inner.b.builtin(ADD, &[sum, sample]), inner.with(ADD, sum, 0.125));
    let next = inner.b.select(condition, more, less);
    let inner = inner.gives(&[("sum", next)]);
    let mut outer = Test::new("outer");
    let total = outer.b.input("total", Type::FLOAT);
    let i = outer.b.input("i", Type::INT);
    let x = outer.b.input("x", Type::FLOAT);
    let number = outer.b.to_float(i);
    let at = outer.b.builtin(ADD, &[x, number]);
    let zero = outer.number(0.0);
    let fold = Fold {
        body: FunctionId(0),
        condition: None,
        starts: vec![zero],
        steps: i,
        most: 3,
        captures: vec![at],
    };
    let sum = outer.b.fold(fold)[0];
    let next = outer.b.builtin(ADD, &[total, sum]);
    let outer = outer.gives(&[("total", next)]);
    let (mut t, x) = Test::entry();
    let four = t.int(4);
    let fold = Fold {
        body: FunctionId(1),
        condition: None,
        starts: vec![x],
        steps: four,
        most: 4,
        captures: vec![x],
    };
    let total = t.b.fold(fold)[0];
    let text = shader("nested", vec![inner, outer, t.gives(&[("total", total)])]);
    assert_eq!(text.matches("fn ").count(), 2, "steps stand in place\n{text}");
    assert_block(
        &text,
        "
    var chosen: f32;

    var total = uv.x;
    var i = 0i;
    loop {
        if (i >= 4i) {
            break;
        }
        let t = (uv.x + f32(i));
        let steps = min(i, 3i);
        var sum = 0f;
        var j = 0i;
        loop {
            if (j >= steps) {
                break;
            }
            if (sum < 0.5f) {
                let sampled = textureSampleLevel(photo_pixels, photo_sampler, vec2((t * speed)), 0f);
                chosen = (sum + sampled.x);
            } else {
                chosen = (sum + 0.125f);
            }
            sum = chosen;
            continuing {
                j = (j + 1i);
            }
        }
        total = (total + sum);
        continuing {
            i = (i + 1i);
        }
    }
    return total;
",
    );
}

#[test]
fn what_a_loop_reads_from_outside_is_computed_once() {
    let (mut t, x) = Test::entry();
    let more = t.with(ADD, x, 0.25);
    let (squared, steps) = (t.b.builtin(MULTIPLY, &[more, more]), t.b.to_int(x));
    let nine = t.int(9);
    let steps = t.b.builtin(MINIMUM_INT, &[steps, nine]);
    let starts = vec![t.number(0.0), t.number(1.0)];
    let fold = Fold { body: FunctionId(0), condition: None, starts, steps, most: 9, captures: vec![squared] };
    let sum = t.b.fold(fold)[0];
    let text = shader("captures", vec![halving(), t.gives(&[("sum", sum)])]);
    let (before, inside) = text.split_once("loop {").expect("a loop");
    assert!(before.contains("min(") && before.contains(" * "), "{text}");
    assert!(!inside.contains("min(") && !inside.contains("i32("), "{text}");
}

/// Folds inside each other, each of two steps, the innermost adding a capture.
fn tower(height: u32) -> Vec<Function> {
    let mut functions = Vec::new();
    for level in 0..height {
        let mut t = Test::new(&format!("level{level}"));
        let sum = t.b.input("sum", Type::FLOAT);
        t.b.input("i", Type::INT);
        let x = t.b.input("x", Type::FLOAT);
        let next = if level == 0 {
            t.b.builtin(ADD, &[sum, x])
        } else {
            let steps = t.int(2);
            let fold = Fold {
                body: FunctionId(level - 1),
                condition: None,
                starts: vec![sum],
                steps,
                most: 2,
                captures: vec![x],
            };
            t.b.fold(fold)[0]
        };
        functions.push(t.gives(&[("sum", next)]));
    }
    functions
}

#[test]
fn folds_of_any_depth_nest_as_deep_as_shader_compilers_take() {
    let indent = |line: &str| line.len() - line.trim_start().len();
    for height in [1, 15, 16, 40, 500] {
        let mut functions = tower(height);
        let (mut t, x) = Test::entry();
        let (steps, zero) = (t.int(2), t.number(0.0));
        let fold = Fold {
            body: FunctionId(height - 1),
            condition: None,
            starts: vec![zero],
            steps,
            most: 2,
            captures: vec![x],
        };
        let sum = t.b.fold(fold)[0];
        functions.push(t.gives(&[("sum", sum)]));
        let text = shader(&format!("tower_{height}"), functions);
        assert_eq!(text.matches("loop {").count(), height as usize);
        let deepest = text.lines().map(|line| indent(line) / 4).max();
        assert!(deepest.is_some_and(|deepest| deepest <= 33), "{deepest:?}");
    }
}

#[test]
fn a_fold_in_the_deepest_arm_nests_no_deeper_than_the_limit() {
    let mut functions = tower(12);
    let (mut t, x) = Test::entry();
    let mut chosen = t.number(0.0);
    for i in 0..60_u8 {
        let (condition, start) = (t.with(LESS, x, f32::from(i)), t.with(SUBTRACT, x, f32::from(i)));
        let steps = t.int(2);
        let fold = Fold {
            body: FunctionId(11),
            condition: None,
            starts: vec![start],
            steps,
            most: 2,
            captures: vec![x],
        };
        let sum = t.b.fold(fold)[0];
        chosen = t.b.select(condition, sum, chosen);
    }
    functions.push(t.gives(&[("sum", chosen)]));
    let text = shader("folds_in_arms", functions);
    let deepest = text.lines().map(|line| (line.len() - line.trim_start().len()) / 4).max();
    assert_eq!(deepest, Some(33), "32 blocks inside the function's own");
}

fn table(entries: usize) -> Arc<[Constant]> {
    (0..entries).map(|i| Constant::floats(&[i as f32, 0.5, -(i as f32)])).collect()
}

#[test]
fn long_tables_are_arrays_and_short_ones_choices() {
    let (mut t, x) = Test::entry();
    let index = t.b.to_int(x);
    let one = t.int(1);
    let next = t.b.builtin(ADD_INT, &[index, one]);
    let long = t.b.lookup(table(2047), index);
    let again = t.b.lookup(table(2047), next);
    let short = t.b.lookup(table(4), index);
    let bools: Arc<[Constant]> = (0..6).map(|i| Constant::bools(&[i % 2 == 0])).collect();
    let ints: Arc<[Constant]> = (0..6).map(|i| Constant::ints(&[i, i])).collect();
    let odd = t.b.lookup(bools, index);
    let pair = t.b.lookup(ints, index);
    let pair = t.b.to_float(pair);
    let pair = t.b.extract(pair, 0);
    let sum = t.b.builtin(ADD, &[long, again]);
    let sum = t.b.select(odd, sum, short);
    let text = shader("tables", vec![t.gives(&[("emission", sum), ("height", pair)])]);
    assert_eq!(text.matches("array<").count(), 6, "three arrays, each with its type twice\n");
    assert_eq!(text.matches("test_table[clamp(").count(), 2);
    assert_eq!(block(&text, "test_texture").matches("select(").count(), 4);
}

#[test]
fn what_a_draw_shares_stands_first() {
    let (mut t, x) = Test::entry();
    let wide = t.with(MULTIPLY, x, 3.0);
    t.named("wide", wide);
    let time = t.b.input("time", Type::FLOAT);
    let speed = t.b.push(Operation::Param(ParamId(0)), Type::FLOAT);
    let phase = t.b.builtin(MULTIPLY, &[time, speed]);
    t.named("phase", phase);
    let far = t.b.builtin(ADD, &[wide, phase]);
    let condition = t.with(LESS, x, 0.5);
    let sample = t.sample(far);
    let chosen = t.b.select(condition, sample, wide);
    let text = shader("draw_first", vec![t.gives(&[("height", chosen)])]);
    let block = block(&text, "test_texture");
    let at = |line: &str| block.find(line).unwrap_or_else(|| panic!("no {line} in\n{block}"));
    let order = ["let phase = ", "let wide = ", "if (", "textureSampleLevel"].map(at);
    assert!(order.is_sorted(), "{block}");
}
