//! The table of T⁻¹, filtered for each level of the Gaussian picture (§1.3.3, §1.5).
//!
//! A pixel that covers many texels shows the mean of what their numbers stand for, which is not what
//! the mean of their numbers stands for. The numbers under a texel of level l are taken to be Gaussian
//! around its own, with the variance that level l lost; the table's row l is T⁻¹ averaged so.
//!
//! Entries are colours: what a channel adds along its axis, so that a shader has nothing to do but to
//! add the channels up. A 16-bit float tells light less finely than the lesser axes of most photographs
//! spread; so alpha holds what red, green and blue have in common, and they what is left, near 0, where
//! floats are finest.

use super::axes::Axes;
use super::gauss::DEVIATION;
use super::ranks::Ranks;
use crate::resource::encoding::Writer;
use crate::resource::table::Made;
use glam::{DVec3, Vec4};
use half::f16;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use texgraph_compiler::manifest::{Format, Recipe, Table};

/// How finely T⁻¹ is averaged, at least: entries from 0 to 1.
const FINE: u32 = 1024;

/// Sums that run side by side.
const LANES: usize = 8;

/// The means of the squares of a level's first three numbers.
pub fn mean_squares(level: &[Vec4]) -> DVec3 {
    let rows = level.chunks(1024).map(|texels| {
        texels.iter().fold(DVec3::ZERO, |sum, texel| {
            let numbers = texel.truncate().as_dvec3();
            sum + numbers * numbers
        })
    });
    rows.fold(DVec3::ZERO, |sum, row| sum + row) / level.len() as f64
}

/// Makes field `inverse`. `squares` are the mean squares of the Gaussian picture's levels from 1 on.
pub fn make(axes: &Axes, ranks: &Ranks, squares: &[DVec3], width: u32, is_inside: bool) -> Made {
    let levels = Recipe::INVERSE_LEVELS;
    // The last row tells whether parts stay inside.
    let size = [width, levels * axes.channels as u32 + 1];
    let table = Table::with_levels(Format::Rgba16Float, size, 1, 1);
    let curves: Vec<Curve> = (0..axes.channels).map(|channel| Curve::new(ranks, channel, width)).collect();
    let rows = (0..levels * axes.channels as u32).into_par_iter().map(|row| {
        let (channel, level) = ((row / levels) as usize, (row % levels) as usize);
        let level = level.min(squares.len());
        let lost = |level: usize| match level {
            0 => 0.0,
            _ => (ranks.mean_square(channel) - squares[level - 1][channel]).max(0.0),
        };
        // The last level has lost all there was: the whole distribution is under its texel.
        let all = lost(squares.len());
        let variance = if all > 0.0 { lost(level) / all * DEVIATION * DEVIATION } else { 0.0 };
        stretched(curves[channel].filtered(variance), |stored| ranks.gaussian(channel, stored))
    });
    let rows: Vec<Vec<f64>> = rows.collect();
    let writer = Writer::new(Format::Rgba16Float);
    let mut bytes = vec![0; table.bytes() as usize];
    let texels = rows.iter().enumerate().flat_map(|(row, values)| {
        let channel = row / levels as usize;
        values.iter().map(move |value| (channel, *value))
    });
    for (slot, (channel, value)) in bytes.chunks_exact_mut(8).zip(texels) {
        let along = DVec3::from_array(axes.directions[channel].map(f64::from));
        let offset = if ranks.is_flat(channel) { 0.0 } else { value - axes.mean_along(channel) };
        let part = along * offset + DVec3::from_array(axes.mean) / axes.channels as f64;
        // A single channel is grey. Slopes along two axes have nothing in common.
        let part = if axes.channels == 1 { DVec3::splat(part.x) } else { part };
        let common = if axes.channels == 2 { 0.0 } else { f16::from_f64(part.element_sum() / 3.0).to_f64() };
        writer.write((part - common).as_vec3().extend(common as f32), slot);
    }
    let last = bytes.len() - 8 * width as usize;
    for slot in bytes[last..].chunks_exact_mut(8) {
        writer.write(Vec4::splat(f32::from(u8::from(is_inside))), slot);
    }
    Made { field: "inverse", table, bytes }
}

/// The entries at stored numbers, which Gaussian ones are more or less close to each other in.
fn stretched(entries: Vec<f64>, gaussian: impl Fn(f64) -> f64) -> Vec<f64> {
    let width = entries.len() as f64;
    let entry = |i: usize| {
        let place = (gaussian((i as f64 + 0.5) / width) * width - 0.5).clamp(0.0, width - 1.0);
        let first = (place as usize).min(entries.len() - 1);
        let next = (first + 1).min(entries.len() - 1);
        entries[first] + (entries[next] - entries[first]) * (place - first as f64)
    };
    (0..entries.len()).map(entry).collect()
}

/// T⁻¹ of a channel.
struct Curve {
    width: u32,
    /// At the middles of the table's entries.
    entries: Vec<f64>,
    /// At the middles of so many parts of each entry.
    fine: Vec<f64>,
    parts: usize,
}

impl Curve {
    fn new(ranks: &Ranks, channel: usize, width: u32) -> Curve {
        let parts = FINE.div_ceil(width);
        // So that lanes fill it.
        let parts = if (parts * width).is_multiple_of(LANES as u32) { parts } else { LANES as u32 };
        let middles = |count: u32| {
            let at = (0..count).map(|i| (f64::from(i) + 0.5) / f64::from(count));
            at.map(|g| ranks.inverse(channel, g)).collect::<Vec<f64>>()
        };
        Curve { width, entries: middles(width), fine: middles(width * parts), parts: parts as usize }
    }

    /// Averaged by a Gaussian of that variance around each entry, cut to 0..1.
    fn filtered(&self, variance: f64) -> Vec<f64> {
        let step = 1.0 / self.fine.len() as f64;
        if variance < step * step {
            return self.entries.clone();
        }
        // Weights of parts so far from an entry: from all to the left to all to the right.
        let reach = self.fine.len();
        let middle = (self.parts as f64 - 1.0) / 2.0;
        let weight = |i: usize| {
            let distance = (i as f64 - reach as f64 - middle) * step;
            libm::exp(-0.5 * distance * distance / variance)
        };
        let weights: Vec<f64> = (0..2 * reach).map(weight).collect();
        let entry = |i: usize| {
            let weights = &weights[reach - i * self.parts..][..reach];
            let sums = weights.as_chunks::<LANES>().0.iter().zip(self.fine.as_chunks::<LANES>().0).fold(
                [[0.0; LANES]; 2],
                |[sums, wholes], (weights, values)| {
                    [
                        std::array::from_fn(|lane| sums[lane] + weights[lane] * values[lane]),
                        std::array::from_fn(|lane| wholes[lane] + weights[lane]),
                    ]
                },
            );
            let [sum, whole] = sums.map(|lanes| lanes.iter().sum::<f64>());
            sum / whole
        };
        (0..self.width as usize).map(entry).collect()
    }
}
