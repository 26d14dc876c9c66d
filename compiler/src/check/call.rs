//! Calls: which node, intrinsic or constructor a name means, and what calling it gives.

use super::arguments::{Arguments, Bound, Given};
use super::head::Head;
use super::types;
use super::view::view_of;
use super::wire::{ArgumentKey, ImportedNodes, Key, Wire};
use super::{Checker, Frame, Outcome};
use crate::diagnostic::{Place, arguments as sentences, names};
use crate::graph::{Constant, FunctionId, Operation, Texel, Type, Value, View};
use crate::library::Callable;
use crate::resource::KINDS;
use smol_str::SmolStr;
use std::rc::Rc;
use texgraph_grammar::syntax::{Argument, Call, Dim, Expr, ExprKind, Field, Postfix, Span};

/// What is called, as written.
#[derive(Clone, Copy)]
pub struct Callee<'a> {
    /// The name.
    pub name: &'a str,
    /// Where it stands.
    pub place: Place,
    /// `<n>`
    pub dim: Option<&'a Dim>,
}

impl<'a> Checker<'a> {
    pub(super) fn callee(&self, f: &Frame<'a>, call: &'a Call) -> Callee<'a> {
        Callee { name: &call.name.text, place: self.place(f, call.name.span), dim: call.dim.as_ref() }
    }

    /// `name<n>(arguments)`
    pub(super) fn call(&mut self, f: &mut Frame<'a>, call: &'a Call, span: Span) -> Wire {
        let place = self.place(f, span);
        let mut given = Arguments::new();
        let candidates = self.callables_of(f.module, &call.name.text);
        self.evaluate(f, &candidates, &call.arguments, &mut given);
        if let Some(Wire::Node(node)) = f.lookup(&call.name.text) {
            let callee = self.callee(f, call);
            return self.call_passed(f, &node, callee, &given, place);
        }
        if candidates.is_empty()
            && let Some(wire) = self.special(f, call, &given, place)
        {
            return wire;
        }
        if candidates.is_empty() {
            let callee = self.callee(f, call);
            return self.no_callable(f, callee, &given);
        }
        let callee = self.callee(f, call);
        self.call_one_of(f, &candidates, callee, &given, place)
    }

    /// `base.name<n>(arguments)`: the base is the first argument.
    pub(super) fn method(
        &mut self,
        f: &mut Frame<'a>,
        base: Wire,
        base_place: Place,
        call: &'a Call,
        span: Span,
    ) -> Wire {
        let place = self.place(f, span);
        let mut given = Arguments::new();
        given.push(Given { name: None, wire: base, place: base_place, expr: None });
        let candidates = self.callables_of(f.module, &call.name.text);
        self.evaluate(f, &candidates, &call.arguments, &mut given);
        if let Some(view) = view_of(&given[0].wire)
            && let Some(wire) = self.view_method(f, view, call, &given[1..], place)
        {
            return wire;
        }
        if matches!(given[0].wire, Wire::Unknown) {
            // What is called on something unknown is unknown too.
            return Wire::Unknown;
        }
        let sampled = matches!(call.name.text.as_str(), "sample" | "texel" | "level");
        let callee = self.callee(f, call);
        if let Some(Wire::Node(node)) = f.lookup(&call.name.text) {
            return self.call_passed(f, &node, callee, &given, place);
        }
        if candidates.is_empty() {
            if let Some(wire) = self.special(f, call, &given, place) {
                return wire;
            }
            return if sampled {
                self.no_view(f, call, &given[0])
            } else {
                self.no_callable(f, callee, &given)
            };
        }
        self.call_one_of(f, &candidates, callee, &given, place)
    }

    /// `sample` of something that has no texels of its own.
    fn no_view(&mut self, f: &mut Frame<'a>, call: &Call, base: &Given<'a>) -> Wire {
        let name = &call.name.text;
        let at = self.place(f, call.name.span);
        let found = types::describe(&base.wire, |v| f.builder.ty(v));
        let has_it = |view: View| name == "texel" || view.texel == Texel::Sampled;
        let kinds = KINDS.iter().filter(|kind| kind.stands_for().is_some_and(has_it));
        let views: Vec<String> = kinds.map(|kind| format!("`{}`", kind.name)).collect();
        let mut error = sentences::bad_receiver(at, name, &found, &views);
        if let Wire::Resource(resource) = &base.wire
            && let Some((field, view)) = resource.views.first()
            && let Type::View(view) = f.builder.ty(*view)
            && has_it(view)
        {
            error = error.help(format!("it has a view of its own: `.{field}.{name}(…)`"));
        }
        self.report(f, error)
    }

    /// A call of an item of an imported file.
    pub(super) fn imported_call(
        &mut self,
        f: &mut Frame<'a>,
        alias: &str,
        module: usize,
        call: &'a Call,
        span: Span,
    ) -> Wire {
        let place = self.place(f, span);
        let mut given = Arguments::new();
        let candidates = self.own_callables(module, &call.name.text).to_vec();
        self.evaluate(f, &candidates, &call.arguments, &mut given);
        if candidates.is_empty() {
            let at = self.place(f, call.name.span);
            if self.globals[module].contains_key(call.name.text.as_str()) {
                return self.report(f, names::value_as_node(at, &format!("{alias}.{}", call.name.text)));
            }
            let near = self.near_item(module, &call.name.text);
            return self
                .report(f, crate::diagnostic::imports::no_such_item(at, alias, &call.name.text, near));
        }
        let callee = self.callee(f, call);
        self.call_one_of(f, &candidates, callee, &given, place)
    }

    /// Adds what arguments are worth.
    fn evaluate(
        &mut self,
        f: &mut Frame<'a>,
        callables: &[Callable],
        arguments: &'a [Argument],
        given: &mut Arguments<'a>,
    ) {
        for Argument { name, value } in arguments {
            let place = self.place(f, value.span);
            let wire = match (name, &value.kind) {
                (Some(input), ExprKind::Name(word))
                    if f.bound.contains_key(word.as_str())
                        && self.is_choice(callables, &input.text, word) =>
                {
                    Wire::word(word, place)
                }
                _ => self.argument_wire(f, value),
            };
            given.push(Given { name: name.as_ref(), wire, place, expr: Some(value) });
        }
    }

    /// An argument, which unlike other expressions may be a lambda, or a node of another file.
    fn argument_wire(&mut self, f: &mut Frame<'a>, expr: &'a Expr) -> Wire {
        if let ExprKind::Lambda { .. } = expr.kind {
            return Wire::Lambda;
        }
        if let ExprKind::Postfix { base, links } = &expr.kind
            && let [Postfix::Field(name)] = links.as_slice()
            && let Some(module) = self.alias_of(f, base)
            && !self.globals[module].contains_key(name.text.as_str())
        {
            let callables = self.own_callables(module, &name.text);
            if let (ExprKind::Name(alias), false) = (&base.kind, callables.is_empty()) {
                let name = format!("{alias}.{}", name.text);
                return Wire::Callables(Rc::new(ImportedNodes { name, callables: callables.to_vec() }));
            }
        }
        self.expr(f, expr)
    }

    pub(super) fn apply(
        &mut self,
        f: &mut Frame<'a>,
        callable: Callable,
        head: Head<'a>,
        dim: Option<&Dim>,
        given: &[Given<'a>],
        place: Place,
    ) -> Wire {
        let stops = super::constructor::joined_stops(head, given);
        let given = stops.as_deref().unwrap_or(given);
        let Some(bound) = self.bind_arguments(f, head, dim, given, place) else {
            return Wire::Unknown;
        };
        f.builder.set_place(place);
        self.warn_of_call(f, callable, &head, given);
        match callable {
            Callable::Node(module, item) => self.call_node(f, (module, item, None), bound, place),
            Callable::Intrinsic(intrinsic) => {
                let values: Option<Vec<Value>> = bound.wires.iter().map(as_value).collect();
                values.map_or(Wire::Unknown, |values| Wire::Value(f.builder.builtin(intrinsic, &values)))
            }
            Callable::Constructor(kind) => self.construct(f, kind, head, bound, place),
        }
    }

    pub(super) fn call_node(
        &mut self,
        f: &mut Frame<'a>,
        (module, item, wire): (usize, usize, Option<String>),
        bound: Bound,
        place: Place,
    ) -> Wire {
        let mut values = Vec::with_capacity(bound.wires.len());
        let arguments = bound.wires.into_iter().map(|wire| key_of(f, wire, &mut values)).collect();
        let dims = bound.dims.iter().map(|(_, width)| *width).collect();
        let key = Key { module, item, dims, arguments, wire };
        match self.made.get(&key) {
            None => {
                f.waiting.push((key, place));
                Wire::Unknown
            }
            Some(Outcome::Failed) => {
                f.failed = true;
                Wire::Unknown
            }
            Some(Outcome::Made(id)) => {
                let id = *id;
                let results = self.results(f, id, values);
                match key.wire {
                    None => self.node_outputs(module, item, results),
                    Some(_) => self.wire_outputs(id, results),
                }
            }
        }
    }

    /// The outputs of a node from the values of its function.
    fn node_outputs(&self, module: usize, item: usize, results: Vec<Value>) -> Wire {
        let outputs = self.node(module, item).map_or(&[][..], |node| &node.outputs);
        let mut results = results.into_iter();
        let mut wire = |output: &Field| match types::matrix(&output.ty) {
            Some(size) => Wire::Matrix(results.by_ref().take(usize::from(size)).collect()),
            None => results.next().map_or(Wire::Unknown, Wire::Value),
        };
        match outputs {
            [only] => wire(only),
            _ => {
                let record = outputs.iter().map(|output| (output.name.text.clone(), wire(output)));
                Wire::Record(Rc::new(record.collect()))
            }
        }
    }

    /// The outputs of a function that gives a wire of a node.
    fn wire_outputs(&self, id: FunctionId, results: Vec<Value>) -> Wire {
        let slots = self.functions[id.0 as usize].outputs.iter().map(|(slot, _)| slot.name.clone());
        let mut record: Vec<(SmolStr, Wire)> = slots.zip(results.into_iter().map(Wire::Value)).collect();
        if record.len() == 1 { record.remove(0).1 } else { Wire::Record(Rc::new(record)) }
    }

    /// Calls a function; its outputs, as numbers where they are known.
    pub(super) fn results(&mut self, f: &mut Frame<'a>, id: FunctionId, arguments: Vec<Value>) -> Vec<Value> {
        let callee = &self.functions[id.0 as usize];
        let known = callee.outputs.iter().map(|(_, value)| match callee.operation(*value) {
            Operation::Constant(constant) => Some(*constant),
            _ => None,
        });
        match known.collect::<Option<Vec<Constant>>>() {
            Some(known) => known.into_iter().map(|constant| f.builder.constant(constant)).collect(),
            None => f.builder.call(id, callee, arguments),
        }
    }

    fn no_callable(&mut self, f: &mut Frame<'a>, callee: Callee<'a>, given: &[Given<'a>]) -> Wire {
        if given.iter().any(|given| matches!(given.wire, Wire::Word(_))) {
            // A word may be a choice of whatever was meant.
            let names = self.library.callable_names();
            let all: Vec<Callable> =
                names.iter().flat_map(|name| self.library.callables(name)).copied().collect();
            self.words(f, &all, given);
        }
        let Callee { name, place, .. } = callee;
        if self.is_value(f, name) {
            if f.scopes
                .iter()
                .rev()
                .find_map(|scope| scope.get(name))
                .is_some_and(|wire| matches!(wire, Wire::Unknown))
            {
                return Wire::Unknown;
            }
            return self.report(f, names::value_as_node(place, name));
        }
        let own = self.modules[f.module].tree.items.iter().filter_map(super::globals::node_of);
        let own: Vec<&str> = own.map(|node| node.name.text.as_str()).collect();
        let known = own.into_iter().chain(self.library.callable_names()).chain(SPECIAL.iter().copied());
        let near = self.near(name, known);
        self.report(f, names::unknown_callable(place, name, near))
    }
}

/// What `special` knows, for suggestions.
const SPECIAL: &[&str] =
    &["float", "vec2", "vec3", "vec4", "int", "ivec2", "ivec3", "ivec4", "dx", "dy", "sample", "texel"];

/// What of an argument is part of the function; the rest joins the values that it is called with.
fn key_of(f: &Frame<'_>, wire: Wire, values: &mut Vec<Value>) -> ArgumentKey {
    let mut number = |value: Value| match f.builder.as_constant(value) {
        Some(constant) => ArgumentKey::Constant(constant),
        None => {
            values.push(value);
            ArgumentKey::Value(f.builder.ty(value))
        }
    };
    match wire {
        Wire::Value(value) => number(value),
        Wire::Matrix(columns) => ArgumentKey::Matrix(columns.iter().map(|column| number(*column)).collect()),
        Wire::Resource(resource) => {
            values.extend(resource.views.iter().map(|(_, view)| *view));
            ArgumentKey::Resource(resource.kind, resource.constants.clone())
        }
        Wire::Node(node) => {
            values.extend(&node.captures);
            ArgumentKey::Node(node.function)
        }
        Wire::Word(word) => ArgumentKey::Word(word.text.clone()),
        _ => ArgumentKey::None,
    }
}

fn as_value(wire: &Wire) -> Option<Value> {
    match wire {
        Wire::Value(value) => Some(*value),
        _ => None,
    }
}
