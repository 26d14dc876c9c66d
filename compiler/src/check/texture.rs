//! Textures: the entry points, whose inputs and outputs have fixed meanings.

use super::constructor::placeholder;
use super::node::{open_input, slots};
use super::plan::has_equal_outputs;
use super::types::{self, Declared, NodeType};
use super::wire::{ArgumentKey, Key, Wire};
use super::{Checker, Frame, Outcome};
use crate::diagnostic::{Place, limits, names, types as errors, unsupported};
use crate::graph::{Builder, FunctionId, Scalar, Type, Value};
use crate::input::INPUTS;
use crate::module::Module;
use texgraph_grammar::syntax::{File, Item, ItemKind, Node};

/// The outputs that hosts know, with their types.
const OUTPUTS: &[(&str, &[&str])] = &[
    ("color", &["color", "vec4"]),
    ("normal", &["vec3"]),
    ("emission", &["vec3"]),
    ("height", &["float"]),
    ("roughness", &["float"]),
    ("metallic", &["float"]),
    ("occlusion", &["float"]),
];

fn is_texture(item: &Item) -> bool {
    matches!(item.kind, ItemKind::Texture { .. })
}

/// A file as a whole.
fn whole(module: &Module) -> Place {
    Place { file: module.file, span: texgraph_grammar::syntax::Span::default() }
}

/// The names of a file's textures, in source order.
pub fn textures(file: &File) -> Vec<&str> {
    let nodes = file.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Texture { node, .. } => Some(node.name.text.as_str()),
        _ => None,
    });
    nodes.collect()
}

impl<'a> Checker<'a> {
    /// Makes a texture of the main file: the named one, or the first. A node's name means the node
    /// on its own, `name.wire` a wire inside. None when something is wrong.
    pub fn texture(&mut self, name: Option<&str>) -> Option<Key> {
        let main = self.modules.len().checked_sub(1)?;
        let module: &'a Module = &self.modules[main];
        let Some(name) = name else {
            let first = module.tree.items.iter().position(is_texture);
            if first.is_none() {
                self.diagnostics.push(limits::no_texture(whole(module)));
            }
            return self.entry(main, first?, None);
        };
        let (name, wire) =
            name.split_once('.').map_or((name, None), |(name, wire)| (name, Some(wire.to_owned())));
        let named = |item: &Item| super::globals::node_of(item).is_some_and(|node| node.name.text == name);
        let Some(item) = module.tree.items.iter().position(named) else {
            let known = textures(&module.tree);
            let list = known.iter().map(|t| format!("`{t}`")).collect::<Vec<_>>().join(", ");
            let nodes = module.tree.items.iter().filter_map(super::globals::node_of);
            let near = names::nearest(name, nodes.map(|node| node.name.text.as_str()));
            self.diagnostics.push(limits::no_such_texture(whole(module), name, &list, near));
            return None;
        };
        if is_texture(&module.tree.items[item]) {
            self.entry(main, item, wire)
        } else {
            self.rendered(main, item, wire)
        }
    }

    /// The name of an item in its head.
    pub fn head_of(&self, key: &Key) -> Place {
        let module = &self.modules[key.module];
        let name = module.tree.items.get(key.item).and_then(super::globals::name_of);
        Place { file: module.file, span: name.map(|name| name.span).unwrap_or_default() }
    }

    /// Makes every texture of the main file, then every node that none of them calls.
    pub fn everything(&mut self) {
        let first = self.library.modules().len();
        let main = self.modules.len().saturating_sub(1);
        for (item, declared) in self.modules[main].tree.items.iter().enumerate() {
            if let ItemKind::Texture { .. } = declared.kind {
                self.entry(main, item, None);
            }
        }
        for module in first..self.modules.len() {
            for (item, declared) in self.modules[module].tree.items.iter().enumerate() {
                if let Some(node) = super::globals::node_of(declared)
                    && !self.made.keys().any(|key| (key.module, key.item) == (module, item))
                {
                    let before = self.diagnostics.len();
                    self.alone(module, item, node, true);
                    // How many steps a fold can have, only a call tells.
                    let said = self.diagnostics.split_off(before);
                    self.diagnostics.extend(said.into_iter().filter(|error| error.code != "E0405"));
                }
                if let Some(node) = super::globals::node_of(declared) {
                    self.defaults(module, node);
                }
            }
        }
    }

