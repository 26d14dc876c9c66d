//! The grammar's errors as diagnostics: the sentences are the grammar's own, with the mends that
//! need more than one token to guess.

use super::{Diagnostic, Place, Suggestion, names};
use texgraph_grammar::{SyntaxError, SyntaxErrorKind};

/// What begins an item.
const ITEMS: [&str; 5] = ["use", "let", "param", "node", "texture"];

/// A syntax error of a file.
pub fn error(file: u32, error: &SyntaxError) -> Diagnostic {
    let place = Place { file, span: error.span };
    let diagnostic = Diagnostic::new(error.code(), place, error.message(), error.label())
        .maybe_help(error.help())
        .suggest(edit(place, &error.kind));
    let diagnostic = match &error.kind {
        SyntaxErrorKind::Unexpected { found, expected, help: None } => mend(diagnostic, found, expected),
        _ => diagnostic,
    };
    match error.related {
        Some((span, label)) => diagnostic.related(Place { file, span }, label),
        None => diagnostic,
    }
}

/// The edit that mends an error, where there is only one.
fn edit(place: Place, kind: &SyntaxErrorKind) -> Option<Suggestion> {
    let replace = |text: String| Some(Suggestion::replace(place, text));
    match kind {
        SyntaxErrorKind::Semicolon { in_brackets: true } => replace(",".to_owned()).map(Suggestion::sure),
        SyntaxErrorKind::Semicolon { .. } => replace(String::new()).map(Suggestion::sure),
        SyntaxErrorKind::SpaceBeforeBracket { name, bracket } => {
            replace(format!("{name}{bracket}")).map(Suggestion::sure)
        }
        SyntaxErrorKind::BadNumber { mend: Some(mend), .. } => replace(mend.clone()),
        SyntaxErrorKind::KeywordAsName { keyword } => replace(format!("{keyword}_")),
        SyntaxErrorKind::Unexpected { found, .. } => match found.trim_matches('`') {
            "and" => replace("&&".to_owned()),
            "or" => replace("||".to_owned()),
            "not" => replace("!".to_owned()),
            _ => None,
        },
        _ => None,
    }
}

/// With a likely mend of a token that can't stand where it does.
fn mend(diagnostic: Diagnostic, found: &str, expected: &[&str]) -> Diagnostic {
    let wants = |what: &str| expected.contains(&what);
    let found = found.trim_matches('`');
    let place = diagnostic.place;
    let replace = |text: &str| Some(Suggestion::replace(place, text));
    match found {
        _ if wants("`else`") => diagnostic.did_you_mean(names::nearest(found, ["else"])),
        _ if wants("an item") => diagnostic.did_you_mean(names::nearest(found, ITEMS)),
        "," if wants("`=`") => diagnostic.help("several names stand in brackets: `let (a, b) = …`"),
        "(" if wants("an assignment") => {
            diagnostic.help("names for several outputs begin with `let`: `let (a, b) = …`")
        }
        "in" if wants("`=`") => {
            diagnostic.help("a param has a default: `param name: float = 1.0 in 0.0..=2.0`")
        }
        "=" if wants("`{`") => diagnostic.help("equality is written `==`").suggest(replace("==")),
        "=" if wants("`:`") => diagnostic.help("a param has a type: `param name: float = 1.0`"),
        ")" | "," if wants("`:`") => diagnostic.help("every input and output has a type: `uv: vec2`"),
        _ if wants("`:`") => diagnostic.help("the name stands before the type: `uv: vec2`"),
        _ => diagnostic,
    }
}
