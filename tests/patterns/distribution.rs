//! Probabilities, the blank pattern, dithering and areas (Lefebvre & Neyret 2003, §3.2).

use crate::support::{Drawing, GRASS, deviations};

/// Cells along a side of what is counted.
const SIDE: u32 = 512;
/// One count in a million lies farther off.
const FAR: f64 = 4.9;

fn count(pixels: &[[f32; 4]], wanted: impl Fn(&[f32; 4]) -> bool) -> usize {
    pixels.iter().filter(|pixel| wanted(pixel)).count()
}

#[test]
fn patterns_are_drawn_in_proportion_to_their_weights() {
    let drawing = Drawing::of(
        "let lawn = probability(weights: [8, 4, 2.5, 0.5], blank: 1, size: 64)\n\
         texture t(uv: vec2) -> (pick: float) {\n\
             pick = float(lawn.at(virtual_index(ifloor(uv * 512.0), lawn.size)))\n\
         }",
    );
    let pixels = drawing.cells(SIDE);
    for (pick, entries) in [(0.0, 32), (1.0, 16), (2.0, 10), (3.0, 2), (-1.0, 4)] {
        let found = count(&pixels, |pixel| pixel[0] == pick);
        let off = deviations(found, pixels.len(), f64::from(entries) / 64.0);
        assert!(off < FAR, "{pick}: {found} of {}", pixels.len());
    }
    assert_eq!((drawing.worst().fetches, drawing.worst().samples), (1.0, 0.0));
}

#[test]
fn of_the_blank_pattern_nothing_is_drawn_and_nothing_fetched() {
    for call in [
        "grass.reference(-1, uv)",
        "grass.reference(-1, uv * 3.0, edges: wrap)",
        "grass.reference(-1, uv, edges: clear)",
        "grass.tiled(ifloor(uv), fract(uv), |c| -1, far: vec4(0.0))",
        "grass.tiled(ifloor(uv), fract(uv), |c| -1, edges: clamp, far: vec4(0.0))",
        "grass.average(-1)",
    ] {
        let drawing =
            Drawing::of(&format!("{GRASS}texture t(uv: vec2) -> (color: color) {{ color = {call} }}"));
        assert!(drawing.cells(16).iter().all(|pixel| *pixel == [0.0; 4]), "{call}");
        assert_eq!(drawing.worst().reads, 0.0, "{call}");
    }
}

#[test]
fn a_list_without_the_blank_pattern_pays_nothing_for_it() {
    let list = |numbers: &str| {
        let text = format!(
            "{GRASS}let lawn = probability({numbers})\n\
             texture t(uv: vec2) -> (color: color) {{\n\
                 color = grass.reference(lawn.at(ifloor(uv.x)), fract(uv))\n\
             }}"
        );
        Drawing::of(&text).worst().arithmetic.compare
    };
    assert!(list("[0, 3, 15]") < list("[0, 3, -1]"));
}

#[test]
fn the_mean_of_a_probability_is_that_of_what_it_draws() {
    let text = |color: &str| {
        Drawing::of(&format!(
            "{GRASS}let lawn = probability(weights: [8, 4, 2, 1], blank: 5, size: 64)\n\
             texture t(uv: vec2) -> (color: color) {{ color = {color} }}"
        ))
    };
    let drawn = text("grass.average(lawn.at(virtual_index(ifloor(uv * 512.0), 64)))").cells(SIDE);
    let mean = text("lawn.average(grass)").cells(1)[0];
    for (i, mean) in mean.iter().enumerate() {
        let found = drawn.iter().map(|pixel| f64::from(pixel[i])).sum::<f64>() / drawn.len() as f64;
        assert!((found - f64::from(*mean)).abs() < 0.004, "{found} {mean}");
    }
}

#[test]
fn dithering_takes_the_second_value_in_proportion_along_the_blend() {
    let drawing = Drawing::of(
        "texture t(uv: vec2) -> (second: vec2) { second = vec2(dither(ifloor(uv * 512.0), uv)) }",
    );
    let (pixels, side) = (drawing.cells(SIDE), SIDE as usize);
    for band in 0..32 {
        let width = side / 32;
        let b = (band as f64 + 0.5) / 32.0;
        let across =
            (0..side * width).filter(|i| pixels[i / width * side + band * width + i % width][0] > 0.0);
        let down = (0..side * width).filter(|i| pixels[band * width * side + i][1] > 0.0);
        for found in [across.count(), down.count()] {
            assert!(deviations(found, side * width, b) < FAR, "{b}: {found} of {}", side * width);
        }
    }
}

