//! Imports and names, each sentence of docs/language.md's paragraphs **Imports** and **Names** by a
//! test of its own.

use std::collections::HashMap;
use texgraph_compiler::diagnostic::render;
use texgraph_compiler::{Compiled, Failure, Library, Options, check, compile};
use texgraph_runtime::settings::Settings;

/// The first file is the main one.
type Files<'a> = &'a [(&'a str, &'a str)];

fn texts(files: Files) -> HashMap<String, String> {
    files.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect()
}

fn library() -> Library {
    Library::standard().expect("the library is right")
}

fn compiled(files: Files) -> Compiled {
    let checked = check(&library(), files[0].0, &texts(files));
    checked.unwrap_or_else(|failure| panic!("{}", page(&failure)));
    compile(&library(), files[0].0, &texts(files), &Options::default())
        .unwrap_or_else(|failure| panic!("{}", page(&failure)))
}

fn page(failure: &Failure) -> String {
    render::human(&failure.sources, &failure.diagnostics)
}

/// Each error as its code and what it underlines, with the file.
fn errors(files: Files) -> Vec<(&'static str, String)> {
    let failure = check(&library(), files[0].0, &texts(files)).expect_err("something is wrong");
    let found = failure.diagnostics.iter().map(|diagnostic| {
        let source = failure.sources.get(diagnostic.place).expect("a place lies in a text");
        (diagnostic.code, format!("{}: {}", source.path, &source.text[diagnostic.place.span.range()]))
    });
    found.collect()
}

fn error(files: Files) -> (&'static str, String) {
    let mut errors = errors(files);
    assert_eq!(errors.len(), 1, "{errors:?}");
    errors.remove(0)
}

/// A texture of one line.
fn texture(color: &str) -> String {
    format!("texture t(uv: vec2) -> (color: color) {{\n    color = {color}\n}}\n")
}

fn main_file(uses: &str, color: &str) -> String {
    format!("{uses}\n\n{}", texture(color))
}

fn params(compiled: &Compiled) -> Vec<&str> {
    compiled.program.manifest.params.iter().map(|param| param.name.as_str()).collect()
}

const STONE: (&str, &str) = (
    "stone.tex",
    "param scale: float = 4.0 in 0.0..=8.0\n\nlet tint = #80c0ff\n\nlet sigma = permutation(16, seed: 1)\n\n\
     node layer(p: vec2) -> (value: float) {\n    value = fract(p.x * scale)\n}\n",
);

/// "`use … as s` gives `s.node(…)`, `s.resource`, and the param `s.scale`": values, resources, params
/// and nodes of an import by its name, in expressions and for hosts.
#[test]
fn an_alias_gives_nodes_resources_and_params() {
    let main = main_file(
        "use \"stone.tex\" as s",
        "s.tint * s.layer(uv) + vec4(s.sigma.at(ifloor(uv.x)).x) * s.scale",
    );
    let compiled = compiled(&[("main.tex", &main), STONE]);
    assert_eq!(params(&compiled), ["s.scale"]);
    assert!(compiled.program.texture().wgsl.contains("s_scale"), "{}", compiled.program.texture().wgsl);
    let manifest = &compiled.program.manifest;
    let mut settings = Settings::new();
    settings.parse(manifest, "s.scale=2").expect("the param goes by the alias");
    assert_eq!(format!("{:?}", settings.value(&manifest.params[0])), "Float([2.0])");
    assert!(settings.parse(manifest, "scale=2").is_err(), "the bare name is no param");
    assert_eq!(manifest.resources[0].name, "s.sigma", "resources go by the alias too");
}

/// "Without a name the file's items join ours".
#[test]
fn items_of_an_unnamed_import_join() {
    let main = main_file("use \"stone.tex\"", "tint * layer(uv) + vec4(sigma.at(ifloor(uv.x)).x) * scale");
    assert_eq!(params(&compiled(&[("main.tex", &main), STONE])), ["scale"]);
}

/// "… they are not passed on to who imports us", neither by name nor through an alias.
#[test]
fn joined_items_are_not_passed_on() {
    let middle = (
        "middle.tex",
        "use \"stone.tex\"\n\nnode half(p: vec2) -> (value: float) {\n    value = layer(p) * 0.5\n}\n",
    );
    let right = main_file("use \"middle.tex\"", "vec4(half(uv))");
    compiled(&[("main.tex", &right), middle, STONE]);
    let wrong = main_file("use \"middle.tex\"", "vec4(layer(uv))");
    assert_eq!(error(&[("main.tex", &wrong), middle, STONE]), ("E0102", "main.tex: layer".into()));
    let wrong = main_file("use \"middle.tex\"", "vec4(half(uv)) * tint");
    assert_eq!(error(&[("main.tex", &wrong), middle, STONE]), ("E0101", "main.tex: tint".into()));
    let wrong = main_file("use \"middle.tex\" as m", "vec4(m.layer(uv))");
    assert_eq!(error(&[("main.tex", &wrong), middle, STONE]), ("E0605", "main.tex: layer".into()));
    let wrong = main_file("use \"middle.tex\" as m", "m.tint");
    assert_eq!(error(&[("main.tex", &wrong), middle, STONE]), ("E0605", "main.tex: tint".into()));
}

