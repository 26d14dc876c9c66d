//! Passes over graphs made by hand: what they change, and that the values stay the same.

use texgraph_compiler::graph::evaluate::evaluate;
use texgraph_compiler::graph::{
    Axis, Builder, Constant, Fold, Function, FunctionId, Graph, Level, Operation, Param, ParamId, Sampled,
    Scalar, Slot, Texel, Type, Value, View, ViewDimension, ViewId,
};
use texgraph_compiler::intrinsic::{
    ADD, ADD_INT, COS, DIVIDE, EXP, LESS, LESS_INT, MULTIPLY, MULTIPLY_INT, SIN, SUBTRACT, TO_FLOAT,
};
use texgraph_compiler::manifest::Gradients;
use texgraph_compiler::pass::{Finished, differentiate, hoist, inline, remove_dead, run};

const FLOAT: Type = Type::FLOAT;
const INT: Type = Type::INT;
const VEC2: Type = Type::Vector(Scalar::Float, 2);

/// A function from its name, its inputs and what makes its outputs.
fn function(
    name: &str,
    inputs: &[(&str, Type)],
    make: impl FnOnce(&mut Builder, &[Value]) -> Vec<Value>,
) -> Function {
    let mut b = Builder::new(name);
    let inputs: Vec<Value> = inputs.iter().map(|(name, ty)| b.input(*name, *ty)).collect();
    for (i, value) in make(&mut b, &inputs).into_iter().enumerate() {
        b.output(format!("out_{}", char::from(b'a' + i as u8 % 26)), value);
    }
    b.finish()
}

fn graph(functions: Vec<Function>) -> Graph {
    let param = |name: &str, default: f32| Param {
        name: name.to_owned(),
        label: String::new(),
        ty: FLOAT,
        default: Constant::floats(&[default]),
        range: None,
    };
    Graph { functions, params: vec![param("scale", 1.75), param("twist", 0.6)], ..Graph::default() }
}

fn float(b: &mut Builder, x: f32) -> Value {
    b.constant(Constant::floats(&[x]))
}

fn int(b: &mut Builder, i: i32) -> Value {
    b.constant(Constant::ints(&[i]))
}

fn param(b: &mut Builder, i: u32) -> Value {
    b.push(Operation::Param(ParamId(i)), FLOAT)
}

fn fold(body: u32, starts: &[Value], steps: Value, captures: &[Value]) -> Fold {
    Fold {
        body: FunctionId(body),
        condition: None,
        starts: starts.to_vec(),
        steps,
        most: 64,
        captures: captures.to_vec(),
    }
}

/// The graph with numbers for params, and with inputs for what the screen says of inputs (named
/// as a further function would name them: `uv_dx`).
fn closed(mut graph: Graph) -> Graph {
    for function in &mut graph.functions {
        for v in 0..function.values.len() {
            match function.values[v] {
                Operation::Param(id) => {
                    function.values[v] = Operation::Constant(graph.params[id.0 as usize].default);
                }
                Operation::Derivative(of, axis, _) => {
                    let Operation::Input(i) = *function.operation(of) else { panic!("it is of an input") };
                    let name = format!("{}_d{axis:?}", function.inputs[i as usize].name).to_lowercase();
                    function.values[v] = Operation::Input(function.inputs.len() as u32);
                    function.inputs.push(Slot { name: name.into(), ty: function.types[v] });
                }
                _ => {}
            }
        }
    }
    graph
}

/// The outputs of a graph for inputs by name.
fn outputs(graph: &Graph, inputs: &[(&str, Constant)]) -> Vec<Constant> {
    let closed = closed(graph.clone());
    let entry = closed.function(closed.entry());
    let known = |slot: &Slot| inputs.iter().find(|(name, _)| *name == slot.name).map(|(_, c)| *c);
    let arguments: Vec<Constant> = entry
        .inputs
        .iter()
        .map(|slot| known(slot).unwrap_or_else(|| panic!("{} is given", slot.name)))
        .collect();
    evaluate(&closed.functions, closed.entry(), &arguments, &mut 10_000_000).expect("it is constant")
}

fn at(u: f32, v: f32) -> Vec<(&'static str, Constant)> {
    vec![("uv", Constant::floats(&[u, v])), ("time", Constant::floats(&[0.4]))]
}

fn folds(function: &Function) -> Vec<&Fold> {
    function
        .values
        .iter()
        .filter_map(|operation| match operation {
            Operation::Fold(fold) => Some(&**fold),
            _ => None,
        })
        .collect()
}

fn named<'g>(graph: &'g Graph, name: &str) -> &'g Function {
    graph.functions.iter().find(|f| f.name == name).unwrap_or_else(|| panic!("{name} is there"))
}

fn count(function: &Function, is: impl Fn(&Operation) -> bool) -> usize {
    function.values.iter().filter(|operation| is(operation)).count()
}

fn has(function: &Function, intrinsic: texgraph_compiler::intrinsic::Intrinsic) -> bool {
    count(function, |operation| matches!(operation, Operation::Builtin(i, _) if *i == intrinsic)) > 0
}

/// The entry's numbers, each with its derivatives as the last outputs.
fn with_derivatives(b: &mut Builder, values: Vec<Value>) -> Vec<Value> {
    let mut all = values.clone();
    for value in values {
        let ty = b.ty(value);
        for axis in [Axis::X, Axis::Y] {
            all.push(b.push(Operation::Derivative(value, axis, Sampled::Constant), ty));
        }
    }
    all
}

/// Checks that the derivatives behind the first outputs are what the outputs' differences say.
fn derivatives_are_differences(before: Graph, (u, v): (f32, f32)) {
    let after = differentiate::run(before, &Finished::default(), true);
    let screen = [[0.7, -0.2], [0.3, 1.1]];
    let numbers = |u: f32, v: f32| -> Vec<Constant> {
        let mut inputs = at(u, v);
        inputs.push(("uv_dx", Constant::floats(&screen[0])));
        inputs.push(("uv_dy", Constant::floats(&screen[1])));
        outputs(&after, &inputs)
    };
    let here = numbers(u, v);
    let values = here.len() / 3;
    assert!(values > 0);
    for (axis, [du, dv]) in screen.into_iter().enumerate() {
        let difference = |step: f32, i: usize, c: usize| {
            let left = numbers(u - step * du, v - step * dv)[i].float(c);
            (numbers(u + step * du, v + step * dv)[i].float(c) - left) / (2.0 * step)
        };
        for i in 0..values {
            let given = here[values + 2 * i + axis];
            for c in 0..usize::from(given.width()) {
                // Richardson's extrapolation: what is left is of fourth order.
                let (coarse, fine) = (difference(1.0 / 128.0, i, c), difference(1.0 / 256.0, i, c));
                let difference = (4.0 * fine - coarse) / 3.0;
                let given = given.float(c);
                assert!(difference.abs() > 1e-3, "output {i} changes");
                let tolerance = 1e-3 * difference.abs().max(1.0);
                assert!((given - difference).abs() < tolerance, "output {i}: {given} for {difference}");
            }
        }
    }
}

