//! Derivative rules: forward mode, one tangent per argument (Griewank & Walther, *Evaluating
//! Derivatives*, §3.1). A rule is 0 where its intrinsic is singular.

use super::*;
use crate::graph::{Builder, Constant, Scalar, Type, Value};

/// What a rule works with: the arguments, the result and the arguments' tangents, each of the type
/// of what it belongs to. A tangent that is known to be 0 is the constant 0, so it folds away.
pub struct Tangents<'a> {
    /// Where new values go.
    pub builder: &'a mut Builder,
    /// The arguments.
    pub arguments: &'a [Value],
    /// The intrinsic's own value.
    pub result: Value,
    /// How the arguments change.
    pub tangents: &'a [Value],
}

impl Tangents<'_> {
    /// Argument `i`.
    pub fn x(&self, i: usize) -> Value {
        self.arguments[i]
    }

    /// The tangent of argument `i`.
    pub fn t(&self, i: usize) -> Value {
        self.tangents[i]
    }

    /// Any intrinsic of any values.
    pub fn of(&mut self, intrinsic: Intrinsic, arguments: &[Value]) -> Value {
        self.builder.builtin(intrinsic, arguments)
    }

    fn mul(&mut self, a: Value, b: Value) -> Value {
        self.of(MULTIPLY, &[a, b])
    }

    fn add(&mut self, a: Value, b: Value) -> Value {
        self.of(ADD, &[a, b])
    }

    fn sub(&mut self, a: Value, b: Value) -> Value {
        self.of(SUBTRACT, &[a, b])
    }

    fn div(&mut self, a: Value, b: Value) -> Value {
        self.of(DIVIDE, &[a, b])
    }

    fn number(&mut self, like: Value, x: f32) -> Value {
        let width = self.builder.ty(like).width();
        self.builder.constant(Constant::floats(&[x]).splat(width))
    }

    fn spread(&mut self, scalar: Value, like: Value) -> Value {
        let width = self.builder.ty(like).width();
        self.builder.splat(scalar, width)
    }

    /// `yes` where the comparison of `a` and `b` holds, component by component.
    fn where_holds(&mut self, comparison: Intrinsic, a: Value, b: Value, yes: Value, no: Value) -> Value {
        let holds = self.of(comparison, &[a, b]);
        self.of(CHOOSE, &[holds, yes, no])
    }
}

/// Of a sum.
pub fn add(d: &mut Tangents) -> Value {
    d.add(d.t(0), d.t(1))
}

/// Of a difference.
pub fn subtract(d: &mut Tangents) -> Value {
    d.sub(d.t(0), d.t(1))
}

/// Of a negation.
pub fn negate(d: &mut Tangents) -> Value {
    d.of(NEGATE, &[d.t(0)])
}

/// Of a product.
pub fn multiply(d: &mut Tangents) -> Value {
    let left = d.mul(d.t(0), d.x(1));
    let right = d.mul(d.x(0), d.t(1));
    d.add(left, right)
}

/// Of a quotient: (x' − q·y') / y.
pub fn divide(d: &mut Tangents) -> Value {
    let part = d.mul(d.result, d.t(1));
    let change = d.sub(d.t(0), part);
    d.div(change, d.x(1))
}

/// Of a remainder: x' − y'·floor(x / y).
pub fn remainder(d: &mut Tangents) -> Value {
    let quotient = d.div(d.x(0), d.x(1));
    let whole = d.of(FLOOR, &[quotient]);
    let part = d.mul(d.t(1), whole);
    d.sub(d.t(0), part)
}

/// Of what moves as its argument does.
pub fn same(d: &mut Tangents) -> Value {
    d.t(0)
}

/// Of what is seen by a part of a pixel: that share of its change.
pub fn narrow(d: &mut Tangents) -> Value {
    d.mul(d.t(0), d.x(1))
}

/// Of an absolute value: 0 at 0.
pub fn absolute(d: &mut Tangents) -> Value {
    let sign = d.of(SIGN, &[d.x(0)]);
    d.mul(sign, d.t(0))
}

/// Of the lesser: that of the one chosen.
pub fn minimum(d: &mut Tangents) -> Value {
    d.where_holds(COMPONENT_LESS, d.x(1), d.x(0), d.t(1), d.t(0))
}

/// Of the greater: that of the one chosen.
pub fn maximum(d: &mut Tangents) -> Value {
    d.where_holds(COMPONENT_LESS, d.x(0), d.x(1), d.t(1), d.t(0))
}

/// Of a clamp: that of whichever of the three it is, bounds applied as the value applies them.
pub fn clamp(d: &mut Tangents) -> Value {
    let raised = d.of(MAXIMUM, &[d.x(0), d.x(1)]);
    let below = d.where_holds(COMPONENT_LESS, d.x(0), d.x(1), d.t(1), d.t(0));
    d.where_holds(COMPONENT_LESS, d.x(2), raised, d.t(2), below)
}

/// Of a mix of two by a third.
pub fn mix(d: &mut Tangents) -> Value {
    let ends = d.of(MIX, &[d.t(0), d.t(1), d.x(2)]);
    let span = d.sub(d.x(1), d.x(0));
    let moved = d.mul(span, d.t(2));
    d.add(ends, moved)
}

/// Of a smoothstep with fixed bounds: 6t(1 − t)/(high − low). Moving bounds count as t moving.
pub fn smoothstep(d: &mut Tangents) -> Value {
    let span = d.sub(d.x(1), d.x(0));
    let offset = d.sub(d.x(2), d.x(0));
    let ratio = d.div(offset, span);
    let (zero, one, six) = (d.number(ratio, 0.0), d.number(ratio, 1.0), d.number(ratio, 6.0));
    let t = d.of(CLAMP, &[ratio, zero, one]);
    let rest = d.sub(one, t);
    let bell = d.mul(t, rest);
    let slope = d.mul(six, bell);
    let widening = d.sub(d.t(1), d.t(0));
    let shift = d.mul(ratio, widening);
    let start = d.sub(d.t(2), d.t(0));
    let change = d.sub(start, shift);
    let moved = d.div(change, span);
    d.mul(slope, moved)
}

