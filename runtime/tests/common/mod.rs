//! Made-up programs and pictures.

#![allow(dead_code)] // every test file uses its own part

pub mod bakes;
pub mod decals;
pub mod folds;
pub mod programs;

use std::path::Path;
use tempfile::TempDir;
use texgraph_compiler::Program;
use texgraph_compiler::diagnostic::{Diagnostic, Place};
use texgraph_compiler::graph::Graph;
use texgraph_compiler::manifest::{
    Filter, Form, Gradients, Manifest, Pass, Recipe, Resource, SampleKind, Sampler, Texture, VERSION,
    ViewDimension, Wrap,
};
use texgraph_runtime::project::Project;
use texgraph_runtime::resource::{Tables, load};

/// A folder that is removed at the end of the test.
pub fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// The project of `main.tex` in a folder.
pub fn project(folder: &Path) -> Project {
    Project::new(&folder.join("main.tex"), false)
}

/// Writes an 8-bit picture; the number of channels follows from the samples.
pub fn write_picture(path: &Path, size: [u32; 2], samples: &[u8]) {
    let color = match samples.len() as u32 / (size[0] * size[1]) {
        1 => image::ExtendedColorType::L8,
        2 => image::ExtendedColorType::La8,
        3 => image::ExtendedColorType::Rgb8,
        _ => image::ExtendedColorType::Rgba8,
    };
    image::save_buffer(path, samples, size[0], size[1], color).expect("the picture is written");
}

/// Writes a grey picture of 16 bits.
pub fn write_deep(path: &Path, size: [u32; 2], samples: &[u16]) {
    let bytes: Vec<u8> = samples.iter().flat_map(|sample| sample.to_ne_bytes()).collect();
    image::save_buffer(path, &bytes, size[0], size[1], image::ExtendedColorType::L16)
        .expect("the picture is written");
}

/// A manifest with nothing in it.
pub fn manifest() -> Manifest {
    Manifest {
        version: VERSION,
        generator: "test".into(),
        texture: "test".into(),
        label: String::new(),
        form: Form::Complete,
        inputs: Vec::new(),
        gradients: Vec::new(),
        outputs: Vec::new(),
        discard_below: None,
        tiles: None,
        params: Vec::new(),
        uniform: None,
        resources: Vec::new(),
        passes: vec![Pass {
            name: "test".into(),
            bake: None,
            reads: Vec::new(),
            params: Vec::new(),
            shader: "test.wgsl".into(),
            entry_point: "main".into(),
            call: None,
            gradients: Gradients::Derive,
        }],
    }
}

/// A resource with one texture, sampled or not, at the bindings 2n + 1 and 2n + 2 of group 0.
pub fn resource(recipe: Recipe, n: u32, wrap: Wrap, filter: Filter) -> Resource {
    let (field, view, sample) = match &recipe {
        Recipe::Image { .. } => ("pixels", ViewDimension::D2, SampleKind::Float),
        Recipe::Patterns { .. } | Recipe::Strips { .. } | Recipe::Volumes { .. } => {
            ("layers", ViewDimension::D2Array, SampleKind::Float)
        }
        Recipe::Permutation { .. } | Recipe::Probability { .. } => {
            ("table", ViewDimension::D2, SampleKind::Int)
        }
        Recipe::Materials { .. } => ("layers", ViewDimension::D2Array, SampleKind::Float),
        Recipe::Indices { .. } | Recipe::Line { .. } => ("map", ViewDimension::D2, SampleKind::Int),
        Recipe::Stack { .. } => ("map", ViewDimension::D2Array, SampleKind::Int),
        Recipe::Tables { .. } => ("table", ViewDimension::D2, SampleKind::Int),
        Recipe::Positions { .. } => ("cells", ViewDimension::D2Array, SampleKind::Int),
        Recipe::PixelMap { .. } => ("blocks", ViewDimension::D2, SampleKind::Int),
        Recipe::Ramp { .. } => ("colors", ViewDimension::D2, SampleKind::Float),
        Recipe::Exemplar { .. } => ("gaussian", ViewDimension::D2, SampleKind::Float),
        Recipe::Volume { .. } => ("gaussian", ViewDimension::D2Array, SampleKind::Float),
        Recipe::Bake { .. } => ("pixels", ViewDimension::D2, SampleKind::Float),
    };
    let sampler =
        Sampler { name: format!("s{n}_"), group: 0, binding: 2 * n + 2, wrap, filter, anisotropy: 1 };
    Resource {
        name: format!("r{n}"),
        label: String::new(),
        recipe,
        textures: vec![Texture {
            field: field.into(),
            name: format!("t{n}_"),
            group: 0,
            binding: 2 * n + 1,
            view,
            sample,
            sampler: (sample == SampleKind::Float).then_some(sampler),
            table: None,
            plain: None,
        }],
    }
}

/// A graph whose resources stand at places 0, 1, 2, …, which only errors look at.
pub fn graph_of(manifest: &Manifest) -> Graph {
    let resources = manifest.resources.iter().enumerate().map(|(index, resource)| {
        texgraph_compiler::resource::Resource {
            name: resource.name.clone(),
            label: String::new(),
            place: Place { file: index as u32, ..Place::default() },
            recipe: resource.recipe.clone(),
            sampler: None,
            bake: None,
        }
    });
    Graph { resources: resources.collect(), ..Graph::default() }
}

/// Loads recipes from a folder.
pub fn load_recipes(folder: &Path, recipes: Vec<Recipe>) -> Result<(Manifest, Tables), Vec<Diagnostic>> {
    let mut manifest = manifest();
    let numbered = (0..).zip(recipes);
    manifest.resources =
        numbered.map(|(n, recipe)| resource(recipe, n, Wrap::Repeat, Filter::Linear)).collect();
    let pass = texgraph_compiler::Pass { graph: graph_of(&manifest), wgsl: String::new() };
    let mut program = Program { passes: vec![pass], manifest };
    load(&mut program, &project(folder)).map(|tables| (program.manifest, tables))
}
