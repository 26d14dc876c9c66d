//! `if`: a choice between values, or at once where the condition is known.

use super::wire::Wire;
use super::{Checker, Frame, types};
use crate::diagnostic::{Place, rates, types as errors};
use crate::graph::{Scalar, Type, Value};
use std::rc::Rc;
use texgraph_grammar::syntax::Expr;

impl<'a> Checker<'a> {
    pub(super) fn choice(
        &mut self,
        f: &mut Frame<'a>,
        arms: &'a [(Expr, Expr)],
        otherwise: &'a Expr,
    ) -> Wire {
        let mut conditions = Vec::new();
        let mut chosen = Vec::new();
        let mut last = Some(otherwise);
        for (condition, arm) in arms {
            let place = self.place(f, condition.span);
            let wire = self.expr(f, condition);
            let value = self.coerce_value(f, &wire, Scalar::Bool, 1, place);
            match value.and_then(|value| f.builder.as_constant(value)) {
                // A known condition leaves one arm; the other is not even looked at.
                Some(known) if known.bool(0) => {
                    last = Some(arm);
                    break;
                }
                Some(_) => continue,
                None => {}
            }
            conditions.push((value, place));
            chosen.push((self.expr(f, arm), self.place(f, arm.span)));
        }
        if let Some(arm) = last.take() {
            chosen.push((self.expr(f, arm), self.place(f, arm.span)));
        }
        self.select(f, &conditions, chosen)
    }

    /// Nested choices from the arms, the last one unconditional.
    fn select(
        &mut self,
        f: &mut Frame<'a>,
        conditions: &[(Option<Value>, Place)],
        arms: Vec<(Wire, Place)>,
    ) -> Wire {
        if let ([], [(only, _)]) = (conditions, arms.as_slice()) {
            return only.clone();
        }
        if arms
            .iter()
            .any(|(wire, _)| matches!(wire, Wire::Resource(_) | Wire::View(_) | Wire::None | Wire::Node(_)))
        {
            let place = conditions.first().map_or(Place::default(), |(_, place)| *place);
            return self.report(f, rates::choice_not_constant(place));
        }
        if arms.iter().any(|(wire, _)| matches!(wire, Wire::Matrix(_))) {
            return self.select_columns(f, conditions, &arms);
        }
        let values: Vec<Option<Value>> =
            arms.iter().map(|(wire, place)| self.value(f, wire, *place)).collect();
        let Some(values) = values.into_iter().collect::<Option<Vec<Value>>>() else { return Wire::Unknown };
        let Some(values) = self.common_type(f, values, &arms) else { return Wire::Unknown };
        let mut values = values.into_iter().rev();
        let Some(mut result) = values.next() else { return Wire::Unknown };
        for ((condition, _), value) in conditions.iter().rev().zip(values) {
            let Some(condition) = condition else { return Wire::Unknown };
            result = f.builder.select(*condition, value, result);
        }
        Wire::Value(result)
    }

    /// A choice between matrices: column by column.
    fn select_columns(
        &mut self,
        f: &mut Frame<'a>,
        conditions: &[(Option<Value>, Place)],
        arms: &[(Wire, Place)],
    ) -> Wire {
        let size = arms.iter().find_map(|(wire, _)| match wire {
            Wire::Matrix(columns) => Some(columns.len()),
            _ => None,
        });
        let size = size.unwrap_or(2) as u8;
        let matrices = arms.iter().map(|(wire, place)| self.coerce_matrix(f, wire, size, *place));
        let matrices: Vec<Option<Rc<[Value]>>> = matrices.collect();
        let Some(matrices) = matrices.into_iter().collect::<Option<Vec<_>>>() else { return Wire::Unknown };
        let column = |i: usize| {
            let mut values = matrices.iter().rev().map(|matrix| matrix[i]);
            let mut result = values.next()?;
            for ((condition, _), value) in conditions.iter().rev().zip(values) {
                result = f.builder.select((*condition)?, value, result);
            }
            Some(result)
        };
        let columns: Option<Vec<Value>> = (0..usize::from(size)).map(column).collect();
        columns.map_or(Wire::Unknown, |columns| Wire::Matrix(columns.into()))
    }

    /// Arms widen to a common type.
    pub(super) fn common_type(
        &mut self,
        f: &mut Frame<'a>,
        values: Vec<Value>,
        arms: &[(Wire, Place)],
    ) -> Option<Vec<Value>> {
        let types: Vec<Type> = values.iter().map(|value| f.builder.ty(*value)).collect();
        let float = types.iter().any(|ty| ty.is_float());
        let scalar = if float { Scalar::Float } else { types.first()?.scalar()? };
        let width = types.iter().map(|ty| ty.width()).max()?;
        let wanted = Type::Vector(scalar, width);
        let fits = |ty: &Type| {
            ty.scalar().is_some_and(|found| types::widens(found, scalar))
                && (ty.width() == 1 || ty.width() == width)
        };
        if let Some(odd) = types.iter().position(|ty| !fits(ty)) {
            let like = types.iter().position(fits).unwrap_or(0);
            let (odd_name, like_name) =
                (types::name(types[odd]), types::name(types.get(like).copied().unwrap_or(wanted)));
            self.report(f, errors::arms_differ(arms[odd].1, &like_name, &odd_name, arms[like].1));
            return None;
        }
        let mut common = Vec::new();
        for (value, (_, place)) in values.into_iter().zip(arms) {
            common.push(self.coerce_value(f, &Wire::Value(value), scalar, width, *place)?);
        }
        Some(common)
    }
}
