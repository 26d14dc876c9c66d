//! The contract with hosts: what a program needs allocated, bound and set, as plain data.
//!
//! A host that runs the emitted WGSL on its own graphics layer needs this and the table bytes, and
//! nothing else of texgraph. What the compiler knows stands here from the start (bindings, view
//! types, samplers, offsets); what only loading the files tells (size, levels, format) is in
//! [`Texture::table`], which the runtime fills in.

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
    /// What it gives.
    pub outputs: Vec<Output>,
    /// What a host may set at run time.
    pub params: Vec<Param>,
    /// The one uniform block; none when nothing is in it.
    pub uniform: Option<Uniform>,
    /// What has to be loaded.
    pub resources: Vec<Resource>,
    /// What has to be drawn, in order; the last is the texture itself.
    pub passes: Vec<Pass>,
}

/// How the shader is wrapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// With a fragment entry point.
    Complete,
    /// A function over global bindings, no entry point.
    Library,
    /// A function of its arguments alone, with those it calls: no global variable, no binding, no
    /// entry point. The host binds everything, as it likes, and passes it on (see [`Pass::call`]).
    /// Bakes are in the complete form all the same: what they bind, and the uniform block with the
    /// params they read, stands in the manifest.
    Functions,
}

/// One shader to run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// The texture's name, or the baked resource's.
    pub name: String,
    /// Of a bake: which resource it fills (an index into [`Manifest::resources`]). A host draws it
    /// into level 0 of that resource's only texture, `uv` (at `@location(0)`) running from 0 to 1
    /// across it, then averages each further level from the one before; once at the start, and
    /// again whenever one of `params` changes. None for the texture itself, the last pass.
    pub bake: Option<u32>,
    /// What it samples or fetches: resource (index) and field. Nothing else has to be bound.
    pub reads: Vec<(u32, String)>,
    /// The params it reads, by name.
    pub params: Vec<String>,
    /// The file with its WGSL, beside the manifest.
    pub shader: String,
    /// `fn NAME(in: NAMEInputs) -> NAMEOutputs` in the library form, the fragment entry point in
    /// the complete form, the function to call in the functions form.
    pub entry_point: String,
    /// How to call the function; in the functions form only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub call: Option<Call>,
    /// `derive`: the shader takes screen derivatives, so it runs in a fragment stage and in uniform
    /// control flow only.
    pub gradients: Gradients,
}

/// How to call the function of the functions form.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Call {
    /// What it takes, in order.
    pub arguments: Vec<Argument>,
    /// The members of the struct that it returns, one for each output, in order. None where there is
    /// one output: the function returns its value.
    pub members: Option<Vec<String>>,
}

/// An argument of the function of the functions form.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Argument {
    /// The input of that name.
    Input(String),
    /// The param of that name, clamped to its range; a bool is a `bool`.
    Param(String),
    /// A texture, by its resource (index) and field.
    Texture(u32, String),
    /// The sampler of the texture before it, by the same.
    Sampler(u32, String),
}

/// Where screen derivatives come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Gradients {
    /// `dpdx` and `dpdy` of the inputs, taken once at the top.
    Derive,
    /// The shader needs none.
    None,
}

/// The type of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Type {
    /// The type of a component.
    pub scalar: Scalar,
    /// Components, 1 to 4.
    pub width: u8,
}

/// The type of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scalar {
    /// 32-bit float.
    Float,
    /// 32-bit signed integer.
    Int,
    /// One of two; in the uniform block a 32-bit unsigned integer, 0 or 1.
    Bool,
}

/// Numbers of a constant, one per component.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Value {
    /// Components of a float.
    Float(Vec<f32>),
    /// Components of an int.
    Int(Vec<i32>),
    /// Components of a bool.
    Bool(Vec<bool>),
}

/// An input of the texture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Input {
    /// One of the fixed names: `uv`, `position`, `normal`, `time`, …
    pub name: String,
    /// Its type.
    pub ty: Type,
    /// Where the complete form reads it.
    pub source: Source,
}

