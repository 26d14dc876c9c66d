//! Names in the emitted text.
//!
//! The text writer renames whatever is used twice in a module, reserved, or ends in a digit. So it
//! is only ever given placeholders (`z17z`), which it leaves alone, and the names of our choice
//! take their place as it writes (see [`Renaming`]).

use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, format_smolstr};
use std::collections::hash_map::Entry;
use std::fmt;
use std::ops::Range;

/// A name that is legal and keeps its meaning: dots of imports become `_`, a trailing digit gets a
/// `_` (tools that import WGSL refuse it otherwise), no leading `_`.
pub fn identifier(name: &str) -> SmolStr {
    if is_identifier(name) {
        return name.into();
    }
    let plain = name.bytes().take_while(u8::is_ascii_alphanumeric).count();
    if plain == name.len() && name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        // It ends in a digit.
        return format_smolstr!("{name}_");
    }
    let mut out = String::with_capacity(name.len() + 2);
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
fn push_number(text: &mut String, number: usize, digits: &[u8]) {
    let mut size = 1;
    while number / size >= digits.len() {
        size *= digits.len();
    }
    while size > 0 {
        text.push(char::from(digits[number / size % digits.len()]));
        size /= digits.len();
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
        let name = identifier(wish);
        if let Some(tried) = self.taken.get(&name) {
            return self.other(name, *tried);
        }
        match self.taken.entry(self.own(name)) {
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
        // No word of the language ends in `_`.
        let is_reserved = || !name.ends_with('_') && is_reserved(&name);
        if is_of_module(&name, &self.module) || is_reserved() {
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

    /// What the writer is given to write to. `results` names the results of calls: `_e7` of the nth
    /// function, which the writer names itself.
    pub fn renaming<'a>(&'a self, results: &'a [FxHashMap<u32, SmolStr>]) -> Renaming<'a> {
        Renaming {
            names: self,
            results,
            // As long as the text of a small graph.
            text: String::with_capacity(8192),
            functions: 0,
            stored: FxHashSet::default(),
            left_out: LeftOut::Nothing,
        }
    }

    /// The name that a token stands for, and how it is declared; `functions` have begun.
    fn meaning<'n>(
        &'n self,
        token: Token,
        results: &'n [FxHashMap<u32, SmolStr>],
        functions: usize,
    ) -> Option<(&'n str, Kind)> {
        match token {
            Token::Placeholder(number) => self.0.get(number).map(|name| (name.text.as_str(), name.kind)),
            Token::Result(number) => {
                let results = results.get(functions.checked_sub(1)?)?;
                results.get(&number).map(|name| (name.as_str(), Kind::Plain))
            }
        }
    }
}

/// Takes what the writer writes, piece by piece; a name is a piece of its own. Placeholders become
/// the names that they stand for.
pub struct Renaming<'a> {
    names: &'a Names,
    results: &'a [FxHashMap<u32, SmolStr>],
    text: String,
    /// How many functions have begun.
    functions: usize,
    /// The placeholders of variables that have been stored to.
    stored: FxHashSet<SmolStr>,
    left_out: LeftOut,
}

/// What is left out of what comes next.
#[derive(Clone, Copy, PartialEq, Eq)]
enum LeftOut {
    Nothing,
    /// The rest of a declaration.
    Line,
    /// The empty line by which the writer parts variables from the rest.
    EmptyLine,
}

impl Renaming<'_> {
    /// The text.
    pub fn finish(self) -> String {
        self.text
    }

    /// What of a piece is not left out.
    fn rest<'p>(&mut self, mut piece: &'p str) -> &'p str {
        if self.left_out == LeftOut::Line {
            let Some((_, behind)) = piece.split_once('\n') else { return "" };
            let is_first = self.text.ends_with("{\n");
            self.left_out = if is_first { LeftOut::EmptyLine } else { LeftOut::Nothing };
            piece = behind;
        }
        if self.left_out == LeftOut::EmptyLine {
            piece = piece.trim_start_matches('\n');
            if !piece.is_empty() {
                self.left_out = LeftOut::Nothing;
            }
        }
        piece
    }

    /// A piece that may be a name, or is left out.
    fn piece(&mut self, piece: &str) {
        let piece = if self.left_out == LeftOut::Nothing { piece } else { self.rest(piece) };
        let names = self.names;
        match token(piece.as_bytes()).and_then(|token| names.meaning(token, self.results, self.functions)) {
            Some((name, kind)) => self.name(piece, name, kind),
            None => self.text.push_str(piece),
        }
    }

    fn name(&mut self, placeholder: &str, name: &str, kind: Kind) {
        self.functions += usize::from(self.text.ends_with("fn "));
        if let Some(before) = kind.undeclared(&self.text) {
            let length = before.trim_end_matches(' ').len();
            self.text.truncate(length);
            self.left_out = LeftOut::Line;
            return;
        }
        if kind == Kind::Stored && self.stored.insert(placeholder.into()) {
            self.text.push_str("var ");
        }
        self.text.push_str(name);
    }
}

