//! Diagrams of small programs, and of all that the repository holds.

use super::layout::{Sheet, place};
use super::{Block, Diagram, DrawError, Kind, MAX_BLOCKS, Rate, diagram};
use crate::Library;
use std::collections::HashMap;
use std::path::Path;

fn library() -> Library {
    Library::standard().expect("the library parses")
}

fn draw(text: &str, name: Option<&str>) -> Diagram {
    let files = HashMap::from([
        ("main.tex".to_owned(), text.to_owned()),
        ("stone.tex".to_owned(), "param grain: float = 2.0\nlet veins = image(\"v.png\")\nnode marble(p: vec2) -> (value: float) { value = p.x * grain }\n".to_owned()),
    ]);
    diagram(&library(), "main.tex", &files, name)
        .unwrap_or_else(|failure| panic!("{:?}", failure.diagnostics))
}

fn texture(body: &str) -> Diagram {
    draw(&format!("texture t(uv: vec2, time: float) -> (color: color) {{ {body} }}"), None)
}

/// The only block of a title.
fn block<'a>(diagram: &'a Diagram, title: &str) -> &'a Block {
    let mut found = diagram.blocks.iter().filter(|block| block.title == title);
    let block = found.next().unwrap_or_else(|| panic!("no `{title}` in {diagram:#?}"));
    assert!(found.next().is_none(), "two `{title}`");
    block
}

/// The wires as `block.output -> block.input`; a formula goes by its text.
fn wires(diagram: &Diagram) -> Vec<String> {
    let name = |block: &Block| match block.title.as_str() {
        "" => block.text.join(" "),
        title => title.split(':').next().unwrap_or_default().to_owned(),
    };
    let mut wires: Vec<String> = diagram
        .wires
        .iter()
        .map(|wire| {
            let (from, to) = (&diagram.blocks[wire.from.block], &diagram.blocks[wire.to.block]);
            let (output, input) = (&from.outputs[wire.from.port], &to.inputs[wire.to.port]);
            format!("{}.{} -> {}.{}", name(from), output.name, name(to), input.name)
        })
        .collect();
    wires.sort();
    wires
}

/// Names and notes of a block's inputs, as written.
fn given(block: &Block) -> Vec<String> {
    block.inputs.iter().map(super::shape::label).collect()
}

#[test]
fn basic_aperiodic_tiling_is_figure_16() {
    let diagram = draw(
        "let grass = patterns(\"g.png\", grid: ivec2(4, 4))\nparam cells: int = 64 in 1..=65536\ntexture tiling(uv: vec2) -> (color: color) {\n    color = grass.reference(pick, at)\n    let pick = virtual_index(cell, grass.count)\n    let (cell, at) = tile_map(uv, cells)\n}\n",
        None,
    );
    assert_eq!(
        wires(&diagram),
        [
            "cells. -> tile_map.cells",
            "grass.count -> virtual_index.count",
            "grass.patterns -> reference.p",
            "reference.color -> color.",
            "tile_map.at -> reference.at",
            "tile_map.cell -> virtual_index.cell",
            "uv. -> tile_map.p",
            "virtual_index.index -> reference.pick",
        ]
    );
    assert_eq!(block(&diagram, "virtual_index").outputs[0].note, "pick");
    // A wire that is called as its port is has no second name.
    assert!(block(&diagram, "tile_map").outputs.iter().all(|port| port.note.is_empty()));
    let rates = ["grass", "cells: int", "tile_map"].map(|title| block(&diagram, title).rate);
    assert_eq!(rates, [Rate::Load, Rate::Draw, Rate::Pixel]);
}

