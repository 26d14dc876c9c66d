//! Digits of 3×5 texels.

/// The rows of each digit, the first texel in the highest of three bits.
const DIGITS: [[u8; 5]; 10] = [
    [7, 5, 5, 5, 7],
    [2, 6, 2, 2, 7],
    [7, 1, 7, 4, 7],
    [7, 1, 7, 1, 7],
    [5, 5, 7, 1, 1],
    [7, 4, 7, 1, 7],
    [7, 4, 7, 5, 7],
    [7, 1, 1, 1, 1],
    [7, 5, 7, 5, 7],
    [7, 5, 7, 1, 7],
];

/// Texels from a digit to the next.
const PITCH: u32 = 4;

/// Texels down a number.
pub const HEIGHT: u32 = 5;

/// A number as digits.
pub struct Number(Vec<u8>);

impl Number {
    /// The decimal digits of a number.
    pub fn new(number: u32) -> Number {
        Number(number.to_string().bytes().map(|digit| digit - b'0').collect())
    }

    /// Texels across.
    pub fn width(&self) -> u32 {
        self.0.len() as u32 * PITCH - 1
    }

    /// Whether the number covers a texel, counted from its top left.
    pub fn covers(&self, [x, y]: [u32; 2]) -> bool {
        let digit = self.0.get((x / PITCH) as usize).and_then(|digit| DIGITS.get(usize::from(*digit)));
        let row = digit.and_then(|digit| digit.get(y as usize));
        row.is_some_and(|row| (row << (x % PITCH)) & 4 != 0)
    }
}
