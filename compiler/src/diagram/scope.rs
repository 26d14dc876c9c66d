//! What a name means, as far as a diagram asks: whose ports a call has, and whether it is a block at
//! all or a part of a formula.

use crate::library::{Callable, Library};
use crate::module::Module;
use crate::resource::{KINDS, LATER, dimension_of, kind_named};
use rustc_hash::FxHashMap;
use texgraph_grammar::syntax::{Call, Dim, Input, Item, ItemKind, Node, TypeKind};

/// The program as a diagram sees it.
pub struct Scope<'a> {
    library: &'a Library,
    modules: &'a [Module],
    /// By module and name: where a value is declared first.
    values: FxHashMap<(usize, &'a str), &'a Item>,
    /// By module and name: the nodes and textures.
    nodes: FxHashMap<(usize, &'a str), Vec<&'a Node>>,
}

/// What is called.
#[derive(Clone, Debug, PartialEq)]
pub enum Callee<'a> {
    /// A function of the formula it stands in.
    Function,
    /// A node, or the constructor of a resource.
    Block(Head<'a>),
}

/// The ports of a block.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Head<'a> {
    /// Names of its inputs; none when nobody knows them.
    pub inputs: Option<Vec<&'a str>>,
    /// Names of its outputs; a single one may be empty. None when nobody knows them.
    pub outputs: Option<Vec<&'a str>>,
    /// It makes a resource.
    pub is_constructor: bool,
}

/// Methods of views, which no head declares.
const METHODS: &[(&str, &[&str])] = &[
    ("sample", &["image", "at", "layer", "lod", "gradient"]),
    ("texel", &["image", "i", "layer"]),
    ("level", &["image", "at"]),
];

/// The one function that is a block of its own in the paper's figures: the source of chance.
const HASH: &str = "hash";

/// Functions of formulas that no table lists.
const FORMULA: &[&str] = &[
    "float", "vec", "vec2", "vec3", "vec4", "int", "ivec", "ivec2", "ivec3", "ivec4", "bool", "bvec", "mat2",
    "mat3", "dx", "dy", "given",
];

impl<'a> Scope<'a> {
    pub fn new(library: &'a Library, modules: &'a [Module]) -> Scope<'a> {
        let mut scope = Scope { library, modules, values: FxHashMap::default(), nodes: FxHashMap::default() };
        for (index, module) in modules.iter().enumerate().skip(library.modules().len()) {
            for item in &module.tree.items {
                scope.declare(index, item);
            }
        }
        scope
    }

    fn declare(&mut self, module: usize, item: &'a Item) {
        match &item.kind {
            ItemKind::Let { name, .. } | ItemKind::Param { name, .. } => {
                self.values.entry((module, &name.text)).or_insert(item);
            }
            ItemKind::Node(node) | ItemKind::Texture { node, .. } => {
                self.nodes.entry((module, &node.name.text)).or_default().push(node);
            }
            ItemKind::Use { .. } => {}
        }
    }

    pub fn module(&self, module: usize) -> Option<&'a Module> {
        self.modules.get(module)
    }

    /// The module that a file imports by that name.
    pub fn alias(&self, module: usize, name: &str) -> Option<usize> {
        let imports = &self.modules.get(module)?.imports;
        let named = imports.iter().find(|import| import.alias.as_ref().is_some_and(|own| own.text == name));
        named.map(|import| import.module)
    }

    /// The item that declares a value, of the file or of one that it imports without a name.
    pub fn global(&self, module: usize, name: &str) -> Option<(usize, &'a Item)> {
        self.own(module).into_iter().find_map(|module| Some((module, *self.values.get(&(module, name))?)))
    }

    /// A file and those whose items joined it.
    fn own(&self, module: usize) -> Vec<usize> {
        let imports = self.modules.get(module).map_or(&[][..], |module| &module.imports);
        let joined = imports.iter().filter(|import| import.alias.is_none()).map(|import| import.module);
        std::iter::once(module).chain(joined).collect()
    }

    /// What a name before `(` means in a file. `receiver` is the kind of resource that the call
    /// begins with, if it does: nodes may share a name.
    pub fn callee(&self, module: usize, name: &str, receiver: Option<&str>) -> Callee<'a> {
        let named = self.own(module).into_iter().filter_map(|module| self.nodes.get(&(module, name)));
        let nodes: Vec<&'a Node> = named.flatten().copied().collect();
        if !nodes.is_empty() {
            return Callee::Block(head_of(&nodes, receiver));
        }
        if let Some((_, inputs)) = METHODS.iter().find(|(method, _)| *method == name) {
            return Callee::Block(Head {
                inputs: Some(inputs.to_vec()),
                outputs: Some(vec![""]),
                is_constructor: false,
            });
        }
        self.library_callee(name, receiver)
    }

    fn library_callee(&self, name: &str, receiver: Option<&str>) -> Callee<'a> {
        let found = self.library.callables(name);
        let nodes: Vec<&'a Node> = found.iter().filter_map(|callable| self.library_node(*callable)).collect();
        match found.first() {
            _ if !nodes.is_empty() => Callee::Block(head_of(&nodes, receiver)),
            Some(Callable::Intrinsic(_)) if name != HASH => Callee::Function,
            Some(callable) => {
                let inputs = self.library.signature(*callable).map(|signature| names(&signature.inputs));
                let is_constructor = matches!(callable, Callable::Constructor(_));
                Callee::Block(Head { inputs, outputs: Some(vec![""]), is_constructor })
            }
            None if FORMULA.contains(&name) => Callee::Function,
            None => Callee::Block(Head { is_constructor: LATER.contains(&name), ..Head::default() }),
        }
    }

    fn library_node(&self, callable: Callable) -> Option<&'a Node> {
        let Callable::Node(module, item) = callable else { return None };
        self.modules.get(module)?.tree.items.get(item).and_then(node_of)
    }

    /// Whether a kind of resource has a field of that name; none for a kind nobody knows yet.
    pub fn has_field(&self, kind: &str, field: &str) -> Option<bool> {
        let kind = KINDS.iter().find(|known| known.name == kind)?;
        Some(kind.fields.iter().any(|known| known.name == field))
    }
}

