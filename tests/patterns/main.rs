//! What the blocks of pattern based textures give, seen by the CPU renderer at a pixel a cell: the
//! proportions in which they draw, and what they cost.

mod animation;
mod color;
mod coordinates;
mod cost;
mod distribution;
mod fades;
mod far;
mod layers;
mod material;
mod motifs;
mod oversampled;
mod shapes;
mod space;
mod splat;
mod stochastic_volumes;
mod streams;
mod strips;
mod support;
mod surface;
mod transition;
mod volumes;
