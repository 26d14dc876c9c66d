//! `image`: one picture with its mip levels. Field `pixels`.

use super::encoding::{self, Reader};
use super::exemplar::Crossover;
use super::table::{self, Made};
use super::{decode, pyramid};
use crate::project::Project;
use texgraph_compiler::diagnostic::{Diagnostic, Place};
use texgraph_compiler::manifest::{Encoding, Tileable};

/// Makes the texture.
///
/// # Errors
/// The picture can't be read, or is larger than a texture may be.
pub fn make(
    project: &Project,
    place: Place,
    path: &str,
    encoding: Encoding,
    tileable: Tileable,
) -> Result<Vec<Made>, Vec<Diagnostic>> {
    let file = decode::open(project, path, place)?;
    let format = encoding::format(encoding, file.depth.is_deep());
    table::check(place, path, format, file.size, 1)?;
    let picture = file.decode()?;
    let reader = Reader::new(&picture, encoding);
    let crossover = (tileable == Tileable::Blend).then(|| Crossover::new(&picture, encoding));
    let texel = |x: u32, y: u32| {
        let blended = crossover.as_ref().and_then(|crossover| crossover.texel(x, y));
        blended.unwrap_or_else(|| reader.texel(x, y))
    };
    Ok(vec![pyramid::build("pixels", format, picture.size, 1, |_, x, y| texel(x, y))])
}
