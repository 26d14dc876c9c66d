//! Expressions: what is a formula and what is a block.
//!
//! A formula is the text of an expression in which every call of a node has been replaced by the
//! name of the block that it became. What the formula reads are its *uses*; they become wires.

use super::End;
use super::build::{Given, Maker, Value};
use super::scope::Callee;
use super::text::{self, subscript};
use crate::check::order::Free;
use rustc_hash::{FxHashMap, FxHashSet};
use texgraph_grammar::syntax::{Argument, Call, Expr, ExprKind, Postfix, Span};

/// Columns of a formula that is written beside the port it goes to, at most.
const BESIDE: usize = 30;

/// Bytes of an `if` that stays a formula, at most.
const SHORT_IF: u32 = 60;

/// An expression on its way to a text.
pub struct Formula {
    span: Span,
    /// What stands in place of the blocks.
    parts: Vec<(Span, String)>,
    /// What it reads.
    pub uses: Vec<Use>,
    seen: FxHashSet<Value>,
    /// How many blocks of a name there are, to number them.
    names: FxHashMap<String, usize>,
}

/// Something that a formula reads.
pub struct Use {
    pub value: Value,
    /// As the formula names it.
    pub label: String,
}

impl Formula {
    fn new(span: Span) -> Formula {
        Formula {
            span,
            parts: Vec::new(),
            uses: Vec::new(),
            seen: FxHashSet::default(),
            names: FxHashMap::default(),
        }
    }

    fn reads(&mut self, value: Value, label: String) {
        if self.seen.insert(value) {
            self.uses.push(Use { value, label });
        }
    }

    /// The name of a block where its call stood.
    fn replace(&mut self, span: Span, name: &str) -> String {
        let count = self.names.entry(name.to_owned()).or_insert(0);
        *count += 1;
        let label = if *count == 1 { name.to_owned() } else { format!("{name}{}", subscript(*count)) };
        self.parts.push((span, label.clone()));
        label
    }
}

/// How far a chain of methods has come: what its links so far have made, how many they are, and
/// where they end.
#[derive(Clone, Copy)]
struct Done<'a> {
    value: Value,
    name: &'a str,
    links: usize,
    end: u32,
}

impl<'a> Maker<'a> {
    /// An expression as a value: a block, or what it names.
    pub fn value(&mut self, expr: &'a Expr) -> Value {
        let (formula, text) = self.formula(expr);
        match formula.uses.as_slice() {
            [used] if used.label == text => used.value,
            _ => Value::Port(self.formula_block(&formula, &text)),
        }
    }

    /// An expression as what is given to a port.
    pub fn operand(&mut self, expr: &'a Expr) -> Given {
        if let ExprKind::Lambda { inputs, body } = &expr.kind {
            return (String::new(), Some((self.lambda(expr, inputs, body), true)));
        }
        let (formula, text) = self.formula(expr);
        let given = match formula.uses.as_slice() {
            [] => (text::shorten(&text, BESIDE), None),
            [used] if used.label == text => (String::new(), Some(self.end(used.value))),
            [used] if text::width(&text) <= BESIDE => (text, Some(self.end(used.value))),
            _ => (String::new(), Some(self.formula_block(&formula, &text))),
        };
        let is_node =
            matches!(&expr.kind, ExprKind::Name(name) if self.node_inputs.contains_key(name.as_str()));
        (given.0, given.1.map(|end| (end, is_node)))
    }

    fn formula(&mut self, expr: &'a Expr) -> (Formula, String) {
        let mut inner = expr;
        while let ExprKind::Paren(inside) = &inner.kind {
            inner = inside;
        }
        let mut formula = Formula::new(inner.span);
        self.read(&mut formula, inner);
        let text = self.formula_text(&formula);
        (formula, text)
    }

    fn formula_text(&self, formula: &Formula) -> String {
        self.text_with(self.module, formula.span, &formula.parts)
    }

