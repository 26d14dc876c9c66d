//! Resources: from the recipes of a program to the bytes of its textures.
//!
//! One file per kind makes the bytes of its fields; `make` is the table of kinds. Everything here
//! runs on the CPU, in parallel, and gives the same bytes for any number of threads and on any
//! machine. Errors are found all at once and stand at the constructor calls.

mod compress;
pub(crate) mod decode;
mod encoding;
pub mod exemplar;
mod image;
mod indices;
mod materials;
mod patterns;
mod permutation;
pub mod pixel_map;
pub mod positions;
mod probability;
pub(crate) mod pyramid;
mod ramp;
mod resample;
mod shape;
pub(crate) mod table;
mod tables;

pub use compress::compress;
pub(crate) use compress::{blocks, compress_with};
pub use decode::Decoded;
pub use encoding::{SrgbEncoder, srgb_to_linear};
pub(crate) use table::Loaded;
pub(crate) use table::MAX_LAYERS;
pub use table::Made;

use crate::project::Project;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use shape::Shape;
use std::sync::Arc;
use texgraph_compiler::Program;
use texgraph_compiler::diagnostic::{Diagnostic, Place};
use texgraph_compiler::manifest::{Compression, Manifest, Recipe, Resource, Table, Texture};

/// The bytes of every texture of a program. Cloning shares them.
#[derive(Clone, Debug, Default)]
pub struct Tables {
    entries: Vec<Entry>,
}

#[derive(Clone, Debug)]
struct Entry {
    resource: usize,
    field: String,
    bytes: Arc<[u8]>,
    /// Where those are compressed, the same without.
    plain: Option<Arc<[u8]>>,
}

impl Tables {
    /// The bytes of a field of a resource (an index into the manifest's `resources`), laid out as
    /// the texture's `table` says.
    pub fn get(&self, resource: usize, field: &str) -> Option<&Arc<[u8]>> {
        let found = self.entries.iter().find(|entry| entry.resource == resource && entry.field == field);
        found.map(|entry| &entry.bytes)
    }

    /// The bytes of a field without compression, where [`Tables::get`] gives compressed ones: laid out
    /// as the texture's `plain` says.
    pub fn plain(&self, resource: usize, field: &str) -> Option<&Arc<[u8]>> {
        let found = self.entries.iter().find(|entry| entry.resource == resource && entry.field == field);
        found.and_then(|entry| entry.plain.as_ref())
    }

    /// Adds or replaces the bytes of a field: how a package made ahead of time comes in.
    pub fn insert(&mut self, resource: usize, field: &str, bytes: impl Into<Arc<[u8]>>) {
        self.entries.retain(|entry| entry.resource != resource || entry.field != field);
        self.entries.push(Entry { resource, field: field.to_string(), bytes: bytes.into(), plain: None });
    }

    /// Those of a field that a renderer can read, with their layout.
    pub(crate) fn readable<'a>(
        &'a self,
        resource: usize,
        texture: &'a Texture,
        reads_blocks: bool,
    ) -> Option<(&'a Table, &'a Arc<[u8]>)> {
        match &texture.plain {
            Some(plain) if !reads_blocks => Some((plain, self.plain(resource, &texture.field)?)),
            _ => Some((texture.table.as_ref()?, self.get(resource, &texture.field)?)),
        }
    }

    fn entry(&mut self, resource: usize, field: &str) -> Option<&mut Entry> {
        self.entries.iter_mut().find(|entry| entry.resource == resource && entry.field == field)
    }

    /// All fields: resource, name, bytes; in the order of the manifest.
    pub fn iter(&self) -> impl Iterator<Item = (usize, &str, &[u8])> {
        self.entries.iter().map(|entry| (entry.resource, entry.field.as_str(), entry.bytes.as_ref()))
    }
}

/// Makes the textures of all resources that the program reads, and fills in
/// [`texgraph_compiler::manifest::Texture::table`] (without a file).
///
/// # Errors
/// Everything that is wrong with any resource, in the order of the resources.
pub fn load(program: &mut Program, project: &Project) -> Result<Tables, Vec<Diagnostic>> {
    let loaded = for_each(program, |place, resource, known| {
        let made = make(project, place, &resource.recipe, known)?;
        Ok(made.into_iter().map(Loaded::from).collect())
    })?;
    let mut tables = Tables::default();
    for (index, loaded) in loaded.into_iter().enumerate() {
        enter(index, loaded, &mut program.manifest, &mut tables);
    }
    Ok(tables)
}

