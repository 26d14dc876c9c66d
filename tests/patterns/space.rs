//! Tiles and transformed patterns in space, and transforms of whatever a node draws, on a line too.

use crate::support::Drawing;

/// Texels along a side, slices of a pattern, patterns: two of noise and a white one.
const SIDE: u32 = 8;
const DEPTH: u32 = 16;

/// A folder with the sheet of the slices, eight to a row.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = image::RgbaImage::from_fn(8 * SIDE, 6 * SIDE, |x, y| {
        let noise = (y * 8 * SIDE + x).wrapping_mul(0x9e37_79b1).rotate_left(13).wrapping_mul(0x85eb_ca6b);
        let [r, g, b, _] = noise.to_be_bytes();
        image::Rgba(if y < 4 * SIDE { [r, g, b, 255] } else { [255; 4] })
    });
    picture.save(folder.path().join("slices.png")).expect("a picture is written");
    folder
}

fn drawing(folder: &tempfile::TempDir, body: &str) -> Drawing {
    Drawing::beside(
        folder.path(),
        &format!(
            "let blocks = patterns<3>(\"slices.png\", grid: ivec2(8, 6), depth: {DEPTH}, encoding: linear)
             node random(c: ivec3) -> (pick: int) {{ pick = virtual_index(c, 4) - 1 }}
             texture t(uv: vec2) -> (seen: vec4) {{ {body} }}"
        ),
    )
}

fn seen(folder: &tempfile::TempDir, body: &str, side: u32) -> Vec<[f32; 4]> {
    drawing(folder, body).seen([side; 2], [0.0, 0.0, 1.0, 1.0])
}

