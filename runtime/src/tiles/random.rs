//! Random numbers of a seed, the same on every machine.

use texgraph_compiler::intrinsic::pcg4d;

/// Keeps these random numbers apart from those of a program: "tile".
const SALT: u32 = 0x7469_6c65;

/// A stream of random numbers.
pub struct Random {
    seed: u32,
    stream: u32,
    drawn: u32,
}

impl Random {
    /// A stream of a seed, from its start. Streams of other numbers have nothing in common.
    pub fn new(seed: u32, stream: u32) -> Random {
        Random { seed, stream, drawn: 0 }
    }

    /// The next number, one of 0..count, or 0 if there is none.
    pub fn below(&mut self, count: u32) -> u32 {
        let word = at([self.drawn, self.stream], self.seed)[0];
        self.drawn = self.drawn.wrapping_add(1);
        ((u64::from(word) * u64::from(count)) >> 32) as u32
    }
}

/// Four random words of a place.
pub fn at([x, y]: [u32; 2], seed: u32) -> [u32; 4] {
    pcg4d([x, y, seed, SALT])
}
