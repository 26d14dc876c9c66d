//! From the place where pest stopped to an error in the reader's words.
//!
//! pest knows how far it came and which rules it tried there. The rough tokens around that place
//! tell the frequent mistakes apart: each has one small function, asked in turn; those about
//! brackets, literals, statements and the habits of other languages have files of their own.
//!
//! Where pest stopped is often one token too late: what is wrong with `uv.x *q weight` is the `q`.
//! So an error shows the token before, too.

mod brackets;
mod habits;
mod literals;
mod statements;

use crate::error::{SyntaxError, SyntaxErrorKind as Kind};
use crate::recover::{is_first_of_line, is_item_keyword};
use crate::scan::{Scan, Token, TokenKind};
use crate::syntax::Span;
use std::ops::Range;

/// Where pest stopped.
pub(crate) struct Failure {
    /// The offset in the file.
    pub at: usize,
    /// What could have stood there, in words; the likeliest first.
    pub expected: Vec<&'static str>,
}

/// The tokens around the place.
struct Place<'a, 's> {
    scan: &'a Scan<'s>,
    /// The piece that was read.
    tokens: Range<usize>,
    /// The token that could not be read.
    index: usize,
    token: Token,
    text: &'s str,
    expected: &'a [&'static str],
}

/// An error, unless this is some other mistake.
type Guess = Option<SyntaxError>;

/// Says what is wrong with a piece that pest could not read.
pub(crate) fn explain(scan: &Scan<'_>, tokens: Range<usize>, failure: Failure) -> SyntaxError {
    let index = scan.tokens.partition_point(|token| token.span.end as usize <= failure.at);
    let place = Place::new(scan, tokens, index, &failure.expected);
    place
        .character()
        .or_else(|| place.preprocessor())
        .or_else(|| place.literal())
        .or_else(|| place.group())
        .or_else(|| place.bracket())
        .or_else(|| place.not_in_words())
        .or_else(|| place.space())
        .or_else(|| place.lambda())
        .or_else(|| place.missing_else())
        .or_else(|| place.missing_if())
        .or_else(|| place.side_by_side())
        .or_else(|| place.not_an_assignment())
        .or_else(|| place.keyword())
        .or_else(|| place.end())
        .or_else(|| place.stray_statement())
        .unwrap_or_else(|| place.unexpected())
}