/// (place, total, count, step, warp) → (place·1.2 + sin(warp)·step, total + sin(x)·y, count + 1)
fn wave() -> Function {
    let inputs = [("place", VEC2), ("total", FLOAT), ("count", INT), ("step", INT), ("warp", FLOAT)];
    function("wave", &inputs, |b, v| {
        let (x, y) = (b.extract(v[0], 0), b.extract(v[0], 1));
        let sine = b.builtin(SIN, &[x]);
        let part = b.builtin(MULTIPLY, &[sine, y]);
        let total = b.builtin(ADD, &[v[1], part]);
        let (growth, step) = (float(b, 1.2), b.builtin(TO_FLOAT, &[v[3]]));
        let shift = b.builtin(SIN, &[v[4]]);
        let shift = b.builtin(MULTIPLY, &[shift, step]);
        let (growth, shift) = (b.splat(growth, 2), b.splat(shift, 2));
        let grown = b.builtin(MULTIPLY, &[v[0], growth]);
        let place = b.builtin(ADD, &[grown, shift]);
        let one = int(b, 1);
        let count = b.builtin(ADD_INT, &[v[2], one]);
        vec![place, total, count]
    })
}

/// Folds `body`, laid out as [`wave`], from (uv, 0, 0), warped by uv.y.
fn waving(b: &mut Builder, uv: Value, steps: i32, condition: Option<u32>) -> Vec<Value> {
    let (zero, none, steps) = (float(b, 0.0), int(b, 0), int(b, steps));
    let warp = b.extract(uv, 1);
    let fold = fold(0, &[uv, zero, none], steps, &[warp]);
    b.fold(Fold { condition: condition.map(FunctionId), ..fold })
}

#[test]
fn tangents_go_through_folds() {
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let all = waving(b, v[0], 6, None);
        with_derivatives(b, all[..2].to_vec())
    });
    derivatives_are_differences(graph(vec![wave(), entry]), (0.31, 0.62));
}

#[test]
fn only_accumulators_that_need_a_tangent_carry_one() {
    // The place alone is asked for: the total goes without.
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let all = waving(b, v[0], 6, None);
        let mut outputs = with_derivatives(b, vec![all[0]]);
        outputs.push(all[1]);
        outputs
    });
    let after = differentiate::run(graph(vec![wave(), entry]), &Finished::default(), true);
    let fold = folds(after.function(after.entry()))[0];
    assert_eq!((fold.starts.len(), fold.captures.len()), (3 + 2, 1 + 2));
    let body = after.function(fold.body);
    let names: Vec<&str> = body.inputs.iter().map(|slot| slot.name.as_str()).collect();
    let wanted = ["place", "total", "count", "place_dx", "place_dy", "step", "warp", "warp_dx", "warp_dy"];
    assert_eq!(names, wanted);
    assert_eq!(body.outputs.len(), fold.starts.len());
}

#[test]
fn a_tangent_may_come_from_many_steps_before() {
    // first ← second ← third ← fourth: only the fourth changes with uv at first.
    let inputs = [("first", FLOAT), ("second", FLOAT), ("third", FLOAT), ("fourth", FLOAT), ("step", INT)];
    let body = function("body", &inputs, |b, v| {
        let grown = b.builtin(SIN, &[v[3]]);
        vec![v[1], v[2], v[3], grown]
    });
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let (zero, steps, x) = (float(b, 0.0), int(b, 5), b.extract(v[0], 0));
        let first = b.fold(fold(0, &[zero, zero, zero, x], steps, &[]))[0];
        with_derivatives(b, vec![first])
    });
    derivatives_are_differences(graph(vec![body, entry]), (0.4, 0.2));
}

#[test]
fn derivatives_inside_a_body_are_those_of_each_step() {
    // The slope of every step's sine, summed up, beside the sum of the sines.
    let inputs = [("x", FLOAT), ("sum", FLOAT), ("slope", VEC2), ("step", INT)];
    let body = function("body", &inputs, |b, v| {
        let sine = b.builtin(SIN, &[v[0]]);
        let slopes = [Axis::X, Axis::Y]
            .map(|axis| b.push(Operation::Derivative(sine, axis, Sampled::Constant), FLOAT));
        let slopes = b.compose(&slopes);
        let growth = float(b, 1.3);
        let next = b.builtin(MULTIPLY, &[v[0], growth]);
        vec![next, b.builtin(ADD, &[v[1], sine]), b.builtin(ADD, &[v[2], slopes])]
    });
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let (zero, steps) = (float(b, 0.0), int(b, 5));
        let (x, none) = (b.extract(v[0], 0), b.splat(zero, 2));
        let all = b.fold(fold(0, &[x, zero, none], steps, &[]));
        vec![all[1], b.extract(all[2], 0), b.extract(all[2], 1)]
    });
    derivatives_are_differences(graph(vec![body, entry]), (0.4, 0.2));
}

#[test]
fn a_condition_takes_what_its_fold_carries() {
    let inputs = [("place", VEC2), ("total", FLOAT), ("count", INT), ("warp", FLOAT)];
    let condition = function("condition", &inputs, |b, v| {
        let (x, bound) = (b.extract(v[0], 0), float(b, 1.5));
        let bound = b.builtin(ADD, &[bound, v[3]]);
        vec![b.builtin(LESS, &[x, bound])]
    });
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let all = waving(b, v[0], 50, Some(1));
        with_derivatives(b, all[..2].to_vec())
    });
    let before = graph(vec![wave(), condition, entry]);
    let after = differentiate::run(before.clone(), &Finished::default(), true);
    let fold = folds(after.function(after.entry()))[0];
    let condition = after.function(fold.condition.expect("it stays"));
    assert_eq!(condition.inputs.len(), fold.starts.len() + fold.captures.len());
    assert_eq!(condition.outputs.len(), 1);
    derivatives_are_differences(before, (0.31, 0.62));
}

