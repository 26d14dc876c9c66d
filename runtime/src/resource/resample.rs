//! Pictures brought to another size: the mean under a triangle two texels wide, of whichever of the
//! two pictures has the larger texels.

use glam::Vec4;

/// From one size to another, borders going on beyond the edges.
pub struct Resampler {
    columns: Vec<Taps>,
    rows: Vec<Taps>,
}

/// The texels that one texel is made of, with their shares, whose sum is 1.
struct Taps {
    first: u32,
    weights: Vec<f32>,
}

impl Resampler {
    /// From texels across and down to others. At one size every texel stays itself.
    pub fn new(from: [u32; 2], to: [u32; 2]) -> Resampler {
        let axis = |i: usize| (0..to[i]).map(|k| Taps::new(from[i], to[i], k)).collect();
        Resampler { columns: axis(0), rows: axis(1) }
    }

    /// A texel of the new picture, from those of the old one.
    pub fn texel(&self, x: u32, y: u32, texel: impl Fn(u32, u32) -> Vec4) -> Vec4 {
        let (columns, rows) = (&self.columns[x as usize], &self.rows[y as usize]);
        rows.sum(|y| columns.sum(|x| texel(x, y)))
    }
}

impl Taps {
    /// For texel `k` of `n`, of a side of `m` texels.
    fn new(m: u32, n: u32, k: u32) -> Taps {
        if m == n {
            return Taps { first: k, weights: vec![1.0] };
        }
        let scale = f64::from(m) / f64::from(n);
        let (centre, reach) = ((f64::from(k) + 0.5) * scale, scale.max(1.0));
        let last = f64::from(m - 1);
        let ends = [centre - reach, centre + reach].map(|end| end.floor().clamp(0.0, last) as u32);
        let weight = |i: u32| (1.0 - (f64::from(i) + 0.5 - centre).abs() / reach).max(0.0);
        let weights: Vec<f64> = (ends[0]..=ends[1]).map(weight).collect();
        let sum: f64 = weights.iter().sum();
        Taps { first: ends[0], weights: weights.iter().map(|weight| (weight / sum) as f32).collect() }
    }

    fn sum(&self, texel: impl Fn(u32) -> Vec4) -> Vec4 {
        let taps = (self.first..).zip(&self.weights);
        taps.fold(Vec4::ZERO, |sum, (at, weight)| sum + texel(at) * *weight)
    }
}

#[cfg(test)]
mod tests {
    use super::Resampler;
    use glam::Vec4;

    #[test]
    fn shares_sum_to_one_and_one_size_changes_nothing() {
        for (from, to) in [(4, 4), (5, 3), (3, 8), (1, 7), (64, 1)] {
            let resampler = Resampler::new([from; 2], [to; 2]);
            for i in 0..to {
                let sum = resampler.texel(i, to - 1 - i, |_, _| Vec4::ONE);
                assert!((sum - Vec4::ONE).abs().max_element() < 1e-6, "{from} {to} {i}: {sum}");
            }
        }
        let same = Resampler::new([4, 4], [4, 4]);
        assert_eq!(same.texel(3, 1, |x, y| Vec4::splat((x * 10 + y) as f32)), Vec4::splat(31.0));
    }

    #[test]
    fn a_slope_stays_one() {
        let half = Resampler::new([16, 16], [8, 8]);
        for x in 1..7 {
            let value = half.texel(x, 4, |x, _| Vec4::splat(x as f32 + 0.5)).x;
            assert!((value - (2.0 * x as f32 + 1.0)).abs() < 1e-5, "{x}: {value}");
        }
    }
}
