//! A family: tiles of one material, any of which may stand beside any other.
//!
//! All tiles have the frame of [`super::frame`]; inside, each shows a place of its own, cut into the
//! frame where that is seen least. They are the ω-tiles of Ng et al. 2005 ("Generating an ω-tile set
//! for texture synthesis").

use super::bitmap::{Bitmap, Texel};
use super::cut::{self, Cut, Pull};
use super::frame::{Geometry, frame};
use super::levels::{Levels, evened};
use super::random::Random;
use super::{SIDES, TilesError, check_sheet, seam};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

/// Tiles of one material: square, of one size, at least one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Family {
    tiles: Vec<Bitmap>,
}

/// Places that are tried for each tile, and at least.
const CANDIDATES_PER_TILE: u32 = 8;
const LEAST_CANDIDATES: u32 = 96;

/// What a texel of the frame costs: what lies in the frame is seen in every tile.
const THICKNESS: u32 = 3;

/// How much a level by which a place stands out counts, in costs of a texel of seam.
const CALM: f32 = 0.5;

/// How much sharing all of its place with another tile costs, in costs of the best place.
const SHARED: f32 = 3.0;

impl Family {
    /// Cuts `count` tiles of `side` texels out of a photograph. The frame depends on the photograph,
    /// the side and the seed alone, so families of one photograph fit together.
    ///
    /// # Errors
    /// The photograph is too small, or the side is not in [`SIDES`].
    pub fn cut(photo: &Bitmap, side: u32, count: u32, seed: u32) -> Result<Family, TilesError> {
        check_photo(photo, side)?;
        let geometry = Geometry::new(side);
        let photo = &evened(photo, side);
        let frame = frame(&evened(photo, side / 8), geometry, &mut Random::new(seed, 0));
        let places = choose(photo, &frame, geometry, count, seed);
        let tile = |place: &[u32; 2]| tile(photo, &frame, geometry, *place);
        Ok(Family { tiles: places.par_iter().map(tile).collect() })
    }

    /// The tiles of a sheet, which must be compatible for what is made of them to be.
    ///
    /// # Errors
    /// The grid does not divide the sheet, has too many tiles, or ones that are not square.
    pub fn of_sheet(sheet: &Bitmap, grid: [u32; 2]) -> Result<Family, TilesError> {
        let tiles = sheet.tiles(grid)?;
        let size = tiles.first().map_or([0; 2], Bitmap::size);
        if size[0] != size[1] {
            return Err(TilesError::NotSquare { size });
        }
        check_sheet(grid, size[0])?;
        Ok(Family { tiles })
    }

    /// The tiles.
    pub fn tiles(&self) -> &[Bitmap] {
        &self.tiles
    }

    /// Texels along a tile.
    pub fn side(&self) -> u32 {
        self.tiles.first().map_or(0, |tile| tile.size()[0])
    }

    /// A tile; beyond the last the first again.
    pub(super) fn tile(&self, index: usize) -> Option<&Bitmap> {
        self.tiles.get(index % self.tiles.len().max(1))
    }
}

/// A sheet of `grid` (columns, rows) compatible tiles of `side` texels, cut out of a photograph.
///
/// # Errors
/// The photograph is too small, or the sheet is not one that may be made.
pub fn make(photo: &Bitmap, grid: [u32; 2], side: u32, seed: u32) -> Result<Bitmap, TilesError> {
    check_sheet(grid, side)?;
    let family = Family::cut(photo, side, grid[0] * grid[1], seed)?;
    Ok(Bitmap::sheet(&family.tiles, grid[0]))
}

fn check_photo(photo: &Bitmap, side: u32) -> Result<(), TilesError> {
    if !SIDES.contains(&side) {
        return Err(TilesError::TileSide { side });
    }
    let fits = |side: u32| photo.size().iter().all(|texels| *texels >= Geometry::new(side).needed());
    if fits(side) {
        return Ok(());
    }
    let largest = SIDES.rev().find(|side| fits(*side));
    Err(TilesError::PhotoTooSmall { size: photo.size(), side, needed: Geometry::new(side).needed(), largest })
}

/// A place of the photograph that may fill a tile.
struct Candidate {
    place: [u32; 2],
    cost: f32,
}

