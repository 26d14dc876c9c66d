//! The standard library: `std/*.tex`, parsed once and shared by every compilation. A process that
//! compiles many programs gets the nodes of the files that they call into made ahead, as most
//! programs call them; one that compiles few makes only what these call, which is less.

use crate::ahead::Ahead;
use crate::check::{self, Known};
use crate::intrinsic::Intrinsic;
use crate::module::{Module, Source, Sources};
use crate::resource::KINDS;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};
use texgraph_grammar::syntax::{ItemKind, Signature};

/// The files, one per technique.
const FILES: &[(&str, &str)] = &[
    ("std/tiling.tex", include_str!("../std/tiling.tex")),
    ("std/strips.tex", include_str!("../std/strips.tex")),
    ("std/volumes.tex", include_str!("../std/volumes.tex")),
    ("std/draws.tex", include_str!("../std/draws.tex")),
    ("std/placing.tex", include_str!("../std/placing.tex")),
    ("std/material_maps.tex", include_str!("../std/material_maps.tex")),
    ("std/transition.tex", include_str!("../std/transition.tex")),
    ("std/animation.tex", include_str!("../std/animation.tex")),
    ("std/splat.tex", include_str!("../std/splat.tex")),
    ("std/layers.tex", include_str!("../std/layers.tex")),
    ("std/resources.tex", include_str!("../std/resources.tex")),
    ("std/distribution.tex", include_str!("../std/distribution.tex")),
    ("std/materials.tex", include_str!("../std/materials.tex")),
    ("std/positions.tex", include_str!("../std/positions.tex")),
    ("std/noise.tex", include_str!("../std/noise.tex")),
    ("std/cells.tex", include_str!("../std/cells.tex")),
    ("std/bombing.tex", include_str!("../std/bombing.tex")),
    ("std/stone.tex", include_str!("../std/stone.tex")),
    ("std/hex.tex", include_str!("../std/hex.tex")),
    ("std/stochastic.tex", include_str!("../std/stochastic.tex")),
    ("std/stochastic_volumes.tex", include_str!("../std/stochastic_volumes.tex")),
    ("std/filtering.tex", include_str!("../std/filtering.tex")),
    ("std/color.tex", include_str!("../std/color.tex")),
    ("std/matrix.tex", include_str!("../std/matrix.tex")),
    ("std/shapes.tex", include_str!("../std/shapes.tex")),
    ("std/motifs.tex", include_str!("../std/motifs.tex")),
    ("std/coordinates.tex", include_str!("../std/coordinates.tex")),
    ("std/surface.tex", include_str!("../std/surface.tex")),
];

/// What a name before `(` may mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Callable {
    /// A node or texture: module and item.
    Node(usize, usize),
    /// A row of the intrinsic table.
    Intrinsic(Intrinsic),
    /// A row of the table of resource kinds.
    Constructor(usize),
}

/// The library and the tables, indexed by name.
#[derive(Clone, Debug)]
pub struct Library {
    sources: Sources,
    modules: Vec<Module>,
    callables: FxHashMap<String, Vec<Callable>>,
    /// Signatures of the intrinsics, by row, then of the constructors.
    signatures: Vec<Signature>,
    /// What is known of the inputs of each.
    known: Vec<Vec<Known>>,
    /// What is made before a program calls it.
    ahead: Arc<Mutex<Progress>>,
}

/// Programs that call into a file before its nodes are made ahead: by then they have spent about as
/// long on making their own.
const PATIENCE: u32 = 32;

/// How much of a library is made ahead.
#[derive(Debug, Default)]
struct Progress {
    /// The modules that programs have called into.
    called: BTreeSet<usize>,
    /// How many programs have missed some of them.
    missed: u32,
    /// Those whose nodes are made, and what was made of them.
    made: BTreeSet<usize>,
    ahead: Arc<Ahead>,
}