#[test]
fn samples_in_bodies_and_conditions_have_gradients() {
    let view = View { dimension: ViewDimension::D2, texel: Texel::Sampled, anisotropy: 1 };
    let sample = |b: &mut Builder, at: Value| {
        let picture = b.push(Operation::View(ViewId(0)), Type::View(view));
        let color = b.sample(picture, at, None, Level::Auto);
        b.extract(color, 0)
    };
    let body = function("body", &[("at", VEC2), ("sum", FLOAT), ("step", INT), ("by", VEC2)], |b, v| {
        let color = sample(b, v[0]);
        vec![b.builtin(ADD, &[v[0], v[3]]), b.builtin(ADD, &[v[1], color])]
    });
    let condition = function("condition", &[("at", VEC2), ("sum", FLOAT), ("by", VEC2)], |b, v| {
        let (color, half) = (sample(b, v[2]), float(b, 0.5));
        vec![b.builtin(LESS, &[color, half])]
    });
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let (zero, steps) = (float(b, 0.0), int(b, 9));
        let by = b.builtin(MULTIPLY, &[v[0], v[0]]);
        let fold = Fold { condition: Some(FunctionId(1)), ..fold(0, &[v[0], zero], steps, &[by]) };
        vec![b.fold(fold)[1]]
    });
    let after = differentiate::run(graph(vec![body, condition, entry]), &Finished::default(), true);
    for name in ["body", "condition"] {
        let function = named(&after, name);
        let gradient = |operation: &Operation| match operation {
            Operation::Sample { level: Level::Gradient(x, y), .. } => Some([*x, *y]),
            _ => None,
        };
        let gradients: Vec<Value> = function.values.iter().filter_map(gradient).flatten().collect();
        let names: Vec<String> = gradients
            .iter()
            .filter_map(|v| match function.operation(*v) {
                Operation::Input(i) => Some(function.inputs[*i as usize].name.to_string()),
                _ => None,
            })
            .collect();
        let wanted = if name == "body" { ["at_dx", "at_dy"] } else { ["by_dx", "by_dy"] };
        assert_eq!(names, wanted, "{name}");
    }
}

#[test]
fn tangents_go_through_folds_in_folds_and_calls_in_them() {
    let bend = function("bend", &[("x", FLOAT), ("by", FLOAT)], |b, v| {
        let sine = b.builtin(SIN, &[v[0]]);
        vec![sine, b.builtin(MULTIPLY, &[sine, v[1]])]
    });
    let inner = function("inner", &[("x", FLOAT), ("step", INT), ("by", FLOAT)], {
        let bend = bend.clone();
        move |b, v| {
            let bent = b.call(FunctionId(0), &bend, vec![v[0], v[2]])[1];
            vec![b.builtin(ADD, &[v[0], bent])]
        }
    });
    let outer = function("outer", &[("x", FLOAT), ("y", FLOAT), ("step", INT), ("by", FLOAT)], |b, v| {
        let by = b.builtin(MULTIPLY, &[v[1], v[3]]);
        let x = b.fold(fold(1, &[v[0]], v[2], &[by]))[0];
        let half = float(b, 0.5);
        let sum = b.builtin(ADD, &[v[1], x]);
        vec![b.builtin(COS, &[x]), b.builtin(MULTIPLY, &[sum, half])]
    });
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let (x, y, steps) = (b.extract(v[0], 0), b.extract(v[0], 1), int(b, 5));
        let by = b.builtin(SIN, &[y]);
        let all = b.fold(fold(2, &[x, y], steps, &[by]));
        with_derivatives(b, all)
    });
    derivatives_are_differences(graph(vec![bend, inner, outer, entry]), (0.31, 0.22));
}

#[test]
fn more_inputs_than_a_set_has_bits() {
    // 100 accumulators in a ring, and 100 captures of which one is added to each in turn.
    let count = 100_usize;
    let names: Vec<String> = (0..2 * count + 1).map(|i| format!("v{i}")).collect();
    let ty = |i: usize| if i == count { INT } else { FLOAT };
    let inputs: Vec<(&str, Type)> =
        names.iter().enumerate().map(|(i, name)| (name.as_str(), ty(i))).collect();
    let body = function("body", &inputs, |b, v| {
        let next = |b: &mut Builder, i: usize| b.builtin(ADD, &[v[(i + 1) % count], v[count + 1 + i]]);
        (0..count).map(|i| next(b, i)).collect()
    });
    let condition_inputs = [&inputs[..count], &inputs[count + 1..]].concat();
    let condition = function("condition", &condition_inputs, |b, v| {
        let bound = float(b, 1e9);
        vec![b.builtin(LESS, &[v[2 * count - 1], bound])]
    });
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let (x, y, steps) = (b.extract(v[0], 0), b.extract(v[0], 1), int(b, 7));
        let part = |b: &mut Builder, v: Value, i: usize| {
            let factor = float(b, i as f32 * 0.01);
            let product = b.builtin(MULTIPLY, &[v, factor]);
            b.builtin(SIN, &[product])
        };
        let starts: Vec<Value> = (0..count).map(|i| part(b, x, i + 1)).collect();
        // Half of the captures do not change.
        let captures: Vec<Value> =
            (0..count).map(|i| if i % 2 == 0 { part(b, y, i + 1) } else { float(b, 0.5) }).collect();
        let fold = Fold { condition: Some(FunctionId(1)), ..fold(0, &starts, steps, &captures) };
        let all = b.fold(fold);
        with_derivatives(b, vec![all[0], all[50], all[99]])
    });
    derivatives_are_differences(graph(vec![body, condition, entry]), (0.4, 0.3));
}