fn difference(one: &[[f32; 4]], two: &[[f32; 4]]) -> f32 {
    one.iter().flatten().zip(two.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

fn mean(pixels: &[[f32; 4]]) -> [f32; 4] {
    [0, 1, 2, 3].map(|i| {
        let sum: f64 = pixels.iter().map(|pixel| f64::from(pixel[i])).sum();
        (sum / pixels.len() as f64) as f32
    })
}

/// A slanted plane through cells.
const PLACE: &str =
    "let p = vec3(uv * CELLS, CELLS * (0.7 * uv.x + 0.3 * uv.y)) let (cell, at) = tile_map(p, 1)";

fn place(cells: &str) -> String {
    PLACE.replace("CELLS", cells)
}

#[test]
fn copies_of_one_block_are_that_block_again() {
    let folder = folder();
    for cells in ["2.3", "9.1", "21.0"] {
        let blended = seen(&folder, &format!("{} seen = blocks.tiled(cell, at, |c| 1)", place(cells)), 48);
        let wrapped =
            seen(&folder, &format!("{} seen = blocks.reference(1, p, edges: wrap)", place(cells)), 48);
        assert!(difference(&blended, &wrapped) < 1e-4, "{cells} cells");
    }
}

/// Across every face, at any level of detail, and where four or eight cells meet.
#[test]
fn blocks_blend_into_their_neighbours() {
    let folder = folder();
    for footprint in ["0.001", "0.05", "0.3", "0.8"] {
        for (axis, way) in
            [("x", "vec3(1.0, 0.0, 0.0)"), ("y", "vec3(0.0, 1.0, 0.0)"), ("z", "vec3(0.0, 0.0, 1.0)")]
        {
            // On both sides of a face, of an edge or of a corner between cells; each row another place.
            let body = format!(
                "let row  = ifloor(uv.y * 64.0)
                 let from = hash(row).xyz * 3.0
                 let on   = vec3(if row % 4 == 1 {{ 1.0 }} else {{ from.x }}, from.y, if row % 8 == 3 {{ 2.0 }} else {{ from.z }})
                 let way  = {way}
                 let face = on * (1.0 - way) + way * (1 + row % 3)
                 let side = ifloor(uv.x * 2.0) * 2 - 1
                 let p    = face + way * side * 0.00001 + vec3(fract(uv.x * 2.0) - 0.5, 0.0, 0.0) * 2.0 * {footprint}
                 let (cell, at) = tile_map(p, 1)
                 seen = blocks.tiled(cell, at, random)"
            );
            let pixels = drawing(&folder, &body).seen([2, 64], [0.0, 0.0, 1.0, 1.0]);
            let (before, after): (Vec<_>, Vec<_>) = pixels.chunks(2).map(|row| (row[0], row[1])).unzip();
            let worst = difference(&before, &after);
            assert!(worst < 0.01, "{footprint}, along {axis}: {worst}");
        }
    }
}

#[test]
fn blocks_become_their_mean_from_afar_and_blank_ones_are_not_fetched() {
    let folder = folder();
    let mean = seen(&folder, "seen = blocks.average", 1)[0];
    let far = seen(&folder, &format!("{} seen = blocks.tiled(cell, at, |c| 0)", place("200.0")), 16);
    assert_eq!(far, vec![mean; 256]);
    let blank = seen(&folder, &format!("{} seen = blocks.tiled(cell, at, |c| -1)", place("5.0")), 16);
    assert_eq!(blank, vec![[0.0; 4]; 256]);
    let alone =
        drawing(&folder, &format!("{} seen = blocks.tiled(cell, at, |c| 1, edges: clamp)", place("5.0")));
    assert_eq!(alone.worst().samples, 2.0);
}

/// A pattern that goes on into seven other cells is as if there were none.
#[test]
fn a_block_goes_on_into_other_cells() {
    let folder = folder();
    let near = "let p = vec3(uv * 4.0, 1.2 + uv.x) let (cell, at) = tile_map(p, 1)";
    let cells = format!(
        "{near} seen = blocks.tile_transform(cell, at, |c| if c == ivec3(2, 1, 1) {{ 1 }} else {{ -1 }},
            scale: |c| 0.65, rotation: |c| 0.7, translation: |c| vec3(0.9, 0.1, 0.8), overflow: neighbours)"
    );
    let plain = format!(
        "{near} let away = p - vec3(2.9, 1.1, 1.8)
         let turned = vec3(transpose(rotation(0.7)) * away.xy, away.z)
         seen = blocks.reference(1, turned / 0.65 + 0.5, edges: clear)"
    );
    let (cells, plain) = (seen(&folder, &cells, 80), seen(&folder, &plain, 80));
    assert!(mean(&cells)[3] > 0.01, "it is seen");
    assert!(difference(&cells, &plain) < 1e-3);
}

/// The part of space that white blocks fill, near and from afar: size³, whether they turn or not.
#[test]
fn blocks_keep_their_mean_from_afar() {
    let folder = folder();
    for (overflow, filled) in [("shrink", 0.6_f32.powi(3)), ("neighbours", 0.6_f32.powi(3))] {
        let body = |cells: &str| {
            // In the middle of every cell, so that none lies on another.
            format!(
                "let p = vec3(uv * {cells}, hash(ifloor(uv * 512.0)).x + {cells} * uv.x)
                 let (cell, at) = tile_map(p, 1)
                 seen = blocks.tile_transform(cell, at, |c| 2, scale: |c| 0.6,
                     rotation: |c| virtual_random(c).y * 1turn, overflow: {overflow})"
            )
        };
        for cells in ["32.0", "32768.0"] {
            let found = mean(&seen(&folder, &body(cells), 512))[3];
            assert!((found - filled).abs() < 1.0 / 255.0, "{overflow}, {cells}: {found}, not {filled}");
        }
    }
}

/// The mean of sizeⁿ of what is 0.3 to 0.8 cells large, turned anyhow, and fits into its cell.
fn part_filled(n: u32) -> f32 {
    let places = || (0..200_u8).map(|i| (f32::from(i) + 0.5) / 200.0);
    let size = |scale: f32, turn: f32| {
        let (sine, cosine) = (std::f32::consts::TAU * turn).sin_cos();
        let around = if n == 1 { 1.0 } else { sine.abs() + cosine.abs() };
        (0.3 + scale * 0.5).min(1.0 / around).powi(n as i32)
    };
    places().map(|scale| places().map(|turn| size(scale, turn)).sum::<f32>()).sum::<f32>() / 40_000.0
}

/// Whatever a node draws, in one to three dimensions: all of it inside its cell, turned and moved.
#[test]
fn what_a_node_draws_is_whole_in_one_two_and_three_dimensions() {
    let folder = folder();
    let random = "scale: |c| 0.3 + virtual_random(c).x * 0.5, translation: |c| MOVED";
    let text = |n: u32, overflow: &str| {
        let (place, moved) = match n {
            1 => ("uv.x * 256.0", "virtual_random(c).z"),
            2 => ("uv * 64.0", "virtual_random(c).zw"),
            _ => ("vec3(uv * 64.0, hash(ifloor(uv * 512.0)).x * 64.0)", "virtual_random(c).yzw"),
        };
        let random = random.replace("MOVED", moved);
        format!(
            "let p = {place}
             let (cell, at) = tile_map(p, 1)
             let drawn = tile_transform(|c, at| vec4(at.x, 0.0, 0.0, 1.0), cell, at, {random},
                 rotation: |c| virtual_random(c, stream: 1).x * 1turn, overflow: {overflow}, largest: 0.8)
             seen = drawn"
        )
    };
    for n in 1..=3 {
        let found = mean(&seen(&folder, &text(n, "shrink"), 512));
        let filled = part_filled(n);
        println!("{n}: {found:?}, {filled}");
        assert!((found[3] - filled).abs() < 0.01, "{n}: {} is filled, not {filled}", found[3]);
        // In each the place goes evenly from 0 to 1.
        assert!((found[0] / found[3] - 0.5).abs() < 0.01, "{n}: {found:?}");
        let over = mean(&seen(&folder, &text(n, "neighbours"), 512))[3];
        assert!(over > 0.5 * found[3] && over < 1.2 * found[3], "{n}: {over}");
    }
}

/// What a symmetry of the square makes of a place: quarter turns, then a mirror image before them.
fn turned(symmetry: usize, at: [f32; 2]) -> [f32; 2] {
    let [x, y] = if symmetry >= 4 { [1.0 - at[0], at[1]] } else { at };
    (0..symmetry % 4).fold([x, y], |[x, y], _| [y, 1.0 - x])
}

/// Each cell shows one of the symmetries about the third axis, all of them as often, and the one that
/// its vectors have; up stays up.
#[test]
fn blocks_are_turned_and_mirrored_about_the_third_axis() {
    let folder = folder();
    let side = 64;
    let tiles = |call: &str, at: [f32; 3]| {
        let body = format!(
            "let cell = ivec3(ifloor(uv * {side}.0), 5)
             let at = vec3({:?}, {:?}, {:?}) + vec3(uv, 0.0) * 0.000001
             seen = {call}",
            at[0], at[1], at[2]
        );
        seen(&folder, &body, side)
    };
    let at = [0.3, 0.2, 0.7];
    for (orient, symmetries) in [(4, 4), (8, 8)] {
        for edges in ["blend", "clamp"] {
            let found =
                tiles(&format!("blocks.tiled(cell, at, |c| 1, edges: {edges}, orient: {orient})"), at);
            let all: Vec<[f32; 4]> = (0..symmetries)
                .map(|symmetry| {
                    let [x, y] = turned(symmetry, [at[0], at[1]]);
                    tiles("blocks.reference(1, at)", [x, y, at[2]])[0]
                })
                .collect();
            let mut counts = vec![0; symmetries];
            for pixel in &found {
                let nearest = all.iter().position(|one| difference(&[*one], &[*pixel]) < 0.001);
                counts[nearest.expect("it is one of them")] += 1;
            }
            for count in counts {
                let off = crate::support::deviations(count, found.len(), 1.0 / symmetries as f64);
                assert!(off < 4.9, "{edges}, {orient}: {count} of {}", found.len());
            }
        }
    }
    let plain = tiles("blocks.tiled(cell, at, |c| 1)", at);
    assert!(difference(&plain, &tiles("blocks.tiled(cell, at, |c| 1, orient: 1, stream: 3)", at)) == 0.0);
}

/// Vectors of a block that all point along x turn with it.
#[test]
fn vectors_of_blocks_turn_with_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = image::RgbImage::from_pixel(8, 32, image::Rgb([255, 128, 128]));
    picture.save(folder.path().join("slices.png")).expect("a picture is written");
    let text = "let blocks = patterns<3>(\"slices.png\", grid: ivec2(1, 4), depth: 4, encoding: normal)
         texture t(uv: vec2) -> (seen: vec4) {
             let cell = ivec3(ifloor(uv * 16.0), 2)
             seen = blocks.tiled(cell, vec3(0.5 + uv * 0.000001, 0.5), |c| 0, orient: 8)
         }";
    let seen = Drawing::beside(folder.path(), text).seen([16; 2], [0.0, 0.0, 1.0, 1.0]);
    let mut ways = [0; 4];
    for [x, y, z, _] in seen {
        let way = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]
            .iter()
            .position(|way: &[f32; 2]| (way[0] - x).abs() < 0.01 && (way[1] - y).abs() < 0.01);
        ways[way.unwrap_or_else(|| panic!("{x} {y} {z}"))] += 1;
        assert!(z.abs() < 0.01, "up stays up: {z}");
    }
    assert!(ways.iter().all(|count| *count > 30), "{ways:?}");
}

