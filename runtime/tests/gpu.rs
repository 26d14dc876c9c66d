//! The GPU renderer against the CPU renderer, on programs that are written twice: as WGSL and as a
//! graph. Without an adapter the tests are shown as ignored, unless `TEXGRAPH_GPU=required`.

#[path = "gpu/bakes.rs"]
mod bakes;
mod common;
#[path = "gpu/positions.rs"]
mod positions;
#[path = "gpu/threads.rs"]
mod threads;

use common::folds::{collatz, counted, gathered, nested};
use common::programs::{arithmetic, fetched, sampled, tiled};
use common::{folder, project, write_deep, write_picture};
use libtest_mimic::{Arguments, Failed, Trial};
use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex};
use texgraph_compiler::manifest::{Encoding, Filter, IndicesSource, Recipe, Tileable, Value, Wrap};
use texgraph_compiler::{Library, Options, Program, compile};
use texgraph_runtime::cpu;
use texgraph_runtime::gpu::{Gpu, Preference};
use texgraph_runtime::render::{RenderError, Request};
use texgraph_runtime::resource::{Tables, load};

/// A filtered texel may differ by this much: filters round their weights.
const FILTERED: f32 = 4.0 / 255.0;

/// The share of pixels that must agree.
const AGREE: f64 = 0.998;

type Test = fn(&Gpu) -> Result<(), Failed>;

const TESTS: &[(&str, Test)] = &[
    ("images_agree", images_agree),
    ("encodings_agree", encodings_agree),
    ("patterns_agree", patterns_agree),
    ("integers_are_equal", integers_are_equal),
    ("inputs_calls_and_outputs_agree", inputs_calls_and_outputs_agree),
    ("folds_agree", folds_agree),
    ("compiled_bakes_agree", bakes::compiled_bakes_agree),
    ("bakes_agree", bakes::bakes_agree),
    ("large_bakes_agree", bakes::large_bakes_agree),
    ("bakes_of_bakes_agree", bakes::bakes_of_bakes_agree),
    ("bakes_are_drawn_again_only_for_their_params", bakes::bakes_are_drawn_again_only_for_their_params),
    ("values_out_of_range_are_stored_alike", bakes::values_out_of_range_are_stored_alike),
    ("a_broken_bake_is_an_error_with_its_name", bakes::a_broken_bake_is_an_error_with_its_name),
    ("edited_positions_agree", positions::edited_positions_agree),
    ("pictures_are_read_back_from_many_threads", threads::pictures_are_read_back_from_many_threads),
    ("a_compiled_program_agrees", a_compiled_program_agrees),
    ("tiles_have_no_seams", tiles_have_no_seams),
    ("a_broken_shader_is_an_error", a_broken_shader_is_an_error),
    ("missing_tables_are_errors", missing_tables_are_errors),
    ("impossible_requests_are_errors", impossible_requests_are_errors),
];

fn main() {
    let arguments = Arguments::from_args();
    let required = std::env::var("TEXGRAPH_GPU").is_ok_and(|value| value == "required");
    let gpu = Gpu::new(Preference::Hardware).map(Arc::new);
    if let Err(error) = &gpu {
        eprintln!("{error}");
    }
    let trials = TESTS.iter().map(|(name, test)| {
        let gpu = gpu.clone();
        let ignored = gpu.is_err() && !required;
        let run = move || test(&*gpu.map_err(|error| error.to_string())?);
        Trial::test(*name, run).with_ignored_flag(ignored)
    });
    libtest_mimic::run(&arguments, trials.collect()).exit();
}

/// Renders on both and compares.
fn compare(
    gpu: &Gpu,
    program: &Program,
    tables: &Tables,
    request: &Request,
    tolerance: f32,
) -> Result<(), Failed> {
    let ours = cpu::render(program, tables, request, &|_| {}).map_err(|error| error.to_string())?;
    let mut scene = gpu.prepare(program, tables, request.output).map_err(|error| error.to_string())?;
    let theirs = scene.render(request, &|_| {}).map_err(|error| error.to_string())?;
    if ours.pixels.iter().all(|pixel| *pixel == ours.pixels[0]) {
        return Err("the picture has one colour: it proves nothing".into());
    }
    let difference = ours.difference(&theirs, tolerance);
    if difference.within < AGREE {
        return Err(format!("{difference:?} for {request:?}").into());
    }
    Ok(())
}

fn scaled(program: &Program, size: [u32; 2], scale: [f32; 2]) -> Request {
    let mut request = Request::new(size);
    request.region = [0.013, -0.007, 1.013, 0.993];
    request.settings.set(&program.manifest, "scale", Value::Float(scale.to_vec())).expect("it is set");
    request
}

/// Random bytes, always the same.
fn noise(count: u32) -> Vec<u8> {
    (0..count).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect()
}

