//! The transformation T: a picture's numbers become Gaussian numbers of the same ranks (§1.3.2).
//!
//! The definition is that of listing 1.8: sort all texels of a channel, equal ones in a hashed order
//! (that of the scan would ramp flat areas); texel i of N gets the Gaussian number that (i + ½)/N of
//! all lie below. As it is stored in 8 bits, only 255 ranks matter, those where the stored number
//! changes. Texels are counted in 65,536 bins; a bin between two such ranks has one number, and only
//! the texels of bins that hold such a rank are put in order.

use super::axes::Axes;
use super::gauss::share_below;
use super::light::{BATCH, Light, NONE};
use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, IntoParallelRefIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;

/// How many bins a channel has.
const BINS: usize = 1 << 16;

/// Texels that one thread looks at before it takes more: whole batches.
const BAND: usize = 1024 * BATCH;

/// Texels whose order is looked for at a time.
const PIECE: usize = BAND / 16;

/// A channel that spreads no further is flat: half the least step of 8-bit sRGB.
const FLAT: f64 = 1.5e-4;

/// The stored number of a flat channel, the mean of all.
const MIDDLE: u8 = 128;

/// A picture's numbers along all axes, in bins.
pub struct Ranks {
    texels: usize,
    channels: Vec<Channel>,
}

/// One channel.
struct Channel {
    scale: Scale,
    /// The bin of each texel.
    bins: Vec<u16>,
    /// How many texels are in the bins before each bin, and last how many there are.
    before: Vec<u32>,
    /// The least number in each bin, and the greatest. Many pictures have few numbers, each of several
    /// percent of all texels, which the way back must not miss.
    ends: Vec<[f32; 2]>,
    /// The number that each bin is stored as; from [`STEPPED`] on the place of its steps.
    codes: Vec<u16>,
    steps: Vec<Steps>,
    /// How many texels are stored as each number.
    stored: Vec<u32>,
    is_flat: bool,
    /// How far apart its least number and its greatest are.
    range: f64,
    /// What deviations of Gaussian numbers are multiplied by where they are stored, at most 1.
    spread: f64,
}

/// What a bin holds.
#[derive(Clone, Copy)]
struct Bin {
    texels: u32,
    ends: [f32; 2],
}

impl Bin {
    const EMPTY: Bin = Bin { texels: 0, ends: [f32::MAX, f32::MIN] };

    fn plus(self, other: Bin) -> Bin {
        let ends = [self.ends[0].min(other.ends[0]), self.ends[1].max(other.ends[1])];
        Bin { texels: self.texels + other.texels, ends }
    }
}

/// Codes from here on are of bins that hold several numbers.
const STEPPED: u16 = 256;

/// What the texels of a bin are stored as.
struct Steps {
    /// The bin's first number.
    first: u8,
    /// Plus 1 for each of these keys that is not above a texel's.
    keys: Vec<u64>,
}

/// Which numbers a bin holds. Most lie where most texels do.
#[derive(Clone, Copy)]
struct Scale {
    /// The least number that there can be.
    low: f32,
    /// The ends of the fine bins.
    fine: [f32; 2],
    /// Bins for each unit, between those ends and beyond them.
    bins: [f32; 2],
    /// The first fine bin.
    first: f32,
}

/// The order of equal values, by the number of their texel: a permutation of all 32-bit integers
/// without pattern (xorshift and multiply, as hashes end).
pub fn scatter(i: u32) -> u32 {
    let i = (i ^ (i >> 16)).wrapping_mul(0x7feb_352d);
    let i = (i ^ (i >> 15)).wrapping_mul(0x846c_a68b);
    i ^ (i >> 16)
}

impl Ranks {
    /// Counts, and finds the ranks where stored numbers change. `is_scaled`: channels are stored as far
    /// spread as their numbers are, the widest as far as ever.
    pub fn of(light: &Light<'_>, axes: &Axes, is_scaled: bool) -> Ranks {
        let mut ranks = Ranks::counted(light, axes);
        let widest = ranks.channels.iter().map(|channel| channel.range).fold(0.0, f64::max);
        for (axis, channel) in ranks.channels.iter_mut().enumerate() {
            if is_scaled && channel.range > 0.0 {
                channel.spread = channel.range / widest;
            }
            channel.order(light, axes, axis);
        }
        ranks
    }

    /// Counts only: enough for [`Ranks::bin`], [`Ranks::shares`] and [`Ranks::inverse`], but not for what
    /// has to do with stored numbers.
    pub fn counted(light: &Light<'_>, axes: &Axes) -> Ranks {
        let mut channels: Vec<Channel> =
            (0..axes.channels).map(|axis| Channel::new(light, axes, axis)).collect();
        count(light, axes, &mut channels);
        channels.iter_mut().for_each(Channel::measure);
        Ranks { texels: light.texels(), channels }
    }

