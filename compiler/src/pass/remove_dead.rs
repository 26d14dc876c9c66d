//! What no output needs is removed: values, inputs of functions with their arguments, outputs that
//! no caller reads, functions that nobody calls.

use crate::graph::{Builder, Function, FunctionId, Graph, Operation, Value};

/// Keeps what the entry's outputs need. The entry keeps its inputs: they are the contract.
pub fn run(graph: Graph) -> Graph {
    let wanted = wanted_outputs(&graph);
    let mut kept: Vec<Option<Kept>> = Vec::with_capacity(graph.functions.len());
    let mut functions = Vec::new();
    for (i, function) in graph.functions.iter().enumerate() {
        let entry = i + 1 == graph.functions.len();
        if !entry && !wanted[i].contains(&true) {
            kept.push(None);
            continue;
        }
        let live = live_values(function, &wanted[i], |callee, input| {
            kept[callee.0 as usize].as_ref().is_none_or(|kept| kept.inputs[input])
        });
        let used =
            |i: usize| function.iter().any(|(v, op)| *op == Operation::Input(i as u32) && live[v.0 as usize]);
        let inputs: Vec<bool> = (0..function.inputs.len()).map(|i| entry || used(i)).collect();
        functions.push(rebuilt(function, &live, &inputs, &wanted[i], &kept));
        let id = FunctionId(functions.len() as u32 - 1);
        kept.push(Some(Kept { id, inputs, outputs: wanted[i].clone() }));
    }
    Graph { functions, ..graph }
}

/// What is left of a function.
struct Kept {
    id: FunctionId,
    inputs: Vec<bool>,
    outputs: Vec<bool>,
}

/// For each function the outputs that are read, callers before callees.
fn wanted_outputs(graph: &Graph) -> Vec<Vec<bool>> {
    let mut wanted: Vec<Vec<bool>> = graph.functions.iter().map(|f| vec![false; f.outputs.len()]).collect();
    if let Some(entry) = wanted.last_mut() {
        entry.fill(true);
    }
    for i in (0..graph.functions.len()).rev() {
        let function = &graph.functions[i];
        let live = live_values(function, &wanted[i], |_, _| true);
        for (_, operation) in function.iter().filter(|(v, _)| live[v.0 as usize]) {
            if let Operation::Output(call, output) = operation
                && let Operation::Call(callee, _) = function.operation(*call)
            {
                wanted[callee.0 as usize][*output as usize] = true;
            }
        }
    }
    wanted
}

/// Which values the wanted outputs need.
fn live_values(function: &Function, wanted: &[bool], reads: impl Fn(FunctionId, usize) -> bool) -> Vec<bool> {
    let mut live = vec![false; function.values.len()];
    for ((_, value), wanted) in function.outputs.iter().zip(wanted) {
        live[value.0 as usize] |= *wanted;
    }
    for (value, operation) in function.iter().rev() {
        if !live[value.0 as usize] {
            continue;
        }
        match operation {
            Operation::Call(callee, arguments) => {
                for (i, argument) in arguments.iter().enumerate() {
                    live[argument.0 as usize] |= reads(*callee, i);
                }
            }
            _ => operation.for_operands(|v| live[v.0 as usize] = true),
        }
    }
    live
}

fn rebuilt(
    function: &Function,
    live: &[bool],
    inputs: &[bool],
    wanted: &[bool],
    kept: &[Option<Kept>],
) -> Function {
    let mut builder = Builder::new(function.name.clone());
    let mut input_values = Vec::new();
    for (slot, keep) in function.inputs.iter().zip(inputs) {
        input_values.push(if *keep { Some(builder.input(slot.name.clone(), slot.ty)) } else { None });
    }
    let mut values: Vec<Value> = Vec::with_capacity(function.values.len());
    for (old, operation) in function.iter() {
        let value = match operation {
            _ if !live[old.0 as usize] => Value(0),
            Operation::Input(i) => input_values[*i as usize].unwrap_or(Value(0)),
            _ => {
                builder.set_place(function.places[old.0 as usize]);
                let copy = adapted(function, operation, &values, kept);
                let value = builder.push(copy, function.ty(old));
                if let Some(name) = function.names.get(&old) {
                    builder.name(value, name);
                }
                value
            }
        };
        values.push(value);
    }
    for ((slot, value), wanted) in function.outputs.iter().zip(wanted) {
        if *wanted {
            builder.output(slot.name.clone(), values[value.0 as usize]);
        }
    }
    builder.finish()
}

/// An operation over new values, calls without the arguments and outputs that were dropped.
fn adapted(function: &Function, operation: &Operation, values: &[Value], kept: &[Option<Kept>]) -> Operation {
    let copy = operation.map_operands(|v| values[v.0 as usize]);
    match (copy, operation) {
        (Operation::Call(callee, arguments), _) => match &kept[callee.0 as usize] {
            Some(kept) => {
                let read = arguments.into_iter().zip(&kept.inputs).filter(|(_, keep)| **keep);
                Operation::Call(kept.id, read.map(|(v, _)| v).collect())
            }
            None => Operation::Call(callee, arguments),
        },
        (Operation::Output(call, i), Operation::Output(old_call, _)) => {
            let dropped = match function.operation(*old_call) {
                Operation::Call(callee, _) => kept[callee.0 as usize].as_ref().map_or(0, |kept| {
                    kept.outputs[..i as usize].iter().filter(|keep| !**keep).count() as u32
                }),
                _ => 0,
            };
            Operation::Output(call, i - dropped)
        }
        (copy, _) => copy,
    }
}
