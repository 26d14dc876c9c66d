//! The formatter: canonical, complete and idempotent.

use std::sync::LazyLock;
use texgraph_grammar::{format, parse, syntax::File};

mod support;

fn formatted(source: &str) -> String {
    format(source).unwrap_or_else(|errors| panic!("{errors:?}\n{source}"))
}

/// The tree without its places: what must survive formatting.
fn shape(source: &str) -> String {
    let File { doc, items, .. } = parse(source).unwrap_or_else(|errors| panic!("{errors:?}\n{source}"));
    let text = format!("{doc:?} {items:?}");
    let mut out = String::new();
    let mut rest = text.as_str();
    while let Some(at) = rest.find("Span {") {
        out.push_str(&rest[..at]);
        rest = &rest[at + rest[at..].find('}').unwrap() + 1..];
    }
    out + rest
}

fn check(source: &str) -> String {
    let once = formatted(source);
    assert_eq!(shape(source), shape(&once), "{source}\n----\n{once}");
    assert_eq!(formatted(&once), once, "formatted twice:\n{source}");
    assert!(once.lines().all(|line| line.trim_end() == line), "{once}");
    once
}

#[test]
fn examples_are_stable() {
    for (name, source) in support::examples() {
        let once = check(&source);
        assert!(once.ends_with('\n') && !once.ends_with("\n\n"), "{name}");
        let long = once.lines().find(|line| line.chars().count() > 100 && !line.contains("//"));
        assert_eq!(long, None, "{name}");
    }
}

#[test]
fn a_canonical_file_stays_as_it_is() {
    let source = support::example("tiling.tex");
    assert_eq!(formatted(&source), source);
}

#[test]
fn assignments_align() {
    let source = "texture t(uv: vec2) -> (color: color) {
let (cell, at) = tile_map(uv, 3)
let pick = f(cell)
color = g(pick, at)

let alone = 1
// apart
let b = 2
}";
    let expected = "texture t(uv: vec2) -> (color: color) {
    let (cell, at) = tile_map(uv, 3)
    let pick       = f(cell)
    color          = g(pick, at)

    let alone = 1
    // apart
    let b = 2
}
";
    assert_eq!(check(source), expected);
}

#[test]
fn empty_lines() {
    let source = "\n\n// c\n\n\n\nlet a = 1\n\n\n\nlet b = 2\nnode n() -> (a: int) {\n\n\na = 1\n\n\n}\nlet c = 3\n\n\n";
    let expected = "// c\n\nlet a = 1\n\nlet b = 2\n\nnode n() -> (a: int) {\n    a = 1\n}\n\nlet c = 3\n";
    assert_eq!(check(source), expected);
}

#[test]
fn what_is_too_long_breaks() {
    let name = "long_name_of_a_wire";
    let sum = [name; 8].join(" + ");
    let source = format!("let a = {sum}\nlet b = f({}, x: 3)\n", [name; 6].join(", "));
    let expected = format!(
        "let a = {}\nlet b = f(\n{}    x: 3,\n)\n",
        [name; 8].join("\n    + "),
        format!("    {name},\n").repeat(6)
    );
    assert_eq!(check(&source), expected);
}

#[test]
fn lists_of_numbers_fill_lines() {
    let source = format!("let a = indices([{}])", ["123456789"; 30].join(","));
    let once = check(&source);
    assert!(once.lines().count() < 9, "{once}");
}

#[test]
fn long_heads_break_at_their_inputs() {
    let inputs = ["position: vec3 = vec3(0.0)"; 4].join(", ");
    let once = check(&format!("node n<n>({inputs}) -> (value: float) {{ value = 1.0 }}"));
    assert_eq!(once.lines().count(), 8, "{once}");
    assert!(once.contains("\n) -> (value: float) {\n"), "{once}");
}

#[test]
fn line_endings_become_lf() {
    let once = check("// a\r\nlet a = /* b\r\nc */ 1\r\n\r\nlet b = 2\r\n");
    assert!(!once.contains('\r'), "{once}");
}

#[test]
fn an_empty_file_stays_empty() {
    assert_eq!(check(""), "");
    assert_eq!(check("\n\n"), "");
    assert_eq!(check("// only"), "// only\n");
    assert_eq!(check("/* only */"), "/* only */\n");
}

