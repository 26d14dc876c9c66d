//! One linear look at the text before pest sees it.
//!
//! The scan cuts the text into tokens and comments. The tokens are only rough (`3y` is a number
//! here): pest decides what is right, and the tokens serve what pest cannot do, which is to bound
//! the nesting beforehand ([`crate::nesting`]), to find where items begin
//! ([`crate::recover`]) and to name the culprit afterwards ([`crate::diagnose`]).
//! The scan itself reports what would hide the rest of the text: an unclosed comment or string.

use crate::error::{SyntaxError, SyntaxErrorKind};
use crate::nesting::MAX_NESTING;
use crate::syntax::{Comment, CommentKind, Span};

/// The largest text that is read: 1 MiB.
pub const MAX_BYTES: usize = 1 << 20;

/// A token, roughly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Token {
    pub kind: TokenKind,
    pub span: Span,
}

/// What a token looks like from its first character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TokenKind {
    /// A name or a keyword.
    Word,
    /// Begins with a digit.
    Number,
    /// Begins with `"`.
    Text,
    /// Begins with `#`.
    Color,
    /// `(`, `[`, `{`
    Open,
    /// `)`, `]`, `}`
    Close,
    /// Operators and marks.
    Symbol,
    /// One character that begins no token.
    Unknown,
}

/// What the scan has found, in source order.
pub(crate) struct Scan<'s> {
    pub source: &'s str,
    pub tokens: Vec<Token>,
    pub comments: Vec<Comment>,
    pub errors: Vec<SyntaxError>,
}

impl<'s> Scan<'s> {
    /// The token's text.
    pub fn text(&self, token: Token) -> &'s str {
        self.source.get(token.span.range()).unwrap_or_default()
    }

    /// The text of the token at an index; nothing behind the last one.
    pub fn text_of(&self, index: usize) -> &'s str {
        self.tokens.get(index).map_or("", |token| self.text(*token))
    }

    /// How many bytes stand before a token on its line.
    pub fn column(&self, index: usize) -> usize {
        let start = self.tokens.get(index).map_or(0, |token| token.span.start as usize);
        let before = self.source.get(..start).unwrap_or_default();
        start - before.rfind('\n').map_or(0, |end| end + 1)
    }
}

/// Marks of more than one character, the longest first.
const SYMBOLS: [&str; 17] =
    ["..=", "..", "->", "=>", "==", "!=", "<=", ">=", "&&", "||", "+=", "-=", "*=", "/=", "::", "++", "**"];

/// Scans a text of at most [`MAX_BYTES`] bytes.
pub(crate) fn scan(source: &str) -> Result<Scan<'_>, SyntaxError> {
    if source.len() > MAX_BYTES {
        return Err(SyntaxError::new(SyntaxErrorKind::FileTooLarge, beyond_limit(source)));
    }
    let tokens = Vec::with_capacity(source.len() / 4);
    let scan = Scan { source, tokens, comments: Vec::new(), errors: Vec::new() };
    let mut scanner = Scanner { scan, bytes: source.as_bytes(), at: 0 };
    while scanner.at < scanner.bytes.len() {
        scanner.step();
    }
    Ok(scanner.scan)
}

/// The first character that is too much.
fn beyond_limit(source: &str) -> Span {
    let start = source.floor_char_boundary(MAX_BYTES);
    let length = source[start..].chars().next().map_or(0, char::len_utf8);
    Span::new(start, start + length)
}

struct Scanner<'s> {
    scan: Scan<'s>,
    bytes: &'s [u8],
    at: usize,
}

