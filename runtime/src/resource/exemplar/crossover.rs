//! A picture's borders crossed over with its middle, so that a picture wraps that did not.
//!
//! ```text
//!  weight of the picture    ╭──────╮    of the picture shifted by half   ╮      ╭
//!  along an axis          ──╯      ╰──  of it, whose seam is here:       ╰──┊───╯
//! ```
//!
//! Four copies are blended: the picture, shifted across, shifted down, and both. Where one has its seam it
//! has no weight, and the middle of the picture is left as it is. The blend is that of exemplars
//! (Deliot & Heitz, GPU Zen 2, 2019, §1.2 and §1.3; Heitz & Neyret, High-Performance By-Example Noise
//! using a Histogram-Preserving Blending Operator, 2018): along the principal axes of all colours
//! numbers become Gaussian numbers of the same ranks, deviations are summed and divided by the root of
//! the sum of squared weights, which keeps their variance, and the sum goes the way back. So contrast
//! and colours stay, where a linear blend is flat and grey.

use super::axes::Axes;
use super::gauss::Quantiles;
use super::light::{Light, MAX_CHANNELS, NONE};
use super::ranks::Ranks;
use crate::resource::decode::Decoded;
use glam::{Vec3, Vec4};
use texgraph_compiler::manifest::Encoding;

/// The part of a side, at each border, in which the picture gains its weight.
const WIDTH: f64 = 1.0 / 8.0;

/// How finely T⁻¹ is kept: entries from 0 to 1.
const FINE: usize = 1 << 14;

/// A picture that is made to wrap.
pub struct Crossover<'a> {
    picture: &'a Decoded,
    light: Light<'a>,
    is_normal: bool,
    is_premultiplied: bool,
    axes: Axes,
    ranks: Ranks,
    channels: Vec<Channel>,
    /// Across and down: the picture's weight at each texel.
    weights: [Vec<f32>; 2],
}

/// The two ways between numbers along an axis and Gaussian numbers.
struct Channel {
    /// T, by the bin of a number: its Gaussian number's deviation from ½.
    deviations: Vec<f32>,
    /// T⁻¹ at the middles of even steps from 0 to 1.
    numbers: Vec<f32>,
}

impl<'a> Crossover<'a> {
    /// Prepares to blend. Which texels with which weight depends on the size alone, so that all pictures
    /// of one material stay in line.
    pub fn new(picture: &'a Decoded, encoding: Encoding) -> Crossover<'a> {
        let channels = match (encoding, picture.is_grey()) {
            (Encoding::Normal, _) => 2,
            (Encoding::Srgb | Encoding::Linear, true) => 1,
            (Encoding::Srgb | Encoding::Linear, false) => MAX_CHANNELS,
        };
        let light = Light::new(picture, encoding, channels);
        let axes = Axes::of(&light);
        let ranks = Ranks::counted(&light, &axes);
        let quantiles = Quantiles::new(FINE);
        let channels = (0..axes.channels).map(|axis| Channel::new(axis, &axes, &ranks, &quantiles)).collect();
        Crossover {
            picture,
            is_normal: encoding == Encoding::Normal,
            is_premultiplied: encoding == Encoding::Srgb,
            light,
            axes,
            ranks: ranks.without_texels(),
            channels,
            weights: picture.size.map(|side| (0..side).map(|i| weight(i, side)).collect()),
        }
    }

    /// A blended texel: linear premultiplied light, data, or a unit normal with alpha 1. None where
    /// the picture has all the weight: there it stays as it is, to the bit.
    pub fn texel(&self, x: u32, y: u32) -> Option<Vec4> {
        let [across, down] = [self.weights[0][x as usize], self.weights[1][y as usize]];
        if across == 1.0 && down == 1.0 {
            return None;
        }
        let [width, height] = self.light.size;
        let [far_x, far_y] = [(x + width / 2) % width, (y + height / 2) % height];
        let copies = [
            (x, y, across * down),
            (far_x, y, (1.0 - across) * down),
            (x, far_y, across * (1.0 - down)),
            (far_x, far_y, (1.0 - across) * (1.0 - down)),
        ];
        let (mut sums, mut squares, mut alpha) = ([0.0; MAX_CHANNELS], 0.0, 0.0);
        let mut numbers = NONE;
        for (x, y, weight) in copies.into_iter().filter(|(.., weight)| *weight > 0.0) {
            self.light.read(y as usize * width as usize + x as usize, 1, &mut numbers);
            for (axis, channel) in self.channels.iter().enumerate() {
                let bin = self.ranks.bin(axis, self.axes.place(axis, &numbers, 0));
                sums[axis] += weight * channel.deviations[bin];
            }
            squares += weight * weight;
            alpha += weight * self.picture.depth.number(self.picture.texel(x, y)[3]);
        }
        let mut numbers = Vec3::ZERO;
        for (axis, channel) in self.channels.iter().enumerate() {
            numbers += Vec3::from(self.axes.directions[axis]) * channel.number(sums[axis] / squares.sqrt());
        }
        Some(self.meaning(numbers, alpha))
    }

    /// What a texel's numbers stand for.
    fn meaning(&self, numbers: Vec3, alpha: f32) -> Vec4 {
        if self.is_normal {
            return Vec3::new(-numbers.x, -numbers.y, 1.0).normalize().extend(1.0);
        }
        // Sums of what the axes have may leave the range a little.
        let (low, high) = self.light.range();
        let numbers = if self.channels.len() == 1 { Vec3::splat(numbers.x) } else { numbers };
        let numbers = numbers.clamp(Vec3::splat(low), Vec3::splat(high));
        (if self.is_premultiplied { numbers * alpha } else { numbers }).extend(alpha)
    }
}

impl Channel {
    fn new(axis: usize, axes: &Axes, ranks: &Ranks, quantiles: &Quantiles) -> Channel {
        let deviations = ranks.shares(axis).map(|share| (quantiles.number(share) - 0.5) as f32);
        let number = |entry: usize| match ranks.is_flat(axis) {
            true => axes.mean_along(axis) as f32,
            false => ranks.inverse(axis, (entry as f64 + 0.5) / FINE as f64) as f32,
        };
        Channel { deviations: deviations.collect(), numbers: (0..FINE).map(number).collect() }
    }

