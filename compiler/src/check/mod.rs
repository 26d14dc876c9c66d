//! Checking: the syntax tree becomes typed functions.
//!
//! A node is made once for every combination of dimensions and constant arguments that it is
//! called with (a [`wire::Key`]). Making a function runs its statements in an order that works;
//! a statement that calls a node which is not made yet *waits*: the node is put on an explicit
//! stack, made, and the statement runs again. Values are hash-consed, so running it again adds
//! nothing. Nothing here recurses deeper than the nesting of one expression.

mod arguments;
mod call;
mod candidates;
mod choice;
mod constructor;
mod default;
mod expr;
mod fold;
mod frame;
mod globals;
mod head;
mod index;
mod layer;
mod matrix;
mod node;
mod operator;
pub mod order;
mod passes;
mod plan;
mod prepared;
mod range;
mod render;
mod special;
mod step;
mod still;
mod texture;
mod tiles;
mod types;
mod view;
mod wire;

pub use head::{Known, known, known_of_items};
pub use prepared::{Prepared, ahead};
pub use texture::textures;
pub use wire::Key;

use crate::ahead::Ahead;
use crate::diagnostic::{Diagnostic, Place, limits, names};
use crate::graph::{
    Builder, Constant, Function, FunctionId, Graph, Operation, Param, ParamId, PassGraph, ResourceView, Type,
    ViewId,
};
use crate::library::{Callable, Library};
use crate::module::Module;
use crate::resource::{KINDS, Resource};
use frame::{Frame, Step, Target};
use globals::Global;
use operator::Overload;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeSet;
use std::rc::Rc;
use texgraph_grammar::syntax::{BinaryOperator, Input, ItemKind, Node, Span};
use types::Declared;
use wire::{ArgumentKey, NodeWire, ResourceWire, Wire};

/// What a made node is.
#[derive(Clone, Copy)]
enum Outcome {
    Made(FunctionId),
    /// Wrong, and reported.
    Failed,
}

/// Everything known while checking a program.
pub struct Checker<'a> {
    library: &'a Library,
    /// What the library made before.
    ahead: &'a Ahead,
    /// The modules called into.
    called: BTreeSet<usize>,
    modules: &'a [Module],
    globals: Vec<FxHashMap<String, Global>>,
    /// The nodes and textures of each file by name.
    callables: Vec<FxHashMap<&'a str, Vec<Callable>>>,
    aliases: Vec<String>,
    /// The rows of operators that were looked up, by the types of their operands.
    overloads: FxHashMap<(BinaryOperator, Type, Type), Option<Overload>>,
    made: FxHashMap<Key, Outcome>,
    interned: FxHashMap<u64, Vec<FunctionId>>,
    functions: Vec<Function>,
    /// For each function the most steps that its folds take inside each other.
    function_steps: Vec<u64>,
    params: Vec<Param>,
    param_names: FxHashSet<String>,
    resources: Vec<Resource>,
    resource_wires: Vec<ResourceFields>,
    views: Vec<ResourceView>,
    /// The resources that are rows of the shared table.
    rows: Vec<u32>,
    /// The periods that textures of the main file ask for, by their items.
    periods: FxHashMap<usize, [f32; 2]>,
    diagnostics: Vec<Diagnostic>,
    warnings: Vec<Diagnostic>,
    /// Where functions that were made ahead stand, by their place in the library's list.
    taken: FxHashMap<FunctionId, FunctionId>,
    /// Nodes made or being made.
    started: usize,
    /// Values of the functions made.
    values: usize,
    /// Operations that working out constants may still take.
    budget: u64,
    /// The limit on values was reported.
    overfull: bool,
    /// The limit on nodes was reported.
    full: bool,
}

