//! Filtering of patterns across the borders of tiles: what `tiled` and `reference` promise, on the
//! CPU and on the GPU. GPU tests are shown as ignored where there is no adapter;
//! `TEXGRAPH_GPU=required` makes that a failure.

use libtest_mimic::{Arguments, Failed, Trial};
use std::path::Path;
use std::sync::Arc;
use texgraph_compiler::manifest::{Format, Gradients, Table};
use texgraph_compiler::{Library, Options, Plane, Program, compile, diagnostic::render};
use texgraph_runtime::cpu;
use texgraph_runtime::gpu::{Gpu, Preference};
use texgraph_runtime::picture::Picture;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, load};

/// A channel may differ by this much from the same picture made otherwise.
const TOLERANCE: f32 = 1.0 / 255.0;
const SIDE: u32 = 128;
/// Sides of one tile in pixels, from much magnified to many tiles a pixel.
const PIXELS_A_TILE: [f64; 16] =
    [512.0, 130.0, 47.3, 32.0, 16.0, 13.7, 9.1, 8.0, 5.3, 3.1, 2.0, 1.4, 1.0, 0.77, 0.6, 0.1];

/// What draws: the CPU, or a GPU.
#[derive(Clone)]
enum Renderer {
    Cpu,
    Gpu(Arc<Gpu>),
}

type Test = fn(&Renderer) -> Result<(), Failed>;

fn main() {
    let arguments = Arguments::from_args();
    let required = std::env::var("TEXGRAPH_GPU").is_ok_and(|value| value == "required");
    let gpu = Gpu::new(Preference::Hardware).map(Arc::new);
    let tests: [(&str, Test); 15] = [
        ("copies_of_one_pattern_are_the_repeated_image", copies_are_the_repeated_image),
        ("a_wrapped_pattern_is_the_repeated_image", wrapped_is_the_repeated_image),
        ("the_level_has_no_seam", the_level_has_no_seam),
        ("different_patterns_are_one_picture", different_patterns_are_one_picture),
        ("a_pattern_alone_lies_on_nothing", alone_lies_on_nothing),
        ("anisotropic_copies_are_the_repeated_image", anisotropic_copies_are_the_repeated_image),
        ("an_anisotropic_wrapped_pattern_is_the_repeated_image", anisotropic_wrapped_is_the_repeated_image),
        ("an_anisotropic_pattern_alone_lies_on_nothing", anisotropic_alone_lies_on_nothing),
        ("far_tiles_become_the_mean", far_tiles_become_the_mean),
        ("far_anisotropic_tiles_become_the_mean", far_anisotropic_tiles_become_the_mean),
        ("weighted_means_are_sums_of_means", weighted_means_are_sums),
        ("levels_are_those_of_the_filter", levels_are_those_of_the_filter),
        ("levels_count_on_anisotropy", levels_count_on_anisotropy),
        ("a_sampled_value_changes_as_it_is_drawn", sampled_values_change_as_drawn),
        ("a_ramp_is_the_mean_over_a_pixel", a_ramp_is_the_mean_over_a_pixel),
    ];
    let mut trials = vec![
        Trial::test("anisotropic_samples_keep_their_gradient", keep_their_gradient),
        Trial::test("anisotropic_tiles_on_the_ground_are_sharper", on_the_ground_are_sharper),
    ];
    for (name, test) in tests {
        trials.push(Trial::test(format!("cpu::{name}"), move || test(&Renderer::Cpu)));
        let gpu = gpu.clone();
        let ignored = gpu.is_err() && !required;
        let run = move || test(&Renderer::Gpu(gpu.map_err(|error| error.to_string())?));
        trials.push(Trial::test(format!("gpu::{name}"), run).with_ignored_flag(ignored));
    }
    libtest_mimic::run(&arguments, trials).exit();
}

