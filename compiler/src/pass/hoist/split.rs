//! A function in two parts: what goes before it, and the rest.

use super::rate::fixed;
use crate::graph::regions::{Regions, Weights};
use crate::graph::{Builder, Function, Operation, Slot, Type, Value};
use std::sync::Arc;

/// How a function is to be split.
pub struct Split<'a> {
    function: &'a Function,
    /// What goes, in arena order; what these are made of goes with them.
    moved: Vec<Value>,
    /// Which values the rest needs, those that go not counted.
    stays: Vec<bool>,
}

impl<'a> Split<'a> {
    /// Finds what goes: it is made of `outside` inputs alone. `per_draw` inputs are the same for a
    /// whole draw. At most `most` values are passed. None if nothing goes.
    pub fn of(
        function: &'a Function,
        outside: &[bool],
        per_draw: &[bool],
        weights: &Weights,
        most: usize,
    ) -> Option<Split<'a>> {
        if !has_work(function, outside) {
            return None;
        }
        let mut movable = fixed(function, outside);
        let trivial = trivial(function);
        let work = |v: Value| !trivial[v.0 as usize];
        let per_draw = fixed(function, per_draw);
        let regions = Regions::of(function, weights);
        for (value, operation) in function.iter() {
            let light = per_draw[value.0 as usize] && !weights.is_heavy(operation);
            let mut goes = movable[value.0 as usize] && (light || regions.is_at_top(value) || !work(value));
            operation.for_operands(|v| goes &= movable[v.0 as usize]);
            movable[value.0 as usize] = goes;
        }
        let mut split = Split { function, moved: Vec::new(), stays: vec![false; function.values.len()] };
        split.decide(|v| movable[v.0 as usize] && work(v), most);
        (!split.moved.is_empty()).then_some(split)
    }

    /// Users before operands: what goes as soon as it can need not be looked into.
    fn decide(&mut self, goes: impl Fn(Value) -> bool, most: usize) {
        let mut needed = vec![false; self.function.values.len()];
        self.function.outputs.iter().for_each(|(_, value)| needed[value.0 as usize] = true);
        for (value, operation) in self.function.iter().rev() {
            if !needed[value.0 as usize] {
                continue;
            }
            // A call or fold has no value of its own.
            let whole = !matches!(operation, Operation::Call(..) | Operation::Fold(_));
            if whole && self.moved.len() < most && goes(value) {
                self.moved.push(value);
            } else {
                self.stays[value.0 as usize] = true;
                operation.for_operands(|v| needed[v.0 as usize] = true);
            }
        }
        self.moved.reverse();
    }

    /// What goes before: it takes the inputs of the function and gives what goes.
    pub fn before(&self) -> Function {
        let function = self.function;
        let mut goes = vec![false; function.values.len()];
        self.moved.iter().for_each(|value| goes[value.0 as usize] = true);
        for (value, operation) in function.iter().rev() {
            if goes[value.0 as usize] {
                operation.for_operands(|v| goes[v.0 as usize] = true);
            }
        }
        let mut part = Part::new(function);
        part.copy(&goes);
        for value in &self.moved {
            part.builder.output(self.name(*value), part.values[value.0 as usize]);
        }
        part.builder.finish()
    }

    /// The rest: it takes the inputs of the function, the `padding` that it does not read, and what
    /// goes.
    pub fn rest(&self, padding: &[Slot]) -> Function {
        let function = self.function;
        let mut part = Part::new(function);
        for slot in padding {
            part.builder.input(slot.name.clone(), slot.ty);
        }
        for value in &self.moved {
            let input = part.builder.input(self.name(*value), function.ty(*value));
            part.values[value.0 as usize] = input;
        }
        part.copy(&self.stays);
        for (slot, value) in &function.outputs {
            part.builder.output(slot.name.clone(), part.values[value.0 as usize]);
        }
        part.builder.finish()
    }

    fn name(&self, value: Value) -> String {
        self.function.names.get(value).map_or("fixed", |name| name).to_owned()
    }
}

/// Some of the values of a function, made anew.
struct Part<'a> {
    function: &'a Function,
    builder: Builder,
    inputs: Vec<Value>,
    values: Vec<Value>,
}

impl<'a> Part<'a> {
    fn new(function: &'a Function) -> Part<'a> {
        let mut builder = Builder::with_capacity(function.name.clone(), function.values.len());
        let inputs = function.inputs.iter().map(|slot| builder.input(slot.name.clone(), slot.ty)).collect();
        Part { function, builder, inputs, values: vec![Value(0); function.values.len()] }
    }

    /// Copies the marked values; their operands are there or marked.
    fn copy(&mut self, marked: &[bool]) {
        for (old, operation) in self.function.iter() {
            if !marked[old.0 as usize] {
                continue;
            }
            self.builder.set_place(self.function.places[old.0 as usize]);
            let value = match operation {
                Operation::Input(i) => self.inputs.get(*i as usize).copied().unwrap_or(Value(0)),
                _ => {
                    let copy = operation.map_operands(|v| self.values[v.0 as usize]);
                    self.builder.push(copy, self.function.ty(old))
                }
            };
            if let Some(name) = self.function.names.get(old) {
                self.builder.name(value, Arc::clone(name));
            }
            self.values[old.0 as usize] = value;
        }
    }
}

/// Whether anything that is work is made of these inputs alone.
pub fn has_work(function: &Function, outside: &[bool]) -> bool {
    fixed(function, outside).into_iter().zip(trivial(function)).any(|(fixed, trivial)| fixed && !trivial)
}

/// Which values are no work: leaves, their components, and vectors of such.
fn trivial(function: &Function) -> Vec<bool> {
    let mut trivial: Vec<bool> = Vec::with_capacity(function.values.len());
    for (value, operation) in function.iter() {
        let leaf = matches!(function.ty(value), Type::View(_))
            || matches!(operation, Operation::Constant(_) | Operation::Input(_) | Operation::Param(_));
        let is_trivial = match operation {
            Operation::Extract(..) => true,
            Operation::Compose(parts) => parts.iter().all(|v| trivial[v.0 as usize]),
            _ => leaf,
        };
        trivial.push(is_trivial);
    }
    trivial
}