    /// Makes a texture with every input open.
    fn entry(&mut self, module: usize, item: usize, wire: Option<String>) -> Option<Key> {
        let node = self.node(module, item)?;
        self.budget = limits::MAX_EVALUATION;
        let fine = self.check_signature(module, node);
        let key = self.alone(module, item, node, fine)?;
        if let (true, None, Some(Outcome::Made(function))) = (fine, &wire, self.made.get(&key).copied()) {
            self.check_tiles(module, item, function);
        }
        let key = match wire {
            Some(_) if !fine || !self.is_fine() => return None,
            Some(_) => {
                let key = Key { wire, ..key };
                let frame = self.frame(node, key.clone(), None);
                self.run(frame);
                key
            }
            None => key,
        };
        (fine && matches!(self.made.get(&key), Some(Outcome::Made(_)))).then_some(key)
    }

    /// Makes a node as if nobody called it, to find what is wrong in it: dimensions are 2,
    /// resources are stood in for. None when its head is wrong.
    pub(super) fn alone(&mut self, module: usize, item: usize, node: &'a Node, report: bool) -> Option<Key> {
        let before = self.diagnostics.len();
        let (key, fine) = self.open_key(module, item, node);
        if !report {
            self.diagnostics.truncate(before);
        }
        let frame = self.frame(node, key.clone(), None);
        self.run(frame);
        fine.then_some(key)
    }

    /// Makes names whose declaration is wrong stand for anything, so that one slip is one error.
    pub(super) fn doubt(&self, f: &mut Frame<'a>, node: &'a Node, item: usize) {
        let module: &'a Module = &self.modules[f.module];
        for input in &node.inputs {
            if !matches!(
                types::resolve(&input.ty, &f.dims, module.file),
                Ok(Declared::Vector(..)
                    | Declared::Matrix(_)
                    | Declared::Node(_)
                    | Declared::Resource(_)
                    | Declared::Choice(_))
            ) {
                f.failed = true;
                f.scopes[0].insert(&input.name.text, Wire::Unknown);
                // The same undeclared dimension in an output is the same slip.
                let dimension = types::dimension_variable(&input.ty);
                let same = |ty| dimension.is_some() && types::dimension_variable(ty) == dimension;
                let outputs = node.outputs.iter().filter(|output| same(&output.ty));
                f.doubtful.extend(outputs.map(|output| output.name.text.as_str()));
            }
        }
        if !matches!(module.tree.items.get(item).map(|item| &item.kind), Some(ItemKind::Texture { .. })) {
            return;
        }
        for input in &node.inputs {
            match INPUTS.iter().find(|known| known.name == input.name.text) {
                // Whatever input was meant is missing.
                None => INPUTS.iter().for_each(|known| f.unknown.insert(known.name)),
                Some(known) if !is_one_of(&input.ty, known.types) => {
                    f.scopes[0].insert(&input.name.text, Wire::Unknown);
                }
                Some(_) => {}
            }
        }
        let wrong = node.outputs.iter().filter(|output| {
            let known = OUTPUTS.iter().find(|(name, _)| *name == output.name.text);
            known.is_some_and(|(_, wanted)| !is_one_of(&output.ty, wanted))
        });
        f.doubtful.extend(wrong.map(|output| output.name.text.as_str()));
    }