fn images_agree(gpu: &Gpu) -> Result<(), Failed> {
    let folder = folder();
    write_picture(&folder.path().join("even.png"), [64, 64], &noise(64 * 64 * 4));
    write_picture(&folder.path().join("odd.png"), [50, 31], &noise(50 * 31 * 4));
    for path in ["even.png", "odd.png"] {
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            for filter in [Filter::Linear, Filter::Nearest] {
                let recipe =
                    Recipe::Image { path: path.into(), encoding: Encoding::Linear, tileable: Tileable::None };
                let (program, tables) = sampled(folder.path(), recipe, wrap, filter);
                for scale in [[0.25, 0.25], [1.0, 1.0], [3.0, 3.0], [16.0, 2.0], [1.0, 5.3]] {
                    compare(gpu, &program, &tables, &scaled(&program, [64, 64], scale), FILTERED)?;
                }
            }
        }
    }
    Ok(())
}

fn encodings_agree(gpu: &Gpu) -> Result<(), Failed> {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [32, 32], &noise(32 * 32 * 4));
    let deep: Vec<u16> = noise(32 * 32).into_iter().map(|byte| u16::from(byte) * 257).collect();
    write_deep(&folder.path().join("deep.png"), [32, 32], &deep);
    for path in ["a.png", "deep.png"] {
        for encoding in [Encoding::Srgb, Encoding::Linear, Encoding::Normal] {
            let recipe = Recipe::Image { path: path.into(), encoding, tileable: Tileable::None };
            let (program, tables) = sampled(folder.path(), recipe, Wrap::Repeat, Filter::Linear);
            compare(gpu, &program, &tables, &scaled(&program, [64, 64], [0.5, 0.5]), FILTERED)?;
            compare(gpu, &program, &tables, &scaled(&program, [64, 64], [4.0, 4.0]), FILTERED)?;
        }
    }
    Ok(())
}

fn patterns_agree(gpu: &Gpu) -> Result<(), Failed> {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [128, 128], &noise(128 * 128 * 3));
    let recipe = Recipe::Patterns { paths: vec!["a.png".into()], grid: [4, 4], encoding: Encoding::Srgb };
    let (program, tables) = tiled(folder.path(), recipe, Wrap::Repeat, Filter::Linear);
    for size in [256, 128, 64, 43, 16] {
        compare(gpu, &program, &tables, &Request::new([size, size]), FILTERED)?;
    }
    Ok(())
}

fn integers_are_equal(gpu: &Gpu) -> Result<(), Failed> {
    let folder = folder();
    let (program, tables) = fetched(folder.path(), Recipe::Permutation { size: 16, seed: 3 });
    let mut request = scaled(&program, [16, 1], [16.0, 1.0]);
    request.region = [0.0, 0.0, 1.0, 1.0];
    compare(gpu, &program, &tables, &request, 0.0)?;
    let rows = (0..16).map(|y| (0..16).map(|x| x * y % 5).collect()).collect();
    let recipe = Recipe::Indices { source: IndicesSource::Rows(rows), levels: 5 };
    let (program, tables) = fetched(folder.path(), recipe);
    let mut request = scaled(&program, [64, 64], [16.0, 16.0]);
    request.region = [0.0, 0.0, 1.0, 1.0];
    compare(gpu, &program, &tables, &request, 0.0)
}

fn inputs_calls_and_outputs_agree(gpu: &Gpu) -> Result<(), Failed> {
    let program = arithmetic();
    for output in [0, 1] {
        let mut request = scaled(&program, [61, 47], [0.4, 0.0]);
        request.time = 2.5;
        request.output = output;
        compare(gpu, &program, &Tables::default(), &request, 1e-4)?;
    }
    Ok(())
}

fn folds_agree(gpu: &Gpu) -> Result<(), Failed> {
    for program in [collatz(), nested()] {
        let request = scaled(&program, [48, 48], [0.5, 0.0]);
        let request = Request { region: [0.0, 0.0, 3.0, 3.0], ..request };
        compare(gpu, &program, &Tables::default(), &request, 0.0)?;
    }
    let request = Request { region: [-0.25, 0.0, 0.75, 1.0], ..Request::new([64, 3]) };
    compare(gpu, &counted(), &Tables::default(), &request, 1e-5)?;
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [32, 32], &noise(32 * 32 * 4));
    let (program, tables) = gathered(folder.path(), "a.png");
    for size in [256, 64, 16] {
        compare(gpu, &program, &tables, &Request::new([size, size]), FILTERED)?;
    }
    Ok(())
}

/// From a file's text to pictures: every kind of resource, read through the library.
const SOURCE: &str = r#"
let tiles = patterns("tiles.png", grid: ivec2(4, 2))
let photo = image("photo.png", wrap: mirror)
let sigma = permutation(16, seed: 5)
let areas = indices("areas.png", levels: 2)
param cells: int = 6 in 1..=100
texture ground(uv: vec2, time: float) -> (color: color, height: float) {
    let (cell, at) = tile_map(uv, cells)
    let tile = tiles.reference(virtual_index(cell, tiles.count), at)
    let other = tiles.reference(sigma.at(cell.x + cell.y).x % tiles.count, at)
    let below = photo.sample(uv * 2.5)
    color = if areas.at(cell) == 1 { mix(tile, below, 0.5) } else { mix(other, below, 0.25) }
    height = 0.5 + 0.5 * sin(6.0 * uv.x + time) * fract(3.0 * uv.y)
}
"#;

