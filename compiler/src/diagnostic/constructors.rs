//! Sentences about constructors' arguments: what can be told without opening a file.

use super::{Diagnostic, Place, Suggestion};
use crate::manifest::Encoding;

/// A number that an argument can't have.
pub fn out_of_bounds(place: Place, what: &str, found: i32, low: i32, high: i32) -> Diagnostic {
    Diagnostic::new("E0551", place, format!("`{what}` is {found}, outside {low} to {high}"), "this number")
        .help(format!("choose a number from {low} to {high}"))
}

/// A number that must be a power of two.
pub fn no_power_of_two(place: Place, what: &str, found: u32) -> Diagnostic {
    let message = format!("`{what}` is {found}, which is no power of two");
    let (below, above) = (1 << found.max(1).ilog2(), 2 << found.max(1).ilog2());
    Diagnostic::new("E0551", place, message, "this number").help(format!("choose {below} or {above}"))
}

/// A grid without cells.
pub fn empty_grid(place: Place, columns: i32, rows: i32) -> Diagnostic {
    Diagnostic::new("E0552", place, format!("a grid of {columns} × {rows} has no cells"), "this grid")
        .help("give the columns and rows of the picture, `grid: ivec2(4, 4)`")
}

/// A grid for several files.
pub fn grid_of_a_list(place: Place) -> Diagnostic {
    Diagnostic::new(
        "E0553",
        place,
        "a list of pictures has no grid",
        "each picture of the list is one pattern",
    )
    .help("leave `grid:` out, or give one picture")
}

/// More layers than a texture has.
pub fn too_many_patterns(place: Place, count: i64) -> Diagnostic {
    Diagnostic::new(
        "E0554",
        place,
        format!("these are {count} patterns, from 1 to 256 are possible"),
        "this many",
    )
    .help("a pattern is a layer of a texture array, which has at most 256")
}

/// More slices of patterns in space than one texture may hold.
pub fn too_many_slices(place: Place, count: i64, label: impl Into<String>) -> Diagnostic {
    let message = format!("these are {count} slices, from 1 to 256 are possible");
    Diagnostic::new("E0554", place, message, label)
        .help("a slice is a layer of a texture array, which has at most 256")
}

/// Slices that make no whole number of patterns.
pub fn uneven_depth(place: Place, depth: u32, count: i64) -> Diagnostic {
    Diagnostic::new(
        "E0552",
        place,
        format!("{count} slices are no whole number of patterns of {depth}"),
        format!("{} would be left over", count % i64::from(depth)),
    )
    .help("`grid` counts the slices of all patterns, `depth` those of one")
}

/// Rows of a map that make no whole number of slices.
pub fn uneven_slices(place: Place, depth: u32, rows: usize) -> Diagnostic {
    Diagnostic::new(
        "E0552",
        place,
        format!("{rows} rows are not {depth} slices of one height"),
        format!("{} would be left over", rows % depth.max(1) as usize),
    )
    .help("the slices of a map in space stand one below another, each with as many rows")
}

/// Rows of different lengths, or none.
pub fn ragged_rows(place: Place) -> Diagnostic {
    Diagnostic::new("E0555", place, "the rows of a map must have one length, at least 1", "this list")
        .help("write it as `[[0, 1], [1, 0]]`")
}

/// An argument that is not a value of the kind wanted.
pub fn wrong_argument(place: Place, input: &str, wanted: &str) -> Diagnostic {
    Diagnostic::new("E0556", place, format!("`{input}` takes {wanted}"), "this does not fit")
}

/// Something else where a ramp has its stops.
pub fn not_a_stop(place: Place) -> Diagnostic {
    Diagnostic::new("E0556", place, "a stop of a ramp is a place and a colour", "this is none")
        .help("write it as `[0.5, #8d8f94]`")
}

/// A ramp of one colour.
pub fn too_few_stops(place: Place) -> Diagnostic {
    Diagnostic::new("E0556", place, "a ramp leads from a stop to another", "only this one")
        .help("write at least two: `[0.0, #1b1d22], [1.0, #f4f1ea]`")
}

/// Stops that stand in another order than along the ramp.
pub fn stops_in_disorder(place: Place) -> Diagnostic {
    Diagnostic::new("E0556", place, "the stops of a ramp go from low to high places", "these stops")
        .help("two may share a place, for a hard edge; the first must be below the last")
}

/// A path that stands without quotes.
pub fn unquoted_path(place: Place, path: &str) -> Diagnostic {
    Diagnostic::new("E0556", place, "a path stands between quotes", "not a string")
        .help(format!("write `\"{path}\"`"))
        .suggest(Some(Suggestion::replace(place, format!("\"{path}\"")).sure()))
}

/// A constructor's argument that is not known before the program runs.
pub fn not_known(place: Place, input: &str) -> Diagnostic {
    Diagnostic::new(
        "E0302",
        place,
        format!("`{input}` of a resource must be known before anything is drawn"),
        "this changes while the program runs",
    )
    .help("resources are made once, when loading: use constants")
}