/// An alias is not an item: who imports us does not see it.
#[test]
fn aliases_are_not_passed_on() {
    let middle = ("middle.tex", "use \"stone.tex\" as s\n\nlet twice = 2.0\n");
    let wrong = main_file("use \"middle.tex\" as m", "vec4(m.s.tint)");
    assert_eq!(error(&[("main.tex", &wrong), middle, STONE]), ("E0605", "main.tex: s".into()));
    let wrong = main_file("use \"middle.tex\"", "s.tint * twice");
    assert_eq!(error(&[("main.tex", &wrong), middle, STONE]), ("E0101", "main.tex: s".into()));
}

/// "… a clash is an error at the second `use`", for nodes and for values; with an item of our own it
/// is an error at that.
#[test]
fn a_clash_is_an_error_at_the_second_use() {
    let brick =
        ("brick.tex", "let tint = #804020\n\nnode layer(p: vec2) -> (value: float) {\n    value = p.y\n}\n");
    let main = main_file("use \"stone.tex\"\nuse \"brick.tex\"", "vec4(layer(uv))");
    assert_eq!(error(&[("main.tex", &main), STONE, brick]), ("E0603", "main.tex: \"brick.tex\"".into()));
    let values = ("values.tex", "let tint = 1.0\n");
    let main = main_file("use \"values.tex\"\nuse \"stone.tex\"", "vec4(layer(uv))");
    assert_eq!(error(&[("main.tex", &main), STONE, values]), ("E0603", "main.tex: \"stone.tex\"".into()));
    let main = main_file("use \"stone.tex\"\n\nlet tint = 1.0", "vec4(layer(uv))");
    assert_eq!(error(&[("main.tex", &main), STONE]), ("E0603", "main.tex: tint".into()));
    let main =
        main_file("use \"stone.tex\" as s\nuse \"brick.tex\"", "vec4(layer(uv), s.layer(uv), 0.0, 1.0)");
    compiled(&[("main.tex", &main), STONE, brick]);
}

/// The same file twice is no clash.
#[test]
fn a_file_does_not_clash_with_itself() {
    let main = main_file("use \"stone.tex\"\nuse \"./stone.tex\"", "vec4(layer(uv))");
    assert_eq!(params(&compiled(&[("main.tex", &main), STONE])), ["scale"]);
}

/// A prefix means one thing.
#[test]
fn an_alias_is_one_file_and_no_value() {
    let main = main_file("use \"stone.tex\" as s\nuse \"brick.tex\" as s", "vec4(s.layer(uv))");
    let brick = ("brick.tex", "let tint = #804020\n");
    assert_eq!(error(&[("main.tex", &main), STONE, brick]), ("E0604", "main.tex: s".into()));
    let main = main_file("use \"stone.tex\" as s\n\nlet s = #804020", "vec4(s.layer(uv))");
    assert_eq!(error(&[("main.tex", &main), STONE]), ("E0103", "main.tex: s".into()));
    let main = main_file("use \"stone.tex\" as s\n\nparam s: float = 1.0", "vec4(s.layer(uv))");
    assert_eq!(error(&[("main.tex", &main), STONE]), ("E0103", "main.tex: s".into()));
}

/// "One file is one instance however often it is imported": a diamond has the param of its base once,
/// and its resource.
#[test]
fn a_diamond_is_compiled_once() {
    let left = (
        "left.tex",
        "use \"stone.tex\" as base\n\nnode shade(p: vec2) -> (value: float) {\n    value = base.layer(p)\n}\n",
    );
    let right = (
        "right.tex",
        "use \"stone.tex\" as base\n\nnode shade(p: vec2) -> (value: float) {\n    value = base.layer(p.yx) + base.sigma.at(ifloor(p.x)).x\n}\n",
    );
    let main = main_file(
        "use \"left.tex\" as left\nuse \"right.tex\" as right",
        "vec4(left.shade(uv), right.shade(uv), 0.0, 1.0)",
    );
    let compiled = compiled(&[("main.tex", &main), left, right, STONE]);
    assert_eq!(params(&compiled), ["left.base.scale"], "under the first alias in source order");
    let resources = &compiled.program.manifest.resources;
    let permutations = resources.iter().filter(|resource| resource.name.ends_with("sigma"));
    assert_eq!(permutations.count(), 1, "{resources:?}");
    let functions = compiled.program.texture().wgsl.matches("fn layer").count();
    assert!(functions <= 1, "`layer` is one function:\n{}", compiled.program.texture().wgsl);
}

