//! `texgraph check`: all errors and warnings of all files.

use crate::args::Check;
use crate::problem::{Problem, Report};
use crate::program::{self, Program};

/// Checks file after file; an error in one does not keep the next from being checked.
///
/// # Errors
/// Nothing can be checked at all. What is wrong with the files is shown as it is found.
pub fn run(args: &Check, report: &mut Report) -> Result<(), Problem> {
    let library = program::library()?;
    for file in &args.files {
        let checked = Program::open(&library, file, args.common.allow_outside).and_then(|program| {
            report.warn(&program.check()?);
            program.check_profile(args.host.profile.into())
        });
        if let Err(problem) = checked {
            report.show(&problem);
        }
    }
    Ok(())
}
