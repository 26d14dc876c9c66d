//! `materials`: probabilities, or patterns, chosen by a number (Lefebvre & Neyret 2003, §3.2, materials
//! map). A row of the shared tables: first (start, length, family, 0) of each material, then the lists:
//! (a pattern's number, how often the number of this place stands in the list, 0, 0).
//!
//! The patterns of all materials are layers of one texture, field `layers`, one material after the
//! other. Field `means` holds the mean of each layer, of all, and of each material.

use super::decode::Decoded;
use super::encoding::{self, Reader};
use super::patterns::{self, Sheet};
use super::resample::Resampler;
use super::table::{self, Made};
use super::{all, pyramid};
use crate::project::Project;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};
use texgraph_compiler::manifest::{Encoding, Recipe, Resource};

/// The widest row of the shared tables.
const MAX_ROW: usize = 8192;

/// The entries of the row.
///
/// # Errors
/// A material is neither a probability nor patterns, its list is empty, or there are too many entries.
pub fn entries(
    place: Place,
    (items, families): (&[u32], &[i32]),
    length: u32,
    known: &[Resource],
) -> Result<Vec<[i32; 4]>, Vec<Diagnostic>> {
    let refuse = |message: String| vec![resources::no_table(place, message, "a list of materials")];
    let lists = lists(items, known).ok_or_else(|| refuse("a material has no list of patterns".into()))?;
    let lengths = lists.iter().map(|list| if length > 0 { length as usize } else { own_length(list) });
    let lengths: Vec<usize> = lengths.collect();
    let total = lengths.iter().fold(lists.len(), |sum, length| sum.saturating_add(*length));
    if total > MAX_ROW || lists.is_empty() {
        return Err(refuse(format!("a row of {total} entries can't be made")));
    }
    let mut row = Vec::with_capacity(total);
    let mut start = lists.len();
    for (i, length) in lengths.iter().enumerate() {
        row.push([start as i32, *length as i32, families.get(i).copied().unwrap_or(0), 0]);
        start += length;
    }
    for (list, length) in lists.iter().zip(lengths) {
        let count = |number: usize| list.iter().filter(|n| usize::try_from(**n) == Ok(number)).count();
        let times = |number: usize| (count(number) * length / list.len()) as i32;
        row.extend((0..length).map(|i| [list[i % list.len()], times(i), 0, 0]));
    }
    Ok(row)
}

/// The pattern numbers of each material; none if one is no material.
fn lists(items: &[u32], known: &[Resource]) -> Option<Vec<Vec<i32>>> {
    let mut first = 0;
    let list = |item: &u32| match &known.get(*item as usize)?.recipe {
        Recipe::Probability { numbers } => (!numbers.is_empty()).then(|| numbers.clone()),
        Recipe::Patterns { paths, grid, .. } => {
            let count = patterns::count(paths, *grid).clamp(1, u64::from(table::MAX_LAYERS)) as i32;
            let range = first..first + count;
            first = range.end;
            Some(range.collect())
        }
        _ => None,
    };
    items.iter().map(list).collect()
}

/// As often the whole of a list as the numbers in it need.
fn own_length(list: &[i32]) -> usize {
    let reach = list.iter().copied().max().map_or(0, |last| usize::try_from(last + 1).unwrap_or(0));
    list.len() * reach.div_ceil(list.len()).max(1)
}

/// Makes the layers of materials that are patterns.
///
/// # Errors
/// All pictures that can't be read; patterns of different sizes, where none is given to resample them
/// to; or more than a texture may hold.
pub fn make(
    project: &Project,
    place: Place,
    items: &[u32],
    size: Option<[u32; 2]>,
    known: &[Resource],
) -> Result<Vec<Made>, Vec<Diagnostic>> {
    let recipes = items.iter().map(|item| match known.get(*item as usize).map(|found| &found.recipe) {
        Some(Recipe::Patterns { paths, grid, encoding }) => Ok((paths.as_slice(), *grid, *encoding)),
        _ => {
            let message = "materials of probabilities have no pictures";
            Err(vec![resources::no_table(place, message, "its patterns are those that they are drawn from")])
        }
    });
    let recipes: Vec<(&[String], [u32; 2], Encoding)> = recipes.collect::<Result<_, _>>()?;
    let sheets = all(&recipes, |(paths, grid, _)| Sheet::open(project, place, paths, *grid))?;
    let (Some(first), Some((paths, _, encoding))) = (sheets.first(), recipes.first()) else {
        return Err(vec![resources::no_table(place, "there are no materials", "at least one is needed")]);
    };
    let size = match size {
        Some(size) => size,
        None => one_size(place, &sheets, first)?,
    };
    let count: u64 = sheets.iter().map(|sheet| u64::from(sheet.count)).sum();
    let layers = u32::try_from(count).unwrap_or(u32::MAX);
    let format = encoding::format(*encoding, sheets.iter().any(Sheet::is_deep));
    table::check(place, paths.first().map_or("", String::as_str), format, size, layers)?;
    let pictures: Vec<Vec<Decoded>> = all(&sheets, Sheet::decode)?;
    let readers: Vec<Vec<Reader<'_>>> = pictures
        .iter()
        .map(|pictures| pictures.iter().map(|picture| Reader::new(picture, *encoding)).collect())
        .collect();
    let resamplers: Vec<Resampler> = sheets.iter().map(|sheet| Resampler::new(sheet.cell, size)).collect();
    let owners: Vec<(usize, u32)> = sheets
        .iter()
        .enumerate()
        .flat_map(|(i, sheet)| (0..sheet.count).map(move |pattern| (i, pattern)))
        .collect();
    let texel = |layer: u32, x: u32, y: u32| {
        let (i, pattern) = owners[layer as usize];
        resamplers[i].texel(x, y, |x, y| sheets[i].texel(&readers[i], pattern, x, y))
    };
    let groups: Vec<u32> = sheets.iter().map(|sheet| sheet.count).collect();
    Ok(vec![
        pyramid::build("layers", format, size, layers, texel),
        patterns::means(size, layers, &groups, texel),
    ])
}

/// The size of all patterns, which must be one.
fn one_size(place: Place, sheets: &[Sheet<'_>], first: &Sheet<'_>) -> Result<[u32; 2], Vec<Diagnostic>> {
    let odd = sheets.iter().filter(|sheet| sheet.cell != first.cell);
    let errors: Vec<Diagnostic> = odd
        .map(|sheet| {
            resources::materials_of_sizes(place, (first.path(), first.cell), (sheet.path(), sheet.cell))
        })
        .collect();
    if errors.is_empty() { Ok(first.cell) } else { Err(errors) }
}
