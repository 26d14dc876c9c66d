//! `render`: pictures of the wanted size, and refusals that leave the old picture.

use crate::workshop::{PLAIN, Run, WRONG, Workshop, examples, png_size};

/// Renders a.tex to a.png on the CPU, 8 by 4 pixels.
fn render(shop: &Workshop, more: &[&str]) -> Run {
    let mut arguments = vec!["render", "a.tex", "-o", "a.png", "--backend=cpu", "--size=8x4"];
    arguments.extend(more);
    shop.run(&arguments)
}

fn changes(shop: &Workshop, more: &[&str]) -> bool {
    let old = shop.read("a.png");
    let run = render(shop, more);
    assert!(run.is_silent(), "{run:#?}");
    shop.read("a.png") != old
}

#[test]
fn the_example_renders() {
    let shop = Workshop::new(&[]);
    let mut arguments = vec![std::ffi::OsString::from("render"), examples().join("tiling.tex").into()];
    arguments.extend(["-o", "out.png", "--size", "48x32", "--backend", "cpu"].map(Into::into));
    let run = shop.run(&arguments);
    assert!(run.is_silent(), "{run:#?}");
    assert_eq!(png_size(&shop.read("out.png")), [48, 32]);
}

#[test]
fn options_reach_the_picture() {
    let moving =
        PLAIN.replace("(uv: vec2)", "(uv: vec2, time: float)").replace("0.0, 1.0)", "fract(time), 1.0)");
    let shop = Workshop::new(&[("a.tex", &moving)]);
    assert!(render(&shop, &[]).is_silent());
    assert_eq!(png_size(&shop.read("a.png")), [8, 4]);
    assert!(!changes(&shop, &[]));
    assert!(!changes(&shop, &["--output=color", "--set=scale=1"]));
    assert!(changes(&shop, &["--set", "scale=0.5"]));
    assert!(changes(&shop, &["--time=-0.25"]));
    assert!(changes(&shop, &["--region", "1,0,0,1"]));
    assert!(changes(&shop, &["--region", "-1,-1,0,0"]));
    assert!(changes(&shop, &["--output", "height"]));
    assert!(changes(&shop, &["--view", "plane"]));
    assert!(changes(&shop, &["--view=flat", "--repeat=1"]));
    assert!(!changes(&shop, &[]));
}

#[test]
fn a_flat_picture_repeats_as_its_region_says() {
    let shop = Workshop::new(&[("a.tex", PLAIN)]);
    assert!(render(&shop, &["--region", "0,0,2.5,2.5"]).is_silent());
    let region = shop.read("a.png");
    assert!(render(&shop, &["--repeat", "2.5"]).is_silent());
    assert_eq!(shop.read("a.png"), region);
    assert!(render(&shop, &["--repeat", "2.5", "--view", "plane"]).is_silent());
    assert_ne!(shop.read("a.png"), region);
}

#[test]
fn a_texture_is_chosen_behind_a_colon() {
    let two = format!("{PLAIN}\ntexture flat(uv: vec2) -> (height: float) {{\n    height = 0.5\n}}\n");
    let shop = Workshop::new(&[("a.tex", &two)]);
    let run = |file: &str| shop.run(&["render", file, "-o", "a.png", "--backend", "cpu", "--size", "2x2"]);
    assert!(run("a.tex:plain").is_silent());
    let plain = shop.read("a.png");
    assert!(run("a.tex:flat").is_silent());
    assert_ne!(shop.read("a.png"), plain);
    run("a.tex:flatt").fails(1, "`flatt`");
}

#[test]
fn only_the_verbose_say_what_renders() {
    let shop = Workshop::new(&[("a.tex", PLAIN)]);
    let run = render(&shop, &["-v"]);
    assert_eq!((run.code, run.err.as_str()), (0, "rendering on: CPU renderer\n"));
}

#[test]
fn a_gpu_renders_or_is_missed() {
    let shop = Workshop::new(&[("a.tex", PLAIN)]);
    let run = shop.run(&["render", "a.tex", "-o", "a.png", "--backend=gpu", "--size=8x4"]);
    match run.code {
        0 => assert_eq!(png_size(&shop.read("a.png")), [8, 4]),
        _ => {
            run.fails(3, "error: there is no GPU");
            assert_eq!(shop.names(), ["a.tex"]);
        }
    }
}

