//! A few of the generated programs and mutants; the example `generated` does thousands.

#[path = "generated/mod.rs"]
mod generated;

use generated::choices::Choices;
use generated::corpus::Corpus;
use generated::features::Features;
use generated::judge::{self, Depth, Outcome};
use generated::mutant::{mutant, tokens};
use generated::program::{Known, Program, program};
use std::path::Path;
use texgraph_compiler::Library;
use texgraph_compiler::intrinsic::Intrinsic;

fn library() -> Library {
    Library::standard().expect("the library parses")
}

fn made(known: &Known, features: Features, seed: u64) -> Program {
    program(&mut Choices::Seed(seed), features, known)
}

fn judged(library: &Library, seed: &str, program: &Program) -> Vec<judge::Shader> {
    for text in program.files.values() {
        let parses = judge::formats(text, Depth::Whole).unwrap_or_else(|why| panic!("{seed}: {why}"));
        assert!(parses, "{seed} does not parse:\n{text}");
    }
    match judge::compiles(library, &program.main, &program.files, true, Depth::Whole) {
        Ok(Outcome::Shaders(shaders)) => shaders,
        Ok(Outcome::Refused(why)) | Err(why) => panic!("{seed}: {why}\n{}", program.text()),
    }
}

#[test]
fn programs_check_and_compile() {
    let library = library();
    let known = Known::new(&library);
    for seed in 0..150 {
        let shaders = judged(&library, &format!("seed {seed}"), &made(&known, Features::NOW, seed));
        assert!(!shaders.is_empty(), "a program has a texture");
    }
}

#[test]
fn any_bytes_are_a_program() {
    let library = library();
    let known = Known::new(&library);
    for length in [0, 1, 2, 5, 20, 100, 500, 2_000] {
        let mut state = Choices::Seed(length as u64);
        let bytes: Vec<u8> = (0..length).map(|_| state.below(256) as u8).collect();
        let program = program(&mut Choices::Bytes(&bytes), Features::NOW, &known);
        judged(&library, &format!("{length} bytes"), &program);
    }
}

/// The parts that the checker does not take yet are at least syntax.
#[test]
fn the_whole_language_parses_and_formats() {
    let known = Known::new(&library());
    for seed in 0..300 {
        for text in made(&known, Features::ALL, seed).files.values() {
            let parses =
                judge::formats(text, Depth::Whole).unwrap_or_else(|why| panic!("seed {seed}: {why}"));
            assert!(parses, "seed {seed} does not parse:\n{text}");
        }
    }
}

#[test]
fn programs_call_every_row_and_hold_every_construct() {
    let known = Known::new(&library());
    let all: String = (0..1_000).map(|seed| made(&known, Features::ALL, seed).text()).collect();
    let rows = Intrinsic::all().map(|intrinsic| intrinsic.row());
    for row in rows.filter(|row| row.name.starts_with(|c: char| c.is_ascii_lowercase())) {
        let generic = row.signature.starts_with('<').then(|| format!("{}<", row.name));
        for form in [format!("{}(", row.name), format!(".{}", row.name)].into_iter().chain(generic) {
            assert!(all.contains(&form), "no program holds `{form}`");
        }
    }
    let constructs = [
        "use \"",
        " as ",
        "let (",
        "param ",
        " in ",
        "..=",
        "node ",
        "texture ",
        " = none",
        "given(",
        "if ",
        "else if",
        "fold (",
        " max ",
        " while ",
        "ivec2(-1)..",
        "ivec<n>(-1)..",
        "(|",
        "mat2(",
        "mat3: ",
        "][",
        "= bake(",
        ": node(",
        "image(\"",
        "patterns([",
        "permutation(",
        "indices([[",
        ".sample(",
        "lod: ",
        "gradient: ",
        "layer: ",
        "dx(",
        ".dy()",
        "turn",
        "deg",
        "#",
        "&&",
        "||",
        "!",
        "%",
        "vec<n>",
        "<n>(",
    ];
    for construct in constructs {
        let construct = construct.replace("mat3: ", ": mat3");
        assert!(all.contains(&construct), "no program holds `{construct}`");
    }
}

#[test]
fn mutants_break_nothing() {
    let library = library();
    let corpus = Corpus::read().expect("there are programs");
    let mut parsed = 0;
    for seed in 0..1_500 {
        let (which, text) = mutant(&mut Choices::Seed(seed), &corpus.texts());
        let whole = judge::formats(&text, Depth::Whole);
        parsed += usize::from(whole.unwrap_or_else(|why| panic!("mutant {seed}: {why}\n{text}")));
        let (main, files) = corpus.with(corpus.paths()[which], &text);
        if let Err(why) = judge::compiles(&library, main, &files, false, Depth::Whole) {
            panic!("mutant {seed}: {why}\n{text}");
        }
    }
    assert!(parsed > 200, "{parsed} of 1,500 mutants parse: the edits are too coarse");
}

/// Programs that once were refused or worse, as small as they go.
#[test]
fn what_was_found_stays_right() {
    let library = library();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/generated/found");
    for entry in std::fs::read_dir(folder).expect("there is a folder") {
        let path = entry.expect("it can be read").path();
        let text = std::fs::read_to_string(&path).expect("it can be read");
        let name = path.display().to_string();
        let files = [("main.tex".to_owned(), text)].into();
        judged(&library, &name, &Program { files, main: "main.tex".to_owned() });
    }
}

#[test]
fn tokens_cover_a_text() {
    for text in Corpus::read().expect("there are programs").texts() {
        let mut end = 0;
        for token in tokens(text) {
            assert_eq!(token.start, end);
            end = token.end;
        }
        assert_eq!(end, text.len());
    }
}

#[test]
fn threads_make_the_same_bytes() {
    let shaders = || {
        let library = library();
        let known = Known::new(&library);
        let programs = (0..40).map(|seed| made(&known, Features::NOW, seed));
        let shaders = programs.flat_map(|program| judged(&library, "a program", &program));
        shaders.map(|shader| (shader.wgsl, shader.manifest)).collect::<Vec<_>>()
    };
    let here = shaders();
    std::thread::scope(|scope| {
        let others = [scope.spawn(shaders), scope.spawn(shaders)];
        for other in others {
            assert_eq!(other.join().expect("the thread ends well"), here);
        }
    });
}
