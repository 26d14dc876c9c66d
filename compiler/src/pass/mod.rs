//! Passes: each a function from graph to graph (or from operation to simpler operation), one file
//! or folder each. They follow arena order, take time in proportion to the graph and never recurse.

mod arrange;
pub mod differentiate;
mod finished;
pub mod fold_constants;
pub mod hoist;
pub mod inline;
mod liveness;
pub mod merge_samples;
pub mod remove_dead;
pub mod share_level;

pub use finished::Finished;

use crate::graph::Graph;
use crate::manifest::Gradients;

/// Everything between checking and lowering, each pass once. `fold_constants` is no step: it is
/// applied wherever a value is made. What is `finished` already is taken over.
pub fn run(graph: Graph, finished: &Finished, gradients: Gradients) -> Graph {
    // First, so that all others see whole expressions, and no loop where there need not be one.
    let graph = inline::run(graph);
    // Before differentiation: what is merged has one gradient.
    let graph = merge_samples::run(graph);
    // Before hoisting, so that a guard may go where its operands are the same for a whole draw.
    let graph = differentiate::run(graph, finished, gradients != Gradients::None);
    // Before hoisting, which takes levels out of loops.
    let graph = share_level::run(graph);
    let graph = hoist::run(graph);
    // Behind all of them, which leave things that nobody reads.
    let graph = remove_dead::run(graph);
    finished::settled(arrange::run(graph))
}
