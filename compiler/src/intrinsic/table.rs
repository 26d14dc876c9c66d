//! The table: one row per intrinsic. See [`Row`](super::Row).
//!
//! Overloads of one name stand together, ints before floats: the first whose inputs accept the
//! arguments without narrowing is the one that is called.

use super::Derivative::{Rule, Zero};
use super::Form::{All, Choose, Convert, Expand, Function, Operator};
use super::Tiling::{By, Plain};
use super::lanes::{Bits, each, whole};
use super::{Form, Helper, Intrinsic, Row, derivative, expand, find, tiling, value};

/// Every row.
pub static TABLE: &[Row] = &[
    Row {
        name: "-x",
        signature: "<n>(x: ivec<n>) -> ivec<n>",
        doc: "The negative; wraps.",
        value: each!((i32) -> i32, i32::wrapping_neg),
        derivative: Zero,
        tiling: By(tiling::negate),
        form: Operator("-"),
    },
    Row {
        name: "-x",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "The negative.",
        value: each!((f32) -> f32, |x| -x),
        derivative: Rule(derivative::negate),
        tiling: By(tiling::negate),
        form: Operator("-"),
    },
    Row {
        name: "!x",
        signature: "(x: bool) -> bool",
        doc: "Whether it does not hold.",
        value: each!((bool) -> bool, |x| !x),
        derivative: Zero,
        tiling: Plain,
        form: Operator("!"),
    },
    Row {
        name: "+",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> ivec<n>",
        doc: "Sum; ints wrap.",
        value: each!((i32, i32) -> i32, i32::wrapping_add),
        derivative: Zero,
        tiling: By(tiling::add),
        form: Operator("+"),
    },
    Row {
        name: "+",
        signature: "<n>(a: vec<n>, b: vec<n>) -> vec<n>",
        doc: "Sum.",
        value: each!((f32, f32) -> f32, |a, b| a + b),
        derivative: Rule(derivative::add),
        tiling: By(tiling::add),
        form: Operator("+"),
    },
    Row {
        name: "-",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> ivec<n>",
        doc: "Difference; ints wrap.",
        value: each!((i32, i32) -> i32, i32::wrapping_sub),
        derivative: Zero,
        tiling: By(tiling::subtract),
        form: Operator("-"),
    },
    Row {
        name: "-",
        signature: "<n>(a: vec<n>, b: vec<n>) -> vec<n>",
        doc: "Difference.",
        value: each!((f32, f32) -> f32, |a, b| a - b),
        derivative: Rule(derivative::subtract),
        tiling: By(tiling::subtract),
        form: Operator("-"),
    },
    Row {
        name: "*",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> ivec<n>",
        doc: "Product, component by component; ints wrap.",
        value: each!((i32, i32) -> i32, i32::wrapping_mul),
        derivative: Zero,
        tiling: By(tiling::multiply),
        form: Operator("*"),
    },
    Row {
        name: "*",
        signature: "<n>(a: vec<n>, b: vec<n>) -> vec<n>",
        doc: "Product, component by component.",
        value: each!((f32, f32) -> f32, |a, b| a * b),
        derivative: Rule(derivative::multiply),
        tiling: By(tiling::multiply),
        form: Operator("*"),
    },
    Row {
        name: "/",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> ivec<n>",
        doc: "Quotient rounded down; `x / 0` is 0, `MIN / -1` is `MIN`.",
        value: each!((i32, i32) -> i32, value::divide_int),
        derivative: Zero,
        tiling: By(tiling::divide_int),
        form: Expand(expand::divide_int),
    },
    Row {
        name: "/",
        signature: "<n>(a: vec<n>, b: vec<n>) -> vec<n>",
        doc: "Quotient; `x / 0` is 0, and 0 is whatever is nearer to it than 1e-37.",
        value: each!((f32, f32) -> f32, value::divide),
        derivative: Rule(derivative::divide),
        tiling: By(tiling::divide),
        form: Expand(expand::divide),
    },
    Row {
        name: "%",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> ivec<n>",
        doc: "What is left of the quotient rounded down: it has the divisor's sign; `x % 0` is 0.",
        value: each!((i32, i32) -> i32, value::remainder_int),
        derivative: Zero,
        tiling: By(tiling::remainder),
        form: Expand(expand::remainder_int),
    },
    Row {
        name: "%",
        signature: "<n>(a: vec<n>, b: vec<n>) -> vec<n>",
        doc: "`x - y·floor(x/y)`; `x % 0` is 0.",
        value: each!((f32, f32) -> f32, value::remainder),
        derivative: Rule(derivative::remainder),
        tiling: By(tiling::remainder),
        form: Expand(expand::remainder),
    },
    Row {
        name: "<",
        signature: "(a: int, b: int) -> bool",
        doc: "Compares two ints.",
        value: each!((i32, i32) -> bool, |a, b| a < b),
        derivative: Zero,
        tiling: By(tiling::less),
        form: Operator("<"),
    },
    Row {
        name: "<",
        signature: "(a: float, b: float) -> bool",
        doc: "Compares two floats.",
        value: each!((f32, f32) -> bool, |a, b| a < b),
        derivative: Zero,
        tiling: By(tiling::less),
        form: Operator("<"),
    },
    Row {
        name: "<=",
        signature: "(a: int, b: int) -> bool",
        doc: "Compares two ints.",
        value: each!((i32, i32) -> bool, |a, b| a <= b),
        derivative: Zero,
        tiling: By(tiling::less_equal),
        form: Operator("<="),
    },
    Row {
        name: "<=",
        signature: "(a: float, b: float) -> bool",
        doc: "Compares two floats.",
        value: each!((f32, f32) -> bool, |a, b| a <= b),
        derivative: Zero,
        tiling: By(tiling::less_equal),
        form: Operator("<="),
    },
    Row {
        name: ">",
        signature: "(a: int, b: int) -> bool",
        doc: "Compares two ints.",
        value: each!((i32, i32) -> bool, |a, b| a > b),
        derivative: Zero,
        tiling: By(tiling::greater),
        form: Operator(">"),
    },
    Row {
        name: ">",
        signature: "(a: float, b: float) -> bool",
        doc: "Compares two floats.",
        value: each!((f32, f32) -> bool, |a, b| a > b),
        derivative: Zero,
        tiling: By(tiling::greater),
        form: Operator(">"),
    },
    Row {
        name: ">=",
        signature: "(a: int, b: int) -> bool",
        doc: "Compares two ints.",
        value: each!((i32, i32) -> bool, |a, b| a >= b),
        derivative: Zero,
        tiling: By(tiling::greater_equal),
        form: Operator(">="),
    },
    Row {
        name: ">=",
        signature: "(a: float, b: float) -> bool",
        doc: "Compares two floats.",
        value: each!((f32, f32) -> bool, |a, b| a >= b),
        derivative: Zero,
        tiling: By(tiling::greater_equal),
        form: Operator(">="),
    },
    Row {
        name: "==",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> bool",
        doc: "Whether all components are equal.",
        value: whole!(([i32; N], [i32; N]) -> bool, value::equal),
        derivative: Zero,
        tiling: By(tiling::equal),
        form: Expand(expand::equal),
    },
    Row {
        name: "==",
        signature: "<n>(a: vec<n>, b: vec<n>) -> bool",
        doc: "Whether all components are equal.",
        value: whole!(([f32; N], [f32; N]) -> bool, value::equal),
        derivative: Zero,
        tiling: By(tiling::equal),
        form: Expand(expand::equal),
    },
    Row {
        name: "==",
        signature: "(a: bool, b: bool) -> bool",
        doc: "Whether all components are equal.",
        value: each!((bool, bool) -> bool, |a, b| a == b),
        derivative: Zero,
        tiling: Plain,
        form: Expand(expand::equal),
    },
    Row {
        name: "!=",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> bool",
        doc: "Whether any component differs.",
        value: whole!(([i32; N], [i32; N]) -> bool, value::not_equal),
        derivative: Zero,
        tiling: By(tiling::not_equal),
        form: Expand(expand::not_equal),
    },
    Row {
        name: "!=",
        signature: "<n>(a: vec<n>, b: vec<n>) -> bool",
        doc: "Whether any component differs.",
        value: whole!(([f32; N], [f32; N]) -> bool, value::not_equal),
        derivative: Zero,
        tiling: By(tiling::not_equal),
        form: Expand(expand::not_equal),
    },
    Row {
        name: "!=",
        signature: "(a: bool, b: bool) -> bool",
        doc: "Whether any component differs.",
        value: each!((bool, bool) -> bool, |a, b| a != b),
        derivative: Zero,
        tiling: Plain,
        form: Expand(expand::not_equal),
    },
    Row {
        name: "&&",
        signature: "(a: bool, b: bool) -> bool",
        doc: "Whether both hold.",
        value: each!((bool, bool) -> bool, |a, b| a && b),
        derivative: Zero,
        tiling: By(tiling::and),
        form: Operator("&"),
    },
    Row {
        name: "||",
        signature: "(a: bool, b: bool) -> bool",
        doc: "Whether either holds.",
        value: each!((bool, bool) -> bool, |a, b| a || b),
        derivative: Zero,
        tiling: By(tiling::or),
        form: Operator("|"),
    },
    Row {
        name: "floor",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Rounds down.",
        value: each!((f32) -> f32, value::floor),
        derivative: Zero,
        tiling: By(tiling::floor),
        form: Function("floor"),
    },
    Row {
        name: "ceil",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Rounds up.",
        value: each!((f32) -> f32, value::ceil),
        derivative: Zero,
        tiling: By(tiling::floor),
        form: Function("ceil"),
    },
    Row {
        name: "round",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Rounds to the nearest; halves to the even one.",
        value: each!((f32) -> f32, value::round),
        derivative: Zero,
        tiling: By(tiling::round),
        form: Function("round"),
    },
    Row {
        name: "ifloor",
        signature: "<n>(x: vec<n>) -> ivec<n>",
        doc: "Rounds down to an int; saturates as `int` does.",
        value: each!((f32) -> i32, value::floor_int),
        derivative: Zero,
        tiling: By(tiling::floor),
        form: Expand(expand::floor_int),
    },
    Row {
        name: "fract",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "`x - floor(x)`: in [0, 1], 1 only by rounding.",
        value: each!((f32) -> f32, |x| x - value::floor(x)),
        derivative: Rule(derivative::same),
        tiling: By(tiling::fract),
        form: Function("fract"),
    },
    Row {
        name: "narrow",
        signature: "<n>(v: vec<n>, share: vec<n>) -> vec<n>",
        doc: "`v`, as a pixel sees it that is `share` as wide: its change across the screen is that much of `v`'s.",
        value: each!((f32, f32) -> f32, |v, _| v),
        derivative: Rule(derivative::narrow),
        tiling: By(tiling::narrow),
        form: Expand(expand::narrow),
    },
    Row {
        name: "abs",
        signature: "<n>(x: ivec<n>) -> ivec<n>",
        doc: "The absolute value; that of the least int is itself.",
        value: each!((i32) -> i32, i32::wrapping_abs),
        derivative: Zero,
        tiling: Plain,
        form: Function("abs"),
    },
    Row {
        name: "abs",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "The absolute value.",
        value: each!((f32) -> f32, f32::abs),
        derivative: Rule(derivative::absolute),
        tiling: Plain,
        form: Function("abs"),
    },
    Row {
        name: "sign",
        signature: "<n>(x: ivec<n>) -> ivec<n>",
        doc: "-1, 0 or 1.",
        value: each!((i32) -> i32, |x| i32::from(x > 0) - i32::from(x < 0)),
        derivative: Zero,
        tiling: Plain,
        form: Function("sign"),
    },
    Row {
        name: "sign",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "-1, 0 or 1.",
        value: each!((f32) -> f32, |x| f32::from(i8::from(x > 0.0) - i8::from(x < 0.0))),
        derivative: Zero,
        tiling: Plain,
        form: Function("sign"),
    },
    Row {
        name: "min",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> ivec<n>",
        doc: "The lesser.",
        value: each!((i32, i32) -> i32, i32::min),
        derivative: Zero,
        tiling: By(tiling::either),
        form: Function("min"),
    },
    Row {
        name: "min",
        signature: "<n>(a: vec<n>, b: vec<n>) -> vec<n>",
        doc: "The lesser.",
        value: each!((f32, f32) -> f32, f32::min),
        derivative: Rule(derivative::minimum),
        tiling: By(tiling::either),
        form: Function("min"),
    },
    Row {
        name: "max",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> ivec<n>",
        doc: "The greater.",
        value: each!((i32, i32) -> i32, i32::max),
        derivative: Zero,
        tiling: By(tiling::either),
        form: Function("max"),
    },
    Row {
        name: "max",
        signature: "<n>(a: vec<n>, b: vec<n>) -> vec<n>",
        doc: "The greater.",
        value: each!((f32, f32) -> f32, f32::max),
        derivative: Rule(derivative::maximum),
        tiling: By(tiling::either),
        form: Function("max"),
    },
    Row {
        name: "clamp",
        signature: "<n>(x: ivec<n>, low: ivec<n>, high: ivec<n>) -> ivec<n>",
        doc: "`min(max(x, low), high)`.",
        value: each!((i32, i32, i32) -> i32, |x, low, high| x.max(low).min(high)),
        derivative: Zero,
        tiling: By(tiling::clamp),
        form: Expand(expand::clamp_int),
    },
    Row {
        name: "clamp",
        signature: "<n>(x: vec<n>, low: vec<n>, high: vec<n>) -> vec<n>",
        doc: "`min(max(x, low), high)`.",
        value: each!((f32, f32, f32) -> f32, |x, low, high| x.max(low).min(high)),
        derivative: Rule(derivative::clamp),
        tiling: By(tiling::clamp),
        form: Expand(expand::clamp),
    },
    Row {
        name: "mix",
        signature: "<n>(a: vec<n>, b: vec<n>, t: vec<n>) -> vec<n>",
        doc: "`a·(1 - t) + b·t`.",
        value: each!((f32, f32, f32) -> f32, value::mix),
        derivative: Rule(derivative::mix),
        tiling: By(tiling::mix),
        form: Expand(expand::mix),
    },
    Row {
        name: "step",
        signature: "<n>(edge: vec<n>, x: vec<n>) -> vec<n>",
        doc: "0 where `x < edge`, else 1.",
        value: each!((f32, f32) -> f32, |edge, x| if x < edge { 0.0 } else { 1.0 }),
        derivative: Zero,
        tiling: By(tiling::step),
        form: Expand(expand::step),
    },
    Row {
        name: "smoothstep",
        signature: "<n>(low: vec<n>, high: vec<n>, x: vec<n>) -> vec<n>",
        doc: "`t²(3 - 2t)` of `t = clamp((x - low)/(high - low), 0, 1)`, which reversed bounds turn round; a step where they are equal, or nearer than 1e-37.",
        value: each!((f32, f32, f32) -> f32, value::smoothstep),
        derivative: Rule(derivative::smoothstep),
        tiling: By(tiling::smoothstep),
        form: Expand(expand::smoothstep),
    },
    Row {
        name: "sin",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Sine of an angle in radians.",
        value: each!((f32) -> f32, libm::sinf),
        derivative: Rule(derivative::sine),
        tiling: By(tiling::wave),
        form: Function("sin"),
    },
    Row {
        name: "cos",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Cosine of an angle in radians.",
        value: each!((f32) -> f32, libm::cosf),
        derivative: Rule(derivative::cosine),
        tiling: By(tiling::wave),
        form: Function("cos"),
    },
    Row {
        name: "tan",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Tangent of an angle in radians.",
        value: each!((f32) -> f32, |x| value::divide(libm::sinf(x), libm::cosf(x))),
        derivative: Rule(derivative::tangent),
        tiling: By(tiling::tangent),
        form: Expand(expand::tangent),
    },
    Row {
        name: "exp",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "e to the power of x; for what is greater than 87, of 87.",
        value: each!((f32) -> f32, |x| libm::expf(x.min(value::GREATEST_EXP))),
        derivative: Rule(derivative::exponential),
        tiling: Plain,
        form: Expand(expand::exponential),
    },
    Row {
        name: "exp2",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "2 to the power of x; for what is greater than 126, of 126.",
        value: each!((f32) -> f32, |x| libm::exp2f(x.min(value::GREATEST_EXP2))),
        derivative: Rule(derivative::exponential2),
        tiling: Plain,
        form: Expand(expand::exponential2),
    },
    Row {
        name: "asin",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Arc sine of x clamped to -1..1, in radians.",
        value: each!((f32) -> f32, |x| libm::asinf(x.clamp(-1.0, 1.0))),
        derivative: Rule(derivative::arc_sine),
        tiling: Plain,
        form: Expand(expand::arc_sine),
    },
    Row {
        name: "acos",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Arc cosine of x clamped to -1..1, in radians.",
        value: each!((f32) -> f32, |x| libm::acosf(x.clamp(-1.0, 1.0))),
        derivative: Rule(derivative::arc_cosine),
        tiling: Plain,
        form: Expand(expand::arc_cosine),
    },
    Row {
        name: "atan2",
        signature: "<n>(y: vec<n>, x: vec<n>) -> vec<n>",
        doc: "The angle of (x, y) in radians, -π to π; 0 where both are nearer to 0 than 1e-37. Such a y alone gives 0 or π, whatever its sign.",
        value: each!((f32, f32) -> f32, value::arc_tangent),
        derivative: Rule(derivative::arc_tangent),
        tiling: Plain,
        form: Expand(expand::arc_tangent),
    },
    Row {
        name: "sqrt",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Square root; 0 of what is negative.",
        value: each!((f32) -> f32, |x| x.max(0.0).sqrt()),
        derivative: Rule(derivative::root),
        tiling: Plain,
        form: Expand(expand::root),
    },
    Row {
        name: "log",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Natural logarithm; 0 of what is below 1e-37.",
        value: each!((f32) -> f32, |x| value::logarithm(libm::logf, x)),
        derivative: Rule(derivative::logarithm),
        tiling: Plain,
        form: Expand(expand::logarithm),
    },
    Row {
        name: "log2",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Logarithm of base 2; 0 of what is below 1e-37.",
        value: each!((f32) -> f32, |x| value::logarithm(libm::log2f, x)),
        derivative: Rule(derivative::logarithm2),
        tiling: Plain,
        form: Expand(expand::logarithm2),
    },
    Row {
        name: "pow",
        signature: "<n>(x: vec<n>, y: vec<n>) -> vec<n>",
        doc: "x to the power of y, at most 1e38; for x below 1e-37 it is 0, and 1 where y is 0.",
        value: each!((f32, f32) -> f32, value::power),
        derivative: Rule(derivative::power),
        tiling: Plain,
        form: Expand(expand::power),
    },
    Row {
        name: "dot",
        signature: "<n>(a: vec<n>, b: vec<n>) -> float",
        doc: "The sum of the products of the components.",
        value: whole!(([f32; N], [f32; N]) -> f32, value::dot),
        derivative: Rule(derivative::dot),
        tiling: By(tiling::dot),
        form: Expand(expand::dot),
    },
    Row {
        name: "length",
        signature: "<n>(v: vec<n>) -> float",
        doc: "Euclidean length.",
        value: whole!(([f32; N]) -> f32, value::length),
        derivative: Rule(derivative::length),
        tiling: Plain,
        form: Expand(expand::length),
    },
    Row {
        name: "distance",
        signature: "<n>(a: vec<n>, b: vec<n>) -> float",
        doc: "Euclidean distance.",
        value: whole!(([f32; N], [f32; N]) -> f32, value::distance),
        derivative: Rule(derivative::distance),
        tiling: By(tiling::distance),
        form: Expand(expand::distance),
    },
    Row {
        name: "cross",
        signature: "(a: vec3, b: vec3) -> vec3",
        doc: "The vector at right angles to both.",
        value: whole!(([f32; 3], [f32; 3]) -> [f32; 3], value::cross),
        derivative: Rule(derivative::cross),
        tiling: Plain,
        form: Function("cross"),
    },
    Row {
        name: "normalize",
        signature: "<n>(v: vec<n>) -> vec<n>",
        doc: "The same direction with length 1; 0 for 0.",
        value: whole!(([f32; N]) -> [f32; N], value::normalize),
        derivative: Rule(derivative::normalize),
        tiling: Plain,
        form: Expand(expand::normalize),
    },
    Row {
        name: "hash",
        signature: "<n>(i: ivec<n>, seed: int = 0) -> vec4",
        doc: "Four random numbers in [0, 1): pcg4d of (i padded with 0, seed), upper 24 bits.",
        value: whole!(([i32; N], i32) -> [f32; 4], value::hash),
        derivative: Zero,
        tiling: Plain,
        form: Expand(expand::hash),
    },
    Row {
        name: "bits",
        signature: "<n>(x: ivec<n>, first: ivec<n>, count: ivec<n>) -> ivec<n>",
        doc: "`count` bits of x from bit `first` on, as a number from 0 up.",
        value: each!((i32, i32, i32) -> i32, value::bits),
        derivative: Zero,
        tiling: By(tiling::bits),
        form: Expand(expand::bits),
    },
    Row {
        name: "(float)",
        signature: "<n>(x: ivec<n>) -> vec<n>",
        doc: "Widens.",
        value: each!((i32) -> f32, |i| i as f32),
        derivative: Zero,
        tiling: By(tiling::to_float),
        form: Convert,
    },
    Row {
        name: "(int)",
        signature: "<n>(x: vec<n>) -> ivec<n>",
        doc: "Truncates; saturates, upwards somewhere from 2147483520, the greatest int that is a float.",
        value: each!((f32) -> i32, value::to_int),
        derivative: Zero,
        tiling: By(tiling::to_int),
        form: Convert,
    },
    Row {
        name: "([i])",
        signature: "<n>(v: vec<n>, i: int) -> float",
        doc: "A component, the index clamped.",
        value: whole!(([Bits; N], i32) -> Bits, value::component),
        derivative: Rule(derivative::component),
        tiling: By(tiling::component),
        form: Expand(expand::component),
    },
    Row {
        name: "(clamp)",
        signature: "<n>(x: vec<n>, low: vec<n>, high: vec<n>) -> vec<n>",
        doc: "The same where the bounds are in order.",
        value: each!((f32, f32, f32) -> f32, |x, low, high| x.max(low).min(high)),
        derivative: Rule(derivative::clamp),
        tiling: By(tiling::clamp),
        form: Function("clamp"),
    },
    Row {
        name: "(smoothstep)",
        signature: "<n>(low: vec<n>, high: vec<n>, x: vec<n>) -> vec<n>",
        doc: "The same where the bounds are in order and apart.",
        value: each!((f32, f32, f32) -> f32, value::smoothstep),
        derivative: Rule(derivative::smoothstep),
        tiling: By(tiling::smoothstep),
        form: Function("smoothstep"),
    },
    Row {
        name: "(hash4)",
        signature: "(v: ivec4) -> vec4",
        doc: "The hash of four words.",
        value: whole!(([i32; 4]) -> [f32; 4], value::hash4),
        derivative: Zero,
        tiling: Plain,
        form: Form::Helper(Helper::Hash),
    },
    Row {
        name: "(all)",
        signature: "<n>(c: bvec<n>) -> bool",
        doc: "Whether all components hold.",
        value: whole!(([bool; N]) -> bool, value::all),
        derivative: Zero,
        tiling: Plain,
        form: All,
    },
    Row {
        name: "(choose int)",
        signature: "<n>(c: bvec<n>, a: ivec<n>, b: ivec<n>) -> ivec<n>",
        doc: "The second where the first holds, else the third.",
        value: each!((bool, i32, i32) -> i32, value::choose),
        derivative: Zero,
        tiling: By(tiling::choose),
        form: Choose,
    },
    Row {
        name: "(choose)",
        signature: "<n>(c: bvec<n>, a: vec<n>, b: vec<n>) -> vec<n>",
        doc: "The second where the first holds, else the third.",
        value: each!((bool, f32, f32) -> f32, value::choose),
        derivative: Rule(derivative::choose),
        tiling: By(tiling::choose),
        form: Choose,
    },
    Row {
        name: "(<int)",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> bvec<n>",
        doc: "Compares components.",
        value: each!((i32, i32) -> bool, |a, b| a < b),
        derivative: Zero,
        tiling: Plain,
        form: Operator("<"),
    },
    Row {
        name: "(<)",
        signature: "<n>(a: vec<n>, b: vec<n>) -> bvec<n>",
        doc: "Compares components.",
        value: each!((f32, f32) -> bool, |a, b| a < b),
        derivative: Zero,
        tiling: Plain,
        form: Operator("<"),
    },
    Row {
        name: "(==int)",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> bvec<n>",
        doc: "Compares components.",
        value: each!((i32, i32) -> bool, |a, b| a == b),
        derivative: Zero,
        tiling: Plain,
        form: Operator("=="),
    },
    Row {
        name: "(!=int)",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> bvec<n>",
        doc: "Compares components.",
        value: each!((i32, i32) -> bool, |a, b| a != b),
        derivative: Zero,
        tiling: Plain,
        form: Operator("!="),
    },
    Row {
        name: "(==)",
        signature: "<n>(a: vec<n>, b: vec<n>) -> bvec<n>",
        doc: "Compares components.",
        value: each!((f32, f32) -> bool, |a, b| a == b),
        derivative: Zero,
        tiling: Plain,
        form: Operator("=="),
    },
    Row {
        name: "(==bool)",
        signature: "<n>(a: bvec<n>, b: bvec<n>) -> bvec<n>",
        doc: "Compares components.",
        value: each!((bool, bool) -> bool, |a, b| a == b),
        derivative: Zero,
        tiling: Plain,
        form: Operator("=="),
    },
    Row {
        name: "(&)",
        signature: "<n>(a: bvec<n>, b: bvec<n>) -> bvec<n>",
        doc: "Both of each component.",
        value: each!((bool, bool) -> bool, |a, b| a && b),
        derivative: Zero,
        tiling: Plain,
        form: Operator("&"),
    },
    Row {
        name: "(^)",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> ivec<n>",
        doc: "Bits that differ.",
        value: each!((i32, i32) -> i32, |a, b| a ^ b),
        derivative: Zero,
        tiling: Plain,
        form: Operator("^"),
    },
    Row {
        name: "(bits &)",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> ivec<n>",
        doc: "Bits that both have.",
        value: each!((i32, i32) -> i32, |a, b| a & b),
        derivative: Zero,
        tiling: Plain,
        form: Operator("&"),
    },
    Row {
        name: "(>>)",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> ivec<n>",
        doc: "Arithmetic shift; counts 0 to 31.",
        value: each!((i32, i32) -> i32, |a, b| a.wrapping_shr(b as u32)),
        derivative: Zero,
        tiling: Plain,
        form: Operator(">>"),
    },
    Row {
        name: "(<<)",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> ivec<n>",
        doc: "Shift; counts 0 to 31.",
        value: each!((i32, i32) -> i32, |a, b| a.wrapping_shl(b as u32)),
        derivative: Zero,
        tiling: Plain,
        form: Operator("<<"),
    },
    Row {
        name: "(/int)",
        signature: "<n>(a: ivec<n>, b: ivec<n>) -> ivec<n>",
        doc: "Truncated quotient; the divisor is not 0.",
        value: each!((i32, i32) -> i32, |a, b| if b == 0 { 0 } else { a.wrapping_div(b) }),
        derivative: Zero,
        tiling: Plain,
        form: Operator("/"),
    },
    Row {
        name: "(/)",
        signature: "<n>(a: vec<n>, b: vec<n>) -> vec<n>",
        doc: "Quotient; what it is for a divisor of 0 must not matter.",
        value: each!((f32, f32) -> f32, value::divide),
        derivative: Rule(derivative::divide),
        tiling: Plain,
        form: Operator("/"),
    },
    Row {
        name: "(dot)",
        signature: "<n>(a: vec<n>, b: vec<n>) -> float",
        doc: "For two components or more.",
        value: whole!(([f32; N], [f32; N]) -> f32, value::dot),
        derivative: Rule(derivative::dot),
        tiling: By(tiling::dot),
        form: Function("dot"),
    },
    Row {
        name: "(sqrt)",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Where it is defined.",
        value: each!((f32) -> f32, f32::sqrt),
        derivative: Rule(derivative::root),
        tiling: Plain,
        form: Function("sqrt"),
    },
    Row {
        name: "(log)",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Where it is defined.",
        value: each!((f32) -> f32, libm::logf),
        derivative: Rule(derivative::logarithm),
        tiling: Plain,
        form: Function("log"),
    },
    Row {
        name: "(log2)",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Where it is defined.",
        value: each!((f32) -> f32, libm::log2f),
        derivative: Rule(derivative::logarithm2),
        tiling: Plain,
        form: Function("log2"),
    },
    Row {
        name: "(asin)",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Where it is defined.",
        value: each!((f32) -> f32, libm::asinf),
        derivative: Rule(derivative::arc_sine),
        tiling: Plain,
        form: Function("asin"),
    },
    Row {
        name: "(acos)",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "Where it is defined.",
        value: each!((f32) -> f32, libm::acosf),
        derivative: Rule(derivative::arc_cosine),
        tiling: Plain,
        form: Function("acos"),
    },
    Row {
        name: "(pow)",
        signature: "<n>(a: vec<n>, b: vec<n>) -> vec<n>",
        doc: "Of a positive base.",
        value: each!((f32, f32) -> f32, libm::powf),
        derivative: Rule(derivative::power),
        tiling: Plain,
        form: Function("pow"),
    },
    Row {
        name: "(atan2)",
        signature: "<n>(a: vec<n>, b: vec<n>) -> vec<n>",
        doc: "Of anything but (0, 0).",
        value: each!((f32, f32) -> f32, libm::atan2f),
        derivative: Rule(derivative::arc_tangent),
        tiling: Plain,
        form: Function("atan2"),
    },
    Row {
        name: "(exp)",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "e to the power of an x of 87 or less.",
        value: each!((f32) -> f32, libm::expf),
        derivative: Rule(derivative::exponential),
        tiling: Plain,
        form: Function("exp"),
    },
    Row {
        name: "(exp2)",
        signature: "<n>(x: vec<n>) -> vec<n>",
        doc: "2 to the power of an x of 126 or less.",
        value: each!((f32) -> f32, libm::exp2f),
        derivative: Rule(derivative::exponential2),
        tiling: Plain,
        form: Function("exp2"),
    },
    Row {
        name: "(length)",
        signature: "<n>(v: vec<n>) -> float",
        doc: "Euclidean length of two components or more.",
        value: whole!(([f32; N]) -> f32, value::length),
        derivative: Rule(derivative::length),
        tiling: Plain,
        form: Function("length"),
    },
];

