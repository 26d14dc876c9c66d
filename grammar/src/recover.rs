//! Cuts a broken file into pieces that are read one by one, so that one mistake hides no other.
//!
//! A piece begins where an item keyword is the first token of a line and either no bracket is open,
//! or the word stands in column 0 where no body could hold it: then a bracket before it was
//! forgotten. An indented `let` begins none: it is a statement of a body whose head is broken.

use crate::scan::{Scan, Token, TokenKind};
use std::ops::Range;

/// Ranges of tokens, one per piece; together they are all tokens.
pub(crate) fn pieces(scan: &Scan<'_>) -> Vec<Range<usize>> {
    let mut starts = vec![0];
    let mut open = Brackets::default();
    for (index, token) in scan.tokens.iter().enumerate() {
        match token.kind {
            TokenKind::Open => open.open(scan.text(*token)),
            TokenKind::Close => open.close(scan.text(*token)),
            TokenKind::Word if index > 0 && begins_item(scan, index, open.innermost()) => {
                open = Brackets::default();
                starts.push(index);
            }
            _ => {}
        }
    }
    let ends = starts.iter().skip(1).copied().chain([scan.tokens.len()]);
    starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect()
}

/// The brackets that are open, on the guess that braces are rarely the forgotten ones.
#[derive(Default)]
struct Brackets<'s> {
    open: Vec<&'s str>,
    braces: usize,
}

impl<'s> Brackets<'s> {
    fn open(&mut self, bracket: &'s str) {
        self.open.push(bracket);
        self.braces += usize::from(bracket == "{");
    }

    /// A closing brace also closes what was forgotten inside; any other bracket only its own.
    fn close(&mut self, bracket: &str) {
        if bracket == "}" && self.braces > 0 {
            while self.open.pop().is_some_and(|open| open != "{") {}
            self.braces -= 1;
        } else if matches!((self.innermost(), bracket), (Some("("), ")") | (Some("["), "]")) {
            self.open.pop();
        }
    }

    fn innermost(&self) -> Option<&'s str> {
        self.open.last().copied()
    }
}

/// Whether the token begins an item, given the innermost bracket that is open.
fn begins_item(scan: &Scan<'_>, index: usize, bracket: Option<&str>) -> bool {
    let token = scan.tokens[index];
    let word = scan.text(token);
    if !is_item_keyword(word) || !is_first_of_line(scan, index) {
        return false;
    }
    match bracket {
        // An indented `let` is more likely a statement of a body whose head is broken.
        None => word != "let" || is_in_column_0(scan.source, token),
        // A `let` at the margin may be a statement of the body around it.
        Some("{") if word == "let" => false,
        Some(_) => is_in_column_0(scan.source, token),
    }
}

/// Whether a word begins an item.
pub(crate) fn is_item_keyword(word: &str) -> bool {
    matches!(word, "use" | "let" | "param" | "node" | "texture")
}

/// Whether a line break, or nothing, stands between this token and the one before.
pub(crate) fn is_first_of_line(scan: &Scan<'_>, index: usize) -> bool {
    let start_of = |token: &Token| token.span.start as usize;
    let end = scan.tokens.get(index).map_or(scan.source.len(), start_of);
    let before = index.checked_sub(1).and_then(|before| scan.tokens.get(before));
    before.is_none_or(|before| {
        let gap = scan.source.get(before.span.end as usize..end);
        gap.is_some_and(|gap| gap.contains('\n'))
    })
}

/// Whether nothing, not even a blank, stands before a token on its line.
pub(crate) fn is_in_column_0(source: &str, token: Token) -> bool {
    let start = token.span.start as usize;
    start == 0 || source.as_bytes().get(start - 1) == Some(&b'\n')
}
