//! The flat view of a texture: what its inputs are when a rectangle of `uv` fills a picture.
//!
//! Every float input is linear across the picture, so one [`Slope`] says what it is worth at any
//! place and what its screen derivatives are. Both renderers take it from here: the GPU at the
//! corners of a tile, the CPU at the centres of pixels.

use crate::render::Request;

/// A float input over a picture, linear in the place: a rise for each component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope([Rise; 4]);

/// One component of an input.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rise {
    /// At the picture's upper left corner.
    corner: f64,
    /// The change one pixel to the right.
    right: f64,
    /// The change one pixel down.
    down: f64,
}

impl Rise {
    /// At a place in pixels; the first pixel's centre is (0.5, 0.5).
    #[inline(always)]
    pub fn at(self, x: f64, y: f64) -> f32 {
        (self.corner + self.right * x + self.down * y) as f32
    }

    /// Whether it is the same at all places.
    pub fn is_constant(self) -> bool {
        self.right == 0.0 && self.down == 0.0
    }

    /// Whether it is the same in all places of a row.
    pub fn is_constant_across(self) -> bool {
        self.right == 0.0
    }
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

    fn constant(value: [f64; 4]) -> Slope {
        Slope(value.map(|corner| Rise { corner, ..Rise::default() }))
    }

    fn across(request: &Request) -> Slope {
        let [x0, y0, x1, y1] = request.region;
        let [width, height] = request.size.map(f64::from);
        Slope([
            Rise { corner: x0, right: (x1 - x0) / width, down: 0.0 },
            Rise { corner: y0, right: 0.0, down: (y1 - y0) / height },
            Rise::default(),
            Rise::default(),
        ])
    }

    /// At a place in pixels.
    #[cfg(feature = "gpu")]
    pub fn at(&self, x: f64, y: f64) -> [f32; 4] {
        self.0.map(|rise| rise.at(x, y))
    }

    /// One component.
    pub fn component(&self, i: usize) -> Rise {
        self.0[i]
    }

    /// The screen derivative to the right.
    pub fn right(&self) -> [f32; 4] {
        self.0.map(|rise| rise.right as f32)
    }

    /// The screen derivative down.
    pub fn down(&self) -> [f32; 4] {
        self.0.map(|rise| rise.down as f32)
    }
}
