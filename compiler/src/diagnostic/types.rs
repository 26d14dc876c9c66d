//! Sentences about types and arguments.

use super::{Diagnostic, Place};

/// A value of another type than wanted.
pub fn mismatch(place: Place, wanted: &str, found: &str) -> Diagnostic {
    let help = match (wanted, found) {
        ("bool", "int" | "float") => Some("compare it: `x != 0`".to_owned()),
        (_, "bool") if wanted != "bool" => Some("choose by it: `if c { 1.0 } else { 0.0 }`".to_owned()),
        _ if wanted.starts_with('i') && !found.starts_with('i') && found != "bool" => {
            Some("nothing narrows by itself: `ifloor(x)` rounds down, `int(x)` truncates".to_owned())
        }
        _ => None,
    };
    Diagnostic::new("E0201", place, format!("this is `{found}`, `{wanted}` is wanted"), format!("`{found}`"))
        .maybe_help(help)
}

/// A type nobody knows.
pub fn unknown_type(place: Place, name: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new("E0202", place, format!("there is no type `{name}`"), "no such type")
        .maybe_help(near.map(|near| format!("did you mean `{near}`?")))
}

/// Two widths where one is wanted.
pub fn widths_differ(place: Place, first: u8, second: u8, first_place: Place) -> Diagnostic {
    Diagnostic::new(
        "E0203",
        place,
        format!("{second} components meet {first}"),
        format!("this has {second} components"),
    )
    .related(first_place, format!("this has {first}"))
    .help("only a scalar spreads to a vector: take components with `.xy`, or build a vector with `vec3(v, 0.0)`")
}

/// More arguments than inputs.
pub fn too_many_arguments(place: Place, name: &str, takes: usize) -> Diagnostic {
    let inputs = if takes == 1 { "one input".to_owned() } else { format!("{takes} inputs") };
    Diagnostic::new("E0204", place, format!("`{name}` has {inputs}"), "one argument too many")
}

/// An input without argument and default.
pub fn missing_argument(place: Place, name: &str, input: &str, ty: &str) -> Diagnostic {
    Diagnostic::new("E0205", place, format!("`{name}` needs `{input}`"), format!("no argument for `{input}: {ty}`"))
        .help(format!("add it by position, or as `{input}: …`"))
}

/// A named argument that is no input.
pub fn unknown_argument(place: Place, name: &str, input: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new("E0206", place, format!("`{name}` has no input `{input}`"), "no such input")
        .maybe_help(near.map(|near| format!("did you mean `{near}:`?")))
}

/// An input that is given two arguments.
pub fn argument_twice(place: Place, name: &str, input: &str) -> Diagnostic {
    Diagnostic::new("E0207", place, format!("`{input}` of `{name}` is given twice"), "the second")
}

/// Operands or arguments that no overload takes.
pub fn no_overload(place: Place, name: &str, found: &[String], accepted: &[String]) -> Diagnostic {
    let found = found.iter().map(|ty| format!("`{ty}`")).collect::<Vec<_>>().join(" and ");
    Diagnostic::new("E0208", place, format!("`{name}` does not take {found}"), format!("{found} here"))
        .help(format!("it takes {}", accepted.join(", or ")))
}

/// A swizzle that asks for what is not there.
pub fn bad_swizzle(place: Place, ty: &str, swizzle: &str) -> Diagnostic {
    Diagnostic::new("E0209", place, format!("`{ty}` has no components `{swizzle}`"), "no such components")
        .help("components are `xyzw` or `rgba`, not mixed, one to four of those the value has")
}

/// A name list that does not fit a record.
pub fn destructuring(place: Place, names: usize, outputs: &[String]) -> Diagnostic {
    Diagnostic::new(
        "E0212",
        place,
        format!("{names} names for {} outputs", outputs.len()),
        format!("the outputs are {}", outputs.join(", ")),
    )
    .help("give one name to each output in order, or name the whole and take `t.output`")
}

