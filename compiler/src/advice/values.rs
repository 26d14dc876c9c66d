//! Values of a wrong type: where they come from, and where they go to.

use super::consequences::{site, value};
use super::names::{Binding, Kind, contains};
use super::{Look, Related};
use crate::diagnostic::{Diagnostic, Suggestion};
use texgraph_grammar::syntax::{Name, Node, Span};

impl Look<'_, '_> {
    /// A value of a wrong type.
    pub(super) fn types(&self, diagnostic: &mut Diagnostic) -> Related {
        if let Some(suggestion) = &mut diagnostic.suggestion {
            self.simplify(suggestion);
        }
        if self.code == "E0213" {
            self.take_apart(diagnostic);
        }
        self.in_order(diagnostic);
        let mut values = vec![value(self.names, self.span())];
        values.extend(diagnostic.related.iter().map(|(place, _)| place.span));
        if self.code == "E0219" {
            let parts = self.names.call(self.span()).into_iter().flat_map(|site| &site.call.arguments);
            values.extend(parts.map(|part| part.value.span).filter(|part| !self.text(*part).contains('(')));
        }
        let mut related: Related = values.into_iter().filter_map(|value| self.source(value)).collect();
        related.extend(self.names.base(self.span()).map(|base| (base, "of this".to_owned())));
        if self.code == "E0225" {
            let operator = self.names.operator(self.span());
            related.extend(operator.map(|operator| (operator, "wants single numbers".to_owned())));
        }
        if matches!(self.code, "E0201" | "E0213" | "E0222" | "E0223") {
            related.extend(self.wanted_by_input().or_else(|| self.wanted_by_output()));
        }
        related
    }

    /// `(uv).x` is `uv.x`.
    fn simplify(&self, suggestion: &mut Suggestion) {
        let is_plain = self.text(self.span()).chars().all(|c| c.is_ascii_alphanumeric() || "_.".contains(c));
        if let [(_, before), (_, behind)] = suggestion.edits.as_mut_slice()
            && before == "("
            && is_plain
        {
            before.clear();
            *behind = behind.trim_start_matches(')').to_owned();
        }
        suggestion.edits.retain(|(place, text)| !text.is_empty() || place.span.start < place.span.end);
    }

    /// Several outputs under one name, where one value is wanted: the names that take them apart.
    fn take_apart(&self, diagnostic: &mut Diagnostic) {
        let record = self.names.meaning(self.span()).filter(|binding| binding.kind == Kind::Wire);
        let node = record.and_then(|record| self.record(record));
        let (Some(node), Some(help)) = (node, &diagnostic.help) else { return };
        let names: Vec<&str> = node.outputs.iter().map(|output| output.name.text.as_str()).collect();
        diagnostic.help = Some(format!("{help}, or take it apart: `let ({}) = …`", names.join(", ")));
    }

    /// Names that take outputs apart in another order than they come in.
    fn in_order(&self, diagnostic: &mut Diagnostic) {
        let read = self.names.read_within(self.span()).into_iter();
        let mut read = read.filter_map(|wire| self.names.bindings.get(wire));
        let Some(part) = read.find(|binding| binding.is_part) else { return };
        let node = self.names.call(part.value).and_then(|site| self.texts.node(&site.call.name.text));
        let outputs = node.map_or(&[][..], |node| &node.outputs);
        let outputs: Vec<&str> = outputs.iter().map(|output| output.name.text.as_str()).collect();
        let parts = self.names.bindings.iter().filter(|other| other.is_part && other.value == part.value);
        let parts: Vec<&str> = parts.map(|part| part.name.text.as_str()).collect();
        if parts.len() == outputs.len() && parts != outputs && parts.iter().all(|part| outputs.contains(part))
        {
            let help = format!("outputs are taken in their order: `let ({}) = …`", outputs.join(", "));
            (diagnostic.help, diagnostic.suggestion) = (Some(help), None);
        }
    }

