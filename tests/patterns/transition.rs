//! Transition tiles and borders (Lefebvre & Neyret 2003, §3.3, figure 11).

use crate::support::Drawing;

/// Families at random, as many as the text says.
const FAMILIES: &str = "
    node family(cell: ivec2) -> (f: int) { f = int(hash(cell).x * COUNT) }
    node corners(cell: ivec2) -> (c: ivec4) {
        c = ivec4(family(cell), family(cell + ivec2(1, 0)), family(cell + ivec2(0, 1)), family(cell + ivec2(1, 1)))
    }
";

fn drawing(count: &str, body: &str) -> Drawing {
    let families = FAMILIES.replace("COUNT", count);
    Drawing::of(&format!(
        "{families} texture t(uv: vec2) -> (seen: vec4) {{ let cell = ifloor(uv * 64.0) {body} }}"
    ))
}

#[test]
fn the_index_counts_the_corners_and_equal_ones_pass_through() {
    for (count, factor) in [("2.0", 2.0), ("3.0", 3.0), ("4.0", 4.0)] {
        let body = format!(
            "let c = corners(cell)
             let t = transition_tile(c, families: {factor})
             seen = vec4(float(t.index), if t.needed {{ 1.0 }} else {{ 0.0 }}, float(c.x + 10 * c.y), float(c.z + 10 * c.w))"
        );
        let body = body.replace(&format!("families: {factor}"), &format!("families: {}", factor as i32));
        let mut plain = 0;
        for [index, needed, upper, lower] in drawing(count, &body).cells(64) {
            let digits = [upper % 10.0, (upper / 10.0).floor(), lower % 10.0, (lower / 10.0).floor()];
            let expected = digits.iter().rev().fold(0.0, |sum, digit| sum * factor + digit);
            let is_plain = digits.iter().all(|digit| *digit == digits[0]);
            assert_eq!((index, needed == 0.0), (expected, is_plain));
            plain += usize::from(is_plain);
        }
        assert!(plain > 0, "{count}: some neighbourhoods are of one family");
    }
}

#[test]
fn a_node_of_the_cell_gives_the_same_as_its_corners() {
    let body = "let a = transition_tile(corners(cell), families: 3)
                let b = transition_tile(|c| family(c), cell, families: 3)
                seen = vec4(float(a.index - b.index), if a.needed == b.needed { 0.0 } else { 1.0 }, 0.0, 0.0)";
    assert!(drawing("3.0", body).cells(64).iter().all(|pixel| *pixel == [0.0; 4]));
}

#[test]
fn in_space_eight_corners_count() {
    let text = "
        node family(cell: ivec3) -> (f: int) { f = int(hash(cell).x * 2.0) }
        texture t(uv: vec2) -> (seen: vec4) {
            let cell = ivec3(ifloor(uv * 32.0), 7)
            let t = transition_tile(|c| family(c), cell, families: 2)
            let all = fold (sum = 0, factor = 1) for o in ivec3(0)..=ivec3(1) {
                sum    = sum + factor * family(cell + o)
                factor = factor * 2
            }
            seen = vec4(float(t.index), float(all.sum), if t.needed { 1.0 } else { 0.0 }, 0.0)
        }";
    for [index, expected, needed, _] in Drawing::of(text).cells(32) {
        assert_eq!(index, expected);
        assert_eq!(needed == 0.0, index == 0.0 || index == 255.0);
    }
}

#[test]
fn borders_lie_over_plain_ground_low_families_below() {
    // A tile is opaque and tells what it is: red the family, green its corners.
    let body = "seen = transition_border(corners(cell), 9, |family, index| vec4(family / 16.0, index / 16.0, 0.0, 1.0))";
    let corners = "let c = corners(cell) seen = vec4(c)";
    let (tiles, corners) = (drawing("9.0", body).cells(64), drawing("9.0", corners).cells(64));
    for (tile, corners) in tiles.iter().zip(&corners) {
        let highest = corners.iter().copied().fold(0.0, f32::max);
        let plain = corners.iter().all(|corner| *corner == highest);
        let bits = (0..4).filter(|i| corners[*i as usize] == highest).map(|i| 1 << i).sum::<i32>();
        let expected = if plain { 15.0 } else { bits as f32 };
        assert_eq!([tile[0] * 16.0, tile[1] * 16.0], [highest, expected]);
    }
}

#[test]
fn a_border_fetches_once_for_each_family() {
    let text = |families: u32| {
        format!(
            "let grass = patterns(\"tiles/grass.png\", grid: ivec2(4, 4))
             texture t(uv: vec2) -> (color: color) {{
                let c = ivec4(hash(ifloor(uv * 9.0)) * {families})
                color = transition_border(c, {families}, |family, index| grass.reference(index, fract(uv * 9.0), edges: clear))
             }}"
        )
    };
    assert_eq!(Drawing::of(&text(4)).worst().samples, 4.0);
}
