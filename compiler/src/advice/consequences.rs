//! Errors that only follow from others: one slip is one error.
//!
//! An error that is left out becomes a place of the one that stays, so that nothing is hidden.

use super::names::{Kind, Names, Site, contains, whole};
use super::{Look, MOST, Texts};
use crate::diagnostic::{Diagnostic, Place, constructors};
use crate::resource::{KINDS, LATER};
use rustc_hash::{FxHashMap, FxHashSet};
use std::hash::Hash;
use texgraph_grammar::syntax::{Node, Span};

/// Names that nobody declared.
const UNKNOWN: [&str; 3] = ["E0101", "E0102", "E0110"];

/// What is said of a call's arguments, or of the names that take its outputs.
const OF_CALLS: [&str; 13] = [
    "E0201", "E0203", "E0204", "E0205", "E0206", "E0207", "E0212", "E0215", "E0222", "E0223", "E0228",
    "E0229", "E0230",
];

/// What is said of a value of a wrong type, or of one that lacks a field or a method.
const OF_TYPES: [&str; 11] =
    ["E0102", "E0105", "E0201", "E0203", "E0208", "E0209", "E0215", "E0219", "E0222", "E0224", "E0225"];

/// Places that are shown of one error, besides the first, because others follow from it.
const MORE: usize = 3;

/// Arguments of a call that must all be wrong for the call to be.
const SEVERAL: usize = 3;

/// The endings of files that programs read.
const ENDINGS: [&str; 10] =
    [".bmp", ".dds", ".exr", ".hdr", ".jpeg", ".jpg", ".ktx2", ".png", ".ron", ".tga"];

/// The errors without those that follow from others.
pub(super) fn leave_out(texts: &Texts, diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let diagnostics = quote_paths(texts, diagnostics);
    let diagnostics = without_calls_of_broken_nodes(texts, diagnostics);
    let records = misused_records(texts, &diagnostics);
    let diagnostics = first_of_each(diagnostics, "and this is one of its outputs", |diagnostic| {
        misused_record(&texts.look(diagnostic)?, &records)
    });
    let diagnostics =
        first_of_each(diagnostics, "and here", |diagnostic| unknown_name(&texts.look(diagnostic)?));
    let calls = mistaken_calls(texts, &diagnostics);
    let diagnostics = first_of_each(diagnostics, "nor does this", |diagnostic| {
        argument(&texts.look(diagnostic)?).map(|(call, _)| call).filter(|call| calls.contains(call))
    });
    let heads = wrong_heads(texts, &diagnostics);
    let diagnostics = first_of_each(diagnostics, "and here", |diagnostic| {
        called(&texts.look(diagnostic)?).filter(|head| heads.contains(head))
    });
    let wires = doubtful_wires(texts, &diagnostics);
    first_of_each(diagnostics, "and here", |diagnostic| {
        wires_of(&texts.look(diagnostic)?).into_iter().find(|wire| wires.contains(wire))
    })
}

/// Keeps the first error of each group; the places of the others are shown with it. Only the first
/// errors are looked at.
fn first_of_each<K: Eq + Hash>(
    diagnostics: Vec<Diagnostic>,
    label: &str,
    group: impl Fn(&Diagnostic) -> Option<K>,
) -> Vec<Diagnostic> {
    let mut kept: Vec<Diagnostic> = Vec::new();
    let mut seen: FxHashMap<K, usize> = FxHashMap::default();
    for (i, diagnostic) in diagnostics.into_iter().enumerate() {
        let Some(key) = (i < MOST).then(|| group(&diagnostic)).flatten() else {
            kept.push(diagnostic);
            continue;
        };
        let first = *seen.entry(key).or_insert(kept.len());
        match kept.get_mut(first) {
            None => kept.push(diagnostic),
            Some(first) if first.related.len() < MORE => {
                first.related.push((diagnostic.place, label.to_owned()));
            }
            Some(_) => {}
        }
    }
    kept
}

