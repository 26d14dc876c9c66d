//! The diagram as text for Graphviz: the same blocks as tables with ports.

use super::shape::label;
use super::svg::escape;
use super::{Block, Diagram, Kind, Rate};
use std::fmt::Write;

fn color(rate: Rate) -> &'static str {
    match rate {
        Rate::Load => "#b07400",
        Rate::Draw => "#00805c",
        Rate::Pixel => "#0a6aad",
    }
}

/// Writes a diagram.
pub fn write(diagram: &Diagram) -> String {
    let mut dot = String::from(
        "digraph {\n  graph [rankdir=LR, nodesep=0.2, ranksep=0.6, labelloc=t, labeljust=l, fontname=\"monospace\"]\n  node [shape=plain, fontname=\"monospace\", fontsize=11]\n  edge [fontname=\"monospace\", fontsize=10, arrowsize=0.6]\n",
    );
    let _ = writeln!(dot, "  label=<{}>", heading(diagram));
    for (i, block) in diagram.blocks.iter().enumerate() {
        let _ = writeln!(dot, "  b{i} [label=<{}>]", table(block));
    }
    let rank = |dot: &mut String, rank: &str, is_there: &dyn Fn(&Block) -> bool| {
        let held = diagram.blocks.iter().enumerate().filter(|(_, block)| is_there(block));
        let held: Vec<String> = held.map(|(i, _)| format!("b{i}")).collect();
        if !held.is_empty() {
            let _ = writeln!(dot, "  {{ rank={rank}; {} }}", held.join("; "));
        }
    };
    rank(&mut dot, "source", &|block| block.inputs.is_empty() && block.kind != Kind::Output);
    rank(&mut dot, "sink", &|block| block.kind == Kind::Output);
    for wire in &diagram.wires {
        let from = &diagram.blocks[wire.from.block];
        let note = from.outputs.get(wire.from.port).map_or("", |port| &port.note);
        let label = if note.is_empty() { String::new() } else { format!(", label=<{}>", escape(note)) };
        let style = if wire.is_node { ", style=dashed" } else { "" };
        let _ = writeln!(
            dot,
            "  b{}:o{}:e -> b{}:i{}:w [color=\"{}\"{label}{style}]",
            wire.from.block,
            wire.from.port,
            wire.to.block,
            wire.to.port,
            color(from.rate)
        );
    }
    dot.push_str("}\n");
    dot
}

fn heading(diagram: &Diagram) -> String {
    let mut heading = format!("<B>{}</B>", escape(&diagram.title));
    if !diagram.label.is_empty() {
        let _ = write!(heading, "<BR ALIGN=\"LEFT\"/>{}", escape(&diagram.label));
    }
    let rates = [(Rate::Load, "load"), (Rate::Draw, "draw"), (Rate::Pixel, "pixel")];
    let legend = rates.map(|(rate, name)| format!("<FONT COLOR=\"{}\">{name}</FONT>", color(rate)));
    let _ = write!(heading, "<BR ALIGN=\"LEFT\"/>rates: {}<BR ALIGN=\"LEFT\"/>", legend.join(", "));
    heading
}

/// A table with the title on top, a row for each pair of ports, and the text below.
fn table(block: &Block) -> String {
    let color = color(block.rate);
    let style = if block.kind == Kind::Lambda { " STYLE=\"DASHED\"" } else { "" };
    let mut table = format!(
        "<TABLE BORDER=\"1\" CELLBORDER=\"0\" CELLSPACING=\"0\" CELLPADDING=\"3\" COLOR=\"{color}\"{style}>"
    );
    if !block.title.is_empty() {
        let title = escape(&block.title);
        let _ = write!(
            table,
            "<TR><TD COLSPAN=\"2\" ALIGN=\"LEFT\"><FONT COLOR=\"{color}\"><B>{title}</B></FONT></TD></TR>"
        );
    }
    let is_formula = block.kind == Kind::Formula;
    for i in 0..block.inputs.len().max(block.outputs.len()) {
        let left = block.inputs.get(i).map(|port| if is_formula { port.name.clone() } else { label(port) });
        let right = block.outputs.get(i).map(|port| port.name.clone());
        let _ = write!(table, "<TR>{}{}</TR>", cell('i', i, left), cell('o', i, right));
    }
    if !block.text.is_empty() {
        let lines: Vec<String> =
            block.text.iter().map(|line| escape(line).replace("  ", "&#160;&#160;")).collect();
        let _ = write!(
            table,
            "<TR><TD COLSPAN=\"2\" ALIGN=\"LEFT\" BALIGN=\"LEFT\">{}</TD></TR>",
            lines.join("<BR/>")
        );
    }
    table.push_str("</TABLE>");
    table
}

fn cell(side: char, port: usize, text: Option<String>) -> String {
    let align = if side == 'i' { "LEFT" } else { "RIGHT" };
    match text {
        Some(text) if text.is_empty() => format!("<TD PORT=\"{side}{port}\" ALIGN=\"{align}\"> </TD>"),
        Some(text) => format!("<TD PORT=\"{side}{port}\" ALIGN=\"{align}\">{}</TD>", escape(&text)),
        None => "<TD></TD>".to_owned(),
    }
}