    /// Where a value comes from: the declaration of the one name that it is made of, or the output of
    /// the node that gives it.
    fn source(&self, value: Span) -> Option<(Span, String)> {
        if let Some(node) = self.names.call(value).and_then(|site| self.names.callee(site)) {
            let (first, last) = (node.outputs.first()?, node.outputs.last()?);
            return Some((first.name.span.to(last.ty.span), format!("`{}` gives this", node.name.text)));
        }
        let read = self.names.read_within(value).into_iter();
        let wires = read.filter_map(|wire| self.names.bindings.get(wire));
        let is_name = self.names.meaning(value).is_some();
        let mut wires = wires.filter(|wire| is_name || wire.kind == Kind::Wire);
        let wire = wires.next().filter(|_| wires.next().is_none())?;
        Some((self.declaration(wire), format!("`{}` is declared here", wire.name.text)))
    }

    /// A `let` has the type of its value, which is shown too unless it is long.
    fn declaration(&self, wire: &Binding) -> Span {
        let whole = wire.span.to(wire.value);
        let is_let = wire.value != Span::default() && !self.text(whole).contains('\n');
        if is_let { whole } else { wire.span }
    }

    /// The input that a value is an argument for.
    fn wanted_by_input(&self) -> Option<(Span, String)> {
        let (site, position) = self.names.argument(self.span())?;
        let Some(node) = self.names.callee(site) else {
            return Some((site.call.name.span, "in this call".to_owned()));
        };
        let named = site.call.arguments.iter().find(|argument| argument.value.span == self.span());
        let named = named.and_then(|argument| argument.name.as_ref());
        let input = match named {
            Some(name) => node.inputs.iter().find(|input| input.name.text == name.text),
            None => node.inputs.get(position),
        }?;
        Some((input.name.span.to(input.ty.span), format!("`{}` is declared here", input.name.text)))
    }

    /// The output or accumulator that a value is assigned to, or the param or input whose default it
    /// is.
    fn wanted_by_output(&self) -> Option<(Span, String)> {
        let name = self.names.assigned(self.span())?;
        let declares = |binding: &&Binding| {
            let has_type = matches!(binding.kind, Kind::Output | Kind::Item | Kind::Input);
            has_type && binding.name.text == name.text && contains(binding.scope, self.span())
        };
        let output = self.names.bindings.iter().rfind(declares)?;
        Some((output.span, format!("`{}` is declared here", name.text)))
    }

    /// What is wrong with an argument may be wrong with the name of what is called, or with its head.
    pub(super) fn in_call(&self) -> Related {
        let base = self.names.base(self.span());
        let mut related: Related = base.map(|base| (base, "of this".to_owned())).into_iter().collect();
        let Some(site) = site(self) else { return related };
        let name = site.call.name.span;
        if !contains(self.span(), name) {
            related.push((name, "in this call".to_owned()));
        }
        if let Some(node) = self.names.callee(site) {
            let inputs: Vec<&Name> = node.inputs.iter().map(|input| &input.name).collect();
            related.extend(self.row(&inputs));
        }
        related
    }

    /// A wire that needs itself: where it is declared.
    pub(super) fn ring(&self) -> Related {
        let wire = self.names.meaning(self.span());
        wire.map(|wire| (wire.span, format!("`{}` is declared here", wire.name.text))).into_iter().collect()
    }

    /// A node that calls itself: its head.
    pub(super) fn own_call(&self) -> Related {
        let node = self.names.call(self.span()).and_then(|site| self.names.callee(site));
        let head = |node: &Node| (node.name.span, format!("`{}` is declared here", node.name.text));
        node.map(head).into_iter().collect()
    }

    /// A dimension that nobody declared: those that are.
    pub(super) fn no_dimension(&self) -> Related {
        let node = self.names.node(self.span());
        let dims: Vec<&Name> = node.map_or(Vec::new(), |node| node.dims.iter().collect());
        self.row(&dims).into_iter().collect()
    }
}
