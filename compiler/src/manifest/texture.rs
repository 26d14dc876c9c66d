//! The textures that a shader reads a resource through, with their samplers.

use super::Table;
use super::names::{name_of, named};
use serde::{Deserialize, Serialize};

/// One texture of a resource.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Texture {
    /// The resource's field: `pixels`, `layers`, `table`, `map`.
    pub field: String,
    /// The variable's name in the WGSL. In the functions form it and the binding are those of bakes;
    /// the texture's own shader knows neither.
    pub name: String,
    /// `@group`
    pub group: u32,
    /// `@binding`
    pub binding: u32,
    /// The shape of its view.
    pub view: ViewDimension,
    /// What the shader reads from it.
    pub sample: SampleKind,
    /// Its sampler; none when it is read texel by texel only.
    pub sampler: Option<Sampler>,
    /// Size, format and place of its bytes; none until the resource is loaded.
    pub table: Option<Table>,
    /// Where `table` is compressed, the same without: for adapters that lack `texture-compression-bc`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plain: Option<Table>,
}

/// The shape of a view, by its WebGPU name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum ViewDimension {
    /// `texture_2d`
    D2,
    /// `texture_2d_array`
    D2Array,
    /// `texture_3d`
    D3,
}

impl ViewDimension {
    const NAMES: &[(ViewDimension, &str)] =
        &[(ViewDimension::D2, "2d"), (ViewDimension::D2Array, "2d-array"), (ViewDimension::D3, "3d")];
}

impl From<ViewDimension> for String {
    fn from(view: ViewDimension) -> String {
        name_of(ViewDimension::NAMES, view)
    }
}

impl TryFrom<String> for ViewDimension {
    type Error = String;

    fn try_from(name: String) -> Result<ViewDimension, String> {
        named(ViewDimension::NAMES, &name)
    }
}

/// What a shader reads from a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SampleKind {
    /// Filterable floats (`<f32>`).
    Float,
    /// Signed integers (`<i32>`).
    Int,
}

/// A sampler.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sampler {
    /// The variable's name in the WGSL.
    pub name: String,
    /// `@group`
    pub group: u32,
    /// `@binding`
    pub binding: u32,
    /// What lies outside 0..1, on every axis.
    pub wrap: Wrap,
    /// Within a level and between levels.
    pub filter: Filter,
    /// Greatest anisotropy, 1 to 16.
    pub anisotropy: u16,
}

/// What lies outside 0..1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Wrap {
    /// The picture again.
    Repeat,
    /// Its border texels.
    Clamp,
    /// The picture mirrored.
    Mirror,
}

/// How texels are weighed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Filter {
    /// Linear within a level and between levels.
    Linear,
    /// The nearest texel of the nearest level.
    Nearest,
}
