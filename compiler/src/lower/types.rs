//! Graph types as naga types.

use crate::graph::{Scalar, Texel, Type, View, ViewDimension};
use naga::{Handle, ImageClass, ImageDimension, ScalarKind, Span, TypeInner, VectorSize};
use rustc_hash::FxHashMap;

/// Handles of the types made so far.
#[derive(Default)]
pub struct Types {
    known: FxHashMap<Type, Handle<naga::Type>>,
}

/// A 32-bit scalar.
pub fn scalar(scalar: Scalar) -> naga::Scalar {
    match scalar {
        Scalar::Float => naga::Scalar::F32,
        Scalar::Int => naga::Scalar::I32,
        Scalar::Bool => naga::Scalar::BOOL,
    }
}

/// Two to four components.
pub fn size(width: u8) -> VectorSize {
    match width {
        2 => VectorSize::Bi,
        3 => VectorSize::Tri,
        _ => VectorSize::Quad,
    }
}

/// A scalar or a vector.
pub fn numeric(kind: naga::Scalar, width: u8) -> TypeInner {
    if width == 1 { TypeInner::Scalar(kind) } else { TypeInner::Vector { size: size(width), scalar: kind } }
}

fn image(view: View) -> TypeInner {
    let kind = match view.texel {
        Texel::Sampled => ScalarKind::Float,
        Texel::Integer => ScalarKind::Sint,
    };
    TypeInner::Image {
        dim: if view.dimension == ViewDimension::D3 { ImageDimension::D3 } else { ImageDimension::D2 },
        arrayed: view.dimension == ViewDimension::D2Array,
        class: ImageClass::Sampled { kind, multi: false },
    }
}

/// Size and alignment in bytes, natural layout.
pub fn layout(inner: &TypeInner) -> (u32, u32) {
    match inner {
        TypeInner::Vector { size: VectorSize::Bi, .. } => (8, 8),
        TypeInner::Vector { size: VectorSize::Tri, .. } => (12, 16),
        TypeInner::Vector { size: VectorSize::Quad, .. } => (16, 16),
        _ => (4, 4),
    }
}

impl Types {
    /// The handle of a type.
    pub fn get(&mut self, types: &mut naga::UniqueArena<naga::Type>, ty: Type) -> Handle<naga::Type> {
        *self.known.entry(ty).or_insert_with(|| {
            let inner = match ty {
                Type::Vector(kind, width) => numeric(scalar(kind), width),
                Type::View(view) => image(view),
            };
            types.insert(naga::Type { name: None, inner }, Span::UNDEFINED)
        })
    }

    /// The handle of an unnamed type.
    pub fn of(types: &mut naga::UniqueArena<naga::Type>, inner: TypeInner) -> Handle<naga::Type> {
        types.insert(naga::Type { name: None, inner }, Span::UNDEFINED)
    }

    /// The handle of a sampler.
    pub fn sampler(types: &mut naga::UniqueArena<naga::Type>) -> Handle<naga::Type> {
        Types::of(types, TypeInner::Sampler { comparison: false })
    }
}
