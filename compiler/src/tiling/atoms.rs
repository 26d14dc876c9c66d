//! Numbers that are the same everywhere in a picture, but not known before it is drawn: params, the
//! time, sizes of textures, and what is worked out of these.

use super::Amount;
use crate::graph::{ParamId, ViewId};
use rustc_hash::FxHashMap;

/// All atoms of a program, numbered in the order they are met in.
#[derive(Default)]
pub struct Atoms {
    all: Vec<Atom>,
    numbers: FxHashMap<Source, u32>,
}

struct Atom {
    name: String,
    is_int: bool,
    bounds: (f64, f64),
}

/// What an atom is: equal sources are the same number.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Source {
    /// A component of a param.
    Param(ParamId, u8),
    /// A component of an input that is the same for a whole draw.
    Input(u32, u8),
    /// The size of a texture along an axis.
    Size(ViewId, u8),
    /// What an operation, by the index of its row, gives for such operands; a component of it.
    Of(usize, Vec<Amount>, u8),
    /// The second where the first is not 0, else the third.
    Choice(Box<[Amount; 3]>),
}

impl Atoms {
    /// The number of an atom; `make` gives its name, whether it is an int, and what it may be.
    pub fn of(&mut self, source: Source, make: impl FnOnce() -> (String, bool, (f64, f64))) -> Amount {
        if let Some(number) = self.numbers.get(&source) {
            return Amount::atom(*number);
        }
        let number = self.all.len() as u32;
        let (name, is_int, bounds) = make();
        self.all.push(Atom { name, is_int, bounds });
        self.numbers.insert(source, number);
        Amount::atom(number)
    }

    /// Whether it is a whole number.
    pub fn is_int(&self, atom: u32) -> bool {
        self.all.get(atom as usize).is_some_and(|atom| atom.is_int)
    }

    /// What it may be.
    pub fn bounds(&self, atom: u32) -> (f64, f64) {
        self.all.get(atom as usize).map_or((f64::NEG_INFINITY, f64::INFINITY), |atom| atom.bounds)
    }

    /// What the author calls it.
    pub fn name(&self, atom: u32) -> String {
        self.all.get(atom as usize).map_or(String::new(), |atom| atom.name.clone())
    }
}
