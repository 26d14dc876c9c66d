//! What a name or an expression stands for while a function is being made.

use crate::diagnostic::Place;
use crate::graph::{Constant, Type, Value};
use std::rc::Rc;

/// What an expression gives.
#[derive(Clone, Debug)]
pub enum Wire {
    /// A number, vector or bool.
    Value(Value),
    /// A texture of a resource: `p.layers`.
    View(Value),
    /// The outputs of a node with several.
    Record(Rc<Vec<(String, Wire)>>),
    /// A resource.
    Resource(Rc<ResourceWire>),
    /// A bare word that names no value; fine where an input's type lists it.
    Word(String, Place),
    /// A string.
    Text(String),
    /// A list with the places of its elements.
    List(Rc<Vec<(Wire, Place)>>),
    /// A resource that was not given.
    None,
    /// Wrong, and reported already; or waiting for a node to be made.
    Unknown,
}

/// A resource as a function sees it: its views are values of that function.
#[derive(Clone, Debug)]
pub struct ResourceWire {
    /// Row of the table of kinds.
    pub kind: usize,
    /// Its view fields.
    pub views: Vec<(&'static str, Value)>,
    /// Its constant fields.
    pub constants: Vec<(&'static str, Constant)>,
}

/// An argument as far as it decides which specialisation is meant.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum ArgumentKey {
    /// A known number: part of the function.
    Constant(Constant),
    /// A value of this type: an input of the function.
    Value(Type),
    /// A resource: its views are inputs, its constants part of the function.
    Resource(usize, Vec<(&'static str, Constant)>),
    /// A bare word.
    Word(String),
    /// A resource that was not given.
    None,
}

/// A node with everything that is known when it is called.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    /// Index of the module.
    pub module: usize,
    /// Index of the item.
    pub item: usize,
    /// The dimension variables, in order.
    pub dims: Vec<u8>,
    /// The inputs, in order.
    pub arguments: Vec<ArgumentKey>,
}
