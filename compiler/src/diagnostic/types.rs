//! Sentences about types and arguments.

use super::{Diagnostic, Place, Suggestion};

/// A value of another type than wanted, for an input or output if it has a name.
pub fn mismatch(place: Place, name: Option<&str>, wanted: &str, found: &str) -> Diagnostic {
    let message = match name {
        Some(name) => format!("`{name}` takes `{wanted}`, this is `{found}`"),
        None => format!("`{wanted}` is wanted, this is `{found}`"),
    };
    Diagnostic::new("E0201", place, message, format!("`{found}`"))
        .maybe_help(conversion(wanted, found))
        .suggest(converted(place, wanted, found))
}

/// Arms of an `if` that have no common type.
pub fn arms_differ(place: Place, wanted: &str, found: &str, other: Place) -> Diagnostic {
    let message = format!("the arms of this `if` are `{wanted}` and `{found}`");
    Diagnostic::new("E0201", place, message, format!("`{found}`"))
        .related(other, format!("`{wanted}`"))
        .maybe_help(conversion(wanted, found))
        .suggest(converted(place, wanted, found))
}

/// A next value that the type of an accumulator can't hold.
pub fn accumulator(place: Place, name: &str, wanted: &str, found: &str, start: Place) -> Diagnostic {
    let help = (wanted == "int" && found == "float").then(|| "start with a float, such as `1.0`".to_owned());
    let message = format!("the accumulator `{name}` is `{wanted}`, its next value `{found}`");
    Diagnostic::new("E0201", place, message, format!("`{found}`"))
        .related(start, format!("its start is `{wanted}`"))
        .suggest(converted(place, wanted, found).filter(|_| help.is_none()))
        .maybe_help(help.or_else(|| conversion(wanted, found)))
}

/// The letter of a type's scalar and its width.
fn shape(ty: &str) -> Option<(char, usize)> {
    Some(match ty {
        "bool" => ('b', 1),
        "float" => ('f', 1),
        "int" => ('i', 1),
        _ => {
            let (scalar, width) =
                ty.strip_prefix("ivec").map(|w| ('i', w)).or(ty.strip_prefix("vec").map(|w| ('f', w)))?;
            (scalar, width.parse().ok()?)
        }
    })
}

/// How one type becomes another.
fn conversion(wanted: &str, found: &str) -> Option<String> {
    let narrows = "nothing narrows by itself: `ifloor(x)` rounds down, `int(x)` truncates";
    Some(match (shape(wanted)?, shape(found)?) {
        (('b', _), (_, 1)) => "compare it: `x != 0`".to_owned(),
        (('b', _), _) => "compare a component: `v.x > 0.0`".to_owned(),
        (_, ('b', _)) => "choose by it: `if c { 1.0 } else { 0.0 }`".to_owned(),
        (('i', want), ('f', have)) if have == 1 || have == want => narrows.to_owned(),
        ((_, 1), _) => "take one component, such as `.x`".to_owned(),
        ((scalar, want), (other, have)) if have > want => {
            let round = if (scalar, other) == ('i', 'f') { " of its `ifloor`" } else { "" };
            format!("take {want} components{round}: `.{}`", "xyzw".get(..want)?)
        }
        ((scalar, want), (_, have)) if have < want => {
            // What a fourth component is missing for is mostly alpha.
            let parts = if scalar == 'i' { ["0"; 4] } else { ["0.0", "0.0", "0.0", "1.0"] };
            format!("add what is missing: `{wanted}(v, {})`", parts.get(have..want)?.join(", "))
        }
        _ => return None,
    })
}

/// The same as an edit of the value.
fn converted(place: Place, wanted: &str, found: &str) -> Option<Suggestion> {
    let around = |before: String, behind: String| Some(Suggestion::around(place, before, behind));
    match (shape(wanted)?, shape(found)?) {
        (('b', _), _) => None,
        (('f', 1), ('b', _)) => around("if ".into(), " { 1.0 } else { 0.0 }".into()),
        (('i', 1), ('b', _)) => around("if ".into(), " { 1 } else { 0 }".into()),
        (_, ('b', _)) => None,
        (('i', want), ('f', have)) if have == 1 || have == want => around("ifloor(".into(), ")".into()),
        (('i', _), ('f', _)) => None,
        ((_, want), (_, have)) if have > want => around("(".into(), format!(").{}", "xyzw".get(..want)?)),
        ((scalar, want), (_, have)) if have < want => {
            let parts = if scalar == 'i' { ["0"; 4] } else { ["0.0", "0.0", "0.0", "1.0"] };
            around(format!("{wanted}("), format!(", {})", parts.get(have..want)?.join(", ")))
        }
        _ => None,
    }
}

/// Names of types in other languages.
const FOREIGN: &[(&str, &str)] = &[
    ("boolean", "bool"),
    ("colour", "color"),
    ("double", "float"),
    ("f32", "float"),
    ("float2", "vec2"),
    ("float3", "vec3"),
    ("float4", "vec4"),
    ("i32", "int"),
    ("int2", "ivec2"),
    ("int3", "ivec3"),
    ("int4", "ivec4"),
    ("integer", "int"),
    ("number", "float"),
    ("real", "float"),
    ("sampler2D", "image"),
    ("texture2D", "image"),
];

