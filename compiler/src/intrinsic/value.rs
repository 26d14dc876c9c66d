//! The values of intrinsics: what defines them.
//!
//! Transcendental functions come from `libm`, so a constant folds to the same bits everywhere.

use super::Evaluate;
use crate::graph::{Constant, Scalar};

/// Applies a row's value, component by component unless it is `Whole`.
pub fn evaluate(value: &Evaluate, arguments: &[Constant]) -> Constant {
    let width = arguments.first().map_or(1, |first| usize::from(first.width()));
    let argument = |k: usize| arguments.get(k).copied().unwrap_or(Constant::zero(Scalar::Float, 1));
    match *value {
        Evaluate::Each { scalar, one, .. } => {
            let arguments = [0, 1, 2].map(argument);
            let words = |i: usize| arguments.map(|argument| argument.int(i) as u32);
            let scalar = scalar.unwrap_or(arguments[0].scalar());
            Constant::new(scalar, (0..width).map(|i| one(words(i))))
        }
        Evaluate::Whole { one, .. } => one(width, [0, 1].map(argument)),
    }
}

/// What is worked out here is a number: NaN is 0, what overflows saturates.
#[inline]
pub fn finite(x: f32) -> f32 {
    if x.is_nan() { 0.0 } else { x.clamp(-f32::MAX, f32::MAX) }
}

/// The nearest integer, halves to the even one.
#[inline]
pub fn round(x: f32) -> f32 {
    x.round_ties_even()
}

/// The greatest integer that is not greater.
#[inline]
pub fn floor(x: f32) -> f32 {
    x.floor()
}

