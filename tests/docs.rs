//! What the README and the guide show compiles.

use std::collections::HashMap;
use std::path::Path;
use texgraph_compiler::{Library, check, diagnostic::render};

/// The fenced blocks of a Markdown text with that info string.
fn blocks<'a>(text: &'a str, info: &str) -> Vec<&'a str> {
    let open = format!("```{info}\n");
    text.split(open.as_str()).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

#[test]
fn examples_in_the_readme_and_the_guide_are_right() {
    let library = Library::standard().expect("the library parses");
    let mut checked = 0;
    for file in ["README.md", "docs/guide.md"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        let text = std::fs::read_to_string(&path).expect("the file is there");
        for block in blocks(&text, "tex").into_iter().filter(|block| block.contains("texture ")) {
            let files: HashMap<String, String> = [("t.tex".to_owned(), block.to_owned())].into();
            if let Err(failure) = check(&library, "t.tex", &files) {
                panic!("{file}:\n{}", render::human(&failure.sources, &failure.diagnostics));
            }
            let formatted = texgraph_grammar::format(block).expect("it parses");
            assert_eq!(formatted, block, "{file} shows the canonical layout");
            checked += 1;
        }
    }
    assert!(checked >= 2, "{checked} examples found");
}