/// `-x`
pub const NEGATE_INT: Intrinsic = find("-x", 0);

/// `-x`
pub const NEGATE: Intrinsic = find("-x", 1);

/// `!x`
pub const NOT: Intrinsic = find("!x", 0);

/// `+`
pub const ADD_INT: Intrinsic = find("+", 0);

/// `+`
pub const ADD: Intrinsic = find("+", 1);

/// `-`
pub const SUBTRACT_INT: Intrinsic = find("-", 0);

/// `-`
pub const SUBTRACT: Intrinsic = find("-", 1);

/// `*`
pub const MULTIPLY_INT: Intrinsic = find("*", 0);

/// `*`
pub const MULTIPLY: Intrinsic = find("*", 1);

/// `/`
pub const DIVIDE_INT: Intrinsic = find("/", 0);

/// `/`
pub const DIVIDE: Intrinsic = find("/", 1);

/// `%`
pub const REMAINDER_INT: Intrinsic = find("%", 0);

/// `%`
pub const REMAINDER: Intrinsic = find("%", 1);

/// `<`
pub const LESS_INT: Intrinsic = find("<", 0);

/// `<`
pub const LESS: Intrinsic = find("<", 1);

/// `<=`
pub const LESS_EQUAL_INT: Intrinsic = find("<=", 0);

