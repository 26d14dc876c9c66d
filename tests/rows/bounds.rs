//! How far a shader may be from a row's value: what WGSL's table of accuracies allows (WebGPU
//! Shading Language, §15.7.4), no more.
//!
//! One ULP is 2⁻²³ of the value; WGSL lets any result below 2⁻¹²⁶ be 0, and rounds either way, so
//! "correctly rounded" is one ULP here. Where the specification says nothing (a divisor above
//! 2¹²⁶) the same bound is held to.

use texgraph_compiler::graph::{Constant, Scalar};

/// One unit in the last place, relative to a value.
const ULP: f64 = 1.0 / 8_388_608.0;
/// Smaller results may be 0.
const LEAST: f64 = f32::MIN_POSITIVE as f64;
/// 2¹²⁶: quotients by greater divisors have no accuracy.
const DIVISOR: f64 = 8.507_059_173_023_462e37;
/// Of `sin` and `cos` within −π..π.
const TURN: f64 = 1.0 / 2_048.0;

/// How far component `i` of a row's result may be off, for arguments and the right value.
/// Ints and bools may not, but for where a float passes the greatest int.
pub fn bound(name: &str, arguments: &[Constant], value: &Constant, i: usize) -> f64 {
    if value.scalar() != Scalar::Float {
        return if value.int(i) == i32::MAX && matches!(name, "(int)" | "ifloor") { 127.0 } else { 0.0 };
    }
    let x = |k: usize| arguments.get(k).map_or(0.0, |c| component(c, i));
    let right = f64::from(value.float(i));
    let ulps = |n: f64| n * ULP * right.abs() + LEAST;
    match name {
        // Choices and steps among their arguments.
        "-x" | "abs" | "sign" | "min" | "max" | "clamp" | "step" | "floor" | "ceil" | "round" | "([i])"
        | "(choose)" | "narrow" => LEAST,
        // 24 bits of an int, times a power of two.
        "hash" | "(hash4)" => 0.0,
        // Correctly rounded.
        "+" | "-" | "*" | "fract" | "(float)" => ulps(1.0),
        // 2.5 ULP.
        "/" | "(/)" => ulps(2.5),
        "%" => remainder(x(0), x(1)),
        // x·(1 − t) + y·t: four roundings, each of a term.
        "mix" => 4.0 * (ULP * ((x(0) * (1.0 - x(2))).abs() + (x(1) * x(2)).abs()) + LEAST),
        // t is a quotient of differences (2.5 + 2 ULP), its polynomial at most doubles that, and
        // has five roundings below 3.
        "smoothstep" => 24.0 * ULP,
        "sin" | "cos" => angle(x(0)).min(2.0),
        "tan" => tangent(angle(x(0)), right),
        // The worse of 6.77e-5 and what atan2 of a root gives.
        "asin" | "acos" | "(asin)" | "(acos)" => 6.77e-5 + 4_096.0 * ULP * right.abs(),
        // A quotient's: nothing is promised where an argument is greater than a divisor may be.
        "atan2" | "(atan2)" if x(0).abs().max(x(1).abs()) > DIVISOR => f64::INFINITY,
        "atan2" | "(atan2)" => ulps(4_096.0),
        "exp" | "exp2" => ulps(3.0 + 2.0 * x(0).abs()),
        "log" | "log2" | "(log)" | "(log2)" => logarithm(x(0), right),
        "pow" | "(pow)" => power(x(0), x(1), right),
        // 1 / inverseSqrt: 2 and 2.5 ULP.
        "sqrt" | "(sqrt)" => ulps(4.5),
        "dot" | "(dot)" => 4.0 * ULP * products(arguments, &[[0, 0], [1, 1], [2, 2], [3, 3]]) + LEAST,
        // The root of a dot product.
        "length" | "distance" => ulps(4.5 + 4.0),
        "cross" => 3.0 * ULP * products(arguments, &cross_terms(i)) + LEAST,
        // By the length, 2.5 ULP more.
        "normalize" => ulps(4.5 + 4.0 + 2.5),
        other => panic!("state how far `{other}` may be off, and why"),
    }
}

fn component(c: &Constant, i: usize) -> f64 {
    let i = if c.width() == 1 { 0 } else { i };
    if c.scalar() == Scalar::Float { f64::from(c.float(i)) } else { f64::from(c.int(i)) }
}

/// x − y·floor(x / y). The quotient is 2.5 ULP off, so its floor may be off by that many, and the
/// product and the difference are rounded.
fn remainder(x: f64, y: f64) -> f64 {
    let quotient = if y == 0.0 { 0.0 } else { x / y };
    let floors = match quotient.abs() {
        // It may be 0, and of a negative one the floor is -1.
        q if q < LEAST => 1.0,
        q if q < 1.0 / (3.0 * ULP) => 0.0,
        q => 3.0 * ULP * q,
    };
    y.abs() * floors + 3.0 * ULP * x.abs().max(y.abs()) + LEAST
}

/// Beyond −π..π WGSL promises nothing. Whole turns are taken off as floats: that costs what an
/// angle has of bits below its last one, twice.
fn angle(x: f64) -> f64 {
    TURN + 2.0 * ULP * x.abs()
}

/// sin / cos, each off by so much: nothing is known of it where the cosine may be 0.
fn tangent(off: f64, right: f64) -> f64 {
    let cosine = 1.0 / (1.0 + right * right).sqrt();
    if cosine <= off { f64::INFINITY } else { off * (1.0 + right.abs()) / (cosine - off) }
}

/// 2⁻²¹ absolute within 0.5..2, else 3 ULP.
fn logarithm(x: f64, right: f64) -> f64 {
    if (0.5..=2.0).contains(&x) { 4.0 * ULP } else { 3.0 * ULP * right.abs() + LEAST }
}

/// exp2(y·log2(x)), each with its own bound.
fn power(x: f64, y: f64, right: f64) -> f64 {
    if x <= 0.0 || y == 0.0 {
        return LEAST;
    }
    let log = x.log2();
    let exponent = y.abs() * logarithm(x, log) + ULP * (y * log).abs();
    let growth = exponent.exp2() - 1.0 + (3.0 + 2.0 * (y * log).abs()) * ULP;
    growth * right.abs() + LEAST
}

/// The sum of the absolute products of these components of the two arguments.
fn products(arguments: &[Constant], pairs: &[[usize; 2]]) -> f64 {
    let [a, b] = arguments else { return 0.0 };
    pairs.iter().map(|[i, j]| (f64::from(a.float(*i)) * f64::from(b.float(*j))).abs()).sum()
}

fn cross_terms(i: usize) -> [[usize; 2]; 2] {
    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
    [[j, k], [k, j]]
}
