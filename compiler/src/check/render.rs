//! Anything as a texture: a node on its own, or a wire inside a node or texture, so that an author
//! can look at it.

use super::arguments::Given;
use super::node::column_name;
use super::types::{self, Declared};
use super::wire::{Key, Wire};
use super::{Checker, Frame, Outcome, Step, Target};
use crate::diagnostic::{Place, nodes, types as errors};
use crate::graph::{Builder, Constant, Scalar, Type, Value};
use crate::input::INPUTS;
use crate::intrinsic::{FLOOR_INT, LESS, MULTIPLY};
use crate::library::Callable;
use smallvec::SmallVec;
use texgraph_grammar::syntax::{Input, Node};

/// Cells along the unit square, where a node takes ints.
const CELLS: f32 = 16.0;

impl<'a> Checker<'a> {
    /// Makes a texture that calls a node: inputs without a default get what a picture has to offer.
    /// None when something is wrong.
    pub(super) fn rendered(&mut self, module: usize, item: usize, wire: Option<String>) -> Option<Key> {
        let node = self.node(module, item)?;
        let Some(statement) = node.body.statements.first() else {
            self.alone(module, item, node, true);
            return None;
        };
        let mut f = Frame::empty();
        f.module = module;
        f.builder = Builder::new(name_of(node, wire.as_deref()));
        let key = Key { module, item: usize::MAX, dims: SmallVec::new(), arguments: SmallVec::new(), wire };
        f.key = Some(key.clone());
        f.steps.push(Step { target: Target::Render(item), value: super::order::value_of(statement) });
        f.order.push(0);
        self.run(f);
        matches!(self.made.get(&key), Some(Outcome::Made(_))).then_some(key)
    }

    /// The call of the node that is to be rendered.
    pub(super) fn render_node(&mut self, f: &mut Frame<'a>, item: usize) -> Wire {
        let module = f.module;
        let (Some(node), Some(head)) = (self.node(module, item), self.head(Callable::Node(module, item)))
        else {
            return Wire::Unknown;
        };
        let place = self.place(f, node.name.span);
        let dims: types::Dims = node.dims.iter().map(|d| (d.text.as_str(), 2)).collect();
        let mut given = Vec::new();
        for input in node.inputs.iter().filter(|input| input.default.is_none()) {
            let declared = types::resolve(&input.ty, &dims, self.modules[module].file);
            let Some(wire) = declared.ok().and_then(|declared| offered(&mut f.builder, input, &declared))
            else {
                let (name, ty) = (&input.name.text, types::show(&input.ty));
                let at = self.place(f, input.name.span);
                return self.report(f, nodes::not_renderable(at, &node.name.text, name, &ty));
            };
            given.push(Given { name: Some(&input.name), wire, place, expr: None });
        }
        let Some(bound) = self.bind_arguments(f, head, None, &given, place) else { return Wire::Unknown };
        let wire = f.key.as_ref().and_then(|key| key.wire.clone());
        self.call_node(f, (module, item, wire), bound, place)
    }

    /// Makes a wire the only output of a function, under its own name.
    pub(super) fn output_wire(&mut self, f: &mut Frame<'a>, node: &'a Node, name: &str) {
        let place = self.place(f, node.name.span);
        let Some(wire) = f.scopes[0].get(name).cloned() else {
            let near = self.near(name, f.scopes[0].keys().copied());
            self.report(f, nodes::no_such_wire(place, &node.name.text, name, near));
            return;
        };
        self.output_parts(f, name, wire, place);
    }

    /// Makes outputs of a wire.
    pub(super) fn output_parts(&mut self, f: &mut Frame<'a>, name: &str, wire: Wire, place: Place) {
        match wire {
            Wire::Value(value) if f.builder.ty(value) == Type::BOOL => {
                let [one, zero] = [1.0, 0.0].map(|x| f.builder.constant(Constant::floats(&[x])));
                let shown = f.builder.select(value, one, zero);
                f.builder.output(name, shown);
            }
            Wire::Value(value) => f.builder.output(name, value),
            Wire::Matrix(columns) => {
                for (i, column) in (0..).zip(columns.iter()) {
                    f.builder.output(column_name(name, i), *column);
                }
            }
            Wire::Record(outputs) => {
                for (output, wire) in outputs.iter() {
                    self.output_parts(f, output, wire.clone(), place);
                }
            }
            Wire::Unknown => f.failed = true,
            other => {
                let what = types::describe(&other, |v| f.builder.ty(v));
                self.report(f, errors::not_a_value(place, &what));
            }
        }
    }
}

/// The name of a node or texture with its wire.
pub fn name_of(node: &Node, wire: Option<&str>) -> String {
    match wire {
        Some(wire) => format!("{}_{wire}", node.name.text),
        None => node.name.text.to_string(),
    }
}

/// What a picture has for an input: the texture input of its name and type, else the place (vectors
/// of two components get `uv`, of three `position`), cut into cells where ints are wanted.
fn offered(builder: &mut Builder, input: &Input, declared: &Declared) -> Option<Wire> {
    let (scalar, width) = match declared {
        Declared::Vector(scalar, width) => (*scalar, *width),
        Declared::Choice(words) => return Some(Wire::word(words.first()?, Place::default())),
        _ => return None,
    };
    let ty = Type::Vector(scalar, width);
    let known = INPUTS.iter().find(|known| known.name == input.name.text);
    if known.is_some_and(|known| known.types.contains(&types::show(&input.ty).as_str())) {
        return Some(Wire::Value(texture_input(builder, &input.name.text, ty)));
    }
    let place = if width == 3 {
        texture_input(builder, "position", Type::Vector(Scalar::Float, 3))
    } else {
        texture_input(builder, "uv", Type::Vector(Scalar::Float, 2))
    };
    let mut parts: Vec<Value> =
        (0..width.min(builder.ty(place).width())).map(|i| builder.extract(place, i)).collect();
    while parts.len() < usize::from(width) {
        let x = if parts.len() == 3 { 1.0 } else { 0.0 };
        parts.push(builder.constant(Constant::floats(&[x])));
    }
    let value = builder.compose(&parts);
    Some(Wire::Value(match scalar {
        Scalar::Float => value,
        Scalar::Int => {
            let cells = builder.constant(Constant::floats(&[CELLS]).splat(width));
            let scaled = builder.builtin(MULTIPLY, &[value, cells]);
            builder.builtin(FLOOR_INT, &[scaled])
        }
        Scalar::Bool => {
            let half = builder.constant(Constant::floats(&[0.5]));
            builder.builtin(LESS, &[value, half])
        }
    }))
}

/// An input of the texture, made once.
fn texture_input(builder: &mut Builder, name: &str, ty: Type) -> Value {
    let function = builder.function();
    let known = function.inputs.iter().position(|slot| slot.name == name);
    match known {
        Some(i) => builder.push(crate::graph::Operation::Input(i as u32), ty),
        None => builder.input(name, ty),
    }
}
