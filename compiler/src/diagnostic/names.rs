//! Sentences about names.

use super::{Diagnostic, Place};

/// The candidate that a misspelt name most likely means.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    candidates
        .into_iter()
        .map(|candidate| (strsim::damerau_levenshtein(name, candidate), candidate))
        .filter(|(distance, candidate)| *distance <= 1 + name.len().min(candidate.len()) / 4)
        .min()
        .map(|(_, candidate)| candidate.to_owned())
}

fn did_you_mean(near: Option<String>) -> Option<String> {
    near.map(|near| format!("did you mean `{near}`?"))
}

/// A value that nobody declared.
pub fn unknown_value(place: Place, name: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new("E0101", place, format!("there is no value `{name}` here"), "no such name")
        .maybe_help(did_you_mean(near))
}

/// A node that nobody declared.
pub fn unknown_callable(place: Place, name: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new("E0102", place, format!("there is no node `{name}`"), "no such node")
        .maybe_help(did_you_mean(near))
}

/// A name bound again in one body or file.
pub fn bound_twice(place: Place, name: &str, first: Place) -> Diagnostic {
    Diagnostic::new("E0103", place, format!("`{name}` is bound twice"), "the second binding")
        .related(first, "the first binding")
        .help("every name is one wire: choose another name")
}

/// Wires that need each other.
pub fn cycle(place: Place, names: &[&str]) -> Diagnostic {
    let mut ring: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    ring.extend(ring.first().cloned());
    Diagnostic::new("E0104", place, format!("wires run in a circle: {}", ring.join(" → ")), "this needs itself")
        .help("a graph has no feedback: compute one of them from something else")
}

/// A field that a value does not have.
pub fn unknown_field(place: Place, what: &str, name: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new("E0105", place, format!("{what} has no field `{name}`"), "no such field")
        .maybe_help(did_you_mean(near))
}

/// An assignment to something that is no output.
pub fn no_such_output(place: Place, node: &str, name: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new("E0106", place, format!("`{node}` has no output `{name}`"), "not an output")
        .maybe_help(did_you_mean(near).or_else(|| Some(format!("a wire begins with `let`: `let {name} = …`"))))
}

/// An output without a value.
pub fn output_missing(place: Place, node: &str, name: &str) -> Diagnostic {
    Diagnostic::new("E0107", place, format!("the output `{name}` of `{node}` gets no value"), "declared here")
        .help(format!("assign it in the body: `{name} = …`"))
}

/// A node that calls itself, directly or through others.
pub fn recursion(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new("E0109", place, format!("`{name}` calls itself"), "the call that closes the ring")
        .help("a graph has no recursion: use a fold")
}

/// A node's name without a call.
pub fn node_as_value(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new("E0110", place, format!("`{name}` is a node, not a value"), "a node needs its arguments")
        .help(format!("call it: `{name}(…)`"))
}

/// A value with brackets behind it.
pub fn value_as_node(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new("E0110", place, format!("`{name}` is a value, not a node"), "it can't be called")
        .help("a value stands without brackets")
}

/// The alias of an import on its own.
pub fn alias_as_value(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new("E0111", place, format!("`{name}` is an imported file, not a value"), "a file")
        .help(format!("name one of its items: `{name}.item`"))
}
