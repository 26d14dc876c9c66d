//! Motifs (`std/motifs.tex`): what they tend to from afar, how they repeat, and that their masks are
//! what a pixel sees.

use crate::support::Drawing;
use std::collections::HashMap;

/// A mask, its period across and down, its mean, and how far a pixel may be off the mean of finer ones:
/// nothing but rounding where the mask is an integral over a box.
struct Mask {
    text: &'static str,
    period: [u32; 2],
    mean: f64,
    off: f64,
}

const fn mask(text: &'static str, period: [u32; 2], mean: f64, off: f64) -> Mask {
    Mask { text, period, mean, off }
}

const INTEGRAL: f64 = 2e-3;

const MASKS: &[Mask] = &[
    mask("checker(uv)", [2, 2], 0.5, INTEGRAL),
    mask("stripes((uv).y, share: 0.3)", [1, 1], 0.3, INTEGRAL),
    mask("grid_lines(uv, thickness: 0.2)", [1, 1], 1.0 - 0.8 * 0.8, INTEGRAL),
    mask("bricks(uv).cover", [2, 2], 0.95 * 0.9, INTEGRAL),
    mask("bricks(uv, bond: stack).cover", [2, 1], 0.95 * 0.9, INTEGRAL),
    mask("bricks(uv, bond: flemish).cover", [3, 2], (1.9 + 0.9) / 3.0 * 0.9, INTEGRAL),
    mask("bricks(uv, bond: english).cover", [2, 2], (0.95 + 0.9) / 2.0 * 0.9, INTEGRAL),
    mask("weave(uv).warp + weave(uv).weft", [2, 2], 1.0 - 0.2 * 0.2, INTEGRAL),
    mask("weave(uv, over: 3, under: 1).warp", [4, 4], 0.8 * 0.2 + 0.8 * 0.8 * 0.75, 0.3),
    mask("dots(uv).cover", [1, 1], std::f64::consts::PI * 0.09, 0.3),
    mask("zigzag(uv, rise: 0.5, share: 0.3).cover", [1, 1], 0.3, 0.3),
    mask("herringbone(uv).cover", [4, 4], 0.9 * 0.95, 0.3),
    mask("herringbone(uv, length: 3).cover", [6, 6], 0.9 * 2.9 / 3.0, 0.3),
    mask("basket_weave(uv).cover", [2, 2], 0.95 * 0.9, 0.3),
    mask("hexagons(uv).cover", [1, 2], 0.95 * 0.95, 0.3),
    mask("truchet(uv, period: ivec2(3, 3)).cover", [3, 3], std::f64::consts::PI * 0.1, 0.3),
];

impl Mask {
    fn drawing(&self) -> Drawing {
        Drawing::of(&format!("texture t(uv: vec2) -> (c: float) {{ c = {} }}", self.text))
    }
}