    /// T⁻¹ of a Gaussian number, given as its deviation from ½.
    fn number(&self, deviation: f32) -> f32 {
        let entry = ((deviation + 0.5) * FINE as f32).clamp(0.0, (FINE - 1) as f32);
        self.numbers[entry as usize]
    }
}

/// The weight of the picture at texel i of n: 0 at the borders, 1 from [`WIDTH`] on, smooth at both ends.
fn weight(i: u32, n: u32) -> f32 {
    let from_border = (f64::from(i.min(n - 1 - i)) + 0.5) / f64::from(n);
    let way = (from_border / WIDTH).min(1.0);
    (way * way * (3.0 - 2.0 * way)) as f32
}

#[cfg(test)]
mod tests {
    use super::super::scatter;
    use super::Crossover;
    use crate::resource::decode::Decoded;
    use crate::resource::encoding::Reader;
    use glam::{Vec3, Vec4};
    use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
    use texgraph_compiler::manifest::Encoding;

    /// Grains of a few texels, and light that falls from one corner to the other, from 0 to this.
    fn photograph(size: [u32; 2], slope: u32) -> Decoded {
        let grain = |x: u32, y: u32, k: u32| scatter(3 * (y * size[0] + x) + k) >> 25;
        let sample = |i: u32| {
            let (x, y, k) = (i / 3 % size[0], i / 3 / size[0], i % 3);
            let near = [(0, 0), (1, 0), (0, 1), (1, 1)];
            let shared = near.map(|(dx, dy)| grain((x + dx) % size[0], (y + dy) % size[1], 0));
            let light = slope * x / size[0] + slope * y / size[1];
            (shared.iter().sum::<u32>() / 4 + grain(x, y, k) / 4 + light / 2) as u8
        };
        let samples = (0..3 * size[0] * size[1]).map(sample).collect();
        Decoded::rgb(size, samples).expect("a picture")
    }

    /// Normals that stand up more or less.
    fn normals(size: [u32; 2]) -> Decoded {
        let grains = photograph(size, 0);
        let texels = (0..size[0] * size[1]).map(|i| grains.texel(i % size[0], i / size[0]));
        let samples = texels.flat_map(|[x, y, ..]| [x as u8 + 96, y as u8 + 96, 230]);
        Decoded::rgb(size, samples.collect()).expect("a picture")
    }

    fn unblended(picture: &Decoded, encoding: Encoding) -> Vec<Vec4> {
        let reader = Reader::new(picture, encoding);
        let [width, height] = picture.size;
        (0..width * height).map(|i| reader.texel(i % width, i / width)).collect()
    }

    fn blended(picture: &Decoded, encoding: Encoding) -> Vec<Vec4> {
        let crossover = Crossover::new(picture, encoding);
        let texels = unblended(picture, encoding).into_par_iter().enumerate();
        let [width, _] = picture.size;
        let texel = |i: u32| crossover.texel(i % width, i / width);
        texels.map(|(i, before)| texel(i as u32).unwrap_or(before)).collect()
    }

    /// Across and down: the mean step between neighbours, and that across the borders.
    fn steps(texels: &[Vec4], [width, height]: [u32; 2]) -> [[f32; 2]; 2] {
        let step = |x: u32, y: u32, dx: u32, dy: u32| {
            let at = |x: u32, y: u32| texels[((y % height) * width + x % width) as usize];
            (at(x, y) - at(x + dx, y + dy)).abs().element_sum()
        };
        let columns = |x: u32| (0..height).map(|y| step(x, y, 1, 0)).sum::<f32>() / height as f32;
        let rows = |y: u32| (0..width).map(|x| step(x, y, 0, 1)).sum::<f32>() / width as f32;
        let mean = |n: u32, line: &dyn Fn(u32) -> f32| (0..n - 1).map(line).sum::<f32>() / (n - 1) as f32;
        [[mean(width, &columns), columns(width - 1)], [mean(height, &rows), rows(height - 1)]]
    }

