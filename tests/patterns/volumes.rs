//! Patterns in space (`std/volumes.tex`), against their slices.

use crate::support::{Drawing, errors};
use std::path::Path;

/// Texels along a side, slices of a pattern, patterns.
const SIDE: usize = 8;
const DEPTH: usize = 16;
const COUNT: usize = 2;
/// Half of what is lost by storing a level in 8 bits, and a little.
const ROUNDING: f32 = 0.6 / 255.0;

/// A texel of a slice: noise.
fn texel(pattern: usize, [x, y, z]: [usize; 3]) -> [f32; 4] {
    let number = (((pattern * DEPTH + z) * SIDE + y) * SIDE + x) as u32;
    let bits = number.wrapping_mul(0x9e37_79b1).rotate_left(13).wrapping_mul(0x85eb_ca6b);
    bits.to_be_bytes().map(|byte| f32::from(byte) / 255.0)
}

/// The mean of a block of texels.
fn mean(pattern: usize, first: [usize; 3], sides: [usize; 3]) -> [f32; 4] {
    let mut sum = [0.0_f64; 4];
    for z in 0..sides[2] {
        for y in 0..sides[1] {
            for x in 0..sides[0] {
                let texel = texel(pattern, [first[0] + x, first[1] + y, first[2] + z]);
                (0..4).for_each(|i| sum[i] += f64::from(texel[i]));
            }
        }
    }
    sum.map(|sum| (sum / (sides[0] * sides[1] * sides[2]) as f64) as f32)
}

/// The sheet of the slices, eight to a row.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let rows = COUNT * DEPTH / 8;
    let picture = image::RgbaImage::from_fn((8 * SIDE) as u32, (rows * SIDE) as u32, |x, y| {
        let (x, y) = (x as usize, y as usize);
        let slice = y / SIDE * 8 + x / SIDE;
        image::Rgba(
            texel(slice / DEPTH, [x % SIDE, y % SIDE, slice % DEPTH]).map(|x| (x * 255.0).round() as u8),
        )
    });
    picture.save(folder.path().join("slices.png")).expect("a picture is written");
    folder
}

fn drawing(folder: &Path, options: &str, body: &str) -> Drawing {
    Drawing::beside(
        folder,
        &format!(
            "let blocks = patterns<3>(\"slices.png\", grid: ivec2(8, 4), depth: {DEPTH}, encoding: linear{options})
             texture t(uv: vec2) -> (seen: vec4) {{ {body} }}"
        ),
    )
}

fn alike(found: [f32; 4], wanted: [f32; 4], what: &str) {
    let off = (0..4).map(|i| (found[i] - wanted[i]).abs()).fold(0.0, f32::max);
    assert!(off < ROUNDING, "{what}: {found:?}, not {wanted:?}");
}

fn mix(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    [0, 1, 2, 3].map(|i| a[i] + (b[i] - a[i]) * t)
}

/// What a place, the same in every pixel, gives for footprints that grow from one slice to all of them
/// along the rows; a row for each of so many z.
fn sweep(place: &str, rows: usize) -> Vec<[f32; 4]> {
    let folder = folder();
    let body = format!(
        "let slices = exp2(ifloor(uv.x * 2048.0) / 512.0)
         let z = (ifloor(uv.y * {rows}.0) + 0.5) / {rows}.0
         let across = (fract(uv.x * 2048.0) - 0.5) * slices / {DEPTH}.0
         seen = blocks.reference(1, {place})"
    );
    drawing(folder.path(), "", &body).seen([2048, rows as u32], [0.0, 0.0, 1.0, 1.0])
}

#[test]
fn slices_are_given_at_their_middles_and_mixed_in_between() {
    let folder = folder();
    // A pixel a texel; four places from the middle of each slice to that of the next.
    let body = "let k = ifloor(uv.y * 128.0)
                seen = blocks.reference(k / 64, vec3(uv.x, fract(uv.y * 128.0), ((k % 64) / 4.0 + 0.5) / 16.0))";
    let seen = drawing(folder.path(), "", body).seen([8, 1024], [0.0, 0.0, 1.0, 1.0]);
    for (i, found) in seen.iter().enumerate() {
        let (x, y, k) = (i % 8, i / 8 % 8, i / 64);
        let (pattern, slice, part) = (k / 64, k % 64 / 4, k % 4);
        let next = (slice + 1).min(DEPTH - 1);
        let wanted = mix(texel(pattern, [x, y, slice]), texel(pattern, [x, y, next]), part as f32 / 4.0);
        alike(*found, wanted, &format!("{pattern} {slice}+{part}/4 {x},{y}"));
    }
}

