//! The dimensions of what pictures hold.

/// What a pattern or a map is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A row of texels.
    Line,
    /// A rectangle.
    Plane,
    /// So many rectangles one after the other.
    Space {
        /// How many.
        depth: u32,
    },
}

impl Shape {
    /// How many rectangles it consists of.
    pub fn slices(self) -> u32 {
        match self {
            Shape::Line | Shape::Plane => 1,
            Shape::Space { depth } => depth,
        }
    }
}
