//! Between what and what the floats of a function lie: where they surely are finite, nothing has to
//! make them so.

use super::shape::{Operand, Operation, Shape};
use texgraph_compiler::graph::Scalar;

/// In how many pieces a fraction is looked at: what is computed of it alone is known the better.
const PIECES: usize = 32;

/// An interval, and whether what lies in it has no fraction.
#[derive(Clone, Copy)]
struct Piece {
    low: f64,
    high: f64,
    whole: bool,
}

impl Piece {
    /// Of exact ends.
    fn exact(low: f64, high: f64, whole: bool) -> Piece {
        Piece { low, high, whole }
    }

    /// That of the least and the greatest of some numbers, and what rounding adds.
    fn of<const N: usize>(ends: [f64; N], whole: bool) -> Piece {
        let [low, high] = [f64::min, f64::max].map(|end| ends.into_iter().reduce(end).unwrap_or(0.0));
        let exact = whole && low.abs().max(high.abs()) < 16_777_216.0;
        let more = if exact { 0.0 } else { 1e-6 };
        Piece { low: low - low.abs() * more, high: high + high.abs() * more, whole: exact }
    }

    fn hull(self, other: Piece) -> Piece {
        Piece::exact(self.low.min(other.low), self.high.max(other.high), self.whole && other.whole)
    }

    fn negative(self) -> Piece {
        Piece::exact(-self.high, -self.low, self.whole)
    }

    fn absolute(self) -> Piece {
        let low = if self.low > 0.0 { self.low } else { (-self.high).max(0.0) };
        Piece::exact(low, self.high.max(-self.low), self.whole)
    }

    fn plus(self, other: Piece) -> Piece {
        Piece::of([self.low + other.low, self.high + other.high], self.whole && other.whole)
    }

    fn times(self, other: Piece) -> Piece {
        let ends =
            [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        Piece::of(ends, self.whole && other.whole)
    }
}

/// Where a float lies: in an interval, or in one for each piece of a fraction that it depends on.
#[derive(Clone)]
pub struct Range {
    /// The value that the pieces are of.
    of: Option<u32>,
    pieces: Vec<Piece>,
}

impl Range {
    /// Of a float of which nothing is known.
    pub fn any() -> Range {
        let most = f64::from(f32::MAX);
        Range::one(Piece::exact(-most, most, false))
    }

    fn one(piece: Piece) -> Range {
        Range { of: None, pieces: vec![piece] }
    }

    /// Of the fraction that is a value.
    fn fraction(value: u32) -> Range {
        let end = |k: usize| k as f64 / PIECES as f64;
        let pieces = (0..PIECES).map(|k| Piece::exact(end(k), end(k + 1), false)).collect();
        Range { of: Some(value), pieces }
    }

    /// Whether a float surely is finite, though each operation before it was rounded.
    pub fn is_finite(&self) -> bool {
        let most = f64::from(f32::MAX);
        self.pieces.iter().all(|piece| piece.low >= -most && piece.high <= most)
    }

    /// Whether a float surely has no fraction.
    pub fn is_whole(&self) -> bool {
        self.pieces.iter().all(|piece| piece.whole)
    }

    /// Whether a float surely is nearer to 0.
    pub fn is_below(&self, bound: f64) -> bool {
        self.pieces.iter().all(|piece| piece.low > -bound && piece.high < bound)
    }

    fn all(&self) -> Piece {
        self.pieces.iter().copied().reduce(Piece::hull).unwrap_or(Piece::exact(0.0, 0.0, true))
    }

    fn map(&self, f: impl Fn(Piece) -> Piece) -> Range {
        Range { of: self.of, pieces: self.pieces.iter().map(|piece| f(*piece)).collect() }
    }

