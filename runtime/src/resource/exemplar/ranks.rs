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
use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
use rayon::slice::{ParallelSlice, ParallelSliceMut};

/// How many bins a channel has.
const BINS: usize = 1 << 16;

/// Texels that one thread looks at before it takes more: whole batches.
const BAND: usize = 1024 * BATCH;

/// A channel that spreads no further is flat: half the least step of 8-bit sRGB.
const FLAT: f32 = 1.5e-4;

/// The stored number of a flat channel, the mean of all.
const MIDDLE: u8 = 128;

/// A picture's numbers along all axes, in bins.
pub struct Ranks {
    texels: usize,
    channels: Vec<Channel>,
}

/// One channel.
struct Channel {
    /// The least number that there can be, and bins for each unit above it.
    low: f32,
    scale: f32,
    /// The bin of each texel.
    bins: Vec<u16>,
    /// How many texels are in the bins before each bin, and last how many there are.
    before: Vec<u32>,
    /// What each bin is stored as.
    codes: Vec<Code>,
    /// How many texels are stored as each number.
    stored: Vec<u32>,
}

/// What the texels of a bin are stored as.
#[derive(Clone)]
enum Code {
    /// All as one number.
    One(u8),
    /// As this number, plus 1 for each of the keys that is not above the texel's.
    Steps(u8, Vec<u64>),
}

/// The order of a texel: first by its number, not below 0, then hashed.
fn key(number: f32, texel: usize) -> u64 {
    (u64::from(number.to_bits()) << 32) | u64::from(scatter(texel as u32))
}

/// The order of equal values, by the number of their texel: a permutation of all 32-bit integers
/// without pattern (xorshift and multiply, as hashes end).
pub fn scatter(i: u32) -> u32 {
    let i = (i ^ (i >> 16)).wrapping_mul(0x7feb_352d);
    let i = (i ^ (i >> 15)).wrapping_mul(0x846c_a68b);
    i ^ (i >> 16)
}

impl Ranks {
    /// Counts, and finds the ranks where stored numbers change.
    pub fn of(light: &Light<'_>, axes: &Axes) -> Ranks {
        let mut channels: Vec<Channel> = (0..axes.channels).map(|axis| Channel::new(light, axes, axis)).collect();
        count(light, axes, &mut channels);
        for (axis, channel) in channels.iter_mut().enumerate() {
            channel.order(light, axes, axis);
        }
        Ranks { texels: light.texels(), channels }
    }

    /// Writes the Gaussian picture: red, green and blue are the channels, 0 where there are less, alpha
    /// is the picture's.
    pub fn write(&self, light: &Light<'_>, axes: &Axes, bytes: &mut [u8]) {
        bytes.par_chunks_mut(BAND * 4).enumerate().for_each(|(band, bytes)| {
            let mut numbers = NONE;
            let (mut places, mut alpha) = ([0.0; BATCH], [0; BATCH]);
            for (batch, bytes) in bytes.chunks_mut(BATCH * 4).enumerate() {
                let first = band * BAND + batch * BATCH;
                let count = bytes.len() / 4;
                let mut is_read = false;
                for (axis, channel) in self.channels.iter().enumerate() {
                    let bins = &channel.bins[first..first + count];
                    let mut is_ordered = false;
                    for (i, (bin, texel)) in bins.iter().zip(bytes.chunks_exact_mut(4)).enumerate() {
                        texel[axis] = match &channel.codes[usize::from(*bin)] {
                            Code::One(code) => *code,
                            Code::Steps(code, keys) => {
                                if !is_read {
                                    light.read(first, count, &mut numbers);
                                    is_read = true;
                                }
                                if !is_ordered {
                                    axes.along(axis, &numbers, &mut places);
                                    is_ordered = true;
                                }
                                let key = key(places[i] - channel.low, first + i);
                                code + keys.iter().filter(|step| **step <= key).count() as u8
                            }
                        };
                    }
                }
                light.alpha(first, count, &mut alpha);
                for (texel, alpha) in bytes.chunks_exact_mut(4).zip(alpha) {
                    texel[3] = alpha;
                }
            }
        });
    }