#[test]
fn calls_that_ask_for_everything_share_a_variant() {
    // Each function calls the next with any one of eight arguments held: 2⁸ ways after eight calls.
    let arguments = ["a", "b", "c", "d", "e", "f", "g", "h"].map(|name| (name, FLOAT));
    let mut functions = vec![function("last", &arguments, |b, v| {
        let product = v.iter().copied().reduce(|x, y| b.builtin(MULTIPLY, &[x, y]));
        vec![b.builtin(SIN, &[product.expect("there are some")])]
    })];
    for i in 0..9 {
        let callee = functions[i].clone();
        functions.push(function("next", &arguments, |b, v| {
            let one = float(b, 1.0);
            let mut held = v.to_vec();
            held[i % 8] = one;
            let some = b.call(FunctionId(i as u32), &callee, held)[0];
            let all = b.call(FunctionId(i as u32), &callee, v.to_vec())[0];
            vec![b.builtin(ADD, &[some, all])]
        }));
    }
    let callee = functions[9].clone();
    functions.push(function("entry", &[("uv", VEC2)], |b, v| {
        let (x, y) = (b.extract(v[0], 0), b.extract(v[0], 1));
        let value = b.call(FunctionId(9), &callee, vec![x, y, x, y, x, y, x, y])[0];
        with_derivatives(b, vec![value])
    }));
    let before = graph(functions);
    let after = differentiate::run(before.clone(), &Finished::default(), true);
    assert!(after.functions.len() <= 10 * 17 + 1, "{} functions", after.functions.len());
    derivatives_are_differences(before, (0.9, 0.8));
}

#[test]
fn a_short_fold_is_written_out() {
    for (steps, remain) in [(-3, 0), (0, 0), (1, 0), (4, 0), (5, 1)] {
        let entry = function("entry", &[("uv", VEC2)], |b, v| waving(b, v[0], steps, None));
        let before = graph(vec![wave(), entry]);
        let after = inline::run(before.clone());
        assert_eq!(folds(after.function(after.entry())).len(), remain, "{steps} steps");
        assert_eq!(outputs(&after, &at(0.3, 0.7)), outputs(&before, &at(0.3, 0.7)), "{steps} steps");
    }
}

#[test]
fn the_most_steps_count_as_known() {
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let (zero, none, steps) = (float(b, 0.0), int(b, 0), int(b, 100));
        let warp = b.extract(v[0], 1);
        b.fold(Fold { most: 3, ..fold(0, &[v[0], zero, none], steps, &[warp]) })
    });
    let before = graph(vec![wave(), entry]);
    let after = inline::run(before.clone());
    assert!(folds(after.function(after.entry())).is_empty());
    assert_eq!(outputs(&after, &at(0.3, 0.7)), outputs(&before, &at(0.3, 0.7)));
}

#[test]
fn a_step_that_is_written_out_knows_its_number() {
    // The inner fold has as many steps as the outer's number: it is written out, too.
    let inner = function("inner", &[("x", INT), ("step", INT), ("by", INT)], |b, v| {
        let sum = b.builtin(ADD_INT, &[v[0], v[1]]);
        vec![b.builtin(MULTIPLY_INT, &[sum, v[2]])]
    });
    let outer = function("outer", &[("x", INT), ("step", INT), ("by", INT)], |b, v| {
        vec![b.fold(fold(0, &[v[0]], v[1], &[v[2]]))[0]]
    });
    let entry = function("entry", &[], |b, _| {
        let (start, steps, by) = (int(b, 1), int(b, 4), int(b, 3));
        vec![b.fold(fold(1, &[start], steps, &[by]))[0]]
    });
    let before = graph(vec![inner, outer, entry]);
    let after = inline::run(before.clone());
    let entry = after.function(after.entry());
    assert_eq!(Operation::Constant(outputs(&before, &[])[0]), *entry.operation(entry.outputs[0].1));
}

#[test]
fn a_condition_keeps_a_fold_unless_it_is_known() {
    let inputs = [("place", VEC2), ("total", FLOAT), ("count", INT), ("warp", FLOAT)];
    let bound = |bound: i32| {
        function("condition", &inputs, move |b, v| {
            let bound = int(b, bound);
            vec![b.builtin(LESS_INT, &[v[2], bound])]
        })
    };
    let always =
        |holds: bool| function("condition", &inputs, move |b, _| vec![b.constant(Constant::bools(&[holds]))]);
    for (condition, remain) in [(bound(2), 1), (always(true), 0), (always(false), 0)] {
        let entry = function("entry", &[("uv", VEC2)], |b, v| waving(b, v[0], 3, Some(1)));
        let before = graph(vec![wave(), condition, entry]);
        let after = inline::run(before.clone());
        assert_eq!(folds(after.function(after.entry())).len(), remain);
        assert_eq!(outputs(&after, &at(0.3, 0.7)), outputs(&before, &at(0.3, 0.7)));
    }
}

#[test]
fn written_out_steps_keep_their_names() {
    let mut body = wave();
    let total = body.outputs[1].1;
    body.names.insert(total, "sum");
    let entry = function("entry", &[("uv", VEC2)], |b, v| waving(b, v[0], 3, None));
    let after = inline::run(graph(vec![body, entry]));
    let names: Vec<&str> = after.function(after.entry()).names.iter().map(|(_, name)| &**name).collect();
    assert_eq!(names, ["sum", "sum", "sum"]);
}

/// A single expression: sin(x) + by.
fn expression() -> Function {
    let mut function = function("expression", &[("x", FLOAT), ("by", FLOAT)], |b, v| {
        let sine = b.builtin(SIN, &[v[0]]);
        vec![b.builtin(ADD, &[sine, v[1]])]
    });
    function.inline = true;
    function
}

#[test]
fn bodies_take_expressions_over() {
    let callee = expression();
    let body = function("body", &[("x", FLOAT), ("step", INT), ("by", FLOAT)], |b, v| {
        b.call(FunctionId(0), &callee, vec![v[0], v[2]])
    });
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let (x, y, steps) = (b.extract(v[0], 0), b.extract(v[0], 1), int(b, 9));
        b.fold(fold(1, &[x], steps, &[y]))
    });
    let before = graph(vec![expression(), body, entry]);
    let after = inline::run(before.clone());
    let names: Vec<&str> = after.functions.iter().map(|f| f.name.as_str()).collect();
    assert_eq!(names, ["body", "entry"]);
    assert!(has(named(&after, "body"), SIN));
    assert_eq!(outputs(&after, &at(0.3, 0.7)), outputs(&before, &at(0.3, 0.7)));
}

/// Loops inside each other in one function.
fn nest(graph: &Graph) -> u32 {
    let mut nests: Vec<u32> = Vec::new();
    for function in &graph.functions {
        let inner = folds(function).into_iter().map(|fold| 1 + nests[fold.body.0 as usize]).max();
        nests.push(inner.unwrap_or(0));
    }
    nests.into_iter().max().unwrap_or(0)
}

