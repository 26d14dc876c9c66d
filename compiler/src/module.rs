//! Files to modules: imports followed, each file read once, cycles refused.
//!
//! The compiler opens no file. A host hands text in through a [`Loader`].

use crate::advice;
use crate::check::{self, Known};
use crate::diagnostic::{Diagnostic, Place, imports, syntax};
use crate::library::Library;
use std::collections::HashMap;
use std::sync::Arc;
use texgraph_grammar::syntax::{File, ItemKind, Name, Span, Text};

/// Where the text of files comes from.
pub trait Loader {
    /// The text of a file. The path has `/`, is relative to the folder of the main file and has no
    /// `.` or inner `..`; it begins with `../` or `/` when it leads out of that folder, and
    /// whether that is allowed is the loader's decision.
    ///
    /// # Errors
    /// Why there is no text, as a sentence without a full stop.
    fn load(&self, path: &str) -> Result<String, String>;
}

/// Files in memory, by path.
impl Loader for HashMap<String, String> {
    fn load(&self, path: &str) -> Result<String, String> {
        self.get(path).cloned().ok_or_else(|| format!("there is no `{path}`"))
    }
}

/// One text that a place can point into.
#[derive(Clone, Debug)]
pub struct Source {
    /// Its path as shown.
    pub path: String,
    /// Its text.
    pub text: Arc<str>,
}

/// All texts of a program: the library's, then the user's.
#[derive(Clone, Debug, Default)]
pub struct Sources(pub Vec<Source>);

impl Sources {
    /// The text a place points into.
    pub fn get(&self, place: Place) -> Option<&Source> {
        self.0.get(place.file as usize)
    }
}

/// One parsed file.
#[derive(Clone, Debug)]
pub struct Module {
    /// Index into [`Sources`].
    pub file: u32,
    /// Its path relative to the main file's folder.
    pub path: String,
    /// Its tree.
    pub tree: Arc<File>,
    /// What is known of the inputs of each item.
    pub(crate) known: Arc<[Vec<Known>]>,
    /// What it imports, in source order.
    pub imports: Vec<Import>,
}

/// One `use`.
#[derive(Clone, Debug)]
pub struct Import {
    /// The name its items go by; none when they join ours.
    pub alias: Option<Name>,
    /// Index of the module.
    pub module: usize,
    /// The path in the `use`.
    pub span: Span,
}

/// A user's modules, imported ones before those that import them; the last is the main file.
pub struct Modules {
    /// All texts.
    pub sources: Sources,
    /// The library's modules, then the user's.
    pub modules: Vec<Module>,
}

/// A file whose imports are being followed.
struct Open {
    file: u32,
    path: String,
    tree: Arc<File>,
    uses: Vec<(Text, Option<Name>)>,
    imports: Vec<Import>,
}

/// Reads the main file and all it imports.
///
/// # Errors
/// Every syntax error and every import that fails, together with the texts to show them in.
pub fn load(
    main: &str,
    loader: &dyn Loader,
    library: &Library,
) -> Result<Modules, (Sources, Vec<Diagnostic>)> {
    let mut walk = Walk {
        library,
        sources: library.sources().clone(),
        modules: library.modules().to_vec(),
        seen: HashMap::new(),
        diagnostics: Vec::new(),
    };
    walk.run(main, loader);
    walk.diagnostics.sort_by_key(|diagnostic| (diagnostic.place, diagnostic.code));
    if walk.diagnostics.is_empty() {
        Ok(Modules { sources: walk.sources, modules: walk.modules })
    } else {
        Err((walk.sources, walk.diagnostics))
    }
}

struct Walk<'l> {
    library: &'l Library,
    sources: Sources,
    modules: Vec<Module>,
    /// Finished files by path; `None` while open or when broken.
    seen: HashMap<String, Option<usize>>,
    diagnostics: Vec<Diagnostic>,
}

