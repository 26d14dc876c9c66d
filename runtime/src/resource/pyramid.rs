//! Mip pyramids: every level is the mean of what it covers, for sizes that are no power of two too.
//!
//! WebGPU's level l of a side of n texels has max(1, ⌊n / 2^l⌋) texels. A texel of an odd level's
//! successor covers a little more than two texels, so it weighs three by the area it covers (a
//! polyphase box filter); every level then keeps the mean of level 0. Each level is computed from
//! the one above in f32, before that one is rounded to its texel format.

use super::encoding::Writer;
use super::table::Made;
use glam::Vec4;
use rayon::iter::{
    IndexedParallelIterator, IntoParallelIterator, IntoParallelRefMutIterator, ParallelIterator,
};
use rayon::slice::ParallelSliceMut;
use texgraph_compiler::manifest::{Format, Table};

/// Builds all levels of all layers. `texel(layer, x, y)` gives level 0; it is read several times
/// rather than stored, for a large picture's floats take four times its bytes.
pub fn build(
    field: &'static str,
    format: Format,
    size: [u32; 2],
    layers: u32,
    texel: impl Fn(u32, u32, u32) -> Vec4 + Sync,
) -> Made {
    build_blocks(field, format, size, [layers, 1], texel)
}

/// Builds the further levels of a picture of 8-bit numbers whose level 0 `write` writes. `visit` sees
/// each of them before it is rounded, the largest first.
pub fn extend(
    field: &'static str,
    size: [u32; 2],
    write: impl FnOnce(&mut [u8]),
    mut visit: impl FnMut(&[Vec4]),
) -> Made {
    let table = Table::mipmapped(Format::Rgba8Unorm, size, 1);
    let mut bytes = vec![0; table.bytes() as usize];
    let (first, mut rest) = bytes.split_at_mut(size[0] as usize * size[1] as usize * 4);
    write(first);
    let (texels, _) = first.as_chunks::<4>();
    let mut above: Option<Plane> = None;
    for level in &table.levels[1..] {
        let plane = match &above {
            None => halve(size, |x, y| {
                let [r, g, b, a] = texels[y as usize * size[0] as usize + x as usize];
                Vec4::new(f32::from(r), f32::from(g), f32::from(b), f32::from(a)) / 255.0
            }),
            Some(above) => halve(above.size, |x, y| above.texel(x, y)),
        };
        visit(&plane.texels);
        let (this, further) = rest.split_at_mut(level.bytes_per_row as usize * level.height as usize);
        this.par_chunks_exact_mut(4).zip(&plane.texels).with_min_len(4096).for_each(|(bytes, texel)| {
            // Numbers of 0..1 are rounded by cutting off.
            let codes = (*texel * 255.0 + 0.5).to_array();
            bytes.iter_mut().zip(codes).for_each(|(byte, code)| *byte = code as u8);
        });
        (rest, above) = (further, Some(plane));
    }
    Made { field, table, bytes }
}

/// The same in 16-bit floats, from the first level as it is and the others before they were rounded.
pub fn deepen(made: &Made, levels: &[Vec<Vec4>]) -> Made {
    let [width, height] = [made.table.levels[0].width, made.table.levels[0].height];
    let table = Table::mipmapped(Format::Rgba16Float, [width, height], 1);
    let writer = Writer::new(Format::Rgba16Float);
    let mut bytes = vec![0; table.bytes() as usize];
    let first = made.bytes.as_chunks::<4>().0[..width as usize * height as usize].iter();
    let first = first.map(|texel| Vec4::from_array(texel.map(f32::from)) / 255.0);
    let texels = first.chain(levels.iter().flatten().copied());
    bytes.chunks_exact_mut(8).zip(texels).for_each(|(slot, texel)| writer.write(texel, slot));
    Made { field: made.field, table, bytes }
}

/// Builds all levels of blocks, each of so many layers, its slices. Level l of a slice is the mean of
/// the group of 2^l slices that it belongs to, counted from the block's first; of those there are.
pub fn build_blocks(
    field: &'static str,
    format: Format,
    size: [u32; 2],
    [blocks, depth]: [u32; 2],
    texel: impl Fn(u32, u32, u32) -> Vec4 + Sync,
) -> Made {
    let table = Table::mipmapped(format, size, blocks * depth);
    let mut bytes = vec![0; table.bytes() as usize];
    let writer = Writer::new(format);
    let mut layers = by_layer(&table, &mut bytes);
    layers.par_chunks_mut(depth as usize).enumerate().for_each(|(block, slices)| {
        let first = block as u32 * depth;
        write_block(&writer, size, slices, |slice, x, y| texel(first + slice, x, y));
    });
    Made { field, table, bytes }
}

/// The bytes of every level, for each layer.
fn by_layer<'a>(table: &Table, mut bytes: &'a mut [u8]) -> Vec<Vec<&'a mut [u8]>> {
    let mut layers: Vec<Vec<&mut [u8]>> = (0..table.layers).map(|_| Vec::new()).collect();
    for level in &table.levels {
        let length = level.bytes_per_row as usize * level.height as usize;
        for layer in &mut layers {
            let (first, rest) = bytes.split_at_mut(length);
            layer.push(first);
            bytes = rest;
        }
    }
    layers
}

