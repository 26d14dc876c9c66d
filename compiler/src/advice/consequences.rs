//! Errors that only follow from others: one slip is one error.
//!
//! An error that is left out becomes a place of the one that stays, so that nothing is hidden.

use super::names::{Kind, Names, Site, contains, whole};
use super::{MOST, Texts};
use crate::diagnostic::{Diagnostic, Place};
use rustc_hash::{FxHashMap, FxHashSet};
use std::hash::Hash;
use texgraph_grammar::syntax::{Node, Span};

/// Names that nobody declared.
const UNKNOWN: [&str; 3] = ["E0101", "E0102", "E0110"];

/// What is said of a call's arguments, or of the names that take its outputs.
const OF_CALLS: [&str; 9] = ["E0201", "E0203", "E0204", "E0205", "E0206", "E0207", "E0212", "E0215", "E0223"];

/// What is said of a value of a wrong type, or of one that lacks a field or a method.
const OF_TYPES: [&str; 11] =
    ["E0102", "E0105", "E0201", "E0203", "E0208", "E0209", "E0215", "E0219", "E0222", "E0224", "E0225"];

/// Places that are shown of one error, besides the first, because others follow from it.
const MORE: usize = 3;

/// The errors without those that follow from others.
pub(super) fn leave_out(texts: &Texts, diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let diagnostics = without_calls_of_broken_nodes(texts, diagnostics);
    let diagnostics = first_of_each(diagnostics, |diagnostic| unknown_name(texts, diagnostic));
    let heads = wrong_heads(texts, &diagnostics);
    let diagnostics = first_of_each(diagnostics, |diagnostic| {
        called(texts, diagnostic).filter(|head| heads.contains(head))
    });
    let wires = doubtful_wires(texts, &diagnostics);
    first_of_each(diagnostics, |diagnostic| wires_of(texts, diagnostic).find(|wire| wires.contains(wire)))
}

/// Keeps the first error of each group; the places of the others are shown with it.
fn first_of_each<K: Eq + Hash>(
    diagnostics: Vec<Diagnostic>,
    group: impl Fn(&Diagnostic) -> Option<K>,
) -> Vec<Diagnostic> {
    let mut kept: Vec<Diagnostic> = Vec::new();
    let mut seen: FxHashMap<K, usize> = FxHashMap::default();
    for diagnostic in diagnostics {
        let Some(key) = group(&diagnostic) else {
            kept.push(diagnostic);
            continue;
        };
        let first = *seen.entry(key).or_insert(kept.len());
        match kept.get_mut(first) {
            None => kept.push(diagnostic),
            Some(first) if first.related.len() < MORE => {
                first.related.push((diagnostic.place, "and here".to_owned()));
            }
            Some(_) => {}
        }
    }
    kept
}

/// A name that nobody declared is one error in a file, however many nodes read it; a dimension is
/// one in its node.
fn unknown_name(texts: &Texts, diagnostic: &Diagnostic) -> Option<(u32, Span, String)> {
    let place = diagnostic.place;
    match diagnostic.code {
        "E0220" => {
            let node = texts.names(diagnostic)?.node(place.span)?;
            Some((place.file, node.name.span, diagnostic.message.clone()))
        }
        code if UNKNOWN.contains(&code) => Some((place.file, Span::default(), texts.text(place).to_owned())),
        _ => None,
    }
}

/// Leaves out what is said of calls of a node that is wrong itself: its head may be what is wrong.
fn without_calls_of_broken_nodes(texts: &Texts, mut diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let errors: Vec<Place> = diagnostics.iter().map(|diagnostic| diagnostic.place).collect();
    let is_broken = |file: u32, node: Span| {
        // Errors stand in source order.
        let first = errors.partition_point(|error| (error.file, error.span.start) < (file, node.start));
        errors.get(first).is_some_and(|error| error.file == file && contains(node, error.span))
    };
    diagnostics.retain(|diagnostic| {
        let place = diagnostic.place;
        let node = callee(texts, diagnostic).map(whole);
        node.is_none_or(|node| contains(node, place.span) || !is_broken(place.file, node))
    });
    diagnostics
}

/// The node of the same file whose call an error is about.
fn callee<'t>(texts: &Texts<'t>, diagnostic: &Diagnostic) -> Option<&'t Node> {
    let names = texts.names(diagnostic)?;
    names.callee(site(names, diagnostic)?)
}

/// The call that an error is about: of an argument's value or name, of what takes its outputs
/// apart, or of the call itself.
pub(super) fn site<'t, 'a>(names: &'t Names<'a>, diagnostic: &Diagnostic) -> Option<&'t Site<'a>> {
    let place = diagnostic.place.span;
    let argument = || names.argument(place).map(|(site, _)| site);
    match diagnostic.code {
        "E0205" => names.call(place),
        "E0212" => names.call(names.taken_apart(place)?),
        code if OF_CALLS.contains(&code) => argument().or_else(|| names.call(place)),
        _ => None,
    }
}

/// The same by the place of its name.
fn called(texts: &Texts, diagnostic: &Diagnostic) -> Option<(u32, Span)> {
    callee(texts, diagnostic).map(|node| (diagnostic.place.file, node.name.span))
}

/// The nodes that are called several times, and never rightly.
fn wrong_heads(texts: &Texts, diagnostics: &[Diagnostic]) -> FxHashSet<(u32, Span)> {
    let mut wrong: FxHashMap<(u32, Span), FxHashSet<Span>> = FxHashMap::default();
    for diagnostic in diagnostics.iter().take(MOST) {
        let site = texts.names(diagnostic).and_then(|names| site(names, diagnostic));
        if let (Some(head), Some(site)) = (called(texts, diagnostic), site) {
            wrong.entry(head).or_default().insert(site.call.name.span);
        }
    }
    let is_never_right = |((file, head), calls): &(&(u32, Span), &FxHashSet<Span>)| {
        calls.len() > 1 && texts.files.get(file).is_some_and(|names| names.count_calls(*head) == calls.len())
    };
    wrong.iter().filter(is_never_right).map(|(head, _)| *head).collect()
}

/// The wires that values of a wrong type are made of, and of nothing else.
fn doubtful_wires(texts: &Texts, diagnostics: &[Diagnostic]) -> FxHashSet<(u32, usize)> {
    let wires = diagnostics.iter().take(MOST).filter_map(|diagnostic| {
        let mut wires = wires_of(texts, diagnostic);
        wires.next().filter(|_| wires.next().is_none())
    });
    wires.collect()
}

/// The wires that a value of a wrong type is made of.
fn wires_of<'t>(texts: &'t Texts, diagnostic: &Diagnostic) -> impl Iterator<Item = (u32, usize)> + use<'t> {
    let file = diagnostic.place.file;
    let names = texts.names(diagnostic).filter(|_| OF_TYPES.contains(&diagnostic.code));
    let read = names.map_or(Vec::new(), |names| names.read_within(value(names, diagnostic.place.span)));
    let has_type = move |wire: &usize| {
        let kind = names.and_then(|names| names.bindings.get(*wire)).map(|binding| binding.kind);
        kind.is_some_and(|kind| !matches!(kind, Kind::Alias | Kind::Node | Kind::Texture | Kind::Dimension))
    };
    read.into_iter().filter(has_type).map(move |wire| (file, wire))
}

/// The value that an error of types is about.
pub(super) fn value(names: &Names, place: Span) -> Span {
    names.taken_apart(place).or_else(|| names.base(place)).unwrap_or(place)
}
