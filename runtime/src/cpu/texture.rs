//! Textures of the CPU renderer: tables with their texels decoded.

use super::mask::{Mask, each_lane};
use crate::bake::Bake;
use crate::pass::Pass;
use crate::render::RenderError;
use crate::resource::positions::Write;
use crate::resource::{Tables, srgb_to_linear};
use glam::{IVec2, IVec4, Vec4};
use half::f16;
use rayon::iter::ParallelIterator;
use rayon::slice::ParallelSlice;
use texgraph_compiler::graph::ResourceView;
use texgraph_compiler::intrinsic::{LANES, Lanes, wide};
use texgraph_compiler::manifest::{self, Filter, Format, Table, Wrap};

/// A texture with its sampler.
pub struct Texture {
    /// The levels, the largest first; at least one.
    pub levels: Vec<Level>,
    /// What lies outside 0..1.
    pub wrap: Wrap,
    /// How texels are weighed.
    pub filter: Filter,
    /// The texels of all levels.
    pub texels: Texels,
}

/// One level.
#[derive(Clone, Copy)]
pub struct Level {
    /// Texels across and down, at least 1.
    pub size: IVec2,
    /// At least 1.
    pub layers: i32,
    /// Where its texels begin.
    start: usize,
}

/// Four components each, all levels one after the other.
pub enum Texels {
    /// Ready to be weighed.
    Float(Vec<Vec4>),
    /// Never sampled.
    Int(Vec<IVec4>),
}

impl Texture {
    fn single() -> Texture {
        Texture {
            levels: vec![Level { size: IVec2::ONE, layers: 1, start: 0 }],
            wrap: Wrap::Clamp,
            filter: Filter::Nearest,
            texels: Texels::Int(vec![IVec4::ZERO]),
        }
    }

    /// Writes texels of level 0 of a map of ints; none where they do not fit.
    pub fn patch(&mut self, write: &Write<'_>) -> Option<()> {
        let (level, [x, y, layer]) = (*self.levels.first()?, write.origin.map(|i| i as usize));
        let Texels::Int(texels) = &mut self.texels else { return None };
        let (width, height) = (write.width as usize, write.height as usize);
        let [columns, rows] = [level.size.x as usize, level.size.y as usize];
        if x + width > columns || y + height > rows || layer >= level.layers as usize {
            return None;
        }
        let texel_bytes = write.texel_bytes as usize;
        for row in 0..height {
            let first = row * write.bytes_per_row as usize;
            let bytes = write.bytes.get(first..first + width * texel_bytes)?;
            let Texels::Int(new) = ints(bytes, texel_bytes) else { return None };
            let start = level.index(layer as i32) + (y + row) * columns + x;
            texels.get_mut(start..start + width)?.copy_from_slice(&new);
        }
        Some(())
    }

    /// Texels of level 0, across and down.
    pub fn size(&self) -> IVec2 {
        self.levels[0].size
    }

    /// Texels of level 0, four floats or four ints, of which only the wanted components are written;
    /// a place outside is moved inside.
    pub fn fetch(
        &self,
        [x, y]: [&Lanes; 2],
        layer: &Lanes,
        mask: Mask,
        wanted: [bool; 4],
        to: &mut [Lanes; 4],
    ) {
        let level = &self.levels[0];
        let layers = level.layers - 1;
        let mut places = [0; LANES];
        wide(
            #[inline(always)]
            || level.places([x, y], &mut places),
        );
        if layers > 0 {
            for (place, layer) in places.iter_mut().zip(layer) {
                *place += (level.index((*layer as i32).clamp(0, layers)) - level.start) as u32;
            }
        }
        for (c, to) in to.iter_mut().enumerate().filter(|(c, _)| wanted[*c]) {
            match &self.texels {
                Texels::Float(texels) => {
                    component(texels, &places, mask, to, |texel| texel.as_ref()[c].to_bits())
                }
                Texels::Int(texels) => component(texels, &places, mask, to, |texel| texel.as_ref()[c] as u32),
            }
        }
    }
}

/// A component of the texels at places, each for its lane.
#[inline(always)]
fn component<T>(texels: &[T], places: &Lanes, mask: Mask, to: &mut Lanes, bits: impl Fn(&T) -> u32) {
    each_lane(
        mask,
        #[inline(always)]
        |i| to[i] = texels.get(places[i] as usize).map_or(0, &bits),
    );
}

impl Level {
    /// Where texels of the first layer are; a place outside is moved inside.
    #[inline(always)]
    fn places(self, [x, y]: [&Lanes; 2], to: &mut Lanes) {
        let (last, start) = (self.size - 1, self.start as u32);
        for ((to, x), y) in to.iter_mut().zip(x).zip(y) {
            let row = (*y as i32).clamp(0, last.y) * self.size.x;
            *to = start + (row + (*x as i32).clamp(0, last.x)) as u32;
        }
    }

    /// Where a layer's texels begin, row by row.
    pub fn index(&self, layer: i32) -> usize {
        self.start + layer as usize * (self.size.y * self.size.x) as usize
    }
}

