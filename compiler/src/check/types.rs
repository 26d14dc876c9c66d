//! Types as declared, and how a value becomes one of another type.

use super::wire::Wire;
use crate::diagnostic::{Diagnostic, Place, types};
use crate::graph::{Scalar, Type};
use crate::resource::{DIMENSIONAL, KINDS, LATER, dimension_of, kind_named};
use smallvec::SmallVec;
use smol_str::SmolStr;
use std::sync::Arc;
use texgraph_grammar::syntax::{self, Dim, TypeKind};

/// A declared type with its dimension variables bound.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Declared {
    /// A number, vector or bool.
    Vector(Scalar, u8),
    /// A matrix of so many columns, each as long.
    Matrix(u8),
    /// A resource, by its row in the table of kinds.
    Resource(usize),
    /// A node.
    Node(Arc<NodeType>),
    /// Inside a node's type only: several values with names.
    Record(Vec<(SmolStr, Declared)>),
    /// What a baked node gives: one to four floats.
    Texel,
    /// One of these words.
    Choice(Vec<String>),
    /// Constructors only: a string.
    Text,
    /// Constructors only: one string or a list of them.
    Texts,
    /// Constructors only: a string, or rows of ints.
    Cells,
    /// Constructors only: lists of a place and a colour, one after the other.
    Stops,
    /// Constructors only: a list of numbers, or nothing.
    Numbers,
    /// Constructors only: a list of resources.
    Resources,
}

/// What a node that is passed to another must take and give.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeType {
    /// Numbers, matrices and records of them, with their names.
    pub inputs: Vec<(SmolStr, Declared)>,
    /// A number, a matrix or a record.
    pub output: Declared,
}

/// Dimension variables with their values.
pub type Dims<'a> = SmallVec<[(&'a str, u8); 2]>;

/// The scalar and fixed width of a named vector type; width `None` for the generic forms.
fn vector(name: &str) -> Option<(Scalar, Option<u8>)> {
    Some(match name {
        "float" => (Scalar::Float, Some(1)),
        "vec2" => (Scalar::Float, Some(2)),
        "vec3" => (Scalar::Float, Some(3)),
        "vec4" | "color" => (Scalar::Float, Some(4)),
        "vec" => (Scalar::Float, None),
        "int" => (Scalar::Int, Some(1)),
        "ivec2" => (Scalar::Int, Some(2)),
        "ivec3" => (Scalar::Int, Some(3)),
        "ivec4" => (Scalar::Int, Some(4)),
        "ivec" => (Scalar::Int, None),
        "bool" => (Scalar::Bool, Some(1)),
        "bvec" => (Scalar::Bool, None),
        _ => return None,
    })
}

/// If a name before `(` constructs a vector: its scalar and width (`None` for `vec<n>`, `ivec<n>`).
pub fn vector_constructor(name: &str) -> Option<(Scalar, Option<u8>)> {
    vector(name).filter(|_| !matches!(name, "bvec" | "color"))
}

/// The dimension variable of a generic type, `vec<n>`.
pub fn dimension_variable(ty: &syntax::Type) -> Option<&str> {
    match &ty.kind {
        TypeKind::Named { dim: Some(Dim::Name(name)), .. } => Some(&name.text),
        _ => None,
    }
}

/// The scalar of a vector type, whatever its width.
pub fn scalar_of(ty: &syntax::Type) -> Option<Scalar> {
    match &ty.kind {
        TypeKind::Named { name, .. } => vector(&name.text).map(|(scalar, _)| scalar),
        _ => None,
    }
}

/// The width of a vector type that has one of its own.
pub fn fixed_width(ty: &syntax::Type) -> Option<u8> {
    match &ty.kind {
        TypeKind::Named { name, .. } => vector(&name.text)?.1,
        _ => None,
    }
}

/// The columns of a matrix type.
pub fn matrix(ty: &syntax::Type) -> Option<u8> {
    match &ty.kind {
        TypeKind::Named { name, .. } if name.text == "mat2" => Some(2),
        TypeKind::Named { name, .. } if name.text == "mat3" => Some(3),
        _ => None,
    }
}

