//! The three forms of one texture give the same picture, pixel for pixel, whether they take screen
//! derivatives or are given them.
//!
//! A small host is written around the library form and the functions form, from the manifest alone:
//! bindings, an entry point and the call. Without an adapter the tests are shown as ignored, unless
//! `TEXGRAPH_GPU=required`.

use libtest_mimic::{Arguments, Failed, Trial};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use texgraph_compiler::manifest::{
    Argument, Axis, Gradient, Input, Manifest, Param, SampleKind, Scalar, Source, Texture, Type, Uniform,
    ViewDimension,
};
use texgraph_compiler::{Form, Gradients, Library, Options, Program, compile, diagnostic::render};
use texgraph_runtime::gpu::{Gpu, Preference};
use texgraph_runtime::picture::Picture;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::load;

const SIDE: u32 = 97;
const TIME: f32 = 1.25;

fn main() {
    let arguments = Arguments::from_args();
    let required = std::env::var("TEXGRAPH_GPU").is_ok_and(|value| value == "required");
    let gpu = Gpu::new(Preference::Hardware).map(Arc::new);
    let trials = files().into_iter().map(|file| {
        let gpu = gpu.clone();
        let name = file.file_stem().map_or(String::new(), |stem| stem.to_string_lossy().into_owned());
        let ignored = gpu.is_err() && !required;
        let run = move || forms_agree(&*gpu.map_err(|error| error.to_string())?, &file);
        Trial::test(format!("forms_agree::{name}"), run).with_ignored_flag(ignored)
    });
    libtest_mimic::run(&arguments, trials.collect()).exit();
}

/// Every example and golden file.
fn files() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = ["examples", "tests/golden"].map(|folder| std::fs::read_dir(root.join(folder)));
    let entries = folders.into_iter().flatten().flatten().flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|extension| extension == "tex")).collect();
    files.sort();
    files
}

fn forms_agree(gpu: &Gpu, file: &Path) -> Result<(), Failed> {
    let complete = pictures(gpu, file, Form::Complete, Gradients::Derive)?;
    if complete.iter().all(|picture| picture.pixels.iter().all(|pixel| *pixel == picture.pixels[0])) {
        return Err("every picture has one colour: they prove nothing".into());
    }
    for form in [Form::Library, Form::Functions] {
        for gradients in [Gradients::Derive, Gradients::Argument] {
            let pictures = pictures(gpu, file, form, gradients)?;
            if let Some(output) = (0..complete.len()).find(|i| pictures[*i] != complete[*i]) {
                let difference = complete[output].difference(&pictures[output], 0.0);
                return Err(format!("{form:?}, {gradients:?}, output {output}: {difference:?}").into());
            }
        }
    }
    Ok(())
}

/// The pictures of all outputs.
fn pictures(gpu: &Gpu, file: &Path, form: Form, gradients: Gradients) -> Result<Vec<Picture>, Failed> {
    let library = Library::standard()?;
    let project = Project::new(file, true);
    let options = Options { form, gradients, ..Options::default() };
    let compiled = compile(&library, project.main(), &project, &options);
    let compiled = compiled.map_err(|f| render::human(&f.sources, &f.diagnostics))?;
    let mut program = compiled.program;
    let text = &program.texture().wgsl;
    if gradients == Gradients::Argument && (text.contains("dpdx") || text.contains("dpdy")) {
        return Err(format!("it takes derivatives:\n{text}").into());
    }
    match form {
        Form::Complete => {}
        Form::Library => host_of_library(&mut program),
        Form::Functions => host_of_functions(&mut program),
    }
    let tables =
        load(&mut program, &project).map_err(|diagnostics| render::human(&compiled.sources, &diagnostics))?;
    (0..program.manifest.outputs.len())
        .map(|output| {
            let request = Request { time: TIME, output, ..Request::new([SIDE, SIDE]) };
            let mut scene = gpu.prepare(&program, &tables, output).map_err(|error| error.to_string())?;
            scene.render(&request, &|_| {}).map_err(|error| error.to_string().into())
        })
        .collect()
}

