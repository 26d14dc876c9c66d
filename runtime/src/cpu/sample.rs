//! Filtered samples, as WebGPU defines them: the level of detail from the coordinate's derivatives,
//! four texels of two levels weighed linearly, or the nearest texel of the nearest level.
//!
//! GPUs round the weights to some eight bits and may take the level of detail from a whole quad of
//! pixels; here all is computed in f32 at the pixel. Samplers have no anisotropy (yet).
//!
//! A batch is sampled level by level: which texels a level gives and how they are weighed is worked
//! out for all lanes side by side, then the texels are gathered for the lanes that want the level.

use super::mask::{Mask, gather, lanes_of};
use super::texture::{Level, Texels, Texture};
use glam::Vec4;
use texgraph_compiler::intrinsic::{LANES, Lanes, ZERO, floor};
use texgraph_compiler::manifest::{Filter, Wrap};

impl Texture {
    /// The level of detail of a coordinate whose screen derivatives are (dx, dy): log2 of the
    /// longer one in texels. Not clamped; −∞ for a constant coordinate.
    pub fn level(&self, [dx, dy]: [[&Lanes; 2]; 2], mask: Mask, to: &mut Lanes) {
        let size = self.size().as_vec2();
        let squared = |[x, y]: [&Lanes; 2], i: usize| {
            let (x, y) = (f32::from_bits(x[i]) * size.x, f32::from_bits(y[i]) * size.y);
            x * x + y * y
        };
        let longer: [f32; LANES] = std::array::from_fn(|i| squared(dx, i).max(squared(dy, i)));
        // Neighbours often have the same gradient, and logarithms are dear.
        let (mut last, mut level) = (f32::NAN, 0);
        for i in lanes_of(mask) {
            if longer[i] != last {
                last = longer[i];
                level = (0.5 * libm::log2f(last)).to_bits();
            }
            to[i] = level;
        }
    }

    /// Filtered samples; level and layer are clamped to what there is.
    pub fn sample(&self, [x, y]: [&Lanes; 2], level: &Lanes, layer: &Lanes, mask: Mask, to: &mut [Lanes; 4]) {
        let Texels::Float(texels) = &self.texels else {
            *to = [ZERO; 4];
            return;
        };
        let fetch = Fetch { texture: self, texels, x: self.places(x), y: self.places(y), layer };
        let last = self.levels.len() - 1;
        // `max` turns what is no number into 0.
        let level = level.map(|bits| f32::from_bits(bits).max(0.0).min(last as f32));
        match self.filter {
            Filter::Nearest => fetch.nearest(&level, mask, to),
            Filter::Linear => fetch.linear(&level, mask, to),
        }
    }

    /// Coordinates in the first period: exact before they are scaled to texels, and finite.
    fn places(&self, lanes: &Lanes) -> Places {
        match self.wrap {
            Wrap::Repeat => places(lanes, |x| x - floor(x)),
            Wrap::Mirror => places(lanes, |x| x - 2.0 * floor(x * 0.5)),
            Wrap::Clamp => places(lanes, |x| x.clamp(-1.0, 2.0)),
        }
    }
}

/// A coordinate of all lanes, or something like it.
type Places = [f32; LANES];

fn places(lanes: &Lanes, reduce: impl Fn(f32) -> f32) -> Places {
    lanes.map(|bits| {
        let reduced = reduce(f32::from_bits(bits));
        if reduced.is_finite() { reduced } else { 0.0 }
    })
}

/// What is sampled: where, of which layer.
struct Fetch<'a> {
    texture: &'a Texture,
    texels: &'a [Vec4],
    x: Places,
    y: Places,
    layer: &'a Lanes,
}