/// Whether a type names a row of the table of kinds. A dimension variable stands for any dimension.
pub fn is_kind(ty: &syntax::Type, kind: usize) -> bool {
    match &ty.kind {
        TypeKind::Named { name, dim: Some(Dim::Name(_)) } => dimension_of(&KINDS[kind]).0 == name.text,
        TypeKind::Named { name, dim } => named(&name.text, dim.as_ref()) == Some(kind),
        _ => false,
    }
}

/// The row of the table of kinds that a name with a dimension means; none if that is a variable.
pub fn named(name: &str, dim: Option<&Dim>) -> Option<usize> {
    match dim {
        None => kind_named(name, None),
        Some(Dim::Number(n, _)) => kind_named(name, Some(u8::try_from(*n).ok()?)),
        Some(Dim::Name(_)) => None,
    }
}

/// A declared type under a binding of its dimension variables.
pub fn resolve(ty: &syntax::Type, dims: &Dims<'_>, file: u32) -> Result<Declared, Diagnostic> {
    let place = Place { file, span: ty.span };
    match &ty.kind {
        TypeKind::Named { name, dim } => match vector(&name.text) {
            Some((scalar, Some(width))) if dim.is_none() => Ok(Declared::Vector(scalar, width)),
            Some((scalar, None)) => {
                Ok(Declared::Vector(scalar, width_of(&name.text, dim.as_ref(), dims, place)?))
            }
            Some(_) => Err(types::unknown_type(place, &show(ty), Some(name.text.to_string()))),
            None => match dim {
                Some(dim) => named_in(&name.text, dim, dims, place).map(Declared::Resource),
                None => resolve_other(&name.text, place),
            },
        },
        TypeKind::Choice(words) => Ok(Declared::Choice(words.iter().map(|w| w.text.to_string()).collect())),
        TypeKind::Node { inputs, output } => {
            let inputs = fields(inputs, dims, file)?;
            let output = part(output, dims, file)?;
            Ok(Declared::Node(Arc::new(NodeType { inputs, output })))
        }
        TypeKind::Record(_) => Err(types::type_not_allowed(place, "a record", "an input or output")),
    }
}

/// The fields of a record type, or the inputs of a node type.
fn fields(
    fields: &[syntax::Field],
    dims: &Dims<'_>,
    file: u32,
) -> Result<Vec<(SmolStr, Declared)>, Diagnostic> {
    fields.iter().map(|field| Ok((field.name.text.clone(), part(&field.ty, dims, file)?))).collect()
}

/// What may stand inside a node's type: numbers, matrices, and records of them.
fn part(ty: &syntax::Type, dims: &Dims<'_>, file: u32) -> Result<Declared, Diagnostic> {
    if let TypeKind::Record(parts) = &ty.kind {
        return Ok(Declared::Record(fields(parts, dims, file)?));
    }
    match resolve(ty, dims, file)? {
        fine @ (Declared::Vector(..) | Declared::Matrix(_) | Declared::Texel) => Ok(fine),
        _ => Err(types::type_not_allowed(Place { file, span: ty.span }, &show(ty), "a node's type")),
    }
}

/// The row of the table of kinds that a name with a dimension means.
pub fn named_in(name: &str, dim: &Dim, dims: &Dims<'_>, place: Place) -> Result<usize, Diagnostic> {
    if !DIMENSIONAL.contains(&name) {
        let shown = format!("{name}<{}>", show_dim(dim));
        return Err(types::unknown_type(place, &shown, Some(name.to_owned())));
    }
    let dimension = width_of(name, Some(dim), dims, place)?;
    let unknown = || types::unknown_type(place, &format!("{name}<{dimension}>"), Some(format!("{name}<3>")));
    kind_named(name, Some(dimension)).ok_or_else(unknown)
}

