//! Screen-space derivatives by forward differentiation of the graph, on demand.
//!
//! A sample needs the gradient of its coordinate; a function is made anew for every combination of
//! inputs that change across the screen and outputs whose change is wanted (a `Variant`). Only
//! values that reach a sample or a `dx`/`dy` get a tangent. The rules are in the intrinsic table;
//! what comes out of a sample or a fetch, and every integer, counts as constant.
//!
//! Analyses first, along arena order, so nothing recurses: what each output depends on, and which
//! inputs' changes a function needs inside. Then variants are requested from callers to callees,
//! and made from callees to callers.

use crate::graph::{Axis, Builder, Constant, Function, FunctionId, Graph, Level, Operation, Type, Value};
use crate::input::is_per_draw;
use crate::intrinsic::{self, Derivative, Tangents};
use rustc_hash::FxHashMap;

/// A set of inputs. Inputs from 127 on share a bit: they may count as dependent when they are not.
type Inputs = u128;

fn bit(input: usize) -> Inputs {
    1 << input.min(127)
}

/// What is known of a function before variants are made.
struct Known {
    /// For each value the inputs that it changes with.
    depends: Vec<Inputs>,
    /// For each output the same.
    outputs: Vec<Inputs>,
    /// The inputs whose change is needed inside.
    needed: Inputs,
}

/// A function with tangents: inputs that change, and outputs whose change is wanted.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Variant {
    changing: Inputs,
    wanted: Vec<bool>,
}

/// A variant that was made.
struct Made {
    id: FunctionId,
    /// For each output the places of its tangents among the outputs, if it has any.
    tangents: Vec<Option<[u32; 2]>>,
}

/// Replaces every `Level::Auto` by gradients and every inner derivative by its value.
pub fn run(graph: Graph) -> Graph {
    let mut known: Vec<Known> = Vec::with_capacity(graph.functions.len());
    for function in &graph.functions {
        known.push(analyse(function, &known));
    }
    let requests = request(&graph, &known);
    let mut functions = Vec::new();
    let mut made: FxHashMap<(usize, Variant), Made> = FxHashMap::default();
    for (i, function) in graph.functions.iter().enumerate() {
        let entry = i + 1 == graph.functions.len();
        for variant in &requests[i] {
            let (new, tangents) = make(function, &known[i], &known, variant, &made, entry);
            functions.push(new);
            made.insert((i, variant.clone()), Made { id: FunctionId(functions.len() as u32 - 1), tangents });
        }
    }
    Graph { functions, ..graph }
}

/// Forward: what changes with what.
fn analyse(function: &Function, callees: &[Known]) -> Known {
    let mut depends: Vec<Inputs> = Vec::with_capacity(function.values.len());
    let mut needed = 0;
    for (value, operation) in function.iter() {
        let of = |v: &Value| depends[v.0 as usize];
        let any = |vs: &[Value]| vs.iter().map(of).fold(0, |all, one| all | one);
        needed |= match operation {
            Operation::Sample { coordinate, level: Level::Auto, .. } => of(coordinate),
            Operation::Derivative(v, _) => of(v),
            Operation::Call(callee, arguments) => {
                let inner = callees[callee.0 as usize].needed;
                let inside = arguments.iter().enumerate().filter(|(i, _)| inner & bit(*i) != 0);
                inside.map(|(_, v)| of(v)).fold(0, |all, one| all | one)
            }
            _ => 0,
        };
        let own = match operation {
            Operation::Input(i) => bit(*i as usize),
            Operation::Builtin(intrinsic, arguments) => match intrinsic.row().derivative {
                Derivative::Zero => 0,
                Derivative::Rule(_) => any(arguments),
            },
            Operation::Compose(parts) => any(parts),
            Operation::Extract(v, _) => of(v),
            Operation::Select(_, yes, no) => of(yes) | of(no),
            Operation::Output(call, i) => match function.operation(*call) {
                Operation::Call(callee, arguments) => {
                    let inner = callees[callee.0 as usize].outputs.get(*i as usize).copied().unwrap_or(0);
                    let inside = arguments.iter().enumerate().filter(|(i, _)| inner & bit(*i) != 0);
                    inside.map(|(_, v)| of(v)).fold(0, |all, one| all | one)
                }
                _ => 0,
            },
            _ => 0,
        };
        depends.push(if function.ty(value).is_float() { own } else { 0 });
    }
    let outputs = function.outputs.iter().map(|(_, value)| depends[value.0 as usize]).collect();
    Known { depends, outputs, needed }
}

