//! Whether tiled and blended photographs have the colours of the photographs: distributions, means and
//! variances of 16 × 16 repeats, texel by texel and filtered, beside those of linear blending.
//!
//! Run with `cargo bench -p texgraph-runtime --no-default-features --bench stochastic`; `-- rock.jpg` for
//! some of the photographs only, `-- brief` for the first level only, `-- autocorrelation`, `-- means`,
//! `-- seams` or `-- blocks` for what is told of those instead; `-- blocks FOLDER/` draws there too.

mod autocorrelation;
mod blocks;
mod means;
mod seams;

use half::f16;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use texgraph_compiler::manifest::Encoding;
use texgraph_compiler::{Library, Options, Program, compile};
use texgraph_runtime::cpu::Scene;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{SrgbEncoder, Tables, load, srgb_to_linear};

/// Repeats along each axis, and how many are drawn at once.
const REPEATS: u32 = 16;
const PIECE: u32 = 4;

const PHOTOS: &[(&str, Encoding)] = &[
    ("brick_grey.png", Encoding::Srgb),
    ("cobbles.jpg", Encoding::Srgb),
    ("cobbles_normal.png", Encoding::Normal),
    ("forest_floor.jpg", Encoding::Srgb),
    ("forest_floor_normal.jpg", Encoding::Normal),
    ("grass_grey.png", Encoding::Srgb),
    ("gravel_grey.png", Encoding::Srgb),
    ("ice.jpg", Encoding::Srgb),
    ("planks.jpg", Encoding::Srgb),
    ("rock.jpg", Encoding::Srgb),
    ("sand.png", Encoding::Srgb),
];

fn main() {
    let asked: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let library = Library::standard().expect("the library is right");
    let is_asked = |file: &str| {
        let mut names = asked.iter().filter(|name| name.contains('.') && !name.ends_with('/')).peekable();
        names.peek().is_none() || names.any(|name| name == file)
    };
    let photos = PHOTOS.iter().filter(|(file, _)| is_asked(file));
    if asked.iter().any(|name| name == "autocorrelation") {
        return autocorrelation::tell(&library, photos);
    }
    if asked.iter().any(|name| name == "blocks") {
        let folder = asked.iter().find_map(|name| name.strip_suffix('/'));
        return blocks::tell(&library, photos, folder.map(Path::new));
    }
    if asked.iter().any(|name| name == "means") {
        return means::tell(&library, photos);
    }
    if asked.iter().any(|name| name == "seams") {
        return seams::tell(&library, photos);
    }
    let is_brief = asked.iter().any(|name| name == "brief");
    println!(
        "{REPEATS} × {REPEATS} repeats; distances are those of Kolmogorov and Smirnov, the worst channel"
    );
    for (file, encoding) in photos {
        // Where parts stay inside, the picture's middle is seen more often than its borders.
        if measure(&library, file, *encoding, "auto", is_brief) {
            measure(&library, file, *encoding, "repeat", is_brief);
        }
    }
}

/// A texture of a text over the photographs, and what it reads.
fn loaded(library: &Library, text: &str, texture: &str) -> (Program, Tables) {
    let files: HashMap<String, String> = [("main.tex".to_owned(), text.to_owned())].into();
    let options = Options { texture: Some(texture.into()), ..Options::default() };
    let compiled = compile(library, "main.tex", &files, &options);
    let mut program = compiled.unwrap_or_else(|error| panic!("{error:?}")).program;
    let project = Project::new(&photos().join("main.tex"), false);
    let tables = load(&mut program, &project).expect("the photograph is read");
    (program, tables)
}

fn photos() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/photos")
}

/// What an encoding is called, as in a text.
fn word(encoding: Encoding) -> &'static str {
    if encoding == Encoding::Normal { "normal" } else { "srgb" }
}

/// Colours in linear light, or the slopes of normals.
fn numbers([x, y, z, _]: [f32; 4], encoding: Encoding) -> [f64; 3] {
    let [x, y, z] = [x, y, z].map(f64::from);
    if encoding == Encoding::Normal { [-x / z.max(0.05), -y / z.max(0.05), 0.0] } else { [x, y, z] }
}