/// Puts an entry point behind a function that reads bindings.
fn host_of_library(program: &mut Program) {
    let pass = program.passes.last_mut().expect("a pass");
    assert!(!pass.wgsl.contains("@fragment"), "{}", pass.wgsl);
    let manifest = &mut program.manifest;
    let name = manifest.passes.last().expect("a pass").entry_point.clone();
    let inputs: Vec<String> = manifest.inputs.iter().map(input).collect();
    let gradients: Vec<String> = manifest.gradients.iter().map(gradient).collect();
    let (_, head) = pass.wgsl.split_once(&format!("fn {name}(")).expect("the function");
    let (head, _) = head.split_once(')').expect("its arguments");
    let arguments = head.split_terminator(", ").map(|argument| match argument.split_once(": ") {
        Some(("in", structure)) => format!("{structure}({})", inputs.join(", ")),
        Some(("gradients", structure)) => format!("{structure}({})", gradients.join(", ")),
        _ => panic!("an argument of another name: {argument}"),
    });
    let inputs = arguments.collect::<Vec<_>>().join(", ");
    let outputs: Vec<String> = manifest.outputs.iter().map(|output| output.name.clone()).collect();
    let entry = entry_point(manifest, &format!("{name}({inputs})"), Some(&outputs));
    pass.wgsl.push_str(&entry);
}

/// Puts bindings and an entry point behind a function that reads its arguments alone.
fn host_of_functions(program: &mut Program) {
    let pass = program.passes.last_mut().expect("a pass");
    for sign in ["@", "var<", "global"] {
        assert!(!pass.wgsl.contains(sign), "{sign} in\n{}", pass.wgsl);
    }
    let manifest = &mut program.manifest;
    let described = manifest.passes.last().expect("a pass");
    let (name, call) = (described.entry_point.clone(), described.call.clone().expect("a call"));
    let mut text = bindings(manifest, &call.arguments);
    let arguments: Vec<String> = call.arguments.iter().map(|one| argument(manifest, one)).collect();
    let call_text = format!("{name}({})", arguments.join(", "));
    text += &entry_point(manifest, &call_text, call.members.as_deref());
    pass.wgsl.push_str(&text);
}

/// Declares what a host binds, and lays out the uniform block.
fn bindings(manifest: &mut Manifest, arguments: &[Argument]) -> String {
    let mut text = String::new();
    let mut size = manifest.params.iter().filter_map(|param| Some(param.offset? + bytes(param.ty))).max();
    for param in &mut manifest.params {
        if arguments.contains(&Argument::Param(param.name.clone())) && param.offset.is_none() {
            let align = [4, 8, 16, 16][usize::from(param.ty.width - 1)];
            let offset = u32::next_multiple_of(size.unwrap_or(0), align);
            param.offset = Some(offset);
            size = Some(offset + bytes(param.ty));
        }
    }
    let mut params: Vec<&Param> = manifest.params.iter().filter(|param| param.offset.is_some()).collect();
    params.sort_by_key(|param| param.offset);
    if let Some(size) = size {
        let (group, binding) = manifest.uniform.as_ref().map_or((0, 99), |old| (old.group, old.binding));
        let members: Vec<String> =
            params.iter().map(|param| format!("{}: {}", member(param), bound(param.ty))).collect();
        writeln!(text, "struct Host {{ {} }}", members.join(", ")).expect("text");
        writeln!(text, "@group({group}) @binding({binding}) var<uniform> host_params: Host;").expect("text");
        let size = size.next_multiple_of(16);
        manifest.uniform = Some(Uniform { name: "host_params".into(), group, binding, size });
    }
    for argument in arguments {
        if let Argument::Texture(resource, field) = argument {
            let texture = texture(manifest, *resource, field);
            let (name, ty, group, binding) =
                (&texture.name, texture_type(texture), texture.group, texture.binding);
            writeln!(text, "@group({group}) @binding({binding}) var {name}: {ty};").expect("text");
            if let Some(sampler) = &texture.sampler {
                let (name, group, binding) = (&sampler.name, sampler.group, sampler.binding);
                writeln!(text, "@group({group}) @binding({binding}) var {name}: sampler;").expect("text");
            }
        }
    }
    text
}

