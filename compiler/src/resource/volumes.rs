//! Patterns in space: how slices make blocks.

use super::{Arguments, Cells, MAX_LAYERS, Made, SamplerState, pattern_constants};
use crate::diagnostic::{Diagnostic, constructors};
use crate::graph::Constant;
use crate::manifest::{Recipe, Wrap};

/// The slices are the cells of the pictures, one after the other; `depth` of them make a pattern.
pub fn make(a: &Arguments) -> Result<Made, Diagnostic> {
    let Cells { paths, grid, count, place } = Cells::of(a)?;
    let depth = a.count("depth", 1, MAX_LAYERS as i32)?;
    if count % i64::from(depth) != 0 {
        return Err(constructors::uneven_depth(a.place("depth"), depth, count));
    }
    if !(1..=MAX_LAYERS).contains(&count) {
        return Err(constructors::too_many_slices(
            place,
            count,
            format!("{} patterns of {depth} slices each", count / i64::from(depth)),
        ));
    }
    let mut constants = pattern_constants(a, count / i64::from(depth), 1);
    constants.push(("depth", Constant::ints(&[depth as i32])));
    constants.push(("total", Constant::ints(&[count as i32])));
    let recipe = Recipe::Volumes { paths, grid, depth, encoding: a.encoding() };
    let sampler = SamplerState { wrap: Wrap::Clamp, filter: a.filter(), anisotropy: 1 };
    Ok(Made { recipe, constants, sampler: Some(sampler), lender: None })
}
