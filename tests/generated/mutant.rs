//! Mutants of real programs: a few small edits of their tokens, lines and bytes.

use super::choices::Choices;
use std::ops::Range;

/// What is inserted, beside tokens of the programs themselves.
const TOKENS: &[&str] = &[
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
    "as",
    "max",
    "tiles",
    "none",
    "given",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "<",
    ">",
    ",",
    ":",
    "->",
    ".",
    "..",
    "..=",
    "|",
    "||",
    "&&",
    "==",
    "!=",
    "<=",
    ">=",
    "=",
    "+",
    "-",
    "*",
    "/",
    "%",
    "!",
    "n",
    "uv",
    "dx",
    "hash",
    "vec2",
    "ivec3",
    "float",
    "int",
    "bool",
    "color",
    "image",
    "patterns",
    "indices",
    "permutation",
    "mat2",
    "\"a.png\"",
    "#fff",
    "#12345678",
    "///",
    "//",
    "/*",
    "*/",
    "//!",
    ";",
    "=>",
    "?",
    "'",
    "\"",
    "\\",
    "@",
];

/// Numbers at and over the edges.
const NUMBERS: &[&str] = &[
    "0",
    "1",
    "-1",
    "2147483647",
    "2147483648",
    "4294967296",
    "18446744073709551616",
    "0.0",
    "1e38",
    "1e39",
    "1e-46",
    "90deg",
    "3y",
    "1.",
    ".5",
    "1e",
    "65536",
    "257",
    "4097",
    "00",
    "1e999999999",
];

/// Characters that texts rarely hold.
const ODD: &[char] =
    &['\0', '\r', '\t', '\u{feff}', '\u{2028}', '\u{202e}', 'é', '漢', '🌿', '\u{301}', '\u{7f}', '`', '~'];

/// A mutant of one of some texts: which one, and the text. The texts are not empty.
pub fn mutant(choices: &mut Choices, texts: &[&str]) -> (usize, String) {
    let which = choices.below(texts.len());
    let mut text = texts[which].to_owned();
    for _ in 0..*choices.pick(&[1, 1, 1, 2, 3, 5]) {
        text = match choices.below(10) {
            0..6 => tokens_edited(choices, &text, texts),
            6 | 7 => lines_edited(choices, &text, texts),
            _ => bytes_edited(choices, &text),
        };
    }
    (which, text)
}

/// The tokens of a text: words and numbers, strings, comments, marks of one or two characters, and
/// what stands between them. Roughly the language's: what is no token in it is one here.
pub fn tokens(text: &str) -> Vec<Range<usize>> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let start = text.len() - rest.len();
        let length = length(rest, first);
        tokens.push(start..start + length);
        rest = &rest[length..];
    }
    tokens
}

/// The length of the token that a text begins with.
fn length(rest: &str, first: char) -> usize {
    let run = |holds: fn(char) -> bool| rest.find(|c| !holds(c)).unwrap_or(rest.len());
    let until = |end: &str| rest.find(end).map_or(rest.len(), |at| at + end.len());
    match first {
        _ if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
        _ if rest.starts_with("/*") => until("*/"),
        '"' => rest[1..].find('"').map_or(rest.len(), |at| at + 2),
        c if c.is_whitespace() => run(char::is_whitespace),
        c if c.is_alphanumeric() || c == '_' || c == '#' => {
            let behind = first.len_utf8();
            let end = rest[behind..].find(|c: char| !c.is_alphanumeric() && c != '_');
            end.map_or(rest.len(), |end| behind + end)
        }
        _ if ["->", "..", "||", "&&", "==", "!=", "<=", ">="].iter().any(|mark| rest.starts_with(mark)) => 2,
        c => c.len_utf8(),
    }
}

/// A token that is no white space; none in an empty text.
fn token(choices: &mut Choices, text: &str) -> Option<Range<usize>> {
    let tokens = tokens(text);
    let solid: Vec<&Range<usize>> =
        tokens.iter().filter(|range| !text[(*range).clone()].trim().is_empty()).collect();
    if solid.is_empty() { None } else { Some((*choices.pick(&solid)).clone()) }
}

