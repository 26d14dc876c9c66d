//! naga module to text. naga validates; its writer writes; our names replace its placeholders.

use crate::lower::Lowered;
use naga::back::wgsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};

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
    let text = text.replace(") \nvar", ") var").replace("@fragment \n", "@fragment\n");
    Ok(lowered.names.apply(&text, &lowered.results))
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
