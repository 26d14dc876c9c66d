//! One row of the table: a graph in a case, drawn in every way and measured.

use crate::Outcome;
use crate::borders;
use crate::case::{Case, Loaded, loaded};
use crate::measure::{Distance, distance, own_psnr};
use crate::reference::{self, Reference};
use crate::rivals::{Rival, by_hand};
use texgraph_compiler::Program;
use texgraph_compiler::manifest::Gradients;
use texgraph_runtime::cpu;
use texgraph_runtime::gpu::Gpu;
use texgraph_runtime::picture::Picture;

/// Pictures of one graph in one case.
pub struct Row {
    /// The graph.
    pub graph: &'static str,
    /// The view and the zoom.
    pub case: Case,
    /// What all are compared with.
    pub reference: Reference,
    /// The reference's own error as a PSNR.
    pub own: f64,
    /// The compiled graph by the CPU renderer.
    pub cpu: Drawn,
    /// On the GPU, where there is one.
    pub gpu: Option<OnGpu>,
}

/// What is drawn on a GPU.
pub struct OnGpu {
    /// The compiled graph.
    pub ours: Drawn,
    /// Whether that leaves levels of detail to the adapter, or works them out.
    pub by_gradient: bool,
    /// The careful person's shader.
    pub by_hand: Drawn,
    /// The same at the level as it is defined.
    pub at_its_level: Drawn,
    /// The one without gradients.
    pub naive: Drawn,
}

/// A picture and its distance from the reference.
pub struct Drawn {
    /// The picture.
    pub picture: Picture,
    /// How far off it is.
    pub off: Distance,
}

/// Draws and measures.
pub fn row(graph: &'static str, case: Case, gpu: Option<&Gpu>) -> Outcome<Row> {
    let reference = reference::draw(graph, case)?;
    let borders = borders::find(graph, case)?;
    let made = loaded(graph, "t", case, Gradients::Derive)?;
    let measured = |picture: Picture| {
        let off = distance(&picture, &reference, &borders);
        Drawn { picture, off }
    };
    let cpu = measured(cpu::render(&made.program, &made.tables, &case.request(), &|_| {})?);
    let on_gpu = |gpu: &Gpu| -> Outcome<OnGpu> {
        let rival = |rival| -> Outcome<Drawn> {
            let program = by_hand(graph, case, &made.program, rival)?;
            Ok(measured(on_gpu(gpu, &program, &made, case)?))
        };
        Ok(OnGpu {
            ours: measured(on_gpu(gpu, &made.program, &made, case)?),
            by_gradient: made.program.texture().wgsl.contains("textureSampleGrad"),
            by_hand: rival(Rival::HandWritten)?,
            at_its_level: rival(Rival::AtItsLevel)?,
            naive: rival(Rival::Naive)?,
        })
    };
    let gpu = gpu.map(on_gpu).transpose()?;
    Ok(Row { graph, case, own: own_psnr(&reference), reference, cpu, gpu })
}

fn on_gpu(gpu: &Gpu, program: &Program, made: &Loaded, case: Case) -> Outcome<Picture> {
    Ok(gpu.prepare(program, &made.tables, 0)?.render(&case.request(), &|_| {})?)
}