impl Library {
    /// Parses the library's files and the tables' signatures.
    ///
    /// # Errors
    /// A file of the library or a row of a table is broken, with a sentence that says which: a bug
    /// of texgraph.
    pub fn standard() -> Result<Library, String> {
        Library::with(&[])
    }

    /// The library with further files (path and text): nodes that a host gives all its programs.
    ///
    /// # Errors
    /// A file can't be parsed, with a sentence that says which and where.
    pub fn with(files: &[(&str, &str)]) -> Result<Library, String> {
        Library::from_files(&[FILES, files].concat())
    }

    fn from_files(files: &[(&str, &str)]) -> Result<Library, String> {
        let mut library = Library {
            sources: Sources::default(),
            modules: Vec::new(),
            callables: FxHashMap::default(),
            signatures: Vec::new(),
            known: Vec::new(),
            ahead: Arc::default(),
        };
        for (path, text) in files {
            library.add_file(path, text)?;
        }
        library.add_tables()?;
        Ok(library)
    }

    fn add_file(&mut self, path: &str, text: &str) -> Result<(), String> {
        let tree = texgraph_grammar::parse(text).map_err(|errors| {
            errors.first().map_or_else(String::new, |e| format!("{path}: {e} at byte {}", e.span.start))
        })?;
        let module = self.modules.len();
        for (item, declared) in tree.items.iter().enumerate() {
            if let ItemKind::Node(node) = &declared.kind {
                let named = self.callables.entry(node.name.text.to_string()).or_default();
                named.push(Callable::Node(module, item));
            }
        }
        self.sources.0.push(Source { path: path.to_owned(), text: text.into() });
        self.modules.push(Module {
            file: module as u32,
            path: path.to_owned(),
            known: check::known_of_items(&tree).into(),
            tree: Arc::new(tree),
            imports: Vec::new(),
        });
        Ok(())
    }

    fn add_tables(&mut self) -> Result<(), String> {
        for intrinsic in Intrinsic::all() {
            let row = intrinsic.row();
            self.add_signature(row.name, row.signature)?;
            if intrinsic.is_callable() {
                let named = self.callables.entry(row.name.to_owned()).or_default();
                named.push(Callable::Intrinsic(intrinsic));
            }
        }
        for (i, kind) in KINDS.iter().enumerate() {
            self.add_signature(kind.name, kind.constructor)?;
            self.callables.entry(kind.name.to_owned()).or_default().push(Callable::Constructor(i));
        }
        Ok(())
    }

    fn add_signature(&mut self, name: &str, text: &str) -> Result<(), String> {
        let signature =
            texgraph_grammar::parse_signature(text).map_err(|e| format!("{name}: {text}: {e}"))?;
        self.known.push(check::known(&signature.dims, &signature.inputs));
        self.signatures.push(signature);
        Ok(())
    }

    /// Its texts.
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// Its modules.
    pub fn modules(&self) -> &[Module] {
        &self.modules
    }

    /// What is made of the nodes that programs before this one called, and of those beside them.
    /// The shaders are the same with and without it.
    pub(crate) fn ahead(&self) -> Arc<Ahead> {
        let mut progress = self.ahead.lock().unwrap_or_else(PoisonError::into_inner);
        if progress.missed >= PATIENCE {
            progress.missed = 0;
            progress.made = progress.called.clone();
            let (nodes, functions) = check::ahead(self, &progress.made);
            progress.ahead = Arc::new(Ahead::of(nodes, functions));
        }
        Arc::clone(&progress.ahead)
    }

    /// Notes the modules that a program has called into.
    pub(crate) fn note(&self, called: &BTreeSet<usize>) {
        let mut progress = self.ahead.lock().unwrap_or_else(PoisonError::into_inner);
        let mut called: BTreeSet<usize> = called.range(..self.modules.len()).copied().collect();
        progress.missed += u32::from(!called.is_subset(&progress.made));
        progress.called.append(&mut called);
    }