/// `<=`
pub const LESS_EQUAL: Intrinsic = find("<=", 1);

/// `>`
pub const GREATER_INT: Intrinsic = find(">", 0);

/// `>`
pub const GREATER: Intrinsic = find(">", 1);

/// `>=`
pub const GREATER_EQUAL_INT: Intrinsic = find(">=", 0);

/// `>=`
pub const GREATER_EQUAL: Intrinsic = find(">=", 1);

/// `==`
pub const EQUAL_INT: Intrinsic = find("==", 0);

/// `==`
pub const EQUAL: Intrinsic = find("==", 1);

/// `==`
pub const EQUAL_BOOL: Intrinsic = find("==", 2);

/// `!=`
pub const NOT_EQUAL_INT: Intrinsic = find("!=", 0);

/// `!=`
pub const NOT_EQUAL: Intrinsic = find("!=", 1);

/// `!=`
pub const NOT_EQUAL_BOOL: Intrinsic = find("!=", 2);

/// `&&`
pub const AND: Intrinsic = find("&&", 0);

/// `||`
pub const OR: Intrinsic = find("||", 0);

/// `floor`
pub const FLOOR: Intrinsic = find("floor", 0);

/// `ceil`
pub const CEIL: Intrinsic = find("ceil", 0);

/// `round`
pub const ROUND: Intrinsic = find("round", 0);

