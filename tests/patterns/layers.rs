//! Painted layers (`std/layers.tex`).

use crate::support::Drawing;

const WEIGHTS: &str = "
    node weight(uv: vec2, i: int) -> (w: float) { w = max(noise(uv * 5.0 + i * 3.7, seed: i), 0.0) }
    node high(uv: vec2, i: int) -> (h: float) { h = noise(uv * 40.0, seed: 20 + i) * 0.5 + 0.5 }
";

#[test]
fn shares_add_up_and_a_layer_without_weight_has_none() {
    let text = format!(
        "{WEIGHTS} texture t(uv: vec2) -> (seen: vec4) {{
            let w = vec4(weight(uv, 0), weight(uv, 1), 0.0, weight(uv, 3))
            let h = vec4(high(uv, 0), high(uv, 1), 1.0, high(uv, 3))
            let s = blend_by_height(w, h, sharpness: 8.0)
            seen = vec4(if dot(w, vec4(1.0)) > 0.001 {{ dot(s, vec4(1.0)) }} else {{ 1.0 }}, s.z, min(min(s.x, s.y), s.w), 0.0)
        }}"
    );
    for [sum, unpainted, least, _] in Drawing::of(&text).cells(64) {
        assert!((sum - 1.0).abs() < 1e-5 && unpainted == 0.0 && least >= 0.0, "{sum} {unpainted} {least}");
    }
}

#[test]
fn without_sharpness_weights_alone_count_and_with_much_the_highest() {
    let text = |sharpness: &str| {
        format!(
            "texture t(uv: vec2) -> (s: vec4) {{ s = blend_by_height(vec4(0.5, 0.25, 0.25, 0.0), vec4(0.0, 1.0, 0.5, 1.0), sharpness: {sharpness}) }}"
        )
    };
    assert_eq!(Drawing::of(&text("0.0")).cells(1)[0], [0.5, 0.25, 0.25, 0.0]);
    // 0.25 · (1 + 1) = 0.5 · (1 + 0): both of the highest, by weight.
    let sharp = Drawing::of(&text("1000.0")).cells(1)[0];
    assert!((sharp[0] - 2.0 / 3.0).abs() < 1e-5 && sharp[2] == 0.0, "{sharp:?}");
}

#[test]
fn the_strongest_of_sixteen_are_found_and_nothing_jumps() {
    let text = format!(
        "{WEIGHTS} texture t(uv: vec2) -> (color: color) {{
            color = layers(16, |i| weight(uv, i), |i| high(uv, i), |i| hue(i / 16.0), strongest: 3, sharpness: 5.0)
        }}"
    );
    let drawing = Drawing::of(&text);
    // Two grids a hair apart: where layers change places the colour must not.
    let hair = 1e-5;
    let (here, there) =
        (drawing.seen([192; 2], [0.0, 0.0, 1.0, 1.0]), drawing.seen([192; 2], [hair, 0.0, 1.0 + hair, 1.0]));
    let step = here.iter().zip(&there).map(|(a, b)| (0..4).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max));
    let worst = step.fold(0.0, f32::max);
    assert!(worst < 0.02, "{worst}");
}

#[test]
fn few_layers_are_fetched_however_many_are_painted() {
    let text = |count: u32| {
        format!(
            "let tiles = patterns(\"tiles/grass.png\", grid: ivec2(4, 4))
             texture t(uv: vec2) -> (color: color) {{
                color = layers({count}, |i| fract(uv.x * (i + 1)), |i| tiles.reference(i, uv).g, |i| tiles.reference(i, uv * 2.0))
             }}"
        )
    };
    assert_eq!((Drawing::of(&text(4)).worst().samples, Drawing::of(&text(16)).worst().samples), (6.0, 6.0));
}

#[test]
fn what_is_far_fades_in_by_footprint() {
    let text = "texture t(uv: vec2) -> (color: color) { color = mix_distance(#ff0000, #0000ff, footprint(uv.x * 64.0)) }";
    let drawing = Drawing::of(text);
    let color = |size: u32| drawing.cells(size)[0];
    assert_eq!((color(1024), color(64)), ([1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]));
    let between = color(256);
    assert!(between[0] > 0.1 && between[2] > 0.1, "{between:?}");
}
