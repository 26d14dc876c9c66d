//! The hash that shaders bring along, made for what is asked of it.

use super::Lowering;
use super::body::Body;
use super::types::{Types, numeric, size};
use crate::graph::{Constant, Function, Operation, Value};
use crate::intrinsic::{Form, Helper};
use crate::naming::{Names, Scope};
use naga::{BinaryOperator, Expression, Handle, Literal, Span};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

/// A hash as it is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Hash {
    /// The words that it takes, 1 to 4; those after them are 0.
    pub words: u8,
    /// The numbers that it gives, 1 to 4; nobody reads those after them.
    pub numbers: u8,
}

/// What is read of a hash in a function.
#[derive(Clone, Copy, Default)]
pub struct Drawn {
    /// The numbers up to the last that is read, 1 to 4.
    pub numbers: u8,
    /// The first of them on its own, if it is read so.
    pub first: Option<Value>,
}

/// Rounds mix words that differ from shader to shader with words that are the same in all.
#[derive(Clone, Copy)]
enum Word {
    Known(u32),
    Value(Handle<Expression>),
}

const MULTIPLIER: u32 = 1_664_525;
const INCREMENT: u32 = 1_013_904_223;

impl Hash {
    /// All that can be asked for.
    pub fn all() -> impl Iterator<Item = Hash> {
        (1..=4).flat_map(|words| (1..=4).map(move |numbers| Hash { words, numbers }))
    }
}

/// The words of a hash that are not 0, with those before them, where some are left out.
pub fn words(function: &Function, argument: Value) -> Option<&[Value]> {
    let Operation::Compose(parts) = function.operation(argument) else { return None };
    let zero = Constant::ints(&[0]);
    let is_zero = |part: &Value| *function.operation(*part) == Operation::Constant(zero);
    let given = parts.iter().rposition(|part| !is_zero(part)).map_or(1, |last| last + 1);
    parts.get(..given).filter(|given| given.len() < parts.len())
}

/// Whether an operation is a hash.
pub fn is_hash(operation: &Operation) -> bool {
    let Operation::Builtin(intrinsic, _) = operation else { return false };
    matches!(intrinsic.row().form, Form::Helper(Helper::Hash))
}

/// What is read of every hash of a function.
pub fn drawn(function: &Function) -> FxHashMap<Value, Drawn> {
    let hashes = function.iter().filter(|(_, operation)| is_hash(operation));
    let mut drawn: FxHashMap<Value, Drawn> =
        hashes.map(|(value, _)| (value, Drawn { numbers: 1, first: None })).collect();
    for (value, operation) in function.iter() {
        if let Operation::Extract(of, i) = operation {
            if let Some(drawn) = drawn.get_mut(of) {
                drawn.numbers = drawn.numbers.max(i + 1);
                drawn.first = drawn.first.or((*i == 0).then_some(value));
            }
        } else {
            operation.for_operands(|v| all_of(&mut drawn, v));
        }
    }
    function.outputs.iter().for_each(|(_, value)| all_of(&mut drawn, *value));
    drawn
}

fn all_of(drawn: &mut FxHashMap<Value, Drawn>, value: Value) {
    if let Some(drawn) = drawn.get_mut(&value) {
        drawn.numbers = 4;
    }
}

