//! Any text, and any well-typed program: what checks compiles to shaders that naga takes, or passes a
//! bound.
#![no_main]

#[path = "../../tests/generated/mod.rs"]
mod generated;
mod input;

use generated::judge::{Depth, compiles};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Some((program, right)) = input::read(bytes) else { return };
    if let Err(why) = compiles(&input::LIBRARY, &program.main, &program.files, right, Depth::Whole) {
        panic!("{why}\n{}", program.text());
    }
});
