//! A pass of a program as both renderers see it: its graph, its shader, what it takes.

use crate::render::RenderError;
use std::borrow::Cow;
use texgraph_compiler::Program;
use texgraph_compiler::manifest::{self, Input, Manifest, Scalar, Source, Type};

/// A pass of a program.
#[derive(Clone)]
pub struct Pass<'a> {
    /// Its graph and its shader.
    pub code: &'a texgraph_compiler::Pass,
    /// What the manifest says of it.
    pub described: &'a manifest::Pass,
    /// The program's manifest.
    pub manifest: &'a Manifest,
    /// What its entry takes, in order: a bake `uv` alone, whatever its node calls it.
    pub inputs: Cow<'a, [Input]>,
}

/// All passes, in order: bakes, then the texture.
pub fn all(program: &Program) -> impl DoubleEndedIterator<Item = Pass<'_>> {
    let manifest = &program.manifest;
    program.passes.iter().zip(&manifest.passes).map(move |(code, described)| Pass {
        code,
        described,
        manifest,
        inputs: if described.bake.is_some() { uv().into() } else { (&manifest.inputs).into() },
    })
}

/// The texture itself.
///
/// # Errors
/// The program has no pass.
pub fn texture(program: &Program) -> Result<Pass<'_>, RenderError> {
    all(program).next_back().ok_or(RenderError::NoPass)
}

fn uv() -> Vec<Input> {
    let ty = Type { scalar: Scalar::Float, width: 2 };
    vec![Input { name: "uv".to_owned(), ty, source: Source::Varying(0) }]
}