    /// Whether a channel has one number everywhere.
    pub fn is_flat(&self, channel: usize) -> bool {
        self.channels[channel].is_flat()
    }

    /// T⁻¹ (§1.3.3): the number along a channel's axis that a Gaussian number in 0..1 stands for.
    pub fn inverse(&self, channel: usize, gaussian: f64) -> f64 {
        let channel = &self.channels[channel];
        let rank = (share_below(gaussian) * self.texels as f64).clamp(0.0, self.texels as f64);
        // The last bin with texels that begins at or below the rank.
        let bin = channel.before.partition_point(|before| f64::from(*before) <= rank).clamp(1, BINS) - 1;
        let bin = (0..=bin).rev().find(|bin| channel.count(*bin) > 0).unwrap_or(bin);
        let within = (rank - f64::from(channel.before[bin])) / f64::from(channel.count(bin).max(1));
        let place = bin as f64 + within.clamp(0.0, 1.0);
        f64::from(channel.low) + place / f64::from(channel.scale)
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
    let scales: Vec<(f32, f32)> = channels.iter().map(|channel| (channel.low, channel.scale)).collect();
    let mut bins: Vec<_> = channels.iter_mut().map(|channel| channel.bins.chunks_mut(BAND)).collect();
    let bands: Vec<Vec<&mut [u16]>> = (0..texels.div_ceil(BAND))
        .map(|_| bins.iter_mut().filter_map(Iterator::next).collect())
        .collect();
    // As many counts as threads, whatever band each takes: sums of integers don't mind.
    let none = || vec![vec![0_u32; BINS]; scales.len()];
    let share = bands.len().div_ceil(rayon::current_num_threads());
    let counts = bands.into_par_iter().enumerate().with_min_len(share).fold(none, |mut counts, (band, mut bins)| {
        let mut numbers = NONE;
        let mut places = [0.0; BATCH];
        let length = bins.first().map_or(0, |bins| bins.len());
        for first in (0..length).step_by(BATCH) {
            let count = BATCH.min(length - first);
            light.read(band * BAND + first, count, &mut numbers);
            for (axis, (low, scale)) in scales.iter().enumerate() {
                axes.along(axis, &numbers, &mut places);
                let slots = &mut bins[axis][first..first + count];
                for (slot, place) in slots.iter_mut().zip(&places) {
                    *slot = bin(*place, *low, *scale);
                }
                slots.iter().for_each(|slot| counts[axis][usize::from(*slot)] += 1);
            }
        }
        counts
    });
    let counts = counts.reduce(none, |mut sum, other| {
        for (sum, other) in sum.iter_mut().flatten().zip(other.iter().flatten()) {
            *sum += other;
        }
        sum
    });
    for (channel, counts) in channels.iter_mut().zip(counts) {
        let running = counts.iter().scan(0, |sum, count| {
            let before = *sum;
            *sum += count;
            Some(before)
        });
        channel.before = running.chain(std::iter::once(texels as u32)).collect();
    }
}

/// The bin of a number: whole numbers are what floats near 2²³ are.
#[inline(always)]
fn bin(number: f32, low: f32, scale: f32) -> u16 {
    let place = ((number - low) * scale).clamp(0.0, (BINS - 1) as f32);
    (place + 8_388_608.0).to_bits() as u16
}

impl Channel {
    fn new(light: &Light<'_>, axes: &Axes, axis: usize) -> Channel {
        let (low, high) = light.range();
        let along = axes.directions[axis];
        let ends = along[..axes.channels].iter().map(|x| (x * low).min(x * high)).sum::<f32>();
        let low_end = if axes.channels == 1 { low } else { ends };
        let high_end = if axes.channels == 1 {
            high
        } else {
            along[..axes.channels].iter().map(|x| (x * low).max(x * high)).sum::<f32>()
        };
        Channel {
            // A little beyond, for sums are rounded.
            low: low_end - 1e-5,
            scale: (BINS - 2) as f32 / (high_end - low_end + 2e-5),
            bins: vec![0; light.texels()],
            before: Vec::new(),
            codes: Vec::new(),
            stored: Vec::new(),
        }
    }

