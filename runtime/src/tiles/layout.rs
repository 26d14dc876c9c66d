//! An empty transition sheet: every tile with its corner codes, to draw on.

use super::bitmap::{Bitmap, Texel};
use super::corners::Corners;
use super::glyphs::{HEIGHT, Number};
use super::{TilesError, check_sheet};

/// What stands for each family.
const COLORS: [Texel; 4] =
    [[236, 220, 176, 255], [150, 196, 132, 255], [142, 186, 222, 255], [214, 160, 186, 255]];

const INK: Texel = [32, 32, 40, 255];

/// The shortest side with room for the tile's index between its codes.
const WITH_INDEX: u32 = 28;

/// The sheet of all m⁴ corner codes of m families, m² columns wide: the columns go through the codes of
/// the upper corners, the rows through those of the lower ones. A quarter of a tile has the colour of its
/// family and the code in its corner; the tile's index stands in the middle.
///
/// # Errors
/// There are more tiles than a sheet may have, or the side is none that is made.
pub fn layout(families: u32, side: u32) -> Result<Bitmap, TilesError> {
    let count = Corners::count(families)?;
    let columns = families * families;
    check_sheet([columns; 2], side)?;
    let tiles: Vec<Bitmap> = (0..count).map(|index| tile(index, families, side)).collect();
    Ok(Bitmap::sheet(&tiles, columns))
}

fn tile(index: u32, families: u32, side: u32) -> Bitmap {
    let Corners(codes) = Corners::of(index, families);
    let mut labels: Vec<Label> =
        (0..4).map(|corner| Label::at_corner(codes[corner as usize], corner, side)).collect();
    if side >= WITH_INDEX {
        labels.push(Label::in_middle(index, side));
    }
    Bitmap::new([side; 2], |x, y| {
        if labels.iter().any(|label| label.covers([x, y])) {
            return INK;
        }
        let corner = usize::from(2 * x >= side) + 2 * usize::from(2 * y >= side);
        COLORS[codes[corner] as usize % COLORS.len()]
    })
}

/// A number, where it stands, and how large.
struct Label {
    number: Number,
    place: [u32; 2],
    scale: u32,
}

impl Label {
    /// Corner 0 is at the top left, 1 at the top right.
    fn at_corner(number: u32, corner: u32, side: u32) -> Label {
        let (number, scale) = (Number::new(number), scale(side));
        let inset = side / 16 + 1;
        let far = |extent: u32| side - inset - extent * scale;
        let left = if corner.is_multiple_of(2) { inset } else { far(number.width()) };
        let top = if corner < 2 { inset } else { far(HEIGHT) };
        Label { number, place: [left, top], scale }
    }

    fn in_middle(number: u32, side: u32) -> Label {
        let (number, scale) = (Number::new(number), scale(side));
        let place = [number.width(), HEIGHT].map(|extent| (side - extent * scale) / 2);
        Label { number, place, scale }
    }

    fn covers(&self, texel: [u32; 2]) -> bool {
        let within = |axis: usize| texel[axis].checked_sub(self.place[axis]).map(|at| at / self.scale);
        within(0).zip(within(1)).is_some_and(|(x, y)| self.number.covers([x, y]))
    }
}

fn scale(side: u32) -> u32 {
    (side / 40).max(1)
}
