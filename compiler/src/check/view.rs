//! Reading textures: `sample` and `texel` of a view, or of a resource that stands for one.

use super::arguments::Given;
use super::types;
use super::wire::Wire;
use super::{Checker, Frame};
use crate::diagnostic::{Place, arguments as sentences, types as errors};
use crate::graph;
use crate::graph::{Axis, Builder, Constant, Level, Operation, Sampled, Scalar, Type, Value};
use crate::intrinsic::{DOT, MAXIMUM, MAXIMUM_INT, MINIMUM, MINIMUM_INT, MULTIPLY, RAW_LOG2, SUBTRACT_INT};
use crate::resource::KINDS;
use texgraph_grammar::syntax::Call;

impl<'a> Checker<'a> {
    /// `sample` and `texel` of a view, or of a resource that stands for one.
    pub(super) fn view_method(
        &mut self,
        f: &mut Frame<'a>,
        view: Value,
        call: &'a Call,
        given: &[Given<'a>],
        place: Place,
    ) -> Option<Wire> {
        let Type::View(ty) = f.builder.ty(view) else { return None };
        let name = call.name.text.as_str();
        let sampled = ty.texel == crate::graph::Texel::Sampled;
        let inputs: &[&str] = match name {
            "sample" if sampled => &["at", "layer", "lod", "gradient"],
            "texel" => &["i", "layer"],
            "level" if sampled => &["at"],
            _ => return None,
        };
        let mut slots: [Option<(Wire, Place)>; 4] = [None, None, None, None];
        for (i, argument) in given.iter().enumerate() {
            let position = match argument.name {
                None => Some(i).filter(|i| *i < 1),
                Some(written) => inputs.iter().position(|input| *input == written.text),
            };
            match position.and_then(|i| slots.get_mut(i)) {
                Some(slot) if slot.is_none() => *slot = Some((argument.wire.clone(), argument.place)),
                Some(slot) => {
                    let first = slot.as_ref().map_or(place, |(_, first)| *first);
                    let input = argument.name.map_or(inputs[0], |name| name.text.as_str());
                    return Some(
                        self.report(f, sentences::argument_twice(argument.place, name, input, first)),
                    );
                }
                None => return Some(self.view_argument_error(f, name, inputs, argument)),
            }
        }
        if slots.iter().flatten().any(|(wire, _)| matches!(wire, Wire::Unknown)) {
            return Some(Wire::Unknown);
        }
        let scalar = if name == "texel" { Scalar::Int } else { Scalar::Float };
        let Some((at, at_place)) = slots[0].take() else {
            let wanted = types::name(Type::Vector(scalar, ty.coordinates()));
            return Some(self.report(f, sentences::missing_argument(place, name, inputs[0], &wanted)));
        };
        let Some(at) = self.coordinate(f, &at, scalar, ty.coordinates(), at_place) else {
            return Some(Wire::Unknown);
        };
        if name == "level" {
            f.builder.set_place(place);
            return Some(Wire::Value(level_of_detail(&mut f.builder, view, at)));
        }
        let Ok(layer) = self.layer(f, ty, slots[1].take(), name, place) else { return Some(Wire::Unknown) };
        f.builder.set_place(place);
        if name == "texel" {
            // The library's indices lie inside already.
            let is_library = f.module < self.library.modules().len();
            let at = if is_library { at } else { inside(&mut f.builder, view, at) };
            return Some(Wire::Value(f.builder.texel(view, at, layer)));
        }
        let Some(level) = self.level(f, ty, &slots) else { return Some(Wire::Unknown) };
        f.builder.set_place(place);
        Some(Wire::Value(f.builder.sample(view, at, layer, level)))
    }

    fn view_argument_error(
        &mut self,
        f: &mut Frame<'a>,
        name: &str,
        inputs: &[&str],
        argument: &Given<'a>,
    ) -> Wire {
        let error = match argument.name {
            Some(written) => {
                let near = self.near(&written.text, inputs.iter().copied());
                sentences::unknown_argument(self.place(f, written.span), name, &written.text, near)
            }
            None => sentences::named_only(argument.place, name, inputs.get(1..).unwrap_or_default()),
        };
        self.report(f, error)
    }

    /// A coordinate has as many components as the view; a scalar does not spread here.
    fn coordinate(
        &mut self,
        f: &mut Frame<'a>,
        wire: &Wire,
        scalar: Scalar,
        width: u8,
        place: Place,
    ) -> Option<Value> {
        let value = self.value(f, wire, place)?;
        if f.builder.ty(value).width() != width {
            let (wanted, found) =
                (types::name(Type::Vector(scalar, width)), types::name(f.builder.ty(value)));
            self.report(f, errors::mismatch(place, None, &wanted, &found));
            return None;
        }
        self.coerce_value(f, wire, scalar, width, place)
    }

    fn layer(
        &mut self,
        f: &mut Frame<'a>,
        ty: crate::graph::View,
        slot: Option<(Wire, Place)>,
        name: &str,
        place: Place,
    ) -> Result<Option<Value>, ()> {
        let array = ty.dimension == crate::graph::ViewDimension::D2Array;
        match slot {
            Some((_, at)) if !array => {
                self.report(f, sentences::no_layers(at, name));
                Err(())
            }
            None if array => {
                self.report(f, sentences::missing_layer(place, name));
                Err(())
            }
            Some((wire, at)) => self.coerce_value(f, &wire, Scalar::Int, 1, at).map(Some).ok_or(()),
            None => Ok(None),
        }
    }

    fn level(
        &mut self,
        f: &mut Frame<'a>,
        ty: crate::graph::View,
        slots: &[Option<(Wire, Place)>; 4],
    ) -> Option<Level> {
        if let Some((wire, at)) = &slots[2] {
            return self.coerce_value(f, wire, Scalar::Float, 1, *at).map(Level::Level);
        }
        let Some((wire, at)) = &slots[3] else { return Some(Level::Auto) };
        let value = self.coordinate(f, wire, Scalar::Float, ty.coordinates(), *at)?;
        let ty = f.builder.ty(value);
        let x = f.builder.push(Operation::Derivative(value, Axis::X, Sampled::Constant), ty);
        let y = f.builder.push(Operation::Derivative(value, Axis::Y, Sampled::Constant), ty);
        Some(Level::Gradient(x, y))
    }
}

/// The texel of level 0 that is nearest to an index: what lies outside is undefined in a shader.
fn inside(builder: &mut Builder, view: Value, index: Value) -> Value {
    let (size, width) = (builder.size(view), builder.ty(index).width());
    let [zero, one] = [0, 1].map(|int| {
        let int = builder.constant(Constant::ints(&[int]));
        builder.splat(int, width)
    });
    let last = builder.builtin(SUBTRACT_INT, &[size, one]);
    let below = builder.builtin(MINIMUM_INT, &[index, last]);
    builder.builtin(MAXIMUM_INT, &[below, zero])
}

/// 2⁻¹²⁰: levels are at least -60.
const LEAST_SQUARE: f32 = f32::from_bits((127 - 120) << 23);

/// The level of detail of a coordinate: log2 of the longer of its two derivatives in texels; where the
/// filter takes up to N samples along that one, of the shorter or an Nth of the longer, if that is more.
fn level_of_detail(builder: &mut Builder, view: Value, at: Value) -> Value {
    let (ty, size) = (builder.ty(at), builder.size(view));
    let size = builder.to_float(size);
    let [x, y] = [Axis::X, Axis::Y].map(|axis| {
        let derivative = builder.push(Operation::Derivative(at, axis, Sampled::Constant), ty);
        let texels = builder.builtin(MULTIPLY, &[derivative, size]);
        builder.builtin(DOT, &[texels, texels])
    });
    let mut longer = builder.builtin(MAXIMUM, &[x, y]);
    if let Type::View(graph::View { anisotropy: samples @ 2.., .. }) = builder.ty(view) {
        let share = builder.constant(Constant::floats(&[1.0 / (f32::from(samples) * f32::from(samples))]));
        let (shorter, part) =
            (builder.builtin(MINIMUM, &[x, y]), builder.builtin(MULTIPLY, &[longer, share]));
        longer = builder.builtin(MAXIMUM, &[shorter, part]);
    }
    // A place that does not move has a level too, one that nothing reaches.
    let least = builder.constant(Constant::floats(&[LEAST_SQUARE]));
    let longer = builder.builtin(MAXIMUM, &[longer, least]);
    let logarithm = builder.builtin(RAW_LOG2, &[longer]);
    let half = builder.constant(Constant::floats(&[0.5]));
    builder.builtin(MULTIPLY, &[logarithm, half])
}

/// The view that a wire is, or stands for.
pub(super) fn view_of(wire: &Wire) -> Option<Value> {
    match wire {
        Wire::View(view) => Some(*view),
        Wire::Resource(resource) => {
            let field = KINDS[resource.kind].view?;
            resource.views.iter().find(|(name, _)| *name == field).map(|(_, view)| *view)
        }
        _ => None,
    }
}
