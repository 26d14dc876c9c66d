//! Light and shade of a photograph: its means over squares.

use super::bitmap::Bitmap;

/// A photograph without its slow changes: the mean of the square of `side` texels around each texel
/// becomes that of the whole picture. Left in, they would make some tiles lighter than others.
pub fn evened(photo: &Bitmap, side: u32) -> Bitmap {
    let levels = Levels::new(photo);
    let (whole, side) = (levels.whole, i64::from(side));
    Bitmap::new(photo.size(), |x, y| {
        let texel = photo.texel(x, y);
        let here = levels.mean([i64::from(x) - side / 2, i64::from(y) - side / 2], [side, side]);
        let code = |i: usize| (f32::from(texel[i]) + whole[i] - here[i]).round().clamp(0.0, 255.0) as u8;
        [code(0), code(1), code(2), texel[3]]
    })
}

/// The sums of a picture's channels over all rectangles from its first texel.
pub struct Levels {
    width: usize,
    height: usize,
    /// One row and one column more than the picture. They wrap around: a rectangle of up to 4096²
    /// texels is right nevertheless.
    sums: Vec<[u32; 3]>,
    whole: [f32; 3],
}

impl Levels {
    /// Sums up a picture.
    pub fn new(picture: &Bitmap) -> Levels {
        let [width, height] = picture.size().map(|side| side as usize);
        let mut sums = vec![[0; 3]; (width + 1) * (height + 1)];
        let mut all = [0u64; 3];
        for (y, row) in picture.texels().chunks(width).enumerate() {
            let mut sum = [0u32; 3];
            for (x, texel) in row.iter().enumerate() {
                for channel in 0..3 {
                    sum[channel] = sum[channel].wrapping_add(u32::from(texel[channel]));
                    let above = sums[y * (width + 1) + x + 1][channel];
                    sums[(y + 1) * (width + 1) + x + 1][channel] = sum[channel].wrapping_add(above);
                }
            }
            for (all, sum) in all.iter_mut().zip(sum) {
                *all += u64::from(sum);
            }
        }
        let whole = all.map(|sum| (sum as f64 / (width * height) as f64) as f32);
        Levels { width, height, sums, whole }
    }

    /// The mean of a rectangle, cut to the picture; in levels.
    pub fn mean(&self, from: [i64; 2], size: [i64; 2]) -> [f32; 3] {
        let clip = |at: i64, most: usize| at.clamp(0, most as i64) as usize;
        let (left, right) = (clip(from[0], self.width), clip(from[0] + size[0], self.width));
        let (top, bottom) = (clip(from[1], self.height), clip(from[1] + size[1], self.height));
        let count = ((right - left) * (bottom - top)).max(1) as f32;
        let at = |x: usize, y: usize| self.sums[y * (self.width + 1) + x];
        let corners = [at(right, bottom), at(left, top), at(left, bottom), at(right, top)];
        [0, 1, 2].map(|i| {
            let [all, before, left, above] = corners.map(|corner| corner[i]);
            all.wrapping_add(before).wrapping_sub(left).wrapping_sub(above) as f32 / count
        })
    }

    /// How far the mean of a rectangle is from that of the picture: the sum of the squares of its
    /// channels, in levels. What is light or dark as a whole is seen again wherever it is repeated.
    pub fn stands_out(&self, from: [i64; 2], size: [i64; 2]) -> f32 {
        let (here, whole) = (self.mean(from, size), self.whole);
        here.iter().zip(whole).map(|(here, whole)| (here - whole) * (here - whole)).sum()
    }
}
