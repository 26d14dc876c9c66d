//! A rendered picture: floats, compared and written as PNG.

use crate::false_color;
use crate::resource::SrgbEncoder;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;
use std::fmt;

/// A rendered output of a texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Row by row from the top; four floats a pixel, as the manifest's `Output` widens them.
    pub pixels: Vec<[f32; 4]>,
    /// What the floats mean.
    pub content: Content,
}

/// What the floats of a picture mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// Linear premultiplied colour.
    Color,
    /// Directions, −1..1.
    Normal,
    /// Anything else.
    Data,
    /// Integers, shown in false colours: each its own, neighbours far apart, negative ones too.
    /// Floats carry them, so above 2²⁴ some share one.
    Integer,
    /// The components of a vector, shown as red, green and blue; a fourth is not shown. Values
    /// outside 0..1 are shown by their fractional part: that they leave the range is then seen.
    Vector,
}

/// How far two pictures are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// The share of pixels whose channels all agree within the tolerance, 0..1.
    pub within: f64,
    /// The greatest difference of a channel.
    pub max: f32,
    /// The mean difference of a channel.
    pub mean: f64,
}

impl Picture {
    /// The bytes of a PNG file. Colour is un-premultiplied and sRGB-encoded in 8 bits; data is
    /// written as it is, clamped to 0..1, in 16 bits; normals likewise as ½ + ½n. What is no number
    /// is 0. There is an alpha channel only where a pixel is not opaque. Integers and vectors are
    /// shown as [`Content`] says, opaque, integers in 8 bits and vectors in 16.
    ///
    /// # Errors
    /// The picture does not have as many pixels as its size says, or is more than a PNG may hold.
    pub fn to_png(&self) -> Result<Vec<u8>, PictureError> {
        let wanted = u64::from(self.size[0]) * u64::from(self.size[1]);
        if self.pixels.len() as u64 != wanted {
            return Err(PictureError {
                reason: format!("{} pixels, where {wanted} belong", self.pixels.len()),
            });
        }
        match self.content {
            Content::Color => self.color_png(),
            Content::Normal => self.data_png(|[x, y, z, w]| [0.5 + 0.5 * x, 0.5 + 0.5 * y, 0.5 + 0.5 * z, w]),
            Content::Data => self.data_png(|pixel| pixel),
            Content::Integer => self.integer_png(),
            Content::Vector => self.data_png(|[x, y, z, _]| {
                let [red, green, blue] = [x, y, z].map(false_color::of_component);
                [red, green, blue, 1.0]
            }),
        }
    }

    fn integer_png(&self) -> Result<Vec<u8>, PictureError> {
        let codes: Vec<[u8; 3]> =
            self.pixels.par_iter().map(|pixel| false_color::of_integers(*pixel)).collect();
        self.encode(codes.as_flattened(), ExtendedColorType::Rgb8)
    }

    fn color_png(&self) -> Result<Vec<u8>, PictureError> {
        let encoder = SrgbEncoder::new();
        let code = |x: f32| (x.clamp(0.0, 1.0) * 255.0).round() as u8;
        let opaque = self.pixels.par_iter().all(|pixel| code(pixel[3]) == 255);
        let channels = if opaque { 3 } else { 4 };
        let mut bytes = vec![0; self.pixels.len() * channels];
        bytes.par_chunks_exact_mut(channels).zip(&self.pixels).for_each(|(slot, pixel)| {
            let alpha = if opaque { 1.0 } else { pixel[3].clamp(0.0, 1.0) };
            let straight = |light: f32| if alpha > 0.0 { encoder.encode(light / alpha) } else { 0 };
            let [r, g, b, _] = pixel.map(straight);
            slot.copy_from_slice(&[r, g, b, code(alpha)][..channels]);
        });
        let color = if opaque { ExtendedColorType::Rgb8 } else { ExtendedColorType::Rgba8 };
        self.encode(&bytes, color)
    }

    fn data_png(&self, shown: impl Fn([f32; 4]) -> [f32; 4] + Sync) -> Result<Vec<u8>, PictureError> {
        let code = |x: f32| (x.clamp(0.0, 1.0) * 65535.0).round() as u16;
        let opaque = self.pixels.par_iter().all(|pixel| code(shown(*pixel)[3]) == u16::MAX);
        let channels = if opaque { 3 } else { 4 };
        let mut bytes = vec![0; self.pixels.len() * channels * 2];
        bytes.par_chunks_exact_mut(channels * 2).zip(&self.pixels).for_each(|(slot, pixel)| {
            for (slot, x) in slot.chunks_exact_mut(2).zip(shown(*pixel)) {
                slot.copy_from_slice(&code(x).to_ne_bytes());
            }
        });
        let color = if opaque { ExtendedColorType::Rgb16 } else { ExtendedColorType::Rgba16 };
        self.encode(&bytes, color)
    }

    fn encode(&self, bytes: &[u8], color: ExtendedColorType) -> Result<Vec<u8>, PictureError> {
        let mut file = Vec::new();
        PngEncoder::new(&mut file)
            .write_image(bytes, self.size[0], self.size[1], color)
            .map_err(|error| PictureError { reason: error.to_string() })?;
        Ok(file)
    }

