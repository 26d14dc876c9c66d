//! Patterns on a line: rows of texels.

use super::{Arguments, Cells, MAX_LAYERS, Made, SamplerState, pattern_constants};
use crate::diagnostic::{Diagnostic, constructors};
use crate::manifest::{Recipe, Wrap};

/// The strips are the cells of the pictures, which only loading finds to be one texel high.
pub fn make(a: &Arguments) -> Result<Made, Diagnostic> {
    let Cells { paths, grid, count, place } = Cells::of(a)?;
    if !(1..=MAX_LAYERS).contains(&count) {
        return Err(constructors::too_many_patterns(place, count));
    }
    let sampler = SamplerState { wrap: Wrap::Clamp, filter: a.filter(), anisotropy: 1 };
    Ok(Made {
        constants: pattern_constants(a, count, 1),
        recipe: Recipe::Strips { paths, grid, encoding: a.encoding() },
        sampler: Some(sampler),
        lender: None,
    })
}
