//! A folder to run the command in, and what came of a run.

use std::ffi::OsStr;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A program of one texture that reads no file.
pub const PLAIN: &str = "param scale: float = 1.0 in 0.0..=4.0\n\ntexture plain(uv: vec2) -> (color: color, height: float) {\n    color  = vec4(uv.x * scale, uv.y, 0.0, 1.0)\n    height = uv.x\n}\n";

/// A program with an error at line 2.
pub const WRONG: &str =
    "texture wrong(uv: vec2) -> (color: color) {\n    color = vec4(uv, missing, 1.0)\n}\n";

/// A folder that is removed at the end of the test.
pub struct Workshop {
    folder: TempDir,
}

/// What came of a run.
#[derive(Debug)]
pub struct Run {
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Workshop {
    /// A folder with these files.
    pub fn new(files: &[(&str, &str)]) -> Workshop {
        let workshop = Workshop { folder: tempfile::tempdir().expect("a temporary folder") };
        for (name, text) in files {
            workshop.write(name, text);
        }
        workshop
    }

    /// The path of a file in it.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a folder above")).expect("the folder is made");
        fs::write(path, bytes).expect("the file is written");
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).expect("the file is text")
    }

    /// The names of all files and folders in it, in order.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("the folder is read").flatten();
        let mut names: Vec<String> =
            entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Runs the command here.
    pub fn run<S: AsRef<OsStr>>(&self, arguments: &[S]) -> Run {
        self.run_with(arguments, "")
    }

    /// Runs the command here with a text on its standard input.
    pub fn run_with<S: AsRef<OsStr>>(&self, arguments: &[S], input: impl AsRef<[u8]>) -> Run {
        let mut child = command(self.folder.path())
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        // A command that does not read its input closes the pipe.
        let _ = child.stdin.take().expect("a pipe").write_all(input.as_ref());
        Run::of(child.wait_with_output().expect("the command ends"))
    }
}

/// The command with nothing of the tester's terminal.
pub fn command(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_texgraph"));
    command.current_dir(folder).env_remove("COLUMNS").env_remove("CLICOLOR_FORCE");
    command
}

impl Run {
    fn of(output: Output) -> Run {
        Run {
            code: output.status.code().unwrap_or(-1),
            out: String::from_utf8_lossy(&output.stdout).into_owned(),
            err: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }

    /// It ended well and said nothing.
    pub fn is_silent(&self) -> bool {
        self.code == 0 && self.out.is_empty() && self.err.is_empty()
    }

    /// It ended well and said what it did on standard error, where nothing panicked.
    pub fn is_done(&self) -> bool {
        self.code == 0 && self.out.is_empty() && !self.err.is_empty() && !self.err.contains("panicked")
    }

    /// Asserts the exit code and a part of what stands on standard error, where nothing panicked.
    #[track_caller]
    pub fn fails(&self, code: i32, part: &str) {
        assert_eq!(self.code, code, "{self:#?}");
        assert!(self.err.contains(part), "no `{part}` in {self:#?}");
        assert!(!self.err.contains("panicked"), "{self:#?}");
    }
}

/// The size of a PNG.
pub fn png_size(bytes: &[u8]) -> [u32; 2] {
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n", "a PNG");
    let number = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().expect("four bytes"));
    [number(16), number(20)]
}

/// The pictures and programs of examples/.
pub fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")
}
