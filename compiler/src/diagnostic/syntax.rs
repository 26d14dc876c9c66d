//! The grammar's errors as diagnostics: the sentences are the grammar's own.

use super::{Diagnostic, Place};
use texgraph_grammar::SyntaxError;

/// A syntax error of a file.
pub fn error(file: u32, error: &SyntaxError) -> Diagnostic {
    let place = Place { file, span: error.span };
    Diagnostic::new(error.code(), place, error.message(), error.label()).maybe_help(error.help())
}
