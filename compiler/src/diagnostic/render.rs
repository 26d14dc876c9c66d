//! The layout of error pages: the only place that knows codespan-reporting.

use super::{Diagnostic, Place};
use crate::module::Sources;
use codespan_reporting::diagnostic::{Diagnostic as Page, Label};
use codespan_reporting::files::{Error, Files};
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
    let page = laid_out(diagnostic, files.sources);
    let emitted = if color {
        emit_colored(&config, files, &page)
    } else {
        term::emit_into_string(&config, files, &page)
    };
    emitted.unwrap_or_else(|_| line(files, diagnostic))
}

fn emit_colored(config: &Config, files: &Shown, page: &Page<usize>) -> Result<String, Error> {
    let mut ansi = term::termcolor::Ansi::new(Vec::new());
    let styles = term::Styles::default();
    term::emit_to_write_style(&mut term::StylesWriter::new(&mut ansi, &styles), config, files, page)?;
    Ok(String::from_utf8_lossy(&ansi.into_inner()).into_owned())
}

fn laid_out(diagnostic: &Diagnostic, sources: &Sources) -> Page<usize> {
    let label = |place: &Place| {
        // A place in a file that was never read has nothing to underline.
        sources.get(*place).map(|source| {
            let end = source.text.len();
            let range = place.span.range();
            (place.file as usize, range.start.min(end)..range.end.min(end))
        })
    };
    let mut page = Page::error().with_code(diagnostic.code).with_message(printable(&diagnostic.message));
    if let Some((file, range)) = label(&diagnostic.place) {
        page = page.with_label(Label::primary(file, range).with_message(printable(&diagnostic.label)));
    }
    for (place, text) in &diagnostic.related {
        if let Some((file, range)) = label(place) {
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
fn printable(text: &str) -> String {
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
    format!("{file}:{line}:{column}: error[{}]: {}\n", diagnostic.code, diagnostic.message)
}

/// The texts with the starts of their lines.
pub(super) struct Shown<'a> {
    /// The texts as they are.
    pub sources: &'a Sources,
    /// The texts as they are printed; places point into them just the same.
    texts: Vec<String>,
    lines: Vec<Vec<usize>>,
}

impl<'a> Shown<'a> {
    pub fn new(sources: &'a Sources) -> Shown<'a> {
        let starts = |text: &str| codespan_reporting::files::line_starts(text).collect();
        let texts: Vec<String> = sources.0.iter().map(|source| printable(&source.text)).collect();
        Shown { sources, lines: texts.iter().map(|text| starts(text)).collect(), texts }
    }
}

impl<'a> Shown<'a> {
    /// A line, from 1, without its end.
    pub fn line(&self, file: u32, number: usize) -> &'a str {
        let starts = self.lines.get(file as usize).map_or(&[][..], Vec::as_slice);
        let text: &'a str = self.sources.0.get(file as usize).map_or("", |source| &source.text);
        let start = number.checked_sub(1).and_then(|index| starts.get(index)).copied().unwrap_or(text.len());
        let end = starts.get(number).copied().unwrap_or(text.len());
        text.get(start..end).unwrap_or_default().trim_end_matches(['\n', '\r'])
    }

    /// From 1; columns in characters.
    pub fn line_and_column(&self, file: u32, offset: u32) -> (usize, usize) {
        let (file, offset) = (file as usize, offset as usize);
        let (Some(source), Ok(line)) = (self.sources.0.get(file), self.line_index(file, offset)) else {
            return (1, 1);
        };
        let start = self.lines.get(file).and_then(|lines| lines.get(line)).copied().unwrap_or(0);
        let before = source.text.get(start..offset).unwrap_or_default();
        (line + 1, before.chars().count() + 1)
    }
}

impl<'a> Files<'a> for Shown<'a> {
    type FileId = usize;
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, id: usize) -> Result<&'a str, Error> {
        self.sources.0.get(id).map(|source| source.path.as_str()).ok_or(Error::FileMissing)
    }

    fn source(&'a self, id: usize) -> Result<&'a str, Error> {
        self.texts.get(id).map(String::as_str).ok_or(Error::FileMissing)
    }

    fn line_index(&'a self, id: usize, byte: usize) -> Result<usize, Error> {
        let lines = self.lines.get(id).ok_or(Error::FileMissing)?;
        Ok(lines.binary_search(&byte).unwrap_or_else(|next| next.saturating_sub(1)))
    }

    fn line_range(&'a self, id: usize, line: usize) -> Result<std::ops::Range<usize>, Error> {
        let lines = self.lines.get(id).ok_or(Error::FileMissing)?;
        let max = lines.len().saturating_sub(1);
        let start = *lines.get(line).ok_or(Error::LineTooLarge { given: line, max })?;
        let end = lines.get(line + 1).copied().unwrap_or(self.source(id)?.len());
        Ok(start..end)
    }
}
