//! Pictures as files have them: 8-bit sRGB with straight alpha.

use super::TilesError;
use crate::picture::PictureError;
use crate::project::Project;
use crate::resource::SrgbEncoder;
use crate::resource::decode::{self, Depth};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use std::path::Path;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};

/// The longest side of a picture that is read.
const MAX_SIDE: u32 = 8192;

/// A texel: red, green, blue and straight alpha, sRGB codes 0 to 255.
pub type Texel = [u8; 4];

/// A picture of at least one texel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bitmap {
    size: [u32; 2],
    /// Row by row from the top.
    texels: Vec<Texel>,
}

impl Bitmap {
    /// A picture whose texel in column x and row y is `texel(x, y)`. A size of 0 is taken as 1.
    pub fn new(size: [u32; 2], texel: impl Fn(u32, u32) -> Texel) -> Bitmap {
        let size = size.map(|side| side.max(1));
        let texel = &texel;
        Bitmap { size, texels: (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| texel(x, y))).collect() }
    }

    /// Reads a picture file of up to 8192 texels a side. Samples of 16 bits are rounded to 8; the light of
    /// floats is cut to 0..1 and encoded.
    ///
    /// # Errors
    /// The file can't be read, is no whole picture, or is too large.
    pub fn open(path: &Path) -> Result<Bitmap, Vec<Diagnostic>> {
        let project = Project::new(path, true);
        let file = decode::open(&project, project.main(), Place::default())?;
        if file.size.iter().any(|side| *side > MAX_SIDE) {
            let too_large =
                resources::picture_too_large(Place::default(), project.main(), file.size, MAX_SIDE);
            return Err(vec![too_large]);
        }
        let picture = file.decode()?;
        let srgb = SrgbEncoder::new();
        let byte = |code: u16| (picture.depth.number(code) * 255.0).round() as u8;
        let color = |code: u16| match picture.depth {
            Depth::Half => srgb.encode(picture.depth.number(code)),
            Depth::Eight | Depth::Sixteen => byte(code),
        };
        Ok(Bitmap::new(picture.size, |x, y| {
            let [red, green, blue, alpha] = picture.texel(x, y);
            [color(red), color(green), color(blue), byte(alpha)]
        }))
    }

    /// Texels across and down.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// All texels, row by row from the top.
    pub fn texels(&self) -> &[Texel] {
        &self.texels
    }

    /// A texel; beyond the sides the nearest.
    pub fn texel(&self, x: u32, y: u32) -> Texel {
        let (x, y) = (x.min(self.size[0] - 1), y.min(self.size[1] - 1));
        self.texels[y as usize * self.size[0] as usize + x as usize]
    }

    /// The part of this size whose first texel is in column `left` and row `top`.
    pub fn part(&self, [left, top]: [u32; 2], size: [u32; 2]) -> Bitmap {
        Bitmap::new(size, |x, y| self.texel(left + x, top + y))
    }

    /// Cuts a sheet into its tiles, row by row.
    ///
    /// # Errors
    /// The grid does not divide the picture into tiles of 2×2 texels or more.
    pub fn tiles(&self, grid: [u32; 2]) -> Result<Vec<Bitmap>, TilesError> {
        let [columns, rows] = grid;
        let fits = |texels: u32, cells: u32| cells > 0 && texels.is_multiple_of(cells) && texels / cells >= 2;
        if !fits(self.size[0], columns) || !fits(self.size[1], rows) {
            return Err(TilesError::UnevenGrid { size: self.size, grid });
        }
        let size = [self.size[0] / columns, self.size[1] / rows];
        let tile = |row: u32, column: u32| self.part([column * size[0], row * size[1]], size);
        Ok((0..rows).flat_map(|row| (0..columns).map(move |column| tile(row, column))).collect())
    }

    /// Tiles of one size as a sheet of that many columns, row by row.
    pub fn sheet(tiles: &[Bitmap], columns: u32) -> Bitmap {
        let side = tiles.first().map_or([1, 1], Bitmap::size);
        let columns = columns.max(1);
        let size = [columns * side[0], (tiles.len() as u32).div_ceil(columns) * side[1]];
        Bitmap::new(size, |x, y| {
            let tile = tiles.get((y / side[1] * columns + x / side[0]) as usize);
            tile.map_or([0; 4], |tile| tile.texel(x % side[0], y % side[1]))
        })
    }

    /// The bytes of a PNG file, of as few channels as show every texel.
    ///
    /// # Errors
    /// The picture is more than a PNG may hold.
    pub fn to_png(&self) -> Result<Vec<u8>, PictureError> {
        let is_opaque = self.texels.iter().all(|texel| texel[3] == 255);
        let is_grey = self.texels.iter().all(|[r, g, b, _]| r == g && g == b);
        let (color, channels): (_, &[usize]) = match (is_opaque, is_grey) {
            (true, true) => (ExtendedColorType::L8, &[0]),
            (false, true) => (ExtendedColorType::La8, &[0, 3]),
            (true, false) => (ExtendedColorType::Rgb8, &[0, 1, 2]),
            (false, false) => (ExtendedColorType::Rgba8, &[0, 1, 2, 3]),
        };
        let bytes: Vec<u8> =
            self.texels.iter().flat_map(|texel| channels.iter().map(|channel| texel[*channel])).collect();
        let mut file = Vec::new();
        PngEncoder::new_with_quality(&mut file, CompressionType::Best, FilterType::Adaptive)
            .write_image(&bytes, self.size[0], self.size[1], color)
            .map_err(|error| PictureError { reason: error.to_string() })?;
        Ok(file)
    }
}