/// A folder with `tiles.png`: two by two tiles of 16 by 16 texels of noise, some transparent, and
/// `one.png`, the first of them; and with `flat.png`, all the same.
fn folder() -> Result<tempfile::TempDir, Failed> {
    let folder = tempfile::tempdir()?;
    let texel = |x: u32, y: u32| {
        let word = (x * 73 + y * 151 + 7).wrapping_mul(2_654_435_761);
        let [r, g, b, a] = (word ^ (word >> 13)).wrapping_mul(2_246_822_519).to_be_bytes();
        image::Rgba([r, g, b, a | 0x3f])
    };
    let save =
        |name: &str, side: u32| image::RgbaImage::from_fn(side, side, texel).save(folder.path().join(name));
    save("tiles.png", 32)?;
    save("one.png", 16)?;
    Ok(folder)
}

/// The same with `wide.png`: the first tile with nothing around it, four tiles a side.
fn folder_with_wide() -> Result<tempfile::TempDir, Failed> {
    let folder = folder()?;
    let one = image::open(folder.path().join("one.png"))?.to_rgba8();
    let mut wide = image::RgbaImage::new(64, 64);
    image::imageops::replace(&mut wide, &one, 16, 16);
    wide.save(folder.path().join("wide.png"))?;
    Ok(folder)
}

/// A program with its tables, from a source.
fn loaded(folder: &Path, source: &str) -> Result<(Program, Tables), Failed> {
    loaded_with(folder, source, &Options::default())
}

fn loaded_with(folder: &Path, source: &str, options: &Options) -> Result<(Program, Tables), Failed> {
    let file = folder.join("main.tex");
    std::fs::write(&file, source)?;
    let library = Library::standard()?;
    let project = Project::new(&file, true);
    let compiled = compile(&library, project.main(), &project, options);
    let compiled = compiled.map_err(|f| render::human(&f.sources, &f.diagnostics))?;
    let mut program = compiled.program;
    let tables = load(&mut program, &project).map_err(|d| render::human(&compiled.sources, &d))?;
    Ok((program, tables))
}

/// The pictures of a program over several views.
fn draw(
    renderer: &Renderer,
    (program, tables): &(Program, Tables),
    requests: &[Request],
) -> Result<Vec<Picture>, Failed> {
    let drawn: Result<Vec<Picture>, _> = match renderer {
        Renderer::Cpu => {
            requests.iter().map(|request| cpu::render(program, tables, request, &|_| {})).collect()
        }
        Renderer::Gpu(gpu) => gpu.prepare(program, tables, 0).and_then(|mut prepared| {
            requests.iter().map(|request| prepared.render(request, &|_| {})).collect()
        }),
    };
    drawn.map_err(|error| error.to_string().into())
}

/// A view over a plane of tiles of side 1, not aligned to them; pixels are a little higher than wide.
fn view(pixels_a_tile: f64) -> Request {
    let side = f64::from(SIDE) / pixels_a_tile;
    let region = [-0.4037 * side, -0.3019 * side, 0.5963 * side, 0.7 * side];
    Request { region, ..Request::new([SIDE, SIDE]) }
}

/// Draws both at the zooms at which a tile has at least so many pixels; they are the same.
fn same(renderer: &Renderer, folder: &Path, sources: [&str; 2], least_pixels: f64) -> Result<(), Failed> {
    let zooms: Vec<f64> = PIXELS_A_TILE.into_iter().filter(|pixels| *pixels >= least_pixels).collect();
    let requests: Vec<Request> = zooms.iter().copied().map(view).collect();
    let [one, two] = sources.map(|source| draw(renderer, &loaded(folder, source)?, &requests));
    for ((pixels, one), two) in zooms.iter().zip(&one?).zip(&two?) {
        let worst = worst(one, two);
        if worst > TOLERANCE {
            return Err(format!("at {pixels} pixels a tile they differ by {:.3}/255", worst * 255.0).into());
        }
    }
    Ok(())
}

/// The greatest difference of a channel.
fn worst(one: &Picture, two: &Picture) -> f32 {
    let pixels = one.pixels.iter().flatten().zip(two.pixels.iter().flatten());
    pixels.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// A GPU's own level of detail may be off its definition by this much: its logarithm is made of
/// straight pieces, in lavapipe of one for each octave.
const OWN_LEVEL: f32 = 0.09;

/// The picture repeated. By [`OWN_LEVEL`], which shows where levels differ as much as in noise, a GPU
/// samples it at the level as it is defined.
fn repeated(renderer: &Renderer) -> &'static str {
    match renderer {
        Renderer::Cpu => {
            r#"
let one = image("one.png")
texture t(uv: vec2) -> (color: color) { color = one.sample(uv) }
"#
        }
        Renderer::Gpu(_) => AT_ITS_LEVEL,
    }
}

