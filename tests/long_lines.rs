//! Error pages of long lines: what is shown is what stands around the marks, with the carets below it.

#[path = "errors/support.rs"]
#[allow(dead_code, reason = "shared with the test of the pages")]
mod support;

use serde_json::Value;
use support::errors_of;
use texgraph_compiler::Failure;
use texgraph_compiler::diagnostic::render;

fn failure(text: &str) -> Failure {
    errors_of(text).expect_err("the text is wrong")
}

fn page(text: &str) -> String {
    let failure = failure(text);
    render::human(&failure.sources, &failure.diagnostics)
}

/// A texture in one line, with so much before what is wrong and behind it.
fn one_line(before: &str, count: usize, wrong: &str) -> String {
    let around = before.repeat(count);
    format!("texture t(uv: vec2) -> (height: float) {{ {around}height = {wrong} {around}}}")
}

#[test]
fn an_error_in_the_middle() {
    let text = one_line("/* 0123456789 */ ", 300, "uvv.x");
    assert!(text.len() > 10_000);
    insta::assert_snapshot!(page(&text));
}

#[test]
fn tabs_and_wide_characters() {
    let text = one_line("/* \t漢字かな交じり文\t🙂é */ ", 200, "/*漢\t*/ uvv.x /*\t字*/");
    insta::assert_snapshot!(page(&text));
}

#[test]
fn two_places_far_apart() {
    let comment = "/* 0123456789 */ ".repeat(100);
    let text = format!(
        "texture t(uv: vec2) -> (height: float) {{ {comment}let a = 1.0 {comment}let a = 2.0 {comment}height = a }}"
    );
    insta::assert_snapshot!(page(&text));
}

#[test]
fn a_mark_longer_than_a_page_is_wide() {
    let sum = "uv.x + ".repeat(2000);
    insta::assert_snapshot!(page(&one_line("", 0, &format!("[{sum}uv.y]"))));
}

#[test]
fn the_first_and_last_columns() {
    let comment = format!("/*{}*/", "-".repeat(5000));
    let whole = "texture t(uv: vec2) -> (height: float) { height = uv.x }";
    insta::assert_snapshot!("first_column", page(&format!("textur {comment} {whole}")));
    insta::assert_snapshot!("last_column", page(&format!("{whole} {comment} }}")));
}

#[test]
fn long_lines_beside_short_ones() {
    let comment = format!("/*{}*/", "-".repeat(500));
    let text = format!(
        "texture t(uv: vec2) -> (height: float) {{\n    height = if uv.x > 0.5 {{\n        {comment} uv.x\n    }} else {{\n        \
         uv {comment}\n    }}\r\n}}\n"
    );
    insta::assert_snapshot!(page(&text));
}

#[test]
fn a_line_of_a_mebibyte() {
    let before = "/* 0123456789 */ ";
    let text = one_line(before, (1 << 19) / before.len() - 4, "uvv.x");
    let text = format!("{text}{}", " ".repeat((1 << 20) - text.len()));
    let page = page(&text);
    assert!(page.len() < 1500, "{} bytes", page.len());
    assert!(page.contains(":1:52"), "{page}");
}

#[test]
fn many_errors_in_one_line() {
    let statements: String = (0..5_000).map(|i| format!("let a{i} = nobody{i} ")).collect();
    let text = format!("texture t(uv: vec2) -> (height: float) {{ {statements}height = uv.x }}");
    let failure = failure(&text);
    let each = failure.diagnostics.len();
    assert!(each >= 1);
    for rendered in [
        render::human(&failure.sources, &failure.diagnostics),
        render::json(&failure.sources, &failure.diagnostics),
    ] {
        assert!(rendered.len() < 6000 * each, "{} bytes for {each} errors", rendered.len());
    }
}

#[test]
fn objects_keep_their_bytes_and_columns() {
    let text = one_line("/* \t漢字 */ ", 1000, "uvv.x");
    let failure = failure(&text);
    let line = render::json(&failure.sources, &failure.diagnostics);
    let message: Value = serde_json::from_str(line.lines().next().unwrap_or_default()).expect("an object");
    let span = &message["spans"][0];
    let at = text.find("uvv").expect("it stands there");
    assert_eq!(span["byte_start"], at);
    assert_eq!(span["byte_end"], at + 3);
    assert_eq!(span["column_start"], text[..at].chars().count() + 1);
    let shown = &span["text"][0];
    let words = shown["text"].as_str().expect("a text");
    let number = |key: &str| shown[key].as_u64().expect("a number") as usize;
    let (from, to) = (number("highlight_start"), number("highlight_end"));
    assert_eq!(words.chars().skip(from - 1).take(to - from).collect::<String>(), "uvv");
    assert!(words.chars().count() < 170, "{words}");
}
