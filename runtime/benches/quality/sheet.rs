//! The contact sheet: a row for each graph; for some cases what ours, the naive shader, the one by
//! hand and the reference show, twice as large.

use crate::Outcome;
use crate::case::View;
use crate::measure::bytes;
use crate::row::Row;
use image::imageops::FilterType;
use image::{Rgb, RgbImage};
use std::path::Path;
use texgraph_runtime::picture::Picture;

/// What the columns show, in groups of four: the view, pixels a cell, and the first row that is shown.
const SHOWN: [(View, f64, u32); 3] =
    [(View::Flat, 16.3, 50), (View::Flat, 1.02, 50), (View::Plane, 67.3, 50)];
/// Pixels along a side of what is shown of a picture, from its left edge.
const PART: u32 = 64;
/// Pixels along the side that it gets.
const SIDE: u32 = 2 * PART;
/// Between pictures, and between groups of them.
const GAPS: [u32; 2] = [2, 8];

/// Writes the sheet.
pub fn write(rows: &[Row], graphs: &[&str], file: &Path) -> Outcome<()> {
    let [gap, wide] = GAPS;
    let group = 4 * (SIDE + gap) + wide;
    let size = [SHOWN.len() as u32 * group - wide - gap, graphs.len() as u32 * (SIDE + gap) - gap];
    let mut sheet = RgbImage::from_pixel(size[0], size[1], Rgb([255; 3]));
    for (down, graph) in (0..).zip(graphs) {
        for (right, (view, pixels, top)) in (0..).zip(SHOWN) {
            let wanted =
                |row: &&Row| row.graph == *graph && row.case.view == view && row.case.pixels == pixels;
            let Some(row) = rows.iter().find(wanted) else { continue };
            for (n, picture) in (0..).zip(four(row, top)) {
                let place = [right * group + n * (SIDE + gap), down * (SIDE + gap)];
                image::imageops::replace(&mut sheet, &picture, place[0].into(), place[1].into());
            }
        }
    }
    Ok(sheet.save(file)?)
}

/// Parts of ours, the naive one, the one by hand and the reference.
fn four(row: &Row, top: u32) -> Vec<RgbImage> {
    let part = |pixels: &[[f32; 3]]| {
        let [width, height] = row.case.size();
        let whole = RgbImage::from_raw(width, height, bytes(pixels)).unwrap_or_default();
        let part = image::imageops::crop_imm(&whole, 0, top, PART, PART).to_image();
        image::imageops::resize(&part, SIDE, SIDE, FilterType::Nearest)
    };
    let colors = |picture: &Picture| -> Vec<[f32; 3]> {
        picture.pixels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()
    };
    let Some(gpu) = &row.gpu else {
        return vec![part(&colors(&row.cpu.picture)), part(&row.reference.pixels)];
    };
    let drawn = [&gpu.ours, &gpu.naive, &gpu.by_hand].map(|drawn| part(&colors(&drawn.picture)));
    drawn.into_iter().chain([part(&row.reference.pixels)]).collect()
}
