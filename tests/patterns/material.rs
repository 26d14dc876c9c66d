//! One choice of pattern, turn and place drives all maps of a material.

use crate::support::Drawing;
use std::path::Path;

/// A folder with `noise.png`, in which no two texels are alike: two patterns.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let of = |x: u32, y: u32| image::Rgb([x, y, x * y].map(|i| (i * 331 % 65_521) as u16));
    let picture = image::ImageBuffer::<image::Rgb<u16>, Vec<u16>>::from_fn(64, 32, of);
    picture.save(folder.path().join("noise.png")).expect("it is saved");
    folder
}

/// Colours, heights and the three of the third map from one picture; how each is drawn.
fn text(call: &str, shown: &str) -> String {
    format!(
        "let colors = patterns(\"noise.png\", grid: ivec2(2, 1), encoding: linear)
        let heights = patterns(\"noise.png\", grid: ivec2(2, 1), encoding: linear)
        let orm = patterns(\"noise.png\", grid: ivec2(2, 1), encoding: linear)
        let normals = patterns(\"noise.png\", grid: ivec2(2, 1), encoding: normal)
        texture t(uv: vec2) -> {shown}
            let (cell, at) = tile_map(uv, 6)
            let pick = virtual_index(cell, 3) - 1
            let m = colors.{call}
    "
    )
}

const MAPS: &str = "normals: normals, heights: heights, orm: orm,";
const ALL: &str = "(color: vec4, normal: vec3, height: float, occlusion: float, roughness: float, \
                   metallic: float) {\n\
                   color = m.color\nnormal = m.normal\nheight = m.height\nocclusion = m.occlusion\n\
                   roughness = m.roughness\nmetallic = m.metallic\n";

fn calls(maps: &str) -> [String; 4] {
    let moved = "scale: |c| 0.6, rotation: |c| virtual_random(c, stream: 2).x * 1turn, \
                 translation: |c| virtual_random(c, stream: 2).zw";
    [
        format!("material_reference(pick, at * 1.4 - 0.2, {maps} edges: clear)"),
        format!("material_tiled(cell, at, |c| virtual_index(c, 2), {maps} orient: 8)"),
        format!("material_transform(cell, at, |c| virtual_index(c, 3) - 1, {maps} {moved})"),
        format!(
            "material_transform(cell, at, |c| virtual_index(c, 3) - 1, {maps} {moved}, \
             overflow: neighbours)"
        ),
    ]
}

/// An output of a texture that has them all.
fn output(folder: &Path, call: &str, name: &str) -> Drawing {
    let (declared, body) = ALL.split_once("{\n").unwrap_or_default();
    let text = format!("{}{body}}}", text(call, &format!("{declared}{{")));
    Drawing::output(folder, &text, Some(name))
}

fn seen(drawing: &Drawing) -> Vec<[f32; 4]> {
    drawing.seen([192; 2], [0.0, 0.0, 1.0, 1.0])
}

#[test]
fn all_maps_show_the_same_tile_by_the_same_turn() {
    let folder = folder();
    for call in calls(MAPS) {
        let [color, height, occlusion, roughness, metallic] =
            ["color", "height", "occlusion", "roughness", "metallic"]
                .map(|name| seen(&output(folder.path(), &call, name)));
        let mut shown = 0;
        for (i, [r, g, b, a]) in color.iter().enumerate() {
            let near = |value: f32, expected: f32| (value - expected).abs() < 1e-5;
            let all = near(height[i][0], *r)
                && near(occlusion[i][0], r + 1.0 - a)
                && near(roughness[i][0], g + 0.5 * (1.0 - a))
                && near(metallic[i][0], *b);
            assert!(all, "{call}: pixel {i} differs");
            shown += usize::from(*a > 0.99);
        }
        assert!(shown > 5_000, "{call}: {shown} pixels show anything");
    }
}

/// The picture as vectors, turned as the colours are: their length is the same, and what has none is
/// flat.
#[test]
fn normals_turn_with_the_colours() {
    let folder = folder();
    for call in calls(MAPS) {
        let color = seen(&output(folder.path(), &call, "color"));
        let normal = seen(&output(folder.path(), &call, "normal"));
        let mut turned = 0;
        for ([r, g, b, a], [x, y, z, _]) in color.into_iter().zip(normal) {
            if a > 0.9999 {
                let expected = [r, g, b].map(|value| 2.0 * value - 1.0);
                let longer = |x: f32, y: f32| x.hypot(y);
                // Where two lie over each other they are turned apart.
                let apart = (longer(x, y) - longer(expected[0], expected[1])).abs() > 1e-3;
                assert!(!apart || call.contains("neighbours"), "{call}");
                assert!((z - expected[2]).abs() < 1e-3, "{call}");
                turned += usize::from((x - expected[0]).abs() > 0.1);
            } else if a == 0.0 {
                assert_eq!([x, y, z], [0.0, 0.0, 1.0], "{call}");
            }
        }
        assert_eq!(turned > 1_000, !call.contains("reference"), "{call}: {turned} are turned");
    }
}

#[test]
fn maps_that_are_not_given_are_neutral() {
    let folder = folder();
    for call in calls("") {
        let neutral = [
            ("normal", [0.0, 0.0, 1.0]),
            ("height", [0.0; 3]),
            ("occlusion", [1.0; 3]),
            ("roughness", [0.5; 3]),
            ("metallic", [0.0; 3]),
        ];
        for (name, value) in neutral {
            let drawing = output(folder.path(), &call, name);
            let width = if name == "normal" { 3 } else { 1 };
            assert!(seen(&drawing).iter().all(|shown| shown[..width] == value[..width]), "{call}: {name}");
            assert!(drawing.worst().reads == 0.0, "{call}: {name} is not fetched");
        }
    }
}

#[test]
fn outputs_not_asked_for_cost_nothing() {
    let folder = folder();
    for call in calls(MAPS) {
        let reads = |name: &str| output(folder.path(), &call, name).worst().samples;
        let alone = output(folder.path(), &call.replace(MAPS, ""), "color").worst().samples;
        assert_eq!(reads("color"), alone, "{call}: other maps cost nothing");
        // Where patterns lie over each other, the colours say what is seen.
        let others = if call.contains("transform") { 2.0 * alone } else { alone };
        for name in ["normal", "height", "occlusion"] {
            assert_eq!(reads(name), others, "{call}: {name}");
        }
    }
}
