//! How alike a picture is to itself, shifted.

use super::field::{Field, transposed};
use rayon::iter::ParallelIterator;
use rayon::slice::ParallelSliceMut;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use rustfft::num_traits::Zero;

/// The autocorrelation of a picture, normalised: 1 without a shift, 0 where nothing is alike. Each shift
/// is a mean over the texels that both copies cover, so large shifts are as high as small ones.
#[derive(Clone, Debug)]
pub struct Autocorrelation {
    /// The largest shift, across and down.
    reach: [i32; 2],
    /// Shifts from -reach to reach, row by row.
    values: Vec<f32>,
}

impl Autocorrelation {
    /// Of a picture whose mean is 0, for shifts up to half its sides (Wiener & Khinchin: the transform of
    /// the power spectrum). A picture without contrast is not alike to itself.
    pub fn of(field: &Field) -> Autocorrelation {
        let [width, height] = field.size();
        let reach = [width / 2, height / 2];
        // With as much of nothing beside it as shifts may reach, it does not meet itself around.
        let padded = [width + reach[0], height + reach[1]].map(usize::next_power_of_two);
        let mut texels = vec![Complex::zero(); padded[0] * padded[1]];
        for (slots, row) in texels.chunks_exact_mut(padded[0]).zip(field.values().chunks_exact(width)) {
            slots.iter_mut().zip(row).for_each(|(slot, value)| slot.re = f64::from(*value));
        }
        let mut spectrum = transform(texels, padded);
        spectrum.iter_mut().for_each(|wave| *wave = Complex::new(wave.norm_sqr(), 0.0));
        // Transformed forward again: a real, even spectrum makes no difference.
        let products = transform(spectrum, [padded[1], padded[0]]);
        let shared = |x: i32, y: i32| {
            let covered = |side: usize, shift: i32| (side - shift.unsigned_abs() as usize) as f64;
            let at = |shift: i32, side: usize| shift.rem_euclid(side as i32) as usize;
            products[at(y, padded[1]) * padded[0] + at(x, padded[0])].re
                / (covered(width, x) * covered(height, y))
        };
        let variance = shared(0, 0);
        let reach = reach.map(|side| side as i32);
        let shifts = (-reach[1]..=reach[1]).flat_map(|y| (-reach[0]..=reach[0]).map(move |x| (x, y)));
        let value = |(x, y)| if variance > 0.0 { (shared(x, y) / variance) as f32 } else { 0.0 };
        Autocorrelation { reach, values: shifts.map(value).collect() }
    }

    /// The mean of several of one size; the first's size counts.
    pub fn mean(all: &[Autocorrelation]) -> Option<Autocorrelation> {
        let first = all.first()?;
        let value = |i: usize| all.iter().filter_map(|one| one.values.get(i)).sum::<f32>() / all.len() as f32;
        Some(Autocorrelation { reach: first.reach, values: (0..first.values.len()).map(value).collect() })
    }

    /// The largest shift, in texels across and down.
    pub fn reach(&self) -> [i32; 2] {
        self.reach
    }

    /// At a shift; 0 beyond the reach.
    pub fn at(&self, [x, y]: [i32; 2]) -> f64 {
        let [across, down] = self.reach;
        if x.abs() > across || y.abs() > down {
            return 0.0;
        }
        let at = (y + down) as usize * (2 * across + 1) as usize + (x + across) as usize;
        self.values.get(at).copied().map_or(0.0, f64::from)
    }
}

/// The transform of rows and then of columns, which come out as rows.
fn transform(mut texels: Vec<Complex<f64>>, [width, height]: [usize; 2]) -> Vec<Complex<f64>> {
    rows(&mut texels, width);
    let mut columns = transposed(&texels, width);
    rows(&mut columns, height);
    columns
}

/// Each row by itself, so any number of threads gives the same.
fn rows(texels: &mut [Complex<f64>], width: usize) {
    let plan = FftPlanner::new().plan_fft_forward(width);
    texels.par_chunks_exact_mut(width).for_each(|row| plan.process(row));
}

#[cfg(test)]
mod tests {
    use super::Autocorrelation;
    use crate::inspect::Field;
    use crate::resource::exemplar::scatter;

    #[test]
    fn shifts_are_means_of_products() {
        let [width, height] = [13, 9];
        let chance = |i: u32| (scatter(i) >> 16) as f32 / 65536.0;
        let field = Field::new([width, height], (0..117).map(chance).collect()).centred();
        let found = Autocorrelation::of(&field);
        assert_eq!(found.reach(), [6, 4]);
        let mean = |x: i32, y: i32| {
            let inside = |at: i32, side: usize| (0..side as i32).contains(&at);
            let at = |x: i32, y: i32| f64::from(field.values()[y as usize * width + x as usize]);
            let places = (0..9).flat_map(|down| (0..13).map(move |across| (across, down)));
            let both = places.filter(|(across, down)| inside(across + x, width) && inside(down + y, height));
            let products: Vec<f64> =
                both.map(|(across, down)| at(across, down) * at(across + x, down + y)).collect();
            products.iter().sum::<f64>() / products.len() as f64
        };
        for [x, y] in [[0, 0], [1, 0], [0, 1], [-1, 2], [6, 4], [-6, 4], [5, -4]] {
            let expected = mean(x, y) / mean(0, 0);
            assert!((found.at([x, y]) - expected).abs() < 1e-6, "({x}, {y}): {expected}");
        }
        assert_eq!(found.at([7, 0]), 0.0);
    }
}
