//! Where everything stands: layers from left to right, by the crate dugong (the algorithm of
//! Gansner et al., *A Technique for Drawing Directed Graphs*, 1993, as dagre has it).
//!
//! It knows nothing of ports, so wires are led here: from port to port through the gaps that the
//! layout leaves for them between the blocks of each layer.

use super::shape::{LINE, Shape};
use super::{Diagram, DrawError, End, Kind, MAX_BLOCKS, Wire};
use dugong::graphlib::{Graph, GraphOptions};
use dugong::{EdgeLabel, GraphLabel, NodeLabel, RankDir, WorkControl, WorkError};

/// What laying out may cost, in the crate's units: about two seconds. The bound of blocks is met
/// first unless very many wires are very long.
const MAX_WORK: usize = 60_000_000;

/// Between the layers.
const LAYERS: f64 = 56.0;
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

/// A level piece of a wire. From one to the next it runs in a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    pub from: f64,
    pub to: f64,
    pub y: f64,
}

type Layered = Graph<NodeLabel, EdgeLabel, GraphLabel>;

/// Lays a diagram out.
///
/// # Errors
/// It is too large, or its wires too many.
pub fn place(diagram: &Diagram) -> Result<Sheet, DrawError> {
    if diagram.blocks.len() > MAX_BLOCKS {
        return Err(DrawError::TooLarge(diagram.blocks.len()));
    }
    let shapes: Vec<Shape> = diagram.blocks.iter().map(Shape::of).collect();
    let mut graph = layered(diagram, &shapes);
    dugong::layout_controlled(&mut graph, &mut Budget(MAX_WORK)).map_err(|_| DrawError::TooEntangled)?;
    let layers = layers(diagram, &shapes, &graph);
    let mut places = Vec::new();
    for (block, shape) in shapes.into_iter().enumerate() {
        let middle = middle(&graph, &id(block));
        let layer = layers.iter().find(|layer| (layer.middle - middle.0).abs() < 1.0);
        let (left, right) = layer.map_or((middle.0, middle.0), |layer| (layer.left, layer.right));
        // What begins stands at the right of its layer, what ends and all between at the left.
        let begins = is_source(diagram, block);
        let x = if begins { right - shape.margin - shape.width } else { left };
        places.push(Place { x, y: middle.1 - shape.height / 2.0, shape });
    }
    sort_ports(diagram, &graph, &mut places);
    let wires = diagram.wires.iter().enumerate();
    let wires = wires.map(|(i, wire)| led(wire, &places, &layers, &bends(&graph, wire, i))).collect();
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
        } else if ends[block] {
            // A wire that nobody reads ends before the outputs.
            let before = EdgeLabel { minlen: 2, ..held(0.0) };
            graph.set_edge_named(id(block), "last", None::<String>, Some(before));
        }
    }
    let apart = EdgeLabel { minlen: 3, ..held(0.0) };
    graph.set_edge_named("first", "last", None::<String>, Some(apart));
    for (i, wire) in diagram.wires.iter().enumerate() {
        let (from, to) = (id(wire.from.block), id(wire.to.block));
        graph.set_edge_named(from, to, Some(i.to_string()), Some(held(1.0)));
    }
    graph
}

fn middle(graph: &Layered, id: &str) -> (f64, f64) {
    let found = graph.node(id).and_then(|label| Some((label.x?, label.y?)));
    found.unwrap_or_default()
}

/// The blocks that stand above one another.
struct Layer {
    middle: f64,
    left: f64,
    right: f64,
}

/// From left to right.
fn layers(diagram: &Diagram, shapes: &[Shape], graph: &Layered) -> Vec<Layer> {
    let mut layers: Vec<Layer> = Vec::new();
    for (block, shape) in shapes.iter().enumerate().take(diagram.blocks.len()) {
        let (x, half) = (middle(graph, &id(block)).0, (shape.width + shape.margin) / 2.0);
        match layers.iter_mut().find(|layer| (layer.middle - x).abs() < 1.0) {
            Some(layer) => {
                layer.left = layer.left.min(x - half);
                layer.right = layer.right.max(x + half);
            }
            None => layers.push(Layer { middle: x, left: x - half, right: x + half }),
        }
    }
    layers.sort_by(|a, b| a.middle.total_cmp(&b.middle));
    layers
}

