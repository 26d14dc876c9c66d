//! From the place where pest stopped to an error in the reader's words.
//!
//! pest knows how far it came and which rules it tried there. The rough tokens around that place
//! tell the frequent mistakes apart: each has one small function, asked in turn; those about
//! literals and the habits of other languages have files of their own.

mod habits;
mod literals;

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
    // Behind the last token stands nothing, which is no mark that anything would ask for.
    let end = Span::new(scan.source.len(), scan.source.len());
    let end = Token { kind: TokenKind::Symbol, span: end };
    let token = scan.tokens.get(index).copied().unwrap_or(end);
    let text = scan.text(token);
    let place = Place { scan, tokens, index, token, text, expected: &failure.expected };
    place
        .character()
        .or_else(|| place.literal())
        .or_else(|| place.bracket())
        .or_else(|| place.space())
        .or_else(|| place.lambda())
        .or_else(|| place.missing_else())
        .or_else(|| place.not_an_assignment())
        .or_else(|| place.keyword())
        .or_else(|| place.end())
        .unwrap_or_else(|| place.unexpected())
}

/// The innermost bracket that is open behind some tokens.
fn unclosed(scan: &Scan<'_>, tokens: Range<usize>) -> Guess {
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
    let token = open.pop()?;
    let (open, close) = match scan.text(token) {
        "(" => ('(', ')'),
        "[" => ('[', ']'),
        _ => ('{', '}'),
    };
    Some(SyntaxError { kind: Kind::Unclosed { open, close }, span: token.span })
}

impl<'s> Place<'_, 's> {
    fn here(&self, kind: Kind) -> Guess {
        Some(SyntaxError { kind, span: self.token.span })
    }

    /// The token some places before or after, within the piece.
    fn at(&self, offset: isize) -> Option<Token> {
        let index = self.index.checked_add_signed(offset)?;
        self.scan.tokens.get(index).copied().filter(|_| index >= self.tokens.start)
    }

    fn text_at(&self, offset: isize) -> &'s str {
        self.at(offset).map_or("", |token| self.scan.text(token))
    }

    fn expects(&self, what: &str) -> bool {
        self.expected.contains(&what)
    }

    fn touches_previous(&self) -> bool {
        self.at(-1).is_some_and(|before| before.span.end == self.token.span.start)
    }

    fn is_name(&self, offset: isize) -> bool {
        let token = self.at(offset);
        token.is_some_and(|token| token.kind == TokenKind::Word && !is_keyword(self.scan.text(token)))
    }

    /// Characters that begin no token.
    fn character(&self) -> Guess {
        if self.text == ";" {
            return self.here(Kind::Semicolon);
        }
        let character = self.text.chars().next()?;
        match self.token.kind {
            TokenKind::Unknown if character.is_ascii() => self.here(Kind::UnknownCharacter { character }),
            TokenKind::Unknown => self.here(Kind::NonAscii { character }),
            _ => None,
        }
    }

    /// A bracket that is not closed before this token, or closes nothing.
    fn bracket(&self) -> Guess {
        let before = self.tokens.start..self.index;
        let open = unclosed(self.scan, before);
        let begins_statement = is_item_keyword(self.text) && is_first_of_line(self.scan, self.index);
        match (self.token.kind, &open) {
            (TokenKind::Close, None) => self.here(Kind::Unopened { close: self.text.chars().next()? }),
            // A brace is rarely the forgotten one: what meets it closes nothing.
            (TokenKind::Close, Some(bracket)) if closes(&bracket.kind, "}") && self.text != "}" => {
                self.here(Kind::Unopened { close: self.text.chars().next()? })
            }
            (TokenKind::Close, Some(bracket)) if !closes(&bracket.kind, self.text) => open,
            // Where an expression is missing, that is the better thing to say.
            (TokenKind::Word, _) if begins_statement && !self.expects("an expression") => open,
            _ if self.index >= self.tokens.end => open,
            _ => None,
        }
    }

    /// `f (x)`, `v [i]`
    fn space(&self) -> Guess {
        let is_bracket = matches!(self.text, "(" | "[");
        let is_call = is_bracket && self.is_name(-1) && !self.touches_previous();
        if !is_call || is_first_of_line(self.scan, self.index) || self.expects("`(`") {
            return None;
        }
        let name = self.text_at(-1).to_string();
        let bracket = self.text.chars().next()?;
        let before = self.at(-1)?.span;
        let kind = Kind::SpaceBeforeBracket { name, bracket };
        Some(SyntaxError { kind, span: before.to(self.token.span) })
    }

    fn lambda(&self) -> Guess {
        let is_lambda = matches!(self.text, "|" | "||") && self.expects("an expression");
        if is_lambda { self.here(Kind::StrayLambda) } else { None }
    }

    /// Points at the `if` whose arm was closed just before.
    fn missing_else(&self) -> Guess {
        if !self.expects("`else`") {
            return None;
        }
        let mut depth = 0usize;
        for token in self.scan.tokens.get(self.tokens.start..self.index)?.iter().rev() {
            match (token.kind, self.scan.text(*token)) {
                (TokenKind::Close, _) => depth += 1,
                (TokenKind::Open, _) => depth = depth.saturating_sub(1),
                (TokenKind::Word, "if") if depth == 0 => {
                    return Some(SyntaxError { kind: Kind::MissingElse, span: token.span });
                }
                _ => {}
            }
        }
        None
    }

    /// `return x`, and expressions that stand as statements.
    fn not_an_assignment(&self) -> Guess {
        let before = self.at(-1)?;
        let found_equals = matches!(self.text, ":" | "::" | "=>" | "==" | "+=" | "-=" | "*=" | "/=");
        let begins = self.expects("`=`") && self.is_name(-1) && !found_equals;
        let is_return = self.text_at(-1) == "return";
        // A name behind a name is a declaration in another language's order: `float x = 1`.
        if !begins || !self.previous_begins_statement() || (self.is_name(0) && !is_return) {
            return None;
        }
        Some(SyntaxError { kind: Kind::NotAnAssignment { is_return }, span: before.span })
    }

    /// Whether the token before could be the first of a statement: not the name behind `let`, nor
    /// an accumulator behind `(` or `,`.
    fn previous_begins_statement(&self) -> bool {
        !matches!(self.text_at(-2), "let" | "param" | "(" | "," | ":" | "")
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
        if !is_keyword(self.text) || !could_be_name || is_meant {
            return None;
        }
        self.here(Kind::KeywordAsName { keyword: self.text.to_string() })
    }

    /// The text ended; the last token is what there is to show.
    fn end(&self) -> Guess {
        if self.index < self.scan.tokens.len() {
            return None;
        }
        let span = self.at(-1).map(|last| last.span).unwrap_or_default();
        let expected = self.expected.to_vec();
        Some(SyntaxError { kind: Kind::UnexpectedEnd { expected }, span })
    }

    fn unexpected(&self) -> SyntaxError {
        let found = match self.token.kind {
            TokenKind::Text => "a string".to_string(),
            _ => format!("`{}`", self.text),
        };
        let kind = Kind::Unexpected { found, expected: self.expected.to_vec(), help: self.habit() };
        SyntaxError { kind, span: self.token.span }
    }
}

/// Whether the bracket of an [`Kind::Unclosed`] would be closed by this one.
fn closes(open: &Kind, bracket: &str) -> bool {
    matches!(open, Kind::Unclosed { close, .. } if bracket.starts_with(*close))
}

fn is_keyword(word: &str) -> bool {
    is_item_keyword(word)
        || matches!(word, "if" | "else" | "fold" | "for" | "in" | "while" | "true" | "false")
}
