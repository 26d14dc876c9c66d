//! The cells that a sprite reaches into, and what each of them holds of it.

use super::{Refused, Sprite};

/// Bytes of a texel: four ints.
pub const TEXEL: usize = 16;
/// The texel of a cell without a sprite: pattern -1.
pub const BLANK: [u8; TEXEL] = [255, 255, 255, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
/// The smallest side, in cells.
const MIN_SCALE: f64 = 1.0 / 256.0;
/// The unit of places: what reaches into a cell by less does not reach into it.
const UNIT: f64 = 1.0 / 32768.0;

/// Where a sprite lies on the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cover {
    /// The middle, in cells.
    middle: [f64; 2],
    /// The first cell across and down, which may be -1.
    first: [i32; 2],
    /// How many across and down, 1 or 2.
    count: [u8; 2],
    grid: [u32; 2],
}

impl Cover {
    /// Of a sprite on a grid that wraps.
    pub fn new(sprite: &Sprite, grid: [u32; 2]) -> Result<Cover, Refused> {
        let (cosine, sine) = direction(sprite);
        let scale = f64::from(sprite.scale);
        let around = scale * (cosine.abs() + sine.abs());
        let is_finite = around.is_finite() && sprite.at.iter().all(|place| place.is_finite());
        if !is_finite || scale < MIN_SCALE || around > 1.0 + UNIT {
            return Err(Refused::Size { scale: sprite.scale, around: around as f32 });
        }
        let axis = |i: usize| {
            let place = f64::from(sprite.at[i]);
            let middle = (place - place.floor()) * f64::from(grid[i]);
            let half = around.min(1.0) / 2.0;
            let first = (middle - half + UNIT).floor();
            let last = ((middle + half - UNIT).ceil() - 1.0).clamp(first, first + 1.0);
            (middle, first as i32, (last - first) as u8 + 1)
        };
        let [x, y] = [axis(0), axis(1)];
        Ok(Cover { middle: [x.0, y.0], first: [x.1, y.1], count: [x.2, y.2], grid })
    }

    /// Whether it has the same cells as another.
    pub fn is_where(&self, other: &Cover) -> bool {
        (self.first, self.count) == (other.first, other.count)
    }

    /// The cells, one to four, all different.
    pub fn cells(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let cover = *self;
        self.steps().map(move |step| cover.cell(step))
    }

    /// The cells with their texels.
    pub fn texels(&self, sprite: &Sprite) -> impl Iterator<Item = ([u32; 2], [u8; TEXEL])> + use<> {
        let (cosine, sine) = direction(sprite);
        let matrix = [cosine, sine].map(|c| (c / f64::from(sprite.scale) * 65536.0).round() as i32);
        let (cover, pattern) = (*self, sprite.pattern as i32);
        self.steps().map(move |step| {
            let place = |i: usize| {
                let from = cover.middle[i] - f64::from(cover.first[i] + step[i]);
                ((from + 0.5) * 32768.0).round().clamp(0.0, 65535.0) as i32
            };
            let words = [pattern, place(0) | (place(1) << 16), matrix[0], matrix[1]];
            let mut texel = [0; TEXEL];
            for (bytes, word) in texel.chunks_exact_mut(4).zip(words) {
                bytes.copy_from_slice(&word.to_le_bytes());
            }
            (cover.cell(step), texel)
        })
    }

    /// From the first cell to each.
    fn steps(&self) -> impl Iterator<Item = [i32; 2]> + use<> {
        let [across, down] = self.count.map(i32::from);
        (0..down).flat_map(move |y| (0..across).map(move |x| [x, y]))
    }

    fn cell(&self, step: [i32; 2]) -> [u32; 2] {
        let wrapped = |i: usize| (self.first[i] + step[i]).rem_euclid(self.grid[i] as i32) as u32;
        [wrapped(0), wrapped(1)]
    }
}

/// Where a sprite's rows go: the cosine and the sine of its turn.
fn direction(sprite: &Sprite) -> (f64, f64) {
    let angle = f64::from(sprite.turn) * std::f64::consts::TAU;
    (libm::cos(angle), libm::sin(angle))
}
