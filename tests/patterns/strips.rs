//! Patterns on a line (`std/strips.tex`), against their texels.

use crate::support::Drawing;

/// Texels of a strip, strips: two of noise and one that rises from its first texel to its last.
const LENGTH: usize = 16;
const COUNT: usize = 3;
/// Half of what is lost by storing a level in 8 bits, and a little.
const ROUNDING: f32 = 0.6 / 255.0;

/// A texel of a strip.
fn texel(pattern: usize, x: usize) -> [f32; 4] {
    if pattern == 2 {
        return [x as f32 * 17.0 / 255.0, 0.0, 1.0, 1.0];
    }
    let noise = ((pattern * LENGTH + x) as u32).wrapping_mul(0x9e37_79b1).rotate_left(13);
    noise.wrapping_mul(0x85eb_ca6b).to_be_bytes().map(|byte| f32::from(byte) / 255.0)
}

/// The mean of so many texels.
fn mean(pattern: usize, first: usize, count: usize) -> [f32; 4] {
    [0, 1, 2, 3].map(|i| {
        let sum: f64 = (first..first + count).map(|x| f64::from(texel(pattern, x)[i])).sum();
        (sum / count as f64) as f32
    })
}

/// A folder with the strips below one another.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = image::RgbaImage::from_fn(LENGTH as u32, COUNT as u32, |x, y| {
        image::Rgba(texel(y as usize, x as usize).map(|x| (x * 255.0).round() as u8))
    });
    picture.save(folder.path().join("strips.png")).expect("a picture is written");
    folder
}

