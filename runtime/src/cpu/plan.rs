//! What to compute for a picture: for each function a list of steps over registers.
//!
//! A [`Register`] holds one component of a value for all [`LANES`] pixels of a batch. Vectors do
//! not exist here: to put one together or to take it apart is to name other registers. Branches are
//! arms that are skipped when no lane wants them ([`Step::Arm`]); what an arm writes in lanes that
//! did not take it is never read.

use super::fused::Row;
use super::planner::{Fuse, Planner};
use super::texture::Texture;
use crate::flat::Rise;
use crate::pass::Pass;
use crate::render::{RenderError, Request};
use std::sync::Arc;
use texgraph_compiler::graph::{Constant, Graph, Scalar};
use texgraph_compiler::intrinsic::{Intrinsic, LANES, Lanes, Vector};

/// What to compute for every pixel.
pub struct Plan {
    /// The graph's functions, callees first.
    pub functions: Vec<Planned>,
    /// What no pixel changes: the same in all lanes.
    pub known: Vec<Lanes>,
    /// The function to run.
    pub entry: usize,
    /// What its frame begins with.
    pub inputs: Vec<Rise>,
    /// What is drawn; none if the program has no such output.
    pub output: Option<Drawn>,
}

/// The output that is drawn.
pub struct Drawn {
    /// The type of a component.
    pub scalar: Scalar,
    /// Four components, as the manifest's `Output` widens them.
    pub components: Components,
}

/// Where the components of a value are; beyond the last anything.
pub type Components = [Register; 4];

/// Where one component is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Register {
    /// In [`Plan::known`].
    Known(u32),
    /// In the frame of the function that runs.
    Frame(u32),
}

impl Register {
    /// The register that is 0 in all lanes.
    pub const ZERO: Register = Register::Known(0);

    /// Whether no pixel changes it.
    pub fn is_known(self) -> bool {
        matches!(self, Register::Known(_))
    }
}

/// A function, planned. Its frame begins with the components of its inputs.
#[derive(Default)]
pub struct Planned {
    /// What to do, in order.
    pub steps: Vec<Step>,
    /// Components of its inputs.
    pub inputs: usize,
    /// Registers of its frame, at least one more than inputs.
    pub size: usize,
    /// Its outputs, component by component.
    pub outputs: Vec<Register>,
    /// Operations of a run at most, calls and folds included.
    pub cost: u64,
}

