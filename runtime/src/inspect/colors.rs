//! How far colours move when a picture is blended.

use super::blended::{BLENDS, Blend, Shown};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;

/// Distances of Kolmogorov and Smirnov between the picture's numbers and those of its blends: the
/// greatest difference between the shares below any number, 0 to 1. The worst of red, green, blue and
/// the axes along which colours are not correlated (§1.4). Both are sampled between texels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distances {
    /// Of blending that keeps nothing.
    pub linear: f64,
    /// Of blending that keeps the variance (§1.2.2).
    pub variance: f64,
    /// Of blending that keeps the histogram: the method.
    pub histogram: f64,
}

impl Distances {
    /// Of the blends from the first, the picture.
    pub(super) fn between(blends: &[Blend; BLENDS], axes: &[[f32; 3]]) -> Distances {
        let own = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let lines: Vec<[f32; 3]> = own.into_iter().chain(axes.iter().copied()).collect();
        let along: Vec<Along> = lines.into_par_iter().map(|line| Along::of(blends, &line)).collect();
        let widest = along.iter().map(|along| along.range).fold(0.0, f32::max);
        let seen = |along: &&Along| along.range >= widest * SEEN;
        let worst =
            |blend: usize| along.iter().filter(seen).map(|along| along.distances[blend]).fold(0.0, f64::max);
        Distances { linear: worst(1), variance: worst(2), histogram: worst(3) }
    }
}

/// Numbers that close are equal: tables of 16-bit floats tell no more.
const SAME: f32 = 1.0 / 2048.0;

/// Of sorted numbers so many are looked past: their shares are a ten-thousandth apart.
const STRIDE: usize = 16;

/// A line along which numbers take up less than this share of the widest range is not seen.
const SEEN: f32 = 0.05;

/// What is found along a line.
struct Along {
    /// Between a hundredth of the picture's numbers from below and from above.
    range: f32,
    distances: [f64; BLENDS],
}

impl Along {
    fn of(blends: &[Blend; BLENDS], line: &[f32; 3]) -> Along {
        let sorted = blends.each_ref().map(|blend| sorted(&blend.samples, line));
        let [picture, ..] = &sorted;
        let at = |hundredth: usize| picture.get(picture.len() * hundredth / 100).copied().unwrap_or(0.0);
        let distances = sorted.each_ref().map(|blend| distance(picture, blend));
        Along { range: at(99) - at(1), distances }
    }
}

fn sorted(shown: &Shown, line: &[f32; 3]) -> Vec<f32> {
    let place = |[x, y, z]: &[f32; 3]| x * line[0] + y * line[1] + z * line[2];
    let mut places: Vec<f32> = shown.numbers.iter().map(place).collect();
    places.par_sort_unstable_by(f32::total_cmp);
    places
}

/// Both sorted.
fn distance(one: &[f32], other: &[f32]) -> f64 {
    let count = |of: &[f32]| of.len().max(1) as f64;
    let up_to = |of: &[f32], number: f32| of.partition_point(|x| *x <= number) as f64 / count(of);
    let below = |of: &[f32], number: f32| of.partition_point(|x| *x < number) as f64 / count(of);
    let apart = |number: f32| {
        let more = up_to(one, number) - up_to(other, number + SAME);
        let less = below(other, number - SAME) - below(one, number);
        more.max(less)
    };
    one.iter().step_by(STRIDE).map(|number| apart(*number)).fold(0.0, f64::max)
}
