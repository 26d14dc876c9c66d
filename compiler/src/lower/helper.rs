//! Functions that the shader brings along.

use super::Lowering;
use super::body::Body;
use super::types::{Types, numeric};
use crate::intrinsic::Helper;
use crate::naming::Scope;
use naga::{BinaryOperator, Expression, Handle, Literal, Span};
use smol_str::SmolStr;

impl Lowering<'_> {
    /// The function, made when first needed.
    pub(super) fn helper(&mut self, helper: Helper) -> Handle<naga::Function> {
        if let Some(handle) = self.helpers.get(&helper) {
            return *handle;
        }
        let name = match helper {
            Helper::Hash => self.module_name("hash"),
        };
        let function = self.link_helper(helper, &name).unwrap_or_else(|| match helper {
            Helper::Hash => self.hash(name),
        });
        let handle = self.module.functions.append(function, Span::UNDEFINED);
        self.results.push(Default::default());
        self.helpers.insert(helper, handle);
        handle
    }

    /// pcg4d: a linear congruential step, then twice a round of multiply-adds, xor-shift between.
    fn hash(&mut self, name: SmolStr) -> naga::Function {
        let ints = Types::of(&mut self.module.types, numeric(naga::Scalar::I32, 4));
        let words = Types::of(&mut self.module.types, numeric(naga::Scalar::U32, 4));
        let floats = Types::of(&mut self.module.types, numeric(naga::Scalar::F32, 4));
        let mut scope = Scope::inside(&self.prefix);
        let argument = self.names.placeholder(scope.name("v"));
        let mut function = naga::Function {
            name: Some(self.names.placeholder(name)),
            arguments: vec![naga::FunctionArgument { name: Some(argument), ty: ints, binding: None }],
            result: Some(naga::FunctionResult { ty: floats, binding: None }),
            ..Default::default()
        };
        let mut b = Body::new(&mut function, scope);
        let v = b.add(Expression::FunctionArgument(0));
        let v = b.convert(v, naga::ScalarKind::Uint);
        let scaled = b.with_word(BinaryOperator::Multiply, v, 1_664_525);
        let seeded = b.with_word(BinaryOperator::Add, scaled, 1_013_904_223);
        b.name(&mut self.names, seeded, "seeded");
        let first = self.round(&mut b, seeded, words);
        b.name(&mut self.names, first, "first");
        let shifted = b.with_word(BinaryOperator::ShiftRight, first, 16);
        let mixed = b.binary(BinaryOperator::ExclusiveOr, first, shifted);
        b.name(&mut self.names, mixed, "mixed");
        let second = self.round(&mut b, mixed, words);
        let upper = b.with_word(BinaryOperator::ShiftRight, second, 8);
        let upper = b.convert(upper, naga::ScalarKind::Float);
        let unit = b.literal(Literal::F32(1.0 / 16_777_216.0));
        let result = b.binary(BinaryOperator::Multiply, upper, unit);
        b.finish(result);
        function
    }

    /// x += y·w, y += z·x, z += x·y, w += y·z, each with what was just computed.
    fn round(&mut self, b: &mut Body, v: Handle<Expression>, ty: Handle<naga::Type>) -> Handle<Expression> {
        let mut part: Vec<Handle<Expression>> =
            (0..4).map(|i| b.add(Expression::AccessIndex { base: v, index: i })).collect();
        for (to, a, c) in [(0, 1, 3), (1, 2, 0), (2, 0, 1), (3, 1, 2)] {
            let product = b.binary(BinaryOperator::Multiply, part[a], part[c]);
            part[to] = b.binary(BinaryOperator::Add, part[to], product);
            b.name(&mut self.names, part[to], ["x", "y", "z", "w"][to]);
        }
        b.add(Expression::Compose { ty, components: part })
    }
}

impl Body<'_> {
    /// An operation of a vector with one word in every component.
    fn with_word(&mut self, op: BinaryOperator, v: Handle<Expression>, word: u32) -> Handle<Expression> {
        let value = self.literal(Literal::U32(word));
        let right = self.add(Expression::Splat { size: naga::VectorSize::Quad, value });
        self.binary(op, v, right)
    }
}
