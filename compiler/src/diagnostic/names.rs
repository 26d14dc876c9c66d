//! Sentences about names.

use super::{Diagnostic, Place, Suggestion};

/// The candidate that a misspelt name most likely means: one that differs only in case and
/// underscores, has a word more or less (`cell`, `my_cell`), or else differs in less than about a
/// third of its letters.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let plain = |name: &str| name.replace('_', "").to_lowercase();
    let distance = |candidate: &str| {
        let same = plain(candidate) == plain(name) && !plain(name).is_empty();
        match same {
            true => 0,
            false if has_word(name, candidate) || has_word(candidate, name) => 1,
            false => strsim::damerau_levenshtein(name, candidate),
        }
    };
    let others = candidates.into_iter().filter(|candidate| *candidate != name);
    others
        .map(|candidate| (distance(candidate), candidate))
        .filter(|(distance, candidate)| {
            let (shorter, longer) = (name.len().min(candidate.len()), name.len().max(candidate.len()));
            *distance <= 1.max(shorter / 3) && *distance < longer
        })
        .min()
        .map(|(_, candidate)| candidate.to_owned())
}

/// Whether a name is another one with words before or behind.
fn has_word(whole: &str, part: &str) -> bool {
    let rest = whole.strip_prefix(part).is_some_and(|rest| rest.starts_with('_'))
        || whole.strip_suffix(part).is_some_and(|rest| rest.ends_with('_'));
    rest && part.len() > 2
}

/// What functions of shading languages are here.
const FOREIGN: &[(&str, &str)] = &[
    ("atan", "`atan2(y, x)`"),
    ("bool", "`x != 0`"),
    ("clamp01", "`clamp(x, 0.0, 1.0)`"),
    ("color", "`vec4(r, g, b, a)`, or a literal such as `#a0c040`"),
    ("dFdx", "`dx(v)`"),
    ("dFdy", "`dy(v)`"),
    ("ddx", "`dx(v)`"),
    ("ddy", "`dy(v)`"),
    ("degrees", "`x / 1deg`"),
    ("dpdx", "`dx(v)`"),
    ("dpdy", "`dy(v)`"),
    ("fabs", "`abs(x)`"),
    ("fmod", "`x % y`"),
    ("frac", "`fract(x)`"),
    ("fwidth", "`footprint(v)`"),
    ("inversesqrt", "`1.0 / sqrt(x)`"),
    ("lerp", "`mix(a, b, t)`"),
    ("mad", "`a * b + c`"),
    ("mod", "`x % y`"),
    ("mul", "`a * b`"),
    ("powf", "`pow(x, y)`"),
    ("radians", "`x * 1deg`"),
    ("rand", "`hash(i)`, of ints"),
    ("random", "`hash(i)`, of ints"),
    ("rsqrt", "`1.0 / sqrt(x)`"),
    ("saturate", "`clamp(x, 0.0, 1.0)`"),
    ("select", "`if c { a } else { b }`"),
    ("tex2D", "`image.sample(uv)`"),
    ("texelFetch", "`image.texel(i)`"),
    ("texture2D", "`image.sample(uv)`"),
    ("textureLod", "`image.sample(uv, lod: l)`"),
    ("textureSample", "`image.sample(uv)`"),
];

/// What values of shading languages are here.
const FOREIGN_VALUES: &[(&str, &str)] = &[
    ("M_PI", "`180deg`"),
    ("None", "`none`"),
    ("PI", "`180deg`"),
    ("TAU", "`360deg`"),
    ("fragCoord", "`uv`, an input of the texture"),
    ("gl_FragCoord", "`uv`, an input of the texture"),
    ("iResolution", "`footprint(uv)`, the size of a pixel"),
    ("iTime", "`time`, an input of the texture"),
    ("nil", "`none`"),
    ("null", "`none`"),
    ("pi", "`180deg`"),
    ("tau", "`360deg`"),
];

fn foreign(table: &[(&str, &str)], name: &str) -> Option<String> {
    let known = table.iter().find(|(theirs, _)| *theirs == name);
    known.map(|(_, ours)| format!("here it is written {ours}"))
}

/// The help for an input of textures that is read where it is not declared.
pub fn not_passed_on(node: &str, input: &str) -> String {
    format!("nothing is passed on by itself: add `{input}` to the inputs of `{node}`")
}

/// A value that nobody declared.
pub fn unknown_value(place: Place, name: &str, near: Option<String>) -> Diagnostic {
    let foreign = foreign(FOREIGN_VALUES, name);
    Diagnostic::new("E0101", place, format!("there is no value `{name}` here"), "no such name")
        .did_you_mean(near.filter(|_| foreign.is_none()))
        .maybe_help(foreign)
}

/// An alias that is missing: a file is imported, but its items joined ours.
pub fn missing_alias(place: Place, name: &str) -> Diagnostic {
    unknown_value(place, name, None).help(format!(
        "the items of that file are used without a prefix, or import it by name: `use \"…\" as {name}`"
    ))
}

/// A node that nobody declared.
pub fn unknown_callable(place: Place, name: &str, near: Option<String>) -> Diagnostic {
    let foreign = foreign(FOREIGN, name);
    Diagnostic::new("E0102", place, format!("there is no node `{name}`"), "no such node")
        .did_you_mean(near.filter(|_| foreign.is_none()))
        .maybe_help(foreign)
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
    let message = match names {
        [one] => format!("`{one}` needs itself"),
        _ => format!("wires run in a circle: {}", ring.join(" → ")),
    };
    Diagnostic::new("E0104", place, message, "this closes the circle")
        .help("a graph has no feedback: compute one of them from something else")
}

/// A field that a value does not have.
pub fn unknown_field(place: Place, what: &str, name: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new("E0105", place, format!("{what} has no field `{name}`"), "no such field")
        .did_you_mean(near)
}

/// An assignment to something that is no output.
pub fn no_such_output(place: Place, node: &str, name: &str, near: Option<String>) -> Diagnostic {
    let message = format!("`{node}` has no output `{name}`");
    no_such_target(Diagnostic::new("E0106", place, message, "not an output"), name, near)
}

/// An assignment in a fold to something that is no accumulator.
pub fn no_such_accumulator(place: Place, name: &str, near: Option<String>) -> Diagnostic {
    let message = format!("the fold has no accumulator `{name}`");
    no_such_target(Diagnostic::new("E0106", place, message, "not in its head"), name, near)
}

fn no_such_target(error: Diagnostic, name: &str, near: Option<String>) -> Diagnostic {
    let wire = Suggestion::replace(error.place, format!("let {name}"));
    let help = format!("a wire begins with `let`: `let {name} = …`");
    error.help(help).suggest(Some(wire)).did_you_mean(near)
}

/// An output without a value.
pub fn output_missing(place: Place, node: &str, name: &str) -> Diagnostic {
    Diagnostic::new("E0107", place, format!("the output `{name}` of `{node}` gets no value"), "declared here")
        .help(format!("assign it in the body: `{name} = …`"))
}

/// An output without a value, because a `let` made a wire of its name.
pub fn output_shadowed(place: Place, node: &str, name: &str, wire: Place) -> Diagnostic {
    output_missing(place, node, name)
        .related(wire, "this `let` makes a wire of its own")
        .help(format!("an output is assigned without `let`: `{name} = …`"))
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