/// The same with σ, whose numbers are the middles of 256 equal parts.
#[test]
fn dithering_by_a_permutation_keeps_the_proportions() {
    for stream in [0, 5] {
        let drawing = Drawing::of(&format!(
            "let sigma = permutation(256, seed: 3)\n\
             texture t(uv: vec2) -> (second: vec2) {{\n\
                 second = vec2(dither(ifloor(uv * 512.0), vec2(0.25, 0.625), sigma: sigma, stream: {stream}))\n\
             }}"
        ));
        // Two digits of each coordinate: four texels, as the walk of a pick takes.
        assert_eq!(drawing.worst().fetches, 4.0);
        let pixels = drawing.cells(SIDE);
        for (axis, b) in [(0, 0.25), (1, 0.625)] {
            let found = count(&pixels, |pixel| pixel[axis] > 0.0);
            assert!(deviations(found, pixels.len(), b) < FAR, "{axis}: {found} of {}", pixels.len());
        }
        let both = count(&pixels, |pixel| pixel[0] * pixel[1] > 0.0);
        let share = both as f64 / pixels.len() as f64;
        // The four permutations meet in 256 places only, so axes are independent to about 1/16 of that.
        assert!((share - 0.25 * 0.625).abs() < 0.05, "{share}");
    }
}

/// Axes draw apart, and apart from the pick of a tile: chi-square over all combinations.
#[test]
fn draws_of_a_cell_are_independent() {
    let drawing = Drawing::of(
        "texture t(uv: vec2) -> (drawn: float) {\n\
             let cell  = ifloor(uv * 512.0)\n\
             let plane = dither(cell, vec2(0.5))\n\
             let depth = dither(ivec3(cell, 0), vec3(0.5)).z\n\
             drawn = float(virtual_index(cell, 4) + 4 * plane.x + 8 * plane.y + 16 * depth)\n\
         }",
    );
    let pixels = drawing.cells(SIDE);
    let expected = pixels.len() as f64 / 32.0;
    let square = |i: u8| (count(&pixels, |p| p[0] == f32::from(i)) as f64 - expected).powi(2) / expected;
    let sum: f64 = (0..32).map(square).sum();
    // 31 degrees of freedom: one in ten thousand is above.
    assert!(sum < 71.0, "chi-square {sum}");
}

/// The areas map of the tests below, its sides not alike.
const AREAS: [[f32; 3]; 4] = [[0.0, 1.0, 1.0], [2.0, 0.0, 3.0], [1.0, 1.0, 2.0], [0.0, 3.0, 3.0]];
const MAP: &str = "let areas = indices([[0, 1, 1], [2, 0, 3], [1, 1, 2], [0, 3, 3]])\n";

/// Where a cell of `n` lies among `a` areas: the first of the two nearest, and the part of the second.
fn among(cell: u32, n: u32, a: u32, softness: f64) -> (i64, f64) {
    let x = (f64::from(cell) + 0.5) * f64::from(a) / f64::from(n) - 0.5;
    let between = x - x.floor();
    let b = match softness {
        0.0 => f64::from(u8::from(between >= 0.5)),
        softness => ((between - 0.5) / softness + 0.5).clamp(0.0, 1.0),
    };
    (x.floor() as i64, b)
}

/// The probability of an area at a cell, by the formula.
fn probability(cell: [u32; 2], n: u32, softness: f64, area: f32) -> f64 {
    let ((i, u), (j, v)) = (among(cell[0], n, 3, softness), among(cell[1], n, 4, softness));
    let corners =
        [(0, 0, (1.0 - u) * (1.0 - v)), (1, 0, u * (1.0 - v)), (0, 1, (1.0 - u) * v), (1, 1, u * v)];
    let holds = |(x, y): (i64, i64)| AREAS[(j + y).rem_euclid(4) as usize][(i + x).rem_euclid(3) as usize];
    corners.iter().filter(|(x, y, _)| holds((*x, *y)) == area).map(|(.., share)| share).sum()
}

