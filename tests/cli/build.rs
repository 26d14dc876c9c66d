//! `build`: files that agree with each other, all of them or none.

use crate::workshop::{PLAIN, WRONG, Workshop, examples};
use std::fs;
use texgraph_compiler::Manifest;
use texgraph_compiler::manifest::{Argument, Form, Gradients};

const TWO: &str = "let order = permutation(16)\n\ntexture first(uv: vec2) -> (height: float) {\n    height = float(order.at(ifloor(uv.x * 16.0)).x)\n}\n\ntexture second(uv: vec2) -> (color: color) {\n    color = vec4(uv, 0.0, 1.0)\n}\n";

#[test]
fn tables_agree_with_the_manifest() {
    let shop = Workshop::new(&[]);
    let file = examples().join("tiling.tex");
    let run = shop.run(&["build".as_ref(), file.as_os_str(), "-o".as_ref(), "new/out".as_ref()]);
    assert!(run.is_done(), "{run:#?}");
    let manifest = Manifest::from_ron(&shop.text("new/out/tiling.ron")).expect("a manifest");
    assert_eq!(manifest.passes[0].shader, "tiling.wgsl");
    assert!(shop.text("new/out/tiling.wgsl").contains(&manifest.passes[0].entry_point));
    let mut files = vec!["tiling.ron".to_owned(), "tiling.wgsl".to_owned()];
    for texture in manifest.textures() {
        let table = texture.table.as_ref().expect("a table");
        let file = table.file.clone().expect("a file");
        let bytes = shop.read(&format!("new/out/{file}"));
        assert!(bytes.starts_with(b"\xabKTX 20\xbb\r\n\x1a\n"), "{file}");
        // The largest level stands last.
        let first = table.levels.first().expect("a level");
        assert_eq!(bytes.len() as u64, first.offset + first.bytes(table.format), "{file}");
        let key = table.key.as_deref().expect("a key").as_bytes();
        assert!(bytes[..1024].windows(key.len()).any(|part| part == key), "{file}");
        files.push(file);
    }
    files.sort();
    assert!(files.contains(&"tiling.grass.layers.ktx2".to_owned()), "{files:?}");
    let found = fs::read_dir(shop.path("new/out")).expect("the folder is read").flatten();
    let mut found: Vec<String> =
        found.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    found.sort();
    assert_eq!(found, files);
}

#[test]
fn every_texture_or_the_named_one() {
    let shop = Workshop::new(&[("two.tex", TWO)]);
    assert!(shop.run(&["build", "two.tex", "-o", "all"]).is_done());
    let names = ["first.tables.table.ktx2", "first.ron", "first.wgsl", "second.ron", "second.wgsl"];
    for name in names {
        assert!(!shop.read(&format!("all/{name}")).is_empty(), "{name}");
    }
    assert!(shop.run(&["build", "two.tex", "--texture", "second"]).is_done());
    assert_eq!(shop.names(), ["all", "second.ron", "second.wgsl", "two.tex"]);
    shop.run(&["build", "two.tex", "--texture", "third"]).fails(1, "`third`");
}

#[test]
fn the_host_chooses_form_bindings_and_format() {
    let shop = Workshop::new(&[("two.tex", TWO)]);
    let arguments =
        ["build", "two.tex", "--form", "library", "--manifest=json", "--group=2", "--first-binding=7"];
    assert!(shop.run(&arguments).is_done());
    let manifest = Manifest::from_json(&shop.text("first.json")).expect("a manifest");
    assert_eq!(manifest.form, Form::Library);
    let bindings: Vec<_> = manifest.textures().map(|texture| (texture.group, texture.binding)).collect();
    assert_eq!(bindings, [(2, 7)]);
    let wgsl = shop.text("first.wgsl");
    assert!(!wgsl.contains("@fragment") && wgsl.contains("@group(2) @binding(7)"), "{wgsl}");
}

#[test]
fn functions_bind_nothing_and_say_how_they_are_called() {
    let shop = Workshop::new(&[("two.tex", TWO)]);
    assert!(shop.run(&["build", "two.tex", "--form", "functions"]).is_done());
    let manifest = Manifest::from_ron(&shop.text("first.ron")).expect("a manifest");
    assert_eq!((manifest.form, &manifest.uniform), (Form::Functions, &None));
    let pass = &manifest.passes[0];
    let call = pass.call.as_ref().expect("a call");
    let read = manifest.resources.iter().position(|resource| !resource.textures.is_empty());
    let read = read.expect("a resource with a texture") as u32;
    let arguments = [Argument::Input("uv".into()), Argument::Texture(read, "table".into())];
    assert_eq!((call.arguments.as_slice(), &call.members), (arguments.as_slice(), &None));
    let wgsl = shop.text("first.wgsl");
    let head = format!("fn {}(uv: vec2<f32>, ", pass.entry_point);
    assert!(!wgsl.contains('@') && wgsl.contains(&head), "{wgsl}");
}

#[test]
fn derivatives_are_taken_passed_or_done_without() {
    let slope = "texture slope(uv: vec2) -> (x: float) {\n    x = dx(uv.x * uv.y)\n}\n";
    let shop = Workshop::new(&[("slope.tex", slope)]);
    let built = |gradients: &str| {
        assert!(shop.run(&["build", "slope.tex", "--form=library", "--gradients", gradients]).is_done());
        let manifest = Manifest::from_ron(&shop.text("slope.ron")).expect("a manifest");
        let given: Vec<String> = manifest.gradients.iter().map(|one| one.name.clone()).collect();
        let wgsl = shop.text("slope.wgsl");
        (manifest.passes[0].gradients, given, wgsl.contains("dpdx"), wgsl.contains("gradients.uv_dx"))
    };
    assert_eq!(built("derive"), (Gradients::Derive, vec![], true, false));
    assert_eq!(built("argument"), (Gradients::Argument, vec!["uv_dx".into()], false, true));
    assert_eq!(built("none"), (Gradients::None, vec![], false, false));
}