/// The least integer that is not less.
#[inline]
pub fn ceil(x: f32) -> f32 {
    x.ceil()
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
#[inline]
pub fn divide(x: f32, y: f32) -> f32 {
    if y.abs() < LEAST { 0.0 } else { x / y }
}

/// `x − y·floor(x / y)`, 0 where `y` counts as 0.
#[inline]
pub fn remainder(x: f32, y: f32) -> f32 {
    if y.abs() < LEAST { 0.0 } else { x - finite(y * floor(finite(x / y))) }
}

/// The quotient rounded down; 0 for a divisor of 0, and `MIN / -1` is `MIN`.
#[inline]
pub fn divide_int(x: i32, y: i32) -> i32 {
    if y == 0 {
        return 0;
    }
    let quotient = x.wrapping_div(y);
    let rest = x.wrapping_rem(y);
    quotient - i32::from(rest != 0 && (rest < 0) != (y < 0))
}

/// What is left of [`divide_int`]: it has the divisor's sign.
#[inline]
pub fn remainder_int(x: i32, y: i32) -> i32 {
    if y == 0 {
        return 0;
    }
    let rest = x.wrapping_rem(y);
    if rest != 0 && (rest < 0) != (y < 0) { rest + y } else { rest }
}

/// Truncates and saturates; NaN is 0.
#[inline]
pub fn to_int(x: f32) -> i32 {
    whole_to_int(if x.is_nan() { 0.0 } else { x.trunc() })
}

/// Rounds down to an int and saturates; NaN is 0.
#[inline]
pub fn floor_int(x: f32) -> i32 {
    whole_to_int(if x.is_nan() { 0.0 } else { floor(x) })
}

/// As `x as i32` for a whole number, NaN aside, without branches: the sum's last 32 bits are the int.
#[inline]
pub fn whole_to_int(x: f32) -> i32 {
    let [least, most] = [i32::MIN, i32::MAX].map(f64::from);
    let wide = f64::from(x);
    // Not `clamp`, which looks for NaN.
    let held = if wide > least { wide } else { least };
    let held = if held < most { held } else { most };
    (held + 6_755_399_441_055_744.0).to_bits() as i32
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
#[inline]
pub fn mix(a: f32, b: f32, t: f32) -> f32 {
    finite(a * (1.0 - t)) + finite(b * t)
}

/// 0 left of `low`, 1 right of `high`, smooth between; a step where their difference counts as 0.
#[inline]
pub fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    if (high - low).abs() < LEAST {
        return if x < low { 0.0 } else { 1.0 };
    }
    let t = finite(finite(x - low) / finite(high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A function of each component. As `array::map`, which is not always taken over by loops over lanes.
#[inline(always)]
pub fn map<A: Copy, B: Copy + Default, const N: usize>(v: [A; N], f: impl Fn(A) -> B) -> [B; N] {
    let mut mapped = [B::default(); N];
    for c in 0..N {
        mapped[c] = f(v[c]);
    }
    mapped
}

/// The sum of the products of the components.
#[inline]
pub fn dot<const N: usize>(a: [f32; N], b: [f32; N]) -> f32 {
    let mut sum = a[0] * b[0];
    for c in 1..N {
        sum += a[c] * b[c];
    }
    sum
}

/// Euclidean length.
#[inline]
pub fn length<const N: usize>(v: [f32; N]) -> f32 {
    finite(if N == 1 { v[0].abs() } else { dot(v, v).sqrt() })
}

/// The same direction with length 1; 0 for 0.
#[inline]
pub fn normalize<const N: usize>(v: [f32; N]) -> [f32; N] {
    let length = length(v);
    map(v, |x| divide(x, length))
}

/// Euclidean distance.
#[inline]
pub fn distance<const N: usize>(a: [f32; N], b: [f32; N]) -> f32 {
    let mut way = a;
    for c in 0..N {
        way[c] -= b[c];
    }
    length(way)
}

/// The vector at right angles to both.
#[inline]
pub fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    let minor = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// Whether two vectors agree in every component.
#[inline]
pub fn equal<T: Copy + PartialEq, const N: usize>(a: [T; N], b: [T; N]) -> bool {
    let mut equal = true;
    for c in 0..N {
        equal &= a[c] == b[c];
    }
    equal
}

/// The negation of [`equal`].
#[inline]
pub fn not_equal<T: Copy + PartialEq, const N: usize>(a: [T; N], b: [T; N]) -> bool {
    !equal(a, b)
}

/// Whether all components hold.
#[inline]
pub fn all<const N: usize>(components: [bool; N]) -> bool {
    let mut all = true;
    for holds in components {
        all &= holds;
    }
    all
}

/// The first where the condition holds, else the second.
#[inline]
pub fn choose<T>(condition: bool, yes: T, no: T) -> T {
    if condition { yes } else { no }
}

/// One component of a vector of any type, the index clamped.
pub fn component<T: Copy, const N: usize>(v: [T; N], index: i32) -> T {
    v[(index.max(0) as usize).min(N - 1)]
}

/// `hash(i, seed)`: pcg4d of (i padded with 0, seed); for four components the seed is xored into
/// the last.
#[inline]
pub fn hash<const N: usize>(i: [i32; N], seed: i32) -> [f32; 4] {
    let word = |c: usize| i.get(c).map_or(0, |word| *word as u32);
    unit(pcg4d([word(0), word(1), word(2), word(3) ^ seed as u32]))
}

/// The hash of four ints.
#[inline]
pub fn hash4(words: [i32; 4]) -> [f32; 4] {
    unit(pcg4d(map(words, |word| word as u32)))
}

/// The upper 24 bits of each as a float in [0, 1). They fit an int, whose conversion is cheaper.
#[inline]
fn unit(words: [u32; 4]) -> [f32; 4] {
    map(words, |u| (u >> 8) as i32 as f32 * (1.0 / 16_777_216.0))
}

/// Four random words of four words, each depending on all (Jarzynski & Olano, *Hash functions for GPU
/// rendering*, JCGT 2020).
#[inline]
pub fn pcg4d(words: [u32; 4]) -> [u32; 4] {
    let stir = |[x, y, z, w]: [u32; 4]| {
        let x = x.wrapping_add(y.wrapping_mul(w));
        let y = y.wrapping_add(z.wrapping_mul(x));
        let z = z.wrapping_add(x.wrapping_mul(y));
        let w = w.wrapping_add(y.wrapping_mul(z));
        [x, y, z, w]
    };
    let seeded = map(words, |u: u32| u.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    stir(map(stir(seeded), |u| u ^ (u >> 16)))
}

/// `count` bits of `x` from bit `first` on, as a number from 0 up.
#[inline]
pub fn bits(x: i32, first: i32, count: i32) -> i32 {
    let first = first.clamp(0, 31) as u32;
    let count = count.clamp(0, 32 - first as i32) as u32;
    let mask = if count == 32 { u32::MAX } else { (1 << count) - 1 };
    ((x as u32 >> first) & mask) as i32
}

#[cfg(test)]
mod tests {
    use super::{ceil, floor, floor_int, round, to_int};

    #[test]
    fn rounding_is_that_of_libm() {
        let edges = [
            0.0,
            0.5,
            1.0,
            1.5,
            2.5,
            4_194_303.5,
            4_194_304.5,
            8_388_607.5,
            8_388_608.0,
            2_147_483_648.0,
            1e30,
        ];
        let near = edges.into_iter().flat_map(|x: f32| {
            (-2..=2).flat_map(move |step| {
                let x = f32::from_bits(x.to_bits().wrapping_add_signed(step));
                [x, -x]
            })
        });
        let spread = (0..1 << 22).map(|i: u32| f32::from_bits(i.wrapping_mul(1021)));
        for x in near.chain(spread) {
            assert_eq!([to_int(x), floor_int(x)], [x as i32, libm::floorf(x) as i32], "{x:?}");
            if x.is_nan() {
                continue;
            }
            let wanted = [libm::floorf(x), libm::ceilf(x), libm::rintf(x)].map(f32::to_bits);
            assert_eq!([floor(x), ceil(x), round(x)].map(f32::to_bits), wanted, "{x:?}");
        }
    }
}