/// A program compiled from a text, in a folder with its pictures.
fn compiled(folder: &Path, text: &str) -> Result<(Program, Tables), Failed> {
    fs::write(folder.join("main.tex"), text)?;
    let project = project(folder);
    let library = Library::standard()?;
    let compiled = compile(&library, project.main(), &project, &Options::default());
    let mut program = compiled.map_err(|failure| format!("{:#?}", failure.diagnostics))?.program;
    let tables = load(&mut program, &project).map_err(|errors| format!("{errors:#?}"))?;
    Ok((program, tables))
}

fn a_compiled_program_agrees(gpu: &Gpu) -> Result<(), Failed> {
    let folder = folder();
    write_picture(&folder.path().join("tiles.png"), [128, 64], &noise(128 * 64 * 3));
    write_picture(&folder.path().join("photo.png"), [50, 31], &noise(50 * 31 * 4));
    write_picture(&folder.path().join("areas.png"), [8, 8], &noise(64));
    let (program, tables) = compiled(folder.path(), SOURCE)?;
    for output in 0..program.manifest.outputs.len() {
        let mut request = Request { output, time: 1.5, ..Request::new([200, 150]) };
        request.region = [-0.51, 0.02, 0.93, 1.13];
        compare(gpu, &program, &tables, &request, FILTERED)?;
        request.settings.parse(&program.manifest, "cells=31").map_err(|error| error.to_string())?;
        compare(gpu, &program, &tables, &request, FILTERED)?;
    }
    Ok(())
}

fn tiles_have_no_seams(gpu: &Gpu) -> Result<(), Failed> {
    let program = arithmetic();
    let mut scene = gpu.prepare(&program, &Tables::default(), 1).map_err(|error| error.to_string())?;
    for size in [[2100, 3], [5, 1025]] {
        let request = Request { output: 1, ..Request::new(size) };
        let heard = Mutex::new(Vec::new());
        let tell = |share: f32| heard.lock().expect("no panic").push(share);
        let theirs = scene.render(&request, &tell).map_err(|error| error.to_string())?;
        let ours = cpu::render(&program, &Tables::default(), &request, &|_| {})
            .map_err(|error| error.to_string())?;
        let difference = ours.difference(&theirs, 1e-5);
        let heard = heard.into_inner().expect("no panic");
        if difference.within < 1.0 || heard.last() != Some(&1.0) || heard.len() < 2 || !heard.is_sorted() {
            return Err(format!("{difference:?}, progress {heard:?}").into());
        }
    }
    Ok(())
}

fn a_broken_shader_is_an_error(gpu: &Gpu) -> Result<(), Failed> {
    let texts = [
        "fn main( {",
        "",
        "@fragment fn other() {}",
        "@fragment fn main() -> @location(0) vec4<f32> { return 1; }",
    ];
    for text in texts {
        let mut program = arithmetic();
        program.passes[0].wgsl = text.into();
        match gpu.prepare(&program, &Tables::default(), 0) {
            Err(RenderError::Gpu(_)) => {}
            Err(other) => return Err(format!("{text}: {other}").into()),
            Ok(_) => return Err(format!("{text}: it was accepted").into()),
        }
    }
    // The device still works.
    compare(gpu, &arithmetic(), &Tables::default(), &Request::new([8, 8]), 1e-4)
}

fn missing_tables_are_errors(gpu: &Gpu) -> Result<(), Failed> {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [4, 4], &[100; 16]);
    let recipe = Recipe::Image { path: "a.png".into(), encoding: Encoding::Linear, tileable: Tileable::None };
    let (program, mut tables) = sampled(folder.path(), recipe, Wrap::Repeat, Filter::Linear);
    let refused =
        |tables: &Tables| matches!(gpu.prepare(&program, tables, 0), Err(RenderError::NoTable { .. }));
    if !refused(&Tables::default()) {
        return Err("a missing table was accepted".into());
    }
    tables.insert(0, "pixels", vec![0; 60]);
    if refused(&tables) { Ok(()) } else { Err("a short table was accepted".into()) }
}

fn impossible_requests_are_errors(gpu: &Gpu) -> Result<(), Failed> {
    let program = arithmetic();
    if !matches!(gpu.prepare(&program, &Tables::default(), 2), Err(RenderError::NoOutput { .. })) {
        return Err("an output that is not there was accepted".into());
    }
    let mut scene = gpu.prepare(&program, &Tables::default(), 0).map_err(|error| error.to_string())?;
    let size = scene.render(&Request::new([0, 1]), &|_| {});
    let region = scene.render(&Request { region: [f64::NAN; 4], ..Request::new([1, 1]) }, &|_| {});
    if !matches!(size, Err(RenderError::Size { .. })) || region != Err(RenderError::NotFinite) {
        return Err("an impossible request was accepted".into());
    }
    Ok(())
}
