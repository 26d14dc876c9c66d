//! The lines of the sources that one page shows, each no longer than a reader can take in.
//!
//! A page asks for lines near its labels only. They are copied here one after another, long ones
//! clipped around the labels, so that a file of a single line of a mebibyte costs no more than any.
//! Offsets given to codespan-reporting count in this copy; line and column numbers are those of the
//! source.

use super::Place;
use super::clip::{Clipped, clip};
use super::render::Shown;
use codespan_reporting::files::{Error, Files};
use std::collections::BTreeMap;
use std::ops::Range;

/// The most lines before and behind an end of a label that may be shown: three of context, and one
/// that stands alone between two that are shown.
const AROUND: usize = 4;

/// What one page shows of the sources.
pub(super) struct Excerpt<'a> {
    files: &'a Shown<'a>,
    parts: BTreeMap<usize, Part>,
}

/// What it shows of one file.
#[derive(Default)]
struct Part {
    text: String,
    /// By their number, from 0: where they stand in `text`.
    lines: BTreeMap<usize, (usize, Clipped)>,
}

impl<'a> Excerpt<'a> {
    /// What is around places.
    pub fn new(files: &'a Shown<'a>, places: &[Place]) -> Excerpt<'a> {
        let mut parts: BTreeMap<usize, Part> = BTreeMap::new();
        for (file, marks) in marks(files, places) {
            let mut part = Part::default();
            for line in marks.keys().flat_map(|line| line.saturating_sub(AROUND)..=line + AROUND) {
                part.add(line, files.line(file, line + 1), marks.get(&line).map_or(&[], Vec::as_slice));
            }
            parts.insert(file as usize, part);
        }
        Excerpt { files, parts }
    }

    /// A file with the place in this copy; none for a place in no file.
    pub fn range(&self, place: Place) -> Option<(usize, Range<usize>)> {
        let file = place.file as usize;
        let part = self.parts.get(&file)?;
        let offset = |offset| {
            let (line, column) = self.files.line_and_byte(place.file, offset)?;
            let (start, shown) = part.lines.get(&line)?;
            Some(start + shown.shown(column))
        };
        Some((file, offset(place.span.start)?..offset(place.span.end)?))
    }

    fn part(&self, file: usize) -> Result<&Part, Error> {
        self.parts.get(&file).ok_or(Error::FileMissing)
    }
}

/// The ends of places by file and line (from 0), as bytes from the line's start.
fn marks(files: &Shown, places: &[Place]) -> BTreeMap<u32, BTreeMap<usize, Vec<usize>>> {
    let mut marks: BTreeMap<u32, BTreeMap<usize, Vec<usize>>> = BTreeMap::new();
    for place in places {
        for offset in [place.span.start, place.span.end] {
            if let Some((line, byte)) = files.line_and_byte(place.file, offset) {
                marks.entry(place.file).or_default().entry(line).or_default().push(byte);
            }
        }
    }
    marks
}

impl Part {
    fn add(&mut self, number: usize, line: &str, marks: &[usize]) {
        if self.lines.contains_key(&number) {
            return;
        }
        let shown = clip(line, marks);
        let start = self.text.len();
        self.text.push_str(&super::render::printable(&shown.text));
        self.text.push('\n');
        self.lines.insert(number, (start, shown));
    }
}

impl<'a> Files<'a> for Excerpt<'a> {
    type FileId = usize;
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, id: usize) -> Result<&'a str, Error> {
        self.files.sources.0.get(id).map(|source| source.path.as_str()).ok_or(Error::FileMissing)
    }

    fn source(&'a self, id: usize) -> Result<&'a str, Error> {
        Ok(&self.part(id)?.text)
    }

    fn line_index(&'a self, id: usize, byte: usize) -> Result<usize, Error> {
        let lines = &self.part(id)?.lines;
        let before = lines.iter().rev().find(|(_, (start, _))| *start <= byte);
        Ok(before.map_or(0, |(number, _)| *number))
    }

    fn column_number(&'a self, id: usize, line: usize, byte: usize) -> Result<usize, Error> {
        let part = self.part(id)?;
        let original = part.lines.get(&line).map_or(0, |(start, shown)| shown.original(byte - start));
        Ok(self.files.column(id as u32, line, original))
    }

    /// Empty for a line that is not shown.
    fn line_range(&'a self, id: usize, line: usize) -> Result<Range<usize>, Error> {
        let part = self.part(id)?;
        let range = part.lines.get(&line).map(|(start, shown)| *start..start + shown.text.len());
        Ok(range.unwrap_or_default())
    }
}
