//! The compiler's shaders beside those that an expert writes by hand, in benches/handwritten: no more
//! fetches, no more arithmetic, the same picture. How long they take is for the bench `handwritten`
//! of the runtime.
//!
//! GPU tests are shown as ignored where there is no adapter; `TEXGRAPH_GPU=required` makes that a
//! failure.

mod count;

use count::{Count, count};
use libtest_mimic::{Arguments, Failed, Trial};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use texgraph_compiler::{Library, Options, Program, compile, diagnostic::render};
use texgraph_runtime::cpu;
use texgraph_runtime::gpu::{Gpu, Preference};
use texgraph_runtime::picture::Picture;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, load};

/// A graph, and the same by hand.
const PAIRS: &[(&str, &str)] = &[("examples/tiling.tex", "benches/handwritten/tiling.wgsl")];

/// Both do the same operations on floats, so a channel may differ by rounding at most.
const TOLERANCE: f32 = 0.1 / 255.0;

fn main() {
    let arguments = Arguments::from_args();
    let required = std::env::var("TEXGRAPH_GPU").is_ok_and(|value| value == "required");
    let gpu = Gpu::new(Preference::Hardware).map(Arc::new);
    let mut trials = vec![Trial::test("what_is_counted", what_is_counted)];
    for (graph, by_hand) in PAIRS {
        trials.push(Trial::test(format!("takes_no_more::{graph}"), || takes_no_more(graph, by_hand)));
        let (ignored, gpu) = (gpu.is_err() && !required, gpu.clone());
        let run = move || gives_the_same(&*gpu.map_err(|error| error.to_string())?, graph, by_hand);
        trials.push(Trial::test(format!("gives_the_same::{graph}"), run).with_ignored_flag(ignored));
    }
    for count in [2, 3, 7, 16, 100, 1024] {
        let (ignored, gpu) = (gpu.is_err() && !required, gpu.clone());
        let run = move || picks(&*gpu.map_err(|error| error.to_string())?, count);
        trials.push(Trial::test(format!("picks_of::{count}"), run).with_ignored_flag(ignored));
    }
    libtest_mimic::run(&arguments, trials).exit();
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn loaded(file: &Path) -> Result<(Program, Tables), Failed> {
    let project = Project::new(file, true);
    let compiled = compile(&Library::standard()?, project.main(), &project, &Options::default());
    let compiled = compiled.map_err(|f| render::human(&f.sources, &f.diagnostics))?;
    let mut program = compiled.program;
    let tables = load(&mut program, &project);
    Ok((program, tables.map_err(|diagnostics| render::human(&compiled.sources, &diagnostics))?))
}

/// A count done by eye: 3 + (2 + 3) + (1 + 1) in the callee, then the sample, 4 and the greater arm.
fn what_is_counted() -> Result<(), Failed> {
    let text = "
        @group(0) @binding(0) var picture: texture_2d<f32>;
        @group(0) @binding(1) var picture_sampler: sampler;
        fn callee(v: vec3<f32>) -> f32 {
            let sum = v + 1.0;
            let product = dot(sum, sum);
            return product + f32(i32(product));
        }
        @fragment fn main(@location(0) at: vec2<f32>) -> @location(0) vec4<f32> {
            var color = textureSampleLevel(picture, picture_sampler, at, 0.0) * callee(vec3(at, 0.0));
            if color.x > 0.5 { color = color * color.yyyy * 2.0; } else { color = -color; }
            return color;
        }";
    let wanted = Count { fetches: 1, arithmetic: 3 + 5 + 3 + 4 + 1 + 8 };
    assert_eq!(count(text)?, wanted);
    assert!(count("@fragment fn main() { loop { break; } }").is_err());
    Ok(())
}

fn takes_no_more(graph: &str, by_hand: &str) -> Result<(), Failed> {
    let (program, _) = loaded(&root().join(graph))?;
    let ours = count(&program.texture().wgsl)?;
    let theirs = count(&std::fs::read_to_string(root().join(by_hand))?)?;
    println!("{graph}: {ours:?}, by hand {theirs:?}");
    if ours.fetches > theirs.fetches || ours.arithmetic > theirs.arithmetic {
        return Err(format!("{ours:?}, by hand {theirs:?}\n{}", program.texture().wgsl).into());
    }
    Ok(())
}

fn gives_the_same(gpu: &Gpu, graph: &str, by_hand: &str) -> Result<(), Failed> {
    let (program, tables) = loaded(&root().join(graph))?;
    let mut twin = program.clone();
    let texture = twin.passes.last_mut().ok_or("a program has a pass")?;
    texture.wgsl = std::fs::read_to_string(root().join(by_hand))?;
    for region in [[0.0, 0.0, 1.0, 1.0], [-0.3, 0.2, 0.1, 0.6], [-20.0, -30.0, 70.0, 60.0]] {
        let request = Request { region, ..Request::new([256, 256]) };
        let picture = |program: &Program| -> Result<Picture, String> {
            let mut scene = gpu.prepare(program, &tables, 0).map_err(|error| error.to_string())?;
            scene.render(&request, &|_| {}).map_err(|error| error.to_string())
        };
        let difference = picture(&program)?.difference(&picture(&twin)?, TOLERANCE);
        if difference.within < 1.0 {
            return Err(format!("over {region:?}: {difference:?}").into());
        }
    }
    Ok(())
}

/// One of `count` drawn for each of 65,536 cells: none of them `count` itself, the same ones by the
/// bits of the hash as by its number, with no limit in the shader where rounding can't reach it.
fn picks(gpu: &Gpu, count: u32) -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("picks.tex");
    let source = format!(
        "texture picks(uv: vec2) -> (pick: float) {{\n\
         pick = float(virtual_index(ifloor(uv * 256.0), {count}, stream: 5))\n}}\n"
    );
    std::fs::write(&file, source)?;
    let (program, tables) = loaded(&file)?;
    let request = Request::new([256, 256]);
    let mut scene = gpu.prepare(&program, &tables, 0).map_err(|error| error.to_string())?;
    let theirs = scene.render(&request, &|_| {}).map_err(|error| error.to_string())?;
    let ours = cpu::render(&program, &tables, &request, &|_| {}).map_err(|error| error.to_string())?;
    assert_eq!(ours.pixels, theirs.pixels);
    let drawn: BTreeSet<u32> = ours.pixels.iter().map(|pixel| pixel[0] as u32).collect();
    let all: BTreeSet<u32> = (0..count).collect();
    assert_eq!(drawn, all);
    let is_limited = program.texture().wgsl.contains("min(");
    assert_eq!(is_limited, !count.is_power_of_two(), "{}", program.texture().wgsl);
    Ok(())
}