/// Backward: the variants that are needed, callers before callees.
fn request(graph: &Graph, known: &[Known]) -> Vec<Vec<Variant>> {
    let mut requests: Vec<Vec<Variant>> = graph.functions.iter().map(|_| Vec::new()).collect();
    let Some(entry) = graph.functions.last() else { return requests };
    let changing = entry.inputs.iter().enumerate().filter(|(_, slot)| changes(slot.ty, &slot.name));
    let changing = changing.map(|(i, _)| bit(i)).fold(0, |all, one| all | one);
    let wanted = vec![false; entry.outputs.len()];
    requests[graph.functions.len() - 1].push(Variant { changing, wanted });
    for i in (0..graph.functions.len()).rev() {
        for variant in requests[i].clone() {
            let function = &graph.functions[i];
            let demanded = demand(function, &known[i], known, &variant);
            for (call, operation) in function.iter() {
                if let Operation::Call(callee, _) = operation {
                    let callee = callee.0 as usize;
                    let variant = variant_of(function, call, &known[i], known, &variant, &demanded);
                    if !requests[callee].contains(&variant) {
                        requests[callee].push(variant);
                    }
                }
            }
        }
    }
    requests
}

fn changes(ty: Type, name: &str) -> bool {
    ty.is_float() && !is_per_draw(name)
}

/// Which values of a variant need a tangent.
fn demand(function: &Function, own: &Known, known: &[Known], variant: &Variant) -> Vec<bool> {
    let active = |v: Value| own.depends[v.0 as usize] & variant.changing != 0;
    let mut demanded = vec![false; function.values.len()];
    for ((_, value), wanted) in function.outputs.iter().zip(&variant.wanted) {
        demanded[value.0 as usize] |= *wanted && active(*value);
    }
    for (value, operation) in function.iter().rev() {
        let mut need = |v: Value| demanded[v.0 as usize] |= active(v);
        match operation {
            Operation::Sample { coordinate, level: Level::Auto, .. } => need(*coordinate),
            Operation::Derivative(v, _) => need(*v),
            Operation::Call(callee, arguments) => {
                let inner = known[callee.0 as usize].needed;
                arguments
                    .iter()
                    .enumerate()
                    .filter(|(i, _)| inner & bit(*i) != 0)
                    .for_each(|(_, v)| need(*v));
            }
            _ => {}
        }
        if !demanded[value.0 as usize] {
            continue;
        }
        let mut need = |v: Value| demanded[v.0 as usize] |= active(v);
        match operation {
            Operation::Select(_, yes, no) => [*yes, *no].into_iter().for_each(need),
            Operation::Output(call, i) => {
                if let Operation::Call(callee, arguments) = function.operation(*call) {
                    let inner = known[callee.0 as usize].outputs[*i as usize];
                    arguments
                        .iter()
                        .enumerate()
                        .filter(|(i, _)| inner & bit(*i) != 0)
                        .for_each(|(_, v)| need(*v));
                }
            }
            Operation::Builtin(..) | Operation::Compose(_) | Operation::Extract(..) => {
                operation.for_operands(&mut need)
            }
            _ => {}
        }
    }
    demanded
}

/// The variant of a callee that a call in a variant of its caller needs.
fn variant_of(
    function: &Function,
    call: Value,
    own: &Known,
    known: &[Known],
    variant: &Variant,
    demanded: &[bool],
) -> Variant {
    let Operation::Call(callee, arguments) = function.operation(call) else {
        return Variant { changing: 0, wanted: Vec::new() };
    };
    let callee = &known[callee.0 as usize];
    let mut wanted = vec![false; callee.outputs.len()];
    for (value, operation) in function.iter() {
        if let Operation::Output(of, i) = operation
            && *of == call
            && demanded[value.0 as usize]
        {
            wanted[*i as usize] = true;
        }
    }
    let through = wanted.iter().zip(&callee.outputs).filter(|(wanted, _)| **wanted);
    let useful = through.map(|(_, inputs)| *inputs).fold(callee.needed, |all, one| all | one);
    let changing = arguments
        .iter()
        .enumerate()
        .filter(|(i, v)| useful & bit(*i) != 0 && own.depends[v.0 as usize] & variant.changing != 0);
    Variant { changing: changing.map(|(i, _)| bit(i)).fold(0, |all, one| all | one), wanted }
}

