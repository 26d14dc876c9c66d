//! Operations on numbers by what they take a graphics processor.

use crate::graph::{Scalar, Type};
use crate::intrinsic::{Form, Intrinsic};
use serde::Serialize;

/// Operations by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Arithmetic {
    /// Sums and products of floats, and roundings.
    pub add: f64,
    /// Quotients, of ints too.
    pub divide: f64,
    /// Roots, powers, logarithms, angles.
    pub transcendental: f64,
    /// Ints: sums, products, shifts, conversions, places in constant tables.
    pub integer: f64,
    /// Comparisons, choices, the lesser and the greater.
    pub compare: f64,
    /// pcg4d, each about twenty operations on ints.
    pub hash: f64,
    /// All kinds together.
    pub total: f64,
}

impl Arithmetic {
    /// Each kind with a name for people, without the total.
    pub fn kinds(&self) -> [(&'static str, f64); 6] {
        [
            ("add, multiply", self.add),
            ("divide", self.divide),
            ("transcendental", self.transcendental),
            ("integer", self.integer),
            ("compare, choose", self.compare),
            ("hash", self.hash),
        ]
    }

    /// Figure by figure.
    pub fn zip(&self, other: &Arithmetic, f: impl Fn(f64, f64) -> f64) -> Arithmetic {
        Arithmetic {
            add: f(self.add, other.add),
            divide: f(self.divide, other.divide),
            transcendental: f(self.transcendental, other.transcendental),
            integer: f(self.integer, other.integer),
            compare: f(self.compare, other.compare),
            hash: f(self.hash, other.hash),
            total: f(self.total, other.total),
        }
    }

    fn of(kinds: &[(Kind, u32)]) -> Arithmetic {
        let mut arithmetic = Arithmetic::default();
        for (kind, count) in kinds {
            let count = f64::from(*count);
            *match kind {
                Kind::Add => &mut arithmetic.add,
                Kind::Divide => &mut arithmetic.divide,
                Kind::Transcendental => &mut arithmetic.transcendental,
                Kind::Integer => &mut arithmetic.integer,
                Kind::Compare => &mut arithmetic.compare,
                Kind::Hash => &mut arithmetic.hash,
            } += count;
            arithmetic.total += count;
        }
        arithmetic
    }

    /// A choice between two values of so many components.
    pub fn choice(width: u8) -> Arithmetic {
        Arithmetic::of(&[(Kind::Compare, u32::from(width))])
    }

    /// A place in a constant table.
    pub fn lookup() -> Arithmetic {
        Arithmetic::of(&[(Kind::Integer, 1)])
    }

    /// A screen derivative of so many components.
    pub fn derivative(width: u8) -> Arithmetic {
        Arithmetic::of(&[(Kind::Add, u32::from(width))])
    }

    /// An intrinsic of arguments of these types.
    pub fn intrinsic(intrinsic: Intrinsic, arguments: &[Type]) -> Arithmetic {
        let width = arguments.iter().map(|ty| u32::from(ty.width())).max().unwrap_or(1);
        let scalar = arguments.first().and_then(|ty| ty.scalar()).unwrap_or(Scalar::Float);
        match intrinsic.row().form {
            Form::Operator(symbol) => Arithmetic::of(&[(operator(symbol, scalar), width)]),
            Form::Function(name) => Arithmetic::of(&function(name, scalar, width)),
            Form::Convert => Arithmetic::of(&[(Kind::Integer, width)]),
            Form::All | Form::Choose => Arithmetic::of(&[(Kind::Compare, width)]),
            Form::Helper(_) => Arithmetic::of(&[(Kind::Hash, 1)]),
            // Expanded before anything is counted.
            Form::Expand(_) => Arithmetic::of(&[(Kind::Add, width)]),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Add,
    Divide,
    Transcendental,
    Integer,
    Compare,
    Hash,
}

fn operator(symbol: &str, scalar: Scalar) -> Kind {
    match (symbol, scalar) {
        (_, Scalar::Bool) | ("<" | "<=" | ">" | ">=" | "==" | "!=", _) => Kind::Compare,
        ("/" | "%", _) => Kind::Divide,
        (_, Scalar::Int) => Kind::Integer,
        (_, Scalar::Float) => Kind::Add,
    }
}

/// Functions of the shader language, by their name in it.
fn function(name: &str, scalar: Scalar, width: u32) -> Vec<(Kind, u32)> {
    let plain = if scalar == Scalar::Int { Kind::Integer } else { Kind::Add };
    // A product of every component, and the sums between them.
    let dot = (Kind::Add, 2 * width - 1);
    match name {
        "dot" => vec![dot],
        "length" => vec![dot, (Kind::Transcendental, 1)],
        "cross" => vec![(Kind::Add, 9)],
        "clamp" => vec![(Kind::Compare, 2 * width)],
        // (x - low)/(high - low), clamped, and its cubic.
        "smoothstep" => vec![(Kind::Divide, width), (Kind::Compare, 2 * width), (Kind::Add, 6 * width)],
        "min" | "max" | "sign" => vec![(Kind::Compare, width)],
        "floor" | "ceil" | "round" | "fract" | "abs" => vec![(plain, width)],
        _ => vec![(Kind::Transcendental, width)],
    }
}

#[cfg(test)]
mod tests {
    use super::{Arithmetic, function};
    use crate::graph::{Scalar, Type};
    use crate::intrinsic::{ADD, ADD_INT, Form, Intrinsic, LESS};

    #[test]
    fn every_function_of_the_table_is_of_its_kind() {
        let transcendental =
            ["sin", "cos", "exp", "exp2", "log", "log2", "pow", "sqrt", "asin", "acos", "atan2"];
        for intrinsic in Intrinsic::all() {
            if let Form::Function(name) = intrinsic.row().form {
                let kinds = function(name, Scalar::Float, 3);
                let is_transcendental = kinds == [(super::Kind::Transcendental, 3)];
                assert_eq!(is_transcendental, transcendental.contains(&name), "{name}");
            }
        }
    }

    #[test]
    fn vectors_count_their_components() {
        let vec3 = Type::Vector(Scalar::Float, 3);
        let ivec2 = Type::Vector(Scalar::Int, 2);
        assert_eq!(Arithmetic::intrinsic(ADD, &[vec3, vec3]).add, 3.0);
        assert_eq!(Arithmetic::intrinsic(ADD_INT, &[ivec2, ivec2]).integer, 2.0);
        assert_eq!(Arithmetic::intrinsic(LESS, &[Type::FLOAT, Type::FLOAT]).compare, 1.0);
        let length = Arithmetic::of(&function("length", Scalar::Float, 3));
        assert_eq!((length.add, length.transcendental, length.total), (5.0, 1.0, 6.0));
    }
}
