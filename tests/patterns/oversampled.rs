//! `oversampled`: the mean of evaluations spread evenly over a pixel, each for its own part of it.

use crate::support::Drawing;

const SIDE: u32 = 32;

fn drawn(call: &str, cells: f64) -> Vec<[f32; 4]> {
    let text = format!(
        "node part(p: vec2) -> (color: color) {{\n    color = vec4(footprint(p), 0.0, 0.0, 1.0)\n}}\n\ntexture t(uv: vec2) -> (color: color) {{\n    let p = uv * {cells:?}\n    color = {call}\n}}\n"
    );
    Drawing::of(&text).cells(SIDE)
}

/// Where a hard edge runs through a pixel, as many grades show as its parts can tell.
#[test]
fn an_edge_has_a_grade_for_each_part() {
    for count in [1, 2, 3, 8] {
        let call = format!("oversampled(p, |q| vec4(step(0.5, q.x)), count: {count})");
        // The edge moves through a pixel by sixteenths of it, and never through the middle of a part.
        for step in 0..16 {
            let shift = (f64::from(step) + 0.5) / 16.0;
            let seen = drawn(&call.replace("q.x", &format!("q.x - {shift:?} / 32.0")), 1.0)[16][0];
            let parts = (0..count).filter(|i| (f64::from(*i) + 0.5) / f64::from(count) >= shift).count();
            let wanted = parts as f32 / count as f32;
            assert!((seen - wanted).abs() < 1e-6, "{count}² parts, edge at {shift}: {seen}, not {wanted}");
        }
    }
}

#[test]
fn what_is_drawn_sees_a_part_of_the_pixel() {
    for (count, side) in [(1, 1), (2, 2), (4, 4), (0, 1), (9, 8)] {
        let seen = drawn(&format!("oversampled(p, part, count: {count})"), 8.0)[0][0];
        let wanted = 8.0 / (SIDE * side) as f32;
        assert!((seen - wanted).abs() < 1e-6, "{count}: {seen}, not {wanted}");
    }
}

#[test]
fn from_afar_it_is_what_lies_there() {
    let near = "|q| vec4(hash(ifloor(q)).x)";
    let seen = |units: f64| {
        let [alone, faded] = ["", ", far: vec4(0.25)"]
            .map(|far| drawn(&format!("oversampled(p, {near}{far})"), units * f64::from(SIDE)));
        (alone, faded)
    };
    for units in [0.3, 0.99] {
        let (alone, faded) = seen(units);
        assert_eq!(alone, faded, "{units} units a pixel");
    }
    let (alone, faded) = seen(1.5);
    for (alone, faded) in alone.iter().zip(&faded) {
        assert!((faded[0] - (0.5 * alone[0] + 0.125)).abs() < 1e-6, "half of both: {faded:?} of {alone:?}");
    }
    for units in [2.0, 50.0] {
        assert!(seen(units).1.iter().all(|pixel| *pixel == [0.25; 4]), "{units} units a pixel");
    }
}
