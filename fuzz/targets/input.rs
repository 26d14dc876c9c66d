//! What the bytes of a fuzzer mean to `check` and `compile`.

use crate::generated::choices::Choices;
use crate::generated::features::Features;
use crate::generated::program::{Known, Program, program};
use std::collections::HashMap;
use std::sync::LazyLock;
use texgraph_compiler::Library;

/// Loaded once.
pub static LIBRARY: LazyLock<Library> = LazyLock::new(|| Library::standard().expect("the library parses"));
static KNOWN: LazyLock<Known> = LazyLock::new(|| Known::new(&LIBRARY));

/// No text begins with this byte: what follows are the decisions of a well-typed program.
const DECISIONS: u8 = 0xff;

/// A program, and whether it must be right; none for bytes that are no text.
pub fn read(bytes: &[u8]) -> Option<(Program, bool)> {
    if let [DECISIONS, decisions @ ..] = bytes {
        return Some((program(&mut Choices::Bytes(decisions), Features::NOW, &KNOWN), true));
    }
    let text = std::str::from_utf8(bytes).ok()?;
    let main = "main.tex".to_owned();
    let files: HashMap<String, String> = [(main.clone(), text.to_owned())].into();
    Some((Program { files, main }, false))
}
