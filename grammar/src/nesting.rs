//! The limit on nesting, checked on the tokens before anything recurses over the text.
//!
//! Every later stage (pest, the tree and its drop, the compiler's walks) may recurse once or a few
//! times a level, so the levels are bounded here, by a count that is the same on every thread and
//! in every build. A level is
//!
//! - an open bracket;
//! - an `if` or a `fold` until its own `{` takes the level over, which bounds `if if if …`;
//! - each further `else if` of a chain, while the chain lasts;
//! - each `-` or `!` of a row of prefixes, until their operand ends.

use crate::error::{SyntaxError, SyntaxErrorKind};
use crate::scan::{Scan, Token, TokenKind};

/// The deepest nesting that is read.
pub const MAX_NESTING: usize = 128;

/// Something that is open.
#[derive(Clone, Copy)]
struct Level {
    kind: LevelKind,
    /// How many levels it counts for.
    weight: usize,
    /// The prefixes before it, which apply to all of it.
    prefixes: usize,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum LevelKind {
    Bracket,
    /// `if` before its `{`.
    If,
    /// The braces of an `if`, with which an `else` may follow.
    Arm,
    /// `fold` before its `{`.
    Fold,
}

/// Checks a run of tokens; the error points at the first token that is too deep.
pub(crate) fn check(scan: &Scan<'_>, tokens: &[Token]) -> Result<(), SyntaxError> {
    let mut counter = Counter::default();
    for token in tokens {
        let text = scan.source.as_bytes().get(token.span.range()).unwrap_or_default();
        counter.step(token.kind, text);
        if counter.depth + counter.prefixes > MAX_NESTING {
            return Err(SyntaxError::new(SyntaxErrorKind::TooDeep, token.span));
        }
    }
    Ok(())
}

#[derive(Default)]
struct Counter {
    levels: Vec<Level>,
    /// The weights of all levels.
    depth: usize,
    /// The prefixes of the operand that is being read.
    prefixes: usize,
    /// Whether an operand stands before this token, so that a `-` would be a subtraction.
    after_operand: bool,
    /// The weight of the arm that the last token closed.
    closed_arm: Option<usize>,
    /// The same, when the last token is the `else` behind it.
    after_else: Option<usize>,
}

impl Counter {
    fn step(&mut self, kind: TokenKind, text: &[u8]) {
        let closed_arm = self.closed_arm.take();
        let after_else = self.after_else.take();
        let mut is_operand = false;
        match kind {
            TokenKind::Open if text == b"{" => self.open_brace(after_else),
            TokenKind::Open => self.open(LevelKind::Bracket, 1),
            TokenKind::Close => {
                self.close();
                is_operand = true;
            }
            TokenKind::Word => match text {
                b"if" => self.open(LevelKind::If, 1 + after_else.unwrap_or(0)),
                b"fold" => self.open(LevelKind::Fold, 1),
                b"else" => self.after_else = closed_arm,
                b"let" | b"for" | b"in" | b"while" | b"use" | b"param" => self.prefixes = 0,
                _ => is_operand = true,
            },
            TokenKind::Symbol => match text {
                b"-" | b"!" if !self.after_operand => self.prefixes += 1,
                b"." => {}
                _ => self.prefixes = 0,
            },
            TokenKind::Unknown => self.prefixes = 0,
            TokenKind::Number | TokenKind::Text | TokenKind::Color => is_operand = true,
        }
        self.after_operand = is_operand;
    }

    fn open(&mut self, kind: LevelKind, weight: usize) {
        // The prefixes become part of the level, for they apply to what is inside.
        let level = Level { kind, weight: weight + self.prefixes, prefixes: self.prefixes };
        self.prefixes = 0;
        self.depth += level.weight;
        self.levels.push(level);
    }

    fn open_brace(&mut self, after_else: Option<usize>) {
        match (after_else, self.levels.last_mut()) {
            (Some(weight), _) => self.open(LevelKind::Bracket, weight),
            (_, Some(level)) if level.kind == LevelKind::If => level.kind = LevelKind::Arm,
            (_, Some(level)) if level.kind == LevelKind::Fold => level.kind = LevelKind::Bracket,
            _ => self.open(LevelKind::Bracket, 1),
        }
        self.prefixes = 0;
    }

    fn close(&mut self) {
        while let Some(level) = self.levels.pop() {
            self.depth -= level.weight;
            self.prefixes = level.prefixes;
            if level.kind == LevelKind::Arm {
                self.closed_arm = Some(level.weight - level.prefixes);
            }
            if matches!(level.kind, LevelKind::Arm | LevelKind::Bracket) {
                break;
            }
        }
    }
}
