//! Surfaces (`std/surface.tex`) against slopes, turns and horizons worked out here.

use crate::support::Drawing;
use std::f64::consts::TAU;

type V = [f64; 3];

fn drawn(text: &str, size: u32) -> Vec<V> {
    let pixels = Drawing::of(text).cells(size);
    pixels.into_iter().map(|[x, y, z, _]| [x, y, z].map(f64::from)).collect()
}

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: V) -> V {
    v.map(|x| x / dot(v, v).sqrt())
}

fn off(a: V, b: V) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)
}

const HILLS: &str = "
    node hills(p: vec2) -> (h: float) { h = 0.05 * sin(p.x * 2turn) + 0.1 * cos(p.y * 1turn) * p.x }
";

/// The slopes of the hills.
fn slopes([x, y]: [f64; 2]) -> [f64; 2] {
    [0.1 * TAU * (2.0 * TAU * x).cos() + 0.1 * (TAU * y).cos(), -0.1 * TAU * (TAU * y).sin() * x]
}

/// Whatever the pixels' way across the place: it is turned, stretched and skewed.
#[test]
fn normals_are_those_of_the_slopes_and_take_no_further_height() {
    for (place, of) in
        [("uv", [[1.0, 0.0], [0.0, 1.0]]), ("mat2(0.5, -2.0, 1.5, 0.25) * uv", [[0.5, 1.5], [-2.0, 0.25]])]
    {
        let text = format!(
            "{HILLS} texture t(uv: vec2) -> (n: vec3) {{
                let p = {place}
                n     = normal_from_height(hills(p), p, strength: 2.0)
            }}"
        );
        let mut worst: f64 = 0.0;
        for (i, found) in (0..).zip(drawn(&text, 32)) {
            let uv = [i % 32, i / 32].map(|i| (f64::from(i) + 0.5) / 32.0);
            let p = [0, 1].map(|k: usize| of[k][0] * uv[0] + of[k][1] * uv[1]);
            let [u, v] = slopes(p);
            let expected = unit([-2.0 * u, -2.0 * v, 1.0]);
            worst = worst.max(off(found, expected));
        }
        println!("{place}: off by {worst:.1e}");
        assert!(worst < 2e-5, "{place}: {worst}");
        assert_eq!(Drawing::of(&text).worst().samples, 0.0);
    }
}

/// A height that was sampled: two more samples show its slopes.
#[test]
fn normals_of_a_map_are_those_of_its_slopes() {
    let text = format!(
        "{HILLS} let map = bake(hills, size: 512)
        texture t(uv: vec2) -> (n: vec3) {{ n = normal_from_height(map.sample(uv).r, uv) }}"
    );
    for (i, found) in (0..).zip(drawn(&text, 128)) {
        let uv = [i % 128, i / 128].map(|i| (f64::from(i) + 0.5) / 128.0);
        let [u, v] = slopes(uv);
        // The hills end at the border, where the map begins again. Elsewhere the slope is that half a pixel
        // on, and of heights stored as half floats.
        let inside = uv.iter().all(|x| (0.02..0.98).contains(x));
        assert!(!inside || off(found, unit([-u, -v, 1.0])) < 0.06, "{uv:?}: {found:?}");
    }
    assert_eq!(Drawing::of(&text).worst().samples, 3.0);
}

#[test]
fn normals_are_blended_as_their_sources_say() {
    let text = |n: &str| {
        format!(
            "texture t(uv: vec2) -> (n: vec3) {{
                let cell   = ifloor(uv * 32.0)
                let base   = normalize(vec3(hash(cell).xy * 2.0 - 1.0, 0.3))
                let detail = normalize(vec3(hash(cell, seed: 1).xy * 2.0 - 1.0, 0.3))
                n          = {n}
            }}"
        )
    };
    let [bases, details] = ["base", "detail"].map(|n| drawn(&text(n), 32));
    let by_mode = |mode: &str| drawn(&text(&format!("blend_normals(base, detail, mode: {mode})")), 32);
    // The detail turned by the shortest turn that takes z to the base (Rodrigues).
    let turned = |b: V, d: V| {
        let (axis, c) = (cross([0.0, 0.0, 1.0], b), b[2]);
        let (around, along) = (cross(axis, d), dot(axis, d) / (1.0 + c));
        [0, 1, 2].map(|i: usize| d[i] * c + around[i] + axis[i] * along)
    };
    let whiteout = |b: V, d: V| unit([b[0] + d[0], b[1] + d[1], b[2] * d[2]]);
    let udn = |b: V, d: V| unit([b[0] + d[0], b[1] + d[1], b[2]]);
    type Mode = (&'static str, fn(V, V) -> V);
    let modes: [Mode; 3] = [("reoriented", turned), ("whiteout", whiteout), ("udn", udn)];
    for (mode, of) in modes {
        for ((b, d), found) in bases.iter().zip(&details).zip(by_mode(mode)) {
            assert!(off(found, of(*b, *d)) < 1e-5, "{mode}: {d:?} on {b:?} is {found:?}");
        }
    }
    for n in [
        "blend_normals(base, vec3(0.0, 0.0, 1.0))",
        "decode_normal(encode_normal(base))",
        "scale_normal(base, 1.0)",
    ] {
        for (b, found) in bases.iter().zip(drawn(&text(n), 32)) {
            assert!(off(found, *b) < 1e-5, "{n}: {b:?} became {found:?}");
        }
    }
    for (d, found) in details.iter().zip(drawn(&text("scale_normal(detail, 3.0)"), 32)) {
        assert!(off(found, unit([3.0 * d[0], 3.0 * d[1], d[2]])) < 1e-5);
    }
}

