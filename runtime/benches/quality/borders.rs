//! The pixels at borders of cells: those whose quad, the 2×2 pixels that a GPU takes differences in,
//! sees more than one cell.

use crate::Outcome;
use crate::case::{Case, loaded};
use std::ops::RangeInclusive;
use texgraph_compiler::manifest::Gradients;
use texgraph_runtime::cpu;

/// Pixels a cell, between which borders are looked at.
const PIXELS: RangeInclusive<f32> = 8.0..=256.0;

/// Which pixels of a case are at a border, where a cell has 8 to 256 pixels along its side.
pub fn find(graph: &str, case: Case) -> Outcome<Vec<bool>> {
    let made = loaded(graph, "borders", case, Gradients::Derive)?;
    let seen = cpu::render(&made.program, &made.tables, &case.request(), &|_| {})?;
    let width = seen.size[0] as usize;
    let pixel = |x: usize, y: usize| seen.pixels[y * width + x];
    let is_border = |n: usize| {
        let (x, y) = ((n % width) & !1, (n / width) & !1);
        let quad = [pixel(x, y), pixel(x + 1, y), pixel(x, y + 1), pixel(x + 1, y + 1)];
        quad.iter().all(|p| PIXELS.contains(&(1.0 / p[2]))) && quad.iter().any(|p| p[..2] != quad[0][..2])
    };
    Ok((0..seen.pixels.len()).map(is_border).collect())
}
