//! The tables of every kind on made-up pictures, and what is said about broken ones.

mod common;

use common::{folder, load_recipes, write_deep, write_picture};
use std::fs;
use std::path::Path;
use texgraph_compiler::manifest::{
    Borders, Compression, Encoding, Format, IndicesSource, Recipe, Table, Tileable,
};
use texgraph_runtime::resource::Decoded;
use texgraph_runtime::resource::exemplar::{self, Wanted};

fn image(path: &str, encoding: Encoding) -> Recipe {
    Recipe::Image { path: path.into(), encoding, tileable: Tileable::None }
}

fn tileable(path: &str, encoding: Encoding) -> Recipe {
    Recipe::Image { path: path.into(), encoding, tileable: Tileable::Blend }
}

fn patterns(paths: &[&str], grid: [u32; 2]) -> Recipe {
    Recipe::Patterns {
        paths: paths.iter().map(ToString::to_string).collect(),
        grid,
        encoding: Encoding::Linear,
    }
}

/// The one table of one recipe.
fn made(folder: &Path, recipe: Recipe) -> (Table, Vec<u8>) {
    let (manifest, tables) = load_recipes(folder, vec![recipe]).expect("the resource loads");
    let texture = &manifest.resources[0].textures[0];
    let bytes = tables.get(0, &texture.field).expect("there are bytes").to_vec();
    (texture.table.clone().expect("the table is described"), bytes)
}

/// The code of each error of some recipes.
fn codes(folder: &Path, recipes: Vec<Recipe>) -> Vec<&'static str> {
    let errors = load_recipes(folder, recipes).expect_err("it must not load");
    errors.iter().map(|error| error.code).collect()
}

fn integers(bytes: &[u8]) -> Vec<i32> {
    bytes.chunks_exact(4).map(|word| i32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}

#[test]
fn opaque_colour_is_stored_as_it_was() {
    let folder = folder();
    let samples: Vec<u8> = (0..4 * 4 * 3).map(|i| (i * 5) as u8).collect();
    write_picture(&folder.path().join("a.png"), [4, 4], &samples);
    let (table, bytes) = made(folder.path(), image("a.png", Encoding::Srgb));
    assert_eq!(table.format, Format::Rgba8UnormSrgb);
    let sizes: Vec<[u32; 2]> = table.levels.iter().map(|level| [level.width, level.height]).collect();
    assert_eq!(sizes, [[4, 4], [2, 2], [1, 1]]);
    assert_eq!(bytes.len(), (16 + 4 + 1) * 4);
    for (texel, stored) in samples.chunks(3).zip(bytes.chunks(4)) {
        assert_eq!([texel[0], texel[1], texel[2], 255], *stored);
    }
}

#[test]
fn colour_is_premultiplied_and_filtered_in_light() {
    let folder = folder();
    let samples = [255, 255, 255, 255, 255, 0, 0, 0];
    write_picture(&folder.path().join("a.png"), [2, 1], &samples);
    let (_, bytes) = made(folder.path(), image("a.png", Encoding::Srgb));
    assert_eq!(bytes[4..8], [0, 0, 0, 0], "a transparent texel has no colour");
    assert_eq!(bytes[8..12], [188, 188, 188, 128], "half the light is sRGB 188");
}

#[test]
fn data_keeps_its_colour_where_it_is_transparent() {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [2, 1], &[200, 100, 0, 255, 100, 0, 0, 0]);
    let (table, bytes) = made(folder.path(), image("a.png", Encoding::Linear));
    assert_eq!(table.format, Format::Rgba8Unorm);
    assert_eq!(bytes, [200, 100, 0, 255, 100, 0, 0, 0, 150, 50, 0, 128]);
}

#[test]
fn grey_reads_as_three_equal_channels() {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [1, 1], &[77]);
    assert_eq!(made(folder.path(), image("a.png", Encoding::Linear)).1, [77, 77, 77, 255]);
}

#[test]
fn normals_are_signed_and_flat_is_flat() {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [2, 1], &[128, 127, 255, 0, 255, 128]);
    let (table, bytes) = made(folder.path(), image("a.png", Encoding::Normal));
    assert_eq!(table.format, Format::Rgba8Snorm);
    assert_eq!(bytes[0..4], [0, 0, 127, 127]);
    assert_eq!(bytes[4..8], [129, 127, 0, 127], "-127 in two's complement");
}

