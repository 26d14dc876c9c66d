//! Names that nobody else has: ordinary ones, and such that mean something in a shader language.

use super::choices::Choices;
use std::collections::BTreeSet;

/// Ordinary words; words that WGSL, GLSL or naga keep for themselves; names with digits and
/// underscores at either end.
const WORDS: &[&str] = &[
    "cell",
    "grain",
    "pebble",
    "Moss",
    "pick",
    "turn",
    "fn",
    "var",
    "const",
    "struct",
    "return",
    "discard",
    "loop",
    "switch",
    "case",
    "default",
    "break",
    "continuing",
    "array",
    "ptr",
    "sampler",
    "texture_2d",
    "vec2f",
    "f32",
    "i32",
    "u32",
    "active",
    "self",
    "main",
    "override",
    "enable",
    "alias",
    "diagnostic",
    "fragment",
    "x",
    "xy",
    "rgb",
    "a1",
    "b_2",
    "m00",
    "_rough",
    "__deep",
    "_",
    "tail_",
    "hash4",
    "select",
    "inverseSqrt",
    "gl_Position",
    "Texture",
    "params",
    "input",
];

/// What can't be a new name: keywords, and what already means something before a bracket.
const TAKEN: &[&str] = &[
    "use",
    "let",
    "param",
    "node",
    "texture",
    "if",
    "else",
    "fold",
    "for",
    "in",
    "while",
    "true",
    "false",
    "none",
    "n",
    "as",
    "max",
    "tiles",
    "given",
    "dx",
    "dy",
    "float",
    "int",
    "bool",
    "color",
    "vec",
    "ivec",
    "vec2",
    "vec3",
    "vec4",
    "ivec2",
    "ivec3",
    "ivec4",
    "mat2",
    "mat3",
    "sample",
    "texel",
    "level",
    "size",
    "uv",
    "position",
    "normal",
    "tangent",
    "view",
    "time",
    "base",
    "uv2",
    "vertex_color",
    "instance",
    "height",
    "emission",
    "roughness",
    "metallic",
    "occlusion",
];

/// The names given so far.
pub struct Names {
    used: BTreeSet<String>,
    count: usize,
}

impl Names {
    /// None given yet but those of the library.
    pub fn new<'a>(library: impl IntoIterator<Item = &'a str>) -> Names {
        let taken = TAKEN.iter().copied().chain(library);
        Names { used: taken.map(str::to_owned).collect(), count: 0 }
    }

    /// A new name.
    pub fn fresh(&mut self, choices: &mut Choices) -> String {
        let word = *choices.pick(WORDS);
        if self.used.insert(word.to_owned()) {
            return word.to_owned();
        }
        loop {
            self.count += 1;
            let name = match choices.below(3) {
                0 => format!("{word}_{}", letters(self.count)),
                1 => format!("{word}{}", self.count),
                _ => format!("{}{word}", letters(self.count)),
            };
            if self.used.insert(name.clone()) {
                return name;
            }
        }
    }
}

/// A number in letters.
fn letters(mut n: usize) -> String {
    let mut letters = String::new();
    while n > 0 {
        letters.push(char::from(b'a' + (n % 26) as u8));
        n /= 26;
    }
    letters
}
