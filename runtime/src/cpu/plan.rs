//! What to compute for a picture: the operations that the wanted output needs, function by
//! function, and the values that no pixel changes.
//!
//! A value is *known* when it depends on no input of its function (in the entry: on none that
//! changes per pixel); it is computed once, calls and folds included. All others become
//! [`Step`]s.
//!
//! A planned function keeps the graph's own [`Operation`]s, over *registers* instead of values:
//! those below the number of known values are the function's constants, the others its frame, which
//! begins with its inputs.

use super::demand::demand;
use super::planner::Planner;
use super::texture::Texture;
use crate::flat::Slope;
use crate::pass::Pass;
use crate::render::{RenderError, Request};
use texgraph_compiler::graph::{Constant, Operation, Value};

/// What to compute for every pixel.
pub struct Plan {
    /// The graph's functions, those that are not needed empty.
    pub functions: Vec<Planned>,
    /// The function to run.
    pub entry: usize,
    /// Which of its outputs is wanted.
    pub output: usize,
    /// What its frame begins with, and how many components of it.
    pub inputs: Vec<(Source, u8)>,
}

/// What an input of the entry is at a pixel.
#[derive(Clone, Copy)]
pub enum Source {
    /// Its value.
    Value(Slope),
    /// Its derivative to the right.
    Right(Slope),
    /// Its derivative down.
    Down(Slope),
}

/// A function, planned.
#[derive(Default)]
pub struct Planned {
    /// The first registers: what no pixel changes.
    pub known: Vec<Constant>,
    /// What to do, in order.
    pub steps: Vec<Step>,
    /// The size of the frame, inputs included.
    pub slots: usize,
    /// The register of each output; none for those that nobody wants.
    pub outputs: Vec<Option<Value>>,
    /// Operations of a run at most, calls and folds included.
    pub cost: u64,
}

/// One operation of a run.
pub struct Step {
    /// Its operands are registers.
    pub operation: Operation,
    /// Where its result goes; not used by calls and folds.
    pub target: Value,
    /// Of a call or a fold: which output goes to which register.
    pub results: Vec<(u32, Value)>,
}

impl Plan {
    /// Plans a request.
    ///
    /// # Errors
    /// A pixel takes more operations than the renderer does.
    pub fn new(pass: &Pass<'_>, request: &Request, textures: &[Texture]) -> Result<Plan, RenderError> {
        let graph = &pass.code.graph;
        let live = demand(graph, request.output);
        let entry = graph.functions.len().saturating_sub(1);
        let mut plan = Plan { functions: Vec::new(), entry, output: request.output, inputs: Vec::new() };
        for (id, function) in graph.functions.iter().enumerate() {
            let mut planner = Planner::new(pass, request, function, &live[id]);
            if id == entry {
                plan.inputs = planner.take_entry_inputs();
            } else {
                planner.take_inputs();
            }
            let planned = planner.finish(&plan.functions, textures)?;
            plan.functions.push(planned);
        }
        Ok(plan)
    }
}
