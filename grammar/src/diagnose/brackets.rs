//! Brackets: not closed, not opened, apart from their name, or holding too much.

use super::{Guess, Place};
use crate::error::{SyntaxError, SyntaxErrorKind as Kind};
use crate::recover::{is_first_of_line, is_item_keyword};
use crate::scan::{Scan, Token, TokenKind};
use std::ops::Range;

/// The innermost bracket that is open behind some tokens.
fn open_bracket(scan: &Scan<'_>, tokens: Range<usize>) -> Option<Token> {
    let mut open = Vec::new();
    for token in scan.tokens.get(tokens)? {
        match token.kind {
            TokenKind::Open => open.push(*token),
            TokenKind::Close => {
                open.pop();
            }
            _ => {}
        }
    }
    open.pop()
}

/// The brackets that belong together, by the opening one.
fn pair(open: &str) -> (char, char) {
    match open {
        "(" => ('(', ')'),
        "[" => ('[', ']'),
        _ => ('{', '}'),
    }
}

impl Place<'_, '_> {
    /// The innermost bracket that is open here.
    pub(super) fn open_bracket(&self) -> Option<Token> {
        open_bracket(self.scan, self.tokens.start..self.index)
    }

    /// Whether a line begins here that can't stand within such brackets.
    fn begins_outside(&self, close: char) -> bool {
        let is_statement = self.text == "let" || (self.is_name(0) && self.text_at(1) == "=");
        let begins = if is_statement { close != '}' } else { is_item_keyword(self.text) };
        begins && is_first_of_line(self.scan, self.index)
    }

    /// The same where pest has read the name of the statement as something else.
    fn is_behind_statement(&self, close: char) -> bool {
        let before = self.index.checked_sub(1);
        let begins = before.is_some_and(|before| is_first_of_line(self.scan, before)) && self.is_name(-1);
        self.text == "=" && close != '}' && begins
    }

    /// A bracket that is not closed before this token, or closes nothing.
    pub(super) fn bracket(&self) -> Guess {
        let open = self.open_bracket();
        let Some(open) = open else {
            return if self.token.kind == TokenKind::Close { self.unopened() } else { None };
        };
        let (_, close) = pair(self.scan.text(open));
        match self.token.kind {
            // A brace is rarely the forgotten one: what meets it closes nothing.
            TokenKind::Close if close == '}' && self.text != "}" => self.unopened(),
            TokenKind::Close if !self.text.starts_with(close) => self.unclosed(open),
            // Where an expression is missing, that is the better thing to say.
            TokenKind::Word if self.begins_outside(close) && !self.expects("an expression") => {
                self.unclosed(open)
            }
            _ if self.index >= self.tokens.end || self.is_behind_statement(close) => self.unclosed(open),
            // A list has no names.
            _ if self.text == ":" && close == ']' && !self.expects("an expression") => self.unclosed(open),
            // The inputs end here.
            _ if self.text == "->" && close == ')' && !self.expects("an expression") => self.unclosed(open),
            _ => None,
        }
    }

    fn unclosed(&self, token: Token) -> Guess {
        if let Some(error) = self.unclosed_by_indentation() {
            return Some(error);
        }
        let (open, close) = pair(self.scan.text(token));
        let error = SyntaxError::new(Kind::Unclosed { open, close }, token.span);
        if self.token.kind == TokenKind::Close && !is_first_of_line(self.scan, self.index) {
            return Some(error.related(Some(self.token.span), "this closes another kind"));
        }
        if self.text == "->" {
            let around = self.span_at(-1).map(|last| last.to(self.token.span));
            return Some(error.related(around, "still open here"));
        }
        let last = self.span_at(-1).filter(|last| *last != token.span);
        Some(error.related(last, "still open after this"))
    }

    /// A brace that is open where a line stands as far to the left as the line that opened it.
    fn unclosed_by_indentation(&self) -> Guess {
        let column = |index: usize| self.scan.column(index);
        let mut line = 0;
        let mut open: Vec<(usize, usize)> = Vec::new();
        for index in self.tokens.start..self.index {
            let token = self.scan.tokens.get(index)?;
            let begins_line = is_first_of_line(self.scan, index);
            line = if begins_line { column(index) } else { line };
            let innermost = open.last().copied().filter(|(brace, _)| self.scan.text_of(*brace) == "{");
            match (token.kind, innermost) {
                (TokenKind::Close, _) => drop(open.pop()),
                (_, Some((brace, indentation))) if begins_line && line <= indentation => {
                    let brace = self.scan.tokens.get(brace)?.span;
                    let error = SyntaxError::new(Kind::Unclosed { open: '{', close: '}' }, brace);
                    return Some(error.related(Some(token.span), "still open before this line"));
                }
                (TokenKind::Open, _) => open.push((index, line)),
                _ => {}
            }
        }
        None
    }

    pub(super) fn unopened(&self) -> Guess {
        self.here(Kind::Unopened { close: self.text.chars().next()? })
    }

    /// `(a, b)`: brackets that belong to no call hold one expression.
    pub(super) fn group(&self) -> Guess {
        let open = self.open_bracket()?;
        let (help, close) = match (self.scan.text(open), self.text) {
            ("(", ",") => {
                ("these brackets belong to no call; a vector is built by its name, `vec2(x, y)`", "`)`")
            }
            ("(", "=") => ("accumulators stand behind `fold`: `fold (a = 0.0) for i in 0..4 { … }`", "`)`"),
            ("[", ",") => ("these brackets hold one index", "`]`"),
            _ => return None,
        };
        let is_full = self.expects(close) && !self.expects("`,`") && !self.expects("an expression");
        let error = is_full.then(|| self.found(vec!["an operator", close], Some(help)))?;
        Some(error.related(Some(open.span), "opened here"))
    }

    /// `f (x)`, `v [i]`
    pub(super) fn space(&self) -> Guess {
        let is_bracket = matches!(self.text, "(" | "[");
        let touches = self.at(-1).is_some_and(|before| before.span.end == self.token.span.start);
        let is_call = is_bracket && self.is_name(-1) && !touches;
        if !is_call || is_first_of_line(self.scan, self.index) || self.expects("`(`") {
            return None;
        }
        let name = self.text_at(-1).to_string();
        let bracket = self.text.chars().next()?;
        let kind = Kind::SpaceBeforeBracket { name, bracket };
        Some(SyntaxError::new(kind, self.span_at(-1)?.to(self.token.span)))
    }
}
