//! `exemplar`: a picture made Gaussian and the way back, for tiling and blending (Deliot & Heitz,
//! Procedural Stochastic Textures by Tiling and Blending, GPU Zen 2, 2019, §1.3 to §1.5). Fields
//! `gaussian` and `inverse`.
//!
//! A colour is seen along the principal axes of all colours (`axes`). Along each axis the picture's
//! numbers are replaced by Gaussian numbers of the same ranks (`ranks`); `inverse` holds what Gaussian
//! numbers stand for, filtered for each mip level. All of it is done in linear light, where averages
//! are right; normals are slopes, for the same reason.

mod axes;
mod borders;
mod crossover;
mod gauss;
mod inverse;
mod light;
mod ranks;

use super::decode::{self, Decoded};
use super::patterns::Sheet;
use super::pyramid;
use super::table::{self, Made};
use crate::project::Project;
use axes::Axes;
pub use borders::SEAM;
pub use crossover::Crossover;
pub(crate) use gauss::cumulative;
use glam::{DVec3, Vec4};
use light::Light;
use ranks::Ranks;
pub use ranks::scatter;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};
use texgraph_compiler::manifest::{Borders, Compression, Encoding, Format};

/// What is asked for.
pub struct Wanted {
    /// How the picture's numbers are read.
    pub encoding: Encoding,
    /// 3, 1 of a grey picture, 2 of normals.
    pub channels: u32,
    /// Slices of a volume, which stand one below another in the picture; 1 of a picture.
    pub slices: u32,
    /// Whether parts may cross the picture's borders.
    pub borders: Borders,
    /// Texels across `inverse`.
    pub lut: u32,
    /// Compressed textures have Gaussian numbers that spread as far as the channel does (§1.6), so that
    /// the errors of compression weigh alike. [`of_picture`] gives them as they are.
    pub compress: Compression,
}

/// Makes the textures.
///
/// # Errors
/// The picture can't be read, is larger than a texture may be, or can't be compressed as wanted.
pub fn make(
    project: &Project,
    place: Place,
    path: &str,
    wanted: &Wanted,
) -> Result<Vec<Made>, Vec<Diagnostic>> {
    let file = decode::open(project, path, place)?;
    table::check(place, path, Format::Rgba8Unorm, file.size, 1)?;
    if wanted.compress != Compression::None && file.size.iter().any(|side| side % 4 != 0) {
        return Err(vec![resources::uneven_compression(place, path, file.size)]);
    }
    let picture = file.decode()?;
    if wanted.compress == Compression::Bc1 && !picture.is_opaque() {
        return Err(vec![resources::transparency_of_bc1(place, path)]);
    }
    Ok(of_picture(&picture, wanted))
}

/// Makes the textures of a volume: `gaussian` has a layer for each slice.
///
/// # Errors
/// As of [`make`]; or the slices are not of one form.
pub fn make_volume(
    project: &Project,
    place: Place,
    paths: &[String],
    grid: [u32; 2],
    wanted: &Wanted,
) -> Result<Vec<Made>, Vec<Diagnostic>> {
    let sheet = Sheet::open(project, place, paths, grid)?;
    table::check(place, sheet.path(), Format::Rgba8Unorm, sheet.cell, sheet.count)?;
    let picture = Decoded::stacked(&sheet.decode()?, grid).ok_or_else(|| {
        let message = "the slices of a volume are stored in different ways";
        vec![resources::no_table(place, message, "all grey or all coloured, of as many bits")]
    })?;
    Ok(of_picture(&picture, wanted))
}

/// The textures of a picture: fields `gaussian` and `inverse`.
pub fn of_picture(picture: &Decoded, wanted: &Wanted) -> Vec<Made> {
    let light = wanted.light(picture);
    let axes = Axes::of(&light);
    let mut ranks = Ranks::of(&light, &axes, wanted.compress != Compression::None);
    let inside = match wanted.borders {
        Borders::Auto => borders::differ(&light, wanted.slices),
        Borders::Repeat => false,
        Borders::Inside => true,
    };
    if wanted.slices > 1 {
        let (gaussian, squares) = blocks(&light, &axes, &mut ranks, wanted.slices);
        return vec![gaussian, inverse::make(&axes, &ranks, &squares, wanted.lut, inside)];
    }
    let is_fine = wanted.encoding == Encoding::Normal && wanted.compress == Compression::None;
    let (mut squares, mut floats) = (Vec::new(), Vec::new());
    let gaussian = pyramid::extend(
        "gaussian",
        light.size,
        |bytes| ranks.write(&light, &axes, bytes),
        |level| {
            squares.push(inverse::mean_squares(level));
            // Of normals every step shows, where something glitters.
            if is_fine {
                floats.push(level.to_vec());
            }
        },
    );
    let gaussian = if is_fine { pyramid::deepen(&gaussian, &floats) } else { gaussian };
    let inverse = inverse::make(&axes, &ranks, &squares, wanted.lut, inside);
    vec![gaussian, inverse]
}