/// "… its params exist once, under the first alias in source order".
#[test]
fn params_go_by_the_first_alias() {
    let main = main_file(
        "use \"stone.tex\" as first\nuse \"stone.tex\" as second",
        "vec4(first.layer(uv), second.layer(uv), first.scale, second.scale)",
    );
    assert_eq!(params(&compiled(&[("main.tex", &main), STONE])), ["first.scale"]);
    // An alias of the main file is nearer than one that only an import has.
    let left = (
        "left.tex",
        "use \"stone.tex\" as base\n\nnode shade(p: vec2) -> (value: float) {\n    value = base.layer(p)\n}\n",
    );
    let main = main_file(
        "use \"left.tex\" as left\nuse \"stone.tex\" as s",
        "vec4(left.shade(uv), s.layer(uv), 0.0, 1.0)",
    );
    assert_eq!(params(&compiled(&[("main.tex", &main), left, STONE])), ["s.scale"]);
    let main =
        main_file("use \"left.tex\"\nuse \"stone.tex\" as s", "vec4(shade(uv), s.layer(uv), 0.0, 1.0)");
    assert_eq!(params(&compiled(&[("main.tex", &main), left, STONE])), ["s.scale"]);
}

/// A file without a texture of its own may be imported by files that hold one, and a texture may be
/// called as a node.
#[test]
fn a_texture_of_another_file_is_a_node() {
    let other = ("other.tex", texture("vec4(uv, 0.0, 1.0)"));
    let main = main_file("use \"other.tex\" as other", "other.t(uv * 2.0)");
    compiled(&[("main.tex", &main), (other.0, &other.1)]);
}

/// Paths are relative to the importing file.
#[test]
fn paths_are_relative_to_the_file_that_imports() {
    let wall = (
        "walls/wall.tex",
        "use \"parts/brick.tex\" as brick\nuse \"../stone.tex\" as stone\n\nnode wall(p: vec2) -> (value: float) {\n    value = brick.layer(p) + stone.layer(p)\n}\n",
    );
    let brick = ("walls/parts/brick.tex", "node layer(p: vec2) -> (value: float) {\n    value = p.y\n}\n");
    let main = main_file("use \"walls/wall.tex\"", "vec4(wall(uv))");
    compiled(&[("main.tex", &main), wall, brick, STONE]);
}

/// "a cycle is an error that names it", at the `use` that closes it, once.
#[test]
fn a_cycle_is_named() {
    let a = ("a.tex", "use \"b.tex\"\n\nlet x = 1.0\n");
    let b = ("b.tex", "use \"c.tex\" as c\n\nlet y = 1.0\n");
    let c = ("c.tex", "use \"a.tex\"\n\nlet z = 1.0\n");
    let files: Files = &[a, b, c];
    assert_eq!(error(files), ("E0602", "c.tex: \"a.tex\"".into()));
    let failure = check(&library(), "a.tex", &texts(files)).expect_err("a cycle");
    assert!(page(&failure).contains("`a.tex` → `b.tex` → `c.tex` → `a.tex`"), "{}", page(&failure));
    let own = ("own.tex", "use \"own.tex\"\n");
    assert_eq!(error(&[own]), ("E0602", "own.tex: \"own.tex\"".into()));
}

/// An error in an imported file is said of that file, once, however often it is imported.
#[test]
fn errors_of_an_import_are_its_own() {
    let broken = ("broken.tex", "node layer(p: vec2) -> (value: float) {\n    value = p.x * grain\n}\n");
    let main = main_file(
        "use \"broken.tex\" as a\nuse \"broken.tex\" as b",
        "vec4(a.layer(uv), b.layer(uv), 0.0, 1.0)",
    );
    assert_eq!(error(&[("main.tex", &main), broken]), ("E0101", "broken.tex: grain".into()));
}

/// "A name before `(` is looked up among callables only … Any other name among values only."
#[test]
fn values_and_nodes_have_names_apart() {
    let main = "node shade(length: float) -> (value: float) {\n    value = length(vec2(length, 1.0))\n}\n\n";
    compiled(&[("main.tex", &format!("{main}{}", texture("vec4(shade(uv.x))")))]);
    let main = "node at(uv: vec2) -> (value: float) {\n    value = uv.x\n}\n\ntexture t(uv: vec2) -> (color: color) {\n    let at = at(uv)\n    color  = vec4(at)\n}\n";
    compiled(&[("main.tex", main)]);
}

