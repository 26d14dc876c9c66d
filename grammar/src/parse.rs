//! Text to syntax tree; pest stays in here.
//!
//! A right file is read in one go. A wrong one is read again piece by piece ([`crate::recover`]);
//! each piece gives the errors that the scan has met in it, else the one where pest stopped, else
//! those of building its tree.
//!
//! `reader` matches the grammar; a text that it refuses goes to pest, which says where and why. The
//! other submodules turn what was matched into the tree, each function one rule: `items`,
//! `expressions` and `literals`, with `pairs` for walking.

#[cfg(test)]
mod agreement;
mod expressions;
mod items;
mod literals;
mod pairs;
mod reader;

use crate::diagnose::{self, Failure};
use crate::error::{SyntaxError, SyntaxErrorKind};
use crate::scan::{Scan, scan};
use crate::syntax::{Comment, File, Signature, Span};
use crate::{nesting, recover};
use pest::Parser;
use pest::error::{ErrorVariant, InputLocation};
use std::ops::Range;

/// The parser that pest derives from `tex.pest`; it explains what is wrong.
#[derive(pest_derive::Parser)]
#[grammar = "../tex.pest"]
struct TexParser;

/// What builds the tree of one piece.
struct Builder<'s> {
    /// Where the piece begins in the file.
    offset: usize,
    source: &'s str,
    comments: &'s [Comment],
    /// What the grammar lets pass and the language does not.
    errors: Vec<SyntaxError>,
}

/// Reads a file.
///
/// # Errors
///
/// All errors of the file, at most a few per item, in source order. Spans lie within the text and
/// on character boundaries.
pub fn parse(source: &str) -> Result<File, Vec<SyntaxError>> {
    let scan = scan(source).map_err(|error| vec![error])?;
    let whole = parse_piece(&scan, 0..scan.tokens.len());
    let whole = whole.map_err(|errors| match recover::pieces(&scan) {
        pieces if pieces.len() > 1 => parse_pieces(&scan, pieces).unwrap_or(errors),
        _ => errors,
    });
    whole.map(|file| File { comments: scan.comments, ..file })
}

/// The errors of all pieces, or `None` if there are none.
fn parse_pieces(scan: &Scan<'_>, pieces: Vec<Range<usize>>) -> Option<Vec<SyntaxError>> {
    let errors: Vec<_> =
        pieces.into_iter().filter_map(|piece| parse_piece(scan, piece).err()).flatten().collect();
    (!errors.is_empty()).then_some(errors)
}

/// Reads the items of some consecutive tokens.
fn parse_piece(scan: &Scan<'_>, tokens: Range<usize>) -> Result<File, Vec<SyntaxError>> {
    let text = text_of(scan, &tokens);
    let scanned = errors_within(scan, text.clone());
    if !scanned.is_empty() {
        return Err(scanned);
    }
    nesting::check(scan, &scan.tokens[tokens.clone()]).map_err(|error| vec![error])?;
    let piece = scan.source.get(text.clone()).unwrap_or_default();
    let Some(steps) = reader::file(piece) else {
        return Err(vec![diagnose::explain(scan, tokens, failure(Rule::file, piece, text.start))]);
    };
    let mut builder =
        Builder { offset: text.start, source: scan.source, comments: &scan.comments, errors: Vec::new() };
    let file = builder.file(&steps).map_err(|error| vec![error])?;
    if builder.errors.is_empty() { Ok(file) } else { Err(builder.errors) }
}

/// The text from the first of the tokens to the first one after them.
fn text_of(scan: &Scan<'_>, tokens: &Range<usize>) -> Range<usize> {
    let start_of = |index: usize| scan.tokens.get(index).map(|token| token.span.start as usize);
    let start = if tokens.start == 0 { 0 } else { start_of(tokens.start).unwrap_or(0) };
    start..start_of(tokens.end).unwrap_or(scan.source.len())
}

/// What the scan has found wrong in a stretch of text.
fn errors_within(scan: &Scan<'_>, text: Range<usize>) -> Vec<SyntaxError> {
    let place = |error: &SyntaxError| error.span.start as usize;
    let start = scan.errors.partition_point(|error| place(error) < text.start);
    let end = scan.errors.partition_point(|error| place(error) < text.end);
    scan.errors[start..end].to_vec()
}

