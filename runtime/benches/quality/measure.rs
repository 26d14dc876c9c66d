//! How far a picture is from the reference.

use crate::reference::Reference;
use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8, FlipPool, flip};
use texgraph_runtime::picture::Picture;

/// The distance of a picture from the reference.
#[derive(Clone, Copy, Debug)]
pub struct Distance {
    /// Peak signal-to-noise ratio in dB, over the channels as displayed: clamped to 0..1 and
    /// sRGB-encoded, not rounded.
    pub psnr: f64,
    /// The same over the pixels at borders; none where there are none.
    pub border_psnr: Option<f64>,
    /// The mean of FLIP, 0 to 1, at 67 pixels a degree (Andersson et al., HPG 2020).
    pub flip: f64,
    /// By how much the mean of the channel that is furthest off differs, of linear values, in 1/255.
    pub drift: f64,
}

/// Measures a picture. `borders` tells which pixels are at borders.
pub fn distance(picture: &Picture, reference: &Reference, borders: &[bool]) -> Distance {
    let linear: Vec<[f32; 3]> = picture.pixels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect();
    let errors: Vec<f64> = squares(&linear, &reference.pixels);
    let at_borders: Vec<f64> =
        errors.iter().zip(borders).filter_map(|(error, border)| border.then_some(*error)).collect();
    Distance {
        psnr: psnr(&errors),
        border_psnr: (!at_borders.is_empty()).then(|| psnr(&at_borders)),
        flip: flip_mean(picture.size, &linear, &reference.pixels),
        drift: drift(&linear, &reference.pixels),
    }
}

/// The reference's own error as a PSNR. Two independent halves of n samples differ by twice as much
/// as the mean of both is off, so half their difference stands for its error.
pub fn own_psnr(reference: &Reference) -> f64 {
    let [a, b] = &reference.halves;
    psnr(&squares(a, b).into_iter().map(|square| square / 4.0).collect::<Vec<f64>>())
}

/// The mean over three channels of the squared differences as displayed, of each pixel.
fn squares(a: &[[f32; 3]], b: &[[f32; 3]]) -> Vec<f64> {
    let square = |(a, b): (&[f32; 3], &[f32; 3])| {
        a.iter().zip(b).map(|(a, b)| (displayed(*a) - displayed(*b)).powi(2)).sum::<f64>() / 3.0
    };
    a.iter().zip(b).map(square).collect()
}

fn psnr(squares: &[f64]) -> f64 {
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    -10.0 * mean.max(1e-12).log10()
}

/// The sRGB code of a linear value, 0 to 1.
pub fn displayed(light: f32) -> f64 {
    let light = f64::from(light).clamp(0.0, 1.0);
    if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

/// The bytes of a picture as displayed.
pub fn bytes(pixels: &[[f32; 3]]) -> Vec<u8> {
    pixels.iter().flatten().map(|light| (displayed(*light) * 255.0).round() as u8).collect()
}

fn flip_mean([width, height]: [u32; 2], picture: &[[f32; 3]], reference: &[[f32; 3]]) -> f64 {
    let image = |pixels: &[[f32; 3]]| FlipImageRgb8::with_data(width, height, &bytes(pixels));
    let map = flip(image(reference), image(picture), DEFAULT_PIXELS_PER_DEGREE);
    f64::from(FlipPool::from_image(&map).mean())
}

fn drift(picture: &[[f32; 3]], reference: &[[f32; 3]]) -> f64 {
    let mean = |pixels: &[[f32; 3]], i: usize| {
        pixels.iter().map(|pixel| f64::from(pixel[i])).sum::<f64>() / pixels.len() as f64
    };
    (0..3).map(|i| (mean(picture, i) - mean(reference, i)).abs() * 255.0).fold(0.0, f64::max)
}