/// Where a value comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// Interpolated, at this `@location`. Integers are flat.
    Varying(u32),
    /// In the uniform block, at this byte offset.
    Uniform(u32),
    /// A member of the inputs' struct (library form).
    Member,
    /// An argument of the function (functions form).
    Argument,
}

/// An output of the texture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Output {
    /// Its name.
    pub name: String,
    /// Its type in the language. The complete form widens every output to `vec4<f32>`: a scalar to
    /// (v, v, v, 1), two components to (x, y, 0, 1), three to (x, y, z, 1).
    pub ty: Type,
    /// Its `@location` in the complete form.
    pub location: u32,
    /// `color: color` is linear and premultiplied; anything else is data.
    pub is_color: bool,
}

/// A param: a value that a host sets without recompiling.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Param {
    /// Its name, as `--set` takes it (`scale`, or `stone.scale` of an import).
    pub name: String,
    /// Its documentation.
    pub label: String,
    /// Its type.
    pub ty: Type,
    /// The value before a host sets one.
    pub default: Value,
    /// The least and greatest value; whoever writes the block clamps to it.
    pub range: Option<(Value, Value)>,
    /// Byte offset in the uniform block; none when nothing that binds the block reads it (in the
    /// functions form, bakes alone do).
    pub offset: Option<u32>,
}

/// The uniform block: params and draw-rate inputs in declaration order, natural alignment, padded
/// to a multiple of 16 bytes, little endian.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Uniform {
    /// The variable's name in the WGSL.
    pub name: String,
    /// `@group`
    pub group: u32,
    /// `@binding`
    pub binding: u32,
    /// Bytes, a multiple of 16.
    pub size: u32,
}

/// A resource: what a constructor call in the source asks for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Resource {
    /// The name of its `let` (or a made-up one for a constructor inside an expression).
    pub name: String,
    /// Its documentation.
    pub label: String,
    /// The constructor with all its arguments: what the bytes are made of.
    pub recipe: Recipe,
    /// The textures the shader reads it through. Those that no shader of this program reads are
    /// left out.
    pub textures: Vec<Texture>,
}

/// How to make the bytes of a resource: a constructor with every argument, defaults filled in.
/// Paths are relative to the folder of the program's main file, with `/`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Recipe {
    /// One picture, mipmapped. Field `pixels`.
    Image {
        /// The picture file.
        path: String,
        /// How its numbers are read.
        encoding: Encoding,
    },
    /// Interchangeable tiles, one layer each. Field `layers`.
    Patterns {
        /// Picture files: one with `grid` cells, or one per pattern.
        paths: Vec<String>,
        /// Columns and rows of the one picture; `[1, 1]` for a list of files. Row by row.
        grid: [u32; 2],
        /// How the numbers are read.
        encoding: Encoding,
    },
    /// Four independent permutations of 0..size: entry i holds σ₀(i)…σ₃(i). A row of the program's
    /// [`Recipe::Tables`].
    Permutation {
        /// T, 2 to 4096.
        size: u32,
        /// Chooses the permutations.
        seed: i32,
    },
    /// An integer map. Field `map`.
    Indices {
        /// Where the integers come from.
        source: IndicesSource,
        /// M: a picture's grey range is cut into M equal steps, numbered from 0 (black); numbers
        /// given as a list must be below it.
        levels: u32,
    },
    /// Small tables that share one texture, a row each. Field `table`: texel i of row r is entry i of
    /// the r-th of these resources; the width is that of the longest.
    Tables {
        /// Indices of resources: permutations.
        rows: Vec<u32>,
    },
    /// The texels of a pass of the program, mipmapped. Field `pixels`, whose table is known when
    /// compiling.
    Bake {
        /// Texels across and down.
        size: [u32; 2],
        /// Its texels' format.
        format: Format,
    },
}

/// Where an integer map comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum IndicesSource {
    /// A grey picture.
    Path(String),
    /// Rows of numbers, all of one length.
    Rows(Vec<Vec<i32>>),
}

/// How the numbers of a picture are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Encoding {
    /// Colour: linearised, premultiplied, filtered in that space.
    Srgb,
    /// Data, as it is, straight alpha.
    Linear,
    /// A normal map: xyz in −1..1.
    Normal,
}

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

