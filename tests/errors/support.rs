//! Where the error files lie, what their first lines ask for, and how they are checked.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use texgraph_compiler::Diagnostic;
use texgraph_compiler::module::Loader;
use texgraph_compiler::{Checked, Compiled, Failure, Library, Options, Profile, check, compile};
use texgraph_runtime::{project::Project, resource};

static LIBRARY: LazyLock<Library> = LazyLock::new(|| Library::standard().expect("the library is right"));

/// The folder of the error files.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/errors")
}

/// Files of a folder; the text in memory before that of the file of its name.
struct Folder {
    path: PathBuf,
    main: Option<(String, String)>,
}

impl Loader for Folder {
    fn load(&self, path: &str) -> Result<String, String> {
        match &self.main {
            Some((name, text)) if path == name => Ok(text.clone()),
            _ => text_of(&self.path.join(path)).map_err(|_| "there is no such file".to_owned()),
        }
    }
}

/// The text of a file as it is checked.
pub fn text_of(path: &Path) -> std::io::Result<String> {
    fs::read_to_string(path).map(|text| repeated(&text))
}

/// A text whose first line says how often the line that ends in `// repeated` stands there; each
/// time its number is put in for `#`.
fn repeated(text: &str) -> String {
    let count = text.strip_prefix("// repeat: ").and_then(|rest| rest.lines().next()?.parse().ok());
    let Some(count) = count else { return text.to_owned() };
    let line = |line: &str| match line.strip_suffix("// repeated") {
        Some(line) => {
            let line = line.trim_end();
            (0..count).map(|i: usize| line.replace('#', &i.to_string()) + "\n").collect()
        }
        None => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

/// The names of the files of a folder with an ending, in order.
pub fn files(folder: &Path, ending: &str) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("it can be read").path());
    let mut names: Vec<String> = paths
        .filter(|path| path.extension().is_some_and(|found| found == ending))
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .collect();
    names.sort();
    names
}

/// The folders of the error files, in order.
pub fn stages() -> Vec<String> {
    let entries = fs::read_dir(root()).expect("the folder is there");
    let folders = entries.map(|entry| entry.expect("it can be read").path()).filter(|path| path.is_dir());
    let mut names: Vec<String> =
        folders.filter_map(|path| Some(path.file_name()?.to_str()?.to_owned())).collect();
    names.sort();
    names
}

/// One error file.
pub struct Case {
    stage: String,
    name: String,
    head: String,
    ask: Option<String>,
}

impl Case {
    /// Every error file, in order.
    pub fn all() -> Vec<Case> {
        let stages = stages().into_iter().map(|stage| (files(&root().join(&stage), "tex"), stage));
        stages
            .flat_map(|(names, stage)| names.into_iter().map(move |name| Case::read(&stage, name)))
            .collect()
    }

    fn read(stage: &str, name: String) -> Case {
        let text =
            fs::read_to_string(root().join(stage).join(format!("{name}.tex"))).expect("it can be read");
        let head = text.lines().next().unwrap_or_default().to_owned();
        let ask = text.lines().take(2).find_map(|line| line.strip_prefix("// ask: ")).map(str::to_owned);
        Case { stage: stage.to_owned(), name, head, ask }
    }

