//! Calls that no row of a table describes: constructors of vectors, `dx`, `dy`, `given`.

use super::arguments::Given;
use super::types;
use super::wire::Wire;
use super::{Checker, Frame};
use crate::diagnostic::{Place, arguments as sentences, types as errors, unsupported};
use crate::graph::{Axis, Constant, Operation, Sampled, Scalar, Type, Value};
use crate::resource::LATER;
use texgraph_grammar::syntax::Call;

impl<'a> Checker<'a> {
    /// Calls that no row describes: constructors of vectors, `dx`, `dy`, `given`.
    pub(super) fn special(
        &mut self,
        f: &mut Frame<'a>,
        call: &'a Call,
        given: &[Given<'a>],
        place: Place,
    ) -> Option<Wire> {
        let name = call.name.text.as_str();
        if let Some((scalar, width)) = types::vector_constructor(name) {
            return Some(self.vector(f, call, scalar, width, given, place));
        }
        let is_library = f.module < self.library.modules().len();
        match name {
            "given" => Some(self.is_given(f, given, place)),
            "dx" => Some(self.derivative(f, name, Axis::X, Sampled::Changing, given, place)),
            "dy" => Some(self.derivative(f, name, Axis::Y, Sampled::Changing, given, place)),
            "_dx" if is_library => Some(self.derivative(f, name, Axis::X, Sampled::Constant, given, place)),
            "_dy" if is_library => Some(self.derivative(f, name, Axis::Y, Sampled::Constant, given, place)),
            "_demand" if is_library => Some(self.demand(f, given, place)),
            "mat2" | "mat3" => Some(self.matrix(f, if name == "mat2" { 2 } else { 3 }, given, place)),
            "fold_sprites" => Some(self.not_yet(f, place, name)),
            _ if LATER.contains(&name) => Some(self.not_yet(f, place, name)),
            _ => None,
        }
    }

    pub(super) fn not_yet(&mut self, f: &mut Frame<'a>, place: Place, name: &str) -> Wire {
        self.report(f, unsupported::not_yet(place, &format!("`{name}`")))
    }

    fn is_given(&mut self, f: &mut Frame<'a>, given: &[Given<'a>], place: Place) -> Wire {
        match given {
            [one] => {
                let holds = !matches!(one.wire, Wire::None);
                Wire::Value(f.builder.constant(Constant::bools(&[holds])))
            }
            [] => self.report(f, sentences::missing_argument(place, "given", "resource", "resource")),
            [_, second, ..] => {
                self.report(f, sentences::too_many_arguments(second.place, "given", &["resource"]))
            }
        }
    }

    /// `_demand(holds, value, "what is wrong", "what to do")`: the value, if the condition does not
    /// fail when compiling.
    fn demand(&mut self, f: &mut Frame<'a>, given: &[Given<'a>], place: Place) -> Wire {
        let wires: Vec<&Wire> = given.iter().map(|given| &given.wire).collect();
        let [Wire::Value(holds), value, Wire::Text(wrong), Wire::Text(mend)] = wires.as_slice() else {
            return self.report(f, sentences::missing_argument(place, "_demand", "mend", "a string"));
        };
        let fails = f.builder.as_constant(*holds) == Some(Constant::bools(&[false]));
        if !fails {
            return (*value).clone();
        }
        let node = f.node.map_or("", |node| node.name.text.as_str());
        self.diagnostics.push(sentences::demand(f.caller.unwrap_or(place), node, wrong, mend));
        f.failed = true;
        Wire::Unknown
    }

    fn derivative(
        &mut self,
        f: &mut Frame<'a>,
        name: &str,
        axis: Axis,
        sampled: Sampled,
        given: &[Given<'a>],
        place: Place,
    ) -> Wire {
        let [one] = given else {
            let error = match given.get(1) {
                Some(second) => sentences::too_many_arguments(second.place, name, &["value"]),
                None => sentences::missing_argument(place, name, "value", "vec<n>"),
            };
            return self.report(f, error);
        };
        let Some(value) = self.value(f, &one.wire, one.place) else { return Wire::Unknown };
        self.warn_if_still(f, name, one);
        let value = f.builder.to_float(value);
        if !f.builder.ty(value).is_float() {
            return self
                .report(f, errors::mismatch(one.place, None, "float", &types::name(f.builder.ty(value))));
        }
        let ty = f.builder.ty(value);
        Wire::Value(f.builder.push(Operation::Derivative(value, axis, sampled), ty))
    }

    /// `vec3(uv, 0.0)`, `ivec2(-1)`, `int(x)`, `vec<n>(x)`.
    fn vector(
        &mut self,
        f: &mut Frame<'a>,
        call: &'a Call,
        scalar: Scalar,
        width: Option<u8>,
        given: &[Given<'a>],
        place: Place,
    ) -> Wire {
        let width = match width {
            Some(_) if call.dim.is_some() => {
                let at = self.place(f, call.name.span);
                return self.report(f, errors::no_dimension(at, &call.name.text));
            }
            Some(width) => width,
            None => match types::width_of(&call.name.text, call.dim.as_ref(), &f.dims, place) {
                Ok(width) => width,
                Err(error) => return self.report(f, error),
            },
        };
        let mut parts = Vec::new();
        for argument in given {
            let Some(value) = self.value(f, &argument.wire, argument.place) else { return Wire::Unknown };
            f.builder.set_place(place);
            let value = match (scalar, f.builder.ty(value).scalar()) {
                (Scalar::Float, Some(Scalar::Int)) => f.builder.to_float(value),
                (Scalar::Int, Some(Scalar::Float)) => f.builder.to_int(value),
                (wanted, Some(found)) if wanted == found => value,
                _ => {
                    let (wanted, found) =
                        (types::name(Type::Vector(scalar, 1)), types::name(f.builder.ty(value)));
                    return self.report(f, errors::mismatch(argument.place, None, &wanted, &found));
                }
            };
            parts.push(value);
        }
        let count: usize = parts.iter().map(|v| usize::from(f.builder.ty(*v).width())).sum();
        if let [single] = parts.as_slice()
            && (count == 1 || count == usize::from(width))
        {
            return Wire::Value(f.builder.splat(*single, width));
        }
        if count != usize::from(width) {
            return self.report(f, errors::component_count(place, &call.name.text, width, count));
        }
        let scalars: Vec<Value> = parts
            .iter()
            .flat_map(|v| (0..f.builder.ty(*v).width()).map(|i| (*v, i)))
            .collect::<Vec<_>>()
            .into_iter()
            .map(|(v, i)| f.builder.extract(v, i))
            .collect();
        Wire::Value(f.builder.compose(&scalars))
    }
}
