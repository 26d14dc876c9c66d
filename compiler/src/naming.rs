//! Names in the emitted text.
//!
//! The text writer renames whatever is used twice in a module, reserved, or ends in a digit. So it
//! is only ever given placeholders (`z17z`), which it leaves alone, and the names of our choice
//! replace them in the text it writes (see [`Names::apply`]).

use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, format_smolstr};
use std::ops::Range;

/// A name that is legal and keeps its meaning: dots of imports become `_`, a trailing digit gets a
/// `_` (tools that import WGSL refuse it otherwise), no leading `_`.
pub fn identifier(name: &str) -> SmolStr {
    if is_identifier(name) {
        return name.into();
    }
    let mut out = String::with_capacity(name.len() + 2);
    let plain = name.bytes().take_while(u8::is_ascii_alphanumeric).count();
    let (plain, rest) = name.split_at(plain);
    out.push_str(plain);
    for c in rest.chars() {
        if c.is_ascii_alphanumeric() {
            out.push(c);
        } else if !(out.is_empty() || out.ends_with('_')) {
            // Neither a leading `_` nor two of them side by side.
            out.push('_');
        }
    }
    if out.is_empty() || out.starts_with(|c: char| c.is_ascii_digit()) {
        out.insert(0, 'n');
    }
    if out.ends_with(|c: char| c.is_ascii_digit()) {
        out.push('_');
    }
    out.into()
}

/// Whether nothing has to be changed.
fn is_identifier(name: &str) -> bool {
    let bytes = name.as_bytes();
    let ends = bytes.first().is_some_and(u8::is_ascii_alphabetic)
        && bytes.last().is_some_and(|byte| byte.is_ascii_alphabetic());
    ends && bytes.iter().all(is_part) && !name.contains("__")
}

/// `tile_map` as `TileMap`.
pub fn camel_case(name: &str) -> String {
    let words = name.split('_').filter(|word| !word.is_empty());
    let camel: String = words
        .map(|word| {
            let (first, rest) = word.split_at(1);
            format!("{}{rest}", first.to_ascii_uppercase())
        })
        .collect();
    if camel.ends_with(|c: char| c.is_ascii_digit()) { format!("{camel}_") } else { camel }
}

const LETTERS: &[u8; 26] = b"abcdefghijklmnopqrstuvwxyz";
const DIGITS: &[u8; 10] = b"0123456789";

/// Writes a number in the system of these digits.
fn push_number(text: &mut String, number: usize, digits: &[u8]) {
    for place in (0..=number.checked_ilog(digits.len()).unwrap_or(0)).rev() {
        let digit = number / digits.len().pow(place) % digits.len();
        text.push(char::from(digits[digit]));
    }
}

/// The names of one scope: a module, a function, a struct.
#[derive(Default, Clone)]
pub struct Scope {
    /// The names taken, each with how many suffixes of it have been tried.
    taken: FxHashMap<SmolStr, usize>,
    /// Names beginning with this belong to the module.
    module: String,
}

impl Scope {
    /// A scope inside a module all of whose names begin with `module`.
    pub fn inside(module: &str) -> Scope {
        Scope { module: module.to_owned(), ..Scope::default() }
    }

    /// Takes a name that was chosen elsewhere.
    pub fn take(&mut self, name: &str) {
        self.taken.entry(name.into()).or_insert(0);
    }

    /// The wished name, or one like it that is free here.
    pub fn name(&mut self, wish: &str) -> SmolStr {
        let name = self.free(identifier(wish));
        self.taken.insert(name.clone(), 0);
        name
    }

