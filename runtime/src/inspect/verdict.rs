//! What follows from the evidence.
//!
//! The bounds are set by looking: at the sheets of the photographs of `benches/photos` (bricks, cobbles and
//! planks fail, the others don't) and of what the examples draw (the coats of giraffes and cracked mud
//! lose their lines, weave and scales their order). docs/stochastic.md has the figures of each.

use super::Report;
use crate::resource::exemplar::SEAM;
use std::fmt;

/// Outlines that are so much alike, shifted, are strong structure: the method breaks it.
pub const STRONG: f64 = 0.2;

/// What keeps less of its edges than this is seen to lose its lines.
pub const LEAST_EDGES: f64 = 0.85;

/// More variance than this between parts of the picture is seen as light and shade in the blend.
pub const MOST_UNEVEN: f64 = 0.25;

/// Colours further off than this are seen, as those of linear blending are, which has 0.06 to 0.2.
pub const MOST_DISTANCE: f64 = 0.15;

/// Texels along a side that tell anything of structure.
pub const LEAST_SIDE: u32 = 64;

/// Whether a picture suits the method.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// It does.
    Suits,
    /// It does, with parts that stay within its borders, which is what `wrap: auto` makes of it.
    SuitsInside,
    /// It does in most respects.
    Doubtful(Vec<Doubt>),
    /// It repeats after so many texels across and down: bricks, weave, scales.
    Repeats([i32; 2]),
    /// It has straight lines that run on along this shift, across and down: planks, furrows.
    Runs([i32; 2]),
}

/// What may be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Doubt {
    /// It is too small to tell.
    Small,
    /// Features do not fit into a hexagon: texels of both.
    Wide {
        /// Texels across a feature.
        features: f64,
        /// Texels down a hexagon.
        tile: f64,
    },
    /// Its light is uneven.
    Uneven,
    /// Its lines do not go on where parts blend.
    Lines,
    /// Its colours change.
    Colors,
}

/// What helps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Advice {
    /// Show it in another way: it has an order that can be written down.
    Patterns,
    /// A greater `tile:`.
    Tile,
    /// A greater `sharpness:`.
    Sharpness,
    /// Even light.
    Light,
    /// More texels.
    Larger,
    /// To look at the sheet.
    Look,
}

impl Verdict {
    pub(super) fn of(report: &Report) -> Verdict {
        let structure = &report.structure;
        let side = report.size[0].min(report.size[1]);
        if side >= LEAST_SIDE && structure.strength > STRONG {
            return match structure.period.filter(|_| !structure.is_line) {
                Some(period) => Verdict::Repeats(period),
                None => Verdict::Runs(structure.shift),
            };
        }
        let is_wide = structure.features > report.tile;
        let doubts = [
            (side < LEAST_SIDE, Doubt::Small),
            (is_wide, Doubt::Wide { features: structure.features, tile: report.tile }),
            (report.unevenness > MOST_UNEVEN, Doubt::Uneven),
            (report.edges < LEAST_EDGES, Doubt::Lines),
            (report.colors.histogram > MOST_DISTANCE, Doubt::Colors),
        ];
        let doubts: Vec<Doubt> =
            doubts.into_iter().filter(|(is_so, _)| *is_so).map(|(_, doubt)| doubt).collect();
        match doubts.is_empty() {
            false => Verdict::Doubtful(doubts),
            true if report.steps.iter().any(|step| *step > SEAM) => Verdict::SuitsInside,
            true => Verdict::Suits,
        }
    }

    /// The verdict in one word, for programs.
    pub fn word(&self) -> &'static str {
        match self {
            Verdict::Suits => "suits",
            Verdict::SuitsInside => "suits_inside",
            Verdict::Doubtful(_) => "doubtful",
            Verdict::Repeats(_) | Verdict::Runs(_) => "does_not_suit",
        }
    }

    /// What helps against each doubt, once.
    pub fn advice(&self) -> Vec<Advice> {
        let Verdict::Doubtful(doubts) = self else {
            let is_strong = matches!(self, Verdict::Repeats(_) | Verdict::Runs(_));
            return if is_strong { vec![Advice::Patterns] } else { Vec::new() };
        };
        doubts.iter().map(|doubt| doubt.advice()).collect()
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Verdict::Suits => f.write_str("suits"),
            Verdict::SuitsInside => f.write_str("suits with `wrap: inside`, which `auto` chooses"),
            Verdict::Doubtful(doubts) => {
                let doubts: Vec<String> = doubts.iter().map(Doubt::to_string).collect();
                write!(f, "doubtful: {}", doubts.join("; "))
            }
            Verdict::Repeats([x, y]) => {
                write!(f, "does not suit: it repeats every {}", way([*x, *y]))
            }
            Verdict::Runs(shift) => write!(f, "does not suit: its lines run on {}", direction(*shift)),
        }
    }
}

impl Doubt {
    fn advice(&self) -> Advice {
        match self {
            Doubt::Small => Advice::Larger,
            Doubt::Wide { .. } => Advice::Tile,
            Doubt::Uneven => Advice::Light,
            Doubt::Lines => Advice::Sharpness,
            Doubt::Colors => Advice::Look,
        }
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Doubt::Small => write!(f, "fewer than {LEAST_SIDE} texels a side tell little"),
            Doubt::Wide { features, tile } => {
                write!(f, "features of {features:.0} texels are wider than hexagons of {tile:.0}")
            }
            Doubt::Uneven => f.write_str("some parts are lighter than others"),
            Doubt::Lines => f.write_str("lines break where parts blend"),
            Doubt::Colors => f.write_str("colours change"),
        }
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Advice::Patterns => {
                "keep its order: repeat it, or draw its parts as `patterns` in the cells of `bricks`, `weave` or a \
                 node of your own"
            }
            Advice::Tile => "take a greater `tile:`, so that a hexagon holds a feature; or a larger photograph",
            Advice::Sharpness => "take `sharpness: 4`, so that less is blended, or cells that are drawn",
            Advice::Light => "take light and shade out of the photograph, or cut out an even part",
            Advice::Larger => "take a larger photograph",
            Advice::Look => "compare the first panel of the sheet with the last",
        })
    }
}

/// `64 texels across`, `32 texels across and 32 down`.
fn way([x, y]: [i32; 2]) -> String {
    match (x.abs(), y.abs()) {
        (x, 0) => format!("{x} texels across"),
        (0, y) => format!("{y} texels down"),
        (x, y) => format!("{x} texels across and {y} down"),
    }
}

/// The nearest of the two axes, where one is near.
fn direction([x, y]: [i32; 2]) -> &'static str {
    match (x.abs(), y.abs()) {
        (x, y) if y * 4 <= x => "across",
        (x, y) if x * 4 <= y => "down",
        _ => "aslant",
    }
}
