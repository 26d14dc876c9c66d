//! Tileability: what of a texture repeats where `uv` moves by a period, proved by a walk over its
//! graph.
//!
//! Axis by axis, every component of every value is worked out as a [`Shift`]: it repeats, it moves by
//! a known amount, it moves by whole multiples of one, or something broke it, which is then the
//! *culprit*. How an intrinsic shifts is in its row of the table. A function is walked once for each
//! set of arguments that it is called with; the steps of a loop are walked one by one, or, where they
//! are many, until nothing changes any more. Amounts may hold params and sizes that only drawing
//! tells, so `ifloor(uv * cells) % cells` repeats whatever `cells` is.
//!
//! What is proved is of real numbers: floats round, and ints are taken not to wrap. What repeats so
//! has derivatives that do too: a value that is [`Shift::Same`] has the same tangent a period on,
//! because steps that may differ from place to place are whole numbers, which have none.

mod amount;
mod atoms;
mod shift;
mod walk;

#[cfg(test)]
pub use amount::near_whole;
pub use amount::{Amount, show_number};
pub use atoms::{Atoms, Source};
pub use shift::Shift;
pub use walk::Walk;

use crate::graph::Place;
use smol_str::SmolStr;

/// What breaks a period.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Culprit {
    /// The call or operator.
    pub place: Place,
    /// The node, intrinsic or output.
    pub name: SmolStr,
    /// The reason.
    pub why: Why,
    /// What it is that breaks.
    pub kind: What,
}

/// What a culprit is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum What {
    /// An operation of the author's own.
    Operation,
    /// A node of the library, called there.
    Node,
    /// An output, which gets what moves.
    Output,
}

/// Why something does not repeat; amounts are in the words of an error.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Why {
    /// It takes only what repeats, and is given what moves by this.
    Moves {
        /// The amount.
        by: String,
    },
    /// It takes what moves by multiples of an amount only.
    NotMultiple {
        /// The amount that it moves by.
        by: String,
        /// What it should be a multiple of.
        of: String,
    },
    /// Its operands move by different amounts.
    Apart {
        /// Of one.
        by: String,
        /// Of another.
        other: String,
    },
    /// Its operands move by amounts without a common measure.
    Unlike {
        /// Of one.
        by: String,
        /// Of another.
        other: String,
    },
    /// What moves is multiplied by what differs from place to place.
    Product {
        /// The amount of what moves.
        by: String,
    },
    /// What moves is cut off towards 0.
    Truncates {
        /// The amount.
        by: String,
    },
    /// A picture that does not repeat is read at what moves.
    Wrap {
        /// The amount.
        by: String,
    },
    /// Ints wrap within few periods.
    Wraps,
    /// It takes too long to find out.
    TooLong,
}
