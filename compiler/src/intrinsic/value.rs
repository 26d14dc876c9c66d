//! The values of intrinsics: what defines them.
//!
//! Transcendental functions come from `libm`, so a constant folds to the same bits everywhere.

use super::Evaluate;
use crate::graph::{Constant, Scalar};

/// Applies a row's value, component by component unless it is `Whole`.
pub fn evaluate(value: &Evaluate, arguments: &[Constant]) -> Constant {
    let float = |k: usize, i: usize| arguments.get(k).map_or(0.0, |c| c.float(i));
    let int = |k: usize, i: usize| arguments.get(k).map_or(0, |c| c.int(i));
    let bool = |k: usize, i: usize| arguments.get(k).is_some_and(|c| c.bool(i));
    let width = arguments.first().map_or(1, |c| usize::from(c.width()));
    let floats =
        |f: &dyn Fn(usize) -> f32| Constant::new(Scalar::Float, (0..width).map(|i| finite(f(i)).to_bits()));
    let ints = |f: &dyn Fn(usize) -> i32| Constant::new(Scalar::Int, (0..width).map(|i| f(i) as u32));
    let bools = |f: &dyn Fn(usize) -> bool| Constant::new(Scalar::Bool, (0..width).map(|i| u32::from(f(i))));
    match *value {
        Evaluate::Float1(f) => floats(&|i| f(float(0, i))),
        Evaluate::Float2(f) => floats(&|i| f(float(0, i), float(1, i))),
        Evaluate::Float3(f) => floats(&|i| f(float(0, i), float(1, i), float(2, i))),
        Evaluate::IntToFloat(f) => floats(&|i| f(int(0, i))),
        Evaluate::Int1(f) => ints(&|i| f(int(0, i))),
        Evaluate::Int2(f) => ints(&|i| f(int(0, i), int(1, i))),
        Evaluate::Int3(f) => ints(&|i| f(int(0, i), int(1, i), int(2, i))),
        Evaluate::FloatToInt(f) => ints(&|i| f(float(0, i))),
        Evaluate::CompareFloat(f) => bools(&|i| f(float(0, i), float(1, i))),
        Evaluate::CompareInt(f) => bools(&|i| f(int(0, i), int(1, i))),
        Evaluate::Bool1(f) => bools(&|i| f(bool(0, i))),
        Evaluate::Bool2(f) => bools(&|i| f(bool(0, i), bool(1, i))),
        Evaluate::Whole(f) => f(arguments),
    }
}

/// What is worked out here is a number: NaN is 0, what overflows saturates.
pub fn finite(x: f32) -> f32 {
    if x.is_nan() { 0.0 } else { x.clamp(-f32::MAX, f32::MAX) }
}

/// Smaller divisors, bases and arguments of logarithms count as 0: graphics hardware may take what
/// is below 1.2e-38 for 0, and shader languages promise no more of a quotient by it.
pub const LEAST: f32 = 1e-37;
/// The greatest power.
pub const GREATEST: f32 = 1e38;
/// The greatest exponent of e, ...
pub const GREATEST_EXP: f32 = 87.0;
/// ... and of 2, with room to the greatest float for a shader's error.
pub const GREATEST_EXP2: f32 = 126.0;

/// `x / y`, 0 where `y` counts as 0.
pub fn divide(x: f32, y: f32) -> f32 {
    if y.abs() < LEAST { 0.0 } else { x / y }
}

/// `x − y·floor(x / y)`, 0 where `y` counts as 0.
pub fn remainder(x: f32, y: f32) -> f32 {
    if y.abs() < LEAST { 0.0 } else { x - finite(y * libm::floorf(finite(x / y))) }
}

/// The quotient rounded down; 0 for a divisor of 0, and `MIN / -1` is `MIN`.
pub fn divide_int(x: i32, y: i32) -> i32 {
    if y == 0 {
        return 0;
    }
    let quotient = x.wrapping_div(y);
    let rest = x.wrapping_rem(y);
    quotient - i32::from(rest != 0 && (rest < 0) != (y < 0))
}

/// What is left of [`divide_int`]: it has the divisor's sign.
pub fn remainder_int(x: i32, y: i32) -> i32 {
    if y == 0 {
        return 0;
    }
    let rest = x.wrapping_rem(y);
    if rest != 0 && (rest < 0) != (y < 0) { rest + y } else { rest }
}

/// Truncates and saturates; NaN is 0.
pub fn to_int(x: f32) -> i32 {
    x as i32
}

/// x to the power of y; 0 where that is not a real number.
pub fn power(x: f32, y: f32) -> f32 {
    if x >= LEAST {
        libm::powf(x, y).min(GREATEST)
    } else if y == 0.0 {
        1.0
    } else {
        0.0
    }
}

/// The angle of (x, y), 0 where both count as 0; a y that counts as 0 lies on the axis.
pub fn arc_tangent(y: f32, x: f32) -> f32 {
    match (y.abs() < LEAST, x.abs() < LEAST) {
        (true, true) => 0.0,
        (true, false) => libm::atan2f(0.0, x),
        (false, _) => libm::atan2f(y, x),
    }
}

/// The logarithm by `log`, 0 where there is none.
pub fn logarithm(log: fn(f32) -> f32, x: f32) -> f32 {
    if x < LEAST { 0.0 } else { log(x) }
}

/// a·(1 − t) + b·t
pub fn mix(a: f32, b: f32, t: f32) -> f32 {
    finite(a * (1.0 - t)) + finite(b * t)
}

