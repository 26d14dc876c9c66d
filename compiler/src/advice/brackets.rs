//! A call whose opening bracket was forgotten: `sinx * pace)`.
//!
//! The parser finds the closing bracket, which is right where it stands. Which word was meant as a
//! call only someone tells who knows the nodes there are.

use crate::diagnostic::{Diagnostic, Place};
use crate::library::Library;
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::Range;
use texgraph_grammar::syntax::Span;

/// Constructors of vectors, which are in no table.
const VECTORS: [&str; 10] =
    ["float", "int", "ivec", "ivec2", "ivec3", "ivec4", "vec", "vec2", "vec3", "vec4"];

/// How many lines a statement is followed back.
const LINES: usize = 32;

/// Longer words are no name and its argument.
const LONGEST: usize = 64;

/// Errors of a file that are looked at.
const MOST: usize = 20;

/// Adds to errors at a `)` or `,` that stands in no brackets the word that was probably a call.
pub fn forgotten(library: &Library, text: &str, diagnostics: &mut [Diagnostic]) {
    let outside = diagnostics.iter_mut().take(MOST).filter(|diagnostic| is_outside(text, diagnostic));
    let mut outside = outside.peekable();
    if outside.peek().is_none() {
        return;
    }
    let words = Words::new(library, text);
    for diagnostic in outside {
        let bracket = if text[diagnostic.place.span.range()].starts_with(']') { '[' } else { '(' };
        if let Some((word, name)) = words.split(diagnostic.place.span.start as usize, bracket) {
            let place = Place { span: Span::new(word.start, word.end), ..diagnostic.place };
            let label = format!("is a `{bracket}` missing after `{}`?", &text[word.start..name]);
            diagnostic.related.push((place, label));
        }
    }
}

fn is_outside(text: &str, diagnostic: &Diagnostic) -> bool {
    match text.get(diagnostic.place.span.range()) {
        Some(")" | "]") => diagnostic.code == "E0014",
        Some(",") => diagnostic.code == "E0011" && !diagnostic.message.contains("`)`"),
        _ => false,
    }
}

/// The words of a file.
struct Words<'a> {
    text: &'a str,
    library: &'a Library,
    /// How often each stands in the file.
    counts: FxHashMap<&'a str, u32>,
    /// The names of the file's nodes.
    nodes: FxHashSet<&'a str>,
}

impl<'a> Words<'a> {
    fn new(library: &'a Library, text: &'a str) -> Words<'a> {
        let mut words = Words { text, library, counts: FxHashMap::default(), nodes: FxHashSet::default() };
        let mut before = "";
        for word in words_of(text, 0..text.len()) {
            let word = &text[word];
            *words.counts.entry(word).or_insert(0) += 1;
            if matches!(before, "node" | "texture") {
                words.nodes.insert(word);
            }
            before = word;
        }
        words
    }

    /// The last word of a statement that may be a name without its bracket, and where the name ends.
    fn split(&self, end: usize, bracket: char) -> Option<(Range<usize>, usize)> {
        let words = words_of(self.text, self.statement(end)?..end);
        let names = words.filter_map(|word| Some((word.clone(), word.start + self.name(word, bracket)?)));
        names.last()
    }

    /// Where the statement around a place begins.
    fn statement(&self, place: usize) -> Option<usize> {
        let mut end = place;
        for _ in 0..LINES {
            let start = self.text[..end].rfind('\n').map_or(0, |line| line + 1);
            if begins_statement(&self.text[start..]) {
                return Some(start);
            }
            end = start.checked_sub(1)?;
        }
        None
    }

    /// The length of the name that a word begins with, if the rest of it was meant to be behind a
    /// bracket.
    fn name(&self, word: Range<usize>, bracket: char) -> Option<usize> {
        let (text, behind) = (&self.text[word.clone()], &self.text[word.end..]);
        let is_type = self.text[..word.start].trim_end().ends_with(':') || behind.starts_with('<');
        let is_right = behind.starts_with(bracket) && self.is_known(text, bracket);
        if is_type || is_right || text.starts_with(|c: char| c.is_ascii_digit()) {
            return None;
        }
        if VECTORS.contains(&text) && bracket == '(' {
            return Some(text.len());
        }
        // What stands elsewhere too is a name of the file.
        if text.len() > LONGEST || self.count(text) > 1 {
            return None;
        }
        (2..=text.len()).rev().find(|length| self.is_known(&text[..*length], bracket))
    }

    fn count(&self, word: &str) -> u32 {
        self.counts.get(word).copied().unwrap_or(0)
    }

    /// Whether a name is called, or may be indexed.
    fn is_known(&self, name: &str, bracket: char) -> bool {
        if bracket == '[' {
            return self.count(name) > 0;
        }
        VECTORS.contains(&name) || self.nodes.contains(name) || !self.library.callables(name).is_empty()
    }
}

/// The words of a stretch of text.
fn words_of(text: &str, stretch: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let mut at = stretch.start;
    std::iter::from_fn(move || {
        let rest = text.get(at..stretch.end)?;
        let start = at + rest.find(is_word)?;
        let rest = text.get(start..stretch.end)?;
        at = start + rest.find(|c| !is_word(c)).unwrap_or(rest.len());
        Some(start..at)
    })
}

/// `let`, an item, or `name =`
fn begins_statement(line: &str) -> bool {
    let line = line.trim_start();
    let word = line.find(|c| !is_word(c)).unwrap_or(line.len());
    let behind = line[word..].trim_start();
    matches!(&line[..word], "let" | "param" | "node" | "texture")
        || (word > 0 && behind.starts_with('=') && !behind.starts_with("=="))
}

fn is_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}
