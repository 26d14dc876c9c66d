//! What becomes of one component of a value where the place moves by one period.

use super::{Amount, Atoms, Why};
use crate::graph::{Constant, Scalar};

/// What becomes of a component where the place moves by one period along an axis.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Shift {
    /// A known number, one component.
    Known(Constant),
    /// The same number everywhere, which only drawing tells.
    Uniform(Amount),
    /// It repeats. What is `whole` is a whole number, and has no derivative.
    Same {
        /// A whole number.
        whole: bool,
    },
    /// It is greater by this, which is not 0.
    Moves {
        /// By how much.
        by: Amount,
        /// A whole number.
        whole: bool,
    },
    /// It is greater by this times a whole number, which may differ from place to place.
    Varies {
        /// The step.
        by: Amount,
        /// A whole number.
        whole: bool,
    },
    /// Nothing is known; the number is that of the culprit.
    Broken(u32),
}

impl Shift {
    /// A known float.
    pub fn float(x: f32) -> Shift {
        Shift::Known(Constant::floats(&[x]))
    }

    /// A known int.
    pub fn int(x: i32) -> Shift {
        Shift::Known(Constant::ints(&[x]))
    }

    /// What it is, where that is the same everywhere.
    pub fn amount(&self) -> Option<Amount> {
        match self {
            Shift::Known(c) => Some(Amount::number(match c.scalar() {
                Scalar::Float => c.float(0).into(),
                Scalar::Int | Scalar::Bool => c.int(0).into(),
            })),
            Shift::Uniform(amount) => Some(amount.clone()),
            _ => None,
        }
    }

    /// The known truth.
    pub fn truth(&self) -> Option<bool> {
        match self {
            Shift::Known(c) => Some(c.bool(0)),
            _ => None,
        }
    }

    /// Whether it is a whole number without a derivative.
    pub fn is_whole(&self, atoms: &Atoms) -> bool {
        match self {
            Shift::Known(_) | Shift::Uniform(_) => self.amount().is_some_and(|amount| amount.is_whole(atoms)),
            Shift::Same { whole } | Shift::Moves { whole, .. } | Shift::Varies { whole, .. } => *whole,
            Shift::Broken(_) => false,
        }
    }

    /// Whether it repeats.
    pub fn repeats(&self) -> bool {
        matches!(self, Shift::Known(_) | Shift::Uniform(_) | Shift::Same { .. })
    }

    /// How much greater it is, exactly: 0 where it repeats. None where that differs.
    pub fn exact(&self) -> Option<Amount> {
        match self {
            Shift::Moves { by, .. } => Some(by.clone()),
            Shift::Varies { .. } | Shift::Broken(_) => None,
            _ => Some(Amount::default()),
        }
    }

    /// What it is greater by a multiple of: 0 where it repeats.
    pub fn step(&self) -> Amount {
        match self {
            Shift::Moves { by, .. } | Shift::Varies { by, .. } => by.clone(),
            _ => Amount::default(),
        }
    }

    /// How it moves, in the words of an error.
    pub fn show(&self, atoms: &Atoms) -> String {
        match self {
            Shift::Varies { by, .. } => {
                let is_negative = by.as_number().is_some_and(|number| number < 0.0);
                let by = if is_negative { by.negative() } else { by.clone() };
                format!("multiples of {}", by.show(atoms))
            }
            _ => self.step().show(atoms),
        }
    }

    /// What is greater by exactly so much.
    pub fn moving(by: Amount, whole: bool) -> Shift {
        if by.is_zero() { Shift::Same { whole } } else { Shift::Moves { by, whole } }
    }

    /// What is greater by a multiple of so much.
    pub fn varying(by: Amount, whole: bool) -> Shift {
        if by.is_zero() { Shift::Same { whole } } else { Shift::Varies { by, whole } }
    }