#[test]
fn sixteen_bits_become_half_floats() {
    let folder = folder();
    write_deep(&folder.path().join("a.png"), [2, 1], &[0, 65535]);
    let (table, bytes) = made(folder.path(), image("a.png", Encoding::Linear));
    assert_eq!(table.format, Format::Rgba16Float);
    let halves: Vec<f32> =
        bytes.chunks(2).map(|pair| half::f16::from_le_bytes([pair[0], pair[1]]).to_f32()).collect();
    assert_eq!(halves, [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.5, 0.5, 0.5, 1.0]);
}

/// Steps across a picture's borders, in those inside: across and down.
fn seams(size: [u32; 2], bytes: &[u8]) -> [f64; 2] {
    let texels = size[0] as usize * size[1] as usize;
    let samples = bytes.chunks_exact(4).take(texels).flat_map(|texel| [texel[0], texel[1], texel[2]]);
    let picture = Decoded::rgb(size, samples.collect()).expect("a picture");
    let wanted = Wanted {
        encoding: Encoding::Srgb,
        channels: 3,
        slices: 1,
        borders: Borders::Auto,
        lut: 256,
        compress: Compression::None,
    };
    let [across, down, _] = exemplar::steps(&picture, &wanted);
    [across, down].map(|[inside, across]| across / inside)
}

#[test]
fn photographs_are_made_to_wrap() {
    let photos = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/photos");
    for photo in ["gravel.jpg", "forest_floor.jpg"] {
        let (table, before) = made(&photos, image(photo, Encoding::Srgb));
        let (_, after) = made(&photos, tileable(photo, Encoding::Srgb));
        let size = [table.levels[0].width, table.levels[0].height];
        let [across, down] = seams(size, &before);
        assert!(across > exemplar::SEAM && down > exemplar::SEAM, "{photo}: {across}, {down}");
        // What stands at a border is the photograph's middle, where steps may be higher than elsewhere.
        let [across, down] = seams(size, &after);
        assert!(across < exemplar::SEAM && down < exemplar::SEAM, "{photo}: {across}, {down}");
        for (y, (before, after)) in before.chunks(512 * 4).zip(after.chunks(512 * 4)).take(512).enumerate() {
            let is_same = before[64 * 4..448 * 4] == after[64 * 4..448 * 4];
            if (64..448).contains(&y) || !(32..480).contains(&y) {
                assert_eq!(is_same, (64..448).contains(&y), "{photo}: {y}");
            }
        }
    }
}

#[test]
fn pictures_of_every_form_are_made_to_wrap() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let slope = |y: usize, x: usize| (40 + 2 * x + y) as u8;
    let grid = || (0..33).flat_map(|y| (0..64).map(move |x| (y, x)));
    let grey: Vec<u8> = grid().map(|(y, x)| slope(y, x)).collect();
    write_picture(&at("grey.png"), [64, 33], &grey);
    let deep: Vec<u16> = grey.iter().map(|sample| u16::from(*sample) * 257).collect();
    write_deep(&at("deep.png"), [64, 33], &deep);
    let clear: Vec<u8> = grid().flat_map(|(y, x)| [200, slope(y, x), 30, slope(y, x)]).collect();
    write_picture(&at("clear.png"), [64, 33], &clear);

    // Grey stays grey, and both depths tell the same.
    let (_, bytes) = made(folder.path(), tileable("grey.png", Encoding::Linear));
    assert!(
        bytes.chunks_exact(4).all(|texel| texel[0] == texel[1] && texel[1] == texel[2] && texel[3] == 255)
    );
    let (table, floats) = made(folder.path(), tileable("deep.png", Encoding::Linear));
    assert_eq!(table.format, Format::Rgba16Float);
    for (texel, deep) in bytes.chunks_exact(4).zip(floats.chunks_exact(8)) {
        let deep = half::f16::from_le_bytes([deep[0], deep[1]]).to_f32() * 255.0;
        assert!((deep - f32::from(texel[0])).abs() < 1.0, "{deep} for {}", texel[0]);
    }
    // Halfway down, at the left border, stands what stands in the middle: of alpha too.
    let (_, bytes) = made(folder.path(), tileable("clear.png", Encoding::Linear));
    let alpha = bytes[4 * 64 * 16 + 3];
    assert!(alpha.abs_diff(slope(16, 32)) <= 2, "{alpha}");
    // Slopes of unit normals.
    let (_, bytes) = made(folder.path(), tileable("clear.png", Encoding::Normal));
    let normal = [0, 1, 2].map(|k| f32::from(bytes[4 * 64 * 16 + k] as i8) / 127.0);
    let length = normal.iter().map(|x| x * x).sum::<f32>();
    assert!((length - 1.0).abs() < 0.03, "{normal:?}");
}

