//! What must hold for any text, and for one that should check.

use super::shape::without_places;
use texgraph_compiler::diagnostic::render;
use texgraph_compiler::module::Loader;
use texgraph_compiler::{Failure, Form, Library, Options, Pass, Program, check, compile, textures};
use texgraph_grammar::{format, parse};

/// The code of what is our bug: naga refused what was made of a program that checked.
const OURS: &str = "E0999";

/// A shader that a program became.
pub struct Shader {
    /// The texture and the form.
    pub name: String,
    /// The shader.
    pub wgsl: String,
    /// The manifest as RON.
    pub manifest: String,
}

/// What became of a text.
pub enum Outcome {
    /// It is refused; the page says why.
    Refused(String),
    /// It checks. Its shaders, as far as the textures keep to the bounds.
    Shaders(Vec<Shader>),
}

/// How much is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// Everything.
    Whole,
    /// Most: parsing is what takes long, so a text is parsed four times and not nine.
    Most,
}

/// A text that parses is formatted to a text with the same tree (and that one to itself). Whether
/// it parses.
///
/// # Errors
/// What differs.
pub fn formats(text: &str, depth: Depth) -> Result<bool, String> {
    let Ok(tree) = parse(text) else {
        let formats = depth == Depth::Whole && format(text).is_ok();
        return if formats { Err("formats what does not parse".to_owned()) } else { Ok(false) };
    };
    let once = format(text).map_err(|errors| format!("parses, but does not format: {errors:?}"))?;
    let again = parse(&once).map_err(|errors| format!("formatted, it does not parse: {errors:?}\n{once}"))?;
    let kinds = |file: &texgraph_grammar::syntax::File| {
        let mut kinds: Vec<String> = file.comments.iter().map(|c| format!("{:?}", c.kind)).collect();
        kinds.sort();
        kinds
    };
    if kinds(&tree) != kinds(&again) {
        return Err(format!("comments were lost:\n{once}"));
    }
    let [mut before, mut after] = [tree, again].map(without_places);
    (before.comments, after.comments) = (Vec::new(), Vec::new());
    if before != after {
        return Err(format!("formatted, it has another tree:\n{once}"));
    }
    if depth == Depth::Whole && format(&once).as_deref() != Ok(once.as_str()) {
        return Err(format!("formatted twice, it differs:\n{once}"));
    }
    Ok(true)
}

/// Checks a program, and compiles every texture in every form; where not everything is looked at, in
/// the complete form, and the first texture in one more. With `strict` an error is a failure; else
/// only what says that the compiler is at fault.
///
/// # Errors
/// What is wrong, with its page.
pub fn compiles(
    library: &Library,
    main: &str,
    loader: &dyn Loader,
    strict: bool,
    depth: Depth,
) -> Result<Outcome, String> {
    if let Err(failure) = check(library, main, loader) {
        let page = page(&failure);
        return if strict { Err(page) } else { Ok(Outcome::Refused(page)) };
    }
    let textures = textures(library, main, loader).map_err(|failure| page(&failure))?;
    let mut shaders = Vec::new();
    for (i, texture) in textures.iter().enumerate() {
        // Either, by and by.
        let other = if texture.len() % 2 == 0 { Form::Library } else { Form::Functions };
        let forms = match depth {
            Depth::Whole => vec![Form::Complete, Form::Library, Form::Functions],
            Depth::Most if i == 0 => vec![Form::Complete, other],
            Depth::Most => vec![Form::Complete],
        };
        for form in forms {
            let options = Options { texture: Some(texture.clone()), form, ..Options::default() };
            match compile(library, main, loader, &options) {
                Ok(compiled) => shaders.extend(shaders_of(&compiled.program, texture, form)),
                Err(failure) => {
                    let ours = failure.diagnostics.iter().any(|d| d.code == OURS);
                    if strict || ours {
                        let page = page(&failure);
                        return Err(format!("checks, but {texture} does not compile:\n{page}"));
                    }
                }
            }
        }
    }
    shaders.iter().try_for_each(reads_back)?;
    Ok(Outcome::Shaders(shaders))
}

fn shaders_of(program: &Program, texture: &str, form: Form) -> Vec<Shader> {
    let shader = |(i, pass): (usize, &Pass)| Shader {
        name: format!("{texture}.{form:?}.{i}"),
        wgsl: pass.wgsl.clone(),
        manifest: program.manifest.to_ron(),
    };
    program.passes.iter().enumerate().map(shader).collect()
}

/// naga's own front end reads the shader, and finds nothing wrong with it.
fn reads_back(shader: &Shader) -> Result<(), String> {
    let Shader { name, wgsl, .. } = shader;
    let module = naga::front::wgsl::parse_str(wgsl)
        .map_err(|error| format!("{name}: naga can't read it: {}\n{wgsl}", error.emit_to_string(wgsl)))?;
    let flags = naga::valid::ValidationFlags::all();
    naga::valid::Validator::new(flags, naga::valid::Capabilities::empty())
        .validate(&module)
        .map_err(|error| format!("{name}: naga refuses it: {:?}\n{wgsl}", error.into_inner()))?;
    Ok(())
}

fn page(failure: &Failure) -> String {
    render::human(&failure.sources, &failure.diagnostics)
}
