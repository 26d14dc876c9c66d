//! What the README and the pages of docs/ show is so: their examples compile, their pictures and
//! files are there, and what is said of built programs is what building gives.

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use texgraph_compiler::manifest::{self, Argument};
use texgraph_compiler::{Form, Library, Options, Program, check, compile, diagnostic::render};
use texgraph_runtime::project::Project;

/// The pages that show pictures or examples.
const PAGES: &[&str] = &[
    "README.md",
    "docs/gallery.md",
    "docs/guide.md",
    "docs/language.md",
    "docs/embedding.md",
    "docs/architecture.md",
    "docs/quality.md",
    "docs/stochastic.md",
];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn page(file: &str) -> String {
    std::fs::read_to_string(root().join(file)).expect("the file is there")
}

/// The fenced blocks of a Markdown text with that info string.
fn blocks<'a>(text: &'a str, info: &str) -> Vec<&'a str> {
    let open = format!("```{info}\n");
    text.split(open.as_str()).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

/// A program out of examples/.
fn example(name: &str, form: Form) -> Program {
    let library = Library::standard().expect("the library parses");
    let project = Project::new(&root().join(format!("examples/{name}.tex")), false);
    let options = Options { form, ..Options::default() };
    match compile(&library, project.main(), &project, &options) {
        Ok(compiled) => compiled.program,
        Err(failure) => panic!("{}", render::human(&failure.sources, &failure.diagnostics)),
    }
}

#[test]
fn every_example_is_right_and_formatted() {
    let library = Library::standard().expect("the library parses");
    let mut checked = 0;
    for file in PAGES {
        for block in blocks(&page(file), "tex") {
            let files: HashMap<String, String> = [("t.tex".to_owned(), block.to_owned())].into();
            if let Err(failure) = check(&library, "t.tex", &files) {
                panic!("{file}:\n{}", render::human(&failure.sources, &failure.diagnostics));
            }
            let formatted = texgraph_grammar::format(block).expect("it parses");
            assert_eq!(formatted, block, "{file} shows the canonical layout");
            checked += 1;
        }
    }
    assert!(checked >= 11, "{checked} examples found");
}

#[test]
fn every_picture_is_there_and_shown() {
    let mut shown = BTreeSet::new();
    for file in PAGES {
        let text = page(file);
        let folder = Path::new(file).parent().unwrap_or(Path::new(""));
        let links = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        for link in links.filter(|link| link.contains("images/")) {
            let path = root().join(folder).join(link);
            assert!(path.is_file(), "{file} shows {link}");
            shown.insert(path.file_name().map(ToOwned::to_owned));
        }
    }
    for entry in std::fs::read_dir(root().join("docs/images")).expect("the folder is there") {
        let path = entry.expect("readable").path();
        let is_picture = path.extension().is_some_and(|e| e == "png" || e == "jpg" || e == "svg");
        let is_shown = shown.contains(&path.file_name().map(ToOwned::to_owned));
        assert!(!is_picture || is_shown, "nothing shows {}", path.display());
    }
}

#[test]
fn the_files_of_the_architecture_are_there() {
    let text = page("docs/architecture.md");
    let rows = text.lines().filter_map(|line| line.strip_prefix("| `"));
    let mut found = 0;
    for row in rows {
        let mut folder = PathBuf::new();
        // `compiler/src/contract.rs`, `manifest.rs`: the second stands beside the first.
        let cell = row.split(" |").next().unwrap_or_default();
        for name in cell.split('`').filter(|part| part.contains(['/', '.'])) {
            let path = if name.contains("*.") {
                Path::new(name).parent().unwrap_or(Path::new(""))
            } else {
                Path::new(name)
            };
            let known =
                [root().join(path), root().join(&folder).join(path), root().join("compiler").join(path)];
            assert!(known.iter().any(|path| path.exists()), "{name} is nowhere");
            folder = path.parent().unwrap_or(Path::new("")).to_owned();
            found += 1;
        }
    }
    assert!(found >= 20, "{found} files found");
}

#[test]
fn the_function_of_the_tiling_is_as_embedding_shows() {
    let text = page("docs/embedding.md");
    let program = example("tiling", Form::Functions);
    let heads: Vec<&str> =
        blocks(&text, "wgsl").into_iter().filter(|block| block.starts_with("fn ")).collect();
    assert_eq!(heads.len(), 1);
    let wgsl = &program.texture().wgsl;
    assert!(wgsl.contains(&format!("{} {{", heads[0].trim_end())), "{wgsl}");
    let pass = program.manifest.passes.last().expect("a pass");
    let start = wgsl.rfind("\nfn ").map_or(0, |start| start + 1);
    assert!(wgsl[start..].starts_with(&format!("fn {}(", pass.entry_point)), "the function is the last");
    let call = pass.call.as_ref().expect("the functions form says how to call it");
    assert_eq!(call.members, None);
    let rows = text.lines().filter_map(|line| line.strip_prefix("| `{")?.split('`').next());
    let shown: Vec<Argument> = rows
        .map(|row| serde_json::from_str(&format!("{{{row}")).expect("an argument as JSON writes it"))
        .collect();
    assert_eq!(shown, call.arguments);
}

#[test]
fn the_passes_of_the_terrain_are_as_embedding_shows() {
    let text = page("docs/embedding.md");
    let manifest = example("terrain", Form::Complete).manifest;
    let row = |pass: &manifest::Pass| {
        let bake = pass.bake.map_or("none".to_owned(), |resource| format!("resource {resource}"));
        let read: Vec<String> = pass.reads.iter().map(|(resource, _)| resource.to_string()).collect();
        let reads = if read.is_empty() { String::new() } else { format!("{} `pixels`", read.join(", ")) };
        let params: Vec<String> = pass.params.iter().map(|param| format!("`{param}`")).collect();
        let cells =
            [format!("`{}`", pass.name), bake, reads, params.join(", "), format!("`{}`", pass.shader)];
        format!("| {} |", cells.join(" | ")).replace("  ", " ")
    };
    for pass in &manifest.passes {
        let row = row(pass);
        assert!(text.contains(&row), "{row}");
    }
}
