//! `texgraph build`: shaders, manifests and tables for hosts.
//!
//! Everything is made in memory first, or taken from what the folder holds of an earlier build. Files
//! are written only when nothing is wrong with any texture, so the folder never holds a mixture of an
//! old and a new build; and only those that have changed, so that who watches them sees what has.

use crate::args::{Build, Form, Gradients, ManifestFormat, MessageFormat};
use crate::output;
use crate::problem::{Problem, Report};
use crate::program::{self, Program};
use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use texgraph_compiler::Options;
use texgraph_compiler::diagnostic::Diagnostic;
use texgraph_compiler::manifest;
use texgraph_runtime::package::{Cache, Packed};

/// A file to be written.
struct Made {
    name: String,
    bytes: Arc<[u8]>,
    /// What is said of it when it is.
    what: What,
}

/// What has been done for a file.
enum What {
    /// A table was made, in so much time if that is known.
    Table(Option<Duration>),
    /// A table was found in the folder, or made for another file.
    Copy,
    /// A text was.
    Text,
}

/// Builds the textures of a file.
///
/// # Errors
/// The file is wrong as a whole, or can't be written. What is wrong with single textures is shown
/// as it is found.
pub fn run(args: &Build, report: &mut Report) -> Result<(), Problem> {
    if args.discard_below.is_some() && args.form != Form::Complete {
        let why = "--discard-below needs an entry point: --form complete; others discard by themselves";
        return Err(Problem::Usage(why.into()));
    }
    let library = program::library()?;
    let program = Program::open(&library, &args.file, args.common.allow_outside)?;
    let mut cache = Cache::open(&args.output);
    let mut made = Vec::new();
    let mut left = Vec::new();
    let mut shown = Vec::new();
    for texture in program.wanted(args.texture.clone())? {
        match make(args, &program, texture, &mut cache) {
            Ok((name, files)) => {
                let names: Vec<&str> = files.iter().map(|file| file.name.as_str()).collect();
                left.extend(cache.left(&name, &names).into_iter().map(str::to_owned));
                made.extend(files);
            }
            Err(problem) => show(report, &mut shown, problem),
        }
    }
    if report.exit_code() != 0 {
        return Ok(());
    }
    let (changed, same) = write(args, made)?;
    if !args.quiet && args.common.message_format == MessageFormat::Human {
        // When even standard error is closed, the files are what can be had.
        let _ = std::io::stderr().lock().write_all(told(&changed, same, &left).as_bytes());
    }
    Ok(())
}

/// Shows what has not been shown for an earlier texture: two that read one picture share its errors.
fn show(report: &mut Report, shown: &mut Vec<Diagnostic>, mut problem: Problem) {
    if let Problem::Pages(failure) = &mut problem {
        failure.diagnostics.retain(|diagnostic| !shown.contains(diagnostic));
        shown.extend(failure.diagnostics.iter().cloned());
    }
    report.show(&problem);
}

/// A texture's name and all its files. A bake that a param changes has no file: its host draws it.
fn make(
    args: &Build,
    program: &Program<'_>,
    texture: Option<String>,
    cache: &mut Cache,
) -> Result<(String, Vec<Made>), Problem> {
    let profile = texgraph_compiler::Profile::from(args.host.profile);
    let (group, first_binding) = profile.bindings();
    let options = Options {
        texture,
        outputs: None,
        form: match args.form {
            Form::Complete => manifest::Form::Complete,
            Form::Library => manifest::Form::Library,
            Form::Functions => manifest::Form::Functions,
        },
        gradients: match args.gradients {
            Gradients::Derive => manifest::Gradients::Derive,
            Gradients::Argument => manifest::Gradients::Argument,
            Gradients::None => manifest::Gradients::None,
        },
        discard_below: args.discard_below,
        group: args.group.unwrap_or(group),
        first_binding: args.first_binding.unwrap_or(first_binding),
        exact_levels: args.exact_levels,
        profile,
        plane: None,
    };
    let mut compiled = program.compile(&options)?;
    let manifest = &compiled.program.manifest;
    if args.discard_below.is_some() && !manifest.outputs.iter().any(|output| output.name == "color") {
        let name = &manifest.texture;
        return Err(Problem::Usage(format!(
            "`{name}` has no output `color` whose alpha --discard-below could test"
        )));
    }
    let mut tables = program.load_new(&mut compiled, cache)?;
    program::fit(&compiled, profile)?;
    cache.draw(&mut compiled.program, &mut tables)?;
    let mut manifest = compiled.program.manifest;
    cache.compress(&mut manifest, &mut tables);
    let mut files: Vec<Made> = cache.pack(&mut manifest, &tables).into_iter().map(Made::from).collect();
    for (pass, described) in compiled.program.passes.into_iter().zip(&manifest.passes) {
        files.push(Made::text(described.shader.clone(), pass.wgsl));
    }
    let name = manifest.texture.clone();
    files.push(match args.manifest {
        ManifestFormat::Ron => Made::text(format!("{name}.ron"), manifest.to_ron()),
        ManifestFormat::Json => Made::text(format!("{name}.json"), manifest.to_json()),
    });
    Ok((name, files))
}

impl Made {
    fn text(name: String, text: String) -> Made {
        Made { name, bytes: text.into_bytes().into(), what: What::Text }
    }
}

impl From<Packed> for Made {
    fn from(Packed { name, bytes, is_made, time }: Packed) -> Made {
        Made { name, bytes, what: if is_made { What::Table(time) } else { What::Copy } }
    }
}

/// Writes the files that are not there as they should be: those, and how many others there are.
fn write(args: &Build, made: Vec<Made>) -> Result<(Vec<Made>, usize), Problem> {
    output::make_folder(&args.output)?;
    let (same, changed): (Vec<Made>, Vec<Made>) =
        made.into_iter().partition(|file| output::holds(&args.output.join(&file.name), &file.bytes));
    let files = changed.iter().map(|file| (args.output.join(&file.name), Arc::clone(&file.bytes)));
    let files: Vec<(PathBuf, Arc<[u8]>)> = files.collect();
    output::write(&files)?;
    Ok((changed, same.len()))
}

/// What was done: a line for each file that was written, one for all others, one for each that no
/// texture reads any more.
fn told(changed: &[Made], same: usize, left: &[String]) -> String {
    let mut lines = String::new();
    for Made { name, bytes, what } in changed {
        lines += &match what {
            What::Table(Some(time)) => {
                format!("made   {name} ({}, {:.2} s)\n", size(bytes), time.as_secs_f64())
            }
            What::Table(None) => format!("made   {name} ({})\n", size(bytes)),
            What::Copy => format!("copied {name} ({})\n", size(bytes)),
            What::Text => format!("wrote  {name}\n"),
        };
    }
    lines += &match (same, changed.len()) {
        (0, _) => String::new(),
        (1, 0) => "kept   the one file: nothing has changed\n".to_owned(),
        (same, 0) => format!("kept   all {same} files: nothing has changed\n"),
        (1, _) => "kept   1 file that has not changed\n".to_owned(),
        (same, _) => format!("kept   {same} files that have not changed\n"),
    };
    left.iter().for_each(|name| lines += &format!("unused {name}, of an earlier build\n"));
    lines
}

fn size(bytes: &[u8]) -> String {
    match bytes.len() {
        small @ ..1000 => format!("{small} bytes"),
        middle @ ..1_000_000 => format!("{:.1} kB", middle as f64 / 1e3),
        large => format!("{:.1} MB", large as f64 / 1e6),
    }
}
