//! A program that draws a positions map, as it is and through a bake.

use super::write_picture;
use std::collections::HashMap;
use std::path::Path;
use texgraph_compiler::{Library, Options, Program, compile, diagnostic::render};
use texgraph_runtime::project::Project;
use texgraph_runtime::resource::positions::{Positions, Sprite, open};
use texgraph_runtime::resource::{Tables, load};

const TEXT: &str = "let leaf = patterns(\"leaf.png\", grid: ivec2(2, 1))
let decals = positions(\"decals.ron\", grid: ivec2(6, 5), patterns: leaf, layers: 2)
let baked = bake(|at| decals.positioned(at), size: ivec2(64))

texture t(uv: vec2) -> (color: color) {
    color = if uv.x < 1.0 { decals.positioned(uv) } else { baked.sample(uv) }
}
";

/// The index of the map among the program's resources.
pub const DECALS: usize = 1;

/// The program in a folder, with the map of a file with these sprites.
pub fn decals(folder: &Path, sprites: &[Sprite]) -> (Program, Tables, Positions) {
    write_picture(
        &folder.join("leaf.png"),
        [32, 16],
        &(0..32 * 16 * 4).map(|i| (i * 37 % 251) as u8).collect::<Vec<_>>(),
    );
    let sprite = |s: &Sprite| {
        let [x, y] = s.at;
        format!("(pattern: {}, at: ({x:?}, {y:?}), scale: {:?}, turn: {:?}),\n", s.pattern, s.scale, s.turn)
    };
    let text: String = sprites.iter().map(sprite).collect();
    std::fs::write(folder.join("decals.ron"), format!("[\n{text}]\n")).expect("the folder can be written");
    let project = Project::new(&folder.join("t.tex"), false);
    let files: HashMap<String, String> = [("t.tex".to_owned(), TEXT.to_owned())].into();
    let library = Library::standard().expect("the library parses");
    let compiled = compile(&library, "t.tex", &files, &Options::default());
    let mut program =
        compiled.unwrap_or_else(|f| panic!("{}", render::human(&f.sources, &f.diagnostics))).program;
    let tables = load(&mut program, &project).unwrap_or_else(|found| panic!("{found:?}"));
    let map = open(&program, &project, "decals").unwrap_or_else(|found| panic!("{found:?}"));
    (program, tables, map)
}

/// Sprites before and after an edit: one moves, one goes, one comes.
pub fn edited(map: &mut Positions) -> Vec<Sprite> {
    let known: Vec<_> = map.sprites().collect();
    let (first, second) = (known[0], known[1]);
    let moved = Sprite { at: [0.61, 0.4], turn: 0.3, scale: 0.7, ..first.1 };
    map.place(first.0, moved).expect("there is room");
    map.remove(second.0).expect("it was there");
    let new = Sprite { pattern: 1, at: [0.02, 0.97], scale: 1.0, turn: 0.0 };
    map.insert(new).expect("there is room");
    let rest = known[2..].iter().map(|(_, sprite)| *sprite);
    std::iter::once(moved).chain(rest).chain([new]).collect()
}

/// Sprites to begin with.
pub const SPRITES: [Sprite; 3] = [
    Sprite { pattern: 0, at: [0.3, 0.3], scale: 1.0, turn: 0.0 },
    Sprite { pattern: 1, at: [0.8, 0.7], scale: 0.6, turn: 0.1 },
    Sprite { pattern: 1, at: [0.35, 0.32], scale: 0.7, turn: 0.4 },
];