    /// The name, or one like it that is free.
    fn free(&mut self, name: SmolStr) -> SmolStr {
        let module = !self.module.is_empty()
            && name.strip_prefix(&self.module).is_some_and(|rest| rest.is_empty() || rest.starts_with('_'));
        let name = if module || is_reserved(&name) { format_smolstr!("{name}_value") } else { name };
        let Some(mut tried) = self.taken.get(&name).copied() else { return name };
        let mut other = String::with_capacity(name.len() + 4);
        other.push_str(&name);
        while self.taken.contains_key(other.as_str()) {
            // `_b`, `_c`, … `_z`, `_ba`, …: without digits.
            tried += 1;
            other.truncate(name.len());
            other.push('_');
            push_number(&mut other, tried, LETTERS);
        }
        self.taken.insert(name, tried);
        other.into()
    }
}

/// Keywords, reserved words and predeclared names of WGSL, and those Tint refuses beyond them.
fn is_reserved(name: &str) -> bool {
    crate::lower::is_keyword(name) || matches!(name, "active" | "self" | "main")
}

/// Final names by placeholder.
#[derive(Default)]
pub struct Names(Vec<Name>);

/// What a placeholder stands for.
struct Name {
    text: SmolStr,
    kind: Kind,
}

/// How a name is declared.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// As the writer declares it.
    Plain,
    /// Not at all: it is another thing's name.
    Alias,
    /// Where it is first stored to.
    Stored,
}

impl Kind {
    /// What stands before a declaration that is not to be written; none where `before` ends in none.
    fn undeclared(self, before: &str) -> Option<&str> {
        match self {
            Kind::Plain => None,
            Kind::Alias => before.strip_suffix("let "),
            Kind::Stored => before.strip_suffix("var "),
        }
    }
}

impl Names {
    /// A placeholder for a final name.
    pub fn placeholder(&mut self, name: impl Into<SmolStr>) -> String {
        self.push(name.into(), Kind::Plain)
    }

    /// A placeholder for what has a final name already, such as the value of a variable.
    pub fn alias(&mut self, name: impl Into<SmolStr>) -> String {
        self.push(name.into(), Kind::Alias)
    }

    /// A placeholder for a variable that is stored to in the block that all its uses are in, before
    /// any of them: it is declared there.
    pub fn stored(&mut self, name: impl Into<SmolStr>) -> String {
        self.push(name.into(), Kind::Stored)
    }

    fn push(&mut self, text: SmolStr, kind: Kind) -> String {
        let mut placeholder = String::with_capacity(8);
        placeholder.push('z');
        push_number(&mut placeholder, self.0.len(), DIGITS);
        placeholder.push('z');
        self.0.push(Name { text, kind });
        placeholder
    }

    /// The text with placeholders replaced. `results` names the results of calls: `_e7` of the
    /// nth function, which the writer names itself.
    pub fn apply(&self, text: &str, results: &[FxHashMap<u32, SmolStr>]) -> String {
        let mut out = String::with_capacity(text.len() * 3 / 2);
        let mut functions = 0_usize;
        let mut stored = FxHashSet::default();
        // What stands before `done` is in `out`.
        let mut done = 0;
        let mut at = 0;
        while let Some((place, token)) = next_token(text, at) {
            at = place.end;
            let before = &text[done..place.start];
            let results = results.get(functions.wrapping_sub(1));
            let Some((name, kind)) = self.meaning(token, results) else { continue };
            functions += usize::from(before.ends_with("fn "));
            if let Some(before) = kind.undeclared(before)
                && let Some((_, behind)) = text[at..].split_once('\n')
            {
                out.push_str(before.trim_end_matches(' '));
                // The writer parts variables from the rest by an empty line.
                let behind = if out.ends_with("{\n") { behind.trim_start_matches('\n') } else { behind };
                at = text.len() - behind.len();
            } else {
                out.push_str(before);
                if kind == Kind::Stored && stored.insert(&text[place]) {
                    out.push_str("var ");
                }
                out.push_str(name);
            }
            done = at;
        }
        out.push_str(&text[done..]);
        out
    }

