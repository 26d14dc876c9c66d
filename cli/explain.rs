//! `texgraph explain`: the long page of an error code, or the list of all codes.

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
    let number = number(asked);
    let page = number.and_then(|number| codes::explain(&format!("E{number:04}")));
    match page {
        Some(page) => output::print(&format!("{}\n", page.trim_end())),
        None => Err(unknown(asked, number)),
    }
}

/// Every code with the title of its page.
fn list() -> String {
    let title =
        |page: &str| page.lines().next().unwrap_or_default().trim_start_matches(['#', ' ']).to_owned();
    codes::PAGES.iter().map(|(code, page)| format!("{code}  {}\n", title(page))).collect()
}

/// The number of a code as people write it: `E0103`, `e103`, `103`.
fn number(code: &str) -> Option<u32> {
    let code = code.trim();
    code.strip_prefix(['E', 'e']).unwrap_or(code).parse().ok()
}

fn unknown(asked: &str, asked_number: Option<u32>) -> Problem {
    let Some(asked_number) = asked_number else {
        let hint = "a code looks like E0501; `texgraph explain` lists all";
        return Problem::Usage(format!("`{asked}` is no error code: {hint}"));
    };
    let mut near: Vec<&str> = codes::PAGES.iter().map(|(code, _)| *code).collect();
    near.sort_by_key(|code| number(code).map(|number| number.abs_diff(asked_number)));
    near.truncate(OFFERED);
    near.sort_unstable();
    let near = near.join(", ");
    Problem::Usage(format!("there is no error code E{asked_number:04}; near it are {near}"))
}
