//! Passes: each a function from graph to graph (or from operation to simpler operation), one file
//! each. They follow arena order and never recurse.

pub mod differentiate;
pub mod expand;
pub mod fold_constants;
pub mod inline;
mod liveness;
pub mod remove_dead;

use crate::graph::Graph;

/// Everything between checking and lowering.
pub fn run(graph: Graph) -> Graph {
    remove_dead::run(expand::run(differentiate::run(inline::run(graph))))
}
