//! The hash that shaders bring along, made for what is asked of it.

use super::Lowering;
use super::body::Body;
use super::types::{Types, numeric, size};
use crate::graph::{Constant, Function, Operation, Value};
use crate::intrinsic::{HASH4, MULTIPLY, TO_INT};
use crate::naming::{Names, Scope};
use naga::{BinaryOperator, Expression, Handle, Literal, Span};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

/// A hash as it is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Hash {
    /// The words that it takes, 1 to 4; those after them are 0. All 4 where it gives 4 numbers: one
    /// function serves all who want so many.
    pub words: u8,
    /// The numbers that it gives: all 4, or 1 where nobody reads the others. With 0 it gives the word
    /// that the first is made of.
    pub numbers: u8,
}

/// What is read of a hash in a function.
#[derive(Clone, Copy)]
pub struct Drawn {
    /// 4, or 1 where only the first is read; 0 for a hash that only picks.
    pub numbers: u8,
    /// The first of them on its own, if it is read so.
    pub first: Option<Value>,
}

/// A step from a hash to a pick, one of a power of two: truncated, a number of [0, 1) times that power
/// is the upper bits of the word that it is made of.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Pick {
    /// The product: the word stands for it.
    Product,
    /// The pick: so many upper bits.
    Upper(u32),
}

/// What is read of all hashes of a function.
#[derive(Default)]
pub struct Draws {
    /// By the hash.
    pub hashes: FxHashMap<Value, Drawn>,
    /// Products and picks of hashes that only pick.
    pub picks: FxHashMap<Value, Pick>,
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
        (1..=4)
            .flat_map(|words| [0, 1].map(|numbers| Hash { words, numbers }))
            .chain([Hash { words: 4, numbers: 4 }])
    }
}

/// The words that a hash takes of its argument's, where it does not take all.
pub fn words(function: &Function, argument: Value, drawn: Drawn) -> Option<&[Value]> {
    let Operation::Compose(parts) = function.operation(argument) else { return None };
    if drawn.numbers > 1 {
        return None;
    }
    let zero = Constant::ints(&[0]);
    let is_zero = |part: &Value| *function.operation(*part) == Operation::Constant(zero);
    let given = parts.iter().rposition(|part| !is_zero(part)).map_or(1, |last| last + 1);
    parts.get(..given).filter(|given| given.len() < parts.len())
}

/// Whether an operation is a hash.
pub fn is_hash(operation: &Operation) -> bool {
    matches!(operation, Operation::Builtin(HASH4, _))
}

/// A hash whose first number is read on its own, and what becomes of that.
struct Chain {
    hash: Value,
    product: Option<(Value, u32)>,
    pick: Option<Value>,
    /// How often the number and the product are read.
    reads: u32,
}

/// A function being looked through.
#[derive(Default)]
struct Looking {
    /// Which values are hashes or stand in a chain; most are neither.
    marked: Vec<bool>,
    draws: Draws,
    /// By the number.
    chains: FxHashMap<Value, Chain>,
    /// The number that each product is made of.
    products: FxHashMap<Value, Value>,
}

impl Draws {
    /// Looks through a function once.
    pub fn of(function: &Function) -> Draws {
        let marked = vec![false; function.values.len()];
        let mut looking = Looking { marked, ..Looking::default() };
        for (value, operation) in function.iter() {
            looking.operation(function, value, operation);
        }
        function.outputs.iter().for_each(|(_, value)| looking.read(*value));
        let Looking { mut draws, chains, .. } = looking;
        for (first, chain) in chains {
            let Chain { hash, product: Some((product, bits)), pick: Some(pick), reads: 2 } = chain else {
                continue;
            };
            let is_named = [first, product].iter().any(|value| function.names.contains(*value));
            let drawn = draws.hashes.get_mut(&hash).filter(|drawn| drawn.numbers == 1 && !is_named);
            if let Some(drawn) = drawn {
                drawn.numbers = 0;
                draws.picks.extend([(product, Pick::Product), (pick, Pick::Upper(bits))]);
            }
        }
        draws
    }
}