#[test]
fn resources_of_a_dimension_are_called_by_it() {
    let diagram = draw(
        "let bark = patterns<3>(\"b.png\", grid: ivec2(1, 8), depth: 4)\ntexture t(uv: vec2) -> (color: color) {\n    color = bark.tiled(ifloor(vec3(uv, bark.depth)), vec3(uv, 0.5), |c| 0) * steps.at(ifloor(uv.x)) + inside(bark, patterns<1>(\"d.png\"))\n}\nlet steps = indices<1>([0, 1])\nnode inside(p: patterns<3>, line: patterns<1>) -> (color: color) { color = p.average + line.average }\n",
        None,
    );
    let found = wires(&diagram);
    for wire in [
        "bark.depth -> ifloor(vec3(uv, bark.depth)).bark.depth",
        "bark.patterns<3> -> inside.p",
        "bark.patterns<3> -> tiled.p",
        "patterns<1>.patterns<1> -> inside.line",
        "steps.indices<1> -> at.map",
    ] {
        assert!(found.iter().any(|known| known == wire), "{wire}: {found:#?}");
    }
}

#[test]
fn operators_and_functions_are_one_formula() {
    let diagram =
        texture("let a = 0.5 + sin(uv.x * 2.0) /* odd */ *  clamp(uv.y, 0.0, time)\n color = vec4(a)");
    let formula = diagram.blocks.iter().find(|block| block.kind == Kind::Formula).expect("a formula");
    assert_eq!(formula.text.concat().replace("  ", " "), "0.5 + sin(uv.x * 2.0) * clamp(uv.y, 0.0, time)");
    assert_eq!(formula.inputs.len(), 2, "each wire once");
    assert_eq!(formula.outputs[0].note, "a");
    assert_eq!(block(&diagram, "color: color").text, ["= vec4(a)"]);
}

#[test]
fn calls_in_formulas_are_blocks() {
    let diagram = texture("color = hue(uv.x) * hue(time) + hue(0.5)");
    let formula = diagram.blocks.iter().find(|block| block.kind == Kind::Formula).expect("a formula");
    assert_eq!(formula.text, ["hue * hue₂ + hue₃"]);
    let hues: Vec<&Block> = diagram.blocks.iter().filter(|block| block.title == "hue").collect();
    assert_eq!(
        hues.iter().flat_map(|hue| given(hue)).collect::<Vec<_>>(),
        ["turn: uv.x", "turn", "turn: 0.5"]
    );
    assert_eq!(hues.iter().map(|hue| hue.rate).collect::<Vec<_>>(), [Rate::Pixel, Rate::Draw, Rate::Load]);
}

#[test]
fn what_is_not_declared_is_drawn() {
    let diagram = texture(
        "let t = nobody(uv, 3, odd: time)\n let (a, b) = other(t.needed)\n color = t.index.more(b) * t.rgb",
    );
    assert_eq!(given(block(&diagram, "nobody")), ["1", "2: 3", "odd"]);
    assert_eq!(
        wires(&diagram),
        [
            "more * t.rgb. -> color.",
            "more. -> more * t.rgb.more",
            "nobody.index -> more.1",
            "nobody.needed -> more * t.rgb.t",
            "nobody.needed -> other.1",
            "other.b -> more.2",
            "time. -> nobody.odd",
            "uv. -> nobody.1",
        ]
    );
    assert_eq!(block(&diagram, "nobody").outputs[0].note, "t.needed");
}

#[test]
fn choices_show_conditions_and_arms() {
    let diagram =
        texture("color = if uv.x < 0.5 { hue(0.1) } else if uv.y < 0.1 { #102030 } else { hue(time) }");
    let choice = block(&diagram, "choice");
    assert_eq!(given(choice), ["if: uv.x < 0.5", "then", "else if: uv.y < 0.1", "then: #102030", "else"]);
    let short = texture("let a = if uv.x < 0.5 { uv.x } else { time }\n color = vec4(a)");
    assert!(short.blocks.iter().all(|block| block.kind != Kind::Choice), "{short:#?}");
}

#[test]
fn folds_show_starts_captures_and_body() {
    let diagram = texture(
        "let best = fold (hit = uv.x, last = -1.0) for o in ivec2(-1)..=ivec2(0) while last < time {\n let r = hash(o) // chance\n hit = r.x * uv.y\n last = hit }\n color = vec4(best.hit, best.last, 0.0, 1.0)",
    );
    let fold = block(&diagram, "fold o in ivec2(-1)..=ivec2(0)");
    assert_eq!(given(fold), ["hit: uv.x", "last: -1.0", "time", "uv"]);
    assert_eq!(fold.text, ["while last < time", "let r = hash(o)", "hit = r.x * uv.y", "last = hit"]);
    assert_eq!(
        fold.outputs.iter().map(|port| port.note.as_str()).collect::<Vec<_>>(),
        ["best.hit", "best.last"]
    );
}

