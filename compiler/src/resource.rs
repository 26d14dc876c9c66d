//! Resources as the graph knows them, and the table of resource kinds.
//!
//! A kind is one row here (its constructor, in the language's own notation, the fields that shaders
//! read, and how the arguments become a [`Recipe`]) and one file in the runtime, which makes the
//! bytes.

use crate::diagnostic::{Diagnostic, Place, constructors};
use crate::graph::{Constant, FunctionId, Scalar, Texel, View, ViewDimension};
use crate::manifest::{Encoding, Filter, Format, Recipe, Space, Stop, Tileable, Wrap};

mod exemplar;
mod indices;
mod materials;
pub mod pixel_map;
mod positions;
mod probability;
mod strips;
mod volumes;

/// A resource of a program: one constructor call.
#[derive(Clone, Debug, PartialEq)]
pub struct Resource {
    /// The name of its `let`.
    pub name: String,
    /// Its documentation.
    pub label: String,
    /// The constructor call, for errors that only loading finds.
    pub place: Place,
    /// What its bytes are made of.
    pub recipe: Recipe,
    /// The sampler of its views, if they are sampled.
    pub sampler: Option<SamplerState>,
    /// Of a bake: the function that gives its texels, from a place in 0..1 to four floats.
    pub bake: Option<FunctionId>,
}

/// How a view is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SamplerState {
    /// What lies outside 0..1.
    pub wrap: Wrap,
    /// Within and between levels.
    pub filter: Filter,
    /// The most samples along the longer gradient, 1 to 16.
    pub anisotropy: u8,
}

/// A row of the table.
pub struct Kind {
    /// The constructor's and the type's name.
    pub name: &'static str,
    /// What the constructor takes. Besides the language's types: `text`, `texts` (one string or a
    /// list of them), `cells` (a string or rows of ints), `row` (a string or a list of ints), `numbers` (a list of them), `resources`
    /// (a list of them) and `stops` (lists of a place and a colour, any number of them one after the
    /// other).
    pub constructor: &'static str,
    /// One line for the reference.
    pub doc: &'static str,
    /// The kind that the constructor makes, if that is another row's.
    pub gives: Option<&'static str>,
    /// What shaders read.
    pub fields: &'static [Field],
    /// The view that `sample`, `texel` and `.size` of the resource itself mean.
    pub view: Option<&'static str>,
    /// Arguments to a recipe. `Err` for a kind that is not built yet.
    pub make: fn(&Arguments) -> Result<Made, Diagnostic>,
}

impl Kind {
    /// The view that a resource of this kind stands for.
    pub fn stands_for(&self) -> Option<View> {
        let field = self.fields.iter().find(|field| Some(field.name) == self.view)?;
        field.kind.view()
    }
}

/// A field of a kind.
pub struct Field {
    /// Its name.
    pub name: &'static str,
    /// What it is.
    pub kind: FieldKind,
}

/// What a field is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum FieldKind {
    /// A texture.
    View(View),
    /// A row of the texture that all small tables share, as [`SHARED`]; the constant `row` tells
    /// which.
    Row,
    /// A number known from the arguments.
    Constant,
    /// A texture that belongs to the resource that the constructor was given, where it is the field of
    /// the same name.
    Lent(View),
    /// The resource itself seen as one of another kind, by its name: the views and constants of that
    /// kind's fields are those of the same name (constants need not be fields here), but for its
    /// `count`, which is named here. There is none where that is 0.
    As(&'static str, &'static str),
    /// The size of a map of another dimension than the plane: across in texels of a view, by its name,
    /// on a line; in space also down, and as deep as a constant says, by its name.
    Size(&'static str, Option<&'static str>),
    /// A colour that is read: the texel of the first row of a view, at a constant; both by name.
    Texel(&'static str, &'static str),
}

impl FieldKind {
    /// The texture, if it is one.
    pub fn view(self) -> Option<View> {
        match self {
            FieldKind::View(view) | FieldKind::Lent(view) => Some(view),
            FieldKind::Row => Some(SHARED),
            FieldKind::Constant | FieldKind::Size(..) | FieldKind::Texel(..) | FieldKind::As(..) => None,
        }
    }
}

