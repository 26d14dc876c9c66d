//! `pixel_map`: a large map of small numbers, stored where it changes (Kraus & Ertl, Adaptive Texture
//! Maps, Graphics Hardware 2002). Field `blocks` holds, for each block of texels, -1 - n where all of
//! them are n, else the block's place in field `pool`. Equal blocks are stored once.
//!
//! A map is read in stripes as high as a block, so it never has to be in memory as a whole.

use super::decode;
use super::table::{MAX_SIDE, Made};
use crate::project::Project;
use std::collections::HashMap;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};
use texgraph_compiler::manifest::Format;
use texgraph_compiler::resource::pixel_map::{across, depth, texels};

/// Makes the textures from a grey picture.
///
/// # Errors
/// The picture can't be read or has colours, its sides are no multiples of the block, or the map is
/// too large.
pub fn make(
    project: &Project,
    place: Place,
    path: &str,
    block: u32,
    levels: u32,
) -> Result<Vec<Made>, Vec<Diagnostic>> {
    let mut builder = match Builder::new(block, levels) {
        Some(builder) => builder,
        None => {
            let message = format!("blocks of {block} texels, {levels} levels can't be made");
            return Err(vec![resources::no_table(place, message, "a power of two from 4 to 64, 2 to 256")]);
        }
    };
    let file = decode::open(project, path, place)?;
    let [width, height] = file.size;
    if width % block != 0 || height % block != 0 {
        return Err(vec![resources::uneven_blocks(place, path, file.size, block)]);
    }
    if width.max(height) / block > MAX_SIDE {
        return Err(vec![resources::texture_too_large(
            place,
            path,
            [width / block, height / block],
            MAX_SIDE,
        )]);
    }
    let picture = file.decode()?;
    let mut stripe = vec![0; width as usize * block as usize];
    for top in (0..height).step_by(block as usize) {
        for (i, number) in (0..).zip(&mut stripe) {
            let (x, y) = (i % width, top + i / width);
            let [red, green, blue, _] = picture.texel(x, y);
            if red != green || red != blue {
                return Err(vec![resources::not_grey(place, path, [x, y])]);
            }
            *number = picture.depth.part(red, levels) as u8;
        }
        builder.stripe(&stripe);
    }
    builder.finish().ok_or_else(|| {
        vec![resources::no_table(
            place,
            "this map has too many blocks that change",
            "at most 8192 rows of them fit",
        )]
    })
}

/// A map in the making, stripe by stripe from the top.
pub struct Builder {
    block: usize,
    depth: u32,
    /// An entry for each block so far, row by row.
    blocks: Vec<i32>,
    /// Blocks in a row.
    columns: usize,
    /// The words of the stored blocks, one after the other.
    pool: Vec<u32>,
    /// Where blocks of these words are stored.
    known: HashMap<Box<[u32]>, i32>,
}

impl Builder {
    /// Of blocks of so many texels a side, with numbers below `levels`; none where a block is no power
    /// of two from 4 to 64, or the levels are not 2 to 256.
    pub fn new(block: u32, levels: u32) -> Option<Builder> {
        let fits = block.is_power_of_two() && (4..=64).contains(&block) && (2..=256).contains(&levels);
        fits.then(|| Builder {
            block: block as usize,
            depth: depth(levels),
            blocks: Vec::new(),
            columns: 0,
            pool: Vec::new(),
            known: HashMap::new(),
        })
    }

    /// Adds rows of numbers, as many as a block is high, from left to right.
    pub fn stripe(&mut self, numbers: &[u8]) {
        let width = numbers.len() / self.block;
        self.columns = width / self.block;
        for column in 0..self.columns {
            let rows = numbers.chunks_exact(width.max(1));
            let side = self.block;
            let block = rows.flat_map(move |row| &row[column * side..][..side]);
            let entry = self.entry(block.copied());
            self.blocks.push(entry);
        }
    }

    /// The entry of a block, by its numbers row by row.
    fn entry(&mut self, block: impl Iterator<Item = u8> + Clone) -> i32 {
        let first = block.clone().next().unwrap_or(0);
        if block.clone().all(|number| number == first) {
            return -1 - i32::from(first);
        }
        let words = self.words(block);
        if let Some(entry) = self.known.get(&words) {
            return *entry;
        }
        let entry = self.known.len() as i32;
        self.pool.extend(&words);
        self.known.insert(words, entry);
        entry
    }

    /// The words that hold a block: whole texels of four.
    fn words(&self, block: impl Iterator<Item = u8>) -> Box<[u32]> {
        let mut words = vec![0; self.texels() * 4];
        for (bit, number) in (0..).step_by(self.depth as usize).zip(block) {
            if let Some(word) = words.get_mut(bit / 32) {
                *word |= u32::from(number) << (bit % 32);
            }
        }
        words.into()
    }

