//! The limits: what is within them parses on any thread, what is beyond them is an error.

use texgraph_grammar::{MAX_BYTES, MAX_NESTING, format, parse};

/// A text nested to a depth.
type Nest = fn(usize) -> String;

fn wrap(before: &str, inner: &str, after: &str, depth: usize) -> String {
    format!("{}{inner}{}", before.repeat(depth), after.repeat(depth))
}

fn value(before: &str, after: &str, depth: usize) -> String {
    format!("let a = {}", wrap(before, "1", after, depth))
}

/// Every way to nest, each one level per step.
const NESTS: &[(&str, Nest)] = &[
    ("brackets", |depth| value("(", ")", depth)),
    ("lists", |depth| value("[", "]", depth)),
    ("indices", |depth| value("a[", "]", depth)),
    ("calls", |depth| value("f(", ")", depth)),
    ("methods", |depth| value("a * b.f(c, x: ", ") + 1 && d", depth)),
    ("dimensions", |depth| value("f<n>(", ")", depth)),
    ("lambdas", |depth| value("f(|a, b| ", ")", depth)),
    ("lambdas and methods", |depth| value("a + b.f<n>(x: |c, d| c < d && ", ") * 1", depth)),
    ("minuses", |depth| value("-", "", depth)),
    ("nots", |depth| value("! ", "", depth)),
    ("arms", |depth| value("if a { ", "} else { 1 }", depth)),
    ("else arms", |depth| value("if a { 1 } else { ", "}", depth)),
    ("conditions", |depth| value("if ", "{ 1 } else { 2 }", depth)),
    ("else ifs", |depth| {
        let more = "else if a { 1 } ".repeat(depth - 1);
        format!("let a = if a {{ 1 }} {more} else {{ 2 }}")
    }),
    ("folds", |depth| value("fold (a = 1) for i in 0..2 { a = ", "}", depth - 1)),
    ("fold ranges", |depth| value("fold (a = 1) for i in 0..", " {}", depth - 1)),
    ("fold conditions", |depth| value("fold (a = 1) for i in 0..2 while ", " {}", depth - 1)),
    ("fold limits", |depth| value("fold (a = 1) for i in 0..2 max ", " {}", depth - 1)),
    ("types", |depth| {
        let ty = wrap("node(x: ", "int", ") -> int", depth - 1);
        format!("node a(x: {ty}) -> (a: int) {{}}")
    }),
    ("comments", |depth| wrap("/* ", "", " */", depth)),
];

#[test]
fn nesting_is_bounded() {
    for (name, nest) in NESTS {
        let deepest = parse(&nest(MAX_NESTING));
        assert!(deepest.is_ok(), "{name}: {deepest:?}");
        let deeper = parse(&nest(MAX_NESTING + 1)).expect_err(name);
        let codes: Vec<_> = deeper.iter().map(|error| error.code()).collect();
        assert_eq!(codes, ["E0002"], "{name}: {deeper:?}");
    }
}

#[test]
fn what_is_deepest_can_be_formatted_cloned_and_compared() {
    for (name, nest) in NESTS {
        let source = nest(MAX_NESTING);
        let file = parse(&source).expect(name);
        assert_eq!(file.clone(), file, "{name}");
        assert!(format(&source).is_ok(), "{name}");
    }
}

#[test]
fn mixed_nesting_within_the_limit_parses() {
    let source = value(
        "f(|a| [-if a { fold (a = 1) for i in 1..2 { a = x.g(y: v[(",
        ")]) } } else { 1 }])",
        MAX_NESTING / 9,
    );
    assert!(parse(&source).is_ok());
    assert!(format(&source).is_ok());
}

#[test]
fn nesting_far_beyond_the_limit_is_an_error() {
    let parts = [
        "(",
        "[",
        "{",
        "f(",
        "a[",
        "-",
        "!",
        "-!",
        "/*",
        "if ",
        "if a {",
        "else if a { 1 } ",
        "if a { 1 } else ",
        "fold (a = ",
        "fold (a = 1) for i in ",
        "fold (a = 1) for i in 0..1 {",
        "f(|a| ",
        "f(|| ",
        "node(x: ",
        "-(",
        "[-",
        "(]",
        "([}",
        "/*/",
        "if {",
        "fold {",
        "else {",
        ")",
        "}",
        "f<",
        "|",
        "x: ",
        "let a = ",
        "\"\\",
        "#",
    ];
    let heads = ["let a = ", "node a(x: ", "texture a(uv: vec2) -> (b: color) { b = if a { 1 } "];
    for part in parts {
        for head in heads {
            let count = 100_000.min((MAX_BYTES - 100) / part.len());
            let source = format!("{head}{}", part.repeat(count));
            let errors = parse(&source).expect_err(part);
            assert!(errors.iter().all(|error| source.get(error.span.range()).is_some()), "{part}");
        }
    }
}

#[test]
fn size_is_bounded() {
    let comment = |bytes: usize| format!("//{}", "x".repeat(bytes - 2));
    assert!(parse(&comment(MAX_BYTES)).is_ok());
    let errors = parse(&comment(MAX_BYTES + 1)).unwrap_err();
    assert_eq!(errors[0].code(), "E0001");
    assert_eq!(errors[0].span.range(), MAX_BYTES..MAX_BYTES + 1);
    // The limit falls inside a character.
    let wide = format!("{}é", comment(MAX_BYTES - 1));
    let errors = parse(&wide).unwrap_err();
    assert!(wide.get(errors[0].span.range()).is_some());
}

#[test]
fn long_files_parse() {
    let long = [
        format!("let a = 1{}", " + 1".repeat(100_000)),
        format!("let a = 1{}", " + 1 * 2 < 3 && -x || y".repeat(20_000)),
        format!("let a = b{}", ".abs()".repeat(100_000)),
        format!("let a = b{}", "[0]".repeat(100_000)),
        format!("let a = f({})", "x: 1, ".repeat(100_000)),
        format!("let a = [{}]", "1,".repeat(100_000)),
        "let a = 1\n".repeat(50_000),
        format!("texture a(uv: vec2) -> (b: color) {{{}}}", " let a = 1".repeat(50_000)),
        "/// a\n// b\n/* c */\n".repeat(30_000),
        format!("let a = /*{}*/ 1", "/**/".repeat(100_000)),
        format!("let a = f({})", "x /* a */ . y, ".repeat(40_000)),
    ];
    for source in long {
        let head = &source[..40];
        assert!(parse(&source).is_ok(), "{head}");
    }
}

#[test]
fn many_errors_are_found_in_one_go() {
    let source = "let a = 3y\n".repeat(20_000);
    assert_eq!(parse(&source).unwrap_err().len(), 20_000);
}