#[test]
fn folds_nest_no_deeper_than_blocks_may() {
    // Each expression folds the next 60 times over, in one step each.
    let mut functions = vec![expression()];
    for _ in 0..60 {
        let (callee, body) = (functions[functions.len() - 1].clone(), functions.len() as u32);
        let id = FunctionId(body - 1);
        functions.push(function("body", &[("x", FLOAT), ("step", INT), ("steps", INT)], |b, v| {
            let second = if callee.inputs[1].ty == INT { v[2] } else { v[0] };
            b.call(id, &callee, vec![v[0], second])
        }));
        let mut next = function("expression", &[("x", FLOAT), ("steps", INT)], |b, v| {
            b.fold(fold(body, &[v[0]], v[1], &[v[1]]))
        });
        next.inline = true;
        functions.push(next);
    }
    let last = functions[functions.len() - 1].clone();
    let id = FunctionId(functions.len() as u32 - 1);
    functions.push(function("entry", &[("uv", VEC2), ("instance", INT)], |b, v| {
        let x = b.extract(v[0], 0);
        b.call(id, &last, vec![x, v[1]])
    }));
    let before = graph(functions);
    let after = inline::run(before.clone());
    assert!((20..=24).contains(&nest(&after)), "{}", nest(&after));
    let mut inputs = at(0.3, 0.7);
    inputs.push(("instance", Constant::ints(&[1])));
    assert_eq!(outputs(&after, &inputs), outputs(&before, &inputs));
}

#[test]
fn expressions_that_call_each_other_twice_do_not_explode() {
    let mut functions = vec![expression()];
    for i in 0..40 {
        let callee = functions[i].clone();
        let mut next = function("expression", &[("x", FLOAT), ("by", FLOAT)], |b, v| {
            let left = b.call(FunctionId(i as u32), &callee, vec![v[0], v[1]])[0];
            let right = b.call(FunctionId(i as u32), &callee, vec![v[1], v[0]])[0];
            let sum = b.builtin(ADD, &[left, v[0]]);
            vec![b.builtin(SUBTRACT, &[sum, right])]
        });
        next.inline = true;
        functions.push(next);
    }
    let last = functions[40].clone();
    functions.push(function("entry", &[("uv", VEC2)], |b, v| {
        let (x, y) = (b.extract(v[0], 0), b.extract(v[0], 1));
        b.call(FunctionId(40), &last, vec![x, y])
    }));
    let after = inline::run(graph(functions));
    let values: usize = after.functions.iter().map(|f| f.values.len()).sum();
    assert!(after.functions.len() < 41 && values < 300_000, "{} {values}", after.functions.len());
}

#[test]
fn short_folds_in_short_folds_do_not_explode() {
    let mut functions = vec![function("body", &[("x", FLOAT), ("step", INT)], |b, v| {
        let step = b.builtin(TO_FLOAT, &[v[1]]);
        let sum = b.builtin(ADD, &[v[0], step]);
        vec![b.builtin(SIN, &[sum])]
    })];
    for i in 0..20 {
        functions.push(function("body", &[("x", FLOAT), ("step", INT)], |b, v| {
            let steps = int(b, 4);
            b.fold(fold(i, &[v[0]], steps, &[]))
        }));
    }
    functions.push(function("entry", &[("uv", VEC2)], |b, v| {
        let (x, steps) = (b.extract(v[0], 0), int(b, 4));
        b.fold(fold(20, &[x], steps, &[]))
    }));
    let after = inline::run(graph(functions));
    let values: usize = after.functions.iter().map(|f| f.values.len()).sum();
    assert!(values < 300_000, "{values}");
}

#[test]
fn a_fold_without_steps_is_its_starts() {
    let entry = function("entry", &[("uv", VEC2)], |b, v| waving(b, v[0], 0, None));
    let after = remove_dead::run(graph(vec![wave(), entry]));
    assert_eq!(after.functions.len(), 1);
    let entry = after.function(after.entry());
    assert_eq!(*entry.operation(entry.outputs[0].1), Operation::Input(0));
}

#[test]
fn accumulators_and_captures_that_nobody_needs_go() {
    // kept ← helper ← captured; counted reads itself, dead reads another capture.
    let inputs = [
        ("dead", FLOAT),
        ("kept", FLOAT),
        ("counted", FLOAT),
        ("helper", FLOAT),
        ("step", INT),
        ("unread", FLOAT),
        ("captured", FLOAT),
    ];
    let body = function("body", &inputs, |b, v| {
        let one = float(b, 1.0);
        vec![
            b.builtin(ADD, &[v[0], v[5]]),
            b.builtin(ADD, &[v[1], v[3]]),
            b.builtin(ADD, &[v[2], one]),
            b.builtin(ADD, &[v[3], v[6]]),
        ]
    });
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let (x, y, steps) = (b.extract(v[0], 0), b.extract(v[0], 1), int(b, 9));
        let wasted = b.builtin(SIN, &[x]);
        let all = b.fold(fold(0, &[x, y, x, y], steps, &[wasted, y]));
        vec![all[1]]
    });
    let before = graph(vec![body, entry]);
    let after = remove_dead::run(before.clone());
    let entry = after.function(after.entry());
    let fold = folds(entry)[0];
    let body = after.function(fold.body);
    let names: Vec<&str> = body.inputs.iter().map(|slot| slot.name.as_str()).collect();
    assert_eq!(names, ["kept", "helper", "step", "captured"]);
    assert_eq!((fold.starts.len(), fold.captures.len(), body.outputs.len()), (2, 1, 2));
    assert!(!has(entry, SIN));
    assert_eq!(outputs(&after, &at(0.3, 0.7)), outputs(&before, &at(0.3, 0.7)));
}

#[test]
fn a_condition_keeps_what_it_reads() {
    let inputs = [
        ("total", FLOAT),
        ("limit", FLOAT),
        ("dead", FLOAT),
        ("step", INT),
        ("unread", FLOAT),
        ("bound", FLOAT),
    ];
    let body = function("body", &inputs, |b, v| {
        let one = float(b, 1.0);
        vec![b.builtin(ADD, &[v[0], one]), b.builtin(MULTIPLY, &[v[1], v[1]]), b.builtin(ADD, &[v[2], v[4]])]
    });
    let inputs = [("total", FLOAT), ("limit", FLOAT), ("dead", FLOAT), ("unread", FLOAT), ("bound", FLOAT)];
    let condition = function("condition", &inputs, |b, v| vec![b.builtin(LESS, &[v[1], v[4]])]);
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let (x, y, steps) = (b.extract(v[0], 0), b.extract(v[0], 1), int(b, 60));
        let (start, bound) = (float(b, 1.5), float(b, 1e6));
        let bound = b.builtin(ADD, &[bound, y]);
        let fold = Fold { condition: Some(FunctionId(1)), ..fold(0, &[x, start, x], steps, &[y, bound]) };
        vec![b.fold(fold)[0]]
    });
    let before = graph(vec![body, condition, entry]);
    let after = remove_dead::run(before.clone());
    let fold = folds(after.function(after.entry()))[0];
    let names = |f: &Function| f.inputs.iter().map(|slot| slot.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(after.function(fold.body)), ["total", "limit", "step", "bound"]);
    assert_eq!(names(after.function(fold.condition.expect("it stays"))), ["total", "limit", "bound"]);
    assert_eq!(outputs(&after, &at(0.3, 0.7)), outputs(&before, &at(0.3, 0.7)));
}

