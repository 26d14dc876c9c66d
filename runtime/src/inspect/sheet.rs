//! The contact sheet: what is to be looked at before figures are believed.

use super::blended::{BLENDS, Blend, PANEL};
use crate::picture::{Content, Picture};
use texgraph_compiler::manifest::Encoding;

/// White pixels between panels.
const GAP: u32 = 8;

/// Panels across.
const ACROSS: u32 = 2;

/// The panels two by two, in reading order.
pub fn of(blends: &[Blend; BLENDS], encoding: Encoding) -> Picture {
    let down = (BLENDS as u32).div_ceil(ACROSS);
    let [width, height] = [ACROSS, down].map(|panels| panels * (PANEL + GAP) - GAP);
    let pixel = |x: u32, y: u32| {
        let [column, row] = [x / (PANEL + GAP), y / (PANEL + GAP)];
        let [x, y] = [x % (PANEL + GAP), y % (PANEL + GAP)];
        let blend = blends.get((row * ACROSS + column) as usize).filter(|_| x < PANEL && y < PANEL);
        blend.and_then(|blend| blend.panel.pixels.get((y * PANEL + x) as usize)).copied().unwrap_or([1.0; 4])
    };
    Picture {
        size: [width, height],
        pixels: (0..height).flat_map(|y| (0..width).map(move |x| pixel(x, y))).collect(),
        content: match encoding {
            Encoding::Srgb => Content::Color,
            Encoding::Linear => Content::Data,
            Encoding::Normal => Content::Normal,
        },
    }
}
