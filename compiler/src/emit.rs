//! naga module to text. naga validates; its writer writes; our names replace its placeholders.

use crate::lower::Lowered;
use memchr::memmem;
use naga::back::wgsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// Numbers that the writer prints without an exponent, and how they are to be written. The greatest
/// float it rounds up, beyond what a float can be: naga reads that back, Tint refuses it. The others
/// are the bounds of [`crate::intrinsic`].
const NUMBERS: [(&str, &str); 3] = [
    ("340282350000000000000000000000000000000f", "3.4028234663852886e38f"),
    ("0.0000000000000000000000000000000000001f", "1e-37f"),
    ("100000000000000000000000000000000000000f", "1e38f"),
];
/// What all of them have, and hardly anything else.
const ZEROS: &str = "0000000000000000000000000000000";

/// How the writer calls what lowering takes for `mix`.
const STANDS_FOR_MIX: &str = "smoothstep(";

/// The module as WGSL.
///
/// # Errors
/// naga refuses the module: a bug of texgraph, said in naga's words.
pub fn wgsl(lowered: &Lowered) -> Result<String, String> {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&lowered.module).map_err(|error| describe(&error))?;
    let text =
        wgsl::write_string(&lowered.module, &info, wgsl::WriterFlags::empty()).map_err(|e| describe(&e))?;
    // The writer breaks the line behind attributes.
    let text = replaced(text, ") \nvar", ") var");
    let text = replaced(text, "@fragment \n", "@fragment\n");
    let mut text = replaced(text, STANDS_FOR_MIX, "mix(");
    if memmem::find(text.as_bytes(), ZEROS.as_bytes()).is_some() {
        text = NUMBERS.iter().fold(text, |text, (long, short)| replaced(text, long, short));
    }
    Ok(lowered.names.apply(&text, &lowered.results))
}

/// A long text with every `from` replaced: mostly there is none, or one.
fn replaced(text: String, from: &str, to: &str) -> String {
    let mut found = memmem::find_iter(text.as_bytes(), from).peekable();
    if found.peek().is_none() {
        return text;
    }
    let mut out = String::with_capacity(text.len());
    let mut done = 0;
    for start in found {
        out += &text[done..start];
        out += to;
        done = start + from.len();
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
