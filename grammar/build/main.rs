//! Makes the reader of right texts: a recogniser for `tex.pest`, as Rust.
//!
//! pest reads the grammar and could read texts with it too, but spends thousands of instructions on
//! every token to be able to say what it expected there. A right text needs no such answer. The
//! reader made here matches the same grammar by the same rules and looks one byte ahead before it
//! tries anything; a text that it refuses is handed to pest for the reason.

mod bytes;
mod emit;
mod first;

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

/// The rules that a text can be read as.
const ENTRIES: [&str; 2] = ["file", "signature"];

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=tex.pest");
    println!("cargo::rerun-if-changed=build");
    let grammar = fs::read_to_string("tex.pest")?;
    let rules = pest_meta::parse_and_optimize(&grammar);
    let (_, rules) = rules.map_err(|errors| errors.iter().map(|e| format!("{e}\n")).collect::<String>())?;
    let folder = PathBuf::from(env::var("OUT_DIR")?);
    fs::write(folder.join("reader.rs"), emit::reader(rules, &ENTRIES)?)?;
    Ok(())
}