/// Toksvig's own way: from a width to a power, divided by his factor, and back.
#[test]
fn roughness_widens_by_the_lost_length() {
    let text = "texture t(uv: vec2) -> (r: float) { r = toksvig(uv.x, vec3(0.6, 0.0, 0.8) * uv.y) }";
    for (i, [found, ..]) in (0..).zip(drawn(text, 32)) {
        let [roughness, length] = [i % 32, i / 32].map(|i| (f64::from(i) + 0.5) / 32.0);
        let power = 2.0 / roughness.powi(4) - 2.0;
        let factor = length / (length + power * (1.0 - length));
        let expected = (2.0 / (factor * power + 2.0)).powf(0.25);
        assert!((found - expected).abs() < 1e-4, "{roughness}, {length}: {found}, not {expected}");
        assert!(found >= roughness - 1e-5);
    }
    let same = "texture t(uv: vec2) -> (r: float) { r = toksvig(uv.x, vec3(0.6, 0.0, 0.8)) - uv.x }";
    assert!(drawn(same, 32).iter().all(|[off, ..]| off.abs() < 2e-3), "unit normals change nothing");
}

/// An open plain sees all of the sky; beside a long wall of height h, at a distance d, half of the
/// directions see it, as far as it is: elevation atan(h·cos φ / d).
#[test]
fn places_see_as_much_sky_as_their_horizon_leaves() {
    let text = |height: &str| {
        format!(
            "let map = bake(|p| {height}, size: 512)
            texture t(uv: vec2) -> (open: float) {{
                open = ambient_occlusion(map, uv, depth: 0.1, radius: 0.4, directions: 32, steps: 48)
            }}"
        )
    };
    assert!(drawn(&text("0.3 + 0.0 * p.x"), 8).iter().all(|[open, ..]| *open == 1.0));
    let wall = text("if p.x > 0.5 { 1.0 } else { 0.0 }");
    let row = &drawn(&wall, 100)[5_000..5_100];
    for (i, [open, ..]) in (0..).zip(row) {
        let x = (f64::from(i) + 0.5) / 100.0;
        let d: f64 = 0.5 - x;
        if !(0.03..0.12).contains(&d) {
            continue;
        }
        let seen = |k: i32| {
            let towards = ((f64::from(k) + 0.5) / 32.0 * TAU).cos();
            // So far the wall is within the radius.
            if towards > d / 0.4 { 1.0 / (1.0 + (0.1 * towards / d).powi(2)) } else { 1.0 }
        };
        let expected = (0..32).map(seen).sum::<f64>() / 32.0;
        println!("{d:.3} from the wall: {open:.3} of {expected:.3}");
        assert!((open - expected).abs() < 0.05, "{d} from the wall: {open}, not {expected}");
    }
    assert!(row[70][0] > 0.999, "on the wall");
    assert_eq!(Drawing::of(&wall).worst().samples, 32.0 * 48.0 + 1.0);
}

#[test]
fn bulges_are_above_0_and_hollows_below() {
    let text = "let map = bake(|p| 0.5 + 0.5 * cos(p.x * 1turn) * cos(p.y * 1turn), size: 128)
        texture t(uv: vec2) -> (b: float) { b = curvature(map, uv, radius: 0.05) }";
    let found = drawn(text, 64);
    for (i, [b, ..]) in (0..).zip(&found) {
        let [x, y] = [i % 64, i / 64].map(|i| (f64::from(i) + 0.5) / 64.0);
        // Of a sum of waves of one length: proportional to the wave.
        let expected = 0.5 * (TAU * x).cos() * (TAU * y).cos() * (1.0 - (TAU * 0.05).cos());
        assert!((b - expected).abs() < 0.003, "[{x}, {y}]: {b}, not {expected}");
    }
}

#[test]
fn the_higher_of_two_is_seen_where_both_were_painted() {
    let text = |below: f32, above: f32| {
        format!(
            "texture t(uv: vec2) -> (s: float) {{ s = height_blend(uv.x, {below:?}, {above:?}, sharpness: 8.0) }}"
        )
    };
    let (low, even, high) =
        (drawn(&text(0.9, 0.1), 33), drawn(&text(0.5, 0.5), 33), drawn(&text(0.1, 0.9), 33));
    assert!(low[16][0] == 0.0 && (even[16][0] - 0.5).abs() < 1e-6 && high[16][0] == 1.0);
    assert!(low[..33].windows(2).all(|pair| pair[1][0] >= pair[0][0]), "more paint shows more");
}