    /// Finds the uses of an expression, and makes its blocks. Recursion is bounded by the nesting
    /// of the text.
    fn read(&mut self, formula: &mut Formula, expr: &'a Expr) {
        match &expr.kind {
            ExprKind::Name(name) => {
                if let Some(value) = self.name(name) {
                    formula.reads(value, name.to_string());
                }
            }
            ExprKind::Paren(inner) => self.read(formula, inner),
            ExprKind::Unary { operand, .. } => self.read(formula, operand),
            ExprKind::Chain { first, links } => {
                self.read(formula, first);
                links.iter().for_each(|link| self.read(formula, &link.operand));
            }
            ExprKind::List(items) => items.iter().for_each(|item| self.read(formula, item)),
            ExprKind::Call(call) if self.is_function(call) => self.read_arguments(formula, &call.arguments),
            ExprKind::Call(call) => {
                let value = self.call(call, self.module, "", None);
                self.stands_for(formula, expr.span, value, &call.name.text);
            }
            ExprKind::Postfix { base, links } => self.postfix(formula, base, links),
            ExprKind::If { arms, otherwise } => {
                if self.is_short(expr) {
                    arms.iter().flat_map(|(c, arm)| [c, arm]).for_each(|part| self.read(formula, part));
                    self.read(formula, otherwise);
                } else {
                    let end = self.choice(arms, otherwise);
                    self.stands_for(formula, expr.span, Value::Port(end), "choice");
                }
            }
            ExprKind::Fold(fold) => {
                let value = self.fold(expr, fold);
                self.stands_for(formula, expr.span, value, "fold");
            }
            ExprKind::Lambda { .. } => {
                for name in Free::of(expr).values {
                    if let Some(value) = self.name(name) {
                        formula.reads(value, name.to_owned());
                    }
                }
            }
            ExprKind::Int(_)
            | ExprKind::Float(_)
            | ExprKind::Bool(_)
            | ExprKind::Text(_)
            | ExprKind::Color(_) => {}
        }
    }

    fn read_arguments(&mut self, formula: &mut Formula, arguments: &'a [Argument]) {
        arguments.iter().for_each(|argument| self.read(formula, &argument.value));
    }

    fn stands_for(&mut self, formula: &mut Formula, span: Span, value: Value, name: &str) {
        let label = formula.replace(span, name);
        formula.reads(value, label);
    }

    /// Fields, indices and methods. Each method that is a block takes what stands before it.
    fn postfix(&mut self, formula: &mut Formula, base: &'a Expr, links: &'a [Postfix]) {
        let alias = self.alias(base);
        let mut done: Option<Done<'a>> = None;
        for (i, link) in links.iter().enumerate() {
            let Postfix::Method(call, span) = link else { continue };
            let module = alias.filter(|_| i == 0);
            if module.is_none() && self.is_function(call) {
                continue;
            }
            let value = match (module, base) {
                (Some(module), Expr { kind: ExprKind::Name(alias), .. }) => {
                    self.call(call, module, &format!("{alias}."), None)
                }
                _ => {
                    let end = links.get(i.wrapping_sub(1)).map_or(base.span.end, end_of);
                    let mut receiver = Formula::new(Span { start: base.span.start, end });
                    self.links(&mut receiver, base, links.get(..i).unwrap_or_default(), done);
                    self.call(call, self.module, "", Some(receiver))
                }
            };
            done = Some(Done { value, name: &call.name.text, links: i + 1, end: span.end });
        }
        self.links(formula, base, links, done);
    }

    /// The rest of a chain, in which nothing is a block.
    fn links(&mut self, formula: &mut Formula, base: &'a Expr, links: &'a [Postfix], done: Option<Done<'a>>) {
        let (value, label, next) = match done {
            Some(done) => {
                let span = Span { start: base.span.start, end: done.end };
                (Some(done.value), formula.replace(span, done.name), done.links)
            }
            None => self.base(formula, base, links),
        };
        let field = match (value, links.get(next)) {
            (Some(value), Some(Postfix::Field(field))) => {
                self.select(value, &field.text).map(|part| (part, format!("{label}.{}", field.text)))
            }
            _ => None,
        };
        match (field, value) {
            (Some((part, label)), _) => formula.reads(part, label),
            (None, Some(value)) => formula.reads(value, label),
            (None, None) => {}
        }
        for link in links.get(next..).unwrap_or_default() {
            match link {
                Postfix::Field(_) => {}
                Postfix::Method(call, _) => self.read_arguments(formula, &call.arguments),
                Postfix::Index(index, _) => self.read(formula, index),
            }
        }
    }

