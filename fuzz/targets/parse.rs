//! Any text: it parses, or has errors that stand in it.
#![no_main]

use texgraph_grammar::parse;

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Err(errors) = parse(text) {
        assert!(!errors.is_empty(), "refused without a word");
        for error in errors {
            let range = error.span.range();
            assert!(text.get(range.clone()).is_some(), "an error at {range:?}, outside the text");
        }
    }
});