impl<'a, 's> Place<'a, 's> {
    fn new(
        scan: &'a Scan<'s>,
        tokens: Range<usize>,
        index: usize,
        expected: &'a [&'static str],
    ) -> Place<'a, 's> {
        // Behind the last token stands nothing, which is no mark that anything would ask for.
        let end = Span::new(scan.source.len(), scan.source.len());
        let end = Token { kind: TokenKind::Symbol, span: end };
        let token = scan.tokens.get(index).copied().unwrap_or(end);
        let text = scan.text(token);
        Place { scan, tokens, index, token, text, expected }
    }

    fn here(&self, kind: Kind) -> Guess {
        Some(SyntaxError::new(kind, self.token.span))
    }

    /// The token some places before or after, within the piece.
    fn at(&self, offset: isize) -> Option<Token> {
        let index = self.index.checked_add_signed(offset)?;
        self.scan.tokens.get(index).copied().filter(|_| index >= self.tokens.start)
    }

    /// Where the token some places before or after stands.
    fn span_at(&self, offset: isize) -> Option<Span> {
        self.at(offset).map(|token| token.span)
    }

    fn text_at(&self, offset: isize) -> &'s str {
        self.at(offset).map_or("", |token| self.scan.text(token))
    }

    fn expects(&self, what: &str) -> bool {
        self.expected.contains(&what)
    }

    fn is_name(&self, offset: isize) -> bool {
        let token = self.at(offset);
        token.is_some_and(|token| token.kind == TokenKind::Word && !is_keyword(self.scan.text(token)))
    }

    /// Characters that begin no token.
    fn character(&self) -> Guess {
        if self.text == ";" {
            let open = self.open_bracket();
            let in_brackets = open.is_some_and(|open| self.scan.text(open) != "{");
            return self.here(Kind::Semicolon { in_brackets });
        }
        let character = self.text.chars().next()?;
        match self.token.kind {
            TokenKind::Unknown if character.is_ascii() => self.here(Kind::UnknownCharacter { character }),
            TokenKind::Unknown => self.here(Kind::NonAscii { character }),
            _ => None,
        }
    }

    fn lambda(&self) -> Guess {
        let is_lambda = matches!(self.text, "|" | "||") && self.expects("an expression");
        if is_lambda {
            return self.here(Kind::StrayLambda);
        }
        // `|a, 1.0`
        let is_open = self.expects("`|`") && self.expects("a name");
        let mark = (1..).map_while(|i| self.at(-i)).find(|token| self.scan.text(*token) == "|");
        let mark = mark.filter(|_| is_open)?;
        let error = self.found(self.expected.to_vec(), self.habit());
        Some(error.related(Some(mark.span), "the inputs of a lambda begin here"))
    }

    /// A keyword where a name would have done.
    fn keyword(&self) -> Guess {
        let begins_statement = self.expects("an assignment");
        // What begins a line, an arm or a body was more likely meant as the keyword that it is.
        let is_meant = match begins_statement {
            true => self.text_at(1) != "=",
            false => is_first_of_line(self.scan, self.index) || self.text_at(-1) == "{",
        };
        let could_be_name = begins_statement || self.expects("a name") || self.expects("an expression");
        if !is_keyword(self.text) || !could_be_name || is_meant || self.is_called_texture() {
            return None;
        }
        self.here(Kind::KeywordAsName { keyword: self.text.to_string() })
    }

    /// The text ended; the last token is what there is to show.
    fn end(&self) -> Guess {
        if self.index < self.scan.tokens.len() {
            return None;
        }
        let span = self.span_at(-1).unwrap_or_default();
        Some(SyntaxError::new(Kind::UnexpectedEnd { expected: self.expected.to_vec() }, span))
    }

    fn unexpected(&self) -> SyntaxError {
        let error = self.found(self.expected.to_vec(), self.habit());
        // What stands on the lines before is complete.
        let begins = self.expects("an item") || self.expects("an assignment");
        let is_apart = begins && is_first_of_line(self.scan, self.index);
        if is_apart { error } else { error.related(self.before(), "after this") }
    }

    /// What stands before this token: one token, or those that belong together.
    fn before(&self) -> Option<Span> {
        let last = self.span_at(-1)?;
        let first = match self.text_at(-1) {
            // `q1.0`
            "." => self.span_at(-2),
            // `0.count`
            _ if self.text_at(-2) == "."
                && self.at(-3).is_some_and(|token| token.kind == TokenKind::Number) =>
            {
                self.span_at(-3)
            }
            // `f(x)), y)`: one of them closes too much.
            ")" if self.text == "," => self.first_of_row(),
            _ => None,
        };
        Some(first.map_or(last, |first| first.to(last)))
    }

    /// The first of the closing brackets that stand before this token without a gap.
    fn first_of_row(&self) -> Option<Span> {
        let mut first = self.at(-1)?;
        for offset in 2.. {
            let before = self.at(-offset).filter(|before| before.kind == TokenKind::Close);
            match before.filter(|before| before.span.end == first.span.start) {
                Some(before) => first = before,
                None => break,
            }
        }
        Some(first.span)
    }

    /// This token can't stand where it does.
    fn found(&self, expected: Vec<&'static str>, help: Option<&'static str>) -> SyntaxError {
        let found = match self.token.kind {
            TokenKind::Text => "a string".to_string(),
            _ => format!("`{}`", self.text),
        };
        SyntaxError::new(Kind::Unexpected { found, expected, help }, self.token.span)
    }
}

fn is_keyword(word: &str) -> bool {
    is_item_keyword(word)
        || matches!(word, "if" | "else" | "fold" | "for" | "in" | "while" | "true" | "false")
}
