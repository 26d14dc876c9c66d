//! The diagram of a node or a texture: blocks with ports, and the wires between them, in the manner
//! of figures 16 to 20 of Lefebvre & Neyret, *Pattern Based Procedural Textures*, I3D 2003.
//!
//! ```text
//! syntax tree ──build──▶ blocks and wires ──dot──▶ text for Graphviz
//!                                └──layout──▶ places ──svg──▶ picture
//! ```
//!
//! A diagram shows what the author wrote, so it is made of the syntax tree: a call is a block, an
//! expression of operators and mathematical functions is one block with its formula, a `let` names
//! a wire. Only the syntax must be right. A node that nobody declared is a block like any other,
//! whose ports are named as its arguments are.

mod blocks;
mod build;
mod dot;
mod formula;
mod global;
mod layout;
mod route;
mod scope;
mod shape;
mod svg;
#[cfg(test)]
mod tests;
mod text;

use crate::diagnostic::{Diagnostic, Place, limits, names};
use crate::module::{Loader, Module};
use crate::{Failure, Library, module};
use texgraph_grammar::syntax::{Item, ItemKind};

/// Blocks in a picture at most: more are neither laid out in a moment nor read by anybody.
pub const MAX_BLOCKS: usize = 400;

/// A node or texture as blocks and wires.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    /// `texture` or `node`, and its name.
    title: String,
    /// The first line of its documentation; may be empty.
    label: String,
    /// In the order in which they were met; a wire's blocks may come in either order.
    blocks: Vec<Block>,
    /// From outputs to inputs.
    wires: Vec<Wire>,
}

/// A box of the diagram.
#[derive(Clone, Debug, PartialEq)]
struct Block {
    kind: Kind,
    /// May be empty.
    title: String,
    /// Lines of source text.
    text: Vec<String>,
    /// On the left, from the top.
    inputs: Vec<Port>,
    /// On the right, from the top.
    outputs: Vec<Port>,
    /// The most frequent rate that reaches it.
    rate: Rate,
}

/// What a block stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// An input of the texture.
    Input,
    /// An output of the texture.
    Output,
    /// A value that the host sets.
    Param,
    /// What a constructor makes.
    Resource,
    /// A constant that the file declares.
    Constant,
    /// A call of a node.
    Call,
    /// An expression without calls of nodes.
    Formula,
    /// An `if` whose arms hold calls.
    Choice,
    /// A loop.
    Fold,
    /// A node written where it is passed.
    Lambda,
}

/// How often something is evaluated. The greater of two is that of both together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Rate {
    /// When loading: constants, files, tables.
    Load,
    /// Once a draw: params, time.
    Draw,
    /// Once a pixel.
    Pixel,
}

/// Where a wire begins or ends.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Port {
    /// As the head of what is called names it; may be empty.
    name: String,
    /// Of an input: what is given there, as far as no wire says it. Of an output: the name that the
    /// author gave the wire.
    note: String,
}

/// A port of a block, an input or an output as the context says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct End {
    block: usize,
    port: usize,
}

/// A connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Wire {
    from: End,
    to: End,
    /// It carries a node, not a value.
    is_node: bool,
}

/// Why a diagram can't be drawn as a picture. As a text for Graphviz it always can.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawError {
    /// It has more than [`MAX_BLOCKS`] blocks; holds how many.
    TooLarge(usize),
    /// Its wires are too many, or too long; holds how many.
    TooEntangled(usize),
}

impl std::fmt::Display for DrawError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            DrawError::TooLarge(blocks) => {
                write!(f, "it has {blocks} blocks, and a picture shows {MAX_BLOCKS} at most")
            }
            DrawError::TooEntangled(wires) => {
                write!(f, "its {wires} wires are too many for a picture, or too long")
            }
        }
    }
}

impl std::error::Error for DrawError {}

impl Diagram {
    /// As an SVG picture, laid out.
    ///
    /// # Errors
    /// It is too large for one.
    pub fn to_svg(&self) -> Result<String, DrawError> {
        let sheet = layout::place(self)?;
        Ok(svg::draw(self, &sheet))
    }

    /// As text for Graphviz, which lays it out. Any size.
    pub fn to_dot(&self) -> String {
        dot::write(self)
    }

    /// Takes the greatest rate that reaches each block.
    fn spread_rates(&mut self) {
        let mut outgoing = vec![Vec::new(); self.blocks.len()];
        for wire in &self.wires {
            outgoing[wire.from.block].push(wire.to.block);
        }
        let mut changed: Vec<usize> = (0..self.blocks.len()).collect();
        while let Some(from) = changed.pop() {
            for &to in &outgoing[from] {
                if self.blocks[to].rate < self.blocks[from].rate {
                    self.blocks[to].rate = self.blocks[from].rate;
                    changed.push(to);
                }
            }
        }
    }
}

/// The diagram of a texture or node of a file: the named one, or the file's first texture.
///
/// # Errors
/// The file or what it imports can't be read or parsed, or declares no such texture or node.
pub fn diagram(
    library: &Library,
    main: &str,
    loader: &dyn Loader,
    name: Option<&str>,
) -> Result<Diagram, Failure> {
    let modules = module::load(main, loader, library)
        .map_err(|(sources, diagnostics)| Failure { sources, diagnostics })?;
    let main = modules.modules.len().saturating_sub(1);
    let chosen = modules.modules.get(main).map_or(Ok(None), |module| choose(module, name).map(Some));
    match chosen {
        Ok(Some(item)) => Ok(build::build(library, &modules, main, item)),
        Ok(None) => Ok(Diagram { title: String::new(), label: String::new(), blocks: vec![], wires: vec![] }),
        Err(diagnostic) => Err(Failure { sources: modules.sources, diagnostics: vec![diagnostic] }),
    }
}

/// The index of the item to draw.
fn choose(module: &Module, name: Option<&str>) -> Result<usize, Diagnostic> {
    let items = &module.tree.items;
    let place = Place { file: module.file, ..Place::default() };
    let is_texture = |item: &Item| matches!(item.kind, ItemKind::Texture { .. });
    let Some(name) = name else {
        return items.iter().position(is_texture).ok_or_else(|| limits::no_texture(place));
    };
    let named = |item: &&Item| drawn_name(item) == Some(name);
    let found = items.iter().position(|item| is_texture(item) && named(&item));
    found.or_else(|| items.iter().position(|item| named(&item))).ok_or_else(|| {
        let known = || items.iter().filter_map(drawn_name);
        let list = known().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        limits::nothing_to_draw(place, name, &list, names::nearest(name, known()))
    })
}

/// The name of an item that can be drawn.
fn drawn_name(item: &Item) -> Option<&str> {
    match &item.kind {
        ItemKind::Node(node) | ItemKind::Texture { node, .. } => Some(&node.name.text),
        _ => None,
    }
}
