//! Graph to naga module.
//!
//! Every function of the graph becomes a plain function that touches no global: its inputs, then
//! the params it reads, then the views it reads with their samplers, itself or through what it
//! calls. One thin wrapper around the entry reads the globals (see `wrap`); the functions form does
//! without.

mod block;
mod body;
mod fold;
mod frame;
mod function;
mod helper;
mod link;
mod operation;
mod outline;
mod slope;
mod table;
mod types;
mod wrap;

use crate::contract::{Reads, reads_of_functions};
use crate::graph::regions::Weights;
use crate::graph::{Constant, Function, FunctionId, Graph, Operation};
use crate::manifest::Manifest;
use crate::naming::{self, Names, Scope};
pub use link::Objects;

use body::Results;
use helper::Hash;
use link::Linked;
use naga::{Handle, Span};
use rustc_hash::FxHashMap;
use smol_str::{SmolStr, format_smolstr};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use types::Types;

/// A module with the names that its placeholders stand for.
pub struct Lowered {
    /// The module, its names placeholders.
    pub module: naga::Module,
    /// The names.
    pub names: Names,
    /// For each function in the text's order the names of the results of calls.
    pub results: Vec<Results>,
}

/// Whether a name is taken by the shader language.
pub fn is_keyword(name: &str) -> bool {
    naga::keywords::wgsl::RESERVED_SET.contains(name)
        || naga::keywords::wgsl::BUILTIN_IDENTIFIER_SET.contains(name)
}

/// A lowered function.
struct Callee {
    handle: Handle<naga::Function>,
    /// Its result is a struct, one member for each output.
    is_struct: bool,
    /// What a result is called that has no name of its own.
    result: SmolStr,
}

impl Callee {
    fn new(handle: Handle<naga::Function>, source: &Function) -> Callee {
        let result = format_smolstr!("{}_of", source.name.trim_start_matches('_'));
        Callee { handle, is_struct: source.outputs.len() > 1, result }
    }
}

/// Everything while a module is being made.
struct Lowering<'a> {
    graph: &'a Graph,
    manifest: &'a Manifest,
    module: naga::Module,
    types: Types,
    names: Names,
    /// Names of the module's own things.
    scope: Scope,
    prefix: SmolStr,
    weights: Weights,
    /// What each function of the graph reads beside its inputs: its further arguments, in order.
    reads: Vec<Reads>,
    /// Those lowered so far; folds' steps and conditions stand in place and are none.
    functions: Vec<Option<Callee>>,
    helpers: BTreeMap<Hash, Handle<naga::Function>>,
    tables: FxHashMap<Arc<[Constant]>, Handle<naga::Constant>>,
    results: Vec<Results>,
    /// What was lowered ahead.
    objects: &'a Objects,
    linked: Linked,
}

/// Lowers a graph whose passes have run, wrapped as its manifest says. Functions that were lowered
/// ahead are taken over.
pub fn lower(graph: &Graph, manifest: &Manifest, objects: &Objects) -> Lowered {
    let graph = &*outline::outlined(graph);
    let mut l = Lowering::new(graph, manifest, naming::identifier(&manifest.texture), objects);
    // The manifest's names are the ones hosts know.
    let entry = manifest.passes.last().map_or(String::new(), |pass| pass.entry_point.clone());
    l.scope.take(&entry);
    manifest.uniform.iter().for_each(|uniform| l.scope.take(&uniform.name));
    for texture in manifest.textures() {
        l.scope.take(&texture.name);
        texture.sampler.iter().for_each(|sampler| l.scope.take(&sampler.name));
    }
    let in_place = in_place(graph);
    for i in (0..graph.functions.len()).filter(|i| !in_place.contains(i)) {
        if !l.link(i) {
            l.function(i, &entry);
        }
    }
    l.wrap(&entry);
    Lowered { module: l.module, names: l.names, results: l.results }
}

impl<'a> Lowering<'a> {
    /// An empty module all of whose names begin with `prefix`.
    fn new(graph: &'a Graph, manifest: &'a Manifest, prefix: SmolStr, objects: &'a Objects) -> Lowering<'a> {
        Lowering {
            graph,
            manifest,
            module: naga::Module::default(),
            types: Types::default(),
            names: Names::default(),
            scope: Scope::default(),
            prefix,
            weights: Weights::of(graph),
            reads: reads_of_functions(graph),
            functions: graph.functions.iter().map(|_| None).collect(),
            helpers: BTreeMap::new(),
            tables: FxHashMap::default(),
            results: Vec::new(),
            objects,
            linked: Linked::default(),
        }
    }

    /// A module-level name that begins with the texture's.
    fn module_name(&mut self, wish: &str) -> SmolStr {
        let full = format!("{}_{}", self.prefix, naming::identifier(wish));
        self.scope.name(&full)
    }

    /// A struct with these members, offsets natural.
    fn structure(&mut self, name: &str, members: Vec<Member>) -> Handle<naga::Type> {
        let name = self.scope.name(name);
        let mut fields = Scope::default();
        let mut offset = 0;
        let mut largest = 4;
        let members = members
            .into_iter()
            .map(|member| {
                let (size, align) = types::layout(&self.module.types[member.ty].inner);
                offset = u32::next_multiple_of(offset, align);
                largest = largest.max(align);
                let at = offset;
                offset += size;
                let name = fields.name(&member.name);
                naga::StructMember {
                    name: Some(self.names.placeholder(name)),
                    ty: member.ty,
                    binding: member.binding,
                    offset: at,
                }
            })
            .collect();
        let span = offset.next_multiple_of(largest);
        let inner = naga::TypeInner::Struct { members, span };
        let name = Some(self.names.placeholder(name));
        self.module.types.insert(naga::Type { name, inner }, Span::UNDEFINED)
    }

    /// A function that has been lowered.
    fn callee(&self, id: FunctionId) -> &Callee {
        match &self.functions[id.0 as usize] {
            Some(callee) => callee,
            None => unreachable!("a function is lowered before its callers"),
        }
    }
}

/// The steps and conditions of folds.
fn in_place(graph: &Graph) -> BTreeSet<usize> {
    let operations = graph.functions.iter().flat_map(|function| &function.values);
    let folds = operations.filter_map(|operation| match operation {
        Operation::Fold(fold) => Some(fold),
        _ => None,
    });
    folds.flat_map(|fold| fold.functions()).map(|part| part.0 as usize).collect()
}

/// A member of a struct in the making.
struct Member {
    name: SmolStr,
    ty: Handle<naga::Type>,
    binding: Option<naga::Binding>,
}
