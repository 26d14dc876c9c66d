//! The numbers of a picture that are made Gaussian: linear light, data, or slopes.

use crate::resource::decode::Decoded;
use crate::resource::encoding;
use texgraph_compiler::manifest::Encoding;

/// The most numbers of a texel.
pub const MAX_CHANNELS: usize = 3;

/// Texels that are looked at together.
pub const BATCH: usize = 64;

/// The numbers of so many texels, channel by channel.
pub type Numbers = [[f32; BATCH]; MAX_CHANNELS];

/// Before anything is read.
pub const NONE: Numbers = [[0.0; BATCH]; MAX_CHANNELS];

/// The steepest slope of a normal, 87°: steeper ones, and those that point down, count as that.
const STEEPEST: f32 = 20.0;

/// A picture, read as numbers.
pub struct Light<'a> {
    picture: &'a Decoded,
    /// Texels across and down.
    pub size: [u32; 2],
    /// How many numbers a texel has, 1 to 3.
    pub channels: usize,
    /// Whether they are slopes.
    is_normal: bool,
    /// What a sample stands for.
    curve: Vec<f32>,
}

impl<'a> Light<'a> {
    /// Prepares to read a picture.
    pub fn new(picture: &'a Decoded, encoding: Encoding, channels: usize) -> Light<'a> {
        Light {
            picture,
            size: picture.size,
            channels: channels.clamp(1, MAX_CHANNELS),
            is_normal: encoding == Encoding::Normal,
            curve: encoding::curve(encoding, picture.white()),
        }
    }

    /// How many texels there are.
    pub fn texels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// The least and the greatest that a number can be.
    pub fn range(&self) -> (f32, f32) {
        if self.is_normal { (-STEEPEST, STEEPEST) } else { (0.0, 1.0) }
    }

    /// The numbers of up to a batch of texels, row by row from the `first` on; the rest is as it was.
    pub fn read(&self, first: usize, count: usize, numbers: &mut Numbers) {
        if self.is_normal {
            self.picture.read(first, count, |i, [red, green, blue, _]| {
                let [x, y, z] = [red, green, blue].map(|sample| self.curve[usize::from(sample)]);
                let steep = (x * x + y * y).sqrt();
                let share = if steep < STEEPEST * z { -1.0 / z } else { -STEEPEST / steep.max(1e-6) };
                (numbers[0][i], numbers[1][i]) = (x * share, y * share);
            });
        } else {
            self.picture.read(first, count, |i, samples| {
                for (channel, sample) in numbers[..self.channels].iter_mut().zip(samples) {
                    channel[i] = self.curve[usize::from(sample)];
                }
            });
        }
    }

    /// Alpha of up to a batch of texels, 0 to 255.
    pub fn alpha(&self, first: usize, count: usize, alpha: &mut [u8; BATCH]) {
        match self.picture.has_alpha() && !self.is_normal {
            true => self.picture.read(first, count, |i, samples| {
                let share = u32::from(samples[3]) * 510 / u32::from(self.picture.white());
                alpha[i] = share.div_ceil(2) as u8;
            }),
            false => alpha.fill(u8::MAX),
        }
    }
}