    /// Compares with another picture. Two pixels that are no number agree; pictures of different
    /// sizes agree nowhere.
    pub fn difference(&self, other: &Picture, tolerance: f32) -> Difference {
        if self.size != other.size || self.pixels.len() != other.pixels.len() {
            return Difference { within: 0.0, max: f32::INFINITY, mean: f64::INFINITY };
        }
        let (mut within, mut max, mut sum) = (0u64, 0f32, 0f64);
        for (a, b) in self.pixels.iter().zip(&other.pixels) {
            let apart = [0, 1, 2, 3].map(|i| distance(a[i], b[i]));
            within += u64::from(apart.iter().all(|d| *d <= tolerance));
            max = apart.iter().copied().fold(max, f32::max);
            sum += apart.iter().map(|d| f64::from(*d)).sum::<f64>();
        }
        let count = self.pixels.len().max(1) as f64;
        Difference { within: within as f64 / count, max, mean: sum / count / 4.0 }
    }
}

fn distance(a: f32, b: f32) -> f32 {
    match (a.is_nan(), b.is_nan()) {
        (true, true) => 0.0,
        (false, false) if a == b => 0.0,
        (false, false) => (a - b).abs(),
        _ => f32::INFINITY,
    }
}

/// A picture that can't be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureError {
    /// Why.
    pub reason: String,
}

impl fmt::Display for PictureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the picture can't be written: {}", self.reason)
    }
}

impl std::error::Error for PictureError {}

#[cfg(test)]
mod tests {
    use super::{Content, Picture};

    fn decoded(picture: &Picture) -> image::DynamicImage {
        image::load_from_memory(&picture.to_png().expect("it is written")).expect("it is a PNG")
    }

    fn picture(pixels: &[[f32; 4]], is_color: bool) -> Picture {
        Picture {
            size: [pixels.len() as u32, 1],
            pixels: pixels.to_vec(),
            content: if is_color { Content::Color } else { Content::Data },
        }
    }

    #[test]
    fn colour_is_straight_and_encoded() {
        let file =
            decoded(&picture(&[[0.25, 0.0, 0.0, 0.5], [1.0, 0.5, f32::NAN, 1.0], [1.0; 4], [0.0; 4]], true));
        assert_eq!(file.color(), image::ColorType::Rgba8);
        let expected = [188, 0, 0, 128, 255, 188, 0, 255, 255, 255, 255, 255, 0, 0, 0, 0];
        assert_eq!(file.as_bytes(), expected);
    }

    #[test]
    fn opaque_pictures_have_no_alpha() {
        assert_eq!(decoded(&picture(&[[0.0, 0.5, 1.0, 1.0]], true)).into_rgb8().into_raw(), [0, 188, 255]);
        assert_eq!(decoded(&picture(&[[0.5, 0.5, 0.5, 1.0]], false)).color(), image::ColorType::Rgb16);
    }

    #[test]
    fn data_is_linear_and_clamped() {
        let file = decoded(&picture(&[[0.5, -1.0, f32::INFINITY, 1.0], [f32::NAN, 1.0, 0.0, 1.0]], false));
        assert_eq!(file.into_rgb16().into_raw(), [32768, 0, 65535, 0, 65535, 0]);
    }

    fn shown(pixels: &[[f32; 4]], content: Content) -> image::DynamicImage {
        decoded(&Picture { content, ..picture(pixels, false) })
    }

    #[test]
    fn vectors_fold_back_and_hide_no_pixel() {
        let file = shown(&[[0.5, -0.25, 1.0, 0.0], [1.5, f32::NAN, 0.0, 9.0]], Content::Vector);
        assert_eq!(file.color(), image::ColorType::Rgb16);
        assert_eq!(file.into_rgb16().into_raw(), [32768, 49151, 65535, 32768, 0, 0]);
    }

    #[test]
    fn integers_have_colours() {
        let scalar = |x: f32| [x, x, x, 1.0];
        let pixels = [scalar(3.0), scalar(-3.0), scalar(3.0), [3.0, 4.0, 0.0, 1.0]];
        let file = shown(&pixels, Content::Integer);
        assert_eq!(file.color(), image::ColorType::Rgb8);
        let raw = file.into_rgb8().into_raw();
        let colors: Vec<&[u8]> = raw.chunks(3).collect();
        assert_eq!(colors[0], colors[2]);
        assert!(colors[0] != colors[1] && colors[0] != colors[3] && colors[1] != colors[3], "{colors:?}");
    }

    #[test]
    fn broken_sizes_are_errors() {
        assert!(
            Picture { size: [2, 2], pixels: vec![[0.0; 4]; 3], content: Content::Color }.to_png().is_err()
        );
        assert!(Picture { size: [0, 0], pixels: vec![], content: Content::Color }.to_png().is_err());
    }

    #[test]
    fn differences_count_pixels() {
        let a = picture(&[[0.0; 4], [1.0; 4], [f32::NAN; 4]], false);
        let b = picture(&[[0.0; 4], [1.0, 1.0, 1.0, 0.5], [f32::NAN; 4]], false);
        let difference = a.difference(&b, 0.1);
        assert!((difference.within - 2.0 / 3.0).abs() < 1e-9 && difference.max == 0.5, "{difference:?}");
        assert_eq!(a.difference(&picture(&[[0.0; 4]], false), 1.0).within, 0.0);
    }
}
