//! Textures: the entry points, whose inputs and outputs have fixed meanings.

use super::constructor::placeholder;
use super::types::{self, Declared};
use super::wire::{ArgumentKey, Key};
use super::{Checker, Outcome};
use crate::diagnostic::{Place, limits, names, types as errors, unsupported};
use crate::graph::{Scalar, Type};
use crate::module::Module;
use texgraph_grammar::syntax::{File, ItemKind, Node};

/// The inputs that hosts know, with their types.
const INPUTS: &[(&str, &[&str])] = &[
    ("uv", &["vec2"]),
    ("position", &["vec3"]),
    ("normal", &["vec3"]),
    ("tangent", &["vec4"]),
    ("view", &["vec3"]),
    ("time", &["float"]),
    ("base", &["ivec2", "ivec3"]),
    ("uv2", &["vec2"]),
    ("vertex_color", &["color", "vec4"]),
    ("instance", &["int"]),
];

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

/// The names of a file's textures, in source order.
pub fn textures(file: &File) -> Vec<&str> {
    let nodes = file.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Texture { node, .. } => Some(node.name.text.as_str()),
        _ => None,
    });
    nodes.collect()
}

impl<'a> Checker<'a> {
    /// Makes a texture of the main file: the named one, or the first. None when something is wrong.
    pub fn texture(&mut self, name: Option<&str>) -> Option<Key> {
        let main = self.modules.len().checked_sub(1)?;
        let module: &'a Module = &self.modules[main];
        let known = textures(&module.tree);
        let all = Place { file: module.file, span: texgraph_grammar::syntax::Span::default() };
        let wanted = match name {
            Some(name) if known.contains(&name) => name,
            Some(name) => {
                let list = known.iter().map(|t| format!("`{t}`")).collect::<Vec<_>>().join(", ");
                self.diagnostics.push(limits::no_such_texture(all, name, &list));
                return None;
            }
            None => match known.first() {
                Some(first) => first,
                None => {
                    self.diagnostics.push(limits::no_texture(all));
                    return None;
                }
            },
        };
        let item = module.tree.items.iter().position(|item| {
            matches!(&item.kind, ItemKind::Texture { node, .. } if node.name.text == wanted)
        })?;
        self.entry(main, item)
    }

    /// Makes every texture of the main file, then every node that none of them calls.
    pub fn everything(&mut self) {
        let first = self.library.modules().len();
        let main = self.modules.len().saturating_sub(1);
        for (item, declared) in self.modules[main].tree.items.iter().enumerate() {
            if let ItemKind::Texture { .. } = declared.kind {
                self.entry(main, item);
            }
        }
        for module in first..self.modules.len() {
            for (item, declared) in self.modules[module].tree.items.iter().enumerate() {
                if let Some(node) = super::globals::node_of(declared)
                    && !self.made.keys().any(|key| (key.module, key.item) == (module, item))
                {
                    self.alone(module, item, node);
                }
            }
        }
    }

    /// Makes a texture with every input open.
    fn entry(&mut self, module: usize, item: usize) -> Option<Key> {
        let node = self.node(module, item)?;
        let fine = self.check_signature(module, item, node);
        let key = self.open_key(module, item, node, fine)?;
        let frame = self.frame(node, key.clone(), None);
        self.run(frame);
        (fine && matches!(self.made.get(&key), Some(Outcome::Made(_)))).then_some(key)
    }

    /// Makes a node that nobody calls, to find what is wrong in it: dimensions are 2, resources
    /// are stood in for.
    fn alone(&mut self, module: usize, item: usize, node: &'a Node) {
        if let Some(key) = self.open_key(module, item, node, true) {
            let frame = self.frame(node, key, None);
            self.run(frame);
        }
    }

    /// The key of a node with every input open; None when an input's type is wrong. `report` tells
    /// whether to say so.
    fn open_key(&mut self, module: usize, item: usize, node: &Node, report: bool) -> Option<Key> {
        let file = self.modules[module].file;
        let dims: types::Dims = node.dims.iter().map(|d| (d.text.clone(), 2)).collect();
        let mut arguments = Vec::new();
        for input in &node.inputs {
            arguments.push(match types::resolve(&input.ty, &dims, file) {
                Ok(Declared::Vector(scalar, width)) => ArgumentKey::Value(Type::Vector(scalar, width)),
                Ok(Declared::Resource(kind)) => ArgumentKey::Resource(kind, placeholder(kind)),
                Ok(Declared::Choice(words)) => ArgumentKey::Word(words.into_iter().next().unwrap_or_default()),
                Ok(_) => {
                    let place = Place { file, span: input.ty.span };
                    let ty = types::show(&input.ty);
                    self.diagnostics.push(errors::type_not_allowed(place, &ty, "a node's input"));
                    return None;
                }
                Err(diagnostic) => {
                    if report {
                        self.diagnostics.push(diagnostic);
                    }
                    return None;
                }
            });
        }
        Some(Key { module, item, dims: dims.iter().map(|(_, width)| *width).collect(), arguments })
    }

    fn check_signature(&mut self, module: usize, item: usize, node: &Node) -> bool {
        let file = self.modules[module].file;
        let before = self.diagnostics.len();
        if let ItemKind::Texture { tiles: Some(tiles), .. } = &self.modules[module].tree.items[item].kind {
            let place = Place { file, span: tiles.span };
            self.diagnostics.push(unsupported::not_yet(place, "`tiles`"));
        }
        for input in &node.inputs {
            let place = Place { file, span: input.name.span };
            match INPUTS.iter().find(|(name, _)| *name == input.name.text) {
                None => {
                    let near = names::nearest(&input.name.text, INPUTS.iter().map(|(name, _)| *name));
                    let known = INPUTS.iter().map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(", ");
                    let error = errors::unknown_texture_input(place, &input.name.text, &known, near);
                    self.diagnostics.push(error);
                }
                Some((name, types)) => self.fixed_type(name, types, &input.ty, file),
            }
            if let Some(default) = &input.default {
                let place = Place { file, span: default.span };
                self.diagnostics.push(unsupported::not_yet(place, "a default of a texture's input"));
            }
        }
        for output in &node.outputs {
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
        if !wanted.contains(&types::show(ty).as_str()) {
            let place = Place { file, span: ty.span };
            self.diagnostics.push(errors::fixed_type(place, name, wanted.first().copied().unwrap_or_default()));
        }
    }
}
