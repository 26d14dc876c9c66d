//! Total operations in terms of what a shader has, with their guards.
//!
//! A guard is made of ordinary values, so it folds away where an operand is constant, and no
//! operation with constant operands that the shader language forbids is ever emitted.

use super::*;
use crate::graph::{Builder, Constant, Operation, Scalar, Type, Value};

/// Values of one shape, made tersely.
struct Shape<'a> {
    b: &'a mut Builder,
    width: u8,
}

impl<'a> Shape<'a> {
    fn of(b: &'a mut Builder, like: Value) -> Shape<'a> {
        let width = b.ty(like).width();
        Shape { b, width }
    }

    fn float(&mut self, x: f32) -> Value {
        self.b.constant(Constant::floats(&[x]).splat(self.width))
    }

    fn int(&mut self, x: i32) -> Value {
        self.b.constant(Constant::ints(&[x]).splat(self.width))
    }

    fn call(&mut self, intrinsic: Intrinsic, arguments: &[Value]) -> Value {
        self.b.builtin(intrinsic, arguments)
    }

    /// What is left to 1; of equal components it is worked out once.
    fn rest(&mut self, t: Value) -> Value {
        let scalar = match self.b.operation(t) {
            Operation::Compose(parts) if parts.iter().all(|part| *part == parts[0]) => parts[0],
            _ => {
                let one = self.float(1.0);
                return self.call(SUBTRACT, &[one, t]);
            }
        };
        let one = self.b.constant(Constant::floats(&[1.0]));
        let rest = self.call(SUBTRACT, &[one, scalar]);
        self.b.splat(rest, self.width)
    }
}

/// Where a number counts as 0; nowhere if it is the greater of something and a number that does not.
fn is_empty(s: &mut Shape, v: Value) -> Value {
    let least = s.float(value::LEAST);
    if let Operation::Builtin(MAXIMUM, of) = s.b.operation(v)
        && let Some(c) = s.b.as_constant(of[1])
        && (0..usize::from(c.width())).all(|i| c.float(i) >= value::LEAST)
    {
        return s.b.constant(Constant::bools(&[false]).splat(s.width));
    }
    let size = s.call(ABSOLUTE, &[v]);
    s.call(COMPONENT_LESS, &[size, least])
}

/// Quotient, 0 for a divisor that counts as 0.
pub fn divide(b: &mut Builder, v: &[Value]) -> Value {
    let mut s = Shape::of(b, v[0]);
    let zero = s.float(0.0);
    let empty = is_empty(&mut s, v[1]);
    // A constant divisor of 0 must not reach the shader.
    if s.b.as_constant(empty).is_some_and(|c| (0..usize::from(c.width())).any(|i| c.bool(i))) {
        let one = s.float(1.0);
        let safe = s.call(CHOOSE, &[empty, one, v[1]]);
        let quotient = s.call(RAW_DIVIDE, &[v[0], safe]);
        return s.call(CHOOSE, &[empty, zero, quotient]);
    }
    let quotient = s.call(RAW_DIVIDE, &v[..2]);
    s.call(CHOOSE, &[empty, zero, quotient])
}

/// x − y·floor(x / y).
pub fn remainder(b: &mut Builder, v: &[Value]) -> Value {
    let quotient = divide(b, v);
    let mut s = Shape::of(b, v[0]);
    let whole = s.call(FLOOR, &[quotient]);
    let part = s.call(MULTIPLY, &[v[1], whole]);
    let rest = s.call(SUBTRACT, &[v[0], part]);
    let zero = s.float(0.0);
    let empty = is_empty(&mut s, v[1]);
    s.call(CHOOSE, &[empty, zero, rest])
}

/// If `v` is a constant power of two in every component: its exponents.
fn exponents(b: &Builder, v: Value) -> Option<Constant> {
    let c = b.as_constant(v)?;
    let mut bits = Vec::new();
    for i in 0..usize::from(c.width()) {
        let x = c.int(i);
        if x <= 0 || !(x as u32).is_power_of_two() {
            return None;
        }
        bits.push(x.trailing_zeros());
    }
    Some(Constant::new(Scalar::Int, bits))
}

/// The divisor with 0 replaced by 1, and where it was 0; and rounding towards −∞ of what the
/// shader truncates.
struct Floored {
    empty: Value,
    quotient: Value,
    rest: Value,
    /// The rest is not 0 and its sign differs from the divisor's.
    low: Value,
}

fn floored(s: &mut Shape, v: &[Value]) -> Floored {
    let zero = s.int(0);
    let one = s.int(1);
    let empty = s.call(COMPONENT_EQUAL_INT, &[v[1], zero]);
    let divisor = s.call(CHOOSE_INT, &[empty, one, v[1]]);
    let quotient = s.call(RAW_DIVIDE_INT, &[v[0], divisor]);
    // `x − q·y` wraps rightly even for MIN / −1, and shares the division.
    let product = s.call(MULTIPLY_INT, &[quotient, divisor]);
    let rest = s.call(SUBTRACT_INT, &[v[0], product]);
    // With a divisor known to be positive, a low rest is simply a negative one.
    let positive =
        s.b.as_constant(divisor).is_some_and(|c| (0..usize::from(c.width())).all(|i| c.int(i) > 0));
    let mixed = if positive { rest } else { s.call(EXCLUSIVE_OR, &[rest, divisor]) };
    let negative = s.call(COMPONENT_LESS_INT, &[mixed, zero]);
    let low = if positive {
        negative
    } else {
        let some = s.call(COMPONENT_UNEQUAL_INT, &[rest, zero]);
        s.call(COMPONENT_AND, &[some, negative])
    };
    Floored { empty, quotient, rest, low }
}

/// The quotient rounded down.
pub fn divide_int(b: &mut Builder, v: &[Value]) -> Value {
    if let Some(shift) = exponents(b, v[1]) {
        let shift = b.constant(shift);
        return b.builtin(SHIFT_RIGHT, &[v[0], shift]);
    }
    let mut s = Shape::of(b, v[0]);
    let f = floored(&mut s, v);
    let (zero, one) = (s.int(0), s.int(1));
    let down = s.call(CHOOSE_INT, &[f.low, one, zero]);
    let quotient = s.call(SUBTRACT_INT, &[f.quotient, down]);
    s.call(CHOOSE_INT, &[f.empty, zero, quotient])
}

/// The rest with the divisor's sign.
pub fn remainder_int(b: &mut Builder, v: &[Value]) -> Value {
    if exponents(b, v[1]).is_some() {
        let mut s = Shape::of(b, v[0]);
        let one = s.int(1);
        let mask = s.call(SUBTRACT_INT, &[v[1], one]);
        return s.call(BITWISE_AND, &[v[0], mask]);
    }
    let mut s = Shape::of(b, v[0]);
    let f = floored(&mut s, v);
    let zero = s.int(0);
    let up = s.call(CHOOSE_INT, &[f.low, v[1], zero]);
    let rest = s.call(ADD_INT, &[f.rest, up]);
    s.call(CHOOSE_INT, &[f.empty, zero, rest])
}

/// Rounds down, then converts; the shader's conversion saturates.
pub fn floor_int(b: &mut Builder, v: &[Value]) -> Value {
    let whole = b.builtin(FLOOR, v);
    b.builtin(TO_INT, &[whole])
}

/// a·(1 − t) + b·t to the letter: a shader may work its own `mix` out in another way.
pub fn mix(b: &mut Builder, v: &[Value]) -> Value {
    let mut s = Shape::of(b, v[0]);
    let rest = s.rest(v[2]);
    let first = s.call(MULTIPLY, &[v[0], rest]);
    let second = s.call(MULTIPLY, &[v[1], v[2]]);
    s.call(ADD, &[first, second])
}

/// Whether each component of `low` is less than that of `high` by `gap` or more, and by a number: all
/// of it is known, and compilers work the difference out.
fn in_order(b: &Builder, low: Value, high: Value, gap: f32) -> bool {
    let (Some(low), Some(high)) = (b.as_constant(low), b.as_constant(high)) else { return false };
    (0..usize::from(low.width())).all(|i| (gap..=f32::MAX).contains(&(high.float(i) - low.float(i))))
}

/// min(max(x, low), high), which has a value for reversed bounds too.
pub fn clamp(b: &mut Builder, v: &[Value]) -> Value {
    if in_order(b, v[1], v[2], 0.0) {
        return b.builtin(RAW_CLAMP, v);
    }
    let raised = b.builtin(MAXIMUM, &[v[0], v[1]]);
    b.builtin(MINIMUM, &[raised, v[2]])
}

/// The same for ints.
pub fn clamp_int(b: &mut Builder, v: &[Value]) -> Value {
    let raised = b.builtin(MAXIMUM_INT, &[v[0], v[1]]);
    b.builtin(MINIMUM_INT, &[raised, v[2]])
}

/// Nothing is left of it but its first argument.
pub fn narrow(_: &mut Builder, v: &[Value]) -> Value {
    v[0]
}

/// The cubic between the bounds, a step where there is nothing between them.
pub fn smoothstep(b: &mut Builder, v: &[Value]) -> Value {
    if in_order(b, v[0], v[1], value::LEAST) {
        return b.builtin(RAW_SMOOTHSTEP, v);
    }
    let mut s = Shape::of(b, v[2]);
    let (zero, one) = (s.float(0.0), s.float(1.0));
    let span = s.call(SUBTRACT, &[v[1], v[0]]);
    let offset = s.call(SUBTRACT, &[v[2], v[0]]);
    let ratio = divide(s.b, &[offset, span]);
    let t = clamp(s.b, &[ratio, zero, one]);
    let (two, three) = (s.float(2.0), s.float(3.0));
    let twice = s.call(MULTIPLY, &[two, t]);
    let rest = s.call(SUBTRACT, &[three, twice]);
    let square = s.call(MULTIPLY, &[t, t]);
    let smooth = s.call(MULTIPLY, &[square, rest]);
    let left = s.call(COMPONENT_LESS, &[v[2], v[0]]);
    let step = s.call(CHOOSE, &[left, zero, one]);
    let flat = is_empty(&mut s, span);
    s.call(CHOOSE, &[flat, step, smooth])
}

/// 0 below, else 1.
pub fn step(b: &mut Builder, v: &[Value]) -> Value {
    let mut s = Shape::of(b, v[0]);
    let (zero, one) = (s.float(0.0), s.float(1.0));
    let below = s.call(COMPONENT_LESS, &[v[1], v[0]]);
    s.call(CHOOSE, &[below, zero, one])
}

/// Of a negative: 0.
pub fn root(b: &mut Builder, v: &[Value]) -> Value {
    let mut s = Shape::of(b, v[0]);
    let zero = s.float(0.0);
    let inside = s.call(MAXIMUM, &[v[0], zero]);
    s.call(RAW_SQRT, &[inside])
}

/// 0 where the argument is not positive, or counts as 0.
fn of_positive(b: &mut Builder, raw: Intrinsic, v: &[Value]) -> Value {
    let mut s = Shape::of(b, v[0]);
    let (zero, one, least) = (s.float(0.0), s.float(1.0), s.float(value::LEAST));
    let none = s.call(COMPONENT_LESS, &[v[0], least]);
    let safe = s.call(CHOOSE, &[none, one, v[0]]);
    let value = s.call(raw, &[safe]);
    s.call(CHOOSE, &[none, zero, value])
}

/// Natural logarithm, 0 where there is none.
pub fn logarithm(b: &mut Builder, v: &[Value]) -> Value {
    of_positive(b, RAW_LOG, v)
}

/// Logarithm of base 2, 0 where there is none.
pub fn logarithm2(b: &mut Builder, v: &[Value]) -> Value {
    of_positive(b, RAW_LOG2, v)
}

/// 0 where the base is not positive or counts as 0, but 1 for an exponent of 0.
pub fn power(b: &mut Builder, v: &[Value]) -> Value {
    let mut s = Shape::of(b, v[0]);
    let (zero, one, least) = (s.float(0.0), s.float(1.0), s.float(value::LEAST));
    let none = s.call(COMPONENT_LESS, &[v[0], least]);
    let safe = s.call(CHOOSE, &[none, one, v[0]]);
    let value = s.call(RAW_POW, &[safe, v[1]]);
    let greatest = s.float(value::GREATEST);
    let value = s.call(MINIMUM, &[value, greatest]);
    let flat = s.call(COMPONENT_EQUAL, &[v[1], zero]);
    let otherwise = s.call(CHOOSE, &[flat, one, zero]);
    s.call(CHOOSE, &[none, otherwise, value])
}

/// e to a power that is not too great.
pub fn exponential(b: &mut Builder, v: &[Value]) -> Value {
    let mut s = Shape::of(b, v[0]);
    let greatest = s.float(value::GREATEST_EXP);
    let exponent = s.call(MINIMUM, &[v[0], greatest]);
    s.call(RAW_EXP, &[exponent])
}

/// 2 to a power that is not too great.
pub fn exponential2(b: &mut Builder, v: &[Value]) -> Value {
    let mut s = Shape::of(b, v[0]);
    let greatest = s.float(value::GREATEST_EXP2);
    let exponent = s.call(MINIMUM, &[v[0], greatest]);
    s.call(RAW_EXP2, &[exponent])
}

/// Sine by cosine: 0 where the cosine counts as 0.
pub fn tangent(b: &mut Builder, v: &[Value]) -> Value {
    let sine = b.builtin(SIN, v);
    let cosine = b.builtin(COS, v);
    divide(b, &[sine, cosine])
}

/// Clamped to −1..1 first.
fn of_cosine(b: &mut Builder, raw: Intrinsic, v: &[Value]) -> Value {
    let mut s = Shape::of(b, v[0]);
    let (low, high) = (s.float(-1.0), s.float(1.0));
    let inside = clamp(s.b, &[v[0], low, high]);
    b.builtin(raw, &[inside])
}

/// Arc sine of the clamped argument.
pub fn arc_sine(b: &mut Builder, v: &[Value]) -> Value {
    of_cosine(b, RAW_ASIN, v)
}

/// Arc cosine of the clamped argument.
pub fn arc_cosine(b: &mut Builder, v: &[Value]) -> Value {
    of_cosine(b, RAW_ACOS, v)
}

/// The angle of (x, y), 0 where both count as 0.
pub fn arc_tangent(b: &mut Builder, v: &[Value]) -> Value {
    let mut s = Shape::of(b, v[0]);
    let (zero, one) = (s.float(0.0), s.float(1.0));
    let flat = is_empty(&mut s, v[0]);
    let empty = is_empty(&mut s, v[1]);
    let origin = s.call(COMPONENT_AND, &[flat, empty]);
    // The angle of (1, 0) is 0. Of a -0 some drivers make NaN.
    let x = s.call(CHOOSE, &[origin, one, v[1]]);
    let y = s.call(CHOOSE, &[flat, zero, v[0]]);
    s.call(RAW_ATAN2, &[y, x])
}

/// The dot product of a scalar with another is their product; the shader has none.
pub fn dot(b: &mut Builder, v: &[Value]) -> Value {
    if b.ty(v[0]).width() == 1 { b.builtin(MULTIPLY, v) } else { b.builtin(RAW_DOT, v) }
}

/// The length of a scalar is its size.
pub fn length(b: &mut Builder, v: &[Value]) -> Value {
    if b.ty(v[0]).width() == 1 { b.builtin(ABSOLUTE, v) } else { b.builtin(RAW_LENGTH, v) }
}

/// The distance of two points.
pub fn distance(b: &mut Builder, v: &[Value]) -> Value {
    let offset = b.builtin(SUBTRACT, v);
    length(b, &[offset])
}

/// v / |v|, 0 for 0.
pub fn normalize(b: &mut Builder, v: &[Value]) -> Value {
    let length = length(b, v);
    let length = b.splat(length, b.ty(v[0]).width());
    divide(b, &[v[0], length])
}

/// Component by component, then all of them.
pub fn equal(b: &mut Builder, v: &[Value]) -> Value {
    let intrinsic = match b.ty(v[0]).scalar() {
        Some(Scalar::Int) => COMPONENT_EQUAL_INT,
        Some(Scalar::Bool) => COMPONENT_EQUAL_BOOL,
        _ => COMPONENT_EQUAL,
    };
    let v = in_place(b, v);
    let each = b.builtin(intrinsic, &v);
    if b.ty(each).width() == 1 { each } else { b.builtin(ALL, &[each]) }
}

/// The negation of [`equal`].
pub fn not_equal(b: &mut Builder, v: &[Value]) -> Value {
    if b.ty(v[0]) == Type::Vector(Scalar::Int, 1) {
        let v = in_place(b, v);
        return b.builtin(COMPONENT_UNEQUAL_INT, &v);
    }
    let same = equal(b, v);
    b.builtin(NOT, &[same])
}

/// What is compared; of bits with 0 those bits where they stand, which need not be shifted down.
fn in_place(b: &mut Builder, v: &[Value]) -> [Value; 2] {
    let whole = [v[0], v[1]];
    let number = |value: Value| b.as_constant(value).filter(|c| c.width() == 1).map(|c| c.int(0));
    let Operation::Builtin(BITWISE_AND, masked) = b.operation(v[0]) else { return whole };
    let Operation::Builtin(SHIFT_RIGHT, shifted) = b.operation(masked[0]) else { return whole };
    let (from, &[of, first]) = (number(v[1]), &shifted[..]) else { return whole };
    let (Some(0), Some(first), Some(mask)) = (from, number(first), number(masked[1])) else { return whole };
    // The sign, which the shift drags along, is no bit of the mask's.
    let there = (0..31).contains(&first).then(|| i64::from(mask) << first);
    let Some(there) = there.filter(|there| (1..=i64::from(i32::MAX)).contains(there)) else { return whole };
    let mask = b.constant(Constant::ints(&[there as i32]));
    [b.builtin(BITWISE_AND, &[of, mask]), v[1]]
}

/// A component by a computed index, clamped: a chain of choices, the shader's own is a trap.
pub fn component(b: &mut Builder, v: &[Value]) -> Value {
    let width = b.ty(v[0]).width();
    let mut chosen = b.extract(v[0], width - 1);
    for i in (0..width - 1).rev() {
        let next = b.constant(Constant::ints(&[i32::from(i) + 1]));
        let here = b.builtin(LESS_INT, &[v[1], next]);
        let component = b.extract(v[0], i);
        chosen = b.select(here, component, chosen);
    }
    chosen
}

/// The padded index and the seed go to the hash of four.
pub fn hash(b: &mut Builder, v: &[Value]) -> Value {
    let width = b.ty(v[0]).width();
    let mut words: Vec<Value> = (0..width).map(|i| b.extract(v[0], i)).collect();
    if let Some(last) = words.get_mut(3) {
        *last = b.builtin(EXCLUSIVE_OR, &[*last, v[1]]);
    } else {
        let zero = b.constant(Constant::ints(&[0]));
        words.resize(3, zero);
        words.push(v[1]);
    }
    let words = b.compose(&words);
    b.builtin(HASH4, &[words])
}

/// Shift and mask; the range clamped to the 32 bits there are.
pub fn bits(b: &mut Builder, v: &[Value]) -> Value {
    let mut s = Shape::of(b, v[0]);
    let (zero, one, top, all) = (s.int(0), s.int(1), s.int(31), s.int(32));
    let first = clamp_int(s.b, &[v[1], zero, top]);
    let room = s.call(SUBTRACT_INT, &[all, first]);
    let count = clamp_int(s.b, &[v[2], zero, room]);
    // The arithmetic shift drags the sign along; the mask takes it off, except for all 32 bits,
    // where `first` is 0 and there is nothing to take off.
    let shifted = s.call(SHIFT_RIGHT, &[v[0], first]);
    let short = s.call(MINIMUM_INT, &[count, top]);
    let power = s.call(SHIFT_LEFT, &[one, short]);
    let mask = s.call(SUBTRACT_INT, &[power, one]);
    let masked = s.call(BITWISE_AND, &[shifted, mask]);
    let whole = s.call(COMPONENT_EQUAL_INT, &[count, all]);
    s.call(CHOOSE_INT, &[whole, v[0], masked])
}
