//! `texgraph tiles transition`: the sixteen tiles between two families, or of one over nothing.

use super::args::Transition;
use crate::problem::Problem;
use std::path::Path;
use texgraph_runtime::tiles::{self, Family};

/// Tiles of a family, where a photograph is cut: as many as there are corner codes.
const COUNT: u32 = 16;

/// Makes the sheet.
///
/// # Errors
/// A picture can't be read or does not suit, or the sheet can't be written.
pub fn run(args: &Transition) -> Result<(), Problem> {
    super::write(&args.output_file, || {
        let first = family(args, &args.first)?;
        Ok(match &args.second {
            Some(second) => tiles::transition(&first, &family(args, second)?, args.seed)?,
            None => tiles::border(&first, args.seed)?,
        })
    })
}

fn family(args: &Transition, path: &Path) -> Result<Family, Problem> {
    let picture = super::open(path)?;
    let family = match args.grid {
        Some(grid) => Family::of_sheet(&picture, grid),
        None => Family::cut(&picture, args.size, COUNT, args.seed),
    };
    family.map_err(|error| super::refused(path, error))
}
