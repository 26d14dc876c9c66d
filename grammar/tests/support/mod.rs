//! What several tests share: the design's examples and a small source of chance.

use std::path::Path;

/// A linear congruential generator: the same numbers everywhere.
pub struct Random(pub u64);

impl Random {
    /// A number below `bound`.
    pub fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) as usize % bound
    }
}

/// One of the design's examples.
pub fn example(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
    std::fs::read_to_string(path).expect("the examples are in tests/data")
}

/// The design's examples, by name.
pub fn examples() -> Vec<(String, String)> {
    let names =
        ["bombing", "island", "landscape", "leaves", "marble", "moss", "signboard", "snake", "tiling"];
    names.map(|name| (format!("{name}.tex"), example(&format!("{name}.tex")))).to_vec()
}
