//! Sentences about nodes that are passed to nodes, and about bakes.

use super::{Diagnostic, Place};

/// A lambda with another number of inputs than the node's type.
pub fn lambda_inputs(place: Place, input: &str, wanted: &[&str], found: usize) -> Diagnostic {
    let plural = if wanted.len() == 1 { "" } else { "s" };
    Diagnostic::new(
        "E0228",
        place,
        format!("`{input}` takes a node of {} input{plural}, this lambda has {found}", wanted.len()),
        format!("{found} here"),
    )
    .help(format!("its inputs are called with: |{}| …", wanted.join(", ")))
}

/// Something else where a node is wanted.
pub fn not_a_node(place: Place, input: &str, found: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new("E0229", place, format!("`{input}` takes a node, this is {found}"), "no node")
        .help("pass the name of a node, or a lambda: `|at| …`")
        .maybe_help(near.map(|near| format!("did you mean `{near}`?")))
}

/// A lambda where no node is wanted.
pub fn lambda_as_value(place: Place) -> Diagnostic {
    Diagnostic::new("E0230", place, "a lambda stands only where a node is wanted", "this input takes a value")
        .help("write its body in place of it")
}

/// A passed node whose record has other fields than its type says.
pub fn record_fields(place: Place, wanted: &[String], found: &str) -> Diagnostic {
    Diagnostic::new(
        "E0231",
        place,
        format!("this node must give ({}), it gives {found}", wanted.join(", ")),
        "another record",
    )
}

/// A bake of something that changes while drawing.
pub fn bake_reads(place: Place, names: &[String]) -> Diagnostic {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    Diagnostic::new(
        "E0307",
        place,
        format!("a bake can't read {}", names.join(", ")),
        "this changes from frame to frame or from pixel to pixel",
    )
    .help("a baked node reads its own input, params, constants and resources")
}

/// A wire of a texture or node that it does not have.
pub fn no_such_wire(place: Place, node: &str, wire: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new("E0804", place, format!("`{node}` has no wire `{wire}`"), "its head")
        .help("any `let` of its body, an input or an output can be looked at")
        .maybe_help(near.map(|near| format!("did you mean `{near}`?")))
}

/// A node that can't be rendered on its own.
pub fn not_renderable(place: Place, node: &str, input: &str, ty: &str) -> Diagnostic {
    Diagnostic::new(
        "E0805",
        place,
        format!("`{node}` can't be rendered alone: nothing is there to pass as `{input}`"),
        format!("a `{ty}` without a default"),
    )
    .help("render a texture that calls it, or a wire of one: `FILE:texture.wire`")
}
