//! Whether the mean colour of 16 × 16 repeats is the photograph's at every level of detail, with the
//! table as it is filtered for each level and with its first row for all.

use crate::{REPEATS, loaded, word};
use texgraph_compiler::manifest::{Encoding, Recipe};
use texgraph_compiler::{Library, Program};
use texgraph_runtime::cpu::Scene;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::Tables;

/// Rows of pixels that are drawn at a time.
const BAND: u32 = 1 << 9;

pub fn tell<'a>(library: &Library, photos: impl Iterator<Item = &'a (&'a str, Encoding)>) {
    println!("| photograph, `wrap: repeat` | filtered for each level | by the first row |");
    println!("| --- | --- | --- |");
    for (file, encoding) in photos.filter(|(_, encoding)| *encoding != Encoding::Normal) {
        let text = format!(
            "let e = exemplar(\"{file}\", encoding: {word}, wrap: repeat)\nlet i = image(\"{file}\", encoding: {word})\n\
             texture repeated(uv: vec2) -> (value: vec4) {{ value = i.sample(uv) }}\n\
             texture blended(uv: vec2) -> (value: vec4) {{ value = e.stochastic(uv) }}\n",
            word = word(*encoding),
        );
        let (program, tables) = loaded(library, &text, "blended");
        let (repeated, plain) = loaded(library, &text, "repeated");
        let side = plain.get(0, "pixels").or(plain.get(1, "pixels")).map_or(0, |bytes| side(bytes.len()));
        // One repeat is like another.
        let expected = |level: u32| mean(&repeated, &plain, 1, (side >> level).max(1));
        let first = first_rows(&program, &tables);
        let told = [&tables, &first].map(|tables| {
            let levels = (0..=side.ilog2()).map(|level| {
                let found = mean(&program, tables, REPEATS, (REPEATS * side) >> level);
                let expected = expected(level);
                let apart = (0..3).map(|k| 255.0 * (found[k] - expected[k]).abs());
                (apart.fold(0.0, f64::max), level)
            });
            let (most, level) = levels.max_by(|a, b| a.0.total_cmp(&b.0)).expect("there is a level");
            format!("{most:.2} at level {level}")
        });
        println!("| {} | {} | {} |", file.split('.').next().unwrap_or(file), told[0], told[1]);
    }
}

/// Texels along a side, of so many bytes of four a texel with all levels.
fn side(bytes: usize) -> u32 {
    1 << ((bytes as f64 * 0.75 / 4.0).log2() / 2.0).round() as u32
}

/// The mean colour of so many repeats along each axis drawn in `size`² pixels, in linear light.
fn mean(program: &Program, tables: &Tables, repeats: u32, size: u32) -> [f64; 3] {
    let mut scene = Scene::new(program, tables, 0).expect("it can be drawn");
    let repeats = f64::from(repeats);
    let mut sums = [0.0; 3];
    for top in (0..size).step_by(BAND as usize) {
        let rows = BAND.min(size - top);
        let [y0, y1] = [top, top + rows].map(|y| f64::from(y) / f64::from(size) * repeats);
        let request = Request { region: [0.0, y0, repeats, y1], ..Request::new([size, rows]) };
        let picture = scene.render(&request, &|_| {}).expect("it is drawn");
        for pixel in &picture.pixels {
            sums.iter_mut().zip(pixel).for_each(|(sum, x)| *sum += f64::from(*x));
        }
    }
    sums.map(|sum| sum / f64::from(size).powi(2))
}

/// The tables with each channel's first row in place of the others.
fn first_rows(program: &Program, tables: &Tables) -> Tables {
    let resources = &program.manifest.resources;
    let e = resources.iter().position(|resource| resource.name == "e").expect("the exemplar is there");
    let bytes = tables.get(e, "inverse").expect("the table is there");
    let levels = Recipe::INVERSE_LEVELS as usize;
    let row = 8 * 256;
    let mut changed = bytes.to_vec();
    for rows in changed.chunks_exact_mut(levels * row) {
        let (first, others) = rows.split_at_mut(row);
        others.chunks_exact_mut(row).for_each(|other| other.copy_from_slice(first));
    }
    let mut tables = tables.clone();
    tables.insert(e, "inverse", changed);
    tables
}
