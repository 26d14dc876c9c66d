//! The layout of a table's bytes, and the limits that every texture keeps.

use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};
use texgraph_compiler::manifest::{Format, Level, Table};

/// WebGPU's least guarantee for a side of a 2D texture.
pub const MAX_SIDE: u32 = 8192;

/// WebGPU's least guarantee for the layers of a texture.
pub const MAX_LAYERS: u32 = 256;

/// The most bytes of a texture, all levels and layers.
pub const MAX_BYTES: u64 = 1 << 30;

/// One texture of a resource, made.
pub struct Made {
    /// The field of the resource's kind.
    pub field: &'static str,
    /// Size, format and levels.
    pub table: Table,
    /// The texels, as `table` lays them out, little endian.
    pub bytes: Vec<u8>,
}

impl Made {
    /// A table of one level and one layer with the integers of all texels in a row.
    pub fn integers(
        field: &'static str,
        format: Format,
        size: [u32; 2],
        values: impl Iterator<Item = i32>,
    ) -> Made {
        let table = layout(format, size, 1, false);
        Made { field, table, bytes: values.flat_map(i32::to_le_bytes).collect() }
    }
}

/// Lays out all levels, or one, of a texture: a level's layers follow one another, rows have no
/// padding.
pub fn layout(format: Format, size: [u32; 2], layers: u32, mipmapped: bool) -> Table {
    let [width, height] = size;
    let count = if mipmapped { width.max(height).max(1).ilog2() + 1 } else { 1 };
    let mut offset = 0;
    let levels = (0..count).map(|level| {
        let [width, height] = size.map(|side| (side >> level).max(1));
        let bytes_per_row = width * format.bytes();
        let level = Level { offset, width, height, layers, bytes_per_row };
        offset += level_bytes(&level);
        level
    });
    Table { file: None, format, width, height, layers, levels: levels.collect() }
}

/// The bytes of a level, all layers.
pub fn level_bytes(level: &Level) -> u64 {
    u64::from(level.bytes_per_row) * u64::from(level.height) * u64::from(level.layers)
}

/// The bytes of all levels.
pub fn bytes(table: &Table) -> u64 {
    table.levels.iter().map(level_bytes).sum()
}

/// Checks a mipmapped texture against what every GPU can hold, before it is made.
///
/// # Errors
/// It has too many layers, too long a side, or too many bytes.
pub fn check(
    place: Place,
    path: &str,
    format: Format,
    size: [u32; 2],
    layers: u32,
) -> Result<(), Vec<Diagnostic>> {
    if layers > MAX_LAYERS {
        return Err(vec![resources::too_many_layers(place, u64::from(layers), MAX_LAYERS)]);
    }
    if size.iter().any(|side| *side > MAX_SIDE) {
        return Err(vec![resources::texture_too_large(place, path, size, MAX_SIDE)]);
    }
    let bytes = bytes(&layout(format, size, layers, true));
    if bytes > MAX_BYTES {
        return Err(vec![resources::too_many_bytes(place, bytes, MAX_BYTES)]);
    }
    Ok(())
}
