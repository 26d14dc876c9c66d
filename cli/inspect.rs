//! `texgraph inspect`: whether a picture suits tiling and blending by example, with the evidence.

use crate::args::{Inspect, InspectEncoding, InspectFormat};
use crate::output;
use crate::problem::Problem;
use crate::program;
use serde_json::json;
use std::fmt::Write;
use texgraph_compiler::manifest::Encoding;
use texgraph_runtime::inspect::{self, Asked, InspectError, Report};
use texgraph_runtime::resource::exemplar::SEAM;

/// Looks at a picture, says what was found, and writes the sheet where one is asked for.
///
/// # Errors
/// The picture can't be read, or the sheet can't be written.
pub fn run(args: &Inspect) -> Result<(), Problem> {
    if let Some(sheet) = &args.output_file {
        output::try_png(sheet)?;
    }
    let shown = args.picture.display().to_string();
    if args.picture.file_name().is_none() {
        return Err(Problem::Input(format!("`{shown}` is a folder, not a file")));
    }
    let asked = Asked { encoding: args.encoding.into(), is_grey: args.channels == 1, tile: args.tile };
    let report =
        inspect::inspect(&program::library()?, &args.picture, &asked).map_err(|error| match error {
            InspectError::Picture(diagnostics) => Problem::Picture { path: shown.clone(), diagnostics },
            InspectError::Program(failure) => Problem::Pages(failure),
            InspectError::Render(error) => Problem::from(error),
        })?;
    if let Some(sheet) = &args.output_file {
        output::write(&[(sheet.clone(), report.sheet.to_png()?)])?;
    }
    output::print(&match args.format {
        InspectFormat::Text => text(&shown, &report),
        InspectFormat::Json => json(&report),
    })
}

impl From<InspectEncoding> for Encoding {
    fn from(encoding: InspectEncoding) -> Encoding {
        match encoding {
            InspectEncoding::Srgb => Encoding::Srgb,
            InspectEncoding::Linear => Encoding::Linear,
            InspectEncoding::Normal => Encoding::Normal,
        }
    }
}

fn text(picture: &str, report: &Report) -> String {
    let Report { size: [width, height], structure, colors, .. } = report;
    let mut text = format!("{picture}, {width}×{height} texels, hexagons of {:.0}\n", report.tile);
    let mut line = |name: &str, found: String, bound: String| {
        let _ = writeln!(text, "{}", format!("  {name:<46}{found:>12}   {bound}").trim_end());
    };
    let [across, down] = report.steps.map(|step| format!("{step:.2}"));
    line("wrap step across, times the mean step inside", across, format!("at most {SEAM}"));
    line("wrap step down", down, format!("at most {SEAM}"));
    line("distance of colours, linear blend", format!("{:.3}", colors.linear), String::new());
    line("                     variance kept", format!("{:.3}", colors.variance), String::new());
    let bound = format!("at most {}", inspect::MOST_DISTANCE);
    line("                     histogram kept", format!("{:.3}", colors.histogram), bound);
    let [x, y] = structure.shift;
    let most = format!("at most {}, is at ({x}, {y})", inspect::STRONG);
    line("autocorrelation of outlines", format!("{:.2}", structure.strength), most);
    for peak in &structure.peaks {
        let [x, y] = peak.shift;
        line("  peak", format!("{:.2}", peak.height), format!("at ({x}, {y})"));
    }
    let bound = format!("at most {:.0}", report.tile);
    line("width of features, texels", format!("{:.0}", structure.features), bound);
    let bound = format!("at most {}", inspect::MOST_UNEVEN);
    line("uneven light, share of the variance", format!("{:.2}", report.unevenness), bound);
    let bound = format!("at least {}", inspect::LEAST_EDGES);
    line("edges kept", format!("{:.2}", report.edges), bound);
    let _ = writeln!(text, "{}", report.verdict);
    for advice in report.verdict.advice() {
        let _ = writeln!(text, "  {advice}");
    }
    text
}

fn json(report: &Report) -> String {
    let Report { structure, colors, verdict, .. } = report;
    let peaks = structure.peaks.iter().map(|peak| json!({ "height": peak.height, "shift": peak.shift }));
    let value = json!({
        "size": report.size,
        "tile": report.tile,
        "wrap_step": report.steps.map(|step| step.is_finite().then_some(step)),
        "distance": { "linear": colors.linear, "variance": colors.variance, "histogram": colors.histogram },
        "autocorrelation": { "most": structure.strength, "shift": structure.shift, "peaks": peaks.collect::<Vec<_>>() },
        "features": structure.features,
        "unevenness": report.unevenness,
        "edges": report.edges,
        "verdict": verdict.word(),
        "says": verdict.to_string(),
        "advice": verdict.advice().iter().map(ToString::to_string).collect::<Vec<_>>(),
    });
    format!("{value:#}\n")
}
