//! The CPU renderer: evaluates a program's graph at every pixel.
//!
//! The twin of the GPU: it needs no driver, defines what a program is worth, and is what the GPU's
//! pictures are compared with. A plan is made once for a picture: which operations the wanted
//! output needs, and what those are worth that no pixel changes. A machine then runs the plan
//! for a pixel; rows are spread over all cores. A version that runs batches of pixels can take the
//! place of the machine alone.

mod demand;
mod evaluate;
mod machine;
mod plan;
mod planner;
mod sample;
mod texture;

use crate::bake::{self, Bake};
use crate::pass::{self, Pass};
use crate::picture::Picture;
use crate::progress::Progress;
use crate::render::{RenderError, Request};
use crate::resource::Tables;
use crate::settings::Settings;
use machine::Machine;
use plan::{Plan, Source};
use rayon::iter::{IndexedParallelIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;
use std::sync::atomic::{AtomicUsize, Ordering};
use texgraph_compiler::Program;
use texgraph_compiler::graph::{Constant, Scalar};
use texture::Texture;

/// Renders a program's output. `progress` hears shares from 0 to 1, from any thread.
///
/// # Errors
/// The request can't be met, a table is missing, or a pixel takes too much work.
pub fn render(
    program: &Program,
    tables: &Tables,
    request: &Request,
    progress: &(dyn Fn(f32) + Sync),
) -> Result<Picture, RenderError> {
    Scene::new(program, tables, request.output)?.render(request, progress)
}

/// A program with its textures decoded, ready to render one of its outputs. It keeps the program's
/// bakes from one picture to the next.
pub struct Scene<'a> {
    program: &'a Program,
    pass: Pass<'a>,
    output: usize,
    /// Of each view of the graph.
    textures: Vec<Texture>,
    bakes: Vec<Bake<'a>>,
    drawn: u64,
}

impl<'a> Scene<'a> {
    /// Decodes a program's textures.
    ///
    /// # Errors
    /// A table is missing.
    pub fn new(program: &'a Program, tables: &Tables, output: usize) -> Result<Scene<'a>, RenderError> {
        let pass = pass::texture(program)?;
        let bakes = bake::all(program, tables)?;
        let textures = texture::decode_all(&pass, &bakes, tables)?;
        Ok(Scene { program, pass, output, textures, bakes, drawn: 0 })
    }

    /// Renders a picture of the output that the scene was made for; the request's own is not looked
    /// at. `progress` hears shares from 0 to 1, from any thread.
    ///
    /// # Errors
    /// The request can't be met, or a pixel takes too much work.
    pub fn render(
        &mut self,
        request: &Request,
        progress: &(dyn Fn(f32) + Sync),
    ) -> Result<Picture, RenderError> {
        let request = Request { output: self.output, ..request.clone() };
        let mut picture = request.picture(self.program)?;
        let stale = self.bakes.iter().filter(|bake| bake.is_stale(&request.settings)).map(Bake::size);
        let mut progress = Progress::new(progress, stale.chain([request.size]));
        for n in 0..self.bakes.len() {
            if self.bakes[n].is_stale(&request.settings) {
                self.bake(n, &request.settings, &mut progress)?;
            }
        }
        let progress = progress.next(request.size);
        draw(&self.pass, &self.textures, &request, &mut picture, &progress)?;
        Ok(picture)
    }

    /// How many bakes have been drawn for all pictures so far.
    pub fn bakes_drawn(&self) -> u64 {
        self.drawn
    }

    /// Draws the bakes that depend on no param: the resource, the field and the texels of each.
    pub(crate) fn fixed_bakes(&mut self) -> Result<Vec<(usize, String, Vec<u8>)>, RenderError> {
        let (mut made, nobody) = (Vec::new(), |_: f32| {});
        let fixed: Vec<usize> = (0..self.bakes.len()).filter(|n| self.bakes[*n].is_fixed()).collect();
        let mut progress = Progress::new(&nobody, fixed.iter().map(|n| self.bakes[*n].size()));
        for n in fixed {
            let texels = self.bake(n, &Settings::new(), &mut progress)?;
            made.push((self.bakes[n].resource, self.bakes[n].texture.field.clone(), texels));
        }
        Ok(made)
    }

    /// Draws a bake into its texture; its texels.
    fn bake(
        &mut self,
        n: usize,
        settings: &Settings,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<u8>, RenderError> {
        let bake = &mut self.bakes[n];
        let request = bake.request(settings);
        let drawn = request.blank().and_then(|mut picture| {
            let progress = progress.next(request.size);
            draw(&bake.pass, &self.textures, &request, &mut picture, &progress)?;
            Ok(picture)
        });
        let texels = bake.texels(&drawn.map_err(|error| bake.failed(error))?);
        texture::replace(&mut self.textures, bake, &texels);
        bake.keep(settings);
        self.drawn += 1;
        Ok(texels)
    }
}

/// Draws one output of a pass into a blank picture.
fn draw(
    pass: &Pass<'_>,
    textures: &[Texture],
    request: &Request,
    picture: &mut Picture,
    progress: &(dyn Fn(f32) + Sync),
) -> Result<(), RenderError> {
    let plan = Plan::new(pass, request, textures)?;
    let [width, height] = request.size.map(|side| side as usize);
    let done = AtomicUsize::new(0);
    let rows = picture.pixels.par_chunks_mut(width).enumerate();
    rows.for_each_init(
        || Machine::new(&plan.functions, textures),
        |machine, (y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = shade(&plan, machine, x, y);
            }
            progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f32 / height as f32);
        },
    );
    Ok(())
}

/// One pixel's output.
fn shade(plan: &Plan, machine: &mut Machine<'_>, x: usize, y: usize) -> [f32; 4] {
    let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
    let inputs = plan.inputs.iter().map(|(source, width)| {
        let components = match source {
            Source::Value(slope) => slope.at(x, y),
            Source::Right(slope) => slope.right(),
            Source::Down(slope) => slope.down(),
        };
        Constant::floats(&components[..usize::from(*width)])
    });
    let outputs = machine.run(plan.entry, inputs);
    outputs.get(plan.output).map_or([0.0; 4], widen)
}

/// An output as four floats, as the manifest's `Output` says.
fn widen(value: &Constant) -> [f32; 4] {
    let component = |i: usize| match value.scalar() {
        Scalar::Float => value.float(i),
        Scalar::Int => value.int(i) as f32,
        Scalar::Bool => f32::from(u8::from(value.bool(i))),
    };
    match value.width() {
        1 => [component(0), component(0), component(0), 1.0],
        2 => [component(0), component(1), 0.0, 1.0],
        3 => [component(0), component(1), component(2), 1.0],
        _ => [component(0), component(1), component(2), component(3)],
    }
}
