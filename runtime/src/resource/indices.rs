//! `indices`: a map of integers. Field `map`.
//!
//! A grey picture's range is cut into `levels` equal steps, numbered from 0 (black): with two
//! levels and 8 bits, 0 to 127 is 0 and 128 to 255 is 1. A list of rows is taken as it is. On a line
//! there is one row; in space the slices stand one below another, and each is a layer.

use super::decode;
use super::shape::Shape;
use super::table::{MAX_LAYERS, MAX_SIDE, Made};
use crate::project::Project;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};
use texgraph_compiler::manifest::{Format, IndicesSource, Table};

/// Makes the texture.
///
/// # Errors
/// The picture can't be read or has colours; rows are empty or of different lengths, more than one on a
/// line, or no whole number of slices in space; a number is not in 0..levels; a side is too long.
pub fn make(
    project: &Project,
    place: Place,
    source: &IndicesSource,
    levels: u32,
    shape: Shape,
) -> Result<Vec<Made>, Vec<Diagnostic>> {
    let layout = |path: &str, size| layout(place, path, size, shape);
    let (table, numbers) = match source {
        IndicesSource::Path(path) => of_picture(project, place, path, levels, layout)?,
        IndicesSource::Rows(rows) => of_rows(place, rows, levels, layout)?,
    };
    // Slices one below another are layers one after the other.
    Ok(vec![Made { field: "map", table, bytes: numbers.into_iter().flat_map(i32::to_le_bytes).collect() }])
}

/// How the numbers of so many columns and rows lie in a texture.
fn layout(place: Place, path: &str, size: [u32; 2], shape: Shape) -> Result<Table, Vec<Diagnostic>> {
    let [width, rows] = size;
    let depth = shape.slices();
    if shape == Shape::Line && rows > 1 {
        return Err(vec![resources::map_is_no_row(place, path, size)]);
    }
    if !(1..=MAX_LAYERS).contains(&depth) {
        return Err(vec![resources::too_many_layers(place, u64::from(depth), MAX_LAYERS)]);
    }
    if !rows.is_multiple_of(depth) {
        return Err(vec![resources::uneven_slices(place, path, size, depth)]);
    }
    let slice = [width, rows / depth];
    if slice.iter().any(|side| *side > MAX_SIDE) {
        return Err(vec![resources::texture_too_large(place, path, slice, MAX_SIDE)]);
    }
    Ok(Table::with_levels(Format::R32Sint, slice, depth, 1))
}

fn of_picture(
    project: &Project,
    place: Place,
    path: &str,
    levels: u32,
    layout: impl Fn(&str, [u32; 2]) -> Result<Table, Vec<Diagnostic>>,
) -> Result<(Table, Vec<i32>), Vec<Diagnostic>> {
    let file = decode::open(project, path, place)?;
    let size = file.size;
    let table = layout(path, size)?;
    let picture = file.decode()?;
    let mut numbers = Vec::with_capacity(size[0] as usize * size[1] as usize);
    for y in 0..size[1] {
        for x in 0..size[0] {
            let [red, green, blue, _] = picture.texel(x, y);
            if red != green || red != blue {
                return Err(vec![resources::not_grey(place, path, [x, y])]);
            }
            numbers.push(picture.depth.part(red, levels) as i32);
        }
    }
    Ok((table, numbers))
}

fn of_rows(
    place: Place,
    rows: &[Vec<i32>],
    levels: u32,
    layout: impl Fn(&str, [u32; 2]) -> Result<Table, Vec<Diagnostic>>,
) -> Result<(Table, Vec<i32>), Vec<Diagnostic>> {
    let width = rows.first().map_or(0, Vec::len);
    let refuse = |message: String, reason: String| Err(vec![resources::no_table(place, message, reason)]);
    if width == 0 {
        return refuse("the map has no numbers".into(), "at least one is needed".into());
    }
    for (y, row) in rows.iter().enumerate() {
        if row.len() != width {
            let message = format!("row {y} has {} numbers, row 0 has {width}", row.len());
            return refuse(message, "all rows have one length".into());
        }
        if let Some(number) = row.iter().find(|number| u32::try_from(**number).map_or(true, |n| n >= levels))
        {
            let message = format!("row {y} holds {number}, which is not in 0..{levels}");
            return refuse(message, "numbers are below `levels`".into());
        }
    }
    let size = [width, rows.len()].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    Ok((layout("this list", size)?, rows.iter().flatten().copied().collect()))
}