/// A name list for a single value.
pub fn not_a_record(place: Place) -> Diagnostic {
    Diagnostic::new("E0224", place, "only a node with several outputs can be taken apart", "this is a single value")
        .help("write `let name = …`")
}

/// Several outputs where one value is wanted.
pub fn record_as_value(place: Place, outputs: &[String]) -> Diagnostic {
    let help = outputs.first().map(|first| format!("take one of its outputs: `.{first}`"));
    Diagnostic::new("E0213", place, "this has several outputs, one value is wanted", outputs.join(", "))
        .maybe_help(help)
}

/// A bare word that is no choice.
pub fn unknown_choice(place: Place, input: &str, words: &[String]) -> Diagnostic {
    Diagnostic::new("E0214", place, format!("`{input}` is one of {}", words.join(", ")), "not one of them")
}

/// A receiver whose type no node of that name takes first.
pub fn bad_receiver(place: Place, name: &str, found: &str, accepted: &[String]) -> Diagnostic {
    Diagnostic::new("E0215", place, format!("no `{name}` takes `{found}` first"), format!("called on `{found}`"))
        .help(format!("`{name}` is for {}", accepted.join(", ")))
}

/// An int that does not fit.
pub fn int_too_large(place: Place) -> Diagnostic {
    Diagnostic::new("E0216", place, "an int lies between -2147483648 and 2147483647", "too large for an int")
        .help("write a float, `1e10`, if that is meant")
}

/// A float that does not fit.
pub fn float_too_large(place: Place) -> Diagnostic {
    Diagnostic::new("E0216", place, "a float is at most 3.4028235e38", "too large for a float")
}

/// An input that no host could feed.
pub fn unknown_texture_input(place: Place, name: &str, known: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new("E0217", place, format!("a texture can't take `{name}`"), "hosts don't know this input")
        .help(match near {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the inputs are {known}; a `param` is a value that the host sets"),
        })
}

/// A known input or output with another type than its own.
pub fn fixed_type(place: Place, name: &str, wanted: &str) -> Diagnostic {
    Diagnostic::new("E0218", place, format!("`{name}` of a texture is `{wanted}`"), format!("write `{name}: {wanted}`"))
}

/// A vector from too many or too few parts.
pub fn component_count(place: Place, name: &str, wanted: u8, found: usize) -> Diagnostic {
    Diagnostic::new("E0219", place, format!("`{name}` has {wanted} components, these are {found}"), "the parts")
        .help(format!("give {wanted} in all, or a single scalar for every component"))
}

/// A dimension that nobody declared, or that no argument binds.
pub fn unknown_dimension(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new("E0220", place, format!("there is no dimension `{name}` here"), "not declared")
        .help(format!("declare it behind the node's name: `node name<{name}>(…)`"))
}

/// A dimension outside 1 to 4.
pub fn bad_dimension(place: Place, found: u32) -> Diagnostic {
    Diagnostic::new("E0221", place, format!("a vector can't have {found} components"), "1 to 4 are possible")
}

/// Something that is no value where one is wanted.
pub fn not_a_value(place: Place, what: &str) -> Diagnostic {
    Diagnostic::new("E0222", place, format!("{what} is not a value"), "a number, vector or bool is wanted here")
}

/// A resource where another thing is wanted, or the other way round.
pub fn resource_mismatch(place: Place, wanted: &str, found: &str) -> Diagnostic {
    Diagnostic::new("E0223", place, format!("`{wanted}` is wanted, this is `{found}`"), format!("`{found}`"))
}

/// A comparison of what has no order.
pub fn not_a_scalar(place: Place, found: &str) -> Diagnostic {
    Diagnostic::new("E0225", place, format!("a single number is wanted, this is `{found}`"), format!("`{found}`"))
        .help("take a component with `.x`, or a `length`")
}

/// A type that can't stand where it stands.
pub fn type_not_allowed(place: Place, ty: &str, here: &str) -> Diagnostic {
    Diagnostic::new("E0226", place, format!("`{ty}` can't be the type of {here}"), "not here")
        .help("floats, ints, bools, vectors and colours can")
}
