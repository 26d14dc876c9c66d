//! The grammar's errors as diagnostics: the sentences are the grammar's own, with the mends that
//! need more than one token to guess.

use super::{Diagnostic, Place, names};
use texgraph_grammar::{SyntaxError, SyntaxErrorKind};

/// What begins an item.
const ITEMS: [&str; 5] = ["use", "let", "param", "node", "texture"];

/// A syntax error of a file.
pub fn error(file: u32, error: &SyntaxError) -> Diagnostic {
    let place = Place { file, span: error.span };
    let help = match &error.kind {
        SyntaxErrorKind::Unexpected { found, expected, help: None } => mend(found, expected),
        _ => error.help(),
    };
    let diagnostic = Diagnostic::new(error.code(), place, error.message(), error.label()).maybe_help(help);
    match error.related {
        Some((span, label)) => diagnostic.related(Place { file, span }, label),
        None => diagnostic,
    }
}

/// A likely mend of a token that can't stand where it does.
fn mend(found: &str, expected: &[&str]) -> Option<String> {
    let wants = |what: &str| expected.contains(&what);
    let found = found.trim_matches('`');
    Some(match found {
        _ if wants("`else`") && names::nearest(found, ["else"]).is_some() => names::did_you_mean("else"),
        _ if wants("an item") => {
            let near = names::nearest(found, ITEMS)?;
            format!("did you mean `{near}`?")
        }
        "," if wants("`=`") => "several names stand in brackets: `let (a, b) = …`".to_owned(),
        "(" if wants("an assignment") => {
            "names for several outputs begin with `let`: `let (a, b) = …`".to_owned()
        }
        "in" if wants("`=`") => "a param has a default: `param name: float = 1.0 in 0.0..=2.0`".to_owned(),
        "=" if wants("`{`") => "equality is written `==`".to_owned(),
        "=" if wants("`:`") => "a param has a type: `param name: float = 1.0`".to_owned(),
        ")" | "," if wants("`:`") => "every input and output has a type: `uv: vec2`".to_owned(),
        _ if wants("`:`") => "the name stands before the type: `uv: vec2`".to_owned(),
        _ => return None,
    })
}
