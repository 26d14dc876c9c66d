//! Intrinsics: everything the language does that is not written in the language.
//!
//! One row of `table` says all about one intrinsic: its name and signature (in the language's own
//! notation), its documentation, its value (which defines it, on every machine, bit for bit), its
//! derivative, how it repeats and its form in the shader. Nothing else lists intrinsics, so a new one is a new row.
//!
//! Two kinds of rows have no name and can't be called: the *raw* operations that a shader really
//! has, undefined for some arguments, and the conversions that checking inserts. A total operation
//! is expanded into raw ones and guards by its row (see [`Form::Expand`]), so the guards are part
//! of the graph and fold away where an operand is constant.

mod derivative;
mod expand;
mod lanes;
mod table;
mod tiling;
mod value;

pub use derivative::{Tangents, zero};
pub use lanes::{LANES, Lanes, Vector, ZERO, wide};
pub use table::*;
pub use tiling::{Arguments, Tiling};
pub use value::{finite, floor, pcg4d, whole_to_int};

use crate::graph::{Builder, Constant, Scalar, Value};

/// An intrinsic: the index of its row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Intrinsic(u16);

/// All about one intrinsic.
pub struct Row {
    /// As written: a name or an operator's symbol. Rows in parentheses can't be called.
    pub name: &'static str,
    /// Dimension variables, inputs and result, as they would be written in a `.tex` file.
    pub signature: &'static str,
    /// One line for the reference.
    pub doc: &'static str,
    /// What it is worth.
    pub value: Evaluate,
    /// How it changes with its arguments.
    pub derivative: Derivative,
    /// How it repeats where its arguments do, or move.
    pub tiling: Tiling,
    /// How the shader computes it.
    pub form: Form,
}

/// The value of an intrinsic, of one value and of [`LANES`] of them by the same function. Made by
/// `each!` and `whole!`; components are bits, as a [`Constant`] holds them.
#[derive(Clone, Copy)]
pub enum Evaluate {
    /// By a function of up to three components, which applies to each on its own.
    Each {
        /// What a component of the value is; there are as many as the first argument has. None for
        /// that of the first argument.
        scalar: Option<Scalar>,
        /// Of a component of each argument.
        one: fn([u32; 3]) -> u32,
        /// The same, but a float that is not finite stays as it is.
        raw: fn([u32; 3]) -> u32,
        /// As `one`, in all lanes.
        all: fn([&Lanes; 3], &mut Lanes),
    },
    /// By a function of up to two whole arguments; the first has this width.
    Whole {
        /// What a component of the value is; none for that of the first argument.
        scalar: Option<Scalar>,
        /// Of one value.
        one: fn(usize, [Constant; 2]) -> Constant,
        /// The same of components, but a float that is not finite stays as it is.
        raw: fn(usize, [[u32; 4]; 2]) -> [u32; 4],
        /// As `one`, in all lanes.
        all: fn(usize, [Vector<'_>; 2], &mut [Lanes; 4]),
    },
}

impl Evaluate {
    /// What a component of the value is; as many as the first argument has. None where only an
    /// evaluation tells.
    pub fn component(&self) -> Option<Scalar> {
        match self {
            Evaluate::Each { scalar, .. } => *scalar,
            Evaluate::Whole { .. } => None,
        }
    }

    /// What a component of the value is, however many there are. None for that of the first argument.
    pub fn scalar(&self) -> Option<Scalar> {
        match self {
            Evaluate::Each { scalar, .. } | Evaluate::Whole { scalar, .. } => *scalar,
        }
    }
}

/// How an intrinsic changes with its arguments.
#[derive(Clone, Copy)]
pub enum Derivative {
    /// Not at all: steps, integers, hashes.
    Zero,
    /// By this rule.
    Rule(fn(&mut Tangents) -> Value),
}

/// How the shader computes an intrinsic.
#[derive(Clone, Copy)]
pub enum Form {
    /// A prefix or infix operator of the shader language.
    Operator(&'static str),
    /// A function of the shader language.
    Function(&'static str),
    /// A conversion to floats or to ints.
    Convert,
    /// All components of a bool vector hold.
    All,
    /// The component-wise choice of two vectors by a vector of bools.
    Choose,
    /// A function that the shader brings along.
    Helper(Helper),
    /// Other operations, by this rule; `arguments` are those of the call.
    Expand(fn(&mut Builder, arguments: &[Value]) -> Value),
}

/// Functions that the shader brings along.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Helper {
    /// Four ints to four floats in [0, 1): pcg4d (Jarzynski & Olano, *Hash functions for GPU
    /// rendering*, JCGT 2020).
    Hash,
}

impl Intrinsic {
    /// Every row, in order.
    pub fn all() -> impl Iterator<Item = Intrinsic> {
        (0..TABLE.len() as u16).map(Intrinsic)
    }

    /// Its place in the table.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }

    /// All about it.
    pub fn row(self) -> &'static Row {
        &TABLE[usize::from(self.0)]
    }

    /// Its value for known arguments of the types its signature asks for. Never NaN or infinite:
    /// what overflows saturates.
    pub fn evaluate(self, arguments: &[Constant]) -> Constant {
        value::evaluate(&self.row().value, arguments)
    }

    /// Whether it can be called by name or symbol.
    pub fn is_callable(self) -> bool {
        !self.row().name.starts_with('(')
    }
}

/// What the `overload`th row of that name is worth, for code that is made of rows: a call of what this
/// gives is a direct one. Fails when compiling texgraph itself where there is no such row.
pub const fn row_of(name: &str, overload: usize) -> &'static Evaluate {
    &TABLE[find(name, overload).0 as usize].value
}

/// The `overload`th row of that name, found when compiling texgraph itself.
const fn find(name: &str, overload: usize) -> Intrinsic {
    let mut i = 0;
    let mut seen = 0;
    while i < TABLE.len() {
        if same(TABLE[i].name, name) {
            if seen == overload {
                return Intrinsic(i as u16);
            }
            seen += 1;
        }
        i += 1;
    }
    panic!("no such row")
}

const fn same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    if a.len() != b.len() {
        return false;
    }
    let mut i = 0;
    while i < a.len() {
        if a[i] != b[i] {
            return false;
        }
        i += 1;
    }
    true
}