impl Scanner<'_> {
    /// Reads one token, one comment or white space.
    fn step(&mut self) {
        let start = self.at;
        match self.bytes[start] {
            b' ' | b'\t' | b'\r' | b'\n' => self.skip(|byte| matches!(byte, b' ' | b'\t' | b'\r' | b'\n')),
            b'/' if self.looking_at("//") => self.line_comment(),
            b'/' if self.looking_at("/*") => self.block_comment(),
            b'"' => self.text(),
            b'#' => self.color(),
            b'0'..=b'9' => self.number(),
            b'(' | b'[' | b'{' => self.mark(TokenKind::Open, 1),
            b')' | b']' | b'}' => self.mark(TokenKind::Close, 1),
            byte if is_word(byte) => {
                self.skip_word();
                self.push(TokenKind::Word, start);
            }
            _ => self.symbol(),
        }
    }

    fn looking_at(&self, text: &str) -> bool {
        self.bytes[self.at..].starts_with(text.as_bytes())
    }

    fn byte(&self, offset: usize) -> u8 {
        self.bytes.get(self.at + offset).copied().unwrap_or(0)
    }

    fn push(&mut self, kind: TokenKind, start: usize) {
        self.scan.tokens.push(Token { kind, span: Span::new(start, self.at) });
    }

    fn mark(&mut self, kind: TokenKind, length: usize) {
        let start = self.at;
        self.at += length;
        self.push(kind, start);
    }

    fn fail(&mut self, kind: SyntaxErrorKind, start: usize, end: usize) {
        self.scan.errors.push(SyntaxError::new(kind, Span::new(start, end)));
    }

    #[inline]
    fn skip(&mut self, is_in: impl Fn(u8) -> bool) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().position(|byte| !is_in(*byte)).unwrap_or(rest.len());
    }

    fn skip_word(&mut self) {
        self.skip(is_word);
    }

    fn line_end(&self) -> usize {
        let rest = &self.bytes[self.at..];
        self.at + rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len())
    }

    fn line_comment(&mut self) {
        let kind = match (self.byte(2), self.byte(3)) {
            (b'!', _) => CommentKind::FileDoc,
            // A row of slashes is a ruler, not documentation.
            (b'/', after) if after != b'/' => CommentKind::Doc,
            _ => CommentKind::Line,
        };
        let start = self.at;
        self.at = self.line_end();
        self.comment(kind, start);
    }

    fn comment(&mut self, kind: CommentKind, start: usize) {
        self.scan.comments.push(Comment { span: Span::new(start, self.at), kind });
    }

    fn block_comment(&mut self) {
        let start = self.at;
        let mut depth = 0;
        let mut too_deep = None;
        loop {
            if self.at >= self.bytes.len() {
                self.fail(SyntaxErrorKind::UnclosedComment, start, start + 2);
                break;
            }
            if self.looking_at("/*") {
                depth += 1;
                if depth == MAX_NESTING + 1 {
                    too_deep.get_or_insert(self.at);
                }
                self.at += 2;
            } else if self.looking_at("*/") {
                depth -= 1;
                self.at += 2;
            } else {
                self.at += 1;
            }
            if depth == 0 {
                break;
            }
        }
        if let Some(place) = too_deep {
            self.fail(SyntaxErrorKind::TooDeep, place, place + 2);
        }
        self.comment(CommentKind::Block, start);
    }

    fn text(&mut self) {
        let start = self.at;
        let end = self.line_end();
        self.at += 1;
        while self.at < end && self.bytes[self.at] != b'"' {
            self.at += if self.bytes[self.at] == b'\\' { 2 } else { 1 };
        }
        if self.at < end {
            self.at += 1;
        } else {
            self.at = end;
            let length = self.scan.source[start..end].trim_end().len();
            self.fail(SyntaxErrorKind::UnclosedText, start, start + length);
        }
        self.push(TokenKind::Text, start);
    }

    fn color(&mut self) {
        let start = self.at;
        self.at += 1;
        self.skip_word();
        self.push(TokenKind::Color, start);
    }

    fn number(&mut self) {
        let start = self.at;
        self.skip_word();
        // Not the first dot of a range, and not a method of an int.
        if self.byte(0) == b'.' && self.byte(1).is_ascii_digit() {
            self.at += 1;
            self.skip_word();
        }
        let exponent = matches!(self.bytes[self.at - 1], b'e' | b'E');
        if exponent && matches!(self.byte(0), b'+' | b'-') && self.byte(1).is_ascii_digit() {
            self.at += 1;
            self.skip_word();
        }
        self.push(TokenKind::Number, start);
    }

    fn symbol(&mut self) {
        // Most marks are single.
        let is_long = matches!(self.byte(1), b'.' | b'>' | b'=' | b'&' | b'|' | b':' | b'+' | b'*');
        if is_long && let Some(symbol) = SYMBOLS.iter().find(|symbol| self.looking_at(symbol)) {
            return self.mark(TokenKind::Symbol, symbol.len());
        }
        match self.bytes[self.at] {
            b'+' | b'-' | b'*' | b'/' | b'%' | b'<' | b'>' | b'=' | b'!' | b'|' | b',' | b':' | b';'
            | b'.' => self.mark(TokenKind::Symbol, 1),
            _ => {
                let rest = &self.scan.source[self.at..];
                self.mark(TokenKind::Unknown, rest.chars().next().map_or(1, char::len_utf8));
            }
        }
    }
}

/// The bytes that words are made of, by their number.
static WORD: [bool; 256] = {
    let mut word = [false; 256];
    let mut byte = 0;
    while byte < 256 {
        word[byte] = (byte as u8).is_ascii_alphanumeric() || byte as u8 == b'_';
        byte += 1;
    }
    word
};

fn is_word(byte: u8) -> bool {
    WORD[usize::from(byte)]
}
