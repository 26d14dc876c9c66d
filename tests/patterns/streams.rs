//! Every node of the library that draws at a cell does so with seeds of its own, so that no two draws
//! at one cell are the same number (Lefebvre & Neyret 2003, §3.2).

use crate::support::Drawing;
use std::path::Path;

/// Cells a side that draws are compared in.
const CELLS: u32 = 512;
/// Values that a draw is sorted into.
const BINS: usize = 16;
/// Texels of a picture that says where it is read.
const TEXELS: u32 = 256;
/// Seeds of a stream at most, and what is greater than other numbers beside a seed.
const OF_A_STREAM: i64 = 256;
const LEAST_BASE: i64 = 1_000_000_000;

/// What the nodes draw for a cell on their default streams, four numbers in [0, 1) each, or constants.
const DRAWS: &[(&str, &str)] = &[
    ("virtual_index", "vec4((virtual_index(cell, 16) + 0.5) / 16.0)"),
    ("virtual_random", "virtual_random(cell)"),
    ("wang", "vec4(wang(cell, 4) % 4, wang(cell, 4) / 4 % 4, 0.0, 0.0) / 4.0"),
    ("dither", "vec4(dither(cell, vec2(0.5)) / 2.0, 0.0, 0.0)"),
    ("tiled", "pattern.tiled(cell, vec2(0.3, 0.1), |c| 0, orient: 8)"),
    ("hex_tile", "vec4(fract(picture.hex_tile(to_grid * cell).rg - to_grid * cell), 0.0, 0.0)"),
    ("noise", "vec4(fract(noise(cell + vec2(0.5, 0.25)) * 8.0), 0.0, 0.0, 0.0)"),
    ("splat, its middle", "vec4(fract(0.5 - own(p, |at, rnd| vec4(at, 0.0, 1.0)).xy), 0.0, 0.0)"),
    ("splat, its size", "vec4(own(p, |at, rnd| vec4(footprint(p) / footprint(at) - 1.0)))"),
    ("splat, its numbers", "own(p, |at, rnd| rnd)"),
];

/// The one stamp whose middle lies in the cell, and pictures that say where they are read.
const HEAD: &str = "
    let pattern = patterns(\"place.png\", encoding: linear, filter: nearest)
    let picture = image(\"place.png\", encoding: linear, filter: nearest)
    let to_grid = mat2(0.28867513, 0.0, 0.14433757, 0.25)
    node own(p: vec2, stamp: node(at: vec2, rnd: vec4) -> color) -> (drawn: vec4) {
        drawn = splat(p, stamp, scale: SCALE, density: |m| if ifloor(m) == ifloor(p) { 1.0 } else { 0.0 })
    }
";

/// A draw in every cell, by its name.
fn drawn(name: &str, draw: &str) -> Vec<[f32; 4]> {
    let folder = tempfile::tempdir().expect("a folder");
    let of = |x: u32, y: u32| image::Rgb([x, y, 0].map(|i| (i * 256 + 128) as u16));
    let picture = image::ImageBuffer::<image::Rgb<u16>, Vec<u16>>::from_fn(TEXELS, TEXELS, of);
    picture.save(folder.path().join("place.png")).expect("it is saved");
    // A stamp of size 1 shows how far its middle is; larger ones are seen from anywhere in the cell.
    let scale = if name.ends_with("size") { "vec2(1.0, 2.0)" } else { "vec2(2.0)" };
    let text = format!(
        "{}\ntexture t(uv: vec2) -> (drawn: vec4) {{
            let cell = ifloor(uv * {CELLS})
            let p    = cell + 0.5 + (uv * {CELLS} - cell - 0.5) * 0.001
            drawn    = {draw}
        }}",
        HEAD.replace("SCALE", scale)
    );
    Drawing::beside(folder.path(), &text).cells(CELLS)
}

