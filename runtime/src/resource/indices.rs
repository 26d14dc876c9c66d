//! `indices`: a map of integers. Field `map`.
//!
//! A grey picture's range is cut into `levels` equal steps, numbered from 0 (black): with two
//! levels and 8 bits, 0 to 127 is 0 and 128 to 255 is 1. A list of rows is taken as it is.

use super::decode;
use super::table::{MAX_SIDE, Made};
use crate::project::Project;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};
use texgraph_compiler::manifest::{Format, IndicesSource};

/// Makes the texture.
///
/// # Errors
/// The picture can't be read or has colours; rows are empty or of different lengths; a number is
/// not in 0..levels; a side is too long.
pub fn make(
    project: &Project,
    place: Place,
    source: &IndicesSource,
    levels: u32,
) -> Result<Vec<Made>, Vec<Diagnostic>> {
    let made = match source {
        IndicesSource::Path(path) => of_picture(project, place, path, levels)?,
        IndicesSource::Rows(rows) => of_rows(place, rows, levels)?,
    };
    Ok(vec![made])
}

fn of_picture(project: &Project, place: Place, path: &str, levels: u32) -> Result<Made, Vec<Diagnostic>> {
    let file = decode::open(project, path, place)?;
    let size = file.size;
    if size.iter().any(|side| *side > MAX_SIDE) {
        return Err(vec![resources::texture_too_large(place, path, size, MAX_SIDE)]);
    }
    let picture = file.decode()?;
    let codes = u64::from(picture.white()) + 1;
    let mut numbers = Vec::with_capacity(size[0] as usize * size[1] as usize);
    for y in 0..size[1] {
        for x in 0..size[0] {
            let [red, green, blue, _] = picture.texel(x, y);
            if red != green || red != blue {
                return Err(vec![resources::not_grey(place, path, [x, y])]);
            }
            numbers.push((u64::from(red) * u64::from(levels) / codes) as i32);
        }
    }
    Ok(Made::integers("map", Format::R32Sint, size, numbers.into_iter()))
}

fn of_rows(place: Place, rows: &[Vec<i32>], levels: u32) -> Result<Made, Vec<Diagnostic>> {
    let width = rows.first().map_or(0, Vec::len);
    let refuse = |message: String, reason: String| Err(vec![resources::no_table(place, message, reason)]);
    if width == 0 {
        return refuse("the map has no numbers".into(), "at least one is needed".into());
    }
    if width.max(rows.len()) > MAX_SIDE as usize {
        let size = [width, rows.len()].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
        return Err(vec![resources::texture_too_large(place, "this list", size, MAX_SIDE)]);
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
    let size = [width as u32, rows.len() as u32];
    Ok(Made::integers("map", Format::R32Sint, size, rows.iter().flatten().copied()))
}
