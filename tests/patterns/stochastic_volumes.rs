//! Exemplars in space (`std/stochastic_volumes.tex`): their colours, their borders and the tetrahedra
//! that they blend in.

use crate::support::Drawing;
use std::f64::consts::TAU;

/// Texels of a block along each axis, four slices to a row of the sheet.
const SIDE: u32 = 16;

/// Pixels along a side of what is drawn.
const PIXELS: u32 = 192;

/// A block that wraps.
fn wave([x, y, z]: [u32; 3]) -> u8 {
    let [x, y, z] = [x, y, z].map(|side| f64::from(side) / f64::from(SIDE) * TAU);
    (128.0 + 40.0 * (x + z).sin() + 40.0 * (y - z).cos() + 40.0 * (x + y + 1.0).sin()) as u8
}

/// One that wraps along two axes only.
fn slope([x, _, z]: [u32; 3]) -> u8 {
    (40.0 + 10.0 * f64::from(z) + 10.0 * (f64::from(x) / f64::from(SIDE) * TAU).sin()) as u8
}

/// All numbers of a block.
fn numbers(code: fn([u32; 3]) -> u8) -> Vec<f32> {
    let texels = (0..SIDE.pow(3)).map(|i| [i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE]);
    texels.map(|at| f32::from(code(at)) / 255.0).collect()
}

/// Drawn of the block on a slanted plane, so many blocks of it along a side.
fn drawn(code: fn([u32; 3]) -> u8, wrap: &str, blocks: f64, arguments: &str) -> Vec<f32> {
    let folder = tempfile::tempdir().expect("a folder");
    let sheet = image::GrayImage::from_fn(4 * SIDE, 4 * SIDE, |x, y| {
        image::Luma([code([x % SIDE, y % SIDE, y / SIDE * 4 + x / SIDE])])
    });
    sheet.save(folder.path().join("slices.png")).expect("a picture is written");
    let text = format!(
        "let block = exemplar<3>(\"slices.png\", grid: ivec2(4, 4), encoding: linear, channels: 1, wrap: {wrap})
         texture t(uv: vec2) -> (seen: vec4) {{
             seen = block.stochastic(vec3(uv, 0.6 * uv.x + 0.3 * uv.y) * {blocks:.6}{arguments})
         }}"
    );
    let seen = Drawing::beside(folder.path(), &text).seen([PIXELS; 2], [0.0, 0.0, 1.0, 1.0]);
    seen.into_iter().map(|pixel| pixel[0]).collect()
}

/// The distance of Kolmogorov and Smirnov of two sets of numbers.
fn distance(mut one: Vec<f32>, mut other: Vec<f32>) -> f64 {
    one.sort_by(f32::total_cmp);
    other.sort_by(f32::total_cmp);
    let below = |set: &[f32], x: f32| set.partition_point(|y| *y <= x) as f64 / set.len() as f64;
    let apart = (0..=1000).map(|i| i as f32 / 1000.0).map(|x| (below(&one, x) - below(&other, x)).abs());
    apart.fold(0.0, f64::max)
}

fn mean(numbers: &[f32]) -> f64 {
    numbers.iter().map(|x| f64::from(*x)).sum::<f64>() / numbers.len() as f64
}

#[test]
fn blends_have_the_colours_of_the_block() {
    let of = |arguments: &str| distance(drawn(wave, "repeat", 12.0, arguments), numbers(wave));
    let (histogram, linear) = (of(""), of(", blend: linear"));
    // Some 1600 tetrahedra are seen: what chance makes of their distance is 0.03.
    assert!(histogram < 0.06, "{histogram}");
    assert!(linear > 0.12 && histogram < 0.5 * linear, "{histogram}, of linear blends {linear}");
    assert!(of(", blend: variance") < linear);
}

#[test]
fn means_stay_from_afar() {
    let expected = mean(&numbers(wave));
    for (blocks, bound) in [(12.0, 0.02), (24.0, 0.01), (50.0, 0.006), (200.0, 0.004), (3000.0, 0.004)] {
        let found = mean(&drawn(wave, "repeat", blocks, ""));
        assert!((found - expected).abs() < bound, "{blocks} blocks: {found} for {expected}");
    }
}

/// Which tetrahedron a pixel lies in: the cube of the skewed grid, and the order of the axes.
fn tetrahedron([x, y]: [u32; 2], blocks: f64) -> ([i64; 3], [bool; 3]) {
    let [u, v] = [x, y].map(|side| (f64::from(side) + 0.5) / f64::from(PIXELS));
    let at = [u, v, 0.6 * u + 0.3 * v].map(|side| side * blocks / 0.3);
    let skewed = at.map(|side| side + at.iter().sum::<f64>() / 3.0);
    let [a, b, c] = skewed.map(|side| side - side.floor());
    (skewed.map(|side| side.floor() as i64), [a > b, b > c, c > a])
}

/// The greatest step from a pixel to the next, from one tetrahedron to another and inside of them.
fn steps(code: fn([u32; 3]) -> u8, wrap: &str, blocks: f64) -> [f32; 2] {
    let light = drawn(code, wrap, blocks, "");
    let mut most = [0.0_f32; 2];
    for (x, y) in (1..PIXELS).flat_map(|y| (1..PIXELS).map(move |x| (x, y))) {
        for there in [[x - 1, y], [x, y - 1]] {
            let step = light[(y * PIXELS + x) as usize] - light[(there[1] * PIXELS + there[0]) as usize];
            let is_inside = tetrahedron([x, y], blocks) == tetrahedron(there, blocks);
            let slot = &mut most[usize::from(is_inside)];
            *slot = slot.max(step.abs());
        }
    }
    most
}

#[test]
fn no_seam_is_seen_in_space() {
    for (code, wrap) in [(wave as fn([u32; 3]) -> u8, "repeat"), (slope, "inside")] {
        // Up to half a texel a pixel: where tetrahedra have few pixels, more steps are across than inside.
        for blocks in [0.4, 1.5, 6.0] {
            let [across, inside] = steps(code, wrap, blocks);
            assert!(across > 0.0 && across < 1.15 * inside, "{wrap}, {blocks}: {across}, inside {inside}");
        }
    }
}

/// `auto` sees that slices don't wrap: no part crosses from the last to the first.
#[test]
fn slices_that_do_not_wrap_stay_inside() {
    let most = |code, wrap| steps(code, wrap, 3.0).into_iter().fold(0.0, f32::max);
    assert_eq!(most(slope, "auto"), most(slope, "inside"));
    assert!(most(slope, "repeat") > 2.5 * most(slope, "auto"));
    assert_eq!(most(wave, "auto"), most(wave, "repeat"));
}