const AT_ITS_LEVEL: &str = r#"
let one = image("one.png")
texture t(uv: vec2) -> (color: color) { color = one.sample(uv, lod: one.level(uv)) }
"#;

fn copies_are_the_repeated_image(renderer: &Renderer) -> Result<(), Failed> {
    let folder = folder()?;
    let source = r#"
let one = patterns("one.png")
texture t(uv: vec2) -> (color: color) {
    let (cell, at) = tile_map(uv, ivec2(1))
    color = one.tiled(cell, at, |c| 0, edges: blend)
}
"#;
    same(renderer, folder.path(), [source, repeated(renderer)], 0.0)
}

fn wrapped_is_the_repeated_image(renderer: &Renderer) -> Result<(), Failed> {
    let folder = folder()?;
    let source = r#"
let one = patterns("one.png")
texture t(uv: vec2) -> (color: color) { color = one.reference(0, uv, edges: wrap) }
"#;
    same(renderer, folder.path(), [source, repeated(renderer)], 0.0)
}

/// The four tiles of one picture, each where it was, are that picture: until levels are reached
/// where a texel of the picture is more than a tile.
fn different_patterns_are_one_picture(renderer: &Renderer) -> Result<(), Failed> {
    let folder = folder()?;
    let source = r#"
let tiles = patterns("tiles.png", grid: ivec2(2))
texture t(uv: vec2) -> (color: color) {
    let (cell, at) = tile_map(uv, ivec2(1))
    color = tiles.tiled(cell, at, |c| c.x % 2 + 2 * (c.y % 2))
}
"#;
    let other = r#"
let tiles = image("tiles.png")
texture t(uv: vec2) -> (color: color) { color = tiles.sample(uv * 0.5, lod: tiles.level(uv * 0.5)) }
"#;
    same(renderer, folder.path(), [source, other], 1.0)
}

/// 0, 1/8, 2/8, … as 16-bit floats.
const EIGHTHS: [u16; 5] = [0, 0x3000, 0x3400, 0x3600, 0x3800];

/// Gives a resource levels of one colour each: level l is grey l / 8.
/// In 16-bit floats: of 8 bits a software adapter blends levels in 8 bits too.
fn flatten((program, tables): &mut (Program, Tables)) {
    let textures = program.manifest.resources.iter_mut().enumerate();
    let textures = textures.flat_map(|(index, r)| r.textures.iter_mut().map(move |texture| (index, texture)));
    for (index, texture) in textures.filter(|(_, texture)| texture.field != "means") {
        let Some(old) = &texture.table else { continue };
        let table = Table::mipmapped(Format::Rgba16Float, [old.width, old.height], old.layers);
        let mut bytes = Vec::new();
        for (level, grey) in table.levels.iter().zip(EIGHTHS) {
            bytes.extend(grey.to_le_bytes().repeat(level.bytes(table.format) as usize / 2));
        }
        texture.table = Some(table);
        tables.insert(index, &texture.field, bytes);
    }
}

