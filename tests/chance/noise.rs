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
    of("turbulence(p, octaves: 1)", 2, 0.2488, 0.0312),
    of("turbulence(p, octaves: 1)", 3, 0.1803, 0.0161),
    of("turbulence(p, octaves: 1)", 4, 0.1374, 0.0097),
    of("ridged(p, octaves: 1)", 2, 0.5955, 0.0603),
    of("ridged(p, octaves: 1)", 3, 0.6880, 0.0392),
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
