//! `texgraph render`: one output of a texture as a PNG picture.
//!
//! ```text
//! FILE:TEXTURE ─compile─▶ program ─load─▶ tables ─render─▶ picture ─▶ OUT.png
//! ```

use crate::args::{Backend, Render, View};
use crate::output;
use crate::problem::Problem;
use crate::program::{self, Program};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use texgraph_compiler::{Compiled, Options, Plane};
use texgraph_runtime::render::{self, Renderer, Request};
use texgraph_runtime::resource;
use texgraph_runtime::settings::Settings;

/// Renders shorter than this show no progress: a bar that only flashes is a nuisance.
const PATIENCE: Duration = Duration::from_millis(700);

/// What a flat picture shows of `uv`, and where in a picture a pixel of the plane is.
const UNIT_SQUARE: [f64; 4] = [0.0, 0.0, 1.0, 1.0];

/// Renders a texture.
///
/// # Errors
/// Anything is wrong; the old picture is then as it was.
pub fn run(args: &Render) -> Result<(), Problem> {
    output::try_png(&args.output_file)?;
    let plane = plane(args)?;
    let (file, texture) = program::split(&args.file);
    let library = program::library()?;
    let program = Program::open(&library, &file, args.common.allow_outside)?;
    // The same picture on every adapter.
    let options = Options { texture, plane, exact_levels: true, ..Options::default() };
    let mut compiled = compile(&program, options, args.output.as_deref())?;
    let request = request(args, &compiled)?;
    let mut tables = program.load(&mut compiled)?;
    let renderer = Renderer::new(match args.backend {
        Backend::Auto => render::Backend::Auto,
        Backend::Gpu => render::Backend::Gpu,
        Backend::Cpu => render::Backend::Cpu,
    })?;
    if args.verbose {
        let _ = writeln!(std::io::stderr(), "rendering on: {}", renderer.name());
    }
    if renderer.reads_blocks() {
        resource::compress(&mut compiled.program.manifest, &mut tables);
    }
    let progress = Progress::new();
    let picture = renderer.render(&compiled.program, &tables, &request, &|share| progress.hear(share))?;
    progress.bar.finish_and_clear();
    output::write(&[(args.output_file.clone(), picture.to_png()?)])
}

/// The camera, unless the view is flat.
fn plane(args: &Render) -> Result<Option<Plane>, Problem> {
    match args.view {
        View::Flat => Ok(None),
        View::Plane if args.region != UNIT_SQUARE => {
            Err(Problem::Usage("--region is for the flat view; the plane takes --repeat".into()))
        }
        View::Plane => {
            let [width, height] = args.size.map(|side| side as f32);
            Ok(Some(Plane { repeat: args.repeat, aspect: width / height }))
        }
    }
}

/// Compiles the wanted output alone. Which outputs there are is known only after compiling, so
/// without a name that happens twice: it takes milliseconds.
fn compile(program: &Program<'_>, mut options: Options, output: Option<&str>) -> Result<Compiled, Problem> {
    let wanted = |output: &str| Some(vec![output.to_owned()]);
    options.outputs = output.and_then(wanted);
    let compiled = program.compile(&options)?;
    let outputs = &compiled.program.manifest.outputs;
    if outputs.len() <= 1 {
        return Ok(compiled);
    }
    let chosen = outputs.iter().find(|output| output.name == "color").or(outputs.first());
    options.outputs = chosen.and_then(|output| wanted(&output.name));
    Ok(program.compile(&options)?)
}

fn request(args: &Render, compiled: &Compiled) -> Result<Request, Problem> {
    let mut settings = Settings::new();
    for setting in &args.set {
        settings.parse(&compiled.program.manifest, setting)?;
    }
    let region = match args.view {
        View::Flat => args.region.map(|bound| bound * f64::from(args.repeat)),
        // The camera takes the place in the picture.
        View::Plane => UNIT_SQUARE,
    };
    Ok(Request { size: args.size, region, time: args.time, settings, output: 0 })
}

/// A bar that appears when the render takes long, and only on a terminal.
struct Progress {
    bar: ProgressBar,
    start: Instant,
    is_shown: AtomicBool,
}

impl Progress {
    fn new() -> Progress {
        let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::hidden());
        // The default style is a bar too, so a template that is refused costs looks only.
        if let Ok(style) = ProgressStyle::with_template("rendering {wide_bar} {percent:>3} % {eta:>4}") {
            bar.set_style(style);
        }
        Progress { bar, start: Instant::now(), is_shown: AtomicBool::new(false) }
    }

    /// Hears a share from 0 to 1, from any thread.
    fn hear(&self, share: f32) {
        if self.start.elapsed() > PATIENCE && !self.is_shown.swap(true, Ordering::Relaxed) {
            // Standard error that is no terminal stays silent by itself.
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_position((share.clamp(0.0, 1.0) * 1000.0) as u64);
    }
}