/// What a function gives for each resource that the program reads, in parallel, and for the others
/// nothing; or all errors. The function gets the place of the constructor call, the resource and all
/// resources.
pub(crate) fn for_each<T: Default + Send>(
    program: &Program,
    each: impl Fn(Place, &Resource, &[Resource]) -> Result<T, Vec<Diagnostic>> + Send + Sync,
) -> Result<Vec<T>, Vec<Diagnostic>> {
    let graph = &program.texture().graph;
    let known = &program.manifest.resources;
    let numbered: Vec<(usize, &Resource)> = known.iter().enumerate().collect();
    all(&numbered, |(index, resource)| {
        if resource.textures.is_empty() {
            return Ok(T::default());
        }
        let place = graph.resources.get(*index).map(|resource| resource.place).unwrap_or_default();
        each(place, resource, known)
    })
}

/// The kinds: which file makes what a recipe asks for.
pub(crate) fn make(
    project: &Project,
    place: Place,
    recipe: &Recipe,
    known: &[Resource],
) -> Result<Vec<Made>, Vec<Diagnostic>> {
    match recipe {
        Recipe::Image { path, encoding, tileable } => image::make(project, place, path, *encoding, *tileable),
        Recipe::Patterns { paths, grid, encoding } => {
            patterns::make(project, place, paths, *grid, Shape::Plane, *encoding)
        }
        Recipe::Strips { paths, grid, encoding } => {
            patterns::make(project, place, paths, *grid, Shape::Line, *encoding)
        }
        Recipe::Volumes { paths, grid, depth, encoding } => {
            patterns::make(project, place, paths, *grid, Shape::Space { depth: *depth }, *encoding)
        }
        Recipe::Permutation { size, seed } => permutation::make(place, *size, *seed),
        // A row of the shared tables, and nothing of its own.
        Recipe::Probability { .. } => Ok(Vec::new()),
        Recipe::Materials { items, size, .. } => materials::make(project, place, items, *size, known),
        Recipe::Indices { source, levels } => indices::make(project, place, source, *levels, Shape::Plane),
        Recipe::Line { source, levels } => indices::make(project, place, source, *levels, Shape::Line),
        Recipe::Stack { source, levels, depth } => {
            indices::make(project, place, source, *levels, Shape::Space { depth: *depth })
        }
        Recipe::Positions { .. } => positions::make(project, place, recipe, known),
        Recipe::PixelMap { path, block, levels } => pixel_map::make(project, place, path, *block, *levels),
        Recipe::Ramp { stops, space } => Ok(vec![ramp::make(stops, *space)]),
        Recipe::Tables { rows } => tables::make(place, rows, known),
        Recipe::Exemplar { path, encoding, channels, borders, lut, compress } => {
            let (encoding, channels, borders) = (*encoding, *channels, *borders);
            let wanted =
                exemplar::Wanted { encoding, channels, slices: 1, borders, lut: *lut, compress: *compress };
            exemplar::make(project, place, path, &wanted)
        }
        Recipe::Volume { paths, grid, encoding, channels, borders, lut } => {
            let (encoding, channels, borders) = (*encoding, *channels, *borders);
            let slices = u32::try_from(patterns::count(paths, *grid)).unwrap_or(u32::MAX);
            let compress = Compression::None;
            let wanted = exemplar::Wanted { encoding, channels, slices, borders, lut: *lut, compress };
            exemplar::make_volume(project, place, paths, *grid, &wanted)
        }
        // Made by rendering its pass.
        Recipe::Bake { .. } => Ok(Vec::new()),
    }
}

/// The results for all items, in parallel; or all errors, in their order.
fn all<'a, T: Sync, R: Send>(
    items: &'a [T],
    f: impl Fn(&'a T) -> Result<R, Vec<Diagnostic>> + Send + Sync,
) -> Result<Vec<R>, Vec<Diagnostic>> {
    let results: Vec<_> = items.par_iter().map(f).collect();
    let (mut done, mut errors) = (Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok(one) => done.push(one),
            Err(found) => errors.extend(found),
        }
    }
    if errors.is_empty() { Ok(done) } else { Err(errors) }
}

/// Keeps the fields that the shader reads, in the manifest's order.
pub(crate) fn enter(index: usize, mut loaded: Vec<Loaded>, manifest: &mut Manifest, tables: &mut Tables) {
    for texture in &mut manifest.resources[index].textures {
        if let Some(at) = loaded.iter().position(|loaded| loaded.field == texture.field) {
            let Loaded { table, bytes, .. } = loaded.swap_remove(at);
            texture.table = Some(table);
            tables.insert(index, &texture.field, bytes);
        }
    }
}
