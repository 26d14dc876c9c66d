//! Colours for numbers that are none, so that any wire of a program can be looked at.

/// The part of a turn of hue from one integer to the next: the golden angle. Numbers that are near
/// each other then differ by much, and only those far apart by little.
const GOLDEN: u32 = 0x9e37_79b9;

/// The same along the second component of a vector, and backward along the third: a scalar, which
/// stands in all three, still turns by the golden angle. One by the plastic number.
const PLASTIC: u32 = 0xc13f_a9a9;

/// The same along the fourth. One by the plastic number's square.
const FOURTH: u32 = 0x91e1_0da5;

/// The sRGB codes that show an integer or a vector of them, each its own colour as far as there are
/// colours. The hue turns by the golden angle from each integer to the next, along every component;
/// a hash of all components gives saturation and lightness. Fractions are cut off.
pub fn of_integers(components: [f32; 4]) -> [u8; 3] {
    let [x, y, z, w] = components.map(|component| component as i32 as u32);
    let turn = x
        .wrapping_mul(GOLDEN)
        .wrapping_add(y.wrapping_sub(z).wrapping_mul(PLASTIC))
        .wrapping_add(w.wrapping_mul(FOURTH));
    let hash = [x, y, z, w].into_iter().fold(0, |hash: u32, word| mix(hash ^ word));
    let share = |bits: u32| (bits & 0xffff) as f32 / 65535.0;
    hsv(turn as f32 / 4_294_967_296.0, 0.55 + 0.45 * share(hash), 0.65 + 0.35 * share(hash >> 16))
}

/// A bijection of words that spreads every bit (Wellons's "lowbias32").
fn mix(word: u32) -> u32 {
    let word = (word ^ (word >> 16)).wrapping_mul(0x7feb_352d);
    let word = (word ^ (word >> 15)).wrapping_mul(0x846c_a68b);
    (word ^ (word >> 16)).wrapping_add(GOLDEN)
}

/// The sRGB codes of hue (in turns), saturation and value, all 0..1.
fn hsv(hue: f32, saturation: f32, value: f32) -> [u8; 3] {
    [5.0, 3.0, 1.0].map(|offset| {
        let k = (offset + 6.0 * hue) % 6.0;
        let level = value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0);
        (level * 255.0).round() as u8
    })
}

/// What sums of shares and the like are off by at most.
const ROUNDING: f32 = 1.0 / 65_536.0;

/// What shows a component of a vector: itself in 0..=1, its fractional part outside. So a value
/// that leaves the range is seen as a jump, where clamping would hide how far it goes, and a place
/// or a direction shows its periods; what only rounding takes out of the range is its end. What is no
/// number is 0.
pub fn of_component(x: f32) -> f32 {
    match x {
        x if (-ROUNDING..=1.0 + ROUNDING).contains(&x) => x.clamp(0.0, 1.0),
        x if x.is_finite() => (x - x.floor()).min(1.0),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::{of_component, of_integers};
    use std::collections::BTreeSet;

    fn distance(a: [u8; 3], b: [u8; 3]) -> u32 {
        a.into_iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(b))).sum()
    }

    fn scalar(x: i32) -> [u8; 3] {
        of_integers([x as f32, x as f32, x as f32, 1.0])
    }

    #[test]
    fn neighbours_differ_clearly() {
        for x in -3000..3000 {
            let apart = distance(scalar(x), scalar(x + 1));
            assert!(apart >= 120, "{x}: {apart}");
            assert!(distance(scalar(x), scalar(x + 2)) >= 60, "{x}, two apart");
        }
        for x in -40..40 {
            for y in -40..40 {
                let at = |x: i32, y: i32| of_integers([x as f32, y as f32, 0.0, 1.0]);
                let apart = distance(at(x, y), at(x + 1, y)).min(distance(at(x, y), at(x, y + 1)));
                assert!(apart >= 60, "{x}, {y}: {apart}");
            }
        }
    }

    #[test]
    fn each_integer_has_its_own_colour() {
        let colors: BTreeSet<[u8; 3]> = (-500..500).map(scalar).collect();
        assert!(colors.len() >= 998, "{}", colors.len());
        assert_eq!(scalar(7), scalar(7));
        assert_ne!(scalar(-7), scalar(7));
        assert!((-500..500).all(|x| scalar(x).into_iter().max() >= Some(160)), "none is lost in black");
    }

    #[test]
    fn components_fold_back() {
        let cases = [
            (0.0, 0.0),
            (0.25, 0.25),
            (1.0, 1.0),
            (1.25, 0.25),
            (-0.25, 0.75),
            (7.5, 0.5),
            (1.000_000_1, 1.0),
            (-1e-7, 0.0),
        ];
        for (x, shown) in cases {
            assert_eq!(of_component(x), shown, "{x}");
        }
        assert_eq!(of_component(f32::NAN), 0.0);
        assert_eq!(of_component(f32::INFINITY), 0.0);
        assert!((0.0..=1.0).contains(&of_component(-1e-30)));
    }
}
