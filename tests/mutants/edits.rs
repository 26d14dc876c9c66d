//! Edits of one place that a person makes by mistake, and the tokens that they touch.

use std::ops::Range;

/// The same numbers on every machine.
pub struct Random(pub u64);

impl Random {
    /// A number from 0 to one below the limit.
    pub fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % limit.max(1)
    }

    fn pick<'a, T>(&mut self, all: &'a [T]) -> Option<&'a T> {
        all.get(self.below(all.len()))
    }
}

/// Bytes of a text with what replaces them.
pub struct Edit {
    pub range: Range<usize>,
    pub replacement: String,
}

impl Edit {
    fn new(range: Range<usize>, replacement: impl Into<String>) -> Edit {
        Edit { range, replacement: replacement.into() }
    }

    /// The text after the edit.
    pub fn apply(&self, text: &str) -> String {
        [&text[..self.range.start], &self.replacement, &text[self.range.end..]].concat()
    }

    /// The tokens of the edited text that were edited, or are what is left of one that was; where
    /// nothing is left, those before and behind.
    pub fn places(&self, original: &str, edited: &str) -> Vec<Range<usize>> {
        let old = tokens(original);
        let old = old.iter().filter(|token| touches(token, &self.range));
        let whole = old
            .fold(self.range.clone(), |whole, token| whole.start.min(token.start)..whole.end.max(token.end));
        let end = whole.end - self.range.len() + self.replacement.len();
        let (whole, tokens) = (whole.start..end, tokens(edited));
        let inside: Vec<Range<usize>> =
            tokens.iter().filter(|token| touches(token, &whole)).cloned().collect();
        if !inside.is_empty() {
            return inside;
        }
        let before = tokens.iter().rev().find(|token| token.end <= whole.start);
        let behind = tokens.iter().find(|token| token.start >= whole.end);
        before.into_iter().chain(behind).cloned().collect()
    }
}

/// Whether a stretch shares bytes with a token, or lies within it where it is empty.
fn touches(token: &Range<usize>, stretch: &Range<usize>) -> bool {
    token.start < stretch.end && stretch.start < token.end
}

/// Makes an edit of a text with these tokens; none where the text has no place for it.
type Make = fn(&str, &[Range<usize>], &mut Random) -> Option<Edit>;

/// Every kind of edit.
pub const EDITS: [(&str, Make); 13] = [
    ("delete a character", delete_character),
    ("insert a character", insert_character),
    ("replace a character", replace_character),
    ("transpose two characters", transpose_characters),
    ("delete a token", delete_token),
    ("duplicate a token", duplicate_token),
    ("swap two tokens", swap_tokens),
    ("misspell a name", misspell),
    ("replace a name by another", rename),
    ("drop an argument", drop_argument),
    ("swap two arguments", swap_arguments),
    ("another type of literal", other_literal),
    ("delete a line", delete_line),
];

/// What a slip of the finger types.
const KEYS: &[u8] = b"abcdefghijklmnopqrstuvwxyz0123456789_.,;:()[]{}<>+-*/=|&\"# ";

fn key(random: &mut Random) -> String {
    random.pick(KEYS).map(|key| char::from(*key).to_string()).unwrap_or_default()
}

