//! Samples to light and back: the colour encodings of pictures and the texel formats of tables.
//!
//! Every table of numbers here is made with `libm`, whose results are the same on every machine,
//! so that the same picture gives the same bytes everywhere.

use super::decode::{Decoded, Depth};
use glam::Vec4;
use half::f16;
use texgraph_compiler::manifest::{Encoding, Format};

/// Light of an sRGB-encoded number, both 0..1 (IEC 61966-2-1).
pub fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// The format in which pictures of this encoding are stored.
pub fn format(encoding: Encoding, is_deep: bool) -> Format {
    match (encoding, is_deep) {
        (_, true) => Format::Rgba16Float,
        (Encoding::Srgb, false) => Format::Rgba8UnormSrgb,
        (Encoding::Linear, false) => Format::Rgba8Unorm,
        (Encoding::Normal, false) => Format::Rgba8Snorm,
    }
}

/// What codes of red, green or blue stand for in an encoding, from 0 to the greatest. Floats are light
/// already.
pub fn curve(encoding: Encoding, depth: Depth) -> Vec<f32> {
    let meaning = |number: f64| match (encoding, depth) {
        (Encoding::Srgb, Depth::Eight | Depth::Sixteen) => srgb_to_linear(number),
        (Encoding::Srgb, Depth::Half) | (Encoding::Linear, _) => number,
        (Encoding::Normal, _) => 2.0 * number - 1.0,
    };
    let number = |code: u16| match depth {
        Depth::Half => f64::from(depth.number(code)),
        Depth::Eight | Depth::Sixteen => f64::from(code) / f64::from(depth.last()),
    };
    (0..=depth.last()).map(|code| meaning(number(code)) as f32).collect()
}

/// Reads the texels of pictures in one encoding as the numbers that are filtered.
pub struct Reader<'a> {
    picture: &'a Decoded,
    encoding: Encoding,
    /// What a sample of red, green or blue stands for.
    curve: Vec<f32>,
}

impl<'a> Reader<'a> {
    /// Prepares to read a picture.
    pub fn new(picture: &'a Decoded, encoding: Encoding) -> Reader<'a> {
        Reader { picture, encoding, curve: curve(encoding, picture.depth) }
    }

    /// A texel: linear premultiplied light, data as it is, or a normal with alpha 1.
    pub fn texel(&self, x: u32, y: u32) -> Vec4 {
        let [red, green, blue, alpha] = self.picture.texel(x, y);
        let number = |sample: u16| self.curve[usize::from(sample)];
        let alpha = self.picture.depth.number(alpha);
        let [red, green, blue] = [number(red), number(green), number(blue)];
        match self.encoding {
            Encoding::Srgb => Vec4::new(red * alpha, green * alpha, blue * alpha, alpha),
            Encoding::Linear => Vec4::new(red, green, blue, alpha),
            Encoding::Normal => Vec4::new(red, green, blue, 1.0),
        }
    }
}

/// Writes texels in a format of floats.
pub struct Writer {
    format: Format,
    srgb: SrgbEncoder,
}

impl Writer {
    /// Prepares to write a format.
    pub fn new(format: Format) -> Writer {
        Writer { format, srgb: SrgbEncoder::new() }
    }

    /// The format that is written.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Writes one texel to as many bytes as the format has. Integer and compressed formats stay zero.
    pub fn write(&self, texel: Vec4, bytes: &mut [u8]) {
        let unorm = |x: f32| (x.clamp(0.0, 1.0) * 255.0).round() as u8;
        let snorm = |x: f32| (x.clamp(-1.0, 1.0) * 127.0).round() as i8 as u8;
        let [r, g, b, a] = texel.to_array();
        match self.format {
            Format::Rgba8UnormSrgb => {
                bytes.copy_from_slice(&[
                    self.srgb.encode(r),
                    self.srgb.encode(g),
                    self.srgb.encode(b),
                    unorm(a),
                ]);
            }
            Format::Rgba8Unorm => bytes.copy_from_slice(&[r, g, b, a].map(unorm)),
            Format::Rgba8Snorm => bytes.copy_from_slice(&[r, g, b, a].map(snorm)),
            Format::Rgba16Float => {
                for (slot, x) in bytes.chunks_exact_mut(2).zip([r, g, b, a]) {
                    // What is too large is the largest: infinity would spread.
                    let x = x.clamp(f16::MIN.to_f32(), f16::MAX.to_f32());
                    slot.copy_from_slice(&f16::from_f32(x).to_le_bytes());
                }
            }
            Format::R32Sint | Format::Rgba32Sint | Format::Bc1RgbaUnorm | Format::Bc7RgbaUnorm => {}
        }
    }
}

/// Light to 8-bit sRGB, rounded exactly: a code is the number of thresholds at or below the light.
pub struct SrgbEncoder {
    /// Threshold i is the light halfway between the codes i and i + 1.
    thresholds: Vec<f32>,
    /// A code at or below that of light k/4096, from which at most a few steps are left.
    starts: Vec<u8>,
}

impl SrgbEncoder {
    /// Makes the tables.
    pub fn new() -> SrgbEncoder {
        let thresholds = (0..255).map(|code| srgb_to_linear((f64::from(code) + 0.5) / 255.0) as f32);
        let thresholds: Vec<f32> = thresholds.collect();
        let below = |light: f32| thresholds.partition_point(|threshold| *threshold <= light) as u8;
        let starts = (0..=4096).map(|k| below(k as f32 / 4096.0)).collect();
        SrgbEncoder { starts, thresholds }
    }

    /// The code of light 0..1; outside is clamped, and what is no number is 0.
    pub fn encode(&self, light: f32) -> u8 {
        let bucket = (light * 4096.0).clamp(0.0, 4096.0) as usize;
        let mut code = self.starts[bucket];
        while self.thresholds.get(usize::from(code)).is_some_and(|threshold| *threshold <= light) {
            code += 1;
        }
        code
    }
}

impl Default for SrgbEncoder {
    fn default() -> SrgbEncoder {
        SrgbEncoder::new()
    }
}

#[cfg(test)]
mod tests {
    use super::{SrgbEncoder, srgb_to_linear};

    #[test]
    fn every_code_survives_a_round_trip() {
        let encoder = SrgbEncoder::new();
        for code in 0..=255u8 {
            assert_eq!(encoder.encode(srgb_to_linear(f64::from(code) / 255.0) as f32), code);
        }
    }

    #[test]
    fn what_is_no_light_is_clamped() {
        let encoder = SrgbEncoder::new();
        assert_eq!(encoder.encode(f32::NAN), 0);
        assert_eq!(encoder.encode(-1.0), 0);
        assert_eq!(encoder.encode(f32::NEG_INFINITY), 0);
        assert_eq!(encoder.encode(f32::INFINITY), 255);
    }
}