/// `ifloor`
pub const FLOOR_INT: Intrinsic = find("ifloor", 0);

/// `fract`
pub const FRACT: Intrinsic = find("fract", 0);

/// `abs`
pub const ABSOLUTE_INT: Intrinsic = find("abs", 0);

/// `abs`
pub const ABSOLUTE: Intrinsic = find("abs", 1);

/// `sign`
pub const SIGN_INT: Intrinsic = find("sign", 0);

/// `sign`
pub const SIGN: Intrinsic = find("sign", 1);

/// `min`
pub const MINIMUM_INT: Intrinsic = find("min", 0);

/// `min`
pub const MINIMUM: Intrinsic = find("min", 1);

/// `max`
pub const MAXIMUM_INT: Intrinsic = find("max", 0);

/// `max`
pub const MAXIMUM: Intrinsic = find("max", 1);

/// `clamp`
pub const CLAMP_INT: Intrinsic = find("clamp", 0);

/// `clamp`
pub const CLAMP: Intrinsic = find("clamp", 1);

/// `clamp` with bounds in order
pub const RAW_CLAMP: Intrinsic = find("(clamp)", 0);
/// `smoothstep` with bounds in order and apart
pub const RAW_SMOOTHSTEP: Intrinsic = find("(smoothstep)", 0);
/// `mix`
pub const MIX: Intrinsic = find("mix", 0);

