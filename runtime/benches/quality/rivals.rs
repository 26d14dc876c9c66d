//! What ours is compared with: the shader that a careful person writes by hand, and the one that
//! leaves gradients to the hardware.
//!
//! Both take the place of a compiled program's own text and use its bindings.

use crate::Outcome;
use crate::case::Case;
use std::path::Path;
use texgraph_compiler::Program;

/// A way to write a shader by hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rival {
    /// With the gradient of the continuous place, and far away the mean.
    HandWritten,
    /// The same at the level of detail as it is defined: an adapter's own may be off, and what is
    /// off to the sharp side is nearer to the reference.
    AtItsLevel,
    /// The same with `textureSample`, which takes differences within 2×2 pixels, and no `fade`.
    Naive,
}

/// A program whose texture is drawn by a shader of `benches/handwritten`.
pub fn by_hand(graph: &str, case: Case, program: &Program, rival: Rival) -> Outcome<Program> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../benches/handwritten");
    let read = |name: &str| std::fs::read_to_string(folder.join(name));
    let (repeat, aspect) = case.plane().map_or((0.0, 1.0), |plane| (plane.repeat, plane.aspect));
    let constants = format!("const REPEAT = f32({repeat:?});\nconst ASPECT = f32({aspect:?});\n");
    let shader = read(&format!("{graph}.wgsl"))?;
    let shader = match rival {
        Rival::HandWritten => shader,
        Rival::AtItsLevel => at_its_level(&shader),
        Rival::Naive => naive(&shader),
    };
    let mut program = program.clone();
    let texture = program.passes.last_mut().ok_or("the program has no pass")?;
    texture.wgsl = format!("{constants}{}{shader}", read("common.wgsl")?);
    Ok(program)
}

/// The text with levels in place of gradients, but for the sample of what is far.
fn at_its_level(shader: &str) -> String {
    let lines = shader.lines().map(|line| match line.strip_suffix(", right, down);") {
        Some(start) => {
            start.replace("textureSampleGrad(", "textureSampleLevel(") + ", level(right, down));\n"
        }
        None => format!("{line}\n"),
    });
    lines.collect()
}

/// The text without gradients.
fn naive(shader: &str) -> String {
    shader
        .replace("textureSampleGrad(", "textureSample(")
        .replace(", right, down)", ")")
        .replace(", dpdx(q), dpdy(q))", ")")
        .replace("fade(p)", "0.0")
}
