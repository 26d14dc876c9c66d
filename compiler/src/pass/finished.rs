//! Functions of the library that have been through all passes before any program calls them.

use super::differentiate::{self, MadeOf, Variant};
use super::{hoist, remove_dead, share_level};
use crate::graph::{Function, FunctionId, Graph, Origin};
use rustc_hash::FxHashMap;

/// What the passes make of the library's functions.
#[derive(Clone, Debug, Default)]
pub struct Finished {
    /// Callees by their place in this list.
    functions: Vec<Function>,
    /// For each the functions that it needs, callees first and itself last.
    needs: Vec<Vec<u32>>,
    /// Where each variant of a checked function is.
    variants: FxHashMap<(u32, Variant), Done>,
}

/// A variant of a function after all passes.
#[derive(Clone, Debug)]
pub struct Done {
    id: u32,
    /// For each output the places of its tangents among the outputs, if they are wanted.
    pub tangents: Vec<Option<[u32; 2]>>,
    /// What it asks of the checked functions that it calls.
    pub inner: Vec<(u32, Variant)>,
}

impl Finished {
    /// Takes the library's functions, then one that calls them, through all passes; also gives the
    /// graph that comes out.
    pub fn of(graph: Graph) -> (Graph, Finished) {
        let (graph, variants) = differentiate::with_variants(graph);
        let shapes: Vec<Shape> = graph.functions.iter().map(Shape::of).collect();
        let (graph, changed) = hoist::with_changed(share_level::run(graph));
        let (graph, places) = remove_dead::with_places(graph);
        let mut finished = Finished::default();
        for function in &graph.functions {
            finished.add(function);
        }
        for MadeOf { function, variant, made, inner } in variants {
            let Some(FunctionId(id)) = places[made.id.0 as usize] else { continue };
            // A program that reads more of it, or gives it other arguments, needs what was removed;
            // where as much was added the number of inputs is the same, but not what they are.
            let place = made.id.0 as usize;
            if !changed[place] && Shape::of(&graph.functions[id as usize]) == shapes[place] {
                finished.variants.insert((function, variant), Done { id, tangents: made.tangents, inner });
            }
        }
        (graph, finished)
    }

    fn add(&mut self, function: &Function) {
        let id = self.functions.len() as u32;
        let mut needs: Vec<u32> = Vec::new();
        for callee in function.functions() {
            for need in &self.needs[callee.0 as usize] {
                if !needs.contains(need) {
                    needs.push(*need);
                }
            }
        }
        needs.push(id);
        self.needs.push(needs);
        self.functions.push(Function { origin: Some(Origin::Finished(id)), ..function.clone() });
    }

    /// The variant of a function, if it is one of the library's and was made.
    pub fn find(&self, function: &Function, variant: &Variant) -> Option<&Done> {
        let Some(Origin::Checked(id)) = function.origin else { return None };
        self.variants.get(&(id, variant.clone()))
    }

    /// Adds it to the functions of a program, after what it needs; `taken` says what has been added
    /// before, and where it stands.
    pub fn take_over(
        &self,
        done: &Done,
        functions: &mut Vec<Function>,
        taken: &mut FxHashMap<u32, FunctionId>,
    ) -> FunctionId {
        for need in &self.needs[done.id as usize] {
            if taken.contains_key(need) {
                continue;
            }
            let mut function = self.functions[*need as usize].clone();
            function.replace_functions(|callee| taken.get(&callee.0).copied().unwrap_or(callee));
            taken.insert(*need, FunctionId(functions.len() as u32));
            functions.push(function);
        }
        taken.get(&done.id).copied().unwrap_or(FunctionId(0))
    }
}

/// A function that uses one which is no longer the library's is none of the library's either.
pub fn settled(mut graph: Graph) -> Graph {
    for i in 0..graph.functions.len() {
        if !graph.functions[i].functions().all(|used| graph.function(used).origin.is_some()) {
            graph.functions[i].origin = None;
        }
    }
    graph
}

/// What callers see of a function.
#[derive(PartialEq)]
struct Shape {
    inputs: usize,
    outputs: usize,
}

impl Shape {
    fn of(function: &Function) -> Shape {
        Shape { inputs: function.inputs.len(), outputs: function.outputs.len() }
    }
}
