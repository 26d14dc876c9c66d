//! `texgraph tiles make`: a photograph as a sheet of compatible tiles.

use super::args::Make;
use crate::problem::Problem;
use texgraph_runtime::tiles;

/// Makes the sheet.
///
/// # Errors
/// The photograph can't be read or is too small, or the sheet can't be written.
pub fn run(args: &Make) -> Result<(), Problem> {
    super::write(&args.output_file, || {
        let photo = super::open(&args.photo)?;
        let made = tiles::make(&photo, args.grid, args.size, args.seed);
        made.map_err(|error| super::refused(&args.photo, error))
    })
}
