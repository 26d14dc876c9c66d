//! The syntax of texgraph: text to syntax tree ([`parse`]) and back ([`format()`]).
//!
//! `tex.pest` defines the language and nothing else does. A text goes through three stages:
//!
//! ```text
//! text ──scan──▶ tokens, comments, limits ──pest──▶ pairs ──parse──▶ syntax tree
//!                                             └─ where that fails: diagnose ──▶ errors in the reader's words
//! ```
//!
//! - `scan` reads the text once, before pest: it collects the comments and refuses what is too
//!   large or too deeply nested, so no later stage can recurse further than [`MAX_NESTING`].
//! - `parse` turns pest's pairs into the [`syntax`] tree. When a file has errors it is read again
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
