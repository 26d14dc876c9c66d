//! `positions`: patterns at places of their own (Lefebvre & Neyret 2003, §3.1, explicit positioning).

use super::{Argument, Arguments, Made};
use crate::diagnostic::{Diagnostic, constructors};
use crate::graph::Constant;
use crate::manifest::Recipe;

/// Cells along a side of the grid. A sprite that lies across a border needs two.
const SIDES: [i32; 2] = [2, 4096];
/// Sprites in a cell.
const MAX_LAYERS: i32 = 8;

/// The recipe of a constructor call.
///
/// # Errors
/// A grid that is too small or too large, or too many layers.
pub fn make(a: &Arguments) -> Result<Made, Diagnostic> {
    let grid = match a.get("grid") {
        Some((Argument::Number(c), _)) => [c.int(0), c.int(1)],
        _ => [0, 0],
    };
    if let Some(side) = grid.iter().find(|side| !(SIDES[0]..=SIDES[1]).contains(*side)) {
        return Err(constructors::out_of_bounds(a.place("grid"), "grid", *side, SIDES[0], SIDES[1]));
    }
    let layers = a.count("layers", 1, MAX_LAYERS)?;
    let [patterns] = a.parts("patterns") else {
        return Err(constructors::wrong_argument(a.place("patterns"), "patterns", "patterns"));
    };
    let mut constants = vec![
        ("grid", Constant::ints(&grid)),
        ("most", Constant::ints(&[layers as i32])),
        ("tiles", Constant::ints(&[patterns.int("count")])),
    ];
    constants.extend(patterns.constants.iter().filter(|(name, _)| *name != "count"));
    let path = a.paths("path").into_iter().next().unwrap_or_default();
    let grid = grid.map(|side| side as u32);
    Ok(Made {
        recipe: Recipe::Positions { path, grid, layers, patterns: patterns.index },
        constants,
        sampler: None,
        lender: Some(patterns.index),
    })
}
