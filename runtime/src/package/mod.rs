//! Packages: what a build writes for hosts, and what the next build takes from it.
//!
//! ```text
//!  recipe, files ─key─▶ known? ──yes──▶ table ─┐
//!                         └no─▶ resource, bake ┴─ktx2─▶ NAME.RESOURCE.FIELD.ktx2
//! ```
//!
//! The tables that a build has written are the cache of the next: each file says under which key its
//! table was made, and where that is the key wanted, nothing is decoded, made or drawn. What counts is
//! the key, not the file's name, so a table is found wherever it stands in the folder: under the name
//! that its `let` had before, or as another texture's. A folder holds what was built into it last and
//! no more, so nothing piles up. Files are only ever read here; who builds writes them.

mod format;
mod key;
mod ktx2;

pub use key::MAKING;

use crate::bake;
use crate::project::Project;
use crate::render::RenderError;
use crate::resource::{self, Loaded, Tables};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};
use texgraph_compiler::Program;
use texgraph_compiler::diagnostic::Diagnostic;
use texgraph_compiler::manifest::{Manifest, Resource, Table};

/// The tables that need not be made: those of a folder, and those made already.
#[derive(Debug)]
pub struct Cache {
    folder: PathBuf,
    /// The files of the folder that say a key of ours, each with that.
    files: BTreeMap<String, String>,
    /// What was made or read here, by key.
    known: BTreeMap<String, Loaded>,
    /// The keys of what was made and not packed yet; for what took a time of its own, how long that was.
    made: BTreeMap<String, Option<Duration>>,
}

/// A table's file, to be written.
#[derive(Clone, Debug)]
pub struct Packed {
    /// Its name.
    pub name: String,
    /// Its bytes.
    pub bytes: Arc<[u8]>,
    /// Whether the table was made for it rather than found.
    pub is_made: bool,
    /// How long that took, together with the other tables of the resource.
    pub time: Option<Duration>,
}

impl Cache {
    /// What a folder holds. One that is not there, or can't be read, holds nothing.
    pub fn open(folder: &Path) -> Cache {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let names = names.filter(|name| name.ends_with(".ktx2"));
        let keyed = names.filter_map(|name| {
            let start = read(&folder.join(&name), ktx2::MAX_HEAD)?;
            let key = ktx2::Head::read(&start)?.table.key?;
            Some((name, key))
        });
        let files = keyed.collect();
        Cache { folder: folder.to_owned(), files, known: BTreeMap::new(), made: BTreeMap::new() }
    }

    /// As [`resource::load`], without making what is known. The tables get their keys.
    ///
    /// # Errors
    /// As [`resource::load`] says, of what is not known.
    pub fn load(&mut self, program: &mut Program, project: &Project) -> Result<Tables, Vec<Diagnostic>> {
        let loaded = resource::for_each(program, |place, resource, others| {
            let keyed = key::of_resource(project, &resource.recipe, others);
            // What can't be read is said by who makes the table.
            let (key, project) = keyed.unwrap_or_else(|| (String::new(), project.clone()));
            if let Some(found) = self.fields(resource, &key) {
                return Ok((found, None));
            }
            let start = Instant::now();
            let made = resource::make(&project, place, &resource.recipe, others)?;
            let keyed = made.into_iter().map(|mut made| {
                made.table.key = (!key.is_empty()).then(|| key::of_field(&key, made.field));
                Loaded::from(made)
            });
            Ok((keyed.collect(), Some(start.elapsed())))
        })?;
        let mut tables = Tables::default();
        for (index, (loaded, time)) in loaded.into_iter().enumerate() {
            loaded.iter().for_each(|loaded| self.learn(loaded, time.map(Some)));
            resource::enter(index, loaded, &mut program.manifest, &mut tables);
        }
        Ok(tables)
    }

    /// As [`bake::render_fixed`], without drawing what is known. The tables get their keys.
    ///
    /// # Errors
    /// As [`bake::render_fixed`] says.
    pub fn draw(&mut self, program: &mut Program, tables: &mut Tables) -> Result<(), RenderError> {
        key::enter_bakes(program);
        let bakes: Vec<(usize, Loaded)> = fixed(&program.manifest).collect();
        for (index, bake) in &bakes {
            if let Some(known) = self.find(&bake.table).filter(|known| known.table == bake.table) {
                tables.insert(*index, &bake.field, Arc::clone(&known.bytes));
                self.learn(&known, None);
            }
        }
        bake::render_fixed(program, tables)?;
        for (index, mut bake) in bakes {
            let is_known = bake.table.key.as_ref().is_some_and(|key| self.known.contains_key(key));
            if let Some(bytes) = tables.get(index, &bake.field).filter(|_| !is_known) {
                bake.bytes = Arc::clone(bytes);
                self.learn(&bake, Some(None));
            }
        }
        Ok(())
    }

