//! Long and deep programs: they compile, or give one coded error; on a test thread's small stack.

use std::collections::HashMap;
use texgraph_compiler::{Compiled, Failure, Library, Options, check, compile};

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
    let one_more = "E0401 a texture may use 4096 nodes, each with its own constants; `f` is one too many";
    assert_eq!(errors(calls(4_097)), [one_more]);
}

/// The errors of a program. Checked only: compiling takes longer and has no bound of its own.
fn errors(text: String) -> Vec<String> {
    let library = Library::standard().expect("the library parses");
    let files: HashMap<String, String> = [("t.tex".to_owned(), text)].into();
    match check(&library, "t.tex", &files) {
        Ok(_) => Vec::new(),
        Err(failure) => failure.diagnostics.iter().map(|d| format!("{} {}", d.code, d.message)).collect(),
    }
}

#[test]
fn values_are_bounded_at_200000() {
    // One for each sum; one each for `uv`, `uv.x`, 1 and 1.0.
    let sums = |count: usize| errors(height(&format!("uv.x{}", "+1".repeat(count - 4))));
    assert!(sums(200_000).is_empty());
    assert_eq!(sums(200_001), ["E0402 a texture may hold 200000 operations; in `t` it passes that"]);
}

#[test]
fn values_are_bounded_in_all_nodes_together() {
    // Seven in the texture: `uv`, `uv.x`, the call of each node with its output, and their sum. In a
    // node one for each sum, and its input, 1 and 1.0.
    let nodes = |first: usize, second: usize| {
        let node = |name: &str, count: usize| {
            format!("node {name}(x: float) -> (y: float) {{ let z = x{} y = z }}\n", "+1".repeat(count - 3))
        };
        errors(format!("{}{}{}", node("f", first), node("g", second), height("f(uv.x) + g(uv.x)")))
    };
    assert!(nodes(100_000, 99_993).is_empty());
    assert_eq!(nodes(100_000, 99_994), ["E0402 a texture may hold 200000 operations; in `t` it passes that"]);
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
