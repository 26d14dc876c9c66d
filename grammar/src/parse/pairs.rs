//! pest's flat queue of tokens to nodes, without recursion.
//!
//! A [`Pair`] is one of pest's with its children, marks left out. What can nest without bound in the
//! grammar, expressions and types, is built as soon as its last token is seen, so nodes themselves
//! stay shallow and the functions over them may call each other freely.

use super::{Builder, Rule};
use crate::error::SyntaxError;
use crate::syntax::{Expr, Name, Span, Type};
use pest::Token;
use pest::iterators::Pairs;
use std::iter::Peekable;

/// A rule that matched.
pub(super) struct Pair<'s> {
    pub rule: Rule,
    /// Where it stands in the file; without the white space behind it.
    pub span: Span,
    pub text: &'s str,
    pub content: Content<'s>,
}

/// What a node holds.
pub(super) enum Content<'s> {
    Parts(Vec<Pair<'s>>),
    Expr(Expr),
    Type(Type),
}

/// The children of a node, in order.
pub(super) struct Parts<'s>(Peekable<std::vec::IntoIter<Pair<'s>>>);

impl<'s> Iterator for Parts<'s> {
    type Item = Pair<'s>;

    fn next(&mut self) -> Option<Pair<'s>> {
        self.0.next()
    }
}

impl<'s> Parts<'s> {
    /// The children of `node`.
    pub fn of(node: Pair<'s>) -> Parts<'s> {
        let parts = match node.content {
            Content::Parts(parts) => parts,
            Content::Expr(_) | Content::Type(_) => Vec::new(),
        };
        Parts(parts.into_iter().peekable())
    }

    /// The next child if it has this rule.
    pub fn accept(&mut self, rule: Rule) -> Option<Pair<'s>> {
        self.0.next_if(|node| node.rule == rule)
    }
}

/// Whether a rule is there only to be matched, or named in an error.
fn is_mark(rule: Rule) -> bool {
    matches!(
        rule,
        Rule::lparen
            | Rule::rparen
            | Rule::lbracket
            | Rule::rbracket
            | Rule::lbrace
            | Rule::rbrace
            | Rule::less
            | Rule::greater
            | Rule::comma
            | Rule::colon
            | Rule::arrow
            | Rule::dot
            | Rule::bar
            | Rule::equals
            | Rule::kw_use
            | Rule::kw_let
            | Rule::kw_param
            | Rule::kw_node
            | Rule::kw_texture
            | Rule::kw_if
            | Rule::kw_else
            | Rule::kw_fold
            | Rule::kw_for
            | Rule::kw_in
            | Rule::kw_while
            | Rule::kw_as
            | Rule::kw_max
            | Rule::kw_tiles
            | Rule::EOI
    )
}

impl<'s> Builder<'s> {
    /// The node of the first pair.
    pub(super) fn nodes(&mut self, pairs: Pairs<'_, Rule>) -> Result<Pair<'s>, SyntaxError> {
        let mut open: Vec<Pair<'s>> = Vec::new();
        let mut last_end = self.offset;
        for token in pairs.tokens() {
            match token {
                Token::Start { rule, pos } => {
                    let start = self.offset + pos.pos();
                    let content = Content::Parts(Vec::new());
                    open.push(Pair { rule, span: Span::new(start, start), text: "", content });
                }
                Token::End { rule, pos } => {
                    let Some(mut node) = open.pop() else { break };
                    // Behind an optional part that is absent pest counts the white space in.
                    let is_leaf = matches!(&node.content, Content::Parts(parts) if parts.is_empty());
                    if is_leaf || is_mark(rule) {
                        last_end = self.offset + pos.pos();
                    }
                    node.span.end = last_end as u32;
                    node.text = self.source.get(node.span.range()).unwrap_or_default();
                    let node = self.reduce(node)?;
                    match open.last_mut().map(|parent| &mut parent.content) {
                        Some(Content::Parts(parts)) if !is_mark(rule) => parts.push(node),
                        Some(_) => {}
                        None => return Ok(node),
                    }
                }
            }
        }
        Err(self.missing("a node"))
    }

    /// Builds what could nest.
    fn reduce(&mut self, node: Pair<'s>) -> Result<Pair<'s>, SyntaxError> {
        let (rule, span, text) = (node.rule, node.span, node.text);
        let content = match rule {
            Rule::expr => Content::Expr(self.chain(node)?),
            Rule::unary => Content::Expr(self.unary(node)?),
            Rule::ty | Rule::inner_type | Rule::inner_output | Rule::signature_output => {
                Content::Type(self.ty(node)?)
            }
            _ => node.content,
        };
        Ok(Pair { rule, span, text, content })
    }

    /// The next part, which the grammar promises.
    pub(super) fn next(&self, parts: &mut Parts<'s>, what: &'static str) -> Result<Pair<'s>, SyntaxError> {
        parts.next().ok_or_else(|| self.missing(what))
    }

    /// A `name` node as a name.
    pub(super) fn name(&self, node: &Pair<'s>) -> Name {
        Name { text: node.text.to_string(), span: node.span }
    }

    /// The next part as a name.
    pub(super) fn next_name(&self, parts: &mut Parts<'s>) -> Result<Name, SyntaxError> {
        Ok(self.name(&self.next(parts, "a name")?))
    }

    /// All names among the children of a node.
    pub(super) fn names(&self, node: Pair<'s>) -> Vec<Name> {
        Parts::of(node).map(|part| self.name(&part)).collect()
    }

    /// The node of an expression as that.
    pub(super) fn expr(&self, node: Pair<'s>) -> Result<Expr, SyntaxError> {
        match node.content {
            Content::Expr(expr) => Ok(expr),
            Content::Parts(_) | Content::Type(_) => Err(self.missing("an expression")),
        }
    }

    /// The next part as an expression.
    pub(super) fn next_expr(&self, parts: &mut Parts<'s>) -> Result<Expr, SyntaxError> {
        self.expr(self.next(parts, "an expression")?)
    }

    /// The next part as a type.
    pub(super) fn next_type(&self, parts: &mut Parts<'s>) -> Result<Type, SyntaxError> {
        match self.next(parts, "a type")?.content {
            Content::Type(ty) => Ok(ty),
            Content::Parts(_) | Content::Expr(_) => Err(self.missing("a type")),
        }
    }
}
