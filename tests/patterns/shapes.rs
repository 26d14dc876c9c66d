//! Shapes (`std/shapes.tex`) against their outlines, walked point by point.

use crate::support::Drawing;
use std::f64::consts::{PI, TAU};

type Point = [f64; 2];
/// Closed ways, each through its points in order.
type Outline = Vec<Vec<Point>>;

/// Places across and down at which distances are compared, from -1 to 1.
const PLACES: u32 = 41;

/// A part of a circle, from one angle to another.
fn arc([x, y]: Point, radius: f64, from: f64, to: f64) -> Vec<Point> {
    let steps = 2_000;
    let angle = |i: u32| from + (to - from) * f64::from(i) / f64::from(steps);
    (0..=steps).map(|i| [x + radius * angle(i).cos(), y + radius * angle(i).sin()]).collect()
}

/// A rectangle with corners of some radii: upper left, upper right, lower right, lower left.
fn rectangle([w, h]: Point, radii: [f64; 4]) -> Outline {
    let corner = |i: usize, x: f64, y: f64| {
        let r = radii[i];
        let start = PI + i as f64 * PI / 2.0;
        arc([x * (w / 2.0 - r), y * (h / 2.0 - r)], r, start, start + PI / 2.0)
    };
    vec![[corner(0, -1.0, -1.0), corner(1, 1.0, -1.0), corner(2, 1.0, 1.0), corner(3, -1.0, 1.0)].concat()]
}

/// Corners around the origin, the first one up, at these radii by turns.
fn corners(count: u32, radii: [f64; 2]) -> Outline {
    let corner = |i: u32| {
        let (angle, r) = (TAU * f64::from(i) / f64::from(count) - PI / 2.0, radii[i as usize % 2]);
        [r * angle.cos(), r * angle.sin()]
    };
    vec![(0..count).map(corner).collect()]
}

fn circle(radius: f64) -> Vec<Point> {
    arc([0.0; 2], radius, 0.0, TAU)
}

/// A part of a ring with round ends.
fn bow(start: f64, sweep: f64, radius: f64, half: f64) -> Outline {
    let [first, last] = [start, start + sweep].map(|angle| [radius * angle.cos(), radius * angle.sin()]);
    let end = start + sweep;
    vec![
        [
            arc([0.0; 2], radius + half, start, end),
            arc(last, half, end, end + PI),
            arc([0.0; 2], radius - half, end, start),
            arc(first, half, start + PI, start + TAU),
        ]
        .concat(),
    ]
}

fn minus([ax, ay]: Point, [bx, by]: Point) -> Point {
    [ax - bx, ay - by]
}

fn sides(way: &[Point]) -> impl Iterator<Item = (Point, Point)> {
    way.iter().copied().zip(way.iter().copied().cycle().skip(1))
}

/// How far a place is from a side.
fn away(p: Point, (from, to): (Point, Point)) -> f64 {
    let ([x, y], [along, down]) = (minus(p, from), minus(to, from));
    let length = along * along + down * down;
    let share = if length > 0.0 { ((x * along + y * down) / length).clamp(0.0, 1.0) } else { 0.0 };
    (x - along * share).hypot(y - down * share)
}

/// Whether a ray to the right meets the side.
fn crosses([x, y]: Point, ([ax, ay], [bx, by]): (Point, Point)) -> bool {
    (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax)
}

/// The signed distance, from the nearest side and from how often a ray leaves the shape.
fn walked(outline: &Outline, p: Point) -> f64 {
    let all = || outline.iter().flat_map(|way| sides(way));
    let nearest = all().map(|side| away(p, side)).fold(f64::MAX, f64::min);
    if all().filter(|side| crosses(p, *side)).count() % 2 == 1 { -nearest } else { nearest }
}

fn check(shape: &str, outline: &Outline, tolerance: f64) {
    let drawing = Drawing::of(&format!("texture t(uv: vec2) -> (d: float) {{ d = {shape} }}"));
    let drawn = drawing.seen([PLACES; 2], [-1.0, -1.0, 1.0, 1.0]);
    let mut worst: f64 = 0.0;
    for (i, [d, ..]) in (0..).zip(drawn) {
        let place = [i % PLACES, i / PLACES].map(|i| (f64::from(i) + 0.5) / f64::from(PLACES) * 2.0 - 1.0);
        let off = (f64::from(d) - walked(outline, place)).abs();
        worst = worst.max(off);
        assert!(off < tolerance, "{shape} at {place:?}: {d}, walked {}", walked(outline, place));
    }
    println!("{shape}: off by {worst:.1e} at most");
}

