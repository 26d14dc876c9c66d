//! Blocks of expressions: calls, choices, folds and lambdas, with what is given to their ports.

use super::build::{Given, Maker, Value};
use super::formula::Formula;
use super::scope::{Callee, Head, callee_name};
use super::text;
use super::{End, Kind, Rate};
use crate::check::order::{Free, value_of};
use rustc_hash::FxHashSet;
use texgraph_grammar::syntax::{Call, Expr, Fold, Name, Span, Statement};

impl<'a> Maker<'a> {
    /// A block for a call.
    pub fn call(&mut self, call: &'a Call, module: usize, prefix: &str, receiver: Option<Formula>) -> Value {
        let name = callee_name(call);
        let first = receiver.map(|receiver| self.received(receiver));
        let kind = first.as_ref().and_then(|(_, _, kind)| *kind);
        let head = self.head(module, name, kind);
        let mut given: Vec<(usize, String, Given)> = Vec::new();
        given.extend(
            first.map(|(note, end, _)| (0, port_name(&head, 0), (note, end.map(|end| (end, false))))),
        );
        let offset = given.len();
        for (i, argument) in call.arguments.iter().enumerate() {
            let (place, port) = place_of(&head, argument.name.as_ref(), i + offset);
            given.push((place, port, self.operand(&argument.value)));
        }
        given.sort_by_key(|(place, ..)| *place);
        let kind = if head.is_constructor { Kind::Resource } else { Kind::Call };
        let block = self.block(kind, format!("{prefix}{name}"), Rate::Load);
        if let Some(node) = self.node_input(name) {
            self.connect(block, "", (String::new(), Some((node, true))));
        }
        for (_, port, given) in given {
            self.connect(block, &port, given);
        }
        self.outputs(block, name, &head)
    }

    /// The input that is a node of that name.
    fn node_input(&mut self, name: &'a str) -> Option<End> {
        let is_input = self.node_inputs.contains_key(name);
        let value = if is_input { self.name(name) } else { None };
        value.map(|value| self.end(value))
    }

    fn outputs(&mut self, block: usize, name: &'a str, head: &Head<'a>) -> Value {
        if head.is_constructor {
            self.add_output(block, name);
            self.kinds.insert(block, name);
            return Value::Resource(block);
        }
        let known = head.outputs.as_deref().unwrap_or_default();
        for output in known {
            self.add_output(block, output);
        }
        match known {
            [_] => Value::Port(End { block, port: 0 }),
            _ => Value::Record { block, open: head.outputs.is_none() },
        }
    }

    fn head(&self, module: usize, name: &str, receiver: Option<&str>) -> Head<'a> {
        if let Some(inputs) = self.node_inputs.get(name) {
            return Head { inputs: Some(inputs.clone()), ..Head::default() };
        }
        match self.scope.callee(module, name, receiver) {
            Callee::Block(head) => head,
            Callee::Function => Head::default(),
        }
    }

    pub fn choice(&mut self, arms: &'a [(Expr, Expr)], otherwise: &'a Expr) -> End {
        let mut given = Vec::new();
        for (i, (condition, arm)) in arms.iter().enumerate() {
            given.push((if i == 0 { "if" } else { "else if" }, self.operand(condition)));
            given.push(("then", self.operand(arm)));
        }
        given.push(("else", self.operand(otherwise)));
        let block = self.block(Kind::Choice, "choice".to_owned(), Rate::Load);
        for (name, given) in given {
            self.connect(block, name, given);
        }
        self.add_output(block, "");
        End { block, port: 0 }
    }

    pub fn fold(&mut self, expr: &'a Expr, fold: &'a Fold) -> Value {
        let starts: Vec<Given> = fold.accumulators.iter().map(|(_, start)| self.operand(start)).collect();
        let range = self.text(self.module, fold.range.span);
        let title = text::shorten(&format!("fold {} in {range}", fold.variable.text), 48);
        let block = self.block(Kind::Fold, title, Rate::Load);
        self.blocks[block].text = self.fold_text(fold);
        for ((name, _), start) in fold.accumulators.iter().zip(starts) {
            self.connect(block, &name.text, start);
            self.add_output(block, &name.text);
        }
        // The starts are read first, and have ports of their own.
        let starts: usize = fold.accumulators.iter().map(|(_, start)| Free::of(start).values.len()).sum();
        self.captures(block, Free::of(expr).values.split_off(starts));
        match fold.accumulators.len() {
            1 => Value::Port(End { block, port: 0 }),
            _ => Value::Record { block, open: false },
        }
    }

    fn fold_text(&self, fold: &Fold) -> Vec<String> {
        let mut lines = Vec::new();
        if let Some(max) = &fold.max {
            lines.push(format!("max {}", self.text(self.module, max.span)));
        }
        if let Some(condition) = &fold.condition {
            lines.push(format!("while {}", self.text(self.module, condition.span)));
        }
        for statement in &fold.body.statements {
            lines.push(self.text(self.module, span_of(statement)));
        }
        let mut lines: Vec<String> = lines.iter().flat_map(|line| text::wrap(line, 52, 4)).collect();
        if lines.len() > 16 {
            lines.truncate(15);
            lines.push("…".to_owned());
        }
        lines
    }

    pub fn lambda(&mut self, expr: &'a Expr, inputs: &'a [Name], body: &'a Expr) -> End {
        let inputs: Vec<&str> = inputs.iter().map(|input| input.text.as_str()).collect();
        let block = self.block(Kind::Lambda, format!("|{}|", inputs.join(", ")), Rate::Load);
        self.blocks[block].text = text::wrap(&self.text(self.module, body.span), 44, 8);
        self.captures(block, Free::of(expr).values);
        self.add_output(block, "");
        End { block, port: 0 }
    }

    /// An input for each name that a body reads from outside.
    fn captures(&mut self, block: usize, names: Vec<&'a str>) {
        let mut seen = FxHashSet::default();
        for name in names {
            let value = if seen.insert(name) { self.name(name) } else { None };
            if let Some(value) = value {
                let from = self.end(value);
                let is_node = self.node_inputs.contains_key(name);
                self.connect(block, name, (String::new(), Some((from, is_node))));
            }
        }
    }
}

fn span_of(statement: &Statement) -> Span {
    match statement {
        Statement::Let { span, .. } => *span,
        Statement::Assign { name, .. } => name.span.to(value_of(statement).span),
    }
}

/// The name of an input by position: its number where nobody knows the head.
fn port_name(head: &Head<'_>, position: usize) -> String {
    match head.inputs.as_ref().map(|inputs| inputs.get(position)) {
        Some(Some(name)) => (*name).to_owned(),
        _ => (position + 1).to_string(),
    }
}

/// Where an argument stands in the head, and what its port is called.
fn place_of(head: &Head<'_>, name: Option<&Name>, position: usize) -> (usize, String) {
    let Some(name) = name else { return (position, port_name(head, position)) };
    let known = head.inputs.as_ref().and_then(|inputs| inputs.iter().position(|input| *input == name.text));
    (known.unwrap_or(usize::MAX), name.text.to_string())
}
