//! Colours (`std/color.tex`) against the formulas of their sources, written out.

use crate::support::Drawing;

type Rgb = [f64; 3];

/// What an expression gives for random colours: `a` and `b` of four numbers each, and `p` and `q`,
/// what they are premultiplied by the last.
fn drawn(expression: &str) -> Vec<[f64; 4]> {
    let text = format!(
        "texture t(uv: vec2) -> (v: vec4) {{
            let cell = ifloor(uv)
            let a    = hash(cell)
            let b    = hash(cell, seed: 1)
            let p    = premultiply(a)
            let q    = premultiply(b)
            v        = {expression}
        }}"
    );
    let numbers = Drawing::of(&text).seen([48; 2], [0.0, 0.0, 48.0, 48.0]);
    numbers.into_iter().map(|v| v.map(f64::from)).collect()
}

fn near(a: &[f64], b: &[f64], tolerance: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance)
}

fn first(v: [f64; 4]) -> Rgb {
    [v[0], v[1], v[2]]
}

#[test]
fn conversions_there_and_back_change_nothing() {
    let colours = drawn("a");
    for way in [
        "from_srgb(to_srgb(a))",
        "to_srgb(from_srgb(a))",
        "vec4(from_oklab(to_oklab(a.rgb)), a.a)",
        "vec4(from_hsv(to_hsv(a.rgb)), a.a)",
        "unpremultiply(premultiply(a))",
        "invert(invert(a))",
        "unpremultiply(adjust_hsv(p))",
        "unpremultiply(adjust_oklch(p))",
        "unpremultiply(adjust_hsv(adjust_hsv(p, hue: 0.3), hue: -0.3))",
        "unpremultiply(curves(p, |x| tone_curve(x)))",
        "unpremultiply(levels(p))",
        "unpremultiply(brightness_contrast(p))",
        "unpremultiply(mix_oklab(p, q, 0.0))",
        "unpremultiply(mix_oklab(q, p, 1.0))",
        "unpremultiply(mix_oklch(p, q, 0.0))",
        "unpremultiply(mix_oklch(q, p, 1.0))",
    ] {
        for (found, expected) in drawn(way).iter().zip(&colours) {
            // What hardly covers anything has no exact colour.
            let tolerance = 2e-5 / expected[3].max(0.01);
            assert!(near(found, expected, tolerance), "{way}: {found:?} of {expected:?}");
        }
    }
}

fn encoded(x: f64) -> f64 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

