//! Functions made inside others: the body of a fold, a lambda, a node passed as an argument.
//!
//! Such a function sees the wires around it. One that it reads becomes an input of it, a *capture*;
//! numbers, params and views are simply made again inside.

use super::wire::{NodeWire, ResourceWire, Wire};
use super::{Checker, Frame};
use crate::graph::{Builder, Operation, Value};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::rc::Rc;

/// A function that waits for one inside it.
pub struct Layer {
    pub builder: Builder,
    /// Its first scope.
    pub base: usize,
    /// What the function inside reads of it, in the order of the inner inputs.
    pub captures: Vec<Value>,
    known: FxHashMap<Value, Value>,
}

impl<'a> Frame<'a> {
    /// Goes on with a function inside the present one, in a scope of its own.
    pub(super) fn enter(&mut self, name: &str) {
        let place = self.builder.place();
        let builder = std::mem::replace(&mut self.builder, Builder::new(name));
        let captures = Vec::new();
        self.layers.push(Layer { builder, base: self.base, captures, known: FxHashMap::default() });
        self.base = self.scopes.len();
        self.scopes.push(FxHashMap::default());
        self.builder.set_place(place);
        // What is evaluated in here is not the step's own.
        self.foreign += 1;
    }

    /// Leaves it: what was made, and what it reads of the function around it.
    pub(super) fn leave(&mut self) -> (Builder, Vec<Value>) {
        self.foreign -= 1;
        self.scopes.truncate(self.base);
        let Some(layer) = self.layers.pop() else { return (Builder::default(), Vec::new()) };
        self.base = layer.base;
        (std::mem::replace(&mut self.builder, layer.builder), layer.captures)
    }

    /// The function of a level; 0 is the outermost.
    pub(super) fn builder_of(&self, level: usize) -> &Builder {
        self.layers.get(level).map_or(&self.builder, |layer| &layer.builder)
    }

    /// The level of the function that a scope belongs to.
    fn level_of(&self, scope: usize) -> usize {
        if scope >= self.base {
            return self.layers.len();
        }
        self.layers.iter().rposition(|layer| scope >= layer.base).unwrap_or(0)
    }

    /// What a name stands for, as a wire of the function being made.
    pub(super) fn lookup(&mut self, name: &str) -> Option<Wire> {
        let found = self.scopes.iter().enumerate().rev().find_map(|(i, scope)| Some((i, scope.get(name)?)));
        let (scope, wire) = found?;
        let (level, wire) = (self.level_of(scope), wire.clone());
        Some(if level == self.layers.len() { wire } else { self.import(level, wire) })
    }

    /// A wire of an outer function in the present one.
    fn import(&mut self, level: usize, wire: Wire) -> Wire {
        match wire {
            Wire::Value(value) => Wire::Value(self.capture(level, value)),
            Wire::View(value) => Wire::View(self.capture(level, value)),
            Wire::Matrix(columns) => {
                Wire::Matrix(columns.iter().map(|column| self.capture(level, *column)).collect())
            }
            Wire::Record(outputs) => {
                let import =
                    |(name, wire): &(SmolStr, Wire)| (name.clone(), self.import(level, wire.clone()));
                Wire::Record(Rc::new(outputs.iter().map(import).collect()))
            }
            Wire::List(items) => {
                let import = |(wire, place): &(Wire, _)| (self.import(level, wire.clone()), *place);
                Wire::List(Rc::new(items.iter().map(import).collect()))
            }
            Wire::Resource(resource) => {
                let views = resource.views.iter().map(|(name, view)| (*name, self.capture(level, *view)));
                let views = views.collect();
                Wire::Resource(Rc::new(ResourceWire { views, ..(*resource).clone() }))
            }
            Wire::Node(node) => {
                let captures = node.captures.iter().map(|value| self.capture(level, *value)).collect();
                Wire::Node(Rc::new(NodeWire { captures, ..(*node).clone() }))
            }
            other => other,
        }
    }

    /// A value of the function of a level in the present one.
    pub(super) fn capture(&mut self, level: usize, mut value: Value) -> Value {
        for outer in level..self.layers.len() {
            value = self.capture_once(outer, value);
        }
        value
    }

    /// A value of the function of level `outer` in the function inside it.
    fn capture_once(&mut self, outer: usize, value: Value) -> Value {
        if let Some(known) = self.layers[outer].known.get(&value) {
            return *known;
        }
        let function = self.layers[outer].builder.function();
        let (operation, ty) = (function.operation(value).clone(), function.ty(value));
        let again = matches!(operation, Operation::Constant(_) | Operation::Param(_) | Operation::View(_));
        let name = name_of(&self.layers[outer].builder, value);
        let inner = if outer + 1 < self.layers.len() {
            &mut self.layers[outer + 1].builder
        } else {
            &mut self.builder
        };
        let inside = if again { inner.push(operation, ty) } else { inner.input(name, ty) };
        if !again {
            self.layers[outer].captures.push(value);
        }
        self.layers[outer].known.insert(value, inside);
        inside
    }
}

/// What a capture is called.
fn name_of(builder: &Builder, value: Value) -> String {
    let function = builder.function();
    match (function.names.get(value), function.operation(value)) {
        (Some(name), _) => name.to_string(),
        (None, Operation::Input(i)) => {
            function.inputs.get(*i as usize).map_or(String::new(), |slot| slot.name.to_string())
        }
        (None, Operation::Output(call, i)) => match function.operation(*call) {
            Operation::Call(..) | Operation::Fold(_) => format!("captured_{i}"),
            _ => "captured".to_owned(),
        },
        _ => "captured".to_owned(),
    }
}

impl<'a> Checker<'a> {
    /// The names of what a function reads from around it, for messages.
    pub(super) fn captured_names(&self, f: &Frame<'a>, captures: &[Value]) -> Vec<String> {
        captures.iter().map(|value| name_of(&f.builder, *value)).collect()
    }
}