/// The same as a picture of 8 bits shows it.
fn shown([x, y, z, w]: [f32; 4], encoding: Encoding, encoder: &SrgbEncoder) -> [f64; 3] {
    let rounded = |x: f32| match encoding {
        Encoding::Normal => ((x.clamp(-1.0, 1.0) * 127.0).round()) / 127.0,
        _ => srgb_to_linear(f64::from(encoder.encode(x)) / 255.0) as f32,
    };
    numbers([rounded(x), rounded(y), rounded(z), w], encoding)
}

/// What is drawn: colours in linear light, slopes of normals.
struct Photo {
    programs: Vec<(&'static str, Program, Tables)>,
    side: u32,
    encoding: Encoding,
}

/// Whether parts stay inside. `is_brief`: at the first level alone.
fn measure(library: &Library, file: &str, encoding: Encoding, wrap: &str, is_brief: bool) -> bool {
    let picture = image::open(photos().join(file)).expect("a photograph");
    let side = picture.width();
    let is_normal = encoding == Encoding::Normal;
    let word = word(encoding);
    let texture = |name: &str, value: &str| {
        format!("texture {name}(uv: vec2) -> (value: vec4) {{ value = {value} }}\n")
    };
    let text = [
        format!(
            "let e = exemplar(\"{file}\", encoding: {word}, wrap: {wrap})\nlet i = image(\"{file}\", encoding: {word})\n"
        ),
        format!("let sigma = permutation({side})\n"),
        texture("repeated", "i.sample(uv)"),
        texture("histogram", "e.stochastic(uv, offsets: sigma)"),
        texture("linear", "e.stochastic(uv, offsets: sigma, blend: linear)"),
        // Between texels: each part lies elsewhere among them, and so do the pixels of the picture.
        texture(
            "shifted",
            &format!("i.sample(uv + hash(ifloor(uv * {side}.0)).xy / {side}.0, gradient: uv)"),
        ),
        texture("between", "e.stochastic(uv)"),
        texture("linear_between", "e.stochastic(uv, blend: linear)"),
        texture("two_between", "e.stochastic(uv, taps: 2)"),
    ];
    let text = text.concat();
    let names = ["repeated", "histogram", "linear", "shifted", "between", "linear_between", "two_between"];
    let programs = names.map(|name| {
        let (program, tables) = loaded(library, &text, name);
        (name, program, tables)
    });
    let photo = Photo { programs: programs.into(), side, encoding };
    let (_, program, tables) = &photo.programs[1];
    let inverse = floats(table(program, tables, "inverse"));
    let is_inside = inverse.ends_with(&[1.0]);
    println!("\n{file}, {side}², wrap: {}", if is_inside { "inside" } else { "repeat" });
    if !is_normal {
        let close = returned(&picture.to_rgb8(), table(program, tables, "gaussian"), &inverse);
        println!("  T⁻¹(T(I)) within one 8-bit step: {:.3} % of texels", 100.0 * close);
    }
    let axes = photo.axes();
    let [plain, ours, linear] = [3, 4, 5].map(|which| photo.drawn(which, 0, &axes));
    let [ours, theirs] = [&ours, &linear].map(|drawn| drawn.against(&plain));
    println!(
        "  between texels: distance {:.4} ({:.4}), variance {:+.1} % ({:+.1} %)",
        ours.distance,
        theirs.distance,
        100.0 * ours.variance,
        100.0 * theirs.variance
    );
    let two = photo.drawn(6, 0, &axes).against(&plain);
    println!("  with two taps: distance {:.4}, variance {:+.1} %", two.distance, 100.0 * two.variance);
    let [plain, texels] = [0, 1].map(|which| photo.drawn(which, 0, &axes));
    let texels = texels.against(&plain);
    println!("  texel by texel: along axes {:.4}, in 8 bits along each {:.4?}", texels.along, texels.shown);
    if is_brief {
        return is_inside;
    }
    println!("  level  distance (linear)  along axes (linear)   variance (linear)   mean, 255ths (linear)");
    // At the last level one texel is left, which tells no distribution.
    for level in 0..=side.ilog2() {
        let [plain, histogram, linear] = [0, 1, 2].map(|which| photo.drawn(which, level, &axes));
        let [ours, theirs] = [&histogram, &linear].map(|drawn| drawn.against(&plain));
        println!(
            "  {level:5}  {:.4} ({:.4})    {:.4} ({:.4})     {:+5.1} % ({:+5.1} %)   {:.2} ({:.2})",
            ours.distance,
            theirs.distance,
            ours.along,
            theirs.along,
            100.0 * ours.variance,
            100.0 * theirs.variance,
            255.0 * ours.mean,
            255.0 * theirs.mean,
        );
    }
    is_inside
}

/// The bytes of a field of the exemplar.
fn table<'a>(program: &Program, tables: &'a Tables, field: &str) -> &'a [u8] {
    let resources = &program.manifest.resources;
    let e = resources.iter().position(|resource| resource.name == "e").expect("the exemplar is there");
    tables.get(e, field).expect("the field is there")
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.chunks_exact(2).map(|pair| f16::from_le_bytes([pair[0], pair[1]]).to_f32()).collect()
}