    fn count(&self, bin: usize) -> u32 {
        self.before[bin + 1] - self.before[bin]
    }

    fn is_flat(&self) -> bool {
        let filled = |bin: &usize| self.count(*bin) > 0;
        let (first, last) = ((0..BINS).find(filled), (0..BINS).rfind(filled));
        first.zip(last).is_none_or(|(first, last)| (last - first) as f32 <= FLAT * self.scale)
    }

    /// Finds what each bin is stored as.
    fn order(&mut self, light: &Light<'_>, axes: &Axes, axis: usize) {
        let texels = light.texels();
        if self.is_flat() {
            self.codes = vec![Code::One(MIDDLE); BINS];
            self.stored = (0..256_usize).map(|code| if code == usize::from(MIDDLE) { texels as u32 } else { 0 }).collect();
            return;
        }
        // The first rank of each stored number but 0, of texels 0..N.
        let first_rank = |code: u32| {
            let below = share_below((f64::from(code) - 0.5) / 255.0) * texels as f64;
            (below - 0.5).ceil().clamp(0.0, texels as f64) as u32
        };
        let ranks: Vec<u32> = (1..256).map(first_rank).collect();
        let ends = ranks.iter().copied().chain(std::iter::once(texels as u32));
        self.stored = ends.scan(0, |last, end| Some(end - std::mem::replace(last, end))).collect();
        // Where in a bin the number changes: at ranks after its first, before its end.
        let changes = |bin: usize| {
            let (first, end) = (self.before[bin], self.before[bin + 1]);
            let (from, to) = (ranks.partition_point(|r| *r <= first), ranks.partition_point(|r| *r < end));
            (from, from.max(to))
        };
        let changes: Vec<(usize, usize)> = (0..BINS).map(changes).collect();
        let mut keys = self.keys(light, axes, axis, |bin| changes[bin].0 < changes[bin].1);
        self.codes = changes
            .iter()
            .enumerate()
            .map(|(bin, (from, to))| {
                let Some(keys) = keys.get_mut(&(bin as u16)).filter(|_| from < to) else {
                    return Code::One(*from as u8);
                };
                let steps = ranks[*from..*to].iter().map(|rank| {
                    let place = (rank - self.before[bin]) as usize;
                    *keys.select_nth_unstable(place).1
                });
                Code::Steps(*from as u8, steps.collect())
            })
            .collect();
    }

    /// The keys of all texels in some bins.
    fn keys(
        &self,
        light: &Light<'_>,
        axes: &Axes,
        axis: usize,
        is_wanted: impl Fn(usize) -> bool,
    ) -> std::collections::BTreeMap<u16, Vec<u64>> {
        let wanted: Vec<bool> = (0..BINS).map(is_wanted).collect();
        let bands = self.bins.par_chunks(BAND).enumerate().map(|(band, bins)| {
            let mut numbers = NONE;
            let mut places = [0.0; BATCH];
            let mut found = Vec::new();
            for (batch, bins) in bins.chunks(BATCH).enumerate() {
                if !bins.iter().any(|bin| wanted[usize::from(*bin)]) {
                    continue;
                }
                let first = band * BAND + batch * BATCH;
                light.read(first, bins.len(), &mut numbers);
                axes.along(axis, &numbers, &mut places);
                for (i, bin) in bins.iter().enumerate().filter(|(_, bin)| wanted[usize::from(**bin)]) {
                    found.push((*bin, key(places[i] - self.low, first + i)));
                }
            }
            found
        });
        let bands: Vec<Vec<(u16, u64)>> = bands.collect();
        let mut keys = std::collections::BTreeMap::<u16, Vec<u64>>::new();
        for bin in (0..BINS).filter(|bin| wanted[*bin]) {
            keys.insert(bin as u16, Vec::with_capacity(self.count(bin) as usize));
        }
        for (bin, key) in bands.into_iter().flatten() {
            keys.entry(bin).or_default().push(key);
        }
        keys
    }
}