    /// The same, with what it knows of each texel forgotten: twice the picture's bytes.
    pub fn without_texels(mut self) -> Ranks {
        self.channels.iter_mut().for_each(|channel| channel.bins = Vec::new());
        self
    }

    /// How a number along a channel's axis is found in [`Ranks::shares`].
    pub fn bin(&self, channel: usize, number: f32) -> usize {
        usize::from(self.channels[channel].scale.bin(number))
    }

    /// For each bin of a channel, from the least on, the share of texels below its middle one.
    pub fn shares(&self, channel: usize) -> impl Iterator<Item = f64> {
        let pairs = self.channels[channel].before.windows(2);
        pairs.map(|pair| (f64::from(pair[0]) + f64::from(pair[1])) / 2.0 / self.texels as f64)
    }

    /// Writes the Gaussian picture: red, green and blue are the channels, 0 where there are less, alpha
    /// is the picture's. The texels' bins are forgotten: they take twice the picture's bytes.
    pub fn write(&mut self, light: &Light<'_>, axes: &Axes, bytes: &mut [u8]) {
        bytes.par_chunks_mut(BAND * 4).enumerate().for_each(|(band, bytes)| {
            let mut numbers = NONE;
            let mut alpha = [0; BATCH];
            for (batch, bytes) in bytes.chunks_mut(BATCH * 4).enumerate() {
                let (first, count) = (band * BAND + batch * BATCH, bytes.len() / 4);
                let (texels, _) = bytes.as_chunks_mut::<4>();
                for (axis, channel) in self.channels.iter().enumerate() {
                    let bins = &channel.bins[first..first + count];
                    for (i, (bin, texel)) in (first..).zip(bins.iter().zip(&mut *texels)) {
                        let code = channel.codes[usize::from(*bin)];
                        texel[axis] = match code {
                            ..STEPPED => code as u8,
                            _ => {
                                light.read(i, 1, &mut numbers);
                                let key = channel.scale.key(axes.place(axis, &numbers, 0), i);
                                channel.steps[usize::from(code - STEPPED)].at(key)
                            }
                        };
                    }
                }
                light.alpha(first, count, &mut alpha);
                texels.iter_mut().zip(alpha).for_each(|(texel, alpha)| texel[3] = alpha);
            }
        });
        self.channels.iter_mut().for_each(|channel| channel.bins = Vec::new());
    }

    /// Whether a channel has one number everywhere.
    pub fn is_flat(&self, channel: usize) -> bool {
        self.channels[channel].is_flat
    }

    /// The Gaussian number that is stored as a number in 0..1.
    pub fn gaussian(&self, channel: usize, stored: f64) -> f64 {
        self.channels[channel].gaussian(stored)
    }

    /// T⁻¹ (§1.3.3): the number along a channel's axis that a Gaussian number in 0..1 stands for.
    pub fn inverse(&self, channel: usize, gaussian: f64) -> f64 {
        let channel = &self.channels[channel];
        let rank = (share_below(gaussian) * self.texels as f64).clamp(0.0, self.texels as f64);
        // The last bin with texels that begins at or below the rank.
        let bin = channel.before.partition_point(|before| f64::from(*before) <= rank).clamp(1, BINS) - 1;
        let bin = (0..=bin).rev().find(|bin| channel.count(*bin) > 0).unwrap_or(bin);
        let within = (rank - f64::from(channel.before[bin])) / f64::from(channel.count(bin).max(1));
        let [least, most] = channel.ends[bin].map(f64::from);
        least + (most - least) * within.clamp(0.0, 1.0)
    }

    /// The mean of the squares of a channel's Gaussian numbers, as they are stored.
    pub fn mean_square(&self, channel: usize) -> f64 {
        let stored = self.channels[channel].stored.iter().enumerate();
        let sum: f64 = stored.map(|(code, count)| f64::from(*count) * (code as f64 / 255.0).powi(2)).sum();
        sum / self.texels as f64
    }
}

