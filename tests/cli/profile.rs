//! `--profile`: the limits of hosts, and where they put our bindings.

use crate::workshop::Workshop;
use texgraph_compiler::Manifest;

/// A texture that reads so many images.
fn images(count: usize) -> String {
    let lets: String = (0..count).map(|i| format!("let i{i} = image(\"{i}.png\")\n")).collect();
    let sum: Vec<String> = (0..count).map(|i| format!("i{i}.sample(uv)")).collect();
    format!("{lets}\ntexture many(uv: vec2) -> (color: color) {{\n    color = {}\n}}\n", sum.join(" + "))
}

const FIVE: &str = "texture five(uv: vec2) -> (color: color, normal: vec3, roughness: float, metallic: float, height: float) {\n    color     = vec4(uv, 0.0, 1.0)\n    normal    = vec3(0.0, 0.0, 1.0)\n    roughness = uv.x\n    metallic  = 1.0\n    height    = uv.y\n}\n";

#[test]
fn check_and_cost_hold_textures_against_the_host() {
    let shop = Workshop::new(&[("six.tex", &images(6)), ("seven.tex", &images(7))]);
    for command in ["check", "cost"] {
        assert_eq!(shop.run(&[command, "six.tex", "--profile=bevy"]).code, 0);
        assert_eq!(shop.run(&[command, "seven.tex"]).code, 0);
        assert_eq!(shop.run(&[command, "seven.tex", "--profile=compat"]).code, 0);
        let run = shop.run(&[command, "seven.tex", "--profile=bevy"]);
        run.fails(1, "error[E0701]: `many` reads 7 textures, and a material of Bevy has room for 6");
        run.fails(1, "make the images `i0`, `i1` one `patterns([…])`");
        run.fails(1, "seven.tex:9:9");
    }
    shop.run(&["check", "six.tex", "--profile=unity"]).fails(2, "unity");
}

#[test]
fn the_limit_of_every_webgpu_device_is_the_default() {
    let shop = Workshop::new(&[("sixteen.tex", &images(16)), ("seventeen.tex", &images(17))]);
    assert_eq!(shop.run(&["check", "sixteen.tex"]).code, 0);
    shop.run(&["check", "seventeen.tex"]).fails(1, "reads 17 textures, and WebGPU has room for 16");
}

#[test]
fn check_looks_at_every_texture_once() {
    let both = format!(
        "{}{}",
        images(7),
        "texture more(uv: vec2) -> (color: color) {\n    color = i0.sample(uv) + i1.sample(uv) + i2.sample(uv) + i3.sample(uv) + i4.sample(uv) + i5.sample(uv) + i6.sample(uv)\n}\n\ntexture few(uv: vec2) -> (color: color) {\n    color = i0.sample(uv)\n}\n"
    );
    let shop = Workshop::new(&[("both.tex", &both)]);
    let run = shop.run(&["check", "both.tex", "--profile=bevy", "--message-format=short"]);
    let lines: Vec<&str> = run.err.lines().collect();
    assert!(run.code == 1 && lines.len() == 2, "{run:#?}");
    assert!(lines[0].contains("`many`") && lines[1].contains("`more`"), "{run:#?}");
}

#[test]
fn bevy_has_its_bindings() {
    let shop = Workshop::new(&[(
        "a.tex",
        "param s: float = 1.0\n\nlet order = indices([[0, 1]], levels: 2)\n\ntexture a(uv: vec2) -> (height: float) {\n    height = s * float(order.at(ifloor(uv)))\n}\n",
    )]);
    let built = |more: &[&str]| {
        let mut arguments = vec!["build", "a.tex", "--form=library"];
        arguments.extend(more);
        let run = shop.run(&arguments);
        assert!(run.is_done(), "{run:#?}");
        let manifest = Manifest::from_ron(&shop.text("a.ron")).expect("a manifest");
        let uniform = manifest.uniform.clone().expect("a uniform block");
        let textures: Vec<(u32, u32)> = manifest.textures().map(|t| (t.group, t.binding)).collect();
        ((uniform.group, uniform.binding), textures)
    };
    assert_eq!(built(&[]), ((0, 0), vec![(0, 1)]));
    assert_eq!(built(&["--profile=compat"]), ((0, 0), vec![(0, 1)]));
    assert_eq!(built(&["--profile=bevy"]), ((3, 100), vec![(3, 101)]));
    assert_eq!(built(&["--profile=bevy", "--group=2"]), ((2, 100), vec![(2, 101)]));
    assert_eq!(built(&["--profile=bevy", "--group=0", "--first-binding=0"]), ((0, 0), vec![(0, 1)]));
}

#[test]
fn outputs_are_limited_where_each_is_drawn_to() {
    let shop = Workshop::new(&[("five.tex", FIVE)]);
    assert!(shop.run(&["build", "five.tex", "-o", "out"]).is_done());
    let run = shop.run(&["build", "five.tex", "-o", "compat", "--profile=compat"]);
    run.fails(1, "error[E0703]: `five` has 5 outputs");
    assert_eq!(shop.names(), ["five.tex", "out"], "nothing is written");
    assert!(shop.run(&["build", "five.tex", "-o", "out", "--profile=compat", "--form=library"]).is_done());
    assert!(shop.run(&["check", "five.tex", "--profile=compat"]).is_silent());
}

#[test]
fn sizes_are_held_against_the_host_when_they_are_known() {
    let text = "let wide = image(\"wide.png\")\n\ntexture a(uv: vec2) -> (color: color) {\n    color = wide.sample(uv)\n}\n";
    let shop = Workshop::new(&[("a.tex", text)]);
    image::GrayImage::new(4097, 1).save(shop.path("wide.png")).expect("the picture is written");
    assert_eq!(shop.run(&["cost", "a.tex"]).code, 0);
    for command in ["build", "cost"] {
        let run = shop.run(&[command, "a.tex", "--profile=compat"]);
        run.fails(1, "error[E0704]: `wide` has 4097×1 texels");
        run.fails(1, "a.tex:1:12");
    }
    assert_eq!(shop.names(), ["a.tex", "wide.png"]);
    image::GrayImage::new(4096, 1).save(shop.path("wide.png")).expect("the picture is written");
    assert!(shop.run(&["build", "a.tex", "-o", "out", "--profile=compat"]).is_done());
}