/// A variant in the making.
struct Making<'a> {
    function: &'a Function,
    builder: Builder,
    values: Vec<Value>,
    tangents: Vec<Option<[Value; 2]>>,
}

impl Making<'_> {
    fn value(&self, old: Value) -> Value {
        self.values[old.0 as usize]
    }

    /// The tangents of a value; zeros where it does not change.
    fn tangent(&mut self, old: Value) -> [Value; 2] {
        let zero = intrinsic::zero(self.function.ty(old)).unwrap_or(Constant::floats(&[0.0]));
        self.tangents[old.0 as usize].unwrap_or_else(|| [self.builder.constant(zero); 2])
    }

    fn name_tangents(&mut self, name: &str, tangents: [Value; 2]) {
        for (value, axis) in tangents.into_iter().zip(["dx", "dy"]) {
            self.builder.name(value, &format!("{name}_{axis}"));
        }
    }
}

fn make(
    function: &Function,
    own: &Known,
    known: &[Known],
    variant: &Variant,
    made: &FxHashMap<(usize, Variant), Made>,
    entry: bool,
) -> (Function, Vec<Option<[u32; 2]>>) {
    let demanded = demand(function, own, known, variant);
    let mut m = Making {
        function,
        builder: Builder::new(function.name.clone()),
        values: Vec::with_capacity(function.values.len()),
        tangents: Vec::with_capacity(function.values.len()),
    };
    let inputs: Vec<Value> =
        function.inputs.iter().map(|slot| m.builder.input(slot.name.clone(), slot.ty)).collect();
    let input_tangents = tangent_inputs(&mut m, &inputs, variant, entry);
    for (old, operation) in function.iter() {
        m.builder.set_place(function.places[old.0 as usize]);
        let call = match operation {
            Operation::Call(callee, _) => {
                let wanted = variant_of(function, old, own, known, variant, &demanded);
                made.get(&(callee.0 as usize, wanted.clone())).map(|made| (made, wanted))
            }
            _ => None,
        };
        let value = copy(&mut m, old, operation, call);
        m.values.push(value);
        let tangents = if demanded[old.0 as usize] {
            differentiate(&mut m, old, operation, &input_tangents, |call| {
                let Operation::Call(callee, _) = function.operation(call) else { return None };
                made.get(&(callee.0 as usize, variant_of(function, call, own, known, variant, &demanded)))
            })
        } else {
            None
        };
        m.tangents.push(tangents);
        if let Some(name) = function.names.get(&old) {
            m.builder.name(value, name);
            if let Some(tangents) = tangents {
                m.name_tangents(name, tangents);
            }
        }
    }
    outputs(m, variant)
}

/// The tangents of the inputs: of the entry what the screen says, else inputs behind the others.
fn tangent_inputs(
    m: &mut Making,
    inputs: &[Value],
    variant: &Variant,
    entry: bool,
) -> Vec<Option<[Value; 2]>> {
    let mut tangents = Vec::new();
    for (i, (slot, input)) in m.function.inputs.iter().zip(inputs).enumerate() {
        if variant.changing & bit(i) == 0 || !slot.ty.is_float() {
            tangents.push(None);
            continue;
        }
        let pair = [(Axis::X, "dx"), (Axis::Y, "dy")].map(|(axis, suffix)| {
            let name = format!("{}_{suffix}", slot.name);
            if entry {
                let value = m.builder.push(Operation::Derivative(*input, axis), slot.ty);
                m.builder.name(value, &name);
                value
            } else {
                m.builder.input(name, slot.ty)
            }
        });
        tangents.push(Some(pair));
    }
    tangents
}

