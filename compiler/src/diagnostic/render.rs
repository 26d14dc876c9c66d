//! The layout of error pages: the only place that knows codespan-reporting.

use super::excerpt::Excerpt;
use super::{Diagnostic, Place};
use crate::module::Sources;
use codespan_reporting::diagnostic::{Diagnostic as Page, Label};
use codespan_reporting::files::Error;
use codespan_reporting::term::{self, Chars, Config};

/// Pages with source lines and underlines, as plain text.
pub fn human(sources: &Sources, diagnostics: &[Diagnostic]) -> String {
    pages(sources, diagnostics, false)
}

/// The same with terminal colours.
pub fn human_colored(sources: &Sources, diagnostics: &[Diagnostic]) -> String {
    pages(sources, diagnostics, true)
}

fn pages(sources: &Sources, diagnostics: &[Diagnostic], color: bool) -> String {
    let files = Shown::new(sources);
    diagnostics.iter().map(|diagnostic| rendered(&files, diagnostic, color)).collect()
}

/// One page as plain text.
pub(super) fn page(files: &Shown, diagnostic: &Diagnostic) -> String {
    rendered(files, diagnostic, false)
}

fn rendered(files: &Shown, diagnostic: &Diagnostic, color: bool) -> String {
    let config = Config { chars: Chars::box_drawing(), tab_width: 4, ..Config::default() };
    let places = diagnostic.related.iter().map(|(place, _)| *place);
    let places: Vec<Place> = std::iter::once(diagnostic.place).chain(places).collect();
    let excerpt = Excerpt::new(files, &places);
    let page = laid_out(diagnostic, &excerpt);
    let emitted = if color {
        emit_colored(&config, &excerpt, &page)
    } else {
        term::emit_into_string(&config, &excerpt, &page)
    };
    emitted.unwrap_or_else(|_| line(files, diagnostic))
}

fn emit_colored(config: &Config, excerpt: &Excerpt, page: &Page<usize>) -> Result<String, Error> {
    let mut ansi = term::termcolor::Ansi::new(Vec::new());
    let styles = term::Styles::default();
    term::emit_to_write_style(&mut term::StylesWriter::new(&mut ansi, &styles), config, excerpt, page)?;
    Ok(String::from_utf8_lossy(&ansi.into_inner()).into_owned())
}

fn laid_out(diagnostic: &Diagnostic, excerpt: &Excerpt) -> Page<usize> {
    let page = if diagnostic.is_warning() { Page::warning() } else { Page::error() };
    let mut page = page.with_code(diagnostic.code).with_message(printable(&diagnostic.message));
    // A place in a file that was never read has nothing to underline.
    if let Some((file, range)) = excerpt.range(diagnostic.place) {
        page = page.with_label(Label::primary(file, range).with_message(printable(&diagnostic.label)));
    }
    for (place, text) in &diagnostic.related {
        if let Some((file, range)) = excerpt.range(*place) {
            page = page.with_label(Label::secondary(file, range).with_message(printable(text)));
        }
    }
    match &diagnostic.help {
        Some(help) => page.with_note(printable(&format!("help: {help}"))),
        None => page,
    }
}

/// A text that can't command a terminal: control characters, which are one byte each like their
/// stand-in, do not reach it.
pub(super) fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii_control() && c != '\n' && c != '\t' { '?' } else { c }).collect()
}

/// One JSON object a line: [`super::json`].
pub fn json(sources: &Sources, diagnostics: &[Diagnostic]) -> String {
    super::json::lines(sources, diagnostics)
}

/// One line each: `file:line:column: error[E0101]: message`.
pub fn short(sources: &Sources, diagnostics: &[Diagnostic]) -> String {
    let files = Shown::new(sources);
    diagnostics.iter().map(|diagnostic| line(&files, diagnostic)).collect()
}

fn line(files: &Shown, diagnostic: &Diagnostic) -> String {
    let (line, column) = files.line_and_column(diagnostic.place.file, diagnostic.place.span.start);
    let file = files.sources.get(diagnostic.place).map_or("", |source| source.path.as_str());
    format!("{file}:{line}:{column}: {}[{}]: {}\n", diagnostic.level(), diagnostic.code, diagnostic.message)
}

/// The texts with the starts of their lines.
pub(super) struct Shown<'a> {
    pub sources: &'a Sources,
    lines: Vec<Vec<usize>>,
}

impl<'a> Shown<'a> {
    pub fn new(sources: &'a Sources) -> Shown<'a> {
        let starts = |text: &str| codespan_reporting::files::line_starts(text).collect();
        Shown { sources, lines: sources.0.iter().map(|source| starts(&source.text)).collect() }
    }

    /// A line, from 1, without its end.
    pub fn line(&self, file: u32, number: usize) -> &'a str {
        let starts = self.lines.get(file as usize).map_or(&[][..], Vec::as_slice);
        let text: &'a str = self.sources.0.get(file as usize).map_or("", |source| &source.text);
        let start = number.checked_sub(1).and_then(|index| starts.get(index)).copied().unwrap_or(text.len());
        let end = starts.get(number).copied().unwrap_or(text.len());
        text.get(start..end).unwrap_or_default().trim_end_matches(['\n', '\r'])
    }

    /// The line, from 0, in which a byte stands, and how many bytes of the line are before it. None
    /// for a file that was never read.
    pub fn line_and_byte(&self, file: u32, offset: u32) -> Option<(usize, usize)> {
        let lines = self.lines.get(file as usize)?;
        let offset = (offset as usize).min(self.sources.0.get(file as usize)?.text.len());
        let line = lines.partition_point(|start| *start <= offset).checked_sub(1)?;
        Some((line, offset - lines.get(line)?))
    }

    /// From 1; columns in characters.
    pub fn line_and_column(&self, file: u32, offset: u32) -> (usize, usize) {
        let place = self.line_and_byte(file, offset);
        place.map_or((1, 1), |(line, byte)| (line + 1, self.column(file, line, byte)))
    }

    /// The column, from 1, of a byte of a line, from 0.
    pub fn column(&self, file: u32, line: usize, byte: usize) -> usize {
        let start = self.lines.get(file as usize).and_then(|lines| lines.get(line)).copied().unwrap_or(0);
        let text = self.sources.0.get(file as usize).map_or("", |source| &source.text);
        text.get(start..start + byte).unwrap_or_default().chars().count() + 1
    }
}
