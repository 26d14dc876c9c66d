//! What can be typed after `texgraph tiles`.

use crate::args::MessageFormat;
use clap::{Subcommand, ValueEnum};
use std::path::PathBuf;

const TILES: &str = "\
Example, from two photographs to what a landscape needs:
  texgraph tiles make lawn.png -o grass.png
  texgraph tiles make beach.png -o sand.png
  texgraph tiles transition sand.png grass.png --grid 4x4 -o shore.png
  texgraph tiles check shore.png --families 2 --max 1";

const MAKE: &str = "\
Example:
  texgraph tiles make lawn.png --grid 4x4 --size 128 -o grass.png
writes 16 tiles of 128×128 texels for `patterns(\"grass.png\", grid: ivec2(4, 4))`.
All tiles have one border, taken from a calm place of the photograph; inside, each shows a place of
its own, cut into the border where that is seen least. Light and shade wider than a tile are taken
out. The photograph needs a quarter more texels along each side than a tile; best are those without
large things to recognise.";

const TRANSITION: &str = "\
Examples:
  texgraph tiles transition beach.png lawn.png -o shore.png              two photographs
  texgraph tiles transition sand.png grass.png --grid 4x4 -o shore.png   two sheets of tiles
  texgraph tiles transition lawn.png --border -o edge.png                grass over anything
writes 16 tiles, 4×4, in the order of their corner codes: tile c00 + 2·c10 + 4·c01 + 8·c11 has
family c00 at its top left, c10 at its top right, c01 at its bottom left, c11 at its bottom right;
0 is the first picture and 1 the second. With --border 0 is transparent and 1 the picture.
From photographs the edges are those of `make` with the same --size and --seed, so the tiles fit
together. From sheets, tiles fit as well as those of the sheets do.";

const LAYOUT: &str = "\
Example:
  texgraph tiles layout --families 2 --size 64 -o to_paint.png
writes 16 tiles, each with its corner codes and its number, to be painted over. m families have m⁴
tiles, up to 4 families; where there are more, paint 16 border tiles for each.";

const CHECK: &str = "\
Examples:
  texgraph tiles check grass.png --grid 4x4
  texgraph tiles check shore.png --families 2 --max 1    exit code 1 if any pair differs more
Compares the texels of all edges that may face each other, in 8-bit levels of sRGB (colours times
alpha). Equal edges are what tiles need that are magnified; in sheets whose tiles go on in each
other instead, facing texels differ as much as neighbours inside tiles do.";

#[derive(clap::Args)]
#[command(after_help = TILES, disable_help_subcommand = true)]
pub struct Tiles {
    #[command(subcommand)]
    pub command: TilesCommand,
}

#[derive(Subcommand)]
pub enum TilesCommand {
    /// Cut a photograph into a sheet of compatible tiles
    Make(Make),
    /// Make the sixteen transition tiles of two families, or the borders of one
    Transition(Transition),
    /// Draw an empty sheet with its corner codes
    Layout(Layout),
    /// Report how well the edges of a sheet's tiles fit
    Check(Check),
}

impl Tiles {
    pub fn message_format(&self) -> MessageFormat {
        match &self.command {
            TilesCommand::Make(Make { message_format, .. })
            | TilesCommand::Transition(Transition { message_format, .. })
            | TilesCommand::Layout(Layout { message_format, .. })
            | TilesCommand::Check(Check { message_format, .. }) => *message_format,
        }
    }
}

#[derive(clap::Args)]
#[command(after_help = MAKE)]
pub struct Make {
    /// The photograph: PNG, JPEG, TGA, OpenEXR or HDR
    pub photo: PathBuf,
    /// The PNG file that is written
    #[arg(short, value_name = "OUT.png")]
    pub output_file: PathBuf,
    /// Tiles across and down the sheet, at most 256
    #[arg(long, value_name = "CxR", default_value = "4x4", value_parser = grid)]
    pub grid: [u32; 2],
    /// Texels along a tile, 16 to 1024
    #[arg(long, value_name = "TEXELS", default_value_t = 128)]
    pub size: u32,
    /// Another number makes another choice of places
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u32,
    /// How errors are printed, on standard error
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub message_format: MessageFormat,
}

#[derive(clap::Args)]
#[command(after_help = TRANSITION)]
pub struct Transition {
    /// The photograph or sheet of family 0; with --border of the only one
    pub first: PathBuf,
    /// The photograph or sheet of family 1
    #[arg(required_unless_present = "border", conflicts_with = "border")]
    pub second: Option<PathBuf>,
    /// The PNG file that is written
    #[arg(short, value_name = "OUT.png")]
    pub output_file: PathBuf,
    /// Make the borders of one family over nothing, with alpha
    #[arg(long)]
    pub border: bool,
    /// The pictures are sheets of compatible tiles, so many across and down
    #[arg(long, value_name = "CxR", value_parser = grid, conflicts_with = "size")]
    pub grid: Option<[u32; 2]>,
    /// Texels along a tile that is cut out of a photograph, 16 to 1024
    #[arg(long, value_name = "TEXELS", default_value_t = 128)]
    pub size: u32,
    /// Another number makes other borders and, of photographs, another choice of places
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u32,
    /// How errors are printed, on standard error
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub message_format: MessageFormat,
}

#[derive(clap::Args)]
#[command(after_help = LAYOUT)]
pub struct Layout {
    /// The PNG file that is written
    #[arg(short, value_name = "OUT.png")]
    pub output_file: PathBuf,
    /// Families of materials, 1 to 4
    #[arg(long, value_name = "M", default_value_t = 2)]
    pub families: u32,
    /// Texels along a tile, 16 to 1024
    #[arg(long, value_name = "TEXELS", default_value_t = 64)]
    pub size: u32,
    /// How errors are printed, on standard error
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub message_format: MessageFormat,
}

#[derive(clap::Args)]
#[command(after_help = CHECK)]
pub struct Check {
    /// The sheet: PNG, JPEG, TGA, OpenEXR or HDR
    pub sheet: PathBuf,
    /// Tiles across and down the sheet, at most 256
    #[arg(long, value_name = "CxR", default_value = "4x4", value_parser = grid)]
    pub grid: [u32; 2],
    /// Families of a sheet in corner-code order; 1 where any tile may stand beside any other
    #[arg(long, value_name = "M", default_value_t = 1)]
    pub families: u32,
    /// The levels, of 255, that facing texels may differ by
    #[arg(long, value_name = "LEVELS")]
    pub max: Option<u8>,
    /// How the figures are printed
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub format: Format,
    /// How errors are printed, on standard error
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub message_format: MessageFormat,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A table for people
    #[default]
    Text,
    /// One JSON object
    Json,
}

/// Columns and rows. How many there may be is for the library to say.
fn grid(text: &str) -> Result<[u32; 2], String> {
    let (columns, rows) = text.split_once(['x', 'X', '×']).ok_or("write columns and rows as 4x4")?;
    let count = |text: &str| {
        let number = text.parse().ok().filter(|number: &u32| *number > 0);
        number.ok_or_else(|| format!("a grid has 1 or more columns and rows, not `{text}`"))
    };
    Ok([count(columns)?, count(rows)?])
}