/// The fields of a resource of the program.
struct ResourceFields {
    /// Row of the table of kinds.
    kind: usize,
    views: Vec<ViewId>,
    constants: Vec<(&'static str, crate::graph::Constant)>,
}

impl<'a> Checker<'a> {
    /// Over the library's and a user's modules; what is made `ahead` is taken over.
    pub fn new(library: &'a Library, ahead: &'a Ahead, modules: &'a [Module]) -> Checker<'a> {
        Checker {
            library,
            ahead,
            called: BTreeSet::new(),
            modules,
            globals: vec![FxHashMap::default(); modules.len()],
            callables: globals::all_callables(modules, library.modules().len()),
            aliases: globals::aliases(modules, library.modules().len()),
            overloads: FxHashMap::default(),
            made: FxHashMap::default(),
            interned: FxHashMap::default(),
            functions: Vec::new(),
            function_steps: Vec::new(),
            params: Vec::new(),
            param_names: FxHashSet::default(),
            resources: Vec::new(),
            resource_wires: Vec::new(),
            views: Vec::new(),
            rows: Vec::new(),
            periods: FxHashMap::default(),
            diagnostics: Vec::new(),
            warnings: Vec::new(),
            taken: FxHashMap::default(),
            started: 0,
            values: 0,
            budget: limits::MAX_EVALUATION,
            overfull: false,
            full: false,
        }
    }

    /// The modules that were called into, those of the library among them.
    pub fn called(&self) -> &BTreeSet<usize> {
        &self.called
    }

    /// All warnings so far, in source order, each once.
    pub fn take_warnings(&mut self) -> Vec<Diagnostic> {
        let mut warnings = std::mem::take(&mut self.warnings);
        warnings.sort_by_key(|d| (d.place, d.code));
        warnings.dedup_by_key(|d| (d.place, d.code));
        warnings
    }

    /// All errors so far, in source order, each once.
    pub fn into_diagnostics(mut self) -> Vec<Diagnostic> {
        self.diagnostics.sort_by_key(|d| (d.place, d.code));
        self.diagnostics.dedup_by_key(|d| (d.place, d.code));
        self.diagnostics
    }

    /// Whether nothing was wrong so far.
    pub fn is_fine(&self) -> bool {
        self.diagnostics.is_empty()
    }

    /// The documentation of the item of `key`.
    pub fn doc(&self, key: &Key) -> String {
        self.modules[key.module].tree.items.get(key.item).map_or(String::new(), |item| item.doc.clone())
    }

    /// The graph whose entry is the node of `key`, made before, after those of the bakes that it
    /// reads, each after those that it reads itself. With each bake the resource that it fills.
    pub fn into_graphs(mut self, key: &Key) -> Option<Vec<PassGraph>> {
        self.share_tables();
        let Some(Outcome::Made(entry)) = self.made.get(key).copied() else { return None };
        let mut graph = Graph {
            functions: self.functions,
            params: self.params,
            resources: self.resources,
            views: self.views,
        };
        let bakes = passes::bakes(&graph, entry).into_iter().filter_map(|id| {
            let resource = graph.resources.get(id as usize)?;
            Some(PassGraph { graph: passes::bake(&graph, resource)?, bake: Some(id) })
        });
        let mut graphs: Vec<PassGraph> = bakes.collect();
        // What is called is made before, so nothing after the entry is needed.
        graph.functions.truncate(entry.0 as usize + 1);
        graphs.push(PassGraph { graph, bake: None });
        Some(graphs)
    }

    fn report(&mut self, f: &mut Frame<'a>, diagnostic: Diagnostic) -> Wire {
        f.failed = true;
        // The library is right: what is wrong in it was called wrongly.
        let diagnostic = match (f.caller, f.node) {
            (Some(place), Some(node)) if f.module < self.library.modules().len() => {
                diagnostic.called_from(place, &node.name.text)
            }
            _ => diagnostic,
        };
        self.diagnostics.push(diagnostic);
        Wire::Unknown
    }

    /// The node of an item.
    fn node(&self, module: usize, item: usize) -> Option<&'a Node> {
        match &self.modules.get(module)?.tree.items.get(item)?.kind {
            ItemKind::Node(node) | ItemKind::Texture { node, .. } => Some(node),
            _ => None,
        }
    }

    /// Makes a function and all it calls.
    fn run(&mut self, root: Frame<'a>) {
        let mut stack = vec![root];
        while let Some(mut top) = stack.pop() {
            // Two steps may have waited for the same node; the second finds it made.
            if top.key.as_ref().is_some_and(|key| self.made.contains_key(key)) {
                continue;
            }
            if let Some(prepared) = top.prepared {
                self.take_over(prepared);
                continue;
            }
            if self.step(&mut top) {
                self.close(top);
                continue;
            }
            let waiting = std::mem::take(&mut top.waiting);
            let parent = stack.len();
            stack.push(top);
            for (key, place) in waiting {
                match self.start(&stack, parent, &key, place) {
                    Some(frame) => stack.push(frame),
                    None => {
                        self.made.insert(key, Outcome::Failed);
                    }
                }
            }
        }
    }

