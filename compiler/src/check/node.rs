//! Nodes as arguments: a lambda, a named node, or a node that was passed in itself, becomes a
//! function of the inputs that its type names and of what it reads from where it was written.

use super::arguments::{Arguments, Given};
use super::call::Callee;
use super::candidates::Candidates;
use super::types::{Declared, NodeType};
use super::wire::{NodeWire, Wire};
use super::{Checker, Frame};
use crate::diagnostic::{Place, nodes};
use crate::graph::{Builder, Constant, Scalar, Type, Value};
use smol_str::{SmolStr, format_smolstr};
use std::rc::Rc;
use std::sync::Arc;
use texgraph_grammar::syntax::{Expr, ExprKind, Name, Postfix};

/// What is to become a node.
enum Source<'a> {
    Lambda(&'a [Name], &'a Expr),
    Named(Callee<'a>, Candidates<'a>),
    Passed(Rc<NodeWire>),
}

impl<'a> Checker<'a> {
    /// An argument as a node of a type.
    pub(super) fn node_argument(
        &mut self,
        f: &mut Frame<'a>,
        input: &str,
        ty: &Arc<NodeType>,
        given: &Given<'a>,
    ) -> Wire {
        let Some(source) = self.node_source(f, input, given) else { return Wire::Unknown };
        match source {
            Source::Passed(node) if node.ty == *ty => Wire::Node(node),
            Source::Passed(node) => self.closure(f, input, ty, given.place, |checker, f, arguments| {
                let node = f.import_node(&node);
                let name = match given.expr.map(|expr| &expr.kind) {
                    Some(ExprKind::Name(name)) => name.as_str(),
                    _ => "",
                };
                let callee = Callee { name, place: given.place, dim: None };
                checker.call_passed(f, &node, callee, arguments, given.place)
            }),
            Source::Named(callee, candidates) => {
                self.closure(f, input, ty, given.place, |checker, f, arguments| {
                    checker.call_one_of(f, &candidates, callee, arguments, given.place)
                })
            }
            Source::Lambda(names, body) => {
                if names.len() != ty.inputs.len() {
                    let wanted: Vec<&str> = ty.inputs.iter().map(|(name, _)| name.as_str()).collect();
                    return self.report(f, nodes::lambda_inputs(given.place, input, &wanted, names.len()));
                }
                self.distinct(f, &names.iter().collect::<Vec<_>>());
                self.closure(f, input, ty, given.place, |checker, f, arguments| {
                    for (name, argument) in names.iter().zip(arguments) {
                        f.scopes[f.base].insert(&name.text, argument.wire.clone());
                    }
                    checker.expr(f, body)
                })
            }
        }
    }

