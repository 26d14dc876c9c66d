//! The numbers of a picture that are made Gaussian: linear light, data, or slopes.

use crate::resource::decode::{Decoded, Depth};
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
    /// The least and the greatest that a number can be.
    ends: [f32; 2],
}

impl<'a> Light<'a> {
    /// Prepares to read a picture.
    pub fn new(picture: &'a Decoded, encoding: Encoding, channels: usize) -> Light<'a> {
        let mut light = Light {
            picture,
            size: picture.size,
            channels: channels.clamp(1, MAX_CHANNELS),
            is_normal: encoding == Encoding::Normal,
            curve: encoding::curve(encoding, picture.depth),
            ends: if encoding == Encoding::Normal { [-STEEPEST, STEEPEST] } else { [0.0, 1.0] },
        };
        if picture.depth == Depth::Half && !light.is_normal {
            light.ends = light.found_ends();
        }
        light
    }

    /// The least number of all texels, and the greatest.
    fn found_ends(&self) -> [f32; 2] {
        let mut ends = [f32::MAX, f32::MIN];
        self.picture.read(0, self.texels(), |_, samples| {
            for sample in &samples[..self.channels] {
                let number = self.curve[usize::from(*sample)];
                ends = [ends[0].min(number), ends[1].max(number)];
            }
        });
        ends
    }

    /// How many texels there are.
    pub fn texels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// The least and the greatest that a number can be.
    pub fn range(&self) -> (f32, f32) {
        self.ends.into()
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
                alpha[i] = (self.picture.depth.number(samples[3]) * 255.0).round() as u8;
            }),
            false => alpha.fill(u8::MAX),
        }
    }
}
