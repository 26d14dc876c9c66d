//! Where everything stands: layers from left to right, by the crate dugong (the algorithm of
//! Gansner et al., *A Technique for Drawing Directed Graphs*, 1993, as dagre has it).
//!
//! It knows nothing of ports: wires are led to them by [`super::route`].

use super::route::{Stretch, led, sort_ports, turn};
use super::shape::Shape;
use super::{Diagram, DrawError, Kind, MAX_BLOCKS, Wire};
use dugong::graphlib::{Graph, GraphOptions};
use dugong::{EdgeLabel, GraphLabel, NodeLabel, RankDir, WorkControl, WorkError};

/// Wires in a picture at most.
pub const MAX_WIRES: usize = 4 * MAX_BLOCKS;
/// What laying out may cost, in the crate's units: about two seconds. The other bounds are met first
/// unless most wires are very long.
const MAX_WORK: usize = 60_000_000;

/// What pulls a wire short. Without any the crate would divide by 0.
const SLACK: f64 = 0.001;

/// Between two layers, at least.
const LAYERS: f64 = 56.0;
/// How much farther for each wire that runs far up or down between them.
const PER_WIRE: f64 = 6.0;
/// Between two layers, at most.
const MOST_APART: f64 = 200.0;
/// How far up or down is far.
pub const STEEP: f64 = 60.0;
/// Between blocks of one layer.
const BLOCKS: f64 = 18.0;
/// Between wires that pass a layer.
const WIRES: f64 = 10.0;
/// Around everything.
pub const MARGIN: f64 = 24.0;

/// A diagram with its places.
pub struct Sheet {
    /// Of the blocks without title and legend.
    pub width: f64,
    pub height: f64,
    /// By block.
    pub places: Vec<Place>,
    /// By wire: where it bends, from its first port to its last.
    pub wires: Vec<Vec<Stretch>>,
}

/// A block on the sheet.
pub struct Place {
    pub x: f64,
    pub y: f64,
    pub shape: Shape,
}

/// What is laid out: blocks and two nodes that hold the ends.
pub type Layered = Graph<NodeLabel, EdgeLabel, GraphLabel>;

/// Lays a diagram out.
///
/// # Errors
/// It is too large, or its wires too many.
pub fn place(diagram: &Diagram) -> Result<Sheet, DrawError> {
    if diagram.blocks.len() > MAX_BLOCKS {
        return Err(DrawError::TooLarge(diagram.blocks.len()));
    }
    let entangled = DrawError::TooEntangled(diagram.wires.len());
    if diagram.wires.len() > MAX_WIRES {
        return Err(entangled);
    }
    let shapes: Vec<Shape> = diagram.blocks.iter().map(Shape::of).collect();
    let mut graph = layered(diagram, &shapes);
    dugong::layout_controlled(&mut graph, &mut Budget(MAX_WORK)).map_err(|_| entangled)?;
    let layers = layers(diagram, &shapes, &graph);
    let mut places: Vec<Place> = Vec::new();
    for (block, shape) in shapes.into_iter().enumerate() {
        let middle = middle(&graph, &id(block));
        let layer = layers.iter().find(|layer| layer.holds(middle.0));
        let (left, right) = layer.map_or((middle.0, middle.0), |layer| (layer.left, layer.right));
        // What begins stands at the right of its layer, what ends and all between at the left.
        let begins = is_source(diagram, block);
        let x = if begins { right - shape.margin - shape.width } else { left };
        places.push(Place { x, y: middle.1 - shape.height / 2.0, shape });
    }
    sort_ports(diagram, &graph, &mut places);
    let wires = diagram.wires.iter().enumerate();
    let mut wires: Vec<Vec<Stretch>> =
        wires.map(|(i, wire)| led(wire, &places, &layers, &bends(&graph, wire, i))).collect();
    turn(&mut wires);
    Ok(fitted(Sheet { width: 0.0, height: 0.0, places, wires }))
}

/// Stops the layout when it has done so much.
struct Budget(usize);

impl WorkControl for Budget {
    fn charge(&mut self, units: usize) -> Result<(), WorkError> {
        self.0 = self.0.checked_sub(units).ok_or(WorkError::Interrupted)?;
        Ok(())
    }
}

fn id(block: usize) -> String {
    format!("b{block}")
}

/// Without a wire that leads to it.
fn is_source(diagram: &Diagram, block: usize) -> bool {
    diagram.blocks[block].inputs.is_empty() && diagram.blocks[block].kind != Kind::Output
}

/// The graph to lay out. Two more nodes hold what begins on the left and what ends on the right.
fn layered(diagram: &Diagram, shapes: &[Shape]) -> Layered {
    let mut graph = Graph::new(GraphOptions { directed: true, multigraph: true, compound: false });
    graph.set_graph(GraphLabel {
        rankdir: RankDir::LR,
        nodesep: BLOCKS,
        edgesep: WIRES,
        ranksep: LAYERS,
        ..GraphLabel::default()
    });
    let mut ends = vec![true; shapes.len()];
    diagram.wires.iter().for_each(|wire| ends[wire.from.block] = false);
    let held = |weight: f64| EdgeLabel { weight, ..EdgeLabel::default() };
    for end in ["first", "last"] {
        graph.set_node(end, NodeLabel { width: 1.0, height: 1.0, ..NodeLabel::default() });
    }
    for (block, shape) in shapes.iter().enumerate() {
        let label =
            NodeLabel { width: shape.width + shape.margin, height: shape.height, ..NodeLabel::default() };
        graph.set_node(id(block), label);
        if is_source(diagram, block) {
            graph.set_edge_named("first", id(block), None::<String>, Some(held(1000.0)));
        }
        if diagram.blocks[block].kind == Kind::Output {
            graph.set_edge_named(id(block), "last", None::<String>, Some(held(1000.0)));
        } else if ends[block] && !is_source(diagram, block) {
            // What nobody reads ends before the outputs.
            let before = EdgeLabel { minlen: 2, ..held(SLACK) };
            graph.set_edge_named(id(block), "last", None::<String>, Some(before));
        }
    }
    if !is_joined(diagram) {
        let apart = EdgeLabel { minlen: 3, ..held(SLACK) };
        graph.set_edge_named("first", "last", None::<String>, Some(apart));
    }
    for (i, wire) in diagram.wires.iter().enumerate() {
        let (from, to) = (id(wire.from.block), id(wire.to.block));
        graph.set_edge_named(from, to, Some(i.to_string()), Some(held(1.0)));
    }
    graph
}

