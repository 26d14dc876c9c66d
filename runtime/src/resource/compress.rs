//! Block-compressed forms of textures, for adapters that read them.
//!
//! Every texture is made plain. [`compress`] adds compressed forms to those whose recipes ask for one,
//! and each renderer takes the form that it can read: the shader is the same.

use super::{Loaded, Tables};
use block_compression::encode::compress_rgba8;
use block_compression::{BC7Settings, CompressionVariant};
use rayon::iter::{IndexedParallelIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;
use std::sync::Arc;
use texgraph_compiler::manifest::{Format, Level, Manifest, Recipe, Table};

/// Texels across and down a block.
const BLOCK: usize = 4;

/// Adds the compressed forms that recipes ask for: [`texgraph_compiler::manifest::Texture::table`] and
/// [`Tables::get`] are then theirs, `plain` and [`Tables::plain`] those that were made. What has one is
/// left as it is.
pub fn compress(manifest: &mut Manifest, tables: &mut Tables) {
    compress_with(manifest, tables, |plain, format| {
        let (table, bytes) = blocks(&plain.table, &plain.bytes, format)?;
        Some(Loaded { field: plain.field.clone(), table, bytes: bytes.into() })
    });
}

/// As [`compress`], the compressed form of a plain one given by a function.
pub(crate) fn compress_with(
    manifest: &mut Manifest,
    tables: &mut Tables,
    mut compressed: impl FnMut(&Loaded, Format) -> Option<Loaded>,
) {
    for (index, resource) in manifest.resources.iter_mut().enumerate() {
        let Some((field, format)) = wanted(&resource.recipe) else { continue };
        let texture = resource.textures.iter_mut().find(|texture| texture.field == field);
        let Some(texture) = texture.filter(|texture| texture.plain.is_none()) else { continue };
        let (Some(table), Some(entry)) = (&texture.table, tables.entry(index, field)) else { continue };
        let (table, bytes) = (table.clone(), Arc::clone(&entry.bytes));
        let Some(made) = compressed(&Loaded { field: field.to_owned(), table, bytes }, format) else {
            continue;
        };
        entry.plain = Some(std::mem::replace(&mut entry.bytes, made.bytes));
        texture.plain = texture.table.replace(made.table);
    }
}

/// The field that a recipe wants compressed, and how.
fn wanted(recipe: &Recipe) -> Option<(&'static str, Format)> {
    match recipe {
        Recipe::Exemplar { compress, .. } => Some(("gaussian", compress.format()?)),
        _ => None,
    }
}

/// A table of one layer of 8-bit texels in blocks; none where it is anything else, or cut short.
pub(crate) fn blocks(table: &Table, bytes: &[u8], format: Format) -> Option<(Table, Vec<u8>)> {
    if table.format != Format::Rgba8Unorm || table.layers != 1 {
        return None;
    }
    let size = [table.width, table.height];
    let compressed = Table::with_levels(format, size, 1, table.levels.len() as u32);
    let variant = match format {
        Format::Bc1RgbaUnorm => CompressionVariant::BC1,
        // Slower settings give a decibel more and take twenty times as long.
        Format::Bc7RgbaUnorm if is_opaque(bytes) => CompressionVariant::BC7(BC7Settings::opaque_ultra_fast()),
        Format::Bc7RgbaUnorm => CompressionVariant::BC7(BC7Settings::alpha_ultrafast()),
        _ => return None,
    };
    let mut made = vec![0; compressed.bytes() as usize];
    for (level, target) in table.levels.iter().zip(&compressed.levels) {
        let texels = bytes.get(level.offset as usize..(level.offset + level.bytes(table.format)) as usize)?;
        let rows = made.get_mut(target.offset as usize..(target.offset + target.bytes(format)) as usize)?;
        rows.par_chunks_mut(target.bytes_per_row as usize).enumerate().for_each(|(row, blocks)| {
            let band = band(level, texels, row);
            let width = band.len() as u32 / (4 * BLOCK as u32);
            compress_rgba8(variant, &band, blocks, width, BLOCK as u32, 4 * width);
        });
    }
    Some((compressed, made))
}

fn is_opaque(texels: &[u8]) -> bool {
    texels.chunks_exact(4).all(|texel| texel[3] == u8::MAX)
}

/// The texels of a row of blocks; beyond the level's edges those at them.
fn band(level: &Level, texels: &[u8], row: usize) -> Vec<u8> {
    let [width, height] = [level.width, level.height].map(|side| side as usize);
    let mut band = Vec::with_capacity(4 * BLOCK * width.next_multiple_of(BLOCK));
    for y in row * BLOCK..(row + 1) * BLOCK {
        let row = &texels[y.min(height - 1) * width * 4..][..width * 4];
        band.extend_from_slice(row);
        for _ in width..width.next_multiple_of(BLOCK) {
            band.extend_from_slice(&row[4 * (width - 1)..]);
        }
    }
    band
}

#[cfg(test)]
mod tests {
    use super::blocks;
    use block_compression::decode::decompress_blocks_as_rgba8;
    use block_compression::{BC7Settings, CompressionVariant};
    use texgraph_compiler::manifest::{Compression, Format, Table};

    /// Slopes along both axes, all levels alike, and the texels that their blocks stand for.
    fn there_and_back(format: Format, size: [u32; 2]) -> Vec<(Vec<u8>, Vec<u8>)> {
        let table = Table::mipmapped(Format::Rgba8Unorm, size, 1);
        let texels = table.levels.iter().flat_map(|level| {
            let place = (0..level.height).flat_map(|y| (0..level.width).map(move |x| [x, y]));
            place.flat_map(|[x, y]| [(x * 3) as u8, (y * 3) as u8, (x + y) as u8, u8::MAX])
        });
        let bytes: Vec<u8> = texels.collect();
        let (compressed, made) = blocks(&table, &bytes, format).expect("8-bit texels");
        let variant = match format {
            Format::Bc1RgbaUnorm => CompressionVariant::BC1,
            _ => CompressionVariant::BC7(BC7Settings::opaque_ultra_fast()),
        };
        let levels = table.levels.iter().zip(&compressed.levels).map(|(level, target)| {
            let blocks = &made[target.offset as usize..][..target.bytes(format) as usize];
            let texels = &bytes[level.offset as usize..][..level.bytes(table.format) as usize];
            let [width, height] = [level.width, level.height].map(|side| side.next_multiple_of(4));
            let mut back = vec![0; 4 * (width * height) as usize];
            decompress_blocks_as_rgba8(variant, width, height, blocks, &mut back);
            let rows = back.chunks_exact(4 * width as usize).take(level.height as usize);
            (texels.to_vec(), rows.flat_map(|row| &row[..4 * level.width as usize]).copied().collect())
        });
        levels.collect()
    }

    #[test]
    fn blocks_of_all_levels_stand_for_their_texels() {
        // Colours of a block lie on a line, where these fill a square of 9 by 9: half of that, a step of
        // the line, and where ends have 5 bits half a step of those.
        for (format, most) in [(Format::Bc1RgbaUnorm, 5 + 3 + 4), (Format::Bc7RgbaUnorm, 5 + 1)] {
            for size in [[64, 64], [20, 36], [4, 64]] {
                for (texels, back) in there_and_back(format, size) {
                    let apart = texels.iter().zip(&back).map(|(a, b)| a.abs_diff(*b)).max();
                    assert!(apart <= Some(most), "{format:?}, {size:?}: {apart:?}");
                }
            }
        }
    }

    #[test]
    fn sizes_are_those_of_the_formats() {
        let bytes = |compress: Compression| {
            let format = compress.format().expect("compressed");
            Table::mipmapped(format, [256, 128], 1).levels[0].bytes(format)
        };
        assert_eq!(bytes(Compression::Bc1), 256 * 128 / 2);
        assert_eq!(bytes(Compression::Bc7), 256 * 128);
    }
}