    /// Texels of the pool for a block.
    fn texels(&self) -> usize {
        texels(self.block as u32, self.depth) as usize
    }

    /// The textures, `blocks` and `pool`; none if the pool would be too high, or nothing was added.
    pub fn finish(self) -> Option<Vec<Made>> {
        let stored = self.known.len() as u32;
        let across = across(self.block as u32, self.depth);
        let width = stored.clamp(1, across) * self.texels() as u32;
        let height = stored.div_ceil(across).max(1);
        if height > MAX_SIDE || self.blocks.is_empty() {
            return None;
        }
        let rows = self.blocks.len() / self.columns;
        let missing = (width * height * 4) as usize - self.pool.len();
        let words = self.pool.iter().copied().chain(std::iter::repeat_n(0, missing));
        Some(vec![
            Made::integers(
                "blocks",
                Format::R32Sint,
                [self.columns as u32, rows as u32],
                self.blocks.into_iter(),
            ),
            Made::integers("pool", Format::Rgba32Sint, [width, height], words.map(u32::cast_signed)),
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::Builder;
    use texgraph_compiler::resource::pixel_map::{across, texels};

    /// The number at a place, read as the shader does.
    fn at(made: &[super::Made], (block, depth): (u32, u32), x: u32, y: u32) -> u32 {
        let word = |made: &super::Made, i: u32| {
            let bytes = &made.bytes[i as usize * 4..][..4];
            i32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
        };
        let entry = word(&made[0], y / block * made[0].table.width + x / block);
        let Ok(entry) = u32::try_from(entry) else { return (-1 - entry).unsigned_abs() };
        let (across, texels) = (across(block, depth), texels(block, depth));
        let bit = (y % block * block + x % block) * depth;
        let texel = entry / across * made[1].table.width + entry % across * texels + bit / 128;
        (word(&made[1], texel * 4 + bit / 32 % 4).cast_unsigned() >> (bit % 32)) & ((1 << depth) - 1)
    }

    #[test]
    fn every_number_is_found_again() {
        for (block, levels, depth) in [(4, 2, 1), (8, 3, 2), (16, 11, 4), (64, 256, 8)] {
            let number = |x: u32, y: u32| ((x * x / 97 + y / 5) % levels) as u8;
            let mut builder = Builder::new(block, levels).expect("it can be made");
            for top in (0..3 * block).step_by(block as usize) {
                let cells = (0..block).flat_map(|y| (0..5 * block).map(move |x| (x, top + y)));
                builder.stripe(&cells.map(|(x, y)| number(x, y)).collect::<Vec<u8>>());
            }
            let made = builder.finish().expect("it fits");
            for (x, y) in (0..3 * block).flat_map(|y| (0..5 * block).map(move |x| (x, y))) {
                assert_eq!(at(&made, (block, depth), x, y), u32::from(number(x, y)), "{block}: {x}, {y}");
            }
        }
    }

    /// Rings around the middle of a map of 16,384 texels a side. Their contour is counted in steps from
    /// a texel to the next, which a slanted line takes about 4/π of its length.
    #[test]
    fn a_large_mask_takes_less_than_a_fiftieth_of_its_texels() {
        const SIDE: u32 = 16_384;
        let ring = |x: u32, y: u32| {
            let [x, y] = [x, y].map(|i| i64::from(i) * 2 - i64::from(SIDE) + 1);
            let radius = (x * x + y * y).isqrt();
            u8::from(radius < 16_000 && radius / 2600 % 2 == 0)
        };
        let mut builder = Builder::new(16, 2).expect("it can be made");
        let (mut stripe, mut steps) = (vec![0; SIDE as usize * 16], 0);
        for top in (0..SIDE).step_by(16) {
            for (i, number) in (0..).zip(&mut stripe) {
                *number = ring(i % SIDE, top + i / SIDE);
            }
            let rows = stripe.chunks_exact(SIDE as usize);
            steps += rows.flat_map(|row| row.windows(2)).filter(|pair| pair[0] != pair[1]).count();
            builder.stripe(&stripe);
        }
        // As many upright steps as level ones, by symmetry.
        let contour = 2.0 * steps as f64 * std::f64::consts::FRAC_PI_4 / f64::from(SIDE);
        let made = builder.finish().expect("it fits");
        let bytes: u64 = made.iter().map(|made| made.table.bytes()).sum();
        let share = bytes as f64 / (f64::from(SIDE) * f64::from(SIDE));
        println!("contour of {contour:.1} sides: {bytes} bytes, {:.2} % of dense", share * 100.0);
        assert!(contour >= 10.0 && share < 0.02, "contour {contour}, share {share}");
    }
}