impl Walk<'_> {
    fn run(&mut self, main: &str, loader: &dyn Loader) {
        let (folder, name) = main.rsplit_once('/').unwrap_or(("", main));
        let mut stack: Vec<Open> = self.open(name, folder, None, loader).into_iter().collect();
        while let Some(mut top) = stack.pop() {
            let Some((text, alias)) = top.uses.pop() else {
                self.close(top);
                continue;
            };
            let path = resolve(&top.path, &text.value);
            let place = Place { file: top.file, span: text.span };
            if let Some(known) = self.seen.get(&path) {
                match known {
                    Some(module) => top.imports.push(Import { alias, module: *module, span: text.span }),
                    None => self.cycle(&stack, &top, &path, place),
                }
                stack.push(top);
            } else if let Some(open) = self.open(&path, folder, Some(place), loader) {
                // Met again once the imported file is closed.
                top.uses.push((text, alias));
                stack.extend([top, open]);
            } else {
                stack.push(top);
            }
        }
    }

    /// Reads and parses one file.
    fn open(&mut self, path: &str, folder: &str, from: Option<Place>, loader: &dyn Loader) -> Option<Open> {
        self.seen.insert(path.to_owned(), None);
        let file = self.sources.0.len() as u32;
        let shown = if folder.is_empty() { path.to_owned() } else { format!("{folder}/{path}") };
        let text = match loader.load(path) {
            Ok(text) => text,
            Err(why) => {
                let place = from.unwrap_or_else(|| {
                    // The main file itself: an empty text to point into.
                    self.sources.0.push(Source { path: shown, text: "".into() });
                    Place { file, ..Place::default() }
                });
                self.diagnostics.push(imports::cannot_load(place, path, &why));
                return None;
            }
        };
        self.sources.0.push(Source { path: shown, text: text.as_str().into() });
        match texgraph_grammar::parse(&text) {
            Ok(tree) => {
                let uses = tree.items.iter().rev().filter_map(|item| match &item.kind {
                    ItemKind::Use { path, alias } => Some((path.clone(), alias.clone())),
                    _ => None,
                });
                let uses = uses.collect();
                Some(Open { file, path: path.to_owned(), tree: Arc::new(tree), uses, imports: Vec::new() })
            }
            Err(errors) => {
                let errors = errors.iter().map(|error| syntax::error(file, error));
                let mut errors: Vec<Diagnostic> = errors.collect();
                advice::forgotten_brackets(self.library, &text, &mut errors);
                self.diagnostics.extend(errors);
                None
            }
        }
    }

    fn close(&mut self, open: Open) {
        self.seen.insert(open.path.clone(), Some(self.modules.len()));
        self.modules.push(Module {
            file: open.file,
            path: open.path,
            known: check::known_of_items(&open.tree).into(),
            tree: open.tree,
            imports: open.imports,
        });
    }

    /// A path that is being followed already, or one that failed before (which was reported).
    fn cycle(&mut self, stack: &[Open], top: &Open, path: &str, place: Place) {
        let open: Vec<&str> = stack.iter().chain([top]).map(|open| open.path.as_str()).collect();
        if let Some(start) = open.iter().position(|p| *p == path) {
            self.diagnostics.push(imports::cycle(place, &open[start..]));
        }
    }
}

/// A path written in a file, relative to the main file's folder, `.` and inner `..` resolved.
pub fn resolve(from: &str, written: &str) -> String {
    let absolute = written.starts_with('/');
    let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
    let parts = if absolute { written.to_owned() } else { format!("{folder}/{written}") };
    let mut out: Vec<&str> = Vec::new();
    for part in parts.split('/') {
        match part {
            "" | "." => {}
            ".." if out.last().is_some_and(|last| *last != "..") => {
                out.pop();
            }
            _ => out.push(part),
        }
    }
    let joined = out.join("/");
    if absolute { format!("/{joined}") } else { joined }
}
