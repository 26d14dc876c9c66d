//! Pairs of files, items, types and statements.

use super::pairs::{Pair, Parts};
use super::reader::Step;
use super::{Builder, Rule};
use crate::error::{SyntaxError, SyntaxErrorKind};
use crate::syntax::{
    Body, CommentKind, Dim, Expr, Field, File, Input, Item, ItemKind, Name, Node, Pattern, Signature,
    Statement, Text, Type, TypeKind,
};

type Built<T> = Result<T, SyntaxError>;

impl<'s> Builder<'s> {
    pub(super) fn file(&mut self, steps: &'s [Step]) -> Built<File> {
        let file = self.next(&mut self.parts(steps), "a file")?;
        let mut items: Vec<Item> = Vec::new();
        for part in self.parts_of(file) {
            let before = items.last().map_or(self.offset as u32, |item| item.span.end);
            items.push(self.item(part, before)?);
        }
        let first = items.first().map_or(u32::MAX, |item| item.span.start);
        let doc = self.doc(CommentKind::FileDoc, self.offset as u32, first);
        Ok(File { doc, items, comments: Vec::new() })
    }

    /// The documentation between two places: comments of a kind that begin their line.
    fn doc(&self, kind: CommentKind, start: u32, end: u32) -> String {
        let first = self.comments.partition_point(|comment| comment.span.start < start);
        let lines = self.comments[first..].iter().take_while(|comment| comment.span.start < end);
        let lines: Vec<&str> = lines
            .filter(|comment| comment.kind == kind && self.begins_line(comment.span.start as usize))
            .map(|comment| {
                let text = self.source.get(comment.span.range()).unwrap_or_default();
                let text = text.get(3..).unwrap_or_default();
                text.strip_prefix(' ').unwrap_or(text).trim_end()
            })
            .collect();
        lines.join("\n")
    }

    fn begins_line(&self, at: usize) -> bool {
        let before = self.source.get(..at).unwrap_or_default();
        let before = before.trim_end_matches([' ', '\t', '\r']);
        before.is_empty() || before.ends_with('\n')
    }

    fn item(&mut self, pair: Pair<'s>, before: u32) -> Built<Item> {
        let pair = self.only(pair, "an item")?;
        let span = pair.span;
        let doc = self.doc(CommentKind::Doc, before, span.start);
        let kind = match pair.rule {
            Rule::use_item => self.use_item(pair)?,
            Rule::let_item => self.let_item(pair)?,
            Rule::param_item => self.param_item(pair)?,
            Rule::node_item => ItemKind::Node(self.node(&mut self.parts_of(pair))?.0),
            Rule::texture_item => {
                let (node, tiles) = self.node(&mut self.parts_of(pair))?;
                ItemKind::Texture { node, tiles }
            }
            _ => return Err(self.missing("an item")),
        };
        Ok(Item { doc, span, kind })
    }

    fn use_item(&mut self, pair: Pair<'s>) -> Built<ItemKind> {
        let mut parts = self.parts_of(pair);
        let path = self.next(&mut parts, "a path")?;
        let path = Text { value: self.text(path), span: path.span };
        let alias = parts.next().map(|name| self.name(name));
        Ok(ItemKind::Use { path, alias })
    }

    fn let_item(&mut self, pair: Pair<'s>) -> Built<ItemKind> {
        let mut parts = self.parts_of(pair);
        let name = self.next_name(&mut parts)?;
        let value = self.next_expr(&mut parts)?;
        Ok(ItemKind::Let { name, value })
    }

    fn param_item(&mut self, pair: Pair<'s>) -> Built<ItemKind> {
        let mut parts = self.parts_of(pair);
        let name = self.next_name(&mut parts)?;
        let ty = self.next_type(&mut parts)?;
        let default = self.next_expr(&mut parts)?;
        let range = parts.next().map(|range| self.range(range)).transpose()?;
        Ok(ItemKind::Param { name, ty, default, range })
    }

    fn node(&mut self, parts: &mut Parts<'s>) -> Built<(Node, Option<Expr>)> {
        let name = self.next_name(parts)?;
        let dims = self.dims(parts);
        let inputs = self.inputs(parts)?;
        let outputs = self.next(parts, "outputs")?;
        let outputs = self.fields(outputs)?;
        let tiles = parts.accept(Rule::tiles);
        let tiles = tiles.map(|tiles| self.only_expr(tiles)).transpose()?;
        let body = self.next(parts, "a body")?;
        let body = self.body(body)?;
        Ok((Node { name, dims, inputs, outputs, body }, tiles))
    }

