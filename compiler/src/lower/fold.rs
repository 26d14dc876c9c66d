//! A fold as a loop, its condition and its step lowered in place.
//!
//! ```text
//! var sum = start;
//! var i = 0;
//! loop {
//!     if i >= steps { break; }
//!     if !condition { break; }
//!     …
//!     sum = next;
//!     continuing { i = i + 1; }
//! }
//! ```

use super::Lowering;
use super::body::{Body, Variable};
use super::frame::{Argument, Frame};
use crate::graph::regions::{Region, Regions};
use crate::graph::{Fold, Function, FunctionId, Operation, Type, Value};
use crate::intrinsic::MINIMUM_INT;
use naga::{BinaryOperator, Expression, Handle, Literal, Statement};

impl Lowering<'_> {
    /// Lowers a fold; gives its accumulators after the last step.
    pub(super) fn fold(
        &mut self,
        body: &mut Body,
        frame: &mut Frame,
        value: Value,
        fold: &Fold,
    ) -> Vec<Handle<Expression>> {
        let graph = self.graph;
        let step = graph.function(fold.body);
        let region = frame.regions.place(value).unwrap_or(Region::TOP);
        let depth = frame.regions.depth(region) + 1;
        let steps = self.steps(body, frame, fold);
        let accumulators = self.accumulators(body, frame, step, fold);
        let counter = self.counter(body, step, fold);
        let captures: Vec<Argument> = fold.captures.iter().map(|v| self.argument(body, frame, *v)).collect();
        body.open();
        let number = body.load(&mut self.names, &counter);
        let done = body.binary(BinaryOperator::GreaterEqual, number, steps);
        break_if(body, done);
        let mut inputs: Vec<Argument> =
            accumulators.iter().map(|variable| self.loaded(body, variable)).collect();
        if let Some(condition) = fold.condition {
            let inputs = [inputs.as_slice(), &captures].concat();
            self.condition(body, condition, depth, &inputs);
        }
        inputs.push(Argument { handle: number, known: None });
        inputs.extend(captures);
        let mut inner = Frame::of_step(step, Regions::inside(step, &self.weights, depth, &[]));
        inner.bind(&inputs);
        self.block(body, &mut inner, Region::TOP);
        self.advance(body, &inner, &accumulators);
        let stepped = body.close();
        let continuing = count_up(body, &counter, number);
        body.statement(Statement::Loop { body: stepped, continuing, break_if: None });
        accumulators.iter().map(|variable| body.load(&mut self.names, variable)).collect()
    }

    /// A value of the frame around as an input of a step.
    fn argument(&mut self, body: &mut Body, frame: &Frame, value: Value) -> Argument {
        Argument { handle: self.operand(body, frame, value), known: frame.constant(value) }
    }

    fn loaded(&mut self, body: &mut Body, variable: &Variable) -> Argument {
        Argument { handle: body.load(&mut self.names, variable), known: None }
    }

    /// A variable for each accumulator, at its start.
    fn accumulators(
        &mut self,
        body: &mut Body,
        frame: &Frame,
        step: &Function,
        fold: &Fold,
    ) -> Vec<Variable> {
        let mut variables = Vec::with_capacity(fold.starts.len());
        for ((slot, _), start) in step.outputs.iter().zip(&fold.starts) {
            let ty = self.types.get(&mut self.module.types, slot.ty);
            let start = self.operand(body, frame, *start);
            variables.push(body.begin(&mut self.names, &slot.name, ty, start));
        }
        variables
    }

    /// The number of the step, at 0.
    fn counter(&mut self, body: &mut Body, step: &Function, fold: &Fold) -> Variable {
        let wish = step.inputs.get(fold.starts.len()).map_or("i", |slot| slot.name.as_str());
        let ty = self.types.get(&mut self.module.types, Type::INT);
        let zero = body.literal(Literal::I32(0));
        body.begin(&mut self.names, wish, ty, zero)
    }

    /// How many steps are taken at most, an int. Known before the loop begins.
    fn steps(&mut self, body: &mut Body, frame: &Frame, fold: &Fold) -> Handle<Expression> {
        let most = i32::try_from(fold.most).unwrap_or(i32::MAX);
        if let Some(steps) = frame.constant(fold.steps) {
            return body.literal(Literal::I32(steps.int(0).clamp(0, most)));
        }
        let steps = frame.get(fold.steps);
        if takes_all_steps(frame.function, fold) {
            return steps;
        }
        let most = body.literal(Literal::I32(most));
        let fun = naga::MathFunction::Min;
        let bounded =
            body.add(Expression::Math { fun, arg: steps, arg1: Some(most), arg2: None, arg3: None });
        body.name(&mut self.names, bounded, "steps");
        bounded
    }

    /// Ends the loop where the condition does not hold.
    fn condition(&mut self, body: &mut Body, condition: FunctionId, depth: u32, inputs: &[Argument]) {
        let graph = self.graph;
        let function = graph.function(condition);
        let mut frame = Frame::new(function, Regions::inside(function, &self.weights, depth, &[]));
        frame.bind(inputs);
        self.block(body, &mut frame, Region::TOP);
        if let Some((_, holds)) = function.outputs.first() {
            let expr = frame.get(*holds);
            let fails = body.add(Expression::Unary { op: naga::UnaryOperator::LogicalNot, expr });
            break_if(body, fails);
        }
    }

    /// Stores the next accumulators. A value is written out where it is stored, so one that reads
    /// what another store has changed by then is named before.
    fn advance(&mut self, body: &mut Body, frame: &Frame, accumulators: &[Variable]) {
        let step = frame.function;
        let stays = |i: usize, next: Value| *step.operation(next) == Operation::Input(i as u32);
        let next = step.outputs.iter().map(|(_, next)| *next).enumerate();
        let changed: Vec<(usize, Value)> = next.filter(|(i, next)| !stays(*i, *next)).collect();
        let mut stored = vec![false; accumulators.len()];
        let mut stores = Vec::with_capacity(changed.len());
        for (i, next) in changed {
            let mut handle = self.operand(body, frame, next);
            if reads_stored(frame, next, &stored) {
                if let Operation::Input(other) = step.operation(next) {
                    handle = body.load_now(&accumulators[*other as usize]);
                }
                body.name(&mut self.names, handle, &format!("next_{}", accumulators[i].name()));
            }
            stored[i] = true;
            stores.push((i, handle));
        }
        stores.into_iter().for_each(|(i, handle)| body.store(&accumulators[i], handle));
    }
}

