//! Fused rows: what a function of the library computes, in one pass over the lanes.
//!
//! A step is a loop over the lanes of a batch, so whatever it computes goes through the cache. A
//! noise is some hundred steps; as one loop its values stay in vector registers. `rows` holds such
//! loops. They are made of the planned steps of nodes (`write`, a test, makes them and fails where they
//! are stale), by the functions that define the intrinsics, so a fused row has the bits of what it
//! stands for.
//!
//! A planned function is known by the hash of its steps, whatever graph it is in. Constants that
//! differ from use to use, seeds and periods, are *free*: the row takes them as further arguments.

#[cfg(test)]
mod range;
#[rustfmt::skip]
mod rows;
mod shape;
#[cfg(test)]
mod write;

use super::mask::Mask;
use super::plan::{Fused, Planned, Register, Step};
use super::planner::Fuse;
use rows::ROWS;
use shape::Shape;
use texgraph_compiler::intrinsic::{self, Evaluate, LANES, Lanes, pcg4d, row_of, wide};

/// The most components of inputs, and free constants, of a row.
pub const MOST_ARGUMENTS: usize = 24;
/// The most components of outputs of a row.
pub const MOST_OUTPUTS: usize = 8;

/// Lanes that are computed together; those in which nobody is interested are left out.
const CHUNK: usize = 16;

/// A function of the library in one loop.
pub struct Row {
    /// The node's name.
    pub name: &'static str,
    /// How many components its inputs have, ...
    inputs: usize,
    /// ... and how many operations it stands for.
    operations: usize,
    /// Of those, see [`Shape::hash`].
    hash: u128,
    /// The free constants: of each, where among the function's constants it stands.
    free: &'static [&'static [u16]],
    /// Computes the outputs where the mask has lanes; others are anything.
    pub run: fn(&[&Lanes; MOST_ARGUMENTS], Mask, &mut [Box<Lanes>; MOST_OUTPUTS]),
}

/// Makes the steps of `rows`.
pub struct Rows;

impl Fuse for Rows {
    fn knows(&self, name: &str) -> bool {
        ROWS.iter().any(|row| row.name == name)
    }

    fn fuse(&mut self, name: &str, planned: &mut Planned, known: &[Lanes], registers: &mut usize) -> bool {
        let Some(shape) = Shape::of(planned, known) else { return false };
        let row = ROWS.iter().find(|row| row.name == name && shape.is(row));
        let Some(row) = row else { return false };
        let inputs = (0..planned.inputs as u32).map(Register::Frame);
        let free = row.free.iter().filter_map(|places| Some(shape.constant(*places.first()?)));
        let arguments = inputs.chain(free).collect();
        let outputs = *registers as u32..(*registers + planned.outputs.len()) as u32;
        *registers = outputs.end as usize;
        planned.outputs = outputs.map(Register::Frame).collect();
        let to = planned.outputs.iter().copied().map(Some).collect();
        planned.steps = vec![Step::Fused(Box::new(Fused { row, arguments, to }))];
        true
    }
}

/// A row's function of one component, for the code of `rows`, which makes values finite where they
/// may be something else.
const fn each(name: &str, overload: usize) -> fn([u32; 3]) -> u32 {
    match row_of(name, overload) {
        Evaluate::Each { raw, .. } => *raw,
        Evaluate::Whole { .. } => panic!("a row of whole arguments"),
    }
}

/// A row's function of whole arguments, for the code of `rows`.
const fn whole(name: &str, overload: usize) -> fn(usize, [[u32; 4]; 2]) -> [u32; 4] {
    match row_of(name, overload) {
        Evaluate::Whole { raw, .. } => *raw,
        Evaluate::Each { .. } => panic!("a row of components"),
    }
}

/// A float's bits made finite, as every row's value is.
#[inline(always)]
fn finite(bits: u32) -> u32 {
    intrinsic::finite(f32::from_bits(bits)).to_bits()
}

/// The int of a float without a fraction.
#[inline(always)]
fn whole_int(bits: u32) -> u32 {
    intrinsic::whole_to_int(f32::from_bits(bits)) as u32
}

/// The int of a float without a fraction, of less than 2²²: the sum's bits count on from those of its
/// second term.
#[inline(always)]
fn small_int(bits: u32) -> u32 {
    const HALF_WAY: f32 = 12_582_912.0;
    (f32::from_bits(bits) + HALF_WAY).to_bits().wrapping_sub(HALF_WAY.to_bits())
}

/// The second where the first holds, else the third.
#[inline(always)]
fn choose(condition: u32, yes: u32, no: u32) -> u32 {
    if condition != 0 { yes } else { no }
}

/// Runs a function of `I` words that gives `O` in all chunks with wanted lanes.
#[inline(always)]
fn run<const I: usize, const O: usize>(
    arguments: &[&Lanes; MOST_ARGUMENTS],
    mask: Mask,
    out: &mut [Box<Lanes>; MOST_OUTPUTS],
    f: impl Fn([u32; I]) -> [u32; O],
) {
    wide(
        #[inline(always)]
        move || {
            for chunk in 0..LANES / CHUNK {
                if (mask >> (chunk * CHUNK)) as u16 == 0 {
                    continue;
                }
                let from: [&[u32; CHUNK]; I] = std::array::from_fn(|k| &arguments[k].as_chunks().0[chunk]);
                let mut made = [[0; CHUNK]; O];
                for i in 0..CHUNK {
                    let mut words = [0; I];
                    for k in 0..I {
                        words[k] = from[k][i];
                    }
                    let words = f(words);
                    for k in 0..O {
                        made[k][i] = words[k];
                    }
                }
                for (to, made) in out.iter_mut().zip(made) {
                    to.as_chunks_mut().0[chunk] = made;
                }
            }
        },
    );
}
