//! The nine worked examples of the design parse and check, nodes that are not in the library yet
//! stood in for.
//!
//! A constructor of a kind that is not built yet is read as one of a kind that is (`STAND_INS`);
//! both lists shrink as the library grows.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use texgraph_compiler::diagnostic::render;
use texgraph_compiler::module::Loader;
use texgraph_compiler::{Library, check};

/// Constructors of kinds to come, and what they are read as.
const STAND_INS: &[(&str, &str)] = &[
    ("probability(weights: [8, 8, 4, 4, 1, 1, 1, 1], size: 64)", "indices([[0]])"),
    ("sprites(\"snake.ron\", patterns: scale, branching: 4, overlap: 12)", "patterns(\"scale.png\")"),
    ("positions(\"decals.ron\", grid: ivec2(128, 128), patterns: decal)", "patterns(\"decals.png\")"),
];

/// Nodes to come, with the heads that the examples call.
const NODES: &str = r"
node positioned(p: patterns, uv: vec2) -> (color: color) { color = p.reference(0, uv) }
node composite(p: patterns, at: vec3, blend: over | blobby = over, stretch: float = 0.0) -> (color: color) {
    color = p.reference(0, at.xy) * stretch
}
node fold_sprites(
    p: patterns,
    at: vec3,
    step: node(old: vec4, s: (distance: float, random: float)) -> vec4,
    start: vec4 = 0.0,
) -> (result: vec4) {
    let near = fold (best = start) for i in 0..4 {
        let d = length(at - i)
        let n = step(best, _sprite(d))
        best = n
    }
    result = near
}
node _sprite(d: float) -> (distance: float, random: float) {
    distance = d
    random   = fract(d)
}
node voronoi<n>(p: vec<n>, per_cell: int = 1) -> (distance: float, edge: float) {
    distance = length(fract(p)) * per_cell
    edge     = 0.5
}
node bomb<n>(
    p: vec<n>,
    stamp: node(at: vec<n>, random: vec4) -> color,
    per_cell: int = 1,
    phase: float = 0.0,
) -> (color: color) {
    let cell = ifloor(p)
    color    = fold (sum = vec4(0.0)) for o in ivec<n>(-1)..=ivec<n>(0) {
        let one = fold (c = vec4(0.0)) for k in 0..min(per_cell, 8) {
            let random = virtual_random(cell + o, stream: k) + phase
            c = stamp(p - (cell + o), random).over(c)
        }
        sum = one.over(sum)
    }
}
node splat<n>(
    p: vec<n>,
    stamp: node(at: vec<n>, random: vec4) -> color,
    per_cell: int = 1,
    scale: vec2 = 1.0,
    rotation: vec2 = 0.0,
    density: node(p: vec<n>) -> float = _everywhere,
) -> (color: color) {
    color = bomb(p * scale.x, |at, random| stamp(at, random) * density(at + rotation.x), per_cell: per_cell)
}
node _everywhere<n>(p: vec<n>) -> (value: float) { value = 1.0 }
node dithered_area(map: indices, cell: ivec2, cells: int, softness: float = 1.0) -> (index: int) {
    index = map.at(cell / max(cells, 1)) + int(softness)
}
node transition_tile(corners: ivec4, families: int) -> (needed: bool, index: int) {
    needed = corners.x != corners.y
    index  = corners.z % families
}
node animate(
    time: float,
    count: int,
    phase: float = 0.0,
    rest: float = 0.0,
    previous_rest: float = 0.0,
    changed: float = 0.0,
) -> (frame: int) {
    frame = ifloor(time + phase + rest + previous_rest + changed) % count
}
";

struct Folder(BTreeMap<String, String>);

impl Loader for Folder {
    fn load(&self, path: &str) -> Result<String, String> {
        self.0.get(path).cloned().ok_or_else(|| "there is no such file".to_owned())
    }
}

fn examples() -> Folder {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/design");
    let entries = fs::read_dir(folder).expect("the folder is there");
    let files = entries.map(|entry| {
        let path = entry.expect("it can be read").path();
        let mut text = fs::read_to_string(&path).expect("it can be read");
        for (constructor, stand_in) in STAND_INS {
            text = text.replace(constructor, stand_in);
        }
        (path.file_name().and_then(|name| name.to_str()).unwrap_or_default().to_owned(), text)
    });
    Folder(files.collect())
}

#[test]
fn nine_examples_check() {
    let library = Library::with(&[("stand_ins.tex", NODES)]).expect("the stand-ins are right");
    let examples = examples();
    assert_eq!(examples.0.len(), 9);
    for name in examples.0.keys() {
        if let Err(errors) = check(&library, name, &examples) {
            panic!("{name}: {}", render::human(&errors.sources, &errors.diagnostics));
        }
    }
}

#[test]
fn what_is_wrong_in_them_is_found() {
    let library = Library::with(&[("stand_ins.tex", NODES)]).expect("the stand-ins are right");
    let mut examples = examples();
    let file = examples.0.get_mut("leaves.tex").expect("the file is there");
    *file =
        file.replace("density: |p| density.sample(p / cells).r", "density: |p| density.sample(p / cells)");
    let errors = check(&library, "leaves.tex", &examples).expect_err("a colour is no density");
    assert_eq!(errors.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["E0201"]);
}
