//! Where decisions come from.

/// A source of decisions: endless from a seed, or as long as the bytes of a fuzzer last.
pub enum Choices<'a> {
    /// The state of a SplitMix64 generator (Steele, Lea & Flood, *Fast splittable pseudorandom
    /// number generators*, OOPSLA 2014).
    Seed(u64),
    /// What is left of the bytes. When they have run out every decision is the first, which is
    /// always the simplest.
    Bytes(&'a [u8]),
}

impl Choices<'_> {
    /// A number below `n`, for `n` of 1 to 65,536.
    pub fn below(&mut self, n: usize) -> usize {
        match self {
            Choices::Seed(state) => (split_mix(state) >> 32) as usize % n,
            Choices::Bytes(bytes) => {
                let taken = if n <= 256 { 1 } else { 2 }.min(bytes.len());
                let (now, rest) = bytes.split_at(taken);
                *bytes = rest;
                now.iter().fold(0, |number, byte| number << 8 | usize::from(*byte)) % n
            }
        }
    }

    /// True in so many of 100 cases; false when bytes have run out.
    pub fn chance(&mut self, percent: usize) -> bool {
        self.below(100) >= 100 - percent
    }

    /// One of a list that is not empty.
    pub fn pick<'t, T>(&mut self, of: &'t [T]) -> &'t T {
        &of[self.below(of.len())]
    }

    /// A list in a random order.
    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for i in (1..list.len()).rev() {
            list.swap(i, i - self.below(i + 1));
        }
    }
}

fn split_mix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