#[test]
fn the_nearest_slice_is_one_fetch_and_two_are_mixed() {
    let folder = folder();
    let body = "let k = ifloor(uv.y * 128.0)
                seen = blocks.reference(k / 64, vec3(uv.x, fract(uv.y * 128.0), ((k % 64) + 0.5) / 64.0))";
    let sharp = drawing(folder.path(), ", filter: nearest", body);
    for (i, found) in sharp.seen([8, 1024], [0.0, 0.0, 1.0, 1.0]).into_iter().enumerate() {
        let (x, y, k) = (i % 8, i / 8 % 8, i / 64);
        alike(found, texel(k / 64, [x, y, k % 64 / 4]), &format!("{k} {x},{y}"));
    }
    let linear = drawing(folder.path(), "", body);
    assert_eq!((sharp.worst().samples, linear.worst().samples), (1.0, 2.0));
}

#[test]
fn a_level_is_the_mean_of_its_groups_of_slices() {
    let folder = folder();
    // Along z only: so many slices a pixel, and the level with them.
    let body = "seen = blocks.reference(1, vec3(0.25, 0.75, uv.x))";
    let drawing = drawing(folder.path(), "", body);
    for pixels in [4_usize, 2] {
        let width = DEPTH / pixels;
        let side = width.min(SIDE);
        let seen = drawing.seen([pixels as u32, 1], [0.0, 0.0, 1.0, 1.0]);
        for (group, found) in seen.iter().enumerate() {
            let first = |at: f32| if side == SIDE { 0 } else { (at * SIDE as f32) as usize / side * side };
            let corner = [first(0.25), first(0.75), group * width];
            alike(*found, mean(1, corner, [side, side, width]), &format!("{group} of {pixels}"));
        }
    }
    // All of it in one pixel: there is no smaller level than that of one texel.
    alike(drawing.seen([1, 1], [0.0, 0.0, 1.0, 1.0])[0], mean(1, [0; 3], [SIDE, SIDE, DEPTH]), "all");
}

#[test]
fn the_longest_axis_chooses_the_level() {
    let places = ["vec3(0.25, 0.25, z + across)", "vec3(0.25 + across * 2.0, 0.25, z)"];
    let [along, beside] = places.map(|place| sweep(place, 3));
    for (a, b) in along.iter().zip(&beside) {
        alike(*a, *b, "the same level for as many slices as texels");
    }
}

#[test]
fn nothing_jumps_from_level_to_level_or_from_slice_to_slice() {
    for edges in ["clamp", "wrap", "clear"] {
        let place = format!("vec3(0.3, 0.6, z * 1.2 - 0.1 + across), edges: {edges}");
        let rows = 1024;
        let seen = sweep(&place, rows);
        let apart = |a: [f32; 4], b: [f32; 4]| (0..4).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
        let levels = (0..seen.len()).filter(|i| i % 2048 > 0).map(|i| apart(seen[i - 1], seen[i]));
        // A 512th of a level on.
        let level = levels.fold(0.0, f32::max);
        assert!(level < 0.01, "{edges}: {level} from level to level");
        // A fiftieth of a slice on, by which two slices are mixed, steeper at smaller levels.
        let slice = (2048..seen.len()).map(|i| apart(seen[i - 2048], seen[i])).fold(0.0, f32::max);
        assert!(slice < 0.025, "{edges}: {slice} from slice to slice");
    }
}