/// Puts ports whose order says nothing in an order in which few wires cross: the outputs of a
/// resource by where their wires go first, the inputs of a formula by where theirs come from.
fn sort_ports(diagram: &Diagram, graph: &Layered, places: &mut [Place]) {
    let mut leaving: Vec<Vec<(f64, usize)>> = vec![Vec::new(); places.len()];
    for (i, wire) in diagram.wires.iter().enumerate() {
        let first = bends(graph, wire, i).get(1).copied();
        let y = first.map_or_else(|| input(places, wire.to).1, |bend| bend.1);
        leaving[wire.from.block].push((y, wire.from.port));
    }
    for (block, shown) in diagram.blocks.iter().enumerate() {
        if shown.kind == Kind::Resource {
            reorder(&mut places[block].shape.outputs, &mut leaving[block]);
        }
    }
    let mut coming: Vec<Vec<(f64, usize)>> = vec![Vec::new(); places.len()];
    for (i, wire) in diagram.wires.iter().enumerate() {
        let last = bends(graph, wire, i).iter().rev().nth(1).copied();
        let y = last.map_or_else(|| output(places, wire.from).1, |bend| bend.1);
        coming[wire.to.block].push((y, wire.to.port));
    }
    for (block, shown) in diagram.blocks.iter().enumerate() {
        if shown.kind == Kind::Formula {
            reorder(&mut places[block].shape.inputs, &mut coming[block]);
        }
    }
}

/// Gives the ports the same heights in another order: the one whose first wire is highest comes
/// first.
fn reorder(heights: &mut [f64], wires: &mut [(f64, usize)]) {
    wires.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut order: Vec<usize> = Vec::new();
    for port in wires.iter().map(|(_, port)| *port).chain(0..heights.len()) {
        if !order.contains(&port) {
            order.push(port);
        }
    }
    let before = heights.to_vec();
    for (port, height) in order.into_iter().zip(before) {
        if let Some(slot) = heights.get_mut(port) {
            *slot = height;
        }
    }
}

/// Where an output lies.
fn output(places: &[Place], end: End) -> (f64, f64) {
    let place = &places[end.block];
    let y = place.shape.outputs.get(end.port).copied().unwrap_or(LINE);
    (place.x + place.shape.width, place.y + y)
}

fn input(places: &[Place], end: End) -> (f64, f64) {
    let place = &places[end.block];
    (place.x, place.y + place.shape.inputs.get(end.port).copied().unwrap_or(LINE))
}

/// Where the layout lets a wire pass the layers between its blocks.
fn bends(graph: &Layered, wire: &Wire, index: usize) -> Vec<(f64, f64)> {
    let name = index.to_string();
    let edge = graph.edge(&id(wire.from.block), &id(wire.to.block), Some(name.as_str()));
    edge.map_or(Vec::new(), |edge| edge.points.iter().map(|point| (point.x, point.y)).collect())
}

/// A wire from port to port: level under its name, level through each layer that it passes.
fn led(wire: &Wire, places: &[Place], layers: &[Layer], bends: &[(f64, f64)]) -> Vec<Stretch> {
    let (start, end) = (output(places, wire.from), input(places, wire.to));
    let margin = places[wire.from.block].shape.margin;
    let beside = layers.iter().find(|layer| layer.left <= start.0 && start.0 <= layer.right + 0.5);
    let out = beside.map_or(start.0 + margin, |layer| layer.right).max(start.0 + 6.0);
    let mut stretches = vec![Stretch { from: start.0, to: out, y: start.1 }];
    for layer in layers.iter().filter(|layer| layer.left > start.0 && layer.right < end.0) {
        let within = |bend: &&(f64, f64)| (bend.0 - layer.middle).abs() < 1.0;
        if let Some(bend) = bends.iter().find(within) {
            stretches.push(Stretch { from: layer.left, to: layer.right, y: bend.1 });
        }
    }
    stretches.push(Stretch { from: end.0 - 8.0, to: end.0, y: end.1 });
    stretches
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
        *stretch = Stretch { from: stretch.from - left, to: stretch.to - left, y: stretch.y - top };
    }
    Sheet { width: right - left, height: bottom - top, ..sheet }
}
