//! The bounds on folds, at N and at N + 1: steps, constant evaluation, entries of a table.

use std::collections::HashMap;
use texgraph_compiler::{Library, check};

/// The errors of a texture `t` with one output.
fn errors(lets: &str, height: &str) -> Vec<String> {
    let text = format!("{lets}\ntexture t(uv: vec2) -> (height: float) {{ height = {height} }}");
    let library = Library::standard().expect("the library parses");
    let files: HashMap<String, String> = [("t.tex".to_owned(), text)].into();
    match check(&library, "t.tex", &files) {
        Ok(_) => Vec::new(),
        Err(failure) => failure.diagnostics.iter().map(|d| format!("{} {}", d.code, d.message)).collect(),
    }
}

fn too_many(steps: u32) -> String {
    format!("E0404 the folds of `t` may take {steps} steps")
}

#[test]
fn a_fold_takes_65536_steps() {
    let fold = |steps: u32| errors("", &format!("fold (a = uv.x) for i in 0..{steps} {{ a = a * a + i }}"));
    assert!(fold(65_536).is_empty());
    assert_eq!(fold(65_537), [too_many(65537)]);
    let cut = |most: u32| {
        let fold = format!("fold (a = uv.x) for i in 0..k max {most} {{ a = a * a + i }}");
        errors("param k: int = 3", &fold)
    };
    assert!(cut(65_536).is_empty());
    assert_eq!(cut(65_537), [too_many(65537)]);
}

#[test]
fn a_box_has_65536_places() {
    let fold = |width: u32| {
        let range = format!("ivec2(0)..ivec2({width}, 256)");
        errors("", &format!("fold (a = uv.x) for o in {range} {{ a = a * a + o.x }}"))
    };
    assert!(fold(256).is_empty());
    assert_eq!(fold(257), [too_many(65792)]);
}

#[test]
fn folds_inside_each_other_multiply() {
    let nested = |outer: u32| {
        let inner = "fold (b = a) for j in 0..256 { b = b * b + j }";
        errors("", &format!("fold (a = uv.x) for i in 0..{outer} {{ a = {inner} + i }}"))
    };
    assert!(nested(256).is_empty());
    assert_eq!(nested(257), [too_many(65792)]);
}

#[test]
fn folds_inside_a_node_multiply() {
    let node = "node f(x: float) -> (y: float) { y = fold (b = x) for j in 0..256 { b = b * b + j } }";
    let called =
        |outer: u32| errors(node, &format!("fold (a = uv.x) for i in 0..{outer} {{ a = f(a) + i }}"));
    assert!(called(256).is_empty());
    assert_eq!(called(257), [too_many(65792)]);
}

#[test]
fn folds_behind_each_other_do_not_multiply() {
    let fold = "fold (a = uv.x) for i in 0..65536 { a = a * a + i }";
    assert!(errors("", &format!("{fold} + {fold}")).is_empty());
}

/// Folds of constants. A step is one operation, and so is its sum: 2 · (7 · 65,536 + 41,248) is a
/// million for a last one of 41,248.
fn constants(last: u32) -> String {
    let fold =
        |k: usize, steps: u32| format!("let c{k} = fold (a = {k}) for i in 0..{steps} {{ a = a + i }}\n");
    (0..7).map(|k| fold(k, 65_536)).chain([fold(7, last)]).collect()
}

#[test]
fn constants_take_a_million_operations() {
    assert!(errors(&constants(41_248), "uv.x").is_empty());
    let too_long = "E0403 the constants of `t.tex` take more than 1000000 operations to compute";
    assert_eq!(errors(&constants(41_249), "uv.x"), [too_long]);
}

#[test]
fn constants_of_a_node_count_too() {
    let node = |last: u32| {
        let node = format!("node f(x: float) -> (y: float) {{ {} y = x }}", constants(last));
        errors(&node, "f(uv.x)")
    };
    assert!(node(41_248).is_empty());
    assert_eq!(node(41_249), ["E0403 the constants of `f` take more than 1000000 operations to compute"]);
}

#[test]
fn a_table_has_2047_entries() {
    let table = |length: usize| {
        let entries: Vec<String> = (0..length).map(|i| format!("{i}.5")).collect();
        errors(&format!("let table = [{}]", entries.join(", ")), "table[ifloor(uv.x)]")
    };
    assert!(table(2_047).is_empty());
    assert_eq!(table(2_048), ["E0406 a table has at most 2047 entries, not 2048"]);
}
