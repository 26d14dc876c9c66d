//! Whether seams are seen: the mean step from a pixel to the next across the edges of triangles, where
//! hexagons begin and end, and across the borders of the photograph inside a hexagon, over that of all
//! other pixels; from close by and from afar, and turned. 1 is no seam.

use crate::{loaded, numbers, word};
use texgraph_compiler::Library;
use texgraph_compiler::manifest::Encoding;
use texgraph_runtime::cpu::Scene;
use texgraph_runtime::picture::Picture;
use texgraph_runtime::render::Request;

/// Pixels along a side of what is drawn.
const SIDE: u32 = 1024;

/// Texels a pixel, and degrees.
const FOOTPRINTS: [f64; 3] = [0.25, 1.0, 3.0];
const TURNS: [f64; 3] = [0.0, 17.0, 45.0];

/// The triangle of a place, and in which copy of the photograph each of its three parts is, as numbers
/// that differ where those do: the grid and the draws of `stochastic`.
const WHERE: &str = "
node copy(at: vec2, vertex: ivec2) -> (number: float) {
    number = hash(ifloor(at + virtual_random(vertex, stream: 1937010544).xy)).x
}

node place(at: vec2) -> (value: vec4) {
    let skewed = mat2(3.4641016, 0.0, -2.0, 4.0) * at
    let corner = ifloor(skewed)
    let inside = fract(skewed)
    let s      = if inside.x + inside.y > 1.0 { 1 } else { 0 }
    value = vec4(
        hash(corner * 2 + s).x,
        copy(at, corner + s),
        copy(at, corner + ivec2(s, 1 - s)),
        copy(at, corner + ivec2(1 - s, s)),
    )
}
";

pub fn tell<'a>(library: &Library, photos: impl Iterator<Item = &'a (&'a str, Encoding)>) {
    println!(
        "steps across edges over those elsewhere, from 0.25 to 3 texels a pixel, turned by up to 45 degrees"
    );
    println!("                         wrap: repeat, triangles   borders         wrap: inside, triangles");
    for (file, encoding) in photos {
        let side = image::image_dimensions(crate::photos().join(file)).expect("a photograph").0;
        let ratios = |wrap: &str| {
            let turned = |footprint: f64, turn: f64| {
                let scale = footprint * f64::from(SIDE) / f64::from(side);
                ratios(library, file, *encoding, wrap, scale, turn.to_radians())
            };
            FOOTPRINTS
                .iter()
                .flat_map(|footprint| TURNS.map(|turn| turned(*footprint, turn)))
                .collect::<Vec<_>>()
        };
        let [repeat, inside] = ["repeat", "inside"].map(ratios);
        let range = |of: &[[f64; 2]], which: usize| {
            let ends = of.iter().fold((f64::MAX, 0.0_f64), |(least, most), ratio| {
                (least.min(ratio[which]), most.max(ratio[which]))
            });
            format!("{:.3} to {:.3}", ends.0, ends.1)
        };
        println!("{file:24} {:25} {:15} {}", range(&repeat, 0), range(&repeat, 1), range(&inside, 0));
    }
}

/// At edges of triangles, and at borders of the photograph within them.
fn ratios(library: &Library, file: &str, encoding: Encoding, wrap: &str, scale: f64, turn: f64) -> [f64; 2] {
    let text = format!(
        "let e = exemplar(\"{file}\", encoding: {word}, wrap: {wrap})\n{WHERE}\n\
         node turned(uv: vec2) -> (at: vec2) {{ at = rotation({turn:.6}) * uv * {scale:.6} }}\n\
         texture blended(uv: vec2) -> (value: vec4) {{ value = e.stochastic(turned(uv)) }}\n\
         texture places(uv: vec2) -> (value: vec4) {{ value = place(turned(uv)) }}\n",
        word = word(encoding),
    );
    let drawn = |texture: &str| -> Picture {
        let (program, tables) = loaded(library, &text, texture);
        let mut scene = Scene::new(&program, &tables, 0).expect("it can be drawn");
        scene.render(&Request::new([SIDE; 2]), &|_| {}).expect("it is drawn")
    };
    let (blended, places) = (drawn("blended"), drawn("places"));
    let (mut sums, mut counts) = ([0.0; 3], [0.0; 3]);
    let side = SIDE as usize;
    for i in 0..side * side {
        let right = (i % side + 1 < side).then_some(i + 1);
        let below = (i + side < side * side).then_some(i + side);
        for j in [right, below].into_iter().flatten() {
            let [one, other] = [i, j].map(|i| numbers(blended.pixels[i], encoding));
            let step: f64 = one.iter().zip(other).map(|(a, b)| (a - b).abs()).sum();
            let [here, there] = [i, j].map(|i| places.pixels[i]);
            let which = if here[0] != there[0] {
                0
            } else if here != there {
                1
            } else {
                2
            };
            sums[which] += step;
            counts[which] += 1.0;
        }
    }
    let mean = |which: usize| sums[which] / f64::max(counts[which], 1.0);
    [0, 1].map(|which| mean(which) / mean(2))
}
