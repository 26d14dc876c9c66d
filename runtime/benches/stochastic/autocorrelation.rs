//! Whether the eye finds a period in 16 × 16 repeats: the autocorrelation at multiples of the picture's
//! sides, and at the vectors of the grid of hexagons, of values and of contrast.
//!
//! A mean over n vectors of one lattice is off by chance by about the deviation of the autocorrelation
//! at other shifts, over the square root of n. What is told is how many times that it is.

use crate::{loaded, numbers, word};
use texgraph_compiler::Library;
use texgraph_compiler::manifest::Encoding;
use texgraph_runtime::cpu::Scene;
use texgraph_runtime::inspect::{Autocorrelation, Field};
use texgraph_runtime::render::Request;

/// Pixels along a side of what is drawn, and along one picture in it.
const SIDE: u32 = 1024;
const PICTURE: f64 = (SIDE / crate::REPEATS) as f64;

/// Shifts are looked at from one picture to so many: what is nearer is alike by itself.
const PICTURES: f64 = 5.0;

/// Between vertices of the grid, where a hexagon is half a picture high.
const EDGE: f64 = 0.288_675_13;

pub fn tell<'a>(library: &Library, photos: impl Iterator<Item = &'a (&'a str, Encoding)>) {
    println!(
        "autocorrelation of 16 × 16 repeats, {SIDE}² pixels; in brackets: so many times what chance makes"
    );
    println!("                         at the picture's period     at the grid's vectors");
    println!(
        "                         repeated  blended           blended            contrast            contrast, linear"
    );
    for (file, encoding) in photos {
        let text = format!(
            "let e = exemplar(\"{file}\", encoding: {word}, wrap: auto)\nlet i = image(\"{file}\", encoding: {word})\n\
             texture repeated(uv: vec2) -> (value: vec4) {{ value = i.sample(uv) }}\n\
             texture linear(uv: vec2) -> (value: vec4) {{ value = e.stochastic(uv, blend: linear) }}\n\
             texture histogram(uv: vec2) -> (value: vec4) {{ value = e.stochastic(uv) }}\n",
            word = word(*encoding),
        );
        let drawn = |texture: &str| drawn(library, &text, texture, *encoding);
        let [repeated, linear, histogram] = ["repeated", "linear", "histogram"].map(drawn);
        let of = |field: &Field| Autocorrelation::of(&field.centred());
        let (period, grid) = (
            lattice([PICTURE, 0.0], [0.0, PICTURE]),
            lattice([EDGE * PICTURE, 0.0], [EDGE * PICTURE / 2.0, PICTURE / 4.0]),
        );
        let plain = at(&of(&repeated), &period).0;
        let told = |of: &Autocorrelation, vectors: &[[i32; 2]]| {
            let (mean, chance) = at(of, vectors);
            format!("{mean:+.4} ({:+.1})", mean / chance)
        };
        let (values, contrast) = (of(&histogram), of(&squares(&histogram)));
        println!(
            "{file:24} {plain:+.3}    {:17} {:18} {:19} {}",
            told(&values, &period),
            told(&values, &grid),
            told(&contrast, &grid),
            told(&of(&squares(&linear)), &grid)
        );
    }
}

/// The first number of each pixel; of colours, their luminance.
fn drawn(library: &Library, text: &str, texture: &str, encoding: Encoding) -> Field {
    let (program, tables) = loaded(library, text, texture);
    let mut scene = Scene::new(&program, &tables, 0).expect("it can be drawn");
    let region = [0.0, 0.0, f64::from(crate::REPEATS), f64::from(crate::REPEATS)];
    let request = Request { region, ..Request::new([SIDE; 2]) };
    let picture = scene.render(&request, &|_| {}).expect("it is drawn");
    let value = |pixel: &[f32; 4]| {
        let [x, y, z] = numbers(*pixel, encoding);
        (if encoding == Encoding::Normal { x } else { 0.2126 * x + 0.7152 * y + 0.0722 * z }) as f32
    };
    Field::new([SIDE as usize; 2], picture.pixels.iter().map(value).collect())
}

/// How far each value is from the mean, squared: where that changes with the grid, the grid is seen.
fn squares(field: &Field) -> Field {
    let values = field.centred().values().iter().map(|value| value * value).collect();
    Field::new(field.size(), values)
}

/// The vectors of a lattice in reach, each once of two opposite ones, to the nearest pixel.
fn lattice(one: [f64; 2], other: [f64; 2]) -> Vec<[i32; 2]> {
    let multiples = (0..40).flat_map(|i| (-40..40).map(move |j| (f64::from(j), f64::from(i))));
    let vectors = multiples.map(|(i, j)| [0, 1].map(|axis| i * one[axis] + j * other[axis]));
    let within = vectors.filter(|[x, y]| is_in_reach(x.hypot(*y)) && (*y > 0.0 || *x > 0.0));
    within.map(|vector| vector.map(|side| side.round() as i32)).collect()
}

fn is_in_reach(length: f64) -> bool {
    (PICTURE - 0.5..=PICTURE * PICTURES).contains(&length)
}

/// The mean at vectors, and what chance makes of such a mean.
fn at(of: &Autocorrelation, vectors: &[[i32; 2]]) -> (f64, f64) {
    let [across, down] = of.reach();
    let all = (0..=down).flat_map(|y| (-across..=across).map(move |x| [x, y]));
    let all = all.filter(|[x, y]| is_in_reach(f64::from(*x).hypot(f64::from(*y))));
    let (sum, squares, count) = all.fold((0.0, 0.0, 0.0), |(sum, squares, count), shift| {
        let value = of.at(shift);
        (sum + value, squares + value * value, count + 1.0)
    });
    // Relative to the mean of all shifts, which unevenness of the whole makes.
    let mean = sum / count;
    let deviation = f64::sqrt(squares / count - mean * mean);
    let found = vectors.iter().map(|vector| of.at(*vector)).sum::<f64>() / vectors.len() as f64;
    (found - mean, deviation / (vectors.len() as f64).sqrt())
}
