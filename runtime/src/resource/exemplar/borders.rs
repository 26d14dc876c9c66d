//! Whether a picture wraps.

use super::light::{BATCH, Light, MAX_CHANNELS, NONE};

/// How many times the mean step between neighbours the step across the borders may be.
pub const SEAM: f64 = 1.6;

/// Whether opposite borders differ more than neighbours do, across or down.
pub fn differ(light: &Light<'_>) -> bool {
    steps(light).iter().any(|[inside, across]| *across > SEAM * inside)
}

/// Along each axis the mean difference of neighbours, and that of the first texel from the last.
pub fn steps(light: &Light<'_>) -> [[f64; 2]; 2] {
    let [width, height] = light.size.map(|side| side as usize);
    let row = |y: usize| read(light, y * width, width);
    let (mut along, mut around) = (0.0, 0.0);
    let mut down = 0.0;
    let (first, mut above) = (row(0), row(0));
    for y in 0..height {
        let texels = row(y);
        along += texels.windows(2).map(|pair| difference(&pair[0], &pair[1])).sum::<f64>();
        around += difference(&texels[0], &texels[width - 1]);
        if y > 0 {
            down += apart(&above, &texels);
        }
        above = texels;
    }
    let mean = |sum: f64, count: usize| if count == 0 { 0.0 } else { sum / count as f64 };
    [
        [mean(along, (width - 1) * height), mean(around, height)],
        [mean(down, (height - 1) * width), mean(apart(&first, &above), width)],
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
