//! `permutation`: four independent permutations of 0..size. Field `table`: texel i, row after row,
//! holds (σ₀(i), σ₁(i), σ₂(i), σ₃(i)).
//!
//! Each is a Fisher–Yates shuffle of 0..size that walks from the last place down: place i is
//! swapped with place ⌊r · (i + 1) / 2³²⌋, where r is the first word of the language's own hash,
//! pcg4d, of (i, channel, seed, [`SALT`]). These bits never change: pictures depend on them.

use super::table::Made;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};
use texgraph_compiler::manifest::{Format, Recipe};

/// Keeps these random numbers apart from those of a program that hashes (i, channel, seed): "perm".
const SALT: u32 = 0x7065_726d;

/// Makes the texture.
///
/// # Errors
/// The size is not 2 to 65,536.
pub fn make(place: Place, size: u32, seed: i32) -> Result<Vec<Made>, Vec<Diagnostic>> {
    let mut entries = entries(place, size, seed)?;
    let [width, rows] = [size.min(Recipe::ROW), size.div_ceil(Recipe::ROW)];
    entries.resize((width * rows) as usize, [0; 4]);
    Ok(vec![Made::integers("table", Format::Rgba32Sint, [width, rows], entries.into_iter().flatten())])
}

/// The entries of the table: (σ₀(i), σ₁(i), σ₂(i), σ₃(i)) for each i.
///
/// # Errors
/// The size is not 2 to 65,536.
pub fn entries(place: Place, size: u32, seed: i32) -> Result<Vec<[i32; 4]>, Vec<Diagnostic>> {
    if !(2..=Recipe::MAX_PERMUTATION).contains(&size) {
        let message = format!("a permutation of {size} numbers can't be made");
        let bounds = format!("its size is 2 to {}", Recipe::MAX_PERMUTATION);
        return Err(vec![resources::no_table(place, message, bounds)]);
    }
    let channels: [Vec<i32>; 4] = [0, 1, 2, 3].map(|channel| shuffle(size, channel, seed));
    Ok((0..size as usize).map(|i| channels.each_ref().map(|channel| channel[i])).collect())
}

fn shuffle(size: u32, channel: u32, seed: i32) -> Vec<i32> {
    let mut places: Vec<i32> = (0..size as i32).collect();
    for i in (1..size).rev() {
        let [random, ..] = pcg4d([i, channel, seed as u32, SALT]);
        let other = (u64::from(random) * u64::from(i + 1)) >> 32;
        places.swap(i as usize, other as usize);
    }
    places
}

/// Four random words of four words (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering").
pub fn pcg4d(words: [u32; 4]) -> [u32; 4] {
    let mixed = mix(words.map(|word| word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223)));
    mix(mixed.map(|word| word ^ (word >> 16)))
}

/// Adds to each word the product of two others, one after the other.
fn mix(words: [u32; 4]) -> [u32; 4] {
    let [mut x, mut y, mut z, mut w] = words;
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w]
}
