//! Expressions: names and fields; what else there is stands in files of its own.

use super::constructor::view_field;
use super::frame::Progress;
use super::types;
use super::wire::Wire;
use super::{Checker, Frame};
use crate::diagnostic::{Place, imports, names, types as errors};
use crate::graph::{Constant, Value};
use std::rc::Rc;
use texgraph_grammar::syntax::{Expr, ExprKind, Name, Postfix, Span};

impl<'a> Checker<'a> {
    /// What an expression gives. Recursion is bounded by the nesting of the text.
    pub(super) fn expr(&mut self, f: &mut Frame<'a>, e: &'a Expr) -> Wire {
        f.builder.set_place(self.place(f, e.span));
        match &e.kind {
            ExprKind::Int(value) => match value.and_then(|v| i32::try_from(v).ok()) {
                Some(int) => Wire::Value(f.builder.constant(Constant::ints(&[int]))),
                None => self.report(f, errors::int_too_large(self.place(f, e.span))),
            },
            ExprKind::Float(value) if (*value as f32).is_finite() => {
                Wire::Value(f.builder.constant(Constant::floats(&[*value as f32])))
            }
            ExprKind::Float(_) => self.report(f, errors::float_too_large(self.place(f, e.span))),
            ExprKind::Bool(value) => Wire::Value(f.builder.constant(Constant::bools(&[*value]))),
            ExprKind::Color(channels) => {
                Wire::Value(f.builder.constant(Constant::floats(&crate::color::linear(*channels))))
            }
            ExprKind::Text(text) => Wire::Text(text.as_str().into()),
            ExprKind::Name(name) => self.name(f, name, e.span),
            ExprKind::Paren(inner) => self.expr(f, inner),
            ExprKind::Call(call) => self.call(f, call, e.span),
            ExprKind::Postfix { base, links } => self.postfix(f, base, links),
            ExprKind::Unary { operators, operand } => self.unary(f, operators, operand, e.span),
            ExprKind::Chain { first, links } => self.chain(f, first, links),
            ExprKind::If { arms, otherwise } => self.choice(f, arms, otherwise),
            ExprKind::List(items) => {
                let items = items.iter().map(|item| (self.expr(f, item), self.place(f, item.span))).collect();
                Wire::List(Rc::new(items))
            }
            ExprKind::Lambda { .. } => Wire::Lambda,
            ExprKind::Fold(fold) => self.fold(f, fold, e.span),
        }
    }

    /// A name: a wire of the function, or a value of the file. One that is neither may still be a
    /// choice; who needs a value reports it.
    fn name(&mut self, f: &mut Frame<'a>, name: &str, span: Span) -> Wire {
        if let Some(wire) = f.lookup(name) {
            return wire;
        }
        if f.bound.contains_key(name) {
            // Bound in this body but not made: part of a ring, or wrong; both are reported.
            f.failed = true;
            return Wire::Unknown;
        }
        if let Some((_, width)) = f.dims.iter().find(|(dim, _)| *dim == name) {
            return Wire::Value(f.builder.constant(Constant::ints(&[i32::from(*width)])));
        }
        match self.global(f.module, name) {
            Some(global) => self.global_wire(f, global),
            None if name == "none" => Wire::None,
            None => Wire::word(name, self.place(f, span)),
        }
    }

    pub(super) fn is_value(&self, f: &Frame<'a>, name: &str) -> bool {
        f.scopes.iter().any(|scope| scope.contains_key(name)) || self.global(f.module, name).is_some()
    }

    /// Reports a name that is no value.
    pub(super) fn unknown_value(&mut self, f: &mut Frame<'a>, name: &str, place: Place) -> Wire {
        if f.unknown.contains(name) {
            f.failed = true;
            return Wire::Unknown;
        }
        if self.alias(f.module, name).is_some() {
            return self.report(f, names::alias_as_value(place, name));
        }
        let module = &self.modules[f.module];
        if module.tree.items.iter().filter_map(super::globals::node_of).any(|node| node.name.text == name)
            || !self.library.callables(name).is_empty()
        {
            return self.report(f, names::node_as_value(place, name));
        }
        f.unknown.insert(name);
        let stem = |import: &crate::module::Import| {
            self.modules[import.module].path.rsplit('/').next()?.strip_suffix(".tex")
        };
        if module.imports.iter().any(|import| import.alias.is_none() && stem(import) == Some(name)) {
            return self.report(f, names::missing_alias(place, name));
        }
        let near = {
            // What the statement itself binds can't be meant.
            let own = f.order.get(f.next).and_then(|step| f.steps.get(*step));
            let own: Vec<&str> = own.into_iter().flat_map(super::Step::names).collect();
            let scoped = f.scopes.iter().flat_map(|scope| scope.keys().copied());
            let later = f.steps.iter().flat_map(super::Step::names);
            let items = self.globals[f.module].keys().map(String::as_str);
            let aliases =
                module.imports.iter().filter_map(|import| Some(import.alias.as_ref()?.text.as_str()));
            let known = scoped.chain(later).chain(items).chain(aliases);
            self.near(name, known.filter(|known| !own.contains(known)))
        };
        self.report(f, names::unknown_value(place, name, near))
    }

    /// The module that an alias names.
    fn alias(&self, module: usize, name: &str) -> Option<usize> {
        let mut imports = self.modules[module].imports.iter();
        imports.find(|import| import.alias.as_ref().is_some_and(|alias| alias.text == name)).map(|i| i.module)
    }

