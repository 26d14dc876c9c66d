//! `texgraph tiles check`: how well the tiles of a sheet fit, and a gate for it.

use super::args::{Check, Format};
use crate::output;
use crate::problem::{Problem, Report as Problems};
use serde_json::{Value, json};
use std::fmt::Write;
use texgraph_runtime::tiles::{self, Edge, Pair, Report, Side};

/// Compares all edges that may face each other.
///
/// # Errors
/// The sheet can't be read or does not suit. One whose edges differ by more than is allowed is shown
/// after the figures.
pub fn run(args: &Check, problems: &mut Problems) -> Result<(), Problem> {
    let sheet = super::open(&args.sheet)?;
    let report = tiles::check(&sheet, args.grid, args.families);
    let report = report.map_err(|error| super::refused(&args.sheet, error))?;
    output::print(&match args.format {
        Format::Text => text(&report),
        Format::Json => json(&report),
    })?;
    if let Some(most) = args.max.filter(|most| report.facing.max > *most) {
        let max = report.facing.max;
        let sheet = args.sheet.display();
        problems.show(&Problem::Input(format!(
            "facing edges of `{sheet}` differ by {max} levels, {most} are allowed"
        )));
    }
    Ok(())
}

fn text(report: &Report) -> String {
    let [width, height] = report.size;
    let mut text =
        format!("{} tiles of {width}×{height} texels, differences in 8-bit sRGB levels:\n", report.tiles);
    let _ = writeln!(text, "{:<44}{:>6}{:>9}", "", "max", "mean");
    line(&mut text, &format!("facing texels of {} pairs of edges", report.pairs), report.facing);
    line(&mut text, "neighbouring texels inside tiles", report.inside);
    let worst = report.worst.iter().filter(|pair| pair.apart.max > 0);
    for pair in worst {
        line(&mut text, &name(*pair), pair.apart);
    }
    text
}

fn line(text: &mut String, name: &str, edge: Edge) {
    let (max, mean) = (edge.max, edge.mean());
    let _ = writeln!(text, "  {name:<42}{max:>6}{mean:>9.2}");
}

fn name(Pair { first, second, side, .. }: Pair) -> String {
    match side {
        Side::Right => format!("right of tile {first}, left of {second}"),
        Side::Bottom => format!("bottom of tile {first}, top of {second}"),
    }
}

fn json(report: &Report) -> String {
    let edge = |edge: Edge| json!({ "max": edge.max, "mean": edge.mean() });
    let pair = |pair: &Pair| -> Value {
        let side = match pair.side {
            Side::Right => "right",
            Side::Bottom => "bottom",
        };
        json!({ "first": pair.first, "second": pair.second, "side": side, "apart": edge(pair.apart) })
    };
    let value = json!({
        "tiles": report.tiles,
        "size": report.size,
        "unit": "8-bit sRGB levels",
        "pairs": report.pairs,
        "facing": edge(report.facing),
        "inside": edge(report.inside),
        "worst": report.worst.iter().map(pair).collect::<Vec<_>>(),
    });
    format!("{value:#}\n")
}
