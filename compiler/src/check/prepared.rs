//! The library's nodes, made when it is loaded: each as a call makes it whose arguments are known
//! only when a shader runs, and whose other inputs keep their defaults. A program takes over what it
//! calls so, in place of making it once more.

use super::arguments::{Arguments, Given};
use super::constructor::placeholder;
use super::node::open_input;
use super::types::{self, Declared, Dims};
use super::wire::{ArgumentKey, Key};
use super::{Checker, Frame, Outcome};
use crate::diagnostic::{Place, limits};
use crate::graph::{Function, FunctionId, Operation};
use crate::library::{Callable, Library};
use rustc_hash::FxHashMap;
use texgraph_grammar::syntax::Node;

/// A node made ahead.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// What was made, in the order that it is made in.
    functions: Vec<Function>,
    /// Which of them the node is, and each that it calls.
    nodes: Vec<(Key, FunctionId)>,
}

/// What of a library can be made ahead.
pub fn prepare(library: &Library) -> FxHashMap<Key, Prepared> {
    let modules = library.modules().iter().enumerate();
    let items =
        modules.flat_map(|(i, module)| module.tree.items.iter().enumerate().map(move |item| (i, item)));
    let nodes = items.filter_map(|(module, (i, item))| Some((module, i, super::globals::node_of(item)?)));
    let calls = nodes.flat_map(|(module, item, node)| {
        let widths = if node.dims.is_empty() { 1..=1 } else { 1..=4 };
        widths.map(move |width| (module, item, node, width))
    });
    let prepared = calls.filter_map(|(module, item, node, width)| {
        Checker::new(library, library.modules()).prepared(module, item, node, width)
    });
    prepared.collect()
}

impl<'a> Checker<'a> {
    /// Makes a node and all it calls; none where that is not the same in every program.
    fn prepared(mut self, module: usize, item: usize, node: &'a Node, width: u8) -> Option<(Key, Prepared)> {
        self.declare();
        let is_alone = self.functions.is_empty() && self.params.is_empty() && self.resources.is_empty();
        let key = self.open_call(module, item, node, width).filter(|_| is_alone)?;
        let frame = self.frame(node, key.clone(), None);
        self.run(frame);
        let nodes = self.made.into_iter().map(|(key, outcome)| match outcome {
            Outcome::Made(id) => Some((key, id)),
            Outcome::Failed => None,
        });
        let nodes = nodes.collect::<Option<Vec<_>>>()?;
        let is_free = self.diagnostics.is_empty() && self.budget == limits::MAX_EVALUATION;
        is_free.then_some((key, Prepared { functions: self.functions, nodes }))
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
        let bound = self.bind_arguments(&mut f, head, None, &given, place)?;
        self.call_node(&mut f, (module, item, None), bound, place);
        f.waiting.pop().map(|(key, _)| key)
    }

    /// The node that was made ahead for a key. Near a limit there is none: making it shows which
    /// node passes the limit.
    pub(super) fn ahead(&self, key: &Key) -> Option<&'a Prepared> {
        let library: &'a Library = self.library;
        let is_far = self.started < limits::MAX_NODES / 2 && self.values < limits::MAX_VALUES / 2;
        library.prepared(key).filter(|_| is_far)
    }

    /// Takes over a node that was made ahead, which counts as one that is made.
    pub(super) fn take_over(&mut self, prepared: &Prepared) {
        let mut ids: Vec<FunctionId> = Vec::with_capacity(prepared.functions.len());
        for function in &prepared.functions {
            let mut function = function.clone();
            let new = |id: &mut FunctionId| *id = ids[id.0 as usize];
            for operation in &mut function.values {
                match operation {
                    Operation::Call(callee, _) => new(callee),
                    Operation::Fold(fold) => {
                        new(&mut fold.body);
                        fold.condition.iter_mut().for_each(new);
                    }
                    _ => {}
                }
            }
            ids.push(self.intern(function));
        }
        for (key, id) in &prepared.nodes {
            if !self.made.contains_key(key) {
                self.started += 1;
                self.made.insert(key.clone(), Outcome::Made(ids[id.0 as usize]));
            }
        }
    }
}