#[test]
fn nodes_are_passed_over_dashed_wires() {
    let diagram = draw(
        "node lay(p: vec2, stamp: node(at: vec2) -> color) -> (color: color) { color = stamp(p) * more(stamp) }\nnode disc(at: vec2) -> (color: color) { color = vec4(at, at) }\ntexture t(uv: vec2, time: float) -> (color: color) { color = lay(uv, |at| hue(at.x * time)) + lay(uv, disc) }",
        None,
    );
    let lambda = block(&diagram, "|at|");
    assert_eq!(
        (given(lambda), lambda.text.clone()),
        (vec!["time".to_owned()], vec!["hue(at.x * time)".to_owned()])
    );
    let dashed: Vec<&str> = diagram
        .wires
        .iter()
        .filter(|wire| wire.is_node)
        .map(|wire| diagram.blocks[wire.from.block].title.as_str())
        .collect();
    assert_eq!(dashed, ["|at|"]);
    assert!(diagram.blocks.iter().any(|block| given(block) == ["p", "stamp: disc"]), "{diagram:#?}");
    let inside = draw(
        "node lay(p: vec2, stamp: node(at: vec2) -> color) -> (color: color) { color = stamp(p) }",
        Some("lay"),
    );
    assert_eq!(given(block(&inside, "stamp")), ["", "at"]);
    assert_eq!(inside.title, "node lay");
}

#[test]
fn imports_are_followed() {
    let diagram = draw(
        "use \"stone.tex\" as stone\ntexture t(uv: vec2) -> (color: color) { color = stone.veins.sample(uv * stone.grain) * stone.marble(uv) }",
        None,
    );
    assert_eq!(given(block(&diagram, "sample")), ["image", "at"]);
    assert_eq!(block(&diagram, "stone.veins").kind, Kind::Resource);
    assert_eq!(block(&diagram, "stone.grain: float").kind, Kind::Param);
    assert_eq!(block(&diagram, "stone.marble").outputs[0].name, "value");
    let joined = draw(
        "use \"stone.tex\"\ntexture t(uv: vec2) -> (color: color) { color = vec4(marble(uv) * grain) }",
        None,
    );
    assert_eq!(given(block(&joined, "marble")), ["p"]);
}

#[test]
fn rings_and_repeated_names_end() {
    for body in [
        "let a = b\n let b = a\n color = a",
        "color = color",
        "let a = 1\n let a = hue(a)\n color = a\n color = a",
    ] {
        texture(body).to_svg().expect("a picture");
    }
    let text = "let a = b + 1\nlet b = a + 1\ntexture t(uv: vec2) -> (color: color) { color = vec4(a) }";
    draw(text, None).to_svg().expect("a picture");
}

#[test]
fn a_name_that_is_missing_is_an_error_with_a_mend() {
    let files =
        HashMap::from([("main.tex".to_owned(), "node disc(x: float) -> (y: float) { y = x }".to_owned())]);
    let error =
        |name| diagram(&library(), "main.tex", &files, name).expect_err("an error").diagnostics.remove(0);
    let misspelt = error(Some("dics"));
    assert_eq!(misspelt.code, "E0802");
    assert_eq!(misspelt.help.as_deref(), Some("did you mean `disc`?"));
    assert_eq!(error(None).code, "E0801");
}

