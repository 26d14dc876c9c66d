//! Pictures to be tiled and blended at random (Deliot & Heitz 2019).

use super::{Arguments, Cells, MAX_LAYERS, Made, SamplerState, constructors};
use crate::diagnostic::Diagnostic;
use crate::graph::Constant;
use crate::manifest::{Borders, Compression, Encoding, Filter, Recipe, Wrap};

/// Colours have three channels, or are grey with `channels: 1`; normals are slopes along two axes.
pub fn make(a: &Arguments) -> Result<Made, Diagnostic> {
    let sampler = a.sampler(Wrap::Repeat)?;
    let read = Read::of(a)?;
    let compress = match a.word("compress") {
        "bc1" => Compression::Bc1,
        "bc7" => Compression::Bc7,
        _ => Compression::None,
    };
    let bc = match compress {
        Compression::None => 0,
        Compression::Bc1 => 1,
        Compression::Bc7 => 7,
    };
    let mut constants = read.constants();
    constants.push(("taps", Constant::ints(&[i32::from(sampler.anisotropy)])));
    constants.push(("bc", Constant::ints(&[bc])));
    let path = a.paths("path").into_iter().next().unwrap_or_default();
    let Read { encoding, channels, borders, lut } = read;
    Ok(Made {
        recipe: Recipe::Exemplar { path, encoding, channels, borders, lut, compress },
        constants,
        sampler: Some(sampler),
        lender: None,
    })
}

/// An exemplar in space: its slices are the cells of the pictures, one after the other.
pub fn make_volume(a: &Arguments) -> Result<Made, Diagnostic> {
    let Cells { paths, grid, count, place } = Cells::of(a)?;
    if !(1..=MAX_LAYERS).contains(&count) {
        return Err(constructors::too_many_slices(place, count, "one block"));
    }
    let read = Read::of(a)?;
    let mut constants = read.constants();
    constants.push(("depth", Constant::ints(&[count as i32])));
    constants.push(("bc", Constant::ints(&[0])));
    let Read { encoding, channels, borders, lut } = read;
    Ok(Made {
        recipe: Recipe::Volume { paths, grid, encoding, channels, borders, lut },
        constants,
        sampler: Some(SamplerState { wrap: Wrap::Repeat, filter: Filter::Linear, anisotropy: 1 }),
        lender: None,
    })
}

/// How an exemplar's numbers are read, and found again.
struct Read {
    encoding: Encoding,
    channels: u32,
    borders: Borders,
    lut: u32,
}

impl Read {
    fn of(a: &Arguments) -> Result<Read, Diagnostic> {
        let encoding = a.encoding();
        let asked = a.count("channels", 1, 3)?;
        let channels = match (encoding, asked) {
            (Encoding::Normal, 2 | 3) => 2,
            (Encoding::Srgb | Encoding::Linear, 1 | 3) => asked,
            _ => return Err(constructors::channels_of_exemplar(a.place("channels"), asked, encoding)),
        };
        let borders = match a.word("wrap") {
            "repeat" => Borders::Repeat,
            "inside" => Borders::Inside,
            _ => Borders::Auto,
        };
        Ok(Read { encoding, channels, borders, lut: a.count("lut", 128, 1024)? })
    }

    fn constants(&self) -> Vec<(&'static str, Constant)> {
        let inside = match self.borders {
            Borders::Repeat => 0,
            Borders::Inside => 1,
            Borders::Auto => 2,
        };
        let constants = [
            ("channels", self.channels as i32),
            ("normals", i32::from(self.encoding == Encoding::Normal)),
            ("inside", inside),
            ("width", self.lut as i32),
            ("levels", Recipe::INVERSE_LEVELS as i32),
        ];
        constants.map(|(name, value)| (name, Constant::ints(&[value]))).into()
    }
}
