//! Pictures on the CPU: what the tiling promises. That the GPU draws the same is for `agreement`.
//!
//! `TEXGRAPH_PICTURES=write` writes the recorded pictures anew.

use libtest_mimic::{Arguments, Failed, Trial};
use std::path::{Path, PathBuf};
use texgraph_compiler::{Library, Options, Program, compile, diagnostic::render};
use texgraph_runtime::picture::Picture;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, load};
use texgraph_runtime::{cpu, settings::Settings};

fn main() {
    let arguments = Arguments::from_args();
    let trials = vec![
        Trial::test("tiling_has_no_grid_and_no_period", tiling_has_no_grid_and_no_period),
        Trial::test("tiling_is_as_recorded", tiling_is_as_recorded),
        Trial::test("tiling_stays_small", tiling_stays_small),
        Trial::test("virtual_indices_do_not_repeat", virtual_indices_do_not_repeat),
        Trial::test("any_thread_count_gives_the_same_picture", any_thread_count_gives_the_same_picture),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// A program with its tables.
fn loaded(file: &Path, output: Option<&str>) -> Result<(Program, Tables), Failed> {
    let library = Library::standard()?;
    let project = Project::new(file, true);
    let outputs = output.map(|output| vec![output.to_owned()]);
    let compiled = compile(&library, project.main(), &project, &Options { outputs, ..Options::default() });
    let compiled = compiled.map_err(|f| render::human(&f.sources, &f.diagnostics))?;
    let mut program = compiled.program;
    let tables =
        load(&mut program, &project).map_err(|diagnostics| render::human(&compiled.sources, &diagnostics))?;
    Ok((program, tables))
}

fn tiling() -> Result<(Program, Tables), Failed> {
    loaded(&root().join("examples/tiling.tex"), None)
}

fn on_cpu(program: &Program, tables: &Tables, request: &Request) -> Result<Picture, Failed> {
    cpu::render(program, tables, request, &|_| {}).map_err(|error| error.to_string().into())
}

/// A picture through its file.
fn written(picture: &Picture) -> Result<image::RgbaImage, Failed> {
    let png = picture.to_png().map_err(|error| error.to_string())?;
    Ok(image::load_from_memory(&png).map_err(|error| error.to_string())?.to_rgba8())
}

/// Luma as it is shown: of sRGB-encoded channels, 0 to 1.
fn luma(picture: &Picture) -> Vec<f32> {
    let encode = |c: f32| if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    picture
        .pixels
        .iter()
        .map(|[r, g, b, _]| 0.2126 * encode(*r) + 0.7152 * encode(*g) + 0.0722 * encode(*b))
        .collect()
}

/// The picture of the README: 64 cells a side, 16 pixels each.
fn tiling_has_no_grid_and_no_period() -> Result<(), Failed> {
    let (program, tables) = tiling()?;
    let (side, cell) = (1024, 16);
    let luma = luma(&on_cpu(&program, &tables, &Request::new([side as u32; 2]))?);
    let (mut across, mut inside) = (Vec::new(), Vec::new());
    for y in 0..side {
        for x in 1..side {
            let steps =
                [luma[y * side + x] - luma[y * side + x - 1], luma[x * side + y] - luma[(x - 1) * side + y]];
            let kind = if x % cell == 0 { &mut across } else { &mut inside };
            kind.extend(steps.map(f32::abs));
        }
    }
    let mean = |steps: &[f32]| steps.iter().map(|s| f64::from(*s)).sum::<f64>() / steps.len() as f64;
    let ratio = mean(&across) / mean(&inside);
    let (peak, at) = highest_repeat(&luma, side, cell);
    println!("gradient across borders over inside {ratio:.3}, highest repeat {peak:.3} at {at:?} cells");
    if ratio > 1.1 || peak > 0.1 {
        return Err(format!(
            "border ratio {ratio:.3} (at most 1.1), repeat {peak:.3} at {at:?} (at most 0.1)"
        )
        .into());
    }
    Ok(())
}

/// The largest autocorrelation at any lag of whole cells up to half the picture: the covariance of
/// what overlaps over its variance.
fn highest_repeat(luma: &[f32], side: usize, cell: usize) -> (f64, (i32, i32)) {
    let mean = luma.iter().sum::<f32>() / luma.len() as f32;
    let centred: Vec<f32> = luma.iter().map(|x| x - mean).collect();
    let half = (side / cell / 2) as i32;
    let mut highest = (f64::MIN, (0, 0));
    for j in 0..=half {
        for i in -half..=half {
            if j == 0 && i <= 0 {
                continue;
            }
            let correlation = correlation(&centred, side, i * cell as i32, j as usize * cell);
            if correlation > highest.0 {
                highest = (correlation, (i, j));
            }
        }
    }
    highest
}

fn correlation(centred: &[f32], side: usize, dx: i32, dy: usize) -> f64 {
    let width = side - dx.unsigned_abs() as usize;
    let (left, right) = if dx < 0 { (-dx as usize, 0) } else { (0, dx as usize) };
    let (mut product, mut first, mut second) = (0.0_f64, 0.0_f64, 0.0_f64);
    for y in 0..side - dy {
        let a = &centred[y * side + left..][..width];
        let b = &centred[(y + dy) * side + right..][..width];
        product += f64::from(a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>());
        first += f64::from(a.iter().map(|a| a * a).sum::<f32>());
        second += f64::from(b.iter().map(|b| b * b).sum::<f32>());
    }
    product / (first * second).sqrt()
}

/// The committed picture of the example is what the CPU renderer draws.
fn tiling_is_as_recorded() -> Result<(), Failed> {
    let (program, tables) = tiling()?;
    let request = Request { region: [0.1, 0.1, 0.2875, 0.2875], ..Request::new([340, 340]) };
    let picture = on_cpu(&program, &tables, &request)?;
    let path = root().join("docs/images/tiling.png");
    if std::env::var("TEXGRAPH_PICTURES").is_ok_and(|value| value == "write") {
        std::fs::write(&path, picture.to_png().map_err(|error| error.to_string())?)?;
    }
    let recorded = image::open(&path).map_err(|error| error.to_string())?.to_rgba8();
    let drawn = written(&picture)?;
    let far = recorded.iter().zip(drawn.iter()).filter(|(a, b)| a.abs_diff(**b) > 1).count();
    if recorded.dimensions() != drawn.dimensions() || far > 0 {
        return Err(format!("{far} channels differ from docs/images/tiling.png").into());
    }
    Ok(())
}

/// Tables and textures of the example stay below 2 MB.
fn tiling_stays_small() -> Result<(), Failed> {
    let (_, tables) = tiling()?;
    let bytes: usize = tables.iter().map(|(_, _, bytes)| bytes.len()).sum();
    println!("{bytes} bytes of tables");
    if bytes < 2_000_000 { Ok(()) } else { Err(format!("{bytes} bytes").into()) }
}

/// No shift of up to 64 cells maps an area of the virtual index onto itself, with σ and without,
/// and all patterns are drawn equally often.
fn virtual_indices_do_not_repeat() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    for pick in ["virtual_index(cell, 16, sigma: s)", "virtual_index(cell, 16)"] {
        let file = folder.path().join("index.tex");
        let text = format!(
            "let s = permutation(16, seed: 1)\n\
             texture index(uv: vec2) -> (height: float) {{ let cell = ifloor(uv) height = {pick} / 16.0 }}"
        );
        std::fs::write(&file, text)?;
        let (program, tables) = loaded(&file, None)?;
        let side = 256;
        // Far out, so that every digit of the walk takes part.
        let region = [40_000.0, 3_000.0, 40_000.0 + f64::from(side), 3_000.0 + f64::from(side)];
        let request = Request { region, settings: Settings::new(), ..Request::new([side; 2]) };
        let picks = |request: &Request| -> Result<Vec<u32>, Failed> {
            let picture = on_cpu(&program, &tables, request)?;
            Ok(picture.pixels.iter().map(|p| (p[0] * 16.0).round() as u32).collect())
        };
        let here = picks(&request)?;
        check_picks(pick, &here, side as usize)?;
        // Shifts by whole digits, within the period of 65,536 cells.
        for shift in [256.0, 4_096.0, 16_384.0, 25_000.0] {
            for [dx, dy] in [[shift, 0.0], [0.0, shift], [shift, shift]] {
                let [x0, y0, x1, y1] = region;
                let moved = Request { region: [x0 + dx, y0 + dy, x1 + dx, y1 + dy], ..request.clone() };
                let there = picks(&moved)?;
                let same = here.iter().zip(&there).filter(|(a, b)| a == b).count();
                let share = same as f64 / here.len() as f64;
                if share > 0.2 {
                    return Err(format!("{pick}: a shift of ({dx}, {dy}) agrees in {share:.2}").into());
                }
            }
        }
    }
    Ok(())
}

fn check_picks(name: &str, picks: &[u32], side: usize) -> Result<(), Failed> {
    let mut counts = [0_usize; 16];
    picks.iter().for_each(|pick| counts[*pick as usize] += 1);
    let expected = picks.len() / 16;
    if counts.iter().any(|count| count.abs_diff(expected) > expected / 10) {
        return Err(format!("{name}: drawn unequally, {counts:?}").into());
    }
    for dy in 0..64 {
        for dx in 0..64 {
            if (dx, dy) == (0, 0) {
                continue;
            }
            let pairs = (0..side - dy).flat_map(|y| (0..side - dx).map(move |x| (x, y)));
            let (mut same, mut all) = (0, 0);
            for (x, y) in pairs {
                all += 1;
                same += usize::from(picks[y * side + x] == picks[(y + dy) * side + x + dx]);
            }
            // Two independent draws of sixteen agree in a sixteenth.
            let share = same as f64 / f64::from(all);
            if share > 0.2 {
                return Err(format!("{name}: a shift of ({dx}, {dy}) agrees in {share:.2}").into());
            }
        }
    }
    Ok(())
}

fn any_thread_count_gives_the_same_picture() -> Result<(), Failed> {
    let (program, tables) = tiling()?;
    let request = Request::new([97, 61]);
    let render = |threads: usize| -> Result<Picture, Failed> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        pool.install(|| on_cpu(&program, &tables, &request))
    };
    let (one, five) = (render(1)?, render(5)?);
    if one.pixels == five.pixels { Ok(()) } else { Err("one thread and five differ".into()) }
}