/// Puts the texels of all channels into bins.
fn count(light: &Light<'_>, axes: &Axes, channels: &mut [Channel]) {
    let texels = light.texels();
    let scales: Vec<Scale> = channels.iter().map(|channel| channel.scale).collect();
    let mut bins: Vec<_> = channels.iter_mut().map(|channel| channel.bins.chunks_mut(BAND)).collect();
    let bands: Vec<Vec<&mut [u16]>> =
        (0..texels.div_ceil(BAND)).map(|_| bins.iter_mut().filter_map(Iterator::next).collect()).collect();
    // As many counts as threads, whatever band each takes: sums of integers don't mind.
    let none = || vec![vec![Bin::EMPTY; BINS]; scales.len()];
    let share = bands.len().div_ceil(rayon::current_num_threads());
    let counts =
        bands.into_par_iter().enumerate().with_min_len(share).fold(none, |mut counts, (band, mut bins)| {
            let mut numbers = NONE;
            let mut places = [0.0; BATCH];
            let length = bins.first().map_or(0, |bins| bins.len());
            for first in (0..length).step_by(BATCH) {
                let count = BATCH.min(length - first);
                light.read(band * BAND + first, count, &mut numbers);
                for (axis, scale) in scales.iter().enumerate() {
                    axes.along(axis, &numbers, &mut places);
                    let slots = &mut bins[axis][first..first + count];
                    for (slot, place) in slots.iter_mut().zip(&places) {
                        *slot = scale.bin(*place);
                    }
                    for (slot, place) in slots.iter().zip(&places) {
                        let bin = &mut counts[axis][usize::from(*slot)];
                        *bin = bin.plus(Bin { texels: 1, ends: [*place; 2] });
                    }
                }
            }
            counts
        });
    let counts = counts.reduce_with(|mut sum, other| {
        for (sum, other) in sum.iter_mut().flatten().zip(other.iter().flatten()) {
            *sum = sum.plus(*other);
        }
        sum
    });
    for (channel, counts) in channels.iter_mut().zip(counts.unwrap_or_default()) {
        channel.ends = counts.iter().map(|bin| bin.ends).collect();
        let running = counts.iter().scan(0, |sum, bin| {
            let before = *sum;
            *sum += bin.texels;
            Some(before)
        });
        channel.before = running.chain(std::iter::once(texels as u32)).collect();
    }
}

impl Scale {
    /// Of an axis on which numbers lie between two ends: all bins but a few lie within six deviations
    /// of the mean.
    fn new([low, high]: [f32; 2], mean: f32, deviation: f32) -> Scale {
        let fine = [mean - 6.0 * deviation, mean + 6.0 * deviation].map(|end| end.clamp(low, high));
        let width = fine[1] - fine[0];
        let beyond = (high - low - width).max(0.0);
        let all = (BINS - 1) as f32;
        let coarse = if beyond > 0.0 { all / 16.0 / beyond } else { 0.0 };
        let first = coarse * (fine[0] - low);
        Scale { low, fine, bins: [(all - coarse * beyond) / width.max(1e-6), coarse], first }
    }

    /// The bin of a number: floats near 2²³ are whole numbers.
    #[inline(always)]
    fn bin(&self, number: f32) -> u16 {
        let near = number.clamp(self.fine[0], self.fine[1]);
        let place = (near - self.fine[0]) * self.bins[0] + (number - near) * self.bins[1] + self.first;
        (place.clamp(0.0, (BINS - 1) as f32) + 8_388_608.0).to_bits() as u16
    }

    /// The order of a texel: first by its number, then hashed.
    fn key(&self, number: f32, texel: usize) -> u64 {
        (u64::from((number - self.low).max(0.0).to_bits()) << 32) | u64::from(scatter(texel as u32))
    }
}

impl Steps {
    fn at(&self, key: u64) -> u8 {
        self.first + self.keys.iter().filter(|step| **step <= key).count() as u8
    }
}

impl Channel {
    fn new(light: &Light<'_>, axes: &Axes, axis: usize) -> Channel {
        let (low, high) = light.range();
        let along = &axes.directions[axis][..axes.channels];
        // A little beyond, for sums are rounded.
        let least = along.iter().map(|x| (x * low).min(x * high)).sum::<f32>() - 1e-5;
        let most = along.iter().map(|x| (x * low).max(x * high)).sum::<f32>() + 1e-5;
        let deviation = axes.variances[axis].max(0.0).sqrt() as f32;
        Channel {
            scale: Scale::new([least, most], axes.mean_along(axis) as f32, deviation),
            bins: vec![0; light.texels()],
            before: Vec::new(),
            ends: Vec::new(),
            codes: vec![u16::from(MIDDLE); BINS],
            steps: Vec::new(),
            stored: Vec::new(),
            is_flat: false,
            range: 0.0,
            spread: 1.0,
        }
    }

