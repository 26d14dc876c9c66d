//! Folds on the CPU, of graphs made by hand: what they give, in which order, what is not computed,
//! and what is refused.

mod common;

use common::folds::{collatz, counted, endless, floats, gathered, int, ints, nested, number};
use common::programs::{VEC2, float, output, program};
use common::{folder, write_picture};
use texgraph_compiler::Program;
use texgraph_compiler::graph::{
    Builder, Constant, Fold, Function, FunctionId, Graph, Operation, ParamId, Type, Value,
};
use texgraph_compiler::intrinsic::TO_INT;
use texgraph_compiler::manifest;
use texgraph_runtime::cpu;
use texgraph_runtime::picture::Picture;
use texgraph_runtime::render::{RenderError, Request};
use texgraph_runtime::resource::Tables;

fn render(program: &Program, request: &Request) -> Picture {
    cpu::render(program, &Tables::default(), request, &|_| {}).expect("it renders")
}

fn refused(program: &Program, request: &Request) -> RenderError {
    cpu::render(program, &Tables::default(), request, &|_| {}).expect_err("it must not render")
}

/// Cell (x, y) of 16 × 16 is pixel 16 y + x.
fn cells() -> Request {
    Request::new([16, 16])
}

fn set(program: &Program, mut request: Request, scale: f32) -> Request {
    let value = manifest::Value::Float(vec![scale, 0.0]);
    request.settings.set(&program.manifest, "scale", value).expect("it is set");
    request
}

#[test]
fn steps_are_clamped_and_accumulators_change_together() {
    let program = counted();
    let picture = render(&program, &cells());
    assert_eq!(picture.pixels[0], [1.0, 0.5, -1.0, 1.0], "no step: the starts");
    let u = 2.5f32 / 16.0;
    assert_eq!(picture.pixels[2], [1.0 + u, 0.5, 1.0, 1.0], "two steps: (½, 1), then (1 + u, ½)");
    for x in [7, 8, 15] {
        assert_eq!(picture.pixels[x][2], 6.0, "the seventh step is the last");
    }
    let left = render(&program, &Request { region: [-1.0, 0.0, 0.0, 1.0], ..cells() });
    assert!(left.pixels.iter().all(|pixel| *pixel == [1.0, 0.5, -1.0, 1.0]), "fewer than no steps");
}

#[test]
fn a_condition_ends_a_fold() {
    let program = collatz();
    let picture = render(&program, &set(&program, cells(), 0.5));
    assert_eq!(picture.pixels[0], [0.0, 1.0, 0.0, 1.0], "it is tested before the first step");
    assert_eq!(picture.pixels[26], [111.0, 9232.0, 55.5, 1.0], "27 takes 111 steps and climbs to 9232");
    assert_eq!(picture.pixels[255], [8.0, 256.0, 4.0, 1.0], "256 is halved eight times");
}

#[test]
fn folds_nest() {
    let picture = render(&nested(), &cells());
    for (pixel, [x, y]) in (0..256).map(|i| (picture.pixels[i as usize], [i % 16, i / 16])) {
        let (mut total, mut count) = (x, 0);
        for b in 0..5 {
            for a in 0..b + 2 {
                if total == y {
                    break;
                }
                total = (3 * total + 7 * a + 5 * b + x) % 101;
                count += 1;
            }
        }
        assert_eq!(pixel, [total as f32, count as f32, 0.0, 1.0], "cell {x}, {y}");
    }
}

#[test]
fn views_are_captured() {
    let folder = folder();
    let samples: Vec<u8> = (0..256).map(|i| (i % 16 * 17) as u8).collect();
    write_picture(&folder.path().join("a.png"), [16, 16], &samples);
    let (program, tables) = gathered(folder.path(), "a.png");
    let picture = cpu::render(&program, &tables, &cells(), &|_| {}).expect("it renders");
    for x in 0..16i32 {
        // Until the map's next 1, at 6, 13 or 20.
        let taps = x..(x + 9).min(x / 7 * 7 + 6);
        let sum: i32 = taps.map(|tap| tap % 16 * 17).sum();
        let found = picture.pixels[x as usize][0] * 9.0 * 255.0;
        assert!((found - sum as f32).abs() < 0.05, "{x}: {found}, not {sum}");
    }
}

/// `value = table[cell.x − 8]` of four numbers.
#[test]
fn lookups_are_clamped() {
    let mut b = Builder::new("test");
    let uv = b.input("uv", VEC2);
    let u = b.extract(uv, 0);
    let index = b.builtin(TO_INT, &[u]);
    let table: Vec<Constant> = [3.0, 1.0, 4.0, 1.5].iter().map(|x| Constant::floats(&[*x])).collect();
    let value = b.lookup(table.into(), index);
    b.output("value", value);
    let program = of(vec![b.finish()]);
    let picture = render(&program, &Request { region: [-3.5, 0.0, 6.5, 1.0], ..Request::new([10, 1]) });
    let found: Vec<f32> = picture.pixels.iter().map(|pixel| pixel[0]).collect();
    assert_eq!(found, [3.0, 3.0, 3.0, 3.0, 1.0, 4.0, 1.5, 1.5, 1.5, 1.5]);
}

