//! What a file declares: its constants, resources and params, and which names reach where.

use super::order::Reach;
use super::wire::Wire;
use super::{Checker, Frame, Step, Target, types};
use crate::diagnostic::{Place, folds, imports, names, rates, types as type_errors};
use crate::graph::{Builder, Constant, Param, ParamId, Scalar, Type};
use crate::library::Callable;
use crate::module::Module;
use crate::resource::{DIMENSIONAL, KINDS, LATER};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::VecDeque;
use std::rc::Rc;
use texgraph_grammar::syntax::{Expr, Item, ItemKind, Name, Node, Range, Span};

/// A value that a file declares.
#[derive(Clone, Debug)]
pub enum Global {
    /// A number.
    Constant(Constant),
    /// A matrix, by its columns.
    Matrix(Rc<[Constant]>),
    /// A table of numbers, with where each entry stands.
    Table(Rc<[(Constant, Place)]>),
    /// Index of a resource.
    Resource(usize),
    /// A param.
    Param(ParamId),
    /// Wrong, and reported.
    Unknown,
}

/// What a call of a file's own nodes may read.
pub fn reach(module: &Module) -> Reach<'_> {
    Reach::new(module.tree.items.iter().filter_map(node_of))
}

/// The node or texture that an item declares.
pub fn node_of(item: &Item) -> Option<&Node> {
    match &item.kind {
        ItemKind::Node(node) | ItemKind::Texture { node, .. } => Some(node),
        _ => None,
    }
}

/// The nodes and textures of each of a user's files by name; the library has its own index.
pub fn all_callables(modules: &[Module], library: usize) -> Vec<FxHashMap<&str, Vec<Callable>>> {
    let modules = modules.iter().enumerate();
    modules.map(|(i, module)| if i < library { FxHashMap::default() } else { callables(i, module) }).collect()
}

fn callables(index: usize, module: &Module) -> FxHashMap<&str, Vec<Callable>> {
    let mut named: FxHashMap<&str, Vec<Callable>> = FxHashMap::default();
    for (item, declared) in module.tree.items.iter().enumerate() {
        if let Some(node) = node_of(declared) {
            named.entry(&node.name.text).or_default().push(Callable::Node(index, item));
        }
    }
    named
}

/// The name that an item declares.
pub fn name_of(item: &Item) -> Option<&Name> {
    match &item.kind {
        ItemKind::Let { name, .. } | ItemKind::Param { name, .. } => Some(name),
        ItemKind::Node(node) | ItemKind::Texture { node, .. } => Some(&node.name),
        ItemKind::Use { .. } => None,
    }
}

/// The name of the value that an item declares.
fn value_of(item: &Item) -> Option<&Name> {
    match &item.kind {
        ItemKind::Let { name, .. } | ItemKind::Param { name, .. } => Some(name),
        _ => None,
    }
}

/// The prefix of each module's params (`stone.`), by the chain of imports that leads to it from the
/// main file, which is the last: the shortest, and the first in source order of those. So what the
/// main file imports goes by the name that the main file gives it.
pub fn aliases(modules: &[Module], library: usize) -> Vec<String> {
    let mut prefixes: Vec<Option<String>> = vec![None; modules.len()];
    let main = modules.len().checked_sub(1).filter(|main| *main >= library);
    let mut queue: VecDeque<(usize, String)> = main.map(|main| (main, String::new())).into_iter().collect();
    while let Some((module, prefix)) = queue.pop_front() {
        if prefixes[module].is_some() {
            continue;
        }
        for import in &modules[module].imports {
            let alias = import.alias.as_ref().map_or(String::new(), |alias| format!("{}.", alias.text));
            queue.push_back((import.module, format!("{prefix}{alias}")));
        }
        prefixes[module] = Some(prefix);
    }
    prefixes.into_iter().map(Option::unwrap_or_default).collect()
}