    /// Finds how far its numbers spread.
    fn measure(&mut self) {
        let filled = |bin: &usize| self.count(*bin) > 0;
        let ends = [(0..BINS).find(filled), (0..BINS).rfind(filled)].map(Option::unwrap_or_default);
        self.range = f64::from(self.ends[ends[1]][1]) - f64::from(self.ends[ends[0]][0]);
        self.is_flat = self.range <= FLAT;
    }

    /// The Gaussian number that is stored as a number in 0..1.
    fn gaussian(&self, stored: f64) -> f64 {
        ((stored - 0.5) / self.spread + 0.5).clamp(0.0, 1.0)
    }

    fn count(&self, bin: usize) -> u32 {
        self.before[bin + 1] - self.before[bin]
    }

    /// Finds what each bin is stored as.
    fn order(&mut self, light: &Light<'_>, axes: &Axes, axis: usize) {
        let texels = light.texels();
        if self.is_flat {
            self.stored = vec![0; 256];
            self.stored[usize::from(MIDDLE)] = texels as u32;
            return;
        }
        // The first rank of each stored number but 0, of texels 0..N.
        let first_rank = |code: u32| {
            let below = share_below(self.gaussian((f64::from(code) - 0.5) / 255.0)) * texels as f64;
            (below - 0.5).ceil().clamp(0.0, texels as f64) as u32
        };
        let ranks: Vec<u32> = (1..256).map(first_rank).collect();
        let ends = ranks.iter().copied().chain(std::iter::once(texels as u32));
        self.stored = ends.scan(0, |last, end| Some(end - std::mem::replace(last, end))).collect();
        // The ranks at which the number changes within a bin come after its first.
        let mut changes: Vec<(u8, u32, &[u32])> = Vec::new();
        let mut passed = 0;
        for bin in 0..BINS {
            let [first, end] = [self.before[bin], self.before[bin + 1]];
            passed += ranks[passed..].iter().take_while(|rank| **rank <= first).count();
            let within = ranks[passed..].iter().take_while(|rank| **rank < end).count();
            self.codes[bin] = if within == 0 { passed as u16 } else { STEPPED + changes.len() as u16 };
            if within > 0 {
                changes.push((passed as u8, first, &ranks[passed..passed + within]));
                passed += within;
            }
        }
        let sizes = self.codes.iter().zip(self.before.windows(2));
        let sizes = sizes.filter(|(code, _)| **code >= STEPPED).map(|(_, before)| before[1] - before[0]);
        let sizes: Vec<u32> = sizes.collect();
        // Keys take eight bytes: of half the texels at a time.
        while self.steps.len() < changes.len() {
            let begin = self.steps.len();
            let within = sizes[begin..].iter().scan(0, |sum, size| {
                *sum += *size as usize;
                Some(*sum)
            });
            let count = within.take_while(|sum| *sum <= texels / 2).count().max(1);
            let keys = self.keys(light, axes, axis, begin, &sizes[begin..begin + count]);
            self.steps.extend(changes[begin..].iter().zip(keys).map(|((code, first, ranks), mut keys)| {
                let keys = ranks.iter().map(|rank| *keys.select_nth_unstable((rank - first) as usize).1);
                Steps { first: *code, keys: keys.collect() }
            }));
        }
    }

    /// The keys of the texels in bins that hold several stored numbers: in those from a place among them
    /// on, of these numbers of texels.
    fn keys(
        &self,
        light: &Light<'_>,
        axes: &Axes,
        axis: usize,
        begin: usize,
        sizes: &[u32],
    ) -> Vec<Vec<u64>> {
        let mut keys: Vec<Vec<u64>> = sizes.iter().map(|size| Vec::with_capacity(*size as usize)).collect();
        let first = STEPPED + begin as u16;
        let codes = first..first + sizes.len() as u16;
        let found = |(piece, bins): (usize, &[u16])| {
            let mut numbers = NONE;
            let mut found = Vec::new();
            for (i, bin) in (piece * PIECE..).zip(bins) {
                let code = self.codes[usize::from(*bin)];
                if codes.contains(&code) {
                    light.read(i, 1, &mut numbers);
                    found.push((code - first, self.scale.key(axes.place(axis, &numbers, 0), i)));
                }
            }
            found
        };
        // A few at a time: all that is found would take several times the picture's bytes.
        let pieces: Vec<(usize, &[u16])> = self.bins.chunks(PIECE).enumerate().collect();
        for pieces in pieces.chunks(8 * rayon::current_num_threads()) {
            let found: Vec<Vec<(u16, u64)>> = pieces.par_iter().map(|piece| found(*piece)).collect();
            found.into_iter().flatten().for_each(|(bin, key)| keys[usize::from(bin)].push(key));
        }
        keys
    }
}
