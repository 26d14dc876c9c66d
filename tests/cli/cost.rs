//! `cost`: figures, the gate, and sizes that nobody knows.

use crate::workshop::{PLAIN, WRONG, Workshop, examples};

const TWO: &str = "let map = indices([[0, 1], [1, 0]], levels: 2)\nlet field = bake(wave, size: ivec2(8, 4))\nlet gone = image(\"gone.png\")\n\nparam n: int = 2 in 0..=8\n\nnode wave(at: vec2) -> (value: float) {\n    value = sin(at.x)\n}\n\ntexture first(uv: vec2) -> (color: color) {\n    color = fold (s = clear) for i in 0..n {\n        s = s + gone.sample(uv * float(i))\n    }\n}\n\nlet clear = vec4(0.0)\n\ntexture second(uv: vec2) -> (height: float) {\n    height = field.sample(uv).r + float(map.at(ifloor(uv)))\n}\n";

#[test]
fn every_texture_is_counted_and_missing_files_are_no_error() {
    let shop = Workshop::new(&[("two.tex", TWO)]);
    let run = shop.run(&["cost", "two.tex"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{run:#?}");
    insta::assert_snapshot!("cost_two", run.out);
    let second = shop.run(&["cost", "two.tex:second"]);
    assert!(run.out.ends_with(&second.out) && second.out.contains("bake field, 32 texels"), "{second:#?}");
}

#[test]
fn the_gate_names_texture_and_number() {
    let shop = Workshop::new(&[("two.tex", TWO)]);
    for most in ["8", "100"] {
        assert_eq!(shop.run(&["cost", "two.tex", "--max-samples", most]).code, 0);
    }
    let run = shop.run(&["cost", "two.tex", "--max-samples=7"]);
    run.fails(1, "error: `first` takes 8 samples and fetches a pixel in the worst case, 7 are allowed\n");
    assert!(run.out.contains("texture second"), "the figures are printed: {run:#?}");
    assert_eq!(run.err.lines().count(), 1, "{run:#?}");
    let both = shop.run(&["cost", "two.tex", "--max-samples", "1"]);
    both.fails(1, "`second` takes 2 samples and fetches");
    assert_eq!(both.err.lines().count(), 2, "{both:#?}");
    let json = shop.run(&["cost", "two.tex", "--max-samples=1", "--message-format=json"]);
    assert!(json.err.lines().all(|line| line.starts_with("{\"message\":\"`")), "{json:#?}");
    shop.run(&["cost", "two.tex", "--max-samples=-1"]).fails(2, "max-samples");
}

#[test]
fn figures_for_programs_are_json() {
    let shop = Workshop::new(&[("two.tex", TWO)]);
    let run = shop.run(&["cost", "two.tex", "--format=json"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{run:#?}");
    let costs: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
    let at = |path: &str| costs.pointer(path).unwrap_or_else(|| panic!("no {path} in {costs:#}")).clone();
    assert_eq!(at("/0/texture"), "first");
    assert_eq!(at("/0/passes/0/worst/samples"), 8.0);
    assert_eq!(at("/0/passes/0/typical/reads"), 2.0);
    assert_eq!(at("/0/passes/0/loops/0/line"), 12);
    assert_eq!(at("/0/tables/0/bytes"), serde_json::Value::Null);
    assert_eq!(at("/1/passes/0/texels"), 32);
    assert_eq!(at("/1/passes/1/worst/fetches"), 1.0);
    assert_eq!(at("/1/uniform_bytes"), 0);
}

#[test]
fn sizes_come_from_the_pictures() {
    let shop = Workshop::new(&[]);
    let run = shop.run(&["cost".as_ref(), examples().join("tiling.tex").as_os_str()]);
    assert_eq!(run.code, 0, "{run:#?}");
    assert!(run.out.contains("1,398,080  rgba8unorm-srgb 128×128×16, 8 levels"), "{run:#?}");
}

#[test]
fn what_is_wrong_is_not_counted() {
    let shop = Workshop::new(&[("a.tex", PLAIN), ("wrong.tex", WRONG), ("empty.tex", "let a = 1\n")]);
    let run = shop.run(&["cost", "wrong.tex"]);
    run.fails(1, "wrong.tex:2:");
    assert_eq!(run.out, "");
    shop.run(&["cost", "empty.tex"]).fails(1, "no texture");
    shop.run(&["cost", "a.tex:plane"]).fails(1, "`plane`");
    shop.run(&["cost", "gone.tex"]).fails(1, "gone.tex");
}

#[test]
fn bombing_samples_four_pictures_for_each_stamp_of_a_cell_at_most() {
    let stamps = ["|at, rnd| sheet.reference(int(rnd.x * 4.0), at, edges: clear)", "|at, rnd| vec4(rnd.x)"];
    let wanted = [[4, 8, 12], [0, 0, 0]];
    for (stamp, wanted) in stamps.into_iter().zip(wanted) {
        for (per_cell, samples) in (1..).zip(wanted) {
            let text = format!(
                "let sheet = patterns(\"gone.png\", grid: ivec2(4, 1))\ntexture t(uv: vec2) -> (color: color) {{\n    color = bomb(uv * 8.0, {stamp}, per_cell: {per_cell})\n}}\n"
            );
            let run = Workshop::new(&[("t.tex", &text)]).run(&["cost", "t.tex", "--format=json"]);
            let costs: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
            assert_eq!(costs[0]["passes"][0]["worst"]["reads"], f64::from(samples), "{per_cell}: {costs:#}");
        }
    }
}