    /// The key of a node with every input open, and whether its types are right.
    fn open_key(&mut self, module: usize, item: usize, node: &Node) -> (Key, bool) {
        let file = self.modules[module].file;
        let dims: types::Dims = node.dims.iter().map(|d| (d.text.as_str(), 2)).collect();
        let before = self.diagnostics.len();
        let argument = |input: &texgraph_grammar::syntax::Input| match types::resolve(&input.ty, &dims, file)
        {
            Ok(Declared::Vector(scalar, width)) => ArgumentKey::Value(Type::Vector(scalar, width)),
            Ok(Declared::Matrix(size)) => {
                let column = ArgumentKey::Value(Type::Vector(Scalar::Float, size));
                ArgumentKey::Matrix(vec![column; usize::from(size)])
            }
            Ok(Declared::Node(ty)) => ArgumentKey::Node(self.some_node(&ty)),
            Ok(Declared::Resource(kind)) => ArgumentKey::Resource(kind, placeholder(kind)),
            Ok(Declared::Choice(words)) => ArgumentKey::Word(words.into_iter().next().unwrap_or_default()),
            Ok(_) => {
                let (place, ty) = (Place { file, span: input.ty.span }, types::show(&input.ty));
                self.diagnostics.push(errors::type_not_allowed(place, &ty, "a node's input"));
                ArgumentKey::None
            }
            Err(diagnostic) => {
                self.diagnostics.push(diagnostic);
                ArgumentKey::None
            }
        };
        let arguments = node.inputs.iter().map(argument).collect();
        let key =
            Key { module, item, dims: dims.iter().map(|(_, width)| *width).collect(), arguments, wire: None };
        (key, self.diagnostics.len() == before)
    }

    /// A node of a type that gives anything: its outputs are captures.
    fn some_node(&mut self, ty: &NodeType) -> FunctionId {
        let mut builder = Builder::new("node");
        for (name, declared) in &ty.inputs {
            open_input(&mut builder, name, declared);
        }
        let given = open_input(&mut builder, "given", &ty.output);
        for (name, value) in slots(&ty.output, "value").into_iter().zip(values_of(&given)) {
            builder.output(name, value);
        }
        self.intern(builder.finish())
    }

    fn check_signature(&mut self, module: usize, node: &Node) -> bool {
        let file = self.modules[module].file;
        let before = self.diagnostics.len();
        for input in &node.inputs {
            let place = Place { file, span: input.name.span };
            match INPUTS.iter().find(|known| known.name == input.name.text) {
                None => {
                    let near = names::nearest(&input.name.text, INPUTS.iter().map(|known| known.name));
                    let known: Vec<String> = INPUTS.iter().map(|known| format!("`{}`", known.name)).collect();
                    let known = known.join(", ");
                    let error = errors::unknown_texture_input(place, &input.name.text, &known, near);
                    self.diagnostics.push(error);
                }
                Some(known) => self.fixed_type(known.name, known.types, &input.ty, file),
            }
            if let Some(default) = &input.default {
                let place = Place { file, span: default.span };
                self.diagnostics.push(unsupported::not_yet(place, "a default of a texture's input"));
            }
        }
        // Where one output is declared twice, another was meant.
        let outputs = if has_equal_outputs(node) { &[][..] } else { &node.outputs };
        for output in outputs {
            if let Some((name, types)) = OUTPUTS.iter().find(|(name, _)| *name == output.name.text) {
                self.fixed_type(name, types, &output.ty, file);
            }
            if types::scalar_of(&output.ty) == Some(Scalar::Bool) {
                let place = Place { file, span: output.ty.span };
                let ty = types::show(&output.ty);
                self.diagnostics.push(errors::type_not_allowed(place, &ty, "a texture's output"));
            }
        }
        self.diagnostics.len() == before
    }

    fn fixed_type(&mut self, name: &str, wanted: &[&str], ty: &texgraph_grammar::syntax::Type, file: u32) {
        if !is_one_of(ty, wanted) {
            let place = Place { file, span: ty.span };
            self.diagnostics.push(errors::fixed_type(
                place,
                name,
                wanted.first().copied().unwrap_or_default(),
            ));
        }
    }
}

/// The values of a wire of numbers, in order.
fn values_of(wire: &Wire) -> Vec<Value> {
    match wire {
        Wire::Value(value) => vec![*value],
        Wire::Matrix(columns) => columns.to_vec(),
        Wire::Record(fields) => fields.iter().flat_map(|(_, wire)| values_of(wire)).collect(),
        _ => Vec::new(),
    }
}

fn is_one_of(ty: &texgraph_grammar::syntax::Type, wanted: &[&str]) -> bool {
    wanted.contains(&types::show(ty).as_str())
}
