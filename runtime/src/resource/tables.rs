//! Small tables that share one texture, a row each. Field `table`.

use super::table::Made;
use super::{materials, permutation, probability};
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};
use texgraph_compiler::manifest::{Format, Recipe, Resource};

/// Makes the texture from the resources that are its rows.
///
/// # Errors
/// A row is no table, or its table can't be made.
pub fn make(place: Place, rows: &[u32], all: &[Resource]) -> Result<Vec<Made>, Vec<Diagnostic>> {
    let tables = rows.chunk_by(|one, next| one == next).map(|same| split(place, same, all));
    let rows = tables.collect::<Result<Vec<_>, _>>()?.concat();
    let width = rows.iter().map(Vec::len).max().unwrap_or(1);
    let texels = rows.iter().flat_map(|row| {
        let rest = std::iter::repeat_n([0; 4], width - row.len());
        row.iter().copied().chain(rest).flatten()
    });
    let size = [width as u32, rows.len().max(1) as u32];
    Ok(vec![Made::integers("table", Format::Rgba32Sint, size, texels)])
}

/// The rows of a resource, which stands in the list once for each.
fn split(place: Place, same: &[u32], all: &[Resource]) -> Result<Vec<Vec<[i32; 4]>>, Vec<Diagnostic>> {
    let entries = entries(place, same[0], all)?;
    match same.len() {
        1 => Ok(vec![entries]),
        _ => Ok(entries.chunks(Recipe::ROW as usize).map(<[_]>::to_vec).collect()),
    }
}

/// What a table holds.
fn entries(place: Place, index: u32, all: &[Resource]) -> Result<Vec<[i32; 4]>, Vec<Diagnostic>> {
    match all.get(index as usize).map(|resource| &resource.recipe) {
        Some(Recipe::Permutation { size, seed }) => permutation::entries(place, *size, *seed),
        Some(Recipe::Materials { items, families, length, .. }) => {
            materials::entries(place, (items, families), *length, all)
        }
        Some(Recipe::Probability { numbers }) => probability::entries(place, numbers),
        _ => {
            let message = format!("resource {index} is no small table");
            Err(vec![resources::no_table(place, message, "a row of the shared tables")])
        }
    }
}
