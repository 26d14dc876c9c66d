//! Patterns that are turned, mirrored, scaled and moved: where they end up, and that the vectors of
//! normal maps turn with them. On the CPU; that the GPU draws the same is for `agreement`.

use std::f64::consts::TAU;
use std::path::Path;
use texgraph_compiler::{Library, Options, compile, diagnostic::render};
use texgraph_runtime::cpu;
use texgraph_runtime::picture::Picture;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::load;

/// Texels a side of the patterns here.
const TEXELS: u32 = 64;

/// What a text draws over a square of so many cells from the origin.
fn drawn(folder: &Path, text: &str, cells: u32, pixels_a_cell: u32) -> Picture {
    let file = folder.join("main.tex");
    std::fs::write(&file, text).expect("it is written");
    let project = Project::new(&file, true);
    let library = Library::standard().expect("the library parses");
    let compiled = compile(&library, project.main(), &project, &Options::default());
    let compiled = compiled.unwrap_or_else(|f| panic!("{}", render::human(&f.sources, &f.diagnostics)));
    let mut program = compiled.program;
    let tables = load(&mut program, &project).expect("pictures are there");
    let region = [0.0, 0.0, f64::from(cells), f64::from(cells)];
    let request = Request { region, ..Request::new([cells * pixels_a_cell; 2]) };
    cpu::render(&program, &tables, &request, &|_| {}).expect("it is drawn")
}

/// A folder with `height.png`, hills that repeat and have no symmetry, `normal.png`, half their
/// slopes, `noise.png`, no two texels alike, and `white.png`.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let save = |name: &str, texel: &dyn Fn(u32, u32) -> [f64; 3]| {
        let of = |x, y| image::Rgb(texel(x, y).map(|value| (value * 65_535.0).round() as u16));
        let picture = image::ImageBuffer::<image::Rgb<u16>, Vec<u16>>::from_fn(TEXELS, TEXELS, of);
        picture.save(folder.path().join(name)).expect("it is saved");
    };
    let at = |i: u32| TAU * (f64::from(i) + 0.5) / f64::from(TEXELS);
    let height =
        |x: u32, y: u32| 0.5 + 0.05 * at(x).sin() + 0.03 * (2.0 * at(y) + at(x)).cos() + 0.02 * at(y).sin();
    let slope = |x: u32, y: u32| {
        let both = -0.03 * (2.0 * at(y) + at(x)).sin();
        [0.05 * at(x).cos() + both, 2.0 * both + 0.02 * at(y).cos()].map(|rise| TAU * rise)
    };
    save("height.png", &|x, y| [height(x, y); 3]);
    save("normal.png", &|x, y| {
        let [right, down] = slope(x, y).map(|rise| 0.5 + 0.25 * rise);
        [right, down, 1.0]
    });
    save("noise.png", &|x, y| [f64::from(x), f64::from(y), 0.0].map(|i| i / f64::from(TEXELS)));
    save("white.png", &|_, _| [1.0; 3]);
    folder
}

fn pixel(picture: &Picture, x: u32, y: u32) -> [f32; 4] {
    picture.pixels[(y * picture.size[0] + x) as usize]
}

/// The way from the middle of a cell to the place in the pattern, by each symmetry.
fn symmetries() -> Vec<[[i32; 2]; 2]> {
    let quarters = [[[1, 0], [0, 1]], [[0, 1], [-1, 0]], [[-1, 0], [0, -1]], [[0, -1], [1, 0]]];
    let mirrored = quarters.map(|[across, down]| [across.map(|c: i32| -c), down]);
    [quarters, mirrored].concat()
}

