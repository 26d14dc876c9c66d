//! Every error as its page: `tests/errors/<stage>/<what_is_wrong>.tex` with the page beside it.
//!
//! A file makes one error, or as many as its first line says: `// expect: E0101, E0216`. What needs
//! more than the text is asked for there too: `// ask: texture meadow`, `// ask: output height`,
//! `// ask: load` (the resources), `// ask: large file a.png` (the same beside such a file),
//! `// ask: profile bevy`. A limit is passed by `// repeat: 4097` and a line that ends in
//! `// repeated`; what is asked for then stands in the second line.
//! `INSTA_UPDATE=always` writes the pages anew.

#[path = "errors/support.rs"]
#[allow(dead_code, reason = "shared with the test of the messages")]
mod support;

use std::collections::BTreeSet;
use std::fs;
use support::{Case, codes_in_use, errors_for, errors_of, fenced, root};
use texgraph_compiler::Profile;
use texgraph_compiler::diagnostic::{codes, render};

/// Codes that no file can show: bugs of texgraph.
const BUGS: [&str; 2] = ["E0049", "E0999"];

/// What every step of a text's way to pixels finds.
const STAGES: [&str; 9] =
    ["syntax", "names", "types", "dimensions", "rates", "resources", "limits", "imports", "filtering"];

#[test]
fn every_file_has_its_page() {
    for case in Case::all() {
        let errors = case.errors();
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(case.folder());
        settings.set_prepend_module_to_snapshot(false);
        settings.set_omit_expression(true);
        settings.bind(|| {
            insta::assert_snapshot!(case.name(), render::human(&errors.sources, &errors.diagnostics))
        });
    }
}

#[test]
fn every_page_has_its_file() {
    let cases: BTreeSet<String> =
        Case::all().iter().map(|case| format!("{}/{}", case.stage(), case.name())).collect();
    for stage in support::stages() {
        for snapshot in support::files(&root().join(&stage), "snap") {
            assert!(cases.contains(&format!("{stage}/{snapshot}")), "{stage}/{snapshot}.snap is stale");
        }
    }
}

#[test]
fn one_slip_is_one_error() {
    for case in Case::all() {
        let errors = case.errors();
        let found: Vec<&str> = errors.diagnostics.iter().map(|diagnostic| diagnostic.code).collect();
        match case.expected() {
            Some(expected) => assert_eq!(found, expected, "{}", case.path()),
            None => assert_eq!(found.len(), 1, "{}: {found:?}", case.path()),
        }
    }
}

#[test]
fn errors_stand_in_source_order_and_in_the_text() {
    for case in Case::all() {
        let errors = case.errors();
        assert!(errors.diagnostics.is_sorted_by_key(|diagnostic| diagnostic.place), "{}", case.path());
        for diagnostic in &errors.diagnostics {
            let source = errors.sources.get(diagnostic.place);
            let text = source.and_then(|source| source.text.get(diagnostic.place.span.range()));
            assert!(text.is_some(), "{}: {diagnostic:?}", case.path());
            let words = [&diagnostic.message, &diagnostic.label].into_iter().chain(&diagnostic.help);
            assert!(words.into_iter().all(|words| !words.contains('\n')), "{diagnostic:?}");
        }
    }
}

#[test]
fn every_code_has_a_file() {
    let cases = Case::all();
    let shown: BTreeSet<&str> =
        cases.iter().filter_map(|case| Some(case.errors().diagnostics.first()?.code)).collect();
    let codes = codes_in_use();
    for code in codes.iter().filter(|code| !BUGS.contains(&code.as_str())) {
        assert!(shown.contains(code.as_str()), "{code} has no file in tests/errors");
    }
    assert!(codes.len() >= 70, "{} codes", codes.len());
    let stages: BTreeSet<&str> = cases.iter().map(Case::stage).collect();
    assert!(STAGES.iter().all(|stage| stages.contains(stage)), "{stages:?}");
}

