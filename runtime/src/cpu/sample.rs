//! Filtered samples, as WebGPU defines them: the level of detail from the coordinate's derivatives,
//! four texels of two levels weighed linearly, or the nearest texel of the nearest level.
//!
//! GPUs round the weights to some eight bits and may take the level of detail from a whole quad of
//! pixels; here all is computed in f32 at the pixel. Samplers have no anisotropy (yet).
//!
//! A batch is sampled level by level: which texels a level gives and how they are weighed is worked
//! out for all lanes side by side, then the texels are gathered for the lanes that want the level.

use super::mask::{Mask, each_lane, gather, lanes_of};
use super::texture::{Level, Texels, Texture};
use glam::Vec4;
use texgraph_compiler::intrinsic::{LANES, Lanes, ZERO, floor, wide};
use texgraph_compiler::manifest::{Filter, Wrap};

/// A coordinate in all lanes, or something like it.
type Places = [f32; LANES];

impl Texture {
    /// The level of detail of a coordinate whose screen derivatives are (dx, dy): log2 of the
    /// longer one in texels. Not clamped; −∞ for a constant coordinate.
    pub fn level(&self, [dx, dy]: [[&Lanes; 2]; 2], mask: Mask, to: &mut Lanes) {
        let size = self.size().as_vec2();
        let squared = |[x, y]: [&Lanes; 2], i: usize| {
            let (x, y) = (f32::from_bits(x[i]) * size.x, f32::from_bits(y[i]) * size.y);
            x * x + y * y
        };
        let longer: Places = std::array::from_fn(|i| squared(dx, i).max(squared(dy, i)));
        // Neighbours often have the same gradient, and logarithms are dear.
        let (mut last, mut level) = (f32::NAN, 0);
        each_lane(mask, |i| {
            if longer[i] != last {
                last = longer[i];
                level = (0.5 * libm::log2f(last)).to_bits();
            }
            to[i] = level;
        });
    }
}

/// Takes samples; keeps its memory from one to the next.
pub struct Sampler {
    /// Coordinates in the first period.
    x: Places,
    y: Places,
    /// Levels of detail, clamped, ...
    lod: Places,
    /// ... rounded down, ...
    upper: Places,
    /// ... and what is left: the share of the next level.
    share: Places,
    /// The texels of two levels.
    taps: [Taps; 2],
}

/// Four texels of a level in all lanes.
struct Taps {
    x: Axis,
    y: Axis,
}

/// Two texels next to each other along an axis, and the share of the second.
struct Axis {
    low: [i32; LANES],
    high: [i32; LANES],
    share: Places,
}

impl Default for Sampler {
    fn default() -> Sampler {
        let none = || Axis { low: [0; LANES], high: [0; LANES], share: [0.0; LANES] };
        let taps = || Taps { x: none(), y: none() };
        let [x, y, lod, upper, share] = [[0.0; LANES]; 5];
        Sampler { x, y, lod, upper, share, taps: [taps(), taps()] }
    }
}

impl Sampler {
    /// Filtered samples of a texture; level and layer are clamped to what there is.
    pub fn sample(
        &mut self,
        texture: &Texture,
        [x, y]: [&Lanes; 2],
        [lod, layer]: [&Lanes; 2],
        mask: Mask,
        to: &mut [Lanes; 4],
    ) {
        let Texels::Float(texels) = &texture.texels else {
            *to = [ZERO; 4];
            return;
        };
        reduce(texture.wrap, x, &mut self.x);
        reduce(texture.wrap, y, &mut self.y);
        let last = (texture.levels.len() - 1) as f32;
        for (to, bits) in self.lod.iter_mut().zip(lod) {
            // `max` turns what is no number into 0.
            *to = f32::from_bits(*bits).max(0.0).min(last);
        }
        let layers = Layers { texels, layer };
        match texture.filter {
            Filter::Nearest => self.nearest(texture, &layers, mask, to),
            Filter::Linear => self.linear(texture, &layers, mask, to),
        }
    }

