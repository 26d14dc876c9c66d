//! The mixed graph on its own, for scripts and profilers.
//!
//! ```text
//! cargo run --release -p texgraph-compiler --example mixed -- write FOLDER
//! cargo run --release -p texgraph-compiler --example mixed -- compile NODES TIMES
//! ```
//!
//! `write` makes `mixed10.tex`, `mixed10.wgsl`, `mixed10.mtlx` and so on for 100, 1,000 and 10,000
//! nodes. `compile` compiles one so often and says how long the quickest took and how much memory the
//! process has used at most.

#![allow(clippy::disallowed_methods, reason = "a program of its own, which writes files")]

#[path = "../benches/mixed/mod.rs"]
mod mixed;

use mixed::Mixed;
use std::collections::HashMap;
use std::path::Path;
use std::time::{Duration, Instant};
use texgraph_compiler::{Library, Options, compile};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments.as_slice() {
        ["write", folder] => Ok(write(Path::new(folder))?),
        ["compile", nodes, times] => compile_often(nodes.parse()?, times.parse()?),
        _ => Err("write FOLDER, or compile NODES TIMES".into()),
    }
}

fn write(folder: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    for nodes in [10, 100, 1_000, 10_000] {
        let graph = Mixed::new(nodes);
        let file = |extension: &str| folder.join(format!("mixed{nodes}.{extension}"));
        std::fs::write(file("tex"), mixed::tex(&graph))?;
        std::fs::write(file("wgsl"), mixed::wgsl(&graph))?;
        std::fs::write(file("mtlx"), mixed::materialx(&graph))?;
    }
    Ok(())
}

fn compile_often(nodes: usize, times: usize) -> Result<(), Box<dyn std::error::Error>> {
    let library = Library::standard()?;
    let text = mixed::tex(&Mixed::new(nodes));
    let files: HashMap<String, String> = [("mixed.tex".to_owned(), text)].into();
    let mut quickest = Duration::MAX;
    let mut bytes = 0;
    for _ in 0..times {
        let start = Instant::now();
        let compiled = compile(&library, "mixed.tex", &files, &Options::default());
        quickest = quickest.min(start.elapsed());
        bytes =
            compiled.map_err(|failure| format!("{:?}", failure.diagnostics))?.program.texture().wgsl.len();
    }
    println!(
        "{nodes} nodes: {:.3} ms, {bytes} bytes of WGSL, {}",
        quickest.as_secs_f64() * 1e3,
        peak_memory()
    );
    Ok(())
}

/// The most memory that the process has used (Linux).
fn peak_memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.map_or_else(String::new, |peak| format!("peak memory {}", peak.trim()))
}

/// The allocator of the command.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;
