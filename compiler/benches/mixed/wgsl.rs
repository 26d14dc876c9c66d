//! The mixed graph as an author would write it in WGSL: shared functions, a line for each node.

use super::{Arithmetic, Blend, Kind, Mixed, PICTURES, Shape, number};

/// The graph of ten nodes, written by hand, as short as it stays readable. Its functions serve
/// graphs of any size.
pub const HAND_WRITTEN: &str = include_str!("hand.wgsl");

/// A module with one fragment entry point, as [`HAND_WRITTEN`] is one.
pub fn wgsl(graph: &Mixed) -> String {
    let functions = HAND_WRITTEN.split_once("// The functions.").map_or("", |(_, rest)| rest);
    let functions = functions.split_once("// The graph.").map_or("", |(functions, _)| functions);
    let mut text = String::new();
    for (i, picture) in graph.pictures().into_iter().enumerate() {
        text += &format!("@group(0) @binding({}) var {picture}: texture_2d<f32>;\n", 2 * i);
        text += &format!("@group(0) @binding({}) var {picture}_sampler: sampler;\n", 2 * i + 1);
    }
    text += functions;
    text += "@fragment\nfn mixed_fragment(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {\n";
    text += "    let dx = dpdx(uv);\n    let dy = dpdy(uv);\n";
    for (i, node) in graph.nodes.iter().enumerate() {
        text += &format!("    let {} = {};\n", graph.name(i), expression(graph, *node));
    }
    let ends: Vec<String> = graph.ends.iter().map(|end| graph.name(*end)).collect();
    text + &format!("    return ({}) / {}.0;\n}}\n", ends.join(" + "), ends.len())
}

fn expression(graph: &Mixed, node: Kind) -> String {
    let name = |node: usize| graph.name(node);
    match node {
        Kind::Place(scale) => format!("uv * {}", number(scale)),
        Kind::Hex(picture, scale) => {
            let (picture, s) = (PICTURES[picture], number(scale));
            format!("hex_tile({picture}, {picture}_sampler, uv * {s}, dx * {s}, dy * {s})")
        }
        Kind::Image(picture, scale) => {
            let (picture, s) = (PICTURES[picture], number(scale));
            format!("textureSampleGrad({picture}, {picture}_sampler, uv * {s}, dx * {s}, dy * {s})")
        }
        Kind::Noise(place) => format!("noise({}) * 0.5 + 0.5", name(place)),
        Kind::Fractal(place, octaves) => format!("fbm({}, {octaves})", name(place)),
        Kind::Cell(place) => format!("hash(vec4(vec2<i32>(floor({})), 0, 0)).x", name(place)),
        Kind::Warp(place, by) => format!("{} + {}", name(place), name(by)),
        Kind::Arithmetic(operator, a, b) => arithmetic(operator, &name(a), &name(b)),
        Kind::Shape(Shape::Smoothstep, x, low, high) => {
            format!("smoothstep({}, {}, {})", number(low), number(high), name(x))
        }
        Kind::Shape(Shape::Clamp, x, low, high) => {
            format!("clamp({}, {}, {})", name(x), number(low), number(high))
        }
        Kind::Blend(way, below, above, by) => {
            let (below, above, by) = (name(below), name(above), name(by));
            let blended = match way {
                Blend::Mix => above,
                Blend::Screen => format!("1.0 - (1.0 - {above}) * (1.0 - {below})"),
                Blend::Difference => format!("abs({above} - {below})"),
            };
            format!("mix({below}, {blended}, {by})")
        }
    }
}

fn arithmetic(operator: Arithmetic, a: &str, b: &str) -> String {
    match operator {
        Arithmetic::Product => format!("{a} * {b}"),
        Arithmetic::Sum => format!("{a} + {b}"),
        Arithmetic::Difference => format!("{a} - {b}"),
        Arithmetic::Greatest => format!("max({a}, {b})"),
        Arithmetic::Least => format!("min({a}, {b})"),
    }
}