/// `step`
pub const STEP: Intrinsic = find("step", 0);

/// `smoothstep`
pub const SMOOTHSTEP: Intrinsic = find("smoothstep", 0);

/// `sin`
pub const SIN: Intrinsic = find("sin", 0);

/// `cos`
pub const COS: Intrinsic = find("cos", 0);

/// `tan`
pub const TAN: Intrinsic = find("tan", 0);

/// `exp`
pub const EXP: Intrinsic = find("exp", 0);

/// `exp2`
pub const EXP2: Intrinsic = find("exp2", 0);

/// `asin`
pub const ASIN: Intrinsic = find("asin", 0);

/// `acos`
pub const ACOS: Intrinsic = find("acos", 0);

/// `atan2`
pub const ATAN2: Intrinsic = find("atan2", 0);

/// `sqrt`
pub const SQRT: Intrinsic = find("sqrt", 0);

/// `log`
pub const LOG: Intrinsic = find("log", 0);

/// `log2`
pub const LOG2: Intrinsic = find("log2", 0);

/// `pow`
pub const POW: Intrinsic = find("pow", 0);

/// `dot`
pub const DOT: Intrinsic = find("dot", 0);

/// `length`
pub const LENGTH: Intrinsic = find("length", 0);

/// `distance`
pub const DISTANCE: Intrinsic = find("distance", 0);

