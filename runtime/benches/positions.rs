//! What it takes to move 1,000 sprites of a positions map in a frame: the edits, the list of writes, and
//! the uploads, as CPU time of the thread that does it.
//!
//! Run with `cargo bench -p texgraph-runtime --bench positions`.

use cpu_time::ThreadTime;
use std::collections::HashMap;
use std::path::Path;
use std::time::Duration;
use texgraph_compiler::{Library, Options, Program, compile};
use texgraph_runtime::gpu::{Gpu, Preference};
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::positions::{MAX_WRITES, Positions, Sprite, SpriteId};
use texgraph_runtime::resource::{Tables, load};

const SPRITES: u32 = 1000;
const FRAMES: u32 = 200;
/// What a frame may take.
const GOAL: Duration = Duration::from_millis(1);

fn main() {
    let gpu = Gpu::new(Preference::Hardware);
    match &gpu {
        Ok(gpu) => println!("{SPRITES} sprites moved a frame, {FRAMES} frames, uploads to {}", gpu.name()),
        Err(error) => println!("{SPRITES} sprites moved a frame, {FRAMES} frames, no uploads: {error}"),
    }
    for (side, layers) in [(64, 2), (128, 1), (256, 1)] {
        measure(gpu.as_ref().ok(), side, layers);
    }
}

fn measure(gpu: Option<&Gpu>, side: u32, layers: u32) {
    let folder = tempfile::tempdir().expect("a folder");
    let (program, tables) = loaded(folder.path(), side, layers);
    let mut scene = gpu.map(|gpu| gpu.prepare(&program, &tables, 0).expect("the program is prepared"));
    let cells = (program.manifest.resources.iter()).position(|found| found.name == "decals");
    let cells = cells.expect("the map is there");
    let mut map = Positions::new([side; 2], layers, 16).expect("it can be");
    let ids: Vec<SpriteId> = (0..)
        .map_while(|i| (i < 4 * SPRITES).then(|| map.insert(sprite(i, 0))))
        .flatten()
        .take(SPRITES as usize)
        .collect();
    let (mut times, mut moved, mut most) = (Vec::new(), 0, 0);
    for frame in 1..=FRAMES {
        let start = ThreadTime::now();
        for (i, id) in (0..).zip(&ids) {
            moved += u32::from(map.place(*id, sprite(i, frame)).is_ok());
        }
        let writes = map.take_writes();
        most = most.max(writes.len());
        if let Some(scene) = &mut scene {
            scene.write(cells, "cells", &writes).expect("it is there");
        }
        times.push(start.elapsed());
        // A frame is drawn before the next, as hosts do: uploads never pile up.
        if let Some(scene) = &mut scene {
            scene.render(&Request::new([8, 8]), &|_| {}).expect("it can be drawn");
        }
    }
    times.sort();
    let (median, worst) = (times[times.len() / 2], times[times.len() - 1]);
    let verdict = if median < GOAL { "reached" } else { "MISSED" };
    println!(
        "{side}×{side} cells, {layers} layer(s), {} sprites: {median:.0?} a frame (worst {worst:.0?}), goal {GOAL:?} {verdict}; {:.0} moved, {most} writes of {MAX_WRITES} at most",
        ids.len(),
        f64::from(moved) / f64::from(FRAMES),
    );
}

/// A sprite on its way.
fn sprite(i: u32, frame: u32) -> Sprite {
    let drift = frame as f32 * 0.002 * (random(i, 2) - 0.5);
    Sprite { pattern: i % 16, at: [random(i, 0) + drift, random(i, 1) - drift], scale: 0.5, turn: drift }
}

/// A number in 0..1.
fn random(i: u32, n: u32) -> f32 {
    let mixed = (i ^ (n << 28)).wrapping_mul(0x9e37_79b1);
    let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x85eb_ca6b);
    ((mixed ^ (mixed >> 13)).wrapping_mul(0xc2b2_ae35) >> 8) as f32 / (1 << 24) as f32
}

fn loaded(folder: &Path, side: u32, layers: u32) -> (Program, Tables) {
    let picture = image::RgbaImage::from_pixel(16, 16, image::Rgba([200, 90, 30, 255]));
    picture.save(folder.join("leaf.png")).expect("the folder can be written");
    std::fs::write(folder.join("decals.ron"), "[]").expect("the folder can be written");
    let text = format!(
        "let leaf = patterns(\"leaf.png\", grid: ivec2(4, 4))\n\
         let decals = positions(\"decals.ron\", grid: ivec2({side}), patterns: leaf, layers: {layers})\n\
         texture t(uv: vec2) -> (color: color) {{ color = decals.positioned(uv) }}"
    );
    let project = Project::new(&folder.join("t.tex"), false);
    let files: HashMap<String, String> = [("t.tex".to_owned(), text)].into();
    let library = Library::standard().expect("the library parses");
    let compiled = compile(&library, "t.tex", &files, &Options::default());
    let mut program = compiled.unwrap_or_else(|failure| panic!("{:?}", failure.diagnostics)).program;
    let tables = load(&mut program, &project).expect("it loads");
    (program, tables)
}
