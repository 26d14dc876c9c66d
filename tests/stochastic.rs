//! `stochastic` shows no seam: neither where hexagons begin and end nor at the borders of the picture,
//! from close by and from afar, and turned. Made-up pictures are smooth, so that a seam is the greatest
//! step of all; those of photographs are measured by the bench of the same name.

use image::{Rgb, RgbImage};
use std::collections::HashMap;
use texgraph_compiler::{Library, Options, compile, diagnostic::render};
use texgraph_runtime::cpu;
use texgraph_runtime::picture::Picture;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::load;

/// Texels along a side of the pictures, and pixels along a side of what is drawn.
const TEXELS: u32 = 64;
const PIXELS: u32 = 256;

/// Texels a pixel, and turns of the plane in radians.
const VIEWS: [(f64, f64); 6] = [(0.25, 0.0), (0.25, 0.4), (1.0, 0.0), (1.0, 0.4), (3.0, 0.0), (3.0, 0.8)];

/// The greatest steps between neighbouring pixels.
struct Steps {
    /// From one triangle of the grid to the next: there hexagons begin and end.
    across: f32,
    /// Inside triangles.
    inside: f32,
}

/// A picture that wraps.
fn wave(x: u32, y: u32) -> u8 {
    let turn = |side: u32| f64::from(side) / f64::from(TEXELS) * std::f64::consts::TAU;
    (128.0 + 50.0 * turn(x).sin() + 50.0 * (turn(y) + turn(x)).cos()) as u8
}

/// One that does not.
fn slope(x: u32, y: u32) -> u8 {
    (40 + 2 * x + y) as u8
}

fn drawn(code: fn(u32, u32) -> u8, wrap: &str, scale: f64, turn: f64) -> Picture {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = RgbImage::from_fn(TEXELS, TEXELS, |x, y| Rgb([code(x, y); 3]));
    picture.save(folder.path().join("smooth.png")).expect("the picture is written");
    let text = format!(
        "let smooth = exemplar(\"smooth.png\", wrap: {wrap})\n\
         texture seamless(uv: vec2) -> (color: color) {{\n\
             color = smooth.stochastic(rotation({turn:.6}) * uv * {scale:.6})\n\
         }}\n"
    );
    let files: HashMap<String, String> = [("main.tex".to_owned(), text)].into();
    let library = Library::standard().expect("the library is right");
    let options = Options { exact_levels: true, ..Options::default() };
    let compiled = compile(&library, "main.tex", &files, &options);
    let compiled = compiled
        .unwrap_or_else(|failure| panic!("{}", render::human(&failure.sources, &failure.diagnostics)));
    let mut program = compiled.program;
    let tables =
        load(&mut program, &Project::new(&folder.path().join("main.tex"), false)).expect("it is loaded");
    cpu::render(&program, &tables, &Request::new([PIXELS; 2]), &|_| {}).expect("it is drawn")
}

/// The triangle of a pixel (§1.2.1), for hexagons half a picture high.
fn triangle(pixel: [u32; 2], scale: f64, turn: f64) -> (i64, i64, bool) {
    let [u, v] = pixel.map(|side| (f64::from(side) + 0.5) / f64::from(PIXELS) * scale);
    let (x, y) = (turn.cos() * u - turn.sin() * v, turn.sin() * u + turn.cos() * v);
    let (x, y) = (2.0 * 3.0_f64.sqrt() * x - 2.0 * y, 4.0 * y);
    (x.floor() as i64, y.floor() as i64, x - x.floor() + y - y.floor() > 1.0)
}

fn steps(code: fn(u32, u32) -> u8, wrap: &str, (footprint, turn): (f64, f64)) -> Steps {
    let scale = footprint * f64::from(PIXELS) / f64::from(TEXELS);
    let picture = drawn(code, wrap, scale, turn);
    let mut steps = Steps { across: 0.0, inside: 0.0 };
    let light = |[x, y]: [u32; 2]| picture.pixels[(y * PIXELS + x) as usize][0];
    for here in (0..PIXELS).flat_map(|y| (0..PIXELS).map(move |x| [x, y])) {
        for there in [[here[0] + 1, here[1]], [here[0], here[1] + 1]] {
            if there.into_iter().all(|side| side < PIXELS) {
                let step = (light(here) - light(there)).abs();
                let is_across = triangle(here, scale, turn) != triangle(there, scale, turn);
                let greatest = if is_across { &mut steps.across } else { &mut steps.inside };
                *greatest = greatest.max(step);
            }
        }
    }
    steps
}

#[test]
fn hexagons_have_no_edge() {
    for (code, wrap) in [(wave as fn(u32, u32) -> u8, "repeat"), (slope, "inside")] {
        for view in VIEWS {
            let Steps { across, inside } = steps(code, wrap, view);
            assert!(across > 0.0 && across <= 1.1 * inside, "{wrap} {view:?}: {across}, inside {inside}");
        }
    }
}

/// What `auto` makes of the two pictures: the one goes on, of the other no part crosses a border.
#[test]
fn borders_are_not_seen() {
    for view in VIEWS.into_iter().filter(|(footprint, _)| *footprint <= 1.0) {
        let most = |code, wrap| {
            let Steps { across, inside } = steps(code, wrap, view);
            across.max(inside)
        };
        let (auto, seen) = (most(slope, "auto"), most(slope, "repeat"));
        assert!(seen > 3.0 * auto, "{view:?}: {auto} with `auto`, {seen} where borders are crossed");
        assert_eq!(most(wave, "auto"), most(wave, "repeat"));
        assert!(most(wave, "auto") < seen / 2.0, "{view:?}: a wave that wraps has no such step");
    }
}
