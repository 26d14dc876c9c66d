//! The plane in perspective: what a camera sees of `uv`. That the GPU sees the same is for
//! `agreement`. `TEXGRAPH_WGSL=FOLDER` writes every example's shader on the ground to `FOLDER/plane`, for
//! `tests/tint`.

use libtest_mimic::{Arguments, Failed, Trial};
use std::collections::HashMap;
use std::path::PathBuf;
use texgraph_compiler::plane::{HORIZON, SKY};
use texgraph_compiler::{Library, Options, Plane, Program, compile, diagnostic::render};
use texgraph_runtime::cpu;
use texgraph_runtime::picture::Picture;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, load};

/// Units of `uv` along the lower edge.
const REPEAT: f32 = 3.0;

fn main() {
    let arguments = Arguments::from_args();
    let trials = vec![
        Trial::test("the_lower_edge_shows_so_many_units", the_lower_edge_shows_so_many_units),
        Trial::test("what_is_above_the_horizon_is_sky", what_is_above_the_horizon_is_sky),
        Trial::test("the_view_goes_to_the_eye", the_view_goes_to_the_eye),
        Trial::test("derivatives_are_those_of_the_place", derivatives_are_those_of_the_place),
        Trial::test("far_away_is_the_mean", far_away_is_the_mean),
        Trial::test("every_example_lies_on_the_ground", every_example_lies_on_the_ground),
        Trial::test("wires_lie_on_the_ground_too", wires_lie_on_the_ground_too),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}

fn plane(size: [u32; 2], repeat: f32) -> Option<Plane> {
    let [width, height] = size.map(|side| side as f32);
    Some(Plane { repeat, aspect: width / height })
}

/// What the CPU sees of a text.
fn seen(text: &str, size: [u32; 2], texture: Option<&str>) -> Result<Picture, Failed> {
    let files: HashMap<String, String> = [("main.tex".to_owned(), text.to_owned())].into();
    let texture = texture.map(str::to_owned);
    let options = Options { texture, plane: plane(size, REPEAT), ..Options::default() };
    let compiled = compile(&Library::standard()?, "main.tex", &files, &options);
    let program = compiled.map_err(|f| render::human(&f.sources, &f.diagnostics))?.program;
    Ok(on_cpu(&program, &Tables::default(), &Request::new(size))?)
}

fn on_cpu(program: &Program, tables: &Tables, request: &Request) -> Result<Picture, String> {
    cpu::render(program, tables, request, &|_| {}).map_err(|error| error.to_string())
}

/// A program that lies on the ground, with its tables.
fn loaded(file: &str, plane: Option<Plane>) -> Result<(Program, Tables), Failed> {
    let project = Project::new(&PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(file), true);
    let options = Options { plane, ..Options::default() };
    let compiled = compile(&Library::standard()?, project.main(), &project, &options);
    let compiled = compiled.map_err(|f| render::human(&f.sources, &f.diagnostics))?;
    let mut program = compiled.program;
    let tables = load(&mut program, &project);
    Ok((program, tables.map_err(|diagnostics| render::human(&compiled.sources, &diagnostics))?))
}

fn pixel(picture: &Picture, x: u32, y: u32) -> [f32; 4] {
    picture.pixels[(y * picture.size[0] + x) as usize]
}

fn near(a: f32, b: f32, tolerance: f32) -> bool {
    (a - b).abs() <= tolerance
}

fn the_lower_edge_shows_so_many_units() -> Result<(), Failed> {
    let size = [2000, 1000];
    let place = seen("texture t(uv: vec2) -> (place: vec2) { place = uv }", size, None)?;
    let [left, right] = [0, size[0] - 1].map(|x| pixel(&place, x, size[1] - 1));
    assert!(near(left[0], 0.0, 0.01) && near(left[1], REPEAT, 0.01), "{left:?}");
    assert!(near(right[0], REPEAT, 0.01) && near(right[1], REPEAT, 0.01), "{right:?}");
    // Twice as far from the horizon is half as far away.
    let middle = pixel(&place, 0, 624);
    assert!(near(middle[0], -REPEAT / 2.0, 0.02), "{middle:?}");
    Ok(())
}

fn what_is_above_the_horizon_is_sky() -> Result<(), Failed> {
    let size = [64, 64];
    let horizon = (HORIZON * 64.0) as u32;
    let text = "texture t(uv: vec2) -> (color: color) { color = vec4(1.0) }\n\
        texture n(uv: vec2) -> (number: int) { number = ifloor(uv.x) + 100000 }\n\
        texture here() -> (height: float) { height = 0.5 }";
    for (texture, sky, ground) in [
        ("t", SKY, 1.0..=1.0),
        ("n", [0.0, 0.0, 0.0, 1.0], 1000.0..=1e6),
        ("here", [0.0, 0.0, 0.0, 1.0], 0.5..=0.5),
    ] {
        let picture = seen(text, size, Some(texture))?;
        for (x, y) in (0..64).flat_map(|y| (0..64).map(move |x| (x, y))) {
            let pixel = pixel(&picture, x, y);
            assert!(
                if y < horizon { pixel == sky } else { ground.contains(&pixel[0]) },
                "{texture} {x} {y} {pixel:?}"
            );
        }
    }
    Ok(())
}

fn the_view_goes_to_the_eye() -> Result<(), Failed> {
    let size = [96, 64];
    let text = "texture v(view: vec3) -> (at: vec3) { at = view }\n\
        texture p(position: vec3) -> (at: vec3) { at = position }";
    let (views, places) = (seen(text, size, Some("v"))?, seen(text, size, Some("p"))?);
    let aspect = 1.5;
    let eye = [0.5, 1.0 + 1.0 / aspect, (1.0 - HORIZON) / aspect].map(|x| x * REPEAT);
    for (x, y) in (17..64).flat_map(|y| (0..96).map(move |x| (x, y))) {
        let (view, place) = (pixel(&views, x, y), pixel(&places, x, y));
        let to_eye = [0, 1, 2].map(|i| eye[i] - place[i]);
        let length = to_eye.iter().map(|x| x * x).sum::<f32>().sqrt();
        let same = [0, 1, 2].iter().all(|i| near(view[*i], to_eye[*i] / length, 1e-4));
        assert!(same, "{x} {y}: {view:?}, {to_eye:?}");
    }
    Ok(())
}

/// Against differences of the place in a picture eight times as fine.
fn derivatives_are_those_of_the_place() -> Result<(), Failed> {
    const FINE: u32 = 8;
    let size = [48, 32];
    let text = "texture t(uv: vec2) -> (rates: vec4) { rates = vec4(dx(uv), dy(uv)) }\n\
        texture p(uv: vec2) -> (place: vec2) { place = uv }";
    let rates = seen(text, size, Some("t"))?;
    let places = seen(text, size.map(|side| side * FINE), Some("p"))?;
    for (x, y) in (10..32).flat_map(|y| (0..48).map(move |x| (x, y))) {
        let rates = pixel(&rates, x, y);
        let (i, j) = (x * FINE + FINE / 2, y * FINE + FINE / 2);
        // A pixel's centre lies between four fine ones.
        let at = [(i - 1, j - 1), (i, j - 1), (i - 1, j), (i, j)].map(|(i, j)| pixel(&places, i, j));
        let between = |a: usize, b: usize, c: usize, d: usize, n: usize| {
            (at[a][n] - at[b][n] + at[c][n] - at[d][n]) * (FINE / 2) as f32
        };
        let expected =
            [between(1, 0, 3, 2, 0), between(1, 0, 3, 2, 1), between(2, 0, 3, 1, 0), between(2, 0, 3, 1, 1)];
        let size = rates.iter().fold(0.0_f32, |most, rate| most.max(rate.abs()));
        let same = rates.iter().zip(expected).all(|(rate, expected)| near(*rate, expected, 0.01 * size));
        assert!(same, "{x} {y}: {rates:?}, {expected:?}");
    }
    Ok(())
}

/// Filtering shows: just below the horizon, where a pixel covers many tiles, there is no noise.
fn far_away_is_the_mean() -> Result<(), Failed> {
    let size = [200, 200];
    let (program, tables) = loaded("examples/tiling.tex", plane(size, 1.0))?;
    let picture = on_cpu(&program, &tables, &Request::new(size))?;
    let rows = |rows: std::ops::Range<usize>| &picture.pixels[rows.start * 200..rows.end * 200];
    let mean = |pixels: &[[f32; 4]]| {
        [0, 1, 2].map(|i| pixels.iter().map(|p| p[i]).sum::<f32>() / pixels.len() as f32)
    };
    let (far, close) = (rows(50..70), rows(150..200));
    let (mean_far, mean_close) = (mean(far), mean(close));
    for i in 0..3 {
        assert!(near(mean_far[i], mean_close[i], 4.0 / 255.0), "{mean_far:?} {mean_close:?}");
        let widest = far.iter().map(|p| (p[i] - mean_far[i]).abs()).fold(0.0, f32::max);
        assert!(widest < 4.0 / 255.0, "channel {i} strays by {widest}");
    }
    Ok(())
}

/// It compiles, so naga takes it.
fn every_example_lies_on_the_ground() -> Result<(), Failed> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("examples");
    let written = std::env::var_os("TEXGRAPH_WGSL").map(|folder| PathBuf::from(folder).join("plane"));
    for entry in std::fs::read_dir(folder)? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        let Some(stem) = name.strip_suffix(".tex") else { continue };
        let (program, _) = loaded(&format!("examples/{name}"), plane([16, 9], REPEAT))?;
        let wgsl = &program.texture().wgsl;
        assert!(wgsl.contains("dpdx") || !wgsl.contains("textureSampleGrad"), "{name}");
        if let Some(folder) = &written {
            std::fs::create_dir_all(folder)?;
            std::fs::write(folder.join(format!("{stem}.wgsl")), wgsl)?;
        }
    }
    Ok(())
}

fn wires_lie_on_the_ground_too() -> Result<(), Failed> {
    let text = "texture t(uv: vec2) -> (color: color) { let place = uv * 2.0 color = vec4(place, 0.0, 1.0) }";
    let place = seen(text, [400, 200], Some("t.place"))?;
    let corner = pixel(&place, 399, 199);
    assert!(near(corner[0], 2.0 * REPEAT, 0.1) && near(corner[1], 2.0 * REPEAT, 0.1), "{corner:?}");
    assert_eq!(pixel(&place, 0, 0)[..2], [0.0, 0.0]);
    Ok(())
}