/// Whether a number of steps is known not to pass the most there may be.
pub fn takes_all_steps(function: &Function, fold: &Fold) -> bool {
    let bound = |v: &Value| match function.operation(*v) {
        Operation::Constant(c) => u32::try_from(c.int(0)).is_ok_and(|bound| bound <= fold.most),
        _ => false,
    };
    match function.operation(fold.steps) {
        Operation::Constant(_) => true,
        Operation::Builtin(MINIMUM_INT, both) => both.iter().any(bound),
        _ => false,
    }
}

/// Whether a value, written out, reads one of the accumulators that are marked.
fn reads_stored(frame: &Frame, value: Value, stored: &[bool]) -> bool {
    let mut stack = vec![value];
    while let Some(value) = stack.pop() {
        let operation = frame.function.operation(value);
        match operation {
            Operation::Input(i) if stored.get(*i as usize).copied().unwrap_or(false) => return true,
            _ if frame.is_written_out(value) => operation.for_operands(|v| stack.push(v)),
            _ => {}
        }
    }
    false
}

/// Ends the loop around if a bool holds.
fn break_if(body: &mut Body, condition: Handle<Expression>) {
    let accept = naga::Block::from_vec(vec![Statement::Break]);
    body.statement(Statement::If { condition, accept, reject: naga::Block::new() });
}

/// The block between two steps.
fn count_up(body: &mut Body, counter: &Variable, number: Handle<Expression>) -> naga::Block {
    body.open();
    let one = body.literal(Literal::I32(1));
    let next = body.binary(BinaryOperator::Add, number, one);
    body.store(counter, next);
    body.close()
}
