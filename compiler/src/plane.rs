//! A texture on the ground: a plane in perspective, up to the horizon, instead of a flat picture.
//!
//! The camera is part of the graph. A new entry takes `uv` as the place in the picture (0 to 1, the
//! first row at the top) and calls the texture with the place on the plane that is seen there; the
//! derivatives of that place, on GPU and CPU alike, then follow from its formula as those of any
//! other value do. What fills a picture of a flat texture fills a picture of the plane.
//!
//! ```text
//!   eye ●───────────────▶ horizon, a quarter of the picture below its upper edge
//!       ┊ ╲
//!       ┊    ╲ a row of pixels sees one line of the plane, `far` times
//! ──────┴───────●──────── as far away as the lowest row
//! ```

use crate::graph::{Builder, Constant, Graph, Scalar, Slot, Type, Value};
use crate::intrinsic::{ADD, DIVIDE, GREATER, Intrinsic, MULTIPLY, NORMALIZE, SUBTRACT};

/// How far the horizon is below the picture's upper edge, in heights of the picture.
pub const HORIZON: f32 = 0.25;

/// What is above the horizon where the output is a `color`: linear and premultiplied, #a4b6c9. Other
/// outputs are 0 there.
pub const SKY: [f32; 4] = [0.371_238, 0.467_784, 0.584_078, 1.0];

/// How the plane is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Units of `uv` along the picture's lower edge. Finite, above 0.
    pub repeat: f32,
    /// The picture's width by its height.
    pub aspect: f32,
}

/// Where the eye meets the plane, and from where.
struct Seen {
    /// Whether the plane is seen at all.
    is_ground: Value,
    /// On the plane, in units of `uv`; v grows towards the eye.
    place: Value,
    /// From there to the eye, of unit length. The plane's normal is z.
    view: Value,
}

/// Puts a camera before a graph's entry, which stays the last function. The new one has the same
/// inputs, and `uv` if there was none.
pub fn seen(graph: &mut Graph, plane: Plane) {
    let callee = graph.entry();
    let Some(entry) = graph.functions.last() else { return };
    let mut b = Builder::new(entry.name.clone());
    let inputs: Vec<Value> =
        entry.inputs.iter().map(|Slot { name, ty }| b.input(name.clone(), *ty)).collect();
    let known = entry.inputs.iter().position(|slot| slot.name == "uv");
    let uv = match known.and_then(|n| inputs.get(n)) {
        Some(uv) => *uv,
        None => b.input("uv", Type::Vector(Scalar::Float, 2)),
    };
    let seen = camera(&mut b, uv, plane);
    let arguments = entry.inputs.iter().zip(inputs);
    let arguments = arguments.map(|(slot, input)| seen.input(&mut b, &slot.name, input)).collect();
    let outputs = b.call(callee, entry, arguments);
    for ((slot, _), value) in entry.outputs.iter().zip(outputs) {
        let sky = b.constant(sky(slot));
        let value = b.select(seen.is_ground, value, sky);
        b.output(slot.name.clone(), value);
    }
    graph.functions.push(b.finish());
}

/// The camera: the eye looks level, one height of the picture away from it. Lengths are in units of
/// the picture's lower edge.
fn camera(b: &mut Builder, uv: Value, Plane { repeat, aspect }: Plane) -> Seen {
    let [horizon, below, half, one, aspect, repeat] =
        [HORIZON, 1.0 - HORIZON, 0.5, 1.0, aspect, repeat].map(|x| b.constant(Constant::floats(&[x])));
    let (x, y) = (b.extract(uv, 0), b.extract(uv, 1));
    let mut of = |how: Intrinsic, first: Value, second: Value| b.builtin(how, &[first, second]);
    let is_ground = of(GREATER, y, horizon);
    let down = of(SUBTRACT, y, horizon);
    let far = of(DIVIDE, below, down);
    // From the place to the line below the eye, to the eye's foot, and up to the eye.
    let aside = of(SUBTRACT, half, x);
    let aside = of(MULTIPLY, aside, far);
    let back = of(DIVIDE, far, aspect);
    let up = of(DIVIDE, below, aspect);
    // The lower edge is 1 on both axes: v there, u at its right end.
    let foot = of(DIVIDE, one, aspect);
    let foot = of(ADD, one, foot);
    let place = [of(SUBTRACT, half, aside), of(SUBTRACT, foot, back)];
    let place = place.map(|part| of(MULTIPLY, part, repeat));
    let view = b.compose(&[aside, back, up]);
    Seen { is_ground, place: b.compose(&place), view: b.builtin(NORMALIZE, &[view]) }
}

impl Seen {
    /// What an input of the texture is there; what the plane does not change is passed on.
    fn input(&self, b: &mut Builder, name: &str, given: Value) -> Value {
        match name {
            "uv" | "uv2" => self.place,
            "position" => {
                let zero = b.constant(Constant::floats(&[0.0]));
                let (x, y) = (b.extract(self.place, 0), b.extract(self.place, 1));
                b.compose(&[x, y, zero])
            }
            "view" => self.view,
            _ => given,
        }
    }
}

/// What an output is above the horizon.
fn sky(slot: &Slot) -> Constant {
    let width = slot.ty.width();
    match slot.ty.scalar() {
        Some(Scalar::Float) if slot.name == "color" && width == 4 => Constant::floats(&SKY),
        scalar => Constant::zero(scalar.unwrap_or(Scalar::Float), width),
    }
}