fn node_of(item: &Item) -> Option<&Node> {
    match &item.kind {
        ItemKind::Node(node) | ItemKind::Texture { node, .. } => Some(node),
        _ => None,
    }
}

/// The head of the node that takes the receiver; of the first where that is not known. Of nodes that
/// all take resources of other kinds nothing is known.
fn head_of<'a>(nodes: &[&'a Node], receiver: Option<&str>) -> Head<'a> {
    let taking = nodes.iter().find(|node| {
        receiver.zip(node.inputs.first()).is_some_and(|(receiver, input)| takes(input, receiver))
    });
    let is_other = |node: &&'a Node| node.inputs.first().and_then(type_name).is_some_and(is_resource);
    if taking.is_none() && receiver.is_some() && nodes.iter().all(is_other) {
        return Head::default();
    }
    let Some(node) = taking.or(nodes.first()) else { return Head::default() };
    Head {
        inputs: Some(names(&node.inputs)),
        outputs: Some(node.outputs.iter().map(|output| output.name.text.as_str()).collect()),
        is_constructor: false,
    }
}

/// Whether a type is one of a resource.
pub fn is_resource(name: &str) -> bool {
    KINDS.iter().any(|kind| kind.name == name) || LATER.contains(&name)
}

fn names(inputs: &[Input]) -> Vec<&str> {
    inputs.iter().map(|input| input.name.text.as_str()).collect()
}

/// The name of an input's type, with its dimension where that is a part of a kind's name.
pub fn type_name(input: &Input) -> Option<&str> {
    match &input.ty.kind {
        TypeKind::Named { name, dim } => Some(full_name(&name.text, dim.as_ref())),
        _ => None,
    }
}

/// The name of what is called, with its dimension where that is a part of a kind's name.
pub fn callee_name(call: &Call) -> &str {
    full_name(&call.name.text, call.dim.as_ref())
}

fn full_name<'a>(name: &'a str, dim: Option<&Dim>) -> &'a str {
    let Some(Dim::Number(n, _)) = dim else { return name };
    let kind = u8::try_from(*n).ok().and_then(|dimension| kind_named(name, Some(dimension)));
    kind.map_or(name, |kind| KINDS[kind].name)
}

/// Whether an input takes resources of a kind; a dimension variable stands for any dimension.
fn takes(input: &Input, kind: &str) -> bool {
    match &input.ty.kind {
        TypeKind::Named { name, dim: Some(Dim::Name(_)) } => {
            let known = KINDS.iter().find(|known| known.name == kind);
            known.map_or(kind, |known| dimension_of(known).0) == name.text
        }
        _ => type_name(input) == Some(kind),
    }
}
