//! Sentences about textures that do not tile.

use super::{Diagnostic, Place};
use crate::tiling::{Culprit, What, Why};
use smol_str::SmolStr;

/// A period that is known too late.
pub fn period_not_constant(place: Place) -> Diagnostic {
    Diagnostic::new(
        "E0807",
        place,
        "the period of a texture must be a constant",
        "this is not known before anything is drawn",
    )
}

/// A period that is none.
pub fn period_not_positive(place: Place) -> Diagnostic {
    Diagnostic::new("E0807", place, "a texture tiles after a length above 0", "this is none")
        .help("along an axis that need not repeat it is 0: `tiles vec2(1, 0)`")
}

/// A texture without a place that could move.
pub fn no_uv(place: Place) -> Diagnostic {
    Diagnostic::new(
        "E0807",
        place,
        "a texture tiles in `uv`, which this one does not take",
        "the period of what?",
    )
    .help("add the input `uv: vec2`")
}

/// What keeps outputs from repeating along axes; `can_be_given` says that it is a node with a period.
pub fn does_not_tile(
    culprit: &Culprit,
    axes: &[&str],
    outputs: &[SmolStr],
    clause: Place,
    can_be_given: bool,
) -> Diagnostic {
    let outputs = outputs.iter().map(|output| format!("`{output}`")).collect::<Vec<_>>().join(", ");
    let axes = axes.iter().map(|axis| format!("`{axis}`")).collect::<Vec<_>>().join(" and ");
    let message = match culprit.kind {
        What::Output => format!("{outputs} does not tile along {axes}"),
        What::Operation | What::Node => {
            format!("`{}` keeps {outputs} from tiling along {axes}", culprit.name)
        }
    };
    let help = if can_be_given { period_help(&culprit.why) } else { help(culprit) };
    Diagnostic::new("E0806", culprit.place, message, reason(&culprit.why))
        .maybe_help(Some(help).filter(|help| !help.is_empty()))
        .related(clause, "the period asked for")
}

/// What happens there, one period on.
fn reason(why: &Why) -> String {
    match why {
        Why::Moves { by } => format!("one period on, this takes what is greater by {by}"),
        Why::NotMultiple { by, of } => {
            let what = if of == "1" { "whole number".to_owned() } else { format!("multiple of {of}") };
            format!("one period on, this takes what is greater by {by}, which is no {what}")
        }
        Why::Apart { by, other } => {
            format!("one period on, one side is greater by {by} and the other by {other}")
        }
        Why::Unlike { by, other } => {
            format!("one period on, this is greater by {by} in some places and by {other} in others")
        }
        Why::Product { by } => {
            format!("one period on, one factor is greater by {by}, and the other differs from place to place")
        }
        Why::Truncates { by } => {
            format!("one period on, this takes what is greater by {by}, and rounds towards 0, not down")
        }
        Why::Wrap { by } => {
            format!("one period on, this reads {by} farther in a picture that does not repeat")
        }
        Why::Wraps => "its ints wrap within a few periods".to_owned(),
        Why::TooLong => "it takes too long to find out how this repeats".to_owned(),
    }
}

fn period_help(why: &Why) -> String {
    match why {
        Why::Moves { by } if by.parse::<u32>().is_ok() => {
            format!("give it `period: {by}`, which is how many of its cells lie in one period")
        }
        _ => "give it a `period:`, and a place that is greater by that many whole cells one period on"
            .to_owned(),
    }
}

fn help(culprit: &Culprit) -> String {
    match &culprit.why {
        Why::Moves { by } if matches!(culprit.name.as_str(), "hash" | "texel") => {
            format!("take the cell modulo what it grows by: `cell % {by}`")
        }
        Why::Moves { .. } => {
            "make it repeat before: `fract`, `%`, `sin` of whole turns, or a node with a `period:`".to_owned()
        }
        Why::NotMultiple { of, .. } if of == "1" => {
            "scale the place so that it grows by a whole number in one period".to_owned()
        }
        Why::NotMultiple { of, .. } => {
            format!("scale the place so that it grows by a multiple of {of} in one period")
        }
        Why::Truncates { .. } => "`ifloor` rounds down everywhere".to_owned(),
        Why::Wrap { .. } => "give the picture `wrap: repeat`, or take `fract` of the place".to_owned(),
        Why::Apart { .. } | Why::Unlike { .. } | Why::Product { .. } => {
            "make both repeat before: `fract`, `%`, or a node with a `period:`".to_owned()
        }
        Why::Wraps => "take it modulo the number of cells in a period before".to_owned(),
        Why::TooLong => String::new(),
    }
}
