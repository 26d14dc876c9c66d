//! `patterns`: interchangeable pictures, one layer each, with a mip chain of its own: field
//! `layers`. Field `means` holds the mean of each, a texel each, and last that of all.
//!
//! Layers are what keeps a pattern's filter from reading its neighbour: the sub-textures that
//! Lefebvre & Neyret 2003, §5.2, ask hardware for. They come from the cells of one picture, row by
//! row, or from a list of files. On a line (`patterns<1>`) a layer is one texel high. In space (`patterns<3>`) a layer is a slice, and a smaller level of
//! it the mean of a group of slices.

use super::decode::{self, Decoded, PictureFile};
use super::encoding::{self, Reader};
use super::shape::Shape;
use super::table::{self, Made};
use super::{all, pyramid};
use crate::project::Project;
use glam::{DVec4, Vec4};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::ops::Add;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};
use texgraph_compiler::manifest::{Encoding, Format, Table};

/// Makes the textures: of one picture cut by `grid` (columns, rows), or of several pictures; cells are
/// patterns, or in space the slices of patterns.
///
/// # Errors
/// All pictures that can't be read, or else a grid that does not divide the picture, sizes that
/// differ, cells on a line that are no rows, slices that make no whole number of patterns, or more than
/// a texture may hold.
pub fn make(
    project: &Project,
    place: Place,
    paths: &[String],
    grid: [u32; 2],
    shape: Shape,
    encoding: Encoding,
) -> Result<Vec<Made>, Vec<Diagnostic>> {
    let sheet = Sheet::open(project, place, paths, grid)?;
    if shape == Shape::Line && sheet.cell[1] > 1 {
        return Err(vec![resources::cells_are_no_rows(place, sheet.path(), sheet.cell, grid)]);
    }
    let depth = shape.slices();
    if depth == 0 || !sheet.count.is_multiple_of(depth) {
        let message = format!("{} slices are no whole number of patterns of {depth}", sheet.count);
        return Err(vec![resources::no_table(place, message, "some are left over")]);
    }
    let format = encoding::format(encoding, sheet.is_deep());
    // Before anything is decoded: many files could fill the memory together.
    table::check(place, sheet.path(), format, sheet.cell, sheet.count)?;
    let pictures = sheet.decode()?;
    let readers: Vec<Reader<'_>> = pictures.iter().map(|picture| Reader::new(picture, encoding)).collect();
    let texel = |layer: u32, x: u32, y: u32| sheet.texel(&readers, layer, x, y);
    let blocks = sheet.count / depth;
    let groups = match shape {
        Shape::Line | Shape::Plane => Vec::new(),
        Shape::Space { depth } => vec![depth; blocks as usize],
    };
    Ok(vec![
        pyramid::build_blocks("layers", format, sheet.cell, [blocks, depth], texel),
        means(sheet.cell, sheet.count, &groups, texel),
    ])
}

/// How many patterns these are.
pub fn count(paths: &[String], grid: [u32; 2]) -> u64 {
    paths.len() as u64 * u64::from(grid[0]) * u64::from(grid[1])
}

/// Pictures of patterns whose headers were read.
pub struct Sheet<'a> {
    files: Vec<PictureFile<'a>>,
    paths: &'a [String],
    grid: [u32; 2],
    /// The size of one pattern in texels.
    pub cell: [u32; 2],
    /// How many patterns there are.
    pub count: u32,
}

impl<'a> Sheet<'a> {
    /// Reads the files and their headers.
    ///
    /// # Errors
    /// All pictures that can't be read, or else a grid that does not divide the picture, sizes that
    /// differ, none or too many patterns.
    pub fn open(
        project: &Project,
        place: Place,
        paths: &'a [String],
        grid: [u32; 2],
    ) -> Result<Sheet<'a>, Vec<Diagnostic>> {
        let count = count(paths, grid);
        if count > u64::from(table::MAX_LAYERS) {
            return Err(vec![resources::too_many_layers(place, count, table::MAX_LAYERS)]);
        }
        if count == 0 {
            return Err(vec![resources::no_table(place, "there are no patterns", "at least one is needed")]);
        }
        let files = all(paths, |path| decode::open(project, path, place))?;
        let cell = cell(place, paths, &files, grid)?;
        Ok(Sheet { files, paths, grid, cell, count: count as u32 })
    }

    /// The path of the first picture.
    pub fn path(&self) -> &'a str {
        self.paths.first().map_or("", String::as_str)
    }

    /// Whether a picture has more than 8 bits a sample.
    pub fn is_deep(&self) -> bool {
        self.files.iter().any(|file| file.depth.is_deep())
    }

    /// The pictures.
    ///
    /// # Errors
    /// All files that are no whole picture.
    pub fn decode(&self) -> Result<Vec<Decoded>, Vec<Diagnostic>> {
        all(&self.files, PictureFile::decode)
    }

    /// A texel of a pattern, from readers of all pictures.
    pub fn texel(&self, readers: &[Reader<'_>], pattern: u32, x: u32, y: u32) -> Vec4 {
        let cells = self.grid[0] * self.grid[1];
        let (picture, within) = (pattern / cells, pattern % cells);
        let (column, row) = (within % self.grid[0], within / self.grid[0]);
        readers[picture as usize].texel(column * self.cell[0] + x, row * self.cell[1] + y)
    }
}

/// The mean of each pattern's level 0, then that of all, then those of groups of so many patterns one
/// after the other; as 16-bit floats.
pub fn means(
    size: [u32; 2],
    count: u32,
    groups: &[u32],
    texel: impl Fn(u32, u32, u32) -> Vec4 + Sync,
) -> Made {
    let mean = |layer: u32| {
        let rows = (0..size[1]).map(|y| {
            let row = (0..size[0]).map(|x| texel(layer, x, y).as_dvec4());
            row.fold(DVec4::ZERO, Add::add)
        });
        rows.fold(DVec4::ZERO, Add::add) / (f64::from(size[0]) * f64::from(size[1]))
    };
    let mut means: Vec<DVec4> = (0..count).into_par_iter().map(mean).collect();
    let of = |means: &[DVec4]| means.iter().copied().fold(DVec4::ZERO, Add::add) / means.len().max(1) as f64;
    let mut first = 0;
    let group = |count: &u32| {
        let range = first..first + *count as usize;
        first = range.end;
        of(means.get(range).unwrap_or_default())
    };
    let further: Vec<DVec4> = groups.iter().map(group).collect();
    means.push(of(&means));
    means.extend(further);
    let table = Table::with_levels(Format::Rgba16Float, [means.len() as u32, 1], 1, 1);
    let mut bytes = vec![0; table.bytes() as usize];
    let writer = encoding::Writer::new(Format::Rgba16Float);
    for (slot, mean) in bytes.chunks_exact_mut(8).zip(&means) {
        writer.write(mean.as_vec4(), slot);
    }
    Made { field: "means", table, bytes }
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
