//! Sentences about arguments of calls.

use super::types::list;
use super::{Diagnostic, Place};

/// More arguments than inputs.
pub fn too_many_arguments(place: Place, name: &str, inputs: &[&str]) -> Diagnostic {
    let takes = match inputs.len() {
        0 => "no inputs".to_owned(),
        1 => "one input".to_owned(),
        count => format!("{count} inputs"),
    };
    let listed = (!inputs.is_empty()).then(|| format!("it takes {}", list(inputs)));
    Diagnostic::new("E0204", place, format!("`{name}` has {takes}"), "one argument too many")
        .maybe_help(listed)
}

/// An argument of `sample` or `texel` that stands without its name.
pub fn named_only(place: Place, name: &str, inputs: &[&str]) -> Diagnostic {
    let names = inputs.iter().map(|input| format!("`{input}: …`")).collect::<Vec<_>>().join(", ");
    too_many_arguments(place, name, &[])
        .because(format!("only the first argument of `{name}` goes by position"))
        .help(format!("name the others: {names}"))
}

/// An input without argument and default.
pub fn missing_argument(place: Place, name: &str, input: &str, ty: &str) -> Diagnostic {
    Diagnostic::new(
        "E0205",
        place,
        format!("`{name}` needs `{input}`"),
        format!("no argument for `{input}: {ty}`"),
    )
    .help(format!("add it by position, or as `{input}: …`"))
}

/// The layer that a layered view needs.
pub fn missing_layer(place: Place, name: &str) -> Diagnostic {
    missing_argument(place, name, "layer", "int").help("say which layer is meant: `layer: …`")
}

/// A layer of a view that has none.
pub fn no_layers(place: Place, name: &str) -> Diagnostic {
    unknown_argument(place, name, "layer", None)
        .help("only layered views, such as those of `patterns`, have layers")
}

/// A named argument that is no input.
pub fn unknown_argument(place: Place, name: &str, input: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new("E0206", place, format!("`{name}` has no input `{input}`"), "no such input")
        .did_you_mean(near)
}

/// An input that is given two arguments.
pub fn argument_twice(place: Place, name: &str, input: &str, first: Place) -> Diagnostic {
    Diagnostic::new("E0207", place, format!("`{input}` of `{name}` is given twice"), "the second")
        .related(first, "the first")
}

/// A bare word that is no choice.
pub fn unknown_choice(place: Place, input: &str, words: &[String], found: &str) -> Diagnostic {
    let near = super::names::nearest(found, words.iter().map(String::as_str));
    Diagnostic::new("E0214", place, format!("`{input}` is one of {}", list(words)), "not one of them")
        .did_you_mean(near)
}

/// A choice written as a string.
pub fn quoted_choice(place: Place, input: &str, words: &[String]) -> Diagnostic {
    unknown_choice(place, input, words, "").help("a choice is a bare word: write it without quotes")
}

/// A receiver whose type no node of that name takes first.
pub fn bad_receiver(place: Place, name: &str, found: &str, accepted: &[String]) -> Diagnostic {
    Diagnostic::new("E0215", place, format!("no `{name}` takes {found} first"), format!("given {found}"))
        .help(format!("`{name}` is for {}", accepted.join(", ")))
}

/// Arguments that a node of the library can do nothing with.
pub fn demand(call: Place, node: &str, wrong: &str, mend: &str) -> Diagnostic {
    let message = format!("`{node}` can't be called like this: {wrong}");
    Diagnostic::new("E0233", call, message, "called here").help(mend)
}
