//! Makes the steps of all functions, callees first.
//!
//! What is over known registers alone is done at once, on the machine, and is known itself. All
//! else becomes a step with new registers for its results; `registers` then lets them share.

mod inline;
mod inputs;
mod known;
mod operations;

use super::machine::Machine;
use super::plan::{Components, Drawn, Plan, Planned, Register, Step};
use super::registers::allocate;
use super::texture::Texture;
use crate::pass::Pass;
use crate::render::{RenderError, Request};
use inline::{Bodies, Body};
use std::collections::HashMap;
use texgraph_compiler::graph::regions::{Branch, Region, Regions, Weights};
use texgraph_compiler::graph::{Function, FunctionId, Graph, Operation, Scalar, Type, Value};
use texgraph_compiler::intrinsic::Lanes;

/// The most operations a pixel.
const MAX_OPERATIONS: u64 = 1_000_000_000;

/// Refuses what would take for ever.
fn bound(operations: u64) -> Result<(), RenderError> {
    if operations > MAX_OPERATIONS {
        return Err(RenderError::TooMuchWork { operations, limit: MAX_OPERATIONS });
    }
    Ok(())
}

/// Where the results of a value are.
#[derive(Clone)]
enum State {
    /// Nothing reads it, or nothing could be made of it.
    Absent,
    /// Its components.
    Components(Components),
    /// The components of all outputs of a call, or of all accumulators of a fold.
    Outputs(Vec<Register>),
}

/// What makes one step of whole functions.
pub trait Fuse {
    /// Whether functions of that name may become a step. They are planned of arithmetic alone if they
    /// can be: with the steps of what they call, though that may be one step by itself.
    fn knows(&self, name: &str) -> bool;

    /// Makes one step of a planned function if it can; whether it has. `registers` are those that the
    /// function has, none shared yet.
    fn fuse(&mut self, name: &str, planned: &mut Planned, known: &[Lanes], registers: &mut usize) -> bool;
}

/// Plans a graph.
pub struct Planner<'a> {
    pass: &'a Pass<'a>,
    graph: &'a Graph,
    request: &'a Request,
    textures: &'a [Texture],
    plan: Plan,
    fuse: &'a mut dyn Fuse,
    /// The known register of some bits.
    numbers: HashMap<u32, Register>,
    machine: Machine,
    /// Of each function that callers take over.
    bodies: Vec<Bodies>,
    /// Whether the function being planned is to be of arithmetic alone.
    plain: bool,
    /// Of the function being planned.
    states: Vec<State>,
    planned: Planned,
    /// Registers of the function so far.
    registers: usize,
    /// Operations done while planning the function.
    work: u64,
}

