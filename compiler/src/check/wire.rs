//! What a name or an expression stands for while a function is being made.

use super::types::NodeType;
use crate::diagnostic::Place;
use crate::graph::{Constant, FunctionId, Type, Value};
use crate::library::Callable;
use smallvec::SmallVec;
use smol_str::SmolStr;
use std::rc::Rc;
use std::sync::Arc;

/// What an expression gives. Small, since there is one for every name.
#[derive(Clone, Debug)]
pub enum Wire {
    /// A number, vector or bool.
    Value(Value),
    /// A texture of a resource: `p.layers`.
    View(Value),
    /// The outputs of a node with several.
    Record(Rc<Vec<(SmolStr, Wire)>>),
    /// A matrix, by its columns.
    Matrix(Rc<[Value]>),
    /// A resource.
    Resource(Rc<ResourceWire>),
    /// A node: an input of this function, or an argument made ready for one.
    Node(Rc<NodeWire>),
    /// The nodes of another file by this name, before it is known whether one is wanted.
    Callables(Rc<ImportedNodes>),
    /// A lambda, before the node's type is known.
    Lambda,
    /// A bare word that names no value; fine where an input's type lists it.
    Word(Rc<BareWord>),
    /// A string.
    Text(Rc<str>),
    /// A list with the places of its elements.
    List(Rc<Vec<(Wire, Place)>>),
    /// A resource or value that was not given.
    None,
    /// Wrong, and reported already; or waiting for a node to be made.
    Unknown,
}

impl Wire {
    /// A bare word.
    pub fn word(text: &str, place: Place) -> Wire {
        Wire::Word(Rc::new(BareWord { text: text.to_owned(), place }))
    }
}

/// A word that names no value.
#[derive(Clone, Debug)]
pub struct BareWord {
    /// The word.
    pub text: String,
    /// Where it stands.
    pub place: Place,
}

/// A resource as a function sees it: its views are values of that function.
#[derive(Clone, Debug)]
pub struct ResourceWire {
    /// Row of the table of kinds.
    pub kind: usize,
    /// Which one it is, where that is known.
    pub id: Option<usize>,
    /// Its view fields.
    pub views: Vec<(&'static str, Value)>,
    /// Its constant fields.
    pub constants: Vec<(&'static str, Constant)>,
}

/// A node as a value: a function whose inputs are those of its type, then its captures.
#[derive(Clone, Debug)]
pub struct NodeWire {
    /// The function.
    pub function: FunctionId,
    /// What it takes and gives.
    pub ty: Arc<NodeType>,
    /// What it reads from where it was written, as values of the function being made.
    pub captures: Vec<Value>,
}

/// What `alias.name` may call.
#[derive(Clone, Debug)]
pub struct ImportedNodes {
    /// As written, alias included.
    pub name: String,
    /// The nodes of that name.
    pub callables: Vec<Callable>,
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
    /// A matrix, column by column.
    Matrix(Vec<ArgumentKey>),
    /// A node: its captures are inputs, the rest part of the function.
    Node(FunctionId),
    /// A bare word.
    Word(String),
    /// A resource or value that was not given.
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
    pub dims: SmallVec<[u8; 4]>,
    /// The inputs, in order.
    pub arguments: SmallVec<[ArgumentKey; 8]>,
    /// A wire of the body that it gives in place of its outputs.
    pub wire: Option<String>,
}

impl Key {
    /// Whether functions of the program are among its arguments.
    pub fn is_passed_functions(&self) -> bool {
        self.arguments.iter().any(|argument| matches!(argument, ArgumentKey::Node(_)))
    }
}