fn replaced(text: &str, range: Range<usize>, by: &str) -> String {
    [&text[..range.start], by, &text[range.end..]].concat()
}

fn tokens_edited(choices: &mut Choices, text: &str, texts: &[&str]) -> String {
    let Some(at) = token(choices, text) else { return text.to_owned() };
    let this = &text[at.clone()];
    match choices.below(17) {
        0 => replaced(text, at, ""),
        1 => replaced(text, at.clone(), &[this, " ", this].concat()),
        2 | 3 | 12.. => {
            // A name for a name, a mark for a mark: what often still parses.
            let kind = |text: &str| text.chars().next().map(|c| (c.is_alphabetic(), c.is_numeric()));
            let alike: Vec<Range<usize>> =
                tokens(text).into_iter().filter(|other| kind(&text[other.clone()]) == kind(this)).collect();
            let other = choices.pick(&alike).clone();
            replaced(text, at, &text[other])
        }
        4 => {
            let other = *choices.pick(texts);
            let Some(range) = token(choices, other) else { return text.to_owned() };
            replaced(text, at, &other[range])
        }
        5 => swapped(choices, text, at),
        6 | 7 => replaced(text, at.start..at.start, &[*choices.pick(TOKENS), " "].concat()),
        8 | 9 => {
            let list = if choices.chance(50) { TOKENS } else { NUMBERS };
            let by = *choices.pick(list);
            replaced(text, at, by)
        }
        10 => {
            let depth = *choices.pick(&[1, 2, 40, 127, 200]);
            let (open, close) = *choices.pick(&[("(", ")"), ("-", ""), ("abs(", ")"), ("[", "]"), ("!", "")]);
            let inner = [&open.repeat(depth), this, &close.repeat(depth)].concat();
            replaced(text, at, &inner)
        }
        _ => {
            let between = *choices.pick(&["// c\n", "/* c */", "\n\n\n", "/// c\n", "//! c\n", " ", "\r\n"]);
            replaced(text, at.start..at.start, between)
        }
    }
}

/// Two tokens in each other's place.
fn swapped(choices: &mut Choices, text: &str, one: Range<usize>) -> String {
    let Some(two) = token(choices, text) else { return text.to_owned() };
    let (first, last) = if one.start <= two.start { (one, two) } else { (two, one) };
    if first.end > last.start {
        return text.to_owned();
    }
    let parts = [
        &text[..first.start],
        &text[last.clone()],
        &text[first.end..last.start],
        &text[first],
        &text[last.end..],
    ];
    parts.concat()
}

fn lines_edited(choices: &mut Choices, text: &str, texts: &[&str]) -> String {
    let mut lines: Vec<&str> = text.split_inclusive('\n').collect();
    if lines.is_empty() {
        return String::new();
    }
    let at = choices.below(lines.len());
    match choices.below(5) {
        0 => {
            lines.remove(at);
        }
        1 => lines.insert(at, lines[at]),
        2 => {
            let line = lines.remove(at);
            lines.insert(choices.below(lines.len() + 1), line);
        }
        3 => {
            let other: Vec<&str> = choices.pick(texts).split_inclusive('\n').collect();
            lines.truncate(at);
            if !other.is_empty() {
                lines.extend(&other[choices.below(other.len())..]);
            }
        }
        _ => lines.truncate(at),
    }
    lines.concat()
}

fn bytes_edited(choices: &mut Choices, text: &str) -> String {
    let mut bytes = text.as_bytes().to_vec();
    let at = choices.below(bytes.len().clamp(1, 65_536));
    let end = (at + 1 + choices.below(16)).min(bytes.len());
    match choices.below(5) {
        _ if bytes.is_empty() => {}
        0 => bytes[at] ^= 1 << choices.below(8),
        1 => {
            bytes.drain(at..end);
        }
        2 => {
            let again = bytes[at..end].to_vec();
            bytes.splice(at..at, again);
        }
        3 => {
            let mut buffer = [0; 4];
            let odd = choices.pick(ODD).encode_utf8(&mut buffer).as_bytes().to_vec();
            bytes.splice(at..at, odd);
        }
        _ => bytes.truncate(at),
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