fn the_level_has_no_seam(renderer: &Renderer) -> Result<(), Failed> {
    let folder = folder()?;
    let bodies = [
        "color = tiles.tiled(cell, at, |c| virtual_index(c, 4), far: vec4(vec3(0.5), 1.0))",
        "color = tiles.tiled(cell, at, |c| virtual_index(c, 4), edges: clamp, far: vec4(0.5))",
        "color = tiles.reference(virtual_index(cell, 4), at)",
        "color = tiles.reference(0, uv, edges: wrap)",
        "let (far, there) = tile_map(turned(uv), ivec2(1))
         color = sharp.tiled(far, there, |c| virtual_index(c, 4), far: vec4(vec3(0.5), 1.0))",
        "color = sharp.reference(0, turned(uv), edges: wrap)",
        "color = tiles.tiled(cell, at, |c| virtual_index(c, 4), far: vec4(vec3(0.5), 1.0), orient: 8)",
    ];
    for body in bodies {
        let source = format!(
            "{TURNED}\nlet tiles = patterns(\"tiles.png\", grid: ivec2(2))\n\
             let sharp = patterns(\"tiles.png\", grid: ivec2(2), anisotropy: 8)\n\
             texture t(uv: vec2) -> (color: color) {{\n\
             let (cell, at) = tile_map(uv, ivec2(1))\n{body}\n}}"
        );
        let mut made = loaded(folder.path(), &source)?;
        flatten(&mut made);
        let pictures = draw(renderer, &made, &PIXELS_A_TILE.map(view))?;
        for (pixels, picture) in PIXELS_A_TILE.iter().zip(pictures) {
            let reds = || picture.pixels.iter().map(|pixel| pixel[0]);
            let (low, high) = (reds().fold(9.0, f32::min), reds().fold(-9.0, f32::max));
            if high - low > 1e-3 {
                return Err(format!("{body}: {low} to {high} at {pixels} pixels a tile").into());
            }
        }
    }
    Ok(())
}

/// Beyond its edges a pattern is nothing: the same as in the middle of a transparent picture.
fn alone_lies_on_nothing(renderer: &Renderer) -> Result<(), Failed> {
    let folder = folder_with_wide()?;
    let source = r#"
let one = patterns("one.png")
texture t(uv: vec2) -> (color: color) { color = one.reference(0, uv, edges: clear) }
"#;
    let other = r#"
let wide = image("wide.png", wrap: clamp)
texture t(uv: vec2) -> (color: color) {
    let at = uv * 0.25 + 0.25
    color = wide.sample(at, lod: wide.level(at))
}
"#;
    same(renderer, folder.path(), [source, other], 1.0)
}

/// A place four times as long down the picture as across, along no axis of the tiles.
const TURNED: &str = "node turned(uv: vec2) -> (at: vec2) {
    at = vec2(0.8 * uv.x - 2.4 * uv.y, 0.6 * uv.x + 3.2 * uv.y)
}";

/// What an anisotropic filter is to see of a picture at a place that is longer down than across.
const TAPPED: &str = "node tapped(one: image, at: vec2) -> (color: color) {
    let texels = at * one.size
    let width  = max(length(dx(texels)), 1.0)
    let count  = max(int(ceil(length(dy(texels)) / width - 0.01)), 1)
    let taps = fold (sum = vec4(0.0)) for i in 0..count max 8 {
        sum = sum + one.sample(at + dy(at) * ((i + 0.5) / count - 0.5), lod: log2(width))
    }
    color = taps / count
}";

fn anisotropic_copies_are_the_repeated_image(renderer: &Renderer) -> Result<(), Failed> {
    let tiled = "let (cell, at) = tile_map(turned(uv), ivec2(1))\n color = one.tiled(cell, at, |c| 0)";
    is_tapped(renderer, tiled, 0.0)
}

fn anisotropic_wrapped_is_the_repeated_image(renderer: &Renderer) -> Result<(), Failed> {
    is_tapped(renderer, "color = one.reference(0, turned(uv), edges: wrap)", 0.0)
}

/// A pattern whose sampler is anisotropic gives the mean of taps of the repeated picture.
fn is_tapped(renderer: &Renderer, body: &str, least_pixels: f64) -> Result<(), Failed> {
    let source = format!(
        "{TURNED}\nlet one = patterns(\"one.png\", anisotropy: 8)\n\
         texture t(uv: vec2) -> (color: color) {{ {body} }}"
    );
    let other = format!(
        "{TURNED}\n{TAPPED}\nlet one = image(\"one.png\")\n\
         texture t(uv: vec2) -> (color: color) {{ color = tapped(one, turned(uv)) }}"
    );
    same(renderer, folder()?.path(), [&source, &other], least_pixels)
}

