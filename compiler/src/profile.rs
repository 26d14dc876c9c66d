//! Profiles: the hosts a program is for, with what they can hold.
//!
//! The figures are those that any device of a profile has; a device may have more. They are held
//! against the manifest, pass by pass, once when compiling and once more when the pictures are
//! loaded and their sizes known.
//!
//! Of what WebGPU's compatibility mode restricts beyond its limits nothing concerns our shaders:
//! a texture has one view and one sampler, so there are as many pairs of texture and sampler as
//! textures; nothing is interpolated `flat` or per sample, no derivative is a fine one, and there
//! are neither storage buffers nor depth textures.

use crate::diagnostic::{Diagnostic, Place, limits};
use crate::graph::Graph;
use crate::manifest::{Encoding, Form, Manifest, Pass, Recipe, Resource, Sampler, Texture, Tileable};
use std::collections::BTreeMap;

/// A host with limits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Profile {
    /// What every WebGPU device has.
    #[default]
    Webgpu,
    /// WebGPU's compatibility mode: devices with OpenGL ES 3.1 or Direct3D 11.
    Compat,
    /// A material of Bevy, which shares a shader with the engine's own textures. Bakes, which the
    /// host draws by themselves, have WebGPU's limits.
    Bevy,
}

/// What a host holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// As a sentence names the host.
    pub host: &'static str,
    /// Textures of a shader, each with a sampler or without: `maxSampledTexturesPerShaderStage`.
    /// There are never more samplers than textures, and they have the same limit.
    pub textures: usize,
    /// Bytes of the uniform block: `maxUniformBufferBindingSize`.
    pub uniform_bytes: u32,
    /// Outputs of the complete form: `maxColorAttachments`.
    pub outputs: usize,
    /// Texels of a texture across or down: `maxTextureDimension2D`.
    pub side: u32,
}

const WEBGPU: Limits =
    Limits { host: "WebGPU", textures: 16, uniform_bytes: 65_536, outputs: 8, side: 8_192 };

const COMPAT: Limits = Limits {
    host: "WebGPU's compatibility mode",
    textures: 16,
    uniform_bytes: 16_384,
    outputs: 4,
    side: 4_096,
};

const BEVY: Limits = Limits { host: "a material of Bevy", textures: 6, ..WEBGPU };

impl Profile {
    /// What a texture's own shader may take.
    pub fn limits(self) -> Limits {
        match self {
            Profile::Webgpu => WEBGPU,
            Profile::Compat => COMPAT,
            Profile::Bevy => BEVY,
        }
    }

    /// What the shader of a bake may take.
    pub fn bake_limits(self) -> Limits {
        match self {
            Profile::Webgpu | Profile::Bevy => WEBGPU,
            Profile::Compat => COMPAT,
        }
    }

    /// The `@group` and the first `@binding` that the host leaves to us.
    pub fn bindings(self) -> (u32, u32) {
        match self {
            Profile::Webgpu | Profile::Compat => (0, 0),
            Profile::Bevy => (3, 100),
        }
    }
}

/// Every limit that a program passes. `head` is the name of the texture in its file; of what a bake
/// passes and of textures that are too large, the place is that of the resource.
pub fn check(profile: Profile, manifest: &Manifest, graph: &Graph, head: Place) -> Vec<Diagnostic> {
    let place = |resource: u32| graph.resources.get(resource as usize).map_or(head, |found| found.place);
    let mut errors = Vec::new();
    for pass in &manifest.passes {
        let (limits, place) = match pass.bake {
            Some(resource) => (profile.bake_limits(), place(resource)),
            None => (profile.limits(), head),
        };
        errors.extend(textures(&limits, manifest, pass, place));
    }
    let limits = profile.limits();
    errors.extend(uniform(&limits, manifest, head));
    errors.extend(outputs(&limits, manifest, head));
    errors.extend(sides(profile, manifest, graph));
    errors.sort_by_key(|error| (error.place, error.code));
    errors
}

/// The textures that are larger than the host can hold, as far as their sizes are known.
pub fn sides(profile: Profile, manifest: &Manifest, graph: &Graph) -> Vec<Diagnostic> {
    let limits = profile.limits();
    let mut errors = Vec::new();
    for (described, resource) in manifest.resources.iter().zip(&graph.resources) {
        let tables = described.textures.iter().filter_map(|texture| texture.table.as_ref());
        let sizes = tables.map(|table| [table.width, table.height]);
        if let Some(size) = sizes.into_iter().find(|size| size.iter().any(|side| *side > limits.side)) {
            errors.push(limits::texture_over_profile(
                resource.place,
                &described.name,
                size,
                limits.host,
                limits.side,
            ));
        }
    }
    errors
}