    /// A frame for a node that is waited for; none where it can't be made, which is reported.
    fn start(&mut self, stack: &[Frame<'a>], parent: usize, key: &Key, place: Place) -> Option<Frame<'a>> {
        let node = self.node(key.module, key.item)?;
        self.called.insert(key.module);
        let mut up = Some(parent);
        while let Some(frame) = up.and_then(|i| stack.get(i)) {
            if frame.key.as_ref().is_some_and(|k| (k.module, k.item) == (key.module, key.item)) {
                self.diagnostics.push(names::recursion(place, &node.name.text));
                return None;
            }
            up = frame.parent;
        }
        if let Some(prepared) = self.made_ahead(key) {
            return Some(Frame { key: Some(key.clone()), prepared: Some(prepared), ..Frame::empty() });
        }
        self.started += 1;
        if self.started > limits::MAX_NODES {
            if !self.full {
                self.diagnostics.push(limits::too_many_nodes(place, &node.name.text));
            }
            self.full = true;
            return None;
        }
        let mut frame = self.frame(node, key.clone(), Some(parent));
        let caller = stack.get(parent);
        let is_user = caller.is_some_and(|caller| caller.module >= self.library.modules().len());
        frame.caller = if is_user { Some(place) } else { caller.and_then(|caller| caller.caller) };
        Some(frame)
    }

    /// A frame with the inputs of its node in scope.
    fn frame(&mut self, node: &'a Node, key: Key, parent: Option<usize>) -> Frame<'a> {
        let mut f = Frame::empty();
        // A statement makes a few values.
        let values = 4 * node.body.statements.len();
        f.builder = Builder::with_capacity(render::name_of(node, key.wire.as_deref()), values);
        f.node = Some(node);
        f.module = key.module;
        f.parent = parent;
        f.dims = node.dims.iter().map(|d| d.text.as_str()).zip(key.dims.iter().copied()).collect();
        f.scopes[0].reserve(node.inputs.len() + node.body.statements.len());
        for (input, argument) in node.inputs.iter().zip(&key.arguments) {
            let wire = self.input_wire(&mut f, input, argument);
            f.scopes[0].insert(&input.name.text, wire);
        }
        self.doubt(&mut f, node, key.item);
        f.key = Some(key);
        self.plan_node(&mut f, node);
        f
    }

    /// Puts a finished node among the functions: the equal one there is already, or a new one.
    fn close(&mut self, mut f: Frame<'a>) {
        let Some(key) = f.key.take() else { return };
        if let (Some(node), Some(wire)) = (f.node, &key.wire) {
            self.output_wire(&mut f, node, wire);
        }
        let whole = f.node.filter(|_| key.wire.is_none());
        for output in whole.iter().flat_map(|node| &node.outputs) {
            match f.scopes[0].get(output.name.text.as_str()) {
                Some(Wire::Value(value)) => f.builder.output(output.name.text.clone(), *value),
                Some(Wire::Matrix(columns)) => {
                    for (i, column) in (0..).zip(columns.iter()) {
                        f.builder.output(node::column_name(&output.name.text, i), *column);
                    }
                }
                _ => f.failed = true,
            }
        }
        if passes_on(f.builder.function()) {
            f.builder.set_inline(true);
        }
        let outcome = if f.failed { Outcome::Failed } else { Outcome::Made(self.intern(f.builder.finish())) };
        self.made.insert(key, outcome);
    }

    fn intern(&mut self, function: Function) -> FunctionId {
        let hash = structure(&function);
        let alike = self.interned.entry(hash).or_default();
        let same = |id: &&FunctionId| {
            let other = &self.functions[id.0 as usize];
            other.name == function.name
                && other.values == function.values
                && other.types == function.types
                && other.outputs == function.outputs
                && other.inputs == function.inputs
        };
        if let Some(id) = alike.iter().find(same) {
            return *id;
        }
        let id = FunctionId(self.functions.len() as u32);
        self.values += function.values.len();
        alike.push(id);
        self.function_steps.push(fold::steps_of(&function, &self.function_steps));
        self.functions.push(function);
        id
    }

    /// What an input of a function is, given what is known of its argument.
    fn input_wire(&self, f: &mut Frame<'a>, input: &Input, argument: &ArgumentKey) -> Wire {
        let name = &input.name.text;
        match argument {
            ArgumentKey::Constant(constant) => Wire::Value(f.builder.constant(*constant)),
            ArgumentKey::Value(ty) => Wire::Value(f.builder.input(name.clone(), *ty)),
            ArgumentKey::Matrix(columns) => {
                let column = |(i, key): (u8, &ArgumentKey)| match key {
                    ArgumentKey::Constant(constant) => f.builder.constant(*constant),
                    ArgumentKey::Value(ty) => f.builder.input(node::column_name(name, i), *ty),
                    _ => f.builder.constant(Constant::floats(&[0.0])),
                };
                Wire::Matrix((0..).zip(columns).map(column).collect())
            }
            ArgumentKey::Resource(kind, constants) => {
                let mut views = Vec::new();
                for field in KINDS[*kind].fields {
                    if let Some(view) = field.kind.view() {
                        let full = format!("{name}_{}", field.name);
                        let view = constructor::with_anisotropy(view, constants);
                        views.push((field.name, f.builder.input(full, Type::View(view))));
                    }
                }
                Wire::Resource(Rc::new(ResourceWire {
                    kind: *kind,
                    id: None,
                    views,
                    constants: constants.clone(),
                }))
            }
            ArgumentKey::Node(function) => self.node_input(f, input, *function),
            ArgumentKey::Word(word) => Wire::word(word, Place::default()),
            ArgumentKey::None => Wire::None,
        }
    }

    /// A node that was passed in: its captures are inputs.
    fn node_input(&self, f: &mut Frame<'a>, input: &Input, function: FunctionId) -> Wire {
        let declared = types::resolve(&input.ty, &f.dims, self.modules[f.module].file);
        let Ok(Declared::Node(ty)) = declared else { return Wire::Unknown };
        let own: usize = ty.inputs.iter().map(|(name, declared)| node::slots(declared, name).len()).sum();
        let made = &self.functions[function.0 as usize];
        let captures = made.inputs.iter().skip(own);
        let captures =
            captures.map(|slot| f.builder.input(format!("{}_{}", input.name.text, slot.name), slot.ty));
        Wire::Node(Rc::new(NodeWire { function, captures: captures.collect(), ty }))
    }

    /// A place in the file of the frame's module.
    fn place(&self, f: &Frame<'a>, span: Span) -> Place {
        Place { file: self.modules[f.module].file, span }
    }

    fn param_value(&self, f: &mut Frame<'a>, id: ParamId) -> Wire {
        let ty = self.params.get(id.0 as usize).map_or(Type::FLOAT, |param| param.ty);
        Wire::Value(f.builder.push(crate::graph::Operation::Param(id), ty))
    }

    /// A resource in the function being made.
    fn resource_value(&self, f: &mut Frame<'a>, resource: usize) -> Wire {
        let ResourceFields { kind, views: ids, constants } = &self.resource_wires[resource];
        let mut views = Vec::new();
        for id in ids {
            let ResourceView { field, view, .. } = &self.views[id.0 as usize];
            views.push((*field, f.builder.push(crate::graph::Operation::View(*id), Type::View(*view))));
        }
        let id = Some(resource);
        Wire::Resource(Rc::new(ResourceWire { kind: *kind, id, views, constants: constants.clone() }))
    }
}

/// Whether all that a function does is to call another.
fn passes_on(function: &Function) -> bool {
    let is_call = |operation: &&Operation| matches!(operation, Operation::Call(..));
    let is_free = |operation: &Operation| {
        matches!(operation, Operation::Input(_) | Operation::Constant(_) | Operation::Output(..))
    };
    function.values.iter().filter(is_call).count() == 1
        && function.values.iter().all(|operation| is_free(operation) || is_call(&operation))
}

fn structure(function: &Function) -> u64 {
    use std::hash::{Hash, Hasher};
    let mut hasher = rustc_hash::FxHasher::default();
    function.name.hash(&mut hasher);
    function.values.hash(&mut hasher);
    function.inputs.hash(&mut hasher);
    hasher.finish()
}