fn anisotropic_alone_lies_on_nothing(renderer: &Renderer) -> Result<(), Failed> {
    let folder = folder_with_wide()?;
    let source = format!(
        "{TURNED}\nlet one = patterns(\"one.png\", anisotropy: 8)\n\
         texture t(uv: vec2) -> (color: color) {{ color = one.reference(0, turned(uv), edges: clear) }}"
    );
    let other = format!(
        "{TURNED}\n{TAPPED}\nlet wide = image(\"wide.png\", wrap: clamp)\n\
         texture t(uv: vec2) -> (color: color) {{ color = tapped(wide, turned(uv) * 0.25 + 0.25) }}"
    );
    same(renderer, folder.path(), [&source, &other], 1.0)
}

/// How much nearer to the truth, in dB, tiles on the ground are with an anisotropy of 8.
const SHARPER: f64 = 3.5;

/// Tiles on the ground against a picture sixteen times as fine, of the finest level alone.
fn on_the_ground_are_sharper() -> Result<(), Failed> {
    let tiles = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/tiles/grass.png");
    let bodies = [
        "let (cell, at) = tile_map(uv, ivec2(1))\n color = grass.tiled(cell, at, |c| virtual_index(c, 16))",
        "color = grass.reference(3, uv, edges: wrap)",
    ];
    for body in bodies {
        let seen = |anisotropy: u32, gradients: Gradients, side: u32| {
            let source = format!(
                "let grass = patterns(\"{}\", grid: ivec2(4), anisotropy: {anisotropy})\n\
                 texture t(uv: vec2) -> (color: color) {{ {body} }}",
                tiles.display()
            );
            let plane = Some(Plane { repeat: 2.0, aspect: 1.0 });
            let folder = tempfile::tempdir()?;
            let made =
                loaded_with(folder.path(), &source, &Options { plane, gradients, ..Options::default() })?;
            // Below the horizon and some pixels.
            let request = Request { region: [0.0, 0.3, 1.0, 1.0], ..Request::new([side; 2]) };
            Ok::<Picture, Failed>(draw(&Renderer::Cpu, &made, &[request])?.remove(0))
        };
        let truth = averaged(&seen(1, Gradients::None, 16 * SIDE)?, 16);
        let error = |anisotropy| {
            Ok::<f64, Failed>(squared_error(&seen(anisotropy, Gradients::Derive, SIDE)?, &truth))
        };
        let (round, long) = (error(1)?, error(8)?);
        let sharper = 10.0 * (round / long).log10();
        println!("{sharper:.2} dB: {body}");
        if sharper < SHARPER {
            return Err(format!("{body}: only {sharper:.2} dB").into());
        }
    }
    Ok(())
}

/// The means of squares of so many pixels a side.
fn averaged(picture: &Picture, side: usize) -> Picture {
    let size = picture.size.map(|length| length / side as u32);
    let width = picture.size[0] as usize;
    let mean = |place: usize| {
        let corner = place / size[0] as usize * side * width + place % size[0] as usize * side;
        let rows = (0..side).flat_map(|row| &picture.pixels[corner + row * width..][..side]);
        let sum = rows.fold([0.0_f64; 4], |sum, pixel| [0, 1, 2, 3].map(|i| sum[i] + f64::from(pixel[i])));
        sum.map(|sum| (sum / (side * side) as f64) as f32)
    };
    let pixels = (0..(size[0] * size[1]) as usize).map(mean).collect();
    Picture { size, pixels, ..picture.clone() }
}

/// The mean square of the difference of channels.
fn squared_error(one: &Picture, two: &Picture) -> f64 {
    let channels = one.pixels.iter().flatten().zip(two.pixels.iter().flatten());
    let sum: f64 = channels.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    sum / (one.pixels.len() * 4) as f64
}

fn far_tiles_become_the_mean(renderer: &Renderer) -> Result<(), Failed> {
    become_the_mean(renderer, "", "ivec2(1)")
}

/// Where a pixel covers eight tiles one way and one the other.
fn far_anisotropic_tiles_become_the_mean(renderer: &Renderer) -> Result<(), Failed> {
    become_the_mean(renderer, ", anisotropy: 8", "ivec2(1, 8)")
}

