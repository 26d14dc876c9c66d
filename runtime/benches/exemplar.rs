//! What it takes to make an exemplar, beside a plain implementation of the published listings 1.8 to
//! 1.11 (Deliot & Heitz 2019) with the same truncation and the same order of equal values.
//!
//! Run with `cargo bench -p texgraph-runtime --no-default-features --bench exemplar`; `-- 4096` for
//! another size, `-- FILE.png` for pictures other than the made-up one. Memory is told on Linux.

use std::time::{Duration, Instant};
use texgraph_compiler::manifest::{Borders, Compression, Encoding};
use texgraph_runtime::resource::exemplar::{self, Wanted};
use texgraph_runtime::resource::{Decoded, srgb_to_linear};

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const WIDTH: usize = 256;
const WANTED: Wanted = Wanted {
    encoding: Encoding::Srgb,
    channels: 3,
    slices: 1,
    borders: Borders::Repeat,
    lut: WIDTH as u32,
    compress: Compression::None,
};
const ROUNDS: usize = 5;
/// Says that memory is to be told.
const MEMORY: &str = "TEXGRAPH_TELL_MEMORY";

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let side = arguments.first().and_then(|argument| argument.parse().ok()).unwrap_or(2048);
    let pictures: Vec<(String, [u32; 2], Vec<u8>)> = match arguments.first() {
        Some(path) if path.parse::<u32>().is_err() => arguments.iter().map(|path| read(path)).collect(),
        _ => vec![(format!("clouds of colour, {side}²"), [side, side], clouds(side))],
    };
    if std::env::var_os(MEMORY).is_some() {
        return pictures.iter().for_each(|(name, size, pixels)| memory(name, *size, pixels));
    }
    // What is freed is held for a while, unless the allocator is told not to when it starts.
    for (what, delay) in [("in use", "0"), ("with what the allocator holds", "10")] {
        let again = std::env::current_exe().and_then(|program| {
            let mut process = std::process::Command::new(program);
            process.args(&arguments).env("MIMALLOC_PURGE_DELAY", delay).env(MEMORY, what).status()
        });
        again.expect("it runs again");
    }
    for (name, size, pixels) in pictures {
        compare(&name, size, &pixels);
    }
}

fn read(path: &str) -> (String, [u32; 2], Vec<u8>) {
    let picture = image::open(path).expect("a picture").to_rgb8();
    (path.to_owned(), [picture.width(), picture.height()], picture.into_raw())
}

/// Tells how much memory there is at most, with the picture and what is made of it. Linux knows.
fn memory(name: &str, size: [u32; 2], pixels: &[u8]) {
    let kilobytes = |what: &str| -> Option<u64> {
        let status = std::fs::read_to_string("/proc/self/status").ok()?;
        let line = status.lines().find_map(|line| line.strip_prefix(what))?;
        line.trim_matches(|c: char| !c.is_ascii_digit()).parse().ok()
    };
    let picture = Decoded::rgb(size, pixels.to_vec()).expect("as many texels as its size says");
    // From here on the peak is counted anew.
    let is_reset = std::fs::write("/proc/self/clear_refs", "5").is_ok();
    let before = kilobytes("VmRSS:");
    let made = exemplar::of_picture(&picture, &WANTED);
    let (Some(before), Some(peak), true) = (before, kilobytes("VmHWM:"), is_reset) else { return };
    let input = pixels.len() as f64;
    let most = (peak.saturating_sub(before) * 1024) as f64 / input + 1.0;
    let left: usize = made.iter().map(|made| made.bytes.len()).sum();
    let left = left as f64 / input;
    let what = std::env::var(MEMORY).unwrap_or_default();
    println!(
        "{name}: {most:.2} times the picture's bytes at most, {what}; with it and {left:.2} that are made"
    );
}