/// For sides that the map divides and sides that it does not.
#[test]
fn areas_are_dithered_by_the_formula() {
    for (n, softness) in [(384, 1.0), (500, 0.6), (384, 0.0), (101, 0.0)] {
        let drawing = Drawing::of(&format!(
            "{MAP}texture t(uv: vec2) -> (area: float) {{\n\
                 area = float(areas.dithered_area(ifloor(uv * {n}.0), {n}, softness: {softness:?}))\n\
             }}"
        ));
        let pixels = drawing.cells(n);
        assert_eq!(drawing.worst().fetches, 1.0);
        for area in [0.0, 1.0, 2.0, 3.0] {
            let (mut expected, mut variance, mut found) = (0.0, 0.0, 0.0);
            for (i, pixel) in (0..).zip(&pixels) {
                let p = probability([i % n, i / n], n, softness, area);
                let is_drawn = f64::from(u8::from(pixel[0] == area));
                assert!(p > 0.0 && p < 1.0 || is_drawn == p, "cell {i} of {n}: {pixel:?}, {area} has {p}");
                (expected, variance, found) = (expected + p, variance + p * (1.0 - p), found + is_drawn);
            }
            let off = (found - expected).abs();
            assert!(off <= FAR * f64::sqrt(variance), "{n}, {softness}: {area} is {found}, not {expected}");
        }
    }
}

/// In the far corner of a map of 65,536² cells: all by the formula, without a border in between.
#[test]
fn areas_are_exact_in_the_far_corner() {
    let drawing = Drawing::of(&format!(
        "{MAP}texture t(uv: vec2) -> (area: float) {{\n\
             let cell = ifloor(uv * 512.0) + 65024 + ivec2(0, -16384)\n\
             area = float(areas.dithered_area(cell, 65536, softness: 0.02))\n\
         }}"
    ));
    let pixels = drawing.cells(SIDE);
    let mut borders = 0;
    for (i, pixel) in (0..).zip(&pixels) {
        let cell = [i % SIDE + 65024, i / SIDE + 65024 - 16384];
        let p = probability(cell, 65536, 0.02, pixel[0]);
        assert!(p > 0.0, "cell {cell:?} is {pixel:?}");
        borders += usize::from(p < 1.0);
    }
    // Borders are a fiftieth of an area wide: 437 cells across and 328 down.
    assert!(borders > 0 && borders < pixels.len(), "{borders}");
}

#[test]
fn areas_of_a_node_are_those_of_a_map() {
    let area = |call: &str| {
        Drawing::of(&format!("{MAP}texture t(uv: vec2) -> (area: float) {{ area = float({call}) }}"))
    };
    let cell = "ifloor((uv - 2.0) * 96.0)";
    let map = area(&format!("areas.dithered_area({cell}, 96)"));
    let node = area(&format!("dithered_area(|g| areas.at(g), {cell}, 96, ivec2(3, 4))"));
    assert_eq!(map.cells(200), node.cells(200));
}

#[test]
fn from_afar_areas_are_the_mean_of_what_they_draw() {
    let color = |color: &str| {
        Drawing::of(&format!("{GRASS}{MAP}texture t(uv: vec2) -> (color: color) {{ color = {color} }}"))
    };
    for softness in ["1.0", "0.4", "0.0"] {
        let cell = "ifloor(uv * 480.0)";
        let drawn = color(&format!("grass.average(areas.dithered_area({cell}, 480, softness: {softness}))"));
        let mean = color(&format!("areas.dithered_average(uv, |i| grass.average(i), softness: {softness})"));
        let (drawn, mean) = (drawn.cells(480), mean.cells(480));
        // A twelfth of the map is 40 cells a side.
        let block = |pixels: &[[f32; 4]], i: usize| {
            let cells = (0..1600).map(|k| (i / 12 * 40 + k / 40) * 480 + i % 12 * 40 + k % 40);
            cells.map(|k| f64::from(pixels[k][1])).sum::<f64>() / 1600.0
        };
        for i in 0..144 {
            let (drawn, mean) = (block(&drawn, i), block(&mean, i));
            assert!((drawn - mean).abs() < 0.004, "{softness}: block {i} is {drawn}, not {mean}");
        }
    }
}

