//! Whether a picture wraps.

use super::light::{BATCH, Light, MAX_CHANNELS, NONE};

/// How many times the mean step between neighbours the step across the borders may be.
pub const SEAM: f64 = 1.6;

/// Whether opposite borders differ more than neighbours do, along any axis.
pub fn differ(light: &Light<'_>, slices: u32) -> bool {
    steps(light, slices).iter().any(|[inside, across]| *across > SEAM * inside)
}

/// Across, down and through so many slices, one below another: the mean difference of neighbours, and
/// that of the first texel from the last. 0 where there is one only.
pub fn steps(light: &Light<'_>, slices: u32) -> [[f64; 2]; 3] {
    let [width, rows] = light.size.map(|side| side as usize);
    let depth = slices as usize;
    let height = rows / depth;
    let row = |z: usize, y: usize| read(light, (z * height + y) * width, width);
    let mut sums = [[0.0; 2]; 3];
    for z in 0..depth {
        let (first, mut above) = (row(z, 0), row(z, 0));
        for y in 0..height {
            let texels = row(z, y);
            sums[0][0] += texels.windows(2).map(|pair| difference(&pair[0], &pair[1])).sum::<f64>();
            sums[0][1] += difference(&texels[0], &texels[width - 1]);
            if y > 0 {
                sums[1][0] += apart(&above, &texels);
            }
            if z > 0 {
                sums[2][0] += apart(&row(z - 1, y), &texels);
            }
            if z > 0 && z == depth - 1 {
                sums[2][1] += apart(&row(0, y), &texels);
            }
            above = texels;
        }
        sums[1][1] += apart(&first, &above);
    }
    let mean = |sum: f64, count: usize| if count == 0 { 0.0 } else { sum / count as f64 };
    [
        [mean(sums[0][0], (width - 1) * rows), mean(sums[0][1], rows)],
        [mean(sums[1][0], (height - 1) * width * depth), mean(sums[1][1], width * depth)],
        [mean(sums[2][0], (depth - 1) * width * height), mean(sums[2][1], width * height)],
    ]
}

fn apart(one: &[[f32; MAX_CHANNELS]], other: &[[f32; MAX_CHANNELS]]) -> f64 {
    one.iter().zip(other).map(|(a, b)| difference(a, b)).sum()
}

fn difference(one: &[f32; MAX_CHANNELS], other: &[f32; MAX_CHANNELS]) -> f64 {
    one.iter().zip(other).map(|(a, b)| f64::from((a - b).abs())).sum()
}

/// The numbers of a row of texels.
fn read(light: &Light<'_>, first: usize, count: usize) -> Vec<[f32; MAX_CHANNELS]> {
    let mut numbers = NONE;
    let mut texels = Vec::with_capacity(count);
    for start in (0..count).step_by(BATCH) {
        let length = BATCH.min(count - start);
        light.read(first + start, length, &mut numbers);
        texels.extend((0..length).map(|i| [0, 1, 2].map(|channel| numbers[channel][i])));
    }
    texels
}