    pub(super) fn signature(&mut self, steps: &'s [Step]) -> Built<Signature> {
        let signature = self.next(&mut self.parts(steps), "a signature")?;
        let mut parts = self.parts_of(signature);
        let dims = self.dims(&mut parts);
        let inputs = self.inputs(&mut parts)?;
        let output = self.next_type(&mut parts)?;
        Ok(Signature { dims, inputs, output })
    }

    fn dims(&self, parts: &mut Parts<'s>) -> Vec<Name> {
        parts.accept(Rule::dims).map(|dims| self.names(dims)).unwrap_or_default()
    }

    fn inputs(&mut self, parts: &mut Parts<'s>) -> Built<Vec<Input>> {
        let inputs = self.next(parts, "inputs")?;
        self.parts_of(inputs).map(|input| self.input(input)).collect()
    }

    fn input(&mut self, pair: Pair<'s>) -> Built<Input> {
        let mut parts = self.parts_of(pair);
        let name = self.next_name(&mut parts)?;
        let ty = self.next_type(&mut parts)?;
        let default = parts.next().map(|value| self.expr(value)).transpose()?;
        Ok(Input { name, ty, default })
    }

    fn fields(&mut self, pair: Pair<'s>) -> Built<Vec<Field>> {
        self.parts_of(pair).map(|field| self.field(field)).collect()
    }

    fn field(&mut self, pair: Pair<'s>) -> Built<Field> {
        let mut parts = self.parts_of(pair);
        Ok(Field { name: self.next_name(&mut parts)?, ty: self.next_type(&mut parts)? })
    }

    /// A type.
    pub(super) fn ty(&mut self, pair: Pair<'s>) -> Built<Type> {
        let pair = self.only(pair, "a type")?;
        let span = pair.span;
        let kind = match pair.rule {
            Rule::record => TypeKind::Record(self.fields(pair)?),
            Rule::node_type => self.node_type(pair)?,
            _ => self.named_type(pair)?,
        };
        Ok(Type { span, kind })
    }

    fn named_type(&mut self, pair: Pair<'s>) -> Built<TypeKind> {
        let mut parts = self.parts_of(pair);
        let name = self.next_name(&mut parts)?;
        if let Some(dim) = parts.accept(Rule::dim) {
            return Ok(TypeKind::Named { name, dim: Some(self.dim(dim)?) });
        }
        let others: Vec<Name> = parts.map(|part| self.name(part)).collect();
        if others.is_empty() {
            return Ok(TypeKind::Named { name, dim: None });
        }
        Ok(TypeKind::Choice([vec![name], others].concat()))
    }

    fn node_type(&mut self, pair: Pair<'s>) -> Built<TypeKind> {
        let mut inputs = Vec::new();
        let mut parts = self.parts_of(pair);
        while let Some(field) = parts.accept(Rule::inner_field) {
            inputs.push(self.field(field)?);
        }
        let output = Box::new(self.next_type(&mut parts)?);
        Ok(TypeKind::Node { inputs, output })
    }

    /// `<n>` of a type or of a call.
    pub(super) fn dim(&mut self, pair: Pair<'s>) -> Built<Dim> {
        let pair = self.only(pair, "a dimension")?;
        if pair.rule == Rule::name {
            return Ok(Dim::Name(self.name(pair)));
        }
        let span = pair.span;
        let number = pair.text().parse().unwrap_or_else(|_| {
            let text = pair.text().to_string();
            self.errors.push(SyntaxError::new(SyntaxErrorKind::NumberTooLarge { text }, span));
            0
        });
        Ok(Dim::Number(number, span))
    }

    pub(super) fn body(&mut self, pair: Pair<'s>) -> Built<Body> {
        let span = pair.span;
        let statements = self.each(self.parts_of(pair), Builder::statement)?;
        Ok(Body { statements, span })
    }

    fn statement(&mut self, pair: Pair<'s>) -> Built<Statement> {
        let pair = self.only(pair, "a statement")?;
        let span = pair.span;
        let is_let = pair.rule == Rule::binding;
        let mut parts = self.parts_of(pair);
        if is_let {
            let pattern = self.next(&mut parts, "a pattern")?;
            let pattern = self.pattern(pattern)?;
            let value = self.next_expr(&mut parts)?;
            return Ok(Statement::Let { span, pattern, value });
        }
        let name = self.next_name(&mut parts)?;
        let value = self.next_expr(&mut parts)?;
        Ok(Statement::Assign { name, value })
    }

    fn pattern(&self, pair: Pair<'s>) -> Built<Pattern> {
        let span = pair.span;
        if pair.text().starts_with('(') {
            Ok(Pattern::Record(self.names(pair), span))
        } else {
            Ok(Pattern::Name(self.next_name(&mut self.parts_of(pair))?))
        }
    }
}