/// Two materials of lists of one length, and two that have no short common length.
#[test]
fn materials_draw_each_in_its_proportions() {
    let lists = [
        ("[0, 0, 0, 5]", "[2, -1]", 1.0),
        ("weights: [3, 0, 0, 0, 0, 1], size: 1024", "weights: [0, 0, 1], blank: 1, size: 1023", 2.0),
    ];
    for (first, second, fetches) in lists {
        let drawing = Drawing::of(&format!(
            "let lawn = probability({first})\n\
             let weeds = probability({second})\n\
             let grounds = materials([lawn, weeds])\n\
             texture t(uv: vec2) -> (pick: float) {{\n\
                 let cell = ifloor(uv * 512.0)\n\
                 pick = float(grounds.at(cell.x / 256, virtual_index(cell, 1024 * 1023)))\n\
             }}"
        ));
        assert_eq!(drawing.worst().fetches, fetches);
        let pixels = drawing.cells(SIDE);
        let half = |right: bool| {
            let side = SIDE as usize;
            let pixels = pixels.iter().enumerate().filter(move |(i, _)| (i % side >= side / 2) == right);
            pixels.map(|(_, pixel)| *pixel).collect::<Vec<_>>()
        };
        for (right, pick, p) in [(false, 0.0, 0.75), (false, 5.0, 0.25), (true, 2.0, 0.5), (true, -1.0, 0.5)]
        {
            let half = half(right);
            // A list of an odd length holds one blank entry less.
            let p = if fetches > 1.0 && right {
                f64::round(p * 1023.0 - 0.1 * f64::from(pick)) / 1023.0
            } else {
                p
            };
            let found = count(&half, |pixel| pixel[0] == pick);
            assert!(deviations(found, half.len(), p) < FAR, "{pick}: {found} of {}", half.len());
        }
    }
}

#[test]
fn families_are_as_given_or_each_its_own() {
    for (families, expected) in [("", [0.0, 1.0, 2.0]), (", families: [4, 0, 4]", [4.0, 0.0, 4.0])] {
        let drawing = Drawing::of(&format!(
            "let l = probability([0])\nlet m = materials([l, l, l]{families})\n\
             texture t(uv: vec2) -> (family: float) {{ family = float(m.family(ifloor(uv.x * 3.0))) }}"
        ));
        let row = drawing.seen([3, 1], [0.0, 0.0, 1.0, 1.0]);
        assert_eq!(row.iter().map(|pixel| pixel[0]).collect::<Vec<_>>(), expected);
    }
}

#[test]
fn the_mean_of_a_material_is_that_of_what_it_draws() {
    let lists = format!(
        "{GRASS}let lawn = probability(weights: [8, 4, 2, 1], blank: 5, size: 64)\n\
         let weeds = probability([15, 3, 3])\nlet drawn = materials([lawn, weeds])\n\
         let tiles = materials([grass, patterns(\"tiles/grass.png\", grid: ivec2(4, 8))], size: ivec2(32))\n"
    );
    let color = |color: &str| {
        Drawing::of(&format!("{lists}texture t(uv: vec2) -> (color: color) {{ color = {color} }}"))
            .seen([2, 1], [0.0, 0.0, 1.0, 1.0])
    };
    let material = "ifloor(uv.x * 2.0)";
    let means = [
        (
            format!("drawn.average({material}, p: grass)"),
            "if uv.x < 0.5 { lawn.average(grass) } else { weeds.average(grass) }",
        ),
        (format!("tiles.average({material})"), "grass.average"),
    ];
    for (mean, expected) in means {
        for (mean, expected) in color(&mean).iter().zip(color(expected)) {
            let off = mean.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(off < 2e-3, "{mean:?} {expected:?}");
        }
    }
}

#[test]
fn a_pixel_map_holds_the_numbers_of_its_picture() {
    let number = |map: &str, at: &str| {
        let file = "tiles/source/grass_grey.png";
        let drawing = Drawing::of(&format!(
            "let m = {map}(\"{file}\", levels: 11)\n\
             texture t(uv: vec2) -> (number: float) {{ number = float(m.{at}(ifloor(uv * 700.0) - 50)) }}"
        ));
        drawing.cells(700)
    };
    assert_eq!(number("pixel_map", "at_texel"), number("indices", "at"));
}

