//! Rendering a texture to a picture, on a GPU or on the CPU: one request, one result.
//!
//! The picture is the flat view of the texture: a rectangle of `uv` fills it, the first row is at
//! the top, `v` grows downward, and each pixel is computed at its centre.

use crate::cpu;
#[cfg(feature = "gpu")]
use crate::gpu::{Gpu, Preference};
use crate::picture::{Content, Picture};
use crate::resource::Tables;
use crate::settings::Settings;
use crate::uniform::Draw;
use std::fmt;
use texgraph_compiler::Program;

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

    /// An empty picture for a program's output.
    ///
    /// # Errors
    /// The request asks for what can't be, or for more than there is memory for.
    pub(crate) fn picture(&self, program: &Program) -> Result<Picture, RenderError> {
        if self.size.iter().any(|side| !(1..=MAX_SIDE).contains(side)) {
            return Err(RenderError::Size { size: self.size });
        }
        if !self.region.iter().all(|bound| bound.is_finite()) || !self.time.is_finite() {
            return Err(RenderError::NotFinite);
        }
        let outputs = &program.manifest.outputs;
        let output = outputs
            .get(self.output)
            .ok_or(RenderError::NoOutput { output: self.output, outputs: outputs.len() })?;
        let count = self.size[0] as usize * self.size[1] as usize;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(count).map_err(|_| RenderError::Memory { size: self.size })?;
        pixels.resize(count, [0.0; 4]);
        let content = match output.name.as_str() {
            _ if output.is_color => Content::Color,
            "normal" => Content::Normal,
            _ => Content::Data,
        };
        Ok(Picture { size: self.size, pixels, content })
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

    /// Renders. `progress` hears shares from 0 to 1, from any thread.
    ///
    /// # Errors
    /// The request can't be met, a table is missing, or the GPU fails.
    pub fn render(
        &self,
        program: &Program,
        tables: &Tables,
        request: &Request,
        progress: &(dyn Fn(f32) + Sync),
    ) -> Result<Picture, RenderError> {
        #[cfg(feature = "gpu")]
        if let Some(gpu) = &self.gpu {
            return gpu.prepare(program, tables, request.output)?.render(request, progress);
        }
        cpu::render(program, tables, request, progress)
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

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq)]
pub enum RenderError {
    /// A side is 0 or more than [`MAX_SIDE`].
    Size {
        /// The size asked for.
        size: [u32; 2],
    },
    /// There is not enough memory.
    Memory {
        /// The size asked for.
        size: [u32; 2],
    },
    /// The region or the time is no finite number.
    NotFinite,
    /// The program has no such output.
    NoOutput {
        /// The output asked for.
        output: usize,
        /// How many there are.
        outputs: usize,
    },
    /// The bytes of a texture were not loaded, or are not as its table says.
    NoTable {
        /// The resource.
        resource: String,
        /// Its field.
        field: String,
    },
    /// A pixel takes more operations than the CPU renderer does.
    TooMuchWork {
        /// Operations a pixel.
        operations: u64,
        /// The most that it does.
        limit: u64,
    },
    /// No GPU can be used.
    NoAdapter {
        /// What was found, and why it does not do.
        reason: String,
    },
    /// The GPU or its driver failed.
    Gpu(String),
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RenderError::Size { size: [width, height] } => {
                write!(f, "a picture has 1 to {MAX_SIDE} pixels along a side, not {width}×{height}")
            }
            RenderError::Memory { size: [width, height] } => {
                let gibibytes = f64::from(*width) * f64::from(*height) * 16.0 / f64::from(1 << 30);
                write!(
                    f,
                    "there is no memory for {width}×{height} pixels ({gibibytes:.1} GiB); render parts of it"
                )
            }
            RenderError::NotFinite => write!(f, "the region and the time must be finite numbers"),
            RenderError::NoOutput { output, outputs } => {
                write!(f, "there is no output number {output}; the texture has {outputs}")
            }
            RenderError::NoTable { resource, field } => {
                write!(f, "the texels of `{resource}.{field}` are missing or not as its table says")
            }
            RenderError::TooMuchWork { operations, limit } => {
                write!(f, "a pixel takes {operations} operations; the CPU renderer does at most {limit}")
            }
            RenderError::NoAdapter { reason } => write!(f, "there is no GPU to render on: {reason}"),
            RenderError::Gpu(text) => write!(f, "the GPU failed: {text}"),
        }
    }
}

impl std::error::Error for RenderError {}