/// The Gaussian numbers of a volume, and their mean squares on its levels from 1 on.
fn blocks(light: &Light<'_>, axes: &Axes, ranks: &mut Ranks, slices: u32) -> (Made, Vec<DVec3>) {
    let [width, height] = [light.size[0], light.size[1] / slices];
    let mut first = vec![0; 4 * light.texels()];
    ranks.write(light, axes, &mut first);
    let number = |texel: &[u8; 4]| Vec4::from_array(texel.map(f32::from)) / 255.0;
    let (texels, _) = first.as_chunks::<4>();
    let texel = |slice: u32, x: u32, y: u32| number(&texels[((slice * height + y) * width + x) as usize]);
    let gaussian = pyramid::build_blocks("gaussian", Format::Rgba8Unorm, [width, height], [1, slices], texel);
    let (table, bytes) = (&gaussian.table, &gaussian.bytes);
    let squares = table.levels[1..].iter().map(|level| {
        let length = level.bytes(table.format) as usize;
        let (texels, _) = bytes[level.offset as usize..][..length].as_chunks::<4>();
        inverse::mean_squares(&texels.iter().map(number).collect::<Vec<Vec4>>())
    });
    let mut squares: Vec<DVec3> = squares.collect();
    // Slices beyond the last level's group: all is lost one level further.
    if slices > 1 << squares.len() {
        let sum = texels.iter().map(|texel| number(texel).truncate().as_dvec3()).sum::<DVec3>();
        squares.push((sum / texels.len() as f64).powf(2.0));
    }
    (gaussian, squares)
}

impl Wanted {
    fn light<'a>(&self, picture: &'a Decoded) -> Light<'a> {
        Light::new(picture, self.encoding, self.channels as usize)
    }
}

/// The axes of a picture's colours, unit vectors, as many as it has channels.
pub fn axes(picture: &Decoded, wanted: &Wanted) -> Vec<[f32; 3]> {
    let axes = Axes::of(&wanted.light(picture));
    axes.directions[..axes.channels].to_vec()
}

/// Across, down and through slices: the mean difference of neighbours, and that of the first texel from
/// the last. Where the second is more than [`SEAM`] times the first the picture is taken not to wrap.
pub fn steps(picture: &Decoded, wanted: &Wanted) -> [[f64; 2]; 3] {
    borders::steps(&wanted.light(picture), wanted.slices)
}

#[cfg(test)]
mod tests {
    use super::gauss::share_below;
    use super::{Wanted, axes, of_picture, scatter};
    use crate::resource::decode::Decoded;
    use crate::resource::srgb_to_linear;
    use half::f16;
    use texgraph_compiler::manifest::{Borders, Compression, Encoding};

    const WANTED: Wanted = Wanted {
        encoding: Encoding::Srgb,
        channels: 3,
        slices: 1,
        borders: Borders::Auto,
        lut: 256,
        compress: Compression::None,
    };

    /// A picture without structure whose colours are correlated and lie on few values.
    fn grains(size: [u32; 2]) -> Vec<u8> {
        let texels = size[0] * size[1];
        let grain = |i: u32| {
            let [a, b] = [scatter(3 * i) >> 25, scatter(3 * i + 1) >> 26];
            [a + 20, a / 2 + b, 90 + b / 4].map(|sample| sample as u8)
        };
        (0..texels).flat_map(grain).collect()
    }

    fn floats(bytes: &[u8]) -> Vec<f32> {
        bytes.chunks_exact(2).map(|pair| f16::from_le_bytes([pair[0], pair[1]]).to_f32()).collect()
    }