/// A picture of so many units from a place on.
fn seen(drawing: &Drawing, size: [u32; 2], [x, y]: [f64; 2], [w, h]: [f64; 2]) -> Vec<f64> {
    let drawn = drawing.seen(size, [x, y, x + w, y + h]);
    drawn.into_iter().map(|[c, ..]| f64::from(c)).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Half a pixel to many units a pixel: the mean of the picture is that of the motif.
#[test]
fn no_distance_changes_the_mean() {
    for m in MASKS {
        let drawing = m.drawing();
        let [w, h] = m.period.map(|n| 12.0 * f64::from(n));
        for pixels in [7, 13, 29, 97, 301] {
            let found = mean(&seen(&drawing, [pixels; 2], [0.3, 0.7], [w, h]));
            let units = w.max(h) / f64::from(pixels);
            println!("{}: {units:.2} units a pixel, mean {found:.4} of {:.4}", m.text, m.mean);
            let off = if m.off == INTEGRAL { 0.0005 } else { 0.015 };
            assert!((found - m.mean).abs() < off, "{}: {units} units a pixel, {found} of {}", m.text, m.mean);
        }
    }
}

/// From a unit a pixel on, masks that fade are their mean in every pixel, and those that are integrals
/// differ from it by the part of a period at their ends at most.
#[test]
fn from_afar_every_pixel_is_the_mean() {
    for m in MASKS {
        let side = 33.7 * 24.0;
        let worst =
            seen(&m.drawing(), [24; 2], [0.1, 0.2], [side; 2]).into_iter().map(|c| (c - m.mean).abs());
        let worst = worst.fold(0.0, f64::max);
        println!("{}: off the mean by {worst:.4}", m.text);
        assert!(worst < 0.05, "{}: {worst}", m.text);
    }
}

/// A pixel is the mean of the finer pixels within it.
#[test]
fn a_pixel_sees_what_finer_pixels_see() {
    const FINER: u32 = 16;
    for m in MASKS {
        let drawing = m.drawing();
        for pixels in [5, 11, 23] {
            let side = 7.3;
            let coarse = seen(&drawing, [pixels; 2], [-2.6, 0.45], [side; 2]);
            let fine = seen(&drawing, [pixels * FINER; 2], [-2.6, 0.45], [side; 2]);
            let mut sums = vec![0.0; coarse.len()];
            for (i, c) in (0..).zip(fine) {
                let [x, y] = [i % (pixels * FINER), i / (pixels * FINER)].map(|i| i / FINER);
                sums[(y * pixels + x) as usize] += c / f64::from(FINER * FINER);
            }
            let offs = || coarse.iter().zip(&sums).map(|(a, b)| (a - b).abs());
            let (worst, square) = (offs().fold(0.0, f64::max), offs().map(|off| off * off).sum::<f64>());
            let root = (square / coarse.len() as f64).sqrt();
            println!(
                "{}: {:.2} units a pixel, off by {root:.3}, {worst:.3} at most",
                m.text,
                side / f64::from(pixels)
            );
            assert!(worst < m.off && root < 0.12, "{}: {pixels} pixels, {root} and {worst}", m.text);
        }
    }
}

/// What lies a period on is the same.
#[test]
fn motifs_repeat() {
    for m in MASKS {
        let drawing = m.drawing();
        // Eighths are exact, so places a period on are, too.
        let here = seen(&drawing, [64; 2], [0.125, 0.25], [8.0; 2]);
        for [x, y] in [[1, 0], [0, 1], [-3, 2]] {
            let there = [x, y].map(f64::from);
            let from = [0.125 + there[0] * f64::from(m.period[0]), 0.25 + there[1] * f64::from(m.period[1])];
            let moved = seen(&drawing, [64; 2], from, [8.0; 2]);
            let worst = here.iter().zip(moved).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(worst < 2e-4, "{}: off by {worst} at {x}, {y} periods", m.text);
        }
    }
}

/// Each brick is one rectangle of its size: its cell stands nowhere else.
#[test]
fn bricks_have_their_size_and_a_number_each() {
    const PIXELS: i64 = 24;
    const SIDE: i64 = 16;
    let longs: [(&str, &[[i64; 2]]); 8] = [
        ("bricks(uv)", &[[2, 1]]),
        ("bricks(uv, bond: stack)", &[[2, 1]]),
        ("bricks(uv, size: vec2(3.0, 2.0))", &[[3, 2]]),
        ("bricks(uv, bond: flemish)", &[[2, 1], [1, 1]]),
        ("bricks(uv, bond: english)", &[[2, 1], [1, 1]]),
        ("herringbone(uv)", &[[2, 1], [1, 2]]),
        ("herringbone(uv, length: 3)", &[[3, 1], [1, 3]]),
        ("basket_weave(uv / 3.0, count: 3)", &[[3, 1], [1, 3]]),
    ];
    for (text, sizes) in longs {
        let drawing = Drawing::of(&format!(
            "texture t(uv: vec2) -> (c: vec4) {{
                let b = {text}
                c = vec4(b.cell, if b.edge > 0.0 {{ 1.0 }} else {{ 0.0 }}, 0.0)
            }}"
        ));
        let half = SIDE as f64 / 2.0;
        let drawn = drawing.seen([(SIDE * PIXELS) as u32; 2], [-half, -half, half, half]);
        // Of each cell: first and last pixel, across and down, and how many.
        let mut bricks: HashMap<[i64; 2], ([i64; 2], [i64; 2], i64)> = HashMap::new();
        for (i, [x, y, ..]) in (0..).zip(&drawn) {
            let pixel = [i % (SIDE * PIXELS), i / (SIDE * PIXELS)];
            let (first, last, count) = bricks.entry([*x as i64, *y as i64]).or_insert((pixel, pixel, 0));
            *first = [first[0].min(pixel[0]), first[1].min(pixel[1])];
            *last = [last[0].max(pixel[0]), last[1].max(pixel[1])];
            *count += 1;
        }
        let edge = SIDE * PIXELS - 1;
        let whole = |(first, last, _): &&([i64; 2], [i64; 2], i64)| {
            first.iter().all(|x| *x > 0) && last.iter().all(|x| *x < edge)
        };
        let mut found = vec![0; sizes.len()];
        for (first, last, count) in bricks.values().filter(whole) {
            let size = [last[0] - first[0] + 1, last[1] - first[1] + 1];
            assert_eq!(*count, size[0] * size[1], "{text}: no rectangle at {first:?}");
            let kind = sizes.iter().position(|[w, h]| [w * PIXELS, h * PIXELS] == size);
            found[kind.unwrap_or_else(|| panic!("{text}: {size:?} pixels at {first:?}"))] += 1;
        }
        println!("{text}: {found:?}");
        assert!(found.iter().all(|count| *count > 8), "{text}: {found:?}");
    }
}

