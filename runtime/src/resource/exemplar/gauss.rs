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

#[cfg(test)]
mod tests {
    use super::share_below;

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
