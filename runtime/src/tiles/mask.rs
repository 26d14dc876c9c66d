//! Where one family ends and the next begins inside a transition tile.
//!
//! Between the corners the codes are interpolated, and noise moves the border where that is ½. The
//! noise repeats with the tile, so what an edge shows depends on its two codes alone, and any two
//! tiles that share them fit.

use super::random;

/// Texels across which one family fades into the next, where nothing disturbs the border.
const SOFT: f32 = 4.0;

/// How far noise and pictures together may disturb the interpolated codes: less than ½, so that
/// between equal corners nothing else appears.
const MOST: f32 = 0.45;

/// Noise cells along a tile, and how far each octave may disturb.
const OCTAVES: [(u32, f32); 4] = [(3, 0.26), (6, 0.18), (12, 0.11), (24, 0.07)];

/// The borders of all tiles of one side.
pub struct Mask {
    period: u32,
    most: f32,
    /// The noise of a tile, without the edges that repeat.
    noise: Vec<f32>,
}

impl Mask {
    /// Draws the noise.
    pub fn new(side: u32, seed: u32) -> Mask {
        let period = side.max(2) - 1;
        let noise = |x: u32, y: u32| -> f32 {
            let octave = |(cells, most): (u32, f32)| most * octave([x, y], period, cells, seed);
            OCTAVES.into_iter().map(octave).sum()
        };
        let texels = (0..period).flat_map(|y| (0..period).map(move |x| (x, y)));
        Mask {
            period,
            // A little less than what is allowed: sums of floats are not exact.
            most: (MOST.min(0.5 - SOFT / (2.0 * period as f32)) - 1e-4).max(0.0),
            noise: texels.map(|(x, y)| noise(x, y)).collect(),
        }
    }

    /// The share of family 1 in a texel, 0..1, where `codes` are 0 or 1 at the corners (c00, c10, c01,
    /// c11). `detail` is what the pictures add: above 0 where family 1 lies on top.
    pub fn share(&self, codes: [u32; 4], x: u32, y: u32, detail: f32) -> f32 {
        let [c00, c10, c01, c11] = codes.map(|code| code as f32);
        let [u, v] = [x, y].map(|at| at as f32 / self.period as f32);
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let plain = mix(mix(c00, c10, u), mix(c01, c11, u), v);
        let at = (y % self.period) * self.period + x % self.period;
        let noise = self.noise.get(at as usize).copied().unwrap_or(0.0);
        let disturbed = plain + (noise + detail).clamp(-self.most, self.most);
        (0.5 + (disturbed - 0.5) * self.period as f32 / SOFT).clamp(0.0, 1.0)
    }
}

/// Value noise of `cells` cells a period, −1..1, smooth.
fn octave(place: [u32; 2], period: u32, cells: u32, seed: u32) -> f32 {
    let at = place.map(|at| at as f32 * cells as f32 / period as f32);
    let cell = at.map(|at| at.floor() as u32);
    let [u, v] = [0, 1].map(|axis| {
        let t = at[axis] - cell[axis] as f32;
        t * t * (3.0 - 2.0 * t)
    });
    let value = |x: u32, y: u32| {
        let word = random::at([(cell[0] + x) % cells, (cell[1] + y) % cells], seed ^ cells)[0];
        word as f32 / u32::MAX as f32 * 2.0 - 1.0
    };
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    mix(mix(value(0, 0), value(1, 0), u), mix(value(0, 1), value(1, 1), u), v)
}

#[cfg(test)]
mod tests {
    use super::Mask;
    use crate::tiles::Corners;

    const SIDE: u32 = 16;

    fn column(mask: &Mask, index: u32, x: u32) -> Vec<f32> {
        (0..SIDE).map(|y| mask.share(Corners::of(index, 2).0, x, y, 0.1)).collect()
    }

    #[test]
    fn an_edge_depends_on_its_codes_alone() {
        let mask = Mask::new(SIDE, 5);
        for (a, b) in (0..16).flat_map(|a| (0..16).map(move |b| (a, b))) {
            let fits = Corners::of(a, 2).left_right()[1] == Corners::of(b, 2).left_right()[0];
            assert_eq!(column(&mask, a, SIDE - 1) == column(&mask, b, 0), fits, "{a} beside {b}");
        }
    }

    #[test]
    fn plain_edges_are_plain_however_much_is_disturbed() {
        let mask = Mask::new(SIDE, 5);
        for detail in [-9.0, 0.0, 9.0] {
            assert!((0..SIDE).all(|y| mask.share([0, 1, 0, 1], 0, y, detail) == 0.0));
            assert!((0..SIDE).all(|y| mask.share([0, 1, 0, 1], SIDE - 1, y, detail) == 1.0));
        }
    }
}
