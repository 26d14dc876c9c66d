//! Errors as objects for editors: one a line, in the shape of rustc's `--error-format json`
//! (<https://doc.rust-lang.org/rustc/json.html>).
//!
//! What differs: nothing is expanded from a macro, so `expansion` is always null; no line at the end
//! counts the errors; and the text of a long line is clipped around the place, with its highlight.

use super::clip::clip;
use super::render::{Shown, page};
use super::{Diagnostic, Place, Suggestion};
use crate::module::Sources;
use serde::Serialize;
use std::ops::Range;

/// One object a line.
pub fn lines(sources: &Sources, diagnostics: &[Diagnostic]) -> String {
    let files = Shown::new(sources);
    let line = |diagnostic: &Diagnostic| {
        let message = Message::of(&files, diagnostic);
        serde_json::to_string(&message).unwrap_or_default() + "\n"
    };
    diagnostics.iter().map(line).collect()
}

#[derive(Serialize)]
struct Message<'a> {
    message: &'a str,
    #[serde(rename = "$message_type")]
    message_type: &'static str,
    code: Option<Code<'a>>,
    level: &'static str,
    spans: Vec<Span<'a>>,
    children: Vec<Message<'a>>,
    rendered: Option<String>,
}

#[derive(Serialize)]
struct Code<'a> {
    code: &'a str,
    explanation: Option<&'a str>,
}

/// A place as editors want it: bytes from 0; lines and columns, in characters, from 1; ends behind
/// the last.
#[derive(Serialize)]
struct Span<'a> {
    file_name: &'a str,
    byte_start: u32,
    byte_end: u32,
    line_start: usize,
    line_end: usize,
    column_start: usize,
    column_end: usize,
    is_primary: bool,
    text: Vec<Line>,
    label: Option<&'a str>,
    suggested_replacement: Option<&'a str>,
    suggestion_applicability: Option<&'static str>,
    expansion: Option<()>,
}

/// A line of the source that a place touches, and the columns of this text that it covers.
#[derive(Serialize)]
struct Line {
    text: String,
    highlight_start: usize,
    highlight_end: usize,
}

impl<'a> Message<'a> {
    fn of(files: &Shown<'a>, diagnostic: &'a Diagnostic) -> Message<'a> {
        let primary = Span::of(files, diagnostic.place, &diagnostic.label);
        let primary = primary.map(|span| Span { is_primary: true, ..span });
        let related = diagnostic.related.iter().filter_map(|(place, label)| Span::of(files, *place, label));
        let code = Code { code: diagnostic.code, explanation: super::codes::explain(diagnostic.code) };
        let help = diagnostic.help.as_ref();
        Message {
            code: Some(code).filter(|code| !code.code.is_empty()),
            level: diagnostic.level(),
            spans: primary.into_iter().chain(related).collect(),
            children: help
                .map(|help| Message::help(files, help, diagnostic.suggestion.as_ref()))
                .into_iter()
                .collect(),
            rendered: Some(page(files, diagnostic)),
            ..Message::plain(&diagnostic.message)
        }
    }

    fn help(files: &Shown<'a>, help: &'a str, suggestion: Option<&'a Suggestion>) -> Message<'a> {
        let edits = suggestion.into_iter().flat_map(|suggestion| {
            let applicability = if suggestion.is_sure { "MachineApplicable" } else { "MaybeIncorrect" };
            let edit = move |(place, text): &'a (Place, String)| {
                Some(Span {
                    is_primary: true,
                    suggested_replacement: Some(text),
                    suggestion_applicability: Some(applicability),
                    ..Span::of(files, *place, "")?
                })
            };
            suggestion.edits.iter().filter_map(edit)
        });
        Message { level: "help", spans: edits.collect(), ..Message::plain(help) }
    }

    fn plain(message: &'a str) -> Message<'a> {
        Message {
            message_type: "diagnostic",
            message,
            code: None,
            level: "error",
            spans: Vec::new(),
            children: Vec::new(),
            rendered: None,
        }
    }
}

impl<'a> Span<'a> {
    /// None for what has no place in any text.
    fn of(files: &Shown<'a>, place: Place, label: &'a str) -> Option<Span<'a>> {
        let source = files.sources.get(place)?;
        let (line_start, column_start) = files.line_and_column(place.file, place.span.start);
        let (line_end, column_end) = files.line_and_column(place.file, place.span.end);
        let (first, start) = files.line_and_byte(place.file, place.span.start)?;
        let (last, end) = files.line_and_byte(place.file, place.span.end)?;
        let line = |number| {
            let text = files.line(place.file, number + 1);
            let start = if number == first { start } else { 0 };
            let end = if number == last { end } else { text.len() };
            Line::of(text, start..end)
        };
        Some(Span {
            file_name: &source.path,
            byte_start: place.span.start,
            byte_end: place.span.end,
            line_start,
            line_end,
            column_start,
            column_end,
            is_primary: false,
            text: (first..=last).map(line).collect(),
            label: Some(label).filter(|label| !label.is_empty()),
            suggested_replacement: None,
            suggestion_applicability: None,
            expansion: None,
        })
    }
}

impl Line {
    /// Of a place in a line, in bytes.
    fn of(line: &str, place: Range<usize>) -> Line {
        let shown = clip(line, &[place.start, place.end]);
        let before = |byte| shown.text.get(..shown.shown(byte)).unwrap_or_default();
        let column = |byte| before(byte).chars().count() + 1;
        let (highlight_start, highlight_end) = (column(place.start), column(place.end));
        Line { text: shown.text, highlight_start, highlight_end }
    }
}
