//! The Gaussian distribution that exemplars have: mean ½, deviation 1/6, cut to 0..1 and made whole
//! again, so that every number has a rank (Burley, On Histogram-Preserving Blending for Randomized
//! Texture Tiling, JCGT 8(4), 2019).

/// The deviation, of which three fit on each side (§1.3.1).
pub const DEVIATION: f64 = 1.0 / 6.0;

/// The share of numbers below g, for g in 0..1.
pub fn share_below(g: f64) -> f64 {
    let (first, last) = (cumulative(-3.0), cumulative(3.0));
    (cumulative((g - 0.5) / DEVIATION) - first) / (last - first)
}

/// The share of a Gaussian distribution of mean 0 and deviation 1 below x.
pub fn cumulative(x: f64) -> f64 {
    0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2)
}

/// The way back from [`share_below`], by a table.
pub struct Quantiles {
    /// The shares below numbers at even steps from 0 to 1.
    shares: Vec<f64>,
}

impl Quantiles {
    /// Makes the table, of so many steps.
    pub fn new(steps: usize) -> Quantiles {
        Quantiles { shares: (0..=steps).map(|step| share_below(step as f64 / steps as f64)).collect() }
    }

    /// The number in 0..1 that a share in 0..1 lies below; within a step shares are taken to be even.
    pub fn number(&self, share: f64) -> f64 {
        let steps = self.shares.len() - 1;
        let next = self.shares.partition_point(|below| *below <= share).clamp(1, steps);
        let [low, high] = [self.shares[next - 1], self.shares[next]];
        (next as f64 - 1.0 + ((share - low) / (high - low)).clamp(0.0, 1.0)) / steps as f64
    }
}

#[cfg(test)]
mod tests {
    use super::{Quantiles, share_below};

    #[test]
    fn the_way_back_from_shares_leads_back() {
        let quantiles = Quantiles::new(1 << 14);
        for i in 0..=1000 {
            let number = f64::from(i) / 1000.0;
            let found = quantiles.number(share_below(number));
            assert!((found - number).abs() < 1e-6, "{found} for {number}");
        }
    }

    #[test]
    fn all_numbers_lie_in_0_to_1() {
        assert_eq!(share_below(0.0), 0.0);
        assert_eq!(share_below(0.5), 0.5);
        assert_eq!(share_below(1.0), 1.0);
        // One deviation: 68.27 % of all, of which 0.27 % are cut off.
        let within = share_below(2.0 / 3.0) - share_below(1.0 / 3.0);
        assert!((within - 0.682_689_5 / 0.997_300_2).abs() < 1e-6, "{within}");
    }
}
