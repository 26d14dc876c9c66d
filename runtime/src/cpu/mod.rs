//! The CPU renderer: evaluates a program's graph at every pixel.
//!
//! The twin of the GPU: it needs no driver, defines what a program is worth, and is what the GPU's
//! pictures are compared with. A plan is made once for a picture: which operations the wanted
//! output needs, and what those are worth that no pixel changes. A machine then runs the plan
//! for a pixel; rows are spread over all cores. A version that runs batches of pixels can take the
//! place of the machine alone.

mod demand;
mod machine;
mod plan;
mod sample;
mod texture;

use crate::picture::Picture;
use crate::render::{RenderError, Request};
use crate::resource::Tables;
use machine::Machine;
use plan::{Plan, Source};
use rayon::iter::{IndexedParallelIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;
use std::sync::atomic::{AtomicUsize, Ordering};
use texgraph_compiler::Program;
use texgraph_compiler::graph::{Constant, Scalar};

/// Renders a program's output. `progress` hears shares from 0 to 1, from any thread.
///
/// # Errors
/// The request can't be met, a table is missing, or a pixel takes too much work.
pub fn render(
    program: &Program,
    tables: &Tables,
    request: &Request,
    progress: &(dyn Fn(f32) + Sync),
) -> Result<Picture, RenderError> {
    let mut picture = request.picture(program)?;
    let textures = texture::decode_all(&program.texture().graph, &program.manifest, tables)?;
    let plan = Plan::new(program, request, &textures)?;
    let [width, height] = request.size.map(|side| side as usize);
    let done = AtomicUsize::new(0);
    let rows = picture.pixels.par_chunks_mut(width).enumerate();
    rows.for_each_init(
        || Machine::new(&plan.functions, &textures),
        |machine, (y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = shade(&plan, machine, x, y);
            }
            progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f32 / height as f32);
        },
    );
    Ok(picture)
}

/// One pixel's output.
fn shade(plan: &Plan, machine: &mut Machine<'_>, x: usize, y: usize) -> [f32; 4] {
    let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
    let inputs = plan.inputs.iter().map(|(source, width)| {
        let components = match source {
            Source::Value(slope) => slope.at(x, y),
            Source::Right(slope) => slope.right(),
            Source::Down(slope) => slope.down(),
        };
        Constant::floats(&components[..usize::from(*width)])
    });
    let outputs = machine.run(plan.entry, inputs);
    outputs.get(plan.output).map_or([0.0; 4], widen)
}

/// An output as four floats, as the manifest's `Output` says.
fn widen(value: &Constant) -> [f32; 4] {
    let component = |i: usize| match value.scalar() {
        Scalar::Float => value.float(i),
        Scalar::Int => value.int(i) as f32,
        Scalar::Bool => f32::from(u8::from(value.bool(i))),
    };
    match value.width() {
        1 => [component(0), component(0), component(0), 1.0],
        2 => [component(0), component(1), 0.0, 1.0],
        3 => [component(0), component(1), component(2), 1.0],
        _ => [component(0), component(1), component(2), component(3)],
    }
}