    /// Either of two, one here and the other there, alike a period apart.
    ///
    /// # Errors
    /// They move by amounts that have no common measure.
    pub fn or(&self, other: &Shift, atoms: &Atoms) -> Result<Shift, Why> {
        if self == other {
            return Ok(self.clone());
        }
        if let Shift::Broken(_) = self {
            return Ok(self.clone());
        }
        if let Shift::Broken(_) = other {
            return Ok(other.clone());
        }
        let whole = self.is_whole(atoms) && other.is_whole(atoms);
        match (self.exact(), other.exact()) {
            (Some(a), Some(b)) if a == b => Ok(Shift::moving(a, whole)),
            _ => {
                let measure = common(&self.step(), &other.step(), atoms);
                let unlike = || Why::Unlike { by: self.show(atoms), other: other.show(atoms) };
                measure.map(|by| Shift::varying(by, whole)).ok_or_else(unlike)
            }
        }
    }

    /// The sum, or the difference.
    ///
    /// # Errors
    /// Their steps have no common measure, or sums become too long.
    pub fn plus(&self, other: &Shift, is_difference: bool, atoms: &Atoms) -> Result<Shift, Why> {
        let signed = |amount: Amount| if is_difference { amount.negative() } else { amount };
        let sum = |a: Amount, b: Amount| a.plus(&signed(b));
        let whole = self.is_whole(atoms) && other.is_whole(atoms);
        if let (Some(a), Some(b)) = (self.amount(), other.amount()) {
            return Ok(sum(a, b).map_or(Shift::Same { whole }, Shift::Uniform));
        }
        let moved = match (self.exact(), other.exact()) {
            (Some(a), Some(b)) => sum(a, b).map(|by| Shift::moving(by, whole)),
            _ => common(&self.step(), &other.step(), atoms).map(|by| Shift::varying(by, whole)),
        };
        moved.ok_or_else(|| Why::Unlike { by: self.show(atoms), other: other.show(atoms) })
    }

    /// The product.
    ///
    /// # Errors
    /// It moves by what differs from place to place.
    pub fn times(&self, other: &Shift, atoms: &Atoms) -> Result<Shift, Why> {
        let whole = self.is_whole(atoms) && other.is_whole(atoms);
        match (self.amount(), other.amount()) {
            (Some(a), Some(b)) => return Ok(a.times(&b).map_or(Shift::Same { whole }, Shift::Uniform)),
            (Some(factor), None) => return other.scaled(&factor, whole),
            (None, Some(factor)) => return self.scaled(&factor, whole),
            (None, None) => {}
        }
        let (a, b) = (self.step(), other.step());
        let by = match (a.is_zero(), b.is_zero()) {
            (true, true) => Some(Amount::default()),
            // A whole number of steps more.
            (false, true) => other.is_whole(atoms).then_some(a),
            (true, false) => self.is_whole(atoms).then_some(b),
            (false, false) => common(&a, &b, atoms).filter(|_| whole),
        };
        let moving = if self.repeats() { other } else { self };
        by.map(|by| Shift::varying(by, whole)).ok_or_else(|| Why::Product { by: moving.show(atoms) })
    }

    /// Times what is the same everywhere.
    fn scaled(&self, factor: &Amount, whole: bool) -> Result<Shift, Why> {
        if factor.as_number().is_some_and(is_left_of_a_quarter) {
            return Ok(Shift::Same { whole });
        }
        let by = |by: &Amount| by.times(factor).ok_or(Why::TooLong);
        match self {
            Shift::Moves { by: step, .. } => Ok(Shift::moving(by(step)?, whole)),
            Shift::Varies { by: step, .. } => Ok(Shift::varying(by(step)?, whole)),
            _ => Ok(Shift::Same { whole }),
        }
    }
}

/// A common measure of two amounts, either of which may be 0.
fn common(a: &Amount, b: &Amount, atoms: &Atoms) -> Option<Amount> {
    match (a.is_zero(), b.is_zero()) {
        (true, _) => Some(b.clone()),
        (_, true) => Some(a.clone()),
        _ => a.measure(b, atoms),
    }
}

/// Whether a number is what the rounding of π leaves of a sine or cosine of quarter turns, which is
/// meant to be 0: so a turn by `0.25turn` is one.
fn is_left_of_a_quarter(x: f64) -> bool {
    const TURN: f32 = std::f32::consts::TAU;
    let zeros = [libm::cosf(TURN * 0.25), libm::sinf(TURN * 0.5), libm::cosf(TURN * 0.75), libm::sinf(TURN)];
    zeros.iter().any(|zero| f64::from(zero.abs()) == x.abs())
}
