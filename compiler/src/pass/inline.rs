//! A node written as a single expression is taken over by its callers; any other stays a function.
//! Functions that nobody calls any more are dropped.

use crate::graph::{Builder, Function, FunctionId, Graph, Operation, Value};
use rustc_hash::FxHashMap;

/// Takes single expressions over, whatever their depth.
pub fn run(graph: Graph) -> Graph {
    let kept = reachable(&graph);
    let mut ids: Vec<Option<FunctionId>> = vec![None; graph.functions.len()];
    let mut functions = Vec::new();
    for (i, function) in graph.functions.iter().enumerate() {
        let entry = i + 1 == graph.functions.len();
        if kept[i] && (entry || !function.inline) {
            functions.push(expanded(&graph, function, &ids));
            ids[i] = Some(FunctionId(functions.len() as u32 - 1));
        }
    }
    Graph { functions, ..graph }
}

/// Which functions the entry calls, through any number of calls.
fn reachable(graph: &Graph) -> Vec<bool> {
    let mut reached = vec![false; graph.functions.len()];
    if let Some(entry) = reached.last_mut() {
        *entry = true;
    }
    // Callees come first, so one walk from the end meets every caller before its callees.
    for i in (0..graph.functions.len()).rev() {
        if !reached[i] {
            continue;
        }
        for operation in &graph.functions[i].values {
            if let Operation::Call(callee, _) = operation {
                reached[callee.0 as usize] = true;
            }
        }
    }
    reached
}

/// A function whose operations are being copied.
struct Copying<'a> {
    function: &'a Function,
    arguments: Vec<Value>,
    next: usize,
    values: Vec<Value>,
    /// The outputs of calls that were taken over, by the call.
    outputs: FxHashMap<Value, Vec<Value>>,
}

impl<'a> Copying<'a> {
    fn new(function: &'a Function, arguments: Vec<Value>) -> Copying<'a> {
        Copying { function, arguments, next: 0, values: Vec::new(), outputs: FxHashMap::default() }
    }

    fn value(&self, old: Value) -> Value {
        self.values.get(old.0 as usize).copied().unwrap_or(Value(0))
    }
}

/// A function with the calls of single expressions replaced by them.
fn expanded(graph: &Graph, function: &Function, ids: &[Option<FunctionId>]) -> Function {
    let mut builder = Builder::new(function.name.clone());
    let inputs = function.inputs.iter().map(|slot| builder.input(slot.name.clone(), slot.ty)).collect();
    let mut stack = vec![Copying::new(function, inputs)];
    while let Some(top) = stack.last_mut() {
        let Some(operation) = top.function.values.get(top.next) else {
            let outputs: Vec<Value> =
                top.function.outputs.iter().map(|(_, value)| top.value(*value)).collect();
            stack.pop();
            match stack.last_mut() {
                Some(caller) => {
                    let call = Value(caller.values.len() as u32 - 1);
                    caller.outputs.insert(call, outputs);
                }
                None => function.outputs.iter().zip(outputs).for_each(|((slot, _), value)| {
                    builder.output(slot.name.clone(), value);
                }),
            }
            continue;
        };
        let old = Value(top.next as u32);
        top.next += 1;
        builder.set_place(top.function.places[old.0 as usize]);
        match operation {
            Operation::Input(i) => {
                let argument = top.arguments.get(*i as usize).copied().unwrap_or(Value(0));
                top.values.push(argument);
            }
            Operation::Call(callee, arguments) if ids[callee.0 as usize].is_none() => {
                let arguments = arguments.iter().map(|v| top.value(*v)).collect();
                // Stands for the call; only its outputs are read.
                top.values.push(Value(0));
                stack.push(Copying::new(graph.function(*callee), arguments));
                continue;
            }
            Operation::Output(call, i) if top.outputs.contains_key(call) => {
                let value = top.outputs.get(call).and_then(|outputs| outputs.get(*i as usize)).copied();
                top.values.push(value.unwrap_or(Value(0)));
            }
            _ => {
                let mut copy = operation.map_operands(|v| top.value(v));
                if let Operation::Call(callee, _) = &mut copy {
                    *callee = ids[callee.0 as usize].unwrap_or(*callee);
                }
                let value = builder.push(copy, top.function.types[old.0 as usize]);
                top.values.push(value);
            }
        }
        // Names of what is taken over would hide the caller's own.
        let value = top.value(old);
        let name = top.function.names.get(&old).filter(|_| stack.len() == 1);
        name.into_iter().for_each(|name| builder.name(value, name));
    }
    builder.finish()
}