impl<'a> Checker<'a> {
    /// Evaluates the `let`s and params of every file.
    pub fn declare(&mut self) {
        for module in 0..self.modules.len() {
            let mut f = Frame::empty();
            f.module = module;
            if module >= self.library.modules().len() {
                f.repeated = self.check_items(module);
                let items = self.modules[module].tree.items.iter().filter_map(value_of);
                let repeated = items.filter(|name| f.repeated.contains(&name.span.start));
                f.doubtful = repeated.map(|name| name.text.as_str()).collect();
            }
            f.builder = Builder::new(self.modules[module].path.clone());
            for item in &self.modules[module].tree.items {
                match &item.kind {
                    ItemKind::Let { name, value } => {
                        f.steps.push(Step { target: Target::Global(name, &item.doc), value });
                    }
                    ItemKind::Param { default, .. } => {
                        f.steps.push(Step { target: Target::Param(item), value: default });
                    }
                    _ => {}
                }
            }
            if !f.steps.is_empty() {
                // Params first, or a bake would decide the order of those it reads.
                f.steps.sort_by_key(|step| !matches!(step.target, Target::Param(_)));
                f.bind_steps();
                self.sort(&mut f);
                self.run(f);
            }
        }
    }

    /// Names declared twice: in the file (where is returned), by two imports, or as two aliases.
    fn check_items(&mut self, module: usize) -> FxHashSet<u32> {
        let m = &self.modules[module];
        let place = |span: Span| Place { file: m.file, span };
        let mut seen: FxHashMap<(&str, &str), &Name> = FxHashMap::default();
        let mut repeated = FxHashSet::default();
        for item in &m.tree.items {
            let Some(name) = name_of(item) else { continue };
            let first = *seen.entry((&name.text, overload_of(item))).or_insert(name);
            if first.span != name.span {
                let diagnostic = names::bound_twice(place(name.span), &name.text, place(first.span));
                self.diagnostics.push(diagnostic);
                repeated.insert(name.span.start);
            }
        }
        let mut aliases: FxHashMap<&str, Span> = FxHashMap::default();
        for alias in m.imports.iter().filter_map(|import| import.alias.as_ref()) {
            if let Some(first) = aliases.get(alias.text.as_str()) {
                let error = imports::alias_twice(place(alias.span), &alias.text, place(*first));
                self.diagnostics.push(error);
            }
            aliases.entry(&alias.text).or_insert(alias.span);
        }
        // Before a dot a name is the file or the value, so it can't be both.
        for name in m.tree.items.iter().filter_map(value_of) {
            if let Some(alias) = aliases.get(name.text.as_str()) {
                let error = names::bound_twice(place(name.span), &name.text, place(*alias));
                self.diagnostics.push(error);
                repeated.insert(name.span.start);
            }
        }
        self.check_joined(module);
        repeated
    }

    /// Items of unnamed imports join the file's: two of one name clash, at the later `use`.
    fn check_joined(&mut self, module: usize) {
        let m = &self.modules[module];
        let mut seen: FxHashMap<(&str, &str), Place> = FxHashMap::default();
        for import in m.imports.iter().filter(|import| import.alias.is_none()) {
            let other = &self.modules[import.module];
            for item in &other.tree.items {
                let Some(name) = name_of(item) else { continue };
                let here = Place { file: other.file, span: name.span };
                let key = (name.text.as_str(), overload_of(item));
                if let Some(first) = seen.insert(key, here).filter(|first| *first != here) {
                    let place = Place { file: m.file, span: import.span };
                    self.diagnostics.push(imports::clash(place, &name.text, first));
                }
            }
        }
        for item in &m.tree.items {
            let Some(name) = name_of(item) else { continue };
            if let Some(first) = seen.get(&(name.text.as_str(), overload_of(item))) {
                let place = Place { file: m.file, span: name.span };
                self.diagnostics.push(imports::clash(place, &name.text, *first));
            }
        }
    }

    /// A value of a file, or of a file that joins it.
    pub fn global(&self, module: usize, name: &str) -> Option<Global> {
        self.globals[module].get(name).cloned().or_else(|| {
            let joined = self.modules[module].imports.iter().filter(|import| import.alias.is_none());
            joined.filter_map(|import| self.globals[import.module].get(name).cloned()).next()
        })
    }

