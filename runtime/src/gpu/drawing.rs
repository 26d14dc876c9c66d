//! A pass ready to draw, tile by tile.

use super::bindings::Bindings;
use super::texture::Textures;
use super::{Gpu, pipeline};
use crate::pass::Pass;
use crate::picture::Picture;
use crate::render::{RenderError, Request};
use std::sync::mpsc;

/// The side of a tile in pixels: small enough for a driver's patience, and for progress to move.
const TILE: u32 = 1024;

/// Bytes of a pixel.
const PIXEL: u32 = 16;

/// A pass with its bindings, and the pipeline of one of its outputs.
pub struct Drawing<'a> {
    pass: Pass<'a>,
    location: u32,
    bindings: Bindings,
    pipeline: wgpu::RenderPipeline,
}

/// What tiles are drawn with and to, used again for each.
struct Canvas {
    corners: wgpu::Buffer,
    target: wgpu::Texture,
    read_back: wgpu::Buffer,
}

/// A part of the picture.
#[derive(Clone, Copy)]
struct Tile {
    first: [u32; 2],
    size: [u32; 2],
}

impl Tile {
    /// The bytes of a row when it is copied; WebGPU wants multiples of 256.
    fn row_bytes(self) -> u32 {
        (self.size[0] * PIXEL).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
    }
}

impl<'a> Drawing<'a> {
    /// Makes a pass ready to draw the output at a `@location`.
    pub fn new(
        gpu: &Gpu,
        pass: &Pass<'a>,
        location: u32,
        textures: &Textures,
        uniform: Option<&wgpu::Buffer>,
    ) -> Result<Drawing<'a>, RenderError> {
        if location >= gpu.device.limits().max_color_attachments {
            return Err(RenderError::Gpu(format!("there is no attachment number {location}")));
        }
        gpu.guarded(|| {
            let bindings = Bindings::new(gpu, pass, textures, uniform)?;
            let pipeline = pipeline::build(gpu, pass, &bindings, location);
            Ok(Drawing { pass: pass.clone(), location, bindings, pipeline })
        })
    }

    /// Draws into a blank picture. `progress` hears shares from 0 to 1.
    pub fn draw(
        &self,
        gpu: &Gpu,
        request: &Request,
        picture: &mut Picture,
        progress: &(dyn Fn(f32) + Sync),
    ) -> Result<(), RenderError> {
        gpu.guarded(|| {
            let canvas = self.canvas(gpu, request.size.map(|side| side.min(TILE)));
            let tiles = tiles(request.size);
            for (done, tile) in (1..).zip(&tiles) {
                self.draw_tile(gpu, &canvas, request, *tile);
                read(gpu, &canvas, *tile, picture)?;
                progress(done as f32 / tiles.len() as f32);
            }
            Ok(())
        })
    }

    fn canvas(&self, gpu: &Gpu, size: [u32; 2]) -> Canvas {
        let device = &gpu.device;
        let buffer = |size: u64, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let whole = Tile { first: [0, 0], size };
        let corners = pipeline::corners(&self.pass.inputs, &Request::new(size), [0, 0], size).len() as u64;
        Canvas {
            corners: buffer(corners, wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST),
            target: device.create_texture(&wgpu::TextureDescriptor {
                label: Some("tile"),
                size: extent(size),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: pipeline::TARGET,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            }),
            read_back: buffer(
                u64::from(whole.row_bytes()) * u64::from(size[1]),
                wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            ),
        }
    }

    /// Draws a tile and copies it to where it can be read.
    fn draw_tile(&self, gpu: &Gpu, canvas: &Canvas, request: &Request, tile: Tile) {
        let corners = pipeline::corners(&self.pass.inputs, request, tile.first, tile.size);
        gpu.queue.write_buffer(&canvas.corners, 0, &corners);
        let view = canvas.target.create_view(&wgpu::TextureViewDescriptor::default());
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.pass(&mut encoder, &view, canvas, tile);
        encoder.copy_texture_to_buffer(
            canvas.target.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &canvas.read_back,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(tile.row_bytes()),
                    rows_per_image: None,
                },
            },
            extent(tile.size),
        );
        gpu.queue.submit([encoder.finish()]);
    }

    fn pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &wgpu::TextureView,
        canvas: &Canvas,
        tile: Tile,
    ) {
        let mut attachments = vec![None; self.location as usize];
        attachments.push(Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                store: wgpu::StoreOp::Store,
            },
        }));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &attachments,
            depth_stencil_attachment: None,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        let [width, height] = tile.size.map(|side| side as f32);
        pass.set_viewport(0.0, 0.0, width, height, 0.0, 1.0);
        pass.set_pipeline(&self.pipeline);
        for (number, group) in (0..).zip(&self.bindings.groups) {
            pass.set_bind_group(number, group, &[]);
        }
        pass.set_vertex_buffer(0, canvas.corners.slice(..));
        pass.draw(0..3, 0..1);
    }
}

/// Waits for a tile and copies its pixels into the picture.
fn read(gpu: &Gpu, canvas: &Canvas, tile: Tile, picture: &mut Picture) -> Result<(), RenderError> {
    let failed = |error: &dyn std::fmt::Display| RenderError::Gpu(error.to_string());
    let (sender, receiver) = mpsc::channel();
    canvas.read_back.map_async(wgpu::MapMode::Read, .., move |result| {
        // The receiver is gone only after an error that is reported already.
        let _ = sender.send(result);
    });
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(&error))?;
    // A poll of another thread may be calling back still.
    let mapped = receiver.recv().map_err(|_| failed(&"the picture was not read back"))?;
    mapped.map_err(|error| failed(&error))?;
    let bytes = canvas.read_back.get_mapped_range(..).map_err(|error| failed(&error))?;
    copy_rows(&bytes, tile, picture);
    drop(bytes);
    canvas.read_back.unmap();
    Ok(())
}
fn extent(size: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 }
}

/// The parts of a picture, row by row.
fn tiles(size: [u32; 2]) -> Vec<Tile> {
    let starts = |side: u32| (0..side).step_by(TILE as usize);
    let tile =
        |x: u32, y: u32| Tile { first: [x, y], size: [(size[0] - x).min(TILE), (size[1] - y).min(TILE)] };
    starts(size[1]).flat_map(|y| starts(size[0]).map(move |x| tile(x, y))).collect()
}

fn copy_rows(bytes: &[u8], tile: Tile, picture: &mut Picture) {
    let rows = bytes.chunks_exact(tile.row_bytes() as usize).take(tile.size[1] as usize);
    for (y, row) in (tile.first[1] as usize..).zip(rows) {
        let start = y * picture.size[0] as usize + tile.first[0] as usize;
        let pixels = picture.pixels[start..].iter_mut().take(tile.size[0] as usize);
        for (pixel, texel) in pixels.zip(row.chunks_exact(PIXEL as usize)) {
            for (component, word) in pixel.iter_mut().zip(texel.chunks_exact(4)) {
                *component = f32::from_le_bytes([word[0], word[1], word[2], word[3]]);
            }
        }
    }
}
