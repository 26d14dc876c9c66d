//! Draws a picture: a machine for each thread, batch after batch.

use super::fused::Rows;
use super::inputs;
use super::machine::{Code, Machine};
use super::mask::Mask;
use super::plan::Plan;
use super::texture::Texture;
use crate::pass::Pass;
use crate::render::{RenderError, Request};
use rayon::iter::{IndexedParallelIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;
use std::sync::atomic::{AtomicUsize, Ordering};
use texgraph_compiler::graph::{Graph, Scalar};
use texgraph_compiler::intrinsic::{LANES, Lanes, wide};

/// Batches that one thread takes on at a time, after which it says how far it is.
const STRETCH: usize = 16;

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
    let plan = Plan::new(pass, graph, request, textures, &mut Rows)?;
    let [width, height] = request.size.map(|side| side as usize);
    let mut pixels = blank(width * height).ok_or(RenderError::Memory { size: request.size })?;
    let done = AtomicUsize::new(0);
    let draw = |machine: &mut Machine, (n, stretch): (usize, &mut [[f32; 4]])| {
        for (batch, first) in stretch.chunks_mut(LANES).zip((n * STRETCH * LANES..).step_by(LANES)) {
            shade(&plan, textures, machine, first, width, batch);
        }
        let before = done.fetch_add(stretch.len(), Ordering::Relaxed);
        for row in before / width..(before + stretch.len()) / width {
            progress((row + 1) as f32 / height as f32);
        }
    };
    let stretches = pixels.par_chunks_mut(STRETCH * LANES).enumerate();
    stretches.for_each_init(Machine::default, draw);
    Ok(pixels)
}

/// Black pixels; none if there is no memory for so many.
fn blank(count: usize) -> Option<Vec<[f32; 4]>> {
    // Memory that is new is black: nothing is written twice. But asking for too much of it would abort.
    Vec::<[f32; 4]>::new().try_reserve_exact(count).ok()?;
    Some(vec![[0.0; 4]; count])
}

/// Draws pixels of a picture from one on.
fn shade(
    plan: &Plan,
    textures: &[Texture],
    machine: &mut Machine,
    first: usize,
    width: usize,
    pixels: &mut [[f32; 4]],
) {
    let code = Code { functions: &plan.functions, known: &plan.known, textures };
    machine.begin(code, plan.entry, Mask::MAX >> (LANES - pixels.len()));
    for (i, rise) in plan.inputs.iter().enumerate() {
        if let Some(lanes) = machine.input(i) {
            inputs::fill(*rise, first, width, lanes);
        }
    }
    machine.work(code);
    let Some(output) = &plan.output else { return };
    let lanes = output.components.map(|register| machine.lanes(code, register));
    match output.scalar {
        Scalar::Float => fill(pixels, lanes, f32::from_bits),
        Scalar::Int => fill(pixels, lanes, |bits| bits as i32 as f32),
        Scalar::Bool => fill(pixels, lanes, |bits| if bits != 0 { 1.0 } else { 0.0 }),
    }
}

/// Fills pixels with four components, as floats.
#[inline(always)]
fn fill(pixels: &mut [[f32; 4]], [r, g, b, a]: [&Lanes; 4], float: impl Fn(u32) -> f32) {
    wide(
        #[inline(always)]
        || {
            // One number a pixel is read once.
            if std::ptr::eq(r, g) && std::ptr::eq(r, b) {
                for ((pixel, grey), a) in pixels.iter_mut().zip(r).zip(a) {
                    *pixel = [float(*grey), float(*grey), float(*grey), float(*a)];
                }
                return;
            }
            for ((((pixel, r), g), b), a) in pixels.iter_mut().zip(r).zip(g).zip(b).zip(a) {
                *pixel = [float(*r), float(*g), float(*b), float(*a)];
            }
        },
    );
}
