//! Files, items, types and statements.

use super::layout::{Piece, Style};
use super::writer::{Blank, Gap};
use super::{Assignment, Formatter};
use crate::syntax::{
    Body, Dim, Expr, Field, File, Input, Item, ItemKind, Name, Node, Pattern, Statement, Type, TypeKind,
};

impl Formatter<'_> {
    pub(super) fn file(&mut self, file: &File) {
        let mut assignments = Vec::new();
        for (index, item) in file.items.iter().enumerate() {
            let before = index.checked_sub(1).map(|before| &file.items[before]);
            self.item(item, before, &mut assignments);
        }
        self.blocks.push(assignments);
        self.writer.finish();
    }

    fn item(&mut self, item: &Item, before: Option<&Item>, assignments: &mut Vec<Assignment>) {
        let is_apart = is_block(item) || before.is_some_and(is_block);
        let is_apart = is_apart && before.is_some();
        let gap = Gap::Line(if is_apart { Blank::Always } else { Blank::Keep });
        match &item.kind {
            ItemKind::Use { path, alias } => {
                self.writer.token(gap, "use");
                self.writer.copy(Gap::Space, path.span);
                if let Some(alias) = alias {
                    self.writer.token(Gap::Space, "as");
                    self.name(Gap::Space, alias);
                }
            }
            ItemKind::Let { name, value } => {
                let follows = before.is_some_and(|before| matches!(before.kind, ItemKind::Let { .. }));
                self.writer.token(gap, "let");
                let (start, is_joined) = (self.writer.line_start, self.writer.plain && follows);
                self.name(Gap::Space, name);
                self.assign(start, is_joined, value, assignments);
            }
            ItemKind::Param { name, ty, default, range } => {
                self.writer.token(gap, "param");
                self.name(Gap::Space, name);
                self.ty_of(ty);
                self.default(default);
                if let Some(range) = range {
                    self.writer.token(Gap::Space, "in");
                    self.range(range);
                }
            }
            ItemKind::Node(node) => self.node(gap, "node", node, None),
            ItemKind::Texture { node, tiles } => self.node(gap, "texture", node, tiles.as_ref()),
        }
    }

    fn node(&mut self, gap: Gap, keyword: &'static str, node: &Node, tiles: Option<&Expr>) {
        self.writer.token(gap, keyword);
        self.name(Gap::Space, &node.name);
        if !node.dims.is_empty() {
            self.names("<", &node.dims, ">");
        }
        self.open_list(Gap::Glue, "(", Style::Early);
        for (index, input) in node.inputs.iter().enumerate() {
            let gap = self.separator(index);
            self.input(gap, input);
        }
        self.close_list(")", node.inputs.is_empty());
        self.writer.token(Gap::Space, "->");
        self.fields(Gap::Space, &node.outputs);
        if let Some(period) = tiles {
            self.writer.token(Gap::Space, "tiles");
            self.expr(Gap::Space, period);
        }
        self.body(&node.body);
    }

    fn input(&mut self, gap: Gap, input: &Input) {
        self.name(gap, &input.name);
        self.ty_of(&input.ty);
        if let Some(default) = &input.default {
            self.default(default);
        }
    }

    fn default(&mut self, value: &Expr) {
        self.writer.token(Gap::Space, "=");
        self.expr(Gap::Space, value);
    }

    fn fields(&mut self, gap: Gap, fields: &[Field]) {
        self.open_list(gap, "(", Style::Even);
        for (index, field) in fields.iter().enumerate() {
            let gap = self.separator(index);
            self.name(gap, &field.name);
            self.ty_of(&field.ty);
        }
        self.close_list(")", fields.is_empty());
    }

    /// `: type`
    fn ty_of(&mut self, ty: &Type) {
        self.writer.token(Gap::Glue, ":");
        self.ty(Gap::Space, ty);
    }

    fn ty(&mut self, gap: Gap, ty: &Type) {
        match &ty.kind {
            TypeKind::Named { name, dim } => {
                self.name(gap, name);
                self.dim(dim.as_ref());
            }
            TypeKind::Choice(names) => self.choice(gap, names),
            TypeKind::Node { inputs, output } => {
                self.writer.token(gap, "node");
                self.fields(Gap::Glue, inputs);
                self.writer.token(Gap::Space, "->");
                self.ty(Gap::Space, output);
            }
            TypeKind::Record(fields) => self.fields(gap, fields),
        }
    }

    fn choice(&mut self, gap: Gap, names: &[Name]) {
        self.writer.lead(gap);
        self.writer.open(Style::Even);
        for (index, name) in names.iter().enumerate() {
            if index == 1 {
                self.writer.indent();
            }
            if index > 0 {
                self.writer.token(Gap::Soft, "|");
            }
            self.name(if index > 0 { Gap::Space } else { Gap::Glue }, name);
        }
        self.writer.dedent();
        self.writer.close();
    }

    pub(super) fn dim(&mut self, dim: Option<&Dim>) {
        let span = match dim {
            None => return,
            Some(Dim::Name(name)) => name.span,
            Some(Dim::Number(_, span)) => *span,
        };
        self.writer.token(Gap::Glue, "<");
        self.writer.copy(Gap::Glue, span);
        self.writer.token(Gap::Glue, ">");
    }

    pub(super) fn name(&mut self, gap: Gap, name: &Name) {
        self.writer.copy(gap, name.span);
    }

    /// A list of names, which never breaks.
    pub(super) fn names(&mut self, open: &'static str, names: &[Name], close: &'static str) {
        self.writer.token(Gap::Glue, open);
        for (index, name) in names.iter().enumerate() {
            if index > 0 {
                self.writer.token(Gap::Glue, ",");
            }
            self.name(if index > 0 { Gap::Space } else { Gap::Glue }, name);
        }
        self.writer.drop_comma();
        self.writer.token(Gap::Glue, close);
    }

    pub(super) fn body(&mut self, body: &Body) {
        self.writer.token(Gap::Space, "{");
        if body.statements.is_empty() {
            self.writer.indent();
            return self.writer.close_bracket(Gap::Glue, "}");
        }
        self.writer.indent();
        let mut assignments = Vec::new();
        for (index, statement) in body.statements.iter().enumerate() {
            self.statement(index, statement, &mut assignments);
        }
        self.blocks.push(assignments);
        self.writer.close_bracket(Gap::Line(Blank::Never), "}");
    }

    fn statement(&mut self, index: usize, statement: &Statement, block: &mut Vec<Assignment>) {
        let gap = Gap::Line(if index == 0 { Blank::Never } else { Blank::Keep });
        self.writer.lead(gap);
        let (start, is_joined) = (self.writer.line_start, self.writer.plain && index > 0);
        match statement {
            Statement::Let { pattern, value, .. } => {
                self.writer.token(Gap::Glue, "let");
                match pattern {
                    Pattern::Name(name) => self.name(Gap::Space, name),
                    Pattern::Record(names, _) => {
                        self.writer.lead(Gap::Space);
                        self.names("(", names, ")");
                    }
                }
                self.assign(start, is_joined, value, block);
            }
            Statement::Assign { name, value } => {
                self.name(Gap::Glue, name);
                self.assign(start, is_joined, value, block);
            }
        }
    }

    /// `= value`, with what aligning it takes.
    fn assign(&mut self, start: usize, is_joined: bool, value: &Expr, block: &mut Vec<Assignment>) {
        let pad = self.writer.pieces.len();
        self.writer.pieces.push(Piece::Pad(0));
        self.default(value);
        let (end, level) = (self.writer.pieces.len(), self.writer.level);
        block.push(Assignment { start, pad, end, level, is_joined });
    }
}

/// Whether an item has a body.
fn is_block(item: &Item) -> bool {
    matches!(item.kind, ItemKind::Node(_) | ItemKind::Texture { .. })
}