/// From two tiles a pixel on every pixel is the mean of the patterns, and the mean colour of the
/// picture does not drift on the way there.
fn become_the_mean(renderer: &Renderer, anisotropy: &str, cells: &str) -> Result<(), Failed> {
    let folder = folder()?;
    let head = format!("let tiles = patterns(\"tiles.png\", grid: ivec2(2){anisotropy})\n");
    let source = format!(
        "{head}texture t(uv: vec2) -> (color: color) {{\n\
         let (cell, at) = tile_map(uv, {cells})\n\
         color = tiles.tiled(cell, at, |c| virtual_index(c, tiles.count))\n}}"
    );
    let means = format!("{head}texture t(uv: vec2) -> (color: color) {{ color = tiles.average }}");
    let each = format!(
        "{head}texture t(uv: vec2) -> (color: color) {{\n\
         color = (tiles.average(0) + tiles.average(1) + tiles.average(2) + tiles.average(3)) / 4.0\n}}"
    );
    let exact = exact_mean(folder.path())?;
    let (tiled, means, each) =
        (loaded(folder.path(), &source)?, loaded(folder.path(), &means)?, loaded(folder.path(), &each)?);
    let request = [Request::new([4, 4])];
    for made in [&means, &each] {
        let found = draw(renderer, made, &request)?[0].pixels[5];
        let off = found.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        if off > 5e-4 {
            return Err(format!("the mean is {found:?}, not {exact:?}").into());
        }
    }
    let zooms = [1.0, 0.9, 0.75, 0.6, 0.5, 0.3, 0.02];
    for (pixels, picture) in zooms.into_iter().zip(draw(renderer, &tiled, &zooms.map(view))?) {
        let count = picture.pixels.len() as f32;
        for channel in 0..4 {
            let values = || picture.pixels.iter().map(|pixel| pixel[channel]);
            let drift = values().sum::<f32>() / count - exact[channel];
            let spread = values().map(|value| (value - exact[channel]).abs()).fold(0.0, f32::max);
            if drift.abs() > TOLERANCE || (pixels <= 0.5 && spread > TOLERANCE) {
                return Err(format!("{pixels} pixels a tile: drift {drift}, spread {spread}").into());
            }
        }
    }
    Ok(())
}

/// Weights count by their share; without any, all patterns count the same; and tiles that are drawn
/// with them tend to that colour.
fn weighted_means_are_sums(renderer: &Renderer) -> Result<(), Failed> {
    let folder = folder()?;
    let head = "let tiles = patterns(\"tiles.png\", grid: ivec2(2))
node weight(pick: int) -> (w: float) { w = if pick == 0 { 3.0 } else if pick == 2 { 1.0 } else { -5.0 } }
node drawn(cell: ivec2) -> (pick: int) { pick = if hash(cell).x < 0.75 { 0 } else { 2 } }";
    let pairs = [
        ("tiles.weighted_average(weight)", "0.75 * tiles.average(0) + 0.25 * tiles.average(2)"),
        ("tiles.weighted_average(|pick| 0.25)", "tiles.average"),
        ("tiles.weighted_average(|pick| 0.0)", "tiles.average"),
    ];
    let source = |value| format!("{head}\ntexture t(uv: vec2) -> (color: color) {{ color = {value} }}");
    for (found, expected) in pairs {
        same(renderer, folder.path(), [&source(found), &source(expected)], 100.0)?;
    }
    let tiled = source("tiles.tiled(ifloor(uv), fract(uv), drawn, far: weighted_average(tiles, weight))");
    let pictures = draw(renderer, &loaded(folder.path(), &tiled)?, &[view(1.0), view(0.5)])?;
    for channel in 0..4 {
        let mean = |picture: &Picture| {
            let sum: f32 = picture.pixels.iter().map(|pixel| pixel[channel]).sum();
            sum / picture.pixels.len() as f32
        };
        let [near, far] = [&pictures[0], &pictures[1]].map(mean);
        if (near - far).abs() > TOLERANCE {
            return Err(format!("tiles of mean {near} become {far}").into());
        }
    }
    Ok(())
}

