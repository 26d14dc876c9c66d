//! Rendering a texture to a picture, on a GPU or on the CPU: one request, one result.
//!
//! The picture is the flat view of the texture: a rectangle of `uv` fills it, the first row is at
//! the top, `v` grows downward, and each pixel is computed at its centre.
//!
//! ```text
//! Renderer::new ─▶ renderer.scene(program, tables, output) ─▶ scene.render(request), again and again
//! ```
//!
//! A [`Renderer`] is a device, a [`Scene`] a program on it. A scene keeps its textures and its
//! pipelines, and the bakes that no changed param touches: an animation makes one scene and renders
//! each frame with it. [`Renderer::render`] and [`render`] are for single pictures.

mod error;

pub use error::RenderError;

use crate::cpu;
#[cfg(feature = "gpu")]
use crate::gpu::{self, Gpu, Preference};
use crate::picture::{Content, Picture};
use crate::resource::Tables;
use crate::resource::positions::Write;
use crate::settings::Settings;
use crate::uniform::Draw;
use texgraph_compiler::Program;
use texgraph_compiler::manifest::{Output, Scalar};

/// The longest side of a picture, in pixels.
pub const MAX_SIDE: u32 = 32_768;

/// What to render.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Pixels across and down, 1 to [`MAX_SIDE`] each.
    pub size: [u32; 2],
    /// The rectangle of `uv` that fills the picture: x0, y0, x1, y1. Finite.
    pub region: [f64; 4],
    /// The input `time`, in seconds.
    pub time: f32,
    /// The params.
    pub settings: Settings,
    /// Which of the manifest's outputs.
    pub output: usize,
}

impl Request {
    /// The unit square in a picture of a size, time 0, defaults, the first output.
    pub fn new(size: [u32; 2]) -> Request {
        Request { size, region: [0.0, 0.0, 1.0, 1.0], time: 0.0, settings: Settings::new(), output: 0 }
    }

    /// The inputs that are the same for all pixels.
    pub fn draw(&self) -> Draw {
        Draw { time: self.time, ..Draw::default() }
    }

    /// A blank picture for a program's output.
    ///
    /// # Errors
    /// The request asks for what can't be, or for more than there is memory for.
    #[cfg(feature = "gpu")]
    pub(crate) fn picture(&self, program: &Program) -> Result<Picture, RenderError> {
        Ok(Picture { content: self.content(program)?, ..self.blank()? })
    }

    /// What the floats of the picture mean.
    ///
    /// # Errors
    /// The program has no such output.
    pub(crate) fn content(&self, program: &Program) -> Result<Content, RenderError> {
        let outputs = &program.manifest.outputs;
        let missing = RenderError::NoOutput { output: self.output, outputs: outputs.len() };
        outputs.get(self.output).map(content).ok_or(missing)
    }

    /// A blank picture of data.
    ///
    /// # Errors
    /// The request asks for what can't be, or for more than there is memory for.
    #[cfg(feature = "gpu")]
    pub(crate) fn blank(&self) -> Result<Picture, RenderError> {
        self.check()?;
        let count = self.size[0] as usize * self.size[1] as usize;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(count).map_err(|_| RenderError::Memory { size: self.size })?;
        pixels.resize(count, [0.0; 4]);
        Ok(Picture { size: self.size, pixels, content: Content::Data })
    }

    /// Looks at everything but the output.
    ///
    /// # Errors
    /// The request asks for what can't be.
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        if self.size.iter().any(|side| !(1..=MAX_SIDE).contains(side)) {
            return Err(RenderError::Size { size: self.size });
        }
        if !self.region.iter().all(|bound| bound.is_finite()) || !self.time.is_finite() {
            return Err(RenderError::NotFinite);
        }
        Ok(())
    }
}

/// What an output's floats mean: by its name where that is one that hosts know, else by its type.
fn content(output: &Output) -> Content {
    match (output.name.as_str(), output.ty.scalar, output.ty.width) {
        (_, Scalar::Int, _) => Content::Integer,
        (_, Scalar::Float, _) if output.is_color => Content::Color,
        ("normal", Scalar::Float, 3) => Content::Normal,
        ("emission", ..) => Content::Data,
        (_, Scalar::Float, 2..) => Content::Vector,
        _ => Content::Data,
    }
}

/// Where to render.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// A graphics card if there is one, else a software driver, else the CPU renderer.
    #[default]
    Auto,
    /// A graphics card or a software driver, or an error.
    Gpu,
    /// The CPU renderer.
    Cpu,
}

/// A place to render, made once and used many times: making a GPU ready takes half a second.
pub struct Renderer {
    #[cfg(feature = "gpu")]
    gpu: Option<Gpu>,
}

impl Renderer {
    /// Makes a backend ready.
    ///
    /// # Errors
    /// A GPU is asked for and there is none.
    #[cfg(feature = "gpu")]
    pub fn new(backend: Backend) -> Result<Renderer, RenderError> {
        let gpu = match backend {
            Backend::Auto => Gpu::new(Preference::Hardware).ok(),
            Backend::Gpu => Some(Gpu::new(Preference::Hardware)?),
            Backend::Cpu => None,
        };
        Ok(Renderer { gpu })
    }

    /// Makes a backend ready.
    ///
    /// # Errors
    /// A GPU is asked for: this build has none.
    #[cfg(not(feature = "gpu"))]
    pub fn new(backend: Backend) -> Result<Renderer, RenderError> {
        match backend {
            Backend::Auto | Backend::Cpu => Ok(Renderer {}),
            Backend::Gpu => {
                Err(RenderError::NoAdapter { reason: "texgraph was built without the feature `gpu`".into() })
            }
        }
    }

