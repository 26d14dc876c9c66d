//! The texgraph compiler: a texture graph written as text becomes a shader and its manifest.
//!
//! ```text
//! text ──module──▶ modules ──check──▶ graph ──pass──▶ smaller graph ──lower──▶ naga ──emit──▶ WGSL
//!                                                        └──contract──▶ manifest
//! ```
//!
//! [`compile`] reads as that picture. No file is opened here: a host hands text in through a
//! [`module::Loader`], and gets back plain data.

mod advice;
mod ahead;
mod check;
pub mod color;
pub mod contract;
pub mod cost;
pub mod diagnostic;
pub mod diagram;
pub mod emit;
pub mod graph;
mod input;
pub mod intrinsic;
pub mod library;
pub mod lower;
pub mod manifest;
pub mod module;
mod naming;
pub mod pass;
pub mod plane;
pub mod profile;
pub mod resource;
mod tiling;

pub use diagnostic::Diagnostic;
pub use library::Library;
pub use manifest::{Form, Gradients, Manifest};
pub use plane::Plane;
pub use profile::Profile;

use crate::ahead::Ahead;
use crate::check::Checker;
use crate::diagnostic::{Place, limits};
use crate::graph::{Graph, PassGraph};
use crate::module::{Loader, Modules, Sources};

/// What to compile, and how to wrap it.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The texture; the file's first when none. A node's name means the node on its own, its inputs
    /// fed from the place; `name.wire` means a wire inside a texture or node.
    pub texture: Option<String>,
    /// The outputs wanted; all when none. Work that only others need is left out.
    pub outputs: Option<Vec<String>>,
    /// How the shader is wrapped.
    pub form: Form,
    /// Where screen derivatives come from. Bakes take their own.
    pub gradients: Gradients,
    /// The alpha of `color` below which the entry point of the complete form discards a pixel, for
    /// hosts that test alpha instead of blending.
    pub discard_below: Option<f32>,
    /// `@group` of everything that is bound.
    pub group: u32,
    /// The first `@binding`; the others follow.
    pub first_binding: u32,
    /// The host whose limits are kept; its bindings are not taken over.
    pub profile: Profile,
    /// The texture on the ground instead of in a flat picture; the complete form then takes `uv` as
    /// the place in the picture.
    pub plane: Option<Plane>,
    /// Every level of detail is worked out in the shader, by the definition, in place of the driver's
    /// own: the same picture on every adapter, and on the CPU, for some more arithmetic.
    pub exact_levels: bool,
}

impl Default for Options {
    fn default() -> Options {
        Options {
            texture: None,
            outputs: None,
            form: Form::Complete,
            gradients: Gradients::Derive,
            discard_below: None,
            group: 0,
            first_binding: 0,
            profile: Profile::Webgpu,
            plane: None,
            exact_levels: false,
        }
    }
}

/// A compiled texture: bakes, each after those it reads, then the texture itself.
#[derive(Clone, Debug)]
pub struct Program {
    /// At least one; as many as the manifest's, in the same order. The last is the texture.
    pub passes: Vec<Pass>,
    /// What a host must allocate, set and draw.
    pub manifest: Manifest,
}

/// One shader of a program.
#[derive(Clone, Debug)]
pub struct Pass {
    /// What it computes, after all passes over the graph; the CPU renderer evaluates this. The
    /// params, resources and views are those of the whole program.
    pub graph: Graph,
    /// The shader.
    pub wgsl: String,
}

impl Program {
    /// The texture itself: the last pass.
    ///
    /// # Panics
    /// The program was put together without a pass.
    pub fn texture(&self) -> &Pass {
        self.passes.last().unwrap_or_else(|| panic!("a program has a pass"))
    }
}

/// What is wrong with a program, and the texts to show it in.
#[derive(Clone, Debug)]
pub struct Failure {
    /// All texts that places point into.
    pub sources: Sources,
    /// All errors, in source order.
    pub diagnostics: Vec<Diagnostic>,
}