/// Writes the levels of a block's slices, the largest first.
fn write_block(
    writer: &Writer,
    size: [u32; 2],
    slices: &mut [Vec<&mut [u8]>],
    texel: impl Fn(u32, u32, u32) -> Vec4 + Sync,
) {
    let levels = slices.first().map_or(0, Vec::len);
    let mut above: Vec<Plane> = Vec::new();
    for level in 0..levels {
        if level > 0 {
            let groups = 0..(slices.len() as u32).div_ceil(1 << level);
            let grouped = groups.into_par_iter().map(|group| {
                let pair = Pair::new(slices.len() as u32, level, group);
                match above.first() {
                    None => halve(size, |x, y| pair.mean(|slice| texel(slice, x, y))),
                    Some(first) => {
                        halve(first.size, |x, y| pair.mean(|group| above[group as usize].texel(x, y)))
                    }
                }
            });
            above = grouped.collect();
        }
        slices.par_iter_mut().enumerate().for_each(|(slice, levels)| match above.get(slice >> level) {
            None => write_level(writer, size[0], levels[level], |x, y| texel(slice as u32, x, y)),
            Some(plane) => write_level(writer, plane.size[0], levels[level], |x, y| plane.texel(x, y)),
        });
    }
}

/// The one or two groups of slices that a group of the next level consists of.
struct Pair {
    first: u32,
    /// The second group's share; none where there is no second.
    second: Option<f32>,
}

impl Pair {
    /// For a group of 2^level slices of a block.
    fn new(depth: u32, level: usize, group: u32) -> Pair {
        let half = 1 << (level - 1);
        let begins = group * 2 * half;
        let second = depth.saturating_sub(begins + half).min(half);
        Pair { first: group * 2, second: (second > 0).then(|| second as f32 / (half + second) as f32) }
    }

    fn mean(&self, part: impl Fn(u32) -> Vec4) -> Vec4 {
        let first = part(self.first);
        self.second.map_or(first, |share| first.lerp(part(self.first + 1), share))
    }
}

fn write_level(writer: &Writer, width: u32, bytes: &mut [u8], texel: impl Fn(u32, u32) -> Vec4 + Sync) {
    let texel_bytes = writer.format().bytes() as usize;
    bytes.par_chunks_mut(width as usize * texel_bytes).enumerate().for_each(|(y, row)| {
        for (x, slot) in row.chunks_exact_mut(texel_bytes).enumerate() {
            writer.write(texel(x as u32, y as u32), slot);
        }
    });
}

/// One level in floats.
struct Plane {
    size: [u32; 2],
    texels: Vec<Vec4>,
}

impl Plane {
    fn texel(&self, x: u32, y: u32) -> Vec4 {
        self.texels[y as usize * self.size[0] as usize + x as usize]
    }
}

/// The next smaller level.
fn halve(size: [u32; 2], texel: impl Fn(u32, u32) -> Vec4 + Sync) -> Plane {
    let next = size.map(|side| (side / 2).max(1));
    let mut texels = vec![Vec4::ZERO; next[0] as usize * next[1] as usize];
    let columns: Vec<Taps> = (0..next[0]).map(|x| Taps::new(size[0], x)).collect();
    let is_even = size.iter().all(|side| side % 2 == 0);
    texels.par_chunks_mut(next[0] as usize).enumerate().for_each(|(y, row)| {
        if is_even {
            let y = 2 * y as u32;
            for (x, slot) in (0..).step_by(2).zip(row) {
                let across = |y: u32| texel(x, y) * 0.5 + texel(x + 1, y) * 0.5;
                *slot = across(y) * 0.5 + across(y + 1) * 0.5;
            }
            return;
        }
        let rows = Taps::new(size[1], y as u32);
        for (slot, columns) in row.iter_mut().zip(&columns) {
            *slot = rows.sum(|y| columns.sum(|x| texel(x, y)));
        }
    });
    Plane { size: next, texels }
}

/// The texels that one texel of the next level covers along an axis, with their shares.
struct Taps {
    first: u32,
    count: usize,
    weights: [f32; 3],
}

impl Taps {
    /// For texel `i` of the level after one of `n` texels.
    fn new(n: u32, i: u32) -> Taps {
        let (m, i64) = (f64::from(n / 2), f64::from(i));
        let share = |x: f64| (x / f64::from(n)) as f32;
        match n {
            1 => Taps { first: 0, count: 1, weights: [1.0, 0.0, 0.0] },
            n if n % 2 == 0 => Taps { first: 2 * i, count: 2, weights: [0.5, 0.5, 0.0] },
            _ => Taps { first: 2 * i, count: 3, weights: [share(m - i64), share(m), share(i64 + 1.0)] },
        }
    }

    fn sum(&self, texel: impl Fn(u32) -> Vec4) -> Vec4 {
        let taps = (self.first..).zip(&self.weights[..self.count]);
        taps.fold(Vec4::ZERO, |sum, (at, weight)| sum + texel(at) * *weight)
    }
}

#[cfg(test)]
mod tests {
    use super::{Taps, halve};
    use glam::Vec4;

    #[test]
    fn shares_cover_every_texel_equally() {
        for n in [1, 2, 3, 4, 5, 7, 9, 31, 100, 101, 8191] {
            let mut covered = vec![0.0; n as usize];
            let m = (n / 2).max(1);
            for i in 0..m {
                let taps = Taps::new(n, i);
                for k in 0..taps.count {
                    covered[taps.first as usize + k] += f64::from(taps.weights[k]);
                }
            }
            let even = f64::from(m) / f64::from(n);
            assert!(covered.iter().all(|share| (share - even).abs() < 1e-6), "{n}");
        }
    }

    #[test]
    fn an_odd_level_keeps_the_mean() {
        let value = |x: u32, y: u32| ((x * 7 + y * 13) % 11) as f32;
        let plane = halve([5, 3], |x, y| Vec4::splat(value(x, y)));
        assert_eq!(plane.size, [2, 1]);
        let before: f32 = (0..15).map(|i| value(i % 5, i / 5)).sum::<f32>() / 15.0;
        let after = (plane.texels[0].x + plane.texels[1].x) / 2.0;
        assert!((before - after).abs() < 1e-5);
    }
}