impl<'a> Planner<'a> {
    /// Over a plan that knows only [`Register::ZERO`].
    pub fn new(
        pass: &'a Pass<'a>,
        graph: &'a Graph,
        request: &'a Request,
        textures: &'a [Texture],
        plan: Plan,
        fuse: &'a mut dyn Fuse,
    ) -> Planner<'a> {
        Planner {
            pass,
            graph,
            request,
            textures,
            plan,
            fuse,
            numbers: [(0, Register::ZERO)].into(),
            machine: Machine::default(),
            bodies: Vec::new(),
            plain: false,
            states: Vec::new(),
            planned: Planned::default(),
            registers: 0,
            work: 0,
        }
    }

    /// Plans all functions.
    ///
    /// # Errors
    /// A run of one, or what is computed here for it, takes more than [`MAX_OPERATIONS`].
    pub fn finish(mut self) -> Result<Plan, RenderError> {
        let graph = self.graph;
        let weights = Weights::of(graph);
        let mut bodies = vec![false; graph.functions.len()];
        for operation in graph.functions.iter().flat_map(|function| &function.values) {
            if let Operation::Fold(fold) = operation {
                bodies.get_mut(fold.body.0 as usize).into_iter().for_each(|is_body| *is_body = true);
            }
        }
        let plain = self.plain_functions();
        for (id, function) in graph.functions.iter().enumerate() {
            self.function(id, function, &weights, bodies[id], plain[id])?;
        }
        Ok(self.plan)
    }

    /// Which functions may become one step, or what they run.
    fn plain_functions(&self) -> Vec<bool> {
        let functions = &self.graph.functions;
        let mut plain: Vec<bool> = functions.iter().map(|function| self.fuse.knows(&function.name)).collect();
        // Callees stand before callers.
        for (id, function) in functions.iter().enumerate().rev() {
            if !plain[id] || id == self.plan.entry {
                continue;
            }
            for operation in &function.values {
                let callees = match operation {
                    Operation::Call(callee, _) => [Some(*callee), None],
                    Operation::Fold(fold) => [Some(fold.body), fold.condition],
                    _ => [None, None],
                };
                for callee in callees.into_iter().flatten() {
                    plain[callee.0 as usize] = true;
                }
            }
        }
        plain
    }

    fn function(
        &mut self,
        id: usize,
        function: &'a Function,
        weights: &Weights,
        is_body: bool,
        is_plain: bool,
    ) -> Result<(), RenderError> {
        let is_entry = id == self.plan.entry;
        let mut bodies = Bodies::default();
        self.plain = is_plain && !is_entry;
        self.steps(function, weights, is_entry)?;
        if self.plain {
            bodies.plain = Body::of(&self.planned, self.registers);
            let (known, registers) = (&self.plan.known, &mut self.registers);
            if !self.fuse.knows(&function.name)
                || !self.fuse.fuse(&function.name, &mut self.planned, known, registers)
            {
                self.plain = false;
                self.steps(function, weights, is_entry)?;
            }
        }
        bodies.fused = Body::of(&self.planned, self.registers);
        self.bodies.push(bodies);
        let pinned = if is_body { self.planned.inputs + 1 } else { 0 };
        allocate(&mut self.planned, self.registers, pinned);
        if is_entry {
            self.plan.output = function.outputs.first().and_then(|(slot, _)| self.drawn(slot.ty));
        }
        self.plan.functions.push(std::mem::take(&mut self.planned));
        Ok(())
    }

    /// Plans the steps of a function, each with registers of its own.
    fn steps(
        &mut self,
        function: &'a Function,
        weights: &Weights,
        is_entry: bool,
    ) -> Result<(), RenderError> {
        self.states = vec![State::Absent; function.values.len()];
        self.work = 0;
        self.planned = Planned::default();
        if is_entry {
            self.entry_inputs(function);
        } else {
            self.inputs(function);
        }
        // One more for the number of steps of a fold.
        self.registers = self.planned.inputs + 1;
        let regions = Regions::of(function, weights);
        self.region(function, &regions, Region::TOP)?;
        bound(self.planned.cost)?;
        for (_, value) in &function.outputs {
            let components = self.components(*value);
            self.planned.outputs.extend(components.iter().take(usize::from(function.ty(*value).width())));
        }
        Ok(())
    }

    /// The entry's only output, widened: three times a scalar, 0 and 1 for what is missing.
    fn drawn(&mut self, ty: Type) -> Option<Drawn> {
        let scalar = ty.scalar()?;
        let one = self.number(if scalar == Scalar::Float { 1f32.to_bits() } else { 1 });
        let components = match self.planned.outputs[..] {
            [x] => [x, x, x, one],
            [x, y] => [x, y, Register::ZERO, one],
            [x, y, z] => [x, y, z, one],
            [x, y, z, w, ..] => [x, y, z, w],
            [] => return None,
        };
        Some(Drawn { scalar, components })
    }

    fn set(&mut self, value: Value, state: State) {
        self.states[value.0 as usize] = state;
    }

    /// The components of a value; 0 for what is absent.
    fn components(&self, value: Value) -> Components {
        match &self.states[value.0 as usize] {
            State::Components(components) => *components,
            _ => [Register::ZERO; 4],
        }
    }

    fn scalar(&self, value: Value) -> Register {
        self.components(value)[0]
    }

    fn pair(&self, value: Value) -> [Register; 2] {
        let [x, y, ..] = self.components(value);
        [x, y]
    }

    /// The components of some values, one after the other.
    fn flat(&self, function: &Function, values: &[Value]) -> Vec<Register> {
        let components = |value: &Value| {
            self.components(*value).into_iter().take(usize::from(function.ty(*value).width()))
        };
        values.iter().flat_map(components).collect()
    }

    /// Plans what stands in a region. Regions nest [`MAX_DEPTH`](texgraph_compiler::graph::regions)
    /// deep at most.
    fn region(
        &mut self,
        function: &'a Function,
        regions: &Regions,
        region: Region,
    ) -> Result<(), RenderError> {
        for value in regions.values(region) {
            match regions.branch(*value) {
                Some(branch) => self.branch(function, regions, branch)?,
                None => self.value(function, *value)?,
            }
        }
        Ok(())
    }

    fn branch(
        &mut self,
        function: &'a Function,
        regions: &Regions,
        branch: &Branch,
    ) -> Result<(), RenderError> {
        let condition = self.scalar(branch.condition);
        for (region, holds) in branch.arms.into_iter().zip([true, false]) {
            match self.bits(condition) {
                Some(bits) if (bits != 0) == holds => self.region(function, regions, region)?,
                Some(_) => {}
                None => {
                    self.planned.steps.push(Step::Arm { condition, holds, end: 0 });
                    self.region(function, regions, region)?;
                    self.planned.steps.push(Step::Join);
                }
            }
        }
        branch.choices.iter().try_for_each(|choice| self.value(function, *choice))
    }

    /// Plans one value, whose operands are planned.
    fn value(&mut self, function: &'a Function, value: Value) -> Result<(), RenderError> {
        let operation = function.operation(value);
        let cost = self.cost(operation);
        let before = self.planned.steps.len();
        self.operation(function, value, operation, cost)?;
        if self.planned.steps.len() > before {
            self.planned.cost = self.planned.cost.saturating_add(cost);
        }
        Ok(())
    }

    fn operation(
        &mut self,
        function: &'a Function,
        value: Value,
        operation: &'a Operation,
        cost: u64,
    ) -> Result<(), RenderError> {
        let width = usize::from(function.ty(value).width());
        let components = match operation {
            // The frame begins with them.
            Operation::Input(_) | Operation::Derivative(..) => return Ok(()),
            Operation::Constant(constant) => self.constant(constant),
            Operation::View(id) => [self.number(id.0), Register::ZERO, Register::ZERO, Register::ZERO],
            Operation::Param(id) => self.param(*id),
            Operation::Compose(scalars) => {
                let mut components = [Register::ZERO; 4];
                for (to, scalar) in components.iter_mut().zip(scalars.iter()) {
                    *to = self.scalar(*scalar);
                }
                components
            }
            Operation::Extract(vector, c) => {
                let component = self.components(*vector)[usize::from(*c).min(3)];
                [component, Register::ZERO, Register::ZERO, Register::ZERO]
            }
            Operation::Builtin(intrinsic, arguments) => self.builtin(function, *intrinsic, arguments, width),
            Operation::Select(condition, yes, no) => self.select(*condition, *yes, *no, width),
            Operation::Lookup(table, index) => {
                let (to, results) = self.targets(width);
                self.push(Step::Lookup { table: table.clone(), index: self.scalar(*index), to }, results)
            }
            Operation::Sample { view, coordinate, layer, level } => {
                self.sample(*view, *coordinate, *layer, level)
            }
            Operation::Texel { view, index, layer } => {
                let (to, results) = self.targets(width);
                let layer = layer.map_or(Register::ZERO, |layer| self.scalar(layer));
                let step = Step::Texel { view: self.scalar(*view), at: self.pair(*index), layer, to };
                self.push(step, results)
            }
            Operation::Size(view) => {
                let (to, results) = self.targets(width);
                self.push(Step::Size { view: self.scalar(*view), to }, results)
            }
            Operation::Output(of, n) => self.output(function, *of, *n as usize, width),
            Operation::Call(id, arguments) => {
                let arguments = self.flat(function, arguments);
                return self.call(value, id.0 as usize, arguments, cost);
            }
            Operation::Fold(fold) => return self.fold(function, value, fold, cost),
        };
        self.set(value, State::Components(components));
        Ok(())
    }

    /// The work of one operation, that of the functions it runs included.
    fn cost(&self, operation: &Operation) -> u64 {
        let of = |id: FunctionId| self.plan.functions.get(id.0 as usize).map_or(0, |callee| callee.cost);
        match operation {
            Operation::Call(id, _) => of(*id).saturating_add(1),
            Operation::Fold(fold) => {
                let steps = self
                    .bits(self.scalar(fold.steps))
                    .map_or(fold.most, |bits| u32::try_from(bits as i32).unwrap_or(0).min(fold.most));
                let step = of(fold.body).saturating_add(fold.condition.map_or(0, of)).saturating_add(1);
                step.saturating_mul(u64::from(steps)).saturating_add(1)
            }
            _ => 1,
        }
    }
}
