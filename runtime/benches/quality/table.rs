//! The rows in Markdown.

use crate::row::{Drawn, Row};
use std::fmt::Write;

const HEAD: &str = "\
| graph | view | cell | reference | PSNR: CPU | GPU | by hand | naive | at borders: GPU | by hand | naive | FLIP: GPU | by hand | naive | drift: GPU | by hand | naive |
| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |
";

/// A table of rows.
pub fn table(rows: &[Row]) -> String {
    rows.iter().fold(HEAD.to_owned(), |text, row| text + &line(row))
}

/// One line of it.
pub fn line(row: &Row) -> String {
    let drawn = row.gpu.as_ref().map(|gpu| [&gpu.ours, &gpu.by_hand, &gpu.naive]);
    let cells = |of: &dyn Fn(&Drawn) -> String| match drawn {
        Some(drawn) => drawn.map(of).join(" | "),
        None => "– | – | –".to_owned(),
    };
    let mut text = format!("| {} | {} | {} ", row.graph, row.case.view.name(), pixels(row.case.pixels));
    let psnrs = cells(&|drawn| format!("{:.2}", drawn.off.psnr));
    let borders = cells(&|drawn| drawn.off.border_psnr.map_or("–".to_owned(), |psnr| format!("{psnr:.1}")));
    let flips = cells(&|drawn| format!("{:.4}", drawn.off.flip));
    let drifts = cells(&|drawn| format!("{:.2}", drawn.off.drift));
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "| {:.1} | {:.2} | {psnrs} | {borders} | {flips} | {drifts} |",
        row.own, row.cpu.off.psnr
    );
    text
}

/// Pixels a cell, or cells a pixel.
pub fn pixels(pixels: f64) -> String {
    if pixels < 1.0 { format!("1/{:.1} px", 1.0 / pixels) } else { format!("{pixels} px") }
}
