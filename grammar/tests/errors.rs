//! Errors: one small text per code, and that no text is too broken.

use texgraph_grammar::{SYNTAX_CODES, SyntaxError, parse, parse_signature};

mod support;

fn errors(source: &str) -> Vec<SyntaxError> {
    parse(source).err().unwrap_or_else(|| panic!("is right: {source}"))
}

/// The code, the underlined text, and the whole error in words.
fn only(source: &str) -> (&'static str, &str, String) {
    let errors = errors(source);
    assert_eq!(errors.len(), 1, "{source}: {errors:?}");
    let error = &errors[0];
    let help = error.help().unwrap_or_default();
    let words = format!("{} | {} | {help}", error.message(), error.label());
    (error.code(), &source[error.span.range()], words)
}

fn body(statement: &str) -> String {
    format!("texture t(uv: vec2) -> (color: color) {{\n    {statement}\n}}\n")
}

/// Source, code, underlined text, and a part of the words.
const CASES: &[(&str, &str, &str, &str)] = &[
    ("let a = 1 /* b /* c */", "E0003", "/*", "never closed"),
    ("use \"a.tex", "E0004", "\"a.tex", "not closed"),
    ("let a = 1 @ 2", "E0005", "@", "no meaning"),
    ("let a = b & c", "E0005", "&", "`&&`"),
    ("let a = c ? 1 : 2", "E0005", "?", "if c { a } else { b }"),
    ("let a = 'b'", "E0005", "'", "double quotes"),
    ("let größe = 1", "E0006", "ö", "A to Z"),
    ("let a = 3 × 4", "E0006", "×", "outside comments"),
    ("let a = f(\"x\\qy\")", "E0007", "\\q", "\\u{"),
    ("let a = f(\"x\\u{110000}\")", "E0007", "\\u{110000}", "no escape"),
    ("let a = 3y", "E0008", "3y", "90deg"),
    ("let a = 0x1F", "E0008", "0x1F", "no number"),
    ("let a = 1. + 2", "E0008", "1.", "write `1.0`"),
    ("let a = .5", "E0008", ".5", "write `0.5`"),
    ("let a = 1e999", "E0009", "1e999", "too large"),
    ("let a = f<99999999999>(1)", "E0009", "99999999999", "too large"),
    ("let a = #12345", "E0010", "#12345", "#rrggbb"),
    ("let a = #ggg", "E0010", "#ggg", "no colour"),
    ("let a 3", "E0011", "3", "expected `=`, found `3`"),
    ("let a: float = 3", "E0011", ":", "type is inferred"),
    ("let a => 3", "E0011", "=>", "with `=`"),
    ("let a = f(b c)", "E0011", "c", "expected `,` or `)`"),
    ("let a = f(b = 1)", "E0011", "=", "`f(octaves: 6)`"),
    ("let a = f(1, , 2)", "E0011", ",", "expected an expression"),
    ("let a = if b { let c = 1 } else { 2 }", "E0011", "let", "one expression"),
    ("node n(a: int) { }", "E0011", "{", "-> (value: float)"),
    ("node n(a: int) -> int { }", "E0011", "int", "-> (value: float)"),
    ("node n(a) -> (b: int) { }", "E0011", ")", "expected `:`"),
    ("param p = 1.0", "E0011", "=", "expected `:`"),
    ("fn f(x) { x }", "E0011", "fn", "`node`"),
    ("import \"a.tex\"", "E0011", "import", "use \"path.tex\""),
    ("let a =\nlet b = 1", "E0011", "let", "expected an expression, found `let`"),
    ("let a = (1 : 2)", "E0011", ":", "found `:`"),
    ("let a =", "E0012", "=", "expected an expression"),
    ("param p: int", "E0012", "int", "the text ends"),
    ("let a = f(1, 2", "E0013", "(", "never closed"),
    ("let a = [f(1, 2]", "E0013", "(", "its `)` is missing"),
    ("let a = f(1))", "E0014", ")", "closes nothing"),
    ("let fold = 1", "E0015", "fold", "try `fold_`"),
    ("let a = f(in)", "E0015", "in", "a keyword"),
    ("let a = if b { c }", "E0016", "if", "needs an `else`"),
    ("let a = if b { if c { 1 } else { 2 } }\nlet d = 1", "E0016", "if", "else"),
    ("let a = 1 < b < 3", "E0017", "<", "a < b && b < c"),
    ("let a = |b| b + 1", "E0018", "|", "argument of a call"),
    ("let a = f (1)", "E0019", "f (", "write `f(`"),
    ("let a = v [1]", "E0019", "v [", "write `v[`"),
    ("let a = f(b: 1, 2)", "E0021", "2", "argument `b`"),
    ("let a = 1;", "E0022", ";", "no `;`"),
];