#[test]
fn distances_are_those_to_the_outline() {
    const ROUNDING: f64 = 4e-6;
    check("circle(uv, radius: 0.6)", &vec![circle(0.6)], ROUNDING);
    check("box(uv, size: vec2(1.2, 0.7))", &rectangle([1.2, 0.7], [0.0; 4]), ROUNDING);
    check("box(uv, size: vec2(1.2, 0.7), rounding: 0.2)", &rectangle([1.2, 0.7], [0.2; 4]), ROUNDING);
    check("star(uv, radius: 0.8, inner: 0.4)", &corners(10, [0.8, 0.32]), ROUNDING);
    check("star(uv, points: 2, radius: 0.8, inner: 0.3)", &corners(4, [0.8, 0.24]), ROUNDING);
    check("star(uv, points: 3, radius: 0.4, inner: 2.0)", &corners(6, [0.4, 0.8]), ROUNDING);
    check("polygon(uv, sides: 3, radius: 0.7)", &corners(3, [0.7; 2]), ROUNDING);
    check("polygon(uv, sides: 8, radius: 0.7)", &corners(8, [0.7; 2]), ROUNDING);
    check("ring(uv, radius: 0.6, thickness: 0.3)", &vec![circle(0.75), circle(0.45)], ROUNDING);
    check("arc(uv, 0.5, 1.5, radius: 0.6, thickness: 0.2)", &bow(0.5, 1.5, 0.6, 0.1), ROUNDING);
    check("arc(uv, -1.0, 5.0, radius: 0.6, thickness: 0.2)", &bow(-1.0, 5.0, 0.6, 0.1), ROUNDING);
    let turn = 0.5_f64.atan2(1.0);
    let rod = [
        arc([0.5, 0.25], 0.2, turn - PI / 2.0, turn + PI / 2.0),
        arc([-0.5, -0.25], 0.2, turn + PI / 2.0, turn + 1.5 * PI),
    ];
    check("line(uv, vec2(-0.5, -0.25), vec2(0.5, 0.25), thickness: 0.4)", &vec![rod.concat()], ROUNDING);
}

#[test]
fn ellipses_are_off_by_less_than_they_say() {
    for [a, b] in [[0.8, 0.2], [0.3, 0.8], [0.5, 0.5], [0.7, 0.6], [0.9, 0.09]] {
        let way = circle(1.0).into_iter().map(|[x, y]| [a * x, b * y]).collect();
        check(&format!("ellipse(uv, vec2({a}, {b}))"), &vec![way], 0.0001 * f64::max(a, b));
    }
}

#[test]
fn corners_of_their_own_radii_are_exact_outside() {
    let text = "max(rounded_box(uv, size: vec2(1.2, 0.8), corners: vec4(0.0, 0.1, 0.2, 0.4)), 0.0)";
    let outline = rectangle([1.2, 0.8], [0.0, 0.1, 0.2, 0.4]);
    let drawing = Drawing::of(&format!("texture t(uv: vec2) -> (d: float) {{ d = {text} }}"));
    let drawn = drawing.seen([PLACES; 2], [-1.0, -1.0, 1.0, 1.0]);
    for (i, [d, ..]) in (0..).zip(drawn) {
        let place = [i % PLACES, i / PLACES].map(|i| (f64::from(i) + 0.5) / f64::from(PLACES) * 2.0 - 1.0);
        assert!((f64::from(d) - walked(&outline, place).max(0.0)).abs() < 4e-6, "{place:?}: {d}");
    }
}