impl Lowering<'_> {
    /// The function, made when first needed.
    pub(super) fn helper(&mut self, hash: Hash) -> Handle<naga::Function> {
        if let Some(handle) = self.helpers.get(&hash) {
            return *handle;
        }
        let name = self.module_name("hash");
        let function = self.link_helper(hash, &name).unwrap_or_else(|| self.hash(name, hash));
        let handle = self.module.functions.append(function, Span::UNDEFINED);
        self.results.push(Default::default());
        self.helpers.insert(hash, handle);
        handle
    }

    /// pcg4d: a linear congruential step, then twice a round of multiply-adds, xor-shift between.
    fn hash(&mut self, name: SmolStr, hash: Hash) -> naga::Function {
        let types = &mut self.module.types;
        let [taken, given] = [(naga::Scalar::I32, hash.words), (naga::Scalar::F32, hash.numbers)]
            .map(|(scalar, width)| Types::of(types, numeric(scalar, width)));
        let [three, four] = [3, 4].map(|width| Types::of(types, numeric(naga::Scalar::U32, width)));
        let result = Types::of(types, numeric(naga::Scalar::U32, hash.numbers));
        let mut scope = Scope::inside(&self.prefix);
        let argument = self.names.placeholder(scope.name("v"));
        let mut function = naga::Function {
            name: Some(self.names.placeholder(name)),
            arguments: vec![naga::FunctionArgument { name: Some(argument), ty: taken, binding: None }],
            result: Some(naga::FunctionResult { ty: given, binding: None }),
            ..Default::default()
        };
        let mut b = Body::new(&mut function, scope);
        let v = b.add(Expression::FunctionArgument(0));
        let v = b.convert(v, naga::ScalarKind::Uint);
        let scaled = b.with_word(BinaryOperator::Multiply, v, MULTIPLIER, hash.words);
        let seeded = b.with_word(BinaryOperator::Add, scaled, INCREMENT, hash.words);
        b.name(&mut self.names, seeded, "seeded");
        let seeded = b.parts(seeded, hash.words);
        let [x, y, z, w] = b.round(&mut self.names, seeded, 4);
        // The first number alone does not need the third word.
        let (stirred, ty) = if hash.numbers == 1 { (vec![x, y, w], three) } else { (vec![x, y, z, w], four) };
        let width = stirred.len() as u8;
        let components = stirred.into_iter().map(|word| b.word(word)).collect();
        let first = b.add(Expression::Compose { ty, components });
        b.name(&mut self.names, first, "first");
        let shifted = b.with_word(BinaryOperator::ShiftRight, first, 16, width);
        let mixed = b.binary(BinaryOperator::ExclusiveOr, first, shifted);
        b.name(&mut self.names, mixed, "mixed");
        let mut mixed = b.parts(mixed, width);
        if hash.numbers == 1 {
            mixed.swap(2, 3);
        }
        let second = b.round(&mut self.names, mixed, hash.numbers);
        let components =
            second.into_iter().take(usize::from(hash.numbers)).map(|word| b.word(word)).collect();
        let second = b.vector(result, components);
        let upper = b.with_word(BinaryOperator::ShiftRight, second, 8, hash.numbers);
        let upper = b.convert(upper, naga::ScalarKind::Float);
        let unit = b.literal(Literal::F32(1.0 / 16_777_216.0));
        let result = b.binary(BinaryOperator::Multiply, upper, unit);
        b.finish(result);
        function
    }
}

impl Body<'_> {
    /// An operation of so many words with one word in every component.
    fn with_word(
        &mut self,
        op: BinaryOperator,
        v: Handle<Expression>,
        word: u32,
        width: u8,
    ) -> Handle<Expression> {
        let value = self.literal(Literal::U32(word));
        let right = match width {
            1 => value,
            _ => self.add(Expression::Splat { size: size(width), value }),
        };
        self.binary(op, v, right)
    }

    /// The words of so many; those after them are what 0 is seeded to.
    fn parts(&mut self, v: Handle<Expression>, width: u8) -> [Word; 4] {
        [0, 1, 2, 3].map(|index| match width {
            1 if index == 0 => Word::Value(v),
            _ if index < width => {
                Word::Value(self.add(Expression::AccessIndex { base: v, index: u32::from(index) }))
            }
            _ => Word::Known(INCREMENT),
        })
    }

    /// x += y·w, y += z·x, z += x·y, w += y·z, each with what was just computed, as many as wanted.
    fn round(&mut self, names: &mut Names, mut words: [Word; 4], wanted: u8) -> [Word; 4] {
        let steps = [(0, 1, 3, "x"), (1, 2, 0, "y"), (2, 0, 1, "z"), (3, 1, 2, "w")];
        for (to, a, c, name) in steps.into_iter().take(usize::from(wanted)) {
            let product = self.of_words(BinaryOperator::Multiply, words[a], words[c]);
            words[to] = self.of_words(BinaryOperator::Add, words[to], product);
            if let Word::Value(value) = words[to] {
                self.name(names, value, name);
            }
        }
        words
    }

    /// A sum or a product.
    fn of_words(&mut self, op: BinaryOperator, left: Word, right: Word) -> Word {
        match (left, right) {
            (Word::Known(a), Word::Known(b)) if op == BinaryOperator::Multiply => {
                Word::Known(a.wrapping_mul(b))
            }
            (Word::Known(a), Word::Known(b)) => Word::Known(a.wrapping_add(b)),
            _ => {
                let (left, right) = (self.word(left), self.word(right));
                Word::Value(self.binary(op, left, right))
            }
        }
    }

    fn word(&mut self, word: Word) -> Handle<Expression> {
        match word {
            Word::Known(word) => self.literal(Literal::U32(word)),
            Word::Value(value) => value,
        }
    }

    /// One component on its own, or several as a vector.
    fn vector(&mut self, ty: Handle<naga::Type>, components: Vec<Handle<Expression>>) -> Handle<Expression> {
        match components.as_slice() {
            [single] => *single,
            _ => self.add(Expression::Compose { ty, components }),
        }
    }
}