/// One operation of a run, in all lanes.
#[derive(Clone)]
pub enum Step {
    /// A row of intrinsics that applies to each component on its own.
    Each {
        row: Intrinsic,
        one: fn([u32; 3]) -> u32,
        all: fn([&Lanes; 3], &mut Lanes),
        arguments: [Register; 3],
        to: Register,
    },
    /// A row of intrinsics that takes whole arguments; the first has this width.
    Whole {
        row: Intrinsic,
        all: fn(usize, [Vector<'_>; 2], &mut [Lanes; 4]),
        width: usize,
        arguments: Box<[Components; 2]>,
        to: Targets,
    },
    /// What a function computes, in one pass over the lanes.
    Fused(Box<Fused>),
    /// The second where the first holds, else the third.
    Select { condition: Register, yes: Register, no: Register, to: Register },
    /// An entry of a table.
    Lookup { table: Arc<[Constant]>, index: Register, to: Targets },
    /// The level of detail of a coordinate with these derivatives.
    Level { view: Register, gradient: [[Register; 2]; 2], to: Register },
    /// A filtered sample.
    Sample { view: Register, at: [Register; 2], layer: Register, level: Register, to: Targets },
    /// A texel of level 0.
    Texel { view: Register, at: [Register; 2], layer: Register, to: Targets },
    /// Texels across and down.
    Size { view: Register, to: Targets },
    /// What is up to [`Step::Join`] is only for lanes where the condition is this. If there are
    /// none, the step after that is next: it is number `end`.
    Arm { condition: Register, holds: bool, end: usize },
    /// The end of an arm.
    Join,
    /// Runs a function.
    Call(Box<Call>),
    /// Runs a loop.
    Fold(Box<Loop>),
}

/// Where the components of a result go; none where nobody wants one.
pub type Targets = [Option<Register>; 4];

/// A function's steps as one.
#[derive(Clone)]
pub struct Fused {
    /// Which.
    pub row: &'static Row,
    /// The function's inputs, then its free constants.
    pub arguments: Vec<Register>,
    /// Where the components of its outputs go; none where nobody wants one.
    pub to: Vec<Option<Register>>,
}

/// A call.
#[derive(Clone)]
pub struct Call {
    /// Which function.
    pub function: usize,
    /// Its inputs, component by component.
    pub arguments: Vec<Register>,
    /// Which component of its outputs goes where.
    pub results: Vec<(usize, Register)>,
}

/// A fold. The frame of its body begins with the accumulators, the number of the step and the
/// captures, then one register for the number of steps.
#[derive(Clone)]
pub struct Loop {
    /// One step.
    pub body: usize,
    /// Tested before each.
    pub condition: Option<usize>,
    /// The accumulators at first, component by component.
    pub starts: Vec<Register>,
    /// What body and condition read from outside, component by component.
    pub captures: Vec<Register>,
    /// How many steps.
    pub steps: Register,
    /// How many at most.
    pub most: u32,
    /// Which component of the accumulators goes where at the end.
    pub results: Vec<(usize, Register)>,
}

impl Step {
    /// Calls `f` with each register that is read.
    pub fn for_operands(&mut self, mut f: impl FnMut(&mut Register)) {
        match self {
            Step::Each { arguments, .. } => arguments.iter_mut().for_each(f),
            Step::Whole { arguments, .. } => arguments.iter_mut().flatten().for_each(f),
            Step::Fused(fused) => fused.arguments.iter_mut().for_each(f),
            Step::Select { condition, yes, no, .. } => [condition, yes, no].into_iter().for_each(f),
            Step::Lookup { index, .. } => f(index),
            Step::Level { view, gradient, .. } => {
                f(view);
                gradient.iter_mut().flatten().for_each(f);
            }
            Step::Sample { view, at: [x, y], layer, level, .. } => {
                [view, x, y, layer, level].into_iter().for_each(f);
            }
            Step::Texel { view, at: [x, y], layer, .. } => [view, x, y, layer].into_iter().for_each(f),
            Step::Size { view, .. } => f(view),
            Step::Arm { condition, .. } => f(condition),
            Step::Join => {}
            Step::Call(call) => call.arguments.iter_mut().for_each(f),
            Step::Fold(fold) => {
                let operands = fold.starts.iter_mut().chain(&mut fold.captures).chain([&mut fold.steps]);
                operands.for_each(f);
            }
        }
    }

    /// Calls `f` with each register that is written. Where it says so, nobody wants it.
    pub fn retain_targets(&mut self, mut f: impl FnMut(&mut Register) -> bool) {
        match self {
            Step::Each { to, .. } | Step::Select { to, .. } | Step::Level { to, .. } => {
                f(to);
            }
            Step::Whole { to, .. }
            | Step::Lookup { to, .. }
            | Step::Sample { to, .. }
            | Step::Texel { to, .. }
            | Step::Size { to, .. } => retain(to, f),
            Step::Fused(fused) => retain(&mut fused.to, f),
            Step::Arm { .. } | Step::Join => {}
            Step::Call(call) => call.results.retain_mut(|(_, to)| f(to)),
            Step::Fold(fold) => fold.results.retain_mut(|(_, to)| f(to)),
        }
    }
}

/// Leaves out targets that nobody wants.
fn retain(to: &mut [Option<Register>], mut f: impl FnMut(&mut Register) -> bool) {
    for to in to {
        if to.as_mut().is_some_and(|register| !f(register)) {
            *to = None;
        }
    }
}

impl Plan {
    /// Plans a request for a graph whose entry has one output, the wanted one.
    ///
    /// # Errors
    /// A pixel takes more operations than the renderer does.
    pub fn new(
        pass: &Pass<'_>,
        graph: &Graph,
        request: &Request,
        textures: &[Texture],
        fuse: &mut dyn Fuse,
    ) -> Result<Plan, RenderError> {
        let plan = Plan {
            functions: Vec::with_capacity(graph.functions.len()),
            known: vec![[0; LANES]],
            entry: graph.functions.len().saturating_sub(1),
            inputs: Vec::new(),
            output: None,
        };
        Planner::new(pass, graph, request, textures, plan, fuse).finish()
    }
}