/// The nearest of points all over the surface of a box, and along a line.
#[test]
fn boxes_and_lines_in_space_are_as_far_as_their_points() {
    const SIDES: [f64; 3] = [1.0, 0.6, 0.4];
    let steps = 160;
    let part = |i: u32| f64::from(i) / f64::from(steps) - 0.5;
    let on_face = |axis: usize, side: f64, i: u32, j: u32| {
        let mut p = [0.0; 3];
        p[axis] = 0.5 * side * SIDES[axis];
        p[(axis + 1) % 3] = part(i) * SIDES[(axis + 1) % 3];
        p[(axis + 2) % 3] = part(j) * SIDES[(axis + 2) % 3];
        p
    };
    let grid = || (0..=steps).flat_map(|i| (0..=steps).map(move |j| (i, j)));
    let faces = [0, 1, 2].into_iter().flat_map(|axis| [-1.0, 1.0].map(|side| (axis, side)));
    let surface: Vec<[f64; 3]> =
        faces.flat_map(|(axis, side)| grid().map(move |(i, j)| on_face(axis, side, i, j))).collect();
    let ends = [[-0.4, -0.3, 0.5], [0.6, 0.2, -0.1]];
    let along = |t: f64| [0, 1, 2].map(|k: usize| ends[0][k] + (ends[1][k] - ends[0][k]) * t);
    let rod: Vec<[f64; 3]> = (0..=10_000).map(|i| along(f64::from(i) / 10_000.0)).collect();
    for z in [0.05, 0.3] {
        let text = format!(
            "texture t(uv: vec2) -> (d: vec2) {{
                let p = vec3(uv, {z})
                d = vec2(
                    box(p, size: vec3(1.0, 0.6, 0.4)),
                    line(p, vec3(-0.4, -0.3, 0.5), vec3(0.6, 0.2, -0.1)),
                )
            }}"
        );
        for (i, drawn) in (0..).zip(Drawing::of(&text).seen([9; 2], [-1.0, -1.0, 1.0, 1.0])) {
            let [x, y] = [i % 9, i / 9].map(|i| (f64::from(i) + 0.5) / 9.0 * 2.0 - 1.0);
            let nearest = |points: &[[f64; 3]]| {
                let squares =
                    points.iter().map(|[a, b, c]| (a - x).powi(2) + (b - y).powi(2) + (c - z).powi(2));
                squares.fold(f64::MAX, f64::min).sqrt()
            };
            let inside = x.abs() < 0.5 && y.abs() < 0.3 && z < 0.2;
            for (d, points, sign) in
                [(drawn[0], &surface, if inside { -1.0 } else { 1.0 }), (drawn[1], &rod, 1.0)]
            {
                let d = f64::from(d) * sign;
                let found = nearest(points);
                assert!(d < found + 1e-5 && found < d + 0.005, "[{x}, {y}, {z}]: {d}, found {found}");
            }
        }
    }
}

#[test]
fn shapes_join_smoothly_and_no_farther_than_they_say() {
    let text = |d: &str| {
        let text = format!(
            "texture t(uv: vec2) -> (d: vec4) {{
                let a = circle(uv, radius: 0.4)
                let b = box(uv - 0.3, size: 0.5)
                d = vec4(a, b, {d})
            }}"
        );
        Drawing::of(&text).seen([64; 2], [-1.0, -1.0, 1.0, 1.0])
    };
    const SMOOTH: f32 = 0.3;
    for [a, b, hard, soft] in text("union(a, b), union(a, b, smooth: 0.3)") {
        assert_eq!(hard, a.min(b));
        let near = (SMOOTH - (a - b).abs()).max(0.0);
        assert!((soft - (hard - near * near / (4.0 * SMOOTH))).abs() < 1e-6, "{a} and {b}: {soft}");
    }
    for [a, b, hard, soft] in text("intersection(a, b), intersection(a, b, smooth: 0.3)") {
        assert!(hard == a.max(b) && soft >= hard && soft <= hard + SMOOTH / 4.0, "{a} and {b}: {soft}");
    }
    for [a, b, hard, soft] in text("difference(a, b), difference(a, b, smooth: 0.3)") {
        assert!(hard == a.max(-b) && soft >= hard && soft <= hard + SMOOTH / 4.0, "{a} and {b}: {soft}");
    }
}

/// What a mask covers is the area of its shape, of however few pixels that is.
#[test]
fn masks_cover_the_area_of_their_shapes() {
    // Of pixels that lie in sixteen ways about the shape.
    let covered = |mask: &str, size: u32| {
        let drawing = Drawing::of(&format!("texture t(uv: vec2) -> (c: float) {{ c = {mask} }}"));
        let shifts = (0..16).map(|i| [i % 4, i / 4].map(|k| f64::from(k) / 4.0 * 2.0 / f64::from(size)));
        let drawn = shifts.flat_map(|[x, y]| drawing.seen([size; 2], [x - 1.0, y - 1.0, x + 1.0, y + 1.0]));
        let drawn: Vec<f64> = drawn.map(|[c, ..]| f64::from(c)).collect();
        4.0 * drawn.iter().sum::<f64>() / drawn.len() as f64
    };
    for size in [16, 32, 128] {
        let (disc, line) = (
            covered("fill(circle(uv, radius: 0.6))", size),
            covered("outline(circle(uv, radius: 0.6), 0.02)", size),
        );
        println!(
            "{size} pixels: a disc of {:.4} covers {disc:.4}, its outline of {:.4} {line:.4}",
            PI * 0.36,
            TAU * 0.012
        );
        assert!((disc / (PI * 0.36) - 1.0).abs() < 0.005, "{size}: {disc}");
        assert!((line / (TAU * 0.012) - 1.0).abs() < 0.01, "{size}: {line}");
    }
}
