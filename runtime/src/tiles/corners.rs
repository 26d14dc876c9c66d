//! Corner codes: which family stands at each corner of a transition tile.
//!
//! A cell of the virtual texture has one corner in common with each of its 2×2 neighbourhood. The
//! tile's index is c00 + m·c10 + m²·c01 + m³·c11 for m families (Lefebvre & Neyret 2003, §3.3, figure
//! 11); v grows downward, so c00 is at the top left, c10 at the top right, c01 at the bottom left and
//! c11 at the bottom right.

use super::{MAX_TILES, TilesError};

/// The families at the corners of a tile: [c00, c10, c01, c11].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corners(pub [u32; 4]);

impl Corners {
    /// The corners of the tile with this index.
    pub fn of(index: u32, families: u32) -> Corners {
        let m = families.max(1);
        let digit = |place: u32| index / m.saturating_pow(place) % m;
        Corners([digit(0), digit(1), digit(2), digit(3)])
    }

    /// The tiles that so many families have.
    ///
    /// # Errors
    /// There are none, or more than a sheet may have.
    pub fn count(families: u32) -> Result<u32, TilesError> {
        let count = families.checked_pow(4).filter(|count| (1..=MAX_TILES).contains(count));
        count.ok_or(TilesError::Families { families })
    }

    /// The codes along the left and the right edge, from the top down.
    pub fn left_right(self) -> [[u32; 2]; 2] {
        let Corners([c00, c10, c01, c11]) = self;
        [[c00, c01], [c10, c11]]
    }

    /// The codes along the top and the bottom edge, from the left.
    pub fn top_bottom(self) -> [[u32; 2]; 2] {
        let Corners([c00, c10, c01, c11]) = self;
        [[c00, c10], [c01, c11]]
    }
}

#[cfg(test)]
mod tests {
    use super::Corners;
    use crate::tiles::TilesError;

    #[test]
    fn an_index_is_its_codes_as_digits() {
        assert_eq!(Corners::of(0, 2), Corners([0, 0, 0, 0]));
        assert_eq!(Corners::of(1 + 8, 2), Corners([1, 0, 0, 1]));
        assert_eq!(Corners::of(2 + 3 + 27, 3), Corners([2, 1, 0, 1]));
        assert_eq!(Corners::of(2, 2).top_bottom(), [[0, 1], [0, 0]]);
        assert_eq!(Corners::of(4, 2).left_right(), [[0, 1], [0, 0]]);
    }

    #[test]
    fn four_families_fill_a_sheet() {
        assert_eq!([1, 2, 3, 4].map(Corners::count), [Ok(1), Ok(16), Ok(81), Ok(256)]);
        for families in [0, 5, u32::MAX] {
            assert_eq!(Corners::count(families), Err(TilesError::Families { families }));
        }
    }
}
