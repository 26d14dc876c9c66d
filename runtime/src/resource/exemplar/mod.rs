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
mod gauss;
mod inverse;
mod light;
mod ranks;

use super::table::{self, Made};
use super::decode::{self, Decoded};
use super::pyramid;
use crate::project::Project;
use axes::Axes;
use light::Light;
use ranks::Ranks;
pub use ranks::scatter;
use texgraph_compiler::diagnostic::{Diagnostic, Place};
use texgraph_compiler::manifest::{Borders, Encoding, Format};

/// What is asked for.
pub struct Wanted {
    /// How the picture's numbers are read.
    pub encoding: Encoding,
    /// 3, 1 of a grey picture, 2 of normals.
    pub channels: u32,
    /// Whether parts may cross the picture's borders.
    pub borders: Borders,
    /// Texels across `inverse`.
    pub lut: u32,
}

/// Makes the textures.
///
/// # Errors
/// The picture can't be read, or is larger than a texture may be.
pub fn make(
    project: &Project,
    place: Place,
    path: &str,
    wanted: &Wanted,
) -> Result<Vec<Made>, Vec<Diagnostic>> {
    let file = decode::open(project, path, place)?;
    table::check(place, path, Format::Rgba8Unorm, file.size, 1)?;
    let picture = file.decode()?;
    Ok(of_picture(&picture, wanted))
}

/// The textures of a picture: fields `gaussian` and `inverse`.
pub fn of_picture(picture: &Decoded, wanted: &Wanted) -> Vec<Made> {
    let light = Light::new(picture, wanted.encoding, wanted.channels as usize);
    let axes = Axes::of(&light);
    let ranks = Ranks::of(&light, &axes);
    let inside = match wanted.borders {
        Borders::Auto => borders::differ(&light),
        Borders::Repeat => false,
        Borders::Inside => true,
    };
    let mut squares = Vec::new();
    let gaussian = pyramid::extend("gaussian", light.size, |bytes| ranks.write(&light, &axes, bytes), |level| {
        squares.push(inverse::mean_squares(level));
    });
    let inverse = inverse::make(&axes, &ranks, &squares, wanted.lut, inside);
    vec![gaussian, inverse]
}

/// The axes of a picture's colours, unit vectors, as many as it has channels.
pub fn axes(picture: &Decoded, wanted: &Wanted) -> Vec<[f32; 3]> {
    let axes = Axes::of(&Light::new(picture, wanted.encoding, wanted.channels as usize));
    axes.directions[..axes.channels].to_vec()
}
