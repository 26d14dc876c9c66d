//! What a compiled program costs: reads and arithmetic per pixel, loops, bindings, bytes.
//!
//! Everything is read off the graphs after all passes, so it is what the shaders do; nothing runs.
//! Two figures are given. The *worst* case takes every loop to its bound and of every branch the
//! dearer arm, for each figure on its own. The *typical* case has the params at their defaults and
//! evaluates what depends on nothing else: a branch so decided takes that arm and a loop so bounded
//! that many steps; of any other branch each arm counts half, and a loop with a `while` takes half
//! of its steps. An `if` that is no branch computes both arms in either case (see
//! [`crate::graph::regions`]).

mod arithmetic;
mod count;
mod known;
#[cfg(test)]
mod tests;

pub use arithmetic::Arithmetic;

use crate::graph::{Fold, Function, Graph, Operation, Place};
use crate::manifest::{self, Manifest, Recipe};
use crate::module::Sources;
use crate::{Compiled, Pass};
use count::Count;
use serde::Serialize;

/// What a program costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// The texture's name.
    pub texture: String,
    /// Its shaders: bakes in the order in which they are drawn, then the texture itself.
    pub passes: Vec<PassCost>,
    /// What its shaders read.
    pub tables: Vec<TableCost>,
    /// Bytes of the tables whose size is known.
    pub table_bytes: u64,
    /// The uniform block that all its shaders share, in bytes.
    pub uniform_bytes: u32,
}

/// What one shader costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PassCost {
    /// The texture's name, or the baked resource's.
    pub name: String,
    /// Of a bake: its texels, each one pixel of this shader.
    pub texels: Option<u64>,
    /// Per pixel.
    pub worst: Counts,
    /// Per pixel.
    pub typical: Counts,
    /// The loops that the shader holds, in source order.
    pub loops: Vec<Loop>,
    /// Textures that it reads.
    pub textures: usize,
    /// Samplers that it reads them through.
    pub samplers: usize,
}

/// What a pixel takes. All figures are at most 10¹⁵: what is beyond stays there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Counts {
    /// Filtered samples.
    pub samples: f64,
    /// Texels fetched by their index.
    pub fetches: f64,
    /// Samples and fetches together. In the worst case no more than their sum: the arm with the
    /// most samples may not be the one with the most fetches.
    pub reads: f64,
    /// Operations on numbers, by kind; on vectors one for each component.
    pub arithmetic: Arithmetic,
}

/// A loop of a shader.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Loop {
    /// Steps at most.
    pub most: u32,
    /// Steps in the typical case.
    pub typical: f64,
    /// The node that holds it.
    pub node: String,
    /// The file that its `fold` is written in.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
}

/// The bytes behind a texture of a program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TableCost {
    /// The resource and its field: `grass.layers`.
    pub name: String,
    /// Bytes of all levels; none while nothing is loaded.
    pub bytes: Option<u64>,
    /// Format, size and levels, for people; empty while nothing is loaded.
    pub layout: String,
}

impl Cost {
    /// The shader of the texture itself: what each pixel on the screen takes.
    pub fn texture(&self) -> Option<&PassCost> {
        self.passes.last()
    }

    /// Whether a table's size is not known.
    pub fn has_unknown_tables(&self) -> bool {
        self.tables.iter().any(|table| table.bytes.is_none())
    }
}

/// What a compiled program costs. Bytes are known of what was loaded before.
pub fn cost(compiled: &Compiled) -> Cost {
    let manifest = &compiled.program.manifest;
    let passes = compiled.program.passes.iter().zip(&manifest.passes);
    let tables = tables(manifest);
    Cost {
        texture: manifest.texture.clone(),
        passes: passes
            .map(|(pass, described)| pass_cost(pass, described, manifest, &compiled.sources))
            .collect(),
        table_bytes: tables.iter().filter_map(|table| table.bytes).sum(),
        tables,
        uniform_bytes: manifest.uniform.as_ref().map_or(0, |uniform| uniform.size),
    }
}