/// Each cell shows its pattern by one of the four or eight symmetries, all equally often.
#[test]
fn patterns_are_turned_and_mirrored_at_random() {
    let (folder, side) = (folder(), TEXELS as i32);
    for (orient, cells) in [(4, 32_u32), (8, 32)] {
        let text = format!(
            "let noise = patterns(\"noise.png\", encoding: linear)\n\
             texture t(uv: vec2) -> (shown: vec4) {{\n\
             shown = noise.tiled(ifloor(uv), fract(uv), |c| 0, orient: {orient}, stream: 9)\n}}"
        );
        let picture = drawn(folder.path(), &text, cells, TEXELS);
        let mut found = vec![0; 8];
        for (i, j) in (0..cells).flat_map(|j| (0..cells).map(move |i| (i, j))) {
            let shows = |[across, down]: &[[i32; 2]; 2]| {
                // In half texels from the middle.
                let from = |x: i32| 2 * x + 1 - side;
                [(3, 40), (50, 9), (30, 61)].into_iter().all(|(x, y)| {
                    let turned = |row: &[i32; 2]| (row[0] * from(x) + row[1] * from(y) + side - 1) / 2;
                    let shown = pixel(&picture, i * TEXELS + x as u32, j * TEXELS + y as u32);
                    let is = |shown: f32, texel: i32| (shown * side as f32 - texel as f32).abs() < 0.01;
                    is(shown[0], turned(across)) && is(shown[1], turned(down))
                })
            };
            let ways: Vec<usize> = (0..8).filter(|way| shows(&symmetries()[*way])).collect();
            assert_eq!(ways.len(), 1, "cell {i}, {j} shows its pattern by {ways:?}");
            found[ways[0]] += 1;
        }
        let equal = f64::from(cells * cells) / f64::from(orient);
        for (way, count) in found.iter().enumerate() {
            let expected = if way < orient as usize { equal } else { 0.0 };
            assert!((f64::from(*count) - expected).abs() <= 4.0 * expected.sqrt(), "{orient}: {found:?}");
        }
    }
}

/// The slopes of hills that are drawn somehow are what their normal map shows when it is drawn so.
fn slopes_are_drawn(draw: &str, scale: f32) {
    const CELLS: u32 = 6;
    const PIXELS: u32 = 96;
    let text = format!(
        "let hills = patterns(\"height.png\", encoding: linear)\n\
         let slopes = patterns(\"normal.png\", encoding: normal)\n\
         node hidden(c: ivec2) -> (pick: int) {{ pick = if c.x % 2 + c.y % 2 > 0 {{ -1 }} else {{ 0 }} }}\n\
         node angle(c: ivec2) -> (angle: float) {{ angle = virtual_random(c).x * 1turn }}\n\
         texture t(uv: vec2) -> (both: vec4) {{\n\
         let (cell, at) = tile_map(uv, 1)\n\
         let height = hills.{draw}\n\
         let slope = slopes.{draw}\n\
         both = vec4(height.r, slope.xy, height.a)\n}}"
    );
    let picture = drawn(folder().path(), &text, CELLS, PIXELS);
    let (mut compared, mut steepest) = (0, 0.0_f32);
    for (x, y) in (0..CELLS * PIXELS).flat_map(|y| (0..CELLS * PIXELS).map(move |x| (x, y))) {
        let is_inside = |i: u32| (3..PIXELS - 3).contains(&(i % PIXELS));
        let near = [(2, 0), (0, 2), (2, 4), (4, 2), (2, 2)];
        let all_shown = |(i, j): (u32, u32)| pixel(&picture, x + i - 2, y + j - 2)[3] > 0.999;
        if !is_inside(x) || !is_inside(y) || !near.into_iter().all(all_shown) {
            continue;
        }
        let height = |i: u32, j: u32| pixel(&picture, i, j)[0];
        let rises = [height(x + 1, y) - height(x - 1, y), height(x, y + 1) - height(x, y - 1)];
        let [_, right, down, _] = pixel(&picture, x, y);
        for (rise, vector) in rises.into_iter().zip([right, down]) {
            let (rise, told) = (rise * PIXELS as f32 / 2.0, 2.0 * vector / scale);
            assert!((rise - told).abs() < 0.03 / scale, "{draw} at {x}, {y}: {rise}, not {told}");
            steepest = steepest.max(rise.abs());
        }
        compared += 1;
    }
    assert!(compared > 15_000 && steepest > 0.4 / scale, "{draw}: {compared}, {steepest}");
}

