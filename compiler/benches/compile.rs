//! How long compiling takes, beside the floor that naga sets: validating and writing the module of
//! the same program. Run with `cargo bench -p texgraph-compiler`.

use criterion::{Criterion, criterion_group, criterion_main};
use naga::back::wgsl::{WriterFlags, write_string};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::HashMap;
use std::hint::black_box;
use texgraph_compiler::{Compiled, Library, Options, compile, lower::lower};

const TILING: &str = include_str!("../../examples/tiling.tex");

fn tiling(library: &Library, files: &HashMap<String, String>) -> Compiled {
    match compile(library, "tiling.tex", files, &Options::default()) {
        Ok(compiled) => compiled,
        Err(failure) => panic!("tiling.tex does not compile: {:?}", failure.diagnostics),
    }
}

fn benches(c: &mut Criterion) {
    let files: HashMap<String, String> = [("tiling.tex".to_owned(), TILING.to_owned())].into();
    let library = Library::standard().expect("the library parses");
    let program = tiling(&library, &files).program;
    let module = lower(&program.texture().graph, &program.manifest).module;
    c.bench_function("library, once", |b| b.iter(|| black_box(Library::standard())));
    c.bench_function("tiling.tex, text to WGSL", |b| b.iter(|| black_box(tiling(&library, &files))));
    c.bench_function("tiling.tex, the floor: naga validates and writes", |b| {
        b.iter(|| {
            let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
            let info = validator.validate(&module).expect("the module is valid");
            black_box(write_string(&module, &info, WriterFlags::empty()))
        });
    });
}

criterion_group!(group, benches);
criterion_main!(group);
