//! Pictures of floats: OpenEXR and Radiance HDR.

mod common;

use common::{folder, load_recipes};
use half::f16;
use image::{DynamicImage, ImageBuffer, Rgb, Rgb32FImage, Rgba, Rgba32FImage};
use std::fs;
use std::path::Path;
use texgraph_compiler::diagnostic::Place;
use texgraph_compiler::manifest::{Borders, Compression, Encoding, IndicesSource, Recipe, Tileable};
use texgraph_runtime::project::Project;
use texgraph_runtime::resource::Made;
use texgraph_runtime::resource::exemplar::{self, Wanted};

fn image(path: &str, encoding: Encoding, tileable: Tileable) -> Recipe {
    Recipe::Image { path: path.into(), encoding, tileable }
}

/// The textures of an exemplar of data: `gaussian` and `inverse`.
fn exemplar(folder: &Path, path: &str) -> [Vec<u8>; 2] {
    let wanted = Wanted {
        encoding: Encoding::Linear,
        channels: 3,
        slices: 1,
        borders: Borders::Repeat,
        lut: 256,
        compress: Compression::None,
    };
    let project = Project::new(&folder.join("main.tex"), false);
    let made = exemplar::make(&project, Place::default(), path, &wanted).expect("the picture is good");
    let [gaussian, inverse] = <[Made; 2]>::try_from(made).unwrap_or_else(|_| panic!("there are two"));
    [gaussian.bytes, inverse.bytes]
}

/// The bytes of a recipe's texture.
fn made(folder: &Path, recipe: Recipe) -> Vec<u8> {
    let field = if matches!(recipe, Recipe::Indices { .. }) { "map" } else { "pixels" };
    let (_, tables) = load_recipes(folder, vec![recipe]).expect("the resource loads");
    tables.get(0, field).expect("there are bytes").to_vec()
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks().0.iter().map(|pair| f16::from_le_bytes(*pair).to_f32()).collect()
}

/// A texel of a made-up picture: its red from 0 to 1.
fn red(x: u32, y: u32) -> f32 {
    ((x * 37 + y * 101 + x * y * 13) % 251) as f32 / 250.0
}

#[test]
fn light_is_kept_as_it_is() {
    let folder = folder();
    let texels = [[2.5, 0.25, -1.0], [1000.0, 0.0, 0.75]];
    let picture = Rgb32FImage::from_fn(2, 1, |x, _| Rgb(texels[x as usize]));
    picture.save(folder.path().join("a.exr")).expect("the picture is written");
    for encoding in [Encoding::Srgb, Encoding::Linear] {
        let bytes = made(folder.path(), image("a.exr", encoding, Tileable::None));
        assert_eq!(floats(&bytes)[..8], [2.5, 0.25, -1.0, 1.0, 1000.0, 0.0, 0.75, 1.0]);
    }
    // Radiance's numbers have eight bits each, and a texel's have one exponent: steps of 1/64, and of 4.
    DynamicImage::from(picture).save(folder.path().join("a.hdr")).expect("the picture is written");
    let bytes = made(folder.path(), image("a.hdr", Encoding::Srgb, Tileable::None));
    let expected = [2.5, 0.25, 0.0, 1.0, 1000.0, 0.0, 0.75, 1.0];
    for (i, (found, expected)) in floats(&bytes).into_iter().zip(expected).enumerate() {
        let step = if i < 4 { 1.0 / 64.0 } else { 4.0 };
        assert!((found - expected).abs() <= step, "{found} for {expected}");
    }
}

#[test]
fn colours_of_openexr_are_multiplied_by_alpha() {
    let folder = folder();
    let picture = Rgba32FImage::from_fn(1, 1, |_, _| Rgba([0.5, 0.25, 0.125, 0.25]));
    picture.save(folder.path().join("a.exr")).expect("the picture is written");
    let bytes = made(folder.path(), image("a.exr", Encoding::Srgb, Tileable::None));
    assert_eq!(floats(&bytes)[..4], [0.5, 0.25, 0.125, 0.25]);
    let bytes = made(folder.path(), image("a.exr", Encoding::Linear, Tileable::None));
    assert_eq!(floats(&bytes)[..4], [2.0, 1.0, 0.5, 0.25], "data is not multiplied");
}