/// What a file that is right makes one think of.
#[derive(Clone, Debug)]
pub struct Checked {
    /// All texts that places point into.
    pub sources: Sources,
    /// What is likely not meant so, in source order.
    pub warnings: Vec<Diagnostic>,
}

/// A program with the texts its places point into.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The program.
    pub program: Program,
    /// All texts.
    pub sources: Sources,
}

/// Compiles one texture of a file.
///
/// # Errors
/// Every error of the file and what it imports, as far as the texture needs it.
pub fn compile(
    library: &Library,
    main: &str,
    loader: &dyn Loader,
    options: &Options,
) -> Result<Compiled, Failure> {
    let modules = load(library, main, loader)?;
    let fail = |diagnostics| Failure { sources: modules.sources.clone(), diagnostics };
    let ahead = library.ahead();
    let Planned { graphs, manifest } = planned(library, &ahead, &modules, options).map_err(fail)?;
    let mut passes = Vec::new();
    for (i, PassGraph { graph, .. }) in graphs.into_iter().enumerate() {
        let manifest = contract::of_pass(&manifest, i);
        let lowered = if options.exact_levels {
            lower::lower(&pass::share_level::everywhere(graph.clone()), &manifest, &lower::Objects::default())
        } else {
            lower::lower(&graph, &manifest, &ahead.objects)
        };
        let wgsl = emit::wgsl(&lowered).map_err(|why| fail(vec![limits::bug(main_place(&modules), &why)]))?;
        passes.push(Pass { graph, wgsl });
    }
    Ok(Compiled { program: Program { passes, manifest }, sources: modules.sources })
}

/// Checks a whole file: every texture, every node, and what it imports.
///
/// # Errors
/// Every error, in source order.
pub fn check(library: &Library, main: &str, loader: &dyn Loader) -> Result<Checked, Failure> {
    let modules = load(library, main, loader)?;
    let ahead = Ahead::default();
    let mut checker = Checker::new(library, &ahead, &modules.modules);
    checker.declare();
    checker.everything();
    let warnings = checker.take_warnings();
    let diagnostics = advice::advise(&modules, checker.into_diagnostics());
    if diagnostics.is_empty() {
        Ok(Checked { sources: modules.sources, warnings })
    } else {
        Err(Failure { sources: modules.sources, diagnostics })
    }
}

/// The names of a file's textures, in source order.
///
/// # Errors
/// The file can't be read or parsed.
pub fn textures(library: &Library, main: &str, loader: &dyn Loader) -> Result<Vec<String>, Failure> {
    let modules = load(library, main, loader)?;
    let main = modules.modules.last().map(|module| check::textures(&module.tree));
    Ok(main.unwrap_or_default().into_iter().map(str::to_owned).collect())
}

fn load(library: &Library, main: &str, loader: &dyn Loader) -> Result<Modules, Failure> {
    module::load(main, loader, library).map_err(|(sources, diagnostics)| Failure { sources, diagnostics })
}

fn main_place(modules: &Modules) -> Place {
    Place { file: modules.modules.last().map_or(0, |module| module.file), ..Place::default() }
}

/// Holds every texture of a file against the limits of a host, in the library form. What else is
/// wrong with them is not looked for: see [`check`].
///
/// # Errors
/// Every limit that is passed, in source order.
pub fn check_profile(
    library: &Library,
    main: &str,
    loader: &dyn Loader,
    profile: Profile,
) -> Result<(), Failure> {
    let modules = load(library, main, loader)?;
    let tree = modules.modules.last().map(|module| &module.tree);
    let ahead = library.ahead();
    let mut diagnostics = Vec::new();
    for texture in tree.map(|tree| check::textures(tree)).unwrap_or_default() {
        let texture = Some(texture.to_owned());
        let options = Options { texture, form: Form::Library, profile, ..Options::default() };
        diagnostics.extend(planned(library, &ahead, &modules, &options).err().unwrap_or_default());
    }
    diagnostics.sort_by_key(|diagnostic| (diagnostic.place, diagnostic.code));
    // Textures share bakes, and with them their errors.
    diagnostics.dedup();
    if diagnostics.is_empty() { Ok(()) } else { Err(Failure { sources: modules.sources, diagnostics }) }
}