fn argument(manifest: &Manifest, argument: &Argument) -> String {
    match argument {
        Argument::Input(name) => {
            input(manifest.inputs.iter().find(|input| input.name == *name).expect("the input"))
        }
        Argument::Param(name) => {
            let param = manifest.params.iter().find(|param| param.name == *name).expect("the param");
            let zero = if param.ty.scalar == Scalar::Bool { " != 0u" } else { "" };
            format!("host_params.{}{zero}", member(param))
        }
        Argument::Gradient(name) => {
            gradient(manifest.gradients.iter().find(|one| one.name == *name).expect("the derivative"))
        }
        Argument::Texture(resource, field) => texture(manifest, *resource, field).name.clone(),
        Argument::Sampler(resource, field) => {
            texture(manifest, *resource, field).sampler.as_ref().expect("a sampler").name.clone()
        }
    }
}

/// An input as the host has it: a varying, or a constant if a draw shares it.
fn input(input: &Input) -> String {
    match (input.name.as_str(), input.ty.width) {
        ("time", _) => format!("{TIME}f"),
        ("instance", _) => "0i".into(),
        ("base", width) => format!("vec{width}<i32>()"),
        (name, _) => format!("in_{name}_"),
    }
}

/// A derivative as the host has it.
fn gradient(gradient: &Gradient) -> String {
    let axis = match gradient.axis {
        Axis::X => "x",
        Axis::Y => "y",
    };
    format!("dpd{axis}(in_{}_)", gradient.input)
}

/// A fragment entry point that makes a call and widens each output; tells the manifest of it.
fn entry_point(manifest: &mut Manifest, call: &str, members: Option<&[String]>) -> String {
    manifest.inputs.retain(|one| input(one).starts_with("in_"));
    let mut varyings = Vec::new();
    for (location, one) in (0..).zip(&mut manifest.inputs) {
        one.source = Source::Varying(location);
        varyings.push(format!("@location({location}) {}: {}", input(one), wgsl(one.ty)));
    }
    let (mut targets, mut values) = (Vec::new(), Vec::new());
    for (i, output) in manifest.outputs.iter().enumerate() {
        targets.push(format!("@location({}) target{i}: vec4<f32>", output.location));
        let value = members.map_or("result".to_owned(), |members| format!("result.{}", members[i]));
        values.push(widened(&value, output.ty));
    }
    manifest.form = Form::Complete;
    manifest.passes.last_mut().expect("a pass").entry_point = "host".into();
    format!(
        "struct Targets {{ {} }}\n@fragment fn host({}) -> Targets {{\n    let result = {call};\n    return Targets({});\n}}\n",
        targets.join(", "),
        varyings.join(", "),
        values.join(", "),
    )
}

fn widened(value: &str, ty: Type) -> String {
    let floats = wgsl(Type { scalar: Scalar::Float, ..ty });
    let value = format!("{floats}({value})");
    match ty.width {
        1 => format!("vec4<f32>({value}, {value}, {value}, 1.0)"),
        2 => format!("vec4<f32>({value}, 0.0, 1.0)"),
        3 => format!("vec4<f32>({value}, 1.0)"),
        _ => value,
    }
}

fn wgsl(ty: Type) -> String {
    let scalar = match ty.scalar {
        Scalar::Float => "f32",
        Scalar::Int => "i32",
        Scalar::Bool => "bool",
    };
    if ty.width == 1 { scalar.into() } else { format!("vec{}<{scalar}>", ty.width) }
}

/// The type in the uniform block.
fn bound(ty: Type) -> String {
    if ty.scalar == Scalar::Bool { "u32".into() } else { wgsl(ty) }
}

fn bytes(ty: Type) -> u32 {
    4 * u32::from(ty.width)
}

fn member(param: &Param) -> String {
    format!("param_{}_", param.name.replace('.', "_"))
}

fn texture<'m>(manifest: &'m Manifest, resource: u32, field: &str) -> &'m Texture {
    let textures = &manifest.resources[resource as usize].textures;
    textures.iter().find(|texture| texture.field == field).expect("the texture")
}

fn texture_type(texture: &Texture) -> String {
    let dimension = match texture.view {
        ViewDimension::D2 => "2d",
        ViewDimension::D2Array => "2d_array",
        ViewDimension::D3 => "3d",
    };
    let texel = if texture.sample == SampleKind::Int { "i32" } else { "f32" };
    format!("texture_{dimension}<{texel}>")
}
