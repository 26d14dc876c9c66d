//! What is made of a resource's files, and the limits that every texture keeps.

use std::sync::Arc;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};
use texgraph_compiler::manifest::{Format, Table};

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

/// A texture of a resource, to be shared.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The field of the resource's kind.
    pub field: String,
    /// As of [`Made`].
    pub table: Table,
    /// As of [`Made`].
    pub bytes: Arc<[u8]>,
}

impl From<Made> for Loaded {
    fn from(Made { field, table, bytes }: Made) -> Loaded {
        Loaded { field: field.to_owned(), table, bytes: bytes.into() }
    }
}

impl Made {
    /// A table of one level and one layer with the integers of all texels in a row.
    pub fn integers(
        field: &'static str,
        format: Format,
        size: [u32; 2],
        values: impl Iterator<Item = i32>,
    ) -> Made {
        let table = Table::with_levels(format, size, 1, 1);
        Made { field, table, bytes: values.flat_map(i32::to_le_bytes).collect() }
    }
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
    let bytes = Table::mipmapped(format, size, layers).bytes();
    if bytes > MAX_BYTES {
        return Err(vec![resources::too_many_bytes(place, bytes, MAX_BYTES)]);
    }
    Ok(())
}
