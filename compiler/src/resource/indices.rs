//! `indices`: maps of integers, on a line, in the plane and in space.

use super::{Argument, Arguments, MAX_LAYERS, Made};
use crate::diagnostic::{Diagnostic, Place, constructors};
use crate::graph::Constant;
use crate::manifest::{IndicesSource, Recipe};

/// A row.
pub fn on_a_line(a: &Arguments) -> Result<Made, Diagnostic> {
    let (source, levels) = source(a)?;
    Ok(made(Recipe::Line { source, levels }, &[("levels", levels)]))
}

/// Rows.
pub fn in_the_plane(a: &Arguments) -> Result<Made, Diagnostic> {
    let (source, levels) = source(a)?;
    Ok(made(Recipe::Indices { source, levels }, &[("levels", levels)]))
}

/// The rows of slices one below another, all of them as high.
pub fn in_space(a: &Arguments) -> Result<Made, Diagnostic> {
    let (source, levels) = source(a)?;
    let depth = a.count("depth", 1, MAX_LAYERS as i32)?;
    if let IndicesSource::Rows(rows) = &source
        && rows.len() % depth as usize != 0
    {
        return Err(constructors::uneven_slices(a.place("depth"), depth, rows.len()));
    }
    Ok(made(Recipe::Stack { source, levels, depth }, &[("levels", levels), ("depth", depth)]))
}

fn made(recipe: Recipe, constants: &[(&'static str, u32)]) -> Made {
    let constant = |(name, value): &(&'static str, u32)| (*name, Constant::ints(&[*value as i32]));
    Made { recipe, constants: constants.iter().map(constant).collect(), sampler: None, lender: None }
}

/// Where the numbers come from, and how many there are.
fn source(a: &Arguments) -> Result<(IndicesSource, u32), Diagnostic> {
    let levels = a.count("levels", 1, 65536)?;
    let source = match a.get("cells") {
        Some((Argument::Rows(rows), place)) => IndicesSource::Rows(checked_rows(rows, levels, place)?),
        _ => IndicesSource::Path(a.paths("cells").into_iter().next().unwrap_or_default()),
    };
    Ok((source, levels))
}

fn checked_rows(rows: &[Vec<i32>], levels: u32, place: Place) -> Result<Vec<Vec<i32>>, Diagnostic> {
    let width = rows.first().map_or(0, Vec::len);
    if width == 0 || rows.iter().any(|row| row.len() != width) {
        return Err(constructors::ragged_rows(place));
    }
    match rows.iter().flatten().find(|i| !(0..levels as i32).contains(*i)) {
        Some(i) => Err(constructors::out_of_bounds(place, "cell", *i, 0, levels as i32 - 1)),
        None => Ok(rows.to_vec()),
    }
}
