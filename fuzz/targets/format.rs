//! Any text that parses: formatted it has the same tree, and formatting that changes nothing.
#![no_main]

#[path = "../../tests/generated/mod.rs"]
mod generated;

use generated::judge::{Depth, formats};

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Err(why) = formats(text, Depth::Whole) {
        panic!("{why}");
    }
});