/// 0 left of `low`, 1 right of `high`, smooth between; a step where their difference counts as 0.
pub fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    if (high - low).abs() < LEAST {
        return if x < low { 0.0 } else { 1.0 };
    }
    let t = finite(finite(x - low) / finite(high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The sum of the products of the components.
pub fn dot(arguments: &[Constant]) -> Constant {
    Constant::floats(&[finite(dot_of(arguments))])
}

fn dot_of(arguments: &[Constant]) -> f32 {
    match arguments {
        [a, b] => (0..usize::from(a.width())).map(|i| a.float(i) * b.float(i)).fold(0.0, |sum, x| sum + x),
        _ => 0.0,
    }
}

/// Euclidean length.
pub fn length(arguments: &[Constant]) -> Constant {
    let Some(v) = arguments.first() else { return Constant::floats(&[0.0]) };
    let length = if v.width() == 1 { v.float(0).abs() } else { libm::sqrtf(dot_of(&[*v, *v])) };
    Constant::floats(&[finite(length)])
}

/// The same direction with length 1; 0 for 0.
pub fn normalize(arguments: &[Constant]) -> Constant {
    let Some(v) = arguments.first() else { return Constant::floats(&[0.0]) };
    let length = length(arguments).float(0);
    Constant::new(
        Scalar::Float,
        (0..usize::from(v.width())).map(|i| finite(divide(v.float(i), length)).to_bits()),
    )
}

/// The vector at right angles to both.
pub fn cross(arguments: &[Constant]) -> Constant {
    let [a, b] = arguments else { return Constant::zero(Scalar::Float, 3) };
    let minor = |i: usize, j: usize| finite(a.float(i) * b.float(j) - a.float(j) * b.float(i));
    Constant::floats(&[minor(1, 2), minor(2, 0), minor(0, 1)])
}

/// Whether two vectors agree in every component.
pub fn equal(arguments: &[Constant]) -> Constant {
    let equal = match arguments {
        [a, b] => (0..usize::from(a.width())).all(|i| match a.scalar() {
            Scalar::Float => a.float(i) == b.float(i),
            Scalar::Int | Scalar::Bool => a.int(i) == b.int(i),
        }),
        _ => true,
    };
    Constant::bools(&[equal])
}

/// The negation of [`equal`].
pub fn not_equal(arguments: &[Constant]) -> Constant {
    Constant::bools(&[!equal(arguments).bool(0)])
}

/// Whether all components hold.
pub fn all(arguments: &[Constant]) -> Constant {
    Constant::bools(&[arguments.iter().all(|c| (0..usize::from(c.width())).all(|i| c.bool(i)))])
}

/// Component by component the second where the first holds, else the third.
pub fn choose(arguments: &[Constant]) -> Constant {
    let [condition, yes, no] = arguments else { return Constant::floats(&[0.0]) };
    let pick = |i: usize| if condition.bool(i) { yes.bits()[i] } else { no.bits()[i] };
    Constant::new(yes.scalar(), (0..usize::from(yes.width())).map(pick))
}

/// Component by component of one vector, the index clamped.
pub fn component(arguments: &[Constant]) -> Constant {
    let [v, index] = arguments else { return Constant::floats(&[0.0]) };
    let last = i32::from(v.width()) - 1;
    v.component(index.int(0).clamp(0, last) as usize)
}

/// `hash(i, seed)`: pcg4d of (i padded with 0, seed); for four components the seed is xored into
/// the last.
pub fn hash(arguments: &[Constant]) -> Constant {
    let [i, seed] = arguments else { return Constant::zero(Scalar::Float, 4) };
    let last = if i.width() == 4 { i.int(3) ^ seed.int(0) } else { seed.int(0) };
    unit(pcg4d([i.int(0) as u32, i.int(1) as u32, i.int(2) as u32, last as u32]))
}

/// The hash of four ints.
pub fn hash4(arguments: &[Constant]) -> Constant {
    let Some(v) = arguments.first() else { return Constant::zero(Scalar::Float, 4) };
    unit(pcg4d([0, 1, 2, 3].map(|i| v.int(i) as u32)))
}

/// The upper 24 bits of each as a float in [0, 1).
fn unit(words: [u32; 4]) -> Constant {
    Constant::floats(&words.map(|u| (u >> 8) as f32 * (1.0 / 16_777_216.0)))
}

/// Four words to four words, each depending on all (Jarzynski & Olano 2020).
pub fn pcg4d(words: [u32; 4]) -> [u32; 4] {
    let stir = |[x, y, z, w]: [u32; 4]| {
        let x = x.wrapping_add(y.wrapping_mul(w));
        let y = y.wrapping_add(z.wrapping_mul(x));
        let z = z.wrapping_add(x.wrapping_mul(y));
        let w = w.wrapping_add(y.wrapping_mul(z));
        [x, y, z, w]
    };
    let seeded = words.map(|u| u.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    stir(stir(seeded).map(|u| u ^ (u >> 16)))
}

/// `count` bits of `x` from bit `first` on, as a number from 0 up.
pub fn bits(x: i32, first: i32, count: i32) -> i32 {
    let first = first.clamp(0, 31) as u32;
    let count = count.clamp(0, 32 - first as i32) as u32;
    let mask = if count == 32 { u32::MAX } else { (1 << count) - 1 };
    ((x as u32 >> first) & mask) as i32
}

/// Euclidean distance.
pub fn distance(arguments: &[Constant]) -> Constant {
    let [a, b] = arguments else { return Constant::floats(&[0.0]) };
    let offset = (0..usize::from(a.width())).map(|i| (a.float(i) - b.float(i)).to_bits());
    length(&[Constant::new(Scalar::Float, offset)])
}