/// The places of the tiles: cheap ones that share little with each other.
fn choose(photo: &Bitmap, frame: &Bitmap, geometry: Geometry, count: u32, seed: u32) -> Vec<[u32; 2]> {
    let mut random = Random::new(seed, 1);
    let mut place = || photo.size().map(|side| random.below(side - geometry.side as u32 + 1));
    let tried = (count * CANDIDATES_PER_TILE).max(LEAST_CANDIDATES);
    let mut places: Vec<[u32; 2]> = (0..tried).map(|_| place()).collect();
    places.sort_unstable();
    places.dedup();
    let levels = Levels::new(photo);
    let candidate = |place: &[u32; 2]| candidate(photo, frame, geometry, &levels, *place);
    let mut candidates: Vec<Candidate> = places.par_iter().map(candidate).collect();
    let mut chosen = Vec::new();
    while chosen.len() < count as usize {
        let Some(best) = cheapest(&candidates, &chosen, geometry) else { break };
        chosen.push(candidates.swap_remove(best).place);
    }
    // A photograph with fewer places than tiles shows some of them again.
    let distinct = chosen.len();
    while distinct > 0 && chosen.len() < count as usize {
        chosen.push(chosen[chosen.len() - distinct]);
    }
    chosen
}

/// The candidate that costs least, what it shares with the chosen ones included.
fn cheapest(candidates: &[Candidate], chosen: &[[u32; 2]], geometry: Geometry) -> Option<usize> {
    let least = candidates.iter().map(|candidate| candidate.cost).fold(f32::INFINITY, f32::min);
    let total = |candidate: &Candidate| {
        let shared: f32 = chosen.iter().map(|place| shared(candidate.place, *place, geometry)).sum();
        candidate.cost + SHARED * least * shared
    };
    let totals = candidates.iter().map(total).enumerate();
    totals.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(index, _)| index)
}

/// The share of a tile's interior that two places have in common.
fn shared(a: [u32; 2], b: [u32; 2], geometry: Geometry) -> f32 {
    let inner = (geometry.side - geometry.band) as f32;
    let along = |axis: usize| (inner - a[axis].abs_diff(b[axis]) as f32).max(0.0) / inner;
    along(0) * along(1)
}

fn candidate(
    photo: &Bitmap,
    frame: &Bitmap,
    geometry: Geometry,
    levels: &Levels,
    place: [u32; 2],
) -> Candidate {
    let seam = insert(photo, frame, geometry, place).cost;
    let along = (4 * geometry.period) as f32;
    let quarter = geometry.side as i64 / 4;
    let pieces = (0..16i64).map(|i| {
        let from = [i64::from(place[0]) + i % 4 * quarter, i64::from(place[1]) + i / 4 * quarter];
        levels.stands_out(from, [quarter, quarter])
    });
    let cost = seam as f32 / along + CALM * pieces.sum::<f32>() / 16.0;
    Candidate { place, cost }
}

/// Cuts a place of the photograph into the frame. What is near the edge is the frame's, what lies deep
/// is the place's, and between there is room to fade.
fn insert(photo: &Bitmap, frame: &Bitmap, geometry: Geometry, [left, top]: [u32; 2]) -> Cut {
    let side = geometry.side;
    let both = |node: usize| -> [Texel; 2] {
        let (x, y) = ((node % side) as u32, (node / side) as u32);
        [frame.texel(x, y), photo.texel(left + x, top + y)]
    };
    let depth = |node: usize| geometry.depth(node % side, node / side);
    let link = |a: usize, b: usize| {
        if depth(a) > geometry.band && depth(b) > geometry.band {
            return 0;
        }
        let ([frame, inner], [next_frame, next_inner]) = (both(a), both(b));
        seam::cost([frame, next_frame], [inner, next_inner])
    };
    cut::minimum([side, side], link, |node| match depth(node) {
        depth if depth < geometry.edge() => Pull::FIRST,
        depth if depth + cut::FADE >= geometry.band => Pull::SECOND,
        _ => Pull { to_first: 0, to_second: THICKNESS },
    })
}

/// The tile that shows a place: across the cut it fades into the frame, but not on the edge.
fn tile(photo: &Bitmap, frame: &Bitmap, geometry: Geometry, [left, top]: [u32; 2]) -> Bitmap {
    let side = geometry.side;
    let cut = insert(photo, frame, geometry, [left, top]);
    Bitmap::new([side as u32; 2], |x, y| {
        let (framed, inner) = (frame.texel(x, y), photo.texel(left + x, top + y));
        match geometry.depth(x as usize, y as usize) {
            0 => framed,
            depth if depth > geometry.band => inner,
            _ => seam::fade(framed, inner, cut.share([side, side], [x as usize, y as usize])),
        }
    })
}
