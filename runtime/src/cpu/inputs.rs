//! The inputs of a texture, for the pixels of a batch.

use crate::flat::Rise;
use texgraph_compiler::intrinsic::{LANES, Lanes, wide};

/// Gives the component of an input its values at the centres of the pixels of a picture from one on, row
/// by row.
pub fn fill(rise: Rise, first: usize, width: usize, lanes: &mut Lanes) {
    let (mut column, mut row, mut from) = (first % width, first / width, 0);
    while from < LANES {
        let to = LANES.min(from + width - column);
        fill_row(rise, column as u32, row as u32, &mut lanes[from..to]);
        (column, row, from) = (0, row + 1, to);
    }
}

/// The same of pixels in one row.
fn fill_row(rise: Rise, column: u32, row: u32, lanes: &mut [u32]) {
    if rise.is_constant_across() {
        return lanes.fill(at(rise, column, row));
    }
    wide(
        #[inline(always)]
        move || {
            for (to, i) in lanes.iter_mut().zip(0..) {
                *to = at(rise, column + i, row);
            }
        },
    );
}

/// What it is at the centre of a pixel.
#[inline(always)]
fn at(rise: Rise, column: u32, row: u32) -> u32 {
    rise.at(f64::from(column) + 0.5, f64::from(row) + 0.5).to_bits()
}