/// Hexagons are the places nearest to their middle.
#[test]
fn hexagons_lie_around_the_nearest_middle() {
    let drawing = Drawing::of(
        "texture t(uv: vec2) -> (c: vec4) {
            let h = hexagons(uv * vec2(1.0, 1.1547005), gap: 0.0)
            c = vec4(h.cell, length(h.at), h.edge)
        }",
    );
    let drawn = drawing.seen([96; 2], [-3.0, -3.0, 3.0, 3.0]);
    let row = 3.0_f64.sqrt() / 2.0;
    let middles: Vec<[f64; 2]> = (-8..8)
        .flat_map(|y: i32| {
            (-8..8).map(move |x: i32| [f64::from(x) + 0.5 * f64::from(y.rem_euclid(2)), f64::from(y)])
        })
        .collect();
    let mut cells = HashMap::new();
    for (i, [cx, cy, at, edge]) in (0..).zip(drawn) {
        let [x, y] = [i % 96, i / 96].map(|i| (f64::from(i) + 0.5) / 16.0 - 3.0);
        let mut away: Vec<f64> = middles.iter().map(|[a, b]| (a - x).hypot(b * row - y)).collect();
        let nearest = (0..away.len()).min_by(|a, b| away[*a].total_cmp(&away[*b])).unwrap_or(0);
        assert!((f64::from(at) - away[nearest]).abs() < 1e-5, "at [{x}, {y}]: {at}, not {}", away[nearest]);
        // The bisector with the next middle is half of the way between the two away.
        let near = away[nearest];
        away.sort_by(f64::total_cmp);
        let bisector = (away[1].powi(2) - near.powi(2)) / 2.0;
        assert!((f64::from(edge) - bisector).abs() < 1e-4, "at [{x}, {y}]: {edge}, not {bisector}");
        assert_eq!(*cells.entry(nearest).or_insert([cx, cy]), [cx, cy], "one number a hexagon");
    }
    let mut numbers: Vec<_> = cells.values().map(|[x, y]| (*x as i32, *y as i32)).collect();
    let count = numbers.len();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), count, "a number for each hexagon");
}

/// Lines of neighbouring squares meet in the middle of their sides.
#[test]
fn truchet_lines_go_on() {
    let drawing = Drawing::of("texture t(uv: vec2) -> (e: float) { e = truchet(uv).edge }");
    let hair = 1e-4;
    let near = |side: f64| drawing.seen([8, 200], [side, 0.0, side + 8.0 * hair, 5.0]);
    let (left, right) = (near(2.0 - 8.0 * hair), near(2.0));
    for (row, (left, right)) in left.chunks(8).zip(right.chunks(8)).enumerate() {
        assert!((left[7][0] - right[0][0]).abs() < 0.001, "row {row}: {} and {}", left[7][0], right[0][0]);
    }
}

/// The compiler proves of every mask that it tiles with its period.
#[test]
fn motifs_are_proved_to_tile() {
    for m in MASKS {
        let [x, y] = m.period;
        let place = format!("uv * vec2({:?}, {:?})", f64::from(4 * x), f64::from(4 * y));
        let cover = m.text.replace("(uv", &format!("({place}"));
        let text = format!("texture t(uv: vec2) -> (c: float) tiles 1 {{ c = {cover} }}");
        Drawing::of(&text);
    }
}