/// The mean of `tiles.png`: linear and premultiplied.
fn exact_mean(folder: &Path) -> Result<[f32; 4], Failed> {
    let picture = image::open(folder.join("tiles.png"))?.to_rgba8();
    let mut sum = [0.0; 4];
    for image::Rgba([r, g, b, a]) in picture.pixels() {
        let alpha = f64::from(*a) / 255.0;
        for (sum, code) in sum.iter_mut().zip([r, g, b]) {
            *sum += texgraph_runtime::resource::srgb_to_linear(f64::from(*code) / 255.0) * alpha;
        }
        sum[3] += alpha;
    }
    let count = f64::from(picture.width() * picture.height());
    Ok(sum.map(|sum| (sum / count) as f32))
}

/// `level` is the level that a sample reads.
fn levels_are_those_of_the_filter(renderer: &Renderer) -> Result<(), Failed> {
    let folder = folder()?;
    let source = r#"
let one = image("one.png")
texture t(uv: vec2) -> (height: float) {
    height = one.sample(uv).r * 8.0 - clamp(one.level(uv), 0.0, 4.0)
}
"#;
    let mut made = loaded(folder.path(), source)?;
    flatten(&mut made);
    let most = if matches!(renderer, Renderer::Cpu) { 1e-3 } else { OWN_LEVEL };
    for (pixels, picture) in PIXELS_A_TILE.iter().zip(draw(renderer, &made, &PIXELS_A_TILE.map(view))?) {
        let worst = picture.pixels.iter().map(|pixel| pixel[0].abs()).fold(0.0, f32::max);
        if worst > most {
            return Err(format!("at {pixels} pixels a tile the level is off by {worst}").into());
        }
    }
    Ok(())
}

/// `dx` and `dy` of what came out of a sample are what the pixels to the right and below have more:
/// through arithmetic, nodes and loops, in a node that is told the value, and with levels and layers.
fn sampled_values_change_as_drawn(renderer: &Renderer) -> Result<(), Failed> {
    let folder = folder()?;
    let head = r#"
let one   = image("one.png")
let tiles = patterns("tiles.png", grid: ivec2(2, 2))
node twice(p: vec2) -> (sum: float) {
    let first = one.sample(p)
    sum       = first.r + 0.3 * first.g + one.sample(p * 0.5, lod: 1.0).b
}
node across(v: float) -> (change: float) {
    let half = v * 0.5
    change   = dx(half + v) / 1.5
}
node down(v: float) -> (change: float) {
    let half = v * 0.5
    change   = dy(half + v) / 1.5
}
node total(p: vec2) -> (sum: float) {
    sum = fold (sum = 0.0) for i in 0..7 { sum = sum * 0.5 + twice(p * (1.0 + 0.1 * i)) }
}
"#;
    let values = [
        "one.sample(uv).r",
        "2.0 * one.sample(uv * 0.7).r - vec3(one.sample(uv).gb, uv.y).yzx.y",
        "twice(uv)",
        "total(uv)",
        "tiles.layers.sample(uv * 0.9, layer: 2).g",
        "if uv.x < 9.0 { one.sample(uv.yx).r } else { 0.0 }",
    ];
    for value in values {
        for (change, step) in [("dx(v)", 1), ("dy(v)", SIDE), ("across(v)", 1), ("down(v)", SIDE)] {
            let source = |given: &str| {
                format!("{head}texture t(uv: vec2) -> (given: float) {{ let v = {value}\n given = {given} }}")
            };
            // Where it is minified a GPU has its own level for a sample that stands alone.
            let pixels = if matches!(renderer, Renderer::Cpu) { [130.0, 9.1] } else { [130.0, 32.0] };
            let requests = pixels.map(view);
            let drawn = draw(renderer, &loaded(folder.path(), &source("v"))?, &requests)?;
            let changes = draw(renderer, &loaded(folder.path(), &source(change))?, &requests)?;
            for (drawn, changes) in drawn.iter().zip(&changes) {
                let mut most = 0.0_f32;
                for i in inner() {
                    let there = drawn.pixels[i + step as usize][0] - drawn.pixels[i][0];
                    let found = changes.pixels[i][0];
                    most = most.max(there.abs());
                    if (there - found).abs() > 2e-3 {
                        return Err(format!("{change} of {value} at {i}: {found}, drawn {there}").into());
                    }
                }
                if most < 0.02 {
                    return Err(format!("{value} proves nothing: it changes by {most}").into());
                }
            }
        }
    }
    Ok(())
}