fn resolve_other(name: &str, place: Place) -> Result<Declared, Diagnostic> {
    if let Some(kind) = KINDS.iter().position(|kind| kind.name == name && kind.gives.is_none()) {
        return Ok(Declared::Resource(kind));
    }
    match name {
        "text" => Ok(Declared::Text),
        "texts" => Ok(Declared::Texts),
        "cells" | "row" => Ok(Declared::Cells),
        "stops" => Ok(Declared::Stops),
        "numbers" => Ok(Declared::Numbers),
        "resources" => Ok(Declared::Resources),
        "texel" => Ok(Declared::Texel),
        "mat2" => Ok(Declared::Matrix(2)),
        "mat3" => Ok(Declared::Matrix(3)),
        _ if LATER.contains(&name) => {
            Err(crate::diagnostic::unsupported::not_yet(place, &format!("`{name}`")))
        }
        _ => {
            let known = [
                "float", "vec2", "vec3", "vec4", "int", "ivec2", "ivec3", "ivec4", "bool", "color", "mat2",
                "mat3",
            ];
            let known = known.into_iter().chain(KINDS.iter().map(|kind| kind.name));
            Err(types::unknown_type(place, name, crate::diagnostic::names::nearest(name, known)))
        }
    }
}

/// The width that a generic type's `<n>` stands for.
pub fn width_of(generic: &str, dim: Option<&Dim>, dims: &Dims<'_>, place: Place) -> Result<u8, Diagnostic> {
    match dim {
        Some(Dim::Number(n, _)) if (1..=4).contains(n) => Ok(*n as u8),
        Some(Dim::Number(n, _)) => Err(types::bad_dimension(place, *n)),
        Some(Dim::Name(name)) => match dims.iter().find(|(known, _)| *known == name.text) {
            Some((_, width)) => Ok(*width),
            None => Err(types::unknown_dimension(place, &name.text)),
        },
        None => Err(types::missing_dimension(place, generic)),
    }
}

/// A type as the author would write it.
pub fn show(ty: &syntax::Type) -> String {
    match &ty.kind {
        TypeKind::Named { name, dim: None } => name.text.to_string(),
        TypeKind::Named { name, dim: Some(dim) } => format!("{}<{}>", name.text, show_dim(dim)),
        TypeKind::Choice(words) => words.iter().map(|w| w.text.as_str()).collect::<Vec<_>>().join(" | "),
        TypeKind::Node { .. } => "node".to_owned(),
        TypeKind::Record(_) => "record".to_owned(),
    }
}

fn show_dim(dim: &Dim) -> String {
    match dim {
        Dim::Name(name) => name.text.to_string(),
        Dim::Number(n, _) => n.to_string(),
    }
}

/// The name of a value's type.
pub fn name(ty: Type) -> String {
    match ty {
        Type::Vector(Scalar::Float, 1) => "float".to_owned(),
        Type::Vector(Scalar::Float, width) => format!("vec{width}"),
        Type::Vector(Scalar::Int, 1) => "int".to_owned(),
        Type::Vector(Scalar::Int, width) => format!("ivec{width}"),
        Type::Vector(Scalar::Bool, 1) => "bool".to_owned(),
        Type::Vector(Scalar::Bool, width) => format!("bvec{width}"),
        Type::View(_) => "view".to_owned(),
    }
}

/// Whether a value of one scalar type may stand where another is wanted.
pub fn widens(from: Scalar, to: Scalar) -> bool {
    from == to || (from == Scalar::Int && to == Scalar::Float)
}

/// What a wire is, in the user's words.
pub fn describe(wire: &Wire, ty: impl Fn(crate::graph::Value) -> Type) -> String {
    let kind = |name: &str| format!("`{name}`");
    match wire {
        Wire::Value(value) => kind(&name(ty(*value))),
        Wire::View(_) => "the view of a resource".to_owned(),
        Wire::Record(_) => "a record of several outputs".to_owned(),
        Wire::Matrix(columns) => kind(&format!("mat{}", columns.len())),
        Wire::Node(_) | Wire::Callables(_) => "a node".to_owned(),
        Wire::Lambda => "a lambda".to_owned(),
        Wire::Resource(resource) => kind(KINDS[resource.kind].name),
        Wire::Word(word) => format!("the word `{}`", word.text),
        Wire::Text(_) => "a string".to_owned(),
        Wire::List(_) => "a list".to_owned(),
        Wire::None => "`none`".to_owned(),
        Wire::Unknown => "unknown".to_owned(),
    }
}
