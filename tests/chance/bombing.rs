//! `bomb` against a compositor that draws every stamp of every cell around, the lowest first.

use crate::hash;
use crate::support::Drawing;

const CELLS: f32 = 8.0;
const SIDE: u32 = 200;
/// Cells on each side of a place whose stamps are drawn.
const AROUND: i32 = 3;

/// A disc, as a compositor sees it.
struct Stamp {
    priority: f32,
    color: [f32; 3],
    cover: f32,
}

/// What a texture says: stamps a cell, and the least and greatest size.
struct Bombing {
    per_cell: i32,
    scale: [f32; 2],
}

impl Bombing {
    fn text(&self) -> String {
        format!(
            "node disc(at: vec2, rnd: vec4) -> (color: color) {{\n    color = vec4(rnd.rgb, 1.0) * coverage(0.5 - length(at - 0.5))\n}}\n\ntexture t(uv: vec2) -> (color: color) {{\n    color = bomb(uv * {CELLS:?}, disc, per_cell: {}, scale: vec2({:?}, {:?}), round: true)\n}}\n",
            self.per_cell, self.scale[0], self.scale[1],
        )
    }

    /// Stamp `k` of a cell at a place, if any of it is seen there.
    fn stamp(&self, p: [f32; 2], cell: [i32; 2], k: i32) -> Option<Stamp> {
        let cell = [cell[0], cell[1], 0];
        let seed = 1_651_469_668 + 6 * k;
        let draw = hash(cell, seed);
        let away = [0, 1].map(|i| p[i] - cell[i] as f32 - draw[i]);
        let part = hash(cell, seed + 3)[0];
        let size = self.scale[0] * (1.0 - part) + self.scale[1] * part;
        let length = (away[0] * away[0] + away[1] * away[1]).sqrt();
        let far = length / size;
        // A pixel's step along an axis changes the distance by the direction's share of it.
        let step = CELLS / SIDE as f32 / size;
        let steepest = away.map(|d| (d / length).abs() * step).into_iter().fold(0.0, f32::max);
        let disc = ((0.5 - far) / steepest.max(1e-6) + 0.5).clamp(0.0, 1.0);
        // Beyond its reach no cell looks for it.
        let reach = 0.5 * self.scale[1];
        let most = away.map(f32::abs).into_iter().fold(0.0, f32::max);
        let [red, green, blue, _] = hash(cell, seed + 4);
        let cover = disc * ((reach - most) / (CELLS / SIDE as f32)).clamp(0.0, 1.0);
        (cover > 0.0).then_some(Stamp { priority: draw[3], color: [red, green, blue], cover })
    }

    /// All stamps over one another.
    fn color(&self, p: [f32; 2]) -> [f32; 4] {
        let home = p.map(|x| x.floor() as i32);
        let mut stamps = Vec::new();
        for (y, x) in (-AROUND..=AROUND).flat_map(|y| (-AROUND..=AROUND).map(move |x| (y, x))) {
            let cell = [home[0] + x, home[1] + y];
            stamps.extend((0..self.per_cell).filter_map(|k| self.stamp(p, cell, k)));
        }
        stamps.sort_by(|a, b| a.priority.total_cmp(&b.priority));
        stamps.iter().fold([0.0; 4], |below, stamp| {
            let over = |i: usize, top: f32| top * stamp.cover + below[i] * (1.0 - stamp.cover);
            let [red, green, blue] = stamp.color;
            [over(0, red), over(1, green), over(2, blue), over(3, 1.0)]
        })
    }
}

#[test]
fn bombing_is_brute_force() {
    let cases = [
        Bombing { per_cell: 1, scale: [1.0, 1.0] },
        Bombing { per_cell: 3, scale: [0.3, 1.0] },
        Bombing { per_cell: 4, scale: [0.5, 1.9] },
    ];
    for case in cases {
        let seen = Drawing::of(&case.text()).cells(SIDE);
        let mut covered = 0;
        for (i, pixel) in seen.into_iter().enumerate() {
            let place = [i as u32 % SIDE, i as u32 / SIDE].map(|x| (x as f32 + 0.5) / SIDE as f32 * CELLS);
            let wanted = case.color(place);
            covered += usize::from(wanted[3] > 0.5);
            for (seen, wanted) in pixel.into_iter().zip(wanted) {
                // It stops at an alpha of 0.996.
                assert!(
                    (seen - wanted).abs() < 0.0045,
                    "{} a cell at {place:?}: {seen}, not {wanted}",
                    case.per_cell
                );
            }
        }
        assert!(covered > (SIDE * SIDE / 4) as usize, "{covered}");
    }
}

/// How many stamps are drawn a pixel: each adds 1 to what lies below an alpha that is 0 or 1.
fn drawn(per_cell: i32, alpha: &str) -> f32 {
    let text = format!(
        "texture t(uv: vec2) -> (color: color) {{\n    color = bomb(uv * {CELLS:?}, |at, rnd| vec4(1.0, 0.0, 0.0, {alpha}), per_cell: {per_cell}, round: true)\n}}\n"
    );
    let seen = Drawing::of(&text).cells(SIDE);
    seen.iter().map(|pixel| pixel[0]).sum::<f32>() / seen.len() as f32
}

#[test]
fn what_is_covered_is_not_drawn() {
    for per_cell in [1, 2, 4] {
        let [disc, clear] =
            ["if length(at - 0.5) < 0.5 { 1.0 } else { 0.0 }", "0.0"].map(|a| drawn(per_cell, a));
        println!(
            "{per_cell} a cell: {disc:.2} of {clear:.2} stamps in reach are drawn, of {} at most",
            4 * per_cell
        );
        assert!(clear <= 4.0 * per_cell as f32 && disc < 0.95 * clear, "{disc} of {clear}");
    }
}
