//! Filtering against a supersampled reference: graphs, from 16 times magnified to 64 cells a pixel,
//! from above and in perspective, ours beside a shader written by hand and one without gradients.
//!
//! ```text
//! graph × view × zoom ─▶ reference (finest level, 256 or 4,096 samples a pixel) ─┐
//!                    ├─▶ ours, by hand, naive ───────────────────────────────────┴─▶ row ─▶ table, sheet
//! ```
//!
//! `cargo bench -p texgraph-runtime --bench quality` prints the table and what it must show; `-- --write`
//! writes docs/images/quality.png and the table in docs/quality.md too; `-- tiles nested` draws these graphs alone.

mod borders;
mod case;
mod docs;
mod measure;
mod reference;
mod rivals;
mod row;
mod sheet;
mod table;
mod targets;

use case::{Case, GRAPHS, View, ZOOMS};
use row::Row;
use std::path::Path;
use texgraph_runtime::gpu::{Gpu, Preference};

/// What fails, fails the bench.
type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> Outcome<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let asked = |graph: &&str| arguments.iter().any(|a| a == graph);
    let graphs: Vec<&'static str> = match GRAPHS.into_iter().filter(asked).collect::<Vec<_>>() {
        none if none.is_empty() => GRAPHS.to_vec(),
        some => some,
    };
    let gpu = Gpu::new(Preference::Hardware);
    match &gpu {
        Ok(gpu) => println!("GPU: {}\n", gpu.name()),
        Err(error) => println!("no GPU, so only the CPU renderer: {error}\n"),
    }
    let rows = draw(&graphs, gpu.as_ref().ok())?;
    println!("\n{}", targets::list(&rows));
    if arguments.iter().any(|argument| argument == "--write") {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
        sheet::write(&rows, &graphs, &folder.join("images/quality.png"))?;
        docs::write(&rows, &folder.join("quality.md"))?;
    }
    Ok(())
}

/// All rows, each printed when it is there.
fn draw(graphs: &[&'static str], gpu: Option<&Gpu>) -> Outcome<Vec<Row>> {
    let mut rows = Vec::new();
    print!("{}", table::table(&[]));
    for graph in graphs {
        for (view, pixels) in View::ALL.into_iter().flat_map(|view| ZOOMS.map(|pixels| (view, pixels))) {
            let row = row::row(graph, Case { view, pixels }, gpu)?;
            print!("{}", table::line(&row));
            rows.push(row);
        }
    }
    Ok(rows)
}
