//! The inputs of a texture, for the pixels of a batch.

use crate::flat::Slope;
use texgraph_compiler::intrinsic::{LANES, Lanes, wide};

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
    /// Whether all are in one row.
    one_row: bool,
}

impl Default for Places {
    fn default() -> Places {
        Places { x: [0.0; LANES], y: [0.0; LANES], one_row: false }
    }
}

impl Places {
    /// Goes to the pixels of a picture from one on, row by row.
    pub fn go(&mut self, first: usize, width: usize) {
        let (mut column, mut row, mut from) = (first % width, first / width, 0);
        self.one_row = column + LANES <= width;
        while from < LANES {
            let to = LANES.min(from + width - column);
            for (x, at) in self.x[from..to].iter_mut().zip(column as u32..) {
                *x = f64::from(at) + 0.5;
            }
            self.y[from..to].fill(row as f64 + 0.5);
            (column, row, from) = (0, row + 1, to);
        }
    }
}

impl Source {
    /// What it is at some places.
    pub fn fill(&self, places: &Places, lanes: &mut Lanes) {
        if places.one_row && self.slope.is_constant_across(self.component) {
            let value = self.slope.component(self.component, places.x[0], places.y[0]);
            return lanes.fill(value.to_bits());
        }
        wide(
            #[inline(always)]
            || self.write(places, lanes),
        );
    }

    #[inline(always)]
    fn write(self, places: &Places, lanes: &mut Lanes) {
        if self.slope.is_constant_down(self.component) {
            for (to, x) in lanes.iter_mut().zip(&places.x) {
                *to = self.slope.component(self.component, *x, 0.0).to_bits();
            }
        } else {
            for ((to, x), y) in lanes.iter_mut().zip(&places.x).zip(&places.y) {
                *to = self.slope.component(self.component, *x, *y).to_bits();
            }
        }
    }
}
