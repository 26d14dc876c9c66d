//! The mixed graph in our own language.

use super::{Arithmetic, Blend, Kind, Mixed, Shape, number};

/// A file with one texture, `mixed`, in canonical layout. Pictures are read from `photos/`.
pub fn tex(graph: &Mixed) -> String {
    let mut text = format!(
        "//! The mixed graph of {} nodes: a scaled place, images with and without hex tiling, noise, fBm,\n\
         //! arithmetic and blends, for comparing compilers (compiler/benches/mixed). Noises are taken as\n\
         //! they are, without filtering, as those of the other compilers.\n\n",
        graph.nodes.len()
    );
    let pictures = graph.pictures();
    let widest = pictures.iter().map(|name| name.len()).max().unwrap_or(0);
    for picture in &pictures {
        let file = format!("photos/{picture}.jpg");
        text += &format!("let {picture:widest$} = image(\"{file}\")\n");
    }
    text += "\ntexture mixed(uv: vec2) -> (color: color) {\n";
    let names: Vec<String> = (0..graph.nodes.len()).map(|i| format!("let {}", graph.name(i))).collect();
    let widest = names.iter().map(String::len).chain(["color".len()]).max().unwrap_or(0);
    for (name, node) in names.iter().zip(&graph.nodes) {
        text += &format!("    {name:widest$} = {}\n", expression(graph, *node));
    }
    let ends: Vec<String> = graph.ends.iter().map(|end| graph.name(*end)).collect();
    let mean = match ends.as_slice() {
        [single] => single.clone(),
        several => format!("({}) / {}.0", several.join(" + "), several.len()),
    };
    text + &format!("    {:widest$} = {mean}\n}}\n", "color")
}

fn expression(graph: &Mixed, node: Kind) -> String {
    let name = |node: usize| graph.name(node);
    match node {
        Kind::Place(scale) => format!("uv * {}", number(scale)),
        Kind::Hex(picture, scale) => {
            format!("{}.hex_tile(uv * {})", super::PICTURES[picture], number(scale))
        }
        Kind::Image(picture, scale) => format!("{}.sample(uv * {})", super::PICTURES[picture], number(scale)),
        Kind::Noise(place) => format!("noise({}, width: 0.0) * 0.5 + 0.5", name(place)),
        Kind::Fractal(place, octaves) => format!("fbm({}, octaves: {octaves}, width: 0.0)", name(place)),
        Kind::Cell(place) => format!("hash(ifloor({})).x", name(place)),
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
