//! The tokens of the source, written in order with the comments between them.
//!
//! The writer keeps its place in the source. Asked for the next token it first looks at what stands
//! before it: comments go out where they are, each as one of two kinds.
//!
//! - A comment at the end of its source line, and every `//`, ends its line here too: on the line
//!   of the token before it if it stood there, else on its own.
//! - Any other `/* … */` stays on the line of the token behind it.
//!
//! Either kind is read back as the same kind, so formatting twice changes nothing.

use super::layout::{Piece, Style};
use crate::syntax::{Comment, CommentKind, Span};
use std::borrow::Cow;

/// What stands between two tokens when there is no comment.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Gap {
    /// Nothing.
    Glue,
    Space,
    /// A line break where the group is broken, else nothing.
    SoftGlue,
    /// A line break where the group is broken, else a space.
    Soft,
    /// A line break.
    Line(Blank),
}

/// Whether there is an empty line.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Blank {
    Never,
    /// Where the source has one.
    Keep,
    Always,
}

/// A comment before the next token.
struct Found<'s> {
    text: Cow<'s, str>,
    /// Line breaks in the source before it.
    lines_before: usize,
    ends_line: bool,
}

/// Writes tokens and comments as pieces.
pub(super) struct Writer<'s> {
    source: &'s str,
    comments: std::slice::Iter<'s, Comment>,
    /// Behind the last token or comment that was written.
    at: usize,
    /// A trailing comma of the source; the layout writes its own.
    dropped_comma: Option<usize>,
    pub pieces: Vec<Piece<'s>>,
    /// Levels of indentation.
    pub level: usize,
    /// The first piece behind the last line break.
    pub line_start: usize,
    /// How many lines were broken in any case.
    breaks: usize,
    /// Whether nothing but one line break stands before the last token, comments on the line before
    /// left aside.
    pub plain: bool,
}

