//! What the four textures of §6's table (Lefebvre & Neyret 2003) take, counted on the worst path.
//! The files are in benches/paper; docs/performance.md has the same figures beside the paper's.

use std::path::Path;
use texgraph_compiler::cost::{Counts, cost};
use texgraph_compiler::{Library, Options, compile, diagnostic::render};
use texgraph_runtime::project::Project;

/// Each with the most reads: hashed, and with numbers from σ.
const BOUNDS: &[(&str, f64, f64)] =
    &[("basic", 1.0, 5.0), ("areas", 3.0, 7.0), ("dithered", 3.0, 10.0), ("transitions", 6.0, 19.0)];

fn worst(library: &Library, file: &str, texture: &str) -> Counts {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("benches/paper/{file}.tex"));
    let project = Project::new(&path, true);
    let options = Options { texture: Some(texture.to_owned()), ..Options::default() };
    let compiled = compile(library, project.main(), &project, &options)
        .unwrap_or_else(|f| panic!("{}", render::human(&f.sources, &f.diagnostics)));
    cost(&compiled).texture().map(|pass| pass.worst).unwrap_or_default()
}

#[test]
fn the_papers_textures_take_fewer_lookups_than_in_the_paper() {
    let library = Library::standard().expect("the library is right");
    for (file, hashed, walked) in BOUNDS {
        for (texture, most) in [("hashed", hashed), ("walked", walked)] {
            let counts = worst(&library, file, texture);
            assert!(counts.samples >= 1.0, "{file}, {texture} draws something");
            assert!(counts.reads <= *most, "{file}, {texture}: {} reads, {most} at most", counts.reads);
        }
    }
}

/// The documented figures are those that are counted.
#[test]
fn the_table_of_costs_is_not_stale() {
    let library = Library::standard().expect("the library is right");
    let docs = include_str!("../../docs/performance.md");
    for (what, texture) in [("hashed", "hashed"), ("with σ", "walked")] {
        let cells: Vec<String> = BOUNDS
            .iter()
            .map(|(file, ..)| worst(&library, file, texture))
            .map(|counts| format!("{} / {}", counts.reads, counts.arithmetic.total))
            .collect();
        let row = format!("| {what} | {} |", cells.join(" | "));
        assert!(docs.contains(&row), "docs/performance.md lacks\n{row}");
    }
}
