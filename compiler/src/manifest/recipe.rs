//! What the bytes of a resource are made of.

use super::{Format, Texture};
use serde::{Deserialize, Serialize};

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
        /// Whether it is made to wrap.
        #[serde(default, skip_serializing_if = "Tileable::is_none")]
        tileable: Tileable,
    },
    /// Interchangeable tiles, one layer each: field `layers`. Field `means`: the mean of each, a texel
    /// each in one row, and last that of all.
    Patterns {
        /// Picture files: one with `grid` cells, or one per pattern.
        paths: Vec<String>,
        /// Columns and rows of the one picture; `[1, 1]` for a list of files. Row by row.
        grid: [u32; 2],
        /// How the numbers are read.
        encoding: Encoding,
    },
    /// Patterns on a line, one layer each, one texel high. Fields `layers` and `means` are those of
    /// [`Recipe::Patterns`].
    Strips {
        /// Picture files: one with `grid` cells, or one per pattern.
        paths: Vec<String>,
        /// Columns and rows of the one picture, as many rows as it has texels down; `[1, 1]` for a list
        /// of files. Row by row.
        grid: [u32; 2],
        /// How the numbers are read.
        encoding: Encoding,
    },
    /// Patterns in space, one layer a slice: layer pattern·depth + slice of field `layers`, of which
    /// level l holds the mean of the slice's group of 2^l, the slices of a pattern being grouped from
    /// its first on (a group that is not full has the mean of what it has). Field `means`: the mean
    /// of each slice, a texel each in one row, then that of all, then that of each pattern.
    Volumes {
        /// Picture files: one with `grid` cells, or one per slice.
        paths: Vec<String>,
        /// Columns and rows of the one picture; `[1, 1]` for a list of files. Row by row.
        grid: [u32; 2],
        /// Slices of one pattern, 1 to 256.
        depth: u32,
        /// How the numbers are read.
        encoding: Encoding,
    },
    /// Four independent permutations of 0..size: entry i holds σ₀(i)…σ₃(i). Rows of the program's
    /// [`Recipe::Tables`], one after the other, of [`Recipe::ROW`] entries each.
    Permutation {
        /// T, 2 to [`Recipe::MAX_PERMUTATION`].
        size: u32,
        /// Chooses the permutations.
        seed: i32,
    },
    /// A list of pattern numbers, each as often as it is probable. A row of the program's
    /// [`Recipe::Tables`]: entry i holds number i (the list wraps) and how often the number i stands
    /// in the list.
    Probability {
        /// The list, 1 to 4096 numbers from -1, the blank pattern, to 255.
        numbers: Vec<i32>,
    },
    /// Probabilities, or patterns, chosen by a number: a row of the program's [`Recipe::Tables`].
    /// Entry m of it stands for material m: where its list begins in the row, how long it is, its
    /// family, 0. An entry of a list holds a pattern's number and, at i from its beginning, how often
    /// number i stands in it; a list is repeated until both fit. Of patterns, field `layers` is that
    /// of all of them one after the other, field `means` the same with the mean of each material last.
    Materials {
        /// Indices of resources: all probabilities or all patterns.
        items: Vec<u32>,
        /// The family of each.
        families: Vec<i32>,
        /// Entries of each list: a common multiple of all lengths, where that is short; else 0, and
        /// each has its own.
        length: u32,
        /// Of patterns: the size to which they are resampled; none where they have one.
        size: Option<[u32; 2]>,
    },
    /// An integer map. Field `map`.
    Indices {
        /// Where the integers come from.
        source: IndicesSource,
        /// M: a picture's grey range is cut into M equal steps, numbered from 0 (black); numbers
        /// given as a list must be below it.
        levels: u32,
    },
    /// A row of integers. Field `map`, one texel high.
    Line {
        /// Where the integers come from: a picture of one row, or one row of numbers.
        source: IndicesSource,
        /// As of [`Recipe::Indices`].
        levels: u32,
    },
    /// An integer map in space. Field `map`, a layer for each slice.
    Stack {
        /// Where the integers come from: the rows of all slices, one slice below another.
        source: IndicesSource,
        /// As of [`Recipe::Indices`].
        levels: u32,
        /// Slices, 1 to 256.
        depth: u32,
    },
    /// A map of small numbers of which blocks of one number are not stored. Field `blocks`: a texel for
    /// each block, -1 - n where all of it is n, else the number i of its texels in field `pool`. There
    /// block i begins at texel (i % across · t, i / across), where t = ⌈block²·depth / 128⌉ texels hold
    /// a block and across = ⌊4096 / t⌋: its numbers row by row, `depth` bits each from the lowest on,
    /// in 4 words of 32 bits a texel. `depth` is 1, 2, 4 or 8, the least that holds the levels.
    PixelMap {
        /// A grey picture whose sides are multiples of the block.
        path: String,
        /// Texels along a side of a block, a power of two from 4 to 64.
        block: u32,
        /// M, 2 to 256: the grey range is cut into M equal steps, numbered from 0 (black).
        levels: u32,
    },
    /// Patterns at places of their own. Field `cells`, a texel for each cell and layer: the pattern's
    /// number, or -1; where its middle lies from the cell's upper left corner, x in the lower and y in
    /// the upper 16 bits, each (place + ½)·2¹⁵ in cells; the cosine and the sine of its turn, each over
    /// its scale, times 2¹⁶. In the pattern a place p cells from that corner is
    /// ½ + (c·d.x + s·d.y, c·d.y - s·d.x), where d = p - middle. A host may write texels while it draws.
    Positions {
        /// A RON list of sprites `(pattern: 3, at: (0.25, 0.5), scale: 0.8, turn: 0.125)`: the middle
        /// in 0..1 across the grid, the side in cells, and the part of a full turn, clockwise.
        path: String,
        /// Cells across and down.
        grid: [u32; 2],
        /// Sprites that a cell may hold.
        layers: u32,
        /// The index of the resource that holds the patterns.
        patterns: u32,
    },
    /// Small tables that share one texture, a row each. Field `table`: texel i of row r is entry i of
    /// the r-th of these resources; the width is that of the longest. A resource of several rows
    /// stands there as many times, one after the other.
    Tables {
        /// Indices of resources: permutations, probabilities, materials.
        rows: Vec<u32>,
    },
    /// A ramp of colours, filtered. Field `colors`: 256 texels across from the first stop to the last,
    /// as 16-bit floats; row 0 as it is, row r filtered by a Gaussian of standard deviation
    /// 2^(r/2 - 9.5) of the ramp's length, r to 21.
    Ramp {
        /// At least two, from low to high.
        stops: Vec<Stop>,
        /// Between stops.
        space: Space,
    },
    /// A picture to be tiled and blended (Deliot & Heitz 2019). Field `gaussian`: the picture with each
    /// of its decorrelated channels made Gaussian, of mean ½ and deviation 1/6 cut to 0..1, mipmapped;
    /// alpha as it is; of normals in 16-bit floats. Field `inverse`: `lut` texels across, a row for each of
    /// [`Recipe::INVERSE_LEVELS`] levels of channel 0, then of channel 1, and so on: what the channel
    /// adds to the colour (linear light, not premultiplied; of normals their slopes) where its Gaussian
    /// number is (x + ½)/`lut`, filtered as that level is; rows beyond the last level repeat it. Its
    /// alpha is added to each of red, green and blue, which are what is left. One more row is 1 where
    /// parts must not cross the picture's borders, else 0.
    Exemplar {
        /// The picture file.
        path: String,
        /// How its numbers are read.
        encoding: Encoding,
        /// How many channels are used: 3, 1 of a grey picture, 2 of normals.
        channels: u32,
        /// Whether parts may cross the picture's borders.
        borders: Borders,
        /// Texels across `inverse`, 128 to 1024.
        lut: u32,
        /// How `gaussian` is compressed where adapters can read that.
        compress: Compression,
    },
    /// An exemplar in space (§1.3 of the same): its slices are the cells of pictures. Field `gaussian` has a
    /// layer for each, of which level l holds the mean of its group of 2^l; field `inverse` is that of
    /// [`Recipe::Exemplar`].
    Volume {
        /// Picture files: one with `grid` cells, or one per slice.
        paths: Vec<String>,
        /// Columns and rows of the one picture; `[1, 1]` for a list of files. Row by row.
        grid: [u32; 2],
        /// How the numbers are read: `srgb` or `linear`.
        encoding: Encoding,
        /// 3, or 1 of grey slices.
        channels: u32,
        /// Whether parts may cross the borders.
        borders: Borders,
        /// Texels across `inverse`, 128 to 1024.
        lut: u32,
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

impl Recipe {
    /// The most entries of a permutation in a row of the shared tables.
    pub const ROW: u32 = 4096;
    /// How many rows a channel of an exemplar has in `inverse`: what a side of 8192 texels needs.
    pub const INVERSE_LEVELS: u32 = 14;
    /// The largest permutation.
    pub const MAX_PERMUTATION: u32 = 65_536;

    /// The files that it reads.
    pub fn files(&self) -> Vec<&str> {
        match self {
            Recipe::Image { path, .. }
            | Recipe::PixelMap { path, .. }
            | Recipe::Positions { path, .. }
            | Recipe::Exemplar { path, .. }
            | Recipe::Indices { source: IndicesSource::Path(path), .. }
            | Recipe::Line { source: IndicesSource::Path(path), .. }
            | Recipe::Stack { source: IndicesSource::Path(path), .. } => vec![path],
            Recipe::Patterns { paths, .. }
            | Recipe::Strips { paths, .. }
            | Recipe::Volumes { paths, .. }
            | Recipe::Volume { paths, .. } => paths.iter().map(String::as_str).collect(),
            Recipe::Indices { source: IndicesSource::Rows(_), .. }
            | Recipe::Line { source: IndicesSource::Rows(_), .. }
            | Recipe::Stack { source: IndicesSource::Rows(_), .. }
            | Recipe::Permutation { .. }
            | Recipe::Probability { .. }
            | Recipe::Materials { .. }
            | Recipe::Tables { .. }
            | Recipe::Ramp { .. }
            | Recipe::Bake { .. } => Vec::new(),
        }
    }

    /// The resources that it is made of, by index.
    pub fn resources(&self) -> &[u32] {
        match self {
            Recipe::Materials { items, .. } => items,
            Recipe::Positions { patterns, .. } => std::slice::from_ref(patterns),
            Recipe::Tables { rows } => rows,
            _ => &[],
        }
    }

    /// How many rows of the shared tables it takes, where it is one of them.
    pub fn rows(&self) -> u32 {
        match self {
            Recipe::Permutation { size, .. } => size.div_ceil(Recipe::ROW),
            _ => 1,
        }
    }
}

/// How a texture is compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Compression {
    /// Not at all.
    None,
    /// To half a byte a texel, without alpha.
    Bc1,
    /// To a byte a texel.
    Bc7,
}

