//! Errors that only follow from others: one slip is one error.

use super::Texts;
use super::names::Names;
use crate::diagnostic::{Diagnostic, Place};
use rustc_hash::FxHashMap;
use texgraph_grammar::syntax::{Node, Span};

/// What is said of a call's arguments, or of the names that take its outputs.
const OF_CALLS: [&str; 9] = ["E0201", "E0203", "E0204", "E0205", "E0206", "E0207", "E0212", "E0215", "E0223"];

/// A name that is unknown in several nodes is one error.
const UNKNOWN: [&str; 2] = ["E0101", "E0102"];

/// Places that are shown of a name that is unknown in several nodes, besides the first.
const MORE: usize = 3;

/// The errors without those that follow from others.
pub(super) fn leave_out(texts: &Texts, diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let broken: Vec<Place> = diagnostics.iter().map(|diagnostic| diagnostic.place).collect();
    let rest = diagnostics.into_iter().filter(|diagnostic| !calls_broken_node(texts, &broken, diagnostic));
    unknown_once(texts, rest)
}

/// Whether an error is about a call of a node that is wrong itself: its head may be what is wrong.
fn calls_broken_node(texts: &Texts, errors: &[Place], diagnostic: &Diagnostic) -> bool {
    if !OF_CALLS.contains(&diagnostic.code) {
        return false;
    }
    let place = diagnostic.place;
    let callee = texts.names(diagnostic).and_then(|names| callee(names, place.span));
    callee.is_some_and(|node| {
        let whole = node.name.span.to(node.body.span);
        let inside = |span: Span| whole.start <= span.start && span.end <= whole.end;
        // Errors stand in source order.
        let first =
            errors.partition_point(|error| (error.file, error.span.start) < (place.file, whole.start));
        let wrong = errors.get(first).is_some_and(|error| error.file == place.file && inside(error.span));
        wrong && !inside(place.span)
    })
}

/// The node of this file whose call a place belongs to.
fn callee<'a>(names: &Names<'a>, place: Span) -> Option<&'a Node> {
    let value = names.taken_apart(place).unwrap_or(place);
    let site = names.argument(place).map(|(site, _)| site).or_else(|| names.call(value));
    site.and_then(|site| names.callee(site))
}

/// A name that nobody declared, in several nodes of a file: the first error shows the other places.
fn unknown_once(texts: &Texts, diagnostics: impl Iterator<Item = Diagnostic>) -> Vec<Diagnostic> {
    let mut kept: Vec<Diagnostic> = Vec::new();
    let mut seen: FxHashMap<(&str, u32, &str), usize> = FxHashMap::default();
    for diagnostic in diagnostics {
        let key = (diagnostic.code, diagnostic.place.file, texts.text(diagnostic.place));
        let first = seen.get(&key).copied().filter(|_| UNKNOWN.contains(&diagnostic.code));
        let Some(first) = first.and_then(|first| kept.get_mut(first)) else {
            seen.insert(key, kept.len());
            kept.push(diagnostic);
            continue;
        };
        if first.related.len() < MORE {
            first.related.push((diagnostic.place, "and here".to_owned()));
        }
    }
    kept
}
