//! `patterns`: interchangeable pictures, one layer each, with a mip chain of its own: field
//! `layers`. Field `means` holds the mean of each, a texel each, and last that of all.
//!
//! Layers are what keeps a pattern's filter from reading its neighbour: the sub-textures that
//! Lefebvre & Neyret 2003, §5.2, ask hardware for. They come from the cells of one picture, row by
//! row, or from a list of files.

use super::decode::{self, PictureFile};
use super::encoding::{self, Reader};
use super::pyramid;
use super::table::{self, Made};
use crate::project::Project;
use glam::{DVec4, Vec4};
use rayon::iter::{IntoParallelIterator, IntoParallelRefIterator, ParallelIterator};
use std::ops::Add;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};
use texgraph_compiler::manifest::{Encoding, Format, Table};

/// Makes the texture: of one picture cut by `grid` (columns, rows), or of several pictures.
///
/// # Errors
/// All pictures that can't be read, or else a grid that does not divide the picture, sizes that
/// differ, or more than a texture may hold.
pub fn make(
    project: &Project,
    place: Place,
    paths: &[String],
    grid: [u32; 2],
    encoding: Encoding,
) -> Result<Vec<Made>, Vec<Diagnostic>> {
    let count = paths.len() as u64 * u64::from(grid[0]) * u64::from(grid[1]);
    if count > u64::from(table::MAX_LAYERS) {
        return Err(vec![resources::too_many_layers(place, count, table::MAX_LAYERS)]);
    }
    let Some(first) = paths.first().filter(|_| count > 0) else {
        return Err(vec![resources::no_table(place, "there are no patterns", "at least one is needed")]);
    };
    let files = all(paths, |path| decode::open(project, path, place))?;
    let cell = cell(place, paths, &files, grid)?;
    let format = encoding::format(encoding, files.iter().any(|file| file.is_deep));
    // Before anything is decoded: many files could fill the memory together.
    table::check(place, first, format, cell, count as u32)?;
    let pictures = all(&files, PictureFile::decode)?;
    let readers: Vec<Reader<'_>> = pictures.iter().map(|picture| Reader::new(picture, encoding)).collect();
    let cells = grid[0] * grid[1];
    let texel = |layer: u32, x: u32, y: u32| {
        let (picture, within) = (layer / cells, layer % cells);
        let (column, row) = (within % grid[0], within / grid[0]);
        readers[picture as usize].texel(column * cell[0] + x, row * cell[1] + y)
    };
    Ok(vec![pyramid::build("layers", format, cell, count as u32, texel), means(cell, count as u32, texel)])
}

/// The mean of each pattern's level 0, then that of all, as 16-bit floats.
fn means(size: [u32; 2], count: u32, texel: impl Fn(u32, u32, u32) -> Vec4 + Sync) -> Made {
    let mean = |layer: u32| {
        let rows = (0..size[1]).map(|y| {
            let row = (0..size[0]).map(|x| texel(layer, x, y).as_dvec4());
            row.fold(DVec4::ZERO, Add::add)
        });
        rows.fold(DVec4::ZERO, Add::add) / (f64::from(size[0]) * f64::from(size[1]))
    };
    let mut means: Vec<DVec4> = (0..count).into_par_iter().map(mean).collect();
    means.push(means.iter().copied().fold(DVec4::ZERO, Add::add) / f64::from(count));
    let table = Table::with_levels(Format::Rgba16Float, [count + 1, 1], 1, 1);
    let mut bytes = vec![0; table.bytes() as usize];
    let writer = encoding::Writer::new(Format::Rgba16Float);
    for (slot, mean) in bytes.chunks_exact_mut(8).zip(&means) {
        writer.write(mean.as_vec4(), slot);
    }
    Made { field: "means", table, bytes }
}

/// The results for all items, in parallel; or all errors, in their order.
fn all<'a, T: Sync, R: Send>(
    items: &'a [T],
    f: impl Fn(&'a T) -> Result<R, Vec<Diagnostic>> + Send + Sync,
) -> Result<Vec<R>, Vec<Diagnostic>> {
    let results: Vec<_> = items.par_iter().map(f).collect();
    let (mut done, mut errors) = (Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok(one) => done.push(one),
            Err(found) => errors.extend(found),
        }
    }
    if errors.is_empty() { Ok(done) } else { Err(errors) }
}

/// The size of one pattern in texels.
fn cell(
    place: Place,
    paths: &[String],
    files: &[PictureFile<'_>],
    grid: [u32; 2],
) -> Result<[u32; 2], Vec<Diagnostic>> {
    let named: Vec<(&str, [u32; 2])> =
        paths.iter().map(String::as_str).zip(files.iter().map(|file| file.size)).collect();
    let Some(&first) = named.first() else {
        return Ok([1, 1]);
    };
    let odd = named.iter().filter(|(_, size)| *size != first.1);
    let errors: Vec<Diagnostic> = odd.map(|other| resources::sizes_differ(place, first, *other)).collect();
    if !errors.is_empty() {
        return Err(errors);
    }
    let (path, size) = first;
    if size[0] % grid[0] != 0 || size[1] % grid[1] != 0 {
        return Err(vec![resources::uneven_grid(place, path, size, grid)]);
    }
    Ok([size[0] / grid[0], size[1] / grid[1]])
}