#[test]
fn odd_sizes_keep_their_mean_on_every_level() {
    let folder = folder();
    let size = [37, 19];
    let samples: Vec<u16> = (0..37 * 19u32).map(|i| (i * 7919 % 65536) as u16).collect();
    write_deep(&folder.path().join("a.png"), size, &samples);
    let (table, bytes) = made(folder.path(), image("a.png", Encoding::Linear));
    let mean = samples.iter().map(|sample| f64::from(*sample) / 65535.0).sum::<f64>() / samples.len() as f64;
    assert_eq!(table.levels.len(), 6);
    for level in &table.levels {
        let count = (level.width * level.height) as usize;
        let texels = &bytes[level.offset as usize..][..count * 8];
        let red = texels.chunks(8).map(|texel| f64::from(half::f16::from_le_bytes([texel[0], texel[1]])));
        assert!((red.sum::<f64>() / count as f64 - mean).abs() < 4e-4, "{level:?}");
    }
}

#[test]
fn patterns_are_cut_row_by_row_and_never_mix() {
    let folder = folder();
    // Four cells of 2×2, each of one grey.
    let grey = |x: u32, y: u32| ((y / 2) * 2 + x / 2) as u8 * 80;
    let samples: Vec<u8> = (0..16).map(|i| grey(i % 4, i / 4)).collect();
    write_picture(&folder.path().join("a.png"), [4, 4], &samples);
    let (table, bytes) = made(folder.path(), patterns(&["a.png"], [2, 2]));
    assert_eq!((table.width, table.height, table.layers, table.levels.len()), (2, 2, 4, 2));
    for level in &table.levels {
        let per_layer = (level.width * level.height) as usize * 4;
        for layer in 0..4 {
            let texels = &bytes[level.offset as usize + layer * per_layer..][..per_layer];
            assert!(texels.chunks(4).all(|texel| texel[0] == layer as u8 * 80), "layer {layer}");
        }
    }
}

#[test]
fn a_list_of_files_is_a_list_of_layers() {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [1, 1], &[10]);
    write_picture(&folder.path().join("b.tga"), [1, 1], &[20]);
    let (table, bytes) = made(folder.path(), patterns(&["a.png", "b.tga"], [1, 1]));
    assert_eq!(table.layers, 2);
    assert_eq!(bytes, [10, 10, 10, 255, 20, 20, 20, 255]);
}

#[test]
fn pattern_mistakes_are_told() {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [5, 4], &[0; 20]);
    write_picture(&folder.path().join("b.png"), [4, 4], &[0; 16]);
    assert_eq!(codes(folder.path(), vec![patterns(&["a.png"], [2, 2])]), ["E0507"]);
    assert_eq!(codes(folder.path(), vec![patterns(&["a.png", "b.png"], [1, 1])]), ["E0508"]);
    assert_eq!(codes(folder.path(), vec![patterns(&["b.png"], [257, 1])]), ["E0554"]);
    assert_eq!(codes(folder.path(), vec![patterns(&["b.png"], [0, 4])]), ["E0551"]);
    assert_eq!(codes(folder.path(), vec![patterns(&[], [1, 1])]), ["E0551"]);
    let errors =
        load_recipes(folder.path(), vec![patterns(&["a.png"], [2, 2])]).expect_err("the grid is uneven");
    assert!(errors[0].message.contains("2×2") && errors[0].message.contains("5×4"), "{}", errors[0].message);
    assert!(errors[0].help.as_deref().is_some_and(|help| help.contains("4×4")));
}