    /// The name that a token stands for, and how it is declared.
    fn meaning<'n>(
        &'n self,
        token: Token,
        results: Option<&'n FxHashMap<u32, SmolStr>>,
    ) -> Option<(&'n str, Kind)> {
        match token {
            Token::Placeholder(number) => self.0.get(number).map(|name| (name.text.as_str(), name.kind)),
            Token::Result(number) => results?.get(&number).map(|name| (name.as_str(), Kind::Plain)),
        }
    }
}

/// A name in the text that is to be replaced.
enum Token {
    /// `z17z`
    Placeholder(usize),
    /// `_e7`
    Result(u32),
}

/// The next one from `from` on, and where it stands.
fn next_token(text: &str, from: usize) -> Option<(Range<usize>, Token)> {
    let bytes = text.as_bytes();
    memchr::memchr2_iter(b'z', b'_', &bytes[from..]).find_map(|found| {
        let start = from + found;
        let (length, token) = token(&bytes[start..])?;
        (!bytes[..start].last().is_some_and(is_part)).then_some((start..start + length, token))
    })
}

/// The token that a text begins with, and its length.
fn token(text: &[u8]) -> Option<(usize, Token)> {
    let (numbered, is_placeholder) = match text {
        [b'z', numbered @ ..] => (numbered, true),
        [b'_', b'e', numbered @ ..] => (numbered, false),
        _ => return None,
    };
    let digits = numbered.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let (digits, behind) = numbered.split_at(digits);
    let behind = match behind {
        [b'z', behind @ ..] if is_placeholder => behind,
        behind if !is_placeholder => behind,
        _ => return None,
    };
    if digits.is_empty() || behind.first().is_some_and(is_part) {
        return None;
    }
    let add = |number: u32, digit: &u8| number.wrapping_mul(10).wrapping_add(u32::from(digit - b'0'));
    let number = digits.iter().fold(0, add);
    let token = if is_placeholder { Token::Placeholder(number as usize) } else { Token::Result(number) };
    Some((text.len() - behind.len(), token))
}

/// Whether a byte can stand in a name.
fn is_part(byte: &u8) -> bool {
    byte.is_ascii_alphanumeric() || *byte == b'_'
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_legal_and_distinct() {
        let mut scope = Scope::inside("meadow");
        assert_eq!(scope.name("cell"), "cell");
        assert_eq!(scope.name("cell"), "cell_b");
        assert_eq!(scope.name("uv2"), "uv2_");
        assert_eq!(scope.name("meadow"), "meadow_value");
        assert_eq!(scope.name("meadow_grass"), "meadow_grass_value");
        assert_eq!(scope.name("loop"), "loop_value");
        assert_eq!(scope.name("s.scale"), "s_scale");
        assert_eq!(scope.name("_x"), "x");
        assert_eq!(camel_case("tile_map"), "TileMap");
    }

    #[test]
    fn placeholders_become_names_and_numbers_stay() {
        let mut names = Names::default();
        let cell = names.placeholder("cell");
        let at = names.placeholder("at");
        let text = format!("let {cell} = 1e-3f + {at}.x * 0x1fu;");
        assert_eq!(names.apply(&text, &[]), "let cell = 1e-3f + at.x * 0x1fu;");
    }

    #[test]
    fn aliases_are_written_as_what_they_stand_for() {
        let mut names = Names::default();
        let variable = names.placeholder("sum");
        let value = names.alias("sum");
        let next = names.placeholder("next");
        let text = format!("{{\n    let {value} = {variable};\n    let {next} = {value} + 1;\n}}\n");
        assert_eq!(names.apply(&text, &[]), "{\n    let next = sum + 1;\n}\n");
    }

    #[test]
    fn variables_are_declared_where_they_are_first_stored_to() {
        let mut names = Names::default();
        let sum = names.stored("sum");
        let text = format!("{{\n    var {sum}: f32;\n\n    {sum} = 1f;\n    {sum} = {sum} + 1f;\n}}\n");
        assert_eq!(names.apply(&text, &[]), "{\n    var sum = 1f;\n    sum = sum + 1f;\n}\n");
    }
}
