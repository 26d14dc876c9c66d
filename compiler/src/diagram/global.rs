//! What files declare: resources, constants and params, each a block that is drawn once.

use super::build::{Maker, Value};
use super::scope::{Callee, callee_name};
use super::text;
use super::{End, Kind, Rate};
use crate::check::order::Free;
use rustc_hash::FxHashSet;
use texgraph_grammar::syntax::{Expr, ExprKind, Item, ItemKind, Span};

impl<'a> Maker<'a> {
    /// The value of that name that a file or one that joined it declares; shown as `label`.
    pub fn global(&mut self, module: usize, name: &'a str, label: &str) -> Option<Value> {
        let (home, item) = self.scope.global(module, name)?;
        if let Some(known) = self.globals.get(&(home, name)) {
            return Some(*known);
        }
        let value = self.declare(home, item, label)?;
        self.globals.insert((home, name), value);
        Some(value)
    }

    fn declare(&mut self, module: usize, item: &'a Item, label: &str) -> Option<Value> {
        match &item.kind {
            ItemKind::Let { value, .. } => Some(self.declare_let(module, value, label)),
            ItemKind::Param { name, ty, default, range } => {
                let title = format!("{label}: {}", self.text(module, ty.span));
                let block = self.block(Kind::Param, title, Rate::Draw);
                let after = range.as_ref().map_or(default.span.end, |range| range.span.end);
                let line = self.text(module, Span { start: ty.span.end.max(name.span.end), end: after });
                self.blocks[block].text = text::wrap(&line, 32, 3);
                self.add_output(block, "");
                Some(Value::Port(End { block, port: 0 }))
            }
            _ => None,
        }
    }

    fn declare_let(&mut self, module: usize, value: &'a Expr, label: &str) -> Value {
        let kind = self.constructor(module, value);
        let block = self.block(
            if kind.is_some() { Kind::Resource } else { Kind::Constant },
            label.to_owned(),
            Rate::Load,
        );
        let line = self.text(module, value.span);
        self.blocks[block].text = text::wrap(&line, 32, 6);
        self.pending.push((block, module, value));
        let Some(kind) = kind else {
            self.add_output(block, "");
            return Value::Port(End { block, port: 0 });
        };
        self.add_output(block, kind);
        self.kinds.insert(block, kind);
        Value::Resource(block)
    }

    /// The kind of resource that an expression makes.
    fn constructor(&self, module: usize, value: &'a Expr) -> Option<&'a str> {
        let ExprKind::Call(call) = &value.kind else { return None };
        match self.scope.callee(module, callee_name(call), None) {
            Callee::Block(head) if head.is_constructor => Some(callee_name(call)),
            _ => None,
        }
    }

    /// Draws the wires between declarations; those that only they read are drawn too.
    pub fn wire_globals(&mut self) {
        while let Some((block, module, value)) = self.pending.pop() {
            let mut seen = FxHashSet::default();
            for name in Free::of(value).values {
                let read = if seen.insert(name) { self.global(module, name, name) } else { None };
                if let Some(read) = read {
                    let from = self.end(read);
                    self.connect(block, name, (String::new(), Some((from, false))));
                }
            }
        }
    }
}
