//! The CPU renderer: evaluates a program's graph for batches of pixels.
//!
//! The twin of the GPU: it needs no driver, defines what a program is worth, and is what the GPU's
//! pictures are compared with. A plan is made once for a picture: the graph without what the wanted
//! output does not need becomes steps over registers, each one component of a value in 128 lanes;
//! what no pixel changes is computed while planning. A machine then runs the plan for 128 pixels at
//! a time: every step is a loop over lanes by the function that defines the row, so a pixel has the
//! same bits as a folded constant, whatever batch it is in. Batches are spread over all cores.
//!
//! ```text
//! graph ──remove_dead──▶ planner ──fused──▶ steps ──registers──▶ plan ──machine──▶ pixels
//! ```

mod draw;
mod fused;
mod inputs;
mod machine;
mod mask;
mod plan;
mod planner;
mod registers;
mod sample;
mod texture;

use crate::bake::{self, Bake};
use crate::pass::{self, Pass};
use crate::picture::{Content, Picture};
use crate::progress::Progress;
use crate::render::{RenderError, Request};
use crate::resource::Tables;
use crate::resource::positions::Write;
use crate::settings::Settings;
use draw::draw;
use texgraph_compiler::Program;
use texgraph_compiler::graph::Graph;
use texgraph_compiler::pass::remove_dead;
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
    /// Of the pass, what the output needs.
    graph: Graph,
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
        let graph = only(&pass.code.graph, output);
        Ok(Scene { program, pass, graph, output, textures, bakes, drawn: 0 })
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
        let content = request.content(self.program)?;
        request.check()?;
        let stale = self.bakes.iter().filter(|bake| bake.is_stale(&request.settings)).map(Bake::size);
        let mut progress = Progress::new(progress, stale.chain([request.size]));
        for n in 0..self.bakes.len() {
            if self.bakes[n].is_stale(&request.settings) {
                self.bake(n, &request.settings, &mut progress)?;
            }
        }
        let progress = progress.next(request.size);
        let pixels = draw(&self.pass, &self.graph, &self.textures, &request, &progress)?;
        Ok(Picture { size: request.size, pixels, content })
    }

    /// Writes texels of a field of a resource, an index into the manifest's `resources`. Bakes that
    /// read it are drawn again with the next picture.
    ///
    /// # Errors
    /// The program reads no such texture, or a write lies outside it.
    pub fn write(&mut self, resource: usize, field: &str, writes: &[Write<'_>]) -> Result<(), RenderError> {
        let views = self.pass.code.graph.views.iter().zip(&mut self.textures);
        let mut found = views
            .filter(|(view, _)| view.resource as usize == resource && view.field == field)
            .map(|(_, texture)| texture)
            .peekable();
        let is_there = found.peek().is_some();
        if !is_there || !found.all(|texture| writes.iter().all(|write| texture.patch(write).is_some())) {
            return Err(RenderError::no_table(&self.program.manifest, resource, field));
        }
        bake::forget(self.bakes.iter_mut(), resource);
        Ok(())
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
        let drawn = request.check().and_then(|()| {
            let graph = only(&bake.pass.code.graph, request.output);
            draw(&bake.pass, &graph, &self.textures, &request, &progress.next(request.size))
        });
        let pixels = drawn.map_err(|error| bake.failed(error))?;
        let texels = bake.texels(&Picture { size: request.size, pixels, content: Content::Data });
        texture::replace(&mut self.textures, bake, &texels);
        bake.keep(settings);
        self.drawn += 1;
        Ok(texels)
    }
}

/// The graph of a pass with only one of its outputs, and what that needs.
fn only(graph: &Graph, output: usize) -> Graph {
    let mut graph = graph.clone();
    if let Some(entry) = graph.functions.last_mut() {
        entry.outputs = entry.outputs.get(output).cloned().into_iter().collect();
    }
    remove_dead::run(graph)
}
