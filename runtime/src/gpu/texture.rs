//! Uploads tables as textures and makes samplers, as the manifest describes them.

use super::Gpu;
use crate::bake::Bake;
use crate::render::RenderError;
use crate::resource::Tables;
use crate::resource::positions::Write;
use std::collections::BTreeMap;
use texgraph_compiler::manifest::{
    Filter, Format, Level, Manifest, Sampler, Table, Texture, ViewDimension, Wrap,
};

/// A texture on the device.
pub struct Uploaded {
    target: wgpu::Texture,
    /// All of it, in the shape that shaders read.
    pub view: wgpu::TextureView,
}

/// The textures of a program on the device, by resource and field.
pub struct Textures(BTreeMap<(usize, String), Uploaded>);

impl Textures {
    /// Uploads all textures, those of bakes without texels.
    pub fn upload(
        gpu: &Gpu,
        manifest: &Manifest,
        bakes: &[Bake<'_>],
        tables: &Tables,
    ) -> Result<Textures, RenderError> {
        let mut textures = BTreeMap::new();
        for (index, resource) in manifest.resources.iter().enumerate() {
            for texture in &resource.textures {
                let missing =
                    || RenderError::NoTable { resource: resource.name.clone(), field: texture.field.clone() };
                let uploaded = if bakes.iter().any(|bake| bake.resource == index) {
                    create(gpu, texture, texture.table.as_ref().ok_or_else(missing)?)
                } else {
                    let readable = tables.readable(index, texture, gpu.reads_blocks());
                    let (table, bytes) = readable.ok_or_else(missing)?;
                    let uploaded = create(gpu, texture, table);
                    write(gpu, &uploaded, table, bytes).ok_or_else(missing)?;
                    uploaded
                };
                textures.insert((index, texture.field.clone()), uploaded);
            }
        }
        Ok(Textures(textures))
    }

    /// A field of a resource.
    pub fn get(&self, resource: usize, field: &str) -> Option<&Uploaded> {
        self.0.get(&(resource, field.to_owned()))
    }

    /// Gives a bake's texture its texels.
    pub fn replace(&self, gpu: &Gpu, bake: &Bake<'_>, texels: &[u8]) -> Result<(), RenderError> {
        let uploaded = self.get(bake.resource, &bake.texture.field);
        let written = uploaded.and_then(|uploaded| write(gpu, uploaded, bake.table, texels));
        written.ok_or_else(|| RenderError::Gpu("a bake has no texture".to_owned()))
    }
}

impl Textures {
    /// Writes some texels of level 0; none where there is no such texture.
    pub fn patch(&self, gpu: &Gpu, resource: usize, field: &str, writes: &[Write<'_>]) -> Option<()> {
        let uploaded = self.get(resource, field)?;
        for write in writes {
            let [x, y, z] = write.origin;
            let place = wgpu::TexelCopyTextureInfo {
                texture: &uploaded.target,
                mip_level: 0,
                origin: wgpu::Origin3d { x, y, z },
                aspect: wgpu::TextureAspect::All,
            };
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(write.bytes_per_row),
                rows_per_image: Some(write.height),
            };
            gpu.queue.write_texture(place, write.bytes, layout, extent(write.width, write.height, 1));
        }
        // On their way now, not with the next picture.
        gpu.queue.submit([]);
        Some(())
    }
}

/// A texture without texels.
fn create(gpu: &Gpu, texture: &Texture, table: &Table) -> Uploaded {
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(&texture.name),
        size: extent(table.width, table.height, table.layers),
        mip_level_count: table.levels.len() as u32,
        sample_count: 1,
        dimension: match texture.view {
            ViewDimension::D2 | ViewDimension::D2Array => wgpu::TextureDimension::D2,
            ViewDimension::D3 => wgpu::TextureDimension::D3,
        },
        format: format(table.format),
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let view = target.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(view_dimension(texture.view)),
        ..wgpu::TextureViewDescriptor::default()
    });
    Uploaded { target, view }
}

/// Writes all levels; none where there are too few bytes.
fn write(gpu: &Gpu, uploaded: &Uploaded, table: &Table, bytes: &[u8]) -> Option<()> {
    for (number, level) in (0..).zip(&table.levels) {
        let format = table.format;
        write_level(gpu, &uploaded.target, number, format, level, level_bytes(level, format, bytes)?);
    }
    Some(())
}

fn level_bytes<'a>(level: &Level, format: Format, bytes: &'a [u8]) -> Option<&'a [u8]> {
    let start = usize::try_from(level.offset).ok()?;
    bytes.get(start..start.checked_add(usize::try_from(level.bytes(format)).ok()?)?)
}

fn write_level(gpu: &Gpu, target: &wgpu::Texture, number: u32, format: Format, level: &Level, texels: &[u8]) {
    let place = wgpu::TexelCopyTextureInfo {
        texture: target,
        mip_level: number,
        origin: wgpu::Origin3d::ZERO,
        aspect: wgpu::TextureAspect::All,
    };
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(level.bytes_per_row),
        rows_per_image: Some(level.rows(format)),
    };
    // Whole blocks, beyond the texels of small levels too.
    let [width, height] = [level.width, level.height].map(|side| side.next_multiple_of(format.block()));
    gpu.queue.write_texture(place, texels, layout, extent(width, height, level.layers));
}

fn extent(width: u32, height: u32, layers: u32) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers: layers }
}

/// A table's view shape in wgpu's words.
pub fn view_dimension(view: ViewDimension) -> wgpu::TextureViewDimension {
    match view {
        ViewDimension::D2 => wgpu::TextureViewDimension::D2,
        ViewDimension::D2Array => wgpu::TextureViewDimension::D2Array,
        ViewDimension::D3 => wgpu::TextureViewDimension::D3,
    }
}

fn format(format: Format) -> wgpu::TextureFormat {
    match format {
        Format::Rgba8UnormSrgb => wgpu::TextureFormat::Rgba8UnormSrgb,
        Format::Rgba8Unorm => wgpu::TextureFormat::Rgba8Unorm,
        Format::Rgba8Snorm => wgpu::TextureFormat::Rgba8Snorm,
        Format::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
        Format::R32Sint => wgpu::TextureFormat::R32Sint,
        Format::Rgba32Sint => wgpu::TextureFormat::Rgba32Sint,
        Format::Bc1RgbaUnorm => wgpu::TextureFormat::Bc1RgbaUnorm,
        Format::Bc7RgbaUnorm => wgpu::TextureFormat::Bc7RgbaUnorm,
    }
}

/// A sampler of the manifest.
pub fn sampler(gpu: &Gpu, sampler: &Sampler) -> wgpu::Sampler {
    let wrap = match sampler.wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
    };
    let (filter, between, anisotropy) = match sampler.filter {
        Filter::Linear => {
            (wgpu::FilterMode::Linear, wgpu::MipmapFilterMode::Linear, sampler.anisotropy.clamp(1, 16))
        }
        Filter::Nearest => (wgpu::FilterMode::Nearest, wgpu::MipmapFilterMode::Nearest, 1),
    };
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some(&sampler.name),
        address_mode_u: wrap,
        address_mode_v: wrap,
        address_mode_w: wrap,
        mag_filter: filter,
        min_filter: filter,
        mipmap_filter: between,
        anisotropy_clamp: anisotropy,
        ..wgpu::SamplerDescriptor::default()
    })
}