/// A program of functions whose last has the input `uv` and outputs of one float.
fn of(functions: Vec<Function>) -> Program {
    let outputs = functions.last().map(|entry| entry.outputs.len()).unwrap_or_default();
    let mut program = program(Graph { functions, ..Graph::default() }, "");
    program.passes[0].graph.params = vec![common::programs::scale_param()];
    program.manifest.outputs = (0..outputs as u32)
        .map(|n| manifest::Output { ty: float(1), ..output(&format!("value{n}"), 1, n) })
        .collect();
    program
}

/// A fold of the accumulators (a, b, c, d): a' = a + u, b' = b + c, c' = c + 1, d' = endless(d).
/// One output for each; with `condition`, while c < 3.
fn four_accumulators(condition: bool) -> Program {
    let mut functions = endless();
    let costly = functions.len() - 1;
    let mut body = Builder::new("body");
    let [a, b, c, d] = ["a", "b", "c", "d"].map(|name| body.input(name, Type::FLOAT));
    body.input("step", Type::INT);
    let u = body.input("u", Type::FLOAT);
    let one = number(&mut body, 1.0);
    let more = floats(&mut body, "+", a, u);
    let sum = floats(&mut body, "+", b, c);
    let count = floats(&mut body, "+", c, one);
    let slow = body.call(FunctionId(costly as u32), &functions[costly], vec![d])[0];
    for (name, value) in [("a", more), ("b", sum), ("c", count), ("d", slow)] {
        body.output(name, value);
    }
    functions.push(body.finish());
    let mut test = Builder::new("condition");
    let [_, _, c, _, _] = ["a", "b", "c", "d", "u"].map(|name| test.input(name, Type::FLOAT));
    let three = number(&mut test, 3.0);
    let holds = test.builtin(common::programs::intrinsic("<", "a: float"), &[c, three]);
    test.output("holds", holds);
    functions.push(test.finish());
    let [body, test] = [2, 1].map(|back| FunctionId((functions.len() - back) as u32));
    let mut entry = Builder::new("test");
    let uv = entry.input("uv", VEC2);
    let u = entry.extract(uv, 0);
    let (zero, steps) = (number(&mut entry, 0.0), int(&mut entry, 5));
    let starts = vec![zero, zero, zero, u];
    let condition = condition.then_some(test);
    let fold = Fold { body, condition, starts, steps, most: 5, captures: vec![u] };
    for (name, result) in ["a", "b", "c", "d"].into_iter().zip(entry.fold(fold)) {
        entry.output(name, result);
    }
    functions.push(entry.finish());
    of(functions)
}

#[test]
fn only_the_accumulators_that_are_needed_are_computed() {
    for (condition, steps) in [(false, 5.0), (true, 3.0)] {
        let program = four_accumulators(condition);
        let value = |output| render(&program, &Request { output, ..Request::new([2, 1]) }).pixels[1][0];
        assert_eq!(value(0), 0.75 * steps, "a, and c where the condition reads it");
        assert_eq!(value(1), steps * (steps - 1.0) / 2.0, "b, which reads c: 0 + 1 + 2 + …");
        assert_eq!(value(2), steps);
        let request = Request { output: 3, ..Request::new([2, 1]) };
        assert!(matches!(refused(&program, &request), RenderError::TooMuchWork { .. }), "d is without end");
    }
}

/// One fold is asked for its first accumulator, the other for its second; each leaves out the start
/// of its other.
#[test]
fn folds_may_share_a_body() {
    let mut body = Builder::new("body");
    let [a, b] = ["a", "b"].map(|name| body.input(name, Type::FLOAT));
    let step = body.input("step", Type::INT);
    let step = body.to_float(step);
    let (sum, difference) = (floats(&mut body, "+", a, step), floats(&mut body, "-", b, step));
    body.output("a", sum);
    body.output("b", difference);
    let mut entry = Builder::new("test");
    let uv = entry.input("uv", VEC2);
    let [u, v] = [0, 1].map(|i| entry.extract(uv, i));
    let twice = floats(&mut entry, "+", v, v);
    let (four, three) = (int(&mut entry, 4), int(&mut entry, 3));
    let fold = |starts, steps| Fold {
        body: FunctionId(0),
        condition: None,
        starts,
        steps,
        most: 4,
        captures: vec![],
    };
    let first = entry.fold(fold(vec![u, twice], four))[0];
    let second = entry.fold(fold(vec![twice, u], three))[1];
    let both = floats(&mut entry, "*", first, second);
    entry.output("both", both);
    let picture = render(&of(vec![body.finish(), entry.finish()]), &Request::new([1, 1]));
    assert_eq!(picture.pixels[0][0], (0.5 + 6.0) * (0.5 - 3.0));
}