    /// Listing 1.8, with the truncated distribution and equal values in hashed order.
    fn sorted_codes(values: &[f32]) -> Vec<u8> {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by_key(|i| scatter(*i as u32));
        order.sort_by(|i, j| values[*i].total_cmp(&values[*j]));
        let mut codes = vec![0; values.len()];
        for (rank, i) in order.into_iter().enumerate() {
            let share = (rank as f64 + 0.5) / values.len() as f64;
            let below = |code: &u32| share_below((f64::from(*code) - 0.5) / 255.0) <= share;
            codes[i] = (1..=255).take_while(below).count() as u8;
        }
        codes
    }

    #[test]
    fn ranks_are_those_of_sorting() {
        for size in [[64, 64], [37, 53], [1, 300], [200, 1], [1, 1]] {
            let pixels = grains(size);
            let picture = Decoded::rgb(size, pixels.clone()).expect("a picture");
            let made = of_picture(&picture, &WANTED);
            for (channel, axis) in axes(&picture, &WANTED).iter().enumerate() {
                let light = |i: usize| srgb_to_linear(f64::from(pixels[i]) / 255.0) as f32;
                let place = |i: usize| {
                    light(3 * i) * axis[0] + light(3 * i + 1) * axis[1] + light(3 * i + 2) * axis[2]
                };
                let values: Vec<f32> = (0..pixels.len() / 3).map(place).collect();
                let ends = values.iter().fold((f32::MAX, f32::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
                let expected =
                    if ends.1 - ends.0 < 1e-4 { vec![128; values.len()] } else { sorted_codes(&values) };
                let found: Vec<u8> =
                    made[0].bytes.chunks_exact(4).take(values.len()).map(|t| t[channel]).collect();
                assert_eq!(found, expected, "{size:?}, channel {channel}");
            }
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bytes() {
        let picture = Decoded::rgb([512, 300], grains([512, 300])).expect("a picture");
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| {
                of_picture(&picture, &WANTED).into_iter().map(|made| made.bytes).collect::<Vec<_>>()
            })
        };
        assert_eq!(on(1), on(3));
    }

    #[test]
    fn the_last_row_is_the_mean() {
        let size = [128, 128];
        let pixels = grains(size);
        let made = of_picture(&Decoded::rgb(size, pixels.clone()).expect("a picture"), &WANTED);
        let inverse = floats(&made[1].bytes);
        let width = WANTED.lut as usize;
        for k in 0..3 {
            let light = pixels[k..].iter().step_by(3).map(|code| srgb_to_linear(f64::from(*code) / 255.0));
            let mean = light.sum::<f64>() / f64::from(size[0] * size[1]);
            let entry = |channel: usize, k: usize| inverse[4 * ((channel * 14 + 13) * width + width / 2) + k];
            let part = |channel: usize| f64::from(entry(channel, k) + entry(channel, 3));
            let sum: f64 = (0..3).map(part).sum();
            assert!((sum - mean).abs() < 0.5 / 255.0, "{sum} for {mean}");
        }
    }

    #[test]
    fn a_flat_picture_stays_as_it_is() {
        let made = of_picture(&Decoded::rgb([8, 8], [10, 200, 60].repeat(64)).expect("a picture"), &WANTED);
        assert!(made[0].bytes.chunks_exact(4).all(|texel| texel == [128, 128, 128, 255]));
        let inverse = floats(&made[1].bytes);
        let expected = [10.0, 200.0, 60.0].map(|code| srgb_to_linear(code / 255.0) as f32);
        for x in [0, 100, 255] {
            for (k, expected) in expected.iter().enumerate() {
                let entry = |channel: usize, k: usize| inverse[4 * (channel * 14 * 256 + x) + k];
                let sum: f32 = (0..3).map(|channel| entry(channel, k) + entry(channel, 3)).sum();
                assert!((sum - expected).abs() < 1e-3, "{sum} for {expected}");
            }
        }
    }

    #[test]
    fn a_picture_that_does_not_wrap_is_seen() {
        let inside = |pixels: Vec<u8>| {
            let made = of_picture(&Decoded::rgb([64, 64], pixels).expect("a picture"), &WANTED);
            floats(&made[1].bytes).ends_with(&[1.0])
        };
        let slope = (0..64 * 64_u32).flat_map(|i| [(i % 64 * 4) as u8; 3]).collect();
        let wave = (0..64 * 64_u32).flat_map(|i| {
            let angle = f64::from(i % 64) / 64.0 * std::f64::consts::TAU;
            [(128.0 + 100.0 * angle.sin()) as u8; 3]
        });
        assert!(inside(slope));
        assert!(!inside(wave.collect()));
    }
}
