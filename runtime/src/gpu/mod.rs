//! The GPU renderer; the only place that knows wgpu.
//!
//! A [`Gpu`] is a device, made once. [`Gpu::prepare`] uploads a program's textures and builds its
//! pipeline; the [`Scene`] it gives renders any number of pictures. Everything a shader asks for
//! (bindings, samplers, offsets) is read from the manifest, as any other host would.
//!
//! Errors of the driver become [`RenderError::Gpu`]: every piece of work runs in `Gpu::guarded`.

mod adapter;
mod bindings;
mod drawing;
mod pipeline;
mod scene;
mod texture;

pub use scene::Scene;

use crate::render::RenderError;
use crate::resource::Tables;
use std::sync::{Arc, Mutex, PoisonError};
use texgraph_compiler::Program;

/// Which adapters do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preference {
    /// A graphics card, else a software driver.
    Hardware,
    /// A software driver only: the same pictures on every machine that has it.
    Software,
}

/// A device to render on. Within WebGPU's default limits; of the optional features only block-compressed
/// textures are used.
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    info: wgpu::AdapterInfo,
    /// The first error that no one was waiting for: a lost device, say.
    stray: Arc<Mutex<Option<String>>>,
}

impl Gpu {
    /// Opens the best adapter that has WebGPU's default limits. Takes about half a second.
    ///
    /// # Errors
    /// There is none; the error tells what each lacks.
    pub fn new(preference: Preference) -> Result<Gpu, RenderError> {
        let (info, device, queue) = adapter::open(preference)?;
        let stray = Arc::new(Mutex::new(None));
        let keep = Arc::clone(&stray);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let mut first = keep.lock().unwrap_or_else(PoisonError::into_inner);
            first.get_or_insert_with(|| error.to_string());
        }));
        Ok(Gpu { device, queue, info, stray })
    }

    /// The adapter and its driver, in words.
    pub fn name(&self) -> String {
        adapter::describe(&self.info)
    }

    /// Whether the adapter is a program on the CPU, not a graphics card.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Whether it reads block-compressed textures.
    pub fn reads_blocks(&self) -> bool {
        self.device.features().contains(wgpu::Features::TEXTURE_COMPRESSION_BC)
    }

    /// Uploads a program's textures and builds the pipeline of one of its outputs.
    ///
    /// The shaders are the texts in the program's passes, under the entry points that its manifest
    /// names. A text written by hand is drawn in the place of the compiler's if it binds and names
    /// the same: `program.passes.last_mut()` holds the texture's, in `wgsl`.
    ///
    /// # Errors
    /// There is no such output, a table is missing, or the driver refuses the shader.
    pub fn prepare<'a>(
        &'a self,
        program: &'a Program,
        tables: &Tables,
        output: usize,
    ) -> Result<Scene<'a>, RenderError> {
        Scene::new(self, program, tables, output)
    }

    /// Does some work on the device; the first error that it meets.
    fn guarded<T>(&self, work: impl FnOnce() -> Result<T, RenderError>) -> Result<T, RenderError> {
        let filters =
            [wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Validation];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let result = work();
        let mut errors = scopes.into_iter().rev().map(|scope| pollster::block_on(scope.pop()));
        let caught = errors.by_ref().fold(None, |first: Option<String>, error| {
            first.or_else(|| error.map(|error| error.to_string()))
        });
        let stray = self.stray.lock().unwrap_or_else(PoisonError::into_inner).take();
        match caught.or(stray) {
            Some(text) => Err(RenderError::Gpu(text)),
            None => result,
        }
    }
}
