//! Well-typed random programs: whole files that should check, and compile.
//!
//! A program is one to three files. Each has constants, params, resources and nodes; the last, the
//! main file, has textures and imports the others. Whatever the checker or a later stage has
//! against one is a bug: of the generator or of the compiler.

use super::calls;
use super::choices::Choices;
use super::features::Features;
use super::names::Names;
use super::types::{Callable, Rate, Scope};
use std::collections::HashMap;
use std::sync::Arc;
use texgraph_compiler::Library;

/// A program's files by path.
pub struct Program {
    /// Every file; hand it to the compiler as the loader.
    pub files: HashMap<String, String>,
    /// The path of the main file.
    pub main: String,
}

impl Program {
    /// All files one after the other, to show or to hash.
    pub fn text(&self) -> String {
        let mut paths: Vec<&String> = self.files.keys().collect();
        paths.sort();
        paths.iter().map(|path| format!("// ==== {path}\n{}", self.files[*path])).collect()
    }
}

/// What is made once for many programs: everything of the library that can be called.
pub struct Known(Arc<Vec<Callable>>);

impl Known {
    /// Read from the library and its tables.
    pub fn new(library: &Library) -> Known {
        Known(Arc::new(calls::library(library)))
    }
}

/// Makes a program of decisions.
pub fn program(choices: &mut Choices, features: Features, known: &Known) -> Program {
    let names = Names::new(known.0.iter().map(|callable| callable.text.as_str()));
    let mut generator = Generator {
        choices,
        features,
        names,
        library: Arc::clone(&known.0),
        callables: Vec::new(),
        room: 0,
        touched: Rate::Load,
        steps: 1,
        widest: 4,
    };
    generator.files()
}

/// A program in the making.
pub struct Generator<'c, 'b> {
    pub choices: &'c mut Choices<'b>,
    pub features: Features,
    names: Names,
    pub library: Arc<Vec<Callable>>,
    /// What the file being made can call of this program.
    pub callables: Vec<Callable>,
    /// Operators, calls and choices that may still go into the item being made.
    pub room: usize,
    /// The highest rate of what the node being made reads besides its inputs.
    touched: Rate,
    /// The most steps of folds around anything in the node being made.
    pub steps: u32,
    /// The widest that the `<n>` of the node being made may be.
    pub widest: u8,
}

/// What is noted while a node is made.
pub struct Noted {
    /// The highest rate of what it reads besides its inputs.
    pub rate: Rate,
    /// See [`Callable::steps`].
    pub steps: u32,
    /// See [`Callable::widest`].
    pub widest: u8,
}

/// What a file has for those that import it.
#[derive(Clone)]
pub struct Exports {
    pub path: String,
    pub scope: Scope,
    pub callables: Vec<Callable>,
}

impl Generator<'_, '_> {
    fn files(&mut self) -> Program {
        let count = *self.choices.pick(&[1, 1, 2, 3]);
        let mut done: Vec<Exports> = Vec::new();
        let mut files = HashMap::new();
        for i in 1..=count {
            let main = i == count;
            let path = match self.choices.below(2) {
                _ if main => "main.tex".to_owned(),
                0 => format!("part{i}.tex"),
                _ => format!("parts/part{i}.tex"),
            };
            let (text, exports) = self.file(&path, &done, main);
            files.insert(path, text);
            done.push(exports);
        }
        Program { files, main: "main.tex".to_owned() }
    }

    /// A name that nobody else has.
    pub fn fresh(&mut self) -> String {
        self.names.fresh(self.choices)
    }

    /// Notes that the node being made reads something of that rate.
    pub fn touch(&mut self, rate: Rate) {
        self.touched = self.touched.max(rate);
    }

    /// Does some work with nothing noted, and what it notes.
    pub fn noting<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> (T, Noted) {
        let before = (self.touched, self.steps, self.widest);
        (self.touched, self.steps, self.widest) = (Rate::Load, 1, 4);
        let result = work(self);
        let noted = Noted { rate: self.touched, steps: self.steps, widest: self.widest };
        (self.touched, self.steps, self.widest) = before;
        (result, noted)
    }

    /// White space or a comment, most often none.
    pub fn aside(&mut self) -> String {
        match self.choices.below(40) {
            37 => "// aside\n".to_owned(),
            38 => "/* aside /* inside */ */ ".to_owned(),
            39 => "\n\n".to_owned(),
            _ => String::new(),
        }
    }
}
