//! naga module to text. naga validates; its writer writes; our names take the place of its placeholders.

use crate::lower::Lowered;
use memchr::memmem::Finder;
use naga::back::wgsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::sync::LazyLock;

/// What the writer writes otherwise than it is to stand there.
const REPLACED: [(&str, &str); 5] = [
    // It breaks the line behind attributes.
    (") \nvar", ") var"),
    ("@fragment \n", "@fragment\n"),
    // It prints numbers without an exponent. The greatest float it rounds up, beyond what a float can
    // be: naga reads that back, Tint refuses it. The others are the bounds of `intrinsic`.
    ("340282350000000000000000000000000000000f", "3.4028234663852886e38f"),
    ("0.0000000000000000000000000000000000001f", "1e-37f"),
    ("100000000000000000000000000000000000000f", "1e38f"),
];

/// The module as WGSL.
///
/// # Errors
/// naga refuses the module: a bug of texgraph, said in naga's words.
pub fn wgsl(lowered: &Lowered) -> Result<String, String> {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&lowered.module).map_err(|error| describe(&error))?;
    let mut writer = wgsl::Writer::new(lowered.names.renaming(&lowered.results), wgsl::WriterFlags::empty());
    writer.write(&lowered.module, &info).map_err(|error| describe(&error))?;
    Ok(replaced(&writer.finish().finish()))
}

/// What finds them.
static FINDERS: LazyLock<[Finder<'static>; REPLACED.len()]> =
    LazyLock::new(|| REPLACED.map(|(from, _)| Finder::new(from)));

/// The text with everything replaced that is to be.
fn replaced(text: &str) -> String {
    let places = FINDERS.iter().zip(REPLACED).flat_map(|(finder, (from, to))| {
        finder.find_iter(text.as_bytes()).map(move |start| (start, start + from.len(), to))
    });
    let mut places: Vec<(usize, usize, &str)> = places.collect();
    places.sort_unstable();
    let mut out = String::with_capacity(text.len());
    let mut done = 0;
    for (start, end, to) in places {
        out += &text[done..start];
        out += to;
        done = end;
    }
    out + &text[done..]
}

/// An error with its causes.
fn describe(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        text = format!("{text}: {cause}");
        source = cause.source();
    }
    text
}
