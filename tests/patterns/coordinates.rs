//! Coordinates (`std/coordinates.tex`): there and back, and what they leave as it was.

use crate::support::Drawing;

/// What a `vec4` expression gives over the unit square.
fn drawn(expression: &str) -> Vec<[f64; 4]> {
    let text = format!(
        "node wave(p: vec2) -> (c: color) {{ c = vec4(sin(p.x * 9.0), cos(p.y * 7.0), p.x * p.y, 1.0) }}
        texture t(uv: vec2) -> (v: vec4) {{
            let space = hash(ifloor(uv * 40.0)).xyz * 2.0 - 1.0
            v = {expression}
        }}"
    );
    Drawing::of(&text).cells(40).into_iter().map(|v| v.map(f64::from)).collect()
}

/// Two expressions are the same.
fn same(one: &str, other: &str) {
    for (i, (a, b)) in drawn(one).into_iter().zip(drawn(other)).enumerate() {
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-5, "{one} is {a:?} at {i}, {other} {b:?}");
    }
}

#[test]
fn places_come_back() {
    same("vec4(rotate_about(rotate_about(uv, 0.7), -0.7), 0.0, 0.0)", "vec4(uv, 0.0, 0.0)");
    same(
        "vec4(scale_about(scale_about(uv, vec2(3.0, 0.5)), vec2(1.0 / 3.0, 2.0)), 0.0, 0.0)",
        "vec4(uv, 0.0, 0.0)",
    );
    same("vec4(from_polar(polar(uv).turn, polar(uv).radius), 0.0, 0.0)", "vec4(uv, 0.0, 0.0)");
    same("vec4(from_latlong(latlong(space)), 0.0)", "vec4(normalize(space), 0.0)");
    same("vec4(latlong(from_latlong(uv)), 0.0, 0.0)", "vec4(uv, 0.0, 0.0)");
    same("vec4(twirl(twirl(uv, angle: 0.6), angle: -0.6), 0.0, 0.0)", "vec4(uv, 0.0, 0.0)");
}

#[test]
fn the_centre_stays_and_the_rest_turns_from_x_towards_y() {
    same(
        "vec4(rotate_about(vec2(0.5), 0.7), rotate_about(vec2(1.0, 0.5), 90deg))",
        "vec4(0.5, 0.5, 0.5, 1.0)",
    );
    same("vec4(twirl(vec2(0.5), angle: 1.0), twirl(vec2(1.2, 0.5), angle: 1.0))", "vec4(0.5, 0.5, 1.2, 0.5)");
    same(
        "vec4(polar(vec2(0.5, 0.7)).turn, polar(vec2(0.5, 0.7)).radius, latlong(vec3(0.0, 1.0, 0.0)).y, 0.0)",
        "vec4(0.25, 0.2, 0.0, 0.0)",
    );
}

#[test]
fn mirrors_repeat_every_other_unit_and_meet() {
    same("vec4(mirror(uv + 2.0), mirror(uv - 4.0))", "vec4(uv, uv)");
    same("vec4(mirror(1.0 + uv), mirror(-uv))", "vec4(1.0 - uv, uv)");
    // A fifth of a turn on, and mirrored, a kaleidoscope shows the same.
    same("wave(kaleidoscope(rotate_about(uv, 0.2turn), sectors: 5))", "wave(kaleidoscope(uv, sectors: 5))");
    same("wave(kaleidoscope(vec2(uv.x, 1.0 - uv.y), sectors: 5))", "wave(kaleidoscope(uv, sectors: 5))");
}

#[test]
fn projections_show_all_of_what_is_drawn() {
    same("triplanar(space, space, |at| #80c0ff)", "#80c0ff");
    same("triplanar(space, vec3(0.0, 0.0, -1.0), wave)", "wave(space.xy)");
    same("triplanar(space, vec3(0.0, 2.0, 0.0), wave)", "wave(space.xz)");
    same("vec4(dot(triplanar_weights(space), vec3(1.0)), 0.0, 0.0, 0.0)", "vec4(1.0, 0.0, 0.0, 0.0)");
    same(
        "vec4(to_tangent(space, vec3(0.0, 1.0, 0.0), vec4(1.0, 0.0, 0.0, -1.0)), 0.0)",
        "vec4(space.x, space.z, space.y, 0.0)",
    );
}

/// A plain at some depth, and a slope: where a ray meets them is known.
#[test]
fn rays_meet_the_surface() {
    let seen = |height: &str, steps: u32| {
        format!("parallax_occlusion(uv, vec3(0.6, 0.0, 0.8), |p| {height}, depth: 0.1, steps: {steps})")
    };
    let flat = seen("0.75", 8);
    same(
        &format!("vec4({flat}.place, {flat}.below, 0.0)"),
        "vec4(uv - vec2(0.25 * 0.1 * 0.75, 0.0), 0.25, 0.0)",
    );
    // Height p.x: 1 - t = x - 0.075·t.
    let slope = seen("p.x", 8);
    same(&format!("vec4({slope}.below, 0.0, 0.0, 0.0)"), "vec4((1.0 - uv.x) / 0.925, 0.0, 0.0, 0.0)");
    let full = seen("1.0", 8);
    same(&format!("vec4({full}.place, {full}.below, 0.0)"), "vec4(uv, 0.0, 0.0)");
    same(
        "vec4(parallax(uv, vec3(0.6, 0.0, 0.8), 1.0, scale: 0.1), 0.0, 0.0)",
        "vec4(uv + vec2(0.03, 0.0), 0.0, 0.0)",
    );
}
