//! Functions of the library that were lowered ahead, and how a module takes them over.
//!
//! An object is a function of a module of its own. In another module it keeps its expressions and
//! statements; types, the functions that it calls and its placeholders become those of that module.

use super::body::Results;
use super::helper::Hash;
use super::{Callee, Lowering, in_place};
use crate::graph::{Function, Graph, Origin};
use crate::manifest::{self, Manifest};
use crate::naming::{Names, renumber};
use naga::{Block, Expression, Handle, Span, Statement};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::collections::BTreeMap;
use std::ops::Range;

/// The library's functions, lowered.
#[derive(Clone, Debug, Default)]
pub struct Objects {
    module: naga::Module,
    names: Names,
    /// By the place of the finished function.
    objects: Vec<Option<Object>>,
    helpers: BTreeMap<Hash, Object>,
    /// Which finished function, or which helper, a function of the module is.
    meanings: FxHashMap<Handle<naga::Function>, Meaning>,
}

/// One of them.
#[derive(Clone, Debug)]
struct Object {
    function: Handle<naga::Function>,
    /// Its own among the names.
    names: Range<usize>,
    /// The names of the results of its calls.
    results: Results,
}

#[derive(Clone, Copy, Debug)]
enum Meaning {
    Finished(u32),
    Helper(Hash),
}

/// What a module has taken over.
#[derive(Default)]
pub struct Linked {
    /// Its functions, by the place of the finished function.
    functions: FxHashMap<u32, Handle<naga::Function>>,
    /// Its types, by those of the objects' module.
    types: FxHashMap<Handle<naga::Type>, Handle<naga::Type>>,
}

impl Linked {
    /// Notes where a function of the graph is, if it is one of the library's.
    pub fn add(&mut self, source: &Function, handle: Handle<naga::Function>) {
        if let Some(Origin::Finished(id)) = source.origin {
            self.functions.insert(id, handle);
        }
    }
}

impl Objects {
    /// Lowers the functions of a graph, but not its entry.
    pub fn of(graph: &Graph) -> Objects {
        let (nothing, manifest) = (Objects::default(), no_manifest());
        let mut l = Lowering::new(graph, &manifest, SmolStr::default(), &nothing);
        let helpers = Hash::all().map(|hash| {
            let start = l.names.len();
            let function = l.helper(hash);
            (hash, Object { function, names: start..l.names.len(), results: Results::default() })
        });
        let helpers: BTreeMap<Hash, Object> = helpers.collect();
        let in_place = in_place(graph);
        let entry = graph.functions.len().saturating_sub(1);
        let mut objects = Vec::new();
        for i in 0..entry {
            let start = l.names.len();
            let lowered = (!in_place.contains(&i)).then(|| l.function(i, ""));
            let callee = lowered.and_then(|()| l.functions[i].as_ref());
            objects.push(callee.map(|callee| Object {
                function: callee.handle,
                names: start..l.names.len(),
                results: l.results.last().cloned().unwrap_or_default(),
            }));
        }
        let finished = (0..).zip(&objects);
        let finished = finished.filter_map(|(i, o)| Some((o.as_ref()?.function, Meaning::Finished(i))));
        let helping = helpers.iter().map(|(hash, object)| (object.function, Meaning::Helper(*hash)));
        let meanings = finished.chain(helping).collect();
        let module = l.module;
        objects.iter_mut().for_each(|object| {
            object.take_if(|object| uses_tables(&module.functions[object.function]));
        });
        Objects { module, names: l.names, objects, helpers, meanings }
    }

    /// A function of a graph, if it was lowered.
    fn find(&self, origin: Option<Origin>) -> Option<&Object> {
        let Some(Origin::Finished(id)) = origin else { return None };
        self.objects.get(id as usize)?.as_ref()
    }
}

/// Whether a function reads constants of its module.
fn uses_tables(function: &naga::Function) -> bool {
    function.expressions.iter().any(|(_, expression)| matches!(expression, Expression::Constant(_)))
}

/// Of a module without globals.
fn no_manifest() -> Manifest {
    Manifest {
        version: manifest::VERSION,
        generator: String::new(),
        texture: String::new(),
        label: String::new(),
        form: manifest::Form::Functions,
        inputs: Vec::new(),
        gradients: Vec::new(),
        discard_below: None,
        tiles: None,
        outputs: Vec::new(),
        params: Vec::new(),
        uniform: None,
        resources: Vec::new(),
        passes: Vec::new(),
    }
}

