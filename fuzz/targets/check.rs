//! Any text, and any well-typed program: it checks, or has errors with a page that can be shown. A
//! well-typed one checks.
#![no_main]

#[path = "../../tests/generated/mod.rs"]
mod generated;
mod input;

use texgraph_compiler::{check, diagnostic::render};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Some((program, right)) = input::read(bytes) else { return };
    if let Err(failure) = check(&input::LIBRARY, &program.main, &program.files) {
        assert!(!failure.diagnostics.is_empty(), "refused without a word");
        let page = render::human(&failure.sources, &failure.diagnostics);
        assert!(!right, "{page}\n{}", program.text());
    }
});