#[test]
fn large_diagrams_are_bounded_and_written_for_graphviz() {
    let lets: String = (1..=10_000).map(|i| format!("let w{i} = hue(w{}.x)\n", i - 1)).collect();
    let chain = texture(&format!("let w0 = vec4(time)\n{lets} color = w10000"));
    assert_eq!(chain.to_svg(), Err(DrawError::TooLarge(10_004)));
    assert_eq!(chain.to_dot().lines().filter(|line| line.contains(" -> ")).count(), 10_002);
    // Three blocks besides: two inputs and the output.
    let of = |count: usize| {
        let lets: String = (1..count).map(|i| format!("let w{i} = hue(w{}.x)\n", i - 1)).collect();
        texture(&format!("let w0 = hue(time)\n{lets} color = w{}", count - 1))
    };
    assert!(of(MAX_BLOCKS - 3).to_svg().is_ok());
    assert_eq!(of(MAX_BLOCKS - 2).to_svg(), Err(DrawError::TooLarge(MAX_BLOCKS + 1)));
}

/// Programs that nobody would draw: wires from anywhere to anywhere, blocks that nobody reads.
#[test]
fn tangles_are_laid_out_or_refused() {
    let mut state = 7_u64;
    let mut below = |limit: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % limit
    };
    for (blocks, arguments) in [(2, 9), (30, 3), (90, 0), (90, 1), (90, 9), (150, 4), (200, 8)] {
        let mut lets = String::from("let w0 = nobody(uv)\n");
        for i in 1..blocks {
            let read: Vec<String> = (0..arguments).map(|_| format!("w{}", below(i))).collect();
            lets += &format!("let w{i} = nobody({})\n", read.join(", "));
        }
        let diagram = texture(&format!("{lets} color = w{}", below(blocks)));
        match place(&diagram) {
            Ok(sheet) => check_sheet(&format!("{blocks} blocks"), &diagram, &sheet),
            Err(error) => assert_eq!(error, DrawError::TooEntangled(diagram.wires.len()), "{blocks} blocks"),
        }
    }
    let many = (0..800).map(|i| format!("let w{i} = nobody(uv, time)\n")).take(300).collect::<String>();
    let sum: Vec<String> =
        (0..300).flat_map(|i| [format!("w{i}"), format!("w{i}"), format!("w{i}"), format!("w{i}")]).collect();
    let wide = texture(&format!("{many} color = other({})", sum.join(", ")));
    assert_eq!(wide.to_svg(), Err(DrawError::TooEntangled(1801)));
}

#[test]
fn nesting_and_long_chains_fit_the_stack() {
    let nested = format!("color = {}uv.x{}", "hue(".repeat(120), ")".repeat(120));
    assert_eq!(texture(&nested).blocks.len(), 123);
    let chain = format!("color = hue(0.1){}", ".over(#000)".repeat(20_000));
    assert_eq!(texture(&chain).blocks.len(), 20_004);
    let sum = format!("color = {}", vec!["hue(0.1)"; 20_000].join(" + "));
    assert_eq!(texture(&sum).blocks.len(), 20_004);
}

#[test]
fn pictures_hold_no_markup_of_the_author() {
    let diagram = draw(
        "/// <script>alert(1)</script> & \"more\"\ntexture t(uv: vec2) -> (color: color) { color = picture.sample(uv) }\nlet picture = image(\"</text><script>\\u{7}&amp;.png\")",
        None,
    );
    for text in [diagram.to_svg().expect("a picture"), diagram.to_dot()] {
        assert!(!text.contains("<script") && !text.contains("</text><"), "{text}");
        assert!(text.contains("&lt;script&gt;alert(1)&lt;/script&gt; &amp; &quot;more&quot;"), "{text}");
        assert!(!text.chars().any(|c| c.is_control() && c != '\n'), "{text}");
    }
}

/// Every program of the repository: its path and its text.
#[allow(clippy::disallowed_methods, reason = "tests read what the compiler must not")]
fn programs() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut folders: Vec<_> =
        ["examples", "tests/golden", "grammar/tests/data"].map(|folder| root.join(folder)).into();
    let stages = std::fs::read_dir(root.join("tests/errors")).expect("the folder is read").flatten();
    folders.extend(stages.map(|entry| entry.path()).filter(|path| path.is_dir()));
    folders.sort();
    let mut programs = Vec::new();
    for folder in folders {
        let mut files: Vec<_> = std::fs::read_dir(&folder)
            .expect("the folder is read")
            .flatten()
            .map(|entry| entry.path())
            .collect();
        files.sort();
        for file in files.iter().filter(|file| file.extension().is_some_and(|ending| ending == "tex")) {
            let text = String::from_utf8_lossy(&std::fs::read(file).expect("the file is read")).into_owned();
            programs.push((file.display().to_string(), text));
        }
    }
    programs
}