/// A path without quotes reads as divisions and fields of names: all that is said of them is one
/// error.
fn quote_paths(texts: &Texts, diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let is_constructor = |name: &str| KINDS.iter().any(|kind| kind.name == name) || LATER.contains(&name);
    let mut quoted: FxHashSet<Place> = FxHashSet::default();
    let mut kept = Vec::new();
    for (i, diagnostic) in diagnostics.into_iter().enumerate() {
        let look = texts.look(&diagnostic).filter(|_| i < MOST);
        let path = look.and_then(|look| {
            let span = look.names.argument_around(look.span(), is_constructor)?;
            let is_path = |text: &&str| {
                let is_plain = text.chars().all(|c| c.is_ascii_alphanumeric() || "/._-".contains(c));
                is_plain && ENDINGS.iter().any(|ending| text.ends_with(ending))
            };
            Some((Place { span, ..look.place }, Some(look.text(span)).filter(is_path)?))
        });
        match path {
            Some((place, path)) if quoted.insert(place) => {
                kept.push(constructors::unquoted_path(place, path))
            }
            Some(_) => {}
            None => kept.push(diagnostic),
        }
    }
    kept
}

/// The wires of several outputs that are read as if they had one.
fn misused_records(texts: &Texts, diagnostics: &[Diagnostic]) -> FxHashSet<Span> {
    let misused = diagnostics.iter().take(MOST).filter(|diagnostic| diagnostic.code == "E0213");
    let records = misused.filter_map(|diagnostic| {
        let look = texts.look(diagnostic)?;
        look.names.meaning(look.span()).map(|record| record.name.span)
    });
    records.collect()
}

/// The misused wire that an error is about: it is the wire, or the name of one of its outputs.
fn misused_record(look: &Look, records: &FxHashSet<Span>) -> Option<(u32, Span)> {
    let record = match look.code {
        "E0213" => look.names.meaning(look.span())?.name.span,
        "E0101" | "E0110" if !records.is_empty() => {
            let mut of_name = look.records_with(look.text(look.span()));
            of_name.find(|(record, _)| records.contains(&record.name.span))?.0.name.span
        }
        _ => return None,
    };
    Some((look.place.file, record))
}

/// A name that nobody declared is one error in a file, however many nodes read it; a dimension is
/// one in its node.
fn unknown_name<'a>(look: &Look<'_, 'a>) -> Option<(u32, Span, &'a str)> {
    let file = look.place.file;
    match look.code {
        "E0220" => {
            let dimension = look.text(look.span()).split(['<', '>']).nth(1)?;
            Some((file, look.names.node(look.span())?.name.span, dimension))
        }
        code if UNKNOWN.contains(&code) => Some((file, Span::default(), look.text(look.span()))),
        _ => None,
    }
}

/// Leaves out what is said of calls of a node that is wrong itself: its head may be what is wrong. The
/// same goes for types in the lambdas that such a node is given: it says what they take.
fn without_calls_of_broken_nodes(texts: &Texts, diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let errors: Vec<Place> = diagnostics.iter().map(|diagnostic| diagnostic.place).collect();
    let is_broken = |file: u32, node: Span| {
        // Errors stand in source order.
        let first = errors.partition_point(|error| (error.file, error.span.start) < (file, node.start));
        errors.get(first).is_some_and(|error| error.file == file && contains(node, error.span))
    };
    let follows = |i: usize, look: &Look| {
        let is_of_types = OF_TYPES.contains(&look.code) || OF_CALLS.contains(&look.code);
        let lambdas =
            (is_of_types && i < MOST).then(|| look.names.lambdas_around(look.span())).into_iter().flatten();
        let nodes = lambdas.filter_map(|site| look.names.callee(site)).chain(callee(look)).map(whole);
        let mut nodes = nodes.filter(|node| !contains(*node, look.span()));
        nodes.any(|node| is_broken(look.place.file, node))
    };
    let is_kept =
        |(i, diagnostic): &(usize, Diagnostic)| texts.look(diagnostic).is_none_or(|look| !follows(*i, &look));
    diagnostics.into_iter().enumerate().filter(is_kept).map(|(_, diagnostic)| diagnostic).collect()
}

