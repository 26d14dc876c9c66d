//! Keys: what a table is made of, hashed.
//!
//! A key stands for the recipe of a table and the content of every file that it is made of, so a table
//! under the same key is the same, byte for byte. Indices of other resources are no part of it: what
//! they stand for is, so that a resource more or less in the program changes no key.

use crate::project::Project;
use std::collections::BTreeMap;
use texgraph_compiler::Program;
use texgraph_compiler::manifest::{Format, Recipe, Resource, Texture};

/// How tables are made, as a number. Raise it with every change of the bytes that some recipe gives
/// (the test `making` finds most): tables made otherwise are then made
/// anew.
pub const MAKING: u32 = 2;

/// Resources that are made of resources that are made of resources…: no program has as many.
const MAX_DEPTH: u32 = 8;

/// The hash of a file of tables, given as its head and its data.
pub fn sum(head: &[u8], data: &[u8]) -> String {
    hex(&blake3::Hasher::new().update(head).update(data).finalize())
}

/// Letters of a hash: 128 bits, more than can be found twice.
pub const LENGTH: usize = 32;

fn hex(hash: &blake3::Hash) -> String {
    hash.to_hex().chars().take(LENGTH).collect()
}

/// What is hashed: parts with their lengths, so that none can pass for the end of another.
struct Hasher(blake3::Hasher);

impl Hasher {
    fn new(purpose: &str) -> Hasher {
        let mut hasher = Hasher(blake3::Hasher::new());
        hasher.add(env!("CARGO_PKG_VERSION"));
        hasher.add(MAKING.to_le_bytes());
        hasher.add(purpose);
        hasher
    }

    fn add(&mut self, part: impl AsRef<[u8]>) {
        let part = part.as_ref();
        self.0.update(&(part.len() as u64).to_le_bytes());
        self.0.update(part);
    }

    fn finish(&self) -> String {
        hex(&self.0.finalize())
    }
}

/// The key of a resource, and a project in which the files that went into it can't change any more:
/// what is made with that is what the key says. None where a file can't be read.
pub fn of_resource(project: &Project, recipe: &Recipe, known: &[Resource]) -> Option<(String, Project)> {
    let mut files = BTreeMap::new();
    let mut hasher = Hasher::new("resource");
    add_recipe(&mut hasher, recipe, known, MAX_DEPTH)?;
    for path in paths(recipe, known, MAX_DEPTH)? {
        let bytes = project.read(path).ok()?;
        hasher.add(&bytes);
        files.insert(path.to_owned(), bytes.into());
    }
    Some((hasher.finish(), project.holding(files)))
}

/// The key of one of a resource's fields.
pub fn of_field(resource: &str, field: &str) -> String {
    let mut hasher = Hasher::new("field");
    hasher.add(resource);
    hasher.add(field);
    hasher.finish()
}

/// The key of the compressed form of a table.
pub fn of_blocks(plain: &str, format: Format) -> String {
    let mut hasher = Hasher::new("blocks");
    hasher.add(plain);
    hasher.add(String::from(format));
    hasher.finish()
}

/// Enters the keys of the bakes that depend on no param into the manifest: of the shader, of the size,
/// and of all that the bake reads. What it reads must have its key.
pub fn enter_bakes(program: &mut Program) {
    for number in 0..program.passes.len() {
        let Some((bake, key)) = of_bake(program, number) else { continue };
        let resource = program.manifest.resources.get_mut(bake);
        let texture = resource.and_then(|resource| resource.textures.first_mut());
        if let Some(table) = texture.and_then(|texture| texture.table.as_mut()) {
            table.key = Some(key);
        }
    }
}

/// The resource that a pass fills, and its key. None where a param changes it, or one of the textures it
/// reads has no key: another bake, that a param changes.
fn of_bake(program: &Program, number: usize) -> Option<(usize, String)> {
    let Program { passes, manifest } = program;
    let described = manifest.passes.get(number).filter(|pass| pass.params.is_empty())?;
    let bake = described.bake? as usize;
    let mut hasher = Hasher::new("bake");
    hasher.add(ron::to_string(&manifest.resources.get(bake)?.recipe).ok()?);
    hasher.add(unbound(&passes.get(number)?.wgsl));
    for (resource, field) in &described.reads {
        let resource = manifest.resources.get(*resource as usize)?;
        let texture = resource.textures.iter().find(|texture| texture.field == *field)?;
        hasher.add(plain_key(texture)?);
        let sampler = texture.sampler.as_ref().map(|s| (s.wrap, s.filter, s.anisotropy));
        hasher.add(ron::to_string(&sampler).ok()?);
    }
    Some((bake, hasher.finish()))
}

/// The key of what the CPU reads of a texture.
fn plain_key(texture: &Texture) -> Option<&String> {
    texture.plain.as_ref().or(texture.table.as_ref())?.key.as_ref()
}

/// A shader without its bindings, which other resources move.
fn unbound(wgsl: &str) -> String {
    wgsl.lines().filter(|line| !line.starts_with("@group")).flat_map(|line| [line, "\n"]).collect()
}

/// Adds a recipe and those of the resources that it names.
fn add_recipe(hasher: &mut Hasher, recipe: &Recipe, known: &[Resource], depth: u32) -> Option<()> {
    let mut alone = recipe.clone();
    match &mut alone {
        Recipe::Materials { items, .. } => items.clear(),
        Recipe::Positions { patterns, .. } => *patterns = 0,
        Recipe::Tables { rows } => rows.clear(),
        _ => {}
    }
    hasher.add(ron::to_string(&alone).ok()?);
    let parts = recipe.resources();
    hasher.add((parts.len() as u64).to_le_bytes());
    for index in parts {
        add_recipe(hasher, &known.get(*index as usize)?.recipe, known, depth.checked_sub(1)?)?;
    }
    Some(())
}

/// The files that a table is made of.
fn paths<'a>(recipe: &'a Recipe, known: &'a [Resource], depth: u32) -> Option<Vec<&'a str>> {
    let mut paths = recipe.files();
    // Of other resources only these take what is in their pictures.
    if let Recipe::Materials { items, .. } = recipe {
        for index in items {
            paths.extend(self::paths(&known.get(*index as usize)?.recipe, known, depth.checked_sub(1)?)?);
        }
    }
    Some(paths)
}
