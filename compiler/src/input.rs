//! The table of texture inputs: what hosts know how to feed.

/// An input that a texture may take.
pub struct TextureInput {
    /// Its fixed name.
    pub name: &'static str,
    /// The types it may be declared with, the usual one first.
    pub types: &'static [&'static str],
    /// It is the same for a whole draw: it has no screen derivative, and the complete form reads it
    /// from the uniform block.
    pub per_draw: bool,
}

const fn varying(name: &'static str, types: &'static [&'static str]) -> TextureInput {
    TextureInput { name, types, per_draw: false }
}

const fn per_draw(name: &'static str, types: &'static [&'static str]) -> TextureInput {
    TextureInput { name, types, per_draw: true }
}

/// Every input.
pub const INPUTS: &[TextureInput] = &[
    varying("uv", &["vec2"]),
    varying("position", &["vec3"]),
    varying("normal", &["vec3"]),
    varying("tangent", &["vec4"]),
    varying("view", &["vec3"]),
    per_draw("time", &["float"]),
    per_draw("base", &["ivec2", "ivec3"]),
    varying("uv2", &["vec2"]),
    varying("vertex_color", &["color", "vec4"]),
    per_draw("instance", &["int"]),
];

/// Whether an input is the same for a whole draw.
pub fn is_per_draw(name: &str) -> bool {
    INPUTS.iter().any(|input| input.name == name && input.per_draw)
}
