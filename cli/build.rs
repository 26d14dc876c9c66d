//! `texgraph build`: shaders, manifests and table bytes for hosts.
//!
//! Everything is made in memory first. Files are written only when nothing is wrong with any
//! texture, so the folder never holds a mixture of an old and a new build.

use crate::args::{Build, Form, Gradients, ManifestFormat};
use crate::output;
use crate::problem::{Problem, Report};
use crate::program::{self, Program};
use std::path::PathBuf;
use std::sync::Arc;
use texgraph_compiler::Options;
use texgraph_compiler::diagnostic::Diagnostic;
use texgraph_compiler::manifest::{self, Manifest};
use texgraph_runtime::bake;
use texgraph_runtime::resource::Tables;

/// A file's name and its bytes.
type Made = (String, Arc<[u8]>);

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
    let mut made = Vec::new();
    let mut shown = Vec::new();
    for texture in program.wanted(args.texture.clone())? {
        match make(args, &program, texture) {
            Ok(files) => made.extend(files),
            Err(problem) => show(report, &mut shown, problem),
        }
    }
    if report.exit_code() == 0 {
        write(args, made)?;
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

/// All files of one texture. A bake that a param changes has no file: its host draws it.
fn make(args: &Build, program: &Program<'_>, texture: Option<String>) -> Result<Vec<Made>, Problem> {
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
    let mut tables = program.load(&mut compiled)?;
    program::fit(&compiled, profile)?;
    bake::render_fixed(&compiled.program, &mut tables)?;
    let mut manifest = compiled.program.manifest;
    let mut files = name_tables(&mut manifest, &tables);
    for (pass, described) in compiled.program.passes.into_iter().zip(&manifest.passes) {
        files.push((described.shader.clone(), pass.wgsl.into_bytes().into()));
    }
    let name = &manifest.texture;
    files.push(match args.manifest {
        ManifestFormat::Ron => (format!("{name}.ron"), manifest.to_ron().into_bytes().into()),
        ManifestFormat::Json => (format!("{name}.json"), manifest.to_json().into_bytes().into()),
    });
    Ok(files)
}

/// The bytes of all textures that the shader reads, with the names that the manifest now has.
fn name_tables(manifest: &mut Manifest, tables: &Tables) -> Vec<Made> {
    let mut files = Vec::new();
    for (index, resource) in manifest.resources.iter_mut().enumerate() {
        for texture in &mut resource.textures {
            if let (Some(table), Some(bytes)) = (&mut texture.table, tables.get(index, &texture.field)) {
                let name = format!("{}.{}.{}.bin", manifest.texture, resource.name, texture.field);
                table.file = Some(name.clone());
                files.push((name, Arc::clone(bytes)));
            }
        }
    }
    files
}

fn write(args: &Build, made: Vec<Made>) -> Result<(), Problem> {
    output::make_folder(&args.output)?;
    let files = made.into_iter().map(|(name, bytes)| (args.output.join(name), bytes));
    let files: Vec<(PathBuf, Arc<[u8]>)> = files.collect();
    output::write(&files)
}