    /// A global as a wire of the function being made.
    pub fn global_wire(&self, f: &mut Frame<'a>, global: Global) -> Wire {
        match global {
            Global::Constant(constant) => Wire::Value(f.builder.constant(constant)),
            Global::Matrix(columns) => {
                Wire::Matrix(columns.iter().map(|column| f.builder.constant(*column)).collect())
            }
            Global::Table(entries) => {
                let entry = |(constant, place): &(Constant, Place)| {
                    (Wire::Value(f.builder.constant(*constant)), *place)
                };
                Wire::List(Rc::new(entries.iter().map(entry).collect()))
            }
            Global::Resource(resource) => self.resource_value(f, resource),
            Global::Param(id) => self.param_value(f, id),
            Global::Unknown => Wire::Unknown,
        }
    }

    pub(super) fn set_global(
        &mut self,
        f: &mut Frame<'a>,
        name: &'a Name,
        doc: &str,
        wire: Wire,
        place: Place,
    ) {
        let global = match &wire {
            Wire::Value(value) => match f.builder.as_constant(*value) {
                Some(constant) => Global::Constant(constant),
                None => {
                    self.report(f, rates::let_not_constant(place, &name.text));
                    Global::Unknown
                }
            },
            Wire::Resource(resource) => resource.id.map_or(Global::Unknown, |id| {
                self.resources[id].name = format!("{}{}", self.aliases[f.module], name.text);
                doc.clone_into(&mut self.resources[id].label);
                Global::Resource(id)
            }),
            Wire::Matrix(columns) => {
                let columns: Option<Vec<Constant>> =
                    columns.iter().map(|column| f.builder.as_constant(*column)).collect();
                columns.map_or_else(
                    || {
                        self.report(f, rates::let_not_constant(place, &name.text));
                        Global::Unknown
                    },
                    |columns| Global::Matrix(columns.into()),
                )
            }
            Wire::List(items) => self.global_table(f, items),
            Wire::Unknown => Global::Unknown,
            Wire::Word(word) => {
                self.unknown_value(f, &word.text, word.place);
                Global::Unknown
            }
            other => {
                let what = types::describe(other, |v| f.builder.ty(v));
                self.report(f, type_errors::not_a_value(place, &what));
                Global::Unknown
            }
        };
        self.declare_value(f, name, global);
    }

    /// A list of numbers, to be indexed.
    fn global_table(&mut self, f: &mut Frame<'a>, items: &[(Wire, Place)]) -> Global {
        let mut entries = Vec::new();
        for (wire, at) in items {
            let Some(value) = self.value(f, wire, *at) else { return Global::Unknown };
            match f.builder.as_constant(value) {
                Some(constant) => entries.push((constant, *at)),
                None => {
                    self.report(f, folds::entry_not_constant(*at));
                    return Global::Unknown;
                }
            }
        }
        Global::Table(entries.into())
    }

    /// The first declaration of a name holds.
    fn declare_value(&mut self, f: &mut Frame<'a>, name: &'a Name, global: Global) {
        // Nobody knows which of two is meant where the name is read.
        let is_doubtful = f.doubtful.contains(name.text.as_str());
        let global = if is_doubtful { Global::Unknown } else { global };
        if !f.repeated.contains(&name.span.start) {
            self.globals[f.module].insert(name.text.to_string(), global.clone());
        }
        let wire = self.global_wire(f, global);
        self.bind(f, name, wire);
    }

    pub(super) fn set_param(&mut self, f: &mut Frame<'a>, item: &'a Item, wire: Wire, place: Place) {
        let ItemKind::Param { name, ty, default, range } = &item.kind else { return };
        let global = match self.param(f, item, name, ty, default, range.as_ref(), wire, place) {
            Some(param) => {
                self.params.push(param);
                Global::Param(ParamId(self.params.len() as u32 - 1))
            }
            None => Global::Unknown,
        };
        self.declare_value(f, name, global);
    }

