//! A `.tex` file on its way to the compiler: opened, compiled, its pictures loaded.
//!
//! Every error comes out as a [`Problem`] with the texts that its pages show.

use crate::problem::Problem;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use texgraph_compiler::diagram::Diagram;
use texgraph_compiler::module::{Loader, Source, Sources};
use texgraph_compiler::{Checked, Compiled, Failure, Library, Options, Profile, profile};
use texgraph_runtime::package::Cache;
use texgraph_runtime::project::Project;
use texgraph_runtime::resource::{self, Tables};

/// The standard library.
///
/// # Errors
/// It is broken, which no user can mend.
pub fn library() -> Result<Library, Problem> {
    Library::standard().map_err(|why| Problem::Machine(format!("a bug of texgraph, please report it: {why}")))
}

/// A main file that can be read.
pub struct Program<'a> {
    library: &'a Library,
    project: Project,
    /// The path as the user sees it, with `/`.
    path: String,
}

impl<'a> Program<'a> {
    /// Opens a file.
    ///
    /// # Errors
    /// It can't be read.
    pub fn open(library: &'a Library, file: &Path, allow_outside: bool) -> Result<Program<'a>, Problem> {
        let (project, path) = project(file, allow_outside)?;
        project.load(project.main()).map_err(|why| Problem::unread(&path, project.main(), why))?;
        Ok(Program { library, project, path })
    }

    /// Checks everything in the file.
    ///
    /// # Errors
    /// All errors of the file and what it imports.
    pub fn check(&self) -> Result<Checked, Problem> {
        Ok(texgraph_compiler::check(self.library, &self.path, &self.project)?)
    }

    /// Holds the file's textures against the limits of a host.
    ///
    /// # Errors
    /// All that they pass.
    pub fn check_profile(&self, profile: Profile) -> Result<(), Problem> {
        Ok(texgraph_compiler::check_profile(self.library, &self.path, &self.project, profile)?)
    }

    /// The names of the file's textures.
    ///
    /// # Errors
    /// All syntax errors.
    pub fn textures(&self) -> Result<Vec<String>, Problem> {
        Ok(texgraph_compiler::textures(self.library, &self.path, &self.project)?)
    }

    /// The named texture, or all of a file that is right as a whole. A file without textures wants
    /// the one that it does not have, and the compiler says so.
    ///
    /// # Errors
    /// None is named, and the file is wrong.
    pub fn wanted(&self, texture: Option<String>) -> Result<Vec<Option<String>>, Problem> {
        if texture.is_some() {
            return Ok(vec![texture]);
        }
        self.check()?;
        let textures = self.textures()?;
        Ok(if textures.is_empty() { vec![None] } else { textures.into_iter().map(Some).collect() })
    }

    /// Compiles a texture.
    ///
    /// # Errors
    /// All errors that concern it.
    pub fn compile(&self, options: &Options) -> Result<Compiled, Failure> {
        texgraph_compiler::compile(self.library, &self.path, &self.project, options)
    }

    /// The diagram of a texture or node; the first texture when none is named.
    ///
    /// # Errors
    /// All syntax errors, or there is no such texture or node.
    pub fn diagram(&self, name: Option<&str>) -> Result<Diagram, Failure> {
        texgraph_compiler::diagram::diagram(self.library, &self.path, &self.project, name)
    }

    /// Loads the textures that a compiled program reads, and enters their sizes into its manifest.
    ///
    /// # Errors
    /// All that is wrong with any of the files.
    pub fn load(&self, compiled: &mut Compiled) -> Result<Tables, Failure> {
        resource::load(&mut compiled.program, &self.project)
            .map_err(|diagnostics| Failure { sources: compiled.sources.clone(), diagnostics })
    }

    /// The same, with what a cache knows taken from there.
    ///
    /// # Errors
    /// All that is wrong with any of the files that it does not know.
    pub fn load_new(&self, compiled: &mut Compiled, cache: &mut Cache) -> Result<Tables, Failure> {
        cache
            .load(&mut compiled.program, &self.project)
            .map_err(|diagnostics| Failure { sources: compiled.sources.clone(), diagnostics })
    }
}

/// Whether the host has room for the textures of a program, as far as they are loaded.
///
/// # Errors
/// All that are too large.
pub fn fit(compiled: &Compiled, profile: Profile) -> Result<(), Failure> {
    let texgraph_compiler::Program { passes, manifest } = &compiled.program;
    let graph = passes.last().map(|pass| &pass.graph);
    let diagnostics = graph.map_or(Vec::new(), |graph| profile::sides(profile, manifest, graph));
    match diagnostics.is_empty() {
        true => Ok(()),
        false => Err(Failure { sources: compiled.sources.clone(), diagnostics }),
    }
}

/// Cuts `FILE:TEXTURE`, or `FILE:TEXTURE.WIRE`. What follows the last `:` is a name only if it could
/// be one: `C:\walls.tex` is a file.
pub fn split(argument: &OsStr) -> (PathBuf, Option<String>) {
    let cut = argument.to_str().and_then(|text| text.rsplit_once(':'));
    match cut {
        Some((file, name)) if !file.is_empty() && is_wire(name) => (file.into(), Some(name.to_owned())),
        _ => (argument.into(), None),
    }
}

/// `texture`, `node` or `texture.wire`; `walls.tex` is a file.
fn is_wire(text: &str) -> bool {
    match text.split_once('.') {
        Some((name, wire)) => is_name(name) && is_name(wire) && wire != "tex",
        None => is_name(text),
    }
}

fn is_name(text: &str) -> bool {
    let is_letter = |c: char| c.is_ascii_alphabetic() || c == '_';
    text.starts_with(is_letter) && text.chars().all(|c| is_letter(c) || c.is_ascii_digit())
}

/// The text of a `.tex` file, with its path as shown.
///
/// # Errors
/// It can't be read.
pub fn text(file: &Path) -> Result<(String, String), Problem> {
    let (project, path) = project(file, false)?;
    let text = project.load(project.main()).map_err(|why| Problem::unread(&path, project.main(), why))?;
    Ok((path, text))
}

/// One text as what pages show.
pub fn sources(path: &str, text: &str) -> Sources {
    Sources(vec![Source { path: path.to_owned(), text: text.into() }])
}

/// The project of a file, and the file's path as shown. The compiler cuts that at the last `/`, so
/// what is behind must be the name that the project knows.
fn project(file: &Path, allow_outside: bool) -> Result<(Project, String), Problem> {
    if file.file_name().is_none() {
        return Err(Problem::Input(format!("`{}` is a folder, not a file", file.display())));
    }
    let project = Project::new(file, allow_outside);
    let folder = file.parent().map(|folder| folder.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = if cfg!(windows) { folder.replace('\\', "/") } else { folder };
    let path = match folder.as_str() {
        "" => project.main().to_owned(),
        _ => format!("{}/{}", folder.trim_end_matches('/'), project.main()),
    };
    Ok((project, path))
}

#[cfg(test)]
mod tests {
    use super::split;
    use std::ffi::OsStr;
    use std::path::PathBuf;

    #[test]
    fn a_texture_is_cut_off_only_where_one_is_named() {
        let cases = [
            ("a.tex", "a.tex", None),
            ("a.tex:bricks", "a.tex", Some("bricks")),
            (r"C:\a.tex", r"C:\a.tex", None),
            (r"C:\a.tex:_b2", r"C:\a.tex", Some("_b2")),
            ("C:/a.tex", "C:/a.tex", None),
            ("a.tex:", "a.tex:", None),
            (":bricks", ":bricks", None),
            ("a.tex:2b", "a.tex:2b", None),
            ("a:b:c", "a:b", Some("c")),
            ("a.tex:bricks.pick", "a.tex", Some("bricks.pick")),
            ("C:walls.tex", "C:walls.tex", None),
        ];
        for (argument, file, texture) in cases {
            assert_eq!(split(OsStr::new(argument)), (PathBuf::from(file), texture.map(str::to_owned)));
        }
    }
}