/// A type nobody knows.
pub fn unknown_type(place: Place, name: &str, near: Option<String>) -> Diagnostic {
    let foreign = FOREIGN.iter().find(|(theirs, _)| *theirs == name).map(|(_, ours)| (*ours).to_owned());
    Diagnostic::new("E0202", place, format!("there is no type `{name}`"), "no such type")
        .did_you_mean(foreign.or(near))
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
        format!("{names} {} for {} outputs", if names == 1 { "name" } else { "names" }, outputs.len()),
        format!("the outputs are {}", list(outputs)),
    )
    .help("give one name to each output in order, or name the whole and take `t.output`")
}

/// A name list for a single value.
pub fn not_a_record(place: Place) -> Diagnostic {
    Diagnostic::new(
        "E0224",
        place,
        "only a node with several outputs can be taken apart",
        "this is a single value",
    )
    .help("write `let name = …`")
}

/// Several outputs where one value is wanted.
pub fn record_as_value(place: Place, outputs: &[String]) -> Diagnostic {
    let taken: Vec<String> = outputs.iter().map(|output| format!("`.{output}`")).collect();
    let help = (!taken.is_empty()).then(|| format!("take one of its outputs: {}", taken.join(" or ")));
    let first = outputs.first().map(|first| Suggestion::around(place, "", format!(".{first}")));
    Diagnostic::new(
        "E0213",
        place,
        "this has several outputs, one value is wanted",
        format!("its outputs are {}", list(outputs)),
    )
    .maybe_help(help)
    .suggest(first)
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
        .help(format!("the inputs are {known}; a `param` is a value that the host sets"))
        .did_you_mean(near)
}

/// A known input or output with another type than its own.
pub fn fixed_type(place: Place, name: &str, wanted: &str) -> Diagnostic {
    Diagnostic::new(
        "E0218",
        place,
        format!("`{name}` of a texture is `{wanted}`"),
        format!("write `{name}: {wanted}`"),
    )
    .suggest(Some(Suggestion::replace(place, wanted).sure()))
}

/// A vector from too many or too few parts.
pub fn component_count(place: Place, name: &str, wanted: u8, found: usize) -> Diagnostic {
    Diagnostic::new(
        "E0219",
        place,
        format!("`{name}` has {wanted} components, these are {found}"),
        "the parts",
    )
    .help(format!("give {wanted} in all, or a single scalar for every component"))
}

/// A dimension that nobody declared, or that no argument binds.
pub fn unknown_dimension(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new("E0220", place, format!("there is no dimension `{name}` here"), "not declared")
        .help(format!("declare it behind the node's name: `node name<{name}>(…)`"))
}

/// A generic type without its dimension.
pub fn missing_dimension(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new("E0220", place, format!("how many components `{name}` has is not said"), "no dimension")
        .help(format!("write `{name}2`, or `{name}<n>` where the node declares `<n>`"))
}

/// A dimension for something that has none.
pub fn no_dimension(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new("E0227", place, format!("`{name}` has no dimension"), "called with one")
        .help("leave out what stands between `<` and `>`")
}

/// A dimension outside 1 to 4.
pub fn bad_dimension(place: Place, found: u32) -> Diagnostic {
    Diagnostic::new("E0221", place, format!("a vector can't have {found} components"), "1 to 4 are possible")
}

/// Something that is no value where one is wanted.
pub fn not_a_value(place: Place, what: &str) -> Diagnostic {
    Diagnostic::new(
        "E0222",
        place,
        format!("{what} is not a value"),
        "a number, vector or bool is wanted here",
    )
}

/// A resource where a value is wanted, with the nodes that read it.
pub fn resource_as_value(place: Place, kind: &str, nodes: &[String]) -> Diagnostic {
    let calls = nodes.iter().map(|node| format!("`.{node}(…)`")).collect::<Vec<_>>().join(" or ");
    not_a_value(place, &format!("`{kind}`"))
        .maybe_help((!nodes.is_empty()).then(|| format!("read it with {calls}")))
}

/// A resource where another thing is wanted, or the other way round.
pub fn resource_mismatch(place: Place, input: &str, wanted: &str, found: &str) -> Diagnostic {
    Diagnostic::new("E0223", place, format!("`{input}` takes {wanted}, this is {found}"), found)
}

/// A comparison of what has no order.
pub fn not_a_scalar(place: Place, found: &str) -> Diagnostic {
    Diagnostic::new(
        "E0225",
        place,
        format!("a single number is wanted, this is `{found}`"),
        format!("`{found}`"),
    )
    .help("take a component with `.x`, or a `length`")
}

/// A type that can't stand where it stands.
pub fn type_not_allowed(place: Place, ty: &str, here: &str) -> Diagnostic {
    let help = if ty == "bool" {
        "write a number: `if c { 1.0 } else { 0.0 }`"
    } else {
        "numbers, vectors and colours can"
    };
    Diagnostic::new("E0226", place, format!("`{ty}` can't be the type of {here}"), "not here").help(help)
}

/// `a`, `b`, `c`
pub(super) fn list(names: &[impl AsRef<str>]) -> String {
    names.iter().map(|name| format!("`{}`", name.as_ref())).collect::<Vec<_>>().join(", ")
}