    /// Two levels weighed linearly; one where the level of detail is whole.
    fn linear(&mut self, texture: &Texture, layers: &Layers<'_>, mask: Mask, to: &mut [Lanes; 4]) {
        for ((lod, upper), share) in self.lod.iter().zip(&mut self.upper).zip(&mut self.share) {
            *upper = floor(*lod);
            *share = lod - *upper;
        }
        let mut left = mask;
        while let Some(first) = lanes_of(left).next() {
            let upper = self.upper[first];
            let same = left & gather(|i| self.upper[i] == upper);
            left &= !same;
            self.two_levels(texture, upper as usize, layers, same, to);
        }
    }

    /// A level, weighed with the next by the share of that.
    fn two_levels(
        &mut self,
        texture: &Texture,
        upper: usize,
        layers: &Layers<'_>,
        mask: Mask,
        to: &mut [Lanes; 4],
    ) {
        let Some(sharp) = texture.levels.get(upper) else { return };
        let next = texture.levels.get(upper + 1);
        let blurred = next.filter(|_| mask & gather(|i| self.share[i] != 0.0) != 0);
        let (x, y, share, [near, far]) = (&self.x, &self.y, &self.share, &mut self.taps);
        near.find(texture.wrap, sharp, x, y);
        let Some(blurred) = blurred else {
            return each_lane(
                mask,
                #[inline(always)]
                |i| store(near.texel(layers.texels(sharp, i), i), i, to),
            );
        };
        far.find(texture.wrap, blurred, x, y);
        each_lane(
            mask,
            #[inline(always)]
            |i| {
                let sharp = near.texel(layers.texels(sharp, i), i);
                let blurred = far.texel(layers.texels(blurred, i), i);
                store(if share[i] == 0.0 { sharp } else { sharp.lerp(blurred, share[i]) }, i, to);
            },
        );
    }

    /// The nearest texel of the nearest level.
    fn nearest(&self, texture: &Texture, layers: &Layers<'_>, mask: Mask, to: &mut [Lanes; 4]) {
        for i in lanes_of(mask) {
            let level = ((self.lod[i] + 0.5).ceil() as usize).max(1) - 1;
            let Some(level) = texture.levels.get(level) else { continue };
            let place = |at: f32, size: i32| inside(texture.wrap, small_int(floor(at * size as f32)), size);
            let (x, y) = (place(self.x[i], level.size.x), place(self.y[i], level.size.y));
            let at = (y * level.size.x + x) as usize;
            store(layers.texels(level, i).get(at).copied().unwrap_or(Vec4::ZERO), i, to);
        }
    }
}

/// The texels of all levels and layers, and which layer a lane wants.
struct Layers<'a> {
    texels: &'a [Vec4],
    layer: &'a Lanes,
}

impl Layers<'_> {
    /// The texels of a lane's layer of a level, row by row.
    #[inline(always)]
    fn texels(&self, level: &Level, lane: usize) -> &[Vec4] {
        let layer = (self.layer[lane] as i32).clamp(0, level.layers - 1);
        self.texels.get(level.index(layer)..).unwrap_or(&[])
    }
}

impl Taps {
    /// Finds the texels around places. Rows are told by where they begin.
    fn find(&mut self, wrap: Wrap, level: &Level, x: &Places, y: &Places) {
        self.x.find(wrap, level.size.x, x);
        self.y.find(wrap, level.size.y, y);
        wide(
            #[inline(always)]
            || {
                scale(&mut self.y.low, level.size.x);
                scale(&mut self.y.high, level.size.x);
            },
        );
    }

    /// What they come to in a lane.
    #[inline(always)]
    fn texel(&self, texels: &[Vec4], i: usize) -> Vec4 {
        let texel = |x: i32, row: i32| texels.get((row + x) as usize).copied().unwrap_or(Vec4::ZERO);
        let row = |row: i32| texel(self.x.low[i], row).lerp(texel(self.x.high[i], row), self.x.share[i]);
        row(self.y.low[i]).lerp(row(self.y.high[i]), self.y.share[i])
    }
}

