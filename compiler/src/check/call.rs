//! Calls: which node, intrinsic or constructor a name means, and what calling it gives.

use super::arguments::{Bound, Given, Head};
use super::types;
use super::view::view_of;
use super::wire::{ArgumentKey, Key, Wire};
use super::{Checker, Frame, Outcome};
use crate::diagnostic::{Place, arguments as sentences, names};
use crate::graph::{Operation, Value};
use crate::library::Callable;
use crate::resource::KINDS;
use std::rc::Rc;
use texgraph_grammar::syntax::{Argument, Call, Expr, ExprKind, Input, Span, TypeKind};

impl<'a> Checker<'a> {
    /// `name<n>(arguments)`
    pub(super) fn call(&mut self, f: &mut Frame<'a>, call: &'a Call, span: Span) -> Wire {
        let place = self.place(f, span);
        let given = self.given(f, &call.arguments);
        let candidates = self.callables_of(f.module, &call.name.text);
        if candidates.is_empty()
            && let Some(wire) = self.special(f, call, &given, place)
        {
            return wire;
        }
        if candidates.is_empty() {
            return self.no_callable(f, call, &given);
        }
        self.call_one_of(f, &candidates, call, given, place)
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
        let arguments = self.given(f, &call.arguments);
        if let Some(view) = view_of(&base)
            && let Some(wire) = self.view_method(f, view, call, &arguments, place)
        {
            return wire;
        }
        if matches!(base, Wire::Unknown) {
            // What is called on something unknown is unknown too.
            return Wire::Unknown;
        }
        let sampled = matches!(call.name.text.as_str(), "sample" | "texel" | "level");
        let receiver = Given { name: None, wire: base, place: base_place, word: None };
        let given: Vec<Given<'a>> = std::iter::once(receiver).chain(arguments).collect();
        let candidates = self.callables_of(f.module, &call.name.text);
        if candidates.is_empty() {
            if let Some(wire) = self.special(f, call, &given, place) {
                return wire;
            }
            return if sampled {
                self.no_view(f, call, &given[0])
            } else {
                self.no_callable(f, call, &given)
            };
        }
        self.call_one_of(f, &candidates, call, given, place)
    }

    /// `sample` of something that has no texels of its own.
    fn no_view(&mut self, f: &mut Frame<'a>, call: &Call, base: &Given<'a>) -> Wire {
        let name = &call.name.text;
        let at = self.place(f, call.name.span);
        let found = types::describe(&base.wire, |v| f.builder.ty(v));
        let views: Vec<String> =
            KINDS.iter().filter(|kind| kind.view.is_some()).map(|kind| format!("`{}`", kind.name)).collect();
        let mut error = sentences::bad_receiver(at, name, &found, &views);
        if let Wire::Resource(resource) = &base.wire
            && let Some((field, _)) = resource.views.first()
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
        let given = self.given(f, &call.arguments);
        let candidates = self.own_callables(module, &call.name.text);
        if candidates.is_empty() {
            let at = self.place(f, call.name.span);
            if self.globals[module].contains_key(&call.name.text) {
                return self.report(f, names::value_as_node(at, &format!("{alias}.{}", call.name.text)));
            }
            let near = self.near_item(module, &call.name.text);
            return self
                .report(f, crate::diagnostic::imports::no_such_item(at, alias, &call.name.text, near));
        }
        self.call_one_of(f, &candidates, call, given, place)
    }

