//! The contract with hosts: what a program needs allocated, bound and set, as plain data.
//!
//! A host that runs the emitted WGSL on its own graphics layer needs this and the table bytes, and
//! nothing else of texgraph. What the compiler knows stands here from the start (bindings, view
//! types, samplers, offsets); what only loading the files tells (size, levels, format) is in
//! [`Texture::table`], which the runtime fills in.

mod interface;
mod names;
mod pass;
mod recipe;
mod table;
mod texture;

pub use interface::{Axis, Gradient, Input, Output, Param, Scalar, Source, Type, Uniform, Value};
pub use pass::{Argument, Call, Form, Gradients, Pass};
pub use recipe::{Borders, Compression, Encoding, IndicesSource, Recipe, Resource, Space, Stop, Tileable};
pub use table::{Format, Level, Table};
pub use texture::{Filter, SampleKind, Sampler, Texture, ViewDimension, Wrap};

use serde::{Deserialize, Serialize};

/// The version of this layout. A reader should refuse what is newer.
pub const VERSION: u32 = 1;

/// Everything about one compiled texture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// [`VERSION`] of the writer.
    pub version: u32,
    /// The program that wrote it, with its version.
    pub generator: String,
    /// The texture's name in its file.
    pub texture: String,
    /// Its documentation.
    pub label: String,
    /// How the shader is wrapped.
    pub form: Form,
    /// What the shader takes per pixel or per draw.
    pub inputs: Vec<Input>,
    /// The derivatives of inputs that the shader is given, if it was compiled to be: all that it
    /// reads, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub gradients: Vec<Gradient>,
    /// What it gives.
    pub outputs: Vec<Output>,
    /// The entry point discards pixels whose `color` has less alpha than this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub discard_below: Option<f32>,
    /// How far `uv` moves along each axis until the picture comes again, if the texture was proved to
    /// tile (`tiles` in its head): a host may draw one period and repeat it. 0 along an axis where it
    /// need not come again.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tiles: Option<[f32; 2]>,
    /// What a host may set at run time.
    pub params: Vec<Param>,
    /// The one uniform block; none when nothing is in it.
    pub uniform: Option<Uniform>,
    /// What has to be loaded.
    pub resources: Vec<Resource>,
    /// What has to be drawn, in order; the last is the texture itself.
    pub passes: Vec<Pass>,
}

impl Manifest {
    /// As RON, for people and Rust.
    pub fn to_ron(&self) -> String {
        let config = ron::ser::PrettyConfig::default().struct_names(false);
        ron::ser::to_string_pretty(self, config).unwrap_or_default()
    }

    /// As JSON, for everything else.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// Reads RON.
    ///
    /// # Errors
    /// The text is not a manifest of this version.
    pub fn from_ron(text: &str) -> Result<Manifest, String> {
        let manifest: Manifest = ron::from_str(text).map_err(|error| error.to_string())?;
        manifest.checked()
    }

    /// Reads JSON.
    ///
    /// # Errors
    /// The text is not a manifest of this version.
    pub fn from_json(text: &str) -> Result<Manifest, String> {
        let manifest: Manifest = serde_json::from_str(text).map_err(|error| error.to_string())?;
        manifest.checked()
    }

    fn checked(self) -> Result<Manifest, String> {
        if self.version == VERSION {
            Ok(self)
        } else {
            Err(format!("the manifest has version {}, this reads version {VERSION}", self.version))
        }
    }

    /// All textures of all resources.
    pub fn textures(&self) -> impl Iterator<Item = &Texture> {
        self.resources.iter().flat_map(|resource| &resource.textures)
    }
}
