//! `v[i]`: a component of a vector, a column of a matrix, an entry of a table. The index is clamped.

use super::wire::Wire;
use super::{Checker, Frame};
use crate::diagnostic::{Place, folds, limits};
use crate::graph::{Constant, Scalar, Value};
use crate::intrinsic::COMPONENT;
use texgraph_grammar::syntax::{Expr, Span};

impl<'a> Checker<'a> {
    /// `v[i]`: a component, the index clamped.
    pub(super) fn index(
        &mut self,
        f: &mut Frame<'a>,
        wire: Wire,
        base: Place,
        index: &'a Expr,
        span: Span,
    ) -> Wire {
        let place = self.place(f, span);
        let at = self.place(f, index.span);
        let index = self.expr(f, index);
        let table = match &wire {
            Wire::List(items) => match self.table(f, items, base) {
                Some(table) => Some(table),
                None => return Wire::Unknown,
            },
            _ => None,
        };
        let vector = match (&table, &wire) {
            (None, Wire::Value(vector)) => Some(*vector),
            (Some(_), _) | (_, Wire::Matrix(_)) => None,
            (None, other) => {
                self.value(f, other, base);
                return Wire::Unknown;
            }
        };
        let Some(index) = self.coerce_value(f, &index, Scalar::Int, 1, at) else { return Wire::Unknown };
        f.builder.set_place(place);
        if let Some(table) = table {
            return Wire::Value(lookup(f, table, index));
        }
        if let Wire::Matrix(columns) = &wire {
            return self.column(f, columns, index);
        }
        let Some(vector) = vector else { return Wire::Unknown };
        f.builder.set_place(place);
        let width = f.builder.ty(vector).width();
        if let Some(known) = f.builder.as_constant(index) {
            let component = known.int(0).clamp(0, i32::from(width) - 1);
            return Wire::Value(f.builder.extract(vector, component as u8));
        }
        Wire::Value(f.builder.builtin(COMPONENT, &[vector, index]))
    }

    /// A list as a table of constants of one type.
    fn table(&mut self, f: &mut Frame<'a>, items: &[(Wire, Place)], place: Place) -> Option<Vec<Constant>> {
        if items.is_empty() {
            self.report(f, folds::empty_table(place));
            return None;
        }
        if items.len() > limits::MAX_TABLE {
            self.report(f, folds::table_too_long(place, items.len()));
            return None;
        }
        let values: Vec<Option<Value>> =
            items.iter().map(|(wire, place)| self.value(f, wire, *place)).collect();
        let values = self.common_type(f, values.into_iter().collect::<Option<_>>()?, items)?;
        let mut entries = Vec::new();
        for (value, (_, at)) in values.iter().zip(items) {
            match f.builder.as_constant(*value) {
                Some(entry) => entries.push(entry),
                None => {
                    self.report(f, folds::entry_not_constant(*at));
                    return None;
                }
            }
        }
        Some(entries)
    }
}

/// An entry of a table, the index clamped.
fn lookup(f: &mut Frame<'_>, table: Vec<Constant>, index: Value) -> Value {
    match table.as_slice() {
        [only] => f.builder.constant(*only),
        _ => f.builder.lookup(table.into(), index),
    }
}
