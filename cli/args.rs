//! Everything that can be typed after `texgraph`, with its help.
//!
//! clap makes the parser and the help from these types; what it refuses ends with exit code 2. The
//! small parsers at the end read sizes, regions and times, so a subcommand only sees values that
//! make sense.

use crate::tiles::args::Tiles;
use clap::{Parser, Subcommand, ValueEnum};
use std::ffi::OsString;
use std::path::PathBuf;
use texgraph_runtime::render::MAX_SIDE;

const START: &str = "\
Start here:
  texgraph check  tiling.tex                  is the file right?
  texgraph render tiling.tex -o tiling.png    what does it look like?
  texgraph build  tiling.tex -o shaders       a shader for an engine, and what it needs

Exit codes: 0 fine, 1 the input is wrong, 2 the command line is wrong, 3 the machine can't.";

const CHECK: &str = "\
Examples:
  texgraph check tiling.tex marble.tex
  texgraph check tiling.tex --profile bevy    may it be a material of Bevy?
Nothing is printed for a file without errors. Pictures are not opened: `render` and `build` do that.";

const BUILD: &str = "\
Example:
  texgraph build tiling.tex -o shaders
writes, for the file's one texture `tiling`:
  shaders/tiling.wgsl               the shader
  shaders/tiling.ron                what a host must bind and may set
  shaders/tiling.grass.layers.ktx2  the texels of `grass`, all levels
All files are made before the first is written; after an error the old ones are as they were.
Building again makes what has changed, and says what that was; a table whose recipe and pictures
are the same is taken from the folder, and files that would hold the same are not touched.
  texgraph build tiling.tex -o shaders --form library --profile bevy
writes a function to import into a material of Bevy, its bindings in group 3 from 100 on.";

const RENDER: &str = "\
Examples:
  texgraph render tiling.tex -o tiling.png
  texgraph render walls.tex:bricks -o bricks.png --size 512x512 --set scale=2 --set tint=#8d8f94
  texgraph render tiling.tex -o corner.png --region 0,0,0.25,0.25
  texgraph render tiling.tex -o ground.png --view plane --repeat 4 --size 1280x720
The flat view shows a rectangle of `uv`, (0, 0) at its top left. The plane is seen from above it, up to
the horizon at a quarter of the picture's height, with the unit square of `uv` --repeat times along
the lower edge; what is above the horizon is #a4b6c9 in a `color`, 0 in other outputs. Colours are
written with 8 bits, other outputs as 16-bit linear data.";

const GRAPH: &str = "\
Examples:
  texgraph graph tiling.tex -o tiling.svg            the file's first texture as a picture
  texgraph graph landscape.tex:material -o m.svg     one node of it
  texgraph graph tiling.tex | dot -Tpdf > tiling.pdf
A block is a call, a formula, a fold; a wire bears the name that its `let` gives it. Colours tell
how often a value is computed: when loading, once a draw, once a pixel. Without -o the text for
Graphviz goes to standard output; it has no bound, a picture shows 400 blocks at most.
Only the syntax has to be right: what is declared nowhere is drawn all the same.";

const COST: &str = "\
Examples:
  texgraph cost tiling.tex
  texgraph cost landscape.tex:landscape --max-samples 8    exit code 1 if a pixel may read more
  texgraph cost tiling.tex --format json
Everything is read off the compiled graph; nothing is rendered. The worst case takes every loop to
its bound and of every branch the dearer arm, each figure on its own. The typical case has params at
their defaults; of a branch that they do not decide each arm counts half, and a loop with a `while`
takes half of its bound. An `if` without samples, fetches or loops in its arms computes both.
Bytes of tables need the pictures; without them they are unknown, which is no error.";

const INSPECT: &str = "\
Examples:
  texgraph inspect moss.png -o sheet.png
  texgraph inspect moss_normal.png --encoding normal --format json
Says whether a picture suits `exemplar` and `stochastic`, which show a photograph without end. What is
made of grains, blades, leaves or stones does; bricks, planks and weave lose their order. The sheet
shows, each 2.5 times as wide as the picture's longer side and in reading order: the picture repeated,
and blended linearly, with its variance kept, with its histogram kept, which is the method.
The figures are explained in docs/stochastic.md.";