#[test]
fn wrong_usage() {
    let shop = Workshop::new(&[("a.tex", PLAIN)]);
    shop.write("a.png", "old");
    let cases: &[(&[&str], &str)] = &[
        (&["--size=0x4"], "a side has 1 to 32768 pixels, not `0`"),
        (&["--size=8"], "write width and height as 512x256"),
        (&["--size=99999999999x1"], "a side has 1 to 32768"),
        (&["--size=-8x8"], "a side has 1 to 32768"),
        (&["--region=0,0,1"], "write four numbers"),
        (&["--region=0,0,nan,1"], "`nan` is no finite number"),
        (&["--region=0,0,inf,1"], "`inf` is no finite number"),
        (&["--region=0,0,0,1"], "the region is empty"),
        (&["--view=globe"], "globe"),
        (&["--view=plane", "--region=0,0,2,2"], "the plane takes --repeat"),
        (&["--repeat=2", "--region=0,0,2,2"], "cannot be used with"),
        (&["--repeat=0"], "above 0 and at most 65536"),
        (&["--repeat=nan"], "`nan` is no finite number"),
        (&["--time=nan"], "`nan` is no finite number"),
        (&["--time=1e300"], "`1e300` is too large"),
        (&["--set=scal=2"], "there is no param `scal`; is `scale` meant?"),
        (&["--set=scale"], "write NAME=VALUE"),
        (&["--set=scale=wide"], "`scale` takes a number"),
        (&["--backend=abacus"], "abacus"),
        (&["--frobnicate"], "--frobnicate"),
    ];
    for (arguments, part) in cases {
        // The flag that is under test may stand once only.
        let flag = arguments[0].split('=').next().unwrap_or_default();
        let mut all = vec!["render", "a.tex", "-o", "a.png", "--backend=cpu", "--size=8x4"];
        all.retain(|argument| !argument.starts_with(flag));
        all.extend(*arguments);
        shop.run(&all).fails(2, part);
    }
    shop.run(&["render", "a.tex", "-o", "a.jpg"]).fails(2, "must end in `.png`");
    shop.run(&["render", "a.tex"]).fails(2, "-o <OUT.png>");
    shop.run(&["paint", "a.tex"]).fails(2, "paint");
    assert_eq!(shop.text("a.png"), "old");
    assert_eq!(shop.names(), ["a.png", "a.tex"]);
}

#[test]
fn wrong_input_leaves_the_old_picture() {
    let shop = Workshop::new(&[("a.tex", WRONG)]);
    shop.write("a.png", "old");
    render(&shop, &[]).fails(1, "a.tex:2:");
    shop.write("a.tex", PLAIN);
    render(&shop, &["--output", "colour"]).fails(1, "`colour`");
    let gone = "let gone = image(\"gone.png\")\n\ntexture t(uv: vec2) -> (color: color) {\n    color = gone.sample(uv)\n}\n";
    shop.write("a.tex", gone);
    render(&shop, &[]).fails(1, "there is no file `gone.png`");
    shop.write("gone.png", "this is no picture");
    render(&shop, &["--message-format=short"]).fails(1, "a.tex:1:");
    assert_eq!(shop.text("a.png"), "old");
    assert_eq!(shop.names(), ["a.png", "a.tex", "gone.png"]);
}

#[test]
fn places_that_can_not_be_written() {
    let shop = Workshop::new(&[("a.tex", PLAIN)]);
    let to = |target: &str| shop.run(&["render", "a.tex", "-o", target, "--backend=cpu", "--size=2x2"]);
    to("no/such/a.png").fails(3, "there is no folder `no/such`");
    to("a.tex/a.png").fails(3, "there is no folder `a.tex`");
    shop.write("folder.png/x", "");
    to("folder.png").fails(3, "can't write `folder.png`: it is a folder");
    shop.write("old.png", "old");
    let mut permissions = std::fs::metadata(shop.path("old.png")).expect("a file").permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(shop.path("old.png"), permissions).expect("it is read-only");
    to("old.png").fails(3, "it is read-only");
    assert_eq!(shop.names(), ["a.tex", "folder.png", "old.png"]);
}
