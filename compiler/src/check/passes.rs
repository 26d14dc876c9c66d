//! Which bakes a texture reads, and the graph of each.

use crate::graph::{FunctionId, Graph, Operation};

/// The resources that have to be baked for a function, each after those that its own bake reads.
pub fn bakes(graph: &Graph, entry: FunctionId) -> Vec<u32> {
    let mut needed = vec![false; graph.resources.len()];
    mark(graph, entry, &mut needed);
    // A bake only reads what was declared before it.
    for resource in (0..graph.resources.len()).rev() {
        if let (true, Some(function)) = (needed[resource], graph.resources[resource].bake) {
            mark(graph, function, &mut needed);
        }
    }
    let baked = graph.resources.iter().zip(&needed).enumerate();
    baked.filter(|(_, (made, needed))| **needed && made.bake.is_some()).map(|(i, _)| i as u32).collect()
}

/// Marks the resources that a function reads, itself or through what it calls.
fn mark(graph: &Graph, entry: FunctionId, needed: &mut [bool]) {
    let mut reached = vec![false; entry.0 as usize + 1];
    if let Some(last) = reached.last_mut() {
        *last = true;
    }
    // Callees come first, so one walk from the end meets every caller before its callees.
    for id in (0..reached.len()).rev() {
        if !reached[id] {
            continue;
        }
        for operation in &graph.functions[id].values {
            match operation {
                Operation::View(view) => needed[graph.views[view.0 as usize].resource as usize] = true,
                Operation::Call(callee, _) => reached[callee.0 as usize] = true,
                Operation::Fold(fold) => {
                    let parts = std::iter::once(fold.body).chain(fold.condition);
                    parts.for_each(|part| reached[part.0 as usize] = true);
                }
                _ => {}
            }
        }
    }
}

/// The graph with a function as its entry, without those made after it.
pub fn rooted(mut graph: Graph, entry: FunctionId) -> Option<Graph> {
    let function = graph.functions.get(entry.0 as usize)?.clone();
    graph.functions.truncate(entry.0 as usize + 1);
    graph.functions.push(function);
    Some(graph)
}
