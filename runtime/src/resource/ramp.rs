//! `ramp`: colours along a line, filtered ahead. Field `colors`.
//!
//! A row holds the ramp filtered by one Gaussian; a shader that knows how far a place spreads in a
//! pixel reads between two rows. Beyond its ends the ramp goes on with the colours there. Filtering is
//! of light, whatever the space in which the colours are blended.

use super::encoding::{Writer, srgb_to_linear};
use super::table::Made;
use glam::{DVec3, DVec4};
use rayon::iter::{IndexedParallelIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;
use texgraph_compiler::manifest::{Format, Space, Stop, Table};

/// Texels from the first stop to the last.
const WIDTH: u32 = 256;
/// One as it is, then two for each octave of spread from 1/512 of the ramp to twice the ramp.
const ROWS: u32 = 22;
/// Pieces of one colour that the ramp is cut into before it is filtered.
const PIECES: u32 = 4 * (WIDTH - 1);

/// Makes the texture. Stops go from low to high; without any the ramp is transparent.
pub fn make(stops: &[Stop], space: Space) -> Made {
    let table = Table::with_levels(Format::Rgba16Float, [WIDTH, ROWS], 1, 1);
    let mut bytes = vec![0; table.bytes() as usize];
    let ramp = Ramp::new(stops, space);
    let at = |i: u32| f64::from(i) / f64::from(WIDTH - 1);
    let pieces: Vec<DVec4> =
        (0..PIECES).map(|i| ramp.color((f64::from(i) + 0.5) / f64::from(PIECES))).collect();
    let ends = [ramp.color(0.0), ramp.color(1.0)];
    let writer = Writer::new(Format::Rgba16Float);
    let texel_bytes = Format::Rgba16Float.bytes() as usize;
    bytes.par_chunks_exact_mut(WIDTH as usize * texel_bytes).enumerate().for_each(|(row, bytes)| {
        for (x, slot) in (0..).zip(bytes.chunks_exact_mut(texel_bytes)) {
            let color = match row {
                0 => ramp.color(at(x)),
                row => filtered(&pieces, ends, at(x), deviation(row)),
            };
            writer.write(color.as_vec4(), slot);
        }
    });
    Made { field: "colors", table, bytes }
}

/// The standard deviation of a row's filter: less what blending two texels spreads by itself, a
/// sixth of a squared texel.
fn deviation(row: usize) -> f64 {
    let texel = 1.0 / f64::from(WIDTH - 1);
    (libm::exp2(row as f64 - 19.0) - texel * texel / 6.0).sqrt()
}

/// The mean under a Gaussian.
fn filtered(pieces: &[DVec4], [first, last]: [DVec4; 2], at: f64, deviation: f64) -> DVec4 {
    let below = |place: f64| 0.5 * libm::erfc((at - place) / (deviation * std::f64::consts::SQRT_2));
    let mut before = below(0.0);
    let mut sum = first * before + last * (1.0 - below(1.0));
    for (i, piece) in (1..).zip(pieces) {
        let next = below(f64::from(i) / pieces.len() as f64);
        sum += *piece * (next - before);
        before = next;
    }
    sum
}

/// Colours along a line from 0 to 1, in the space where they are blended.
struct Ramp {
    space: Space,
    stops: Vec<(f64, DVec4)>,
}

impl Ramp {
    fn new(stops: &[Stop], space: Space) -> Ramp {
        let ends = stops.first().zip(stops.last());
        let (low, high) = ends.map_or((0.0, 1.0), |(a, b)| (f64::from(a.at), f64::from(b.at)));
        let stop = |stop: &Stop| ((f64::from(stop.at) - low) / (high - low), encode(stop.color, space));
        Ramp { space, stops: stops.iter().map(stop).collect() }
    }

    /// Linear and premultiplied.
    fn color(&self, at: f64) -> DVec4 {
        let next = self.stops.partition_point(|(place, _)| *place <= at);
        let mixed = match (next.checked_sub(1).and_then(|i| self.stops.get(i)), self.stops.get(next)) {
            (Some((low, from)), Some((high, to))) => from.lerp(*to, (at - low) / (high - low)),
            (Some((_, only)), None) | (None, Some((_, only))) => *only,
            (None, None) => DVec4::ZERO,
        };
        decode(mixed, self.space)
    }
}

/// A premultiplied colour in the space, still premultiplied.
fn encode(color: [f32; 4], space: Space) -> DVec4 {
    let [r, g, b, alpha] = color.map(f64::from);
    let straight = if alpha > 0.0 { DVec3::new(r, g, b) / alpha } else { DVec3::ZERO };
    let inside = match space {
        Space::Linear => straight,
        Space::Srgb => straight.map(linear_to_srgb),
        Space::Oklab => to_oklab(straight),
    };
    (inside * alpha).extend(alpha)
}

/// And back.
fn decode(color: DVec4, space: Space) -> DVec4 {
    let alpha = color.w;
    let inside = if alpha > 0.0 { color.truncate() / alpha } else { DVec3::ZERO };
    let straight = match space {
        Space::Linear => inside,
        Space::Srgb => inside.map(srgb_to_linear),
        Space::Oklab => from_oklab(inside).max(DVec3::ZERO),
    };
    (straight * alpha).extend(alpha)
}

/// IEC 61966-2-1.
fn linear_to_srgb(light: f64) -> f64 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * libm::pow(light, 1.0 / 2.4) - 0.055 }
}