fn textures(limits: &Limits, manifest: &Manifest, pass: &Pass, place: Place) -> Option<Diagnostic> {
    let count = pass.reads.len();
    (count > limits.textures).then(|| {
        let mend = merge(manifest, pass, count - limits.textures);
        limits::too_many_textures(place, &pass.name, count, limits.host, limits.textures, &mend)
    })
}

fn uniform(limits: &Limits, manifest: &Manifest, place: Place) -> Option<Diagnostic> {
    let size = manifest.uniform.as_ref().map_or(0, |uniform| uniform.size);
    (size > limits.uniform_bytes).then(|| {
        limits::too_many_uniform_bytes(place, &manifest.texture, size, limits.host, limits.uniform_bytes)
    })
}

fn outputs(limits: &Limits, manifest: &Manifest, place: Place) -> Option<Diagnostic> {
    let count = manifest.outputs.len();
    (manifest.form == Form::Complete && count > limits.outputs)
        .then(|| limits::too_many_outputs(place, &manifest.texture, count, limits.host, limits.outputs))
}

/// Resources that one resource could stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Likeness {
    /// Images that are sampled and encoded alike: layers of one `patterns`.
    Image(u8, u8, u8),
    /// Patterns that are sampled and encoded alike.
    Patterns(u8, u8),
    /// Maps of integers: parts of one map.
    Indices,
}

fn likeness(resource: &Resource) -> Option<Likeness> {
    let sampler = resource.textures.first().and_then(|texture: &Texture| texture.sampler.as_ref());
    let filter = |sampler: &Sampler| sampler.filter as u8;
    let code = |encoding: Encoding| encoding as u8;
    match &resource.recipe {
        // Patterns are not made to wrap.
        Recipe::Image { encoding, tileable: Tileable::None, .. } => {
            sampler.map(|s| Likeness::Image(s.wrap as u8, filter(s), code(*encoding)))
        }
        Recipe::Patterns { encoding, .. } => sampler.map(|s| Likeness::Patterns(filter(s), code(*encoding))),
        Recipe::Indices { .. } => Some(Likeness::Indices),
        _ => None,
    }
}

/// What to merge to spare so many textures, the largest group of like resources first.
fn merge(manifest: &Manifest, pass: &Pass, spare: usize) -> String {
    let mut alike: BTreeMap<Likeness, Vec<&str>> = BTreeMap::new();
    for (resource, _) in &pass.reads {
        let resource = manifest.resources.get(*resource as usize);
        if let Some((resource, likeness)) = resource.and_then(|found| Some((found, likeness(found)?))) {
            alike.entry(likeness).or_default().push(&resource.name);
        }
    }
    let mut groups: Vec<(Likeness, Vec<&str>)> =
        alike.into_iter().filter(|(_, names)| names.len() > 1).collect();
    groups.sort_by_key(|(_, names)| std::cmp::Reverse(names.len()));
    let mut spared = 0;
    let mut mends = Vec::new();
    for (likeness, names) in groups {
        if spared < spare {
            // One more than is to be spared: they become one.
            let enough = &names[..names.len().min(spare - spared + 1)];
            spared += enough.len() - 1;
            mends.push(mend(likeness, enough));
        }
    }
    mends.push(match (mends.is_empty(), spared < spare) {
        (true, _) => "bake what they are combined to: a bake is one texture, whatever it reads".to_owned(),
        (false, true) => "bake what the others are combined to".to_owned(),
        (false, false) => return mends.join("; "),
    });
    mends.join("; ")
}

fn mend(likeness: Likeness, names: &[&str]) -> String {
    let shown: Vec<String> = names.iter().take(8).map(|name| format!("`{name}`")).collect();
    let more = if names.len() > 8 { ", …" } else { "" };
    let list = shown.join(", ") + more;
    match likeness {
        Likeness::Image(..) => format!(
            "make the images {list} one `patterns([…])`: they are sampled alike, and {} layers are one texture",
            names.len()
        ),
        Likeness::Patterns(..) => {
            format!("make the patterns {list} one list of patterns: they are sampled alike")
        }
        Likeness::Indices => format!("put the maps {list} side by side into one `indices`"),
    }
}
