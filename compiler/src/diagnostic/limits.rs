//! Sentences about the bounds of the language.

use super::{Diagnostic, Place};

/// Specialised nodes in a texture.
pub const MAX_NODES: usize = 4_096;
/// Values in a texture.
pub const MAX_VALUES: usize = 200_000;
/// Operations that working out constants may take, in a texture.
pub const MAX_EVALUATION: u64 = 1_000_000;
/// Steps of a fold, times those of the folds inside it.
pub const MAX_STEPS: u32 = 65_536;
/// Defaults that call nodes for whose defaults further nodes are called, each inside the next.
pub const MAX_DEFAULTS: usize = 32;
/// Entries of a constant table.
pub const MAX_TABLE: usize = 2_047;

/// More specialised nodes than a texture may have.
pub fn too_many_nodes(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new(
        "E0401",
        place,
        format!("a texture may use {MAX_NODES} nodes, each with its own constants; `{name}` is one too many"),
        "this call",
    )
    .help("pass numbers that vary as params or computed values instead of constants")
}

/// Defaults inside defaults.
pub fn defaults_too_deep(place: Place, name: &str) -> Diagnostic {
    let message = format!("defaults nest {MAX_DEFAULTS} levels deep before those of `{name}`");
    Diagnostic::new("E0002", place, message, "this call needs them")
        .help("give some of these nodes their arguments")
}

/// More values than a texture may have.
pub fn too_many_values(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new(
        "E0402",
        place,
        format!("a texture may hold {MAX_VALUES} operations; in `{name}` it passes that"),
        "too large here",
    )
    .help("split the texture, or bake a part of it")
}

/// More constant arithmetic than compiling may do.
pub fn too_much_evaluation(place: Place, name: &str) -> Diagnostic {
    Diagnostic::new(
        "E0403",
        place,
        format!("the constants of `{name}` take more than {MAX_EVALUATION} operations to compute"),
        "this fold is worked out when compiling",
    )
    .help("make it shorter, or let it depend on a param: then the shader computes it")
}

/// More textures than a host holds for one shader.
pub fn too_many_textures(
    place: Place,
    name: &str,
    count: usize,
    host: &str,
    most: usize,
    mend: &str,
) -> Diagnostic {
    Diagnostic::new(
        "E0701",
        place,
        format!("`{name}` reads {count} textures, and {host} has room for {most}"),
        format!("{} too many", count - most),
    )
    .help(mend)
}

/// More bytes of params than a host holds.
pub fn too_many_uniform_bytes(place: Place, name: &str, bytes: u32, host: &str, most: u32) -> Diagnostic {
    Diagnostic::new(
        "E0702",
        place,
        format!("the params of `{name}` take {bytes} bytes, and {host} has room for {most}"),
        "its uniform block is too large",
    )
    .help("make params that never change constants (`let`), and many numbers of one kind an `indices` or an `image`")
}

/// More outputs than a host draws to at once.
pub fn too_many_outputs(place: Place, name: &str, count: usize, host: &str, most: usize) -> Diagnostic {
    Diagnostic::new(
        "E0703",
        place,
        format!("`{name}` has {count} outputs, and {host} draws to {most} at once"),
        "an output is a colour attachment",
    )
    .help("put several numbers into one output (roughness, metallic and height into a `vec3`), or build it with `--form library`")
}

/// A texture that is larger than a host's may be.
pub fn texture_over_profile(place: Place, name: &str, size: [u32; 2], host: &str, most: u32) -> Diagnostic {
    let [width, height] = size;
    Diagnostic::new(
        "E0704",
        place,
        format!("`{name}` has {width}×{height} texels, and {host} has textures of {most} a side at most"),
        "too large for the profile",
    )
    .help("make the picture smaller, or cut it into `patterns`")
}

/// No texture to compile.
pub fn no_texture(place: Place) -> Diagnostic {
    Diagnostic::new("E0801", place, "the file declares no texture", "nothing to compile")
        .help("declare one: `texture name(uv: vec2) -> (color: color) { color = … }`")
}

/// A texture asked for by a name that the file does not have.
pub fn no_such_texture(place: Place, name: &str, known: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new("E0802", place, format!("the file has no texture `{name}`"), "in this file")
        .help(if known.is_empty() {
            "it declares none".to_owned()
        } else {
            format!("its textures are {known}")
        })
        .maybe_help(near.map(|near| format!("did you mean `{near}`?")))
}

/// A texture or node asked for, to draw its diagram, that the file does not have.
pub fn nothing_to_draw(place: Place, name: &str, known: &str, near: Option<String>) -> Diagnostic {
    no_such_texture(place, name, known, None)
        .because(format!("the file has no texture and no node `{name}`"))
        .help(if known.is_empty() {
            "it declares none".to_owned()
        } else {
            format!("its textures and nodes are {known}")
        })
        .maybe_help(near.map(|near| format!("did you mean `{near}`?")))
}

/// An output asked for that the texture does not have.
pub fn no_such_texture_output(place: Place, name: &str, known: &str, near: Option<String>) -> Diagnostic {
    Diagnostic::new("E0803", place, format!("the texture has no output `{name}`"), "its head")
        .help(format!("its outputs are {known}"))
        .maybe_help(near.map(|near| format!("did you mean `{near}`?")))
}

/// A shader that naga refuses: our fault.
pub fn bug(place: Place, what: &str) -> Diagnostic {
    Diagnostic::new("E0999", place, format!("a bug of texgraph: {what}"), "the shader of this is refused")
        .help("please report it with the file")
}