fn compare(name: &str, size: [u32; 2], pixels: &[u8]) {
    let picture = Decoded::rgb(size, pixels.to_vec()).expect("as many texels as its size says");
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| least(ROUNDS, || exemplar::of_picture(&picture, &WANTED)))
    };
    let (one, made) = on(1);
    let (two, _) = on(2);
    println!("{name}: {:.0} ms on one thread, {:.0} ms on two", ms(one), ms(two));
    let (plain, (gaussian, lut)) = least(1, || listings(size, pixels));
    println!("the listings: {:.0} ms, {:.1} times", ms(plain), plain.as_secs_f64() / one.as_secs_f64());
    let texels = size[0] as usize * size[1] as usize;
    let ours = &made[0].bytes[..texels * 4];
    let mut apart = [0_usize; 256];
    for (ours, plain) in ours.chunks_exact(4).zip(gaussian.chunks_exact(3)) {
        ours.iter().zip(plain).for_each(|(a, b)| apart[usize::from(a.abs_diff(*b))] += 1);
    }
    let differ: usize = apart[1..].iter().sum();
    let most = apart.iter().rposition(|count| *count > 0).unwrap_or(0);
    println!(
        "8-bit numbers that differ: {:.4} %, by {most} at most",
        100.0 * differ as f64 / (3 * texels) as f64
    );
    assert!(lut.iter().all(|number| number.is_finite()), "the listings' table is finite");
}

fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

fn least<T>(rounds: usize, mut f: impl FnMut() -> T) -> (Duration, T) {
    let mut timed = || {
        let start = Instant::now();
        let made = f();
        (start.elapsed(), made)
    };
    let mut best = timed();
    for _ in 1..rounds {
        let next = timed();
        if next.0 < best.0 {
            best = next;
        }
    }
    best
}

/// A picture like a photograph: octaves of smooth noise, three ways mixed, and grain.
fn clouds(side: u32) -> Vec<u8> {
    let random = |x: u32, y: u32, seed: u32| {
        let mut h =
            x.wrapping_mul(0x9e37_79b9) ^ y.wrapping_mul(0x85eb_ca6b) ^ seed.wrapping_mul(0xc2b2_ae35);
        h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
        h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
        f64::from(h ^ (h >> 15)) / f64::from(u32::MAX)
    };
    let smooth = |x: f64, y: f64, seed: u32| {
        let (i, j) = (x.floor(), y.floor());
        let ease = |t: f64| t * t * (3.0 - 2.0 * t);
        let (u, v) = (ease(x - i), ease(y - j));
        let at = |di: f64, dj: f64| random((i + di) as u32, (j + dj) as u32, seed);
        let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
        mix(mix(at(0.0, 0.0), at(1.0, 0.0), u), mix(at(0.0, 1.0), at(1.0, 1.0), u), v)
    };
    let sum = |x: f64, y: f64, seed: u32| {
        let octaves = (0..6).map(|k| {
            smooth(x * f64::from(1 << k), y * f64::from(1 << k), seed + k) * 0.5_f64.powi(k as i32 + 1)
        });
        octaves.sum::<f64>()
    };
    let mut pixels = Vec::with_capacity(side as usize * side as usize * 3);
    for y in 0..side {
        for x in 0..side {
            let (u, v) = (f64::from(x) * 8.0 / f64::from(side), f64::from(y) * 8.0 / f64::from(side));
            let (a, b) = (sum(u, v, 1), sum(u, v, 20));
            let grain = random(x, y, 99) * 0.1;
            for part in [a * 0.9, a * 0.6 + b * 0.3, b * 0.5 + a * 0.2] {
                pixels.push(((part + grain).clamp(0.0, 1.0) * 255.0) as u8);
            }
        }
    }
    pixels
}

/// A value of a channel with its place, as listing 1.8 sorts them.
#[derive(Clone, Copy)]
struct PixelSort {
    x: u32,
    y: u32,
    value: f32,
}

