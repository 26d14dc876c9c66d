//! `texgraph tiles`: tile sets from photographs. Each subcommand is a file of its name.

pub mod args;
mod check;
mod layout;
mod make;
mod transition;

use crate::output;
use crate::problem::{Problem, Report};
use args::{Tiles, TilesCommand};
use std::path::Path;
use texgraph_runtime::tiles::{Bitmap, TilesError};

/// Runs the subcommand.
///
/// # Errors
/// As it says.
pub fn run(args: &Tiles, report: &mut Report) -> Result<(), Problem> {
    match &args.command {
        TilesCommand::Make(args) => make::run(args),
        TilesCommand::Transition(args) => transition::run(args),
        TilesCommand::Layout(args) => layout::run(args),
        TilesCommand::Check(args) => check::run(args, report),
    }
}

/// Reads a picture.
fn open(path: &Path) -> Result<Bitmap, Problem> {
    let shown = path.display().to_string();
    if path.file_name().is_none() {
        return Err(Problem::Input(format!("`{shown}` is a folder, not a file")));
    }
    Bitmap::open(path).map_err(|diagnostics| Problem::Picture { path: shown, diagnostics })
}

/// Makes a sheet for a place that is known to be writable, and writes it.
fn write(path: &Path, make: impl FnOnce() -> Result<Bitmap, Problem>) -> Result<(), Problem> {
    output::try_png(path)?;
    output::write(&[(path.to_path_buf(), make()?.to_png()?)])
}

/// What is wrong with a picture, by its name, or with what is asked for.
fn refused(path: &Path, error: TilesError) -> Problem {
    match Problem::from(error) {
        Problem::Input(sentence) => Problem::Input(format!("`{}`: {sentence}", path.display())),
        other => other,
    }
}

impl From<TilesError> for Problem {
    fn from(error: TilesError) -> Problem {
        let sentence = error.to_string();
        match error {
            TilesError::Count { .. }
            | TilesError::TileSide { .. }
            | TilesError::SheetTooLarge { .. }
            | TilesError::Families { .. } => Problem::Usage(sentence),
            TilesError::PhotoTooSmall { .. }
            | TilesError::UnevenGrid { .. }
            | TilesError::SizesDiffer { .. }
            | TilesError::NotSquare { .. }
            | TilesError::Codes { .. } => Problem::Input(sentence),
        }
    }
}
