//! Draws a picture: a machine for each thread, batch after batch.

use super::inputs::Places;
use super::machine::{Code, Machine};
use super::mask::Mask;
use super::plan::Plan;
use super::texture::Texture;
use crate::pass::Pass;
use crate::render::{RenderError, Request};
use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
use std::sync::atomic::{AtomicUsize, Ordering};
use texgraph_compiler::graph::{Graph, Scalar};
use texgraph_compiler::intrinsic::{LANES, Lanes};

/// Batches that one thread takes on at least.
const LEAST_BATCHES: usize = 16;

/// The pixels of a batch.
type Batch = [[f32; 4]; LANES];

/// The pixels of the output of a graph, row by row.
///
/// # Errors
/// A pixel takes too much work, or the picture more memory than there is.
pub fn draw(
    pass: &Pass<'_>,
    graph: &Graph,
    textures: &[Texture],
    request: &Request,
    progress: &(dyn Fn(f32) + Sync),
) -> Result<Vec<[f32; 4]>, RenderError> {
    let plan = Plan::new(pass, graph, request, textures)?;
    let [width, height] = request.size.map(|side| side as usize);
    let count = width * height;
    // Whole batches, so that nothing is written twice; what is behind the last pixel is cut off.
    let mut batches = Vec::new();
    batches
        .try_reserve_exact(count.div_ceil(LANES))
        .map_err(|_| RenderError::Memory { size: request.size })?;
    let done = AtomicUsize::new(0);
    let batch = |machine: &mut Machine, n: usize| {
        let pixels = LANES.min(count - n * LANES);
        let batch = shade(&plan, textures, machine, &Places::from(n * LANES, width), pixels);
        let before = done.fetch_add(pixels, Ordering::Relaxed);
        for row in before / width..(before + pixels) / width {
            progress((row + 1) as f32 / height as f32);
        }
        batch
    };
    let numbers = (0..count.div_ceil(LANES)).into_par_iter().with_min_len(LEAST_BATCHES);
    numbers.map_init(Machine::default, batch).collect_into_vec(&mut batches);
    let mut pixels = batches.into_flattened();
    pixels.truncate(count);
    Ok(pixels)
}

/// The first of the pixels at some places.
fn shade(plan: &Plan, textures: &[Texture], machine: &mut Machine, places: &Places, pixels: usize) -> Batch {
    let code = Code { functions: &plan.functions, known: &plan.known, textures };
    machine.begin(code, plan.entry, Mask::MAX >> (LANES - pixels));
    for (i, source) in plan.inputs.iter().enumerate() {
        if let Some(lanes) = machine.input(i) {
            source.fill(places, lanes);
        }
    }
    machine.work(code);
    let Some(output) = &plan.output else { return [[0.0; 4]; LANES] };
    let lanes = output.components.map(|register| machine.lanes(code, register));
    match output.scalar {
        Scalar::Float => pixels_of(lanes, f32::from_bits),
        Scalar::Int => pixels_of(lanes, |bits| bits as i32 as f32),
        Scalar::Bool => pixels_of(lanes, |bits| if bits != 0 { 1.0 } else { 0.0 }),
    }
}

/// Pixels of four components, as floats.
#[inline(always)]
fn pixels_of([r, g, b, a]: [&Lanes; 4], float: impl Fn(u32) -> f32) -> Batch {
    std::array::from_fn(|i| [float(r[i]), float(g[i]), float(b[i]), float(a[i])])
}