/// `sum = sum + x` for some steps, from 0.
fn sums(steps: fn(&mut Builder, Value) -> Value, most: u32) -> Program {
    let mut body = Builder::new("body");
    let sum = body.input("sum", Type::FLOAT);
    body.input("step", Type::INT);
    let x = body.input("x", Type::FLOAT);
    let next = floats(&mut body, "+", sum, x);
    body.output("sum", next);
    let mut b = Builder::new("test");
    let uv = b.input("uv", VEC2);
    let u = b.extract(uv, 0);
    let steps = steps(&mut b, u);
    let zero = number(&mut b, 0.0);
    let starts = vec![zero];
    let fold = Fold { body: FunctionId(0), condition: None, starts, steps, most, captures: vec![u] };
    let sum = b.fold(fold)[0];
    b.output("sum", sum);
    of(vec![body.finish(), b.finish()])
}

fn of_param(b: &mut Builder, _: Value) -> Value {
    let scale = b.push(Operation::Param(ParamId(0)), VEC2);
    let scale = b.extract(scale, 0);
    b.builtin(TO_INT, &[scale])
}

fn of_pixel(b: &mut Builder, u: Value) -> Value {
    b.builtin(TO_INT, &[u])
}

#[test]
fn the_work_of_a_fold_is_bounded_by_its_steps() {
    let one = Request::new([1, 1]);
    let program = sums(of_param, u32::MAX);
    assert_eq!(render(&program, &set(&program, one.clone(), 6.0)).pixels[0][0], 3.0);
    let request = set(&program, one.clone(), 2e9);
    assert!(matches!(refused(&program, &request), RenderError::TooMuchWork { .. }), "steps are known");
    assert_eq!(render(&sums(of_pixel, 1_000_000), &one).pixels[0][0], 0.0);
    let endless = refused(&sums(of_pixel, u32::MAX), &one);
    assert!(matches!(endless, RenderError::TooMuchWork { .. }), "steps are not known, most counts");
}

/// Each function folds over the one before, `steps` times.
fn tower(height: u32, steps: i32) -> Program {
    let mut functions: Vec<Function> = Vec::new();
    for id in 0..height {
        let mut b = Builder::new("f");
        let x = b.input("x", Type::FLOAT);
        let step = b.input("step", Type::INT);
        let y = if id == 0 {
            let (step, one) = (b.to_float(step), number(&mut b, 1.0));
            let more = floats(&mut b, "+", step, one);
            floats(&mut b, "+", x, more)
        } else {
            let (steps, body) = (int(&mut b, steps), FunctionId(id - 1));
            b.fold(Fold { body, condition: None, starts: vec![x], steps, most: 9, captures: vec![] })[0]
        };
        b.output("y", y);
        functions.push(b.finish());
    }
    let mut b = Builder::new("test");
    let uv = b.input("uv", VEC2);
    let u = b.extract(uv, 0);
    let (steps, body) = (int(&mut b, steps), FunctionId(height - 1));
    let y = b.fold(Fold { body, condition: None, starts: vec![u], steps, most: 9, captures: vec![] })[0];
    b.output("y", y);
    functions.push(b.finish());
    of(functions)
}

#[test]
fn deep_folds_need_no_stack() {
    let run = || {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).stack_size(128 << 10).build();
        let picture = pool.expect("a pool").install(|| render(&tower(4096, 1), &Request::new([2, 1])));
        assert_eq!(picture.pixels[0][0], 1.25);
    };
    let small = std::thread::Builder::new().stack_size(128 << 10);
    small.spawn(run).expect("a thread").join().expect("no overflow");
}

#[test]
fn deep_folds_multiply_their_work() {
    assert_eq!(render(&tower(3, 3), &Request::new([2, 1])).pixels[0][0], 0.25 + 9.0 * 6.0);
    let refused = refused(&tower(64, 3), &Request::new([1, 1]));
    assert!(matches!(refused, RenderError::TooMuchWork { .. }), "{refused}");
}

/// Folds whose operands are all known, in a function that is called, are no work of the calls.
#[test]
fn known_folds_are_computed_in_planning() {
    let mut body = Builder::new("body");
    let n = body.input("n", Type::INT);
    body.input("step", Type::INT);
    let one = int(&mut body, 1);
    let other = ints(&mut body, "-", one, n);
    body.output("n", other);
    let mut called = Builder::new("called");
    let x = called.input("x", Type::FLOAT);
    let (zero, steps) = (int(&mut called, 0), int(&mut called, 999_999));
    let (body_id, starts) = (FunctionId(0), vec![zero]);
    let fold = Fold { body: body_id, condition: None, starts, steps, most: 999_999, captures: vec![] };
    let parity = called.fold(fold)[0];
    let parity = called.to_float(parity);
    let y = floats(&mut called, "+", x, parity);
    called.output("y", y);
    let called = called.finish();
    let mut b = Builder::new("test");
    let uv = b.input("uv", VEC2);
    let mut x = b.extract(uv, 0);
    // A million steps for each call would be more than a pixel may take.
    for _ in 0..1000 {
        x = b.call(FunctionId(1), &called, vec![x])[0];
    }
    b.output("x", x);
    let functions = vec![body.finish(), called, b.finish()];
    let picture = render(&of(functions), &Request::new([1, 1]));
    assert_eq!(picture.pixels[0][0], 1000.5);
}
