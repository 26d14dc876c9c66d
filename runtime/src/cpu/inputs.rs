//! The inputs of a texture, for the pixels of a batch.

use crate::flat::Slope;
use texgraph_compiler::intrinsic::{LANES, Lanes};

/// One component of an input that changes from pixel to pixel.
#[derive(Clone, Copy)]
pub struct Source {
    /// The input.
    pub slope: Slope,
    /// Which of its components.
    pub component: usize,
}

/// The places of a batch's pixels, at their centres.
pub struct Places {
    x: [f64; LANES],
    y: [f64; LANES],
}

impl Places {
    /// Of the pixels of a picture from one on, row by row.
    pub fn from(first: usize, width: usize) -> Places {
        let (mut x, mut y) = (first % width, first / width);
        let mut places = Places { x: [0.0; LANES], y: [0.0; LANES] };
        for (to_x, to_y) in places.x.iter_mut().zip(&mut places.y) {
            (*to_x, *to_y) = (x as f64 + 0.5, y as f64 + 0.5);
            x += 1;
            if x == width {
                (x, y) = (0, y + 1);
            }
        }
        places
    }
}

impl Source {
    /// What it is at some places.
    pub fn fill(&self, places: &Places, lanes: &mut Lanes) {
        for ((to, x), y) in lanes.iter_mut().zip(&places.x).zip(&places.y) {
            *to = self.slope.component(self.component, *x, *y).to_bits();
        }
    }
}
