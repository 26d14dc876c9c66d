//! Statements that are none, and expressions that stand where no operator joins them.

use super::{Guess, Place};
use crate::error::{Statement, SyntaxError, SyntaxErrorKind as Kind};
use crate::recover::{is_first_of_line, is_in_column_0};
use crate::scan::TokenKind;
use crate::syntax::Span;

impl Place<'_, '_> {
    /// Points at the `if` whose arm was closed just before.
    pub(super) fn missing_else(&self) -> Guess {
        if !self.expects("`else`") {
            return None;
        }
        // `{ a }} else`
        if self.text == "}" && self.text_at(1) == "else" {
            return self.unopened();
        }
        // `{ a } esle { b }`
        if self.is_name(0) && !is_first_of_line(self.scan, self.index) {
            return Some(self.found(vec!["`else`"], None));
        }
        let mut depth = 0usize;
        for token in self.scan.tokens.get(self.tokens.start..self.index)?.iter().rev() {
            match (token.kind, self.scan.text(*token)) {
                (TokenKind::Close, _) => depth += 1,
                (TokenKind::Open, _) => depth = depth.saturating_sub(1),
                (TokenKind::Word, "if") if depth == 0 => {
                    let error = SyntaxError::new(Kind::MissingElse, token.span);
                    // `} { b }`
                    if self.text == "{"
                        || (self.token.kind == TokenKind::Open && !is_first_of_line(self.scan, self.index))
                    {
                        return Some(
                            error.related(Some(self.token.span), "an `else` is missing before this"),
                        );
                    }
                    return Some(error.related(self.span_at(-1), "an `else` is missing after this"));
                }
                _ => {}
            }
        }
        None
    }

    /// `x = c { a } else { b }`
    pub(super) fn missing_if(&self) -> Guess {
        if self.text != "{" || !self.expects("an assignment") {
            return None;
        }
        let equals = (1..).map_while(|i| Some((i, self.at(-i)?)));
        let (back, _) = equals.into_iter().find(|(_, token)| self.scan.text(*token) == "=")?;
        let condition = self.span_at(1 - back)?.to(self.span_at(-1)?);
        let error = self.found(
            vec!["an operator", "a new line"],
            Some("a choice begins with `if`: `if c { a } else { b }`"),
        );
        Some(error.related(Some(condition), "is an `if` missing before this?"))
    }

    /// `a b`: pest takes the second for the beginning of a statement, and stops behind it.
    pub(super) fn side_by_side(&self) -> Guess {
        if self.expects("an assignment") && !self.begins_statement(self.index) {
            return self.no_operator();
        }
        let found_second = self.expects("`=`") && self.is_name(-1) && self.previous_begins_statement();
        if !found_second || self.begins_statement(self.index - 1) || self.text_at(-1) == "return" {
            return None;
        }
        let place = Place::new(self.scan, self.tokens.clone(), self.index - 1, self.expected);
        place.no_operator()
    }

    fn no_operator(&self) -> Guess {
        // A closing bracket, a comma, a mark: something else is wrong with these.
        if !matches!(
            self.token.kind,
            TokenKind::Word | TokenKind::Number | TokenKind::Text | TokenKind::Color
        ) {
            return None;
        }
        let error = self.found(vec!["an operator", "a new line"], self.habit());
        Some(error.related(self.span_at(-1), "after this"))
    }

    /// Whether a token could be the first of a statement: nothing stands before it on its line.
    fn begins_statement(&self, index: usize) -> bool {
        let before = index.checked_sub(1).and_then(|before| self.scan.tokens.get(before));
        is_first_of_line(self.scan, index) || before.is_none_or(|before| self.scan.text(*before) == "{")
    }

    /// `return x`, and expressions that stand as statements.
    pub(super) fn not_an_assignment(&self) -> Guess {
        let before = self.at(-1)?;
        let assigns = matches!(self.text, ":" | "::" | "=>" | "==" | "+=" | "-=" | "*=" | "/=" | "++" | "--");
        let begins = self.expects("`=`") && self.is_name(-1) && !assigns;
        let found = match (self.text_at(-1), self.text) {
            ("return", _) => Statement::Return,
            (_, ".") if self.text_at(2) == "=" => Statement::Component,
            _ => Statement::Expression,
        };
        // A name behind a name is a declaration in another language's order: `float x = 1`.
        if !begins || !self.previous_begins_statement() || (self.is_name(0) && found != Statement::Return) {
            return None;
        }
        let error = SyntaxError::new(Kind::NotAnAssignment { found }, before.span);
        Some(error.related((found != Statement::Return).then_some(self.token.span), "expected `=`"))
    }

    /// Whether the token before could be the first of a statement: not the name behind `let`, nor
    /// an accumulator behind `(` or `,`.
    fn previous_begins_statement(&self) -> bool {
        !matches!(self.text_at(-2), "let" | "param" | "(" | "," | ":" | "")
    }

    /// An assignment outside of all bodies: the head of its node is missing, or a brace too many.
    pub(super) fn stray_statement(&self) -> Guess {
        let is_statement = self.expects("an item") && self.is_name(0) && self.text_at(1) == "=";
        if !is_statement || is_in_column_0(self.scan.source, self.token) {
            return None;
        }
        let (place, label) = match (self.orphan(), self.first_indented()) {
            (Some(orphan), _) => (Some(orphan), "this is indented like the body of a fold that is not there"),
            (None, Some(first)) => (Some(first), "a body seems to begin here, without its head"),
            (None, None) => (self.span_at(-1), "the body ends here"),
        };
        let help = "an assignment stands between the braces of a `node` or a `texture`";
        Some(self.found(self.expected.to_vec(), Some(help)).related(place, label))
    }

    /// The first statement of a block that nobody opens: its lines are further to the right than
    /// those before it, or than the brace that closes it.
    fn orphan(&self) -> Option<Span> {
        // Of each open bracket: the column of its line, and the first statement inside with the last
        // one's column.
        let mut open: Vec<(usize, Option<(Span, usize)>)> = Vec::new();
        let mut line = 0;
        for index in self.tokens.start..self.index {
            let token = self.scan.tokens.get(index)?;
            let begins_line = is_first_of_line(self.scan, index);
            line = if begins_line { self.scan.column(index) } else { line };
            let assigns = self.scan.text_of(index + 1) == "=" || self.scan.text(*token) == "let";
            match (token.kind, open.last_mut()) {
                (TokenKind::Open, _) => open.push((line, None)),
                (TokenKind::Close, Some((outer, Some((first, _))))) if begins_line && line > *outer => {
                    return Some(*first);
                }
                (TokenKind::Close, _) => drop(open.pop()),
                (TokenKind::Word, Some((_, statement))) if begins_line && assigns => match statement {
                    Some((_, column)) if line > *column => return Some(token.span),
                    Some((_, column)) => *column = line,
                    None => *statement = Some((token.span, line)),
                },
                _ => {}
            }
        }
        None
    }

    /// Where the indented lines before this one begin, if they stand in no body either.
    fn first_indented(&self) -> Option<Span> {
        let mut depth = 0usize;
        let mut first = None;
        for index in (self.tokens.start..self.index).rev() {
            let token = self.scan.tokens.get(index)?;
            match token.kind {
                TokenKind::Close => depth += 1,
                TokenKind::Open => depth = depth.saturating_sub(1),
                _ => {}
            }
            let begins_line = is_first_of_line(self.scan, index);
            if begins_line && is_in_column_0(self.scan.source, *token) {
                break;
            }
            if begins_line && depth == 0 {
                first = Some(token.span);
            }
        }
        first
    }
}
