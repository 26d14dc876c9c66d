//! What the noises' documentation says of their mean, their variance and their period.

use crate::support::Drawing;

/// Cells along the side of a field: 2²⁰ of them, each seen at one random place.
const SIDE: u32 = 1024;

/// A noise: the call, of a place `p` in so many dimensions, with its mean and variance as documented.
struct Noise {
    call: &'static str,
    dimensions: usize,
    mean: f64,
    variance: f64,
}

const fn of(call: &'static str, dimensions: usize, mean: f64, variance: f64) -> Noise {
    Noise { call, dimensions, mean, variance }
}

const NOISES: [Noise; 23] = [
    of("noise(p, seed: s)", 1, 0.0, 0.2375),
    of("noise(p)", 2, 0.0, 0.0931),
    of("noise(p)", 3, 0.0, 0.0486),
    of("noise(p)", 4, 0.0, 0.0286),
    of("value_noise(p, seed: s)", 1, 0.0, 0.2612),
    of("value_noise(p)", 2, 0.0, 0.2047),
    of("value_noise(p)", 3, 0.0, 0.1604),
    of("value_noise(p)", 4, 0.0, 0.1256),
    of("simplex(p, seed: s)", 1, 0.0, 0.3148),
    of("simplex(p)", 2, 0.0, 0.2905),
    of("simplex(p)", 3, 0.0, 0.1509),
    of("simplex(p)", 4, 0.0, 0.0641),
    of("gabor(p, seed: s)", 1, 0.0, 1.0 / 9.0),
    of("gabor(p)", 2, 0.0, 1.0 / 9.0),
    of("gabor(p)", 3, 0.0, 1.0 / 9.0),
    of("worley(p)", 2, 0.4292, 0.0360),
    of("worley(p)", 3, 0.5205, 0.0297),
    of("turbulence(p, octaves: 1, seed: s)", 1, 0.3795, 0.0935),
    of("turbulence(p, octaves: 1)", 2, 0.2491, 0.0310),
    of("turbulence(p, octaves: 1)", 3, 0.1798, 0.0163),
    of("turbulence(p, octaves: 1)", 4, 0.1372, 0.0097),
    of("ridged(p, octaves: 1)", 2, 0.5949, 0.0601),
    of("ridged(p, octaves: 1)", 3, 0.6891, 0.0396),
];

/// The mean and the variance.
fn moments(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n)
}

#[test]
fn means_and_variances_are_as_documented() {
    let mut off = Vec::new();
    for Noise { call, dimensions, mean, variance } in NOISES {
        let place = ["a.x", "a.xy", "vec3(a.xy, b.z)", "vec4(a.xy, b.zw)"][dimensions - 1];
        let text = format!(
            "texture t(uv: vec2) -> (value: float) {{\n    let cell = ifloor(uv * {SIDE}.0)\n    let b = hash(cell, seed: 99) * 512.0\n    let a = cell + fract(b.xy)\n    let p = {place}\n    let s = cell.y\n    value = {call}\n}}\n",
        );
        let values: Vec<f64> =
            Drawing::of(&text).cells(SIDE).iter().map(|pixel| f64::from(pixel[0])).collect();
        let (found_mean, found_variance) = moments(&values);
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        println!(
            "{call} in {dimensions}D: mean {found_mean:.5}, variance {found_variance:.6}, {least:.3} to {most:.3}"
        );
        if (found_mean - mean).abs() > 0.01 * variance.sqrt()
            || (found_variance / variance - 1.0).abs() > 0.01
        {
            off.push(format!(
                "{call} in {dimensions}D: {found_mean} ({mean}), {found_variance} ({variance})"
            ));
        }
    }
    assert!(off.is_empty(), "{}", off.join("\n"));
}

/// What repeats after eight cells, in calls of `p`.
const TILED: [&str; 14] = [
    "noise(p, period: ivec2(8))",
    "noise(vec3(p, 0.3), period: ivec3(8))",
    "noise(vec4(p, 0.3, 0.6), period: ivec4(8))",
    "value_noise(p, period: ivec2(8))",
    "simplex(p, period: ivec2(8))",
    "simplex(vec3(p, 0.3), period: ivec3(8))",
    "simplex(vec4(p, 0.3, 0.6), period: ivec4(8))",
    "gabor(p, period: ivec2(8))",
    "worley(p, period: ivec2(8))",
    "fbm(p, octaves: 5, period: ivec2(8))",
    "turbulence(p, octaves: 5, period: ivec2(8))",
    "ridged(p, octaves: 5, period: ivec2(8))",
    "marble(p, period: ivec2(8)).vein",
    "clouds(p, period: ivec2(8)).density",
];

