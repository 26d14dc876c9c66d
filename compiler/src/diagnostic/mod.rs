//! What is wrong, where, why, and what would mend it.
//!
//! A [`Diagnostic`] is plain data. The sentences live beside each other in one file per stage
//! (`syntax`, `names`, `types`, …), each a function that makes the diagnostic; the layout lives in
//! [`render`], and the long explanations in `pages/`, listed by [`codes`].

pub mod arguments;
pub mod codes;
pub mod constructors;
pub mod folds;
pub mod imports;
pub mod limits;
pub mod names;
pub mod nodes;
pub mod rates;
pub mod render;
pub mod resources;
pub mod syntax;
pub mod types;
pub mod unsupported;

pub use crate::graph::Place;

/// One error, ready to be shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Its code, `E0103`; `texgraph explain` knows it.
    pub code: &'static str,
    /// One line of what is wrong, in the user's words.
    pub message: String,
    /// What is underlined.
    pub place: Place,
    /// The reason, beside the underline; may be empty.
    pub label: String,
    /// Other places that matter, with what they are.
    pub related: Vec<(Place, String)>,
    /// A likely mend.
    pub help: Option<String>,
}

impl Diagnostic {
    /// With a label, and nothing else yet.
    pub fn new(
        code: &'static str,
        place: Place,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic {
            code,
            message: message.into(),
            place,
            label: label.into(),
            related: Vec::new(),
            help: None,
        }
    }

    /// With another reason than its sentence has.
    #[must_use]
    pub fn because(mut self, message: impl Into<String>) -> Diagnostic {
        self.message = message.into();
        self
    }

    /// With a likely mend.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Diagnostic {
        self.help = Some(help.into());
        self
    }

    /// With a likely mend, if there is one.
    #[must_use]
    pub fn maybe_help(mut self, help: Option<String>) -> Diagnostic {
        self.help = help.or(self.help);
        self
    }

    /// With another place that matters.
    #[must_use]
    pub fn related(mut self, place: Place, label: impl Into<String>) -> Diagnostic {
        self.related.push((place, label.into()));
        self
    }
}