#[test]
fn an_error_leaves_the_old_files() {
    let shop = Workshop::new(&[("a.tex", PLAIN)]);
    assert!(shop.run(&["build", "a.tex"]).is_done());
    let old = (shop.read("plain.wgsl"), shop.read("plain.ron"));
    let unreadable = "\n\nlet gone = image(\"gone.png\")\n\ntexture late(uv: vec2) -> (color: color) {\n    color = gone.sample(uv)\n}\n";
    shop.write("a.tex", PLAIN.replace("uv.y", "0.25") + unreadable);
    let run = shop.run(&["build", "a.tex"]);
    run.fails(1, "gone.png");
    run.fails(1, "─ a.tex:9:");
    assert_eq!((shop.read("plain.wgsl"), shop.read("plain.ron")), old);
    assert_eq!(shop.names(), ["a.tex", "plain.ron", "plain.wgsl"]);
}

#[test]
fn textures_share_one_error() {
    let read =
        |name: &str| format!("texture {name}(uv: vec2) -> (color: color) {{ color = gone.sample(uv) }}\n");
    let program = format!("let gone = image(\"gone.png\")\n{}{}", read("a"), read("b"));
    let shop = Workshop::new(&[("a.tex", &program)]);
    let run = shop.run(&["build", "a.tex", "--message-format=short"]);
    run.fails(1, "a.tex:1:");
    assert_eq!(run.err.lines().count(), 1, "{run:#?}");
}

#[test]
fn what_can_not_be_built() {
    let shop = Workshop::new(&[("empty.tex", "let a = 1\n"), ("wrong.tex", WRONG), ("a.tex", PLAIN)]);
    shop.run(&["build", "empty.tex"]).fails(1, "no texture");
    shop.run(&["build", "wrong.tex"]).fails(1, "wrong.tex:2:");
    shop.run(&["build", "a.tex", "-o", "wrong.tex"]).fails(3, "a file has this name");
    shop.run(&["build", "a.tex", "--group", "9"]).fails(2, "9 is not in 0..=7");
    shop.run(&["build", "a.tex", "--first-binding", "4294967295"]).fails(2, "4294967295");
    shop.write("blocked/plain.ron/x", "");
    shop.run(&["build", "a.tex", "-o", "blocked"]).fails(3, "it is a folder");
    assert!(!shop.path("blocked/plain.wgsl").exists());
    assert_eq!(shop.names(), ["a.tex", "blocked", "empty.tex", "wrong.tex"]);
}

#[test]
fn pictures_stay_in_the_folder() {
    let program = "let out = image(\"../grass.png\")\n\ntexture t(uv: vec2) -> (color: color) {\n    color = out.sample(uv)\n}\n";
    let shop = Workshop::new(&[("sub/a.tex", program)]);
    shop.write("grass.png", fs::read(examples().join("tiles/grass.png")).expect("a picture"));
    shop.run(&["build", "sub/a.tex"]).fails(1, "E0502");
    assert!(shop.run(&["build", "sub/a.tex", "--allow-outside"]).is_done());
}

#[test]
fn pixels_that_cover_too_little_are_discarded_where_a_host_tests_alpha() {
    let shop = Workshop::new(&[("two.tex", TWO)]);
    assert!(shop.run(&["build", "two.tex", "--texture=second", "--discard-below", "0.25"]).is_done());
    let manifest = Manifest::from_ron(&shop.text("second.ron")).expect("a manifest");
    assert_eq!(manifest.discard_below, Some(0.25));
    let wgsl = shop.text("second.wgsl");
    assert!(wgsl.contains("< 0.25f") && wgsl.contains("discard;"), "{wgsl}");
    let library = ["build", "two.tex", "--texture=second", "--form=library", "--discard-below=0.25"];
    shop.run(&library).fails(2, "--form complete");
    shop.run(&["build", "two.tex", "--texture=first", "--discard-below=0.25"]).fails(2, "no output `color`");
    shop.run(&["build", "two.tex", "--texture=second", "--discard-below=2"]).fails(2, "from 0 to 1");
}

#[test]
fn levels_can_be_worked_out_in_the_shader() {
    let shop = Workshop::new(&[("photo.tex", PHOTO)]);
    image::RgbImage::new(8, 8).save(shop.path("photo.png")).expect("a picture");
    for (form, entry) in [("complete", "@fragment"), ("library", "fn "), ("functions", "fn ")] {
        let form = format!("--form={form}");
        assert!(shop.run(&["build", "photo.tex", &form]).is_done());
        assert!(shop.text("t.wgsl").contains("textureSampleGrad("));
        assert!(shop.run(&["build", "photo.tex", &form, "--exact-levels"]).is_done());
        let exact = shop.text("t.wgsl");
        assert!(exact.contains("textureSampleLevel(") && !exact.contains("textureSampleGrad("), "{exact}");
        assert!(exact.contains(entry));
    }
}

const PHOTO: &str = "texture t(uv: vec2) -> (color: color) {
    let photo = image(\"photo.png\")
    color = photo.sample(uv * 4.0)
}
";
