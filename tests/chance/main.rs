//! Cells, bombing and noise beside what they are said to be.

mod bombing;
mod noise;
#[path = "../patterns/support.rs"]
#[allow(dead_code, reason = "other tests use the rest of it")]
mod support;
mod voronoi;

/// The language's `hash` of up to three coordinates: pcg4d (Jarzynski & Olano, JCGT 2020).
fn hash(cell: [i32; 3], seed: i32) -> [f32; 4] {
    let words = [cell[0], cell[1], cell[2], seed].map(|word| word as u32);
    let mixed = products(words.map(|word| word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223)));
    products(mixed.map(|word| word ^ (word >> 16))).map(|word| (word >> 8) as f32 / 16_777_216.0)
}

/// To each word the product of two others is added, one after the other.
fn products(mut v: [u32; 4]) -> [u32; 4] {
    for (i, j, k) in [(0, 1, 3), (1, 2, 0), (2, 0, 1), (3, 1, 2)] {
        v[i] = v[i].wrapping_add(v[j].wrapping_mul(v[k]));
    }
    v
}