const FMT: &str = "\
Examples:
  texgraph fmt tiling.tex          rewrites the file if its layout is not the canonical one
  texgraph fmt --check *.tex       lists the files that would change; exit code 1 if any would
  texgraph fmt - < a.tex > b.tex   reads standard input, writes standard output
Comments stay where they are. A file with syntax errors is left alone.";

const EXPLAIN: &str = "\
Examples:
  texgraph explain E0501    what the error means, with a wrong and a right program
  texgraph explain          all codes";

/// Textures written as graphs, compiled to shaders for any engine.
#[derive(Parser)]
#[command(name = "texgraph", version, after_help = START, max_term_width = 100, disable_help_subcommand = true)]
pub struct Args {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// Report all errors of .tex files
    Check(Check),
    /// Write shaders, their manifests and their textures; again, what has changed
    Build(Build),
    /// Render a texture to a PNG picture
    Render(Render),
    /// Count what a texture takes: samples, arithmetic, loops, bytes
    Cost(Cost),
    /// Draw the node diagram of a texture or a node
    Graph(Graph),
    /// Say whether a picture suits tiling and blending by example
    Inspect(Inspect),
    /// Make and check tile sets: sheets of tiles that fit together
    Tiles(Tiles),
    /// Put .tex files into their canonical layout
    Fmt(Fmt),
    /// Explain an error code
    Explain(Explain),
}

impl Command {
    /// How errors are printed; subcommands without the flag print pages.
    pub fn message_format(&self) -> MessageFormat {
        match self {
            Command::Check(Check { common, .. })
            | Command::Build(Build { common, .. })
            | Command::Render(Render { common, .. })
            | Command::Cost(Cost { common, .. })
            | Command::Graph(Graph { common, .. }) => common.message_format,
            Command::Inspect(inspect) => inspect.message_format,
            Command::Tiles(tiles) => tiles.message_format(),
            Command::Fmt(_) | Command::Explain(_) => MessageFormat::Human,
        }
    }
}

/// What every subcommand that reads programs takes.
#[derive(clap::Args)]
pub struct Common {
    /// How errors are printed, on standard error
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub message_format: MessageFormat,
    /// Let the program read files outside its own folder
    #[arg(long)]
    pub allow_outside: bool,
}

/// The host that a program is for.
#[derive(clap::Args)]
pub struct Host {
    /// The host whose limits are kept
    #[arg(long, value_enum, default_value_t, value_name = "HOST")]
    pub profile: Profile,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Profile {
    /// Every WebGPU device: 16 textures, 64 KiB of params, 8 outputs, textures of 8192 a side
    #[default]
    Webgpu,
    /// WebGPU's compatibility mode: 16 textures, 16 KiB, 4 outputs, textures of 4096 a side
    Compat,
    /// A material of Bevy: 6 textures; `build` puts bindings into group 3 from 100 on
    Bevy,
}

impl From<Profile> for texgraph_compiler::Profile {
    fn from(profile: Profile) -> texgraph_compiler::Profile {
        match profile {
            Profile::Webgpu => texgraph_compiler::Profile::Webgpu,
            Profile::Compat => texgraph_compiler::Profile::Compat,
            Profile::Bevy => texgraph_compiler::Profile::Bevy,
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum MessageFormat {
    /// Pages with source lines and underlines
    #[default]
    Human,
    /// One line each: `file:line:column: error[CODE]: message`
    Short,
    /// One JSON object a line
    Json,
}

#[derive(clap::Args)]
#[command(after_help = CHECK)]
pub struct Check {
    /// The .tex files
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    #[command(flatten)]
    pub host: Host,
    #[command(flatten)]
    pub common: Common,
}

#[derive(clap::Args)]
#[command(after_help = BUILD)]
pub struct Build {
    /// The .tex file
    pub file: PathBuf,
    /// The folder that is written to; made if it is missing
    #[arg(short, value_name = "DIR", default_value = ".")]
    pub output: PathBuf,
    /// The one texture to build; all of the file when not given
    #[arg(long, value_name = "NAME")]
    pub texture: Option<String>,
    /// Do not say what was made
    #[arg(short, long)]
    pub quiet: bool,
    /// How the shader is wrapped
    #[arg(long, value_enum, default_value_t, value_name = "FORM")]
    pub form: Form,
    /// Where the derivatives come from that samples are filtered with
    #[arg(long, value_enum, default_value_t, value_name = "FROM")]
    pub gradients: Gradients,
    /// Discard pixels whose `color` has less alpha than this, 0 to 1, for hosts that test alpha instead
    /// of blending; in the complete form
    #[arg(long, value_name = "ALPHA", value_parser = alpha)]
    pub discard_below: Option<f32>,
    /// Work every level of detail out in the shader, as `texgraph render` does, instead of leaving it to
    /// the driver: the same picture on every adapter, for some more arithmetic
    #[arg(long)]
    pub exact_levels: bool,
    /// The format of the manifest
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub manifest: ManifestFormat,
    /// The @group of all bindings, 0 to 7; 0, or what the profile says
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=7))]
    pub group: Option<u32>,
    /// The first @binding, 0 to 999, the others follow; 0, or what the profile says
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=999))]
    pub first_binding: Option<u32>,
    #[command(flatten)]
    pub host: Host,
    #[command(flatten)]
    pub common: Common,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Form {
    /// With a fragment entry point
    #[default]
    Complete,
    /// A function to import or to paste into another shader
    Library,
    /// A function that takes textures, samplers and params as arguments, and binds nothing
    Functions,
}

