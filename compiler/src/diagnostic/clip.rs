//! Source lines too long to be read, cut down to what stands around the marks in them.
//!
//! ```text
//! …rock.sample(uv * 8.0), moss.sample(uvv * 8.0), …
//! ```

use std::ops::Range;

/// The most columns of a line that is shown whole; of a longer one about as many are shown.
pub const COLUMNS: usize = 160;

/// What stands for text that is left out.
const ELLIPSIS: &str = "…";

/// Text left out is longer than this, in bytes: less is no gain.
const LEAST_GAP: usize = 4;

/// A line as it is shown.
pub struct Clipped {
    /// The pieces that are shown, with ellipses between them.
    pub text: String,
    /// Where each piece stands in the line, and where it begins in `text`.
    pieces: Vec<(Range<usize>, usize)>,
}

/// Cuts a line down to the surroundings of its marks (bytes from its start); to its beginning if it
/// has none.
pub fn clip(line: &str, marks: &[usize]) -> Clipped {
    if end_of(line.char_indices(), COLUMNS).is_none() {
        return Clipped { text: line.to_owned(), pieces: vec![(0..line.len(), 0)] };
    }
    let mut shown = Clipped { text: String::new(), pieces: Vec::new() };
    let pieces = pieces(line, marks);
    let end = pieces.last().map_or(0, |piece| piece.end);
    for piece in pieces {
        if piece.start > 0 {
            shown.text.push_str(ELLIPSIS);
        }
        shown.pieces.push((piece.clone(), shown.text.len()));
        shown.text.push_str(&line[piece]);
    }
    if end < line.len() {
        shown.text.push_str(ELLIPSIS);
    }
    shown
}

impl Clipped {
    /// Where a byte of the line is shown; the ellipsis for what is left out.
    pub fn shown(&self, at: usize) -> usize {
        match self.pieces.iter().find(|(piece, _)| at <= piece.end) {
            Some((piece, start)) if at >= piece.start => start + (at - piece.start),
            Some((_, start)) => start - ELLIPSIS.len(),
            None => self.text.len(),
        }
    }

    /// Where a shown byte stands in the line.
    pub fn original(&self, shown: usize) -> usize {
        let before = self.pieces.iter().rev().find(|(_, start)| *start <= shown);
        before.map_or(0, |(piece, start)| (piece.start + shown - start).min(piece.end))
    }
}

/// What is shown of a long line, in order, apart from each other.
fn pieces(line: &str, marks: &[usize]) -> Vec<Range<usize>> {
    let mut marks: Vec<usize> = marks.iter().map(|mark| line.floor_char_boundary(*mark)).collect();
    marks.sort_unstable();
    marks.dedup();
    if marks.is_empty() {
        marks.push(0);
    }
    let columns = COLUMNS / (2 * marks.len());
    let mut pieces: Vec<Range<usize>> = Vec::new();
    for mark in marks {
        let piece = around(line, mark, columns);
        match pieces.last_mut() {
            Some(last) if piece.start < last.end + LEAST_GAP => last.end = piece.end,
            _ => pieces.push(piece),
        }
    }
    pieces
}

/// So many columns on either side of a mark; more behind it where the line begins before.
fn around(line: &str, mark: usize, columns: usize) -> Range<usize> {
    let (before, behind) = line.split_at(mark);
    let backwards = before.char_indices().rev().map(|(at, c)| (before.len() - at - c.len_utf8(), c));
    match end_of(backwards, columns) {
        Some(length) => mark - length..mark + end_of(behind.char_indices(), columns).unwrap_or(behind.len()),
        None => 0..end_of(line.char_indices(), 2 * columns).unwrap_or(line.len()),
    }
}

/// How many bytes of these characters fit into so many columns; none if all do.
fn end_of(characters: impl Iterator<Item = (usize, char)>, columns: usize) -> Option<usize> {
    let mut width = 0;
    for (at, character) in characters {
        width += columns_of(character);
        if width > columns {
            return Some(at);
        }
    }
    None
}

/// The most columns that a character may take.
fn columns_of(character: char) -> usize {
    match character {
        '\t' => 4,
        c if c.is_ascii() => 1,
        _ => 2,
    }
}

#[cfg(test)]
mod tests {
    use super::{COLUMNS, clip};

    #[test]
    fn a_line_that_fits_stays_as_it_is() {
        let line = "x".repeat(COLUMNS);
        let shown = clip(&line, &[7]);
        assert_eq!(shown.text, line);
        assert_eq!((shown.shown(7), shown.original(7)), (7, 7));
    }

    #[test]
    fn marks_keep_their_character() {
        let line: String = (0..4000).map(|i| ["a", "\t", "ä", "漢"][i % 4]).collect();
        let places: Vec<usize> = line.char_indices().map(|(at, _)| at).collect();
        for mark in places.iter().step_by(37) {
            let far = places[places.len() - 1 - mark % 300];
            let shown = clip(&line, &[*mark, far, line.len()]);
            for at in [*mark, far] {
                let place = shown.shown(at);
                assert_eq!(shown.text[place..].chars().next(), line[at..].chars().next());
                assert_eq!(shown.original(place), at);
            }
            assert_eq!(shown.shown(line.len()), shown.text.len());
            assert!(shown.text.chars().count() <= COLUMNS + 4, "{}", shown.text);
        }
    }

    #[test]
    fn what_is_left_out_is_an_ellipsis() {
        let line = format!("{}b{}c{}", "-".repeat(300), "-".repeat(300), "-".repeat(300));
        let shown = clip(&line, &[300, 601]);
        let side = "-".repeat(40);
        let end = "-".repeat(39);
        assert_eq!(shown.text, format!("…{side}b{end}…{side}c{end}…"));
        assert_eq!(&shown.text[shown.shown(450)..][..3], "…");
        assert_eq!(&shown.text[shown.shown(0)..][..3], "…");
        assert_eq!(shown.text.chars().count(), 2 * 80 + 3);
    }
}
