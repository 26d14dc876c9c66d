//! `build` once more: what has not changed is neither made nor written again.

use crate::workshop::{Run, Workshop, examples};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::time::{Duration, SystemTime};
use texgraph_compiler::Manifest;

const TWO: &str = "param scale: float = 1.0 in 0.0..=4.0

let left  = image(\"left.png\")
let right = image(\"right.png\")

texture pair(uv: vec2) -> (color: color) {
    color = left.sample(uv * scale) + right.sample(uv)
}

texture alone(uv: vec2) -> (color: color) {
    color = right.sample(uv)
}
";

const BAKED: &str = "node hills(at: vec2) -> (height: float) {
    height = fbm(at * 4.0)
}

node lit(at: vec2) -> (light: float) {
    light = land.sample(at).r * 2.0
}

let land  = bake(hills, size: 16)
let light = bake(lit, size: 16)

texture map(uv: vec2) -> (height: float) {
    height = light.sample(uv).r
}
";

/// A folder with the program and two pictures, built into `out`.
fn built() -> (Workshop, Run) {
    let shop = Workshop::new(&[("a.tex", TWO)]);
    paint(&shop, "left.png", 10);
    paint(&shop, "right.png", 20);
    let run = build(&shop);
    (shop, run)
}

fn paint(shop: &Workshop, name: &str, grey: u8) {
    image::RgbImage::from_pixel(8, 8, image::Rgb([grey; 3])).save(shop.path(name)).expect("a picture");
}

/// Builds, with all files of the folder older than any that is written.
fn build(shop: &Workshop) -> Run {
    for path in files(shop) {
        let file = File::options().append(true).open(shop.path("out").join(path)).expect("it opens");
        file.set_modified(old()).expect("it has a time");
    }
    let run = shop.run(&["build", "a.tex", "-o", "out"]);
    assert!(run.is_done(), "{run:#?}");
    run
}

fn old() -> SystemTime {
    SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000)
}

fn files(shop: &Workshop) -> BTreeSet<String> {
    let entries = fs::read_dir(shop.path("out")).into_iter().flatten().flatten();
    entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
}

/// The files that the last build has written.
fn written(shop: &Workshop) -> Vec<String> {
    let time = |name: &String| fs::metadata(shop.path("out").join(name)).and_then(|kind| kind.modified());
    files(shop).into_iter().filter(|name| time(name).expect("it has a time") != old()).collect()
}

/// The files of which a run says this.
fn said(run: &Run, verb: &str) -> Vec<String> {
    let lines = run.err.lines().filter_map(|line| line.strip_prefix(verb));
    let names = lines.filter_map(|rest| rest.split([' ', ',']).find(|word| word.contains('.')));
    let mut names: Vec<String> = names.map(str::to_owned).collect();
    names.sort();
    names
}

const LEFT: &str = "pair.left.pixels.ktx2";
const RIGHT: &str = "pair.right.pixels.ktx2";
const ALONE: &str = "alone.right.pixels.ktx2";

#[test]
fn a_picture_of_two_textures_is_made_once() {
    let (shop, run) = built();
    assert_eq!(said(&run, "made"), [LEFT, RIGHT]);
    assert_eq!(said(&run, "copied"), [ALONE]);
    assert_eq!(said(&run, "wrote"), ["alone.ron", "alone.wgsl", "pair.ron", "pair.wgsl"]);
    assert_eq!(shop.read(&format!("out/{RIGHT}")), shop.read(&format!("out/{ALONE}")));
}

#[test]
fn nothing_is_made_or_written_twice() {
    let (shop, _) = built();
    let run = build(&shop);
    assert_eq!(run.err, "kept   all 7 files: nothing has changed\n");
    assert_eq!(written(&shop), [""; 0]);
}

#[test]
fn a_changed_picture_remakes_its_tables_alone() {
    let (shop, _) = built();
    paint(&shop, "left.png", 30);
    let run = build(&shop);
    assert_eq!((said(&run, "made"), said(&run, "copied")), (vec![LEFT.to_owned()], vec![]));
    // The manifest names the new key.
    assert_eq!(written(&shop), [LEFT, "pair.ron"]);
    assert!(run.err.ends_with("kept   5 files that have not changed\n"), "{run:#?}");
}

#[test]
fn a_changed_param_remakes_no_table() {
    let (shop, _) = built();
    shop.write("a.tex", TWO.replace("uv * scale", "uv * scale * 2.0"));
    let run = build(&shop);
    assert_eq!(said(&run, "made"), [""; 0]);
    assert_eq!(written(&shop), ["pair.wgsl"]);
    shop.write("a.tex", TWO.replace("= 1.0 in", "= 2.0 in"));
    build(&shop);
    // Params are the file's, and stand in both manifests.
    assert_eq!(written(&shop), ["alone.ron", "pair.ron", "pair.wgsl"]);
}