#[test]
fn outputs_and_arguments_of_calls_that_nobody_reads_go() {
    let callee = function("callee", &[("x", FLOAT), ("y", FLOAT)], |b, v| {
        vec![b.builtin(SIN, &[v[0]]), b.builtin(COS, &[v[1]]), b.builtin(EXP, &[v[1]])]
    });
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let (x, y) = (b.extract(v[0], 0), b.extract(v[0], 1));
        let wasted = b.builtin(SIN, &[x]);
        let all = b.call(FunctionId(0), &callee, vec![wasted, y]);
        vec![all[2]]
    });
    let before = graph(vec![callee.clone(), entry]);
    let after = remove_dead::run(before.clone());
    let (callee, entry) = (named(&after, "callee"), named(&after, "entry"));
    assert_eq!((callee.inputs.len(), callee.outputs.len()), (1, 1));
    assert!(has(callee, EXP) && !has(callee, COS) && !has(entry, SIN));
    assert_eq!(outputs(&after, &at(0.3, 0.7)), outputs(&before, &at(0.3, 0.7)));
}

/// Nothing is lost and nothing is done twice: hoisted, then cleaned up.
fn hoisted(before: &Graph) -> Graph {
    let after = remove_dead::run(hoist::run(before.clone()));
    assert_eq!(outputs(&after, &at(0.3, 0.7)), outputs(before, &at(0.3, 0.7)));
    after
}

#[test]
fn what_a_body_makes_of_captures_is_made_outside() {
    let mut body = wave();
    let is_shift = |op: &Operation| matches!(op, Operation::Builtin(SIN, v) if v[0] == Value(4));
    let shift = body.values.iter().position(is_shift).expect("it is there");
    body.names.insert(Value(shift as u32), "shift");
    let entry = function("entry", &[("uv", VEC2)], |b, v| waving(b, v[0], 9, None));
    let after = hoisted(&graph(vec![body, entry]));
    let entry = after.function(after.entry());
    let fold = folds(entry)[0];
    let body = after.function(fold.body);
    let names: Vec<&str> = body.inputs.iter().map(|slot| slot.name.as_str()).collect();
    assert_eq!(names, ["place", "total", "count", "step", "shift"]);
    assert_eq!(entry.names.get(fold.captures[0]).map(|name| &**name), Some("shift"));
    assert_eq!(count(entry, |op| matches!(op, Operation::Builtin(SIN, _))), 1);
    assert_eq!(count(body, |op| matches!(op, Operation::Builtin(SIN, _))), 1, "that of the place stays");
}

#[test]
fn what_both_body_and_condition_make_of_captures_is_made_outside() {
    for first in ["body", "condition"] {
        let body = function("body", &[("x", FLOAT), ("step", INT), ("by", FLOAT)], |b, v| {
            let shift = b.builtin(SIN, &[v[2]]);
            vec![b.builtin(ADD, &[v[0], shift])]
        });
        let condition = function("condition", &[("x", FLOAT), ("by", FLOAT)], |b, v| {
            let bound = b.builtin(EXP, &[v[1]]);
            let twice = b.builtin(ADD, &[bound, bound]);
            vec![b.builtin(LESS, &[v[0], twice])]
        });
        let ids = if first == "body" { [0, 1] } else { [1, 0] };
        let entry = function("entry", &[("uv", VEC2)], |b, v| {
            let (x, y, steps) = (b.extract(v[0], 0), b.extract(v[0], 1), int(b, 60));
            let fold = Fold { condition: Some(FunctionId(ids[1])), ..fold(ids[0], &[x], steps, &[y]) };
            b.fold(fold)
        });
        let mut functions = if first == "body" { vec![body, condition] } else { vec![condition, body] };
        functions.push(entry);
        let after = hoisted(&graph(functions));
        let entry = after.function(after.entry());
        let fold = folds(entry)[0];
        let condition = after.function(fold.condition.expect("it stays"));
        assert!(!has(after.function(fold.body), SIN) && !has(condition, EXP) && !has(condition, ADD));
        assert!(has(entry, SIN) && has(entry, EXP));
        assert_eq!(fold.captures.len(), 2);
    }
}

#[test]
fn what_no_loop_changes_leaves_all_loops() {
    let inner = function("inner", &[("x", FLOAT), ("step", INT), ("by", FLOAT)], |b, v| {
        let (shift, scale) = (b.builtin(SIN, &[v[2]]), param(b, 0));
        let root = b.builtin(EXP, &[scale]);
        let product = b.builtin(MULTIPLY, &[shift, root]);
        vec![b.builtin(ADD, &[v[0], product])]
    });
    let outer = function("outer", &[("x", FLOAT), ("step", INT), ("by", FLOAT)], |b, v| {
        b.fold(fold(0, &[v[0]], v[1], &[v[2]]))
    });
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let (x, y, steps) = (b.extract(v[0], 0), b.extract(v[0], 1), int(b, 9));
        b.fold(fold(1, &[x], steps, &[y]))
    });
    let after = hoisted(&graph(vec![inner, outer, entry]));
    for name in ["inner", "outer"] {
        assert!(![SIN, EXP, MULTIPLY].iter().any(|i| has(named(&after, name), *i)), "{name}");
    }
    let entry = after.function(after.entry());
    assert!(has(entry, SIN) && has(entry, EXP) && has(entry, MULTIPLY));
}

/// A picture's red at (x, x), level 0.
fn sample(b: &mut Builder, x: Value) -> Value {
    let view = View { dimension: ViewDimension::D2, texel: Texel::Sampled, anisotropy: 1 };
    let picture = b.push(Operation::View(ViewId(0)), Type::View(view));
    let (place, level) = (b.compose(&[x, x]), float(b, 0.0));
    let color = b.sample(picture, place, None, Level::Level(level));
    b.extract(color, 0)
}