/// Every gap of a text in which a comment may stand, by asking the parser.
fn gaps(source: &str) -> Vec<usize> {
    let is_word = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    (0..=source.len())
        .filter(|at| source.is_char_boundary(*at))
        .filter(|at| {
            let (before, after) = source.as_bytes().split_at(*at);
            let inside = before.last().is_some_and(|byte| is_word(*byte))
                && after.first().is_some_and(|byte| is_word(*byte));
            let text = format!("{} /**/ {}", &source[..*at], &source[*at..]);
            !inside && parse(&text).is_ok_and(|file| file.comments.len() == 1)
        })
        .collect()
}

static GAPS: LazyLock<Vec<usize>> = LazyLock::new(|| gaps(EVERYTHING));

const EVERYTHING: &str = "use \"a.tex\" as b
let a = image(\"f.png\", wrap: repeat,)
param p: ivec2 = ivec2(1, -2) in ivec2(0)..=ivec2(9)
node n<n, m>(a: vec<n>, f: node(x: (d: float, r: float)) -> color = g, k: one | two = one,) -> (v: vec<n>, w: float) {
    let (c, d,) = !x.y[1] || f<2>(#fff, 90deg) && 1 < 2
    v = fold (h = 1.0, k = 2,) for i in 0..n max 8 while h < 3.0 { h = h + i k = -h }
    w = if a { [1, 2,] } else if b { (c) } else { f(|| 1, |x, y,| x * y) }
}
texture t(uv: vec2) -> (color: color) tiles 1 { color = f(a).g(b)[0].x }
";

fn check_comment(at: usize, comment: &str) {
    let source = format!("{}{comment}{}", &EVERYTHING[..at], &EVERYTHING[at..]);
    if parse(&source).is_err() {
        return;
    }
    let once = formatted(&source);
    assert_eq!(once.matches("c1c").count(), 1, "{source}\n----\n{once}");
    assert_eq!(shape(&source), shape(&once), "{source}\n----\n{once}");
    assert_eq!(formatted(&once), once, "formatted twice:\n{source}");
}

#[test]
fn one_comment_anywhere() {
    assert!(GAPS.len() > 250, "{}", GAPS.len());
    for at in GAPS.iter().copied() {
        for comment in [" /*c1c*/ ", " // c1c\n", "\n// c1c\n", "\n\n/* c1c */\n\n", " /* c1c\n*/ "] {
            check_comment(at, comment);
        }
    }
}

#[test]
fn comments_everywhere() {
    for mark in [" /*c#c*/ ", " // c#c\n", "\n// c#c\n", "\n\n/* c#c */\n\n", " /*c#c*/ // c#d\n"] {
        let mut source = String::new();
        let mut before = 0;
        for (index, at) in GAPS.iter().enumerate() {
            source.push_str(&EVERYTHING[before..*at]);
            source.push_str(&mark.replace('#', &index.to_string()));
            before = *at;
        }
        source.push_str(&EVERYTHING[before..]);
        let once = check(&source);
        for index in 0..GAPS.len() {
            assert_eq!(once.matches(&format!("c{index}c")).count(), 1, "comment {index}:\n{once}");
        }
        let kinds = |text: &str| -> Vec<_> {
            parse(text).unwrap().comments.into_iter().map(|comment| comment.kind).collect()
        };
        assert_eq!(kinds(&source), kinds(&once));
    }
}

#[test]
fn any_white_space_gives_the_same_text() {
    let mut random = support::Random(7);
    for (_, source) in support::examples() {
        let code: Vec<&str> = source.lines().filter(|line| !line.contains("//")).collect();
        let once = formatted(&code.join("\n"));
        for _ in 0..20 {
            let mut ragged = String::new();
            for character in once.chars() {
                let inside = !ragged.ends_with(char::is_whitespace);
                ragged.push(character);
                if character == ' ' && inside {
                    ragged.push_str([" ", "", "\n", "\t"][random.below(4)]);
                }
            }
            assert_eq!(check(&ragged), once);
        }
    }
}

#[test]
fn deep_and_long_files_format() {
    check(&format!("let a = {}1{}", "f(|a| ".repeat(128), ")".repeat(128)));
    check(&format!("let a = {}1{}", "-if a { ".repeat(64), "} else { 1 }".repeat(64)));
    check(&format!("let a = {}1{}", "fold (a = 1) for i in 1..2 { a = ".repeat(127), "}".repeat(127)));
    formatted(&format!("let a = 1{}", " + 1".repeat(100_000)));
    formatted(&format!("let a = 1{}", ".abs()".repeat(100_000)));
    formatted(&"let a = 1\n".repeat(50_000));
}
