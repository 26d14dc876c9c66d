//! Sentences about resources: what only opening the files can tell.
//!
//! They stand at the constructor call. The runtime finds them, all at once, when it loads.

use super::{Diagnostic, Place};

/// The file is not there.
pub fn missing_file(place: Place, path: &str, near: Option<&str>) -> Diagnostic {
    Diagnostic::new("E0501", place, format!("there is no file `{path}`"), "named here")
        .maybe_help(near.map(|near| format!("is `{near}` meant?")))
}

/// The path leaves the program's folder, by its text or through a link.
pub fn outside(place: Place, path: &str, link: bool) -> Diagnostic {
    let message = if link {
        format!("a link on the way to `{path}` leads out of the program's folder")
    } else {
        format!("`{path}` lies outside the program's folder")
    };
    Diagnostic::new("E0502", place, message, "a program reads its own folder only")
        .help("copy the file into the folder, or allow it with --allow-outside")
}

/// A folder, or something that the system refuses to read.
pub fn unreadable_file(place: Place, path: &str, reason: &str) -> Diagnostic {
    Diagnostic::new("E0503", place, format!("`{path}` can't be read"), reason)
}

/// A file of too many bytes.
pub fn file_too_large(place: Place, path: &str, limit: u64) -> Diagnostic {
    Diagnostic::new(
        "E0504",
        place,
        format!("`{path}` has more than {} MiB", limit >> 20),
        "a file of this size is not opened",
    )
    .help("save the picture smaller, or with compression")
}

/// Bytes that are no whole picture.
pub fn not_a_picture(place: Place, path: &str, reason: &str) -> Diagnostic {
    Diagnostic::new("E0505", place, format!("`{path}` can't be read as a picture"), reason)
        .help("PNG, JPEG and TGA pictures with 8 or 16 bits a channel, OpenEXR and HDR are read")
}

/// A picture that claims, or has, more texels than are decoded.
pub fn picture_too_large(place: Place, path: &str, size: [u32; 2], limit: u32) -> Diagnostic {
    let [width, height] = size;
    let label = format!("at most {limit}×{limit}, and 1 GiB of texels, are decoded");
    Diagnostic::new("E0506", place, format!("`{path}` has {width}×{height} texels"), label)
}

/// A grid that cuts through texels.
pub fn uneven_grid(place: Place, path: &str, size: [u32; 2], grid: [u32; 2]) -> Diagnostic {
    let [width, height] = size;
    let [columns, rows] = grid;
    let fit = |texels: u32, cells: u32| (texels.max(cells) / cells.max(1)) * cells;
    Diagnostic::new(
        "E0507",
        place,
        format!("a grid of {columns}×{rows} does not divide `{path}`, which has {width}×{height} texels"),
        "every pattern must have the same whole number of texels",
    )
    .help(format!("crop the picture to {}×{}, or change `grid`", fit(width, columns), fit(height, rows)))
}

/// Patterns on a line that are more than one texel high.
pub fn cells_are_no_rows(place: Place, path: &str, cell: [u32; 2], grid: [u32; 2]) -> Diagnostic {
    let [width, height] = cell;
    Diagnostic::new(
        "E0507",
        place,
        format!("the patterns of `{path}` have {width}×{height} texels"),
        "a pattern on a line is one row of texels",
    )
    .help(format!("give every row a cell, `grid: ivec2({}, {})`", grid[0], grid[1] * height))
}

/// A map on a line that has more than one row.
pub fn map_is_no_row(place: Place, path: &str, [width, height]: [u32; 2]) -> Diagnostic {
    Diagnostic::new(
        "E0507",
        place,
        format!("`{path}` has {width}×{height} texels"),
        "a map on a line is one row of texels",
    )
    .help("crop the picture to its first row, or make it a map of the plane, `indices`")
}

/// A map whose slices have no whole number of rows.
pub fn uneven_slices(place: Place, path: &str, [width, height]: [u32; 2], depth: u32) -> Diagnostic {
    let fit = (height.max(depth) / depth.max(1)) * depth;
    Diagnostic::new(
        "E0507",
        place,
        format!("{depth} slices do not divide `{path}`, which has {width}×{height} texels"),
        "every slice must have the same whole number of rows",
    )
    .help(format!("crop the picture to {width}×{fit}, or change `depth`"))
}

/// A map whose blocks would be cut off at its edges.
pub fn uneven_blocks(place: Place, path: &str, size: [u32; 2], block: u32) -> Diagnostic {
    let [width, height] = size;
    let fit = |texels: u32| texels.div_ceil(block.max(1)) * block;
    Diagnostic::new(
        "E0507",
        place,
        format!("blocks of {block} do not divide `{path}`, which has {width}×{height} texels"),
        "every block must have the same whole number of texels",
    )
    .help(format!("extend the picture to {}×{}, or change `block`", fit(width), fit(height)))
}

