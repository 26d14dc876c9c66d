//! Which bakes a texture reads, and the graph of each.

use crate::graph::{FunctionId, Graph, Operation};
use crate::resource::Resource;

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

/// The graph of a bake: its function, which gets the name of its resource, after all that it calls.
pub fn bake(graph: &Graph, resource: &Resource) -> Option<Graph> {
    let mut functions = graph.functions.get(..=resource.bake?.0 as usize)?.to_vec();
    let entry = functions.last_mut()?;
    entry.name = resource.name.as_str().into();
    entry.origin = None;
    let Graph { params, resources, views, .. } = graph;
    Some(Graph { functions, params: params.clone(), resources: resources.clone(), views: views.clone() })
}
