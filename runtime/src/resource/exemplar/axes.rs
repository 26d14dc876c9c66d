//! The principal axes of a picture's colours: along them channels are not correlated (§1.4).

use super::light::{BATCH, Light, MAX_CHANNELS, NONE, Numbers};
use nalgebra::{Matrix3, SymmetricEigen};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// Axes of the space of numbers, and where the picture lies along them.
pub struct Axes {
    /// How many there are.
    pub channels: usize,
    /// Unit vectors at right angles, those of the most variance first.
    pub directions: [[f32; MAX_CHANNELS]; MAX_CHANNELS],
    /// The mean of all texels.
    pub mean: [f64; MAX_CHANNELS],
    /// The variance along each axis.
    pub variances: [f64; MAX_CHANNELS],
}

/// Sums over texels: of each number, and of the products xx, xy, xz, yy, yz, zz.
#[derive(Clone, Copy, Default)]
struct Moments {
    first: [f64; 3],
    second: [f64; 6],
}

/// Which numbers the products are of.
const PAIRS: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

impl Axes {
    /// The eigenvectors of the covariance of all texels.
    pub fn of(light: &Light<'_>) -> Axes {
        let moments = Moments::of(light);
        let texels = light.texels() as f64;
        let mean = moments.first.map(|sum| sum / texels);
        let mut covariance = Matrix3::zeros();
        for ((i, j), sum) in PAIRS.into_iter().zip(moments.second) {
            let shared = sum / texels - mean[i] * mean[j];
            covariance[(i, j)] = shared;
            covariance[(j, i)] = shared;
        }
        let mut variances = [covariance[(0, 0)], 0.0, 0.0];
        let mut directions = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        // A line needs none, and what a plane lacks is its own axis.
        if light.channels > 1 {
            let eigen = SymmetricEigen::new(covariance);
            let mut order = [0, 1, 2];
            order.sort_by(|i, j| eigen.eigenvalues[*j].total_cmp(&eigen.eigenvalues[*i]));
            for ((direction, variance), i) in directions.iter_mut().zip(&mut variances).zip(order) {
                *variance = eigen.eigenvalues[i];
                let vector = eigen.eigenvectors.column(i);
                // Of the two senses the one whose longest component is positive.
                let longest =
                    vector.iter().fold(0.0_f64, |most, x| if x.abs() > most.abs() { *x } else { most });
                let sense = if longest < 0.0 { -1.0 } else { 1.0 };
                *direction = [0, 1, 2].map(|k| (vector[k] * sense) as f32);
            }
        }
        Axes { channels: light.channels, directions, mean, variances }
    }

    /// Where numbers lie along an axis.
    pub fn along(&self, axis: usize, numbers: &Numbers, places: &mut [f32; BATCH]) {
        let [x, y, z] = self.directions[axis];
        match self.channels {
            1 => *places = numbers[0],
            2 => (0..BATCH).for_each(|i| places[i] = numbers[0][i] * x + numbers[1][i] * y),
            _ => {
                (0..BATCH).for_each(|i| places[i] = numbers[0][i] * x + numbers[1][i] * y + numbers[2][i] * z)
            }
        }
    }

    /// Where the numbers of one texel of a batch lie along an axis.
    pub fn place(&self, axis: usize, numbers: &Numbers, i: usize) -> f32 {
        let [x, y, z] = self.directions[axis];
        match self.channels {
            1 => numbers[0][i],
            2 => numbers[0][i] * x + numbers[1][i] * y,
            _ => numbers[0][i] * x + numbers[1][i] * y + numbers[2][i] * z,
        }
    }

    /// The mean along an axis.
    pub fn mean_along(&self, axis: usize) -> f64 {
        let direction = self.directions[axis].map(f64::from);
        direction.iter().zip(self.mean).map(|(along, mean)| along * mean).sum()
    }
}

impl Moments {
    /// Rows are summed apart, and then one after the other: the same for any number of threads.
    fn of(light: &Light<'_>) -> Moments {
        let rows: Vec<Moments> =
            (0..light.size[1] as usize).into_par_iter().map(|y| Moments::of_row(light, y)).collect();
        rows.iter().fold(Moments::default(), |sum, row| sum.plus(row))
    }

    fn of_row(light: &Light<'_>, y: usize) -> Moments {
        let width = light.size[0] as usize;
        let mut numbers = NONE;
        let mut sum = Moments::default();
        for first in (0..width).step_by(BATCH) {
            let count = BATCH.min(width - first);
            light.read(y * width + first, count, &mut numbers);
            numbers.iter_mut().for_each(|channel| channel[count..].fill(0.0));
            let total = |lanes: [f32; 8]| lanes.iter().map(|lane| f64::from(*lane)).sum::<f64>();
            let first = [0, 1, 2].map(|i| {
                let chunks = numbers[i].as_chunks::<8>().0.iter();
                total(chunks.fold([0.0; 8], |sum, part| std::array::from_fn(|lane| sum[lane] + part[lane])))
            });
            let second =
                PAIRS.map(|(i, j)| {
                    let chunks = numbers[i].as_chunks::<8>().0.iter().zip(numbers[j].as_chunks::<8>().0);
                    total(chunks.fold([0.0; 8], |sum, (a, b)| {
                        std::array::from_fn(|lane| sum[lane] + a[lane] * b[lane])
                    }))
                });
            sum = sum.plus(&Moments { first, second });
        }
        sum
    }

    fn plus(self, other: &Moments) -> Moments {
        Moments {
            first: std::array::from_fn(|i| self.first[i] + other.first[i]),
            second: std::array::from_fn(|i| self.second[i] + other.second[i]),
        }
    }
}