/// How far a table of pairs is from that of independent draws, in standard deviations of chi-square.
fn dependence(pairs: &[f64]) -> f64 {
    let total: f64 = pairs.iter().sum();
    let rows: Vec<f64> = pairs.chunks(BINS).map(|row| row.iter().sum()).collect();
    let columns: Vec<f64> = (0..BINS).map(|j| pairs.iter().skip(j).step_by(BINS).sum()).collect();
    let expected = rows.iter().flat_map(|row| columns.iter().map(move |column| row * column / total));
    // A middle that rounds into the next cell leaves some cells without a stamp: too few to judge.
    let filled = pairs.iter().zip(expected).filter(|(_, expected)| *expected > 5.0);
    let chi_square: f64 = filled.map(|(n, expected)| (n - expected).powi(2) / expected).sum();
    let kinds = |sums: &[f64]| sums.iter().filter(|sum| **sum > total / 1000.0).count() as f64;
    let freedom = (kinds(&rows) - 1.0) * (kinds(&columns) - 1.0);
    (chi_square - freedom) / (2.0 * freedom).sqrt()
}

/// The components of a draw that are not constant, each as a value for every cell.
fn components(name: &str, draw: &str) -> Vec<(String, Vec<usize>)> {
    let drawn = drawn(name, draw);
    let sorted = |i: usize| drawn.iter().map(move |cell| ((cell[i] * BINS as f32) as usize).min(BINS - 1));
    let all = (0..4).map(|i| (format!("{name}.{i}"), sorted(i).collect::<Vec<_>>()));
    let changing: Vec<_> = all.filter(|(_, values)| values.iter().any(|value| *value != values[0])).collect();
    assert!(!changing.is_empty(), "{name} draws something");
    changing
}

#[test]
fn draws_of_all_nodes_at_one_cell_are_independent() {
    let all: Vec<_> = DRAWS.iter().map(|(name, draw)| components(name, draw)).collect();
    let mut worst = 0.0_f64;
    for (i, one) in all.iter().enumerate() {
        for ((a, first), (b, second)) in
            one.iter().flat_map(|a| all.iter().take(i).flatten().map(move |b| (a, b)))
        {
            let mut pairs = vec![0.0; BINS * BINS];
            for (x, y) in first.iter().zip(second) {
                pairs[x * BINS + y] += 1.0;
            }
            let off = dependence(&pairs);
            worst = worst.max(off);
            assert!(off < 6.0, "{a} and {b}: {off:.2} standard deviations");
        }
    }
    println!("at most {worst:.2} standard deviations");
}

/// The bases of seeds in the library's texts, with their files: the large numbers where a seed is made.
/// Those of one file that stand side by side are draws of one node.
fn bases() -> Vec<(i64, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("compiler/std");
    let files = std::fs::read_dir(folder).expect("the library is there");
    let mut bases: Vec<(i64, String)> =
        files.flat_map(|entry| bases_of(&entry.expect("readable").path())).collect();
    // The one whose streams begin at 0.
    bases.push((0, "virtual_index".to_owned()));
    bases.sort();
    bases.dedup_by(|(high, two), (low, one)| one == two && *high - *low < OF_A_STREAM);
    bases
}

fn bases_of(file: &Path) -> Vec<(i64, String)> {
    let text = std::fs::read_to_string(file).expect("it is UTF-8");
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let makes_a_seed = |line: &&str| {
        !line.trim_start().starts_with("//") && (line.contains("seed") || line.contains("stream +"))
    };
    let words = text.lines().filter(makes_a_seed).flat_map(|line| line.split(|c: char| !c.is_ascii_digit()));
    let numbers = words.filter_map(|word| word.parse().ok());
    numbers.filter(|number| *number > LEAST_BASE).map(|number| (number, name.to_string())).collect()
}

/// 256 seeds for each of 1,001 streams, of which 64 stamps take three each: no other base is so near.
#[test]
fn the_seeds_of_a_thousand_streams_are_apart() {
    let splat = include_str!("../../compiler/std/splat.tex");
    assert!(splat.contains("+ 256 * stream + 3 * k") && splat.contains("0..per_cell max 64"));
    let bases = bases();
    assert!(bases.len() >= 13, "{bases:?}");
    for pair in bases.windows(2) {
        let [(low, one), (high, two)] = pair else { continue };
        assert!(high - low > OF_A_STREAM * 1001, "{one} and {two}");
    }
    let greatest = bases.last().map_or(0, |(base, _)| *base);
    assert!(greatest + OF_A_STREAM * 1001 < i64::from(i32::MAX), "seeds do not wrap");
}
