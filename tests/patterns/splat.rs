//! Sparse convolution (Lefebvre & Neyret 2003, §4).

use crate::support::{Drawing, deviations};

/// Every stamp within reach, cell by cell, with no reckoning of which cells can reach: what `splat`
/// must show.
fn agrees(arguments: &str, turn: &str, scale: &str, round: bool) {
    let stamp = "|at, rnd| vec4(rnd.rgb, 1.0) * (if length(at - 0.5) < 0.5 { 0.75 } else { OUTSIDE })";
    let stamp = stamp.replace("OUTSIDE", if round { "0.0" } else { "0.5" });
    let text = format!(
        "node stamp(at: vec2, rnd: vec4) -> (c: vec4) {{ c = vec4(rnd.rgb, 1.0) * (if length(at - 0.5) < 0.5 {{ 0.75 }} else {{ {} }}) }}
         texture t(uv: vec2) -> (seen: vec4) {{
            let p = uv * 6.0
            let all = fold (sum = vec4(0.0)) for o in ivec2(-3)..=ivec2(3) while sum.a < 0.996 {{
                let cell = ifloor(p) + o
                sum = fold (above = sum) for k in 0..2 while above.a < 0.996 {{
                    let draw = hash(cell, seed: 1936747636 + 3 * k)
                    let size = hash(cell, seed: 1936747637 + 3 * k)
                    let at   = rotation(-mix({turn}, size.y)) * (p - cell - draw.xy) / mix({scale}, size.x) + 0.5
                    let near = abs(at - 0.5)
                    let cover = {}
                    above = if cover > 0.0 && draw.w < 0.8 {{ above + stamp(at, hash(cell, seed: 1936747638 + 3 * k)) * cover * (1.0 - above.a) }} else {{ above }}
                }}
            }}
            seen = all - splat(p, {stamp}, per_cell: 2, density: |m| 0.8, {arguments})
         }}",
        if round { "0.0" } else { "0.5" },
        if round { "1.0" } else { "coverage(0.5 - max(near.x, near.y))" },
    );
    let worst = Drawing::of(&text).cells(192).iter().flatten().fold(0.0, |worst: f32, x| worst.max(x.abs()));
    assert!(worst < 1e-5, "{arguments}: {worst}");
}

#[test]
fn every_stamp_that_reaches_a_pixel_is_drawn() {
    agrees("scale: vec2(0.2, 0.7), rotation: vec2(0.0, 1turn)", "0.0, 1turn", "0.2, 0.7", false);
    agrees("scale: vec2(0.3, 1.4), rotation: vec2(0.0, 1turn)", "0.0, 1turn", "0.3, 1.4", false);
    agrees("scale: vec2(0.5, 1.0)", "0.0, 0.0", "0.5, 1.0", false);
    agrees("scale: vec2(0.5, 2.0)", "0.0, 0.0", "0.5, 2.0", false);
    agrees("round: true, scale: vec2(0.5, 1.0), rotation: vec2(0.0, 1turn)", "0.0, 1turn", "0.5, 1.0", true);
}

#[test]
fn a_promise_of_discs_spares_five_of_nine_cells() {
    let steps = |arguments: &str| {
        let text = format!(
            "let leaf = patterns(\"tiles/grass.png\", grid: ivec2(4, 4))
             texture t(uv: vec2) -> (color: color) {{
                color = splat(uv * 9.0, |at, rnd| leaf.reference(int(rnd.x * 16.0), at), rotation: vec2(0.0, 1turn){arguments})
             }}"
        );
        Drawing::of(&text).worst().samples
    };
    assert_eq!((steps(""), steps(", round: true")), (9.0, 4.0));
}

#[test]
fn density_keeps_stamps_whole_and_in_proportion() {
    // Stamps far smaller than cells: the part of cells that show one is the density.
    let text = "texture t(uv: vec2) -> (seen: float) {
        let cell = ifloor(uv * 200.0)
        let kept = fold (sum = vec4(0.0)) for o in ivec2(0)..ivec2(16) {
            sum = sum + splat(cell + (o + 0.5) / 16.0, |at, rnd| vec4(1.0), scale: vec2(0.25), density: |p| if p.x < 100.0 { 0.2 } else { 0.7 })
        }
        seen = kept.a
    }";
    let pixels = Drawing::of(text).cells(200);
    for (half, density) in [(0, 0.2), (1, 0.7)] {
        // 16 of 256 places of a cell lie in a stamp.
        let of_half = pixels.iter().enumerate().filter(|(i, _)| i % 200 / 100 == half);
        let sum: f32 = of_half.map(|(_, pixel)| pixel[0]).sum();
        let stamps = (f64::from(sum) / 16.0).round() as usize;
        assert!(deviations(stamps, 20_000, density) < 6.0, "{stamps} of 20000 at {density}");
    }
}

#[test]
fn a_stamp_that_reaches_too_far_is_an_error_at_the_call() {
    let found = crate::support::errors(
        "texture t(uv: vec2) -> (color: color) {
            color = splat(uv, |at, rnd| vec4(1.0), scale: vec2(1.0, 1.5), rotation: vec2(0.0, 1turn))
        }",
    );
    assert!(found.contains("E0233") && found.contains("reach farther"), "{found}");
}
