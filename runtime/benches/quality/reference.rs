//! The reference: the finest level sampled many times in each pixel, and averaged.

use crate::Outcome;
use crate::case::{Case, loaded};
use texgraph_compiler::manifest::Gradients;
use texgraph_runtime::cpu;
use texgraph_runtime::render::Request;

/// A supersampled picture.
pub struct Reference {
    /// Linear colour, row by row: the mean over each pixel.
    pub pixels: Vec<[f32; 3]>,
    /// Means over two halves of the samples, which lie between each other like the two colours of a
    /// chess board.
    pub halves: [Vec<[f32; 3]>; 2],
}

/// Draws a case as many times as a pixel has strata, each time moved into another. Without gradients
/// every sample is of the finest level and nothing fades.
pub fn draw(graph: &str, case: Case) -> Outcome<Reference> {
    let made = loaded(graph, "once", case, Gradients::None)?;
    let mut scene = cpu::Scene::new(&made.program, &made.tables, 0)?;
    let count = case.samples();
    let mut sums = [(); 2].map(|()| vec![[0.0; 3]; (case.size()[0] * case.size()[1]) as usize]);
    for (i, j) in (0..count).flat_map(|j| (0..count).map(move |i| (i, j))) {
        let picture = scene.render(&moved(case, i, j), &|_| {})?;
        for (sum, pixel) in sums[((i + j) % 2) as usize].iter_mut().zip(&picture.pixels) {
            for (sum, light) in sum.iter_mut().zip(pixel) {
                *sum += f64::from(*light);
            }
        }
    }
    let half = f64::from(count * count) / 2.0;
    let halves = sums.map(|sum| sum.into_iter().map(|sum| sum.map(|x| (x / half) as f32)).collect());
    let [a, b]: &[Vec<[f32; 3]>; 2] = &halves;
    let both = |(a, b): (&[f32; 3], &[f32; 3])| [0, 1, 2].map(|i| (a[i] + b[i]) / 2.0);
    Ok(Reference { pixels: a.iter().zip(b).map(both).collect(), halves })
}

/// The request moved to a sample of each pixel: the middle of a stratum, or by chance in it where
/// there are many.
fn moved(case: Case, i: u32, j: u32) -> Request {
    let request = case.request();
    let [x0, y0, x1, y1] = request.region;
    let [jitter_x, jitter_y] = if case.is_far() { jitter(i, j) } else { [0.5, 0.5] };
    let count = f64::from(case.samples());
    let right = ((f64::from(i) + jitter_x) / count - 0.5) * (x1 - x0) / f64::from(request.size[0]);
    let down = ((f64::from(j) + jitter_y) / count - 0.5) * (y1 - y0) / f64::from(request.size[1]);
    Request { region: [x0 + right, y0 + down, x1 + right, y1 + down], ..request }
}

/// Two numbers in [0, 1) that only depend on the stratum.
fn jitter(i: u32, j: u32) -> [f64; 2] {
    [1, 2].map(|n: u32| {
        let word = (i * 64 + j).wrapping_mul(2_654_435_761).wrapping_add(n.wrapping_mul(0x9e37_79b9));
        let word = (word ^ (word >> 15)).wrapping_mul(0x2c1b_3c6d);
        let word = (word ^ (word >> 12)).wrapping_mul(0x297a_2d39);
        f64::from(word ^ (word >> 15)) / f64::from(u32::MAX)
    })
}