/// The pixels that have one to the right and one below.
fn inner() -> impl Iterator<Item = usize> {
    let side = SIDE as usize;
    (0..side - 1).flat_map(move |y| (0..side - 1).map(move |x| y * side + x))
}

/// What a ramp gives for a pixel is the mean of what it gives for 32 places across it, but for the
/// shape of the filter; and for a place that is spread far it is the mean of all.
fn a_ramp_is_the_mean_over_a_pixel(renderer: &Renderer) -> Result<(), Failed> {
    let folder = folder()?;
    let head = "let r = ramp([-0.5, #d03020], [0.1, #2040c0c0], [0.3, #ffe080], [1.5, #104010])\n";
    let source =
        |body: &str| format!("{head}texture t(uv: vec2) -> (color: color) {{ color = r.at(uv.x{body}) }}");
    let filtered = loaded(folder.path(), &source(""))?;
    let plain = loaded(folder.path(), &source(", spread: 0.0"))?;
    for (pixels, tolerance) in [(16, 0.02), (32, 0.008), (128, 0.004)] {
        let view = |across| Request { region: [-0.5, 0.0, 1.5, 1.0], ..Request::new([across, 2]) };
        let mean = &draw(renderer, &plain, &[view(32 * pixels)])?[0];
        let found = &draw(renderer, &filtered, &[view(pixels)])?[0];
        // The ramp goes on beyond its ends, its pixels here do not.
        for (i, pixel) in found.pixels.iter().take(pixels as usize).enumerate().skip(2).rev().skip(2) {
            let parts = &mean.pixels[32 * i..32 * i + 32];
            for (channel, value) in pixel.iter().enumerate() {
                let mean = parts.iter().map(|part| part[channel]).sum::<f32>() / 32.0;
                if (value - mean).abs() > tolerance {
                    return Err(format!("{pixels}: pixel {i} is {value}, the mean {mean}").into());
                }
            }
        }
    }
    Ok(())
}

/// With N samples along the longer gradient the level is that of the shorter, or of an Nth of the
/// longer; 16 texels a side make a texel a pixel at 16 pixels a tile.
fn levels_count_on_anisotropy(renderer: &Renderer) -> Result<(), Failed> {
    let folder = folder()?;
    for (anisotropy, stretch, level) in
        [(1, 1, 2.0), (1, 8, 5.0), (2, 8, 4.0), (4, 8, 3.0), (8, 8, 2.0), (16, 8, 2.0), (16, 1, 2.0)]
    {
        let source = format!(
            "let one = image(\"one.png\", anisotropy: {anisotropy})\n\
             texture t(uv: vec2) -> (height: float) {{ height = one.level(uv * vec2(1.0, {stretch}.0)) }}"
        );
        let made = loaded(folder.path(), &source)?;
        let found =
            draw(renderer, &made, &[Request { region: [0.0, 0.0, 2.0, 2.0], ..Request::new([8, 8]) }])?;
        let found = found[0].pixels[9][0];
        if (found - level).abs() > 1e-3 {
            return Err(format!("{anisotropy}, stretched {stretch} times: level {found}, not {level}").into());
        }
        if made
            .0
            .manifest
            .resources
            .iter()
            .flat_map(|r| &r.textures)
            .any(|texture| texture.sampler.as_ref().is_some_and(|s| s.anisotropy != anisotropy))
        {
            return Err("the sampler has another anisotropy".into());
        }
    }
    Ok(())
}

/// Samples that share a gradient share a level, but not where a filter takes samples along it.
fn keep_their_gradient() -> Result<(), Failed> {
    let folder = folder()?;
    for (anisotropy, kept) in [(1, 0), (4, 2)] {
        let source = format!(
            "let one = image(\"one.png\", anisotropy: {anisotropy})\n\
             texture t(uv: vec2) -> (color: color) {{ color = one.sample(uv) + one.sample(uv + 0.5) }}"
        );
        let (program, _) = loaded(folder.path(), &source)?;
        let found = program.texture().wgsl.matches("textureSampleGrad").count();
        if found != kept {
            return Err(format!("anisotropy {anisotropy}: {found} samples by gradient").into());
        }
    }
    Ok(())
}
