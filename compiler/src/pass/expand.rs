//! Total operations become what a shader has, with guards where operands are not known to be fine.

use crate::graph::{Builder, Function, Graph, Operation, Value};
use crate::intrinsic::Form;

/// Expands every intrinsic whose form is a rule.
pub fn run(mut graph: Graph) -> Graph {
    graph.functions = graph.functions.iter().map(expanded).collect();
    graph
}

fn expanded(function: &Function) -> Function {
    let mut builder = Builder::new(function.name.clone());
    for slot in &function.inputs {
        builder.input(slot.name.clone(), slot.ty);
    }
    let mut values: Vec<Value> = Vec::with_capacity(function.values.len());
    for (old, operation) in function.iter() {
        builder.set_place(function.places[old.0 as usize]);
        let copy = operation.map_operands(|v| values[v.0 as usize]);
        let value = match &copy {
            Operation::Builtin(intrinsic, arguments) => match intrinsic.row().form {
                Form::Expand(rule) => rule(&mut builder, arguments),
                _ => builder.builtin(*intrinsic, arguments),
            },
            _ => builder.push(copy, function.ty(old)),
        };
        if let Some(name) = function.names.get(&old) {
            builder.name(value, name);
        }
        values.push(value);
    }
    for (slot, value) in &function.outputs {
        builder.output(slot.name.clone(), values[value.0 as usize]);
    }
    builder.finish()
}
