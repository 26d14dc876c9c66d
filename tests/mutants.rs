//! The errors measured: of single edits that a person makes by mistake, how many does the first
//! error point at?
//!
//! Every file of `examples/` and `tests/golden/`, the library's own, and every design example that
//! checks, gets edits of one place: a character, a token, an argument, a name, a literal, a line.
//! The first 300 mutants that no longer check are the sample. An error points at the edit when its
//! span or one of its related spans touches a token that was edited or is what is left of one, or,
//! where nothing is left, the token before or behind.
//!
//! `cargo test --test mutants -- --nocapture` prints the figures; `MUTANTS_SEED=7` takes another
//! sample, and `MUTANTS_SHOW=1` prints the page of every miss.

#[path = "mutants/edits.rs"]
mod edits;

use edits::{EDITS, Edit, Random, tokens};
use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use texgraph_compiler::diagnostic::{Diagnostic, Place, render};
use texgraph_compiler::module::Loader;
use texgraph_compiler::{Failure, Library, check};

/// Mutants in the sample.
const SAMPLE: usize = 300;
/// Per cent of them whose first error must point at the edit.
const LEAST: usize = 90;
/// Errors that one edit may give.
const MOST: usize = 2;

/// A file that is right.
struct Original {
    folder: PathBuf,
    name: String,
    text: String,
}

/// The folder of an original, with another text in its place.
struct Folder<'a> {
    original: &'a Original,
    text: &'a str,
}

impl Loader for Folder<'_> {
    fn load(&self, path: &str) -> Result<String, String> {
        if path == self.original.name {
            return Ok(self.text.to_owned());
        }
        fs::read_to_string(self.original.folder.join(path)).map_err(|_| "there is no such file".to_owned())
    }
}

impl Original {
    fn errors(&self, library: &Library, text: &str) -> Option<Failure> {
        check(library, &self.name, &Folder { original: self, text }).err()
    }
}

/// The right files, in order.
fn originals(library: &Library) -> Vec<Original> {
    let folders = ["examples", "tests/golden", "tests/golden/parts", "compiler/std", "grammar/tests/data"];
    let mut found = Vec::new();
    for folder in folders.map(|folder| Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)) {
        let entries = fs::read_dir(&folder).expect("the folder is there");
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        let mut names: Vec<String> = names.filter(|name| name.ends_with(".tex")).collect();
        names.sort();
        for name in names {
            let text = fs::read_to_string(folder.join(&name)).expect("it can be read");
            found.push(Original { folder: folder.clone(), name, text });
        }
    }
    found.retain(|original| original.errors(library, &original.text).is_none());
    found
}

/// One mutant that does not check.
struct Mutant<'a> {
    original: &'a Original,
    kind: &'static str,
    edit: Edit,
    text: String,
    failure: Failure,
}

/// The first mutants of a seed that do not check.
fn sample<'a>(library: &Library, originals: &'a [Original], seed: u64) -> Vec<Mutant<'a>> {
    let mut random = Random(seed);
    let mut mutants = Vec::new();
    while mutants.len() < SAMPLE {
        let original = &originals[random.below(originals.len())];
        let (kind, make) = EDITS[random.below(EDITS.len())];
        let Some(edit) = make(&original.text, &tokens(&original.text), &mut random) else { continue };
        let text = edit.apply(&original.text);
        if let Some(failure) = original.errors(library, &text) {
            mutants.push(Mutant { original, kind, edit, text, failure });
        }
    }
    mutants
}

impl Mutant<'_> {
    /// Whether the first error points at the edit, by its own span and by that or a related one.
    fn is_hit(&self) -> [bool; 2] {
        let first = &self.failure.diagnostics[0];
        let own = self.is_edited(first.place);
        [own, own || first.related.iter().any(|(place, _)| self.is_edited(*place))]
    }

    fn is_edited(&self, place: Place) -> bool {
        let edited = self.edit.places(&self.original.text, &self.text);
        self.is_here(place) && edited.iter().any(|edit| meet(edit, &place.span.range()))
    }

    /// Whether a place lies in the file that was edited.
    fn is_here(&self, place: Place) -> bool {
        self.failure.sources.get(place).is_some_and(|source| *source.text == *self.text)
    }

    fn errors(&self) -> &[Diagnostic] {
        &self.failure.diagnostics
    }

    fn page(&self) -> String {
        let edit = &self.edit;
        let old = self.original.text.get(edit.range.clone()).unwrap_or_default();
        let page = render::human(&self.failure.sources, self.errors());
        format!("== {}: {}: {old:?} became {:?}\n{page}", self.original.name, self.kind, edit.replacement)
    }
}

fn meet(a: &Range<usize>, b: &Range<usize>) -> bool {
    a.start < b.end && b.start < a.end
}

#[test]
fn the_first_error_points_at_the_edit() {
    let library = Library::standard().expect("the library is right");
    let originals = originals(&library);
    let seed = std::env::var("MUTANTS_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(1);
    let mutants = sample(&library, &originals, seed);
    let mut kinds: BTreeMap<&str, [usize; 4]> = BTreeMap::new();
    for mutant in &mutants {
        let ([own, hit], many) = (mutant.is_hit(), mutant.errors().len() > MOST);
        let counts = kinds.entry(mutant.kind).or_default();
        counts[0] += 1;
        counts[1] += usize::from(hit);
        counts[2] += usize::from(many);
        counts[3] += usize::from(own);
        if std::env::var_os("MUTANTS_SHOW").is_some() && (!hit || many) {
            println!("{}", mutant.page());
        }
    }
    let total = |i: usize| kinds.values().map(|counts| counts[i]).sum::<usize>();
    let (hits, many, own) = (total(1), total(2), total(3));
    let percent = |hits: usize| hits as f64 * 100.0 / SAMPLE as f64;
    println!(
        "{} originals; mutants, hits, by the error's own span, with more than {MOST} errors:",
        originals.len()
    );
    kinds
        .iter()
        .for_each(|(kind, [all, hits, many, own])| println!("{all:4} {hits:4} {own:4} {many:3}  {kind}"));
    println!("{SAMPLE:4} {hits:4} {own:4} {many:3}  all: {:.1} %, {:.1} %", percent(hits), percent(own));
    assert!(hits * 100 >= SAMPLE * LEAST, "{hits} of {SAMPLE} first errors point at the edit");
    assert_eq!(many, 0, "mutants with more than {MOST} errors");
}