    fn node_source(&mut self, f: &mut Frame<'a>, input: &str, given: &Given<'a>) -> Option<Source<'a>> {
        let place = given.place;
        match (&given.wire, given.expr.map(|expr| &expr.kind)) {
            (Wire::Lambda, Some(ExprKind::Lambda { inputs, body })) => Some(Source::Lambda(inputs, body)),
            (Wire::Node(node), _) => Some(Source::Passed(Rc::clone(node))),
            (Wire::Callables(nodes), Some(ExprKind::Postfix { links, .. })) => {
                let name = links.iter().find_map(|link| match link {
                    Postfix::Field(name) => Some(name.text.as_str()),
                    _ => None,
                });
                let callee = Callee { name: name.unwrap_or_default(), place, dim: None };
                Some(Source::Named(callee, nodes.callables.clone().into()))
            }
            // A name before a bracket is looked up among nodes only, so here it is too.
            (_, Some(ExprKind::Name(name))) if !self.callables_of(f.module, name).is_empty() => {
                Some(Source::Named(Callee { name, place, dim: None }, self.callables_of(f.module, name)))
            }
            (Wire::Word(word), _) => {
                let own = self.modules[f.module].tree.items.iter().filter_map(super::globals::node_of);
                let own: Vec<&str> = own.map(|node| node.name.text.as_str()).collect();
                let near = self.near(&word.text, own.into_iter().chain(self.library.callable_names()));
                let error = nodes::not_a_node(word.place, input, "a name that nothing has", near);
                self.report(f, error);
                None
            }
            (wire, _) => {
                let found = super::types::describe(wire, |v| f.builder.ty(v));
                self.report(f, nodes::not_a_node(place, input, &found, None));
                None
            }
        }
    }

    /// A function inside the present one whose inputs have the types of a node type.
    fn closure(
        &mut self,
        f: &mut Frame<'a>,
        input: &str,
        ty: &Arc<NodeType>,
        place: Place,
        make: impl FnOnce(&mut Self, &mut Frame<'a>, &[Given<'a>]) -> Wire,
    ) -> Wire {
        f.enter(input);
        let arguments = ty.inputs.iter().map(|(name, declared)| Given {
            name: None,
            wire: open_input(&mut f.builder, name, declared),
            place,
            expr: None,
        });
        let arguments: Arguments<'a> = arguments.collect();
        let wire = make(self, f, &arguments);
        let given = match wire {
            Wire::Unknown => None,
            _ if f.waiting.is_empty() => self.parts(f, &ty.output, wire, place),
            _ => None,
        };
        if let Some(values) = &given {
            for (name, value) in slots(&ty.output, "value").into_iter().zip(values) {
                f.builder.output(name, *value);
            }
        }
        f.builder.set_inline(true);
        let (builder, captures) = f.leave();
        match given {
            Some(_) => {
                let function = self.intern(builder.finish());
                Wire::Node(Rc::new(NodeWire { function, ty: Arc::clone(ty), captures }))
            }
            None => Wire::Unknown,
        }
    }

    /// A wire as the values of an output; none when it does not fit (reported).
    fn parts(
        &mut self,
        f: &mut Frame<'a>,
        declared: &Declared,
        wire: Wire,
        place: Place,
    ) -> Option<Vec<Value>> {
        match declared {
            Declared::Vector(scalar, width) => {
                self.coerce_value(f, &wire, *scalar, *width, place).map(|value| vec![value])
            }
            Declared::Matrix(size) => self.coerce_matrix(f, &wire, *size, place).map(|m| m.to_vec()),
            Declared::Texel => self.texel_of(f, &wire, place).map(|value| vec![value]),
            Declared::Record(fields) => {
                let outputs = match &wire {
                    Wire::Record(outputs) if outputs.len() == fields.len() => Rc::clone(outputs),
                    other => {
                        let wanted: Vec<String> = fields.iter().map(|(name, _)| name.to_string()).collect();
                        let found = super::types::describe(other, |v| f.builder.ty(v));
                        self.report(f, nodes::record_fields(place, &wanted, &found));
                        return None;
                    }
                };
                let mut values = Vec::new();
                for ((_, declared), (_, wire)) in fields.iter().zip(outputs.iter()) {
                    values.extend(self.parts(f, declared, wire.clone(), place)?);
                }
                Some(values)
            }
            _ => None,
        }
    }

    /// One to four floats as a texel: a scalar as (v, v, v, 1), two as (x, y, 0, 1), three as
    /// (x, y, z, 1), as outputs are widened.
    fn texel_of(&mut self, f: &mut Frame<'a>, wire: &Wire, place: Place) -> Option<Value> {
        let value = self.value(f, wire, place)?;
        let width = f.builder.ty(value).width();
        let value = self.coerce_value(f, &Wire::Value(value), Scalar::Float, width, place)?;
        let components: Vec<Value> = (0..width).map(|i| f.builder.extract(value, i)).collect();
        let [zero, one] = [0.0, 1.0].map(|x| f.builder.constant(Constant::floats(&[x])));
        let all = match components.as_slice() {
            [v] => vec![*v, *v, *v, one],
            [x, y] => vec![*x, *y, zero, one],
            [x, y, z] => vec![*x, *y, *z, one],
            _ => components,
        };
        Some(f.builder.compose(&all))
    }

    /// Calls a node that was passed in.
    pub(super) fn call_passed(
        &mut self,
        f: &mut Frame<'a>,
        node: &NodeWire,
        callee: Callee<'a>,
        given: &[Given<'a>],
        place: Place,
    ) -> Wire {
        let inputs: Vec<&str> = node.ty.inputs.iter().map(|(name, _)| name.as_str()).collect();
        let Some(given) = self.passed_arguments(f, &inputs, callee, given, place) else {
            return Wire::Unknown;
        };
        let mut arguments = Vec::new();
        for ((_, declared), given) in node.ty.inputs.iter().zip(given) {
            if matches!(given.wire, Wire::Unknown) {
                return Wire::Unknown;
            }
            match self.parts(f, declared, given.wire.clone(), given.place) {
                Some(values) => arguments.extend(values),
                None => return Wire::Unknown,
            }
        }
        arguments.extend(&node.captures);
        f.builder.set_place(place);
        let results = self.results(f, node.function, arguments);
        let mut results = results.into_iter();
        shaped(&node.ty.output, &mut results)
    }

    /// One argument for each input, by position or by name.
    fn passed_arguments<'g>(
        &mut self,
        f: &mut Frame<'a>,
        inputs: &[&str],
        callee: Callee<'a>,
        given: &'g [Given<'a>],
        place: Place,
    ) -> Option<Vec<&'g Given<'a>>> {
        use crate::diagnostic::arguments as sentences;
        let mut slots: Vec<Option<&Given<'a>>> = vec![None; inputs.len()];
        for (i, argument) in given.iter().enumerate() {
            let position = match argument.name {
                None => Some(i),
                Some(name) => inputs.iter().position(|input| *input == name.text),
            };
            let error = match (position.and_then(|i| slots.get_mut(i)), argument.name) {
                (Some(slot @ None), _) => {
                    *slot = Some(argument);
                    continue;
                }
                (Some(Some(first)), _) => {
                    let input = position.and_then(|i| inputs.get(i)).copied().unwrap_or_default();
                    sentences::argument_twice(argument.place, callee.name, input, first.place)
                }
                (None, Some(name)) => {
                    let near = self.near(&name.text, inputs.iter().copied());
                    sentences::unknown_argument(self.place(f, name.span), callee.name, &name.text, near)
                }
                (None, None) => sentences::too_many_arguments(argument.place, callee.name, inputs),
            };
            self.report(f, error);
            return None;
        }
        if let Some(missing) = slots.iter().position(Option::is_none) {
            let input = inputs.get(missing).copied().unwrap_or_default();
            self.report(f, sentences::missing_argument(place, callee.name, input, "value"));
            return None;
        }
        slots.into_iter().collect()
    }
}

