//! `texgraph tiles layout`: an empty sheet with its corner codes.

use super::args::Layout;
use crate::problem::Problem;
use texgraph_runtime::tiles;

/// Draws the sheet.
///
/// # Errors
/// There are too many tiles, or the sheet can't be written.
pub fn run(args: &Layout) -> Result<(), Problem> {
    super::write(&args.output_file, || Ok(tiles::layout(args.families, args.size)?))
}