#[test]
fn all_errors_of_all_resources_come_at_once_and_in_order() {
    let folder = folder();
    write_picture(&folder.path().join("grass.png"), [1, 1], &[0]);
    let recipes = vec![
        image("gras.png", Encoding::Srgb),
        image("grass.png", Encoding::Srgb),
        patterns(&["x.png", "y.png"], [1, 1]),
        image("../x.png", Encoding::Srgb),
        Recipe::Permutation { size: 1, seed: 0 },
    ];
    let errors = load_recipes(folder.path(), recipes).expect_err("four are broken");
    let told: Vec<(u32, &str)> = errors.iter().map(|error| (error.place.file, error.code)).collect();
    assert_eq!(told, [(0, "E0501"), (2, "E0501"), (2, "E0501"), (3, "E0502"), (4, "E0551")]);
    assert_eq!(errors[0].help.as_deref(), Some("is `grass.png` meant?"));
}

/// A PNG of one row whose header claims another size; its checksum is mended.
fn lying_png(size: [u32; 2]) -> Vec<u8> {
    let folder = folder();
    let path = folder.path().join("a.png");
    write_picture(&path, [4, 4], &[0; 16]);
    let mut bytes = fs::read(path).expect("the picture is there");
    bytes[16..20].copy_from_slice(&size[0].to_be_bytes());
    bytes[20..24].copy_from_slice(&size[1].to_be_bytes());
    let checksum = crc(&bytes[12..29]);
    bytes[29..33].copy_from_slice(&checksum.to_be_bytes());
    bytes
}

fn crc(bytes: &[u8]) -> u32 {
    let step = |crc: u32, byte: &u8| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { (c >> 1) ^ 0xedb8_8320 } else { c >> 1 })
    };
    !bytes.iter().fold(u32::MAX, step)
}

#[test]
fn lying_headers_are_refused() {
    let folder = folder();
    let claims = [
        ([60_000, 60_000], "E0506"),
        ([16_385, 1], "E0506"),
        ([16_384, 16], "E0511"),
        ([8_192, 16], "E0505"),
    ];
    for (size, code) in claims {
        fs::write(folder.path().join("lie.png"), lying_png(size)).expect("it is written");
        assert_eq!(codes(folder.path(), vec![image("lie.png", Encoding::Srgb)]), [code], "{size:?}");
    }
    let mut tga = vec![0; 18];
    tga[2] = 2;
    tga[12..16].fill(0xff);
    tga[16] = 32;
    fs::write(folder.path().join("lie.tga"), tga).expect("it is written");
    assert_eq!(codes(folder.path(), vec![image("lie.tga", Encoding::Srgb)]), ["E0506"]);
}

#[test]
fn every_truncation_is_an_error() {
    let folder = folder();
    let samples: Vec<u8> = (0..32 * 32 * 3).map(|i| (i * 37 % 251) as u8).collect();
    for name in ["a.png", "a.jpg", "a.tga"] {
        let path = folder.path().join(name);
        write_picture(&path, [32, 32], &samples);
        let whole = fs::read(&path).expect("the picture is there");
        load_recipes(folder.path(), vec![image(name, Encoding::Srgb)]).expect("the whole one loads");
        let kept = [0, 1, 10, 100, whole.len() / 4, whole.len() / 2, whole.len() * 9 / 10];
        for length in kept {
            fs::write(&path, &whole[..length]).expect("it is written");
            assert_eq!(
                codes(folder.path(), vec![image(name, Encoding::Srgb)]),
                ["E0505"],
                "{name}, {length} bytes"
            );
        }
    }
}

#[test]
fn other_formats_are_refused_by_their_content() {
    let folder = folder();
    fs::write(folder.path().join("a.png"), b"GIF89a\x01\0\x01\0\0\0\0;").expect("it is written");
    assert_eq!(codes(folder.path(), vec![image("a.png", Encoding::Srgb)]), ["E0505"]);
}

#[test]
fn a_texture_larger_than_any_gpu_takes_is_refused() {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [8193, 1], &[0; 8193]);
    assert_eq!(codes(folder.path(), vec![image("a.png", Encoding::Srgb)]), ["E0511"]);
    write_picture(&folder.path().join("b.png"), [8192, 1], &[0; 8192]);
    assert_eq!(made(folder.path(), image("b.png", Encoding::Srgb)).0.levels.len(), 14);
    let paths = ["b.png"; 2];
    assert_eq!(made(folder.path(), patterns(&paths, [1, 1])).0.layers, 2);
}