#[test]
fn what_stands_in_a_branch_stays_there() {
    // The sample of a capture is needed in some steps only; with it its coordinate. The other sample
    // is needed in all.
    let body = function("body", &[("x", FLOAT), ("step", INT), ("by", FLOAT)], |b, v| {
        let one = int(b, 1);
        let first = b.builtin(LESS_INT, &[v[1], one]);
        let (rare, always) = (b.builtin(SIN, &[v[2]]), b.builtin(EXP, &[v[2]]));
        let (rare, always) = (sample(b, rare), sample(b, always));
        let chosen = b.select(first, rare, v[0]);
        vec![b.builtin(ADD, &[chosen, always])]
    });
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let (x, y, steps) = (b.extract(v[0], 0), b.extract(v[0], 1), int(b, 9));
        b.fold(fold(0, &[x], steps, &[y]))
    });
    let after = remove_dead::run(hoist::run(graph(vec![body, entry])));
    let (body, entry) = (named(&after, "body"), named(&after, "entry"));
    let samples = |f: &Function| count(f, |op| matches!(op, Operation::Sample { .. }));
    assert_eq!((samples(body), samples(entry)), (1, 1));
    assert!(has(body, SIN) && !has(body, EXP) && !has(entry, SIN) && has(entry, EXP));
}

#[test]
fn arithmetic_of_a_draw_leaves_branches_but_samples_do_not() {
    let callee = function("callee", &[("x", FLOAT)], |b, v| {
        let (scale, half) = (param(b, 0), float(b, 0.5));
        let low = b.builtin(LESS, &[v[0], half]);
        let sine = b.builtin(SIN, &[scale]);
        let color = sample(b, sine);
        let bent = b.builtin(EXP, &[color]);
        vec![b.select(low, bent, v[0])]
    });
    let entry = function("entry", &[("uv", VEC2)], |b, v| {
        let x = b.extract(v[0], 0);
        b.call(FunctionId(0), &callee, vec![x])
    });
    let after = remove_dead::run(hoist::run(graph(vec![callee.clone(), entry])));
    let (callee, entry) = (named(&after, "callee"), named(&after, "entry"));
    assert!(has(entry, SIN) && !has(entry, EXP) && has(callee, EXP) && !has(callee, SIN));
    assert_eq!(count(entry, |op| matches!(op, Operation::Sample { .. })), 0);
}

/// (x, speed) → sin(x·exp(speed)·exp(scale)), the factor named.
fn swirl() -> Function {
    let mut factor = Value(0);
    let mut swirl = function("swirl", &[("x", FLOAT), ("speed", FLOAT)], |b, v| {
        let scale = param(b, 0);
        let (speed, scale) = (b.builtin(EXP, &[v[1]]), b.builtin(EXP, &[scale]));
        factor = b.builtin(MULTIPLY, &[speed, scale]);
        let product = b.builtin(MULTIPLY, &[v[0], factor]);
        vec![b.builtin(SIN, &[product])]
    });
    swirl.names.insert(factor, "factor");
    swirl
}

const TIMED: [(&str, Type); 2] = [("uv", VEC2), ("time", FLOAT)];

#[test]
fn work_of_a_draw_ends_in_the_entry_once() {
    let middle = function("middle", &[("x", FLOAT), ("speed", FLOAT)], |b, v| {
        let twist = param(b, 1);
        let speed = b.builtin(MULTIPLY, &[v[1], twist]);
        let once = b.call(FunctionId(0), &swirl(), vec![v[0], speed])[0];
        vec![b.call(FunctionId(0), &swirl(), vec![once, speed])[0]]
    });
    let entry = function("entry", &TIMED, |b, v| {
        let (x, y) = (b.extract(v[0], 0), b.extract(v[0], 1));
        let left = b.call(FunctionId(1), &middle, vec![x, v[1]])[0];
        let right = b.call(FunctionId(1), &middle, vec![y, v[1]])[0];
        vec![b.builtin(ADD, &[left, right])]
    });
    let after = hoisted(&graph(vec![swirl(), middle, entry]));
    let entry = after.function(after.entry());
    for name in ["swirl", "middle"] {
        let function = named(&after, name);
        assert!(!has(function, EXP), "{name}");
        assert_eq!(function.inputs.len(), 2, "{name}: {:?}", function.inputs);
        assert_eq!(function.inputs[1].name, "factor", "{name}");
    }
    assert_eq!(count(entry, |op| matches!(op, Operation::Builtin(EXP, _))), 2);
    assert!(entry.names.iter().any(|(_, name)| **name == *"factor"));
}

#[test]
fn what_differs_between_pixels_at_one_call_stays_inside() {
    let entry = function("entry", &TIMED, |b, v| {
        let (x, y) = (b.extract(v[0], 0), b.extract(v[0], 1));
        let left = b.call(FunctionId(0), &swirl(), vec![x, v[1]])[0];
        let right = b.call(FunctionId(0), &swirl(), vec![x, y])[0];
        vec![b.builtin(ADD, &[left, right])]
    });
    let after = hoisted(&graph(vec![swirl(), entry]));
    let exponentials = |f: &Function| count(f, |op| matches!(op, Operation::Builtin(EXP, _)));
    assert_eq!(exponentials(named(&after, "swirl")), 1, "of the speed");
    assert_eq!(exponentials(named(&after, "entry")), 1, "of the param");
}

#[test]
fn every_caller_computes_its_own() {
    let entry = function("entry", &TIMED, |b, v| {
        let (x, twist) = (b.extract(v[0], 0), param(b, 1));
        let left = b.call(FunctionId(0), &swirl(), vec![x, v[1]])[0];
        let right = b.call(FunctionId(0), &swirl(), vec![x, twist])[0];
        vec![b.builtin(ADD, &[left, right])]
    });
    let after = hoisted(&graph(vec![swirl(), entry]));
    assert!(!has(named(&after, "swirl"), EXP));
    let entry = named(&after, "entry");
    assert_eq!(count(entry, |op| matches!(op, Operation::Builtin(EXP, _))), 3, "time, param, param");
}

