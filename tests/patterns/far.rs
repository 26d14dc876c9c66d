//! A virtual texture of 65,536² cells of 64² texels, addressed with `base:`: its farthest corner is as
//! exact and as cheap as its nearest.

use crate::support::{Drawing, GRASS};

/// Cells shown along a side, and pixels of each.
const SHOWN: u32 = 8;
const TEXELS: u32 = 64;
/// The first cell that is shown, so that the last one is the last of all.
const FIRST: u32 = 65_536 - SHOWN;

fn drawing(shown: &str) -> Drawing {
    Drawing::of(&format!(
        "{GRASS}param corner: int = 0 in 0..=65535
        texture t(uv: vec2) -> (shown: vec4) {{
            let (cell, at) = tile_map(uv, 1, base: corner)
            shown = {shown}
        }}"
    ))
}

fn corner(drawing: &Drawing, first: u32) -> Vec<[f32; 4]> {
    let side = f64::from(SHOWN);
    drawing.seen_with(&format!("corner={first}"), [SHOWN * TEXELS; 2], [0.0, 0.0, side, side])
}

#[test]
fn the_far_corner_has_exact_cells_and_places() {
    let far = corner(&drawing("vec4(cell, at)"), FIRST);
    for (i, shown) in (0..).zip(far) {
        let pixel: [u32; 2] = [i % (SHOWN * TEXELS), i / (SHOWN * TEXELS)];
        let [x, y] = pixel.map(|p| (FIRST + p / TEXELS) as f32);
        let [u, v] = pixel.map(|p| ((p % TEXELS) as f32 + 0.5) / TEXELS as f32);
        assert_eq!(shown, [x, y, u, v], "at {pixel:?}");
    }
}

#[test]
fn the_far_corner_shows_whole_tiles_of_its_own() {
    const TILE: &str = "grass.reference(virtual_index(cell, grass.count), at)";
    let far = corner(&drawing(TILE), FIRST);
    let numbered = format!("let far = cell + {FIRST}\nshown = {}", TILE.replace("(cell,", "(far,"));
    let named = Drawing::of(&format!(
        "{GRASS}texture t(uv: vec2) -> (shown: vec4) {{ let (cell, at) = tile_map(uv, 1)\n{numbered}\n}}"
    ));
    assert_eq!(far, named.seen([SHOWN * TEXELS; 2], [0.0, 0.0, f64::from(SHOWN), f64::from(SHOWN)]));
    assert_ne!(far, corner(&drawing(TILE), 0), "other tiles than at the near corner");
}

#[test]
fn the_far_corner_costs_what_the_smallest_does() {
    let tile = "grass.reference(virtual_index(cell, grass.count), at)";
    let small = Drawing::of(&format!(
        "{GRASS}texture t(uv: vec2) -> (shown: vec4) {{
            let (cell, at) = tile_map(uv, 1)
            shown = {tile}
        }}"
    ));
    let (small, large) = (small.worst(), drawing(tile).worst());
    assert_eq!((small.samples, small.fetches), (1.0, 0.0));
    assert_eq!((large.samples, large.fetches), (1.0, 0.0));
    // The sum of the two parts of the number, and no more.
    assert!(large.arithmetic.total <= small.arithmetic.total + 2.0, "{large:?}, not {small:?}");
}
