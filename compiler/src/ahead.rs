//! What is made of the library's nodes before a program calls them: checked, through all passes, and
//! lowered.
//!
//! A program takes over what it uses unchanged, and makes all else itself; both are the same, byte
//! for byte. A function says by its [`Origin`] what it is; whoever changes one, makes a new one,
//! which has none.

use crate::check::{Key, Prepared};
use crate::graph::{Builder, Function, FunctionId, Graph, Origin};
use crate::lower::Objects;
use crate::pass::{Finished, inline, merge_samples};
use rustc_hash::FxHashMap;

/// Functions made ahead.
#[derive(Clone, Debug, Default)]
pub struct Ahead {
    /// Nodes by the calls that they are made for.
    pub prepared: FxHashMap<Key, Prepared>,
    /// After checking, single expressions taken over; callees by their place in this list.
    pub checked: Vec<Function>,
    /// After all passes.
    pub finished: Finished,
    /// Lowered.
    pub objects: Objects,
}

impl Ahead {
    /// Of nodes and the functions that they are made of.
    pub fn of(prepared: Vec<(Key, Prepared)>, functions: Vec<Function>) -> Ahead {
        let nodes: Vec<FunctionId> = prepared.iter().map(|(_, prepared)| prepared.node()).collect();
        let mut graph = Graph { functions, ..Graph::default() };
        graph.functions.push(caller(&graph.functions, &nodes));
        let functions = inline::ahead(&graph);
        let Graph { functions: mut checked, .. } = merge_samples::run(Graph { functions, ..graph.clone() });
        for (i, function) in checked.iter_mut().enumerate() {
            function.origin = Some(Origin::Checked(i as u32));
        }
        let graph = Graph { functions: checked, ..graph };
        let (graph_after, finished) = Finished::of(graph.clone());
        let objects = Objects::of(&graph_after);
        let mut checked = graph.functions;
        checked.pop();
        Ahead { prepared: prepared.into_iter().collect(), checked, finished, objects }
    }
}

/// A function that calls each of the nodes as most programs do: with arguments of its own, all
/// outputs read.
fn caller(functions: &[Function], nodes: &[FunctionId]) -> Function {
    let mut builder = Builder::new("library");
    let mut results = Vec::new();
    for node in nodes {
        let callee = &functions[node.0 as usize];
        let arguments = callee.inputs.iter().map(|slot| builder.input("argument", slot.ty)).collect();
        results.extend(builder.call(*node, callee, arguments));
    }
    results.into_iter().for_each(|result| builder.output("result", result));
    builder.finish()
}