#[test]
fn permutations_are_permutations_and_never_change() {
    let folder = folder();
    for size in [2, 3, 256, 4096, 5000, 65_536] {
        let (table, bytes) = made(folder.path(), Recipe::Permutation { size, seed: 1 });
        assert_eq!(table.format, Format::Rgba32Sint);
        assert_eq!([table.width, table.height], [size.min(4096), size.div_ceil(4096)]);
        let numbers = integers(&bytes);
        for channel in 0..4 {
            let all = numbers.iter().skip(channel).step_by(4);
            let mut sigma: Vec<i32> = all.take(size as usize).copied().collect();
            sigma.sort_unstable();
            assert!(sigma.into_iter().eq(0..size as i32), "size {size}, channel {channel}");
        }
    }
    let (_, bytes) = made(folder.path(), Recipe::Permutation { size: 256, seed: 1 });
    assert_eq!(integers(&bytes)[..8], [130, 151, 169, 18, 196, 204, 177, 222]);
    assert_eq!(codes(folder.path(), vec![Recipe::Permutation { size: 65_537, seed: 0 }]), ["E0551"]);
}

#[test]
fn grey_is_cut_into_equal_steps() {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [4, 1], &[0, 127, 128, 255]);
    write_deep(&folder.path().join("b.png"), [4, 1], &[0, 21845, 21846, 65535]);
    let map = |path: &str, levels| Recipe::Indices { source: IndicesSource::Path(path.into()), levels };
    let (table, bytes) = made(folder.path(), map("a.png", 2));
    assert_eq!((table.format, table.levels.len()), (Format::R32Sint, 1));
    assert_eq!(integers(&bytes), [0, 0, 1, 1]);
    assert_eq!(integers(&made(folder.path(), map("b.png", 3)).1), [0, 0, 1, 2]);
    write_picture(&folder.path().join("c.png"), [1, 1], &[1, 2, 3]);
    assert_eq!(codes(folder.path(), vec![map("c.png", 2)]), ["E0513"]);
}

#[test]
fn rows_of_numbers_are_checked() {
    let folder = folder();
    let rows = |rows: &[&[i32]]| Recipe::Indices {
        source: IndicesSource::Rows(rows.iter().map(|row| row.to_vec()).collect()),
        levels: 2,
    };
    let (table, bytes) = made(folder.path(), rows(&[&[0, 1, 0], &[1, 0, 1]]));
    assert_eq!((table.width, table.height), (3, 2));
    assert_eq!(integers(&bytes), [0, 1, 0, 1, 0, 1]);
    for wrong in [rows(&[]), rows(&[&[]]), rows(&[&[0, 1], &[0]]), rows(&[&[0, 2]]), rows(&[&[-1]])] {
        assert_eq!(codes(folder.path(), vec![wrong]), ["E0551"]);
    }
}

#[test]
fn a_map_on_a_line_is_a_row_and_one_in_space_a_layer_a_slice() {
    let folder = folder();
    write_picture(
        &folder.path().join("a.png"),
        [2, 6],
        &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11].map(|i| i * 20),
    );
    let path = || IndicesSource::Path("a.png".into());
    let stack = |source, depth| Recipe::Stack { source, levels: 256, depth };
    let (table, bytes) = made(folder.path(), stack(path(), 3));
    assert_eq!((table.width, table.height, table.layers, table.levels.len()), (2, 2, 3, 1));
    assert_eq!(integers(&bytes), [0, 20, 40, 60, 80, 100, 120, 140, 160, 180, 200, 220]);
    let rows = |rows: &[&[i32]]| IndicesSource::Rows(rows.iter().map(|row| row.to_vec()).collect());
    let (table, bytes) = made(folder.path(), stack(rows(&[&[1, 2, 3], &[4, 5, 6]]), 2));
    assert_eq!((table.width, table.height, table.layers), (3, 1, 2));
    assert_eq!(integers(&bytes), [1, 2, 3, 4, 5, 6]);
    let line = |source| Recipe::Line { source, levels: 256 };
    let (table, bytes) = made(folder.path(), line(rows(&[&[1, 0, 2]])));
    assert_eq!((table.width, table.height, table.layers), (3, 1, 1));
    assert_eq!(integers(&bytes), [1, 0, 2]);
    let wrong = vec![stack(path(), 4), line(path()), line(rows(&[&[1], &[2]])), stack(path(), 0)];
    assert_eq!(codes(folder.path(), wrong), ["E0507", "E0507", "E0507", "E0554"]);
}