#[test]
fn what_is_no_number_becomes_one() {
    let folder = folder();
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30];
    let picture = Rgb32FImage::from_fn(16, 16, |x, y| {
        Rgb([odd[(x % 4) as usize], red(x, y), if x == y { odd[(y % 4) as usize] } else { red(y, x) }])
    });
    picture.save(folder.path().join("a.exr")).expect("the picture is written");
    for encoding in [Encoding::Srgb, Encoding::Linear, Encoding::Normal] {
        for tileable in [Tileable::None, Tileable::Blend] {
            let bytes = made(folder.path(), image("a.exr", encoding, tileable));
            assert!(floats(&bytes).iter().all(|number| number.is_finite()), "{encoding:?}, {tileable:?}");
        }
    }
    let [_, inverse] = exemplar(folder.path(), "a.exr");
    assert!(floats(&inverse).iter().all(|number| number.is_finite()));
}

/// Eight times the light has the same ranks, and the way back leads to eight times as much.
#[test]
fn exemplars_of_floats_are_those_of_their_ranks() {
    let folder = folder();
    let size = 64;
    let color = |x: u32, y: u32| [red(x, y), red(y + 3, x), red(x + 7, y + 2)];
    let plain = Rgb32FImage::from_fn(size, size, |x, y| Rgb(color(x, y)));
    let bright = Rgb32FImage::from_fn(size, size, |x, y| Rgb(color(x, y).map(|number| number * 8.0)));
    plain.save(folder.path().join("plain.exr")).expect("the picture is written");
    bright.save(folder.path().join("bright.exr")).expect("the picture is written");
    let samples = (0..size * size).flat_map(|i| color(i % size, i / size));
    let samples: Vec<u16> = samples.map(|number| (number * 65535.0).round() as u16).collect();
    let picture: ImageBuffer<Rgb<u16>, _> =
        ImageBuffer::from_raw(size, size, samples).expect("there are enough");
    picture.save(folder.path().join("deep.png")).expect("the picture is written");
    let [plain, bright, deep] =
        ["plain.exr", "bright.exr", "deep.png"].map(|path| exemplar(folder.path(), path));
    let agree = |a: &[u8], b: &[u8]| {
        let near = a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) <= 1).count();
        near as f64 / a.len() as f64
    };
    assert!(agree(&plain[0], &bright[0]) > 0.9999, "{}", agree(&plain[0], &bright[0]));
    for (found, expected) in floats(&bright[1]).into_iter().zip(floats(&plain[1])) {
        assert!((found / 8.0 - expected).abs() < 2e-3, "{found} for eight times {expected}");
    }
    // Halves are coarser than 16-bit numbers: a texel may have another's rank.
    assert!(agree(&plain[0], &deep[0]) > 0.99, "{}", agree(&plain[0], &deep[0]));
}

#[test]
fn maps_take_shares_of_one() {
    let folder = folder();
    let share = |x: u32| [-3.0, 0.0, 0.24, 0.26, 0.5, 0.99, 1.0, 7.0][x as usize];
    Rgb32FImage::from_fn(8, 1, |x, _| Rgb([share(x); 3]))
        .save(folder.path().join("a.exr"))
        .expect("it is written");
    let source = IndicesSource::Path("a.exr".into());
    let recipe = Recipe::Indices { source, levels: 4 };
    let bytes = made(folder.path(), recipe);
    let numbers: Vec<i32> = bytes.as_chunks().0.iter().map(|word| i32::from_le_bytes(*word)).collect();
    assert_eq!(numbers, [0, 0, 0, 1, 2, 3, 3, 3]);
}

/// Each file cut at each length, and with each byte changed, is made or told of.
#[test]
fn damaged_files_are_told_of() {
    let folder = folder();
    let picture = Rgb32FImage::from_fn(24, 20, |x, y| Rgb([red(x, y), red(y, x), 0.5]));
    for name in ["a.exr", "a.hdr"] {
        let path = folder.path().join(name);
        DynamicImage::from(picture.clone()).save(&path).expect("the picture is written");
        let whole = fs::read(&path).expect("it is read");
        let load = |bytes: &[u8]| {
            fs::write(&path, bytes).expect("it is written");
            load_recipes(folder.path(), vec![image(name, Encoding::Srgb, Tileable::None)])
        };
        let mut refused = 0;
        for length in (0..whole.len()).step_by(whole.len() / 150) {
            let error = load(&whole[..length]).expect_err("a part is no picture");
            assert_eq!(error[0].code, "E0505", "{name} cut at {length}");
        }
        for at in (0..whole.len().min(400)).chain((400..whole.len()).step_by(97)) {
            let mut bytes = whole.clone();
            bytes[at] ^= 0x90;
            refused += usize::from(load(&bytes).is_err());
        }
        assert!(refused > 10, "{name}: {refused} of changed files are refused");
    }
}
