//! `graph`: pictures and text for Graphviz, and what can't be drawn.

use crate::workshop::{PLAIN, WRONG, Workshop, examples};

#[test]
fn the_example_is_drawn() {
    let shop = Workshop::new(&[]);
    let file = examples().join("tiling.tex");
    let run = shop.run(&["graph".as_ref(), file.as_os_str(), "-o".as_ref(), "tiling.svg".as_ref()]);
    assert!(run.is_silent(), "{run:#?}");
    let svg = shop.text("tiling.svg");
    assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\"") && svg.ends_with("</svg>\n"));
    for text in
        ["texture tiling", "tile_map", "virtual_index", "reference", "pick", "cells: int", "color: color"]
    {
        assert!(svg.contains(&format!(">{text}</text>")), "no `{text}`");
    }
    assert!(shop.run(&["graph".as_ref(), file.as_os_str(), "-o".as_ref(), "again.SVG".as_ref()]).is_silent());
    assert_eq!(shop.text("again.SVG"), svg);
    // The guide shows it.
    let shown = examples().join("../docs/images/tiling_graph.svg");
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        std::fs::write(&shown, &svg).expect("the picture is written");
    }
    assert_eq!(std::fs::read_to_string(&shown).expect("the picture is read"), svg);
}

#[test]
fn text_for_graphviz_goes_to_standard_output() {
    let shop = Workshop::new(&[("a.tex", PLAIN)]);
    let run = shop.run(&["graph", "a.tex"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{run:#?}");
    insta::assert_snapshot!("graph_plain_dot", run.out);
    assert!(shop.run(&["graph", "a.tex:plain", "-o", "a.dot"]).is_silent());
    assert_eq!(shop.text("a.dot"), run.out);
    assert_eq!(shop.names(), ["a.dot", "a.tex"]);
}

#[test]
fn only_the_syntax_has_to_be_right() {
    let shop = Workshop::new(&[("wrong.tex", WRONG), ("broken.tex", "texture t(uv: vec2 {")]);
    let run = shop.run(&["graph", "wrong.tex"]);
    assert_eq!(run.code, 0, "{run:#?}");
    assert!(run.out.contains("vec4(uv, missing, 1.0)"), "{run:#?}");
    shop.run(&["graph", "broken.tex"]).fails(1, "broken.tex:1:");
    shop.run(&["graph", "wrong.tex:rong"]).fails(1, "did you mean `wrong`?");
    shop.run(&["graph", "gone.tex"]).fails(1, "gone.tex");
}

#[test]
fn what_is_too_large_for_a_picture() {
    let lets: String = (1..10_000).map(|i| format!("    let w{i} = hue(w{}.x)\n", i - 1)).collect();
    let large = format!(
        "texture large(uv: vec2) -> (color: color) {{\n    let w0 = hue(uv.x)\n{lets}    color  = w9999\n}}\n"
    );
    let shop = Workshop::new(&[("large.tex", &large)]);
    let run = shop.run(&["graph", "large.tex", "-o", "large.svg"]);
    run.fails(1, "it has 10002 blocks, and a picture shows 400 at most");
    run.fails(1, "write a `.dot`");
    assert!(shop.run(&["graph", "large.tex", "-o", "large.dot"]).is_silent());
    assert_eq!(shop.names(), ["large.dot", "large.tex"]);
}

#[test]
fn wrong_usage() {
    let shop = Workshop::new(&[("a.tex", PLAIN)]);
    shop.run(&["graph", "a.tex", "-o", "a.png"]).fails(2, "`a.png` must end in `.svg`");
    shop.run(&["graph", "a.tex", "-o", "a"]).fails(2, "must end in `.svg`");
    shop.run(&["graph", "a.tex", "-o", "no/a.svg"]).fails(3, "there is no folder `no`");
    assert_eq!(shop.names(), ["a.tex"]);
}
