//! The mixed graph as a MaterialX document (1.39), node for node from the standard library.
//!
//! Colours are `color3`. The overall texture coordinate is one node more.

use super::{Arithmetic, Blend, Kind, Mixed, PICTURES, Shape, number};

/// A document with the node graph `mixed` and its output `color`.
pub fn materialx(graph: &Mixed) -> String {
    let mut text = String::from("<?xml version=\"1.0\"?>\n<materialx version=\"1.39\">\n");
    text += "  <nodegraph name=\"mixed\">\n    <texcoord name=\"uv\" type=\"vector2\" />\n";
    for (i, node) in graph.nodes.iter().enumerate() {
        text += &element(graph, &graph.name(i), *node);
    }
    let mut mean = graph.ends.first().map_or(String::new(), |end| graph.name(*end));
    for (i, end) in graph.ends.iter().enumerate().skip(1) {
        let name = format!("end{i}");
        let by = Input("mix", "float", number(1.0 / (i + 1) as f32));
        text += &node(
            "mix",
            &name,
            "color3",
            &[wire("bg", "color3", &mean), wire("fg", "color3", &graph.name(*end)), by],
        );
        mean = name;
    }
    text + &format!(
        "    <output name=\"color\" type=\"color3\" nodename=\"{mean}\" />\n  </nodegraph>\n</materialx>\n"
    )
}

/// An input with its type and a value; a wire's value is the attribute of another node.
struct Input(&'static str, &'static str, String);

fn wire(name: &'static str, ty: &'static str, from: &str) -> Input {
    Input(name, ty, format!("@{from}"))
}

fn node(category: &str, name: &str, ty: &str, inputs: &[Input]) -> String {
    let mut text = format!("    <{category} name=\"{name}\" type=\"{ty}\">\n");
    for Input(name, ty, value) in inputs {
        let attribute = match value.strip_prefix('@') {
            Some(from) => format!("nodename=\"{from}\""),
            None => format!("value=\"{value}\""),
        };
        text += &format!("      <input name=\"{name}\" type=\"{ty}\" {attribute} />\n");
    }
    text + &format!("    </{category}>\n")
}

fn element(graph: &Mixed, name: &str, kind: Kind) -> String {
    let of = |node: usize| graph.name(node);
    let float = |name: &'static str, x: f32| Input(name, "float", number(x));
    let place = |from: usize| wire("texcoord", "vector2", &of(from));
    let picture = |category: &str, tiling: &'static str, picture: usize, scale: f32| {
        let file = Input("file", "filename", format!("photos/{}.jpg", PICTURES[picture]));
        let tiling = Input(tiling, "vector2", format!("{scale:?}, {scale:?}"));
        node(category, name, "color3", &[file, wire("texcoord", "vector2", "uv"), tiling])
    };
    match kind {
        Kind::Place(scale) => {
            node("multiply", name, "vector2", &[wire("in1", "vector2", "uv"), float("in2", scale)])
        }
        Kind::Hex(file, scale) => picture("hextiledimage", "tiling", file, scale),
        Kind::Image(file, scale) => picture("tiledimage", "uvtiling", file, scale),
        Kind::Noise(at) => {
            node("noise2d", name, "float", &[place(at), float("amplitude", 0.5), float("pivot", 0.5)])
        }
        Kind::Fractal(at, octaves) => {
            let octaves = Input("octaves", "integer", octaves.to_string());
            node("fractal2d", name, "float", &[place(at), octaves])
        }
        Kind::Cell(at) => node("cellnoise2d", name, "float", &[place(at)]),
        Kind::Warp(at, by) => {
            let inputs = [wire("in1", "vector2", &of(at)), wire("in2", "float", &of(by))];
            node("add", name, "vector2", &inputs)
        }
        Kind::Arithmetic(operator, a, b) => {
            let inputs = [wire("in1", "float", &of(a)), wire("in2", "float", &of(b))];
            node(arithmetic(operator), name, "float", &inputs)
        }
        Kind::Shape(curve, x, low, high) => {
            let category = match curve {
                Shape::Smoothstep => "smoothstep",
                Shape::Clamp => "clamp",
            };
            let inputs = [wire("in", "float", &of(x)), float("low", low), float("high", high)];
            node(category, name, "float", &inputs)
        }
        Kind::Blend(way, below, above, by) => {
            let category = match way {
                Blend::Mix => "mix",
                Blend::Screen => "screen",
                Blend::Difference => "difference",
            };
            let inputs = [
                wire("fg", "color3", &of(above)),
                wire("bg", "color3", &of(below)),
                wire("mix", "float", &of(by)),
            ];
            node(category, name, "color3", &inputs)
        }
    }
}

fn arithmetic(operator: Arithmetic) -> &'static str {
    match operator {
        Arithmetic::Product => "multiply",
        Arithmetic::Sum => "add",
        Arithmetic::Difference => "subtract",
        Arithmetic::Greatest => "max",
        Arithmetic::Least => "min",
    }
}