/// Where screen derivatives come from.
#[derive(Clone, Copy, Default, ValueEnum)]
pub enum Gradients {
    /// The shader takes them itself: in the fragment stage, in uniform control flow
    #[default]
    Derive,
    /// Whoever calls the shader passes them: for compute, ray tracing, branches
    Argument,
    /// Nowhere: every sample is of the finest level
    None,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ManifestFormat {
    /// For people and Rust
    #[default]
    Ron,
    /// For everything else
    Json,
}

#[derive(clap::Args)]
#[command(after_help = RENDER)]
pub struct Render {
    /// The .tex file, with the name of the texture if it is not the first: walls.tex:bricks. A node
    /// is rendered by its name too, and any wire inside either as walls.tex:bricks.pick
    #[arg(value_name = "FILE[:TEXTURE[.WIRE]]")]
    pub file: OsString,
    /// The PNG file that is written
    #[arg(short, value_name = "OUT.png")]
    pub output_file: PathBuf,
    /// Pixels across and down
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = size)]
    pub size: [u32; 2],
    /// The rectangle of `uv` that fills the picture; reversed bounds mirror it
    #[arg(long, value_name = "X0,Y0,X1,Y1", default_value = "0,0,1,1", value_parser = region)]
    #[arg(allow_hyphen_values = true)]
    pub region: [f64; 4],
    /// How the texture is looked at
    #[arg(long, value_enum, default_value_t)]
    pub view: View,
    /// Unit squares of `uv` across the picture, in the flat view also down it, instead of --region
    #[arg(long, value_name = "N", default_value = "1", value_parser = repeat)]
    #[arg(conflicts_with = "region")]
    pub repeat: f32,
    /// Set a param: a number, true or false, components with commas, or a colour (#rrggbb)
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// The input `time`, in seconds
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = seconds)]
    #[arg(allow_hyphen_values = true)]
    pub time: f32,
    /// The output to render; when not given `color`, else the first
    #[arg(long, value_name = "NAME")]
    pub output: Option<String>,
    /// Where to render
    #[arg(long, value_enum, default_value_t)]
    pub backend: Backend,
    /// Say what renders
    #[arg(short, long)]
    pub verbose: bool,
    #[command(flatten)]
    pub common: Common,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum View {
    /// A rectangle of `uv` fills the picture
    #[default]
    Flat,
    /// On the ground, in perspective, up to the horizon
    Plane,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// A GPU if there is one, else the CPU
    #[default]
    Auto,
    /// A GPU, or exit code 3
    Gpu,
    /// The CPU
    Cpu,
}