/// Imports of files that are not there are replaced: a diagram has nothing else to ask of them.
fn everything(library: &Library, text: &str) -> Vec<Diagram> {
    let Ok(tree) = texgraph_grammar::parse(text) else { return Vec::new() };
    let mut files = HashMap::from([("main.tex".to_owned(), text.to_owned())]);
    for item in &tree.items {
        if let texgraph_grammar::syntax::ItemKind::Use { path, .. } = &item.kind {
            files.insert(crate::module::resolve("main.tex", &path.value), "let veins = ramp()".to_owned());
        }
    }
    let names = tree.items.iter().filter_map(super::drawn_name);
    names.filter_map(|name| diagram(library, "main.tex", &files, Some(name)).ok()).collect()
}

#[test]
fn every_program_is_drawn_without_overlaps() {
    let library = library();
    let mut drawn = 0;
    for (file, text) in programs() {
        for diagram in everything(&library, &text) {
            let sheet = place(&diagram).unwrap_or_else(|error| panic!("{file}: {error}"));
            check_sheet(&file, &diagram, &sheet);
            assert_eq!(diagram.to_svg(), diagram.clone().to_svg(), "{file}");
            drawn += 1;
        }
    }
    assert!(drawn > 120, "{drawn} diagrams");
}

/// Blocks stand apart and inside the sheet, what begins stands on the left, what ends on the right,
/// and wires run from left to right.
fn check_sheet(file: &str, diagram: &Diagram, sheet: &Sheet) {
    let boxes: Vec<[f64; 4]> = sheet
        .places
        .iter()
        .map(|place| {
            [place.x, place.y, place.x + place.shape.width + place.shape.margin, place.y + place.shape.height]
        })
        .collect();
    for (i, a) in boxes.iter().enumerate() {
        assert!(
            a[0] >= -0.1 && a[1] >= -0.1 && a[2] <= sheet.width + 0.1 && a[3] <= sheet.height + 0.1,
            "{file}"
        );
        for b in &boxes[..i] {
            let is_apart = a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
            assert!(is_apart, "{file}: {a:?} and {b:?} of {}", diagram.title);
        }
    }
    for (wire, stretches) in diagram.wires.iter().zip(&sheet.wires) {
        let [from, to] = [boxes[wire.from.block], boxes[wire.to.block]];
        if wire.from.block == wire.to.block {
            continue;
        }
        // A wrong file may hold a ring.
        let may_run_back = file.contains("tests/errors");
        assert!(may_run_back || from[2] < to[0], "{file}: a wire runs back in {}", diagram.title);
        assert!(stretches.iter().all(|stretch| stretch.from <= stretch.to), "{file}: {stretches:?}");
        for stretch in &stretches[1..stretches.len() - 1] {
            let hits = |b: &&[f64; 4]| {
                stretch.y > b[1] && stretch.y < b[3] && stretch.from < b[2] && b[0] < stretch.to
            };
            assert!(
                !boxes.iter().any(|b| hits(&b)),
                "{file}: a wire runs through a block of {}",
                diagram.title
            );
        }
    }
    let inputs = diagram.blocks.iter().zip(&boxes).filter(|(block, _)| block.kind == Kind::Input);
    let rights: Vec<f64> = inputs.map(|(_, place)| place[2]).collect();
    let outputs = diagram.blocks.iter().zip(&boxes).filter(|(block, _)| block.kind == Kind::Output);
    let lefts: Vec<f64> = outputs.map(|(_, place)| place[0]).collect();
    assert!(rights.iter().all(|x| (x - rights[0]).abs() < 0.1), "{file}: inputs stand together");
    assert!(lefts.iter().all(|x| (x - lefts[0]).abs() < 0.1), "{file}: outputs stand together");
    assert!(boxes.iter().all(|place| lefts.is_empty() || place[0] <= lefts[0]), "{file}: outputs come last");
}
