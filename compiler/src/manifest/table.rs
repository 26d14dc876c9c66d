//! The bytes of a texture: format, size, and where each level stands.

use super::names::{name_of, named};
use serde::{Deserialize, Serialize};

/// The bytes of a texture: every level, every layer (or slice), row by row, without padding.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// The KTX2 file with the bytes, beside the manifest; none when they were not written. The levels'
    /// offsets are then those in the file.
    pub file: Option<String>,
    /// What the bytes were made of, hashed: the recipe and the content of all files that it reads. The
    /// file holds the same as `texgraph.key`. None when the bytes were not made to be kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub key: Option<String>,
    /// Its texels.
    pub format: Format,
    /// Width of level 0 in texels.
    pub width: u32,
    /// Height of level 0 in texels.
    pub height: u32,
    /// Layers of an array, or depth of a volume's level 0; else 1.
    pub layers: u32,
    /// The levels, from the largest.
    pub levels: Vec<Level>,
}

impl Table {
    /// A table of all levels down to one texel: a level's layers follow one another, rows have no
    /// padding.
    pub fn mipmapped(format: Format, size: [u32; 2], layers: u32) -> Table {
        let [width, height] = size;
        Table::with_levels(format, size, layers, width.max(height).max(1).ilog2() + 1)
    }

    /// A table of so many levels.
    pub fn with_levels(format: Format, size: [u32; 2], layers: u32, count: u32) -> Table {
        let [width, height] = size;
        let mut offset = 0;
        let levels = (0..count).map(|level| {
            let [width, height] = size.map(|side| (side >> level).max(1));
            let bytes_per_row = width.div_ceil(format.block()) * format.bytes();
            let level = Level { offset, width, height, layers, bytes_per_row };
            offset += level.bytes(format);
            level
        });
        let levels = levels.collect();
        Table { file: None, key: None, format, width, height, layers, levels }
    }

    /// Bytes of all levels.
    pub fn bytes(&self) -> u64 {
        self.levels.iter().map(|level| level.bytes(self.format)).sum()
    }
}

/// One level of a table. All its layers follow one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Level {
    /// Where it begins, in bytes; in the table's file, if there is one.
    pub offset: u64,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Layers or slices.
    pub layers: u32,
    /// Bytes from one row to the next: a row of texels, or of blocks.
    pub bytes_per_row: u32,
}

impl Level {
    /// Rows of a layer: of texels, or of blocks.
    pub fn rows(&self, format: Format) -> u32 {
        self.height.div_ceil(format.block())
    }

    /// Bytes of the level, all layers.
    pub fn bytes(&self, format: Format) -> u64 {
        u64::from(self.bytes_per_row) * u64::from(self.rows(format)) * u64::from(self.layers)
    }
}

/// Texel formats, by their WebGPU names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Format {
    /// 8 bits a channel, the premultiplied colour sRGB-encoded, alpha linear.
    Rgba8UnormSrgb,
    /// 8 bits a channel, 0..1.
    Rgba8Unorm,
    /// 8 bits a channel, −1..1.
    Rgba8Snorm,
    /// 16-bit floats.
    Rgba16Float,
    /// One 32-bit integer.
    R32Sint,
    /// Four 32-bit integers.
    Rgba32Sint,
    /// Colours of 0..1 in 8 bytes for 4 by 4 texels, alpha 1.
    Bc1RgbaUnorm,
    /// 0..1 in 16 bytes for 4 by 4 texels.
    Bc7RgbaUnorm,
}

impl Format {
    const NAMES: &[(Format, &str)] = &[
        (Format::Rgba8UnormSrgb, "rgba8unorm-srgb"),
        (Format::Rgba8Unorm, "rgba8unorm"),
        (Format::Rgba8Snorm, "rgba8snorm"),
        (Format::Rgba16Float, "rgba16float"),
        (Format::R32Sint, "r32sint"),
        (Format::Rgba32Sint, "rgba32sint"),
        (Format::Bc1RgbaUnorm, "bc1-rgba-unorm"),
        (Format::Bc7RgbaUnorm, "bc7-rgba-unorm"),
    ];

    /// Bytes a texel, or a block of texels.
    pub fn bytes(self) -> u32 {
        match self {
            Format::Rgba8UnormSrgb | Format::Rgba8Unorm | Format::Rgba8Snorm | Format::R32Sint => 4,
            Format::Rgba16Float | Format::Bc1RgbaUnorm => 8,
            Format::Rgba32Sint | Format::Bc7RgbaUnorm => 16,
        }
    }

    /// Texels across and down a block; 1 where every texel stands for itself.
    pub fn block(self) -> u32 {
        if self.is_compressed() { 4 } else { 1 }
    }

    /// Whether adapters need the feature `texture-compression-bc`.
    pub fn is_compressed(self) -> bool {
        matches!(self, Format::Bc1RgbaUnorm | Format::Bc7RgbaUnorm)
    }
}

impl From<Format> for String {
    fn from(format: Format) -> String {
        name_of(Format::NAMES, format)
    }
}

impl TryFrom<String> for Format {
    type Error = String;

    fn try_from(name: String) -> Result<Format, String> {
        named(Format::NAMES, &name)
    }
}