#[derive(clap::Args)]
#[command(after_help = COST)]
pub struct Cost {
    /// The .tex file, with the name of one texture if not all of it are meant
    #[arg(value_name = "FILE[:TEXTURE]")]
    pub file: OsString,
    /// Samples and fetches of a pixel at most, in the worst case
    #[arg(long, value_name = "N")]
    pub max_samples: Option<u32>,
    /// How the figures are printed
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub format: CostFormat,
    #[command(flatten)]
    pub host: Host,
    #[command(flatten)]
    pub common: Common,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum CostFormat {
    /// Tables for people
    #[default]
    Text,
    /// One JSON array, an object for each texture
    Json,
}

#[derive(clap::Args)]
#[command(after_help = GRAPH)]
pub struct Graph {
    /// The .tex file, with the name of the texture or node if it is not the first texture
    #[arg(value_name = "FILE[:NAME]")]
    pub file: OsString,
    /// The file that is written, by its ending: .svg a picture, .dot text for Graphviz
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub common: Common,
}

#[derive(clap::Args)]
#[command(after_help = INSPECT)]
pub struct Inspect {
    /// The picture: PNG, JPEG, TGA, OpenEXR or HDR
    pub picture: PathBuf,
    /// The PNG file that is written: the picture repeated, and its blends
    #[arg(short, value_name = "SHEET.png")]
    pub output_file: Option<PathBuf>,
    /// How the picture's numbers are read, as by `exemplar`
    #[arg(long, value_enum, default_value_t)]
    pub encoding: InspectEncoding,
    /// Channels that are made Gaussian: 3, or 1 of a grey picture
    #[arg(long, value_name = "N", default_value = "3", value_parser = channels)]
    pub channels: u32,
    /// The height of a hexagon in pictures, as of `stochastic`; above 0, at most 1
    #[arg(long, value_name = "PICTURES", default_value = "0.5", value_parser = tile)]
    pub tile: f32,
    /// How the figures are printed
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub format: InspectFormat,
    /// How errors are printed, on standard error
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub message_format: MessageFormat,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum InspectEncoding {
    /// Colours
    #[default]
    Srgb,
    /// Data
    Linear,
    /// Normals
    Normal,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum InspectFormat {
    /// A table for people
    #[default]
    Text,
    /// One JSON object
    Json,
}

#[derive(clap::Args)]
#[command(after_help = FMT)]
pub struct Fmt {
    /// The .tex files; - is standard input
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Write nothing; list the files that would change
    #[arg(long)]
    pub check: bool,
}

#[derive(clap::Args)]
#[command(after_help = EXPLAIN)]
pub struct Explain {
    /// The code, as E0501 or 501
    pub code: Option<String>,
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X', '×']).ok_or("write width and height as 512x256")?;
    let side = |text: &str| {
        let number = text.parse().ok().filter(|side| (1..=MAX_SIDE).contains(side));
        number.ok_or_else(|| format!("a side has 1 to {MAX_SIDE} pixels, not `{text}`"))
    };
    Ok([side(sides.0)?, side(sides.1)?])
}

fn region(text: &str) -> Result<[f64; 4], String> {
    let bounds: Vec<f64> = text.split(',').map(finite).collect::<Result<_, _>>()?;
    let bounds: [f64; 4] = bounds.try_into().map_err(|_| "write four numbers as 0,0,1,1")?;
    let [x0, y0, x1, y1] = bounds;
    if x0 == x1 || y0 == y1 {
        return Err("the region is empty".into());
    }
    Ok(bounds)
}

/// The most unit squares across a picture.
const MAX_REPEAT: f32 = 65_536.0;

fn repeat(text: &str) -> Result<f32, String> {
    let number = finite(text)? as f32;
    let fits = number > 0.0 && number <= MAX_REPEAT;
    if fits { Ok(number) } else { Err(format!("it is above 0 and at most {MAX_REPEAT}")) }
}

fn alpha(text: &str) -> Result<f32, String> {
    let alpha = finite(text)?;
    if (0.0..=1.0).contains(&alpha) { Ok(alpha as f32) } else { Err("it must be from 0 to 1".to_owned()) }
}

fn seconds(text: &str) -> Result<f32, String> {
    let seconds = finite(text)? as f32;
    if seconds.is_finite() { Ok(seconds) } else { Err(format!("`{text}` is too large")) }
}

fn channels(text: &str) -> Result<u32, String> {
    let channels = text.parse().ok().filter(|channels| [1, 3].contains(channels));
    channels.ok_or_else(|| format!("colours have 3 channels and grey pictures 1, not `{text}`"))
}

fn tile(text: &str) -> Result<f32, String> {
    let tile = finite(text)? as f32;
    if tile > 0.0 && tile <= 1.0 {
        Ok(tile)
    } else {
        Err(format!("a hexagon is up to 1 picture high, not `{text}`"))
    }
}

fn finite(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| format!("`{text}` is no finite number"))
}
