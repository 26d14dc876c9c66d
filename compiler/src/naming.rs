//! Names in the emitted text.
//!
//! The text writer renames whatever is used twice in a module, reserved, or ends in a digit. So it
//! is only ever given placeholders (`z17z`), which it leaves alone, and the names of our choice
//! replace them in the text it writes (see [`Names::apply`]).

use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, format_smolstr};
use std::collections::hash_map::Entry;
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

/// Writes a number in the system of these digits, two or more.
fn push_number(text: &mut String, mut number: usize, digits: &[u8]) {
    let start = text.len();
    loop {
        text.insert(start, char::from(digits[number % digits.len()]));
        number /= digits.len();
        if number == 0 {
            break;
        }
    }
}

/// The names of one scope: a module, a function, a struct.
#[derive(Default, Clone)]
pub struct Scope {
    /// The names taken, each with how many suffixes of it have been tried.
    taken: FxHashMap<SmolStr, usize>,
    /// Names beginning with this belong to the module.
    module: SmolStr,
}

impl Scope {
    /// A scope inside a module all of whose names begin with `module`.
    pub fn inside(module: &str) -> Scope {
        // As many names as most functions have.
        let taken = FxHashMap::with_capacity_and_hasher(28, Default::default());
        Scope { taken, module: module.into() }
    }

    /// Takes a name that was chosen elsewhere.
    pub fn take(&mut self, name: &str) {
        self.taken.entry(name.into()).or_insert(0);
    }

    /// The wished name, or one like it that is free here.
    pub fn name(&mut self, wish: &str) -> SmolStr {
        let name = self.own(identifier(wish));
        match self.taken.entry(name) {
            Entry::Vacant(free) => {
                let name = free.key().clone();
                free.insert(0);
                name
            }
            Entry::Occupied(taken) => {
                let (name, tried) = (taken.key().clone(), *taken.get());
                self.other(name, tried)
            }
        }
    }

    /// The name, unless it is the module's or the language's.
    fn own(&self, name: SmolStr) -> SmolStr {
        if is_of_module(&name, &self.module) || is_reserved(&name) {
            format_smolstr!("{name}_value")
        } else {
            name
        }
    }

    /// A free name like one that is taken, of which so many suffixes have been tried.
    fn other(&mut self, name: SmolStr, mut tried: usize) -> SmolStr {
        let mut other = String::with_capacity(name.len() + 4);
        other.push_str(&name);
        while self.taken.contains_key(other.as_str()) {
            // `_b`, `_c`, … `_z`, `_ba`, …: without digits.
            tried += 1;
            other.truncate(name.len());
            other.push('_');
            push_number(&mut other, tried, LETTERS);
        }
        let other = SmolStr::from(other);
        self.taken.insert(name, tried);
        self.taken.insert(other.clone(), 0);
        other
    }
}

/// Whether a name begins with that of its module, if that has one.
fn is_of_module(name: &str, module: &str) -> bool {
    let rest = name.strip_prefix(module).filter(|_| !module.is_empty());
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
}

/// Keywords, reserved words and predeclared names of WGSL, and those Tint refuses beyond them.
fn is_reserved(name: &str) -> bool {
    crate::lower::is_keyword(name) || matches!(name, "active" | "self" | "main")
}

/// Final names by placeholder.
#[derive(Clone, Debug, Default)]
pub struct Names(Vec<Name>);

/// What a placeholder stands for.
#[derive(Clone, Debug)]
struct Name {
    text: SmolStr,
    kind: Kind,
}

/// How a name is declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
        write_placeholder(&mut placeholder, self.0.len());
        self.0.push(Name { text, kind });
        placeholder
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Adds the names of others behind its own.
    pub fn extend(&mut self, others: &Names, range: Range<usize>) {
        self.0.extend_from_slice(&others.0[range]);
    }

    /// Whether one of these names begins as those of a module do.
    pub fn begin_with(&self, range: Range<usize>, module: &str) -> bool {
        self.0[range].iter().any(|name| is_of_module(&name.text, module))
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
        for start in memchr::memchr2_iter(b'z', b'_', text.as_bytes()) {
            let Some((length, token)) = (start >= at).then(|| token_at(text.as_bytes(), start)).flatten()
            else {
                continue;
            };
            let place = start..start + length;
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

/// Makes a text the placeholder of that number.
fn write_placeholder(text: &mut String, number: usize) {
    text.clear();
    text.push('z');
    push_number(text, number, DIGITS);
    text.push('z');
}

/// Makes a placeholder the one of another number.
pub fn renumber(placeholder: &mut String, other: impl Fn(usize) -> usize) {
    if let Some((_, Token::Placeholder(number))) = token(placeholder.as_bytes()) {
        write_placeholder(placeholder, other(number));
    }
}

/// A name in the text that is to be replaced.
enum Token {
    /// `z17z`
    Placeholder(usize),
    /// `_e7`
    Result(u32),
}

/// The token at a place in the text, and its length; none in the middle of a name.
fn token_at(text: &[u8], start: usize) -> Option<(usize, Token)> {
    if text[..start].last().is_some_and(is_part) { None } else { token(&text[start..]) }
}

/// The token that a text begins with, and its length.
#[inline]
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