impl<'a> Frame<'a> {
    /// A node of the function around the present one, inside it.
    fn import_node(&mut self, node: &NodeWire) -> NodeWire {
        let level = self.layers.len().saturating_sub(1);
        let captures = node.captures.iter().map(|value| self.capture(level, *value)).collect();
        NodeWire { captures, ..node.clone() }
    }
}

/// New inputs of a type, as a wire.
pub fn open_input(builder: &mut Builder, name: &str, declared: &Declared) -> Wire {
    match declared {
        Declared::Vector(scalar, width) => Wire::Value(builder.input(name, Type::Vector(*scalar, *width))),
        Declared::Texel => Wire::Value(builder.input(name, Type::Vector(Scalar::Float, 4))),
        Declared::Matrix(size) => {
            let column = |i: u8| builder.input(column_name(name, i), Type::Vector(Scalar::Float, *size));
            Wire::Matrix((0..*size).map(column).collect())
        }
        Declared::Record(fields) => {
            let field = |(field, declared): &(SmolStr, Declared)| {
                (field.clone(), open_input(builder, &format!("{name}_{field}"), declared))
            };
            Wire::Record(Rc::new(fields.iter().map(field).collect()))
        }
        _ => Wire::Unknown,
    }
}

/// The name of a column of a matrix.
pub fn column_name(name: &str, i: u8) -> SmolStr {
    format_smolstr!("{name}_{}", ["x", "y", "z", "w"][usize::from(i.min(3))])
}

/// The names of a function's outputs for a value of a type.
pub fn slots(declared: &Declared, name: &str) -> Vec<SmolStr> {
    match declared {
        Declared::Matrix(size) => (0..*size).map(|i| column_name(name, i)).collect(),
        Declared::Record(fields) => {
            fields.iter().flat_map(|(field, declared)| slots(declared, field)).collect()
        }
        _ => vec![name.into()],
    }
}

/// The values of a function's outputs as one wire of a type.
pub fn shaped(declared: &Declared, values: &mut dyn Iterator<Item = Value>) -> Wire {
    match declared {
        Declared::Matrix(size) => Wire::Matrix(values.take(usize::from(*size)).collect()),
        Declared::Record(fields) => {
            let field = |(name, declared): &(SmolStr, Declared)| (name.clone(), shaped(declared, values));
            Wire::Record(Rc::new(fields.iter().map(field).collect()))
        }
        _ => values.next().map_or(Wire::Unknown, Wire::Value),
    }
}
