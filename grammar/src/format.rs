//! The canonical layout.
//!
//! [`format`] parses the text and walks the tree, but what it prints are the tokens of the source:
//! numbers, colours and strings stay as they were written and every comment stays between the two
//! tokens where it stood. Only white space changes, and the commas behind the last of a list.
//!
//! The work is split in three: `items` and `expressions` walk the tree and say which token comes
//! next and what may stand before it; `writer` puts the tokens and the comments in a row;
//! `layout` decides where lines break.
//!
//! The rules: 4 spaces a level; lines of at most 100 characters where there is a choice; arguments
//! stand all on one line or one on each; operators begin a line; empty lines between statements and
//! items are kept, as one; an empty line stands around every node and texture; the `=` of
//! neighbouring one-line assignments are aligned.

mod expressions;
mod items;
mod layout;
mod writer;

use crate::error::SyntaxError;
use crate::parse::parse;
use layout::{Measures, Piece};
use writer::Writer;

/// Prints a file in its canonical layout; formatting the result again changes nothing.
///
/// # Errors
///
/// Those of [`parse`].
pub fn format(source: &str) -> Result<String, Vec<SyntaxError>> {
    let file = parse(source)?;
    let mut formatter = Formatter { writer: Writer::new(source, &file.comments), blocks: Vec::new() };
    formatter.file(&file);
    let mut pieces = formatter.writer.pieces;
    align(&mut pieces, &formatter.blocks);
    Ok(if pieces.is_empty() { String::new() } else { layout::render(&pieces) })
}

/// Walks the tree.
struct Formatter<'s> {
    writer: Writer<'s>,
    /// The assignments of every body, and those of the file.
    blocks: Vec<Vec<Assignment>>,
}

/// An assignment among the pieces.
struct Assignment {
    start: usize,
    /// The padding before the `=`.
    pad: usize,
    end: usize,
    level: usize,
    /// Whether it stands right below the assignment before it in its block.
    is_joined: bool,
}

/// Aligns the `=` of neighbouring assignments that take one line each.
fn align(pieces: &mut [Piece<'_>], blocks: &[Vec<Assignment>]) {
    let measures = Measures::new(pieces);
    let is_short = |assignment: &Assignment| {
        let width = measures.flat(assignment.start, assignment.end);
        width.is_some_and(|width| layout::fits(assignment.level, width))
    };
    for block in blocks {
        let runs = block.chunk_by(|a, b| b.is_joined && is_short(a) && is_short(b));
        for run in runs.filter(|run| run.len() > 1) {
            align_run(pieces, &measures, run);
        }
    }
}

fn align_run(pieces: &mut [Piece<'_>], measures: &Measures, run: &[Assignment]) {
    let column =
        |assignment: &Assignment| measures.flat(assignment.start, assignment.pad).unwrap_or_default();
    let widest = run.iter().map(column).max().unwrap_or_default();
    let fits = run.iter().all(|assignment| {
        let width = measures.flat(assignment.start, assignment.end).unwrap_or_default();
        layout::fits(assignment.level, width + widest - column(assignment))
    });
    for assignment in run.iter().filter(|_| fits) {
        pieces[assignment.pad] = Piece::Pad(widest - column(assignment));
    }
}
