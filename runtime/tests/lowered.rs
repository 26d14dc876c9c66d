//! Random graphs of ints with choices, calls, tables and folds inside each other: what the shader
//! gives at each pixel is what the graph evaluates to. Without an adapter the test is shown as
//! ignored, unless `TEXGRAPH_GPU=required`.

use libtest_mimic::{Arguments, Failed, Trial};
use std::sync::Arc;
use texgraph_compiler::graph::evaluate::evaluate;
use texgraph_compiler::graph::{
    Builder, Constant, Fold, Function, FunctionId, Graph, PassGraph, Scalar, Type, Value,
};
use texgraph_compiler::intrinsic::{
    ADD_INT, BITWISE_AND, EXCLUSIVE_OR, FLOOR, Intrinsic, LESS_INT, MAXIMUM_INT, MINIMUM_INT, MULTIPLY,
    MULTIPLY_INT, SUBTRACT_INT, TO_FLOAT, TO_INT,
};
use texgraph_compiler::{Options, Pass, Program, contract, emit, lower};
use texgraph_runtime::gpu::{Gpu, Preference};
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::Tables;

const PROGRAMS: u64 = 60;
const SIDE: u32 = 16;
const TIME: f32 = 5.0;

fn main() {
    let arguments = Arguments::from_args();
    let required = std::env::var("TEXGRAPH_GPU").is_ok_and(|value| value == "required");
    let gpu = Gpu::new(Preference::Hardware);
    if let Err(error) = &gpu {
        eprintln!("{error}");
    }
    let ignored = gpu.is_err() && !required;
    let run = move || {
        let gpu = gpu.map_err(|error| error.to_string())?;
        (0..PROGRAMS).try_for_each(|seed| shaders_give_what_graphs_do(&gpu, seed))
    };
    let trial = Trial::test("shaders_give_what_graphs_do", run).with_ignored_flag(ignored);
    libtest_mimic::run(&arguments, vec![trial]).exit();
}

/// Random numbers, the same everywhere (a linear congruential generator).
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % bound
    }

    fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }
}

/// Functions in the making, callees first.
struct Making {
    random: Random,
    functions: Vec<Function>,
    /// Those that may be called: no steps of folds.
    callable: Vec<FunctionId>,
}

/// A function in the making with its ints.
struct Scope {
    b: Builder,
    ints: Vec<Value>,
}

impl Scope {
    fn new(name: &str, inputs: &[String]) -> Scope {
        let mut b = Builder::new(name);
        let ints = inputs.iter().map(|name| b.input(name, Type::INT)).collect();
        Scope { b, ints }
    }

    fn int(&mut self, number: usize) -> Value {
        self.b.constant(Constant::ints(&[number as i32]))
    }
}

impl Making {
    fn add(&mut self, function: Function) -> FunctionId {
        self.functions.push(function);
        FunctionId(self.functions.len() as u32 - 1)
    }

    /// One of the latest values, mostly.
    fn pick(&mut self, scope: &Scope) -> Value {
        let count = scope.ints.len();
        let back = self.random.below(count).min(self.random.below(count));
        scope.ints[count - 1 - back]
    }

    fn grow(&mut self, scope: &mut Scope, operations: usize, folds: usize) {
        for _ in 0..operations {
            let value = match self.random.below(16) {
                0..6 => self.arithmetic(scope),
                6..11 => self.choice(scope),
                11 => self.table(scope),
                12 if !self.callable.is_empty() => self.call(scope),
                13..15 if folds > 0 => self.fold(scope, folds - 1),
                _ => {
                    let number = self.random.below(40);
                    scope.int(number)
                }
            };
            if self.random.below(4) == 0 {
                let name = self.random.of(&["pick", "cell", "sum", "loop", "sum_b", "i"]);
                scope.b.name(value, name);
            }
            scope.ints.push(value);
        }
    }

    fn arithmetic(&mut self, scope: &mut Scope) -> Value {
        let all: [Intrinsic; 7] =
            [ADD_INT, SUBTRACT_INT, MULTIPLY_INT, MINIMUM_INT, MAXIMUM_INT, BITWISE_AND, EXCLUSIVE_OR];
        let intrinsic = self.random.of(&all);
        let both = [self.pick(scope), self.pick(scope)];
        scope.b.builtin(intrinsic, &both)
    }

    fn choice(&mut self, scope: &mut Scope) -> Value {
        let [a, b, yes, no] = [(); 4].map(|()| self.pick(scope));
        // Few conditions, so that choices share them.
        let bound = [a, b][self.random.below(2)];
        let seven = scope.int(7);
        let condition = scope.b.builtin(LESS_INT, &[scope.ints[0], seven]);
        let own = scope.b.builtin(LESS_INT, &[a, bound]);
        let condition = self.random.of(&[condition, own]);
        scope.b.select(condition, yes, no)
    }

    fn table(&mut self, scope: &mut Scope) -> Value {
        let entries = 2 + self.random.below(8);
        let table: Arc<[Constant]> =
            (0..entries).map(|_| Constant::ints(&[self.random.below(100) as i32])).collect();
        let (index, mask) = (self.pick(scope), scope.int(15));
        let index = scope.b.builtin(BITWISE_AND, &[index, mask]);
        scope.b.lookup(table, index)
    }

    fn call(&mut self, scope: &mut Scope) -> Value {
        let id = self.random.of(&self.callable);
        let callee = &self.functions[id.0 as usize];
        let (inputs, outputs) = (callee.inputs.len(), callee.outputs.len());
        let arguments = (0..inputs).map(|_| self.pick(scope)).collect();
        let results = scope.b.call(id, &self.functions[id.0 as usize], arguments);
        results[self.random.below(outputs)]
    }

