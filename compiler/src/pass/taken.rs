//! A function taken apart, so that a pass that makes it anew moves what it keeps.

use crate::graph::{Function, Operation, Place, Slot, Type, Value};
use std::collections::btree_map;
use std::iter::Peekable;
use std::vec;

/// The parts of a function.
pub struct Taken {
    /// Its name.
    pub name: String,
    /// What it took.
    pub inputs: Vec<Slot>,
    /// What it gave.
    pub outputs: Vec<(Slot, Value)>,
    /// Its values, operands first.
    pub values: Values,
}

/// One value with all that a function knows of it.
pub struct Part {
    /// Which it was.
    pub old: Value,
    /// What it is worth.
    pub operation: Operation,
    /// Its type.
    pub ty: Type,
    /// Where it was written.
    pub place: Place,
    /// The author's name for it.
    pub name: Option<String>,
}

impl Taken {
    /// Takes a function apart.
    pub fn new(function: Function) -> Taken {
        let Function { name, inputs, outputs, values, types, names, places, .. } = function;
        let values = Values {
            next: 0,
            operations: values.into_iter(),
            types: types.into_iter(),
            places: places.into_iter(),
            names: names.into_iter().peekable(),
        };
        Taken { name, inputs, outputs, values }
    }
}

/// Goes through the values of a function.
pub struct Values {
    next: u32,
    operations: vec::IntoIter<Operation>,
    types: vec::IntoIter<Type>,
    places: vec::IntoIter<Place>,
    names: Peekable<btree_map::IntoIter<Value, String>>,
}

impl Iterator for Values {
    type Item = Part;

    fn next(&mut self) -> Option<Part> {
        let old = Value(self.next);
        self.next += 1;
        Some(Part {
            old,
            operation: self.operations.next()?,
            ty: self.types.next()?,
            place: self.places.next()?,
            name: self.names.next_if(|(value, _)| *value == old).map(|(_, name)| name),
        })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.operations.size_hint()
    }
}

impl ExactSizeIterator for Values {}