fn decoded(x: f64) -> f64 {
    if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

/// As it is told: by which component is the greatest.
fn hsv([r, g, b]: Rgb) -> Rgb {
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let degrees = if most == least {
        0.0
    } else if most == r {
        60.0 * ((g - b) / (most - least))
    } else if most == g {
        60.0 * ((b - r) / (most - least)) + 120.0
    } else {
        60.0 * ((r - g) / (most - least)) + 240.0
    };
    [degrees.rem_euclid(360.0) / 360.0, if most == 0.0 { 0.0 } else { (most - least) / most }, most]
}

#[test]
fn conversions_are_those_of_their_sources() {
    let colours = drawn("a");
    let each = |found: Vec<[f64; 4]>, expected: &dyn Fn(Rgb) -> Rgb| {
        for (found, colour) in found.into_iter().zip(&colours) {
            let expected = expected(first(*colour));
            assert!(near(&first(found), &expected, 1e-5), "{found:?} of {colour:?}, not {expected:?}");
        }
    };
    each(drawn("to_srgb(a)"), &|c| c.map(encoded));
    each(drawn("from_srgb(a)"), &|c| c.map(decoded));
    each(drawn("to_srgb(a * 0.004)"), &|c| c.map(|x| encoded(0.004 * x)));
    each(drawn("vec4(to_hsv(a.rgb), 1.0)"), &hsv);
    // Of the colours that CSS Color 4 lists.
    for (colour, lab) in [
        ("#ffffff", [1.0, 0.0, 0.0]),
        ("#ff0000", [0.627_96, 0.224_86, 0.125_85]),
        ("#00ff00", [0.866_44, -0.233_89, 0.179_50]),
        ("#0000ff", [0.452_01, -0.032_46, -0.311_53]),
    ] {
        let found = first(drawn(&format!("vec4(to_oklab({colour}.rgb), 1.0)"))[0]);
        assert!(near(&found, &lab, 2e-5), "{colour}: {found:?}");
    }
}

fn multiply(b: f64, s: f64) -> f64 {
    b * s
}

fn screen(b: f64, s: f64) -> f64 {
    b + s - b * s
}

fn hard_light(b: f64, s: f64) -> f64 {
    if s <= 0.5 { multiply(b, 2.0 * s) } else { screen(b, 2.0 * s - 1.0) }
}

fn dodge(b: f64, s: f64) -> f64 {
    if b == 0.0 {
        0.0
    } else if s == 1.0 {
        1.0
    } else {
        f64::min(1.0, b / (1.0 - s))
    }
}

fn burn(b: f64, s: f64) -> f64 {
    if b == 1.0 {
        1.0
    } else if s == 0.0 {
        0.0
    } else {
        1.0 - f64::min(1.0, (1.0 - b) / s)
    }
}

fn soft_light(b: f64, s: f64) -> f64 {
    let d = if b <= 0.25 { ((16.0 * b - 12.0) * b + 4.0) * b } else { b.sqrt() };
    if s <= 0.5 { b - (1.0 - 2.0 * s) * b * (1.0 - b) } else { b + (2.0 * s - 1.0) * (d - b) }
}

fn lum([r, g, b]: Rgb) -> f64 {
    0.3 * r + 0.59 * g + 0.11 * b
}

fn sat([r, g, b]: Rgb) -> f64 {
    r.max(g).max(b) - r.min(g).min(b)
}

/// `ClipColor` of `SetLum`.
fn set_lum(c: Rgb, l: f64) -> Rgb {
    let d = l - lum(c);
    let mut c = c.map(|x| x + d);
    let (l, n, x) = (lum(c), c[0].min(c[1]).min(c[2]), c[0].max(c[1]).max(c[2]));
    if n < 0.0 {
        c = c.map(|c| l + (c - l) * l / (l - n));
    }
    if x > 1.0 {
        c = c.map(|c| l + (c - l) * (1.0 - l) / (x - l));
    }
    c
}

/// The spec sorts the components; the middle one keeps its part of the way.
fn set_sat(c: Rgb, s: f64) -> Rgb {
    let mut order = [0, 1, 2];
    order.sort_by(|a: &usize, b| c[*a].total_cmp(&c[*b]));
    let [min, mid, max] = order;
    let mut result = [0.0; 3];
    if c[max] > c[min] {
        result[mid] = (c[mid] - c[min]) * s / (c[max] - c[min]);
        result[max] = s;
    }
    result
}

/// A mode of blending: its word and what it makes of what is below and what is above.
type Mode = (&'static str, fn(Rgb, Rgb) -> Rgb);

fn each(b: Rgb, s: Rgb, of: fn(f64, f64) -> f64) -> Rgb {
    [0, 1, 2].map(|i: usize| of(b[i], s[i]))
}

const MODES: [Mode; 17] = [
    ("normal", |_, s| s),
    ("multiply", |b, s| each(b, s, multiply)),
    ("screen", |b, s| each(b, s, screen)),
    ("overlay", |b, s| each(s, b, hard_light)),
    ("darken", |b, s| each(b, s, f64::min)),
    ("lighten", |b, s| each(b, s, f64::max)),
    ("color_dodge", |b, s| each(b, s, dodge)),
    ("color_burn", |b, s| each(b, s, burn)),
    ("hard_light", |b, s| each(b, s, hard_light)),
    ("soft_light", |b, s| each(b, s, soft_light)),
    ("difference", |b, s| each(b, s, |b, s| (b - s).abs())),
    ("exclusion", |b, s| each(b, s, |b, s| b + s - 2.0 * b * s)),
    ("add", |b, s| each(b, s, |b, s| b + s)),
    ("hue", |b, s| set_lum(set_sat(s, sat(b)), lum(b))),
    ("saturation", |b, s| set_lum(set_sat(b, sat(s)), lum(b))),
    ("hue_saturation", |b, s| set_lum(s, lum(b))),
    ("luminosity", |b, s| set_lum(b, lum(s))),
];

#[test]
fn modes_blend_as_the_specification_says() {
    let (sources, grounds) = (drawn("a"), drawn("b"));
    for (mode, of) in MODES {
        for (space, opacity) in [("linear", 1.0), ("srgb", 1.0), ("linear", 0.4)] {
            let blended = drawn(&format!("blend(p, q, mode: {mode}, opacity: {opacity}, space: {space})"));
            let mut worst: f64 = 0.0;
            for ((s, b), found) in sources.iter().zip(&grounds).zip(blended) {
                let (cs, cb, alpha_s, alpha_b) = (first(*s), first(*b), s[3] * opacity, b[3]);
                let mixed = if space == "srgb" {
                    of(cb.map(encoded), cs.map(encoded)).map(decoded)
                } else {
                    of(cb, cs)
                };
                let alpha = alpha_s + alpha_b - alpha_s * alpha_b;
                let mut expected = [0.0, 0.0, 0.0, alpha];
                for i in 0..3 {
                    expected[i] = alpha_s * (1.0 - alpha_b) * cs[i]
                        + alpha_s * alpha_b * mixed[i]
                        + (1.0 - alpha_s) * alpha_b * cb[i];
                }
                let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                worst = worst.max(off);
                assert!(off < 2e-5, "{mode}, {space}: {s:?} on {b:?} is {found:?}, not {expected:?}");
            }
            println!("{mode}, {space}, {opacity}: off by {worst:.1e} at most");
        }
    }
}

/// Black and white, and nothing at all, through the modes that divide.
#[test]
fn modes_know_black_and_white() {
    for (mode, of) in MODES {
        for (below, b) in [("#000000", 0.0), ("#ffffff", 1.0)] {
            for (top, s) in [("#000000", 0.0), ("#ffffff", 1.0)] {
                let found = first(drawn(&format!("blend({top}, {below}, mode: {mode})"))[0]);
                assert!(near(&found, &of([b; 3], [s; 3]), 1e-6), "{mode}: {top} on {below} is {found:?}");
            }
        }
        let through = drawn(&format!("blend(p, vec4(0.0), mode: {mode}) - p"));
        let alone = drawn(&format!("blend(vec4(0.0), q, mode: {mode}) - q"));
        for found in through.iter().chain(&alone) {
            assert!(near(found, &[0.0; 4], 1e-6), "{mode} with nothing: {found:?}");
        }
    }
}

#[test]
fn greys_are_as_bright_as_their_colours() {
    let y = |c: Rgb| 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    for (found, colour) in drawn("grayscale(p)").into_iter().zip(drawn("p")) {
        assert!(near(&found, &[y(first(colour)), y(first(colour)), y(first(colour)), colour[3]], 1e-6));
    }
    // Turned around in Oklab, greys are what they were and lightness stays.
    let lightness = |of: &str| drawn(&format!("vec4(to_oklab(({of}).rgb).x, vec3(0.0))"));
    let few = "vec4(0.4 + 0.1 * a.rgb, 1.0)";
    for (found, own) in lightness(&format!("adjust_oklch({few}, hue: 0.4)")).iter().zip(lightness(few)) {
        assert!(near(found, &own, 1e-5), "{found:?}, not {own:?}");
    }
}

#[test]
fn levels_and_curves_map_as_they_say() {
    for (found, a) in drawn("levels(a.rgb, black: 0.2, white: 0.7, gamma: 2.2, low: 0.1, high: 0.8).rgbr")
        .into_iter()
        .zip(drawn("a"))
    {
        let expected = first(a).map(|x| 0.1 + 0.7 * ((x - 0.2) / 0.5).clamp(0.0, 1.0).powf(1.0 / 2.2));
        assert!(near(&first(found), &expected, 1e-5), "{a:?}: {found:?}, not {expected:?}");
    }
    // A premultiplied colour is mapped as it is where nothing shines through.
    let straight = drawn("unpremultiply(brightness_contrast(p, brightness: 0.1, contrast: 1.5))");
    for (found, a) in straight.into_iter().zip(drawn("a")) {
        let expected = first(a).map(|x| ((x - 0.5) * 1.5 + 0.6).max(0.0));
        assert!(a[3] < 0.01 || near(&first(found), &expected, 1e-4), "{a:?}: {found:?}, not {expected:?}");
    }
    let curve = "tone_curve(uv.x, black: 0.1, shadows: 0.15, middle: 0.7, lights: 0.7, white: 0.95)";
    let text = format!("texture t(uv: vec2) -> (y: float) {{ y = {curve} }}");
    let line = Drawing::of(&text).seen([4097, 1], [-0.5 / 4096.0, 0.0, 1.0 + 0.5 / 4096.0, 1.0]);
    let y: Vec<f32> = line.into_iter().map(|[y, ..]| y).collect();
    for (i, expected) in [(0, 0.1), (1024, 0.15), (2048, 0.7), (3072, 0.7), (4096, 0.95)] {
        assert!((y[i] - expected).abs() < 2e-3, "{} at {i}", y[i]);
    }
    let slopes: Vec<f32> = y.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(slopes.iter().all(|slope| *slope > -1e-6), "it falls where its points do not");
    let kink = slopes.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    assert!(kink < 1e-5, "a kink of {kink} a 4096th");
}

#[test]
fn steps_are_even_and_vanish_from_afar() {
    let drawn = |size: u32, side: f64| {
        let text = "texture t(uv: vec2) -> (y: float) { y = posterize(uv.x, steps: 4) }";
        Drawing::of(text).seen([size, 1], [0.0, 0.0, side, 1.0])
    };
    let fine: Vec<f32> = drawn(1000, 1.0).into_iter().map(|[y, ..]| y).collect();
    for (i, y) in (0..).zip(&fine) {
        let expected = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0][i / 250];
        assert!((y - expected).abs() < 1e-5 || i % 250 < 1 || i % 250 > 248, "{y} at {i}");
    }
    // A pixel as wide as a step shows the ramp itself, of four steps from 0 to 1.
    for (i, [y, ..]) in (0..).zip(drawn(4, 1.0)) {
        let mean = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0][i];
        assert!((y - mean).abs() < 1e-5, "{y} at {i}, not {mean}");
    }
}

