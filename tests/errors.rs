//! Every error as its page: `tests/errors/<stage>/<what_is_wrong>.tex` with the page beside it.
//!
//! A file makes one error, or as many as its first line says: `// expect: E0101, E0216`. What needs
//! more than the text is asked for there too: `// ask: texture meadow`, `// ask: output height`,
//! `// ask: load` (the resources).
//! `INSTA_UPDATE=always` writes the pages anew.

#[path = "errors/support.rs"]
mod support;

use std::collections::BTreeSet;
use std::fs;
use support::{Case, codes_in_use, errors_of, fenced, generated, root};
use texgraph_compiler::diagnostic::{codes, render};

/// Codes that no file can show: bugs of texgraph.
const BUGS: [&str; 2] = ["E0049", "E0999"];

/// A code that needs a file larger than a repository should hold: made by its own test.
const MADE: &str = "E0504";

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
    let mut shown: BTreeSet<&str> = BTreeSet::new();
    for case in Case::all() {
        shown.extend(case.errors().diagnostics.first().map(|diagnostic| diagnostic.code));
    }
    shown.extend(generated().iter().map(|(code, _)| *code));
    for code in codes_in_use() {
        let known = BUGS.contains(&code.as_str()) || code == MADE;
        assert!(known || shown.contains(code.as_str()), "{code} has no file in tests/errors");
    }
}

#[test]
fn what_is_beyond_a_limit_is_an_error() {
    for (code, text) in generated() {
        let errors = errors_of(&text).expect_err(code);
        let found: Vec<&str> = errors.diagnostics.iter().map(|diagnostic| diagnostic.code).collect();
        assert_eq!(found, [code]);
        assert!(render::human(&errors.sources, &errors.diagnostics).contains(code));
    }
}

/// A file with a hole takes no room on the disk.
#[test]
fn a_file_of_more_than_half_a_gibibyte() {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = fs::File::create(folder.path().join("large.png")).expect("a file");
    picture.set_len((512 << 20) + 1).expect("a hole");
    let main = folder.path().join("t.tex");
    let text =
        "let a = image(\"large.png\")\ntexture t(uv: vec2) -> (color: color) { color = a.sample(uv) }\n";
    fs::write(&main, text).expect("written");
    let project = texgraph_runtime::project::Project::new(&main, false);
    let library = texgraph_compiler::Library::standard().expect("the library is right");
    let options = texgraph_compiler::Options::default();
    let compiled = texgraph_compiler::compile(&library, project.main(), &project, &options);
    let mut program = compiled.expect("it compiles").program;
    let loaded = texgraph_runtime::resource::load(&mut program, &project);
    let Err(errors) = loaded else { panic!("the file is too large") };
    assert_eq!(errors.iter().map(|d| d.code).collect::<Vec<_>>(), [MADE]);
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