/// Anisotropy where texels are not blended.
pub fn anisotropy_of_nearest(place: Place) -> Diagnostic {
    Diagnostic::new("E0556", place, "with `filter: nearest` there is no anisotropy", "only 1 is possible")
        .help("leave `anisotropy:` or `filter:` out")
}

/// A picture made to wrap, which is not sampled so.
pub fn tileable_without_repeat(place: Place, wrap: &str) -> Diagnostic {
    let message = format!("with `wrap: {wrap}` a picture's borders never meet");
    Diagnostic::new("E0556", place, message, "nothing to blend")
        .help("leave `tileable:` out, or repeat the picture: `wrap: repeat`")
}

/// Channels of an exemplar that its encoding does not have.
pub fn channels_of_exemplar(place: Place, asked: u32, encoding: Encoding) -> Diagnostic {
    let (of, fit) = match encoding {
        Encoding::Normal => ("normals", "normals have 2, their slopes"),
        Encoding::Srgb | Encoding::Linear => ("a picture", "use 3, or 1 of a grey picture"),
    };
    Diagnostic::new("E0556", place, format!("`channels: {asked}` does not fit an exemplar of {of}"), fit)
}

/// A probability of neither a list nor weights, or of both.
pub fn list_or_weights(place: Place, both: bool) -> Diagnostic {
    let message = if both {
        "a probability is a list of numbers or has weights, not both"
    } else {
        "a probability needs a list of numbers, or weights"
    };
    Diagnostic::new("E0557", place, message, "this call")
        .help("write `probability([0, 0, 0, 1])`, or `probability(weights: [3, 1], size: 64)`")
}

/// An empty list of pattern numbers, or weights of which none is above 0.
pub fn nothing_probable(place: Place) -> Diagnostic {
    Diagnostic::new("E0557", place, "no pattern is probable", "at least one number above 0 is needed")
}

/// A weight below 0.
pub fn negative_weight(place: Place) -> Diagnostic {
    Diagnostic::new("E0557", place, "a weight is below 0", "as often as this nothing can be")
        .help("a pattern of weight 0 is never chosen")
}

/// A list of its own length that is given another, or the number of a pattern that is no int.
pub fn not_a_list_of_patterns(place: Place) -> Diagnostic {
    Diagnostic::new("E0557", place, "the list holds numbers of patterns, which are ints", "this is a float")
        .help("for weights, write `weights: [0.5, 0.5]`")
}

/// A size beside a list.
pub fn size_of_a_list(place: Place, entries: usize) -> Diagnostic {
    Diagnostic::new(
        "E0557",
        place,
        format!("the list has {entries} entries, and that is its size"),
        "not chosen here",
    )
    .help("leave `size:` and `blank:` out; they say how weights are rounded")
}

/// A weight that no entry of the list is left for.
pub fn list_too_short(place: Place, size: u32, least: u32) -> Diagnostic {
    let help = match least {
        0 => "drop the pattern, or bring the weights nearer together".to_owned(),
        least => format!("from `size: {least}` on every weight has an entry"),
    };
    Diagnostic::new(
        "E0557",
        place,
        format!("a list of {size} entries has none for this weight"),
        "the pattern would never be chosen",
    )
    .help(help)
}

/// Materials of nothing.
pub fn no_materials(place: Place) -> Diagnostic {
    Diagnostic::new("E0558", place, "there are no materials in this list", "at least one is needed")
        .help("write `materials([meadow, gravel])`")
}

/// Something other than a probability or patterns among materials, or one of the two among the other.
pub fn not_a_material(place: Place, kind: &str, others: Option<&str>) -> Diagnostic {
    let message = match others {
        Some(others) => format!("this is `{kind}`, the materials before it are `{others}`"),
        None => format!("`{kind}` is no material"),
    };
    Diagnostic::new("E0558", place, message, "here")
        .help("materials are all `probability`, or all `patterns`")
}

/// Patterns that one texture can't hold together.
pub fn materials_differ(place: Place, what: &str) -> Diagnostic {
    Diagnostic::new(
        "E0558",
        place,
        format!("these patterns have another {what} than those before them"),
        "the patterns of all materials are layers of one texture",
    )
    .help(format!("make all of them with the same `{what}`"))
}

/// A number of families that is not that of the materials.
pub fn families_of_others(place: Place, families: usize, materials: usize) -> Diagnostic {
    Diagnostic::new(
        "E0558",
        place,
        format!("{families} families for {materials} materials"),
        "one number for each material",
    )
}

/// Lists that have too many entries together.
pub fn materials_too_long(place: Place, entries: u64, most: u64) -> Diagnostic {
    Diagnostic::new(
        "E0558",
        place,
        format!("the lists of these materials have {entries} entries, at most {most} fit"),
        "too many together",
    )
    .help("give the probabilities a smaller `size`")
}
