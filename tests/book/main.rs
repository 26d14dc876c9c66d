//! docs/nodes, the reference of the library: a page for each file of compiler/std, made of its doc
//! comments, with a picture of every node drawn by the CPU renderer and the text that draws it.
//!
//! `TEXGRAPH_BOOK=write cargo test --test book` writes what has changed; without it the test fails
//! when anything has.

mod draw;
mod page;

use page::Group;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Every file of the book: its name below docs/nodes, and its bytes.
fn book() -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let groups: Vec<Group> = page::groups();
    for group in &groups {
        files.insert(PathBuf::from(format!("{}.md", group.name)), group.text().into_bytes());
        for node in group.nodes() {
            // Nodes of several files share names.
            let picture = draw::sheet(&root().join(format!("tests/nodes/{}.tex", group.name)), &node);
            files.insert(PathBuf::from(format!("images/{}/{node}.jpg", group.name)), picture);
        }
    }
    files.insert("intrinsics.md".into(), page::intrinsics().into_bytes());
    files.insert("README.md".into(), page::contents(&groups).into_bytes());
    files
}

/// The files below a folder, as paths from there.
fn files_of(folder: &Path, below: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder.join(below)).into_iter().flatten().flatten();
    let paths = entries.map(|entry| below.join(entry.file_name()));
    paths
        .flat_map(|path| if folder.join(&path).is_dir() { files_of(folder, &path) } else { vec![path] })
        .collect()
}

#[test]
fn the_book_is_up_to_date() {
    let folder = root().join("docs/nodes");
    let book = book();
    assert!(book.len() > 100, "{} files", book.len());
    let writes = std::env::var("TEXGRAPH_BOOK").is_ok_and(|value| value == "write");
    let gone = files_of(&folder, Path::new("")).into_iter().filter(|path| !book.contains_key(path));
    let mut stale: Vec<PathBuf> = gone.collect();
    if writes {
        stale.drain(..).for_each(|path| fs::remove_file(folder.join(path)).expect("it can be removed"));
    }
    for (path, bytes) in book {
        let file = folder.join(&path);
        if fs::read(&file).is_ok_and(|found| found == bytes) {
            continue;
        }
        if writes {
            file.parent().map(fs::create_dir_all).transpose().expect("the folder can be made");
            fs::write(file, bytes).expect("it can be written");
        } else {
            stale.push(path);
        }
    }
    assert!(stale.is_empty(), "TEXGRAPH_BOOK=write cargo test --test book makes these anew: {stale:?}");
}
