//! `texgraph explain`: the long page of the code of an error or a warning, or the list of all codes.

use crate::args::Explain;
use crate::output;
use crate::problem::Problem;
use texgraph_compiler::diagnostic::codes;

/// How many codes are offered in place of one that does not exist.
const OFFERED: usize = 3;

/// Prints a page, or the list.
///
/// # Errors
/// There is no such code.
pub fn run(args: &Explain) -> Result<(), Problem> {
    let Some(asked) = &args.code else { return output::print(&list()) };
    let code = code(asked);
    let page = code.and_then(|(letter, number)| codes::explain(&format!("{letter}{number:04}")));
    match page {
        Some(page) => output::print(&format!("{}\n", page.trim_end())),
        None => Err(unknown(asked, code)),
    }
}

/// Every code with the title of its page.
fn list() -> String {
    let title =
        |page: &str| page.lines().next().unwrap_or_default().trim_start_matches(['#', ' ']).to_owned();
    codes::PAGES.iter().map(|(code, page)| format!("{code}  {}\n", title(page))).collect()
}

/// The letter and the number of a code as people write it: `E0103`, `e103`, `103`, `w801`.
fn code(written: &str) -> Option<(char, u32)> {
    let written = written.trim();
    let letter = if written.starts_with(['W', 'w']) { 'W' } else { 'E' };
    Some((letter, written.strip_prefix(['E', 'e', 'W', 'w']).unwrap_or(written).parse().ok()?))
}

fn unknown(asked: &str, code_asked: Option<(char, u32)>) -> Problem {
    let Some((letter, asked_number)) = code_asked else {
        let hint = "a code looks like E0501; `texgraph explain` lists all";
        return Problem::Usage(format!("`{asked}` is no error code: {hint}"));
    };
    let mut near: Vec<&str> = codes::PAGES.iter().map(|(code, _)| *code).collect();
    near.sort_by_key(|known| code(known).map(|(of, number)| (of != letter, number.abs_diff(asked_number))));
    near.truncate(OFFERED);
    near.sort_unstable();
    let near = near.join(", ");
    Problem::Usage(format!("there is no error code {letter}{asked_number:04}; near it are {near}"))
}
