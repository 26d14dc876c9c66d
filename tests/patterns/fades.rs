//! What fades into `far` from one to two cells a pixel on keeps its mean, does not pop, and costs
//! nothing where no `far` is given (Lefebvre & Neyret 2003, §5.1).

use crate::support::{Drawing, errors};

/// Cells a side, of which a pixel covers 64 × 64 from afar.
const CELLS: u32 = 64;
const AFAR: u32 = CELLS / 64;
/// Pixels a cell of the reference; a bake has half as many texels.
const FINE: u32 = 16;

/// A node that fades: what it needs, and how it is called at the place `p` in cells, with `FAR` among
/// its arguments.
struct Fading {
    name: &'static str,
    head: &'static str,
    call: &'static str,
}

const NODES: &[Fading] = &[
    Fading {
        name: "splat",
        head: "",
        call: "splat(p, |at, rnd| vec4(rnd.xyz, 1.0) * coverage(0.5 - length(at - 0.5)),
               scale: vec2(0.5, 1.0), round: true FAR)",
    },
    Fading {
        name: "positioned",
        head: "let map = positions(\"decals.ron\", grid: ivec2(16), patterns: tiles, layers: 4)",
        call: "map.positioned(p / 16.0 FAR)",
    },
    Fading {
        name: "transition",
        head: "",
        call: "transition(corners, 2, |i| tiles.reference(i, at), |f| tiles.reference(15 * f, at) FAR)",
    },
    Fading {
        name: "transition_border",
        head: "",
        call: "transition_border(corners, 3, |f, i| tiles.reference(i, at, edges: clear)
               * vec4(1.0, f * 0.5, 0.5, 1.0) FAR)",
    },
    Fading {
        name: "material_transform",
        head: "",
        call: "tiles.material_transform(cell, at, |c| virtual_index(c, 16), heights: tiles,
               scale: |c| 0.4 + 0.4 * virtual_random(c).x, rotation: |c| virtual_random(c).y * 1turn,
               translation: |c| virtual_random(c).zw FAR).color",
    },
    Fading {
        name: "tile_transform",
        head: "",
        call: "tile_transform(|c, at| hue(virtual_random(c).w) * coverage(0.4 - length(at - 0.5)),
               cell, at, scale: |c| 0.5 + 0.5 * virtual_random(c, stream: 1).x FAR)",
    },
    Fading {
        name: "share",
        head: "let mask = pixel_map(\"tiles/source/grass_grey.png\", block: 8)",
        call: "vec4(vec3(mask.share(p * 2.0 / (1.0 * (mask.blocks.size * 8)) FAR)), 1.0)",
    },
];

impl Fading {
    /// A texture of `CELLS` cells a side; `far` is what is given.
    fn text(&self, far: &str) -> String {
        let place = if self.name.starts_with("transition") { ", at: at" } else { "" };
        let given = match (far, self.name) {
            ("", _) => String::new(),
            (far, "share") => format!(", far: ({far}).x"),
            (far, _) => format!("{place}, far: {far}"),
        };
        let near = |given: &str| self.call.replace("FAR", given);
        format!(
            "let tiles = patterns(\"tiles/grass.png\", grid: ivec2(4, 4))
            let afar = bake(|uv| shown(uv * {CELLS}), size: {})
            {}
            node shown(p: vec2) -> (color: color) {{
                let (cell, at) = tile_map(p, 1)
                let corners    = ivec4(hash(cell) * 2.0)
                color          = {}
            }}
            texture t(uv: vec2) -> (seen: vec4) {{
                let p          = uv * {CELLS}
                let (cell, at) = tile_map(p, 1)
                let corners    = ivec4(hash(cell) * 2.0)
                seen           = {}
            }}",
            CELLS * FINE / 2,
            self.head,
            near(""),
            near(&given),
        )
    }

    fn drawing(&self, far: &str) -> Drawing {
        Drawing::of(&self.text(far))
    }
}