#[test]
fn outputs_of_a_draw_are_known_to_the_caller() {
    // The callee's second output does not need its pixel's input, and goes on into another call.
    let callee = function("callee", &[("x", FLOAT), ("speed", FLOAT)], |b, v| {
        let speed = b.builtin(EXP, &[v[1]]);
        vec![b.builtin(MULTIPLY, &[v[0], speed]), b.builtin(SIN, &[speed])]
    });
    let caller = function("caller", &[("x", FLOAT), ("speed", FLOAT)], |b, v| {
        let all = b.call(FunctionId(0), &callee, vec![v[0], v[1]]);
        let bent = b.builtin(COS, &[all[1]]);
        vec![b.builtin(ADD, &[all[0], bent])]
    });
    let entry = function("entry", &TIMED, |b, v| {
        let x = b.extract(v[0], 0);
        b.call(FunctionId(1), &caller, vec![x, v[1]])
    });
    let after = hoisted(&graph(vec![callee.clone(), caller, entry]));
    let entry = after.function(after.entry());
    assert!([EXP, SIN, COS].iter().all(|i| has(entry, *i)));
    assert!(![EXP, SIN, COS].iter().any(|i| has(named(&after, "caller"), *i)));
    assert_eq!(named(&after, "callee").outputs.len(), 1);
}

#[test]
fn dead_calls_do_not_hold_work_back() {
    let entry = function("entry", &TIMED, |b, v| {
        let (x, y) = (b.extract(v[0], 0), b.extract(v[0], 1));
        b.call(FunctionId(0), &swirl(), vec![x, y]);
        b.call(FunctionId(0), &swirl(), vec![x, v[1]])
    });
    let after = hoisted(&graph(vec![swirl(), entry]));
    assert!(!has(named(&after, "swirl"), EXP));
}

#[test]
fn components_params_and_inputs_are_not_moved() {
    let callee = function("callee", &[("x", FLOAT), ("speed", VEC2)], |b, v| {
        let (scale, speed) = (param(b, 0), b.extract(v[1], 1));
        let product = b.builtin(MULTIPLY, &[v[0], scale]);
        vec![b.builtin(ADD, &[product, speed])]
    });
    let entry = function("entry", &TIMED, |b, v| {
        let (x, speed) = (b.extract(v[0], 0), b.compose(&[v[1], v[1]]));
        b.call(FunctionId(0), &callee, vec![x, speed])
    });
    let before = graph(vec![callee.clone(), entry]);
    let after = hoisted(&before);
    assert_eq!(after.to_string(), before.to_string());
}

#[test]
fn callers_that_call_twice_do_not_explode() {
    let mut functions = vec![swirl()];
    for i in 0..40 {
        let callee = functions[i].clone();
        functions.push(function("middle", &[("x", FLOAT), ("speed", FLOAT)], |b, v| {
            let speeds = [1.0, 2.0].map(|by| {
                let by = float(b, by + i as f32);
                b.builtin(ADD, &[v[1], by])
            });
            let once = b.call(FunctionId(i as u32), &callee, vec![v[0], speeds[0]])[0];
            b.call(FunctionId(i as u32), &callee, vec![once, speeds[1]])
        }));
    }
    let last = functions[40].clone();
    functions.push(function("entry", &TIMED, |b, v| {
        let x = b.extract(v[0], 0);
        b.call(FunctionId(40), &last, vec![x, v[1]])
    }));
    let after = remove_dead::run(hoist::run(graph(functions)));
    let values: usize = after.functions.iter().map(|f| f.values.len()).sum();
    assert!(values < 200_000, "{values}");
    assert!(after.functions.iter().all(|f| f.inputs.len() <= 64));
}

#[test]
fn all_passes_keep_every_value() {
    // A condition, a nested fold, calls, tangents, short folds, divisions with guards.
    let condition_inputs = [("place", VEC2), ("total", FLOAT), ("count", INT), ("warp", FLOAT)];
    let condition = function("condition", &condition_inputs, |b, v| {
        let (x, bound) = (b.extract(v[0], 0), b.builtin(EXP, &[v[3]]));
        let twice = b.builtin(ADD, &[bound, bound]);
        vec![b.builtin(LESS, &[x, twice])]
    });
    let nested = function("nested", &[("x", FLOAT), ("step", INT), ("y", FLOAT)], |b, v| {
        let bent = b.call(FunctionId(2), &swirl(), vec![v[0], v[2]])[0];
        let (scale, twist) = (param(b, 0), param(b, 1));
        let ratio = b.builtin(DIVIDE, &[scale, twist]);
        let bent = b.builtin(MULTIPLY, &[bent, ratio]);
        vec![b.builtin(DIVIDE, &[bent, v[2]])]
    });
    let entry = function("entry", &TIMED, |b, v| {
        let all = waving(b, v[0], 7, Some(1));
        let (steps, short) = (b.builtin(ADD_INT, &[all[2], all[2]]), int(b, 3));
        let long = b.fold(fold(3, &[all[1]], steps, &[v[1]]))[0];
        let short = b.fold(fold(3, &[long], short, &[all[1]]))[0];
        with_derivatives(b, vec![all[0], long, short])
    });
    let before = graph(vec![wave(), condition, swirl(), nested, entry]);
    let mut inputs = at(0.31, 0.62);
    inputs.push(("uv_dx", Constant::floats(&[0.7, -0.2])));
    inputs.push(("uv_dy", Constant::floats(&[0.3, 1.1])));
    let plain = differentiate::run(before.clone(), &Finished::default(), true);
    assert_eq!(
        outputs(&run(before, &Finished::default(), Gradients::Derive), &inputs),
        outputs(&plain, &inputs)
    );
}

#[test]
fn ten_thousand_functions_and_folds_deep() {
    let mut functions = vec![swirl()];
    for i in 0..10_000 {
        let callee = functions[i].clone();
        functions.push(function("next", &[("x", FLOAT), ("speed", FLOAT)], |b, v| {
            let (x, one) = (b.builtin(SIN, &[v[0]]), float(b, 1.0));
            let speed = b.builtin(ADD, &[v[1], one]);
            b.call(FunctionId(i as u32), &callee, vec![x, speed])
        }));
    }
    let last = functions[10_000].clone();
    functions.push(function("entry", &TIMED, |b, v| {
        let x = b.extract(v[0], 0);
        let value = b.call(FunctionId(10_000), &last, vec![x, v[1]])[0];
        with_derivatives(b, vec![value])
    }));
    let after = run(graph(functions), &Finished::default(), Gradients::Derive);
    assert_eq!(after.functions.len(), 10_002);
    assert!(!has(&after.functions[0], EXP));
}
