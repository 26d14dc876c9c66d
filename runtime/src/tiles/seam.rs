//! What a seam between two pictures costs: the less, the less it is seen.

use super::bitmap::Texel;

/// What differences are divided by where both pictures are flat, in levels of all channels: without
/// it a faint step in a flat place would cost more than anything else.
const FLAT: u32 = 24;

/// The cost of differences of one level each at both texels, without gradients.
const SCALE: u32 = 64 * FLAT;

/// Passing from picture `a` to picture `b` between two neighbouring texels, of which each is given
/// as it is in both: what the pictures differ by there, over how much they change anyway (Kwatra et
/// al. 2003, §3.1). At least 1, so that of equal seams the shorter one is cheaper.
pub fn cost(a: [Texel; 2], b: [Texel; 2]) -> u32 {
    let apart = distance(a[0], b[0]) + distance(a[1], b[1]);
    let gradient = distance(a[0], a[1]) + distance(b[0], b[1]);
    1 + SCALE * apart / (FLAT + gradient) / FLAT
}

/// `share` of one texel, the rest of another: codes are averaged, as an eye sees them.
pub fn fade(a: Texel, b: Texel, share: f32) -> Texel {
    [0, 1, 2, 3].map(|i| (f32::from(b[i]) + (f32::from(a[i]) - f32::from(b[i])) * share).round() as u8)
}

/// The sum of the differences of all channels, in levels.
pub fn distance(a: Texel, b: Texel) -> u32 {
    a.iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(b))).sum()
}