/// Reads an intrinsic's head without its name: `<n>(a: vec<n>, b: vec<n>) -> vec<n>`.
///
/// # Errors
///
/// The first error of the text.
pub fn parse_signature(text: &str) -> Result<Signature, SyntaxError> {
    let scan = scan(text)?;
    if let Some(error) = scan.errors.first() {
        return Err(error.clone());
    }
    nesting::check(&scan, &scan.tokens)?;
    let Some(steps) = reader::signature(text) else {
        let failure = failure(Rule::signature, text, 0);
        return Err(diagnose::explain(&scan, 0..scan.tokens.len(), failure));
    };
    let mut builder = Builder { offset: 0, source: text, comments: &scan.comments, errors: Vec::new() };
    let signature = builder.signature(&steps)?;
    builder.errors.into_iter().next().map_or(Ok(signature), Err)
}

/// Where pest stops in a text that can't be read, and what it tried there. The text begins at
/// `offset` in the file.
fn failure(rule: Rule, text: &str, offset: usize) -> Failure {
    let Err(error) = TexParser::parse(rule, text) else {
        return Failure { at: offset, expected: Vec::new() };
    };
    let at = match error.location {
        InputLocation::Pos(at) | InputLocation::Span((at, _)) => offset + at,
    };
    let expected = match error.variant {
        ErrorVariant::ParsingError { positives, .. } => expected(&positives),
        ErrorVariant::CustomError { .. } => Vec::new(),
    };
    Failure { at, expected }
}

/// Whether a token, read on its own, is what a literal's rule wants.
pub(crate) fn is_literal(text: &str) -> bool {
    [Rule::number, Rule::color, Rule::text]
        .into_iter()
        .any(|rule| TexParser::parse(rule, text).is_ok_and(|pairs| pairs.as_str().len() == text.len()))
}

/// What pest tried, in words: the likeliest first.
fn expected(rules: &[Rule]) -> Vec<&'static str> {
    let mut words: Vec<(u8, &'static str)> = rules.iter().filter_map(|rule| in_words(*rule)).collect();
    words.sort_unstable();
    words.dedup();
    let best = words.first().map_or(0, |word| word.0);
    // An operator could follow any expression: it is worth a word only where nothing else could.
    words.retain(|word| word.0 < 9 || best == 9);
    // A name inside a call's brackets could still become an argument's name.
    if words.iter().any(|word| word.1 == "`,`") {
        words.retain(|word| word.1 != "`:`");
    }
    words.into_iter().take(4).map(|word| word.1).collect()
}

/// A rule in the reader's words, with its rank.
fn in_words(rule: Rule) -> Option<(u8, &'static str)> {
    Some(match rule {
        Rule::file | Rule::item => (0, "an item"),
        Rule::statement => (0, "an assignment"),
        Rule::input | Rule::name | Rule::field | Rule::inner_field => (1, "a name"),
        Rule::accumulator | Rule::pattern => (1, "a name"),
        Rule::ty | Rule::inner_type | Rule::inner_output | Rule::signature_output => (1, "a type"),
        Rule::expr | Rule::postfix | Rule::argument => (1, "an expression"),
        Rule::range => (1, "a range"),
        Rule::text => (1, "a string"),
        Rule::equals => (2, "`=`"),
        Rule::colon => (2, "`:`"),
        Rule::arrow => (2, "`->`"),
        Rule::range_operator => (2, "`..`"),
        Rule::kw_for => (2, "`for`"),
        Rule::kw_in => (2, "`in`"),
        Rule::kw_else => (2, "`else`"),
        Rule::kw_max => (3, "`max`"),
        Rule::kw_while => (3, "`while`"),
        Rule::kw_tiles => (3, "`tiles`"),
        Rule::comma => (4, "`,`"),
        Rule::lparen | Rule::inputs | Rule::record | Rule::signature => (5, "`(`"),
        Rule::rparen => (5, "`)`"),
        Rule::rbracket => (5, "`]`"),
        Rule::lbrace | Rule::arm | Rule::body => (5, "`{`"),
        Rule::rbrace => (5, "`}`"),
        Rule::greater => (5, "`>`"),
        Rule::bar => (5, "`|`"),
        Rule::EOI => (6, "the end"),
        Rule::operator => (9, "an operator"),
        _ => return None,
    })
}

impl Builder<'_> {
    /// The error for a pair that the grammar promises and that is not there.
    fn missing(&self, what: &'static str) -> SyntaxError {
        let span = Span::new(self.offset, self.offset);
        SyntaxError::new(SyntaxErrorKind::Grammar { missing: what }, span)
    }
}