impl Looking {
    fn operation(&mut self, function: &Function, value: Value, operation: &Operation) {
        match operation {
            Operation::Extract(of, i) if self.is_marked(*of) => {
                self.extract(*of, *i, value);
                return;
            }
            Operation::Builtin(MULTIPLY, of) if self.is_marked(of[0]) => {
                let bits = power_of_two(function, of[1]);
                if let (Some(bits), Some(chain)) = (bits, self.chains.get_mut(&of[0])) {
                    chain.product = Some((value, bits));
                    self.products.insert(value, of[0]);
                    self.marked[value.0 as usize] = true;
                }
            }
            Operation::Builtin(TO_INT, of) if self.is_marked(of[0]) => {
                let chain = self.products.get(&of[0]).and_then(|first| self.chains.get_mut(first));
                chain.into_iter().for_each(|chain| chain.pick = Some(value));
            }
            _ if is_hash(operation) => {
                self.draws.hashes.insert(value, Drawn { numbers: 1, first: None });
                self.marked[value.0 as usize] = true;
            }
            _ => {}
        }
        operation.for_operands(|v| self.read(v));
    }

    fn extract(&mut self, hash: Value, i: u8, value: Value) {
        if let Some(drawn) = self.draws.hashes.get_mut(&hash) {
            if i > 0 {
                drawn.numbers = 4;
            } else {
                drawn.first = Some(value);
                self.marked[value.0 as usize] = true;
                self.chains.insert(value, Chain { hash, product: None, pick: None, reads: 0 });
            }
        }
    }

    fn is_marked(&self, value: Value) -> bool {
        self.marked[value.0 as usize]
    }

    fn read(&mut self, value: Value) {
        if !self.is_marked(value) {
            return;
        }
        if let Some(drawn) = self.draws.hashes.get_mut(&value) {
            drawn.numbers = 4;
        }
        let first = self.products.get(&value).unwrap_or(&value);
        if let Some(chain) = self.chains.get_mut(first) {
            chain.reads += 1;
        }
    }
}

/// The exponent of a power of two that is known, 1 to 24: a random number has as many bits.
fn power_of_two(function: &Function, value: Value) -> Option<u32> {
    let Operation::Constant(constant) = function.operation(value) else { return None };
    let number = constant.float(0) as u32;
    let exponent = number.checked_ilog2().filter(|exponent| (1..=24).contains(exponent))?;
    (constant.float(0) == (1_u32 << exponent) as f32).then_some(exponent)
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
        let numbers = hash.numbers.max(1);
        let given = if hash.numbers == 0 { naga::Scalar::U32 } else { naga::Scalar::F32 };
        let [taken, given] = [(naga::Scalar::I32, hash.words), (given, numbers)]
            .map(|(scalar, width)| Types::of(types, numeric(scalar, width)));
        let [three, four] = [3, 4].map(|width| Types::of(types, numeric(naga::Scalar::U32, width)));
        let result = Types::of(types, numeric(naga::Scalar::U32, numbers));
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
        let (stirred, ty) = if numbers == 1 { (vec![x, y, w], three) } else { (vec![x, y, z, w], four) };
        let width = stirred.len() as u8;
        let components = stirred.into_iter().map(|word| b.word(word)).collect();
        let first = b.add(Expression::Compose { ty, components });
        b.name(&mut self.names, first, "first");
        let shifted = b.with_word(BinaryOperator::ShiftRight, first, 16, width);
        let mixed = b.binary(BinaryOperator::ExclusiveOr, first, shifted);
        b.name(&mut self.names, mixed, "mixed");
        let mut mixed = b.parts(mixed, width);
        if numbers == 1 {
            mixed.swap(2, 3);
        }
        let second = b.round(&mut self.names, mixed, numbers);
        let components = second.into_iter().take(usize::from(numbers)).map(|word| b.word(word)).collect();
        let second = b.vector(result, components);
        if hash.numbers == 0 {
            b.finish(second);
            return function;
        }
        let upper = b.with_word(BinaryOperator::ShiftRight, second, 8, numbers);
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
