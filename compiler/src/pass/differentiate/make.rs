//! Makes one variant of a function.

use super::demand::{Demand, Requests, of_condition};
use super::{Analysis, Layout, Variant, marked};
use crate::graph::{
    Axis, Builder, Constant, Fold, Function, FunctionId, Level, Operation, Sampled, Slot, Value,
};
use crate::intrinsic::{self, ADD, Derivative, SUBTRACT, Tangents};
use smallvec::SmallVec;
use std::sync::Arc;

/// The tangents of a value in x and y.
type Pair = [Value; 2];

/// One for each of the few arguments of an intrinsic.
type Few<T> = SmallVec<[T; 4]>;

const AXES: [(Axis, &str); 2] = [(Axis::X, "dx"), (Axis::Y, "dy")];

/// A variant that was made.
#[derive(Clone)]
pub struct Made {
    /// The function that it became.
    pub id: FunctionId,
    /// For each output the places of its tangents among the outputs, if they are wanted.
    pub tangents: Vec<Option<[u32; 2]>>,
}

/// A variant in the making.
pub struct Making<'a> {
    analysis: &'a Analysis<'a>,
    place: usize,
    function: &'a Function,
    variant: &'a Variant,
    demand: &'a Demand,
    requests: &'a Requests<'a>,
    made: &'a [Vec<Made>],
    builder: Builder,
    inputs: Vec<Value>,
    input_tangents: Vec<Option<Pair>>,
    values: Vec<Value>,
    tangents: Vec<Option<Pair>>,
}