/// The share of texels of which no channel is further off than one step, there and back.
fn returned(picture: &image::RgbImage, gaussian: &[u8], inverse: &[f32]) -> f64 {
    let encoder = SrgbEncoder::new();
    let rows = 3 * 14 + 1;
    let width = inverse.len() / 4 / rows;
    let channel = |channel: usize, code: u8| {
        let at = (f32::from(code) / 255.0 * width as f32 - 0.5).clamp(0.0, (width - 1) as f32);
        let (i, share) = ((at as usize).min(width - 2), at - (at as usize).min(width - 2) as f32);
        let entry = |i: usize| &inverse[4 * (channel * 14 * width + i)..][..4];
        let color = |i: usize| [0, 1, 2].map(|k| entry(i)[k] + entry(i)[3]);
        [0, 1, 2].map(|k| color(i)[k] * (1.0 - share) + color(i + 1)[k] * share)
    };
    let texels = picture.pixels().zip(gaussian.chunks_exact(4));
    let close = texels.filter(|(texel, codes)| {
        let parts = [0, 1, 2].map(|c| channel(c, codes[c]));
        (0..3).all(|k| {
            let light = parts[0][k] + parts[1][k] + parts[2][k];
            encoder.encode(light).abs_diff(texel[k]) <= 1
        })
    });
    close.count() as f64 / f64::from(picture.width() * picture.height())
}

/// How often numbers occur.
struct Drawn {
    /// Red, green, blue, and then along each axis.
    counts: Vec<Vec<u64>>,
    /// Along each axis, of pictures of 8 bits.
    shown: Vec<Vec<u64>>,
    sums: [f64; 3],
    squares: [f64; 3],
    count: f64,
}

/// How two differ.
struct Difference {
    distance: f64,
    along: f64,
    /// The same of pictures of 8 bits, along each.
    shown: Vec<f64>,
    variance: f64,
    mean: f64,
}

const BINS: usize = 1 << 17;

impl Photo {
    /// Three unit vectors along which the photograph's numbers are not correlated, those of the
    /// exemplar: what the texels of its table's first row differ by.
    fn axes(&self) -> Vec<[f64; 3]> {
        let (_, program, tables) = &self.programs[1];
        let inverse = floats(table(program, tables, "inverse"));
        let channels = if self.encoding == Encoding::Normal { 2 } else { 3 };
        let width = inverse.len() / 4 / (14 * channels + 1);
        let axis = |channel: usize| {
            let row = &inverse[4 * 14 * width * channel..][..4 * width];
            let color = |x: usize, k: usize| f64::from(row[4 * x + k]) + f64::from(row[4 * x + 3]);
            let difference = [0, 1, 2].map(|k| color(width - 1, k) - color(0, k));
            let length = difference.iter().map(|x| x * x).sum::<f64>().sqrt();
            (length > 1e-3).then(|| difference.map(|x| x / length))
        };
        (0..channels).filter_map(axis).collect()
    }

