//! Sentences about `use`.

use super::{Diagnostic, Place};

/// A file that can't be had.
pub fn cannot_load(place: Place, path: &str, why: &str) -> Diagnostic {
    Diagnostic::new("E0601", place, format!("can't read `{path}`: {why}"), "imported here")
        .help("a path is relative to the folder of the file that holds it")
}

/// Files that import each other.
pub fn cycle(place: Place, paths: &[&str]) -> Diagnostic {
    let mut ring: Vec<String> = paths.iter().map(|path| format!("`{path}`")).collect();
    ring.extend(ring.first().cloned());
    let (message, help) = match paths {
        [one] => (format!("`{one}` imports itself"), "a file sees its own items without an import"),
        _ => {
            let message = format!("files import each other: {}", ring.join(" → "));
            (message, "move what they share into a file of its own that both import")
        }
    };
    Diagnostic::new("E0602", place, message, "this closes the ring").help(help)
}

/// One name from two files.
pub fn clash(place: Place, name: &str, first: Place) -> Diagnostic {
    Diagnostic::new(
        "E0603",
        place,
        format!("`{name}` comes from two files"),
        "the second file that declares it",
    )
    .related(first, "the first declaration")
    .help("import one of them under a name: `use \"…\" as other`")
}

/// An alias that is taken.
pub fn alias_twice(place: Place, name: &str, first: Place) -> Diagnostic {
    Diagnostic::new("E0604", place, format!("two files are imported as `{name}`"), "the second")
        .related(first, "the first")
        .help("give each its own name")
}

/// An item that an imported file does not declare.
pub fn no_such_item(place: Place, alias: &str, name: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new(
        "E0605",
        place,
        format!("`{alias}` declares no `{name}`"),
        format!("not an item of `{alias}`"),
    )
    .did_you_mean(near)
}
