//! The bytes of a program's uniform block: params, and the inputs that change per draw.
//!
//! The offsets are the manifest's; components are little endian and lie without gaps, a bool is a
//! 32-bit 0 or 1, and what lies between the members is 0.

use crate::settings::Settings;
use texgraph_compiler::manifest::{Manifest, Scalar, Source, Type, Value};

/// The inputs of a texture that are the same for all pixels of a draw.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Draw {
    /// Seconds.
    pub time: f32,
    /// The whole part of the place, for textures far from the origin.
    pub base: [i32; 3],
    /// A seed per object.
    pub instance: i32,
}

impl Draw {
    /// The value of an input by its name; none for inputs that change per pixel.
    pub fn value(&self, name: &str, ty: Type) -> Option<Value> {
        match (name, ty.scalar) {
            ("time", Scalar::Float) => Some(Value::Float(vec![self.time])),
            ("base", Scalar::Int) => Some(Value::Int(self.base[..usize::from(ty.width.min(3))].to_vec())),
            ("instance", Scalar::Int) => Some(Value::Int(vec![self.instance])),
            _ => None,
        }
    }
}

/// The uniform block, as long as the manifest says; empty where there is none.
pub fn block(manifest: &Manifest, settings: &Settings, draw: &Draw) -> Vec<u8> {
    let mut bytes = vec![0; manifest.uniform.as_ref().map_or(0, |uniform| uniform.size as usize)];
    for param in &manifest.params {
        if let Some(offset) = param.offset {
            write(&mut bytes, offset, &settings.value(param));
        }
    }
    for input in &manifest.inputs {
        if let (Source::Uniform(offset), Some(value)) = (input.source, draw.value(&input.name, input.ty)) {
            write(&mut bytes, offset, &value);
        }
    }
    bytes
}

/// Writes what lies inside the block: a manifest from a file may lie about its offsets.
fn write(bytes: &mut [u8], offset: u32, value: &Value) {
    let words: Vec<[u8; 4]> = match value {
        Value::Float(components) => components.iter().map(|f| f.to_le_bytes()).collect(),
        Value::Int(components) => components.iter().map(|i| i.to_le_bytes()).collect(),
        Value::Bool(components) => components.iter().map(|b| u32::from(*b).to_le_bytes()).collect(),
    };
    let behind = bytes.get_mut(offset as usize..).unwrap_or_default();
    for (slot, word) in behind.chunks_exact_mut(4).zip(words) {
        slot.copy_from_slice(&word);
    }
}
