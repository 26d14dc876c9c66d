//! The reader and pest say the same of every text.

use super::reader::{self, Step};
use super::{Rule, TexParser};
use crate::syntax::Span;
use pest::Parser;
use std::path::Path;

/// Rules that match one text only; the reader records none of them.
const MARKS: [Rule; 29] = [
    Rule::lparen,
    Rule::rparen,
    Rule::lbracket,
    Rule::rbracket,
    Rule::lbrace,
    Rule::rbrace,
    Rule::less,
    Rule::greater,
    Rule::comma,
    Rule::colon,
    Rule::arrow,
    Rule::dot,
    Rule::bar,
    Rule::equals,
    Rule::kw_use,
    Rule::kw_let,
    Rule::kw_param,
    Rule::kw_node,
    Rule::kw_texture,
    Rule::kw_if,
    Rule::kw_else,
    Rule::kw_fold,
    Rule::kw_for,
    Rule::kw_in,
    Rule::kw_while,
    Rule::kw_as,
    Rule::kw_max,
    Rule::kw_tiles,
    Rule::EOI,
];

/// A rule with its place and text.
type Match<'s> = (Rule, u32, &'s str);

fn with_reader(text: &str) -> Option<Vec<Match<'_>>> {
    let text_of = |step: &Step| (step.rule, step.span.start, &text[step.span.range()]);
    Some(reader::file(text)?.iter().map(text_of).collect())
}

/// What is left of a text without the white space and comments at its end.
fn without_skipped(text: &str) -> &str {
    let scan = crate::scan::scan(text).expect("short");
    let end = scan.tokens.last().map_or(0, |token| token.span.end);
    &text[Span { start: 0, end }.range()]
}

fn with_pest(text: &str) -> Option<Vec<Match<'_>>> {
    let pairs = TexParser::parse(Rule::file, text).ok()?.flatten();
    let kept = pairs.filter(|pair| !MARKS.contains(&pair.as_rule()));
    Some(
        kept.map(|pair| {
            let span = pair.as_span();
            (pair.as_rule(), span.start() as u32, without_skipped(span.as_str()))
        })
        .collect(),
    )
}

/// All `.tex` files of the repository.
fn texts() -> Vec<String> {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("..")];
    let mut texts = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let (path, name) = (entry.path(), entry.file_name());
            let is_source = !["target", "node_modules", ".git"].iter().any(|other| name == *other);
            if path.is_dir() && is_source {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "tex") {
                texts.extend(std::fs::read_to_string(path));
            }
        }
    }
    texts
}

#[test]
fn on_every_file() {
    let texts = texts();
    assert!(texts.len() > 100, "the repository has many files");
    for text in &texts {
        assert_eq!(with_reader(text), with_pest(text), "{text}");
    }
}

/// Every token of a file is left out, doubled and exchanged with the next, one at a time.
#[test]
fn on_slips() {
    let mut right = 0;
    for text in texts().iter().filter(|text| text.len() < 800) {
        let Ok(scan) = crate::scan::scan(text) else { continue };
        for pair in scan.tokens.windows(2) {
            let [a, b] = [pair[0].span.range(), pair[1].span.range()];
            let (before, between, behind) = (&text[..a.start], &text[a.end..b.start], &text[b.end..]);
            let [a, b] = [&text[a], &text[b]];
            for middle in [
                format!("{between}{b}"),
                format!("{a}{b}"),
                format!("{a} {a}{between}{b}"),
                format!("{b}{between}{a}"),
                format!("{a}/* */ {b}"),
            ] {
                let slip = format!("{before}{middle}{behind}");
                let read = with_reader(&slip);
                right += usize::from(read.is_some());
                assert_eq!(read, with_pest(&slip), "{slip}");
            }
        }
    }
    assert!(right > 500, "many slips are no errors of the syntax: {right}");
}
