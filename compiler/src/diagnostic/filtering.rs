//! What is likely not filtered as it was meant.

use super::{Diagnostic, Place};

/// A derivative of what is looked up or hashed, and of nothing else.
pub fn footprint_of_nothing(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new(
        "W0801",
        place,
        format!("the change that `{name}` measures is 0 everywhere"),
        "this is looked up or hashed, so it jumps and does not change from pixel to pixel",
    )
    .help("take it of the place that it is looked up for, or give the width yourself")
}