/// A picture that no whole number of blocks covers.
pub fn uneven_compression(place: Place, path: &str, [width, height]: [u32; 2]) -> Diagnostic {
    let fit = |texels: u32| texels.max(4) / 4 * 4;
    Diagnostic::new(
        "E0507",
        place,
        format!("`{path}` has {width}×{height} texels, and can't be compressed"),
        "blocks of compressed textures have 4×4 texels",
    )
    .help(format!("crop the picture to {}×{}, or leave `compress` out", fit(width), fit(height)))
}

/// Transparency where the format has none.
pub fn transparency_of_bc1(place: Place, path: &str) -> Diagnostic {
    Diagnostic::new("E0509", place, format!("`{path}` is transparent in places"), "bc1 holds no transparency")
        .help("write `compress: bc7`")
}

/// Files of one resource that differ in size.
pub fn sizes_differ(place: Place, first: (&str, [u32; 2]), other: (&str, [u32; 2])) -> Diagnostic {
    let (path, [width, height]) = first;
    let (odd, [odd_width, odd_height]) = other;
    Diagnostic::new(
        "E0508",
        place,
        format!("`{odd}` has {odd_width}×{odd_height} texels, but `{path}` has {width}×{height}"),
        "patterns of one resource are layers of one texture",
    )
    .help(format!("scale `{odd}` to {width}×{height}"))
}

/// Patterns of materials that differ in size.
pub fn materials_of_sizes(place: Place, first: (&str, [u32; 2]), other: (&str, [u32; 2])) -> Diagnostic {
    let (path, [width, height]) = first;
    let (odd, [odd_width, odd_height]) = other;
    let what = format!(
        "patterns of `{odd}` have {odd_width}×{odd_height} texels, those of `{path}` {width}×{height}"
    );
    Diagnostic::new("E0508", place, what, "the patterns of all materials are layers of one texture")
        .help(format!("have them resampled: `size: ivec2({width}, {height})`"))
}

/// More layers than every GPU has.
pub fn too_many_layers(place: Place, layers: u64, limit: u32) -> Diagnostic {
    Diagnostic::new(
        "E0554",
        place,
        format!("{layers} patterns are too many"),
        format!("a texture has at most {limit} layers"),
    )
    .help("spread them over several resources, and choose between these with `if`")
}

/// Sizes or numbers in the constructor's arguments that make no table.
pub fn no_table(place: Place, message: impl Into<String>, reason: impl Into<String>) -> Diagnostic {
    Diagnostic::new("E0551", place, message, reason)
}

/// A texture with a side longer than every GPU has.
pub fn texture_too_large(place: Place, path: &str, size: [u32; 2], limit: u32) -> Diagnostic {
    let [width, height] = size;
    Diagnostic::new(
        "E0511",
        place,
        format!("a texture of `{path}` would have {width}×{height} texels"),
        format!("a texture has at most {limit} texels along a side"),
    )
    .help("reduce the picture, or cut it into `patterns`")
}

/// A texture of too many bytes.
pub fn too_many_bytes(place: Place, bytes: u64, limit: u64) -> Diagnostic {
    let mebibytes = bytes.div_ceil(1 << 20);
    let label = format!("at most {} MiB a resource", limit >> 20);
    Diagnostic::new("E0512", place, format!("the textures of this resource take {mebibytes} MiB"), label)
        .help("reduce the pictures, or use fewer")
}

/// A picture with colours where only grey has a meaning.
pub fn not_grey(place: Place, path: &str, at: [u32; 2]) -> Diagnostic {
    let [x, y] = at;
    Diagnostic::new(
        "E0513",
        place,
        format!("`{path}` is not grey: the texel at column {x}, row {y} has a colour"),
        "an integer map is read from a grey picture",
    )
    .help("save it as a grey picture")
}

/// A file that holds something other than sprites.
pub fn not_sprites(place: Place, path: &str, reason: &str) -> Diagnostic {
    Diagnostic::new(
        "E0514",
        place,
        format!("`{path}` can't be read as a list of sprites"),
        reason.replace('\n', " "),
    )
    .help("write `[(pattern: 3, at: (0.25, 0.5), scale: 0.8, turn: 0.125)]`")
}

/// A sprite that can't be.
pub fn bad_sprite(place: Place, path: &str, number: usize, reason: &str) -> Diagnostic {
    Diagnostic::new("E0514", place, format!("sprite {number} of `{path}` can't be placed"), reason)
        .help("sprites are counted from 0; patterns are those of `patterns:`")
}

/// Two sprites that want one cell.
pub fn cell_taken(place: Place, path: &str, sprites: [usize; 2], cell: [u32; 2], layers: u32) -> Diagnostic {
    let ([first, second], [x, y]) = (sprites, cell);
    Diagnostic::new(
        "E0515",
        place,
        format!("sprites {first} and {second} of `{path}` want the cell in column {x}, row {y}"),
        format!("a cell holds {layers}"),
    )
    .help(format!("write `layers: {}`, move one of them, or use a finer `grid`", layers + 1))
}
