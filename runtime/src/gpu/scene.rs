//! A program ready to render pictures: its textures, its bakes, and the texture itself.

use super::Gpu;
use super::bindings::uniform_buffer;
use super::drawing::Drawing;
use super::texture::Textures;
use crate::bake::{self, Bake};
use crate::pass;
use crate::picture::Picture;
use crate::progress::Progress;
use crate::render::{RenderError, Request};
use crate::resource::Tables;
use crate::resource::positions::Write;
use crate::settings::Settings;
use crate::uniform;
use texgraph_compiler::Program;

/// A program's textures on the device, and the pipelines of its bakes and of one of its outputs. It
/// keeps the bakes from one picture to the next.
pub struct Scene<'a> {
    gpu: &'a Gpu,
    program: &'a Program,
    output: usize,
    textures: Textures,
    uniform: Option<wgpu::Buffer>,
    bakes: Vec<(Bake<'a>, Drawing<'a>)>,
    drawing: Drawing<'a>,
    drawn: u64,
}

impl<'a> Scene<'a> {
    pub(super) fn new(
        gpu: &'a Gpu,
        program: &'a Program,
        tables: &Tables,
        output: usize,
    ) -> Result<Scene<'a>, RenderError> {
        let outputs = &program.manifest.outputs;
        let location =
            outputs.get(output).ok_or(RenderError::NoOutput { output, outputs: outputs.len() })?.location;
        let bakes = bake::all(program, tables)?;
        let (textures, uniform) = gpu.guarded(|| {
            let textures = Textures::upload(gpu, &program.manifest, &bakes, tables)?;
            Ok((textures, uniform_buffer(gpu, &program.manifest)))
        })?;
        let drawing = Drawing::new(gpu, &pass::texture(program)?, location, &textures, uniform.as_ref())?;
        let with_drawing = |bake: Bake<'a>| {
            let drawing = Drawing::new(gpu, &bake.pass, 0, &textures, uniform.as_ref());
            let drawing = drawing.map_err(|error| bake.failed(error))?;
            Ok((bake, drawing))
        };
        let bakes = bakes.into_iter().map(with_drawing).collect::<Result<_, _>>()?;
        Ok(Scene { gpu, program, output, textures, uniform, bakes, drawing, drawn: 0 })
    }

    /// Renders a picture of the output that the scene was prepared for; the request's own is not
    /// looked at. Bakes are drawn first, those that this picture's params change. `progress` hears
    /// shares from 0 to 1.
    ///
    /// # Errors
    /// The request can't be met, or the driver fails.
    pub fn render(
        &mut self,
        request: &Request,
        progress: &(dyn Fn(f32) + Sync),
    ) -> Result<Picture, RenderError> {
        let request = Request { output: self.output, ..request.clone() };
        let mut picture = request.picture(self.program)?;
        if let Some(buffer) = &self.uniform {
            let bytes = uniform::block(&self.program.manifest, &request.settings, &request.draw());
            self.gpu.guarded(|| {
                self.gpu.queue.write_buffer(buffer, 0, &bytes);
                Ok(())
            })?;
        }
        let stale = self.bakes.iter().map(|(bake, _)| bake).filter(|bake| bake.is_stale(&request.settings));
        let mut progress = Progress::new(progress, stale.map(Bake::size).chain([request.size]));
        self.refresh(&request.settings, &mut progress)?;
        self.drawing.draw(self.gpu, &request, &mut picture, &progress.next(request.size))?;
        Ok(picture)
    }

    /// Writes texels of a field of a resource, an index into the manifest's `resources`. Bakes that
    /// read it are drawn again with the next picture.
    ///
    /// # Errors
    /// The program reads no such texture, or a write lies outside it.
    pub fn write(&mut self, resource: usize, field: &str, writes: &[Write<'_>]) -> Result<(), RenderError> {
        self.gpu.guarded(|| {
            let written = self.textures.patch(self.gpu, resource, field, writes);
            written.ok_or_else(|| RenderError::no_table(&self.program.manifest, resource, field))
        })?;
        bake::forget(self.bakes.iter_mut().map(|(bake, _)| bake), resource);
        Ok(())
    }

    /// How many bakes have been drawn for all pictures so far.
    pub fn bakes_drawn(&self) -> u64 {
        self.drawn
    }

    /// Draws the bakes that are not as these params want them.
    fn refresh(&mut self, settings: &Settings, progress: &mut Progress<'_>) -> Result<(), RenderError> {
        for (bake, drawing) in &mut self.bakes {
            if !bake.is_stale(settings) {
                continue;
            }
            let request = bake.request(settings);
            let drawn = request.blank().and_then(|mut picture| {
                drawing.draw(self.gpu, &request, &mut picture, &progress.next(request.size))?;
                self.gpu.guarded(|| self.textures.replace(self.gpu, bake, &bake.texels(&picture)))
            });
            drawn.map_err(|error| bake.failed(error))?;
            bake.keep(settings);
            self.drawn += 1;
        }
        Ok(())
    }
}
