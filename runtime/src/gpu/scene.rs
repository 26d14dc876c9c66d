//! A program ready to draw, tile by tile.

use super::bindings::Bindings;
use super::{Gpu, pipeline};
use crate::picture::Picture;
use crate::render::{RenderError, Request};
use crate::resource::Tables;
use crate::uniform;
use std::sync::mpsc;
use texgraph_compiler::Program;

/// The side of a tile in pixels: small enough for a driver's patience, and for progress to move.
const TILE: u32 = 1024;

/// Bytes of a pixel.
const PIXEL: u32 = 16;

/// A program's textures on the device, and the pipeline of one of its outputs.
pub struct Scene<'a> {
    gpu: &'a Gpu,
    program: &'a Program,
    output: usize,
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

impl<'a> Scene<'a> {
    pub(super) fn new(
        gpu: &'a Gpu,
        program: &'a Program,
        tables: &Tables,
        output: usize,
    ) -> Result<Scene<'a>, RenderError> {
        let outputs = &program.manifest.outputs;
        let location =
            outputs.get(output).ok_or(RenderError::NoOutput { output, outputs: outputs.len() })?.location;
        if location >= gpu.device.limits().max_color_attachments {
            return Err(RenderError::Gpu(format!("there is no attachment number {location}")));
        }
        gpu.guarded(|| {
            let bindings = Bindings::new(gpu, &program.manifest, tables)?;
            let pipeline = pipeline::build(gpu, program, &bindings, location)?;
            Ok(Scene { gpu, program, output, location, bindings, pipeline })
        })
    }

    /// Renders a picture of the output that the scene was prepared for; the request's own is not
    /// looked at. `progress` hears shares from 0 to 1.
    ///
    /// # Errors
    /// The request can't be met, or the driver fails.
    pub fn render(&self, request: &Request, progress: &(dyn Fn(f32) + Sync)) -> Result<Picture, RenderError> {
        let request = Request { output: self.output, ..request.clone() };
        let mut picture = request.picture(self.program)?;
        self.gpu.guarded(|| {
            if let Some(buffer) = &self.bindings.uniform {
                let bytes = uniform::block(&self.program.manifest, &request.settings, &request.draw());
                self.gpu.queue.write_buffer(buffer, 0, &bytes);
            }
            let canvas = self.canvas(request.size.map(|side| side.min(TILE)));
            let tiles = tiles(request.size);
            for (done, tile) in (1..).zip(&tiles) {
                self.draw(&canvas, &request, *tile);
                self.read(&canvas, *tile, &mut picture)?;
                progress(done as f32 / tiles.len() as f32);
            }
            Ok(())
        })?;
        Ok(picture)
    }

    fn canvas(&self, size: [u32; 2]) -> Canvas {
        let device = &self.gpu.device;
        let buffer = |size: u64, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let whole = Tile { first: [0, 0], size };
        let corners =
            pipeline::corners(&self.program.manifest, &Request::new(size), [0, 0], size).len() as u64;
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
    fn draw(&self, canvas: &Canvas, request: &Request, tile: Tile) {
        let corners = pipeline::corners(&self.program.manifest, request, tile.first, tile.size);
        self.gpu.queue.write_buffer(&canvas.corners, 0, &corners);
        let view = canvas.target.create_view(&wgpu::TextureViewDescriptor::default());
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
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
        self.gpu.queue.submit([encoder.finish()]);
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

    /// Waits for a tile and copies its pixels into the picture.
    fn read(&self, canvas: &Canvas, tile: Tile, picture: &mut Picture) -> Result<(), RenderError> {
        let failed = |error: &dyn std::fmt::Display| RenderError::Gpu(error.to_string());
        let (sender, receiver) = mpsc::channel();
        canvas.read_back.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone only after an error that is reported already.
            let _ = sender.send(result);
        });
        self.gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(&error))?;
        // A poll of another thread may be calling back still.
        let mapped = receiver.recv().map_err(|_| failed(&"the picture was not read back"))?;
        mapped.map_err(|error| failed(&error))?;
        let bytes = canvas.read_back.get_mapped_range(..).map_err(|error| failed(&error))?;
        copy_rows(&bytes, tile, picture);
        drop(bytes);
        canvas.read_back.unmap();
        Ok(())
    }
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