/// What a constructor call makes.
pub struct Made {
    /// What the bytes are made of.
    pub recipe: Recipe,
    /// The values of the constant fields, by name.
    pub constants: Vec<(&'static str, Constant)>,
    /// How the views are sampled.
    pub sampler: Option<SamplerState>,
    /// The resource whose textures are lent.
    pub lender: Option<u32>,
}

/// The arguments of a constructor call, defaults filled in.
pub struct Arguments {
    /// The call.
    pub place: Place,
    /// The file that holds the call, to resolve paths against.
    pub file: String,
    /// Each with its input's name and its place.
    pub values: Vec<(String, Place, Argument)>,
}

/// One argument of a constructor.
pub enum Argument {
    /// A string.
    Text(String),
    /// A list of strings.
    Texts(Vec<String>),
    /// Rows of ints.
    Rows(Vec<Vec<i32>>),
    /// Stops of a ramp.
    Stops(Vec<Stop>),
    /// A list of numbers, with where each stands.
    Numbers(Vec<(Constant, Place)>),
    /// A list of resources.
    Resources(Vec<Part>),
    /// A number.
    Number(Constant),
    /// A bare word.
    Word(String),
    /// A node.
    Node,
    /// What was not given and has no default.
    Absent,
}

/// A resource that another is made of.
#[derive(Clone)]
pub struct Part {
    /// Its number among the program's resources.
    pub index: u32,
    /// Its kind's name.
    pub kind: &'static str,
    /// What its bytes are made of.
    pub recipe: Recipe,
    /// Its constant fields.
    pub constants: Vec<(&'static str, Constant)>,
    /// How it is sampled.
    pub sampler: Option<SamplerState>,
    /// Where it is named.
    pub place: Place,
}

impl Part {
    /// A constant field that is an int; 0 where there is none.
    fn int(&self, name: &str) -> i32 {
        self.constants.iter().find(|(field, _)| *field == name).map_or(0, |(_, constant)| constant.int(0))
    }
}

impl Arguments {
    fn get(&self, name: &str) -> Option<(&Argument, Place)> {
        self.values.iter().find(|(n, ..)| n == name).map(|(_, place, argument)| (argument, *place))
    }

    fn place(&self, name: &str) -> Place {
        self.get(name).map_or(self.place, |(_, place)| place)
    }

    fn word(&self, name: &str) -> &str {
        match self.get(name) {
            Some((Argument::Word(word), _)) => word,
            _ => "",
        }
    }

    fn int(&self, name: &str) -> i32 {
        match self.get(name) {
            Some((Argument::Number(c), _)) => c.int(0),
            _ => 0,
        }
    }

    /// A float, or an int as one.
    fn float(&self, name: &str) -> f32 {
        match self.get(name) {
            Some((Argument::Number(c), _)) if c.scalar() == Scalar::Float => c.float(0),
            _ => self.int(name) as f32,
        }
    }

    /// A list of numbers, with where each stands; none where none was given.
    fn numbers(&self, name: &str) -> Option<&[(Constant, Place)]> {
        match self.get(name) {
            Some((Argument::Numbers(numbers), _)) => Some(numbers),
            _ => None,
        }
    }

    /// A list of resources.
    fn parts(&self, name: &str) -> &[Part] {
        match self.get(name) {
            Some((Argument::Resources(parts), _)) => parts,
            _ => &[],
        }
    }

    /// A count that must lie within bounds.
    fn count(&self, name: &str, low: i32, high: i32) -> Result<u32, Diagnostic> {
        let count = self.int(name);
        if (low..=high).contains(&count) {
            Ok(count as u32)
        } else {
            Err(constructors::out_of_bounds(self.place(name), name, count, low, high))
        }
    }

    fn paths(&self, name: &str) -> Vec<String> {
        let written = match self.get(name) {
            Some((Argument::Text(path), _)) => std::slice::from_ref(path),
            Some((Argument::Texts(paths), _)) => paths,
            _ => &[],
        };
        written.iter().map(|path| crate::module::resolve(&self.file, path)).collect()
    }

