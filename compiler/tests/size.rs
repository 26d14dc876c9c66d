//! Long and deep programs: they compile, or give one coded error; on a test thread's small stack.

use std::collections::HashMap;
use texgraph_compiler::{Compiled, Failure, Library, Options, compile};

fn compiled(text: String) -> Result<Compiled, Failure> {
    let library = Library::standard().expect("the library parses");
    let files: HashMap<String, String> = [("t.tex".to_owned(), text)].into();
    compile(&library, "t.tex", &files, &Options::default())
}

fn codes(result: Result<Compiled, Failure>) -> Vec<&'static str> {
    result.map_or_else(|failure| failure.diagnostics.iter().map(|d| d.code).collect(), |_| Vec::new())
}

fn height(expression: &str) -> String {
    format!("texture t(uv: vec2) -> (height: float) {{ height = {expression} }}")
}

/// A short name for a number.
fn name(mut n: usize) -> String {
    let mut name = String::from("w");
    while n > 0 {
        name.push(char::from(b'a' + (n % 26) as u8));
        n /= 26;
    }
    name
}

/// A chain of nodes that call each other.
fn nodes(count: usize, body: impl Fn(usize) -> String) -> String {
    let chain: String =
        (0..count).map(|i| format!("node f{i}(x: float) -> (y: float) {{ {} }}\n", body(i))).collect();
    format!("{chain}node f{count}(x: float) -> (y: float) {{ y = x }}\n{}", height("f0(uv.x)"))
}

#[test]
fn a_hundred_thousand_operators() {
    assert!(codes(compiled(height(&format!("uv.x{}", " + 1".repeat(100_000))))).is_empty());
}

#[test]
fn a_hundred_thousand_methods() {
    assert!(codes(compiled(height(&format!("uv.x{}", ".abs()".repeat(100_000))))).is_empty());
}

#[test]
fn fifty_thousand_lets_in_reverse() {
    let lets: String = (1..=50_000).rev().map(|i| format!("let {}={}+1\n", name(i), name(i - 1))).collect();
    let text =
        format!("texture t(uv: vec2) -> (height: float) {{height={}\n{lets}let w=uv.x}}", name(50_000));
    let program = compiled(text).expect("compiles").program;
    let entry = program.texture().graph.function(program.texture().graph.entry());
    assert!(entry.values.len() > 50_000, "one addition for each `let`");
}

#[test]
fn forty_thousand_lets_of_a_file_in_reverse() {
    let lets: String = (1..=40_000).rev().map(|i| format!("let {}={}+1\n", name(i), name(i - 1))).collect();
    let program = compiled(format!("{lets}let w=2\n{}", height(&name(40_000)))).expect("compiles").program;
    assert!(program.texture().wgsl.contains("40002f"), "the constant is folded");
}

#[test]
fn four_thousand_nodes_each_calling_the_next() {
    let plain = |i: usize| format!("y = f{}(x) + 1.0", i + 1);
    let program = compiled(nodes(4_000, plain)).expect("compiles").program;
    assert_eq!(program.texture().graph.functions.len(), 1, "single expressions are taken over");
    let named = |i: usize| format!("let z = f{}(x) * x  y = z + 1.0", i + 1);
    assert_eq!(
        compiled(nodes(4_000, named)).expect("compiles").program.texture().graph.functions.len(),
        4_001
    );
}

#[test]
fn ten_thousand_nodes_are_one_error() {
    assert_eq!(codes(compiled(nodes(10_000, |i| format!("y = f{}(x) + 1.0", i + 1)))), ["E0401"]);
}

#[test]
fn specialised_nodes_are_bounded_at_4096() {
    let calls = |count: usize| {
        let calls: Vec<String> = (0..count).map(|i| format!("f(uv.x, {i})")).collect();
        format!("node f(x: float, k: int) -> (y: float) {{ y = x * k }}\n{}", height(&calls.join(" + ")))
    };
    assert!(codes(compiled(calls(4_096))).is_empty());
    assert_eq!(codes(compiled(calls(4_097))), ["E0401"]);
}

#[test]
fn values_are_bounded_at_200000() {
    let parts: Vec<String> = (0..29_000).map(|i| format!("a*{i}.5-b/{i}.25")).collect();
    let text = |n: usize| {
        let sum = parts[..n].join("+");
        format!("texture t(uv: vec2) -> (height: float) {{ let a = uv.x let b = uv.y height = {sum} }}")
    };
    assert!(codes(compiled(text(1_000))).is_empty());
    let many = "y = uv.x".to_owned() + &(0..100_100).map(|i| format!("*{i}")).collect::<String>();
    assert!(many.len() < 1 << 20);
    let text = format!("texture t(uv: vec2) -> (height: float) {{ let {many} height = y }}");
    assert_eq!(codes(compiled(text)), ["E0402"]);
    // The bound is the texture's, not a function's.
    let long = (0..30_000).map(|i| format!("*{i}")).collect::<String>();
    let node = |i: usize| format!("node f{i}(x: float) -> (y: float) {{ y = x{long}+{i} }}\n");
    let text = (0..4).map(node).collect::<String>() + &height("f0(uv.x) + f1(uv.x) + f2(uv.x) + f3(uv.x)");
    assert!(text.len() < 1 << 20, "{}", text.len());
    assert_eq!(codes(compiled(text)), ["E0402"]);
}

#[test]
fn a_node_that_calls_itself_is_one_error() {
    let ring = "node a(x: float) -> (y: float) { y = b(x) }\nnode b(x: float) -> (y: float) { y = a(x) }\n";
    assert_eq!(codes(compiled(format!("{ring}{}", height("a(uv.x)")))), ["E0109"]);
}

#[test]
fn nesting_is_bounded_and_never_overflows() {
    for (open, close) in
        [("(", ")"), ("abs(", ")"), ("if uv.x<0.5{1}else{", "}"), ("-", ""), ("vec2(", ").x")]
    {
        for depth in [60, 100, 127, 128, 129, 1_000, 50_000] {
            let text = height(&format!("{}uv.x{}", open.repeat(depth), close.repeat(depth)));
            let codes = codes(compiled(text));
            assert!(
                codes.len() <= 1 && codes.iter().all(|code| ["E0001", "E0002"].contains(code)),
                "{open} {depth}: {codes:?}"
            );
        }
    }
}
