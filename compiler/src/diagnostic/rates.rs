//! Sentences about when things are known.

use super::{Diagnostic, Place};

/// A `let` of a file that is not known before anything is drawn.
pub fn let_not_constant(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new(
        "E0301",
        place,
        format!("`{name}` is not a constant"),
        "a `let` of the file is known before anything is drawn",
    )
    .help("it can't read a param: compute it inside the texture")
}

/// A param's default or range that is not a constant.
pub fn param_not_constant(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new(
        "E0303",
        place,
        format!("the default and range of `{name}` must be constants"),
        "this is not known before anything is drawn",
    )
}

/// A default outside its own range, or a range that is empty.
pub fn default_outside_range(place: Place, name: &str, range: Place) -> Diagnostic {
    Diagnostic::new("E0304", place, format!("the default of `{name}` lies outside its range"), "the default")
        .related(range, "the range")
        .help("change the one or the other")
}

/// A range that holds nothing.
pub fn empty_range(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new(
        "E0305",
        place,
        format!("the range of `{name}` is empty"),
        "the end lies before the start",
    )
    .help("write the smaller number first: `in 0.0..=1.0`")
}

/// A choice between things that are not values, by a condition that is not known.
pub fn choice_not_constant(place: Place) -> Diagnostic {
    Diagnostic::new(
        "E0306",
        place,
        "resources can only be chosen by a condition that is known when loading",
        "this changes while the program runs",
    )
    .help("choose between their samples instead")
}
