use std::collections::HashMap;
use std::time::Instant;
use texgraph_compiler::graph::evaluate::evaluate;
use texgraph_compiler::graph::*;
use texgraph_compiler::intrinsic::*;
use texgraph_compiler::pass::*;
fn time<T>(what: &str, f: impl FnOnce() -> T) -> T {
    let c = || {
        std::fs::read_to_string("/proc/thread-self/schedstat")
            .unwrap()
            .split(' ')
            .next()
            .unwrap()
            .parse::<f64>()
            .unwrap()
    };
    let t = c();
    let r = f();
    eprintln!("  {what}: {:.2} ms cpu", (c() - t) / 1e6);
    r
}
fn wide(n: usize) -> Graph {
    // n calls of n/10 functions, each with a fold, one after the other, differentiated.
    let mut functions = Vec::new();
    let k = n / 10;
    for i in 0..k {
        let mut b = Builder::new("body");
        let x = b.input("x", Type::FLOAT);
        b.input("step", Type::INT);
        let by = b.input("by", Type::FLOAT);
        let s = b.builtin(SIN, &[by]);
        let c = b.constant(Constant::floats(&[i as f32]));
        let s = b.builtin(ADD, &[s, c]);
        let y = b.builtin(MULTIPLY, &[x, s]);
        b.output("x", y);
        functions.push(b.finish());
        let mut b = Builder::new("node");
        let x = b.input("x", Type::FLOAT);
        let t = b.input("t", Type::FLOAT);
        let t = b.builtin(EXP, &[t]);
        let steps = b.constant(Constant::ints(&[9]));
        let y = b.fold(Fold {
            body: FunctionId(2 * i as u32),
            condition: None,
            starts: vec![x],
            steps,
            most: 9,
            captures: vec![t],
        })[0];
        let y = b.builtin(DIVIDE, &[y, t]);
        b.output("y", y);
        functions.push(b.finish());
    }
    let mut b = Builder::new("entry");
    let uv = b.input("uv", Type::Vector(Scalar::Float, 2));
    let t = b.input("time", Type::FLOAT);
    let mut x = b.extract(uv, 0);
    for i in 0..n {
        let id = 2 * (i % k) + 1;
        let f = functions[id].clone();
        let c = b.constant(Constant::floats(&[(i % 7) as f32]));
        let t = b.builtin(ADD, &[t, c]);
        x = b.call(FunctionId(id as u32), &f, vec![x, t])[0];
        x = b.builtin(SIN, &[x]);
    }
    let d = b.push(Operation::Derivative(x, Axis::X), Type::FLOAT);
    b.output("x", x);
    b.output("d", d);
    functions.push(b.finish());
    Graph { functions, ..Graph::default() }
}
fn deep(n: usize) -> Graph {
    let mut functions: Vec<Function> = Vec::new();
    for i in 0..n {
        let mut b = Builder::new("next");
        let x = b.input("x", Type::FLOAT);
        let t = b.input("t", Type::FLOAT);
        let x = b.builtin(SIN, &[x]);
        let c = b.constant(Constant::floats(&[1.0]));
        let t = b.builtin(ADD, &[t, c]);
        let y = if i == 0 {
            b.builtin(MULTIPLY, &[x, t])
        } else {
            let f = functions[i - 1].clone();
            b.call(FunctionId(i as u32 - 1), &f, vec![x, t])[0]
        };
        b.output("y", y);
        functions.push(b.finish());
    }
    let mut b = Builder::new("entry");
    let uv = b.input("uv", Type::Vector(Scalar::Float, 2));
    let t = b.input("time", Type::FLOAT);
    let x = b.extract(uv, 0);
    let f = functions[n - 1].clone();
    let x = b.call(FunctionId(n as u32 - 1), &f, vec![x, t])[0];
    let d = b.push(Operation::Derivative(x, Axis::X), Type::FLOAT);
    b.output("x", x);
    b.output("d", d);
    functions.push(b.finish());
    Graph { functions, ..Graph::default() }
}
fn avg(n: usize, reps: usize, make: fn(usize) -> Graph) {
    let names = ["inline", "differentiate", "hoist", "remove_dead"];
    let passes: [fn(Graph) -> Graph; 4] = [inline::run, differentiate::run, hoist::run, remove_dead::run];
    let mut mins = [f64::MAX; 4];
    let g0 = make(n);
    let input: usize = g0.functions.iter().map(|f| f.values.len()).sum();
    let mut output = 0;
    for _ in 0..reps {
        let mut g = g0.clone();
        for (i, pass) in passes.iter().enumerate() {
            let t = Instant::now();
            g = pass(g);
            mins[i] = mins[i].min(t.elapsed().as_secs_f64() * 1e3);
        }
        output = g.functions.iter().map(|f| f.values.len()).sum();
    }
    eprintln!(
        "{n} ({input} -> {output} values): {} = {:.2} ms",
        names.iter().zip(mins).map(|(n, t)| format!("{n} {t:.3}")).collect::<Vec<_>>().join(", "),
        mins.iter().sum::<f64>()
    );
}
/// A graph as a user writes it: calls of library-like nodes, arithmetic, mixes, one in ten a fold.
fn mixed(n: usize) -> Graph {
    let mut functions = Vec::new();
    let vec2 = Type::Vector(Scalar::Float, 2);
    let mut b = Builder::new("noise");
    let p = b.input("p", vec2);
    let cell = b.builtin(FLOOR, &[p]);
    b.name(cell, "cell");
    let at = b.builtin(SUBTRACT, &[p, cell]);
    b.name(at, "at");
    let s = b.builtin(MULTIPLY, &[at, at]);
    let s = b.builtin(MULTIPLY, &[s, at]);
    b.name(s, "s");
    let x = b.extract(s, 0);
    let y = b.extract(s, 1);
    let d = b.builtin(DIVIDE, &[x, y]);
    let r = b.builtin(ADD, &[d, x]);
    b.output("n", r);
    functions.push(b.finish());
    let mut b = Builder::new("remap");
    b.set_inline(true);
    let x = b.input("x", Type::FLOAT);
    let lo = b.input("lo", Type::FLOAT);
    let hi = b.input("hi", Type::FLOAT);
    let d = b.builtin(SUBTRACT, &[hi, lo]);
    let r = b.builtin(MULTIPLY, &[x, d]);
    let r = b.builtin(ADD, &[r, lo]);
    b.output("y", r);
    functions.push(b.finish());
    let mut b = Builder::new("body");
    let v = b.input("v", Type::FLOAT);
    let s = b.input("s", Type::FLOAT);
    b.input("i", Type::INT);
    let p = b.input("p", vec2);
    let q = b.compose(&[s, s]);
    let q = b.builtin(MULTIPLY, &[q, p]);
    let m = b.call(FunctionId(0), &functions[0].clone(), vec![q])[0];
    let v = b.builtin(ADD, &[v, m]);
    let s2 = b.builtin(ADD, &[s, s]);
    b.output("v", v);
    b.output("s", s2);
    functions.push(b.finish());
    let mut b = Builder::new("fbm");
    let p = b.input("p", vec2);
    let zero = b.constant(Constant::floats(&[0.0]));
    let one = b.constant(Constant::floats(&[1.0]));
    let steps = b.constant(Constant::ints(&[5]));
    let r = b.fold(Fold {
        body: FunctionId(2),
        condition: None,
        starts: vec![zero, one],
        steps,
        most: 5,
        captures: vec![p],
    })[0];
    b.output("r", r);
    functions.push(b.finish());
    let mut b = Builder::new("entry");
    let uv = b.input("uv", vec2);
    let scale = b.push(Operation::Param(ParamId(0)), Type::FLOAT);
    let mut x = b.extract(uv, 0);
    for i in 0..n {
        let c = b.constant(Constant::floats(&[(i as f32) + 0.5]));
        x = match i % 10 {
            0 => {
                let q = b.compose(&[c, x]);
                let q = b.builtin(ADD, &[uv, q]);
                b.call(FunctionId(0), &functions[0].clone(), vec![q])[0]
            }
            1 => {
                let q = b.compose(&[c, x]);
                b.call(FunctionId(3), &functions[3].clone(), vec![q])[0]
            }
            2 | 3 => b.call(FunctionId(1), &functions[1].clone(), vec![x, c, scale])[0],
            4 => b.builtin(MIX, &[x, scale, c]),
            5 => {
                let y = b.builtin(MULTIPLY, &[x, c]);
                b.builtin(SIN, &[y])
            }
            6 => b.builtin(DIVIDE, &[x, scale]),
            _ => b.builtin(ADD, &[x, c]),
        };
        b.name(x, &format!("wire_{i}"));
    }
    b.output("x", x);
    functions.push(b.finish());
    let p = Param {
        name: "scale".into(),
        label: String::new(),
        ty: Type::FLOAT,
        default: Constant::floats(&[1.0]),
        range: None,
    };
    Graph { functions, params: vec![p], ..Graph::default() }
}
#[test]
fn timing() {
    let e = |n: &str| std::env::var(n).unwrap();
    let (n, r): (usize, usize) = (e("N").parse().unwrap(), e("R").parse().unwrap());
    avg(n, r, if e("G") == "wide" { wide } else { mixed });
}
