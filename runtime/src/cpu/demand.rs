//! Which values an output needs: demand runs from the entry down, and a function's output is wanted
//! where a call of it has an `Output` that is.

use texgraph_compiler::graph::{Graph, Operation};

/// For each function, which of its values an output of the entry needs.
pub fn demand(graph: &Graph, output: usize) -> Vec<Vec<bool>> {
    let functions = &graph.functions;
    let mut live: Vec<Vec<bool>> =
        functions.iter().map(|function| vec![false; function.values.len()]).collect();
    if let Some((_, value)) = functions.last().and_then(|entry| entry.outputs.get(output)) {
        live[functions.len() - 1][value.0 as usize] = true;
    }
    for id in (0..functions.len()).rev() {
        let (callees, rest) = live.split_at_mut(id);
        let own = &mut rest[0];
        for (value, operation) in functions[id].iter().rev() {
            if !own[value.0 as usize] {
                continue;
            }
            operation.for_operands(|operand| own[operand.0 as usize] = true);
            if let Operation::Output(call, n) = operation
                && let Operation::Call(callee, _) = functions[id].operation(*call)
                && let Some((_, wanted)) = functions[callee.0 as usize].outputs.get(*n as usize)
            {
                callees[callee.0 as usize][wanted.0 as usize] = true;
            }
        }
    }
    live
}
