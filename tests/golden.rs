//! Golden tests: every example and every row of the language's syntax, text to WGSL and manifest.
//! `INSTA_UPDATE=always cargo test --test golden` writes what changed; the diff shows it.

use std::path::{Path, PathBuf};
use texgraph_compiler::module::Loader;
use texgraph_compiler::{Compiled, Form, Library, Options, Pass, Program, compile, diagnostic::render};

/// Files below a folder, with parent folders allowed: tests share pictures.
struct Folder(PathBuf);

impl Loader for Folder {
    fn load(&self, path: &str) -> Result<String, String> {
        std::fs::read_to_string(self.0.join(path)).map_err(|error| error.to_string())
    }
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Every `.tex` file right in a folder, by name.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "tex"));
    files.sort();
    assert!(!files.is_empty(), "{} holds no .tex file", folder.display());
    files
}

fn compiled(library: &Library, file: &Path, options: &Options) -> Compiled {
    let folder = Folder(file.parent().expect("a file has a folder").to_owned());
    let name = file.file_name().and_then(|name| name.to_str()).expect("names are UTF-8");
    compile(library, name, &folder, options)
        .unwrap_or_else(|failure| panic!("{}", render::human(&failure.sources, &failure.diagnostics)))
}

/// The shaders of all passes, bakes with their names.
fn all_shaders(program: &Program) -> String {
    let named = program.passes.iter().zip(&program.manifest.passes).map(|(pass, described)| {
        let mark = described.bake.map_or(String::new(), |_| format!("// {}\n", described.shader));
        format!("{mark}{}", pass.wgsl)
    });
    named.collect::<Vec<_>>().join("\n")
}

fn files() -> Vec<PathBuf> {
    [sources(&root().join("tests/golden")), sources(&root().join("examples"))].concat()
}

#[test]
fn wgsl_and_manifest_are_as_recorded() {
    let library = Library::standard().expect("the library parses");
    insta::with_settings!({ snapshot_path => "golden/snapshots", prepend_module_to_snapshot => false }, {
        for file in files() {
            let name = file.file_stem().and_then(|stem| stem.to_str()).expect("names are UTF-8");
            for (form, suffix) in [(Form::Complete, "complete"), (Form::Library, "library")] {
                let options = Options { form, ..Options::default() };
                let program = compiled(&library, &file, &options).program;
                insta::assert_snapshot!(format!("{name}.{suffix}.wgsl"), all_shaders(&program));
                if form == Form::Complete {
                    insta::assert_snapshot!(format!("{name}.ron"), program.manifest.to_ron());
                }
            }
        }
    });
}

#[test]
fn every_shader_reads_back_and_samples_explicitly() {
    let library = Library::standard().expect("the library parses");
    for file in files() {
        for form in [Form::Complete, Form::Library, Form::Functions] {
            let options = Options { form, group: 2, first_binding: 100, ..Options::default() };
            for Pass { wgsl, .. } in compiled(&library, &file, &options).program.passes {
                assert!(!wgsl.contains("textureSample("), "{}: an implicit level", file.display());
                let module = naga::front::wgsl::parse_str(&wgsl)
                    .unwrap_or_else(|error| panic!("{}: {}", file.display(), error.emit_to_string(&wgsl)));
                let flags = naga::valid::ValidationFlags::all();
                let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::empty());
                validator.validate(&module).unwrap_or_else(|error| panic!("{}: {error:?}", file.display()));
            }
        }
    }
}

#[test]
fn the_same_text_gives_the_same_bytes() {
    let library = Library::standard().expect("the library parses");
    for file in files() {
        let options = Options::default();
        let first = compiled(&library, &file, &options).program;
        let again = std::thread::scope(|scope| {
            let other = scope.spawn(|| {
                let library = Library::standard().expect("the library parses");
                compiled(&library, &file, &options).program
            });
            other.join().expect("the thread ends well")
        });
        assert_eq!(all_shaders(&first), all_shaders(&again));
        assert_eq!(first.manifest, again.manifest);
    }
}

#[test]
fn an_expression_and_its_parts_named_differently_give_the_same_shader() {
    let library = Library::standard().expect("the library parses");
    let shader = |text: &str| {
        let files = [("t.tex".to_owned(), text.to_owned())].into();
        let files: std::collections::HashMap<String, String> = files;
        compile(&library, "t.tex", &files, &Options::default())
            .expect("compiles")
            .program
            .texture()
            .graph
            .clone()
    };
    let one = shader("texture t(uv: vec2) -> (height: float) { height = sin(uv.x * 3.0) + sin(uv.x * 3.0) }");
    let two = shader(
        "texture t(uv: vec2) -> (height: float) { height = a + b let b = sin(uv.x * 3.0) let a = sin(uv.x * 3.0) }",
    );
    let count = |graph: &texgraph_compiler::graph::Graph| {
        graph.functions.iter().map(|f| f.values.len()).sum::<usize>()
    };
    assert_eq!(count(&one), count(&two));
}