    /// What a name may mean, in order of preference.
    pub fn callables(&self, name: &str) -> &[Callable] {
        self.callables.get(name).map_or(&[], Vec::as_slice)
    }

    /// Every name that can be called, in order.
    pub fn callable_names(&self) -> Vec<&str> {
        let mut names: Vec<&str> =
            self.callables.keys().map(String::as_str).filter(|n| !n.starts_with('_')).collect();
        names.sort_unstable();
        names
    }

    /// The signature of an intrinsic or a constructor; none for nodes, which have their own head.
    pub fn signature(&self, callable: Callable) -> Option<&Signature> {
        self.signatures.get(row(callable)?)
    }

    /// What is known of the inputs of an intrinsic or a constructor.
    pub(crate) fn known(&self, callable: Callable) -> &[Known] {
        row(callable).and_then(|row| self.known.get(row)).map_or(&[], Vec::as_slice)
    }
}

/// The place of a signature among all of them.
fn row(callable: Callable) -> Option<usize> {
    match callable {
        Callable::Node(..) => None,
        Callable::Intrinsic(intrinsic) => Some(intrinsic.index()),
        Callable::Constructor(kind) => Some(Intrinsic::all().count() + kind),
    }
}

#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "tests read the examples")]
mod tests {
    use super::*;
    use crate::{Form, Options, compile, textures};
    use std::collections::HashMap;

    const TEXT: &str = r#"
let rock = image("rock.jpg")

texture mixture(uv: vec2) -> (color: color) {
    let mixed = mix(turbulence(uv), fbm(uv * 3.0, octaves: 2), noise(uv, seed: 7))
    let again = noise(vec3(uv, fbm(uv)))
    let turn  = rotation(again) * uv
    color     = over(rock.hex_tile(turn) * mixed, hue(again))
}
"#;

    /// Every example, and a texture that calls nodes in many ways.
    fn files() -> HashMap<String, String> {
        let entries = ["examples", "tests/golden"].iter().flat_map(|folder| {
            std::fs::read_dir(format!("{}/../{folder}", env!("CARGO_MANIFEST_DIR"))).unwrap()
        });
        let files = entries.map(|entry| entry.unwrap().path());
        let files = files.filter(|path| path.extension().is_some_and(|extension| extension == "tex"));
        let named = files.map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            (path.file_name().unwrap().to_string_lossy().into_owned(), text)
        });
        // What imports from a folder beside it would need that, too.
        let alone = named.filter(|(_, text)| !text.contains("\nuse \""));
        alone.chain([("mixture.tex".to_owned(), TEXT.to_owned())]).collect()
    }

    #[test]
    fn nodes_made_ahead_are_those_made_in_place() {
        let all = Library::standard().unwrap();
        (0..PATIENCE).for_each(|_| all.note(&(0..all.modules().len()).collect()));
        let ahead = all.ahead();
        assert!(!ahead.prepared.is_empty());
        assert!(!ahead.prepared.keys().any(|key| key.is_passed_functions()));
        let files = files();
        for file in files.keys() {
            for texture in textures(&all, file, &files).unwrap() {
                for form in [Form::Complete, Form::Library, Form::Functions] {
                    let options = Options { texture: Some(texture.clone()), form, ..Options::default() };
                    let compiled = |library: &Library| {
                        let compiled = compile(library, file, &files, &options).unwrap();
                        compiled.program.passes.into_iter().map(|pass| pass.wgsl).collect::<Vec<_>>()
                    };
                    let library = Library { ahead: Arc::default(), ..all.clone() };
                    let in_place = compiled(&library);
                    for (ahead, in_place) in compiled(&all).iter().zip(&in_place) {
                        let first = ahead.lines().zip(in_place.lines()).find(|(a, b)| a != b);
                        assert!(ahead == in_place, "{file}: {texture}, all made ahead: {first:?}");
                    }
                }
            }
        }
    }
}
