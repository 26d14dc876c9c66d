//! The shaders of a program: how each is wrapped, run and called.

use serde::{Deserialize, Serialize};

/// How the shader is wrapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// With a fragment entry point.
    Complete,
    /// A function over global bindings, no entry point.
    Library,
    /// A function of its arguments alone, with those it calls: no global variable, no binding, no
    /// entry point. The host binds everything, as it likes, and passes it on (see [`Pass::call`]).
    /// Bakes are in the complete form all the same: what they bind, and the uniform block with the
    /// params they read, stands in the manifest.
    Functions,
}

/// One shader to run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// The texture's name, or the baked resource's.
    pub name: String,
    /// Of a bake: which resource it fills (an index into [`Manifest::resources`](super::Manifest::resources)). A host draws it
    /// into level 0 of that resource's only texture, `uv` (at `@location(0)`) running from 0 to 1
    /// across it, then averages each further level from the one before; once at the start, and
    /// again whenever one of `params` changes. None for the texture itself, the last pass.
    pub bake: Option<u32>,
    /// What it samples or fetches: resource (index) and field. Nothing else has to be bound.
    pub reads: Vec<(u32, String)>,
    /// The params it reads, by name.
    pub params: Vec<String>,
    /// The file with its WGSL, beside the manifest.
    pub shader: String,
    /// `fn NAME(in: NAMEInputs) -> NAMEOutputs` in the library form, the fragment entry point in
    /// the complete form, the function to call in the functions form.
    pub entry_point: String,
    /// How to call the function; in the functions form only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub call: Option<Call>,
    /// `derive`: the shader takes screen derivatives, so it runs in a fragment stage and in uniform
    /// control flow only; `argument`: it is given them.
    pub gradients: Gradients,
}

/// How to call the function of the functions form.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Call {
    /// What it takes, in order.
    pub arguments: Vec<Argument>,
    /// The members of the struct that it returns, one for each output, in order. None where there is
    /// one output: the function returns its value.
    pub members: Option<Vec<String>>,
}

/// An argument of the function of the functions form.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Argument {
    /// The input of that name.
    Input(String),
    /// The param of that name, clamped to its range; a bool is a `bool`.
    Param(String),
    /// A texture, by its resource (index) and field.
    Texture(u32, String),
    /// The derivative of that name, one of the manifest's `gradients`.
    Gradient(String),
    /// The sampler of the texture before it, by the same.
    Sampler(u32, String),
}

/// Where screen derivatives come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Gradients {
    /// `dpdx` and `dpdy` of the inputs, taken once at the top.
    Derive,
    /// From whoever calls the shader, which then runs in any stage, wherever control flow is: see
    /// [`Manifest::gradients`](super::Manifest::gradients).
    Argument,
    /// The shader needs none, or does without: every sample is of the finest level.
    None,
}
