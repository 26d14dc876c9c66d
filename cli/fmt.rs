//! `texgraph fmt`: the canonical layout, in place, checked, or from standard input.

use crate::args::Fmt;
use crate::output;
use crate::problem::{Problem, Report};
use crate::program;
use std::io::Read;
use std::path::Path;
use texgraph_compiler::Failure;
use texgraph_compiler::diagnostic::syntax;
use texgraph_grammar::MAX_BYTES;

/// Formats file after file; one that is wrong does not keep the next from being formatted.
///
/// # Errors
/// Never as a whole: what is wrong with a file is shown as it is found.
pub fn run(args: &Fmt, report: &mut Report) -> Result<(), Problem> {
    for file in &args.files {
        match one(file, args.check) {
            Ok(Outcome::Fine) => {}
            Ok(Outcome::WouldChange) => report.count_as_wrong(),
            Err(problem) => report.show(&problem),
        }
    }
    Ok(())
}

/// What became of a file.
enum Outcome {
    /// It has the canonical layout now, or it was printed.
    Fine,
    /// It has not, and nothing may be written.
    WouldChange,
}

fn one(file: &Path, only_check: bool) -> Result<Outcome, Problem> {
    let is_stdin = file == Path::new("-");
    let (path, text) = if is_stdin { stdin()? } else { program::text(file)? };
    let formatted = format(&path, &text)?;
    match (only_check, is_stdin) {
        (true, _) if formatted == text => {}
        (true, _) => {
            output::print(&format!("{path}\n"))?;
            return Ok(Outcome::WouldChange);
        }
        (false, true) => output::print(&formatted)?,
        (false, false) if formatted == text => {}
        (false, false) => output::write(&[(file.to_path_buf(), formatted)])?,
    }
    Ok(Outcome::Fine)
}

fn format(path: &str, text: &str) -> Result<String, Problem> {
    texgraph_grammar::format(text).map_err(|errors| {
        let diagnostics = errors.iter().map(|error| syntax::error(0, error)).collect();
        Problem::Pages(Failure { sources: program::sources(path, text), diagnostics })
    })
}

/// Standard input, as far as the grammar accepts it: what is longer is refused by its length, not
/// read to an end that may never come.
fn stdin() -> Result<(String, String), Problem> {
    let mut bytes = Vec::new();
    let limit = MAX_BYTES as u64 + 1;
    std::io::stdin()
        .lock()
        .take(limit)
        .read_to_end(&mut bytes)
        .map_err(|error| Problem::Input(format!("standard input can't be read: {error}")))?;
    if bytes.len() as u64 == limit {
        return Err(Problem::Input(format!("standard input has more than {} MiB", MAX_BYTES >> 20)));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let end = error.utf8_error().valid_up_to();
        Problem::Input(format!("standard input is not UTF-8 text (byte {end} is where that ends)"))
    })?;
    Ok(("<stdin>".to_owned(), text))
}