/// The mean of pixels.
fn mean(pixels: &[[f32; 4]]) -> [f64; 4] {
    [0, 1, 2, 3].map(|i| pixels.iter().map(|pixel| f64::from(pixel[i])).sum::<f64>() / pixels.len() as f64)
}

/// The greatest difference of two channels.
fn difference(one: &[[f32; 4]], two: &[[f32; 4]]) -> f32 {
    assert_eq!(one.len(), two.len());
    one.iter().flatten().zip(two.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn a_bake_from_afar_keeps_the_mean() {
    for node in NODES {
        let near = mean(&node.drawing("").seen([CELLS * FINE; 2], [0.0, 0.0, 1.0, 1.0]));
        let far = mean(&node.drawing("afar.sample(uv)").cells(AFAR));
        println!("{}: {near:.4?}, from afar {far:.4?}", node.name);
        assert!(near[3] > 0.02, "{} shows something", node.name);
        for (near, far) in near.iter().zip(far) {
            assert!((near - far).abs() < 1.0 / 255.0, "{}: {near}, from afar {far}", node.name);
        }
    }
}

/// Drawn with so many cells a pixel.
fn seen(drawing: &Drawing, cells: f64) -> Vec<[f32; 4]> {
    let end = 0.01 + 16.0 * cells / f64::from(CELLS);
    drawing.seen([16; 2], [0.01, 0.01, end, end])
}

#[test]
fn nothing_pops_where_far_begins_and_where_it_is_all() {
    let far = [0.25, 0.5, 0.75, 1.0];
    for node in NODES {
        let (near, faded) = (node.drawing(""), node.drawing("vec4(0.25, 0.5, 0.75, 1.0)"));
        let far = if node.name == "share" { [0.25, 0.25, 0.25, 1.0] } else { far };
        let all_far = vec![far; 256];
        for (cells, shown) in [(0.3, 0.0), (0.999, 0.0), (1.001, 0.001), (1.5, 0.5)] {
            let (near, faded) = (seen(&near, cells), seen(&faded, cells));
            let expected: Vec<[f32; 4]> = near
                .iter()
                .map(|pixel| [0, 1, 2, 3].map(|i| pixel[i] + (far[i] - pixel[i]) * shown))
                .collect();
            let worst = difference(&faded, &expected);
            assert!(worst < 0.002, "{} at {cells} cells a pixel: {worst}", node.name);
        }
        assert!(difference(&seen(&faded, 1.999), &all_far) < 0.002, "{} ends without a jump", node.name);
        assert!(difference(&seen(&faded, 3.0), &all_far) < 1e-6, "{} is all far", node.name);
        assert!(difference(&seen(&near, 3.0), &all_far) > 0.1, "{}: the test sees a difference", node.name);
    }
}

/// What a call without `far` takes at most: arithmetic, samples and fetches, as before there was one.
const WITHOUT: &[(&str, [f64; 3])] = &[
    ("splat", [598.0, 0.0, 0.0]),
    ("positioned", [613.0, 4.0, 4.0]),
    ("transition_border", [392.0, 3.0, 0.0]),
    ("material_transform", [1785.0, 9.0, 0.0]),
    ("share", [311.0, 0.0, 8.0]),
];

#[test]
fn far_costs_nothing_where_it_is_not_given() {
    for (name, most) in WITHOUT {
        let node = NODES.iter().find(|node| node.name == *name).expect("it is among them");
        let counts = |far: &str| {
            let worst = node.drawing(far).worst();
            [worst.arithmetic.total, worst.samples, worst.fetches]
        };
        let (without, with) = (counts(""), counts("vec4(0.5)"));
        println!("{name}: {without:?} without, {with:?} with");
        assert!(without.iter().zip(most).all(|(count, most)| count <= most), "{name}: {without:?}");
        assert!(with[0] > without[0], "{name}: {with:?}");
    }
}

#[test]
fn a_transition_tells_from_the_families_what_the_tile_alone_does() {
    let text = |shown: &str| {
        format!(
            "let tiles = patterns(\"tiles/grass.png\", grid: ivec2(4, 4))
            texture t(uv: vec2) -> (color: color) {{
                let (cell, at) = tile_map(uv, 20)
                let corners    = ivec4(hash(cell) * 2.0)
                let tile       = transition_tile(corners, 2)
                color          = {shown}
            }}"
        )
    };
    let node = Drawing::of(&text(
        "transition(corners, 2, |i| tiles.reference(i, at), |f| tiles.reference(15 * f, at))",
    ));
    let by_hand = Drawing::of(&text("tiles.reference(tile.index, at)"));
    assert_eq!(node.cells(100), by_hand.cells(100), "15 is what four corners of family 1 make");
    assert_eq!(node.worst().samples, 1.0);
}

/// The maps that are not colours fade into what their patterns are on average.
#[test]
fn all_maps_of_a_material_keep_their_mean() {
    let text = |overflow: &str, far: &str| {
        format!(
            "let tiles = patterns(\"tiles/grass.png\", grid: ivec2(4, 4))
            let heights = patterns(\"tiles/grass.png\", grid: ivec2(4, 4), encoding: linear)
            param cells: float = 128.0 in 1.0..=100000.0
            texture t(uv: vec2) -> (height: float) {{
                let (cell, at) = tile_map(uv * cells, 1)
                let m = tiles.material_transform(cell, at, |c| virtual_index(c, 20) - 4,
                    heights: heights, scale: |c| 0.4 + 0.3 * virtual_random(c).x,
                    rotation: |c| virtual_random(c).y * 1turn,
                    translation: |c| virtual_random(c).zw, overflow: {overflow} {far})
                height = m.height
            }}"
        )
    };
    for overflow in ["shrink", "neighbours"] {
        let near = Drawing::of(&text(overflow, "")).seen([512; 2], [0.0, 0.0, 1.0, 1.0]);
        let far = Drawing::of(&text(overflow, ", far: tiles.average")).seen_with(
            "cells=4096",
            [64; 2],
            [0.0, 0.0, 1.0, 1.0],
        );
        let (near, far) = (mean(&near)[0], mean(&far)[0]);
        println!("{overflow}: {near:.4}, from afar {far:.4}");
        assert!(near > 0.02 && (near - far).abs() < 1.0 / 255.0, "{overflow}: {near}, from afar {far}");
    }
}

#[test]
fn a_place_is_asked_for_with_far() {
    let found = errors(
        "texture t(uv: vec2) -> (color: color) {
            color = transition_border(ivec4(0), 2, |f, i| #ffffff, far: #808080)
        }",
    );
    assert!(found.contains("E0233") && found.contains("`transition_border`"), "{found}");
    assert!(found.contains("main.tex:2") && found.contains("give `at`"), "{found}");
}

/// `none` stands for any input whose default it is, and for no other.
#[test]
fn a_number_may_be_left_out_where_its_node_says_so() {
    let text = |uses: &str| {
        format!(
            "node given_or<n>(p: vec<n>, more: vec<n> = none, turned: node(p: vec<n>) -> float = none)
             -> (sum: float) {{
                let most = if given(more) {{ more.x }} else {{ 0.25 }}
                sum      = if given(turned) {{ turned(p) + most }} else {{ most }}
             }}
             texture t(uv: vec2) -> (seen: float) {{ seen = given_or({uses}) }}"
        )
    };
    let seen = |uses: &str| Drawing::of(&text(uses)).cells(1)[0][0];
    assert_eq!(seen("uv"), 0.25);
    assert_eq!(seen("uv, more: none, turned: none"), 0.25);
    assert_eq!(seen("uv, more: uv"), 0.5);
    assert_eq!(seen("uv, more: none, turned: |p| p.x"), 0.75);
    let found = errors(&text("none"));
    assert!(found.contains("E0222") && found.contains("`none` is not a value"), "{found}");
    let found =
        errors("node n(a: vec2 = none) -> (c: vec2) { c = a }\ntexture t(uv: vec2) -> (c: vec2) { c = n() }");
    assert!(found.contains("E0222") && found.contains("`a` is declared here"), "{found}");
}