impl Axis {
    fn find(&mut self, wrap: Wrap, size: i32, places: &Places) {
        match wrap {
            Wrap::Repeat => self.each(size, places, move |at| wrapped(at, size)),
            Wrap::Clamp => self.each(size, places, move |at| at.clamp(0, size - 1)),
            Wrap::Mirror => self.each(size, places, move |at| mirrored(at, size)),
        }
    }

    #[inline(always)]
    fn each(&mut self, size: i32, places: &Places, inside: impl Fn(i32) -> i32 + Copy) {
        wide(
            #[inline(always)]
            || find_texels(&mut self.low, &mut self.high, &mut self.share, size, places, inside),
        );
    }
}

/// Multiplies numbers.
#[inline(always)]
fn scale(numbers: &mut [i32; LANES], factor: i32) {
    for number in numbers {
        *number *= factor;
    }
}

// Loops inside `wide` are functions of their own: their arguments are told apart there.

/// Writes, for each place along an axis, the two texels around it and the share of the second.
#[inline(always)]
fn find_texels(
    low: &mut [i32; LANES],
    high: &mut [i32; LANES],
    share: &mut Places,
    size: i32,
    places: &Places,
    inside: impl Fn(i32) -> i32,
) {
    for (((low, high), share), place) in low.iter_mut().zip(high).zip(share).zip(places) {
        let place = place * size as f32 - 0.5;
        let first = floor(place);
        let number = small_int(first);
        (*low, *high, *share) = (inside(number), inside(number + 1), place - first);
    }
}

/// Coordinates in the first period: exact before they are scaled to texels, and finite.
fn reduce(wrap: Wrap, lanes: &Lanes, to: &mut Places) {
    match wrap {
        Wrap::Repeat => reduce_by(lanes, to, |x| x - floor(x)),
        Wrap::Mirror => reduce_by(lanes, to, |x| x - 2.0 * floor(x * 0.5)),
        Wrap::Clamp => reduce_by(lanes, to, |x| x.clamp(-1.0, 2.0)),
    }
}

#[inline(always)]
fn reduce_by(lanes: &Lanes, to: &mut Places, reduce: impl Fn(f32) -> f32) {
    #[inline(always)]
    fn each(lanes: &Lanes, to: &mut Places, reduce: impl Fn(f32) -> f32) {
        for (to, bits) in to.iter_mut().zip(lanes) {
            let reduced = reduce(f32::from_bits(*bits));
            *to = if reduced.is_finite() { reduced } else { 0.0 };
        }
    }
    wide(
        #[inline(always)]
        || each(lanes, to, reduce),
    );
}

/// A texel becomes what a lane has.
#[inline(always)]
fn store(texel: Vec4, i: usize, to: &mut [Lanes; 4]) {
    for (to, component) in to.iter_mut().zip(texel.to_array()) {
        to[i] = component.to_bits();
    }
}

/// A whole number below 2²² as an int: the sum's last bits. `as` would not be done side by side.
fn small_int(x: f32) -> i32 {
    const BASE: f32 = 12_582_912.0;
    (x + BASE).to_bits().wrapping_sub(BASE.to_bits()) as i32
}

/// A texel's place inside a level.
fn inside(wrap: Wrap, at: i32, size: i32) -> i32 {
    match wrap {
        Wrap::Repeat => wrapped(at, size),
        Wrap::Clamp => at.clamp(0, size - 1),
        Wrap::Mirror => mirrored(at, size),
    }
}

/// A texel's place in a picture that repeats; it is less than a period outside.
fn wrapped(at: i32, size: i32) -> i32 {
    let up = if at < 0 { at + size } else { at };
    if up >= size { up - size } else { up }
}

/// A texel's place in a picture whose neighbours are mirrored.
fn mirrored(at: i32, size: i32) -> i32 {
    let folded = wrapped(at, 2 * size);
    folded.min(2 * size - 1 - folded)
}
