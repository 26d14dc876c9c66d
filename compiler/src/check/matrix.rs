//! Matrices: columns that go together. The graph knows vectors only, so a matrix costs nothing
//! that its columns do not.

use super::arguments::Given;
use super::types;
use super::wire::Wire;
use super::{Checker, Frame};
use crate::diagnostic::{Place, types as errors};
use crate::graph::{Constant, Scalar, Value};
use crate::intrinsic::{ADD, DOT, Intrinsic, LESS_INT, MULTIPLY, NEGATE, SUBTRACT};
use std::rc::Rc;
use texgraph_grammar::syntax::{BinaryOperator, ChainLink};

impl<'a> Checker<'a> {
    /// `mat2(…)`, `mat3(…)`: all columns, or all numbers, column by column.
    pub(super) fn matrix(&mut self, f: &mut Frame<'a>, size: u8, given: &[Given<'a>], place: Place) -> Wire {
        let mut columns = Vec::new();
        let mut numbers = Vec::new();
        for argument in given {
            let Some(value) = self.value(f, &argument.wire, argument.place) else { return Wire::Unknown };
            let width = f.builder.ty(value).width();
            let Some(value) = self.coerce_value(f, &Wire::Value(value), Scalar::Float, width, argument.place)
            else {
                return Wire::Unknown;
            };
            match width {
                1 => numbers.push(value),
                width if width == size => columns.push(value),
                _ => {
                    let name = format!("mat{size}");
                    return self
                        .report(f, errors::component_count(argument.place, &name, size, width.into()));
                }
            }
        }
        f.builder.set_place(place);
        let side = usize::from(size);
        if columns.is_empty() && numbers.len() == side * side {
            columns = numbers.chunks(side).map(|column| f.builder.compose(column)).collect();
            numbers.clear();
        }
        if columns.len() != side || !numbers.is_empty() {
            let name = format!("mat{size}");
            let found = columns.len() * side + numbers.len();
            return self.report(f, errors::component_count(place, &name, size * size, found));
        }
        Wire::Matrix(columns.into())
    }

    /// A wire as a matrix of a size.
    pub(super) fn coerce_matrix(
        &mut self,
        f: &mut Frame<'a>,
        wire: &Wire,
        size: u8,
        place: Place,
    ) -> Option<Rc<[Value]>> {
        match wire {
            Wire::Matrix(columns) if columns.len() == usize::from(size) => Some(Rc::clone(columns)),
            Wire::Unknown => None,
            Wire::Word(word) => {
                self.unknown_value(f, &word.text, word.place);
                None
            }
            other => {
                let found = types::describe(other, |v| f.builder.ty(v));
                let found = found.trim_matches('`');
                self.report(f, errors::mismatch(place, None, &format!("mat{size}"), found));
                None
            }
        }
    }

    /// An operator one of whose operands is a matrix.
    pub(super) fn matrix_operator(
        &mut self,
        f: &mut Frame<'a>,
        link: &ChainLink,
        (a, a_place): (&Wire, Place),
        (b, b_place): (&Wire, Place),
        whole: Place,
    ) -> Wire {
        use BinaryOperator::{Add, Multiply, Subtract};
        f.builder.set_place(whole);
        let width = |f: &Frame<'a>, v: Value| f.builder.ty(v).width();
        let made = match (link.operator, a, b) {
            (Multiply, Wire::Matrix(a), Wire::Matrix(b)) if a.len() == b.len() => {
                Some(Wire::Matrix(b.iter().map(|column| transform(f, a, *column)).collect()))
            }
            (Add | Subtract, Wire::Matrix(a), Wire::Matrix(b)) if a.len() == b.len() => {
                let intrinsic = if link.operator == Add { ADD } else { SUBTRACT };
                let sums = a.iter().zip(b.iter()).map(|(a, b)| f.builder.builtin(intrinsic, &[*a, *b]));
                Some(Wire::Matrix(sums.collect()))
            }
            (Multiply, Wire::Matrix(m), other) | (Multiply, other, Wire::Matrix(m)) => {
                let left = matches!(a, Wire::Matrix(_));
                let place = if left { b_place } else { a_place };
                let Some(value) = self.value(f, other, place) else { return Wire::Unknown };
                let value = f.builder.to_float(value);
                match width(f, value) {
                    _ if !f.builder.ty(value).is_float() => None,
                    1 => Some(Wire::Matrix(scaled(f, m, value))),
                    n if usize::from(n) == m.len() && left => Some(Wire::Value(transform(f, m, value))),
                    n if usize::from(n) == m.len() => {
                        let dots: Vec<Value> =
                            m.iter().map(|column| f.builder.builtin(DOT, &[value, *column])).collect();
                        Some(Wire::Value(f.builder.compose(&dots)))
                    }
                    _ => None,
                }
            }
            _ => None,
        };
        made.unwrap_or_else(|| {
            let found = [a, b].map(|wire| types::describe(wire, |v| f.builder.ty(v)).replace('`', ""));
            let accepted = ["a matrix with a matrix, vector or number".to_owned()];
            let at = self.place(f, link.operator_span);
            let error = errors::no_overload(at, link.operator.symbol(), &found, &accepted)
                .related(a_place, format!("`{}`", found[0]))
                .related(b_place, format!("`{}`", found[1]));
            self.report(f, error)
        })
    }

    /// `m[i]`: a column, the index clamped.
    pub(super) fn column(&mut self, f: &mut Frame<'a>, columns: &[Value], index: Value) -> Wire {
        Wire::Value(choose(f, columns, index))
    }
}

/// One of several values of one type by a clamped index: a chain of choices.
fn choose(f: &mut Frame<'_>, values: &[Value], index: Value) -> Value {
    if let Some(known) = f.builder.as_constant(index) {
        let i = usize::try_from(known.int(0)).unwrap_or(0).min(values.len() - 1);
        return values[i];
    }
    let mut rest = values.iter().enumerate().rev();
    let mut chosen = rest.next().map_or(index, |(_, last)| *last);
    for (i, value) in rest {
        let next = f.builder.constant(Constant::ints(&[i as i32 + 1]));
        let here = f.builder.builtin(LESS_INT, &[index, next]);
        chosen = f.builder.select(here, *value, chosen);
    }
    chosen
}

/// A matrix times a vector: the columns weighed by its components.
fn transform(f: &mut Frame<'_>, matrix: &[Value], vector: Value) -> Value {
    let mut sum = None;
    for (i, column) in matrix.iter().enumerate() {
        let component = f.builder.extract(vector, i as u8);
        let weight = f.builder.splat(component, matrix.len() as u8);
        let part = f.builder.builtin(MULTIPLY, &[*column, weight]);
        sum = Some(match sum {
            Some(sum) => f.builder.builtin(ADD, &[sum, part]),
            None => part,
        });
    }
    sum.unwrap_or(vector)
}

fn scaled(f: &mut Frame<'_>, matrix: &[Value], factor: Value) -> Rc<[Value]> {
    let factor = f.builder.splat(factor, matrix.len() as u8);
    matrix.iter().map(|column| f.builder.builtin(MULTIPLY, &[*column, factor])).collect()
}

/// The negative of a matrix.
pub fn negated(f: &mut Frame<'_>, matrix: &[Value]) -> Wire {
    each(f, matrix, NEGATE)
}

fn each(f: &mut Frame<'_>, matrix: &[Value], intrinsic: Intrinsic) -> Wire {
    Wire::Matrix(matrix.iter().map(|column| f.builder.builtin(intrinsic, &[*column])).collect())
}
