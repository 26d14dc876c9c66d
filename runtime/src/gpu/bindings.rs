//! Bind groups from the manifest: the uniform block, textures and samplers, wherever it puts them.

use super::{Gpu, texture};
use crate::render::RenderError;
use crate::resource::Tables;
use std::collections::BTreeMap;
use texgraph_compiler::manifest::{Manifest, SampleKind, Texture};

/// What a program's shader reads, ready to be set.
pub struct Bindings {
    /// The layout of each group from 0 on; a number that is not used has an empty one.
    pub layouts: Vec<wgpu::BindGroupLayout>,
    /// The groups, for the same numbers.
    pub groups: Vec<wgpu::BindGroup>,
    /// The uniform block, if there is one.
    pub uniform: Option<wgpu::Buffer>,
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
    /// Uploads all textures and makes the groups.
    pub fn new(gpu: &Gpu, manifest: &Manifest, tables: &Tables) -> Result<Bindings, RenderError> {
        let mut slots = Slots::new();
        let uniform = manifest.uniform.as_ref().map(|uniform| {
            let buffer = uniform_buffer(gpu, u64::from(uniform.size));
            slots.entry(uniform.group).or_default().insert(uniform.binding, Bound::Uniform(buffer.clone()));
            buffer
        });
        for (index, resource) in manifest.resources.iter().enumerate() {
            for texture in &resource.textures {
                let view = texture::upload(gpu, tables, index, resource, texture)?;
                bind_texture(gpu, &mut slots, texture, view);
            }
        }
        let count = slots.keys().next_back().map_or(0, |last| last.saturating_add(1));
        if count > MAX_GROUPS {
            return Err(RenderError::Gpu(format!("there are {MAX_GROUPS} bind groups, not {count}")));
        }
        let empty = BTreeMap::new();
        let made = (0..count).map(|group| make_group(gpu, slots.get(&group).unwrap_or(&empty)));
        let (layouts, groups) = made.unzip();
        Ok(Bindings { layouts, groups, uniform })
    }
}

fn uniform_buffer(gpu: &Gpu, size: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("uniform block"),
        size,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
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
