//! Samples that are merged or moved give the same picture as those that can't be.

use std::path::Path;
use texgraph_compiler::{Compiled, Library, Options, compile, diagnostic::render};
use texgraph_runtime::cpu;
use texgraph_runtime::picture::Picture;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::load;

/// Textures with the samples that a pixel takes at most. `same` is one picture in all places, in the
/// twin another one in each: two pictures are never sampled as one.
const TEXTURES: &[(&str, &str, usize)] = &[
    (
        "arms",
        "color = if uv.x > 0.5 { ONE.sample(uv * 3.0) * 0.5 } else { 1.0 - TWO.sample(uv.yx * 2.0) }",
        1,
    ),
    (
        "chain",
        "color = if uv.x > 0.7 { ONE.sample(uv * 3.0) } else if uv.y > 0.5 { TWO.sample(uv) } else { THREE.sample(-uv) }",
        1,
    ),
    (
        "several",
        "color = if uv.x > 0.3 { mix(ONE.sample(uv), ONE.sample(uv * 5.0), uv.y) } else { TWO.sample(uv * 0.5) }",
        2,
    ),
    (
        "dependent",
        "let first = ONE.sample(uv)\n color = if uv.x > 0.3 { ONE.sample(first.rg) } else { TWO.sample(TWO.sample(uv * 2.0).rg + first.b) }",
        3,
    ),
    ("loops", "color = if uv.x > uv.y { total(ONE, uv) } else { total(TWO, uv.yx) }", 1),
    ("calls", "color = if uv.x > uv.y { twice(ONE, uv) } else { twice(TWO, uv.yx * 3.0) }", 2),
    (
        "winner",
        "let (cell, at) = tile_map(uv, 6)
        let win = fold (best = -1.0, color = vec4(0.2, 0.3, 0.4, 1.0)) for k in ivec2(-1)..=ivec2(1) {
            let r = virtual_random(cell + k)
            let place = at - k - r.xy + 0.5
            let wins = max(abs(place.x - 0.5), abs(place.y - 0.5)) < 0.5 && r.z > best
            best  = if wins { r.z } else { best }
            color = if wins { ONE.sample(place) } else { color }
        }
        color = win.color",
        1,
    ),
    (
        "last_of_two",
        "let win = fold (color = vec4(0.0), other = vec4(1.0)) for i in 0..7 {
            let wins = hash(ifloor(uv * 9.0), seed: i).x > 0.7
            color = if !wins { color } else { ONE.sample(uv * float(i + 1), lod: uv.x * 4.0) }
            other = if uv.x < 0.1 * float(i) { other } else { TWO.sample(uv + 0.1 * float(i)) }
        }
        color = mix(win.color, win.other, 0.5)",
        2,
    ),
    (
        "early",
        "let win = fold (best = -1.0, color = vec4(0.0)) for i in 0..9 while best < 0.9 {
            let r = hash(ifloor(uv * 9.0), seed: i).x
            best  = max(r, best)
            color = if r > best { ONE.sample(uv * r) } else { color }
        }
        color = win.color",
        1,
    ),
    // One condition, whose inputs are those of two loops: their samples stay in them.
    (
        "two_early",
        "let win = fold (best = -1.0, color = vec4(0.0)) for i in 0..9 while best < 0.9 {
            let r = hash(ifloor(uv * 9.0), seed: i).x
            best  = max(r, best)
            color = if r > best { ONE.sample(uv * r) } else { color }
        }
        let sum = fold (best = -1.0, color = vec4(0.0)) for i in 0..9 while best < 0.9 {
            best  = best + 0.3 * uv.x
            color = color * 0.5 + 0.1
        }
        let last = fold (best = -1.0, color = vec4(0.0)) for i in 0..9 while best < 0.9 {
            let r = hash(ifloor(uv * 9.0), seed: i + 100).x
            best  = best + r
            color = if r < 0.5 { ONE.sample(uv + r, lod: r) } else { color }
        }
        color = (win.color + sum.color + last.color) / 3.0",
        2,
    ),
];

/// A loop, and a node that stays a function.
const NODES: &str = "
node total(p: image, at: vec2) -> (sum: vec4) {
    sum = fold (s = vec4(0.0)) for i in 0..9 { s = s + p.sample(at * float(i)) * 0.1 }
}

node twice(p: image, at: vec2) -> (sum: vec4) {
    let once = p.sample(at)
    sum = 0.5 * (once + p.sample(at + once.rg))
}
";

/// What keeps a winner's sample where it is: something else reads it.
const READ: &str = "color.w > -1.0 {";

fn program(name: &str, body: &str, is_merged: bool) -> String {
    let mut body = body.to_owned();
    for (word, twin) in [("ONE", "one"), ("TWO", "two"), ("THREE", "three")] {
        body = body.replace(word, if is_merged { "one" } else { twin });
    }
    if !is_merged && body.contains("color = vec4") {
        let joined = if body.contains(" while ") { "&&" } else { "while" };
        body = body.replacen(" {\n", &format!(" {joined} {READ}\n"), 1);
        body = body.replacen("if uv.x < 0.1", "if other.w < -1.0 || uv.x < 0.1", 1);
    }
    let images =
        ["one", "two", "three"].map(|name| format!("let {name} = image(\"photos/rock.jpg\")\n")).concat();
    format!("{images}{NODES}\ntexture {name}(uv: vec2) -> (color: color) {{\n    {body}\n}}\n")
}

fn picture(text: &str) -> (Compiled, Picture) {
    let folder = tempfile::tempdir().expect("a folder");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/photos/rock.jpg");
    std::fs::create_dir(folder.path().join("photos")).expect("a folder in it");
    std::fs::copy(root, folder.path().join("photos/rock.jpg")).expect("the picture");
    let file = folder.path().join("t.tex");
    std::fs::write(&file, text).expect("the program");
    let (library, project) = (Library::standard().expect("the library"), Project::new(&file, false));
    let compiled = compile(&library, project.main(), &project, &Options::default());
    let mut compiled = compiled.unwrap_or_else(|f| panic!("{}", render::human(&f.sources, &f.diagnostics)));
    let tables = load(&mut compiled.program, &project).expect("the tables");
    let picture = cpu::render(&compiled.program, &tables, &Request::new([120, 90]), &|_| {});
    (compiled, picture.expect("a picture"))
}

#[test]
fn merged_samples_give_the_same_picture() {
    for (name, body, samples) in TEXTURES {
        let (merged, picture_of_merged) = picture(&program(name, body, true));
        let (twin, picture_of_twin) = picture(&program(name, body, false));
        let count = |compiled: &Compiled| compiled.program.texture().wgsl.matches("textureSample").count();
        assert_eq!(count(&merged), *samples, "{name}:\n{}", merged.program.texture().wgsl);
        assert!(count(&twin) >= *samples, "{name}:\n{}", twin.program.texture().wgsl);
        let difference = picture_of_merged.difference(&picture_of_twin, 0.0);
        assert_eq!(picture_of_merged, picture_of_twin, "{name}: {difference:?}");
        let first = picture_of_merged.pixels[0];
        assert!(picture_of_merged.pixels.iter().any(|pixel| *pixel != first), "{name} proves nothing");
    }
}
