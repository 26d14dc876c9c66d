//! Heads: what a node, an intrinsic or a constructor takes. What of it is the same in every call is
//! worked out once.

use super::types::{self, Declared, Dims};
use crate::graph::{Constant, Scalar};
use texgraph_grammar::syntax::{Dim, ExprKind, File, Input, Name, TypeKind};

/// The head of what is called.
#[derive(Clone, Copy)]
pub struct Head<'s> {
    /// Its name, for messages.
    pub name: &'s str,
    /// Its dimension variables.
    pub dims: &'s [Name],
    /// Its inputs.
    pub inputs: &'s [Input],
    /// What is known of each.
    pub known: &'s [Known],
    /// The module whose names its defaults see.
    pub module: usize,
}

/// What is known of an input.
#[derive(Clone, Debug)]
pub struct Known {
    /// Its type.
    pub ty: InputType,
    /// Its default, where that is a literal of its type.
    pub default: Option<Constant>,
}

/// The type of an input.
#[derive(Clone, Debug)]
pub enum InputType {
    /// The same in every call.
    Same(Declared),
    /// A vector as wide as a dimension variable, given by its place.
    Wide(Scalar, usize),
    /// To be looked at in each call; wrong ones too.
    Open,
}

/// What is known of a head's inputs.
pub fn known(dims: &[Name], inputs: &[Input]) -> Vec<Known> {
    let known = inputs.iter().map(|input| {
        let ty = input_type(dims, input);
        Known { default: literal(&ty, input), ty }
    });
    known.collect()
}

/// The same for each item of a file; nothing for those that have no inputs.
pub fn known_of_items(file: &File) -> Vec<Vec<Known>> {
    let nodes = file.items.iter().map(super::globals::node_of);
    nodes.map(|node| node.map_or_else(Vec::new, |node| known(&node.dims, &node.inputs))).collect()
}

fn input_type(dims: &[Name], input: &Input) -> InputType {
    if let TypeKind::Named { dim: Some(Dim::Name(dim)), .. } = &input.ty.kind {
        let place = dims.iter().position(|known| known.text == dim.text);
        let scalar = types::scalar_of(&input.ty).filter(|_| types::fixed_width(&input.ty).is_none());
        return scalar.zip(place).map_or(InputType::Open, |(scalar, place)| InputType::Wide(scalar, place));
    }
    types::resolve(&input.ty, &Dims::new(), 0).map_or(InputType::Open, InputType::Same)
}

fn literal(ty: &InputType, input: &Input) -> Option<Constant> {
    let constant = match &input.default.as_ref()?.kind {
        ExprKind::Int(Some(int)) => Constant::ints(&[i32::try_from(*int).ok()?]),
        ExprKind::Float(float) if (*float as f32).is_finite() => Constant::floats(&[*float as f32]),
        ExprKind::Bool(holds) => Constant::bools(&[*holds]),
        _ => return None,
    };
    matches!(ty, InputType::Same(Declared::Vector(scalar, 1)) if *scalar == constant.scalar())
        .then_some(constant)
}
