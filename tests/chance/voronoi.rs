//! `voronoi` against all points of all cells around.

use crate::hash;
use crate::support::Drawing;

/// Pixels along the side of a picture: more than 100,000 in all.
const SIDE: u32 = 320;
/// Cells on each side of a place that brute force looks at.
const AROUND: i32 = 4;

/// A way to measure distances.
type Metric = fn([f32; 3]) -> f32;

const METRICS: [(&str, Metric); 4] = [
    ("euclidean", |v| v.iter().map(|x| x * x).sum::<f32>().sqrt()),
    ("manhattan", |v| v.iter().map(|x| x.abs()).sum()),
    ("chebyshev", |v| v.iter().fold(0.0, |most: f32, x| most.max(x.abs()))),
    ("minkowski", |v| v.iter().map(|x| x.abs().powi(3)).sum::<f32>().cbrt()),
];

/// Where points lie: so many coordinates, points a cell, and how far from the middle.
#[derive(Clone, Copy)]
struct Scatter {
    dimensions: usize,
    per_cell: i32,
    jitter: f32,
}

const SCATTERS: [Scatter; 4] = [
    Scatter { dimensions: 2, per_cell: 1, jitter: 1.0 },
    Scatter { dimensions: 2, per_cell: 3, jitter: 0.6 },
    Scatter { dimensions: 3, per_cell: 1, jitter: 1.0 },
    Scatter { dimensions: 3, per_cell: 2, jitter: 1.0 },
];

impl Scatter {
    /// From a place to all points nearby.
    fn ways(self, p: [f32; 3]) -> Vec<[f32; 3]> {
        let home = p.map(|x| x.floor() as i32);
        let depth = if self.dimensions == 3 { -AROUND..=AROUND } else { 0..=0 };
        let mut ways = Vec::new();
        for z in depth {
            for (y, x) in (-AROUND..=AROUND).flat_map(|y| (-AROUND..=AROUND).map(move |x| (y, x))) {
                let cell = [home[0] + x, home[1] + y, home[2] + z];
                ways.extend((0..self.per_cell).map(|k| self.way(p, cell, k)));
            }
        }
        ways
    }

    fn way(self, p: [f32; 3], cell: [i32; 3], k: i32) -> [f32; 3] {
        let draw = hash(cell, 1_668_246_636 + 256 * k);
        let mut way = [0.0; 3];
        for axis in 0..self.dimensions {
            let place = 0.5 + f64::from(self.jitter * (draw[axis] - 0.5));
            way[axis] = (f64::from(cell[axis]) + place - f64::from(p[axis])) as f32;
        }
        way
    }

    /// Random places, and what `voronoi` says of them.
    fn drawn(self, metric: &str) -> Vec<([f32; 3], [f32; 3])> {
        let places = if self.dimensions == 3 { "random.xyz" } else { "random.xy" };
        let call = format!(
            "voronoi({places} * 40.0 - 20.0, per_cell: {}, jitter: {:?}, metric: {metric})",
            self.per_cell, self.jitter
        );
        let text = |output: &str| {
            format!(
                "texture t(uv: vec2) -> (out: vec3) {{\n    let random = hash(ifloor(uv * {SIDE}.0))\n    let v = {call}\n    out = {output}\n}}\n"
            )
        };
        let places = Drawing::of(&text("random.xyz * 40.0 - 20.0")).cells(SIDE);
        let seen = Drawing::of(&text("vec3(v.f1, v.f2, v.edge)")).cells(SIDE);
        let three = |v: [f32; 4]| [v[0], v[1], v[2]];
        let flat = |[x, y, z]: [f32; 3]| [x, y, if self.dimensions == 3 { z } else { 0.0 }];
        places.into_iter().map(three).map(flat).zip(seen.into_iter().map(three)).collect()
    }
}

/// The two least distances, and the distance of the nearest border where it is asked for.
fn brute(ways: &[[f32; 3]], metric: Metric, is_euclidean: bool) -> [f32; 3] {
    let mut far: Vec<(f32, [f32; 3])> = ways.iter().map(|way| (metric(*way), *way)).collect();
    far.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [f1, f2] = [far[0].0, far[1].0];
    if !is_euclidean {
        return [f1, f2, f2 - f1];
    }
    let nearest = far[0].1;
    let borders = far[1..].iter().map(|(_, way)| {
        let between = [0, 1, 2].map(|i| way[i] - nearest[i]);
        let sum = [0, 1, 2].map(|i| way[i] + nearest[i]);
        let product: f32 = sum.iter().zip(&between).map(|(a, b)| a * b).sum();
        0.5 * product / between.iter().map(|x| x * x).sum::<f32>().sqrt()
    });
    [f1, f2, borders.fold(f32::INFINITY, f32::min)]
}

#[test]
fn voronoi_is_brute_force() {
    for scatter in SCATTERS {
        for (name, metric) in METRICS {
            let drawn = scatter.drawn(name);
            assert!(drawn.len() > 100_000);
            for (p, seen) in drawn {
                let wanted = brute(&scatter.ways(p), metric, name == "euclidean");
                for (seen, wanted) in seen.into_iter().zip(wanted) {
                    let n = scatter.dimensions;
                    assert!((seen - wanted).abs() < 2e-5, "{name} in {n}D at {p:?}: {seen}, not {wanted}");
                }
            }
        }
    }
}

/// The cheaper search misses what it says it may miss, and not much.
#[test]
fn the_near_search_is_seldom_wrong() {
    let text = |search: &str| {
        format!(
            "texture t(uv: vec2) -> (f1: float) {{\n    f1 = voronoi(uv * 64.0, search: {search}).f1\n}}\n"
        )
    };
    let exact = Drawing::of(&text("exact")).cells(512);
    let near = Drawing::of(&text("near")).cells(512);
    let wrong = exact.iter().zip(&near).filter(|(a, b)| (a[0] - b[0]).abs() > 1e-5).count();
    assert!(exact.iter().zip(&near).all(|(a, b)| a[0] <= b[0] + 1e-5), "what is missed is farther away");
    let share = wrong as f64 / exact.len() as f64;
    println!("the near search is wrong in {:.2} % of pixels", share * 100.0);
    assert!(share > 0.0 && share < 0.1, "{share}");
}