#[test]
fn the_share_of_a_pixel_is_that_of_its_texels() {
    let mask = "let m = pixel_map(\"tiles/source/grass_grey.png\")\n";
    let sharp =
        Drawing::of(&format!("{mask}texture t(uv: vec2) -> (number: float) {{ number = float(m.at(uv)) }}"));
    let soft = Drawing::of(&format!("{mask}texture t(uv: vec2) -> (share: float) {{ share = m.share(uv) }}"));
    let (texels, pixels) = (sharp.cells(512), soft.cells(128));
    let share = |i: usize| {
        let texel = |k: usize| texels[(i / 128 * 4 + k / 4) * 512 + i % 128 * 4 + k % 4][0];
        (0..16).map(texel).sum::<f32>() / 16.0
    };
    let off: f32 = pixels.iter().enumerate().map(|(i, pixel)| (pixel[0] - share(i)).abs()).sum();
    let sharp_off: f32 =
        sharp.cells(128).iter().enumerate().map(|(i, pixel)| (pixel[0] - share(i)).abs()).sum();
    let mean = off / pixels.len() as f32;
    assert!(mean < 0.12 && off < 0.55 * sharp_off, "{mean}, {}", sharp_off / pixels.len() as f32);
    assert_eq!(soft.worst().fetches, 8.0);
}

/// The corners of a transition tile are the areas of the four cells, each as it is alone.
#[test]
fn corners_are_the_areas_of_four_cells() {
    for sigma in ["", ", sigma: sigma, period: 256", ", softness: 0.3, stream: 5"] {
        let shown = |corners: &str| {
            let text = format!(
                "let areas = indices([[0, 1, 2], [3, 4, 5], [6, 7, 8], [9, 10, 11]])\n\
                 let sigma = permutation(256, seed: 2)\n\
                 texture t(uv: vec2) -> (shown: vec4) {{\n\
                     let c = ifloor(uv * 96.0) - 40\n\
                     shown = vec4({corners})\n\
                 }}"
            );
            Drawing::of(&text).cells(96)
        };
        let alone = [[0, 0], [1, 0], [0, 1], [1, 1]]
            .map(|[x, y]| format!("areas.dithered_area(c + ivec2({x}, {y}), 70{sigma})"));
        let corners = shown(&format!("areas.dithered_corners(c, 70{sigma})"));
        assert_eq!(corners, shown(&alone.join(", ")), "{sigma}");
        assert!(corners.iter().any(|corners| corners[0] != corners[3]), "areas differ");
    }
}

/// Maps on a line and in space say what stands in a cell as those in the plane do: they wrap, and a
/// `base` takes them as far as one likes.
#[test]
fn maps_of_any_dimension_say_what_stands_in_a_cell() {
    let maps = "let line = indices<1>([2, 0, 1])
         let plane = indices([[2, 0, 1]])
         let space = indices<3>([[2, 0, 1], [3, 4, 5], [6, 7, 8], [9, 10, 11]], depth: 2)\n";
    let seen = |body: &str| {
        Drawing::of(&format!("{maps}texture t(uv: vec2) -> (seen: vec4) {{ {body} }}")).cells(24)
    };
    let far = "tile_map(uv.x, 24, base: 1000000)";
    let line = seen(&format!("let (cell, at) = {far} seen = vec4(line.at(cell - 5))"));
    let plane = seen(&format!("let (cell, at) = {far} seen = vec4(plane.at(ivec2(cell - 5, 0)))"));
    assert_eq!(line, plane);
    let space = seen(
        "let (cell, at) = tile_map(vec3(uv, uv.x + uv.y), 24, base: ivec3(7, -5, 3))
         seen = vec4(space.at(cell), cell % space.size)",
    );
    let wanted = [[[2, 0, 1], [3, 4, 5]], [[6, 7, 8], [9, 10, 11]]];
    for [index, x, y, z] in space.into_iter().map(|pixel| pixel.map(|i| i as usize)) {
        assert_eq!(index, wanted[z][y][x], "{x} {y} {z}");
    }
    assert_eq!(seen("seen = vec4(space.size, line.size)")[0], [3.0, 2.0, 2.0, 3.0]);
    // Areas of such maps are dithered by the nodes that take a lambda.
    let dithered = "float(dithered_area(|c| MAP, ifloor(uv.x * 24.0), 24, line.size))";
    let by = |map: &str| seen(&format!("seen = vec4({})", dithered.replace("MAP", map)));
    assert_eq!(by("line.at(c)"), by("plane.at(ivec2(c, 0))"));
}
