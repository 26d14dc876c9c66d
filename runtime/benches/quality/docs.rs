//! The part of docs/quality.md that this bench writes: how targets fare, and some of the rows.

use crate::Outcome;
use crate::case::View;
use crate::row::{Drawn, Row};
use crate::table::pixels;
use crate::targets;
use std::path::Path;

/// What stands before and behind that part.
const MARKS: [&str; 2] = ["<!-- quality: written by the bench -->\n", "<!-- quality: end -->"];
/// The rows that are shown, of each graph.
const SHOWN: [(View, f64); 6] = [
    (View::Flat, 251.0),
    (View::Flat, 16.3),
    (View::Flat, 1.02),
    (View::Flat, 1.0 / 64.3),
    (View::Plane, 67.3),
    (View::Plane, 1.0 / 64.3),
];

/// Writes the part into the page.
pub fn write(rows: &[Row], page: &Path) -> Outcome<()> {
    let text = std::fs::read_to_string(page)?;
    let (before, rest) = text.split_once(MARKS[0]).ok_or("the page has no mark")?;
    let (_, after) = rest.split_once(MARKS[1]).ok_or("the page has no second mark")?;
    let part = format!("\n{}\n{}\n", targets::table(rows), table(rows));
    Ok(std::fs::write(page, [before, MARKS[0], &part, MARKS[1], after].concat())?)
}

fn table(rows: &[Row]) -> String {
    let head = "| graph | view | a cell | reference | PSNR | at borders | FLIP | drift |\n\
        | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    let is_shown = |row: &&Row| SHOWN.contains(&(row.case.view, row.case.pixels));
    rows.iter().filter(is_shown).fold(head.to_owned(), |text, row| text + &line(row))
}

fn line(row: &Row) -> String {
    let drawn: Vec<&Drawn> = match &row.gpu {
        Some(gpu) => vec![&gpu.ours, &gpu.by_hand, &gpu.naive],
        None => vec![&row.cpu],
    };
    let each = |of: &dyn Fn(&Drawn) -> String| drawn.iter().map(|d| of(d)).collect::<Vec<_>>().join(" · ");
    format!(
        "| {} | {} | {} | {:.1} | {} | {} | {} | {:.2} |\n",
        row.graph,
        row.case.view.name(),
        pixels(row.case.pixels),
        row.own,
        each(&|drawn| format!("{:.1}", drawn.off.psnr)),
        each(&|drawn| drawn.off.border_psnr.map_or("–".to_owned(), |psnr| format!("{psnr:.1}"))),
        each(&|drawn| format!("{:.3}", drawn.off.flip)),
        row.cpu.off.drift,
    )
}