/// Blocks that turn are still joined: of blocks all sides of which are alike no face is seen.
#[test]
fn turned_blocks_blend_into_their_neighbours() {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = image::RgbImage::from_fn(8, 64, |x, y| {
        let (y, z) = (y % 8, y / 8);
        let is_inside = (1..7).contains(&x) && (1..7).contains(&y) && (1..7).contains(&z);
        let noise = (x * 64 + y * 8 + z).wrapping_mul(0x9e37_79b1).to_be_bytes();
        image::Rgb(if is_inside { [noise[0], noise[1], noise[2]] } else { [120, 60, 200] })
    });
    picture.save(folder.path().join("slices.png")).expect("a picture is written");
    for way in ["vec3(1.0, 0.0, 0.0)", "vec3(0.0, 1.0, 0.0)", "vec3(0.0, 0.0, 1.0)"] {
        for footprint in ["0.001", "0.2", "0.8"] {
            let text = format!(
                "let blocks = patterns<3>(\"slices.png\", grid: ivec2(1, 8), depth: 8, encoding: linear)
                 texture t(uv: vec2) -> (seen: vec4) {{
                     let row  = ifloor(uv.y * 64.0)
                     let way  = {way}
                     let face = hash(row).xyz * 3.0 * (1.0 - way) + way * (1 + row % 3)
                     let side = ifloor(uv.x * 2.0) * 2 - 1
                     let p    = face + way * side * 0.00001 + vec3(fract(uv.x * 2.0) - 0.5, 0.0, 0.0) * 2.0 * {footprint}
                     let (cell, at) = tile_map(p, 1)
                     seen = blocks.tiled(cell, at, |c| 0, orient: 8)
                 }}"
            );
            let pixels = Drawing::beside(folder.path(), &text).seen([2, 64], [0.0, 0.0, 1.0, 1.0]);
            let worst = pixels.chunks(2).map(|pair| difference(&pair[..1], &pair[1..])).fold(0.0, f32::max);
            assert!(worst < 0.01, "{way}, {footprint}: {worst}");
        }
    }
}
