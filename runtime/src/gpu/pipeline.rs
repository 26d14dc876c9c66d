//! The pipeline of a flat picture: the program's fragment entry point behind a vertex stage of ours.
//!
//! One triangle covers the target. Its three corners carry the clip position and the program's
//! varyings as vertex attributes, so the vertex stage only hands them on and no binding is needed
//! that could clash with the program's.

use super::Gpu;
use super::bindings::Bindings;
use crate::flat::Slope;
use crate::pass::Pass;
use crate::render::Request;
use std::fmt::Write;
use texgraph_compiler::manifest::{Input, Scalar, Source, Type, Value};

/// What a pixel is rendered to; it keeps every bit of the shader's floats.
pub const TARGET: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Bytes of a corner's clip position.
const CLIP_BYTES: u64 = 8;

/// Inputs that come as varyings, with their location.
fn varyings(inputs: &[Input]) -> impl Iterator<Item = (&Input, u32)> {
    inputs.iter().filter_map(|input| match input.source {
        Source::Varying(location) => Some((input, location)),
        Source::Uniform(_) | Source::Member | Source::Argument => None,
    })
}

/// Builds the pipeline that draws one output.
pub fn build(gpu: &Gpu, pass: &Pass<'_>, bindings: &Bindings, location: u32) -> wgpu::RenderPipeline {
    let layouts: Vec<_> = bindings.layouts.iter().map(Some).collect();
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &layouts,
        immediate_size: 0,
    });
    let vertex = shader(gpu, "corners", vertex_stage(&pass.inputs));
    let fragment = shader(gpu, &pass.described.name, pass.code.wgsl.clone());
    let (attributes, stride) = attributes(&pass.inputs);
    let corners = wgpu::VertexBufferLayout {
        array_stride: stride,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &attributes,
    };
    let mut targets = vec![None; location as usize];
    targets.push(Some(wgpu::ColorTargetState {
        format: TARGET,
        blend: None,
        write_mask: wgpu::ColorWrites::ALL,
    }));
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(&pass.described.name),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &vertex,
            entry_point: Some("corner"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(corners)],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &fragment,
            entry_point: Some(&pass.described.entry_point),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn shader(gpu: &Gpu, label: &str, text: String) -> wgpu::ShaderModule {
    let source = wgpu::ShaderSource::Wgsl(text.into());
    gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source })
}

/// The text of the vertex stage.
fn vertex_stage(inputs: &[Input]) -> String {
    let (mut members, mut parameters, mut values) = (String::new(), String::new(), String::new());
    for (n, (input, location)) in (1..).zip(varyings(inputs)) {
        let ty = wgsl_type(input.ty);
        let flat = if input.ty.scalar == Scalar::Float { "" } else { " @interpolate(flat)" };
        // Writing to a String cannot fail.
        let _ = writeln!(members, "    @location({location}){flat} in{n}: {ty},");
        let _ = write!(parameters, ", @location({n}) in{n}: {ty}");
        let _ = write!(values, ", in{n}");
    }
    format!(
        "struct Corner {{\n    @builtin(position) clip: vec4<f32>,\n{members}}}\n\n\
         @vertex\nfn corner(@location(0) clip: vec2<f32>{parameters}) -> Corner {{\n    \
         return Corner(vec4<f32>(clip, 0.0, 1.0){values});\n}}\n"
    )
}

fn wgsl_type(ty: Type) -> String {
    let scalar = if ty.scalar == Scalar::Float { "f32" } else { "i32" };
    if ty.width == 1 { scalar.to_string() } else { format!("vec{}<{scalar}>", ty.width) }
}

/// The attributes of a corner, and the bytes from one to the next.
fn attributes(inputs: &[Input]) -> (Vec<wgpu::VertexAttribute>, u64) {
    let clip = wgpu::VertexAttribute { format: wgpu::VertexFormat::Float32x2, offset: 0, shader_location: 0 };
    let mut attributes = vec![clip];
    let mut offset = CLIP_BYTES;
    for (n, (input, _)) in (1..).zip(varyings(inputs)) {
        attributes.push(wgpu::VertexAttribute {
            format: vertex_format(input.ty),
            offset,
            shader_location: n,
        });
        offset += u64::from(input.ty.width) * 4;
    }
    (attributes, offset)
}

fn vertex_format(ty: Type) -> wgpu::VertexFormat {
    match (ty.scalar, ty.width) {
        (Scalar::Float, 1) => wgpu::VertexFormat::Float32,
        (Scalar::Float, 2) => wgpu::VertexFormat::Float32x2,
        (Scalar::Float, 3) => wgpu::VertexFormat::Float32x3,
        (Scalar::Float, _) => wgpu::VertexFormat::Float32x4,
        (_, 1) => wgpu::VertexFormat::Sint32,
        (_, 2) => wgpu::VertexFormat::Sint32x2,
        (_, 3) => wgpu::VertexFormat::Sint32x3,
        _ => wgpu::VertexFormat::Sint32x4,
    }
}

/// The bytes of the three corners for a part of the picture: its first pixel and its size. The
/// triangle reaches twice as far as the part, right and down.
pub fn corners(inputs: &[Input], request: &Request, first: [u32; 2], size: [u32; 2]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for [right, down] in [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]] {
        let clip = [right * 2.0 - 1.0, 1.0 - down * 2.0];
        bytes.extend(clip.iter().flat_map(|x: &f32| x.to_le_bytes()));
        let x = f64::from(first[0]) + f64::from(right) * f64::from(size[0]);
        let y = f64::from(first[1]) + f64::from(down) * f64::from(size[1]);
        for (input, _) in varyings(inputs) {
            bytes.extend(corner(input, request, x, y));
        }
    }
    bytes
}

/// An input's bytes at a place.
fn corner(input: &Input, request: &Request, x: f64, y: f64) -> Vec<u8> {
    let width = usize::from(input.ty.width);
    let floats = Slope::of(&input.name, request).at(x, y);
    match request.draw().value(&input.name, input.ty) {
        Some(Value::Int(components)) => components.iter().flat_map(|i| i.to_le_bytes()).collect(),
        _ => floats.iter().take(width).flat_map(|f| f.to_le_bytes()).collect(),
    }
}