/// `cross`
pub const CROSS: Intrinsic = find("cross", 0);

/// `normalize`
pub const NORMALIZE: Intrinsic = find("normalize", 0);

/// `hash`
pub const HASH: Intrinsic = find("hash", 0);

/// `bits`
pub const BITS: Intrinsic = find("bits", 0);

/// `(float)`
pub const TO_FLOAT: Intrinsic = find("(float)", 0);

/// `(int)`
pub const TO_INT: Intrinsic = find("(int)", 0);

/// `([i])`
pub const COMPONENT: Intrinsic = find("([i])", 0);

/// `(hash4)`
pub const HASH4: Intrinsic = find("(hash4)", 0);

/// `(all)`
pub const ALL: Intrinsic = find("(all)", 0);

/// `(choose int)`
pub const CHOOSE_INT: Intrinsic = find("(choose int)", 0);

/// `(choose)`
pub const CHOOSE: Intrinsic = find("(choose)", 0);

/// `(<int)`
pub const COMPONENT_LESS_INT: Intrinsic = find("(<int)", 0);

/// `(<)`
pub const COMPONENT_LESS: Intrinsic = find("(<)", 0);

/// `(==int)`
pub const COMPONENT_EQUAL_INT: Intrinsic = find("(==int)", 0);

/// `(!=int)`
pub const COMPONENT_UNEQUAL_INT: Intrinsic = find("(!=int)", 0);