    fn drawn(&self, which: usize, level: u32, axes: &[[f64; 3]]) -> Drawn {
        let (_, program, tables) = &self.programs[which];
        let mut scene = Scene::new(program, tables, 0).expect("it can be drawn");
        let pieces = if level < 2 { REPEATS / PIECE } else { 1 };
        let repeats = REPEATS / pieces;
        let size = (self.side * repeats) >> level;
        let encoder = SrgbEncoder::new();
        let mut drawn = Drawn {
            counts: vec![vec![0; BINS]; 3 + axes.len()],
            shown: vec![vec![0; BINS]; axes.len()],
            sums: [0.0; 3],
            squares: [0.0; 3],
            count: 0.0,
        };
        // What repeats need not be drawn again.
        let all = if which == 0 || which == 3 { 1 } else { pieces * pieces };
        for piece in 0..all {
            let [x, y] = [piece % pieces, piece / pieces].map(|i| f64::from(i * repeats));
            let region = [x, y, x + f64::from(repeats), y + f64::from(repeats)];
            let request = Request { region, ..Request::new([size; 2]) };
            let picture = scene.render(&request, &|_| {}).expect("it is drawn");
            for pixel in &picture.pixels {
                drawn.add(numbers(*pixel, self.encoding), axes);
                drawn.count_shown(shown(*pixel, self.encoding, &encoder), axes);
            }
        }
        drawn
    }
}

/// From -4 to 4, which slopes may have.
fn bin(x: f64) -> usize {
    ((x + 4.0) / 8.0 * BINS as f64).clamp(0.0, BINS as f64 - 1.0) as usize
}

impl Drawn {
    fn add(&mut self, numbers: [f64; 3], axes: &[[f64; 3]]) {
        for (k, x) in numbers.into_iter().enumerate() {
            self.sums[k] += x;
            self.squares[k] += x * x;
            self.counts[k][bin(x)] += 1;
        }
        for (axis, counts) in axes.iter().zip(&mut self.counts[3..]) {
            counts[bin(axis.iter().zip(numbers).map(|(a, x)| a * x).sum())] += 1;
        }
        self.count += 1.0;
    }

    fn count_shown(&mut self, numbers: [f64; 3], axes: &[[f64; 3]]) {
        for (axis, counts) in axes.iter().zip(&mut self.shown) {
            counts[bin(axis.iter().zip(numbers).map(|(a, x)| a * x).sum())] += 1;
        }
    }

    fn mean(&self, k: usize) -> f64 {
        self.sums[k] / self.count
    }

    fn variance(&self, k: usize) -> f64 {
        self.squares[k] / self.count - self.mean(k).powi(2)
    }

    fn against(&self, plain: &Drawn) -> Difference {
        let apart = |these: &[u64], those: &[u64]| {
            let (mut one, mut other, mut most) = (0.0, 0.0, 0.0_f64);
            for (a, b) in these.iter().zip(those) {
                one += *a as f64 / self.count;
                other += *b as f64 / plain.count;
                most = most.max(f64::abs(one - other));
            }
            most
        };
        let distance = |of: usize| apart(&self.counts[of], &plain.counts[of]);
        let shown = self.shown.iter().zip(&plain.shown).map(|(these, those)| apart(these, those));
        let all = self.counts.len();
        let more = (0..3).filter(|k| plain.variance(*k) > 1e-9);
        let more = more.map(|k| self.variance(k) / plain.variance(k) - 1.0);
        Difference {
            distance: (0..3).map(distance).fold(0.0, f64::max),
            along: (3..all).map(distance).fold(0.0, f64::max),
            shown: shown.collect(),
            variance: more.fold(0.0, |most: f64, x| if x.abs() > most.abs() { x } else { most }),
            mean: (0..3).map(|k| (self.mean(k) - plain.mean(k)).abs()).fold(0.0, f64::max),
        }
    }
}
