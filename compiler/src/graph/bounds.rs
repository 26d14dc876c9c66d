//! What an int can be, as far as the operations that make it tell.

use super::{Function, Operation, Scalar, Value};
use crate::intrinsic::{
    ABSOLUTE_INT, ADD_INT, BITS, CLAMP_INT, DIVIDE_INT, HASH, HASH4, Intrinsic, MAXIMUM_INT, MINIMUM_INT,
    MULTIPLY, MULTIPLY_INT, NEGATE_INT, REMAINDER_INT, SUBTRACT_INT, TO_INT,
};

/// The numbers that an int may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least.
    pub low: i64,
    /// The greatest.
    pub high: i64,
}

/// How deep a function's values are looked into: a choice looks both ways.
const MAX_DEPTH: u32 = 6;

impl Bounds {
    /// Any int.
    pub const ANY: Bounds = Bounds { low: i32::MIN as i64, high: i32::MAX as i64 };

    /// One number.
    pub fn exactly(n: i32) -> Bounds {
        Bounds { low: n.into(), high: n.into() }
    }

    /// Of a component of a value, by its function alone: any number for what it is given.
    pub fn within(function: &Function, value: Value, component: u8) -> Bounds {
        within(function, value, component, 0)
    }

    /// Of a component of what an operation gives; `of` tells those of a component of an operand.
    pub fn of(operation: &Operation, component: u8, mut of: impl FnMut(Value, u8) -> Bounds) -> Bounds {
        let found = match operation {
            Operation::Constant(c) if c.scalar() == Scalar::Int => {
                Bounds::exactly(c.int(usize::from(component)))
            }
            Operation::Compose(parts) => {
                parts.get(usize::from(component)).map_or(Bounds::ANY, |part| of(*part, 0))
            }
            Operation::Extract(vector, i) => of(*vector, *i),
            Operation::Select(_, yes, no) => of(*yes, component).either(of(*no, component)),
            Operation::Builtin(intrinsic, arguments) => {
                let mut all = [Bounds::ANY; 3];
                all.iter_mut().zip(arguments.iter()).for_each(|(bounds, v)| *bounds = of(*v, component));
                arithmetic(*intrinsic, all.get(..arguments.len()).unwrap_or(&all))
            }
            _ => Bounds::ANY,
        };
        found.without_wrap()
    }

    fn either(self, other: Bounds) -> Bounds {
        Bounds { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// What leaves the ints wraps, so it may be any.
    pub fn without_wrap(self) -> Bounds {
        let is_int = self.low >= Bounds::ANY.low && self.high <= Bounds::ANY.high && self.low <= self.high;
        if is_int { self } else { Bounds::ANY }
    }
}

fn within(function: &Function, value: Value, component: u8, depth: u32) -> Bounds {
    let operation = function.operation(value);
    if depth > MAX_DEPTH {
        return Bounds::ANY;
    }
    match operation {
        Operation::Builtin(TO_INT, of) => drawn(function, of[0]).unwrap_or(Bounds::ANY),
        _ => Bounds::of(operation, component, |v, i| within(function, v, i, depth + 1)),
    }
}

/// Of a random number times a known one, truncated. The random number is m/2²⁴, m below 2²⁴: times a
/// power of two it stays exact, so it stays below that power. Times any other n it may come out as n,
/// as a shader rounds either way.
fn drawn(function: &Function, product: Value) -> Option<Bounds> {
    let Operation::Builtin(MULTIPLY, factors) = function.operation(product) else { return None };
    let Operation::Extract(random, _) = function.operation(factors[0]) else { return None };
    let Operation::Builtin(HASH | HASH4, _) = function.operation(*random) else { return None };
    let Operation::Constant(count) = function.operation(factors[1]) else { return None };
    let count = count.float(0);
    let most = count as i64;
    if !(1.0..=65_536.0).contains(&count) || count != most as f32 {
        return None;
    }
    let last = if (most as u32).is_power_of_two() { most - 1 } else { most };
    Some(Bounds { low: 0, high: last })
}

fn arithmetic(intrinsic: Intrinsic, v: &[Bounds]) -> Bounds {
    match (intrinsic, v) {
        (ADD_INT, [a, b]) => Bounds { low: a.low + b.low, high: a.high + b.high },
        (SUBTRACT_INT, [a, b]) => Bounds { low: a.low - b.high, high: a.high - b.low },
        (NEGATE_INT, [a]) => Bounds { low: -a.high, high: -a.low },
        (MULTIPLY_INT, [a, b]) => {
            let products = [a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high];
            let (low, high) = products
                .iter()
                .fold((i64::MAX, i64::MIN), |(low, high), product| (low.min(*product), high.max(*product)));
            Bounds { low, high }
        }
        (MINIMUM_INT, [a, b]) => Bounds { low: a.low.min(b.low), high: a.high.min(b.high) },
        (MAXIMUM_INT, [a, b]) => Bounds { low: a.low.max(b.low), high: a.high.max(b.high) },
        (CLAMP_INT, [x, low, high]) => {
            Bounds { low: x.low.max(low.low).min(high.low), high: x.high.max(low.high).min(high.high) }
        }
        (ABSOLUTE_INT, [a]) if a.low > Bounds::ANY.low => {
            Bounds { low: a.low.max(-a.high).max(0), high: a.high.max(-a.low) }
        }
        (REMAINDER_INT, [_, b]) if b.low > 0 => Bounds { low: 0, high: b.high - 1 },
        (DIVIDE_INT, [a, b]) if b.low > 0 => Bounds {
            low: a.low.div_euclid(if a.low < 0 { b.low } else { b.high }),
            high: a.high.div_euclid(if a.high < 0 { b.high } else { b.low }),
        },
        (BITS, [_, _, count]) if (0..31).contains(&count.high) => {
            Bounds { low: 0, high: (1 << count.high) - 1 }
        }
        _ => Bounds::ANY,
    }
}
