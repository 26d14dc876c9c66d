//! The mixed graph: what texture artists wire together, at any size, for measuring compilers.
//!
//! Ten nodes make a block: a scaled place, a hex-tiled image, noise, an image, a mix, a warped
//! place, fBm, arithmetic (or cell noise), a shaping curve and a blend, all kinds of MaterialX's
//! standard library. A node reads the oldest results that nobody has read yet, so each block goes
//! on with what the last one made and nothing is dead; warps and every third operand of arithmetic
//! reach anywhere back. The same graph is written in three languages: `tex`, `wgsl` (as an author
//! or MaterialX writes it: shared functions, a line a node) and `materialx` (a document).

#![allow(dead_code, unused_imports, reason = "the bench, the test and the example need a part of it each")]

mod materialx;
mod tex;
mod wgsl;

pub use materialx::materialx;
pub use tex::tex;
pub use wgsl::{HAND_WRITTEN, wgsl};

/// Pictures below `photos/`. Hex tiling takes the even ones, plain images the odd ones.
pub const PICTURES: [&str; 8] =
    ["rock", "planks", "cobbles", "sand", "forest_floor", "ice", "gravel_grey", "grass_grey"];

/// What a node computes. Operands are numbers of earlier nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// The texture coordinate, scaled.
    Place(f32),
    /// A picture, hex-tiled at the coordinate times a scale.
    Hex(usize, f32),
    /// A picture at the coordinate times a scale.
    Image(usize, f32),
    /// Gradient noise at a place, 0 to 1.
    Noise(usize),
    /// fBm of so many octaves at a place.
    Fractal(usize, u32),
    /// A random number for each unit square of a place.
    Cell(usize),
    /// A place, moved by a number.
    Warp(usize, usize),
    /// Two numbers in one.
    Arithmetic(Arithmetic, usize, usize),
    /// A number bent into 0 to 1, between two bounds.
    Shape(Shape, usize, f32, f32),
    /// Two colours in one, as far as a number says.
    Blend(Blend, usize, usize, usize),
}

/// Operators of two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Arithmetic {
    Product,
    Sum,
    Difference,
    Greatest,
    Least,
}

/// Curves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    Smoothstep,
    Clamp,
}

/// Ways to lay a colour over another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blend {
    Mix,
    Screen,
    Difference,
}

/// What a node gives.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Gives {
    Place,
    Number,
    Color,
}

impl Kind {
    fn gives(self) -> Gives {
        match self {
            Kind::Place(_) | Kind::Warp(..) => Gives::Place,
            Kind::Hex(..) | Kind::Image(..) | Kind::Blend(..) => Gives::Color,
            Kind::Noise(_) | Kind::Fractal(..) | Kind::Cell(_) | Kind::Arithmetic(..) | Kind::Shape(..) => {
                Gives::Number
            }
        }
    }

    /// The nodes that it reads.
    pub fn operands(self) -> Vec<usize> {
        match self {
            Kind::Place(_) | Kind::Hex(..) | Kind::Image(..) => vec![],
            Kind::Noise(a) | Kind::Fractal(a, _) | Kind::Cell(a) | Kind::Shape(_, a, ..) => vec![a],
            Kind::Warp(a, b) | Kind::Arithmetic(_, a, b) => vec![a, b],
            Kind::Blend(_, a, b, c) => vec![a, b, c],
        }
    }

    /// What nodes of this kind are called.
    fn word(self) -> &'static str {
        match self {
            Kind::Place(_) => "place",
            Kind::Hex(..) => "hex",
            Kind::Image(..) => "image",
            Kind::Noise(_) => "noise",
            Kind::Fractal(..) => "fractal",
            Kind::Cell(_) => "cell",
            Kind::Warp(..) => "warp",
            Kind::Arithmetic(..) => "number",
            Kind::Shape(..) => "shape",
            Kind::Blend(..) => "blend",
        }
    }
}

/// A mixed graph.
pub struct Mixed {
    /// Each reads earlier ones only.
    pub nodes: Vec<Kind>,
    /// The colours that no node reads: what is seen is their mean. Never empty from two nodes on.
    pub ends: Vec<usize>,
}

impl Mixed {
    /// The graph of so many nodes; always the same.
    pub fn new(nodes: usize) -> Mixed {
        let mut making = Making { nodes: Vec::with_capacity(nodes), unread: Vec::new(), state: 1, scales: 0 };
        for i in 0..nodes {
            making.add(i);
        }
        let colors = making.unread.iter().copied().filter(|i| making.nodes[*i].gives() == Gives::Color);
        Mixed { ends: colors.collect(), nodes: making.nodes }
    }