/// The published listings: 1.8 for each channel, 1.9 for each channel, and the filter of §1.5.3, in
/// colours along the axes of §1.4, which are ours.
fn listings(size: [u32; 2], pixels: &[u8]) -> (Vec<u8>, Vec<f32>) {
    let texels = size[0] as usize * size[1] as usize;
    let light: Vec<f32> = (0..256).map(|code| srgb_to_linear(f64::from(code) / 255.0) as f32).collect();
    let picture = Decoded::rgb(size, pixels.to_vec()).expect("a picture");
    let axes = exemplar::axes(&picture, &WANTED);
    let mut gaussian = vec![0_u8; texels * 3];
    let mut luts = Vec::new();
    for (channel, axis) in axes.iter().enumerate() {
        let value = |i: usize| {
            let [r, g, b] = [0, 1, 2].map(|k| light[usize::from(pixels[3 * i + k])]);
            r * axis[0] + g * axis[1] + b * axis[2]
        };
        // Listing 1.8.
        let mut sorted: Vec<PixelSort> = (0..texels)
            .map(|i| PixelSort { x: i as u32 % size[0], y: i as u32 / size[0], value: value(i) })
            .collect();
        let order = |p: &PixelSort| exemplar::scatter(p.y * size[0] + p.x);
        sorted.sort_unstable_by(|a, b| a.value.total_cmp(&b.value).then_with(|| order(a).cmp(&order(b))));
        let mut floats = vec![0.0_f32; texels];
        for (i, pixel) in sorted.iter().enumerate() {
            let u = (i as f64 + 0.5) / texels as f64;
            let (low, high) = (cdf(-3.0), cdf(3.0));
            let g = 0.5 + inverse_cdf(low + u * (high - low)) / 6.0;
            floats[(pixel.y * size[0] + pixel.x) as usize] = g as f32;
        }
        for (i, g) in floats.iter().enumerate() {
            gaussian[3 * i + channel] = (g * 255.0).round() as u8;
        }
        // Listing 1.9.
        let mut values: Vec<f32> = (0..texels).map(value).collect();
        values.sort_unstable_by(f32::total_cmp);
        let mut lut: Vec<f32> = (0..WIDTH)
            .map(|i| {
                let g = (i as f64 + 0.5) / WIDTH as f64;
                let (low, high) = (cdf(-3.0), cdf(3.0));
                let u = (cdf((g - 0.5) * 6.0) - low) / (high - low);
                values[((u * texels as f64) as usize).min(texels - 1)]
            })
            .collect();
        filter(&mut lut, &floats, size);
        luts.extend(lut);
    }
    (gaussian, luts)
}

/// A row of the table for each level: the mean variance of the windows of that level, and the table
/// filtered by a Gaussian of it (§1.5.3).
fn filter(lut: &mut Vec<f32>, gaussian: &[f32], size: [u32; 2]) {
    let levels = size[0].max(size[1]).ilog2() + 1;
    for level in 1..levels {
        let window = 1_usize << level;
        let (width, height) = (size[0] as usize, size[1] as usize);
        let mut sum = 0.0;
        let mut windows = 0;
        for y in (0..height).step_by(window) {
            for x in (0..width).step_by(window) {
                let (mut first, mut second, mut count) = (0.0, 0.0, 0);
                for row in y..(y + window).min(height) {
                    for value in &gaussian[row * width + x..row * width + (x + window).min(width)] {
                        first += f64::from(*value);
                        second += f64::from(*value) * f64::from(*value);
                        count += 1;
                    }
                }
                let mean = first / f64::from(count);
                sum += second / f64::from(count) - mean * mean;
                windows += 1;
            }
        }
        let variance = sum / f64::from(windows);
        for i in 0..WIDTH {
            let (mut total, mut weights) = (0.0, 0.0);
            for (j, value) in lut[..WIDTH].iter().enumerate() {
                let distance = (j as f64 - i as f64) / WIDTH as f64;
                let weight = (-0.5 * distance * distance / variance).exp();
                total += weight * f64::from(*value);
                weights += weight;
            }
            lut.push((total / weights) as f32);
        }
    }
}

/// Listing 1.6, in doubles.
fn cdf(x: f64) -> f64 {
    0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)
}

/// Listing 1.7: the inverse of the error function (Giles, Approximating the erfinv function, 2010),
/// and a step of Newton's method, for the listing has floats.
fn inverse_cdf(u: f64) -> f64 {
    let x = 2.0 * u - 1.0;
    let w = -((1.0 - x) * (1.0 + x)).ln();
    let polynomial = |w: f64, c: [f64; 9]| c.iter().fold(0.0, |sum, c| sum * w + c);
    let guess = x * if w < 5.0 {
        polynomial(
            w - 2.5,
            [
                2.810_226_36e-8,
                3.432_739_39e-7,
                -3.523_387_7e-6,
                -4.391_506_54e-6,
                0.000_218_580_87,
                -0.001_253_725_03,
                -0.004_177_681_640,
                0.246_640_727,
                1.501_409_41,
            ],
        )
    } else {
        polynomial(
            w.sqrt() - 3.0,
            [
                -0.000_200_214_257,
                0.000_100_950_558,
                0.001_349_343_22,
                -0.003_673_428_44,
                0.005_739_507_73,
                -0.007_622_461_3,
                0.009_438_870_47,
                1.001_674_06,
                2.832_976_82,
            ],
        )
    };
    let z = guess * std::f64::consts::SQRT_2;
    let density = (-0.5 * z * z).exp() / (2.0 * std::f64::consts::PI).sqrt();
    z - (cdf(z) - u) / density
}
