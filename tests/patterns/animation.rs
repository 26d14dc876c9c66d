//! Animation cycles and their temporal transition (Lefebvre & Neyret 2003, §3.4, figure 13).

use crate::support::Drawing;

/// Random cycles and changes, one a cell. `o` are two pairs of rests and densities, the frames, the
/// phase and the time of the change.
const CYCLES: &str = "
    node numbers(cell: ivec2) -> (frames: int, phase: float, change: float, a: vec2, z: vec2) {
        let r  = hash(cell, seed: 1)
        let s  = hash(cell, seed: 2)
        frames = 1 + int(r.x * 12.0)
        phase  = r.y * 4000.0 - 2000.0
        change = r.z * 300.0 - 150.0
        a      = vec2(s.x, s.y) * 1.5
        // Some have no rest at all.
        z      = vec2(max(s.z * 30.0 - 3.0, 0.0), max(s.w * 30.0 - 3.0, 0.0))
    }
    node frame_at(cell: ivec2, time: float) -> (frame: int) {
        let o = numbers(cell)
        frame = animate(time, o.frames, phase: o.phase, rest: o.z.x, density: o.a.x,
                        previous_rest: o.z.y, previous_density: o.a.y, changed: o.change)
    }
    node cycle_at(cell: ivec2, time: float, old: int) -> (frame: int) {
        let o = numbers(cell)
        frame = animate(time, o.frames, phase: o.phase, rest: o.z[old], density: o.a[old])
    }
";

#[test]
fn no_frame_is_skipped_and_none_pops() {
    // 480² random sets of parameters, each looked at at every frame around its change.
    let drawing = Drawing::of(&format!(
        "{CYCLES} texture t(uv: vec2) -> (wrong: float) {{
            let cell  = ifloor(uv * 480.0)
            let o     = numbers(cell)
            let start = ifloor(ceil(o.change)) - 2
            let seen = fold (frame = frame_at(cell, float(start)), wrong = 0) for i in 1..(2 * o.frames + 4) max 30 {{
                let next = frame_at(cell, float(start + i))
                wrong = if next == frame + 1 || (next == 0 && (frame == 0 || frame == o.frames - 1)) {{ wrong }} else {{ wrong + 1 }}
                frame = next
            }}
            wrong = float(seen.wrong)
        }}"
    ));
    let wrong = drawing.cells(480).iter().filter(|pixel| pixel[0] != 0.0).count();
    assert_eq!(wrong, 0);
}

#[test]
fn before_a_change_runs_the_old_cycle_and_two_sequences_after_it_the_new_one() {
    let drawing = Drawing::of(&format!(
        "{CYCLES} texture t(uv: vec2) -> (wrong: float) {{
            let cell   = ifloor(uv * 256.0)
            let o      = numbers(cell)
            let before = ceil(o.change) - 1.0 - ifloor(hash(cell, seed: 3).x * 100.0)
            let after  = ceil(o.change) + 2.0 * o.frames + ifloor(hash(cell, seed: 4).x * 100.0)
            let old    = frame_at(cell, before) == cycle_at(cell, before, 1)
            let new    = frame_at(cell, after) == cycle_at(cell, after, 0)
            wrong      = if old && new {{ 0.0 }} else {{ 1.0 }}
        }}"
    ));
    assert!(drawing.cells(256).iter().all(|pixel| pixel[0] == 0.0));
}

#[test]
fn a_cycle_rests_and_then_shows_each_frame_once() {
    // Figure 12: three frames ahead, two at rest before a sequence of five.
    let drawing = Drawing::of(
        "texture t(uv: vec2) -> (frame: float) {
            frame = float(animate(floor(uv.x * 16.0), 5, phase: 3.0, rest: 2.0))
        }",
    );
    let frames: Vec<f32> = drawing.cells(16)[..16].iter().map(|pixel| pixel[0]).collect();
    assert_eq!(frames, [1., 2., 3., 4., 0., 0., 0., 1., 2., 3., 4., 0., 0., 0., 1., 2.]);
}

#[test]
fn a_sequence_goes_along_any_value_and_keeps_its_time_line() {
    let drawing = Drawing::of(
        "let grass = patterns(\"tiles/grass.png\", grid: ivec2(4, 4))
         let slow = probability([0, 0, 0, 5, 9, 5])
         texture t(uv: vec2) -> (pick: float) {
            pick = float(if uv.y < 0.5 { grass.sequence(uv.x * 2.0 - 0.5) } else { grass.sequence(uv.x, timeline: slow) })
         }",
    );
    let pixels = drawing.cells(32);
    let row = |y: usize| -> Vec<f32> { pixels[y * 32..][..32].iter().map(|pixel| pixel[0]).collect() };
    assert_eq!(row(0)[..9], [0.0; 9], "before its begin it shows its first frame");
    assert_eq!(row(0)[8..24].to_vec(), (0..16).map(|i| i as f32).collect::<Vec<_>>());
    assert_eq!(row(0)[24..], [15.0; 8]);
    assert_eq!(row(31)[..16], [0.0; 16], "half of the time line");
    assert_eq!(row(31)[17..32], [5., 5., 5., 5., 9., 9., 9., 9., 9., 9., 5., 5., 5., 5., 5.]);
}
