//! What is costly is done once where it was done in several places of which one counts.
//!
//! - Samples of one view in both arms of a choice become one sample at the chosen coordinate; so do
//!   calls and folds over one function (see `choice`).
//! - A loop that keeps the sample of its winner keeps the winner's coordinate instead, and one sample
//!   is taken after it (GPU Gems, 20.2.1; see `winner`).
//!
//! Before differentiation: the chosen coordinate has one gradient, that of the arm which is chosen.

mod choice;
mod winner;

use crate::graph::Graph;
use crate::graph::regions::Weights;

/// Merges samples, calls and folds; functions keep their places, inputs and outputs, but for the
/// bodies and conditions of folds.
pub fn run(graph: Graph) -> Graph {
    let mut graph = winner::run(graph);
    let mut weights = Weights::default();
    for function in &mut graph.functions {
        if let Some(merged) = choice::merged(function, &weights) {
            *function = merged;
        }
        weights.add(function);
    }
    graph
}