/// Of a sine.
pub fn sine(d: &mut Tangents) -> Value {
    let slope = d.of(COS, &[d.x(0)]);
    d.mul(slope, d.t(0))
}

/// Of a cosine.
pub fn cosine(d: &mut Tangents) -> Value {
    let slope = d.of(SIN, &[d.x(0)]);
    let moved = d.mul(slope, d.t(0));
    d.of(NEGATE, &[moved])
}

/// Of a tangent: x'·(1 + tan²).
pub fn tangent(d: &mut Tangents) -> Value {
    let square = d.mul(d.result, d.result);
    let one = d.number(square, 1.0);
    let slope = d.add(square, one);
    d.mul(slope, d.t(0))
}

/// Of an arc sine: x'/√(1 − x²).
pub fn arc_sine(d: &mut Tangents) -> Value {
    let square = d.mul(d.x(0), d.x(0));
    let one = d.number(square, 1.0);
    let rest = d.sub(one, square);
    let root = d.of(SQRT, &[rest]);
    d.div(d.t(0), root)
}

/// Of an arc cosine: −x'/√(1 − x²).
pub fn arc_cosine(d: &mut Tangents) -> Value {
    let moved = arc_sine(d);
    d.of(NEGATE, &[moved])
}

/// Of the angle of (x, y): (y'·x − x'·y)/(x² + y²).
pub fn arc_tangent(d: &mut Tangents) -> Value {
    let (y, x) = (d.x(0), d.x(1));
    let (left, right) = (d.mul(d.t(0), x), d.mul(d.t(1), y));
    let turn = d.sub(left, right);
    let (xx, yy) = (d.mul(x, x), d.mul(y, y));
    let square = d.add(xx, yy);
    d.div(turn, square)
}

/// Of a power of e.
pub fn exponential(d: &mut Tangents) -> Value {
    d.mul(d.result, d.t(0))
}

/// Of a power of 2.
pub fn exponential2(d: &mut Tangents) -> Value {
    let slope = d.number(d.result, std::f32::consts::LN_2);
    let moved = d.mul(slope, d.t(0));
    d.mul(d.result, moved)
}

/// Of a natural logarithm.
pub fn logarithm(d: &mut Tangents) -> Value {
    d.div(d.t(0), d.x(0))
}

/// Of a logarithm of base 2.
pub fn logarithm2(d: &mut Tangents) -> Value {
    let slope = d.number(d.x(0), std::f32::consts::LOG2_E);
    let moved = d.mul(slope, d.t(0));
    d.div(moved, d.x(0))
}

/// Of a square root: x'/(2√x).
pub fn root(d: &mut Tangents) -> Value {
    let two = d.number(d.result, 2.0);
    let twice = d.mul(two, d.result);
    d.div(d.t(0), twice)
}

/// Of a power: y·x^(y−1)·x' + ln(x)·x^y·y'.
pub fn power(d: &mut Tangents) -> Value {
    let one = d.number(d.x(1), 1.0);
    let lower = d.sub(d.x(1), one);
    let flat = d.of(POW, &[d.x(0), lower]);
    let slope = d.mul(d.x(1), flat);
    let base = d.mul(slope, d.t(0));
    let log = d.of(LOG, &[d.x(0)]);
    let growth = d.mul(log, d.result);
    let exponent = d.mul(growth, d.t(1));
    d.add(base, exponent)
}

/// Of a dot product.
pub fn dot(d: &mut Tangents) -> Value {
    let left = d.of(DOT, &[d.t(0), d.x(1)]);
    let right = d.of(DOT, &[d.x(0), d.t(1)]);
    d.add(left, right)
}

/// Of a length: v·v'/|v|.
pub fn length(d: &mut Tangents) -> Value {
    let along = d.of(DOT, &[d.x(0), d.t(0)]);
    d.div(along, d.result)
}

/// Of a distance.
pub fn distance(d: &mut Tangents) -> Value {
    let offset = d.sub(d.x(0), d.x(1));
    let change = d.sub(d.t(0), d.t(1));
    let along = d.of(DOT, &[offset, change]);
    d.div(along, d.result)
}

/// Of a cross product.
pub fn cross(d: &mut Tangents) -> Value {
    let left = d.of(CROSS, &[d.t(0), d.x(1)]);
    let right = d.of(CROSS, &[d.x(0), d.t(1)]);
    d.add(left, right)
}

/// Of a normalised vector: the change across it, over the length.
pub fn normalize(d: &mut Tangents) -> Value {
    let along = d.of(DOT, &[d.result, d.t(0)]);
    let spread = d.spread(along, d.result);
    let part = d.mul(d.result, spread);
    let across = d.sub(d.t(0), part);
    let length = d.of(LENGTH, &[d.x(0)]);
    let length = d.spread(length, d.result);
    d.div(across, length)
}

/// Of a component-wise choice.
pub fn choose(d: &mut Tangents) -> Value {
    d.of(CHOOSE, &[d.x(0), d.t(1), d.t(2)])
}

/// Of a component.
pub fn component(d: &mut Tangents) -> Value {
    d.of(COMPONENT, &[d.t(0), d.x(1)])
}

/// The zero of a type: the tangent of what does not change. Views have none.
pub fn zero(ty: Type) -> Option<Constant> {
    ty.scalar().map(|scalar| Constant::zero(scalar, ty.width())).filter(|c| c.scalar() != Scalar::Bool)
}
