//! Sentences about folds and constant tables.

use super::limits::{MAX_STEPS, MAX_TABLE};
use super::{Diagnostic, Place};

/// A fold, or folds inside each other, with more steps than the bound.
pub fn too_many_steps(place: Place, node: &str, steps: u64) -> Diagnostic {
    Diagnostic::new(
        "E0404",
        place,
        format!("the folds of `{node}` may take {steps} steps"),
        format!("at most {MAX_STEPS} steps, folds inside it counted"),
    )
    .help("bound the range (`0..min(k, 16)`), or write `max 64` behind it to cut it off")
}

/// A range whose length nothing bounds.
pub fn range_unbounded(place: Place) -> Diagnostic {
    Diagnostic::new(
        "E0405",
        place,
        "the length of this range is not bounded",
        "how many steps it can have must be known when compiling",
    )
    .help("bound an end, as in `0..min(k, 16)`, or write `max 64` behind the range to cut it off")
}

/// A `max` that is no constant, or negative.
pub fn max_not_constant(place: Place) -> Diagnostic {
    Diagnostic::new(
        "E0309",
        place,
        "the `max` of a fold must be a constant, 0 or more",
        "not known when compiling",
    )
    .help("write a number: `for i in 0..k max 64`")
}

/// A table with an entry that is no constant.
pub fn entry_not_constant(place: Place) -> Diagnostic {
    Diagnostic::new(
        "E0308",
        place,
        "the entries of a table must be constants",
        "this is not known when compiling",
    )
    .help("choose among values with `if`, or put the numbers into the table and compute after the lookup")
}

/// A list that is indexed and holds nothing.
pub fn empty_table(place: Place) -> Diagnostic {
    Diagnostic::new("E0232", place, "an empty list has no entry", "at least one entry is needed")
}

/// A list that stands where a number is wanted.
pub fn table_too_long(place: Place, length: usize) -> Diagnostic {
    Diagnostic::new(
        "E0406",
        place,
        format!("a table has at most {MAX_TABLE} entries, not {length}"),
        "too long for a shader's constant",
    )
    .help("put whole numbers into a map: `indices([[…]])`")
}
