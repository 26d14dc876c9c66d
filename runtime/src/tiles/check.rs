//! How well the tiles of a sheet fit: every pair of edges that may face each other, compared.
//!
//! Texels are compared as they look: sRGB codes times alpha, and alpha, in levels of 8 bits.

use super::bitmap::{Bitmap, Texel};
use super::corners::Corners;
use super::{MAX_TILES, TilesError, count};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::cmp::Reverse;

/// The pairs that a report names.
const NAMED: usize = 5;

/// An edge of the first tile of a pair; the second has the opposite one beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// Its right edge, at the left of the second.
    Right,
    /// Its bottom edge, above the second.
    Bottom,
}

/// How far texels are apart, in levels of 8 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Edge {
    /// The greatest difference of a channel.
    pub max: u8,
    /// The sum over all channels of all texels, and how many these are.
    sum: u64,
    channels: u64,
}

/// Two tiles beside each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pair {
    /// The number of the left or upper tile, row by row from 0.
    pub first: u32,
    /// The number of the right or lower one.
    pub second: u32,
    /// Where they meet.
    pub side: Side,
    /// How far the facing texels are apart.
    pub apart: Edge,
}

/// What is found in a sheet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// Tiles.
    pub tiles: u32,
    /// Texels of a tile across and down.
    pub size: [u32; 2],
    /// Pairs of edges that were compared.
    pub pairs: u64,
    /// All facing texels.
    pub facing: Edge,
    /// All neighbouring texels inside tiles: what a sheet whose tiles continue each other, instead
    /// of sharing their edges, should come near to.
    pub inside: Edge,
    /// The pairs that are farthest apart, by the greatest difference, then the mean: at most 5.
    pub worst: Vec<Pair>,
}

/// Compares the facing edges of all tiles that may stand beside each other: of one family any two,
/// of more families, in the order of their corner codes, those that agree about their common corners.
///
/// # Errors
/// The grid does not divide the sheet, or has not a tile for each corner code.
pub fn check(sheet: &Bitmap, grid: [u32; 2], families: u32) -> Result<Report, TilesError> {
    if !(1..=u64::from(MAX_TILES)).contains(&count(grid)) {
        return Err(TilesError::Count { grid });
    }
    let codes = Corners::count(families)?;
    if families > 1 && count(grid) != u64::from(codes) {
        return Err(TilesError::Codes { grid, families });
    }
    let tiles = sheet.tiles(grid)?;
    let edges: Vec<Edges> =
        (0..).zip(&tiles).map(|(i, tile)| Edges::new(tile, Corners::of(i, families))).collect();
    let found: Vec<(Edge, u64, Vec<Pair>)> =
        (0..edges.len()).into_par_iter().map(|first| beside(&edges, first)).collect();
    let mut report = Report {
        tiles: tiles.len() as u32,
        size: tiles.first().map_or([0; 2], Bitmap::size),
        pairs: found.iter().map(|(_, pairs, _)| pairs).sum(),
        facing: found.iter().fold(Edge::default(), |all, (edge, ..)| all.with(*edge)),
        inside: tiles.iter().fold(Edge::default(), |all, tile| all.with(inside(tile))),
        worst: found.into_iter().flat_map(|(.., worst)| worst).collect(),
    };
    keep_worst(&mut report.worst);
    Ok(report)
}

impl Edge {
    /// The mean difference of a channel.
    pub fn mean(&self) -> f64 {
        self.sum as f64 / self.channels.max(1) as f64
    }

    fn with(self, other: Edge) -> Edge {
        Edge {
            max: self.max.max(other.max),
            sum: self.sum + other.sum,
            channels: self.channels + other.channels,
        }
    }

    fn of(pairs: impl Iterator<Item = (Texel, Texel)>) -> Edge {
        let mut edge = Edge::default();
        for (a, b) in pairs {
            let apart = [0, 1, 2, 3].map(|channel| a[channel].abs_diff(b[channel]));
            // Pictures without alpha have three channels.
            let channels = if a[3] == 255 && b[3] == 255 { 3 } else { 4 };
            edge.max = apart.into_iter().fold(edge.max, u8::max);
            edge.sum += apart.into_iter().map(u64::from).sum::<u64>();
            edge.channels += channels;
        }
        edge
    }
}

/// The edges of a tile, and which codes stand along them.
struct Edges {
    /// Left, right, top, bottom.
    texels: [Vec<Texel>; 4],
    codes: [[u32; 2]; 4],
}

impl Edges {
    fn new(tile: &Bitmap, corners: Corners) -> Edges {
        let [width, height] = tile.size();
        let column = |x: u32| (0..height).map(|y| seen(tile.texel(x, y))).collect();
        let row = |y: u32| (0..width).map(|x| seen(tile.texel(x, y))).collect();
        let ([left, right], [top, bottom]) = (corners.left_right(), corners.top_bottom());
        Edges {
            texels: [column(0), column(width - 1), row(0), row(height - 1)],
            codes: [left, right, top, bottom],
        }
    }
}

/// A texel as it looks: colour times alpha.
fn seen([r, g, b, alpha]: Texel) -> Texel {
    let times = |code: u8| ((u32::from(code) * u32::from(alpha) + 127) / 255) as u8;
    [times(r), times(g), times(b), alpha]
}

/// All pairs of which one tile is the first: the sum of them, how many, and the worst.
fn beside(edges: &[Edges], first: usize) -> (Edge, u64, Vec<Pair>) {
    let (mut all, mut count, mut worst) = (Edge::default(), 0, Vec::new());
    for second in 0..edges.len() {
        for (side, mine, theirs) in [(Side::Right, 1, 0), (Side::Bottom, 3, 2)] {
            let (a, b) = (&edges[first], &edges[second]);
            if a.codes[mine] != b.codes[theirs] {
                continue;
            }
            let apart = Edge::of(a.texels[mine].iter().copied().zip(b.texels[theirs].iter().copied()));
            all = all.with(apart);
            count += 1;
            worst.push(Pair { first: first as u32, second: second as u32, side, apart });
        }
    }
    keep_worst(&mut worst);
    (all, count, worst)
}

fn keep_worst(pairs: &mut Vec<Pair>) {
    pairs.sort_by_key(|pair| (Reverse((pair.apart.max, pair.apart.sum)), pair.first, pair.second, pair.side));
    pairs.truncate(NAMED);
}

/// The differences of all neighbours inside a tile.
fn inside(tile: &Bitmap) -> Edge {
    let [width, height] = tile.size();
    let row = |y: u32| (1..width).map(move |x| (seen(tile.texel(x - 1, y)), seen(tile.texel(x, y))));
    let column = |x: u32| (1..height).map(move |y| (seen(tile.texel(x, y - 1)), seen(tile.texel(x, y))));
    Edge::of((0..height).flat_map(row).chain((0..width).flat_map(column)))
}