    #[test]
    fn steps_across_the_borders_are_those_inside() {
        for size in [[256, 256], [301, 203], [128, 64]] {
            let picture = photograph(size, 120);
            for encoding in [Encoding::Srgb, Encoding::Linear] {
                for [inside, across] in steps(&unblended(&picture, encoding), size) {
                    assert!(across > 1.6 * inside, "{size:?}: {across} beside {inside} before");
                }
                // Means of 64 steps or more, whose deviation is at most as large as they are: four
                // deviations of one in eight.
                for [inside, across] in steps(&blended(&picture, encoding), size) {
                    assert!((across / inside - 1.0).abs() < 0.5, "{size:?}: {across} beside {inside}");
                }
            }
        }
    }

    #[test]
    fn no_line_of_the_picture_is_a_seam() {
        let size = [256, 256];
        let texels = blended(&photograph(size, 120), Encoding::Srgb);
        let line = |x: usize, dx: usize| {
            let step = |y: usize| texels[y * 256 + x % 256] - texels[y * 256 + (x + dx) % 256];
            (0..256).map(|y| step(y).abs().element_sum()).sum::<f32>()
        };
        let mean = (0..256).map(|x| line(x, 1)).sum::<f32>() / 256.0;
        let most = (0..256).map(|x| line(x, 1)).fold(0.0, f32::max);
        // Seams of the slope are 1.6 times as high as steps are, and more.
        assert!(most < 1.5 * mean, "{most} beside {mean}");
    }

    #[test]
    fn the_middle_is_untouched() {
        let picture = photograph([96, 80], 120);
        let crossover = Crossover::new(&picture, Encoding::Srgb);
        for (x, y) in (0..96).flat_map(|x| (0..80).map(move |y| (x, y))) {
            let is_middle = (12..84).contains(&x) && (10..70).contains(&y);
            assert_eq!(crossover.texel(x, y).is_none(), is_middle, "{x}, {y}");
        }
    }

    #[test]
    fn colours_keep_their_distribution() {
        for encoding in [Encoding::Srgb, Encoding::Linear, Encoding::Normal] {
            let size = [256, 256];
            let picture = if encoding == Encoding::Normal { normals(size) } else { photograph(size, 0) };
            let moments = |texels: Vec<Vec4>| {
                let count = texels.len() as f32;
                let mean = texels.iter().map(|texel| texel.truncate()).sum::<Vec3>() / count;
                let squares = texels.iter().map(|texel| (texel.truncate() - mean).powf(2.0));
                (mean, squares.sum::<Vec3>() / count)
            };
            // Normals are made of unit length everywhere, to compare them.
            let whole = |texel: &Vec4| match encoding {
                Encoding::Normal => texel.truncate().normalize().extend(1.0),
                _ => *texel,
            };
            let before = moments(unblended(&picture, encoding).iter().map(whole).collect());
            let after = moments(blended(&picture, encoding).iter().map(whole).collect());
            // A grain's light is shared by four texels, and a texel stands in up to four others: of 65,536
            // texels 4096 count by themselves, seven sixteenths of them blended. Four deviations of their
            // mean are (4 · √(7/16) / 64) = 1/24 of theirs; of their variance √2 times that.
            let deviation = before.1.map(f32::sqrt);
            let means = (after.0 - before.0).abs() / deviation;
            let variances = (after.1 / before.1 - 1.0).abs();
            assert!(means.max_element() < 1.0 / 24.0, "{encoding:?}: {means}");
            assert!(variances.max_element() < 0.06, "{encoding:?}: {variances}");
        }
    }

    #[test]
    fn pictures_of_any_size_are_blended() {
        for size in [[1, 1], [1, 40], [40, 1], [2, 2], [3, 5], [9, 9], [17, 4]] {
            let picture = photograph(size, 120);
            for encoding in [Encoding::Srgb, Encoding::Linear, Encoding::Normal] {
                for texel in blended(&picture, encoding) {
                    assert!(texel.is_finite(), "{size:?}, {encoding:?}");
                    assert!(texel.abs().max_element() <= 1.0, "{size:?}, {encoding:?}: {texel}");
                }
            }
        }
    }

    #[test]
    fn a_flat_picture_stays_as_it_is() {
        let picture = Decoded::rgb([16, 16], [10, 200, 60].repeat(256)).expect("a picture");
        let before = unblended(&picture, Encoding::Srgb);
        for (before, after) in before.iter().zip(blended(&picture, Encoding::Srgb)) {
            assert!(before.abs_diff_eq(after, 1e-5), "{before} became {after}");
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_texels() {
        let picture = photograph([300, 200], 120);
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| blended(&picture, Encoding::Srgb))
        };
        assert_eq!(on(1), on(3));
    }
}
