//! Plans one function: which of its values are known, and the steps for the others.

use super::evaluate::evaluate;
use super::machine::{Machine, fold_steps};
use super::plan::{Planned, Source, Step};
use super::texture::Texture;
use crate::flat::Slope;
use crate::pass::Pass;
use crate::render::{RenderError, Request};
use texgraph_compiler::graph::{Axis, Constant, Function, FunctionId, Operation, Value};
use texgraph_compiler::manifest;

/// The most operations a pixel.
const MAX_OPERATIONS: u64 = 1_000_000_000;

/// Refuses what would take for ever.
fn bound(operations: u64) -> Result<(), RenderError> {
    if operations > MAX_OPERATIONS {
        return Err(RenderError::TooMuchWork { operations, limit: MAX_OPERATIONS });
    }
    Ok(())
}

/// What is known of a value while its function is planned.
#[derive(Clone, PartialEq)]
enum State {
    /// Nothing: it is dead, or not yet looked at.
    Unknown,
    /// What it is worth.
    Known(Constant),
    /// All outputs of a call, or accumulators of a fold, that no pixel changes.
    KnownOutputs(Vec<Constant>),
    /// A place in the frame.
    Slot(usize),
    /// All outputs of the call or fold that is this step.
    Outputs(usize),
}

/// Plans one function after those that it calls or folds over.
pub struct Planner<'a> {
    pass: &'a Pass<'a>,
    request: &'a Request,
    function: &'a Function,
    live: &'a [bool],
    states: Vec<State>,
    planned: Planned,
}