/// `(==)`
pub const COMPONENT_EQUAL: Intrinsic = find("(==)", 0);

/// `(==bool)`
pub const COMPONENT_EQUAL_BOOL: Intrinsic = find("(==bool)", 0);

/// `(&)`
pub const COMPONENT_AND: Intrinsic = find("(&)", 0);

/// `(^)`
pub const EXCLUSIVE_OR: Intrinsic = find("(^)", 0);

/// `(bits &)`
pub const BITWISE_AND: Intrinsic = find("(bits &)", 0);

/// `(>>)`
pub const SHIFT_RIGHT: Intrinsic = find("(>>)", 0);

/// `(<<)`
pub const SHIFT_LEFT: Intrinsic = find("(<<)", 0);

/// `(/int)`
pub const RAW_DIVIDE_INT: Intrinsic = find("(/int)", 0);

/// `(/)`
pub const RAW_DIVIDE: Intrinsic = find("(/)", 0);

/// `(dot)`
pub const RAW_DOT: Intrinsic = find("(dot)", 0);

/// `(sqrt)`
pub const RAW_SQRT: Intrinsic = find("(sqrt)", 0);

/// `(log)`
pub const RAW_LOG: Intrinsic = find("(log)", 0);

/// `(log2)`
pub const RAW_LOG2: Intrinsic = find("(log2)", 0);

/// `(asin)`
pub const RAW_ASIN: Intrinsic = find("(asin)", 0);

/// `(acos)`
pub const RAW_ACOS: Intrinsic = find("(acos)", 0);

/// `(pow)`
pub const RAW_POW: Intrinsic = find("(pow)", 0);

/// `(atan2)`
pub const RAW_ATAN2: Intrinsic = find("(atan2)", 0);

/// `(exp)`
pub const RAW_EXP: Intrinsic = find("(exp)", 0);

/// `(exp2)`
pub const RAW_EXP2: Intrinsic = find("(exp2)", 0);

/// `(length)`
pub const RAW_LENGTH: Intrinsic = find("(length)", 0);