impl Compression {
    /// The format; none of what is not compressed.
    pub fn format(self) -> Option<Format> {
        match self {
            Compression::None => None,
            Compression::Bc1 => Some(Format::Bc1RgbaUnorm),
            Compression::Bc7 => Some(Format::Bc7RgbaUnorm),
        }
    }
}

/// Whether parts of an exemplar may cross the borders of its picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Borders {
    /// As the picture needs it: inside, where opposite borders differ more than neighbours do.
    Auto,
    /// They may: the picture wraps.
    Repeat,
    /// They may not.
    Inside,
}

/// How a picture that does not wrap is made to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tileable {
    /// Not at all.
    #[default]
    None,
    /// An eighth of it at each border is crossed over with its middle, with the histogram kept.
    Blend,
}

impl Tileable {
    /// Whether the picture stays as it is.
    pub fn is_none(&self) -> bool {
        *self == Tileable::None
    }
}

/// A colour of a ramp.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stop {
    /// Where it stands.
    pub at: f32,
    /// Linear and premultiplied.
    pub color: [f32; 4],
}

/// The space in which colours are blended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Space {
    /// As light.
    Linear,
    /// As it is encoded for screens.
    Srgb,
    /// By equal steps for the eye (Ottosson, A perceptual color space for image processing, 2020).
    Oklab,
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