impl fmt::Write for Renaming<'_> {
    #[inline]
    fn write_str(&mut self, piece: &str) -> fmt::Result {
        // Most pieces are marks and numbers.
        match piece.as_bytes() {
            _ if self.left_out != LeftOut::Nothing => self.piece(piece),
            [mark] if mark.is_ascii() => self.text.push(char::from(*mark)),
            [b'z' | b'_', ..] => self.piece(piece),
            _ => self.text.push_str(piece),
        }
        Ok(())
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
    if let Some(Token::Placeholder(number)) = token(placeholder.as_bytes()) {
        write_placeholder(placeholder, other(number));
    }
}

/// A name that is to be replaced.
enum Token {
    /// `z17z`
    Placeholder(usize),
    /// `_e7`
    Result(u32),
}

/// The token that a text is.
#[inline]
fn token(text: &[u8]) -> Option<Token> {
    let (digits, is_placeholder) = match text {
        [b'z', digits @ .., b'z'] => (digits, true),
        [b'_', b'e', digits @ ..] => (digits, false),
        _ => return None,
    };
    let add = |number: u32, digit: &u8| {
        digit.is_ascii_digit().then(|| number.wrapping_mul(10).wrapping_add(u32::from(digit - b'0')))
    };
    let number = digits.iter().try_fold(0, add).filter(|_| !digits.is_empty())?;
    Some(if is_placeholder { Token::Placeholder(number as usize) } else { Token::Result(number) })
}

/// Whether a byte can stand in a name.
fn is_part(byte: &u8) -> bool {
    byte.is_ascii_alphanumeric() || *byte == b'_'
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write as _;

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
        let mut renaming = names.renaming(&[]);
        write!(renaming, "let {cell} = 1e-3f + {at}.x * 0x1fu;").unwrap();
        assert_eq!(renaming.finish(), "let cell = 1e-3f + at.x * 0x1fu;");
    }

    #[test]
    fn aliases_are_written_as_what_they_stand_for() {
        let mut names = Names::default();
        let variable = names.placeholder("sum");
        let value = names.alias("sum");
        let next = names.placeholder("next");
        let mut renaming = names.renaming(&[]);
        write!(renaming, "{{\n    let {value} = {variable};\n    let {next} = {value} + 1;\n}}\n").unwrap();
        assert_eq!(renaming.finish(), "{\n    let next = sum + 1;\n}\n");
    }

    #[test]
    fn variables_are_declared_where_they_are_first_stored_to() {
        let mut names = Names::default();
        let sum = names.stored("sum");
        let mut renaming = names.renaming(&[]);
        write!(renaming, "{{\n    var {sum}: f32;\n\n    {sum} = 1f;\n    {sum} = {sum} + 1f;\n}}\n")
            .unwrap();
        assert_eq!(renaming.finish(), "{\n    var sum = 1f;\n    sum = sum + 1f;\n}\n");
    }
}
