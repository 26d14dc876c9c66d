//! The measures of a block: how large it is and where its ports lie.
//!
//! A picture can't ask a font for its widths, so everything is set in a monospaced one and a
//! character is taken for 0.61 em wide: a little more than the usual fonts have.

use super::text::width;
use super::{Block, Kind, Port};

/// Size of the letters, in units of the picture.
pub const FONT: f64 = 12.0;
/// Width of a letter.
pub const LETTER: f64 = FONT * 0.61;
/// From one line of ports to the next.
pub const ROW: f64 = 18.0;
/// From one line of text to the next.
pub const LINE: f64 = 15.0;
/// The strip with the title.
pub const HEADER: f64 = 22.0;
/// Between the border and what stands in it.
pub const PAD: f64 = 9.0;
/// Between the inputs and the outputs of one row.
const APART: f64 = 22.0;

/// How a block is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Rounded, with its title in the middle; ports in the middle of the sides.
    Pill,
    /// Text alone; inputs spread along the left side.
    Formula,
    /// A strip with the title, rows of ports, and text below.
    Titled,
}

/// The measures of a block, from its upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    pub style: Style,
    pub width: f64,
    pub height: f64,
    /// What the names of its wires take beyond its right side.
    pub margin: f64,
    /// Heights of the inputs.
    pub inputs: Vec<f64>,
    /// Heights of the outputs.
    pub outputs: Vec<f64>,
    /// Height of the top of the text.
    pub text: f64,
}

impl Shape {
    pub fn of(block: &Block) -> Shape {
        let notes = block.outputs.iter().map(|port| letters(width(&port.note))).fold(0.0, f64::max);
        let margin = if notes > 0.0 { notes + 14.0 } else { 0.0 };
        let shape = match style(block) {
            Style::Pill => pill(block),
            Style::Formula => formula(block),
            Style::Titled => titled(block),
        };
        Shape { margin, ..shape }
    }
}

fn style(block: &Block) -> Style {
    match block.kind {
        Kind::Formula => Style::Formula,
        Kind::Output => Style::Pill,
        Kind::Input if block.outputs.len() == 1 => Style::Pill,
        _ => Style::Titled,
    }
}

fn letters(columns: usize) -> f64 {
    columns as f64 * LETTER
}

fn widest<'a>(texts: impl Iterator<Item = &'a String>) -> f64 {
    letters(texts.map(|text| width(text)).max().unwrap_or(0))
}

/// Ports side by side on a height, as many as there are.
fn spread(ports: &[Port], from: f64, to: f64) -> Vec<f64> {
    let step = (to - from) / ports.len().max(1) as f64;
    (0..ports.len()).map(|i| from + step * (i as f64 + 0.5)).collect()
}

fn pill(block: &Block) -> Shape {
    let inside = widest(block.text.iter().chain([&block.title]));
    let text = if block.text.is_empty() { 0.0 } else { LINE * block.text.len() as f64 + 4.0 };
    let height = 26.0 + text;
    Shape {
        style: Style::Pill,
        width: inside + 2.0 * PAD + 10.0,
        height,
        margin: 0.0,
        inputs: spread(&block.inputs, 0.0, height),
        outputs: spread(&block.outputs, 0.0, height),
        text: 24.0,
    }
}

fn formula(block: &Block) -> Shape {
    let lines = LINE * block.text.len() as f64 + 9.0;
    let height = lines.max(9.0 * block.inputs.len() as f64);
    Shape {
        style: Style::Formula,
        width: widest(block.text.iter()) + 2.0 * PAD,
        height,
        margin: 0.0,
        inputs: spread(&block.inputs, 0.0, height),
        outputs: spread(&block.outputs, 0.0, height),
        text: (height - LINE * block.text.len() as f64) / 2.0,
    }
}

fn titled(block: &Block) -> Shape {
    let left = widest(block.inputs.iter().map(label).collect::<Vec<_>>().iter());
    let right = widest(block.outputs.iter().map(|port| &port.name));
    let inside = (left + right + if left > 0.0 && right > 0.0 { APART } else { 0.0 })
        .max(letters(width(&block.title)))
        .max(widest(block.text.iter()));
    // Nothing beside the one output: it leaves the block in the middle.
    let is_plain = block.inputs.is_empty() && block.outputs.iter().all(|port| port.name.is_empty());
    let rows = if is_plain { 0 } else { block.inputs.len().max(block.outputs.len()) };
    let rows_height = if rows == 0 { 0.0 } else { ROW * rows as f64 + 6.0 };
    let text_height = if block.text.is_empty() { 0.0 } else { LINE * block.text.len() as f64 + 8.0 };
    let height = HEADER + rows_height + text_height;
    let row = |i: usize| HEADER + 3.0 + ROW * (i as f64 + 0.5);
    Shape {
        style: Style::Titled,
        width: inside + 2.0 * PAD,
        height,
        margin: 0.0,
        inputs: (0..block.inputs.len()).map(row).collect(),
        outputs: if is_plain {
            spread(&block.outputs, 0.0, height)
        } else {
            (0..block.outputs.len()).map(row).collect()
        },
        text: HEADER + rows_height + 4.0,
    }
}

/// A port of a titled block as it is written.
pub fn label(port: &Port) -> String {
    match (port.name.as_str(), port.note.as_str()) {
        (name, "") => name.to_owned(),
        ("", note) => note.to_owned(),
        (name, note) => format!("{name}: {note}"),
    }
}