/// A texture on its way to shaders.
struct Planned {
    /// After all passes: bakes, then the texture.
    graphs: Vec<PassGraph>,
    /// What a host must allocate, within its limits.
    manifest: Manifest,
}

/// All of compiling but the shaders.
fn planned(
    library: &Library,
    ahead: &Ahead,
    modules: &Modules,
    options: &Options,
) -> Result<Planned, Vec<Diagnostic>> {
    let checked = checked(library, ahead, modules, options);
    let Graphs { graphs, label, period, head } = checked.map_err(|found| advice::advise(modules, found))?;
    let optimised = graphs.into_iter().map(|PassGraph { graph, bake }| {
        let gradients = if bake.is_some() { Gradients::Derive } else { options.gradients };
        PassGraph { graph: pass::run(graph, &ahead.finished, gradients), bake }
    });
    let graphs: Vec<PassGraph> = optimised.collect();
    // In perspective nothing repeats.
    let tiles = period.filter(|_| options.plane.is_none());
    let manifest = Manifest { tiles, ..contract::manifest(&graphs, &label, options) };
    let passed = graphs.last().map(|last| profile::check(options.profile, &manifest, &last.graph, head));
    match passed.unwrap_or_default() {
        passed if passed.is_empty() => Ok(Planned { graphs, manifest }),
        passed => Err(passed),
    }
}

/// A texture that is right.
struct Graphs {
    /// Bakes, then the texture.
    graphs: Vec<PassGraph>,
    /// Its documentation.
    label: String,
    /// The period that it was proved to have.
    period: Option<[f32; 2]>,
    /// Its name in its file.
    head: Place,
}

/// The graphs of the chosen texture and the bakes before it.
fn checked(
    library: &Library,
    ahead: &Ahead,
    modules: &Modules,
    options: &Options,
) -> Result<Graphs, Vec<Diagnostic>> {
    let mut checker = Checker::new(library, ahead, &modules.modules);
    checker.declare();
    let key = checker.texture(options.texture.as_deref());
    library.note(checker.called());
    let (true, Some(key)) = (checker.is_fine(), key) else {
        let diagnostics = checker.into_diagnostics();
        let silent = diagnostics.is_empty();
        let bug = limits::bug(main_place(modules), "compiling stopped without saying why");
        return Err(if silent { vec![bug] } else { diagnostics });
    };
    let label = checker.doc(&key);
    let (period, head) = (checker.period(&key), checker.head_of(&key));
    let Some(mut graphs) = checker.into_graphs(&key) else {
        return Err(vec![limits::bug(main_place(modules), "a checked texture has no graph")]);
    };
    if let Some(last) = graphs.last_mut() {
        choose_outputs(&mut last.graph, options, head).map_err(|diagnostic| vec![diagnostic])?;
        options.plane.iter().for_each(|plane| plane::seen(&mut last.graph, *plane));
    }
    Ok(Graphs { graphs, label, period, head })
}

/// Leaves only the outputs that are wanted.
fn choose_outputs(graph: &mut Graph, options: &Options, place: Place) -> Result<(), Diagnostic> {
    let (Some(wanted), Some(entry)) = (&options.outputs, graph.functions.last_mut()) else { return Ok(()) };
    for name in wanted {
        if !entry.outputs.iter().any(|(slot, _)| slot.name == *name) {
            let known: Vec<String> =
                entry.outputs.iter().map(|(slot, _)| format!("`{}`", slot.name)).collect();
            let near =
                diagnostic::names::nearest(name, entry.outputs.iter().map(|(slot, _)| slot.name.as_str()));
            return Err(limits::no_such_texture_output(place, name, &known.join(", "), near));
        }
    }
    entry.outputs.retain(|(slot, _)| wanted.iter().any(|name| slot.name == *name));
    Ok(())
}