#[test]
fn a_pattern_on_a_line_is_one_texel_high() {
    let folder = folder();
    write_picture(&folder.path().join("a.png"), [4, 2], &[0, 40, 80, 120, 10, 20, 30, 40]);
    let strips = |grid| Recipe::Strips { paths: vec!["a.png".into()], grid, encoding: Encoding::Linear };
    let (table, bytes) = made(folder.path(), strips([2, 2]));
    assert_eq!((table.width, table.height, table.layers, table.levels.len()), (2, 1, 4, 2));
    let first: Vec<u8> = bytes.iter().copied().step_by(4).collect();
    assert_eq!(first, [0, 40, 80, 120, 10, 20, 30, 40, 20, 100, 15, 35]);
    assert_eq!(codes(folder.path(), vec![strips([2, 1])]), ["E0507"]);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let folder = folder();
    let samples: Vec<u8> = (0..97 * 61 * 4).map(|i| (i * 31 % 256) as u8).collect();
    write_picture(&folder.path().join("a.png"), [97, 61], &samples);
    let load = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| made(folder.path(), image("a.png", Encoding::Srgb)))
    };
    assert_eq!(load(1), load(7));
}

#[test]
fn small_tables_share_a_texture_a_row_each() {
    let folder = folder();
    let recipes = vec![
        Recipe::Permutation { size: 16, seed: 3 },
        Recipe::Permutation { size: 5, seed: 4 },
        Recipe::Tables { rows: vec![1, 0] },
    ];
    let (manifest, tables) = load_recipes(folder.path(), recipes).expect("they load");
    let bytes = |index: usize| integers(tables.get(index, "table").expect("made"));
    let shared = manifest.resources[2].textures[0].table.as_ref().expect("laid out");
    assert_eq!((shared.width, shared.height), (16, 2));
    let (first, second, all) = (bytes(0), bytes(1), bytes(2));
    assert_eq!(all[..20], second[..]);
    assert!(all[20..64].iter().all(|rest| *rest == 0));
    assert_eq!(all[64..], first[..]);
    assert_eq!(codes(folder.path(), vec![Recipe::Tables { rows: vec![0] }]), ["E0551"]);
}

#[test]
fn a_large_permutation_takes_a_row_for_every_4096_numbers() {
    let folder = folder();
    let recipes = vec![
        Recipe::Permutation { size: 5000, seed: 3 },
        Recipe::Permutation { size: 5, seed: 4 },
        Recipe::Tables { rows: vec![0, 0, 1] },
    ];
    let (manifest, tables) = load_recipes(folder.path(), recipes).expect("they load");
    let bytes = |index: usize| integers(tables.get(index, "table").expect("made"));
    let shared = manifest.resources[2].textures[0].table.as_ref().expect("laid out");
    assert_eq!((shared.width, shared.height), (4096, 3));
    let (large, small, all) = (bytes(0), bytes(1), bytes(2));
    assert_eq!(all[..4 * 8192], large[..]);
    assert!(all[4 * 5000..4 * 8192].iter().all(|rest| *rest == 0));
    assert_eq!(all[4 * 8192..][..4 * 5], small[..]);
}

#[test]
fn a_probability_holds_its_list_and_how_often_each_number_stands_in_it() {
    let folder = folder();
    let recipes = vec![Recipe::Probability { numbers: vec![5, -1, 0, 5] }, Recipe::Tables { rows: vec![0] }];
    let (manifest, tables) = load_recipes(folder.path(), recipes).expect("they load");
    let shared = manifest.resources[1].textures[0].table.as_ref().expect("laid out");
    assert_eq!((shared.width, shared.height), (6, 1));
    let texels = integers(tables.get(1, "table").expect("made"));
    let channel = |i: usize| texels.iter().skip(i).step_by(4).copied().collect::<Vec<_>>();
    assert_eq!(channel(0), [5, -1, 0, 5, 5, -1]);
    assert_eq!(channel(1), [1, 0, 0, 0, 0, 2]);
    for numbers in [vec![], vec![256], vec![-2], vec![0; 4097]] {
        let refused = vec![Recipe::Probability { numbers }, Recipe::Tables { rows: vec![0] }];
        assert_eq!(codes(folder.path(), refused), ["E0551"]);
    }
}

