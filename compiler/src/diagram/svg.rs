//! The picture as SVG: plain shapes and text, one style sheet, no script.

use super::layout::{MARGIN, Place, Sheet};
use super::route::Stretch;
use super::shape::{FONT, HEADER, LETTER, LINE, PAD, Style, label};
use super::text::width;
use super::{Block, Diagram, Kind, Rate};
use std::fmt::Write;

/// The strip with the title of the diagram.
const TITLE: f64 = 50.0;
/// The strip with the legend.
const LEGEND: f64 = 34.0;

/// The rates with their classes, for the legend.
const RATES: &[(Rate, &str, &str)] = &[
    (Rate::Load, "load", "load: files, tables, constants"),
    (Rate::Draw, "draw", "draw: params, time"),
    (Rate::Pixel, "pixel", "pixel: the texture's inputs"),
];

/// Okabe and Ito's colours, which the colour-blind tell apart.
const STYLE: &str = "\
text{font:12px ui-monospace,SFMono-Regular,Menlo,Consolas,'DejaVu Sans Mono',monospace;fill:#1f2933}
.title{font-size:17px;font-weight:bold}.doc{fill:#66727f}
.block{fill:#fff;stroke-width:1.3}.formula{fill:#fbfcfd}.lambda{stroke-dasharray:5 3}
.name{font-weight:bold;fill:#fff}.pill{font-weight:bold}.code{fill:#52606d}.note{font-style:italic}
.line{stroke:#d5dbe1;fill:none}.wire{fill:none;stroke-width:1.5}.node{stroke-dasharray:5 3}.halo{stroke:#fff;fill:none;stroke-width:4.5}
.load{stroke:#b07400}.draw{stroke:#00805c}.pixel{stroke:#0a6aad}
.f-load{fill:#b07400}.f-draw{fill:#00805c}.f-pixel{fill:#0a6aad}
.t-load{fill:#fdf3dc}.t-draw{fill:#dcf3ea}.t-pixel{fill:#e0eefa}
";

/// Draws a diagram that is laid out.
pub fn draw(diagram: &Diagram, sheet: &Sheet) -> String {
    let letters = |text: &str, size: f64| width(text) as f64 * LETTER * size / FONT;
    let legend: f64 = legend_width(diagram);
    let head = letters(&diagram.title, 17.0).max(letters(&diagram.label, FONT));
    let inside = sheet.width.max(legend).max(head);
    let (wide, high) = (inside + 2.0 * MARGIN, sheet.height + TITLE + LEGEND + 2.0 * MARGIN);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\">\n<title>{title}</title>\n<style>\n{STYLE}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        w = number(wide),
        h = number(high),
        title = escape(&diagram.title),
    );
    text(&mut svg, MARGIN, MARGIN + 14.0, "title", &diagram.title);
    text(&mut svg, MARGIN, MARGIN + 33.0, "doc", &diagram.label);
    let _ = writeln!(svg, "<g transform=\"translate({} {})\">", number(MARGIN), number(MARGIN + TITLE));
    for (wire, stretches) in diagram.wires.iter().zip(&sheet.wires) {
        let rate = class(diagram.blocks[wire.from.block].rate);
        draw_wire(&mut svg, stretches, rate, wire.is_node);
    }
    for (block, place) in diagram.blocks.iter().zip(&sheet.places) {
        draw_block(&mut svg, block, place);
    }
    for (wire, stretches) in diagram.wires.iter().zip(&sheet.wires) {
        arrow(&mut svg, stretches, class(diagram.blocks[wire.from.block].rate));
    }
    svg.push_str("</g>\n");
    draw_legend(&mut svg, diagram, high - MARGIN);
    svg.push_str("</svg>\n");
    svg
}

fn class(rate: Rate) -> &'static str {
    RATES.iter().find(|(known, ..)| *known == rate).map_or("pixel", |(_, class, _)| class)
}

/// A wire, with a white edge so that one that crosses another is told from one that ends there.
fn draw_wire(svg: &mut String, stretches: &[Stretch], rate: &str, is_node: bool) {
    let path = path(stretches);
    let dashes = if is_node { " node" } else { "" };
    let _ = writeln!(
        svg,
        "<path class=\"halo\" d=\"{path}\"/><path class=\"wire {rate}{dashes}\" d=\"{path}\"/>"
    );
}

fn path(stretches: &[Stretch]) -> String {
    let mut path = String::new();
    let mut before: Option<&Stretch> = None;
    for stretch in stretches {
        match before {
            None => {
                let _ = write!(path, "M{} {}", number(stretch.from), number(stretch.y));
            }
            Some(before) => {
                // A wire that runs back, as in a ring, takes a wide turn.
                let back = (before.to - stretch.from).max(0.0) * 0.5;
                let (leave, come) = (before.turn + back * 2.0, before.turn - back * 2.0);
                let _ = write!(
                    path,
                    "C{} {} {} {} {} {}",
                    number(leave),
                    number(before.y),
                    number(come),
                    number(stretch.y),
                    number(stretch.from),
                    number(stretch.y),
                );
            }
        }
        let _ = write!(path, "H{}", number(stretch.to));
        before = Some(stretch);
    }
    path
}

fn arrow(svg: &mut String, stretches: &[Stretch], rate: &str) {
    let Some(last) = stretches.last() else { return };
    let (x, y) = (last.to, last.y);
    let _ = writeln!(svg, "<path class=\"f-{rate}\" d=\"M{} {}l-7 -4v8z\"/>", number(x + 1.0), number(y));
}

fn draw_block(svg: &mut String, block: &Block, place: &Place) {
    match place.shape.style {
        Style::Pill => draw_pill(svg, block, place),
        Style::Formula => draw_formula(svg, block, place),
        Style::Titled => draw_titled(svg, block, place),
    }
    let rate = class(block.rate);
    for (port, y) in block.outputs.iter().zip(&place.shape.outputs) {
        let (x, y) = (place.x + place.shape.width, place.y + y);
        let _ =
            writeln!(svg, "<circle class=\"f-{rate}\" cx=\"{}\" cy=\"{}\" r=\"3\"/>", number(x), number(y));
        text(svg, x + 8.0, y - 4.0, &format!("note f-{rate}"), &port.note);
    }
}

fn rect(svg: &mut String, place: &Place, round: f64, classes: &str) {
    let _ = writeln!(
        svg,
        "<rect class=\"{classes}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"{round}\"/>",
        number(place.x),
        number(place.y),
        number(place.shape.width),
        number(place.shape.height)
    );
}

fn draw_pill(svg: &mut String, block: &Block, place: &Place) {
    let rate = class(block.rate);
    let node = if block.kind == Kind::Input && block.title.contains("node(") { " lambda" } else { "" };
    rect(svg, place, 13.0, &format!("block t-{rate} {rate}{node}"));
    let inside = PAD + 5.0;
    text(svg, place.x + inside, place.y + 17.0, "pill", &block.title);
    lines(svg, block, place, inside);
}

fn draw_formula(svg: &mut String, block: &Block, place: &Place) {
    rect(svg, place, 5.0, &format!("block formula {}", class(block.rate)));
    lines(svg, block, place, PAD);
}

fn draw_titled(svg: &mut String, block: &Block, place: &Place) {
    let rate = class(block.rate);
    let lambda = if block.kind == Kind::Lambda { " lambda" } else { "" };
    rect(svg, place, 5.0, &format!("block {rate}{lambda}"));
    let (x, y, wide) = (place.x, place.y, place.shape.width);
    let _ = writeln!(
        svg,
        "<path class=\"f-{rate}\" d=\"M{} {}v-{}a5 5 0 0 1 5 -5h{}a5 5 0 0 1 5 5v{}z\"/>",
        number(x),
        number(y + HEADER),
        number(HEADER - 5.0),
        number(wide - 10.0),
        number(HEADER - 5.0)
    );
    text(svg, x + PAD, y + 15.0, "name", &block.title);
    for (port, height) in block.inputs.iter().zip(&place.shape.inputs) {
        input_label(svg, x + PAD, y + height + 4.0, &port.name, &port.note, &label(port));
    }
    for (port, height) in block.outputs.iter().zip(&place.shape.outputs) {
        let start = x + wide - PAD - width(&port.name) as f64 * LETTER;
        text(svg, start, y + height + 4.0, "", &port.name);
    }
    if !block.text.is_empty() && place.shape.text > HEADER + 5.0 {
        let line = y + place.shape.text - 4.0;
        let _ =
            writeln!(svg, "<path class=\"line\" d=\"M{} {}h{}\"/>", number(x), number(line), number(wide));
    }
    lines(svg, block, place, PAD);
}

/// What is given without a wire is fainter than the name.
fn input_label(svg: &mut String, x: f64, y: f64, name: &str, note: &str, whole: &str) {
    if note.is_empty() || name.is_empty() {
        return text(svg, x, y, if name.is_empty() { "code" } else { "" }, whole);
    }
    let _ = writeln!(
        svg,
        "<text x=\"{}\" y=\"{}\">{}<tspan class=\"code\">: {}</tspan></text>",
        number(x),
        number(y),
        escape(name),
        escape(note)
    );
}

fn lines(svg: &mut String, block: &Block, place: &Place, inside: f64) {
    for (i, line) in block.text.iter().enumerate() {
        let y = place.y + place.shape.text + LINE * i as f64 + 11.5;
        // White space at the start of a text is not drawn everywhere.
        let indent = line.len() - line.trim_start().len();
        text(svg, place.x + inside + indent as f64 * LETTER, y, "code", line.trim_start());
    }
}

fn text(svg: &mut String, x: f64, y: f64, class: &str, text: &str) {
    if !text.is_empty() {
        let class = if class.is_empty() { String::new() } else { format!(" class=\"{class}\"") };
        let _ = writeln!(svg, "<text{class} x=\"{}\" y=\"{}\">{}</text>", number(x), number(y), escape(text));
    }
}

/// What the diagram shows, left to right.
fn legend(diagram: &Diagram) -> Vec<(&'static str, &'static str, &'static str)> {
    let mut entries: Vec<_> = RATES.iter().map(|(_, class, text)| (*class, "", *text)).collect();
    if diagram.wires.iter().any(|wire| wire.is_node) {
        entries.push(("load", " node", "a node, passed as an argument"));
    }
    entries
}

fn legend_width(diagram: &Diagram) -> f64 {
    legend(diagram).iter().map(|(.., text)| width(text) as f64 * LETTER + 56.0).sum()
}

fn draw_legend(svg: &mut String, diagram: &Diagram, y: f64) {
    let mut x = MARGIN;
    for (class, dashes, entry) in legend(diagram) {
        let _ = writeln!(
            svg,
            "<path class=\"wire {class}{dashes}\" style=\"stroke-width:3\" d=\"M{} {}h24\"/>",
            number(x),
            number(y - 4.0)
        );
        text(svg, x + 32.0, y, "doc", entry);
        x += width(entry) as f64 * LETTER + 56.0;
    }
}

/// With one digit behind the point, where there is one.
fn number(value: f64) -> String {
    let tenths = (value * 10.0).round() as i64;
    let sign = if tenths < 0 { "-" } else { "" };
    match (tenths.abs() / 10, tenths.abs() % 10) {
        (whole, 0) => format!("{sign}{whole}"),
        (whole, part) => format!("{sign}{whole}.{part}"),
    }
}

/// Text that can't be taken for markup, and holds no character that XML forbids.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}
