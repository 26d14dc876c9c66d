//! Literals: numbers, angles, colours, strings.

use super::pairs::Pair;
use super::{Builder, Rule};
use crate::error::{SyntaxError, SyntaxErrorKind};
use crate::syntax::{ExprKind, Span};
use std::f64::consts::{PI, TAU};

impl<'s> Builder<'s> {
    pub(super) fn literal(&mut self, pair: Pair<'s>) -> ExprKind {
        match pair.rule {
            Rule::text => ExprKind::Text(self.text(pair)),
            Rule::color => ExprKind::Color(color(pair.text())),
            Rule::boolean => ExprKind::Bool(pair.text() == "true"),
            _ => self.number(pair),
        }
    }

    fn number(&mut self, pair: Pair<'s>) -> ExprKind {
        let text = pair.text();
        if text.bytes().all(|byte| byte.is_ascii_digit()) {
            return ExprKind::Int(text.parse().ok());
        }
        let (digits, unit) = match (text.strip_suffix("deg"), text.strip_suffix("turn")) {
            (Some(digits), _) => (digits, PI / 180.0),
            (_, Some(digits)) => (digits, TAU),
            _ => (text, 1.0),
        };
        let value = digits.parse::<f64>().unwrap_or(f64::INFINITY) * unit;
        if !value.is_finite() {
            let kind = SyntaxErrorKind::NumberTooLarge { text: text.to_string() };
            self.errors.push(SyntaxError::new(kind, pair.span));
        }
        ExprKind::Float(value)
    }

    /// The value of a string literal.
    pub(super) fn text(&mut self, pair: Pair<'s>) -> String {
        let span = pair.span;
        let quoted = pair.text();
        let inner = quoted.get(1..quoted.len() - 1).unwrap_or_default();
        let mut value = String::with_capacity(inner.len());
        let mut rest = inner;
        while let Some(at) = rest.find('\\') {
            value.push_str(&rest[..at]);
            let offset = span.start as usize + 1 + (inner.len() - rest.len()) + at;
            let (character, length) = unescape(&rest[at..]);
            let escape = rest.get(at..at + length).unwrap_or_default();
            match character {
                Some(character) => value.push(character),
                None => self.errors.push(SyntaxError::new(
                    SyntaxErrorKind::BadEscape { escape: escape.to_string() },
                    Span::new(offset, offset + length),
                )),
            }
            rest = rest.get(at + length..).unwrap_or_default();
        }
        value + rest
    }
}

/// The character that an escape stands for, and the escape's length.
fn unescape(text: &str) -> (Option<char>, usize) {
    let simple = match text.as_bytes().get(1) {
        Some(b'n') => '\n',
        Some(b't') => '\t',
        Some(b'"') => '"',
        Some(b'\\') => '\\',
        _ => {
            let digits = text.get(3..).unwrap_or_default().split('}').next().unwrap_or_default();
            let code = u32::from_str_radix(digits, 16).ok();
            return (code.and_then(char::from_u32), 4 + digits.len());
        }
    };
    (Some(simple), 2)
}

/// The four channels of `#rgb`, `#rrggbb` or `#rrggbbaa`.
fn color(text: &str) -> [u8; 4] {
    let digit = |index: usize| match text.as_bytes().get(index) {
        Some(byte) => (*byte as char).to_digit(16).unwrap_or(0) as u8,
        None => 15,
    };
    match text.len() {
        4 => [digit(1) * 17, digit(2) * 17, digit(3) * 17, 255],
        _ => [1, 3, 5, 7].map(|at| digit(at) * 16 + digit(at + 1)),
    }
}
