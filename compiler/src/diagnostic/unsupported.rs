//! What the language has and this compiler does not do yet: said plainly, at its place.

use super::{Diagnostic, Place};

/// A part of the language that is not built yet.
pub fn not_yet(place: Place, what: &str) -> Diagnostic {
    Diagnostic::new(
        "E0901",
        place,
        format!("{what}: not supported yet"),
        "this version of texgraph can't compile it",
    )
}
