//! The syntax of texgraph: text to syntax tree ([`parse`]) and back ([`format()`]).
//!
//! `tex.pest` defines the language and nothing else does. A text goes through three stages:
//!
//! ```text
//! text ──scan──▶ tokens, comments, limits ──reader──▶ steps ──parse──▶ syntax tree
//!                                             └─ where that fails: pest, diagnose ──▶ errors in words
//! ```
//!
//! - `scan` reads the text once, before pest: it collects the comments and refuses what is too
//!   large or too deeply nested, so no later stage can recurse further than [`MAX_NESTING`].
//! - `parse` matches the text and turns what has matched into the [`syntax`] tree. The reader that
//!   matches is made of `tex.pest` when the crate is built (`build/`); pest itself, which is slower,
//!   is asked where and why a text does not match. When a file has errors it is read again
//!   in pieces, one or a few items each, so that every broken item is reported, in source order.
//! - [`format()`] prints the tree in its one canonical layout and keeps every comment.
//!
//! Nothing here knows a name or a type; that begins in the compiler.

// pest's derive names it.
extern crate alloc;

mod diagnose;
mod error;
mod format;
mod nesting;
mod parse;
mod recover;
mod scan;
pub mod syntax;

pub use error::{SYNTAX_CODES, Statement, SyntaxError, SyntaxErrorKind};
pub use format::format;
pub use nesting::MAX_NESTING;
pub use parse::{parse, parse_signature};
pub use scan::MAX_BYTES;
