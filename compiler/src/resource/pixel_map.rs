//! `pixel_map`: a mask of which only the blocks along its contour are stored (Kraus & Ertl, Adaptive
//! Texture Maps, Graphics Hardware 2002; pixel map in Lefebvre & Neyret 2003, §3.3).

use super::{Arguments, Made};
use crate::diagnostic::{Diagnostic, constructors};
use crate::graph::Constant;
use crate::manifest::Recipe;

/// Texels along a side of a block.
const BLOCKS: [i32; 5] = [4, 8, 16, 32, 64];

/// The recipe of a constructor call.
///
/// # Errors
/// A block that is no power of two from 4 to 64; levels that are not 2 to 256.
pub fn make(a: &Arguments) -> Result<Made, Diagnostic> {
    let block = a.count("block", BLOCKS[0], BLOCKS[4])?;
    if !block.is_power_of_two() {
        return Err(constructors::no_power_of_two(a.place("block"), "block", block));
    }
    let levels = a.count("levels", 2, 256)?;
    let depth = depth(levels);
    let path = a.paths("path").into_iter().next().unwrap_or_default();
    let fields = [("block", block), ("levels", levels), ("depth", depth), ("across", across(block, depth))];
    Ok(Made {
        recipe: Recipe::PixelMap { path, block, levels },
        constants: fields.map(|(name, value)| (name, Constant::ints(&[value as i32]))).into(),
        sampler: None,
        lender: None,
    })
}

/// Bits of a texel in the pool: 1, 2, 4 or 8, the least that hold so many levels.
pub fn depth(levels: u32) -> u32 {
    [1, 2, 4].into_iter().find(|bits| levels <= 1 << bits).unwrap_or(8)
}

/// Blocks in a row of the pool, whose texels are 128 bits; a row has at most 4096. `block` is 4 to 64.
pub fn across(block: u32, depth: u32) -> u32 {
    4096 / texels(block, depth)
}

/// Texels of the pool for a block, at least 1.
pub fn texels(block: u32, depth: u32) -> u32 {
    block.saturating_mul(block).saturating_mul(depth).div_ceil(128).max(1)
}
