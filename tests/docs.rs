//! What the README, the guide and the language reference show compiles.

use std::collections::HashMap;
use std::path::Path;
use texgraph_compiler::{Library, check, diagnostic::render};

/// The fenced blocks of a Markdown text with that info string.
fn blocks<'a>(text: &'a str, info: &str) -> Vec<&'a str> {
    let open = format!("```{info}\n");
    text.split(open.as_str()).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

#[test]
fn every_example_is_right_and_formatted() {
    let library = Library::standard().expect("the library parses");
    let mut checked = 0;
    for file in ["README.md", "docs/guide.md", "docs/language.md"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        let text = std::fs::read_to_string(&path).expect("the file is there");
        for block in blocks(&text, "tex").into_iter() {
            let files: HashMap<String, String> = [("t.tex".to_owned(), block.to_owned())].into();
            if let Err(failure) = check(&library, "t.tex", &files) {
                panic!("{file}:\n{}", render::human(&failure.sources, &failure.diagnostics));
            }
            let formatted = texgraph_grammar::format(block).expect("it parses");
            assert_eq!(formatted, block, "{file} shows the canonical layout");
            checked += 1;
        }
    }
    assert!(checked >= 5, "{checked} examples found");
}
