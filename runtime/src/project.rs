//! The folder of a program: which files it may read, and what is said when one can't be read.
//!
//! A program names files by paths with `/`, relative to the folder of its main file. A `.tex` file
//! from a stranger must not be able to read what lies elsewhere, so paths that leave that folder
//! are refused (`../x`, absolute ones, links that lead out) unless the user allows them with
//! `--allow-outside`. Only regular files are opened: a pipe would never end.

use crate::nearest::nearest;
use std::collections::BTreeMap;
use std::fmt;
use std::fs::{self, File};
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use texgraph_compiler::module::Loader;

/// The largest resource file that is read, in bytes.
pub const MAX_FILE: u64 = 512 << 20;

/// What is read of a `.tex` file at most: a little more than the compiler accepts, so that the
/// compiler sees that it is too long, wherever the cut falls in a character.
const MAX_TEXT: u64 = (1 << 20) + 4;

/// The folder that a program's paths are relative to.
#[derive(Clone, Debug)]
pub struct Project {
    folder: PathBuf,
    main: String,
    allow_outside: bool,
    /// Files that were read before, with their bytes.
    held: BTreeMap<String, Arc<[u8]>>,
}

impl Project {
    /// The project of a main `.tex` file. Nothing is read yet.
    pub fn new(main: &Path, allow_outside: bool) -> Project {
        let parent = main.parent().filter(|parent| !parent.as_os_str().is_empty());
        Project {
            folder: parent.unwrap_or(Path::new(".")).to_path_buf(),
            main: main.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default(),
            allow_outside,
            held: BTreeMap::new(),
        }
    }

    /// The same project, in which these resource files, by their paths, hold these bytes whatever becomes
    /// of them.
    pub(crate) fn holding(&self, files: BTreeMap<String, Arc<[u8]>>) -> Project {
        Project { held: files, ..self.clone() }
    }

    /// The main file's path as the program sees it: its name.
    pub fn main(&self) -> &str {
        &self.main
    }

    /// The folder that paths are relative to.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The bytes of a resource file.
    ///
    /// # Errors
    /// The path leaves the folder, or names nothing, no regular file, one that can't be opened, or
    /// one of more than [`MAX_FILE`] bytes.
    pub fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        if let Some(bytes) = self.held.get(path) {
            return Ok(bytes.to_vec());
        }
        let fail = |problem| FileError { path: path.to_string(), problem };
        let file = self.open(path).map_err(fail)?;
        let bytes = read_at_most(file, MAX_FILE + 1).map_err(fail)?;
        if bytes.len() as u64 > MAX_FILE {
            return Err(fail(Problem::TooLarge { limit: MAX_FILE }));
        }
        Ok(bytes)
    }

    /// Opens a regular file that the program may read.
    fn open(&self, path: &str) -> Result<File, Problem> {
        let named_by_user = path == self.main;
        if !self.allow_outside && !named_by_user && leaves_folder(path) {
            return Err(Problem::Outside { link: false });
        }
        let full = fs::canonicalize(self.folder.join(path)).map_err(|error| self.problem(path, &error))?;
        if !self.allow_outside && !named_by_user {
            let folder = fs::canonicalize(&self.folder).map_err(|error| self.problem(path, &error))?;
            if !full.starts_with(folder) {
                return Err(Problem::Outside { link: true });
            }
        }
        let kind = fs::metadata(&full).map_err(|error| self.problem(path, &error))?;
        if kind.is_dir() {
            return Err(Problem::Folder);
        }
        if !kind.is_file() {
            return Err(Problem::Unreadable { reason: "it is not a regular file".into() });
        }
        File::open(&full).map_err(|error| self.problem(path, &error))
    }

    /// What an error of the file system means for the author.
    fn problem(&self, path: &str, error: &std::io::Error) -> Problem {
        match error.kind() {
            ErrorKind::NotFound | ErrorKind::NotADirectory => Problem::Missing { near: self.near(path) },
            _ => Problem::Unreadable { reason: error.to_string() },
        }
    }

    /// A file of the same folder with a similar name, as the program would write it.
    fn near(&self, path: &str) -> Option<String> {
        let (folder, name) = path.rsplit_once('/').map_or(("", path), |(folder, name)| (folder, name));
        let entries = fs::read_dir(self.folder.join(folder)).ok()?;
        let names = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<String> = names.collect();
        names.sort();
        let found = nearest(name, names.iter().map(String::as_str))?;
        Some(if folder.is_empty() { found.to_string() } else { format!("{folder}/{found}") })
    }
}