#[test]
fn files_that_are_not_as_they_were_written_are_made_again() {
    let (shop, _) = built();
    let whole = shop.read(&format!("out/{LEFT}"));
    let mut other_texel = whole.clone();
    *other_texel.last_mut().expect("a byte") ^= 1;
    let mut other_size = whole.clone();
    other_size[20] = 16;
    let foreign = b"\xabKTX 20\xbb\r\n\x1a\n and no more".to_vec();
    for bad in
        [other_texel, other_size, whole[..whole.len() - 1].to_vec(), whole[..90].to_vec(), foreign, vec![]]
    {
        shop.write(&format!("out/{LEFT}"), &bad);
        let run = build(&shop);
        assert_eq!((said(&run, "made"), written(&shop)), (vec![LEFT.to_owned()], vec![LEFT.to_owned()]));
        assert_eq!(shop.read(&format!("out/{LEFT}")), whole);
    }
}

#[test]
fn a_table_is_found_under_another_name() {
    let (shop, _) = built();
    shop.write("a.tex", TWO.replace("left", "west").replace("west.png", "left.png"));
    let run = build(&shop);
    let renamed = "pair.west.pixels.ktx2".to_owned();
    assert_eq!((said(&run, "made"), said(&run, "copied")), (vec![], vec![renamed]));
    assert_eq!(said(&run, "unused"), [LEFT]);
    assert!(files(&shop).contains(LEFT), "nothing is deleted");
}

#[test]
fn a_missing_picture_is_an_error_although_its_table_is_there() {
    let (shop, _) = built();
    fs::remove_file(shop.path("left.png")).expect("it is removed");
    shop.run(&["build", "a.tex", "-o", "out"]).fails(1, "left.png");
    assert!(shop.run(&["build", "a.tex", "-o", "out", "--texture", "alone"]).is_done());
}

#[test]
fn bakes_are_drawn_again_when_what_they_read_has_changed() {
    let shop = Workshop::new(&[("a.tex", BAKED)]);
    let both = ["map.land.pixels.ktx2", "map.light.pixels.ktx2"];
    let read_alone = &both[1..];
    let first = build(&shop);
    // `land` is read by the other bake, which is read by the texture: both are tables of it.
    assert_eq!(said(&first, "made"), both);
    assert!(build(&shop).err.contains("nothing has changed"));
    shop.write("a.tex", BAKED.replace("* 2.0", "* 3.0"));
    assert_eq!(said(&build(&shop), "made"), read_alone);
    shop.write("a.tex", BAKED.replace("* 4.0", "* 5.0"));
    assert_eq!(said(&build(&shop), "made"), both);
    let run = shop.run(&["build", "a.tex", "-o", "out", "--group", "2"]);
    let moved = ["map.ron", "map.wgsl", "map_light.wgsl"];
    assert_eq!(said(&run, "made"), [""; 0]);
    assert_eq!(said(&run, "wrote"), moved);
}

#[test]
fn both_forms_of_a_compressed_picture_are_kept() {
    let program = "let stone = exemplar(\"rock.jpg\", compress: bc7)

texture rock(uv: vec2) -> (color: color) {
    color = stone.stochastic(uv * 4.0)
}
";
    let shop = Workshop::new(&[("a.tex", program)]);
    let rock = examples().join("photos/rock.jpg");
    shop.write("rock.jpg", fs::read(rock).expect("a picture"));
    let run = build(&shop);
    let made = ["rock.stone.gaussian.ktx2", "rock.stone.gaussian.plain.ktx2", "rock.stone.inverse.ktx2"];
    assert_eq!(said(&run, "made"), made, "{run:#?}");
    let manifest = Manifest::from_ron(&shop.text("out/rock.ron")).expect("a manifest");
    let texture = manifest.textures().next().expect("a texture");
    let name = |table: &Option<_>| -> Option<String> {
        table.as_ref().and_then(|table: &texgraph_compiler::manifest::Table| table.file.clone())
    };
    assert_eq!(
        (name(&texture.table).as_deref(), name(&texture.plain).as_deref()),
        (Some(made[0]), Some(made[1]))
    );
    assert!(build(&shop).err.contains("nothing has changed"));
}

#[test]
fn builds_at_once_leave_whole_files() {
    let (shop, _) = built();
    let before: Vec<Vec<u8>> = files(&shop).iter().map(|name| shop.read(&format!("out/{name}"))).collect();
    fs::remove_dir_all(shop.path("out")).expect("it is removed");
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| assert!(shop.run(&["build", "a.tex", "-o", "out"]).is_done()));
        }
    });
    let after: Vec<Vec<u8>> = files(&shop).iter().map(|name| shop.read(&format!("out/{name}"))).collect();
    assert!(before == after);
}

#[test]
fn only_people_are_told() {
    let (shop, _) = built();
    assert!(shop.run(&["build", "a.tex", "-o", "new", "--quiet"]).is_silent());
    assert!(shop.run(&["build", "a.tex", "-o", "new", "--message-format=json"]).is_silent());
    assert!(shop.run(&["build", "a.tex", "-o", "new", "--message-format=short"]).is_silent());
}

#[test]
fn render_writes_no_table() {
    let (shop, _) = built();
    let before = shop.names();
    let run = shop.run(&["render", "a.tex", "-o", "a.png", "--size=8x8", "--backend=cpu"]);
    assert_eq!(run.code, 0, "{run:#?}");
    let after: Vec<String> = shop.names().into_iter().filter(|name| name != "a.png").collect();
    assert_eq!(after, before);
}