/// The operation itself over new values, levels and inner derivatives replaced.
fn copy(m: &mut Making, old: Value, operation: &Operation, call: Option<(&Made, Variant)>) -> Value {
    let ty = m.function.ty(old);
    match operation {
        Operation::Derivative(v, axis) => m.tangent(*v)[usize::from(*axis == Axis::Y)],
        Operation::Sample { view, coordinate, layer, level: Level::Auto } => {
            let level = match m.tangents[coordinate.0 as usize] {
                Some([x, y]) => Level::Gradient(x, y),
                // What does not change across the screen shows the finest level.
                None => Level::Level(m.builder.constant(Constant::floats(&[0.0]))),
            };
            let layer = layer.map(|v| m.value(v));
            let (view, coordinate) = (m.value(*view), m.value(*coordinate));
            m.builder.push(Operation::Sample { view, coordinate, layer, level }, ty)
        }
        Operation::Call(_, arguments) => {
            let Some((made, variant)) = call else { return Value(0) };
            let mut all: Vec<Value> = arguments.iter().map(|v| m.value(*v)).collect();
            for (i, argument) in arguments.iter().enumerate() {
                if variant.changing & bit(i) != 0 && m.function.ty(*argument).is_float() {
                    let tangents = m.tangent(*argument);
                    all.extend(tangents);
                }
            }
            m.builder.push(Operation::Call(made.id, all), ty)
        }
        _ => {
            let copy = operation.map_operands(|v| m.values[v.0 as usize]);
            m.builder.push(copy, ty)
        }
    }
}

/// The tangents of a value that needs them.
fn differentiate<'k>(
    m: &mut Making,
    old: Value,
    operation: &Operation,
    inputs: &[Option<[Value; 2]>],
    made: impl Fn(Value) -> Option<&'k Made>,
) -> Option<[Value; 2]> {
    let ty = m.function.ty(old);
    let pair = match operation {
        Operation::Input(i) => return inputs.get(*i as usize).copied().flatten(),
        Operation::Builtin(intrinsic, arguments) => {
            let Derivative::Rule(rule) = intrinsic.row().derivative else { return None };
            let new: Vec<Value> = arguments.iter().map(|v| m.value(*v)).collect();
            let changes: Vec<[Value; 2]> = arguments.iter().map(|v| m.tangent(*v)).collect();
            [0, 1].map(|axis| {
                let tangents: Vec<Value> = changes.iter().map(|pair| pair[axis]).collect();
                let result = m.values[old.0 as usize];
                rule(&mut Tangents { builder: &mut m.builder, arguments: &new, result, tangents: &tangents })
            })
        }
        Operation::Compose(parts) => {
            let changes: Vec<[Value; 2]> = parts.iter().map(|v| m.tangent(*v)).collect();
            [0, 1].map(|axis| {
                let parts: Vec<Value> = changes.iter().map(|pair| pair[axis]).collect();
                m.builder.compose(&parts)
            })
        }
        Operation::Extract(v, i) => m.tangent(*v).map(|t| m.builder.extract(t, *i)),
        Operation::Select(condition, yes, no) => {
            let (condition, yes, no) = (m.value(*condition), m.tangent(*yes), m.tangent(*no));
            [0, 1].map(|axis| m.builder.select(condition, yes[axis], no[axis]))
        }
        Operation::Output(call, i) => {
            let places = made(*call)?.tangents.get(*i as usize).copied().flatten()?;
            let call = m.value(*call);
            places.map(|place| m.builder.push(Operation::Output(call, place), ty))
        }
        _ => return None,
    };
    Some(pair)
}

/// The variant's outputs: the function's own, then the tangents that are wanted.
fn outputs(mut m: Making, variant: &Variant) -> (Function, Vec<Option<[u32; 2]>>) {
    for (slot, value) in &m.function.outputs {
        let value = m.value(*value);
        m.builder.output(slot.name.clone(), value);
    }
    let mut places = Vec::new();
    let mut next = m.function.outputs.len() as u32;
    for ((slot, value), wanted) in m.function.outputs.iter().zip(&variant.wanted) {
        let tangents = m.tangents[value.0 as usize].filter(|_| *wanted);
        places.push(tangents.map(|_| [next, next + 1]));
        for (tangent, axis) in tangents.into_iter().flatten().zip(["dx", "dy"]) {
            m.builder.output(format!("{}_{axis}", slot.name), tangent);
            next += 1;
        }
    }
    (m.builder.finish(), places)
}
