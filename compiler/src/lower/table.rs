//! Constant tables that are indexed at run time.

use super::Lowering;
use super::body::Body;
use super::frame::Frame;
use super::operation::literal;
use super::types::{layout, size};
use crate::graph::{Constant, Type, Value};
use naga::{BinaryOperator, Expression, Handle, Literal, Span, TypeInner};
use std::num::NonZeroU32;
use std::sync::Arc;

/// The entries of a table that is a chain of choices; a longer one is an array of the module.
pub const MAX_CHOSEN: usize = 4;

impl Lowering<'_> {
    /// The entry at an index, the first or last beyond them.
    pub(super) fn lookup(
        &mut self,
        body: &mut Body,
        frame: &Frame,
        table: &Arc<[Constant]>,
        index: Value,
    ) -> Handle<Expression> {
        let index = frame.get(index);
        if table.len() <= MAX_CHOSEN {
            return self.chosen(body, table, index);
        }
        let table_constant = self.table(table);
        let base = body.add(Expression::Constant(table_constant));
        let last = i32::try_from(table.len() - 1).unwrap_or(i32::MAX);
        let [low, high] = [0, last].map(|bound| body.literal(Literal::I32(bound)));
        let fun = naga::MathFunction::Clamp;
        let math = Expression::Math { fun, arg: index, arg1: Some(low), arg2: Some(high), arg3: None };
        let index = body.add(math);
        body.add(Expression::Access { base, index })
    }

    /// `select(select(c, b, i < 2), a, i < 1)`
    fn chosen(
        &mut self,
        body: &mut Body,
        table: &[Constant],
        index: Handle<Expression>,
    ) -> Handle<Expression> {
        let mut entries = table.iter().enumerate().rev();
        let Some((_, last)) = entries.next() else { unreachable!("a table has entries") };
        let mut chosen = self.constant(body, last);
        for (i, entry) in entries {
            let accept = self.constant(body, entry);
            let bound = body.literal(Literal::I32(i as i32 + 1));
            let condition = body.binary(BinaryOperator::Less, index, bound);
            chosen = body.add(Expression::Select { condition, accept, reject: chosen });
        }
        chosen
    }

    /// The array of the module, made when first needed.
    fn table(&mut self, table: &Arc<[Constant]>) -> Handle<naga::Constant> {
        if let Some(handle) = self.tables.get(table) {
            return *handle;
        }
        let element = table.first().map_or(Type::FLOAT, Constant::ty);
        let base = self.types.get(&mut self.module.types, element);
        let (bytes, align) = layout(&self.module.types[base].inner);
        let length = NonZeroU32::new(table.len() as u32).unwrap_or(NonZeroU32::MIN);
        let inner = TypeInner::Array {
            base,
            size: naga::ArraySize::Constant(length),
            stride: bytes.next_multiple_of(align),
        };
        let ty = super::Types::of(&mut self.module.types, inner);
        let components = table.iter().map(|entry| self.entry(entry, base)).collect();
        let init =
            self.module.global_expressions.append(Expression::Compose { ty, components }, Span::UNDEFINED);
        let name = self.module_name("table");
        let constant = naga::Constant { name: Some(self.names.placeholder(name)), ty, init };
        let handle = self.module.constants.append(constant, Span::UNDEFINED);
        self.tables.insert(Arc::clone(table), handle);
        handle
    }

    /// A number among the module's own expressions.
    fn entry(&mut self, entry: &Constant, ty: Handle<naga::Type>) -> Handle<Expression> {
        let mut add = |expression| self.module.global_expressions.append(expression, Span::UNDEFINED);
        let mut components: Vec<Handle<Expression>> = Vec::with_capacity(4);
        for i in 0..usize::from(entry.width()) {
            components.push(add(Expression::Literal(literal(entry, i))));
        }
        match components.as_slice() {
            [single] => *single,
            [value, ..] if entry.is_splat() => {
                add(Expression::Splat { size: size(entry.width()), value: *value })
            }
            _ => add(Expression::Compose { ty, components }),
        }
    }
}
