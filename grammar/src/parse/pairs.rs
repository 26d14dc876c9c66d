//! The reader's flat list of steps as nodes with children.
//!
//! The functions over them call each other as the rules do, so no deeper than
//! [`crate::MAX_NESTING`] allows.

use super::reader::Step;
use super::{Builder, Rule};
use crate::error::SyntaxError;
use crate::syntax::{Expr, Name, Span, Type};

/// A rule that matched.
#[derive(Clone, Copy)]
pub(super) struct Pair<'s> {
    pub rule: Rule,
    /// Where it stands in the file.
    pub span: Span,
    source: &'s str,
    /// What it is made of.
    steps: &'s [Step],
}

impl<'s> Pair<'s> {
    /// What stands there.
    pub fn text(&self) -> &'s str {
        self.source.get(self.span.range()).unwrap_or_default()
    }
}

/// The children of a node, in order; marks are none.
#[derive(Clone, Copy)]
pub(super) struct Parts<'s> {
    source: &'s str,
    /// Where the piece that was read begins in the file.
    offset: u32,
    steps: &'s [Step],
}

impl<'s> Iterator for Parts<'s> {
    type Item = Pair<'s>;

    fn next(&mut self) -> Option<Pair<'s>> {
        let step = *self.steps.first()?;
        let (this, rest) = self.steps.split_at_checked(step.size as usize)?;
        self.steps = rest;
        let span = Span { start: step.span.start + self.offset, end: step.span.end + self.offset };
        let steps = this.get(1..).unwrap_or_default();
        Some(Pair { rule: step.rule, span, source: self.source, steps })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let mut rest = self.steps;
        let mut count = 0;
        while let Some(after) = rest.first().and_then(|step| rest.get(step.size as usize..)) {
            rest = after;
            count += 1;
        }
        (count, Some(count))
    }
}

impl ExactSizeIterator for Parts<'_> {}

impl<'s> Parts<'s> {
    /// The next child if it has this rule.
    pub fn accept(&mut self, rule: Rule) -> Option<Pair<'s>> {
        self.steps.first().filter(|step| step.rule == rule)?;
        self.next()
    }
}

impl<'s> Builder<'s> {
    /// What has been read.
    pub(super) fn parts(&self, steps: &'s [Step]) -> Parts<'s> {
        Parts { source: self.source, offset: self.offset as u32, steps }
    }

    /// The children of a node.
    pub(super) fn parts_of(&self, node: Pair<'s>) -> Parts<'s> {
        self.parts(node.steps)
    }

    /// The next part, which the grammar promises.
    pub(super) fn next(&self, parts: &mut Parts<'s>, what: &'static str) -> Result<Pair<'s>, SyntaxError> {
        parts.next().ok_or_else(|| self.missing(what))
    }

    /// What is made of each part, in the memory that it needs and no more.
    pub(super) fn each<T>(
        &mut self,
        parts: Parts<'s>,
        make: impl Fn(&mut Self, Pair<'s>) -> Result<T, SyntaxError>,
    ) -> Result<Vec<T>, SyntaxError> {
        let mut made = Vec::with_capacity(parts.len());
        for part in parts {
            made.push(make(self, part)?);
        }
        Ok(made)
    }

    /// The first child, which the grammar promises.
    pub(super) fn only(&self, node: Pair<'s>, what: &'static str) -> Result<Pair<'s>, SyntaxError> {
        self.next(&mut self.parts_of(node), what)
    }

    /// A `name` node as a name.
    pub(super) fn name(&self, node: Pair<'s>) -> Name {
        Name { text: node.text().into(), span: node.span }
    }

    /// The next part as a name.
    pub(super) fn next_name(&self, parts: &mut Parts<'s>) -> Result<Name, SyntaxError> {
        Ok(self.name(self.next(parts, "a name")?))
    }

    /// All names among the children of a node.
    pub(super) fn names(&self, node: Pair<'s>) -> Vec<Name> {
        self.parts_of(node).map(|part| self.name(part)).collect()
    }

    /// The next part as an expression.
    pub(super) fn next_expr(&mut self, parts: &mut Parts<'s>) -> Result<Expr, SyntaxError> {
        let node = self.next(parts, "an expression")?;
        self.expr(node)
    }

    /// The first child as an expression.
    pub(super) fn only_expr(&mut self, node: Pair<'s>) -> Result<Expr, SyntaxError> {
        self.next_expr(&mut self.parts_of(node))
    }

    /// The next part as a type.
    pub(super) fn next_type(&mut self, parts: &mut Parts<'s>) -> Result<Type, SyntaxError> {
        let node = self.next(parts, "a type")?;
        self.ty(node)
    }
}