fn drawing(body: &str) -> Drawing {
    Drawing::beside(
        folder().path(),
        &format!(
            "let strips = patterns<1>(\"strips.png\", grid: ivec2(1, {COUNT}), encoding: linear)
             let sharp = patterns<1>(\"strips.png\", grid: ivec2(1, {COUNT}), encoding: linear, filter: nearest)
             let vectors = patterns<1>(\"strips.png\", grid: ivec2(1, {COUNT}), encoding: normal)
             texture t(uv: vec2) -> (seen: vec4) {{ {body} }}"
        ),
    )
}

/// What a row of so many pixels shows.
fn seen(body: &str, pixels: usize) -> Vec<[f32; 4]> {
    drawing(body).seen([pixels as u32, 1], [0.0, 0.0, 1.0, 1.0])
}

fn apart(a: [f32; 4], b: [f32; 4]) -> f32 {
    (0..4).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max)
}

fn alike(found: [f32; 4], wanted: [f32; 4], what: &str) {
    assert!(apart(found, wanted) < ROUNDING, "{what}: {found:?}, not {wanted:?}");
}

fn mix(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    [0, 1, 2, 3].map(|i| a[i] + (b[i] - a[i]) * t)
}

#[test]
fn texels_are_given_at_their_middles_and_mixed_in_between() {
    for pattern in 0..COUNT {
        // Four places from the middle of each texel to that of the next.
        let all = seen(
            &format!("seen = strips.reference({pattern}, (ifloor(uv.x * 60.0) / 4.0 + 0.5) / {LENGTH}.0)"),
            60,
        );
        for (i, found) in all.into_iter().enumerate() {
            let wanted = mix(texel(pattern, i / 4), texel(pattern, i / 4 + 1), (i % 4) as f32 / 4.0);
            alike(found, wanted, &format!("{pattern}, {i}"));
        }
        let all = seen(&format!("seen = sharp.reference({pattern}, uv.x)"), LENGTH);
        for (x, found) in all.into_iter().enumerate() {
            alike(found, texel(pattern, x), &format!("{pattern}, {x}"));
        }
    }
}

/// Whatever is across the line: its gradient alone says which level is read.
#[test]
fn a_level_is_the_mean_of_its_texels() {
    for pixels in [16, 8, 4, 2, 1] {
        let width = LENGTH / pixels;
        let body = "seen = strips.reference(1, uv.x + 0.0 * uv.y)";
        let all = drawing(body).seen([pixels as u32, 3], [0.0, 0.0, 1.0, 100.0]);
        for (i, found) in all.into_iter().enumerate() {
            alike(found, mean(1, i % pixels * width, width), &format!("{i} of {pixels}"));
        }
    }
}

#[test]
fn ends_are_borders_or_the_pattern_again_or_nothing() {
    let at = |edges: &str, at: &str| {
        seen(&format!("seen = strips.reference(0, {at} + uv.x * 0.000001, edges: {edges})"), 1)[0]
    };
    let (first, last) = (texel(0, 0), texel(0, LENGTH - 1));
    alike(at("clamp", "-3.0"), first, "a border");
    alike(at("clamp", "4.0"), last, "the other");
    alike(at("wrap", "-1.96875"), first, "again");
    alike(at("wrap", "3.0"), mix(first, last, 0.5), "between");
    alike(at("clear", "0.03125"), first, "inside");
    alike(at("clear", "1.0"), last.map(|x| x / 2.0), "half way out");
    assert_eq!(at("clear", "-0.04"), [0.0; 4]);
    assert_eq!(at("clear", "1.04"), [0.0; 4]);
}

#[test]
fn copies_of_one_strip_are_that_strip_again_and_an_image_repeated() {
    let folder = folder();
    let picture = image::RgbaImage::from_fn(LENGTH as u32, 1, |x, _| {
        image::Rgba(texel(1, x as usize).map(|x| (x * 255.0).round() as u8))
    });
    picture.save(folder.path().join("one.png")).expect("a picture is written");
    let seen = |cells: &str, what: &str| {
        let text = format!(
            "let strips = patterns<1>(\"strips.png\", grid: ivec2(1, {COUNT}), encoding: linear)
             let one = image(\"one.png\", encoding: linear)
             texture t(uv: vec2) -> (seen: vec4) {{
                 let p = uv.x * {cells}
                 let (cell, at) = tile_map(p, 1)
                 seen = {what}
             }}"
        );
        Drawing::beside(folder.path(), &text).seen([96, 1], [0.0, 0.0, 1.0, 1.0])
    };
    for cells in ["2.3", "19.1", "71.0"] {
        let blended = seen(cells, "strips.tiled(cell, at, |c| 1)");
        for other in ["strips.reference(1, p, edges: wrap)", "one.sample(vec2(p, 0.5))"] {
            for (a, b) in blended.iter().zip(seen(cells, other)) {
                assert!(apart(*a, b) < 1e-4, "{cells} cells, {other}: {a:?}, {b:?}");
            }
        }
    }
}

/// On both sides of the ends of cells, at any level.
#[test]
fn strips_blend_into_their_neighbours() {
    for footprint in ["0.001", "0.05", "0.3", "0.8"] {
        let body = format!(
            "let side = ifloor(uv.x * 2.0) * 2 - 1
             let end  = ifloor(uv.y * 64.0)
             let p    = end + side * 0.00001 + (fract(uv.x * 2.0) - 0.5) * 2.0 * {footprint}
             let (cell, at) = tile_map(p, 1)
             seen = strips.tiled(cell, at, |c| virtual_index(c, 4) - 1)"
        );
        let all = drawing(&body).seen([2, 64], [0.0, 0.0, 1.0, 1.0]);
        let worst = all.chunks(2).map(|pair| apart(pair[0], pair[1])).fold(0.0, f32::max);
        assert!(worst < 0.01, "{footprint}: {worst}");
    }
    // And it is the true neighbour.
    let body = "let (cell, at) = tile_map(3.0 + uv.x * 0.000001, 1) seen = strips.tiled(cell, at, |c| c % 2)";
    alike(seen(body, 1)[0], mix(texel(0, LENGTH - 1), texel(1, 0), 0.5), "strips 2 and 3");
}

#[test]
fn a_neighbour_is_fetched_at_ends_only() {
    let samples = |call: &str| {
        let body = format!("let (cell, at) = tile_map(uv.x * 5.0, 1) seen = {call}");
        drawing(&body).worst().samples
    };
    assert_eq!(samples("strips.tiled(cell, at, |c| c)"), 2.0);
    assert_eq!(samples("strips.tiled(cell, at, |c| c, edges: clamp)"), 1.0);
    assert_eq!(samples("strips.reference(cell, at)"), 1.0);
    assert_eq!(samples("strips.reference(-1, at)"), 0.0);
    assert_eq!(samples("strips.tiled(cell, at, |c| -1, far: vec4(0.0))"), 0.0);
}

#[test]
fn strips_become_their_mean_from_afar() {
    let mean_of_all = [0, 1, 2, 3].map(|i| (0..COUNT).map(|k| mean(k, 0, LENGTH)[i]).sum::<f32>() / 3.0);
    let far = seen("let (cell, at) = tile_map(uv.x * 200.0, 1) seen = strips.tiled(cell, at, |c| 0)", 16);
    far.iter().for_each(|found| alike(*found, mean_of_all, "far"));
    alike(seen("seen = strips.average", 1)[0], mean_of_all, "all");
    alike(seen("seen = strips.average(1)", 1)[0], mean(1, 0, LENGTH), "one");
    assert_eq!(seen("seen = strips.average(-1)", 1)[0], [0.0; 4]);
}

/// About half are mirrored, vectors with their strip; on their own and beside each other.
#[test]
fn strips_are_mirrored_at_random() {
    let cells = 512;
    for edges in ["clamp", "blend"] {
        let call = |set: &str, orient: &str| {
            let body = format!(
                "let (cell, at) = tile_map(uv.x * {cells}.0, 1)
                 seen = {set}.tiled(cell, 0.25 + at * 0.000001, |c| 2, edges: {edges}, {orient})"
            );
            seen(&body, cells)
        };
        let (plain, turned) = (mix(texel(2, 3), texel(2, 4), 0.5), mix(texel(2, 11), texel(2, 12), 0.5));
        call("strips", "stream: 0").into_iter().for_each(|found| alike(found, plain, "as it is"));
        let (found, vectors) = (call("strips", "orient: 2"), call("vectors", "orient: 2"));
        let is_turned: Vec<bool> = found.iter().map(|found| apart(*found, turned) < ROUNDING).collect();
        for ((found, vector), is_turned) in found.into_iter().zip(vectors).zip(&is_turned) {
            if !is_turned {
                alike(found, plain, "not turned");
            }
            let wanted = if *is_turned { 1.0 - 2.0 * turned[0] } else { 2.0 * plain[0] - 1.0 };
            assert!((vector[0] - wanted).abs() < 2.0 * ROUNDING, "{vector:?}, {wanted}");
        }
        let turned = is_turned.iter().filter(|turned| **turned).count();
        assert!(crate::support::deviations(turned, cells, 0.5) < 4.9, "{turned}");
        let other: Vec<bool> = call("strips", "orient: 8, stream: 1")
            .iter()
            .map(|found| apart(*found, plain) > ROUNDING)
            .collect();
        assert_ne!(is_turned, other, "another stream");
    }
}

/// Moved and scaled: the rising strip, inside its cell.
#[test]
fn a_strip_is_placed_on_a_line() {
    let body = "let (cell, at) = tile_map(uv.x * 4.0, 1)
                seen = strips.tile_transform(cell, at, |c| if c == 1 { 2 } else { -1 },
                    scale: |c| 0.5, translation: |c| 0.75)";
    let pixels = 640;
    for (i, found) in seen(body, pixels).into_iter().enumerate() {
        let place = (((i as f32 + 0.5) / pixels as f32 * 4.0 - 1.0) - 0.625) / 0.5 + 0.5;
        if (0.04..0.96).contains(&place) {
            let rising = (place * LENGTH as f32 - 0.5).clamp(0.0, 15.0) / 15.0;
            assert!((found[0] - rising).abs() < 0.02 && found[3] > 0.99, "{i}: {found:?}, {rising}");
        } else if !(-0.04..1.04).contains(&place) {
            assert_eq!(found, [0.0; 4], "{i}");
        }
    }
}