impl Lowering<'_> {
    /// Takes over function `index` of the graph if it was lowered ahead; whether it was.
    pub(super) fn link(&mut self, index: usize) -> bool {
        let objects = self.objects;
        let source = &self.graph.functions[index];
        let Some(object) = objects.find(source.origin) else { return false };
        if !self.can_link(object) {
            return false;
        }
        let name = self.module_name(&source.name);
        let mut function = self.copy(object);
        let result = self.result_type(source, &name);
        function.name = Some(self.names.placeholder(name));
        if let Some(old) = &mut function.result {
            self.linked.types.insert(old.ty, result);
        }
        self.retype(&mut function);
        for (_, expression) in function.expressions.iter_mut() {
            if let Expression::CallResult(callee) = expression {
                *callee = self.linked(*callee);
            }
        }
        self.recall(&mut function.body);
        let handle = self.module.functions.append(function, Span::UNDEFINED);
        self.linked.add(source, handle);
        self.results.push(object.results.clone());
        self.functions[index] = Some(Callee::new(handle, source));
        true
    }

    /// Takes over a function that shaders bring along, if it was lowered ahead.
    pub(super) fn link_helper(&mut self, helper: Hash, name: &str) -> Option<naga::Function> {
        let object = self.objects.helpers.get(&helper).filter(|object| self.can_link(object))?;
        let mut function = self.copy(object);
        function.name = Some(self.names.placeholder(name));
        self.retype(&mut function);
        Some(function)
    }

    /// Whether no local name has to be another because it begins with the module's.
    fn can_link(&self, object: &Object) -> bool {
        !self.objects.names.begin_with(object.names.clone(), &self.prefix)
    }

    /// A function with placeholders of this module.
    fn copy(&mut self, object: &Object) -> naga::Function {
        let first = self.names.len();
        self.names.extend(&self.objects.names, object.names.clone());
        let mut function = self.objects.module.functions[object.function].clone();
        let own = |placeholder: &mut String| renumber(placeholder, |n| n - object.names.start + first);
        function.arguments.iter_mut().filter_map(|argument| argument.name.as_mut()).for_each(own);
        function.local_variables.iter_mut().filter_map(|(_, local)| local.name.as_mut()).for_each(own);
        function.named_expressions.values_mut().for_each(own);
        function
    }

    /// Gives a function the types of this module.
    fn retype(&mut self, function: &mut naga::Function) {
        let arguments = function.arguments.iter_mut().map(|argument| &mut argument.ty);
        let locals = function.local_variables.iter_mut().map(|(_, local)| &mut local.ty);
        let expressions = function.expressions.iter_mut().filter_map(|(_, expression)| match expression {
            Expression::Compose { ty, .. } | Expression::ZeroValue(ty) => Some(ty),
            _ => None,
        });
        let result = function.result.iter_mut().map(|result| &mut result.ty);
        for ty in arguments.chain(locals).chain(expressions).chain(result) {
            let (types, known) = (&mut self.module.types, &self.objects.module.types);
            *ty = *self
                .linked
                .types
                .entry(*ty)
                .or_insert_with(|| types.insert(known[*ty].clone(), Span::UNDEFINED));
        }
    }

    /// Has the calls of a block go to this module's functions. Blocks nest as deep as regions do.
    fn recall(&mut self, block: &mut Block) {
        for statement in block.iter_mut() {
            match statement {
                Statement::Call { function, .. } => *function = self.linked(*function),
                Statement::If { accept, reject, .. } => {
                    self.recall(accept);
                    self.recall(reject);
                }
                Statement::Loop { body, continuing, .. } => {
                    self.recall(body);
                    self.recall(continuing);
                }
                _ => {}
            }
        }
    }

    /// What a function of the objects' module is in this one. What an object calls has been taken
    /// over before.
    fn linked(&mut self, function: Handle<naga::Function>) -> Handle<naga::Function> {
        match self.objects.meanings.get(&function) {
            Some(Meaning::Helper(helper)) => self.helper(*helper),
            Some(Meaning::Finished(id)) => self.linked.functions.get(id).copied().unwrap_or(function),
            None => function,
        }
    }
}