fn pass_cost(pass: &Pass, described: &manifest::Pass, manifest: &Manifest, sources: &Sources) -> PassCost {
    let known = known::at_defaults(&pass.graph);
    let Count { worst, typical } = count::entry(&pass.graph, &known);
    let read = textures(manifest, described);
    PassCost {
        name: described.name.clone(),
        texels: described.bake.and_then(|resource| texels(manifest, resource)),
        worst,
        typical,
        loops: loops(&pass.graph, &known, sources),
        textures: read.len(),
        samplers: read.iter().filter(|texture| texture.sampler.is_some()).count(),
    }
}

/// The textures that a pass reads.
pub fn textures<'a>(manifest: &'a Manifest, pass: &manifest::Pass) -> Vec<&'a manifest::Texture> {
    let read = pass.reads.iter().filter_map(|(resource, field)| {
        let resource = manifest.resources.get(*resource as usize)?;
        resource.textures.iter().find(|texture| texture.field == *field)
    });
    read.collect()
}

fn texels(manifest: &Manifest, resource: u32) -> Option<u64> {
    match manifest.resources.get(resource as usize)?.recipe {
        Recipe::Bake { size: [width, height], .. } => Some(u64::from(width) * u64::from(height)),
        _ => None,
    }
}

fn tables(manifest: &Manifest) -> Vec<TableCost> {
    let textures = manifest.resources.iter().flat_map(|resource| {
        resource.textures.iter().map(move |texture| (format!("{}.{}", resource.name, texture.field), texture))
    });
    let costs = textures.map(|(name, texture)| TableCost {
        name,
        bytes: texture.table.as_ref().map(manifest::Table::bytes),
        layout: texture.table.as_ref().map_or(String::new(), layout),
    });
    costs.collect()
}

/// `rgba8unorm-srgb 128×128×16, 8 levels`
fn layout(table: &manifest::Table) -> String {
    let format = String::from(table.format);
    let layers = if table.layers > 1 { format!("×{}", table.layers) } else { String::new() };
    let levels = match table.levels.len() {
        1 => String::new(),
        count => format!(", {count} levels"),
    };
    format!("{format} {}×{}{layers}{levels}", table.width, table.height)
}

/// Every loop once, however often its node is called.
fn loops(graph: &Graph, known: &known::Known, sources: &Sources) -> Vec<Loop> {
    let mut found: Vec<(Place, Loop)> = Vec::new();
    for (index, function) in graph.functions.iter().enumerate().filter(|(index, _)| known.is_reached(*index))
    {
        for (value, operation) in function.iter() {
            let Operation::Fold(fold) = operation else { continue };
            let place = function.places.get(value.0 as usize).copied().unwrap_or_default();
            let steps = known.steps(index, function, fold);
            let (file, line) = line(sources, place);
            let node = named(graph, function).to_owned();
            found.push((place, Loop { most: bound(function, fold), typical: steps, node, file, line }));
        }
    }
    found.sort_by_key(|(place, written)| (*place, written.most));
    found.dedup();
    found.into_iter().map(|(_, written)| written).collect()
}

/// The name of the node that a function is a part of.
fn named<'a>(graph: &'a Graph, function: &'a Function) -> &'a str {
    let entry = graph.functions.last().map_or("", |entry| entry.name.as_str());
    if function.name.is_empty() { entry } else { &function.name }
}

/// The steps of a fold at most.
fn bound(function: &Function, fold: &Fold) -> u32 {
    match function.operation(fold.steps) {
        Operation::Constant(steps) => u32::try_from(steps.int(0)).unwrap_or(0).min(fold.most),
        _ => fold.most,
    }
}

/// The file of a place and its line, from 1.
fn line(sources: &Sources, place: Place) -> (String, usize) {
    let Some(source) = sources.get(place) else { return (String::new(), 1) };
    let before = source.text.get(..place.span.start as usize).unwrap_or_default();
    (source.path.clone(), before.bytes().filter(|byte| *byte == b'\n').count() + 1)
}