    /// A node's name.
    fn name(&self, node: usize) -> String {
        format!("{}{node}", self.nodes[node].word())
    }

    /// The pictures that are read.
    fn pictures(&self) -> Vec<&'static str> {
        let read = |picture: usize| {
            self.nodes.iter().any(|n| matches!(n, Kind::Hex(p, _) | Kind::Image(p, _) if *p == picture))
        };
        (0..PICTURES.len()).filter(|i| read(*i)).map(|i| PICTURES[i]).collect()
    }
}

/// A graph in the making.
struct Making {
    nodes: Vec<Kind>,
    /// Nodes that no other has read, in order.
    unread: Vec<usize>,
    /// The state of the random numbers.
    state: u32,
    /// How many scales were given out.
    scales: u32,
}

impl Making {
    fn add(&mut self, i: usize) {
        let block = i / 10;
        let kind = match i % 10 {
            0 => Kind::Place(self.scale()),
            1 => Kind::Hex(2 * (block % 4), self.scale()),
            2 => Kind::Noise(self.oldest(Gives::Place)),
            3 => Kind::Image(2 * (block % 4) + 1, self.scale()),
            4 => self.blend(Blend::Mix),
            5 => Kind::Warp(self.any(Gives::Place), self.any(Gives::Number)),
            6 => Kind::Fractal(self.oldest(Gives::Place), 2 + self.random(4)),
            7 if block % 3 == 2 => Kind::Cell(self.any(Gives::Place)),
            7 => self.arithmetic(),
            8 => self.shape(),
            _ => self.blend([Blend::Screen, Blend::Mix, Blend::Difference, Blend::Mix][block % 4]),
        };
        self.nodes.push(kind);
        self.unread.push(i);
    }

    fn arithmetic(&mut self) -> Kind {
        use Arithmetic::*;
        let operator = [Product, Sum, Difference, Greatest, Least][self.random(5) as usize];
        let first = self.oldest(Gives::Number);
        let second = if self.random(3) == 0 { self.any(Gives::Number) } else { self.oldest(Gives::Number) };
        Kind::Arithmetic(operator, first, self.other_than(first, second))
    }

    fn shape(&mut self) -> Kind {
        let curve = [Shape::Smoothstep, Shape::Smoothstep, Shape::Clamp][self.random(3) as usize];
        let low = 0.0 - self.random(6) as f32 / 10.0;
        let high = (3 + self.random(7)) as f32 / 10.0;
        match curve {
            Shape::Smoothstep => Kind::Shape(curve, self.oldest(Gives::Number), low, high),
            Shape::Clamp => Kind::Shape(curve, self.oldest(Gives::Number), 0.0, high),
        }
    }

    fn blend(&mut self, way: Blend) -> Kind {
        let below = self.oldest(Gives::Color);
        let above = self.oldest(Gives::Color);
        Kind::Blend(way, below, self.other_than(below, above), self.oldest(Gives::Number))
    }

    /// The second node, or another of its kind if it is the first.
    fn other_than(&self, first: usize, second: usize) -> usize {
        let gives = self.nodes[first].gives();
        let others = |i: &usize| *i != first && self.nodes[*i].gives() == gives;
        if first == second { (0..self.nodes.len()).rev().find(others).unwrap_or(first) } else { second }
    }

    /// A number below `bound` (xorshift).
    fn random(&mut self, bound: u32) -> u32 {
        self.state ^= self.state << 13;
        self.state ^= self.state >> 17;
        self.state ^= self.state << 5;
        self.state % bound
    }

    /// 1 to 8 in thousandths, for each node (of up to 20,000) another: equal work would be shared.
    fn scale(&mut self) -> f32 {
        self.scales += 1;
        (1_000 + self.scales * 2_741 % 7_000) as f32 / 1_000.0
    }

    /// The oldest result of that kind that nobody has read, else any.
    fn oldest(&mut self, gives: Gives) -> usize {
        match self.unread.iter().position(|i| self.nodes[*i].gives() == gives) {
            Some(place) => self.unread.remove(place),
            None => self.any(gives),
        }
    }

    /// Any result of that kind.
    fn any(&mut self, gives: Gives) -> usize {
        let known: Vec<usize> = (0..self.nodes.len()).filter(|i| self.nodes[*i].gives() == gives).collect();
        let node = known[self.random(known.len() as u32) as usize];
        self.unread.retain(|i| *i != node);
        node
    }
}

/// A number as all three languages write it.
fn number(x: f32) -> String {
    format!("{x:?}")
}
