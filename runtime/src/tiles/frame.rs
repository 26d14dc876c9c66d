//! The border that all tiles of a family share.
//!
//! Where four tiles meet, their borders form a plus. It is taken from one place of the photograph,
//! so it is a photograph across every border. The plus repeats with the tiles: each arm closes on
//! itself half a tile from the crossing, by a cut across its overlapping ends.
//!
//! ```text
//!         │▒│          ▒  overlap: head and tail of an arm, cut
//!     ────┼─┼────      a tile sees the plus from inside: half an arm on each side
//!     ▒   │ │   ▒
//!     ────┼─┼────
//!         │▒│
//! ```

use super::bitmap::{Bitmap, Texel};
use super::cut::{self, Pull};
use super::levels::Levels;
use super::random::Random;
use super::seam;
use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// The texels of a tile, and what of it may belong to the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Geometry {
    /// Texels along a tile.
    pub side: usize,
    /// Texels from a border to the next one like it: facing edges are equal.
    pub period: usize,
    /// Texels from the edge within which a tile may be cut into its frame.
    pub band: usize,
    /// Texels along which an arm overlaps itself.
    overlap: usize,
}

impl Geometry {
    /// Of tiles of this side, at least 16.
    pub fn new(side: u32) -> Geometry {
        let side = side.max(16) as usize;
        let period = side - 1;
        Geometry { side, period, band: (side / 5).min(40), overlap: (period / 4).min(64) }
    }

    /// The texels that a photograph needs along each side.
    pub fn needed(&self) -> u32 {
        (self.period + self.overlap + 1) as u32
    }

    /// Texels from the end of an arm to the crossing.
    fn half(&self) -> usize {
        self.period / 2
    }

    /// Texels from the edge that are the frame's in every tile: a photograph goes on across them.
    pub fn edge(&self) -> usize {
        (self.band / 4).clamp(1, 3)
    }

    /// Texels from the nearest edge.
    pub fn depth(&self, x: usize, y: usize) -> usize {
        let to_edge = |at: usize| at.min(self.period - at.min(self.period));
        to_edge(x).min(to_edge(y))
    }
}

/// Places that are tried for a plus.
const CANDIDATES: usize = 192;

/// How much a level by which a place stands out counts, in costs of a seam.
const CALM: f32 = 0.3;

/// The frame of a photograph: a tile whose texels up to the band's depth are those of the best of
/// many random plus shapes; what lies deeper is of no use. The photograph is as large as is needed.
pub fn frame(photo: &Bitmap, geometry: Geometry, random: &mut Random) -> Bitmap {
    let [width, height] = photo.size();
    let mut place = || {
        let offset = [width, height].map(|side| random.below(side.saturating_sub(geometry.needed()) + 1));
        offset.map(|offset| offset as usize + geometry.half())
    };
    let places: Vec<[usize; 2]> = (0..CANDIDATES).map(|_| place()).collect();
    let levels = Levels::new(photo);
    let plus = |crossing: [usize; 2]| Plus::new(photo, geometry, crossing);
    let costs: Vec<(u64, usize)> = (0..places.len())
        .into_par_iter()
        .map(|i| {
            let plus = plus(places[i]);
            ((plus.cost() + CALM * plus.stands_out(&levels)) as u64, i)
        })
        .collect();
    let best = costs.into_iter().min().map_or([0; 2], |(_, i)| places[i]);
    plus(best).tile()
}

/// A plus of the photograph, its arms closed.
struct Plus<'a> {
    photo: &'a Bitmap,
    geometry: Geometry,
    crossing: [usize; 2],
    /// The arm down the photograph, then the arm across it.
    arms: [cut::Cut; 2],
}

impl<'a> Plus<'a> {
    fn new(photo: &'a Bitmap, geometry: Geometry, crossing: [usize; 2]) -> Plus<'a> {
        let close = |axis: usize| {
            let width = 2 * geometry.band + 1;
            let both = |node: usize| {
                let [along, across] = [node / width, node % width];
                [along + geometry.period, along]
                    .map(|along| arm(photo, geometry, crossing, axis, [along, across]))
            };
            let link = |a: usize, b: usize| {
                let ([tail, head], [next_tail, next_head]) = (both(a), both(b));
                seam::cost([tail, next_tail], [head, next_head])
            };
            cut::minimum([width, geometry.overlap], link, |node| match node / width {
                0 => Pull::FIRST,
                along if along + 1 == geometry.overlap => Pull::SECOND,
                _ => Pull::default(),
            })
        };
        Plus { photo, geometry, crossing, arms: [close(0), close(1)] }
    }

    /// What both cuts cost for each texel across.
    fn cost(&self) -> f32 {
        let width = 2 * self.geometry.band + 1;
        self.arms.iter().map(|arm| arm.cost as f32).sum::<f32>() / width as f32
    }

    /// How much pieces of the arms stand out, in the mean.
    fn stands_out(&self, levels: &Levels) -> f32 {
        let Geometry { period, overlap, band, .. } = self.geometry;
        let piece = (band / 4).max(2) as i64;
        let steps = (period + overlap) as i64 / piece;
        let [x, y] = self.crossing.map(|at| at as i64);
        let start = [x, y].map(|at| at - self.geometry.half() as i64);
        let sum: f32 = (0..steps)
            .map(|step| {
                let down = levels.stands_out([x - piece / 2, start[1] + step * piece], [piece, piece]);
                down + levels.stands_out([start[0] + step * piece, y - piece / 2], [piece, piece])
            })
            .sum();
        sum / steps.max(1) as f32
    }

    /// The plus as a tile sees it.
    fn tile(&self) -> Bitmap {
        let Geometry { side, period, band, .. } = self.geometry;
        // Across an arm: its right half is seen at the left edge.
        let across = |at: usize| match at {
            at if at <= band => Some(band + at),
            at if at + band >= period => Some(at + band - period),
            _ => None,
        };
        Bitmap::new([side as u32, side as u32], |x, y| {
            let (x, y) = (x as usize, y as usize);
            match (across(x), across(y)) {
                (Some(across), _) => self.closed(0, y, across),
                (None, Some(across)) => self.closed(1, x, across),
                (None, None) => [0; 4],
            }
        })
    }

    /// A texel of a closed arm, `from` texels from the crossing.
    fn closed(&self, axis: usize, from: usize, across: usize) -> Texel {
        let Geometry { period, band, overlap, .. } = self.geometry;
        let along = (from + self.geometry.half()) % period;
        let texel = |along: usize| arm(self.photo, self.geometry, self.crossing, axis, [along, across]);
        if along >= overlap {
            return texel(along);
        }
        let share = self.arms[axis].share([2 * band + 1, overlap], [across, along]);
        seam::fade(texel(along + period), texel(along), share)
    }
}

/// A texel of an arm before it is closed: down the photograph for axis 0, across it for axis 1.
fn arm(
    photo: &Bitmap,
    geometry: Geometry,
    [x, y]: [usize; 2],
    axis: usize,
    [along, across]: [usize; 2],
) -> Texel {
    let place = match axis {
        0 => [x + across - geometry.band, y + along - geometry.half()],
        _ => [x + along - geometry.half(), y + across - geometry.band],
    };
    photo.texel(place[0] as u32, place[1] as u32)
}
