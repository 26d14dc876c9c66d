//! Graph to naga module.
//!
//! Every function of the graph becomes a plain function that touches no global: its inputs, then
//! the params it reads, then the views it reads with their samplers, itself or through what it
//! calls. One thin wrapper around the entry reads the globals (see `wrap`).

mod function;
mod helper;
mod operation;
mod types;
mod wrap;

use crate::graph::{Graph, Operation, ParamId, ViewId};
use crate::intrinsic::Helper;
use crate::manifest::Manifest;
use crate::naming::{self, Names, Scope};
use naga::{Handle, Span};
use rustc_hash::FxHashMap;
use std::collections::{BTreeMap, BTreeSet};
use types::Types;

/// A module with the names that its placeholders stand for.
pub struct Lowered {
    /// The module, its names placeholders.
    pub module: naga::Module,
    /// The names.
    pub names: Names,
    /// For each function in the text's order the names of the results of calls.
    pub results: Vec<FxHashMap<u32, String>>,
}

/// Whether a name is taken by the shader language.
pub fn is_keyword(name: &str) -> bool {
    naga::keywords::wgsl::RESERVED_SET.contains(name)
        || naga::keywords::wgsl::BUILTIN_IDENTIFIER_SET.contains(name)
}

/// What a function reads beside its inputs, in the order of its further arguments.
#[derive(Default, Clone)]
struct Captures {
    params: BTreeSet<ParamId>,
    views: BTreeSet<ViewId>,
}

/// A lowered function.
struct Callee {
    handle: Handle<naga::Function>,
    captures: Captures,
    /// Its result is a struct, one member for each output.
    is_struct: bool,
    /// For messages and names of results.
    name: String,
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
    prefix: String,
    functions: Vec<Callee>,
    helpers: BTreeMap<Helper, Handle<naga::Function>>,
    results: Vec<FxHashMap<u32, String>>,
}

/// Lowers a graph whose passes have run, wrapped as its manifest says.
pub fn lower(graph: &Graph, manifest: &Manifest) -> Lowered {
    let mut l = Lowering {
        graph,
        manifest,
        module: naga::Module::default(),
        types: Types::default(),
        names: Names::default(),
        scope: Scope::default(),
        prefix: naming::identifier(&manifest.texture),
        functions: Vec::new(),
        helpers: BTreeMap::new(),
        results: Vec::new(),
    };
    // The manifest's names are the ones hosts know.
    let entry = manifest.passes.last().map_or(String::new(), |pass| pass.entry_point.clone());
    l.scope.take(&entry);
    manifest.uniform.iter().for_each(|uniform| l.scope.take(&uniform.name));
    for texture in manifest.textures() {
        l.scope.take(&texture.name);
        texture.sampler.iter().for_each(|sampler| l.scope.take(&sampler.name));
    }
    for i in 0..graph.functions.len() {
        l.function(i);
    }
    l.wrap(&entry);
    Lowered { module: l.module, names: l.names, results: l.results }
}

impl Lowering<'_> {
    /// A module-level name that begins with the texture's.
    fn module_name(&mut self, wish: &str) -> String {
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

    /// What a function and all it calls read.
    fn captures(&self, index: usize) -> Captures {
        let mut captures = Captures::default();
        for operation in &self.graph.functions[index].values {
            match operation {
                Operation::Param(id) => {
                    captures.params.insert(*id);
                }
                Operation::View(id) => {
                    captures.views.insert(*id);
                }
                Operation::Call(callee, _) => {
                    let inner = &self.functions[callee.0 as usize].captures;
                    captures.params.extend(&inner.params);
                    captures.views.extend(&inner.views);
                }
                _ => {}
            }
        }
        captures
    }
}

/// A member of a struct in the making.
struct Member {
    name: String,
    ty: Handle<naga::Type>,
    binding: Option<naga::Binding>,
}
