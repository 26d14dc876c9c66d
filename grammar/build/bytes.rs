//! Sets of bytes.

use std::ops::RangeInclusive;

/// A set of bytes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Bytes([bool; 256]);

impl Bytes {
    /// No byte.
    pub const NONE: Bytes = Bytes([false; 256]);
    /// Every byte.
    pub const ALL: Bytes = Bytes([true; 256]);

    /// The bytes of a range.
    pub fn range(range: RangeInclusive<u8>) -> Bytes {
        let mut bytes = Bytes::NONE;
        bytes.0[usize::from(*range.start())..=usize::from(*range.end())].fill(true);
        bytes
    }

    /// The bytes of either.
    pub fn or(self, other: Bytes) -> Bytes {
        Bytes(std::array::from_fn(|byte| self.0[byte] || other.0[byte]))
    }

    /// Whether a byte belongs to it.
    pub fn contains(self, byte: u8) -> bool {
        self.0[usize::from(byte)]
    }

    /// As a Rust pattern; nothing when it is empty.
    pub fn pattern(self) -> Option<String> {
        let mut ranges: Vec<(u8, u8)> = Vec::new();
        for byte in (0..=u8::MAX).filter(|byte| self.contains(*byte)) {
            match ranges.last_mut() {
                Some((_, end)) if *end + 1 == byte => *end = byte,
                _ => ranges.push((byte, byte)),
            }
        }
        let ranges: Vec<String> = ranges.into_iter().map(|(start, end)| format!("{start}..={end}")).collect();
        (!ranges.is_empty()).then(|| ranges.join(" | "))
    }
}
