//! Errors as editors get them: `--message-format json`, in rustc's shape.
//!
//! Every error file is read the way a problem matcher does it: by the lines and columns, by the
//! bytes, and by the edits that are suggested.

#[path = "errors/support.rs"]
#[allow(dead_code, reason = "shared with the test of the pages")]
mod support;

use serde_json::Value;
use support::{Case, root};
use texgraph_compiler::diagnostic::render;

/// The errors of a case as objects.
fn messages(case: &Case) -> Vec<Value> {
    let errors = case.errors();
    let lines = render::json(&errors.sources, &errors.diagnostics);
    let read = |line: &str| serde_json::from_str(line).unwrap_or_else(|why| panic!("{why}: {line}"));
    lines.lines().map(read).collect()
}

fn number(value: &Value, key: &str) -> usize {
    value[key].as_u64().unwrap_or_else(|| panic!("{key} of {value}")) as usize
}

fn list<'v>(value: &'v Value, key: &str) -> &'v [Value] {
    value[key].as_array().unwrap_or_else(|| panic!("{key} of {value}"))
}

/// The text of the file that a span names.
fn text_of(span: &Value) -> String {
    let name = span["file_name"].as_str().unwrap_or_default();
    support::text_of(&root().join(name)).unwrap_or_else(|why| panic!("{why}: {span}"))
}

/// What lies between two places given as lines and columns, both from 1, the columns in characters.
fn between(text: &str, start: (usize, usize), end: (usize, usize)) -> String {
    let offset = |(line, column): (usize, usize)| {
        let before: usize = text.split_inclusive('\n').take(line - 1).map(str::len).sum();
        let inside: usize = text[before..].chars().take(column - 1).map(char::len_utf8).sum();
        before + inside
    };
    text[offset(start)..offset(end)].to_owned()
}

/// Checks one span: bytes, columns and lines all cut the same text.
fn check(span: &Value) {
    let text = text_of(span);
    let by_bytes = &text[number(span, "byte_start")..number(span, "byte_end")];
    let start = (number(span, "line_start"), number(span, "column_start"));
    let end = (number(span, "line_end"), number(span, "column_end"));
    assert_eq!(by_bytes, between(&text, start, end), "{span}");
    let lines = list(span, "text");
    let of_file: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), end.0 + 1 - start.0, "{span}");
    let highlighted = lines.iter().enumerate().map(|(i, line)| {
        let shown = line["text"].as_str().unwrap_or_default();
        let whole = of_file.get(start.0 - 1 + i).copied().unwrap_or_default();
        match whole.chars().count() {
            0..=160 => assert_eq!(shown, whole),
            // Clipped: pieces of it are shown.
            _ => assert!(shown.split('…').all(|piece| whole.contains(piece)), "{shown}"),
        }
        let (from, to) = (number(line, "highlight_start"), number(line, "highlight_end"));
        shown.chars().skip(from - 1).take(to - from).collect::<String>()
    });
    assert_eq!(highlighted.collect::<Vec<_>>().join("\n"), by_bytes, "{span}");
}

#[test]
fn spans_cut_the_right_text() {
    let mut checked = 0;
    for message in Case::all().iter().flat_map(messages) {
        let spans = list(&message, "spans");
        assert_eq!(spans.iter().filter(|span| span["is_primary"] == true).count(), 1, "{message}");
        let edits = list(&message, "children").iter().flat_map(|child| list(child, "spans"));
        for span in spans.iter().chain(edits) {
            check(span);
            checked += 1;
        }
    }
    assert!(checked > 300, "{checked} spans");
}

#[test]
fn messages_have_the_keys_of_rustc() {
    let keys = ["$message_type", "message", "code", "level", "spans", "children", "rendered"];
    let of_span = [
        "file_name",
        "byte_start",
        "byte_end",
        "line_start",
        "line_end",
        "column_start",
        "column_end",
        "is_primary",
        "text",
        "label",
        "suggested_replacement",
        "suggestion_applicability",
        "expansion",
    ];
    for message in Case::all().iter().flat_map(messages) {
        let children = list(&message, "children");
        for object in std::iter::once(&message).chain(children) {
            assert!(keys.iter().all(|key| object.get(key).is_some()), "{object}");
            let spans = list(object, "spans");
            assert!(spans.iter().all(|span| of_span.iter().all(|key| span.get(key).is_some())), "{object}");
        }
        let is_warning = message["code"]["code"].as_str().is_some_and(|code| code.starts_with('W'));
        let level = if is_warning { "warning" } else { "error" };
        assert_eq!(message["level"], level);
        assert!(message["code"]["explanation"].as_str().is_some_and(|page| page.starts_with("# ")));
        assert!(message["rendered"].as_str().is_some_and(|page| page.starts_with(&format!("{level}["))));
        assert!(children.iter().all(|child| child["level"] == "help" && child["code"].is_null()));
    }
}

/// The text with all edits of a suggestion made.
fn edited(text: &str, edits: &[Value]) -> String {
    let mut edited = text.to_owned();
    for edit in edits.iter().rev() {
        let replacement = edit["suggested_replacement"].as_str().unwrap_or_else(|| panic!("{edit}"));
        edited.replace_range(number(edit, "byte_start")..number(edit, "byte_end"), replacement);
    }
    edited
}

#[test]
fn suggestions_mend_what_they_are_made_for() {
    let mut tried = 0;
    for case in Case::all() {
        for message in messages(&case) {
            let Some(child) =
                list(&message, "children").iter().find(|child| !list(child, "spans").is_empty())
            else {
                continue;
            };
            let edits = list(child, "spans");
            if edits[0]["file_name"] != format!("{}.tex", case.path()) {
                continue;
            }
            let before = text_of(&edits[0]);
            let after = edited(&before, edits);
            assert_ne!(before, after, "{message}");
            let code = message["code"]["code"].as_str().unwrap_or_default();
            let place = number(&list(&message, "spans")[0], "byte_start");
            let errors = case.errors_of_text(&after);
            let again =
                errors.iter().any(|error| error.code == code && error.place.span.start as usize == place);
            assert!(!again, "{}: {code} stays:\n{after}", case.path());
            tried += 1;
        }
    }
    assert!(tried > 30, "{tried} suggestions");
}
