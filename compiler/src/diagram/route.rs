//! Wires from port to port. The layout knows blocks only: it leaves a gap for each wire in every
//! layer that the wire passes, and here the wire is led through these gaps.

use super::layout::{Layer, Layered, Place, STEEP, bends};
use super::shape::LINE;
use super::{Diagram, End, Kind, Wire};
use std::collections::BTreeMap;

/// A level piece of a wire. From one to the next it runs in a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    pub from: f64,
    pub to: f64,
    pub y: f64,
    /// Where the curve to the next is steepest.
    pub turn: f64,
}

impl Stretch {
    fn new(from: f64, to: f64, y: f64) -> Stretch {
        Stretch { from, to, y, turn: to }
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

/// A wire from port to port: level under its name, level through each layer that it passes.
pub fn led(wire: &Wire, places: &[Place], layers: &[Layer], bends: &[(f64, f64)]) -> Vec<Stretch> {
    let (start, end) = (output(places, wire.from), input(places, wire.to));
    let margin = places[wire.from.block].shape.margin;
    let beside = layers.iter().find(|layer| layer.left <= start.0 && start.0 <= layer.right + 0.5);
    let out = beside.map_or(start.0 + margin, |layer| layer.right).max(start.0 + 6.0);
    let mut stretches = vec![Stretch::new(start.0, out, start.1)];
    for layer in layers.iter().filter(|layer| layer.left > start.0 && layer.right < end.0) {
        let within = |bend: &&(f64, f64)| layer.holds(bend.0);
        if let Some(bend) = bends.iter().find(within) {
            stretches.push(Stretch::new(layer.left, layer.right, bend.1));
        }
    }
    stretches.push(Stretch::new(end.0 - 8.0, end.0, end.1));
    stretches
}

/// Lets wires between two layers turn one behind the other, so that they cross as little as they
/// can: of those that run down the highest last, of those that run up the lowest last.
pub fn turn(wires: &mut [Vec<Stretch>]) {
    let mut gaps: BTreeMap<i64, Vec<(f64, usize, usize)>> = BTreeMap::new();
    for (wire, stretches) in wires.iter().enumerate() {
        for (i, pair) in stretches.windows(2).enumerate() {
            let down = pair[1].y - pair[0].y;
            // A key that puts the turns in order, from the left.
            let key = if down > 0.0 { -pair[0].y } else { pair[0].y };
            if down.abs() > STEEP / 4.0 {
                gaps.entry((pair[0].to * 10.0) as i64).or_default().push((key, wire, i));
            }
        }
    }
    for stretches in wires.iter_mut() {
        for i in 1..stretches.len() {
            stretches[i - 1].turn = (stretches[i - 1].to + stretches[i].from) / 2.0;
        }
    }
    for mut turns in gaps.into_values() {
        turns.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let last = turns.len().saturating_sub(1).max(1) as f64;
        for (place, (_, wire, i)) in turns.iter().enumerate().filter(|_| turns.len() > 1) {
            let (to, from) = (wires[*wire][*i].to, wires[*wire][*i + 1].from);
            // Between a quarter and three quarters of the way.
            wires[*wire][*i].turn = to + (from - to) * (0.25 + 0.5 * place as f64 / last);
        }
    }
}

/// Puts ports whose order says nothing in an order in which few wires cross: the outputs of a
/// resource by where their wires go first, the inputs of a formula by where theirs come from.
pub fn sort_ports(diagram: &Diagram, graph: &Layered, places: &mut [Place]) {
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