    fn fold(&mut self, scope: &mut Scope, folds: usize) -> Value {
        let accumulators = 1 + self.random.below(3);
        let captures = self.random.below(3);
        let heads: Vec<String> =
            (0..accumulators).map(|_| self.random.of(&["sum", "hit", "i"]).to_owned()).collect();
        let over: Vec<String> = (0..captures).map(|i| format!("over{i}")).collect();
        let condition = (self.random.below(2) == 0).then(|| self.condition(&heads, &over));
        let inputs = [heads.as_slice(), &["i".to_owned()], &over].concat();
        let mut body = Scope::new("step", &inputs);
        let operations = 3 + self.random.below(8);
        self.grow(&mut body, operations, folds);
        for head in &heads {
            let next = self.pick(&body);
            body.b.name(next, head.as_str());
            body.b.output(head, next);
        }
        let body = self.add(body.b.finish());
        let starts = (0..accumulators).map(|_| self.pick(scope)).collect();
        let captures = (0..captures).map(|_| self.pick(scope)).collect();
        let count = self.random.below(5);
        let steps = [self.pick(scope), scope.int(count)][self.random.below(2)];
        let fold = Fold { body, condition, starts, steps, most: 3, captures };
        let results = scope.b.fold(fold);
        scope.ints.extend(&results);
        results[self.random.below(results.len())]
    }

    fn condition(&mut self, heads: &[String], over: &[String]) -> FunctionId {
        let mut scope = Scope::new("condition", &[heads, over].concat());
        self.grow(&mut scope, 2, 0);
        let (last, bound) = (self.pick(&scope), scope.int(30));
        let holds = scope.b.builtin(LESS_INT, &[last, bound]);
        scope.b.output("holds", holds);
        self.add(scope.b.finish())
    }

    /// A function that others call.
    fn callee(&mut self) {
        let mut scope = Scope::new("node", &["x".to_owned(), "y".to_owned()]);
        let operations = 2 + self.random.below(8);
        self.grow(&mut scope, operations, 1);
        for i in 0..1 + self.random.below(2) {
            let value = self.pick(&scope);
            scope.b.output(format!("out{i}"), value);
        }
        let id = self.add(scope.b.finish());
        self.callable.push(id);
    }

    /// The texture: four bytes of four ints.
    fn entry(&mut self) {
        let mut scope = Scope::new("test", &[]);
        let uv = scope.b.input("uv", Type::Vector(Scalar::Float, 2));
        let time = scope.b.input("time", Type::FLOAT);
        let side = scope.b.constant(Constant::floats(&[SIDE as f32; 2]));
        let pixel = scope.b.builtin(MULTIPLY, &[uv, side]);
        let pixel = scope.b.builtin(FLOOR, &[pixel]);
        let pixel = scope.b.builtin(TO_INT, &[pixel]);
        scope.ints = vec![scope.b.extract(pixel, 0), scope.b.extract(pixel, 1)];
        let time = scope.b.builtin(TO_INT, &[time]);
        scope.ints.push(time);
        self.grow(&mut scope, 24, 3);
        let mask = scope.int(255);
        let bytes: Vec<Value> = (0..4)
            .map(|_| {
                let value = self.pick(&scope);
                let byte = scope.b.builtin(BITWISE_AND, &[value, mask]);
                scope.b.builtin(TO_FLOAT, &[byte])
            })
            .collect();
        let color = scope.b.compose(&bytes);
        scope.b.output("color", color);
        self.functions.push(scope.b.finish());
    }
}

fn random_graph(seed: u64) -> Graph {
    let mut making = Making { random: Random(seed), functions: Vec::new(), callable: Vec::new() };
    (0..making.random.below(4)).for_each(|_| making.callee());
    making.entry();
    Graph { functions: making.functions, ..Graph::default() }
}

fn shaders_give_what_graphs_do(gpu: &Gpu, seed: u64) -> Result<(), Failed> {
    let graphs = [PassGraph { graph: random_graph(seed), bake: None }];
    let manifest = contract::manifest(&graphs, "", &Options::default());
    let lowered =
        lower::lower(&graphs[0].graph, &contract::of_pass(&manifest, 0), &lower::Objects::default());
    let [PassGraph { graph, .. }] = graphs;
    let wgsl = emit::wgsl(&lowered).map_err(|error| format!("{seed}: {error}\n{graph}"))?;
    let program = Program { passes: vec![Pass { graph, wgsl }], manifest };
    let graph = &program.passes[0].graph;
    let request = Request { time: TIME, ..Request::new([SIDE, SIDE]) };
    let mut scene =
        gpu.prepare(&program, &Tables::default(), 0).map_err(|error| format!("{seed}: {error}"))?;
    let picture = scene.render(&request, &|_| {}).map_err(|error| format!("{seed}: {error}"))?;
    for (i, pixel) in (0..SIDE * SIDE).zip(&picture.pixels) {
        let uv = [i % SIDE, i / SIDE].map(|at| (at as f32 + 0.5) / SIDE as f32);
        let inputs = [Constant::floats(&uv), Constant::floats(&[TIME])];
        let wanted = evaluate(&graph.functions, graph.entry(), &inputs, &mut u64::MAX.clone())
            .map_err(|stopped| format!("{seed}: {stopped:?}"))?;
        let wanted: [f32; 4] = std::array::from_fn(|i| wanted[0].float(i));
        if *pixel != wanted {
            let wgsl = &program.passes[0].wgsl;
            return Err(format!("{seed}, {uv:?}: {pixel:?}, not {wanted:?}\n{graph}\n{wgsl}").into());
        }
    }
    Ok(())
}