    fn with(&self, other: &Range, f: impl Fn(Piece, Piece) -> Piece) -> Range {
        match (self.of, other.of) {
            (_, None) => self.map(|piece| f(piece, other.pieces[0])),
            (None, _) => other.map(|piece| f(self.pieces[0], piece)),
            (one, two) if one == two => {
                let pieces = self.pieces.iter().zip(&other.pieces).map(|(a, b)| f(*a, *b)).collect();
                Range { of: one, pieces }
            }
            _ => Range::one(f(self.all(), other.all())),
        }
    }
}

/// Where each value lies, if it is a float.
pub fn ranges(shape: &Shape, free: &[Vec<u16>]) -> Vec<Range> {
    let mut ranges: Vec<Range> = vec![Range::any(); 4 * shape.operations.len() + 4];
    for (operation, operands, first) in &shape.operations {
        let range = |k: usize| match operands[k] {
            Operand::Value(n) => ranges[n as usize].clone(),
            Operand::Constant(place) if !free.iter().any(|places| places.contains(&place)) => {
                let value = f64::from(f32::from_bits(shape.constants[usize::from(place)].1));
                let whole = value.fract() == 0.0;
                if value.is_finite() { Range::one(Piece::exact(value, value, whole)) } else { Range::any() }
            }
            Operand::Input(_) | Operand::Constant(_) => Range::any(),
        };
        let found = match operation {
            Operation::Select => Some(range(1).with(&range(2), Piece::hull)),
            Operation::Each(row) if row.row().value.scalar() != Some(Scalar::Float) => None,
            Operation::Each(row) => match row.row().name {
                "(choose)" => Some(range(1).with(&range(2), Piece::hull)),
                "+" => Some(range(0).with(&range(1), Piece::plus)),
                "-" => Some(range(0).with(&range(1), |a, b| a.plus(b.negative()))),
                "*" => Some(range(0).with(&range(1), Piece::times)),
                // No divisor is nearer to 0 than that.
                "/" | "(/)" => Some(range(0).map(|a| {
                    Piece::exact(-1.0, 1.0, false).times(Piece::exact(0.0, a.absolute().high / 1e-37, false))
                })),
                "-x" => Some(range(0).map(Piece::negative)),
                "abs" => Some(range(0).map(Piece::absolute)),
                // The greatest floats have no fraction.
                "floor" => Some(Range::one({
                    let a = range(0).all();
                    Piece::exact(a.low.floor(), a.high, true)
                })),
                "fract" => Some(Range::fraction(*first)),
                "min" => Some(range(0).with(&range(1), |a, b| {
                    Piece::exact(a.low.min(b.low), a.high.min(b.high), a.whole && b.whole)
                })),
                "max" => Some(range(0).with(&range(1), |a, b| {
                    Piece::exact(a.low.max(b.low), a.high.max(b.high), a.whole && b.whole)
                })),
                "(float)" => Some(Range::one(Piece::exact(-2_147_483_648.0, 2_147_483_648.0, true))),
                "sqrt" | "(sqrt)" if range(0).all().low >= 0.0 => {
                    Some(Range::one(Piece::of([0.0, range(0).all().high.sqrt()], false)))
                }
                _ => None,
            },
            Operation::Whole(row, width) => {
                let product = |c: usize| range(c).all().times(range(4 + c).all());
                let square = |c: usize| range(c).all().times(range(c).all());
                let columns = 0..*width;
                match row.row().name {
                    "(hash4)" | "hash" => Some(Range::one(Piece::exact(0.0, 1.0, false))),
                    "length" | "(length)" => columns
                        .map(square)
                        .reduce(Piece::plus)
                        .map(|sum| Range::one(Piece::of([0.0, sum.high.max(0.0).sqrt()], false))),
                    "dot" | "(dot)" => columns.map(product).reduce(Piece::plus).map(Range::one),
                    _ => None,
                }
            }
        };
        let values = if matches!(operation, Operation::Whole(..)) { 4 } else { 1 };
        ranges[*first as usize..][..values].fill(found.unwrap_or_else(Range::any));
    }
    ranges
}