/// "`x.name`: an import's item, else a resource's field, a record's output, a swizzle." What a body
/// binds shadows an import.
#[test]
fn inputs_shadow_imports_and_items() {
    let main = "use \"stone.tex\" as s\n\nlet k = 3.0\n\nnode shade(s: vec2, k: float) -> (value: float) {\n    value = s.y * k\n}\n\n";
    compiled(&[("main.tex", &format!("{main}{}", texture("vec4(shade(uv, k)) * s.tint"))), STONE]);
    let main = "use \"stone.tex\" as s\n\n";
    let folded = texture("vec4(fold (s = 0.0) for i in 0..4 {\n        s = s + uv.x * i\n    })");
    compiled(&[("main.tex", &format!("{main}{folded}")), STONE]);
}

/// "A user's name wins over the library's; library files never see users' names."
#[test]
fn a_users_name_wins_and_the_library_does_not_see_it() {
    let own = "node fract(x: vec2) -> (y: vec2) {\n    y = x * 0.0\n}\n\n";
    let plain = texture("vec4(tile_map(uv, 8).at, 0.0, 1.0)");
    let with_own = compiled(&[("main.tex", &format!("{own}{plain}"))]);
    let without = compiled(&[("main.tex", &plain)]);
    assert_eq!(
        with_own.program.texture().wgsl,
        without.program.texture().wgsl,
        "tile_map calls its own `fract`"
    );
    let called = compiled(&[("main.tex", &format!("{own}{}", texture("vec4(fract(uv), 0.0, 1.0)")))]);
    assert!(
        !called.program.texture().wgsl.contains("fract"),
        "ours is called: {}",
        called.program.texture().wgsl
    );
}

/// "… the nearest callable": a user's node is called, and is wrong, even where the library's of that
/// name would take the other arguments.
#[test]
fn a_users_name_wins_whatever_the_other_arguments_are() {
    let own = "node clamp(x: float, low: int, high: int) -> (y: float) {\n    y = x * low * high\n}\n\n";
    let main = format!("{own}{}", texture("vec4(clamp(uv.x, 0.25, 1))"));
    assert_eq!(error(&[("main.tex", &main)]), ("E0201", "main.tex: 0.25".into()));
    // Where the first argument is none of ours, the library's is the nearest that takes it.
    let main = format!("{own}{}", texture("vec4(clamp(uv, 0.25, 1.0), 0.0, 1.0)"));
    compiled(&[("main.tex", &main)]);
}

/// The same for what an import declares.
#[test]
fn an_imports_name_wins_over_the_librarys() {
    let own = ("own.tex", "node fract(x: vec2) -> (y: vec2) {\n    y = x * 0.0\n}\n");
    let main = main_file("use \"own.tex\"", "vec4(fract(uv), 0.0, 1.0)");
    let called = compiled(&[("main.tex", &main), own]);
    assert!(!called.program.texture().wgsl.contains("fract"), "{}", called.program.texture().wgsl);
}

/// "Nodes may share a name when their first inputs differ in resource kind."
#[test]
fn nodes_share_a_name_by_the_kind_of_their_first_input() {
    let main = "let sigma = permutation(16, seed: 1)\nlet tiles = patterns(\"a.png\", grid: ivec2(2, 2))\n\n\
        node pick(p: permutation, i: int) -> (value: float) {\n    value = p.at(i).x\n}\n\n\
        node pick(p: patterns, i: int) -> (value: float) {\n    value = p.reference(i, vec2(0.5)).r\n}\n\n";
    let called = texture("vec4(sigma.pick(3), tiles.pick(1), pick(sigma, 2), pick(tiles, 2))");
    compiled(&[("main.tex", &format!("{main}{called}"))]);
    let twice = "node pick(x: float) -> (value: float) {\n    value = x\n}\n\nnode pick(x: vec2) -> (value: float) {\n    value = x.y\n}\n\n";
    let main = format!("{twice}{}", texture("vec4(pick(uv.x))"));
    assert_eq!(error(&[("main.tex", &main)]), ("E0103", "main.tex: pick".into()));
    // The library's node of that name is still there for its own kind.
    let own = "let sigma = permutation(16, seed: 1)\nlet tiles = patterns(\"a.png\", grid: ivec2(2, 2))\n\n\
        node at(p: patterns, i: int) -> (value: float) {\n    value = p.reference(i, vec2(0.5)).r\n}\n\n";
    let called = texture("vec4(sigma.at(3).x, tiles.at(1), at(sigma, 2).x, at(tiles, 2))");
    compiled(&[("main.tex", &format!("{own}{called}"))]);
}