    /// What a chain begins with: its value, its name, and how many links that takes. Anything but a
    /// name is read here and has no value of its own.
    fn base(
        &mut self,
        formula: &mut Formula,
        base: &'a Expr,
        links: &'a [Postfix],
    ) -> (Option<Value>, String, usize) {
        let ExprKind::Name(name) = &base.kind else {
            self.read(formula, base);
            return (None, String::new(), 0);
        };
        if let (Some(module), Some(Postfix::Field(item))) = (self.alias(base), links.first()) {
            let label = format!("{name}.{}", item.text);
            return (self.global(module, &item.text, &label), label, 1);
        }
        (self.name(name), name.to_string(), 0)
    }

    /// The module that an expression names, if it is nothing else.
    fn alias(&mut self, base: &'a Expr) -> Option<usize> {
        let ExprKind::Name(name) = &base.kind else { return None };
        let module = self.scope.alias(self.module, name)?;
        self.name(name).is_none().then_some(module)
    }

    /// What stands before a method: its text if that says more than the wire, the wire, and the
    /// kind of resource.
    pub fn received(&mut self, formula: Formula) -> (String, Option<End>, Option<&'a str>) {
        let text = self.formula_text(&formula);
        match formula.uses.as_slice() {
            [] => (text::shorten(&text, BESIDE), None, None),
            [used] => {
                let kind = match used.value {
                    Value::Resource(block) => self.kinds.get(&block).copied(),
                    _ => None,
                };
                let end = self.end(used.value);
                if used.label == text {
                    (String::new(), Some(end), kind)
                } else if text::width(&text) <= BESIDE {
                    (text, Some(end), None)
                } else {
                    (String::new(), Some(self.formula_block(&formula, &text)), None)
                }
            }
            _ => (String::new(), Some(self.formula_block(&formula, &text)), None),
        }
    }

    /// Whether a call is a part of the formula it stands in.
    fn is_function(&self, call: &Call) -> bool {
        let name = call.name.text.as_str();
        !self.node_inputs.contains_key(name) && self.scope.callee(self.module, name, None) == Callee::Function
    }

    /// Whether an `if` can be read as a formula.
    fn is_short(&self, expr: &Expr) -> bool {
        expr.span.end - expr.span.start <= SHORT_IF && !self.has_block(expr)
    }

    /// Whether a part of an expression becomes a block. Asked of short ones only.
    fn has_block(&self, expr: &Expr) -> bool {
        match &expr.kind {
            ExprKind::Call(call) => {
                !self.is_function(call) || call.arguments.iter().any(|a| self.has_block(&a.value))
            }
            ExprKind::Postfix { base, links } => {
                let is_block = |link: &Postfix| match link {
                    Postfix::Field(_) => false,
                    Postfix::Method(call, _) => {
                        !self.is_function(call) || call.arguments.iter().any(|a| self.has_block(&a.value))
                    }
                    Postfix::Index(index, _) => self.has_block(index),
                };
                self.has_block(base) || links.iter().any(is_block)
            }
            ExprKind::Paren(inner) | ExprKind::Unary { operand: inner, .. } => self.has_block(inner),
            ExprKind::Chain { first, links } => {
                self.has_block(first) || links.iter().any(|link| self.has_block(&link.operand))
            }
            ExprKind::If { arms, otherwise } => {
                arms.iter().any(|(c, arm)| self.has_block(c) || self.has_block(arm))
                    || self.has_block(otherwise)
            }
            ExprKind::List(items) => items.iter().any(|item| self.has_block(item)),
            ExprKind::Fold(_) => true,
            _ => false,
        }
    }
}

fn end_of(link: &Postfix) -> u32 {
    match link {
        Postfix::Field(name) => name.span.end,
        Postfix::Method(_, span) | Postfix::Index(_, span) => span.end,
    }
}