/// The range of one character of a token.
fn character(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Range<usize>> {
    let token = random.pick(tokens)?;
    let characters: Vec<(usize, char)> = text[token.clone()].char_indices().collect();
    let (at, character) = random.pick(&characters)?;
    Some(token.start + at..token.start + at + character.len_utf8())
}

fn delete_character(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Edit> {
    Some(Edit::new(character(text, tokens, random)?, ""))
}

fn insert_character(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Edit> {
    let at = character(text, tokens, random)?;
    let at = if random.below(2) == 0 { at.start } else { at.end };
    Some(Edit::new(at..at, key(random)))
}

fn replace_character(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Edit> {
    let at = character(text, tokens, random)?;
    Some(Edit::new(at, key(random)))
}

fn transpose_characters(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Edit> {
    let first = character(text, tokens, random)?;
    let second = text[first.end..].chars().next()?;
    let swapped = format!("{second}{}", &text[first.clone()]);
    Some(Edit::new(first.start..first.end + second.len_utf8(), swapped))
}

fn delete_token(_: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Edit> {
    Some(Edit::new(random.pick(tokens)?.clone(), ""))
}

fn duplicate_token(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Edit> {
    // Nobody can tell which of the two was there before.
    let token = random.pick(tokens)?.clone();
    let old = &text[token.clone()];
    let gap = if old.starts_with(is_word) { " " } else { "" };
    Some(Edit::new(token, format!("{old}{gap}{old}")))
}

fn swap_tokens(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Edit> {
    let at = random.below(tokens.len());
    let (first, second) = (tokens.get(at)?, tokens.get(at + 1)?);
    swap(text, first, second)
}

/// Two stretches in each other's place.
fn swap(text: &str, first: &Range<usize>, second: &Range<usize>) -> Option<Edit> {
    let parts = [second.clone(), first.end..second.start, first.clone()];
    let swapped: String = parts.into_iter().filter_map(|part| text.get(part)).collect();
    Some(Edit::new(first.start..second.end, swapped))
}

/// A name, and nothing that is a keyword.
fn name(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Range<usize>> {
    let names: Vec<&Range<usize>> = tokens.iter().filter(|token| is_name(&text[(*token).clone()])).collect();
    random.pick(&names).map(|token| (*token).clone())
}

fn is_name(token: &str) -> bool {
    const KEYWORDS: [&str; 13] = [
        "use", "let", "param", "node", "texture", "if", "else", "fold", "for", "in", "while", "true", "false",
    ];
    let first = token.chars().next().is_some_and(|c| is_word(c) && !c.is_ascii_digit());
    first && !KEYWORDS.contains(&token)
}

/// One use of a name with another ending or beginning.
fn misspell(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Edit> {
    let token = name(text, tokens, random)?;
    let old = &text[token.clone()];
    let new = match random.below(4) {
        0 => format!("{old}s"),
        1 => format!("{old}2"),
        2 => format!("my_{old}"),
        _ => old.replacen(['a', 'e', 'i', 'o', 'u'], "", 1),
    };
    Some(Edit::new(token, if new.is_empty() { "it".to_owned() } else { new }))
}

/// One use of a name with another name of the text.
fn rename(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Edit> {
    let (token, other) = (name(text, tokens, random)?, name(text, tokens, random)?);
    Some(Edit::new(token, &text[other]))
}

/// The arguments, inputs or elements between one pair of brackets.
fn arguments(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Vec<Range<usize>>> {
    let opens: Vec<usize> = (0..tokens.len()).filter(|i| "([".contains(&text[tokens[*i].clone()])).collect();
    let open = *random.pick(&opens)?;
    let (mut depth, mut start, mut found) = (0, open + 1, Vec::new());
    for (i, token) in tokens.iter().enumerate().skip(open) {
        let text = &text[token.clone()];
        let ends = depth == 1 && matches!(text, "," | ")" | "]" | "}");
        if ends && start < i {
            found.push(tokens[start].start..tokens[i - 1].end);
            start = i + 1;
        }
        depth += i32::from(matches!(text, "(" | "[" | "{")) - i32::from(matches!(text, ")" | "]" | "}"));
        if depth == 0 {
            break;
        }
    }
    Some(found)
}

fn drop_argument(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Edit> {
    let arguments = arguments(text, tokens, random)?;
    let at = random.below(arguments.len());
    let argument = arguments.get(at)?.clone();
    // The comma goes with it.
    match (at.checked_sub(1).and_then(|before| arguments.get(before)), arguments.get(at + 1)) {
        (_, Some(next)) => Some(Edit::new(argument.start..next.start, "")),
        (Some(before), None) => Some(Edit::new(before.end..argument.end, "")),
        (None, None) => Some(Edit::new(argument, "")),
    }
}

fn swap_arguments(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Edit> {
    let arguments = arguments(text, tokens, random)?;
    let at = random.below(arguments.len().checked_sub(1)?);
    swap(text, arguments.get(at)?, arguments.get(at + 1)?)
}

fn other_literal(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Edit> {
    let is_literal = |token: &&Range<usize>| {
        let text = &text[(*token).clone()];
        text.starts_with(|c: char| c.is_ascii_digit() || c == '"' || c == '#')
            || matches!(text, "true" | "false")
    };
    let literals: Vec<&Range<usize>> = tokens.iter().filter(is_literal).collect();
    let token = (*random.pick(&literals)?).clone();
    let old = &text[token.clone()];
    let new = match random.below(5) {
        0 if old.starts_with('"') => old.trim_matches('"').to_owned(),
        0 => format!("\"{old}\""),
        1 => "true".to_owned(),
        2 => "#ff8000".to_owned(),
        3 => "1.5".to_owned(),
        _ => "3".to_owned(),
    };
    Some(Edit::new(token, new))
}

fn delete_line(text: &str, tokens: &[Range<usize>], random: &mut Random) -> Option<Edit> {
    let token = random.pick(tokens)?;
    let start = text[..token.start].rfind('\n').map_or(0, |end| end + 1);
    let end = text[token.start..].find('\n').map_or(text.len(), |end| token.start + end + 1);
    Some(Edit::new(start..end, ""))
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Marks of more than one character, the longest first.
const MARKS: [&str; 10] = ["..=", "..", "->", "==", "!=", "<=", ">=", "&&", "||", "=>"];

/// The tokens of a text: words, numbers, strings, colours and marks, without blanks and comments.
pub fn tokens(text: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let length = match first {
            _ if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            _ if rest.starts_with("/*") => comment(rest),
            '"' => string(rest),
            '#' => 1 + word(&rest[1..]),
            '0'..='9' => number(rest),
            _ if is_word(first) => word(rest),
            _ => {
                let mark = MARKS.iter().find(|mark| rest.starts_with(**mark));
                mark.map_or(first.len_utf8(), |mark| mark.len())
            }
        };
        let is_comment = rest.starts_with("//") || rest.starts_with("/*");
        if !is_comment && !first.is_whitespace() {
            found.push(at..at + length);
        }
        at += length;
    }
    found
}

/// Block comments nest.
fn comment(text: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < text.len() {
        let step = match text.as_bytes().get(at..at + 2) {
            Some(b"/*") => 1,
            Some(b"*/") => -1,
            _ => 0,
        };
        depth += step;
        at += if step == 0 { 1 } else { 2 };
        if depth == 0 {
            return at;
        }
    }
    text.len()
}

fn word(text: &str) -> usize {
    text.find(|c| !is_word(c)).unwrap_or(text.len())
}

fn number(text: &str) -> usize {
    let whole = word(text);
    match text[whole..].strip_prefix('.') {
        Some(rest) if rest.starts_with(|c: char| c.is_ascii_digit()) => whole + 1 + word(rest),
        _ => whole,
    }
}

/// A string ends on its line.
fn string(text: &str) -> usize {
    let line = text.find('\n').unwrap_or(text.len());
    text[1..line].find('"').map_or(line, |end| end + 2)
}