#[test]
fn tiled_noises_match_at_the_border_to_the_last_bit() {
    for call in TILED {
        let text = format!(
            "texture t(uv: vec2) -> (value: float) {{\n    let p = uv * 8.0\n    value = {call}\n}}\n"
        );
        let drawing = Drawing::of(&text);
        let here = drawing.seen([64; 2], [0.0, 0.0, 1.0, 1.0]);
        let spread = moments(&here.iter().map(|pixel| f64::from(pixel[0])).collect::<Vec<_>>()).1;
        assert!(spread > 0.005, "{call} is flat: {spread}");
        for region in [[1.0, 0.0, 2.0, 1.0], [0.0, 1.0, 1.0, 2.0], [-3.0, 2.0, -2.0, 3.0]] {
            let there = drawing.seen([64; 2], region);
            let differ = here.iter().zip(&there).filter(|(a, b)| a[0].to_bits() != b[0].to_bits()).count();
            assert_eq!(differ, 0, "{call} at {region:?}");
        }
    }
}

/// What moves its own place repeats but for what the place loses where numbers are larger.
#[test]
fn materials_match_at_the_border() {
    for call in ["rust(p, period: ivec2(8)).height", "granite(p, period: ivec2(8)).color.r"] {
        let text = format!(
            "texture t(uv: vec2) -> (value: float) {{\n    let p = uv * 8.0\n    value = {call}\n}}\n"
        );
        let drawing = Drawing::of(&text);
        let here = drawing.seen([64; 2], [0.0, 0.0, 1.0, 1.0]);
        for region in [[1.0, 0.0, 2.0, 1.0], [0.0, 1.0, 1.0, 2.0], [-3.0, 2.0, -2.0, 3.0]] {
            let there = drawing.seen([64; 2], region);
            let differ = here.iter().zip(&there).filter(|(a, b)| (a[0] - b[0]).abs() > 1e-3).count();
            assert!(differ <= 4, "{call} at {region:?}: {differ} pixels");
        }
    }
}

/// Pixels along the side of a field, of eight a cell.
const FIELD: usize = 256;

/// The power at a frequency, in cycles a cell, of a field seen through a Hann window.
fn power(field: &[f64], frequency: [f64; 2]) -> f64 {
    let wave = |axis: usize| -> Vec<[f64; 2]> {
        let turn = std::f64::consts::TAU * frequency[axis] / 8.0;
        (0..FIELD).map(|i| [(turn * i as f64).cos(), (turn * i as f64).sin()]).collect()
    };
    let (across, down) = (wave(0), wave(1));
    let mut sum = [0.0; 2];
    for (row, [c, s]) in field.chunks_exact(FIELD).zip(down) {
        let [re, im] =
            row.iter().zip(&across).fold([0.0; 2], |[re, im], (v, [c, s])| [re + v * c, im + v * s]);
        sum = [sum[0] + re * c - im * s, sum[1] + re * s + im * c];
    }
    sum[0] * sum[0] + sum[1] * sum[1]
}

/// How much more power a noise has along the axes than along the diagonals.
fn axes_over_diagonals(call: &str) -> f64 {
    let hann = |i: usize| (std::f64::consts::PI * (i as f64 + 0.5) / FIELD as f64).sin().powi(2);
    let mut powers = [0.0; 2];
    for seed in 0..16 {
        let text = format!(
            "texture t(uv: vec2) -> (value: float) {{\n    let p = uv * 32.0 + 100.0 * {seed}\n    let s = {seed}\n    value = {call}\n}}\n"
        );
        let seen = Drawing::of(&text).cells(FIELD as u32);
        let field: Vec<f64> = seen
            .iter()
            .enumerate()
            .map(|(i, v)| f64::from(v[0]) * hann(i % FIELD) * hann(i / FIELD))
            .collect();
        for (sum, first) in powers.iter_mut().zip([0.0_f64, 45.0]) {
            for (radius, away) in (2..28).flat_map(|r| [-8.0, 0.0, 8.0, 82.0, 90.0, 98.0].map(|a| (r, a))) {
                let angle = (first + away).to_radians();
                let radius = f64::from(radius) * 0.1;
                *sum += radius * power(&field, [radius * angle.cos(), radius * angle.sin()]);
            }
        }
    }
    powers[0] / powers[1]
}

#[test]
fn simplex_and_gabor_look_alike_in_all_directions() {
    let bounds = [
        ("noise(p, seed: s)", f64::INFINITY),
        ("value_noise(p, seed: s)", f64::INFINITY),
        ("worley(p, seed: s) - 0.4292", f64::INFINITY),
        ("simplex(p, seed: s)", 1.15),
        ("gabor(p, seed: s)", 1.15),
    ];
    let ratios = bounds.map(|(call, bound)| (call, bound, axes_over_diagonals(call)));
    for (call, _, ratio) in ratios {
        println!("{call}: {ratio:.3} times as much power along the axes as along the diagonals");
    }
    for (call, bound, ratio) in ratios {
        assert!(ratio.max(1.0 / ratio) <= bound, "{call}: {ratio}");
    }
}