    /// As [`resource::compress`], without compressing what is known. The tables get their keys.
    pub fn compress(&mut self, manifest: &mut Manifest, tables: &mut Tables) {
        let mut made = Vec::new();
        resource::compress_with(manifest, tables, |plain, format| {
            let Loaded { field, table, bytes } = plain;
            let key = table.key.as_deref().map(|plain| key::of_blocks(plain, format));
            if let Some(found) = key.as_deref().and_then(|key| self.by_key(key)) {
                return Some(found);
            }
            let start = Instant::now();
            let (table, bytes) = resource::blocks(table, bytes, format)?;
            let blocks = Loaded { field: field.clone(), table: Table { key, ..table }, bytes: bytes.into() };
            made.push((blocks.clone(), start.elapsed()));
            Some(blocks)
        });
        made.iter().for_each(|(blocks, time)| self.learn(blocks, Some(Some(*time))));
    }

    /// The files of all tables, whose names and offsets the manifest then has.
    pub fn pack(&mut self, manifest: &mut Manifest, tables: &Tables) -> Vec<Packed> {
        let mut packed = Vec::new();
        for (index, resource) in manifest.resources.iter_mut().enumerate() {
            for texture in &mut resource.textures {
                let (field, view) = (texture.field.clone(), texture.view);
                let forms = [
                    (&mut texture.table, "", tables.get(index, &field)),
                    (&mut texture.plain, ".plain", tables.plain(index, &field)),
                ];
                for (table, form, bytes) in forms {
                    let name = format!("{}.{}.{field}{form}.ktx2", manifest.texture, resource.name);
                    let (Some(table), Some(bytes)) = (table, bytes) else { continue };
                    let Some((placed, bytes)) = ktx2::write(view, table, bytes) else { continue };
                    *table = Table { file: Some(name.clone()), ..placed };
                    // A second file of the same table is a copy.
                    let made = table.key.as_ref().and_then(|key| self.made.remove(key));
                    let (is_made, time) = (made.is_some(), made.flatten());
                    packed.push(Packed { name, bytes: bytes.into(), is_made, time });
                }
            }
        }
        packed
    }

    /// The folder's files of a texture's tables that are not among these: of an older build.
    pub fn left<'a>(&'a self, texture: &str, files: &[&str]) -> Vec<&'a str> {
        let is_of_it = |name: &&str| name.strip_prefix(texture).is_some_and(|rest| rest.starts_with('.'));
        let left = self.files.keys().map(String::as_str).filter(is_of_it);
        left.filter(|name| !files.contains(name)).collect()
    }

    /// All that the shader reads of a resource, if all is known.
    fn fields(&self, resource: &Resource, key: &str) -> Option<Vec<Loaded>> {
        let known = resource.textures.iter().map(|texture| {
            let known = self.by_key(&key::of_field(key, &texture.field))?;
            Some(Loaded { field: texture.field.clone(), ..known })
        });
        known.collect()
    }

    /// What is known under a table's key.
    fn find(&self, table: &Table) -> Option<Loaded> {
        self.by_key(table.key.as_deref()?)
    }

    fn by_key(&self, key: &str) -> Option<Loaded> {
        if let Some(known) = self.known.get(key) {
            return Some(known.clone());
        }
        let names = self.files.iter().filter(|(_, other)| *other == key).map(|(name, _)| name);
        let mut whole = names.filter_map(|name| ktx2::read(&read(&self.folder.join(name), ktx2::MAX_FILE)?));
        let (table, bytes) = whole.find(|(table, _)| table.key.as_deref() == Some(key))?;
        Some(Loaded { field: String::new(), table, bytes: bytes.into() })
    }

    /// Keeps a table, and whether it was made.
    fn learn(&mut self, loaded: &Loaded, made: Option<Option<Duration>>) {
        let Some(key) = &loaded.table.key else { return };
        self.known.insert(key.clone(), loaded.clone());
        if let Some(time) = made {
            self.made.insert(key.clone(), time);
        }
    }
}

/// The bakes that have a key, and so depend on no param: the resource and its table, without bytes.
fn fixed(manifest: &Manifest) -> impl Iterator<Item = (usize, Loaded)> {
    let bakes = manifest.passes.iter().filter_map(|pass| pass.bake).map(|bake| bake as usize);
    bakes.filter_map(|bake| {
        let texture = manifest.resources.get(bake)?.textures.first()?;
        let table = texture.table.clone().filter(|table| table.key.is_some())?;
        Some((bake, Loaded { field: texture.field.clone(), table, bytes: Arc::default() }))
    })
}

/// The first bytes of a regular file: a pipe would never end.
fn read(path: &Path, most: u64) -> Option<Vec<u8>> {
    fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
    let mut bytes = Vec::new();
    File::open(path).ok()?.take(most).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}
