//! The reader of right texts: what it records, and the helpers of its rules.
//!
//! The rules are made of `tex.pest` when this crate is built (`build/`), so the grammar stays the only
//! definition. They match like pest's: in order, greedily, without going back into what has matched.

use super::Rule;
use crate::syntax::Span;

/// A rule that matched; the rules within it follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Step {
    pub rule: Rule,
    /// How many steps it is, itself and all within it.
    pub size: u32,
    /// Where it stands in the text, without what was skipped behind it.
    pub span: Span,
}

struct Reader<'s> {
    text: &'s [u8],
    /// The place of the next byte.
    at: usize,
    /// The stretch that was skipped last.
    gap: (usize, usize),
    steps: Vec<Step>,
}

/// A place to come back to.
#[derive(Clone, Copy)]
struct Mark {
    at: usize,
    steps: usize,
}

/// What a whole file is made of; nothing if it is wrong.
pub(super) fn file(text: &str) -> Option<Vec<Step>> {
    read(text, |reader| reader.match_file())
}

/// The same of an intrinsic's head.
pub(super) fn signature(text: &str) -> Option<Vec<Step>> {
    read(text, |reader| reader.match_signature())
}

fn read(text: &str, rule: fn(&mut Reader<'_>) -> bool) -> Option<Vec<Step>> {
    let steps = Vec::with_capacity(text.len() / 2);
    let mut reader = Reader { text: text.as_bytes(), at: 0, gap: (0, 0), steps };
    rule(&mut reader).then_some(reader.steps)
}

impl Reader<'_> {
    /// The next byte; 0 at the end.
    #[inline]
    fn peek(&self) -> u8 {
        self.text.get(self.at).copied().unwrap_or(0)
    }

    fn is_at_end(&self) -> bool {
        self.at == self.text.len()
    }

    /// Takes a byte that has been looked at.
    fn step(&mut self) -> bool {
        self.at += 1;
        true
    }

    /// Takes all bytes of a kind.
    #[inline]
    fn run(&mut self, is_one: impl Fn(u8) -> bool) -> bool {
        let rest = self.text.get(self.at..).unwrap_or_default();
        self.at += rest.iter().position(|byte| !is_one(*byte)).unwrap_or(rest.len());
        true
    }

    /// Takes a word.
    #[inline]
    fn word(&mut self, word: &[u8]) -> bool {
        let is_there = self.text.get(self.at..).is_some_and(|rest| rest.starts_with(word));
        self.at += if is_there { word.len() } else { 0 };
        is_there
    }

    /// Takes a character.
    fn any(&mut self) -> bool {
        let length = match self.peek() {
            _ if self.is_at_end() => return false,
            0..0x80 => 1,
            0x80..0xE0 => 2,
            0xE0..0xF0 => 3,
            0xF0.. => 4,
        };
        self.at += length;
        true
    }

    fn mark(&self) -> Mark {
        Mark { at: self.at, steps: self.steps.len() }
    }

    /// Forgets what was read since; another way may be tried.
    fn back(&mut self, mark: Mark) -> bool {
        self.at = mark.at;
        self.steps.truncate(mark.steps);
        true
    }

    /// Notes what was skipped.
    fn skipped(&mut self, from: usize) -> bool {
        if from < self.at {
            self.gap = (from, self.at);
        }
        true
    }

    /// Begins a step whose rule is still to match.
    fn open(&mut self) -> usize {
        self.steps.push(Step { rule: Rule::EOI, size: 0, span: Span::new(self.at, self.at) });
        self.steps.len() - 1
    }

    /// The rule has matched.
    fn close(&mut self, open: usize, rule: Rule) -> bool {
        let size = self.steps.len() - open;
        let end = if self.gap.1 == self.at { self.gap.0 } else { self.at };
        if let Some(step) = self.steps.get_mut(open) {
            (step.rule, step.size, step.span.end) = (rule, size as u32, end as u32);
        }
        true
    }
}

#[allow(warnings, clippy::all, clippy::pedantic, reason = "made by build/")]
mod rules {
    use super::{Reader, Rule};
    include!(concat!(env!("OUT_DIR"), "/reader.rs"));
}
