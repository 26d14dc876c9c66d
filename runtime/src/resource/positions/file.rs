//! The sprites of a RON file.

use super::{Positions, Refused, Sprite};
use crate::project::Project;
use crate::resource::decode::unread;
use crate::resource::patterns;
use crate::resource::table::{self, Made};
use std::collections::HashMap;
use texgraph_compiler::Program;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};
use texgraph_compiler::manifest::{Format, Recipe, Resource};

/// Sprites of a file of which it is told that they can't be placed.
const MAX_ERRORS: usize = 8;

/// The map of a program's resource as its file has it, to be edited while the program runs. Sprites
/// are numbered in the file's order ([`Positions::sprites`]).
///
/// # Errors
/// There is no positions map of that name; or what loading it finds.
pub fn open(program: &Program, project: &Project, name: &str) -> Result<Positions, Vec<Diagnostic>> {
    let known = &program.manifest.resources;
    let found = known.iter().position(|resource| resource.name == name);
    let (index, recipe) = match found.and_then(|index| Some((index, &known.get(index)?.recipe))) {
        Some((index, recipe @ Recipe::Positions { .. })) => (index, recipe),
        _ => {
            let message = format!("there is no positions map `{name}`");
            return Err(vec![resources::no_table(Place::default(), message, "in this program")]);
        }
    };
    let places = &program.texture().graph.resources;
    let place = places.get(index).map(|resource| resource.place).unwrap_or_default();
    read(project, place, recipe, known)
}

/// Makes the texture.
///
/// # Errors
/// The file can't be read or holds something other than sprites; two sprites want one cell; a sprite
/// is too large or has no pattern.
pub fn make(
    project: &Project,
    place: Place,
    recipe: &Recipe,
    known: &[Resource],
) -> Result<Vec<Made>, Vec<Diagnostic>> {
    let map = read(project, place, recipe, known)?;
    Ok(vec![Made { field: "cells", table: map.table(), bytes: map.bytes().to_vec() }])
}

fn read(
    project: &Project,
    place: Place,
    recipe: &Recipe,
    known: &[Resource],
) -> Result<Positions, Vec<Diagnostic>> {
    let refuse = |message: String, reason: &str| vec![resources::no_table(place, message, reason)];
    let Recipe::Positions { path, grid, layers, patterns } = recipe else {
        return Err(refuse("these are no positions".into(), "another kind of resource"));
    };
    let count = match known.get(*patterns as usize).map(|resource| &resource.recipe) {
        Some(Recipe::Patterns { paths, grid, .. }) => patterns::count(paths, *grid).min(256) as u32,
        _ => return Err(refuse("positions of no patterns".into(), "another kind of resource")),
    };
    table::check(place, path, Format::Rgba32Sint, *grid, *layers)?;
    let wrong = |refused: Refused| refuse(refused.to_string(), "2 to 4096 cells a side, 1 to 8 layers");
    let mut map = Positions::new(*grid, *layers, count).map_err(wrong)?;
    let bytes = project.read(path).map_err(|error| vec![unread(place, path, error.problem)])?;
    let sprites: Vec<Sprite> = ron::de::from_bytes(&bytes)
        .map_err(|error| vec![resources::not_sprites(place, path, &error.to_string())])?;
    let (mut placed, mut errors) = (HashMap::new(), Vec::new());
    for (number, sprite) in sprites.into_iter().enumerate() {
        match map.insert(sprite) {
            Ok(id) => drop(placed.insert(id, number)),
            Err(Refused::Taken { cell, by }) => {
                let other = placed.get(&by).copied().unwrap_or_default();
                errors.push(resources::cell_taken(place, path, [other, number], cell, *layers));
            }
            Err(other) => errors.push(resources::bad_sprite(place, path, number, &other.to_string())),
        }
    }
    errors.truncate(MAX_ERRORS);
    map.take_writes();
    if errors.is_empty() { Ok(map) } else { Err(errors) }
}
