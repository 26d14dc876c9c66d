//! The picture of a node: all outputs of the texture `NODE_alone`, side by side.

use image::codecs::jpeg::JpegEncoder;
use image::{RgbImage, imageops};
use std::path::Path;
use texgraph_compiler::{Library, Options, compile, diagnostic::render};
use texgraph_runtime::cpu;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::load;

/// Pixels along the side of an output.
const SIDE: u32 = 160;
/// Pixels between two outputs.
const GAP: u32 = 4;
/// Of the JPEG, in percent.
const QUALITY: u8 = 88;

/// A JPEG of what a node's texture gives.
pub fn sheet(file: &Path, node: &str) -> Vec<u8> {
    let texture = format!("{node}_alone");
    let outputs = outputs(file, &texture);
    let width = outputs.len() as u32 * (SIDE + GAP) - GAP;
    let mut sheet = RgbImage::from_pixel(width, SIDE, image::Rgb([255; 3]));
    for (i, output) in outputs.iter().enumerate() {
        imageops::replace(&mut sheet, &drawn(file, &texture, output), i64::from(i as u32 * (SIDE + GAP)), 0);
    }
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, QUALITY)
        .encode_image(&sheet)
        .expect("a JPEG of this size can be");
    bytes
}

fn options(texture: &str, output: Option<&str>) -> Options {
    let outputs = output.map(|output| vec![output.to_owned()]);
    Options { texture: Some(texture.to_owned()), outputs, ..Options::default() }
}

/// The outputs of a texture, in order.
fn outputs(file: &Path, texture: &str) -> Vec<String> {
    let library = Library::standard().expect("the library is right");
    let project = Project::new(file, true);
    let compiled = compile(&library, project.main(), &project, &options(texture, None))
        .unwrap_or_else(|f| panic!("{}", render::human(&f.sources, &f.diagnostics)));
    compiled.program.manifest.outputs.iter().map(|output| output.name.clone()).collect()
}

fn drawn(file: &Path, texture: &str, output: &str) -> RgbImage {
    let library = Library::standard().expect("the library is right");
    let project = Project::new(file, true);
    let mut compiled = compile(&library, project.main(), &project, &options(texture, Some(output)))
        .unwrap_or_else(|f| panic!("{}", render::human(&f.sources, &f.diagnostics)));
    let tables = load(&mut compiled.program, &project)
        .unwrap_or_else(|found| panic!("{}", render::human(&compiled.sources, &found)));
    let picture = cpu::render(&compiled.program, &tables, &Request::new([SIDE; 2]), &|_| {})
        .unwrap_or_else(|error| panic!("{error}"));
    let png = picture.to_png().expect("it can be encoded");
    over_white(&image::load_from_memory(&png).expect("it can be decoded").to_rgba8())
}

fn over_white(picture: &image::RgbaImage) -> RgbImage {
    RgbImage::from_fn(picture.width(), picture.height(), |x, y| {
        let [r, g, b, a] = picture.get_pixel(x, y).0.map(u32::from);
        image::Rgb([r, g, b].map(|c| ((c * a + 255 * (255 - a)) / 255) as u8))
    })
}