/// The textures of all views of a graph, in their order; a single texel for a view that nothing
/// reads, and for a bake until it is drawn.
///
/// # Errors
/// The bytes of one are missing or too few.
pub fn decode_all(pass: &Pass<'_>, bakes: &[Bake<'_>], tables: &Tables) -> Result<Vec<Texture>, RenderError> {
    let decode_view = |view: &ResourceView| {
        let resource = pass.manifest.resources.get(view.resource as usize);
        let texture = resource.and_then(|r| r.textures.iter().find(|texture| texture.field == view.field));
        let Some(texture) = texture else { return Ok(Texture::single()) };
        if bakes.iter().any(|bake| fills(bake, view)) {
            return Ok(Texture::single());
        }
        let whole = tables.readable(view.resource as usize, texture, false);
        whole.and_then(|(table, bytes)| decode(texture, table, bytes)).ok_or_else(|| RenderError::NoTable {
            resource: resource.map_or(String::new(), |r| r.name.clone()),
            field: view.field.to_string(),
        })
    };
    pass.code.graph.views.iter().map(decode_view).collect()
}

/// Whether a view shows what a bake draws.
fn fills(bake: &Bake<'_>, view: &ResourceView) -> bool {
    bake.resource == view.resource as usize && bake.texture.field == view.field
}

/// Gives a bake's texture its texels.
pub fn replace(textures: &mut [Texture], bake: &Bake<'_>, texels: &[u8]) {
    for (texture, view) in textures.iter_mut().zip(&bake.pass.code.graph.views) {
        if fills(bake, view)
            && let Some(decoded) = decode(bake.texture, bake.table, texels)
        {
            *texture = decoded;
        }
    }
}

/// None where the table and its bytes do not fit.
fn decode(texture: &manifest::Texture, table: &Table, bytes: &[u8]) -> Option<Texture> {
    let texel_bytes = table.format.bytes() as usize;
    let levels = table.levels.iter().map(|level| Level {
        size: IVec2::new(level.width as i32, level.height as i32),
        layers: level.layers as i32,
        start: level.offset as usize / texel_bytes,
    });
    let levels: Vec<Level> = levels.collect();
    let whole = |level: &Level| {
        let side = 1..=i32::from(i16::MAX);
        let count = i64::from(level.size.x) * i64::from(level.size.y) * i64::from(level.layers);
        let fits = level.start as i64 + count <= (bytes.len() / texel_bytes) as i64;
        side.contains(&level.size.x) && side.contains(&level.size.y) && side.contains(&level.layers) && fits
    };
    if table.format.is_compressed() || levels.is_empty() || !levels.iter().all(whole) {
        return None;
    }
    let (wrap, filter) = match &texture.sampler {
        Some(sampler) => (sampler.wrap, sampler.filter),
        None => (Wrap::Clamp, Filter::Nearest),
    };
    Some(Texture { levels, wrap, filter, texels: texels(table.format, bytes) })
}

fn texels(format: Format, bytes: &[u8]) -> Texels {
    let light: Vec<f32> = (0..=255u8).map(|code| srgb_to_linear(f64::from(code) / 255.0) as f32).collect();
    let unorm = |byte: u8| f32::from(byte) / 255.0;
    let srgb = |byte: u8| light[usize::from(byte)];
    let snorm = |byte: u8| (f32::from(byte as i8) / 127.0).max(-1.0);
    let half = |pair: &[u8]| f16::from_le_bytes([pair[0], pair[1]]).to_f32();
    match format {
        Format::Rgba8UnormSrgb => {
            floats(bytes, 4, |t| Vec4::new(srgb(t[0]), srgb(t[1]), srgb(t[2]), unorm(t[3])))
        }
        Format::Rgba8Unorm => {
            floats(bytes, 4, |t| Vec4::new(unorm(t[0]), unorm(t[1]), unorm(t[2]), unorm(t[3])))
        }
        Format::Rgba8Snorm => {
            floats(bytes, 4, |t| Vec4::new(snorm(t[0]), snorm(t[1]), snorm(t[2]), snorm(t[3])))
        }
        Format::Rgba16Float => {
            floats(bytes, 8, |t| Vec4::new(half(&t[0..2]), half(&t[2..4]), half(&t[4..6]), half(&t[6..8])))
        }
        Format::R32Sint => ints(bytes, 4),
        Format::Rgba32Sint => ints(bytes, 16),
        Format::Bc1RgbaUnorm | Format::Bc7RgbaUnorm => Texels::Float(Vec::new()),
    }
}

fn floats(bytes: &[u8], texel_bytes: usize, texel: impl Fn(&[u8]) -> Vec4 + Sync + Send) -> Texels {
    Texels::Float(bytes.par_chunks_exact(texel_bytes).map(texel).collect())
}

/// Channels that a format does not have are 0, alpha 1, as a shader reads them.
fn ints(bytes: &[u8], texel_bytes: usize) -> Texels {
    let texel = |bytes: &[u8]| {
        let mut components = [0, 0, 0, 1];
        for (component, word) in components.iter_mut().zip(bytes.chunks_exact(4)) {
            *component = i32::from_le_bytes([word[0], word[1], word[2], word[3]]);
        }
        IVec4::from_array(components)
    };
    Texels::Int(bytes.par_chunks_exact(texel_bytes).map(texel).collect())
}
