//! The library's nodes, made before a program calls them: each as a call makes it whose arguments are known
//! only when a shader runs, and whose other inputs keep their defaults. A program takes over what it
//! calls so, in place of making it once more.

use super::arguments::{Arguments, Given};
use super::constructor::placeholder;
use super::node::open_input;
use super::types::{self, Declared, Dims};
use super::wire::{ArgumentKey, Key};
use super::{Checker, Frame, Outcome};
use crate::ahead::Ahead;
use crate::diagnostic::{Place, limits};
use crate::graph::{Function, FunctionId};
use crate::library::{Callable, Library};
use rustc_hash::FxHashSet;
use std::collections::BTreeSet;
use texgraph_grammar::syntax::Node;

/// A node made ahead; functions by their place in the library's list.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// What was made, in the order that it is made in.
    functions: Vec<FunctionId>,
    /// Which of them the node is, and each that it calls.
    nodes: Vec<(Key, FunctionId)>,
    node: FunctionId,
}

impl Prepared {
    /// The node itself.
    pub fn node(&self) -> FunctionId {
        self.node
    }
}

/// The nodes of these modules of a library that can be made ahead, and the functions they are made of.
pub fn ahead(library: &Library, modules: &BTreeSet<usize>) -> (Vec<(Key, Prepared)>, Vec<Function>) {
    let modules = modules.iter().filter_map(|i| Some((*i, library.modules().get(*i)?)));
    let items =
        modules.flat_map(|(i, module)| module.tree.items.iter().enumerate().map(move |item| (i, item)));
    let nodes = items.filter_map(|(module, (i, item))| Some((module, i, super::globals::node_of(item)?)));
    let calls = nodes.flat_map(|(module, item, node)| {
        let widths = if node.dims.is_empty() { 1..=1 } else { 1..=4 };
        widths.map(move |width| (module, item, node, width))
    });
    let nothing = Ahead::default();
    let checker = || Checker::new(library, &nothing, library.modules());
    let mut all = checker();
    let made =
        calls.filter_map(|(module, item, node, width)| checker().made_alone(module, item, node, width));
    let made = made.collect::<Vec<Alone>>().into_iter().flat_map(|alone| all.collect(alone)).collect();
    (made, all.functions)
}

impl<'a> Checker<'a> {
    /// Makes a node and all it calls; none where that is not the same in every program.
    fn made_alone(mut self, module: usize, item: usize, node: &'a Node, width: u8) -> Option<Alone> {
        self.declare();
        let is_alone = self.functions.is_empty() && self.params.is_empty() && self.resources.is_empty();
        let key = self.open_call(module, item, node, width).filter(|_| is_alone)?;
        let frame = self.frame(node, key, None);
        self.run(frame);
        let mut nodes = Vec::with_capacity(self.made.len());
        for (key, outcome) in self.made {
            match outcome {
                // Functions of another program are not those that it was passed here.
                Outcome::Made(_) if key.is_passed_functions() => {}
                Outcome::Made(id) => nodes.push((key, id)),
                Outcome::Failed => return None,
            }
        }
        let is_free = self.diagnostics.is_empty() && self.budget == limits::MAX_EVALUATION;
        is_free.then_some(Alone { functions: self.functions, nodes })
    }

    /// Puts the functions of a node among those of all: the node, and each that it calls.
    fn collect(&mut self, alone: Alone) -> Vec<(Key, Prepared)> {
        let Alone { functions, nodes } = alone;
        let mut ids: Vec<FunctionId> = Vec::with_capacity(functions.len());
        for mut function in functions {
            function.replace_functions(|id| ids[id.0 as usize]);
            ids.push(self.intern(function));
        }
        let nodes: Vec<(Key, FunctionId)> =
            nodes.into_iter().map(|(key, id)| (key, ids[id.0 as usize])).collect();
        let mut all = Vec::with_capacity(nodes.len());
        ids.sort_unstable();
        ids.dedup();
        for (key, node) in &nodes {
            // What a function uses was made before it.
            let mut needed: FxHashSet<FunctionId> = [*node].into_iter().collect();
            for id in ids.iter().rev() {
                if needed.contains(id) {
                    needed.extend(self.functions[id.0 as usize].functions());
                }
            }
            let is_needed = |id: &FunctionId| needed.contains(id);
            let functions = ids.iter().copied().filter(is_needed).collect();
            let nodes = nodes.iter().filter(|(_, id)| is_needed(id)).cloned().collect();
            all.push((key.clone(), Prepared { functions, nodes, node: *node }));
        }
        all
    }

    /// The key of a call that gives what has no default, and gives nothing that is known.
    fn open_call(&mut self, module: usize, item: usize, node: &'a Node, width: u8) -> Option<Key> {
        let mut f = Frame::empty();
        f.module = module;
        let dims: Dims<'a> = node.dims.iter().map(|dim| (dim.text.as_str(), width)).collect();
        let place = Place::default();
        let mut given = Arguments::new();
        for input in node.inputs.iter().filter(|input| input.default.is_none()) {
            let wire = match types::resolve(&input.ty, &dims, self.modules[module].file).ok()? {
                Declared::Resource(kind) if placeholder(kind).is_empty() => {
                    self.input_wire(&mut f, input, &ArgumentKey::Resource(kind, Vec::new()))
                }
                declared @ (Declared::Vector(..) | Declared::Matrix(_)) => {
                    open_input(&mut f.builder, &input.name.text, &declared)
                }
                _ => return None,
            };
            given.push(Given { name: Some(&input.name), wire, place, expr: None });
        }
        let head = self.head(Callable::Node(module, item))?;
        let bound = loop {
            if let Some(bound) = self.bind_arguments(&mut f, head, None, &given, place) {
                break bound;
            }
            // A default may call nodes, which are made first.
            let (key, _) = f.waiting.pop()?;
            let frame = self.frame(self.node(key.module, key.item)?, key, None);
            self.run(frame);
        };
        self.call_node(&mut f, (module, item, None), bound, place);
        f.waiting.pop().map(|(key, _)| key)
    }

    /// The node that was made ahead for a key. Near a limit there is none: making it shows which
    /// node passes the limit.
    pub(super) fn made_ahead(&self, key: &Key) -> Option<&'a Prepared> {
        let is_far = self.started < limits::MAX_NODES / 2 && self.values < limits::MAX_VALUES / 2;
        self.ahead.prepared.get(key).filter(|_| is_far)
    }

    /// Takes over a node that was made ahead, which counts as one that is made.
    pub(super) fn take_over(&mut self, prepared: &Prepared) {
        for ahead in &prepared.functions {
            if !self.taken.contains_key(ahead) {
                let mut function = self.ahead.checked[ahead.0 as usize].clone();
                function.replace_functions(|id| self.taken.get(&id).copied().unwrap_or(id));
                let id = self.intern(function);
                self.taken.insert(*ahead, id);
            }
        }
        for (key, ahead) in &prepared.nodes {
            if !self.made.contains_key(key) {
                self.started += 1;
                self.made.insert(key.clone(), Outcome::Made(self.taken[ahead]));
            }
        }
    }
}

/// A node made on its own; functions by their place in its list.
struct Alone {
    functions: Vec<Function>,
    nodes: Vec<(Key, FunctionId)>,
}
