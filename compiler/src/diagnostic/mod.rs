//! What is wrong, where, why, and what would mend it.
//!
//! A [`Diagnostic`] is plain data. The sentences live beside each other in one file per stage
//! (`syntax`, `names`, `types`, …), each a function that makes the diagnostic; the layout lives in
//! [`render`] (pages for people) and [`json`] (objects for editors), and the long explanations in
//! `pages/`, listed by [`codes`].

pub mod arguments;
mod clip;
pub mod codes;
pub mod constructors;
mod excerpt;
pub mod filtering;
pub mod folds;
pub mod imports;
pub mod json;
pub mod limits;
pub mod names;
pub mod nodes;
pub mod rates;
pub mod render;
pub mod resources;
pub mod syntax;
pub mod tiling;
pub mod types;
pub mod unsupported;

pub use crate::graph::Place;
use texgraph_grammar::syntax::Span;

/// One error or warning, ready to be shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Its code, `E0103` of an error, `W0801` of a warning; `texgraph explain` knows it.
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
    /// The same as edits that an editor can make.
    pub suggestion: Option<Suggestion>,
    /// Two places that belong exchanged: whoever has the text makes the edits of it.
    pub exchange: Option<(Place, Place)>,
}

/// Edits that make up one likely mend.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Suggestion {
    /// Places with what stands there instead; an empty place is an insertion. In source order, apart
    /// from each other.
    pub edits: Vec<(Place, String)>,
    /// Whether the mend is surely what was meant, so that a tool may make it unasked.
    pub is_sure: bool,
}

impl Suggestion {
    /// One place with what stands there instead.
    pub fn replace(place: Place, text: impl Into<String>) -> Suggestion {
        Suggestion { edits: vec![(place, text.into())], is_sure: false }
    }

    /// Something before a place and something behind it.
    pub fn around(place: Place, before: impl Into<String>, behind: impl Into<String>) -> Suggestion {
        let at = |offset| Place { span: Span { start: offset, end: offset }, ..place };
        let edits = vec![(at(place.span.start), before.into()), (at(place.span.end), behind.into())];
        Suggestion { edits, is_sure: false }
    }

    /// The same, surely meant.
    #[must_use]
    pub fn sure(mut self) -> Suggestion {
        self.is_sure = true;
        self
    }
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
            suggestion: None,
            exchange: None,
        }
    }

    /// Whether the program is right, and only likely not to do what was meant.
    pub fn is_warning(&self) -> bool {
        self.code.starts_with('W')
    }

    /// `error` or `warning`.
    pub fn level(&self) -> &'static str {
        if self.is_warning() { "warning" } else { "error" }
    }

    /// With another reason than its sentence has.
    #[must_use]
    pub fn because(mut self, message: impl Into<String>) -> Diagnostic {
        self.message = message.into();
        self
    }

    /// The same for who called a node of the library: what is said of its text is said of the call.
    #[must_use]
    pub fn called_from(mut self, call: Place, node: &str) -> Diagnostic {
        self.related.insert(0, (self.place, std::mem::take(&mut self.label)));
        self.place = call;
        self.message = format!("`{node}` can't be called like this: {}", self.message);
        self.label = "called here".to_owned();
        (self.help, self.suggestion) = (None, None);
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

    /// With a name that was probably meant here, if there is one.
    #[must_use]
    pub fn did_you_mean(mut self, near: Option<String>) -> Diagnostic {
        near.iter().for_each(|near| self.suggest_name(near));
        self
    }

    /// Suggests a name that was probably meant here.
    pub fn suggest_name(&mut self, near: &str) {
        self.help = Some(format!("did you mean `{near}`?"));
        self.suggestion = Some(Suggestion::replace(self.place, near));
    }

    /// Says that two arguments, for inputs of these names, belong exchanged.
    pub fn exchange(&mut self, places: (Place, Place), [first, second]: [&str; 2]) {
        self.help =
            Some(format!("the types fit if the arguments for `{first}` and `{second}` are exchanged"));
        (self.suggestion, self.exchange) = (None, Some(places));
    }

    /// With the edits of a likely mend, if there are any.
    #[must_use]
    pub fn suggest(mut self, suggestion: Option<Suggestion>) -> Diagnostic {
        self.suggestion = suggestion.or(self.suggestion);
        self
    }

    /// With another place that matters.
    #[must_use]
    pub fn related(mut self, place: Place, label: impl Into<String>) -> Diagnostic {
        self.related.push((place, label.into()));
        self
    }
}
