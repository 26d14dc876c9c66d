//! Finds and opens an adapter.

use super::Preference;
use super::pipeline::TARGET;
use crate::render::RenderError;
use wgpu::{Adapter, AdapterInfo, Device, DeviceType, Queue};

/// Opens the first adapter, in order of preference, that gives a device. OpenGL is only asked where
/// nothing else answers: it is the least like WebGPU, and some of its drivers print when asked.
pub fn open(preference: Preference) -> Result<(AdapterInfo, Device, Queue), RenderError> {
    let mut refusals = Vec::new();
    for backends in [wgpu::Backends::PRIMARY, wgpu::Backends::GL] {
        if let Some(opened) = open_one_of(backends, preference, &mut refusals) {
            return Ok(opened);
        }
    }
    let reason = if refusals.is_empty() { "no adapter was found".to_string() } else { refusals.join("; ") };
    Err(RenderError::NoAdapter { reason })
}

fn open_one_of(
    backends: wgpu::Backends,
    preference: Preference,
    refusals: &mut Vec<String>,
) -> Option<(AdapterInfo, Device, Queue)> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    descriptor.backends &= backends;
    let instance = wgpu::Instance::new(descriptor);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(backends));
    adapters.retain(|adapter| {
        preference == Preference::Hardware || adapter.get_info().device_type == DeviceType::Cpu
    });
    adapters.sort_by_key(|adapter| rank(&adapter.get_info()));
    for adapter in adapters {
        let info = adapter.get_info();
        match device(&adapter) {
            Ok((device, queue)) => return Some((info, device, queue)),
            Err(reason) => refusals.push(format!("{}: {reason}", describe(&info))),
        }
    }
    None
}

/// Graphics cards before software.
fn rank(info: &AdapterInfo) -> u8 {
    match info.device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    }
}

/// A device with exactly WebGPU's default limits, so that what runs here runs everywhere; compressed
/// textures, where it reads them, have plain forms for the others. Some OpenGL drivers claim these limits
/// but can't draw floats.
fn device(adapter: &Adapter) -> Result<(Device, Queue), String> {
    let usages = adapter.get_texture_format_features(TARGET).allowed_usages;
    if !usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
        return Err("it does not render to 32-bit floats".to_string());
    }
    let descriptor = wgpu::DeviceDescriptor {
        label: Some("texgraph"),
        required_features: adapter.features() & wgpu::Features::TEXTURE_COMPRESSION_BC,
        ..wgpu::DeviceDescriptor::default()
    };
    pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| error.to_string())
}

/// An adapter in words.
pub fn describe(info: &AdapterInfo) -> String {
    let driver = [info.driver.as_str(), info.driver_info.as_str()].join(" ");
    match driver.trim() {
        "" => format!("{} ({:?})", info.name, info.backend),
        driver => format!("{} ({:?}, {driver})", info.name, info.backend),
    }
}
