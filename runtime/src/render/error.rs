//! Why there is no picture.

use super::MAX_SIDE;
use crate::resource::table;
use std::fmt;
use texgraph_compiler::manifest::Manifest;

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
    /// A baked texture has a side of no texels, or of more than any GPU can hold.
    TextureSize {
        /// Texels across and down.
        size: [u32; 2],
    },
    /// A bake can't be drawn.
    Bake {
        /// Its name.
        name: String,
        /// Why; not a `Bake` itself.
        error: Box<RenderError>,
    },
    /// The program has no pass: it was put together by hand.
    NoPass,
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

impl RenderError {
    /// A field of a resource, by its index, is no texture that can be written so.
    pub(crate) fn no_table(manifest: &Manifest, resource: usize, field: &str) -> RenderError {
        let name = manifest.resources.get(resource).map_or(String::new(), |found| found.name.clone());
        RenderError::NoTable { resource: name, field: field.to_owned() }
    }
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
            RenderError::TextureSize { size: [width, height] } => {
                let most = table::MAX_SIDE;
                write!(f, "a baked texture has 1 to {most} texels along a side, not {width}×{height}")
            }
            RenderError::Bake { name, error } => write!(f, "`{name}` can't be baked: {error}"),
            RenderError::NoPass => write!(f, "the program has nothing to draw"),
            RenderError::TooMuchWork { operations, limit } => {
                write!(f, "a pixel takes {operations} operations; the CPU renderer does at most {limit}")
            }
            RenderError::NoAdapter { reason } => write!(f, "there is no GPU to render on: {reason}"),
            RenderError::Gpu(text) => write!(f, "the GPU failed: {text}"),
        }
    }
}

impl std::error::Error for RenderError {}
