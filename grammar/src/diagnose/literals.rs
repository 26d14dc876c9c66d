//! Literals that are none: `3y`, `1.`, `.5`, `#12345`, `"\q"`.

use super::{Guess, Place};
use crate::error::{SyntaxError, SyntaxErrorKind as Kind};
use crate::parse::is_literal;
use crate::recover::is_first_of_line;
use crate::scan::{Token, TokenKind};
use crate::syntax::Span;

impl Place<'_, '_> {
    /// Literals that are none, wherever they stand.
    pub(super) fn literal(&self) -> Guess {
        let text = self.text.to_string();
        match self.token.kind {
            TokenKind::Number if !is_literal(self.text) => Some(self.bad_number()),
            TokenKind::Color if !is_literal(self.text) => self.here(Kind::BadColor { text }),
            TokenKind::Text => self.bad_escape(),
            _ => self.leading_dot().or_else(|| self.trailing_dot()),
        }
    }

    /// `3y`, `1e-x`
    fn bad_number(&self) -> SyntaxError {
        let follows = |before: Token, after: &Token| before.span.end == after.span.start;
        let sign = self.at(1).filter(|sign| follows(self.token, sign) && self.text.ends_with(['e', 'E']));
        let sign = sign.filter(|sign| matches!(self.scan.text(*sign), "+" | "-"));
        let rest = sign.and_then(|sign| self.at(2).filter(|rest| follows(sign, rest)).or(Some(sign)));
        let span = rest.map_or(self.token.span, |rest| self.token.span.to(rest.span));
        let text = self.scan.source.get(span.range()).unwrap_or_default().to_string();
        let mend = self.text.strip_suffix(['f', 'F']).filter(|number| is_literal(number)).map(str::to_string);
        SyntaxError::new(Kind::BadNumber { text, mend }, span)
    }

    fn bad_escape(&self) -> Guess {
        let mut at = 0;
        while let Some(next) = self.text.get(at..)?.find('\\') {
            at += next;
            let rest = &self.text[at..];
            let braced = rest.starts_with("\\u{").then(|| rest.find('}')).flatten();
            let length = match (braced, rest.chars().nth(1)) {
                (Some(end), _) => end + 1,
                (None, Some(character)) => 1 + character.len_utf8(),
                (None, None) => 1,
            };
            let escape = &rest[..length];
            if !is_literal(&format!("\"{escape}\"")) {
                let start = self.token.span.start as usize + at;
                let kind = Kind::BadEscape { escape: escape.to_string() };
                return Some(SyntaxError::new(kind, Span::new(start, start + length)));
            }
            at += length;
        }
        None
    }

    /// `.5`
    fn leading_dot(&self) -> Guess {
        let next = self.at(1)?;
        if self.text != "." || next.kind != TokenKind::Number || next.span.start != self.token.span.end {
            return None;
        }
        let text = format!(".{}", self.scan.text(next));
        let mend = Some(format!("0{text}"));
        let span = self.token.span.to(next.span);
        Some(SyntaxError::new(Kind::BadNumber { text, mend }, span))
    }

    /// `1.`, where what follows is no name, or one that begins the next statement.
    fn trailing_dot(&self) -> Guess {
        let begins_line = |index: Option<usize>| index.is_some_and(|i| is_first_of_line(self.scan, i));
        let is_next = self.text == "=" && begins_line(self.index.checked_sub(1));
        let back = if is_next { -1 } else { 0 };
        let number = self.at(back - 2).filter(|token| token.kind == TokenKind::Number)?;
        let dot = self.at(back - 1).filter(|dot| dot.span.start == number.span.end)?;
        if self.scan.text(dot) != "." || !(is_next || self.expects("a name")) {
            return None;
        }
        let text = format!("{}.", self.scan.text(number));
        let mend = Some(format!("{text}0"));
        Some(SyntaxError::new(Kind::BadNumber { text, mend }, number.span.to(dot.span)))
    }
}