/// The name of a value in a table of names.
fn name_of<T: PartialEq>(names: &[(T, &str)], value: T) -> String {
    names.iter().find(|(known, _)| *known == value).map_or(String::new(), |(_, name)| (*name).to_owned())
}

/// The value of a name in a table of names.
fn named<T: Copy>(names: &[(T, &str)], name: &str) -> Result<T, String> {
    let found = names.iter().find(|(_, known)| *known == name).map(|(value, _)| *value);
    found.ok_or_else(|| format!("`{name}` is not known here"))
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

/// The bytes of a texture: every level, every layer (or slice), row by row, without padding.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// The file with the bytes, beside the manifest; none when they were not written.
    pub file: Option<String>,
    /// Its texels.
    pub format: Format,
    /// Width of level 0 in texels.
    pub width: u32,
    /// Height of level 0 in texels.
    pub height: u32,
    /// Layers of an array, or depth of a volume's level 0; else 1.
    pub layers: u32,
    /// The levels, from the largest.
    pub levels: Vec<Level>,
}

impl Table {
    /// A table of all levels down to one texel: a level's layers follow one another, rows have no
    /// padding.
    pub fn mipmapped(format: Format, size: [u32; 2], layers: u32) -> Table {
        let [width, height] = size;
        Table::with_levels(format, size, layers, width.max(height).max(1).ilog2() + 1)
    }

    /// A table of so many levels.
    pub fn with_levels(format: Format, size: [u32; 2], layers: u32, count: u32) -> Table {
        let [width, height] = size;
        let mut offset = 0;
        let levels = (0..count).map(|level| {
            let [width, height] = size.map(|side| (side >> level).max(1));
            let bytes_per_row = width * format.bytes();
            let level = Level { offset, width, height, layers, bytes_per_row };
            offset += level.bytes();
            level
        });
        let levels = levels.collect();
        Table { file: None, format, width, height, layers, levels }
    }
}

impl Level {
    /// Bytes of the level, all layers.
    pub fn bytes(&self) -> u64 {
        u64::from(self.bytes_per_row) * u64::from(self.height) * u64::from(self.layers)
    }
}

/// One level of a table. All its layers follow one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Level {
    /// Where it begins, in bytes.
    pub offset: u64,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Layers or slices.
    pub layers: u32,
    /// Bytes from one row to the next.
    pub bytes_per_row: u32,
}

/// Texel formats, by their WebGPU names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Format {
    /// 8 bits a channel, the premultiplied colour sRGB-encoded, alpha linear.
    Rgba8UnormSrgb,
    /// 8 bits a channel, 0..1.
    Rgba8Unorm,
    /// 8 bits a channel, −1..1.
    Rgba8Snorm,
    /// 16-bit floats.
    Rgba16Float,
    /// One 32-bit integer.
    R32Sint,
    /// Four 32-bit integers.
    Rgba32Sint,
}

impl From<Format> for String {
    fn from(format: Format) -> String {
        name_of(Format::NAMES, format)
    }
}

impl TryFrom<String> for Format {
    type Error = String;

    fn try_from(name: String) -> Result<Format, String> {
        named(Format::NAMES, &name)
    }
}

impl Format {
    const NAMES: &[(Format, &str)] = &[
        (Format::Rgba8UnormSrgb, "rgba8unorm-srgb"),
        (Format::Rgba8Unorm, "rgba8unorm"),
        (Format::Rgba8Snorm, "rgba8snorm"),
        (Format::Rgba16Float, "rgba16float"),
        (Format::R32Sint, "r32sint"),
        (Format::Rgba32Sint, "rgba32sint"),
    ];

    /// Bytes a texel.
    pub fn bytes(self) -> u32 {
        match self {
            Format::Rgba8UnormSrgb | Format::Rgba8Unorm | Format::Rgba8Snorm | Format::R32Sint => 4,
            Format::Rgba16Float => 8,
            Format::Rgba32Sint => 16,
        }
    }
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