#[test]
fn vectors_turn_with_their_pattern() {
    slopes_are_drawn("tiled(cell, at, |c| 0, orient: 4)", 1.0);
    slopes_are_drawn("tiled(cell, at, |c| 0, edges: clamp, orient: 8)", 1.0);
    slopes_are_drawn(
        "tile_transform(cell, at, hidden, scale: |c| 0.6, rotation: angle, overflow: neighbours)",
        0.6,
    );
    slopes_are_drawn("tile_transform(cell, at, hidden, scale: |c| 0.5, rotation: angle)", 0.5);
}

/// What a shrunk pattern covers of its cell is all of it: nothing is cut off.
#[test]
fn what_is_shrunk_is_whole() {
    const PIXELS: u32 = 96;
    let text = |output: &str| {
        format!(
            "let white = patterns(\"white.png\")\n\
             texture t(uv: vec2) -> (shown: vec4) {{\n\
             let (cell, at) = tile_map(uv, 1)\n\
             let drawn = white.tile_transform(cell, at, |c| 0, scale: |c| virtual_random(c).x * 1.5,\n\
             rotation: |c| virtual_random(c).y * 1turn, translation: |c| virtual_random(c).zw)\n\
             let random = virtual_random(cell)\n\
             {output}\n}}"
        )
    };
    let folder = folder();
    let shown = drawn(folder.path(), &text("shown = drawn"), 12, PIXELS);
    let random = drawn(folder.path(), &text("shown = random"), 12, 1);
    for (i, j) in (0..12).flat_map(|j| (0..12).map(move |i| (i, j))) {
        let [scale, turn, ..] = pixel(&random, i, j);
        let (sine, cosine) = (std::f32::consts::TAU * turn).sin_cos();
        let fitted = (1.5 * scale).min(1.0 / (sine.abs() + cosine.abs()));
        let cell = (0..PIXELS).flat_map(|y| (0..PIXELS).map(move |x| (x, y)));
        let covered: f32 = cell.map(|(x, y)| pixel(&shown, i * PIXELS + x, j * PIXELS + y)[3]).sum();
        let covered = covered / (PIXELS * PIXELS) as f32;
        assert!((covered - fitted * fitted).abs() < 0.01, "{i}, {j}: {covered}, not {}", fitted * fitted);
    }
}

/// The greatest difference of two texts.
fn difference(texts: [&str; 2]) -> f32 {
    let folder = folder();
    let [one, two] = texts.map(|text| {
        let head =
            "let noise = patterns(\"noise.png\", encoding: linear)\ntexture t(uv: vec2) -> (shown: vec4) ";
        drawn(
            folder.path(),
            &format!("{head}{{\nlet (cell, at) = tile_map(uv, 1)\nshown = {text}\n}}"),
            4,
            80,
        )
    });
    let channels = one.pixels.iter().flatten().zip(two.pixels.iter().flatten());
    channels.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// A pattern that goes on into three other cells is as if there were none.
#[test]
fn a_pattern_goes_on_into_other_cells() {
    let cells = "noise.tile_transform(cell, at, |c| if c == ivec2(2, 1) { 0 } else { -1 }, scale: |c| 0.65,
        rotation: |c| 0.7, translation: |c| vec2(0.9, 0.1), overflow: neighbours)";
    let plain =
        "noise.reference(0, transpose(rotation(0.7)) * (uv - vec2(2.9, 1.1)) / 0.65 + 0.5, edges: clear)";
    let worst = difference([cells, plain]);
    assert!(worst < 1e-3, "{worst}");
}