    #[expect(clippy::too_many_arguments, reason = "the parts of one declaration")]
    fn param(
        &mut self,
        f: &mut Frame<'a>,
        item: &Item,
        name: &Name,
        ty: &texgraph_grammar::syntax::Type,
        default: &Expr,
        range: Option<&'a Range>,
        wire: Wire,
        place: Place,
    ) -> Option<Param> {
        let (scalar, width) = match types::resolve(ty, &f.dims, self.modules[f.module].file) {
            Ok(types::Declared::Vector(scalar, width)) => (scalar, width),
            Ok(_) => {
                let at = self.place(f, ty.span);
                self.report(f, type_errors::type_not_allowed(at, &types::show(ty), "a param"));
                return None;
            }
            Err(diagnostic) => {
                self.report(f, diagnostic);
                return None;
            }
        };
        let value = self.known(f, name, &wire, scalar, width, place);
        let written = range.map_or(place, |range| self.place(f, range.span));
        let range = match range {
            Some(range) => Some(self.range(f, name, range, scalar, width)?),
            None => None,
        };
        let value = value?;
        if let Some((low, high)) = range
            && !within(&value, &low, &high)
        {
            let at = self.place(f, default.span);
            self.report(f, rates::default_outside_range(at, &name.text, written));
            return None;
        }
        Some(Param {
            name: self.fresh_param(&format!("{}{}", self.aliases[f.module], name.text)),
            label: item.doc.clone(),
            ty: Type::Vector(scalar, width),
            default: value,
            range,
        })
    }

    /// The name of a param, made unique: a joined file's aliases may be the main file's too.
    fn fresh_param(&mut self, wish: &str) -> String {
        let others = (2..).map(|n| format!("{wish}_{n}"));
        let mut names = std::iter::once(wish.to_owned()).chain(others);
        names.find(|name| self.param_names.insert(name.clone())).unwrap_or_default()
    }

    fn range(
        &mut self,
        f: &mut Frame<'a>,
        name: &Name,
        range: &'a Range,
        scalar: Scalar,
        width: u8,
    ) -> Option<(Constant, Constant)> {
        let mut ends = Vec::new();
        for end in [&*range.start, &*range.end] {
            let wire = self.expr(f, end);
            let place = self.place(f, end.span);
            ends.push(self.known(f, name, &wire, scalar, width, place)?);
        }
        let (low, mut high) = (ends[0], ends[1]);
        if !range.inclusive && scalar == Scalar::Int {
            high = Constant::ints(
                &(0..usize::from(width)).map(|i| high.int(i).wrapping_sub(1)).collect::<Vec<_>>(),
            );
        }
        if !within(&low, &low, &high) {
            let place = self.place(f, range.span);
            self.report(f, rates::empty_range(place, &name.text));
            return None;
        }
        Some((low, high))
    }

    /// A constant of that type.
    fn known(
        &mut self,
        f: &mut Frame<'a>,
        name: &Name,
        wire: &Wire,
        scalar: Scalar,
        width: u8,
        place: Place,
    ) -> Option<Constant> {
        let value = self.coerce_named(f, wire, (scalar, width), place, Some(&name.text));
        let constant = value.and_then(|value| f.builder.as_constant(value));
        if constant.is_none() && value.is_some() {
            self.report(f, rates::param_not_constant(place, &name.text));
        }
        constant
    }
}

/// Nodes may share a name when their first inputs are of different resource kinds.
fn overload_of(item: &Item) -> &str {
    let first = node_of(item).and_then(|node| node.inputs.first());
    match first.map(|input| &input.ty.kind) {
        Some(texgraph_grammar::syntax::TypeKind::Named { name, dim }) => {
            match super::types::named(&name.text, dim.as_ref()) {
                Some(kind) => KINDS[kind].name,
                None if DIMENSIONAL.contains(&name.text.as_str()) => &name.text,
                None if LATER.contains(&name.text.as_str()) => &name.text,
                None => "",
            }
        }
        _ => "",
    }
}

fn within(value: &Constant, low: &Constant, high: &Constant) -> bool {
    (0..usize::from(value.width())).all(|i| match value.scalar() {
        Scalar::Float => value.float(i) >= low.float(i) && value.float(i) <= high.float(i),
        Scalar::Int | Scalar::Bool => value.int(i) >= low.int(i) && value.int(i) <= high.int(i),
    })
}