impl<'s> Writer<'s> {
    pub fn new(source: &'s str, comments: &'s [Comment]) -> Writer<'s> {
        Writer {
            source,
            comments: comments.iter(),
            at: 0,
            dropped_comma: None,
            pieces: Vec::new(),
            level: 0,
            line_start: 0,
            breaks: 0,
            plain: false,
        }
    }

    /// Writes a mark or a keyword.
    pub fn token(&mut self, gap: Gap, text: &'static str) {
        self.lead(gap);
        self.put(Cow::Borrowed(text));
    }

    /// Writes a token as the source has it.
    pub fn copy(&mut self, gap: Gap, span: Span) {
        self.lead(gap);
        self.put(Cow::Borrowed(self.source.get(span.range()).unwrap_or_default()));
    }

    fn put(&mut self, text: Cow<'s, str>) {
        self.at += text.len();
        self.pieces.push(Piece::Text(text));
    }

    pub fn open(&mut self, style: Style) {
        self.pieces.push(Piece::Open(style));
    }

    pub fn close(&mut self) {
        self.pieces.push(Piece::Close);
    }

    pub fn indent(&mut self) {
        self.level += 1;
        self.pieces.push(Piece::Indent);
    }

    pub fn dedent(&mut self) {
        self.level -= 1;
        self.pieces.push(Piece::Dedent);
    }

    /// Writes what stands before the next token.
    pub fn lead(&mut self, gap: Gap) {
        let (comments, lines) = self.find_comments();
        self.write_gap(gap, comments, lines, false);
    }

    /// Writes a closing bracket, one level less deep than what is before it.
    pub fn close_bracket(&mut self, gap: Gap, text: &'static str) {
        let (comments, lines) = self.find_comments();
        self.write_gap(gap, comments, lines, true);
        self.put(Cow::Borrowed(text));
    }

    /// Writes the comma behind the last of a list, which a broken group has and a flat one has not.
    pub fn trailing_comma(&mut self) {
        self.pieces.push(Piece::IfBroken(","));
        self.drop_comma();
    }

    /// Passes over the comma behind the last of a list.
    pub fn drop_comma(&mut self) {
        let mut at = self.at;
        for comment in self.comments.clone() {
            if !self.source[at..comment.span.start as usize].trim().is_empty() {
                break;
            }
            at = comment.span.end as usize;
        }
        let rest = self.source[at..].trim_start();
        if rest.starts_with(',') {
            self.dropped_comma = Some(self.source.len() - rest.len());
        }
    }

    /// Writes the comments behind the last token.
    pub fn finish(&mut self) {
        let (comments, _) = self.find_comments();
        let gap = Gap::Line(Blank::Keep);
        let mut state = GapState { gap, is_closing: true, is_placed: false, ended_line: false };
        for comment in comments {
            self.write_comment(&mut state, comment);
        }
    }

    /// Moves to the next token, past comments; also counts the line breaks right before it.
    fn find_comments(&mut self) -> (Vec<Found<'s>>, usize) {
        let mut found: Vec<Found<'s>> = Vec::new();
        let mut lines = 0;
        while let Some(character) = self.source[self.at..].chars().next() {
            let next = self.comments.as_slice().first();
            if let Some(comment) = next.filter(|next| next.span.start as usize == self.at) {
                self.comments.next();
                found.push(self.found(comment, lines));
                self.at = comment.span.end as usize;
                lines = 0;
            } else if character.is_whitespace() || self.dropped_comma == Some(self.at) {
                lines += usize::from(character == '\n');
                self.at += character.len_utf8();
            } else {
                break;
            }
        }
        (found, lines)
    }

    fn found(&self, comment: &Comment, lines_before: usize) -> Found<'s> {
        let text = self.source.get(comment.span.range()).unwrap_or_default();
        let rest = self.source[comment.span.end as usize..].trim_start_matches([' ', '\t', '\r']);
        if comment.kind != CommentKind::Block {
            return Found { text: text.trim_end().into(), lines_before, ends_line: true };
        }
        let ends_line = rest.is_empty() || rest.starts_with('\n');
        Found { text: text.replace("\r\n", "\n").into(), lines_before, ends_line }
    }

    /// Writes comments and what stands around them.
    fn write_gap(&mut self, gap: Gap, comments: Vec<Found<'s>>, lines: usize, is_closing: bool) {
        let mut state = GapState { gap, is_closing, is_placed: false, ended_line: false };
        let has_comments = !comments.is_empty();
        let breaks_before = self.breaks;
        for comment in comments {
            self.write_comment(&mut state, comment);
        }
        if is_closing {
            self.dedent();
        }
        if self.pieces.is_empty() {
        } else if state.ended_line {
            self.break_line(&mut state, lines, true);
        } else if !has_comments || is_closing {
            self.place(&mut state, lines, true);
        } else if gap != Gap::Glue {
            self.space();
        }
        self.plain &= self.breaks == breaks_before + 1;
    }

    fn write_comment(&mut self, state: &mut GapState, comment: Found<'s>) {
        let own_line = comment.ends_line && comment.lines_before > 0;
        if self.pieces.is_empty() {
            state.is_placed = true;
        } else if state.ended_line || own_line {
            self.break_line(state, comment.lines_before, false);
        } else if comment.ends_line || state.is_placed || state.is_closing {
            self.space();
        } else {
            self.place(state, comment.lines_before, false);
            if state.gap == Gap::Glue {
                self.space();
            }
        }
        self.plain = false;
        state.ended_line = comment.ends_line;
        let is_note = comment.text.starts_with("//");
        self.pieces.push(if is_note { Piece::Note(comment.text) } else { Piece::Text(comment.text) });
    }

    /// Writes the gap itself.
    fn place(&mut self, state: &mut GapState, lines: usize, is_last: bool) {
        state.is_placed = true;
        match state.gap {
            Gap::Line(_) => self.break_line(state, lines, is_last),
            Gap::Soft => self.pieces.push(Piece::Break(" ")),
            Gap::SoftGlue => self.pieces.push(Piece::Break("")),
            Gap::Space => self.space(),
            Gap::Glue => {}
        }
    }

    fn space(&mut self) {
        self.pieces.push(Piece::Text(Cow::Borrowed(" ")));
    }

    /// Breaks the line; `lines` is how often the source does.
    fn break_line(&mut self, state: &mut GapState, lines: usize, is_last: bool) {
        let blank = match state.gap {
            Gap::Line(_) if is_last && state.is_closing => false,
            Gap::Line(Blank::Always) => true,
            Gap::Line(Blank::Keep) => lines > 1,
            _ => false,
        };
        if let Gap::Line(_) = state.gap {
            state.gap = Gap::Line(Blank::Keep);
        }
        state.is_placed = true;
        self.pieces.push(Piece::Line { blank });
        self.line_start = self.pieces.len();
        self.breaks += 1;
        self.plain = !blank;
    }
}

/// How far a gap has been written.
struct GapState {
    gap: Gap,
    /// A closing bracket follows: comments go with what is before it.
    is_closing: bool,
    is_placed: bool,
    /// The comment before ends its line.
    ended_line: bool,
}