/// Four cells show as much as nine where patterns are small enough.
#[test]
fn four_cells_are_enough_for_small_patterns() {
    let text = |largest: f32| {
        format!(
            "noise.tile_transform(cell, at, |c| 0, scale: |c| 0.2 + virtual_random(c).x,
             rotation: |c| virtual_random(c).y * 1turn, translation: |c| virtual_random(c).zw,
             overflow: neighbours, largest: {largest:?})"
        )
    };
    let nine = text(1.4).replace("0.2 + virtual_random(c).x", "min(0.2 + virtual_random(c).x, 0.7)");
    let worst = difference([&text(0.7), &nine]);
    assert!(worst < 1e-3, "{worst}");
    assert!(difference([&text(1.0), &text(1.4)]) > 0.1, "size proves nothing");
}

/// White patterns, a quarter of them blank, in a view of so many cells a pixel: the mean of its alpha.
fn mean_alpha(transform: &str, cells_a_pixel: f64) -> f64 {
    const PIXELS: u32 = 128;
    let text = format!(
        "let white = patterns(\"white.png\")\n\
         texture t(uv: vec2) -> (shown: vec4) {{\n\
         let (cell, at) = tile_map(uv * {:?}, 1)\n\
         shown = white.tile_transform(cell, at, |c| min(virtual_index(c, 4), 1) - 1, {transform})\n}}",
        cells_a_pixel * f64::from(PIXELS)
    );
    let picture = drawn(folder().path(), &text, 1, PIXELS);
    picture.pixels.iter().map(|pixel| f64::from(pixel[3])).sum::<f64>() / picture.pixels.len() as f64
}

/// The mean of a function over the unit square.
fn integral(f: impl Fn(f64, f64) -> f64) -> f64 {
    let places = (0..100).map(|i| (f64::from(i) + 0.5) / 100.0);
    places.clone().flat_map(|y| places.clone().map(move |x| (x, y))).map(|(x, y)| f(x, y)).sum::<f64>() / 1e4
}

/// From afar patterns keep the mean of what they cover, blank ones counted.
#[test]
fn what_is_shrunk_keeps_its_mean_from_afar() {
    let transform = "scale: |c| 0.2 + virtual_random(c, stream: 1).x,\n\
                     rotation: |c| virtual_random(c, stream: 1).y * 1turn,\n\
                     translation: |c| virtual_random(c, stream: 1).zw";
    let covered = integral(|scale, turn| {
        let (sine, cosine) = (TAU * turn).sin_cos();
        (0.2 + scale).min(1.0 / (sine.abs() + cosine.abs())).powi(2)
    });
    for (cells, tolerance) in [(0.2481, 2.5), (0.7323, 1.5), (1.3717, 1.5), (64.0, 1.0)] {
        let mean = mean_alpha(transform, cells);
        let drift = (mean - 0.75 * covered) * 255.0;
        println!("{cells} cells a pixel: {drift:.2}/255");
        assert!(drift.abs() < tolerance, "{cells} cells a pixel: {drift:.2}/255");
    }
}

#[test]
fn what_overflows_keeps_its_mean_from_afar() {
    for scale in [0.6, 1.2] {
        let transform = format!(
            "scale: |c| {scale}, translation: |c| virtual_random(c, stream: 1).zw,\n\
             overflow: neighbours, largest: {scale}"
        );
        // Where in a cell a middle may lie so that its pattern covers a place.
        let across = |x: f64| ((x + scale / 2.0).min(1.0) - (x - scale / 2.0).max(0.0)).max(0.0);
        let covered = integral(|x, y| {
            let cells = (-1..=1).flat_map(|j| (-1..=1).map(move |i| [f64::from(i), f64::from(j)]));
            let hole = |[i, j]: [f64; 2]| 1.0 - 0.75 * across(x - i) * across(y - j);
            1.0 - cells.map(hole).product::<f64>()
        });
        let drift = (mean_alpha(&transform, 64.0) - covered) * 255.0;
        println!("of size {scale}: {drift:.2}/255");
        assert!(drift.abs() < 1.0, "of size {scale}: {drift:.2}/255");
    }
}
