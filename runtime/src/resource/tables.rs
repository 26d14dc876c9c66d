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
    let entries = rows.iter().map(|row| match all.get(*row as usize).map(|resource| &resource.recipe) {
        Some(Recipe::Permutation { size, seed }) => permutation::entries(place, *size, *seed),
        Some(Recipe::Materials { items, families, length, .. }) => {
            materials::entries(place, (items, families), *length, all)
        }
        Some(Recipe::Probability { numbers }) => probability::entries(place, numbers),
        _ => {
            let message = format!("resource {row} is no small table");
            Err(vec![resources::no_table(place, message, "a row of the shared tables")])
        }
    });
    let entries = entries.collect::<Result<Vec<_>, _>>()?;
    let width = entries.iter().map(Vec::len).max().unwrap_or(1);
    let texels = entries.iter().flat_map(|row| {
        let rest = std::iter::repeat_n([0; 4], width - row.len());
        row.iter().copied().chain(rest).flatten()
    });
    let size = [width as u32, entries.len().max(1) as u32];
    Ok(vec![Made::integers("table", Format::Rgba32Sint, size, texels)])
}