impl Loader for Project {
    fn load(&self, path: &str) -> Result<String, String> {
        let fail = |problem| FileError { path: path.to_string(), problem }.to_string();
        let file = self.open(path).map_err(fail)?;
        let bytes = read_at_most(file, MAX_TEXT).map_err(fail)?;
        text(bytes).map_err(|reason| fail(Problem::Unreadable { reason }))
    }
}

/// Text of bytes whose last character may be cut by [`MAX_TEXT`].
fn text(bytes: Vec<u8>) -> Result<String, String> {
    let cut = bytes.len() as u64 == MAX_TEXT;
    String::from_utf8(bytes).or_else(|error| {
        let at = error.utf8_error();
        let mut bytes = error.into_bytes();
        if cut && at.error_len().is_none() {
            bytes.truncate(at.valid_up_to());
            return Ok(String::from_utf8_lossy(&bytes).into_owned());
        }
        Err(format!("it is not UTF-8 text (byte {} is where that ends)", at.valid_up_to()))
    })
}

fn read_at_most(file: File, limit: u64) -> Result<Vec<u8>, Problem> {
    let mut bytes = Vec::new();
    match file.take(limit).read_to_end(&mut bytes) {
        Ok(_) => Ok(bytes),
        Err(error) => Err(Problem::Unreadable { reason: error.to_string() }),
    }
}

/// Whether a path leaves its folder by its text alone, on any operating system: `..` beyond the
/// top, a root, a drive.
fn leaves_folder(path: &str) -> bool {
    let drive = path.as_bytes().get(1) == Some(&b':');
    let mut depth = 0i32;
    let climbs = path.split(['/', '\\']).any(|part| {
        depth += match part {
            ".." => -1,
            "" | "." => 0,
            _ => 1,
        };
        depth < 0
    });
    drive || climbs || path.starts_with(['/', '\\'])
}

/// Why a file can't be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileError {
    /// The path as the program writes it.
    pub path: String,
    /// What is wrong with it.
    pub problem: Problem,
}

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Problem {
    /// There is none of this name.
    Missing {
        /// A file beside it with a similar name.
        near: Option<String>,
    },
    /// It lies outside the program's folder.
    Outside {
        /// The path stays inside, but a link on it leads out.
        link: bool,
    },
    /// It is a folder.
    Folder,
    /// The system refuses it.
    Unreadable {
        /// The system's words.
        reason: String,
    },
    /// It has too many bytes.
    TooLarge {
        /// The most that is read.
        limit: u64,
    },
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let path = &self.path;
        match &self.problem {
            Problem::Missing { near: Some(near) } => {
                write!(f, "there is no file `{path}`; is `{near}` meant?")
            }
            Problem::Missing { near: None } => write!(f, "there is no file `{path}`"),
            Problem::Outside { link: false } => {
                write!(f, "`{path}` lies outside the program's folder; allow that with --allow-outside")
            }
            Problem::Outside { link: true } => write!(
                f,
                "a link on the way to `{path}` leads out of the program's folder; allow that with --allow-outside"
            ),
            Problem::Folder => write!(f, "`{path}` is a folder, not a file"),
            Problem::Unreadable { reason } => write!(f, "`{path}` can't be read: {reason}"),
            Problem::TooLarge { limit } => write!(f, "`{path}` has more than {} MiB", limit >> 20),
        }
    }
}

impl std::error::Error for FileError {}

#[cfg(test)]
mod tests {
    use super::leaves_folder;

    #[test]
    fn paths_that_leave_are_seen_by_their_text() {
        for path in ["../x", "a/../../x", "/etc/passwd", "\\x", "C:\\x", "c:x", "a\\..\\..\\x", "//host/x"] {
            assert!(leaves_folder(path), "{path}");
        }
        for path in ["x", "a/x", "a/../x", "./x", "..x", "a/...", "x:y/z"] {
            assert!(!leaves_folder(path) || path == "x:y/z", "{path}");
        }
    }
}