impl<'a> Planner<'a> {
    /// Nothing planned yet.
    pub fn new(
        pass: &'a Pass<'a>,
        request: &'a Request,
        function: &'a Function,
        live: &'a [bool],
    ) -> Planner<'a> {
        let states = vec![State::Unknown; function.values.len()];
        Planner { pass, request, function, live, states, planned: Planned::default() }
    }

    /// Live values with their operations, operands first.
    fn live(&self) -> impl Iterator<Item = (Value, &'a Operation)> + use<'a> {
        let live = self.live;
        self.function.iter().filter(move |(value, _)| live[value.0 as usize])
    }

    fn state(&self, value: Value) -> &State {
        &self.states[value.0 as usize]
    }

    fn set(&mut self, value: Value, state: State) {
        self.states[value.0 as usize] = state;
    }

    /// The frame begins with the inputs, in order.
    pub fn take_inputs(&mut self) {
        self.planned.slots = self.function.inputs.len();
        for (value, operation) in self.live() {
            if let Operation::Input(n) = operation {
                self.set(value, State::Slot(*n as usize));
            }
        }
    }

    /// The frame begins with what the entry reads of its inputs, values and derivatives; which they
    /// are, and how many components of each.
    pub fn take_entry_inputs(&mut self) -> Vec<(Source, u8)> {
        let mut inputs = Vec::new();
        for (value, operation) in self.live() {
            let state = match operation {
                Operation::Input(n) => self.entry_input(*n, Source::Value, &mut inputs),
                Operation::Derivative(of, axis) => match self.function.operation(*of) {
                    Operation::Input(n) if *axis == Axis::X => {
                        self.entry_input(*n, Source::Right, &mut inputs)
                    }
                    Operation::Input(n) => self.entry_input(*n, Source::Down, &mut inputs),
                    _ => State::Unknown,
                },
                _ => continue,
            };
            self.set(value, state);
        }
        self.planned.slots = inputs.len();
        inputs
    }

    fn entry_input(&self, n: u32, source: fn(Slope) -> Source, inputs: &mut Vec<(Source, u8)>) -> State {
        let (Some(slot), Some(input)) =
            (self.function.inputs.get(n as usize), self.pass.inputs.get(n as usize))
        else {
            return State::Unknown;
        };
        let draw = self.request.draw().value(&input.name, input.ty);
        let slope = Slope::of(&input.name, self.request);
        match (draw, source(slope)) {
            (Some(value), Source::Value(_)) => State::Known(constant(&value)),
            (_, source) => {
                inputs.push((source, slot.ty.width()));
                State::Slot(inputs.len() - 1)
            }
        }
    }

    /// Computes what is known and makes steps of the rest.
    ///
    /// # Errors
    /// A run, or what is computed here, takes more than [`MAX_OPERATIONS`].
    pub fn finish(mut self, callees: &[Planned], textures: &[Texture]) -> Result<Planned, RenderError> {
        self.compute_known(callees, textures)?;
        self.schedule(callees);
        bound(self.planned.cost)?;
        Ok(self.planned)
    }

    /// Computes every live value whose operands are known.
    fn compute_known(&mut self, callees: &[Planned], textures: &[Texture]) -> Result<(), RenderError> {
        let mut machine = Machine::new(callees, textures);
        let mut work = 0u64;
        for (value, operation) in self.live() {
            if *self.state(value) != State::Unknown || !self.can_be_known(operation) {
                continue;
            }
            work = work.saturating_add(self.cost(operation, callees));
            bound(work)?;
            if let Some(state) = self.known(operation, &mut machine, textures) {
                self.set(value, state);
            }
        }
        Ok(())
    }

    /// Whether all operands are known. The start of an accumulator that nobody wants does not count.
    fn can_be_known(&self, operation: &Operation) -> bool {
        let mut known = !matches!(operation, Operation::Input(_) | Operation::Derivative(..));
        operation.for_operands(|operand| {
            let is_known = matches!(self.state(operand), State::Known(_) | State::KnownOutputs(_));
            known &= is_known || !self.live[operand.0 as usize];
        });
        known
    }

    /// The worth of an operation over known operands; none where the program is not whole.
    fn known(&self, operation: &Operation, machine: &mut Machine<'_>, textures: &[Texture]) -> Option<State> {
        let read = |value: Value| match self.state(value) {
            State::Known(constant) => *constant,
            _ => Constant::floats(&[0.0]),
        };
        match operation {
            Operation::Param(id) => {
                let name = &self.pass.code.graph.params.get(id.0 as usize)?.name;
                let param = self.pass.manifest.params.iter().find(|param| param.name == *name)?;
                Some(State::Known(constant(&self.request.settings.value(param))))
            }
            Operation::Output(call, n) => {
                let State::KnownOutputs(outputs) = self.state(*call) else { return None };
                outputs.get(*n as usize).map(|output| State::Known(*output))
            }
            Operation::Call(id, arguments) => {
                let outputs = machine.run(id.0 as usize, arguments.iter().map(|value| read(*value)));
                Some(State::KnownOutputs(outputs.to_vec()))
            }
            Operation::Fold(fold) => Some(State::KnownOutputs(machine.run_fold(fold, read).to_vec())),
            _ => Some(State::Known(evaluate(operation, read, textures, &mut Vec::new()))),
        }
    }

    /// Makes steps of all that is left.
    fn schedule(&mut self, callees: &[Planned]) {
        let known = self.number_known();
        for (value, operation) in self.live() {
            if *self.state(value) != State::Unknown {
                continue;
            }
            if let Operation::Output(call, n) = operation {
                let target = self.new_slot(value);
                if let State::Outputs(step) = self.state(*call) {
                    let step = *step;
                    self.planned.steps[step].results.push((*n, target));
                }
                continue;
            }
            self.planned.cost = self.planned.cost.saturating_add(self.cost(operation, callees));
            let moved = operation.map_operands(|operand| self.register(&known, operand));
            let target = if matches!(operation, Operation::Call(..) | Operation::Fold(_)) {
                self.set(value, State::Outputs(self.planned.steps.len()));
                Value(0)
            } else {
                self.new_slot(value)
            };
            self.planned.steps.push(Step { operation: moved, target, results: Vec::new() });
        }
        let outputs = self.function.outputs.iter();
        let wanted =
            outputs.map(|(_, value)| self.live[value.0 as usize].then(|| self.register(&known, *value)));
        self.planned.outputs = wanted.collect();
    }

    /// A new place in the frame for a value; its register.
    fn new_slot(&mut self, value: Value) -> Value {
        self.set(value, State::Slot(self.planned.slots));
        self.planned.slots += 1;
        Value((self.planned.known.len() + self.planned.slots - 1) as u32)
    }

    /// The register of a value that is known or has been scheduled. A call or fold has none: only
    /// its outputs are read; nor has a value that nobody wants, and any does in its place.
    fn register(&self, known: &[Option<u32>], value: Value) -> Value {
        match (known[value.0 as usize], self.state(value)) {
            (Some(register), _) => Value(register),
            (None, State::Slot(slot)) => Value((self.planned.known.len() + slot) as u32),
            _ => Value(0),
        }
    }

    /// The work of one operation, that of the functions it runs included.
    fn cost(&self, operation: &Operation, callees: &[Planned]) -> u64 {
        let of = |id: FunctionId| callees.get(id.0 as usize).map_or(0, |callee| callee.cost);
        match operation {
            Operation::Call(id, _) => of(*id).saturating_add(1),
            Operation::Fold(fold) => {
                let steps = match self.state(fold.steps) {
                    State::Known(steps) => fold_steps(fold, steps),
                    _ => fold.most,
                };
                let step = of(fold.body).saturating_add(fold.condition.map_or(0, of)).saturating_add(1);
                step.saturating_mul(u64::from(steps)).saturating_add(1)
            }
            _ => 1,
        }
    }

    /// Gives every known value that may be read the next register.
    fn number_known(&mut self) -> Vec<Option<u32>> {
        let known = &mut self.planned.known;
        let numbered = self.states.iter().map(|state| match state {
            State::Known(constant) => {
                known.push(*constant);
                Some(known.len() as u32 - 1)
            }
            _ => None,
        });
        numbered.collect()
    }
}

/// A manifest's value as the graph carries it.
fn constant(value: &manifest::Value) -> Constant {
    match value {
        manifest::Value::Float(components) => Constant::floats(components),
        manifest::Value::Int(components) => Constant::ints(components),
        manifest::Value::Bool(components) => Constant::bools(components),
    }
}
