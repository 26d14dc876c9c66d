//! What a second look at the text adds to errors.
//!
//! The checker says what is wrong where it finds it. The slip itself often lies elsewhere: a name is
//! unknown because its declaration was renamed, an argument does not fit because the input's type was
//! changed. So each error is looked at once more, together with the text around it: places that
//! explain it become related ones, names that are near or that nobody reads become suggestions, and
//! errors that only follow from others are left out.
//!
//! It works on the syntax trees and on nothing that the checker knows, and only says more about
//! errors that are there already.

mod brackets;
mod consequences;
mod mends;
mod names;

pub use brackets::forgotten as forgotten_brackets;

use crate::diagnostic::{Diagnostic, Place};
use crate::module::Modules;
use names::Names;
use std::collections::BTreeMap;

/// Only the first errors are looked at once more: it takes time, and nobody reads further.
const MOST: usize = 100;

/// Errors in source order, with what the text around them tells.
pub fn advise(modules: &Modules, diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let mut texts = Texts { modules, files: BTreeMap::new() };
    let first: Vec<u32> = diagnostics.iter().take(MOST).map(|diagnostic| diagnostic.place.file).collect();
    first.into_iter().for_each(|file| texts.read(file));
    let mut diagnostics = consequences::leave_out(&texts, diagnostics);
    for diagnostic in diagnostics.iter_mut().take(MOST) {
        mends::mend(&texts, diagnostic);
    }
    diagnostics
}

/// The files that have errors.
struct Texts<'a> {
    modules: &'a Modules,
    files: BTreeMap<u32, Names<'a>>,
}

impl<'a> Texts<'a> {
    fn read(&mut self, file: u32) {
        let module = self.modules.modules.iter().find(|module| module.file == file);
        if let Some(module) = module {
            self.files.entry(file).or_insert_with(|| Names::of(&module.tree));
        }
    }

    /// The names of the file of an error.
    fn names(&self, diagnostic: &Diagnostic) -> Option<&Names<'a>> {
        self.files.get(&diagnostic.place.file)
    }

    /// The text of a place.
    fn text(&self, place: Place) -> &'a str {
        let source = self.modules.sources.get(place);
        source.and_then(|source| source.text.get(place.span.range())).unwrap_or_default()
    }
}