    fn encoding(&self) -> Encoding {
        match self.word("encoding") {
            "linear" => Encoding::Linear,
            "normal" => Encoding::Normal,
            _ => Encoding::Srgb,
        }
    }

    fn filter(&self) -> Filter {
        if self.word("filter") == "nearest" { Filter::Nearest } else { Filter::Linear }
    }

    fn wrap(&self) -> Wrap {
        match self.word("wrap") {
            "clamp" => Wrap::Clamp,
            "mirror" => Wrap::Mirror,
            _ => Wrap::Repeat,
        }
    }

    /// How a picture is sampled.
    fn sampler(&self, wrap: Wrap) -> Result<SamplerState, Diagnostic> {
        let anisotropy = self.count("anisotropy", 1, 16)? as u8;
        if anisotropy > 1 && self.filter() == Filter::Nearest {
            return Err(constructors::anisotropy_of_nearest(self.place("anisotropy")));
        }
        Ok(SamplerState { wrap, filter: self.filter(), anisotropy })
    }
}

const PIXELS: View = View { dimension: ViewDimension::D2, texel: Texel::Sampled, anisotropy: 1 };
const LAYERS: View = View { dimension: ViewDimension::D2Array, texel: Texel::Sampled, anisotropy: 1 };
const MAPS: View = View { dimension: ViewDimension::D2Array, texel: Texel::Integer, anisotropy: 1 };
const INTEGERS: View = View { dimension: ViewDimension::D2, texel: Texel::Integer, anisotropy: 1 };

/// The texture that small tables of ints share, a row each: a graph stays inside the number of
/// textures that a shader may read.
pub const SHARED: View = INTEGERS;

/// The constant that says how a resource's views are sampled, where that is more than once.
pub const ANISOTROPY: &str = "anisotropy";

/// The most layers of a texture: what every GPU can hold.
const MAX_LAYERS: i64 = 256;

/// The longest side of a bake: what every GPU can hold.
const MAX_BAKE: i32 = 8192;

/// Every kind.
pub static KINDS: &[Kind] = &[
    Kind {
        name: "image",
        constructor: "(path: text, wrap: repeat | clamp | mirror = repeat, filter: linear | nearest = linear, \
                      encoding: srgb | linear | normal = srgb, anisotropy: int = 1, \
                      tileable: none | blend = none) -> image",
        doc: "A picture with its mip levels.",
        gives: None,
        fields: &[Field { name: "pixels", kind: FieldKind::View(PIXELS) }],
        view: Some("pixels"),
        make: make_image,
    },
    Kind {
        name: "patterns",
        constructor: "(paths: texts, grid: ivec2 = 1, encoding: srgb | linear | normal = srgb, \
                      filter: linear | nearest = linear, anisotropy: int = 1) -> patterns",
        doc: "Interchangeable tiles, one layer each with its own mip levels.",
        gives: None,
        fields: &[
            Field { name: "layers", kind: FieldKind::View(LAYERS) },
            Field { name: "means", kind: FieldKind::View(PIXELS) },
            Field { name: "average", kind: FieldKind::Texel("means", "count") },
            Field { name: "count", kind: FieldKind::Constant },
            Field { name: "linear", kind: FieldKind::Constant },
            Field { name: "taps", kind: FieldKind::Constant },
            Field { name: "normals", kind: FieldKind::Constant },
        ],
        view: None,
        make: make_patterns,
    },
    Kind {
        name: "patterns<1>",
        constructor: "(paths: texts, grid: ivec2 = 1, encoding: srgb | linear | normal = srgb, \
                      filter: linear | nearest = linear) -> patterns",
        doc: "Interchangeable strips, a row of texels and a layer each with its own mip levels.",
        gives: None,
        fields: &[
            Field { name: "layers", kind: FieldKind::View(LAYERS) },
            Field { name: "means", kind: FieldKind::View(PIXELS) },
            Field { name: "average", kind: FieldKind::Texel("means", "count") },
            Field { name: "strips", kind: FieldKind::As("patterns", "count") },
            Field { name: "count", kind: FieldKind::Constant },
            Field { name: "linear", kind: FieldKind::Constant },
            Field { name: "taps", kind: FieldKind::Constant },
            Field { name: "normals", kind: FieldKind::Constant },
        ],
        view: None,
        make: strips::make,
    },
    Kind {
        name: "patterns<3>",
        constructor: "(paths: texts, depth: int, grid: ivec2 = 1, encoding: srgb | linear | normal = srgb, \
                      filter: linear | nearest = linear) -> patterns",
        doc: "Interchangeable blocks of slices, one layer a slice; mip levels average across slices too.",
        gives: None,
        fields: &[
            Field { name: "layers", kind: FieldKind::View(LAYERS) },
            Field { name: "means", kind: FieldKind::View(PIXELS) },
            Field { name: "average", kind: FieldKind::Texel("means", "total") },
            Field { name: "slices", kind: FieldKind::As("patterns", "total") },
            Field { name: "count", kind: FieldKind::Constant },
            Field { name: "depth", kind: FieldKind::Constant },
            Field { name: "total", kind: FieldKind::Constant },
            Field { name: "linear", kind: FieldKind::Constant },
            Field { name: "taps", kind: FieldKind::Constant },
            Field { name: "normals", kind: FieldKind::Constant },
        ],
        view: None,
        make: volumes::make,
    },
    Kind {
        name: "permutation",
        constructor: "(size: int, seed: int = 0) -> permutation",
        doc: "A table of four independent permutations of 0..size, at most 65,536.",
        gives: None,
        fields: &[
            Field { name: "table", kind: FieldKind::Row },
            Field { name: "size", kind: FieldKind::Constant },
            Field { name: "across", kind: FieldKind::Constant },
            Field { name: "row", kind: FieldKind::Constant },
        ],
        view: None,
        make: make_permutation,
    },
    Kind {
        name: "probability",
        constructor: "(numbers: numbers = none, weights: numbers = none, size: int = 0, \
                      blank: float = 0.0) -> probability",
        doc: "A list of pattern numbers, each as often as it is probable; -1 is the blank pattern.",
        gives: None,
        fields: &[
            Field { name: "table", kind: FieldKind::Row },
            Field { name: "size", kind: FieldKind::Constant },
            Field { name: "least", kind: FieldKind::Constant },
            Field { name: "reach", kind: FieldKind::Constant },
            Field { name: "row", kind: FieldKind::Constant },
        ],
        view: None,
        make: probability::make,
    },
    Kind {
        name: "materials",
        constructor: "(items: resources, families: numbers = none, size: ivec2 = 0) -> materials",
        doc: "Probabilities, or patterns, chosen by a number.",
        gives: None,
        fields: &[
            Field { name: "table", kind: FieldKind::Row },
            Field { name: "layers", kind: FieldKind::View(LAYERS) },
            Field { name: "means", kind: FieldKind::View(PIXELS) },
            Field { name: "patterns", kind: FieldKind::As("patterns", "tiles") },
            Field { name: "count", kind: FieldKind::Constant },
            Field { name: "size", kind: FieldKind::Constant },
            Field { name: "least", kind: FieldKind::Constant },
            Field { name: "reach", kind: FieldKind::Constant },
            Field { name: "tiles", kind: FieldKind::Constant },
            Field { name: "linear", kind: FieldKind::Constant },
            Field { name: "taps", kind: FieldKind::Constant },
            Field { name: "normals", kind: FieldKind::Constant },
            Field { name: "row", kind: FieldKind::Constant },
        ],
        view: None,
        make: materials::make,
    },
    Kind {
        name: "indices",
        constructor: "(cells: cells, levels: int = 256) -> indices",
        doc: "An integer map, which wraps.",
        gives: None,
        fields: &[
            Field { name: "map", kind: FieldKind::View(INTEGERS) },
            Field { name: "levels", kind: FieldKind::Constant },
        ],
        view: Some("map"),
        make: indices::in_the_plane,
    },
    Kind {
        name: "indices<1>",
        constructor: "(cells: row, levels: int = 256) -> indices",
        doc: "A row of integers, which wraps.",
        gives: None,
        fields: &[
            Field { name: "map", kind: FieldKind::View(INTEGERS) },
            Field { name: "size", kind: FieldKind::Size("map", None) },
            Field { name: "levels", kind: FieldKind::Constant },
        ],
        view: None,
        make: indices::on_a_line,
    },
    Kind {
        name: "indices<3>",
        constructor: "(cells: cells, depth: int, levels: int = 256) -> indices",
        doc: "An integer map of slices, a layer each, which wraps.",
        gives: None,
        fields: &[
            Field { name: "map", kind: FieldKind::View(MAPS) },
            Field { name: "size", kind: FieldKind::Size("map", Some("depth")) },
            Field { name: "depth", kind: FieldKind::Constant },
            Field { name: "levels", kind: FieldKind::Constant },
        ],
        view: None,
        make: indices::in_space,
    },
    Kind {
        name: "positions",
        constructor: "(path: text, grid: ivec2, patterns: patterns, layers: int = 1) -> positions",
        doc: "Patterns at places of their own, which can change while the program runs.",
        gives: None,
        fields: &[
            Field { name: "cells", kind: FieldKind::View(MAPS) },
            Field { name: "layers", kind: FieldKind::Lent(LAYERS) },
            Field { name: "means", kind: FieldKind::Lent(PIXELS) },
            Field { name: "patterns", kind: FieldKind::As("patterns", "tiles") },
            Field { name: "grid", kind: FieldKind::Constant },
            Field { name: "most", kind: FieldKind::Constant },
            Field { name: "tiles", kind: FieldKind::Constant },
        ],
        view: None,
        make: positions::make,
    },
    Kind {
        name: "pixel_map",
        constructor: "(path: text, block: int = 16, levels: int = 2) -> pixel_map",
        doc: "A large map of which only the blocks are stored that hold more than one number.",
        gives: None,
        fields: &[
            Field { name: "blocks", kind: FieldKind::View(INTEGERS) },
            Field { name: "pool", kind: FieldKind::View(INTEGERS) },
            Field { name: "block", kind: FieldKind::Constant },
            Field { name: "levels", kind: FieldKind::Constant },
            Field { name: "depth", kind: FieldKind::Constant },
            Field { name: "across", kind: FieldKind::Constant },
        ],
        view: None,
        make: pixel_map::make,
    },
    Kind {
        name: "ramp",
        constructor: "(stops: stops, space: linear | srgb | oklab = oklab) -> ramp",
        doc: "A ramp of colours, filtered by how far its place spreads.",
        gives: None,
        fields: &[
            Field { name: "colors", kind: FieldKind::View(PIXELS) },
            Field { name: "low", kind: FieldKind::Constant },
            Field { name: "high", kind: FieldKind::Constant },
        ],
        view: None,
        make: make_ramp,
    },
    Kind {
        name: "exemplar",
        constructor: "(path: text, encoding: srgb | linear | normal = srgb, channels: int = 3, \
                      wrap: auto | repeat | inside = auto, compress: none | bc1 | bc7 = none, lut: int = 256, \
                      anisotropy: int = 1) -> exemplar",
        doc: "A photograph whose parts `stochastic` tiles and blends without end.",
        gives: None,
        fields: &[
            Field { name: "gaussian", kind: FieldKind::View(PIXELS) },
            Field { name: "inverse", kind: FieldKind::View(PIXELS) },
            Field { name: "channels", kind: FieldKind::Constant },
            Field { name: "normals", kind: FieldKind::Constant },
            Field { name: "taps", kind: FieldKind::Constant },
            Field { name: "inside", kind: FieldKind::Constant },
            Field { name: "width", kind: FieldKind::Constant },
            Field { name: "bc", kind: FieldKind::Constant },
            Field { name: "levels", kind: FieldKind::Constant },
        ],
        view: None,
        make: exemplar::make,
    },
    Kind {
        name: "exemplar<3>",
        constructor: "(paths: texts, grid: ivec2 = 1, encoding: srgb | linear = srgb, channels: int = 3, \
                      wrap: auto | repeat | inside = auto, lut: int = 256) -> exemplar",
        doc: "A block of slices whose parts `stochastic` tiles and blends without end in space.",
        gives: None,
        fields: &[
            Field { name: "gaussian", kind: FieldKind::View(LAYERS) },
            Field { name: "inverse", kind: FieldKind::View(PIXELS) },
            Field { name: "channels", kind: FieldKind::Constant },
            Field { name: "normals", kind: FieldKind::Constant },
            Field { name: "inside", kind: FieldKind::Constant },
            Field { name: "width", kind: FieldKind::Constant },
            Field { name: "bc", kind: FieldKind::Constant },
            Field { name: "levels", kind: FieldKind::Constant },
            Field { name: "depth", kind: FieldKind::Constant },
        ],
        view: None,
        make: exemplar::make_volume,
    },
    Kind {
        name: "bake",
        constructor: "(field: node(uv: vec2) -> texel, size: ivec2 = 512, \
                      wrap: repeat | clamp | mirror = repeat, filter: linear | nearest = linear, \
                      format: rgba16float | rgba8unorm | rgba8snorm = rgba16float) -> image",
        doc: "The values of a node over 0..1, a texel each, with mip levels: a virtual texture made explicit.",
        gives: Some("image"),
        fields: &[],
        view: None,
        make: make_bake,
    },
];

/// The row of the kind that a row's constructor makes.
pub fn made_by(row: usize) -> usize {
    let gives = KINDS[row].gives;
    gives.and_then(|name| KINDS.iter().position(|kind| kind.name == name)).unwrap_or(row)
}

/// Kinds of the language that are not built yet.
pub const LATER: &[&str] = &["images", "volume", "sprites"];

/// Kinds that have a dimension. In two it need not be written, in others it is part of the name.
pub const DIMENSIONAL: &[&str] = &["indices", "patterns", "exemplar"];

/// The row that a name stands for, with the dimension that is written after it.
pub fn kind_named(name: &str, dimension: Option<u8>) -> Option<usize> {
    let named = |kind: &Kind| match dimension {
        None => kind.name == name,
        Some(2) => kind.name == name && DIMENSIONAL.contains(&name),
        Some(n) => kind.name.strip_prefix(name).is_some_and(|rest| rest == format!("<{n}>")),
    };
    KINDS.iter().position(named)
}

/// A kind's name without its dimension, and that.
pub fn dimension_of(kind: &'static Kind) -> (&'static str, Option<u8>) {
    match kind.name.split_once('<') {
        Some((name, rest)) => (name, rest.trim_end_matches('>').parse().ok()),
        None => (kind.name, DIMENSIONAL.contains(&kind.name).then_some(2)),
    }
}

fn make_image(a: &Arguments) -> Result<Made, Diagnostic> {
    let sampler = a.sampler(a.wrap())?;
    let path = a.paths("path").into_iter().next().unwrap_or_default();
    let tileable = if a.word("tileable") == "blend" { Tileable::Blend } else { Tileable::None };
    if tileable == Tileable::Blend && sampler.wrap != Wrap::Repeat {
        return Err(constructors::tileable_without_repeat(a.place("tileable"), a.word("wrap")));
    }
    Ok(Made {
        recipe: Recipe::Image { path, encoding: a.encoding(), tileable },
        constants: Vec::new(),
        sampler: Some(sampler),
        lender: None,
    })
}

fn make_bake(a: &Arguments) -> Result<Made, Diagnostic> {
    let size = match a.get("size") {
        Some((Argument::Number(c), _)) => [c.int(0), c.int(1)],
        _ => [1, 1],
    };
    if let Some(side) = size.iter().find(|side| !(1..=MAX_BAKE).contains(*side)) {
        return Err(constructors::out_of_bounds(a.place("size"), "size", *side, 1, MAX_BAKE));
    }
    let format = match a.word("format") {
        "rgba8unorm" => Format::Rgba8Unorm,
        "rgba8snorm" => Format::Rgba8Snorm,
        _ => Format::Rgba16Float,
    };
    Ok(Made {
        recipe: Recipe::Bake { size: size.map(|side| side as u32), format },
        constants: Vec::new(),
        sampler: Some(SamplerState { wrap: a.wrap(), filter: a.filter(), anisotropy: 1 }),
        lender: None,
    })
}

fn make_patterns(a: &Arguments) -> Result<Made, Diagnostic> {
    let sampler = a.sampler(Wrap::Clamp)?;
    let Cells { paths, grid, count, place } = Cells::of(a)?;
    if !(1..=MAX_LAYERS).contains(&count) {
        return Err(constructors::too_many_patterns(place, count));
    }
    let taps = i32::from(sampler.anisotropy);
    Ok(Made {
        constants: pattern_constants(a, count, taps),
        recipe: Recipe::Patterns { paths, grid, encoding: a.encoding() },
        // The library's nodes take the taps, so that they reach other patterns.
        sampler: Some(SamplerState { anisotropy: 1, ..sampler }),
        lender: None,
    })
}

/// The constants that patterns of any dimension have.
fn pattern_constants(a: &Arguments, count: i64, taps: i32) -> Vec<(&'static str, Constant)> {
    let linear = i32::from(a.filter() == Filter::Linear);
    let normals = i32::from(a.encoding() == Encoding::Normal);
    let all = [("count", count as i32), ("linear", linear), ("taps", taps), ("normals", normals)];
    all.map(|(name, value)| (name, Constant::ints(&[value]))).into()
}

/// The pictures of patterns, and how they are cut.
struct Cells {
    paths: Vec<String>,
    grid: [u32; 2],
    /// How many cells all pictures have.
    count: i64,
    /// The argument that says how many.
    place: Place,
}

impl Cells {
    fn of(a: &Arguments) -> Result<Cells, Diagnostic> {
        let paths = a.paths("paths");
        let place = a.place("grid");
        let (columns, rows) = match a.get("grid") {
            Some((Argument::Number(c), _)) => (c.int(0), c.int(1)),
            _ => (1, 1),
        };
        if columns < 1 || rows < 1 {
            return Err(constructors::empty_grid(place, columns, rows));
        }
        if paths.len() != 1 && (columns, rows) != (1, 1) {
            return Err(constructors::grid_of_a_list(place));
        }
        let cells = i64::from(columns) * i64::from(rows);
        Ok(Cells {
            grid: [columns as u32, rows as u32],
            count: cells.saturating_mul(paths.len() as i64),
            place: if cells > 1 { place } else { a.place("paths") },
            paths,
        })
    }
}

fn make_ramp(a: &Arguments) -> Result<Made, Diagnostic> {
    let stops = match a.get("stops") {
        Some((Argument::Stops(stops), _)) => stops.clone(),
        _ => Vec::new(),
    };
    let place = a.place("stops");
    let [first, .., last] = stops.as_slice() else { return Err(constructors::too_few_stops(place)) };
    if first.at >= last.at || stops.windows(2).any(|pair| pair[0].at > pair[1].at) {
        return Err(constructors::stops_in_disorder(place));
    }
    let ends = [("low", first.at), ("high", last.at)];
    let space = match a.word("space") {
        "linear" => Space::Linear,
        "srgb" => Space::Srgb,
        _ => Space::Oklab,
    };
    Ok(Made {
        recipe: Recipe::Ramp { stops, space },
        constants: ends.map(|(name, at)| (name, Constant::floats(&[at]))).into(),
        sampler: Some(SamplerState { wrap: Wrap::Clamp, filter: Filter::Linear, anisotropy: 1 }),
        lender: None,
    })
}

fn make_permutation(a: &Arguments) -> Result<Made, Diagnostic> {
    let size = a.count("size", 2, Recipe::MAX_PERMUTATION as i32)?;
    let fields = [("size", size), ("across", size.min(Recipe::ROW))];
    Ok(Made {
        recipe: Recipe::Permutation { size, seed: a.int("seed") },
        constants: fields.map(|(name, value)| (name, Constant::ints(&[value as i32]))).into(),
        sampler: None,
        lender: None,
    })
}
