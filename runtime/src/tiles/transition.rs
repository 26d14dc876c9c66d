//! Transition sheets: sixteen tiles between two families, or of one family over nothing.

use super::bitmap::{Bitmap, Texel};
use super::corners::Corners;
use super::family::Family;
use super::mask::Mask;
use super::{TilesError, check_sheet};
use crate::resource::{SrgbEncoder, srgb_to_linear};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// Tiles along a sheet.
const GRID: u32 = 4;

/// How much the light of a picture disturbs the border: light blades and stones lie on top.
const RELIEF: f32 = 0.5;

/// The 4×4 transition tiles of two families in the order of their corner codes, where 0 is `a` and 1
/// is `b`. Tiles 0 and 15 are plain tiles of the families; neighbours that agree about their common
/// corners fit, plain tiles of the families included. Colours blend as light.
///
/// # Errors
/// The tiles of the families differ in size.
pub fn transition(a: &Family, b: &Family, seed: u32) -> Result<Bitmap, TilesError> {
    if a.side() != b.side() {
        return Err(TilesError::SizesDiffer { sizes: [a, b].map(|family| [family.side(); 2]) });
    }
    let relief = [Relief::of(a), Relief::of(b)];
    let light = Light::new();
    draw(a.side(), seed, |mask, index, [x, y]| {
        let texels = [a, b].map(|family| family.tile(index as usize).map_or([0; 4], |tile| tile.texel(x, y)));
        let detail = relief[1].at(texels[1]) - relief[0].at(texels[0]);
        light.mix(texels[0], texels[1], mask.share(Corners::of(index, 2).0, x, y, detail))
    })
}

/// The 4×4 border tiles of a family in the order of their corner codes, where 1 is the family and 0
/// nothing: straight alpha, with the family's colours kept where it is transparent, so that filtering
/// brings no fringe in. Laid over any other family they are its transitions.
///
/// # Errors
/// The tiles are too large for a sheet.
pub fn border(family: &Family, seed: u32) -> Result<Bitmap, TilesError> {
    let relief = Relief::of(family);
    draw(family.side(), seed, |mask, index, [x, y]| {
        let texel = family.tile(index as usize).map_or([0; 4], |tile| tile.texel(x, y));
        let share = mask.share(Corners::of(index, 2).0, x, y, relief.at(texel));
        let [r, g, b, alpha] = texel;
        [r, g, b, (f32::from(alpha) * share).round() as u8]
    })
}

/// A sheet whose texels are `texel(mask, tile, place in the tile)`.
fn draw(
    side: u32,
    seed: u32,
    texel: impl Fn(&Mask, u32, [u32; 2]) -> Texel + Sync,
) -> Result<Bitmap, TilesError> {
    check_sheet([GRID; 2], side)?;
    let mask = Mask::new(side, seed);
    let tile = |index: u32| Bitmap::new([side; 2], |x, y| texel(&mask, index, [x, y]));
    let tiles: Vec<Bitmap> = (0..GRID * GRID).into_par_iter().map(tile).collect();
    Ok(Bitmap::sheet(&tiles, GRID))
}

/// How far the texels of a family rise above its mean.
struct Relief {
    mean: f32,
}

impl Relief {
    fn of(family: &Family) -> Relief {
        let texels = || family.tiles().iter().flat_map(Bitmap::texels);
        let sum: u64 = texels().map(|texel| u64::from(luma(*texel))).sum();
        Relief { mean: sum as f32 / texels().count().max(1) as f32 }
    }

    fn at(&self, texel: Texel) -> f32 {
        RELIEF * (luma(texel) as f32 - self.mean) / LUMA_WHITE
    }
}

/// The luma of white.
const LUMA_WHITE: f32 = 255.0 * 10_000.0;

/// Rec. 709 luma of the codes, in 1/10,000.
fn luma([r, g, b, _]: Texel) -> u32 {
    2126 * u32::from(r) + 7152 * u32::from(g) + 722 * u32::from(b)
}

/// Codes to light and back.
struct Light {
    of_code: [f32; 256],
    encoder: SrgbEncoder,
}

impl Light {
    fn new() -> Light {
        let mut of_code = [0.0; 256];
        for (code, light) in of_code.iter_mut().enumerate() {
            *light = srgb_to_linear(code as f64 / 255.0) as f32;
        }
        Light { of_code, encoder: SrgbEncoder::new() }
    }

    /// As much of `b` as `share` says, the rest of `a`; texels as they are where the share is 0 or 1.
    fn mix(&self, a: Texel, b: Texel, share: f32) -> Texel {
        if share <= 0.0 {
            return a;
        }
        if share >= 1.0 {
            return b;
        }
        let weights = [f32::from(a[3]) * (1.0 - share), f32::from(b[3]) * share];
        let alpha = weights[0] + weights[1];
        let channel = |i: usize| {
            let [a, b] = [a, b].map(|texel| self.of_code[usize::from(texel[i])]);
            self.encoder.encode((a * weights[0] + b * weights[1]) / alpha.max(f32::MIN_POSITIVE))
        };
        [channel(0), channel(1), channel(2), alpha.round() as u8]
    }
}
