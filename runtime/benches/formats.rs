//! What a stochastic texture costs and stores, by the size of its photograph and its format, beside the
//! photograph repeated: table 1.1 of Deliot & Heitz 2019, on a software adapter.
//!
//! Run with `cargo bench -p texgraph-runtime --bench formats`.

use cpu_time::ProcessTime;
use image::{RgbImage, imageops};
use std::path::Path;
use texgraph_compiler::{Library, Options, Program, compile};
use texgraph_runtime::gpu::{Gpu, Preference, Scene};
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, compress, load};

const SIDES: [u32; 6] = [64, 128, 256, 512, 1024, 2048];
const FORMATS: [&str; 3] = ["none", "bc1", "bc7"];
const ROUNDS: usize = 12;
/// Pixels across and down, a texel each.
const SIDE: u32 = 1024;

fn main() {
    let gpu = match Gpu::new(Preference::Software) {
        Ok(gpu) => gpu,
        Err(error) => return println!("no software adapter: {error}"),
    };
    println!("{}, {SIDE}² pixels, least of {ROUNDS} rounds, ns of CPU time a pixel", gpu.name());
    println!("| size | `compress` | `gaussian` | `inverse` | repeated | stochastic | ratio |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    let photo = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/photos/rock.jpg");
    let photo = image::open(photo).expect("the photograph").to_rgb8();
    let folder = tempfile::tempdir().expect("a folder");
    for side in SIDES {
        sized(&photo, side).save(folder.path().join("photo.png")).expect("it is written");
        for format in FORMATS {
            let tell = |text: &str| loaded(folder.path(), &text.replace("SIDE", &format!("{side}")));
            let repeated = tell(
                "let i = image(\"photo.png\")\ntexture t(uv: vec2) -> (color: color) { color = i.sample(uv * 1024.0 / SIDE.0) }\n",
            );
            let ours = tell(&format!(
                "let e = exemplar(\"photo.png\", wrap: repeat, compress: {format})\ntexture t(uv: vec2) -> (color: color) {{ color = e.stochastic(uv * 1024.0 / SIDE.0) }}\n"
            ));
            let [repeated_ns, ours_ns] = least(&gpu, [&repeated, &ours]);
            let kilobytes = |field: &str| {
                let bytes = ours.1.get(0, field).map_or(0, |bytes| bytes.len());
                format!("{:.1} kB", bytes as f64 / 1000.0)
            };
            println!(
                "| {side}² | {format} | {} | {} | {repeated_ns:.1} | {ours_ns:.1} | {:.2} |",
                kilobytes("gaussian"),
                kilobytes("inverse"),
                ours_ns / repeated_ns
            );
        }
    }
}

/// A part of the photograph, or the photograph repeated.
fn sized(photo: &RgbImage, side: u32) -> RgbImage {
    let mut picture = RgbImage::new(side, side);
    imageops::tile(&mut picture, photo);
    picture
}

fn loaded(folder: &Path, text: &str) -> (Program, Tables) {
    let file = folder.join("main.tex");
    std::fs::write(&file, text).expect("it is written");
    let library = Library::standard().expect("the library parses");
    let project = Project::new(&file, false);
    let compiled = compile(&library, project.main(), &project, &Options::default());
    let mut program = compiled.unwrap_or_else(|failure| panic!("{:?}", failure.diagnostics)).program;
    let mut tables = load(&mut program, &project).expect("the pictures load");
    compress(&mut program.manifest, &mut tables);
    (program, tables)
}

/// The least time of each, drawn in turns.
fn least(gpu: &Gpu, both: [&(Program, Tables); 2]) -> [f64; 2] {
    let mut scenes = both.map(|(program, tables)| gpu.prepare(program, tables, 0).expect("it draws"));
    let mut least = [f64::MAX; 2];
    for _ in 0..ROUNDS {
        for (scene, least) in scenes.iter_mut().zip(&mut least) {
            *least = least.min(draw(scene));
        }
    }
    least.map(|seconds| seconds * 1e9 / f64::from(SIDE * SIDE))
}

/// Seconds of CPU time for a picture.
fn draw(scene: &mut Scene<'_>) -> f64 {
    let start = ProcessTime::now();
    scene.render(&Request::new([SIDE, SIDE]), &|_| {}).expect("the adapter renders");
    start.elapsed().as_secs_f64()
}
