//! Moves the leaves of examples/decals.tex in the wind and writes a picture of each frame:
//!
//! ```text
//! cargo run --release -p texgraph-runtime --example decals -- FOLDER [FRAMES]
//! ```
//!
//! Each frame writes the few texels that have changed into the texture that the shader reads; no
//! shader and no other texture is made again.

#![allow(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a program of its own, which writes files"
)]

use std::error::Error;
use std::path::{Path, PathBuf};
use texgraph_compiler::{Library, Options, compile};
use texgraph_runtime::project::Project;
use texgraph_runtime::render::{Backend, Renderer, Request};
use texgraph_runtime::resource::load;
use texgraph_runtime::resource::positions::{self, Positions, Refused};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().ok_or("say into which folder")?);
    let frames: u32 = arguments.next().map_or(Ok(24), |frames| frames.parse())?;
    std::fs::create_dir_all(&folder)?;

    let project = Project::new(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/decals.tex"), false);
    let library = Library::standard()?;
    let compiled = compile(&library, project.main(), &project, &Options::default());
    let mut program = compiled.map_err(|failure| format!("{:?}", failure.diagnostics))?.program;
    let tables = load(&mut program, &project).map_err(|found| format!("{found:?}"))?;
    let mut leaves = positions::open(&program, &project, "leaves").map_err(|found| format!("{found:?}"))?;
    let resource = program.manifest.resources.iter().position(|resource| resource.name == "leaves");
    let resource = resource.ok_or("the shader reads no leaves")?;

    let renderer = Renderer::new(Backend::Auto)?;
    let mut scene = renderer.scene(&program, &tables, 0)?;
    for frame in 0..frames {
        let stayed = blow(&mut leaves, frame)?;
        scene.write(resource, "cells", &leaves.take_writes())?;
        let picture = scene.render(&Request::new([512, 512]), &|_| {})?;
        std::fs::write(folder.join(format!("decals_{frame:03}.png")), picture.to_png()?)?;
        println!("frame {frame}: {stayed} leaves had no room to move");
    }
    Ok(())
}

/// Moves each leaf a step; how many stayed where they were because too many lie there.
fn blow(leaves: &mut Positions, frame: u32) -> Result<usize, Refused> {
    let mut stayed = 0;
    let all: Vec<_> = leaves.sprites().collect();
    for (number, (id, mut leaf)) in all.into_iter().enumerate() {
        let gust = (frame as f32 * 0.4 + number as f32 * 1.7).sin();
        leaf.at = [
            (leaf.at[0] + 0.006 + 0.003 * gust).rem_euclid(1.0),
            (leaf.at[1] + 0.002 * gust).rem_euclid(1.0),
        ];
        leaf.turn += 0.01 * gust;
        match leaves.place(id, leaf) {
            Ok(()) => {}
            // The map is as it was: this leaf waits for the next frame.
            Err(Refused::Taken { .. }) => stayed += 1,
            Err(other) => return Err(other),
        }
    }
    Ok(stayed)
}
