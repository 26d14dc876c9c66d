//! Total operations become what a shader has, with guards where operands are not known to be fine.

use super::taken::Taken;
use crate::graph::{Builder, Function, Graph, Operation, Value};
use crate::intrinsic::Form;

/// Expands every intrinsic whose form is a rule.
pub fn run(mut graph: Graph) -> Graph {
    graph.functions = graph.functions.into_iter().map(expanded).collect();
    graph
}

fn is_total(operation: &Operation) -> bool {
    matches!(operation, Operation::Builtin(i, _) if matches!(i.row().form, Form::Expand(_)))
}

fn expanded(function: Function) -> Function {
    if !function.values.iter().any(is_total) {
        return function;
    }
    let taken = Taken::new(function);
    let mut builder = Builder::with_capacity(taken.name, taken.values.len());
    for slot in taken.inputs {
        builder.input(slot.name, slot.ty);
    }
    let mut values: Vec<Value> = Vec::with_capacity(taken.values.len());
    for mut part in taken.values {
        builder.set_place(part.place);
        part.operation.replace_operands(|v| values[v.0 as usize]);
        let rule = match &part.operation {
            Operation::Builtin(intrinsic, arguments) => match intrinsic.row().form {
                Form::Expand(rule) => Some((rule, arguments)),
                _ => None,
            },
            _ => None,
        };
        let value = match rule {
            Some((rule, arguments)) => rule(&mut builder, arguments),
            None => builder.push(part.operation, part.ty),
        };
        if let Some(name) = part.name {
            builder.name(value, name);
        }
        values.push(value);
    }
    for (slot, value) in taken.outputs {
        builder.output(slot.name, values[value.0 as usize]);
    }
    builder.finish()
}
