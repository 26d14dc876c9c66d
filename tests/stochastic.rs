//! `stochastic` shows no seam: neither where hexagons begin and end nor at the borders of the picture,
//! from close by and from afar, and turned. Made-up pictures are smooth, so that a seam is the greatest
//! step of all; those of photographs are measured by the bench of the same name. Normals turn with what
//! they belong to.

use image::{ImageBuffer, Luma, Rgb, RgbImage};
use std::collections::HashMap;
use std::path::Path;
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
    rendered(folder.path(), &text)
}

/// What the pictures of a folder are made into.
fn rendered(folder: &Path, text: &str) -> Picture {
    let files: HashMap<String, String> = [("main.tex".to_owned(), text.to_owned())].into();
    let library = Library::standard().expect("the library is right");
    let options = Options { exact_levels: true, ..Options::default() };
    let compiled = compile(&library, "main.tex", &files, &options);
    let compiled = compiled
        .unwrap_or_else(|failure| panic!("{}", render::human(&failure.sources, &failure.diagnostics)));
    let mut program = compiled.program;
    let tables = load(&mut program, &Project::new(&folder.join("main.tex"), false)).expect("it is loaded");
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

/// Where hexagons turn, normals turn with them: those of a slope stay those of the slope that is seen.
#[test]
fn normals_turn_with_their_hexagons() {
    let folder = tempfile::tempdir().expect("a folder");
    // No two texels of one height, which would be steps.
    let slope = |x: u32, y: u32| Luma([(8000 + 768 * x + 12 * y) as u16]);
    let slope: ImageBuffer<Luma<u16>, _> = ImageBuffer::from_fn(TEXELS, TEXELS, slope);
    slope.save(folder.path().join("slope.png")).expect("the picture is written");
    let normals = RgbImage::from_pixel(TEXELS, TEXELS, Rgb([51, 128, 230]));
    normals.save(folder.path().join("normals.png")).expect("the picture is written");
    let text = "let slope = exemplar(\"slope.png\", encoding: linear, channels: 1, wrap: repeat)\n\
         let normals = exemplar(\"normals.png\", encoding: normal, wrap: repeat)\n\
         node height(at: vec2) -> (height: float) {\n\
             height = slope.stochastic(at, rotation: 1.0, sharpness: 8.0).r\n\
         }\n\
         texture turned(uv: vec2) -> (value: vec4) {\n\
             let across = height(uv * 4.0 + vec2(0.03, 0.0)) - height(uv * 4.0 - vec2(0.03, 0.0))\n\
             let down   = height(uv * 4.0 + vec2(0.0, 0.03)) - height(uv * 4.0 - vec2(0.0, 0.03))\n\
             // Not where the slope begins anew: from 0.12 to 0.87.\n\
             let inside = step(0.25, height(uv * 4.0)) * step(height(uv * 4.0), 0.75)\n\
             value = inside * vec4(across, down, normals.stochastic(uv * 4.0, rotation: 1.0, sharpness: 8.0).xy)\n\
         }\n";
    let picture = rendered(folder.path(), text);
    let (mut turns, mut errors) = (Vec::new(), Vec::new());
    for (i, j) in (0..12).flat_map(|j| (-8..14).map(move |i| (i, j))) {
        // The middle of a hexagon, of which nothing else is seen.
        let middle = [0.288_675_13 * f64::from(i) + 0.144_337_57 * f64::from(j), 0.25 * f64::from(j)];
        let [x, y] = middle.map(|side| side / 4.0 * f64::from(PIXELS));
        if !(0.0..f64::from(PIXELS)).contains(&x) || !(0.0..f64::from(PIXELS)).contains(&y) {
            continue;
        }
        let [across, down, nx, ny] = picture.pixels[(y as u32 * PIXELS + x as u32) as usize];
        let (steep, flat) = ((across * across + down * down).sqrt(), (nx * nx + ny * ny).sqrt());
        if steep > 0.0 {
            assert!((flat - 0.6).abs() < 0.03, "({i}, {j}): a normal of {nx}, {ny}");
            // From the normal to the slope's: 8-bit Gaussian numbers have some six steps here.
            let [along, aside] = [-(across * nx + down * ny), down * nx - across * ny];
            let error = aside.atan2(along);
            assert!(error.abs() < 0.5, "({i}, {j}): a slope of {across}, {down}, a normal of {nx}, {ny}");
            errors.push(error);
            turns.push(ny.atan2(nx));
        }
    }
    let mean = errors.iter().sum::<f32>() / errors.len() as f32;
    assert!(mean.abs() < 0.04, "normals are {mean} off");
    let apart = turns.iter().fold([f32::MAX, f32::MIN], |[a, b], turn| [a.min(*turn), b.max(*turn)]);
    assert!(turns.len() > 50 && apart[1] - apart[0] > 4.0, "{} hexagons, turned by {apart:?}", turns.len());
}
