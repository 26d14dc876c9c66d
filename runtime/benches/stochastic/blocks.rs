//! What block compression costs an exemplar, with its Gaussian numbers as they are and spread as far as
//! its colours (Deliot & Heitz 2019, §1.6, figure 1.12).

use crate::loaded;
use block_compression::decode::decompress_blocks_as_rgba8;
use block_compression::{BC7Settings, CompressionVariant};
use image::RgbImage;
use std::path::Path;
use texgraph_compiler::manifest::{Compression, Encoding, Format, Recipe};
use texgraph_compiler::{Library, Program};
use texgraph_runtime::cpu::Scene;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{SrgbEncoder, Tables, compress};

/// Pixels along a side of what is compared, of 1.5 repeats, and of a panel that shows half a repeat or less.
const SIDE: u32 = 768;
const PANEL: u32 = 320;

/// Tells all; draws one photograph in a folder, if there is one.
pub fn tell<'a>(
    library: &Library,
    photos: impl Iterator<Item = &'a (&'a str, Encoding)>,
    folder: Option<&Path>,
) {
    println!("| photograph | bc1, as they are | bc1, spread | bc7, as they are | bc7, spread |");
    println!("| --- | --- | --- | --- | --- |");
    for (file, _) in photos.filter(|(_, encoding)| *encoding != Encoding::Normal) {
        let exemplar = |compress: &str| {
            let text = format!(
                "let e = exemplar(\"{file}\", wrap: repeat, compress: {compress})\n\
                 texture t(uv: vec2) -> (color: color) {{ color = e.stochastic(uv) }}\n"
            );
            loaded(library, &text, "t")
        };
        let (program, tables) = exemplar("none");
        let whole = drawn(&program, &tables, 1.5, SIDE);
        let mut told = Vec::new();
        let mut panels = vec![drawn(&program, &tables, 0.3, PANEL)];
        for (word, compression) in [("bc1", Compression::Bc1), ("bc7", Compression::Bc7)] {
            let mut program = program.clone();
            let Recipe::Exemplar { compress, .. } = &mut program.manifest.resources[0].recipe else { return };
            *compress = compression;
            let spread = exemplar(word);
            for (program, tables) in [(&program, &tables), (&spread.0, &spread.1)] {
                let tables = through_blocks(program, tables);
                told.push(format!("{:.1} dB", decibels(&whole, &drawn(program, &tables, 1.5, SIDE))));
                panels.push(drawn(program, &tables, 0.3, PANEL));
            }
        }
        println!("| {} | {} |", file.split('.').next().unwrap_or(file), told.join(" | "));
        if let Some(folder) = folder {
            for (panel, name) in panels.iter().zip(["whole", "bc1", "bc1_spread", "bc7", "bc7_spread"]) {
                panel.save(folder.join(format!("{file}.{name}.png"))).expect("it is written");
            }
        }
    }
}

/// The tables with Gaussian numbers as they come out of their blocks.
fn through_blocks(program: &Program, tables: &Tables) -> Tables {
    let (mut manifest, mut tables) = (program.manifest.clone(), tables.clone());
    compress(&mut manifest, &mut tables);
    let texture = manifest.resources[0].textures.iter().find(|texture| texture.field == "gaussian");
    let texture = texture.expect("the exemplar has it");
    let (Some(table), Some(plain)) = (&texture.table, &texture.plain) else { return tables };
    let variant = match table.format {
        Format::Bc1RgbaUnorm => CompressionVariant::BC1,
        _ => CompressionVariant::BC7(BC7Settings::opaque_ultra_fast()),
    };
    let made = tables.get(0, "gaussian").expect("it is compressed").clone();
    let mut bytes = Vec::new();
    for (level, target) in plain.levels.iter().zip(&table.levels) {
        let blocks = &made[target.offset as usize..][..target.bytes(table.format) as usize];
        let [width, height] = [level.width, level.height].map(|side| side.next_multiple_of(4));
        let mut back = vec![0; 4 * (width * height) as usize];
        decompress_blocks_as_rgba8(variant, width, height, blocks, &mut back);
        let rows = back.chunks_exact(4 * width as usize).take(level.height as usize);
        bytes.extend(rows.flat_map(|row| &row[..4 * level.width as usize]));
    }
    tables.insert(0, "gaussian", bytes);
    tables
}

/// So many repeats in so many pixels.
fn drawn(program: &Program, tables: &Tables, repeats: f64, side: u32) -> RgbImage {
    let mut scene = Scene::new(program, tables, 0).expect("it can be drawn");
    let request = Request { region: [0.0, 0.0, repeats, repeats], ..Request::new([side; 2]) };
    let picture = scene.render(&request, &|_| {}).expect("it is drawn");
    let encoder = SrgbEncoder::new();
    let codes = picture.pixels.iter().flat_map(|pixel| [0, 1, 2].map(|k| encoder.encode(pixel[k])));
    RgbImage::from_raw(side, side, codes.collect()).expect("as many as its size says")
}

/// Peak signal to noise of 8-bit sRGB.
fn decibels(one: &RgbImage, other: &RgbImage) -> f64 {
    let apart = |(a, b): (&u8, &u8)| f64::from(a.abs_diff(*b)).powi(2);
    let sum: f64 = one.as_raw().iter().zip(other.as_raw()).map(apart).sum();
    10.0 * (255.0_f64.powi(2) * one.as_raw().len() as f64 / sum).log10()
}