#[test]
fn every_mistake_has_its_error() {
    let mut wrong = Vec::new();
    for (source, code, place, words) in CASES {
        let found = only(source);
        if (found.0, found.1) != (*code, *place) || !found.2.contains(words) {
            wrong.push(format!("{source}: {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn statements_that_are_none() {
    let cases = [
        ("return uv", "E0020", "return", "assign to an output"),
        ("f(uv)", "E0020", "f", "assigns nothing"),
        ("uv.x", "E0020", "uv", "let name = …"),
        ("3 + 4", "E0011", "3", "expected an assignment"),
        ("for i in 0..3 { }", "E0011", "for", "only loop is `fold"),
        ("color = 1;", "E0022", ";", "remove"),
        ("color: 1", "E0011", ":", "with `=`"),
        ("color += 1", "E0011", "+=", "once"),
        ("in = 1", "E0015", "in", "keyword"),
        ("color = (1", "E0013", "(", "never closed"),
    ];
    for (statement, code, place, words) in cases {
        let source = body(statement);
        let found = only(&source);
        assert_eq!((found.0, found.1), (code, place), "{source}: {}", found.2);
        assert!(found.2.contains(words), "{source}: {}", found.2);
    }
}

#[test]
fn every_code_has_a_case() {
    let elsewhere = ["E0001", "E0002", "E0020", "E0049"];
    let tested = |code: &str| CASES.iter().any(|case| case.1 == code) || elsewhere.contains(&code);
    for (code, title) in SYNTAX_CODES {
        assert!(tested(code), "{code}: {title}");
    }
    assert!(SYNTAX_CODES.is_sorted_by(|a, b| a.0 < b.0));
    assert!(CASES.iter().all(|case| SYNTAX_CODES.iter().any(|code| code.0 == case.1)));
}

#[test]
fn all_errors_of_a_file_at_once() {
    let source = "let a = 3y
param b: float = 1.0
node c(x: int) -> (v: int) {
    v = (x
}
let d = f(1 2)
texture e(uv: vec2) -> (color: color) {
    let a = 1
let b = 2
    color = #12345
    height = \"\\q\"
}

let f = 1 < 2 < 3
/// A right one.
let g = \"open
node h(";
    let found: Vec<_> =
        errors(source).iter().map(|error| (error.code(), &source[error.span.range()])).collect();
    let expected = [
        ("E0008", "3y"),
        ("E0013", "("),
        ("E0011", "2"),
        ("E0010", "#12345"),
        ("E0017", "<"),
        ("E0004", "\"open"),
        ("E0013", "("),
    ];
    assert_eq!(found, expected);
}

#[test]
fn a_forgotten_bracket_spoils_one_item_only() {
    let source = "node a() -> (v: int) {\n    v = f(1\n\nnode b() -> (v: int) {\n    v = 1\n}\nlet c = 3y\n";
    let codes: Vec<_> = errors(source).iter().map(SyntaxError::code).collect();
    assert_eq!(codes, ["E0013", "E0008"]);
}

#[test]
fn errors_of_signatures() {
    assert!(parse_signature("(a: float) -> float").is_ok());
    assert_eq!(parse_signature("(a: float) -> ").unwrap_err().code(), "E0012");
    assert_eq!(parse_signature("(a float) -> float").unwrap_err().code(), "E0011");
    assert_eq!(parse_signature("").unwrap_err().code(), "E0012");
    assert_eq!(parse_signature("(a: float = 1 < 2 < 3) -> float").unwrap_err().code(), "E0017");
}

/// Reads a text that may be broken in any way.
fn survive(source: &str) {
    let Err(errors) = parse(source) else { return };
    assert!(!errors.is_empty(), "{source}");
    assert!(errors.is_sorted_by_key(|error| error.span.start), "{source}: {errors:?}");
    for error in errors {
        let text = source.get(error.span.range());
        assert!(text.is_some_and(|text| !text.is_empty()), "{source}: {error:?}");
        assert_ne!(error.code(), "E0049", "{source}");
        let words = [error.message(), error.label(), error.help().unwrap_or_default()];
        assert!(words.iter().all(|words| !words.contains('\n')), "{words:?}");
    }
}

#[test]
fn mutants_survive() {
    let alphabet = b" \n\"#/*(){}[]<>|.,:=-!+aif019_;\\\xc3";
    let mut random = support::Random(1);
    for (_, source) in support::examples() {
        for _ in 0..400 {
            let mut bytes = source.clone().into_bytes();
            let at = random.below(bytes.len());
            let byte = alphabet[random.below(alphabet.len())];
            match random.below(3) {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ => drop(bytes.remove(at)),
            }
            survive(&String::from_utf8_lossy(&bytes));
        }
    }
}

#[test]
fn cut_texts_survive() {
    for (_, source) in support::examples() {
        for at in (0..source.len()).step_by(3).filter(|at| source.is_char_boundary(*at)) {
            survive(&source[..at]);
            survive(&source[at..]);
        }
    }
}
