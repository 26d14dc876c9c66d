//! Pictures to be tiled and blended at random (Deliot & Heitz 2019).

use super::{Arguments, Made, constructors};
use crate::diagnostic::Diagnostic;
use crate::graph::Constant;
use crate::manifest::{Borders, Compression, Encoding, Recipe, Wrap};

/// Colours have three channels, or are grey with `channels: 1`; normals are slopes along two axes.
pub fn make(a: &Arguments) -> Result<Made, Diagnostic> {
    let sampler = a.sampler(Wrap::Repeat)?;
    let encoding = a.encoding();
    let asked = a.count("channels", 1, 3)?;
    let channels = match (encoding, asked) {
        (Encoding::Normal, 2 | 3) => 2,
        (Encoding::Srgb | Encoding::Linear, 1 | 3) => asked,
        _ => return Err(constructors::channels_of_exemplar(a.place("channels"), asked, encoding)),
    };
    let lut = a.count("lut", 128, 1024)?;
    let borders = match a.word("wrap") {
        "repeat" => Borders::Repeat,
        "inside" => Borders::Inside,
        _ => Borders::Auto,
    };
    let inside = match borders {
        Borders::Repeat => 0,
        Borders::Inside => 1,
        Borders::Auto => 2,
    };
    let compress = match a.word("compress") {
        "bc1" => Compression::Bc1,
        "bc7" => Compression::Bc7,
        _ => Compression::None,
    };
    let normals = i32::from(encoding == Encoding::Normal);
    let bc = match compress {
        Compression::None => 0,
        Compression::Bc1 => 1,
        Compression::Bc7 => 7,
    };
    let constants = [
        ("channels", channels as i32),
        ("normals", normals),
        ("taps", i32::from(sampler.anisotropy)),
        ("inside", inside),
        ("width", lut as i32),
        ("bc", bc),
        ("levels", Recipe::INVERSE_LEVELS as i32),
    ];
    let path = a.paths("path").into_iter().next().unwrap_or_default();
    Ok(Made {
        recipe: Recipe::Exemplar { path, encoding, channels, borders, lut, compress },
        constants: constants.map(|(name, value)| (name, Constant::ints(&[value]))).into(),
        sampler: Some(sampler),
        lender: None,
    })
}
