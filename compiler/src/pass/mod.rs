//! Passes: each a function from graph to graph (or from operation to simpler operation), one file
//! each. They follow arena order and never recurse.

pub mod differentiate;
pub mod expand;
pub mod fold_constants;
pub mod inline;
pub mod remove_dead;

use crate::graph::Graph;

/// Everything between checking and lowering.
///
/// # Errors
/// What the passes can't do yet, at its place.
pub fn run(graph: Graph) -> Result<Graph, crate::diagnostic::Diagnostic> {
    let graph = inline::run(graph);
    let graph = differentiate::run(graph)?;
    let graph = expand::run(graph);
    Ok(remove_dead::run(graph))
}
