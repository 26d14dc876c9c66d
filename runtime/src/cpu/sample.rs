//! Filtered samples, as WebGPU defines them: the level of detail from the coordinate's derivatives,
//! four texels of two levels weighed linearly, or the nearest texel of the nearest level.
//!
//! GPUs round the weights to some eight bits and may take the level of detail from a whole quad of
//! pixels; here all is computed in f32 at the pixel. Samplers have no anisotropy (yet).

use super::texture::{Level, Texture};
use glam::{IVec2, Vec2, Vec4};
use texgraph_compiler::manifest::{Filter, Wrap};

impl Texture {
    /// The level of detail of a coordinate whose screen derivatives are `dx` and `dy`: log2 of the
    /// longer one in texels. Not clamped; −∞ for a constant coordinate.
    pub fn level(&self, dx: Vec2, dy: Vec2) -> f32 {
        let size = self.size().as_vec2();
        let longer = (dx * size).length_squared().max((dy * size).length_squared());
        0.5 * libm::log2f(longer)
    }

    /// A filtered sample; the level and the layer are clamped to what there is.
    pub fn sample(&self, at: Vec2, lod: f32, layer: i32) -> Vec4 {
        let last = self.levels.len() - 1;
        // `max` turns what is no number into 0.
        let lod = lod.max(0.0).min(last as f32);
        let layer = layer.clamp(0, self.levels[0].layers - 1);
        match self.filter {
            Filter::Nearest => {
                self.nearest(&self.levels[((lod + 0.5).ceil() as usize).max(1) - 1], at, layer)
            }
            Filter::Linear => {
                let (upper, share) = (lod.floor() as usize, lod.fract());
                let sharp = self.bilinear(&self.levels[upper], at, layer);
                if share == 0.0 {
                    return sharp;
                }
                sharp.lerp(self.bilinear(&self.levels[upper + 1], at, layer), share)
            }
        }
    }

    fn nearest(&self, level: &Level, at: Vec2, layer: i32) -> Vec4 {
        let place = self.place(at) * level.size.as_vec2();
        self.texel(level, self.inside(place.floor().as_ivec2(), level.size), layer)
    }

    fn bilinear(&self, level: &Level, at: Vec2, layer: i32) -> Vec4 {
        let place = self.place(at) * level.size.as_vec2() - 0.5;
        let first = place.floor();
        let share = place - first;
        let low = self.inside(first.as_ivec2(), level.size);
        let high = self.inside(first.as_ivec2() + 1, level.size);
        let texel = |x: i32, y: i32| self.texel(level, IVec2::new(x, y), layer);
        let upper = texel(low.x, low.y).lerp(texel(high.x, low.y), share.x);
        let lower = texel(low.x, high.y).lerp(texel(high.x, high.y), share.x);
        upper.lerp(lower, share.y)
    }

    /// The coordinate in the first period: exact before it is scaled to texels, and finite.
    fn place(&self, at: Vec2) -> Vec2 {
        let reduced = match self.wrap {
            Wrap::Repeat => at - at.floor(),
            Wrap::Mirror => at - 2.0 * (at * 0.5).floor(),
            Wrap::Clamp => at.clamp(Vec2::splat(-1.0), Vec2::splat(2.0)),
        };
        Vec2::select(reduced.is_finite_mask(), reduced, Vec2::ZERO)
    }

    /// A texel's place inside the level.
    fn inside(&self, at: IVec2, size: IVec2) -> IVec2 {
        match self.wrap {
            Wrap::Repeat => at.rem_euclid(size),
            Wrap::Clamp => at.clamp(IVec2::ZERO, size - 1),
            Wrap::Mirror => {
                let folded = at.rem_euclid(2 * size);
                folded.min(2 * size - 1 - folded)
            }
        }
    }
}
