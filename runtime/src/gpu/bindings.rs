//! Bind groups from the manifest: the uniform block, textures and samplers, wherever it puts them.

use super::Gpu;
use super::texture::{self, Textures};
use crate::pass::Pass;
use crate::render::RenderError;
use std::collections::BTreeMap;
use texgraph_compiler::manifest::{Manifest, SampleKind, Texture};

/// What a pass reads, ready to be set.
pub struct Bindings {
    /// The layout of each group from 0 on; a number that is not used has an empty one.
    pub layouts: Vec<wgpu::BindGroupLayout>,
    /// The groups, for the same numbers.
    pub groups: Vec<wgpu::BindGroup>,
}

/// A thing to bind.
enum Bound {
    Uniform(wgpu::Buffer),
    Texture(wgpu::TextureView, wgpu::BindingType),
    Sampler(wgpu::Sampler),
}

/// Things to bind, by group and binding.
type Slots = BTreeMap<u32, BTreeMap<u32, Bound>>;

/// Groups that WebGPU guarantees; a manifest with more is refused rather than allocated for.
const MAX_GROUPS: u32 = 4;

impl Bindings {
    /// Makes the groups of a pass: the uniform block, and the textures that the manifest says it
    /// reads.
    pub fn new(
        gpu: &Gpu,
        pass: &Pass<'_>,
        textures: &Textures,
        uniform: Option<&wgpu::Buffer>,
    ) -> Result<Bindings, RenderError> {
        let mut slots = Slots::new();
        if let (Some(described), Some(buffer)) = (&pass.manifest.uniform, uniform) {
            let bound = Bound::Uniform(buffer.clone());
            slots.entry(described.group).or_default().insert(described.binding, bound);
        }
        for (resource, field) in &pass.described.reads {
            let described = pass.manifest.resources.get(*resource as usize);
            let texture = described.and_then(|r| r.textures.iter().find(|texture| texture.field == *field));
            if let (Some(texture), Some(uploaded)) = (texture, textures.get(*resource as usize, field)) {
                bind_texture(gpu, &mut slots, texture, uploaded.view.clone());
            }
        }
        let count = slots.keys().next_back().map_or(0, |last| last.saturating_add(1));
        if count > MAX_GROUPS {
            return Err(RenderError::Gpu(format!("there are {MAX_GROUPS} bind groups, not {count}")));
        }
        let empty = BTreeMap::new();
        let made = (0..count).map(|group| make_group(gpu, slots.get(&group).unwrap_or(&empty)));
        let (layouts, groups) = made.unzip();
        Ok(Bindings { layouts, groups })
    }
}

/// A buffer for a program's uniform block, if it has one.
pub fn uniform_buffer(gpu: &Gpu, manifest: &Manifest) -> Option<wgpu::Buffer> {
    let uniform = manifest.uniform.as_ref()?;
    Some(gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("uniform block"),
        size: u64::from(uniform.size),
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    }))
}

fn bind_texture(gpu: &Gpu, slots: &mut Slots, texture: &Texture, view: wgpu::TextureView) {
    let ty = wgpu::BindingType::Texture {
        sample_type: match texture.sample {
            SampleKind::Float => wgpu::TextureSampleType::Float { filterable: true },
            SampleKind::Int => wgpu::TextureSampleType::Sint,
        },
        view_dimension: texture::view_dimension(texture.view),
        multisampled: false,
    };
    slots.entry(texture.group).or_default().insert(texture.binding, Bound::Texture(view, ty));
    if let Some(sampler) = &texture.sampler {
        let bound = Bound::Sampler(texture::sampler(gpu, sampler));
        slots.entry(sampler.group).or_default().insert(sampler.binding, bound);
    }
}

fn make_group(gpu: &Gpu, slots: &BTreeMap<u32, Bound>) -> (wgpu::BindGroupLayout, wgpu::BindGroup) {
    let entries: Vec<_> = slots.iter().map(|(binding, bound)| layout_entry(*binding, bound)).collect();
    let layout = gpu
        .device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
    let entries: Vec<_> = slots
        .iter()
        .map(|(binding, bound)| wgpu::BindGroupEntry { binding: *binding, resource: bound.resource() })
        .collect();
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &entries,
    });
    (layout, group)
}

fn layout_entry(binding: u32, bound: &Bound) -> wgpu::BindGroupLayoutEntry {
    let ty = match bound {
        Bound::Uniform(_) => wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        Bound::Texture(_, ty) => *ty,
        Bound::Sampler(_) => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
    };
    wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None }
}

impl Bound {
    fn resource(&self) -> wgpu::BindingResource<'_> {
        match self {
            Bound::Uniform(buffer) => buffer.as_entire_binding(),
            Bound::Texture(view, _) => wgpu::BindingResource::TextureView(view),
            Bound::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
        }
    }
}
