//! The tables of all examples, hashed.
//!
//! A build takes a table that an earlier one has made of the same recipe and files. Where a change makes
//! other bytes of them, this snapshot changes, and `package::MAKING` has to be raised with it. (Where
//! an example or its pictures were changed, it need not.)

use std::fmt::Write;
use std::fs;
use std::path::Path;
use texgraph_compiler::{Library, Options, compile, textures};
use texgraph_runtime::project::Project;
use texgraph_runtime::{bake, package, resource};

#[test]
fn the_bytes_of_tables_are_those_of_their_number() {
    let library = Library::standard().expect("the library parses");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let entries = fs::read_dir(folder).expect("the folder is there").flatten();
    let mut files: Vec<_> = entries.map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "tex"));
    files.sort();
    let mut text = format!("making {}\n", package::MAKING);
    for path in files {
        let project = Project::new(&path, false);
        for name in textures(&library, project.main(), &project).expect("it parses") {
            let options = Options { texture: Some(name.clone()), ..Options::default() };
            let Ok(compiled) = compile(&library, project.main(), &project, &options) else {
                panic!("{name}")
            };
            let mut program = compiled.program;
            let mut tables = resource::load(&mut program, &project).expect("its pictures are there");
            resource::compress(&mut program.manifest, &mut tables);
            bake::render_fixed(&program, &mut tables).expect("its bakes are drawn");
            for (index, field, bytes) in tables.iter() {
                let resource = &program.manifest.resources[index].name;
                writeln!(text, "{name}.{resource}.{field} {:016x}", hash(bytes)).expect("a string takes all");
            }
        }
    }
    insta::assert_snapshot!(text);
}

/// FNV-1a (Fowler, Noll & Vo).
fn hash(bytes: &[u8]) -> u64 {
    let start = 0xcbf2_9ce4_8422_2325;
    bytes.iter().fold(start, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3))
}