    fn postfix(&mut self, f: &mut Frame<'a>, base: &'a Expr, links: &'a [Postfix]) -> Wire {
        let (mut next, mut wire) = match f.progress.get(&links.as_ptr()).filter(|_| f.foreign == 0) {
            Some(progress) => (progress.next, progress.wire.clone()),
            None => self.first_link(f, base, links),
        };
        while let Some(link) = links.get(next) {
            // A word that something is asked of is a name that nobody declared.
            if let Wire::Word(word) = &wire {
                wire = self.unknown_value(f, &word.text.clone(), word.place);
            }
            let before = links[..next].last().map_or(base.span, end_of);
            let place = self.place(f, base.span.to(before));
            let (waiting, values) = (f.waiting.len(), f.builder.function().values.len());
            let result = match link {
                Postfix::Field(name) => self.field(f, wire.clone(), name),
                Postfix::Method(call, span) => self.method(f, wire.clone(), place, call, *span),
                Postfix::Index(index, span) => self.index(f, wire.clone(), place, index, *span),
            };
            if f.waiting.len() > waiting {
                // While something waits, folds do, and lists of them are to be made again.
                if f.foreign == 0 && waiting == 0 && !matches!(wire, Wire::Unknown) {
                    f.progress.insert(links.as_ptr(), Progress { next, wire, values });
                }
                return Wire::Unknown;
            }
            wire = result;
            next += 1;
        }
        wire
    }

    /// The base, or an item of an imported file together with the link that names it.
    fn first_link(&mut self, f: &mut Frame<'a>, base: &'a Expr, links: &'a [Postfix]) -> (usize, Wire) {
        match (&base.kind, self.alias_of(f, base), links.first()) {
            (ExprKind::Name(alias), Some(module), Some(Postfix::Field(name))) => {
                (1, self.imported_value(f, alias, module, name))
            }
            (ExprKind::Name(alias), Some(module), Some(Postfix::Method(call, span))) => {
                (1, self.imported_call(f, alias, module, call, *span))
            }
            (ExprKind::Name(alias), Some(_), _) => {
                let place = self.place(f, base.span);
                (links.len(), self.report(f, names::alias_as_value(place, alias)))
            }
            _ => (0, self.expr(f, base)),
        }
    }

    pub(super) fn alias_of(&self, f: &Frame<'a>, base: &Expr) -> Option<usize> {
        match &base.kind {
            ExprKind::Name(name) if !self.is_value(f, name) => self.alias(f.module, name),
            _ => None,
        }
    }

    fn imported_value(&mut self, f: &mut Frame<'a>, alias: &str, module: usize, name: &Name) -> Wire {
        if let Some(global) = self.globals[module].get(name.text.as_str()).cloned() {
            return self.global_wire(f, global);
        }
        let place = self.place(f, name.span);
        let full = format!("{alias}.{}", name.text);
        if !self.own_callables(module, &name.text).is_empty() {
            return self.report(f, names::node_as_value(place, &full));
        }
        let near = self.near_item(module, &name.text);
        self.report(f, imports::no_such_item(place, alias, &name.text, near))
    }

    /// The item of a module that was most likely meant.
    pub(super) fn near_item(&self, module: usize, name: &str) -> Option<String> {
        let known = self.modules[module].tree.items.iter().filter_map(super::globals::name_of);
        self.near(name, known.map(|known| known.text.as_str()))
    }

    fn field(&mut self, f: &mut Frame<'a>, wire: Wire, name: &Name) -> Wire {
        let place = self.place(f, name.span);
        f.builder.set_place(place);
        match &wire {
            Wire::Unknown => Wire::Unknown,
            Wire::Record(outputs) => match outputs.iter().find(|(output, _)| *output == name.text) {
                Some((_, wire)) => wire.clone(),
                None => {
                    let near = self.near(&name.text, outputs.iter().map(|(output, _)| output.as_str()));
                    self.report(f, names::unknown_field(place, "this record", &name.text, near))
                }
            },
            Wire::Resource(resource) => match self.resource_field(f, resource, &name.text) {
                Some(wire) => wire,
                None => self.unknown_resource_field(f, resource.kind, name, place),
            },
            Wire::View(view) => match view_field(f, *view, &name.text) {
                Some(wire) => wire,
                None => self.report(f, names::unknown_field(place, "a view", &name.text, None)),
            },
            Wire::Value(value) => self.swizzle(f, *value, name, place),
            other => {
                let what = types::describe(other, |v| f.builder.ty(v));
                self.report(f, names::unknown_field(place, &what, &name.text, None))
            }
        }
    }

    fn unknown_resource_field(&mut self, f: &mut Frame<'a>, kind: usize, name: &Name, place: Place) -> Wire {
        let kind = &crate::resource::KINDS[kind];
        let near = self.near(&name.text, kind.fields.iter().map(|field| field.name));
        self.report(f, names::unknown_field(place, &format!("`{}`", kind.name), &name.text, near))
    }

    /// `.xyzw` or `.rgba`, one to four of the components there are.
    fn swizzle(&mut self, f: &mut Frame<'a>, value: Value, name: &Name, place: Place) -> Wire {
        let width = f.builder.ty(value).width();
        let components = ["xyzw", "rgba"].iter().find_map(|set| {
            name.text
                .chars()
                .map(|c| set.find(c))
                .collect::<Option<Vec<usize>>>()
                .filter(|found| found.len() <= 4)
        });
        let components = components.filter(|found| found.iter().all(|i| *i < usize::from(width)));
        let Some(components) = components else {
            let ty = types::name(f.builder.ty(value));
            return self.report(f, errors::bad_swizzle(place, &ty, &name.text));
        };
        let scalars: Vec<Value> = components.into_iter().map(|i| f.builder.extract(value, i as u8)).collect();
        Wire::Value(f.builder.compose(&scalars))
    }
}

fn end_of(link: &Postfix) -> Span {
    match link {
        Postfix::Field(name) => name.span,
        Postfix::Method(_, span) | Postfix::Index(_, span) => *span,
    }
}