    fn given(&mut self, f: &mut Frame<'a>, arguments: &'a [Argument]) -> Vec<Given<'a>> {
        arguments
            .iter()
            .map(|argument| Given {
                name: argument.name.as_ref(),
                wire: self.expr(f, &argument.value),
                place: self.place(f, argument.value.span),
                word: word(&argument.value),
            })
            .collect()
    }

    /// What a name may mean in a file, nearest first.
    fn callables_of(&self, module: usize, name: &str) -> Vec<Callable> {
        let mut found = Vec::new();
        if module >= self.library.modules().len() {
            found.extend(self.own_callables(module, name));
            for import in self.modules[module].imports.iter().filter(|import| import.alias.is_none()) {
                found.extend(self.own_callables(import.module, name));
            }
            if name.starts_with('_') {
                return found;
            }
        }
        found.extend(self.library.callables(name));
        found
    }

    pub(super) fn own_callables(&self, module: usize, name: &str) -> Vec<Callable> {
        self.callables[module].get(name).cloned().unwrap_or_default()
    }

    pub(super) fn head(&self, callable: Callable) -> Option<Head<'a>> {
        let library: &'a crate::library::Library = self.library;
        match callable {
            Callable::Node(module, item) => self.node(module, item).map(|node| Head {
                name: &node.name.text,
                dims: &node.dims,
                inputs: &node.inputs,
                module,
            }),
            Callable::Intrinsic(intrinsic) => library.signature(callable).map(|signature| Head {
                name: intrinsic.row().name,
                dims: &signature.dims,
                inputs: &signature.inputs,
                module: 0,
            }),
            Callable::Constructor(kind) => library.signature(callable).map(|signature| Head {
                name: KINDS[kind].name,
                dims: &signature.dims,
                inputs: &signature.inputs,
                module: 0,
            }),
        }
    }

    /// Calls the first candidate that takes the arguments; where none does, the one that the user
    /// most likely meant reports why.
    pub(super) fn call_one_of(
        &mut self,
        f: &mut Frame<'a>,
        candidates: &[Callable],
        call: &'a Call,
        given: Vec<Given<'a>>,
        place: Place,
    ) -> Wire {
        if given.iter().any(|given| matches!(given.wire, Wire::Unknown)) {
            f.failed |= f.waiting.is_empty();
            self.words(f, candidates, &given);
            return Wire::Unknown;
        }
        let heads: Vec<(Callable, Head<'a>)> =
            candidates.iter().filter_map(|callable| Some((*callable, self.head(*callable)?))).collect();
        let fits =
            |head: &Head<'a>, n: usize| head.inputs.iter().zip(&given).take(n).all(|(i, g)| accepts(f, i, g));
        let chosen = heads
            .iter()
            .find(|(_, head)| given.len() <= head.inputs.len() && fits(head, given.len()))
            .or_else(|| heads.iter().find(|(_, head)| fits(head, 1)))
            .copied();
        match (chosen, heads.as_slice()) {
            (Some((callable, head)), _) => self.apply(f, callable, head, call, given, place),
            (None, [(callable, head)]) => self.apply(f, *callable, *head, call, given, place),
            (None, _) => self.no_receiver(f, &heads, call, &given, place),
        }
    }

    /// Reports the arguments that are unknown names, in a call that is wrong elsewhere too.
    fn words(&mut self, f: &mut Frame<'a>, candidates: &[Callable], given: &[Given<'a>]) {
        let inputs =
            candidates.iter().filter_map(|callable| self.head(*callable)).flat_map(|head| head.inputs);
        let chooses = |word: &str, input: &Input| matches!(&input.ty.kind, TypeKind::Choice(words) if words.iter().any(|known| known.text == word));
        let inputs: Vec<&'a Input> = inputs.collect();
        for argument in given {
            if let Wire::Word(word, at) = &argument.wire
                && !inputs.iter().any(|input| chooses(word, input))
            {
                self.unknown_value(f, word, *at);
            }
        }
    }

    fn no_receiver(
        &mut self,
        f: &mut Frame<'a>,
        heads: &[(Callable, Head<'a>)],
        call: &Call,
        given: &[Given<'a>],
        place: Place,
    ) -> Wire {
        let first = given.first();
        if let Some(Wire::Word(word, at)) = first.map(|given| &given.wire) {
            return self.unknown_value(f, word, *at);
        }
        let found = first
            .map_or_else(|| "nothing".to_owned(), |given| types::describe(&given.wire, |v| f.builder.ty(v)));
        let accepted = heads.iter().filter_map(|(_, head)| head.inputs.first());
        let accepted: Vec<String> = accepted.map(|input| format!("`{}`", types::show(&input.ty))).collect();
        let at = first.map_or(place, |given| given.place);
        self.report(f, sentences::bad_receiver(at, &call.name.text, &found, &accepted))
    }

    fn apply(
        &mut self,
        f: &mut Frame<'a>,
        callable: Callable,
        head: Head<'a>,
        call: &'a Call,
        given: Vec<Given<'a>>,
        place: Place,
    ) -> Wire {
        let Some(bound) = self.bind_arguments(f, head, call.dim.as_ref(), given, place) else {
            return Wire::Unknown;
        };
        f.builder.set_place(place);
        match callable {
            Callable::Node(module, item) => self.call_node(f, module, item, bound, place),
            Callable::Intrinsic(intrinsic) => {
                let values: Option<Vec<Value>> = bound.wires.iter().map(as_value).collect();
                values.map_or(Wire::Unknown, |values| Wire::Value(f.builder.builtin(intrinsic, &values)))
            }
            Callable::Constructor(kind) => self.construct(f, kind, head, bound, place),
        }
    }

    fn call_node(
        &mut self,
        f: &mut Frame<'a>,
        module: usize,
        item: usize,
        bound: Bound,
        place: Place,
    ) -> Wire {
        let mut key = Key {
            module,
            item,
            dims: bound.dims.iter().map(|(_, width)| *width).collect(),
            arguments: vec![],
        };
        let mut arguments = Vec::new();
        for wire in bound.wires {
            let argument = match wire {
                Wire::Value(value) => match f.builder.as_constant(value) {
                    Some(constant) => ArgumentKey::Constant(constant),
                    None => {
                        arguments.push(value);
                        ArgumentKey::Value(f.builder.ty(value))
                    }
                },
                Wire::Resource(resource) => {
                    arguments.extend(resource.views.iter().map(|(_, view)| *view));
                    ArgumentKey::Resource(resource.kind, resource.constants.clone())
                }
                Wire::Word(word, _) => ArgumentKey::Word(word),
                _ => ArgumentKey::None,
            };
            key.arguments.push(argument);
        }
        match self.made.get(&key) {
            None => {
                f.waiting.push((key, place));
                Wire::Unknown
            }
            Some(Outcome::Failed) => {
                f.failed = true;
                Wire::Unknown
            }
            Some(Outcome::Made(id)) => self.outputs(f, *id, arguments),
        }
    }

    fn outputs(&mut self, f: &mut Frame<'a>, id: crate::graph::FunctionId, arguments: Vec<Value>) -> Wire {
        let callee = &self.functions[id.0 as usize];
        let known: Vec<_> = callee.outputs.iter().map(|(_, value)| callee.operation(*value)).collect();
        let outputs = if known.iter().all(|operation| matches!(operation, Operation::Constant(_))) {
            known
                .iter()
                .filter_map(
                    |op| if let Operation::Constant(c) = op { Some(f.builder.constant(*c)) } else { None },
                )
                .collect()
        } else {
            f.builder.call(id, callee, arguments)
        };
        let names = callee.outputs.iter().map(|(slot, _)| slot.name.clone());
        let mut record: Vec<(String, Wire)> = names.zip(outputs.into_iter().map(Wire::Value)).collect();
        if record.len() == 1 { record.remove(0).1 } else { Wire::Record(Rc::new(record)) }
    }

    fn no_callable(&mut self, f: &mut Frame<'a>, call: &Call, given: &[Given<'a>]) -> Wire {
        if given.iter().any(|given| matches!(given.wire, Wire::Word(..))) {
            // A word may be a choice of whatever was meant.
            let names = self.library.callable_names();
            let all: Vec<Callable> =
                names.iter().flat_map(|name| self.library.callables(name)).copied().collect();
            self.words(f, &all, given);
        }
        let place = self.place(f, call.name.span);
        let name = call.name.text.as_str();
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

fn word(expr: &Expr) -> Option<&str> {
    match &expr.kind {
        ExprKind::Name(name) => Some(name),
        _ => None,
    }
}

fn as_value(wire: &Wire) -> Option<Value> {
    match wire {
        Wire::Value(value) => Some(*value),
        _ => None,
    }
}

/// Whether an input may take an argument, as far as that can be told before dimensions are bound.
fn accepts(f: &Frame<'_>, input: &texgraph_grammar::syntax::Input, given: &Given<'_>) -> bool {
    if given.name.is_some() {
        return true;
    }
    match (&given.wire, types::scalar_of(&input.ty)) {
        (Wire::Value(value), Some(wanted)) => {
            let ty = f.builder.ty(*value);
            let width =
                types::fixed_width(&input.ty).is_none_or(|width| ty.width() == 1 || ty.width() == width);
            width && ty.scalar().is_some_and(|found| types::widens(found, wanted))
        }
        (Wire::Resource(resource), None) => types::kind_of(&input.ty) == Some(resource.kind),
        (Wire::Word(..) | Wire::None | Wire::Text(_) | Wire::List(_), None) => true,
        _ => false,
    }
}
