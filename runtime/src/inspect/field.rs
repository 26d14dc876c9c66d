//! A picture of one number a texel, and what can be told from it in place.

use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
use rayon::slice::{ParallelSlice, ParallelSliceMut};

/// Numbers row by row.
#[derive(Clone, Debug)]
pub struct Field {
    size: [usize; 2],
    values: Vec<f32>,
}

/// Parts along each side whose means are compared.
const PARTS: usize = 4;

impl Field {
    /// Numbers across and down. What is missing is 0, what is too much is not looked at.
    pub fn new(size: [usize; 2], mut values: Vec<f32>) -> Field {
        values.resize(size[0] * size[1], 0.0);
        Field { size, values }
    }

    /// Numbers across and down.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// The numbers, row by row.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The shorter side.
    pub fn side(&self) -> usize {
        self.size[0].min(self.size[1])
    }

    /// The mean of all numbers.
    pub fn mean(&self) -> f64 {
        self.values.iter().map(|value| f64::from(*value)).sum::<f64>() / self.values.len().max(1) as f64
    }

    /// Less its mean.
    pub fn centred(&self) -> Field {
        let mean = self.mean() as f32;
        Field { size: self.size, values: self.values.iter().map(|value| value - mean).collect() }
    }

    /// Less the mean around each texel, of a Gaussian of that deviation in texels: what is left is finer.
    pub fn fine(&self, deviation: f64) -> Field {
        let smooth = self.blurred(deviation);
        let values = self.values.iter().zip(&smooth.values).map(|(value, mean)| value - mean);
        Field { size: self.size, values: values.collect() }
    }

    /// Means by a Gaussian of that deviation; beyond the borders there is nothing to be weighed.
    pub fn blurred(&self, deviation: f64) -> Field {
        let reach = (3.0 * deviation).ceil().max(0.0) as usize;
        let weight = |i: usize| libm::exp(-0.5 * (i as f64 / deviation.max(1e-6)).powi(2)) as f32;
        let weights: Vec<f32> = (0..=reach).map(weight).collect();
        let [width, height] = self.size;
        let across = along_rows(&self.values, width, &weights);
        let down = along_rows(&transposed(&across, width), height, &weights);
        Field { size: self.size, values: transposed(&down, height) }
    }

    /// The share of the variance that is between the means of sixteen parts, 0 to 1. The method takes
    /// every part of a picture to be like any other.
    pub fn unevenness(&self) -> f64 {
        let [width, height] = self.size;
        let mean = self.mean();
        let (mut between, mut all) = (0.0, 0.0);
        for part in 0..PARTS * PARTS {
            let bounds = |i: usize, side: usize| i * side / PARTS..(i + 1) * side / PARTS;
            let (columns, rows) = (bounds(part % PARTS, width), bounds(part / PARTS, height));
            let texels = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
            let (mut sum, mut count) = (0.0, 0.0);
            for (x, y) in texels {
                let apart = f64::from(self.values[y * width + x]) - mean;
                (sum, count) = (sum + apart, count + 1.0);
                all += apart * apart;
            }
            between += if count > 0.0 { sum * sum / count } else { 0.0 };
        }
        if all > 0.0 { between / all } else { 0.0 }
    }

    /// How much of its slope stands in edges: the mean fourth power of slopes over the square of their
    /// mean square, blurred by a deviation in texels. 2 for a Gaussian field, more where there are lines
    /// or outlines with calm between them.
    pub fn edges(&self, deviation: f64) -> f64 {
        let [width, height] = self.size;
        let smooth = self.blurred(deviation).values;
        let at = |x: usize, y: usize| f64::from(smooth[y * width + x]);
        let (mut squares, mut fourths, mut count) = (0.0, 0.0, 0.0);
        for y in 1..height.saturating_sub(1) {
            for x in 1..width.saturating_sub(1) {
                let slope = (at(x + 1, y) - at(x - 1, y)).powi(2) + (at(x, y + 1) - at(x, y - 1)).powi(2);
                (squares, fourths, count) = (squares + slope, fourths + slope * slope, count + 1.0);
            }
        }
        if squares > 0.0 { fourths * count / (squares * squares) } else { 0.0 }
    }
}

/// Weighted means along rows; the first weight is a number's own.
fn along_rows(values: &[f32], width: usize, weights: &[f32]) -> Vec<f32> {
    let mut means = vec![0.0; values.len()];
    means.par_chunks_mut(width).zip(values.par_chunks(width)).for_each(|(means, row)| {
        for (x, mean) in means.iter_mut().enumerate() {
            let before = row[..x].iter().rev().zip(&weights[1..]);
            let after = row[x..].iter().zip(weights);
            let (sum, whole) = before
                .chain(after)
                .fold((0.0, 0.0), |(sum, whole), (value, weight)| (sum + value * weight, whole + weight));
            *mean = sum / whole;
        }
    });
    means
}

/// Columns as rows.
pub fn transposed<T: Copy + Send + Sync>(values: &[T], width: usize) -> Vec<T> {
    let height = values.len() / width.max(1);
    let columns = (0..width).into_par_iter();
    columns.flat_map_iter(|x| (0..height).map(move |y| values[y * width + x])).collect()
}