#[test]
fn edges_are_borders_or_the_pattern_again_or_nothing() {
    let folder = folder();
    let seen = |edges: &str, place: &str| {
        let body =
            format!("seen = blocks.reference(0, vec3({place}) + vec3(uv, 0.0) * 0.000001, edges: {edges})");
        drawing(folder.path(), "", &body).cells(1)[0]
    };
    let corner = texel(0, [0, 0, 0]);
    alike(seen("clamp", "0.0625, 0.0625, -3.0"), corner, "a border");
    alike(seen("wrap", "-1.9375, 5.0625, 7.03125"), corner, "again");
    alike(seen("clear", "0.0625, 0.0625, 0.03125"), corner, "inside");
    for place in ["0.0625, 0.0625, -0.04", "0.0625, 0.0625, 1.04", "-0.07, 0.5, 0.5", "0.5, 1.07, 0.5"] {
        assert_eq!(seen("clear", place), [0.0; 4], "{place}");
    }
    // Half way: a filter's width is not cut.
    let last = texel(0, [0, 0, DEPTH - 1]);
    alike(seen("wrap", "0.0625, 0.0625, 0.0"), mix(corner, last, 0.5), "the border of two");
    alike(seen("clear", "0.0625, 0.0625, 1.0"), last.map(|x| x / 2.0), "the border of nothing");
    alike(seen("wrap", "0.0, 0.0625, 0.03125"), mix(corner, texel(0, [7, 0, 0]), 0.5), "beside");
    alike(seen("clear", "0.0625, 0.0, 0.03125"), corner.map(|x| x / 2.0), "above");
}

#[test]
fn picks_are_clamped_and_the_blank_one_is_not_fetched() {
    let folder = folder();
    let seen =
        |pick: &str| drawing(folder.path(), "", &format!("seen = blocks.reference({pick}, vec3(uv, 0.3))"));
    assert_eq!(seen("7").cells(8), seen("1").cells(8));
    let blank = seen("-1");
    assert_eq!((blank.cells(4), blank.worst().samples), (vec![[0.0; 4]; 16], 0.0));
}

#[test]
fn averages_are_those_of_patterns_and_of_all() {
    let folder = folder();
    let body = "seen = if uv.x < 0.5 { blocks.average(ifloor(uv.y * 2.0)) } else { blocks.average }";
    let seen = drawing(folder.path(), "", body).cells(2);
    let whole = |pattern| mean(pattern, [0; 3], [SIDE, SIDE, DEPTH]);
    alike(seen[0], whole(0), "the first");
    alike(seen[2], whole(1), "the second");
    alike(seen[1], mix(whole(0), whole(1), 0.5), "all");
    let blank = drawing(folder.path(), "", "seen = blocks.average(-1)");
    assert_eq!(blank.cells(1)[0], [0.0; 4]);
}

#[test]
fn nodes_take_patterns_of_a_dimension() {
    let folder = folder();
    let text = |uses: &str| {
        format!(
            "let tiles = patterns<2>(\"slices.png\", grid: ivec2(8, 4))
             let blocks = patterns<3>(\"slices.png\", grid: ivec2(8, 4), depth: 16)
             node first<n>(p: patterns<n>, uv: vec2) -> (c: color) {{
                c = if n == 2 {{ vec4(p.count) }} else {{ vec4(p.count, n, uv) }}
             }}
             node sized(p: patterns, uv: vec2) -> (c: color) {{ c = p.reference(0, uv) }}
             node sized(p: patterns<3>, uv: vec2) -> (c: color) {{ c = p.reference(0, vec3(uv, 0.5)) }}
             texture t(uv: vec2) -> (seen: vec4) {{ seen = {uses} }}"
        )
    };
    let seen = |uses: &str| Drawing::beside(folder.path(), &text(uses)).cells(1)[0];
    assert_eq!(seen("tiles.first(uv)"), [32.0; 4]);
    assert_eq!(seen("blocks.first(uv)"), [2.0, 3.0, 0.5, 0.5]);
    assert_eq!(seen("tiles.sized(uv) - tiles.reference(0, uv)"), [0.0; 4]);
    assert_eq!(seen("blocks.sized(uv) - blocks.reference(0, vec3(uv, 0.5))"), [0.0; 4]);
    assert!(errors(&text("blocks.material_reference(0, uv).color")).contains("`patterns<3>`"));
}