impl<'a> Making<'a> {
    /// Variants of all that the function calls and folds are made already.
    pub fn new(
        analysis: &'a Analysis<'a>,
        place: usize,
        variant: &'a Variant,
        demand: &'a Demand,
        requests: &'a Requests<'a>,
        made: &'a [Vec<Made>],
    ) -> Making<'a> {
        let function = &analysis.graph.functions[place];
        // Tangents are about half as many again.
        let room = function.values.len() * 3 / 2;
        let mut builder = Builder::with_capacity(function.name.clone(), room);
        builder.set_expands(true);
        Making {
            analysis,
            place,
            function,
            variant,
            demand,
            requests,
            made,
            builder,
            inputs: Vec::new(),
            input_tangents: Vec::new(),
            values: Vec::with_capacity(function.values.len()),
            tangents: Vec::with_capacity(function.values.len()),
        }
    }

    /// The function, and for each output the places of its tangents.
    pub fn run(mut self) -> (Function, Vec<Option<[u32; 2]>>) {
        self.take_inputs();
        for (old, operation) in self.function.iter() {
            self.builder.set_place(self.function.places[old.0 as usize]);
            let value = self.copy(old, operation);
            self.values.push(value);
            let wanted = marked(&self.demand.values, old);
            let tangents = if wanted { self.differentiate(old, operation) } else { None };
            self.tangents.push(tangents);
            if let Some(name) = self.function.names.get(old) {
                self.builder.name(value, Arc::clone(name));
                for (tangent, (_, axis)) in tangents.into_iter().flatten().zip(AXES) {
                    self.builder.name(tangent, format!("{name}_{axis}"));
                }
            }
        }
        self.give_outputs()
    }

    fn value(&self, old: Value) -> Value {
        self.values[old.0 as usize]
    }

    /// The tangents of a value; zeros where it does not change.
    fn tangent(&mut self, old: Value) -> Pair {
        let zero = intrinsic::zero(self.function.ty(old)).unwrap_or(Constant::floats(&[0.0]));
        self.tangents[old.0 as usize].unwrap_or_else(|| [self.builder.constant(zero); 2])
    }

    /// The inputs with the tangents of those that change.
    fn take_inputs(&mut self) {
        let function = self.function;
        let layout = self.analysis.layouts[self.place];
        let (before, behind) = function.inputs.split_at(layout.split.min(function.inputs.len()));
        for (first, slots) in [(0, before), (before.len(), behind)] {
            for slot in slots {
                let input = self.builder.input(slot.name.clone(), slot.ty);
                self.inputs.push(input);
            }
            for (i, slot) in (first..).zip(slots) {
                let takes = self.variant.takes(layout, i, slot.ty);
                let tangents = takes.then(|| self.take_tangents(self.inputs[i], slot));
                self.input_tangents.push(tangents);
            }
        }
    }

    /// The tangents of an input: of the entry what the screen says, else further inputs.
    fn take_tangents(&mut self, input: Value, slot: &Slot) -> Pair {
        let entry = self.place + 1 == self.analysis.graph.functions.len();
        AXES.map(|(axis, suffix)| {
            let name = format!("{}_{suffix}", slot.name);
            if !entry {
                return self.builder.input(name, slot.ty);
            }
            let value = self.builder.push(Operation::Derivative(input, axis, Sampled::Constant), slot.ty);
            self.builder.name(value, name);
            value
        })
    }

    /// The operation itself over new values, levels and inner derivatives replaced.
    fn copy(&mut self, old: Value, operation: &Operation) -> Value {
        let copy = match operation {
            Operation::Input(i) => return self.inputs.get(*i as usize).copied().unwrap_or(Value(0)),
            Operation::Derivative(v, axis, _) => return self.tangent(*v)[usize::from(*axis == Axis::Y)],
            Operation::Sample { view, coordinate, layer, level: Level::Auto } => Operation::Sample {
                view: self.value(*view),
                coordinate: self.value(*coordinate),
                layer: layer.map(|v| self.value(v)),
                level: self.level(*coordinate),
            },
            Operation::Call(callee, arguments) => self.call(old, *callee, arguments),
            Operation::Fold(fold) => self.fold(old, fold),
            _ => operation.map_operands(|v| self.values[v.0 as usize]),
        };
        self.builder.push(copy, self.function.ty(old))
    }

    fn level(&mut self, coordinate: Value) -> Level {
        match self.tangents[coordinate.0 as usize] {
            Some([x, y]) => Level::Gradient(x, y),
            // What does not change across the screen shows the finest level.
            None => Level::Level(self.builder.constant(Constant::floats(&[0.0]))),
        }
    }

    /// The variant that a call or a fold asked for, as it was made.
    fn find(&self, id: FunctionId, request: &Variant) -> Option<(&'a Variant, &'a Made)> {
        let (place, variant) = self.requests.find(id, request)?;
        self.made.get(id.0 as usize)?.get(place).map(|made| (variant, made))
    }

    /// Operands for inputs from `first` on, then the tangents of those that change.
    fn with_tangents(
        &mut self,
        operands: &[Value],
        first: usize,
        layout: Layout,
        variant: &Variant,
    ) -> Vec<Value> {
        let mut all: Vec<Value> = operands.iter().map(|v| self.value(*v)).collect();
        for (i, operand) in (first..).zip(operands) {
            if variant.takes(layout, i, self.function.ty(*operand)) {
                all.extend(self.tangent(*operand));
            }
        }
        all
    }

    fn call(&mut self, old: Value, callee: FunctionId, arguments: &[Value]) -> Operation {
        let found = self.demand.inner.get(&old).and_then(|request| self.find(callee, request));
        let Some((variant, made)) = found else { return Operation::Constant(Constant::floats(&[0.0])) };
        Operation::Call(made.id, self.with_tangents(arguments, 0, Layout::CALLED, variant).as_slice().into())
    }

    fn fold(&mut self, old: Value, fold: &Fold) -> Operation {
        let found = self.demand.inner.get(&old).and_then(|request| self.find(fold.body, request));
        let Some((variant, body)) = found else { return Operation::Constant(Constant::floats(&[0.0])) };
        let condition = fold.condition.and_then(|condition| self.find(condition, &of_condition(variant)));
        let layout = self.analysis.layout(fold.body);
        Operation::Fold(Box::new(Fold {
            body: body.id,
            condition: condition.map(|(_, made)| made.id),
            starts: self.with_tangents(&fold.starts, 0, layout, variant),
            steps: self.value(fold.steps),
            most: fold.most,
            captures: self.with_tangents(&fold.captures, fold.starts.len() + 1, layout, variant),
        }))
    }

    /// The tangents of a value that needs them.
    fn differentiate(&mut self, old: Value, operation: &Operation) -> Option<Pair> {
        let ty = self.function.ty(old);
        let pair = match operation {
            Operation::Input(i) => return self.input_tangents.get(*i as usize).copied().flatten(),
            Operation::Builtin(intrinsic, arguments) => {
                let Derivative::Rule(rule) = intrinsic.row().derivative else { return None };
                self.apply(rule, old, arguments)
            }
            Operation::Compose(parts) => {
                let changes: Few<Pair> = parts.iter().map(|v| self.tangent(*v)).collect();
                [0, 1].map(|axis| {
                    let parts: Few<Value> = changes.iter().map(|pair| pair[axis]).collect();
                    self.builder.compose(&parts)
                })
            }
            Operation::Extract(v, i) => self.tangent(*v).map(|t| self.builder.extract(t, *i)),
            Operation::Select(condition, yes, no) => {
                let (condition, yes, no) = (self.value(*condition), self.tangent(*yes), self.tangent(*no));
                [0, 1].map(|axis| self.builder.select(condition, yes[axis], no[axis]))
            }
            Operation::Sample { view, coordinate, layer, level } => {
                self.difference(old, *view, *coordinate, *layer, *level)?
            }
            Operation::Output(of, i) => {
                let places = self.places(*of, *i as usize)?;
                let of = self.value(*of);
                places.map(|place| self.builder.push(Operation::Output(of, place), ty))
            }
            _ => return None,
        };
        Some(pair)
    }

    /// How much two samples one pixel apart, of the same level, differ from this one.
    fn difference(
        &mut self,
        old: Value,
        view: Value,
        coordinate: Value,
        layer: Option<Value>,
        level: Level,
    ) -> Option<Pair> {
        let steps = self.tangents[coordinate.0 as usize]?;
        let level = match level {
            Level::Auto => self.level(coordinate),
            Level::Level(level) => Level::Level(self.value(level)),
            Level::Gradient(x, y) => Level::Gradient(self.value(x), self.value(y)),
        };
        let (view, at, layer) = (self.value(view), self.value(coordinate), layer.map(|v| self.value(v)));
        let sample = self.value(old);
        Some(steps.map(|step| {
            let there = self.builder.builtin(ADD, &[at, step]);
            let there = self.builder.sample(view, there, layer, level);
            self.builder.builtin(SUBTRACT, &[there, sample])
        }))
    }

    fn apply(&mut self, rule: fn(&mut Tangents) -> Value, old: Value, arguments: &[Value]) -> Pair {
        let new: Few<Value> = arguments.iter().map(|v| self.value(*v)).collect();
        let changes: Few<Pair> = arguments.iter().map(|v| self.tangent(*v)).collect();
        let result = self.value(old);
        [0, 1].map(|axis| {
            let tangents: Few<Value> = changes.iter().map(|pair| pair[axis]).collect();
            let builder = &mut self.builder;
            rule(&mut Tangents { builder, arguments: &new, result, tangents: &tangents })
        })
    }

    /// Where the tangents of an output of a call or fold come out.
    fn places(&self, of: Value, output: usize) -> Option<[u32; 2]> {
        let id = match self.function.operation(of) {
            Operation::Call(callee, _) => *callee,
            Operation::Fold(fold) => fold.body,
            _ => return None,
        };
        let (_, made) = self.find(id, self.demand.inner.get(&of)?)?;
        made.tangents.get(output).copied().flatten()
    }

    /// The variant's outputs: the function's own, then the tangents that are wanted.
    fn give_outputs(mut self) -> (Function, Vec<Option<[u32; 2]>>) {
        let function = self.function;
        for (slot, value) in &function.outputs {
            let value = self.value(*value);
            self.builder.output(slot.name.clone(), value);
        }
        let mut places = Vec::new();
        let mut next = function.outputs.len() as u32;
        for ((slot, value), wanted) in function.outputs.iter().zip(&self.variant.wanted) {
            places.push(wanted.then_some([next, next + 1]));
            if !wanted {
                continue;
            }
            for (tangent, (_, axis)) in self.tangent(*value).into_iter().zip(AXES) {
                self.builder.output(format!("{}_{axis}", slot.name), tangent);
                next += 1;
            }
        }
        (self.builder.finish(), places)
    }
}