/// Linear sRGB to Oklab (Ottosson 2020).
fn to_oklab(c: DVec3) -> DVec3 {
    let cones = DVec3::new(
        c.dot(DVec3::new(0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9)),
        c.dot(DVec3::new(0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6)),
        c.dot(DVec3::new(0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5)),
    );
    let roots = cones.map(libm::cbrt);
    DVec3::new(
        roots.dot(DVec3::new(0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8)),
        roots.dot(DVec3::new(1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9)),
        roots.dot(DVec3::new(0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0)),
    )
}

/// And back.
fn from_oklab(c: DVec3) -> DVec3 {
    let roots = DVec3::new(
        c.dot(DVec3::new(1.0, 0.396_337_777_4, 0.215_803_757_3)),
        c.dot(DVec3::new(1.0, -0.105_561_345_8, -0.063_854_172_8)),
        c.dot(DVec3::new(1.0, -0.089_484_177_5, -1.291_485_548_0)),
    );
    let cones = roots * roots * roots;
    DVec3::new(
        cones.dot(DVec3::new(4.076_741_662_1, -3.307_711_591_3, 0.230_969_929_2)),
        cones.dot(DVec3::new(-1.268_438_004_6, 2.609_757_401_1, -0.341_319_396_5)),
        cones.dot(DVec3::new(-0.004_196_086_3, -0.703_418_614_7, 1.707_614_701_0)),
    )
}

#[cfg(test)]
mod tests {
    use super::{Ramp, decode, encode, filtered};
    use glam::DVec4;
    use texgraph_compiler::manifest::{Space, Stop};

    const STOPS: [Stop; 2] =
        [Stop { at: 2.0, color: [0.2, 0.1, 0.0, 0.5] }, Stop { at: 4.0, color: [0.9, 0.3, 1.0, 1.0] }];

    #[test]
    fn every_space_keeps_the_stops() {
        for space in [Space::Linear, Space::Srgb, Space::Oklab] {
            for Stop { color, .. } in STOPS {
                let back = decode(encode(color, space), space).as_vec4();
                let off = (back - glam::Vec4::from_array(color)).abs().max_element();
                assert!(off < 1e-5, "{space:?}: {back}, {color:?}");
            }
        }
    }

    #[test]
    fn white_is_lightness_1_and_grey_has_no_colour() {
        let white = encode([1.0; 4], Space::Oklab);
        assert!((white - DVec4::new(1.0, 0.0, 0.0, 1.0)).abs().max_element() < 1e-6, "{white}");
    }

    #[test]
    fn a_straight_ramp_is_filtered_to_itself_inside_and_to_the_mean_from_afar() {
        let ramp = Ramp::new(&STOPS, Space::Linear);
        let pieces: Vec<DVec4> = (0..1000).map(|i| ramp.color((f64::from(i) + 0.5) / 1000.0)).collect();
        let ends = [ramp.color(0.0), ramp.color(1.0)];
        let middle = (ends[0] + ends[1]) / 2.0;
        assert!((filtered(&pieces, ends, 0.5, 0.05) - middle).abs().max_element() < 1e-9);
        assert!((filtered(&pieces, ends, 0.3, 0.02) - ramp.color(0.3)).abs().max_element() < 1e-9);
        assert!((filtered(&pieces, ends, 0.3, 100.0) - middle).abs().max_element() < 1e-2);
    }
}