impl Fetch<'_> {
    /// Two levels weighed linearly; one where the level of detail is whole.
    fn linear(&self, level: &Places, mask: Mask, to: &mut [Lanes; 4]) {
        let upper = level.map(floor);
        let mut left = mask;
        while let Some(first) = lanes_of(left).next() {
            let sharp = upper[first];
            let same = left & gather(|i| upper[i] == sharp);
            left &= !same;
            self.two_levels(sharp as usize, &level.map(|level| level - sharp), same, to);
        }
    }

    /// A level, weighed with the next by the share of that.
    fn two_levels(&self, level: usize, share: &Places, mask: Mask, to: &mut [Lanes; 4]) {
        let Some(sharp) = self.bilinear(level) else { return };
        let next = if mask & gather(|i| share[i] != 0.0) != 0 { self.bilinear(level + 1) } else { None };
        for i in lanes_of(mask) {
            let texel = match &next {
                Some(next) if share[i] != 0.0 => sharp.texel(i).lerp(next.texel(i), share[i]),
                _ => sharp.texel(i),
            };
            store(texel, i, to);
        }
    }

    /// Four texels of a level weighed linearly.
    fn bilinear(&self, level: usize) -> Option<Bilinear<'_>> {
        let level = self.texture.levels.get(level)?;
        let (x, y) = (self.axis(&self.x, level.size.x), self.axis(&self.y, level.size.y));
        let rows = |row: &[i32; LANES]| row.map(|row| row * level.size.x);
        Some(Bilinear { fetch: self, level, rows: [rows(&y.low), rows(&y.high)], x, down: y.share })
    }

    /// The nearest texel of the nearest level.
    fn nearest(&self, level: &Places, mask: Mask, to: &mut [Lanes; 4]) {
        for i in lanes_of(mask) {
            let level = ((level[i] + 0.5).ceil() as usize).max(1) - 1;
            let Some(level) = self.texture.levels.get(level) else { continue };
            let place = |place: f32, size: i32| self.inside(small_int(floor(place * size as f32)), size);
            let (x, y) = (place(self.x[i], level.size.x), place(self.y[i], level.size.y));
            let at = (y * level.size.x + x) as usize;
            store(self.layer(level, i).get(at).copied().unwrap_or(Vec4::ZERO), i, to);
        }
    }

    /// The texels of a lane's layer.
    fn layer(&self, level: &Level, lane: usize) -> &[Vec4] {
        let layer = (self.layer[lane] as i32).clamp(0, level.layers - 1);
        self.texels.get(level.index(layer)..).unwrap_or(&[])
    }

    /// The two texels next to each place along one axis.
    fn axis(&self, places: &Places, size: i32) -> Axis {
        match self.texture.wrap {
            Wrap::Repeat => axis(places, size, |at| wrapped(at, size)),
            Wrap::Clamp => axis(places, size, |at| at.clamp(0, size - 1)),
            Wrap::Mirror => axis(places, size, |at| mirrored(at, size)),
        }
    }

    /// A texel's place inside a level.
    fn inside(&self, at: i32, size: i32) -> i32 {
        match self.texture.wrap {
            Wrap::Repeat => wrapped(at, size),
            Wrap::Clamp => at.clamp(0, size - 1),
            Wrap::Mirror => mirrored(at, size),
        }
    }
}

/// Four texels of a level in all lanes, and their shares.
struct Bilinear<'a> {
    fetch: &'a Fetch<'a>,
    level: &'a Level,
    x: Axis,
    /// Where the upper and the lower row begin.
    rows: [[i32; LANES]; 2],
    /// The share of the lower row.
    down: Places,
}

impl Bilinear<'_> {
    /// What they come to in a lane.
    #[inline(always)]
    fn texel(&self, i: usize) -> Vec4 {
        let texels = self.fetch.layer(self.level, i);
        let texel = |x: i32, row: i32| texels.get((row + x) as usize).copied().unwrap_or(Vec4::ZERO);
        let row = |row: i32| texel(self.x.low[i], row).lerp(texel(self.x.high[i], row), self.x.share[i]);
        row(self.rows[0][i]).lerp(row(self.rows[1][i]), self.down[i])
    }
}

/// A texel becomes what a lane has.
fn store(texel: Vec4, i: usize, to: &mut [Lanes; 4]) {
    for (to, component) in to.iter_mut().zip(texel.to_array()) {
        to[i] = component.to_bits();
    }
}

/// Two texels next to each other along an axis, and the share of the second.
struct Axis {
    low: [i32; LANES],
    high: [i32; LANES],
    share: Places,
}

fn axis(places: &Places, size: i32, inside: impl Fn(i32) -> i32) -> Axis {
    let mut axis = Axis { low: [0; LANES], high: [0; LANES], share: [0.0; LANES] };
    let places = places.iter().map(|place| place * size as f32 - 0.5);
    let slots = axis.low.iter_mut().zip(&mut axis.high).zip(&mut axis.share);
    for (((low, high), share), place) in slots.zip(places) {
        let first = floor(place);
        let number = small_int(first);
        (*low, *high, *share) = (inside(number), inside(number + 1), place - first);
    }
    axis
}

/// A whole number below 2²² as an int: the sum's last bits. `as` would not be done side by side.
fn small_int(x: f32) -> i32 {
    const BASE: f32 = 12_582_912.0;
    (x + BASE).to_bits().wrapping_sub(BASE.to_bits()) as i32
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
