//! The real programs that mutants are made of.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use texgraph_compiler::module::Loader;

/// Folders whose `.tex` files are mutated.
const FOLDERS: &[&str] =
    &["examples", "tests/golden", "tests/golden/parts", "compiler/std", "grammar/tests/data"];

/// Every program with its path from the root of the repository, by path.
pub struct Corpus {
    files: BTreeMap<String, String>,
}

impl Corpus {
    /// Read from the repository.
    ///
    /// # Errors
    /// A file can't be read, or there is none.
    pub fn read() -> Result<Corpus, String> {
        let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let mut files = BTreeMap::new();
        for folder in FOLDERS {
            for path in sources(&root.join(folder))? {
                let text = std::fs::read_to_string(&path).map_err(|why| format!("{path:?}: {why}"))?;
                let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                files.insert(format!("{folder}/{name}"), text);
            }
        }
        if files.is_empty() { Err("there is no program to mutate".to_owned()) } else { Ok(Corpus { files }) }
    }

    /// The paths, in order.
    pub fn paths(&self) -> Vec<&str> {
        self.files.keys().map(String::as_str).collect()
    }

    /// The texts, in the same order.
    pub fn texts(&self) -> Vec<&str> {
        self.files.values().map(String::as_str).collect()
    }

    /// The corpus with another text for one of its files, and what that file is called there:
    /// paths are relative to its folder.
    pub fn with<'a>(&'a self, path: &'a str, text: &'a str) -> (&'a str, Changed<'a>) {
        let (folder, name) = path.rsplit_once('/').unwrap_or(("", path));
        (name, Changed { corpus: self, folder, name, text })
    }
}

fn sources(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|why| format!("{folder:?}: {why}"))?;
    let files = entries.flatten().map(|entry| entry.path());
    Ok(files.filter(|file| file.extension().is_some_and(|extension| extension == "tex")).collect())
}

/// A corpus in which one file has another text.
pub struct Changed<'a> {
    corpus: &'a Corpus,
    folder: &'a str,
    name: &'a str,
    text: &'a str,
}

impl Loader for Changed<'_> {
    fn load(&self, path: &str) -> Result<String, String> {
        if path == self.name {
            return Ok(self.text.to_owned());
        }
        let full = format!("{}/{path}", self.folder);
        self.corpus.files.get(&full).cloned().ok_or_else(|| format!("there is no `{path}`"))
    }
}