/// Whether a wire leads from what begins to what ends: then these stand apart by themselves.
fn is_joined(diagram: &Diagram) -> bool {
    let mut reached: Vec<bool> = (0..diagram.blocks.len()).map(|block| is_source(diagram, block)).collect();
    let mut next: Vec<usize> = (0..reached.len()).filter(|block| reached[*block]).collect();
    while let Some(from) = next.pop() {
        for wire in diagram.wires.iter().filter(|wire| wire.from.block == from) {
            if !reached[wire.to.block] {
                reached[wire.to.block] = true;
                next.push(wire.to.block);
            }
        }
    }
    diagram.blocks.iter().zip(reached).any(|(block, reached)| reached && block.kind == Kind::Output)
}

fn middle(graph: &Layered, id: &str) -> (f64, f64) {
    let found = graph.node(id).and_then(|label| Some((label.x?, label.y?)));
    found.unwrap_or_default()
}

/// The blocks that stand above one another.
pub struct Layer {
    /// As it was laid out.
    middle: f64,
    pub left: f64,
    pub right: f64,
}

impl Layer {
    /// Whether something stands in it.
    pub fn holds(&self, middle: f64) -> bool {
        (self.middle - middle).abs() < 1.0
    }
}

/// From left to right, moved apart where many wires run far up or down between two.
fn layers(diagram: &Diagram, shapes: &[Shape], graph: &Layered) -> Vec<Layer> {
    let mut layers: Vec<Layer> = Vec::new();
    for (block, shape) in shapes.iter().enumerate() {
        let (x, half) = (middle(graph, &id(block)).0, (shape.width + shape.margin) / 2.0);
        match layers.iter_mut().find(|layer| layer.holds(x)) {
            Some(layer) => {
                layer.left = layer.left.min(x - half);
                layer.right = layer.right.max(x + half);
            }
            None => layers.push(Layer { middle: x, left: x - half, right: x + half }),
        }
    }
    layers.sort_by(|a, b| a.middle.total_cmp(&b.middle));
    let mut moved = 0.0;
    let mut before: Option<f64> = None;
    let steep = steep(diagram, graph, &layers);
    for (layer, steep) in layers.iter_mut().zip(steep) {
        if let Some(right) = before {
            moved += right + MOST_APART.min(LAYERS + PER_WIRE * steep as f64) - (layer.left + moved);
        }
        layer.left += moved;
        layer.right += moved;
        before = Some(layer.right);
    }
    layers
}

/// For each layer how many wires run steeply to it from the one before.
fn steep(diagram: &Diagram, graph: &Layered, layers: &[Layer]) -> Vec<usize> {
    let mut steep = vec![0; layers.len()];
    for (i, wire) in diagram.wires.iter().enumerate() {
        let ends = [wire.from.block, wire.to.block].map(|block| middle(graph, &id(block)));
        let bends = bends(graph, wire, i);
        let inner = bends.get(1..bends.len().saturating_sub(1)).unwrap_or_default();
        let mut before = ends[0].1;
        for point in inner.iter().chain([&ends[1]]) {
            if let Some(layer) = layers.iter().position(|layer| layer.holds(point.0)) {
                steep[layer] += usize::from((point.1 - before).abs() > STEEP);
                before = point.1;
            }
        }
    }
    steep
}

/// Where the layout lets a wire pass the layers between its blocks.
pub fn bends(graph: &Layered, wire: &Wire, index: usize) -> Vec<(f64, f64)> {
    let name = index.to_string();
    let edge = graph.edge(&id(wire.from.block), &id(wire.to.block), Some(name.as_str()));
    edge.map_or(Vec::new(), |edge| edge.points.iter().map(|point| (point.x, point.y)).collect())
}

/// Moved to the margins.
fn fitted(mut sheet: Sheet) -> Sheet {
    let bound =
        |values: &mut dyn Iterator<Item = f64>, pick: fn(f64, f64) -> f64| values.reduce(pick).unwrap_or(0.0);
    let tops = sheet.places.iter().map(|place| place.y);
    let levels = || sheet.wires.iter().flatten().map(|stretch| stretch.y);
    let left = bound(&mut sheet.places.iter().map(|place| place.x), f64::min);
    let top = bound(&mut tops.chain(levels()), f64::min);
    let right = bound(
        &mut sheet.places.iter().map(|place| place.x + place.shape.width + place.shape.margin),
        f64::max,
    );
    let bottoms = sheet.places.iter().map(|place| place.y + place.shape.height);
    let bottom = bound(&mut bottoms.chain(levels()), f64::max);
    for place in &mut sheet.places {
        place.x -= left;
        place.y -= top;
    }
    for stretch in sheet.wires.iter_mut().flatten() {
        stretch.from -= left;
        stretch.to -= left;
        stretch.turn -= left;
        stretch.y -= top;
    }
    Sheet { width: right - left, height: bottom - top, ..sheet }
}