#[test]
fn params_fill_the_uniform_block_of_each_host() {
    for (profile, bytes) in [(Profile::Compat, 16_384), (Profile::Webgpu, 65_536), (Profile::Bevy, 65_536)] {
        let text = |count: usize| {
            let params: String = (0..count).map(|i| format!("param p{i}: vec4 = vec4(0.0)\n")).collect();
            let sum: Vec<String> = (0..count).map(|i| format!("p{i}")).collect();
            format!("{params}texture t(uv: vec2) -> (color: color) {{ color = {} }}\n", sum.join(" + "))
        };
        if let Some(failure) = errors_for(&text(bytes / 16), profile) {
            panic!("{profile:?}: {:?}", failure.diagnostics);
        }
        let failure = errors_for(&text(bytes / 16 + 1), profile).expect("one too many");
        let [error] = failure.diagnostics.as_slice() else { panic!("{:?}", failure.diagnostics) };
        assert_eq!(error.code, "E0702");
        let figures = format!("take {} bytes, and ", bytes + 16);
        assert!(
            error.message.contains(&figures) && error.message.ends_with(&format!("room for {bytes}")),
            "{error:?}"
        );
    }
}

#[test]
fn every_code_has_an_explanation() {
    assert!(codes::PAGES.is_sorted_by(|a, b| a.0 < b.0));
    let listed: BTreeSet<String> = codes::PAGES.iter().map(|(code, _)| (*code).to_owned()).collect();
    assert_eq!(listed, codes_in_use(), "codes with a page, and codes in use");
    for (code, page) in codes::PAGES {
        let title = page.lines().next().and_then(|line| line.strip_prefix("# "));
        assert!(title.is_some_and(|title| !title.is_empty()), "{code} has no title");
        let prose =
            page.lines().skip(1).take_while(|line| !line.starts_with("```")).filter(|line| !line.is_empty());
        let widths: Vec<usize> = prose.map(|line| line.chars().count()).collect();
        assert!(
            (1..=12).contains(&widths.len()) && widths.iter().all(|width| *width <= 100),
            "{code}: the text"
        );
    }
}

#[test]
fn examples_of_explanations_are_wrong_and_right() {
    for (code, page) in codes::PAGES {
        let right = fenced(page, "tex right").unwrap_or_else(|| panic!("{code} has no right example"));
        if let Err(errors) = errors_of(&right) {
            panic!("{code} right: {}", render::human(&errors.sources, &errors.diagnostics));
        }
        assert!(
            texgraph_grammar::format(&right).is_ok_and(|text| text == right),
            "{code} right: not formatted"
        );
        match fenced(page, "tex wrong") {
            Some(wrong) => {
                let errors = errors_of(&wrong).err().unwrap_or_else(|| panic!("{code} wrong: nothing is"));
                let first = errors.diagnostics.first().map(|diagnostic| diagnostic.code);
                assert_eq!(first, Some(*code), "{}", render::human(&errors.sources, &errors.diagnostics));
            }
            None => {
                assert!(fenced(page, "tex wrong (not compiled)").is_some(), "{code} has no wrong example")
            }
        }
    }
}

#[test]
fn a_main_file_that_is_missing() {
    let errors = support::missing_main();
    let page = render::human(&errors.sources, &errors.diagnostics);
    assert!(page.contains("E0601") && page.contains("nowhere.tex"), "{page}");
}

/// The forms for programs, pinned.
#[test]
fn short_and_json() {
    let case = Case::all()
        .into_iter()
        .find(|case| case.path() == "names/wire_bound_twice")
        .expect("the file is there");
    let errors = case.errors();
    let short = render::short(&errors.sources, &errors.diagnostics);
    assert_eq!(short, "names/wire_bound_twice.tex:3:9: error[E0103]: `shade` is bound twice\n");
    let json = render::json(&errors.sources, &errors.diagnostics);
    let pinned = root().join("form.json");
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        fs::write(&pinned, &json).expect("the folder can be written");
    }
    assert_eq!(json, fs::read_to_string(pinned).expect("the form is pinned"));
}

/// Texts that are broken in any way are errors with a place, and nothing worse.
#[test]
fn mutants_survive() {
    let mut random = support::Random(1);
    for source in support::sources() {
        for _ in 0..8 {
            let Err(errors) = errors_of(&support::mutant(&source, &mut random)) else { continue };
            assert!(!errors.diagnostics.is_empty());
            let page = render::human(&errors.sources, &errors.diagnostics);
            assert!(!page.contains("E0999") && !page.contains("E0049"), "{page}");
            assert!(errors.diagnostics.is_sorted_by_key(|diagnostic| diagnostic.place), "{page}");
        }
    }
}