    /// What renders, in words: the adapter with its driver, or the CPU renderer.
    pub fn name(&self) -> String {
        #[cfg(feature = "gpu")]
        if let Some(gpu) = &self.gpu {
            return gpu.name();
        }
        "CPU renderer".to_string()
    }

    /// Whether [`crate::resource::compress`] is of use: whether a graphics card reads block-compressed
    /// textures. Software adapters do too, but decode BC7 anew for each sample, twenty times as slow.
    pub fn reads_blocks(&self) -> bool {
        #[cfg(feature = "gpu")]
        if let Some(gpu) = &self.gpu {
            return gpu.reads_blocks() && !gpu.is_software();
        }
        false
    }

    /// Makes a program's output ready to be rendered any number of times.
    ///
    /// # Errors
    /// There is no such output, a table is missing, or the GPU refuses the shader.
    pub fn scene<'a>(
        &'a self,
        program: &'a Program,
        tables: &Tables,
        output: usize,
    ) -> Result<Scene<'a>, RenderError> {
        #[cfg(feature = "gpu")]
        if let Some(gpu) = &self.gpu {
            return Ok(Scene::Gpu(Box::new(gpu.prepare(program, tables, output)?)));
        }
        Ok(Scene::Cpu(Box::new(cpu::Scene::new(program, tables, output)?)))
    }

    /// Renders one picture: [`Renderer::scene`], then [`Scene::render`].
    ///
    /// # Errors
    /// As these two.
    pub fn render(
        &self,
        program: &Program,
        tables: &Tables,
        request: &Request,
        progress: &(dyn Fn(f32) + Sync),
    ) -> Result<Picture, RenderError> {
        self.scene(program, tables, request.output)?.render(request, progress)
    }
}

/// A program's output on a renderer, with its textures and bakes.
pub enum Scene<'a> {
    /// On a GPU.
    #[cfg(feature = "gpu")]
    Gpu(Box<gpu::Scene<'a>>),
    /// On the CPU.
    Cpu(Box<cpu::Scene<'a>>),
}

impl Scene<'_> {
    /// Renders a picture of the output that the scene was made for; the request's own is not looked
    /// at. Bakes that depend on a param with a new value are drawn first, at the first picture all
    /// of them. `progress` hears shares from 0 to 1, from any thread.
    ///
    /// # Errors
    /// The request can't be met, a pixel takes too much work for the CPU, or the GPU fails. Other
    /// requests may be met after that.
    pub fn render(
        &mut self,
        request: &Request,
        progress: &(dyn Fn(f32) + Sync),
    ) -> Result<Picture, RenderError> {
        match self {
            #[cfg(feature = "gpu")]
            Scene::Gpu(scene) => scene.render(request, progress),
            Scene::Cpu(scene) => scene.render(request, progress),
        }
    }

    /// Writes texels of a field of a resource, an index into the manifest's `resources`: what a
    /// [`positions`](crate::resource::positions) map says has changed, in its field `cells`. Bakes that
    /// read it are drawn again with the next picture.
    ///
    /// # Errors
    /// The program reads no such texture, or a write lies outside it.
    pub fn write(&mut self, resource: usize, field: &str, writes: &[Write<'_>]) -> Result<(), RenderError> {
        match self {
            #[cfg(feature = "gpu")]
            Scene::Gpu(scene) => scene.write(resource, field, writes),
            Scene::Cpu(scene) => scene.write(resource, field, writes),
        }
    }

    /// How many bakes have been drawn for all pictures so far.
    pub fn bakes_drawn(&self) -> u64 {
        match self {
            #[cfg(feature = "gpu")]
            Scene::Gpu(scene) => scene.bakes_drawn(),
            Scene::Cpu(scene) => scene.bakes_drawn(),
        }
    }
}

/// Renders once: [`Renderer::new`], then [`Renderer::render`].
///
/// # Errors
/// As these two.
pub fn render(
    program: &Program,
    tables: &Tables,
    request: &Request,
    backend: Backend,
    progress: &(dyn Fn(f32) + Sync),
) -> Result<Picture, RenderError> {
    Renderer::new(backend)?.render(program, tables, request, progress)
}

#[cfg(test)]
mod tests {
    use super::content;
    use crate::picture::Content;
    use texgraph_compiler::manifest::{Output, Scalar, Type};

    #[test]
    fn what_an_output_means_follows_from_name_and_type() {
        let of = |name: &str, scalar, width| {
            let ty = Type { scalar, width };
            content(&Output { name: name.into(), ty, location: 0, is_color: name == "color" })
        };
        assert_eq!(of("color", Scalar::Float, 4), Content::Color);
        assert_eq!(of("normal", Scalar::Float, 3), Content::Normal);
        assert_eq!(of("normal", Scalar::Float, 2), Content::Vector);
        assert_eq!(of("emission", Scalar::Float, 3), Content::Data);
        assert_eq!(of("height", Scalar::Float, 1), Content::Data);
        assert_eq!(of("at", Scalar::Float, 2), Content::Vector);
        assert_eq!(of("rnd", Scalar::Float, 4), Content::Vector);
        assert_eq!(of("pick", Scalar::Int, 1), Content::Integer);
        assert_eq!(of("cell", Scalar::Int, 2), Content::Integer);
        assert_eq!(of("color", Scalar::Int, 1), Content::Integer);
        assert_eq!(of("inside", Scalar::Bool, 1), Content::Data);
    }
}
