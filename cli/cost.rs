//! `texgraph cost`: what textures take per pixel, and a gate for it.

use crate::args::{Cost as Args, CostFormat};
use crate::output;
use crate::problem::{Problem, Report};
use crate::program::{self, Program};
use std::fmt::Write;
use texgraph_compiler::cost::{self, Cost, Counts, PassCost};
use texgraph_compiler::{Options, Profile};

/// Counts the named texture, or all of a file.
///
/// # Errors
/// A texture is wrong. One that takes more than is allowed is shown as it is found, after the
/// figures.
pub fn run(args: &Args, report: &mut Report) -> Result<(), Problem> {
    let (file, texture) = program::split(&args.file);
    let library = program::library()?;
    let program = Program::open(&library, &file, args.common.allow_outside)?;
    let mut costs = Vec::new();
    let profile = Profile::from(args.host.profile);
    for texture in program.wanted(texture)? {
        let mut compiled = program.compile(&Options { texture, profile, ..Options::default() })?;
        // What can't be loaded has an unknown size; `render` and `build` say why.
        let _ = program.load(&mut compiled);
        program::fit(&compiled, profile)?;
        costs.push(cost::cost(&compiled));
    }
    output::print(&match args.format {
        CostFormat::Text => costs.iter().map(text).collect::<Vec<_>>().join("\n"),
        CostFormat::Json => json(&costs)?,
    })?;
    for cost in &costs {
        gate(cost, args.max_samples, report);
    }
    Ok(())
}

fn json(costs: &[Cost]) -> Result<String, Problem> {
    let text = serde_json::to_string_pretty(costs);
    text.map(|text| text + "\n").map_err(|error| Problem::Machine(format!("a bug of texgraph: {error}")))
}

/// A texture that may read more than is allowed is wrong input.
fn gate(cost: &Cost, most: Option<u32>, report: &mut Report) {
    let Some((most, pass)) = most.zip(cost.texture()) else { return };
    if pass.worst.reads > f64::from(most) {
        let (name, reads) = (&cost.texture, number(pass.worst.reads));
        report.show(&Problem::Input(format!(
            "`{name}` takes {reads} samples and fetches a pixel in the worst case, {most} are allowed"
        )));
    }
}

/// The figures of a texture for people.
fn text(cost: &Cost) -> String {
    let mut text = String::new();
    for pass in &cost.passes {
        pass_text(&mut text, cost, pass);
    }
    bindings(&mut text, cost);
    text
}

fn pass_text(text: &mut String, cost: &Cost, pass: &PassCost) {
    let (kind, of) = match pass.texels {
        Some(texels) => ("bake", format!("{} texels, per texel:", number(texels as f64))),
        None => ("texture", "per pixel:".to_owned()),
    };
    let _ = writeln!(text, "{:<40}{:>14}{:>14}", format!("{kind} {}, {of}", pass.name), "worst", "typical");
    let mut line = |name: &str, worst: f64, typical: f64| {
        let _ = writeln!(text, "  {name:<38}{:>14}{:>14}", number(worst), number(typical));
    };
    let Counts { samples, fetches, reads, arithmetic } = pass.worst;
    let typical = pass.typical;
    line("samples", samples, typical.samples);
    line("fetches", fetches, typical.fetches);
    line("samples and fetches", reads, typical.reads);
    line("arithmetic", arithmetic.total, typical.arithmetic.total);
    for ((name, worst), (_, typical)) in arithmetic.kinds().into_iter().zip(typical.arithmetic.kinds()) {
        if worst > 0.0 {
            line(&format!("  {name}"), worst, typical);
        }
    }
    for a_loop in &pass.loops {
        let place = format!("{}:{}", a_loop.file, a_loop.line);
        let (most, typical) = (number(f64::from(a_loop.most)), number(a_loop.typical));
        let _ = writeln!(
            text,
            "  {:<38}{most:>14}{typical:>14}  steps, {place}",
            format!("fold in {}", a_loop.node)
        );
    }
    let _ = writeln!(text, "  {:<38}{:>14}", "textures bound", pass.textures);
    let _ = writeln!(text, "  {:<38}{:>14}", "samplers bound", pass.samplers);
    if cost.passes.len() > 1 {
        text.push('\n');
    }
}

fn bindings(text: &mut String, cost: &Cost) {
    let _ = writeln!(text, "  {:<38}{:>14}", "uniform bytes", number(f64::from(cost.uniform_bytes)));
    for table in &cost.tables {
        let bytes = table.bytes.map_or("unknown".to_owned(), |bytes| number(bytes as f64));
        let _ = writeln!(
            text,
            "{}",
            format!("  {:<38}{bytes:>14}  {}", format!("bytes of {}", table.name), table.layout).trim_end()
        );
    }
    if cost.tables.len() > 1 {
        let rest = if cost.has_unknown_tables() { "  and what is unknown" } else { "" };
        let _ =
            writeln!(text, "  {:<38}{:>14}{rest}", "bytes of all tables", number(cost.table_bytes as f64));
    }
}

/// `1,398,080`, or `12.5`.
fn number(value: f64) -> String {
    let tenths = (value * 10.0).round() as u64;
    let digits = (tenths / 10).to_string();
    let mut whole = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            whole.push(',');
        }
        whole.push(digit);
    }
    match tenths % 10 {
        0 => whole,
        tenth => format!("{whole}.{tenth}"),
    }
}
