//! The flat view of a texture: what its inputs are when a rectangle of `uv` fills a picture.
//!
//! Every float input is linear across the picture, so one [`Slope`] says what it is worth at any
//! place and what its screen derivatives are. Both renderers take it from here: the GPU at the
//! corners of a tile, the CPU at the centres of pixels.

use crate::render::Request;

/// A float input over a picture, linear in the place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// At the picture's upper left corner.
    corner: [f64; 4],
    /// The change one pixel to the right.
    right: [f64; 4],
    /// The change one pixel down.
    down: [f64; 4],
}

impl Slope {
    /// Of an input by its name. What a flat picture knows nothing of is 0.
    pub fn of(name: &str, request: &Request) -> Slope {
        match name {
            "uv" | "uv2" | "position" => Slope::across(request),
            "normal" | "view" => Slope::constant([0.0, 0.0, 1.0, 0.0]),
            "tangent" => Slope::constant([1.0, 0.0, 0.0, 1.0]),
            "vertex_color" => Slope::constant([1.0; 4]),
            "time" => Slope::constant([f64::from(request.time), 0.0, 0.0, 0.0]),
            _ => Slope::constant([0.0; 4]),
        }
    }

    fn constant(corner: [f64; 4]) -> Slope {
        Slope { corner, right: [0.0; 4], down: [0.0; 4] }
    }

    fn across(request: &Request) -> Slope {
        let [x0, y0, x1, y1] = request.region;
        let [width, height] = request.size.map(f64::from);
        Slope {
            corner: [x0, y0, 0.0, 0.0],
            right: [(x1 - x0) / width, 0.0, 0.0, 0.0],
            down: [0.0, (y1 - y0) / height, 0.0, 0.0],
        }
    }

    /// At a place in pixels; the first pixel's centre is (0.5, 0.5).
    #[cfg(feature = "gpu")]
    pub fn at(&self, x: f64, y: f64) -> [f32; 4] {
        [0, 1, 2, 3].map(|i| self.component(i, x, y))
    }

    /// One component of it at a place in pixels.
    pub fn component(&self, i: usize, x: f64, y: f64) -> f32 {
        (self.corner[i] + self.right[i] * x + self.down[i] * y) as f32
    }

    /// Whether a component is the same at all places.
    pub fn is_constant(&self, i: usize) -> bool {
        self.right[i] == 0.0 && self.down[i] == 0.0
    }

    /// Whether a component is the same in all places of a column.
    pub fn is_constant_down(&self, i: usize) -> bool {
        self.down[i] == 0.0
    }

    /// Whether a component is the same in all places of a row.
    pub fn is_constant_across(&self, i: usize) -> bool {
        self.right[i] == 0.0
    }

    /// The screen derivative to the right.
    pub fn right(&self) -> [f32; 4] {
        self.right.map(|x| x as f32)
    }

    /// The screen derivative down.
    pub fn down(&self) -> [f32; 4] {
        self.down.map(|x| x as f32)
    }
}