    pub fn stage(&self) -> &str {
        &self.stage
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    /// `names/misspelt_value`
    pub fn path(&self) -> String {
        format!("{}/{}", self.stage, self.name)
    }

    pub fn folder(&self) -> PathBuf {
        root().join(&self.stage)
    }

    /// The codes that the first line announces.
    pub fn expected(&self) -> Option<Vec<&str>> {
        let codes = self.head.strip_prefix("// expect: ")?;
        Some(codes.split(',').map(str::trim).collect())
    }

    /// What is said about the file with another text in its place.
    pub fn errors_of_text(&self, text: &str) -> Vec<Diagnostic> {
        let loader =
            Folder { path: self.folder(), main: Some((format!("{}.tex", self.name), text.to_owned())) };
        let checked = said(check(&LIBRARY, &format!("{}.tex", self.path()), &loader));
        checked.err().map_or(Vec::new(), |said| said.diagnostics)
    }

    /// What is said about the file.
    pub fn errors(&self) -> Failure {
        let loader = Folder { path: self.folder(), main: None };
        let main = format!("{}.tex", self.path());
        let failure = match self.ask.as_deref() {
            Some("load") => load(&main, &loader, &root().join(&main)),
            Some(wish) if wish.starts_with("large file ") => load_large(&main, &loader, &wish[11..]),
            Some(wish) => compile(&LIBRARY, &main, &loader, &asked(wish)).err(),
            None => said(check(&LIBRARY, &main, &loader)).err(),
        };
        failure.unwrap_or_else(|| panic!("{}: nothing is wrong", self.path()))
    }
}

/// What only loading the resources finds.
fn load(main: &str, loader: &Folder, file: &Path) -> Option<Failure> {
    let Compiled { mut program, sources } = match compile(&LIBRARY, main, loader, &Options::default()) {
        Ok(compiled) => compiled,
        Err(failure) => return Some(failure),
    };
    let project = Project::new(file, false);
    let diagnostics = resource::load(&mut program, &project).err()?;
    Some(Failure { sources, diagnostics })
}

/// The same beside a file of more than half a gibibyte. A file with a hole takes no room on the disk.
fn load_large(main: &str, loader: &Folder, name: &str) -> Option<Failure> {
    let folder = tempfile::tempdir().expect("a folder");
    let large = fs::File::create(folder.path().join(name)).expect("a file");
    large.set_len((512 << 20) + 1).expect("a hole");
    let copy = folder.path().join("main.tex");
    fs::copy(root().join(main), &copy).expect("copied");
    load(main, loader, &copy)
}

fn asked(wish: &str) -> Options {
    match wish.split_once(' ') {
        Some(("texture", name)) => Options { texture: Some(name.to_owned()), ..Options::default() },
        Some(("output", name)) => Options { outputs: Some(vec![name.to_owned()]), ..Options::default() },
        Some(("profile", name)) => Options { profile: profile(name), ..Options::default() },
        _ => Options::default(),
    }
}

fn profile(name: &str) -> Profile {
    match name {
        "compat" => Profile::Compat,
        "bevy" => Profile::Bevy,
        _ => Profile::Webgpu,
    }
}

/// Checks a text that may import what the files about imports do.
pub fn errors_of(text: &str) -> Result<(), Failure> {
    let loader =
        Folder { path: root().join("imports"), main: Some(("main.tex".to_owned(), text.to_owned())) };
    said(check(&LIBRARY, "main.tex", &loader))
}

/// Errors, or else warnings.
fn said(checked: Result<Checked, Failure>) -> Result<(), Failure> {
    let Checked { sources, warnings } = checked?;
    if warnings.is_empty() { Ok(()) } else { Err(Failure { sources, diagnostics: warnings }) }
}

/// Compiles a text for a host.
pub fn errors_for(text: &str, profile: Profile) -> Option<Failure> {
    let loader = Folder { path: root(), main: Some(("main.tex".to_owned(), text.to_owned())) };
    compile(&LIBRARY, "main.tex", &loader, &Options { profile, ..Options::default() }).err()
}

/// A main file that nobody has.
pub fn missing_main() -> Failure {
    let loader = Folder { path: root(), main: None };
    check(&LIBRARY, "nowhere.tex", &loader).expect_err("there is no such file")
}

/// The text of a fenced block.
pub fn fenced(page: &str, info: &str) -> Option<String> {
    let (_, rest) = page.split_once(&format!("```{info}\n"))?;
    rest.split_once("```").map(|(text, _)| text.to_owned())
}

/// The codes of the grammar, and those in the sentences of the compiler.
pub fn codes_in_use() -> BTreeSet<String> {
    let mut codes: BTreeSet<String> =
        texgraph_grammar::SYNTAX_CODES.iter().map(|(code, _)| (*code).to_owned()).collect();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("compiler/src/diagnostic");
    for file in
        files(&folder, "rs").into_iter().filter(|file| file != "codes" && file != "mod" && file != "render")
    {
        let text = fs::read_to_string(folder.join(format!("{file}.rs"))).expect("it can be read");
        codes.extend(text.split('"').filter(|word| is_code(word)).map(str::to_owned));
    }
    codes
}

fn is_code(word: &str) -> bool {
    word.len() == 5 && word.starts_with(['E', 'W']) && word[1..].bytes().all(|byte| byte.is_ascii_digit())
}

/// Texts to break: the examples and every error file.
pub fn sources() -> Vec<String> {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let folders = stages().into_iter().map(|stage| root().join(stage)).chain([examples]);
    let files = folders
        .flat_map(|folder| files(&folder, "tex").into_iter().map(move |file| folder.join(file + ".tex")));
    files.map(|file| fs::read_to_string(file).expect("it can be read")).collect()
}

/// The same numbers on every machine.
pub struct Random(pub u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % limit.max(1)
    }
}

/// The text with one or two words or marks left out, doubled, or replaced by others of the text.
pub fn mutant(source: &str, random: &mut Random) -> String {
    let mut tokens = tokens(source);
    for _ in 0..=random.below(2) {
        let (at, other) = (random.below(tokens.len()), random.below(tokens.len()));
        let token = tokens.get(other).cloned().unwrap_or_default();
        match random.below(3) {
            0 => drop(tokens.splice(at..(at + 1).min(tokens.len()), [])),
            1 => tokens.insert(at, token),
            _ => drop(tokens.splice(at..(at + 1).min(tokens.len()), [token])),
        }
    }
    tokens.concat()
}

/// Words, and the marks and blanks between them.
fn tokens(source: &str) -> Vec<String> {
    let mut tokens: Vec<String> = Vec::new();
    for c in source.chars() {
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        match tokens.last_mut() {
            Some(last) if is_word(c) && last.ends_with(is_word) => last.push(c),
            _ => tokens.push(c.to_string()),
        }
    }
    tokens
}
