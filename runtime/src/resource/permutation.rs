//! `permutation`: four independent permutations of 0..size. Field `table`: texel i, row after row,
//! holds (σ₀(i), σ₁(i), σ₂(i), σ₃(i)).
//!
//! Each is a Fisher–Yates shuffle of 0..size that walks from the last place down: place i is
//! swapped with place ⌊r · (i + 1) / 2³²⌋, where r is the first word of the language's own hash,
//! pcg4d, of (i, channel, seed, [`SALT`]). These bits never change: pictures depend on them.
//!
//! A walk through σ₀ (std/draws.tex) draws its own order down a column of cells: with one digit the
//! numbers one after the other, with two those that lie as far apart as numbers one after the other
//! differ. Of random shuffles one in twelve of 65,536 numbers, and every other one of 256, so follows
//! itself enough that |r| of sixteen patterns passes 0.01 within eight cells. Such a shuffle is drawn
//! again, with the next number after [`SALT`] ([`follows`]); all others are as they are drawn first.

use super::table::Made;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};
use texgraph_compiler::intrinsic::pcg4d;
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
    let [second, third, fourth] = [1, 2, 3].map(|channel| shuffle(size, channel, seed, SALT));
    let channels = [drawn(size, seed), second, third, fourth];
    Ok((0..size as usize).map(|i| channels.each_ref().map(|channel| channel[i])).collect())
}

/// After how many shuffles the next is taken as it is: so many that none gets there.
const MOST_SHUFFLES: u32 = 64;

/// σ₀: the first shuffle whose numbers do not follow one another.
fn drawn(size: u32, seed: i32) -> Vec<i32> {
    let mut shuffles = (SALT..SALT + MOST_SHUFFLES).map(|salt| shuffle(size, 0, seed, salt));
    let fitting = shuffles.find(|sigma| !follows(sigma));
    fitting.unwrap_or_else(|| shuffle(size, 0, seed, SALT + MOST_SHUFFLES))
}

/// Whether sixteen patterns, drawn for cells by walks through σ, correlate by more than 0.01 over one to
/// eight cells: down columns, and along diagonals in the first columns. Asked of sizes of which coordinates below 65,536 have one digit, or two: from 1,024 on
/// those correlate far less, and smaller ones have more digits and could not keep it. In whole numbers,
/// so that it is the same on every machine.
fn follows(sigma: &[i32]) -> bool {
    match sigma.len() {
        65_536 => {
            let centred = centred(sigma);
            let most = ring(&centred, 0);
            (1..=LAGS).any(|lag| ring(&centred, lag).abs() * 100 > most)
        }
        256..1024 => follows_by_two(sigma),
        _ => false,
    }
}

/// Cells over which patterns must not correlate.
const LAGS: usize = 8;

fn follows_by_two(sigma: &[i32]) -> bool {
    let size = sigma.len();
    let centred = centred(sigma);
    let rings: Vec<i64> = (0..size).map(|lag| ring(&centred, lag)).collect();
    let around = |from: usize, to: usize| (sigma[to % size] + size as i32 - sigma[from]) as usize % size;
    // The sum over a column beside one that begins so many numbers on in σ. Below one of `size` cells
    // in `lag` the higher digit is one more.
    let beside = |shift: usize, lag: usize| -> i128 {
        let at = |k: usize| around(k, k + shift);
        let product = |k| (size - lag) as i64 * rings[at(k)] + lag as i64 * rings[(at(k) + 1) % size];
        (0..size).map(|k| i128::from(product(k))).sum()
    };
    let most = (size * size) as i128 * i128::from(rings[0]);
    let begins = |x: usize| sigma[sigma[x] as usize] as usize;
    (1..=LAGS).any(|lag| {
        let column = beside(lag, lag);
        let columns = size - lag;
        let shift = |x: usize| lag + begins(x + lag) + size - begins(x);
        let diagonal: i128 = (0..columns).map(|x| beside(shift(x), lag)).sum();
        column.abs() * 100 > most || diagonal.abs() * 100 > most * columns as i128
    })
}

/// The sixteenth of the range that each number lies in, as far from their mean, times the size.
fn centred(sigma: &[i32]) -> Vec<i64> {
    let size = sigma.len() as i64;
    let parts: Vec<i64> = sigma.iter().map(|number| i64::from(*number) * 16 / size).collect();
    let sum: i64 = parts.iter().sum();
    parts.into_iter().map(|part| part * size - sum).collect()
}

/// The sum of the products of numbers so far apart on a ring.
fn ring(centred: &[i64], lag: usize) -> i64 {
    let after = centred.iter().cycle().skip(lag);
    centred.iter().zip(after).map(|(one, two)| one * two).sum()
}

fn shuffle(size: u32, channel: u32, seed: i32, salt: u32) -> Vec<i32> {
    let mut places: Vec<i32> = (0..size as i32).collect();
    for i in (1..size).rev() {
        let [random, ..] = pcg4d([i, channel, seed as u32, salt]);
        let other = (u64::from(random) * u64::from(i + 1)) >> 32;
        places.swap(i as usize, other as usize);
    }
    places
}

#[cfg(test)]
mod tests {
    use super::{SALT, drawn, follows, shuffle};

    /// Those that are drawn again.
    fn again(size: u32) -> Vec<i32> {
        let is_first = |seed: &i32| drawn(size, *seed) == shuffle(size, 0, *seed, SALT);
        (1..=20).filter(|seed| !is_first(seed)).collect()
    }

    #[test]
    fn numbers_that_follow_one_another_are_drawn_again() {
        let rising: Vec<i32> = (0..65_536).collect();
        assert!(follows(&rising) && follows(&rising[..256]));
        assert_eq!(again(65_536), [16, 17]);
        assert_eq!(again(256), [4, 6, 7, 9, 10, 12, 14, 15, 16, 17]);
    }

    #[test]
    fn what_can_keep_no_bound_or_always_does_is_taken_as_it_is_drawn() {
        for size in [2, 16, 255, 1024, 4096] {
            assert_eq!(again(size), [0; 0], "{size}");
        }
    }
}