/// Half of the way from red to blue: through purple on the wheel, the shorter way.
#[test]
fn hues_are_mixed_the_shorter_way() {
    let angle = |of: &str| {
        let lab = first(drawn(&format!("vec4(to_oklab({of}.rgb), 1.0)"))[0]);
        (lab[2].atan2(lab[1]), lab[1].hypot(lab[2]))
    };
    let (red, blue) = (angle("vec4(0.5, 0.1, 0.1, 1.0)"), angle("vec4(0.1, 0.1, 0.5, 1.0)"));
    let found = angle("mix_oklch(vec4(0.5, 0.1, 0.1, 1.0), vec4(0.1, 0.1, 0.5, 1.0), 0.25)");
    let way =
        (blue.0 - red.0 + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
    assert!((found.0 - (red.0 + 0.25 * way)).abs() < 1e-4, "{found:?} between {red:?} and {blue:?}");
    assert!((found.1 - (0.75 * red.1 + 0.25 * blue.1)).abs() < 1e-4, "{found:?}");
    let from_grey = angle("mix_oklch(vec4(0.2, 0.2, 0.2, 1.0), vec4(0.1, 0.1, 0.5, 1.0), 0.5)");
    assert!((from_grey.0 - blue.0).abs() < 1e-3, "{from_grey:?}: the hue of {blue:?}");
}
