//! Writing: files that are whole or not there, and standard output that may close early.
//!
//! A file is written beside its target under another name and renamed when it is complete, so no
//! reader ever sees half of it and a failed run leaves the old one. Several files are all written
//! before the first is renamed.

use crate::problem::Problem;
use std::fs;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Writes files, all or none. Those that exist keep their permissions.
///
/// # Errors
/// The machine can't write one of them.
pub fn write<B: AsRef<[u8]>>(files: &[(PathBuf, B)]) -> Result<(), Problem> {
    let staged = files.iter().map(|(path, bytes)| stage(path, bytes.as_ref()));
    let staged: Vec<Staged> = staged.collect::<Result<_, _>>()?;
    for Staged { file, target } in staged {
        file.persist(&target).map_err(|error| cannot_write(&target, &error.error))?;
    }
    Ok(())
}

/// Whether a file holds exactly these bytes, and so need not be written.
pub fn holds(path: &Path, bytes: &[u8]) -> bool {
    let is_as_long = fs::metadata(path).is_ok_and(|kind| kind.is_file() && kind.len() == bytes.len() as u64);
    is_as_long && fs::read(path).is_ok_and(|held| held == bytes)
}

/// Finds out early whether a picture can be written: it is a PNG, and there is a place for it.
///
/// # Errors
/// Its name ends otherwise, or as [`try_out`] says.
pub fn try_png(path: &Path) -> Result<(), Problem> {
    if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
        let path = path.display();
        return Err(Problem::Usage(format!("only PNG pictures are written: `{path}` must end in `.png`")));
    }
    try_out(path)
}

/// Finds out early whether a file can be written: before minutes of rendering, not after.
///
/// # Errors
/// Its folder is missing or closed to us, or the path is a folder or a read-only file.
pub fn try_out(path: &Path) -> Result<(), Problem> {
    let target = target(path)?;
    // An unnamed file: nothing is left of it, however the process ends.
    tempfile::tempfile_in(folder(&target)).map(drop).map_err(|error| cannot_write(&target, &error))
}

/// Makes a folder and those above it, if they are missing.
///
/// # Errors
/// The machine can't.
pub fn make_folder(path: &Path) -> Result<(), Problem> {
    if path.is_dir() {
        return Ok(());
    }
    fs::create_dir_all(path).map_err(|error| {
        let reason = if path.exists() { "a file has this name".to_owned() } else { reason(&error) };
        Problem::Machine(format!("can't make the folder `{}`: {reason}", path.display()))
    })
}

/// Writes to standard output. A reader that has seen enough (`texgraph explain | head`) is fine.
///
/// # Errors
/// The machine can't write.
pub fn print(text: &str) -> Result<(), Problem> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Problem::Machine(format!("can't write to standard output: {}", reason(&error))))
        }
        _ => Ok(()),
    }
}

/// A complete file that only lacks its name.
struct Staged {
    file: NamedTempFile,
    target: PathBuf,
}

fn stage(path: &Path, bytes: &[u8]) -> Result<Staged, Problem> {
    let target = target(path)?;
    let fail = |error: std::io::Error| cannot_write(&target, &error);
    let mut file = create_in(folder(&target)).map_err(fail)?;
    file.write_all(bytes).map_err(fail)?;
    if let Ok(old) = fs::metadata(&target) {
        file.as_file().set_permissions(old.permissions()).map_err(fail)?;
    }
    Ok(Staged { file, target })
}

/// A new file with the permissions that any new file of the user has.
fn create_in(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".texgraph-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// What a path really names: a link stays and its file is replaced.
fn target(path: &Path) -> Result<PathBuf, Problem> {
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let refuse = |why: &str| Err(Problem::Machine(format!("can't write `{}`: {why}", path.display())));
    match fs::metadata(&target) {
        Ok(kind) if kind.is_dir() => refuse("it is a folder"),
        Ok(kind) if !kind.is_file() => refuse("it is not a regular file"),
        Ok(kind) if kind.permissions().readonly() => refuse("it is read-only"),
        Ok(_) => Ok(target),
        Err(_) if !folder(&target).is_dir() => {
            refuse(&format!("there is no folder `{}`", folder(&target).display()))
        }
        Err(_) => Ok(target),
    }
}

fn folder(path: &Path) -> &Path {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    parent.unwrap_or(Path::new("."))
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Problem {
    Problem::Machine(format!("can't write `{}`: {}", path.display(), reason(error)))
}

/// The system's words, without the path of a temporary file that nobody has heard of.
fn reason(error: &std::io::Error) -> String {
    match error.kind() {
        ErrorKind::PermissionDenied => "permission denied".into(),
        ErrorKind::StorageFull => "the disk is full".into(),
        ErrorKind::ReadOnlyFilesystem => "the file system is read-only".into(),
        _ => error.to_string(),
    }
}
