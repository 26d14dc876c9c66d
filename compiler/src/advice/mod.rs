//! What a second look at the text adds to errors.
//!
//! The checker says what is wrong where it finds it. The slip itself often lies elsewhere: a name is
//! unknown because its declaration was renamed, an argument does not fit because the input's type was
//! changed. So each error is looked at once more, together with the text around it: places that
//! explain it become related ones, names that are near become suggestions, and errors that only
//! follow from others become places of those.
//!
//! It works on the syntax trees and on nothing that the checker knows, and only says more about
//! errors that are there already.

mod brackets;
mod consequences;
mod names;
mod outputs;
mod unknown;
mod values;

pub use brackets::forgotten as forgotten_brackets;

use crate::diagnostic::{Diagnostic, Place, Suggestion};
use crate::module::Modules;
use names::Names;
use std::collections::BTreeMap;
use texgraph_grammar::syntax::{ItemKind, Node, Span};

/// Only the first errors are looked at once more: it takes time, and nobody reads further.
const MOST: usize = 100;

/// Other places that are shown of one error at most.
const PLACES: usize = 4;

/// Places with what they are.
type Related = Vec<(Span, String)>;

/// Errors in source order, with what the text around them tells.
pub fn advise(modules: &Modules, diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let mut texts = Texts { modules, files: BTreeMap::new() };
    let first: Vec<u32> = diagnostics.iter().take(MOST).map(|diagnostic| diagnostic.place.file).collect();
    first.into_iter().for_each(|file| texts.read(file));
    let mut diagnostics = consequences::leave_out(&texts, diagnostics);
    for diagnostic in diagnostics.iter_mut().take(MOST) {
        if let Some((first, second)) = diagnostic.exchange {
            let edits = vec![(first, texts.text(second).to_owned()), (second, texts.text(first).to_owned())];
            diagnostic.suggestion = Some(Suggestion { edits, is_sure: false });
        }
        if let Some(look) = texts.look(diagnostic) {
            let related = look.mend(diagnostic);
            show(diagnostic, related);
        }
    }
    diagnostics
}

/// Adds places to an error: those that are apart from the ones it has.
fn show(diagnostic: &mut Diagnostic, related: Related) {
    for (span, label) in related {
        let place = Place { span, ..diagnostic.place };
        let is_apart = |known: Place| known.file != place.file || !overlap(known.span, span);
        let is_new =
            is_apart(diagnostic.place) && diagnostic.related.iter().all(|(known, _)| is_apart(*known));
        if is_new && diagnostic.related.len() < PLACES {
            diagnostic.related.push((place, label));
        }
    }
}

fn overlap(a: Span, b: Span) -> bool {
    a.start < b.end && b.start < a.end
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

    /// An error together with the text around it; none where that was not read.
    fn look(&self, diagnostic: &Diagnostic) -> Option<Look<'_, 'a>> {
        let names = self.files.get(&diagnostic.place.file)?;
        Some(Look { texts: self, names, place: diagnostic.place, code: diagnostic.code })
    }

    /// The text of a place.
    fn text(&self, place: Place) -> &'a str {
        let source = self.modules.sources.get(place);
        source.and_then(|source| source.text.get(place.span.range())).unwrap_or_default()
    }

    /// A node of any file, the library's included.
    fn node(&self, name: &str) -> Option<&'a Node> {
        let items = self.modules.modules.iter().rev().flat_map(|module| &module.tree.items);
        let mut nodes = items.filter_map(|item| match &item.kind {
            ItemKind::Node(node) | ItemKind::Texture { node, .. } => Some(node),
            _ => None,
        });
        nodes.find(|node| node.name.text == name)
    }
}

/// The place of an error with the text around it.
struct Look<'t, 'a> {
    texts: &'t Texts<'a>,
    names: &'t Names<'a>,
    place: Place,
    code: &'static str,
}

impl<'t, 'a> Look<'t, 'a> {
    /// What is underlined.
    fn span(&self) -> Span {
        self.place.span
    }

    /// The text of a place in the same file.
    fn text(&self, span: Span) -> &'a str {
        self.texts.text(Place { span, ..self.place })
    }

    /// Adds to an error what the text around it tells; the places are returned.
    fn mend(&self, diagnostic: &mut Diagnostic) -> Related {
        match self.code {
            "E0101" => self.unknown_value(diagnostic),
            "E0102" => self.unknown_node(diagnostic),
            "E0106" => self.no_output(diagnostic),
            "E0107" => self.no_value(diagnostic),
            "E0110" if self.is_library_name() => self.unknown_value(diagnostic),
            "E0104" => self.ring(),
            "E0109" => self.own_call(),
            "E0105" | "E0201" | "E0203" | "E0208" | "E0209" | "E0212" | "E0213" | "E0219" | "E0222"
            | "E0223" | "E0224" | "E0225" => self.types(diagnostic),
            "E0204" | "E0205" | "E0206" | "E0207" | "E0215" | "E0228" | "E0229" => self.in_call(),
            "E0220" => self.no_dimension(),
            _ => Vec::new(),
        }
    }
}