/// The node of the same file whose call an error is about.
fn callee<'a>(look: &Look<'_, 'a>) -> Option<&'a Node> {
    look.names.callee(site(look)?)
}

/// The call that an error is about: of an argument's value or name, of what takes its outputs
/// apart, or of the call itself.
pub(super) fn site<'t, 'a>(look: &Look<'t, 'a>) -> Option<&'t Site<'a>> {
    let argument = || look.names.argument(look.span()).map(|(site, _)| site);
    match look.code {
        "E0205" => look.names.call(look.span()).or_else(argument),
        "E0212" => look.names.call(look.names.taken_apart(look.span())?),
        code if OF_CALLS.contains(&code) => argument().or_else(|| look.names.call(look.span())),
        _ => None,
    }
}

/// The same by the place of its name.
fn called(look: &Look) -> Option<(u32, Span)> {
    callee(look).map(|node| (look.place.file, node.name.span))
}

/// The calls of several arguments, none of which fits: another node is meant.
fn mistaken_calls(texts: &Texts, diagnostics: &[Diagnostic]) -> FxHashSet<(u32, Span)> {
    let mut wrong: FxHashMap<(u32, Span), FxHashSet<usize>> = FxHashMap::default();
    let mut mistaken = FxHashSet::default();
    for look in diagnostics.iter().take(MOST).filter_map(|diagnostic| texts.look(diagnostic)) {
        let Some((call, position)) = argument(&look) else { continue };
        let wrong = wrong.entry(call).or_default();
        wrong.insert(position);
        let count = look.names.argument(look.span()).map_or(0, |(site, _)| site.call.arguments.len());
        if wrong.len() >= count.max(SEVERAL) {
            mistaken.insert(call);
        }
    }
    mistaken
}

/// The call by the place of its name, and which of its arguments an error is about.
fn argument(look: &Look) -> Option<((u32, Span), usize)> {
    if look.code != "E0214" && !OF_CALLS.contains(&look.code) {
        return None;
    }
    let (site, position) = look.names.argument(look.span())?;
    Some(((look.place.file, site.call.name.span), position))
}

/// The nodes that are called several times, and never rightly.
fn wrong_heads(texts: &Texts, diagnostics: &[Diagnostic]) -> FxHashSet<(u32, Span)> {
    let mut wrong: FxHashMap<(u32, Span), FxHashSet<Span>> = FxHashMap::default();
    for look in diagnostics.iter().take(MOST).filter_map(|diagnostic| texts.look(diagnostic)) {
        if let (Some(head), Some(site)) = (called(&look), site(&look)) {
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
    let looks = diagnostics.iter().take(MOST).filter_map(|diagnostic| texts.look(diagnostic));
    let wires = looks.filter_map(|look| match wires_of(&look).as_slice() {
        [only] => Some(*only),
        _ => None,
    });
    wires.collect()
}

/// The wires that a value of a wrong type is made of.
fn wires_of(look: &Look) -> Vec<(u32, usize)> {
    if !OF_TYPES.contains(&look.code) {
        return Vec::new();
    }
    let has_type = |wire: &usize| {
        let kind = look.names.bindings.get(*wire).map(|binding| binding.kind);
        kind.is_some_and(|kind| !matches!(kind, Kind::Alias | Kind::Node | Kind::Texture | Kind::Dimension))
    };
    let read = look.names.read_within(value(look.names, look.span()));
    read.into_iter().filter(has_type).map(|wire| (look.place.file, wire)).collect()
}

/// The value that an error of types is about.
pub(super) fn value(names: &Names, place: Span) -> Span {
    names.taken_apart(place).or_else(|| names.base(place)).unwrap_or(place)
}
