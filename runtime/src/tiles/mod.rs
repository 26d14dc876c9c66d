//! Tile sets from photographs: sheets of tiles that may stand beside each other.
//!
//! ```text
//!  photo ─frame─▶ one border for all ─▶ family of tiles ─sheet─▶ make
//!        └─places─▶ interiors, cut in ─┘        └─mask─▶ sheet ─▶ transition
//!  sheet ─▶ check: how well facing edges agree            layout ─▶ an empty sheet to draw on
//! ```
//!
//! The outermost texels of a tile are its *edges*. In what is made here, facing edges are equal: a
//! tile that is magnified and clamped at its edges, as `patterns` are, then goes on in its neighbour
//! without a step. All is done in 8-bit sRGB, on the CPU, in parallel, and gives the same bytes for any
//! number of threads.

mod bitmap;
mod check;
mod corners;
mod cut;
mod family;
mod frame;
mod glyphs;
mod layout;
mod levels;
mod mask;
mod random;
mod seam;
mod transition;

pub use bitmap::Bitmap;
pub use check::{Edge, Pair, Report, Side, check};
pub use corners::Corners;
pub use family::{Family, make};
pub use layout::layout;
pub use transition::{border, transition};

use std::fmt;

/// The shortest and the longest side of a tile that is made, in texels.
pub const SIDES: std::ops::RangeInclusive<u32> = 16..=1024;

/// The most tiles of a sheet: the layers that every GPU has.
pub const MAX_TILES: u32 = crate::resource::MAX_LAYERS;

/// The most texels of a sheet that is made.
pub const MAX_TEXELS: u64 = 1 << 26;

/// What a tile set can't be made or checked of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TilesError {
    /// The photograph is too small for tiles of this side.
    PhotoTooSmall {
        /// Texels of the photograph across and down.
        size: [u32; 2],
        /// Texels along a tile.
        side: u32,
        /// Texels that the photograph needs along each side.
        needed: u32,
        /// The longest side of a tile that it is enough for, if there is one.
        largest: Option<u32>,
    },
    /// A grid without tiles, or with more than [`MAX_TILES`].
    Count {
        /// Columns and rows.
        grid: [u32; 2],
    },
    /// Tiles with a side outside [`SIDES`].
    TileSide {
        /// Texels along a tile.
        side: u32,
    },
    /// A sheet of more than [`MAX_TEXELS`].
    SheetTooLarge {
        /// Columns and rows.
        grid: [u32; 2],
        /// Texels along a tile.
        side: u32,
    },
    /// A grid that does not divide the sheet into tiles of at least 2×2 texels.
    UnevenGrid {
        /// Texels of the sheet across and down.
        size: [u32; 2],
        /// Columns and rows.
        grid: [u32; 2],
    },
    /// Two sheets whose tiles differ in size.
    SizesDiffer {
        /// Texels of a tile of each.
        sizes: [[u32; 2]; 2],
    },
    /// Tiles that are not square.
    NotSquare {
        /// Texels of a tile across and down.
        size: [u32; 2],
    },
    /// A transition sheet whose grid has not one tile for each of the families' corner codes.
    Codes {
        /// Columns and rows.
        grid: [u32; 2],
        /// Families.
        families: u32,
    },
    /// More families than [`MAX_TILES`] tiles have corner codes for.
    Families {
        /// Families.
        families: u32,
    },
}

impl fmt::Display for TilesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TilesError::PhotoTooSmall { size: [width, height], side, needed, largest } => {
                write!(
                    f,
                    "the photograph has {width}×{height} texels; tiles of {side} need {needed}×{needed}: "
                )?;
                match largest {
                    Some(largest) => write!(f, "take a larger one, or a --size of at most {largest}"),
                    None => f.write_str("take a larger one"),
                }
            }
            TilesError::Count { grid: [columns, rows] } => {
                write!(
                    f,
                    "a sheet has 1 to {MAX_TILES} tiles; {columns}×{rows} are {}",
                    count([*columns, *rows])
                )
            }
            TilesError::TileSide { side } => {
                write!(f, "a tile has {} to {} texels a side, not {side}", SIDES.start(), SIDES.end())
            }
            TilesError::SheetTooLarge { grid: [columns, rows], side } => write!(
                f,
                "{columns}×{rows} tiles of {side} texels are more than the {MAX_TEXELS} texels of a sheet: \
                 take fewer or smaller ones"
            ),
            TilesError::UnevenGrid { size: [width, height], grid: [columns, rows] } => write!(
                f,
                "a grid of {columns}×{rows} does not divide {width}×{height} texels into tiles of 2×2 or more"
            ),
            TilesError::SizesDiffer { sizes: [[w, h], [other_w, other_h]] } => {
                write!(
                    f,
                    "the tiles of the first sheet have {w}×{h} texels, those of the second {other_w}×{other_h}"
                )
            }
            TilesError::NotSquare { size: [width, height] } => {
                write!(f, "the tiles have {width}×{height} texels, but transitions need square ones")
            }
            TilesError::Codes { grid: [columns, rows], families } => write!(
                f,
                "{families} families have {} corner codes, but a grid of {columns}×{rows} has {} tiles",
                u64::from(*families).saturating_pow(4),
                count([*columns, *rows])
            ),
            TilesError::Families { families } => write!(
                f,
                "{families} families have {} corner codes, and a sheet has {MAX_TILES} tiles at most: take up to 4 \
                 families, or 16 border tiles for each (`texgraph tiles transition PHOTO --border`), laid over \
                 each other from low to high",
                u64::from(*families).saturating_pow(4)
            ),
        }
    }
}

impl std::error::Error for TilesError {}

fn count([columns, rows]: [u32; 2]) -> u64 {
    u64::from(columns) * u64::from(rows)
}

/// Whether a sheet of this grid and side may be made.
fn check_sheet(grid: [u32; 2], side: u32) -> Result<(), TilesError> {
    let tiles = count(grid);
    if !SIDES.contains(&side) {
        return Err(TilesError::TileSide { side });
    }
    if tiles == 0 || tiles > u64::from(MAX_TILES) {
        return Err(TilesError::Count { grid });
    }
    if tiles * u64::from(side) * u64::from(side) > MAX_TEXELS {
        return Err(TilesError::SheetTooLarge { grid, side });
    }
    Ok(())
}