#[test]
fn a_level_of_a_slice_is_the_mean_of_its_group() {
    let folder = folder();
    // Two patterns of three slices of 4×2 texels; all texels of slice i are 20·i.
    let samples: Vec<u8> = (0..6).flat_map(|slice| [slice * 20; 4 * 2 * 3]).collect();
    write_picture(&folder.path().join("a.png"), [4, 12], &samples);
    let volumes = |depth| Recipe::Volumes {
        paths: vec!["a.png".into()],
        grid: [1, 6],
        depth,
        encoding: Encoding::Linear,
    };
    let (table, bytes) = made(folder.path(), volumes(3));
    assert_eq!((table.layers, table.levels.len()), (6, 3));
    let mut rest = bytes.as_slice();
    // The third slice has no second in its group; the last level is the mean of all three.
    for (texels, wanted) in
        [(8, [0, 20, 40, 60, 80, 100]), (2, [10, 10, 40, 70, 70, 100]), (1, [20, 20, 20, 80, 80, 80])]
    {
        for slice in wanted {
            let (layer, after) = rest.split_at(texels * 4);
            assert!(layer.chunks(4).all(|texel| texel == [slice, slice, slice, 255]), "{layer:?}, {slice}");
            rest = after;
        }
    }
    assert!(rest.is_empty());
    assert_eq!(codes(folder.path(), vec![volumes(4), volumes(0)]), ["E0551", "E0551"]);
}

#[test]
fn volumes_of_sheets_and_of_lists_are_the_same() {
    let folder = folder();
    let code = |x: u32, y: u32, z: u32, k: u32| ((x * 37 + y * 59 + z * 83 + k * 11 + x * y * z) % 251) as u8;
    let [width, height] = [8, 4];
    let texel = |x: u32, y: u32, z: u32| [0, 1, 2].map(|k| code(x, y, z, k));
    let sheet: Vec<u8> = (0..3 * height)
        .flat_map(|y| (0..2 * width).map(move |x| (x, y)))
        .flat_map(|(x, y)| texel(x % width, y % height, y / height * 2 + x / width))
        .collect();
    write_picture(&folder.path().join("sheet.png"), [2 * width, 3 * height], &sheet);
    let names: Vec<String> = (0..6).map(|z| format!("slice_{z}.png")).collect();
    for (z, name) in (0..).zip(&names) {
        let slice: Vec<u8> = (0..width * height).flat_map(|i| texel(i % width, i / width, z)).collect();
        write_picture(&folder.path().join(name), [width, height], &slice);
    }
    let volume = |paths: &[String], grid: [u32; 2]| Recipe::Volume {
        paths: paths.to_vec(),
        grid,
        encoding: Encoding::Linear,
        channels: 3,
        borders: Borders::Auto,
        lut: 256,
    };
    let (table, bytes) = made(folder.path(), volume(&["sheet.png".to_owned()], [2, 3]));
    assert_eq!((table.format, table.layers, table.levels.len()), (Format::Rgba8Unorm, 6, 4));
    let (_, others) = made(folder.path(), volume(&names, [1, 1]));
    assert_eq!(bytes, others);
    // From the third level on, four slices are one, and two.
    let last = table.levels[2];
    let layers = bytes[last.offset as usize..].chunks_exact(2 * 4).take(6).collect::<Vec<_>>();
    assert!(layers[0] == layers[3] && layers[4] == layers[5] && layers[0] != layers[4], "{layers:?}");
    // Slices of several forms don't make one block.
    write_picture(&folder.path().join("slice_3.png"), [width, height], &[7; 32]);
    assert_eq!(codes(folder.path(), vec![volume(&names, [1, 1])]), ["E0551"]);
    write_picture(&folder.path().join("slice_3.png"), [4, 4], &[7; 48]);
    assert_eq!(codes(folder.path(), vec![volume(&names, [1, 1])]).len(), 1);
}
