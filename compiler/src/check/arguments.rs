//! Arguments to inputs: by position, by name, by default; dimensions bound; values converted.

use super::candidates::accepts;
use super::head::{Head, InputType, Known};
use super::types::{self, Declared, Dims};
use super::wire::Wire;
use super::{Checker, Frame};
use crate::diagnostic::{Place, arguments as sentences, limits, names, nodes, types as errors};
use crate::graph::{Scalar, Texel, Type, Value};
use crate::resource::{KINDS, dimension_of};
use smallvec::{SmallVec, smallvec};
use std::rc::Rc;
use texgraph_grammar::syntax::{Dim, Expr, ExprKind, Input, Name, TypeKind};

/// An argument, evaluated.
#[derive(Clone)]
pub struct Given<'a> {
    /// The input's name, when it was written.
    pub name: Option<&'a Name>,
    /// Its value.
    pub wire: Wire,
    /// Where it stands.
    pub place: Place,
    /// The expression, when there is one: a name may be a choice or a node, a lambda is made when
    /// the type of its input is known.
    pub expr: Option<&'a Expr>,
}

impl<'a> Given<'a> {
    /// The name itself, if the argument is nothing but a name.
    pub fn word(&self) -> Option<&'a str> {
        match self.expr.map(|expr| &expr.kind) {
            Some(ExprKind::Name(name)) => Some(name),
            _ => None,
        }
    }
}

/// The arguments of a call: few in most cases.
pub type Arguments<'a> = SmallVec<[Given<'a>; 4]>;

/// The argument of each input; none where the default stands.
type Slots<'g, 'a> = SmallVec<[Option<&'g Given<'a>>; 8]>;

/// Inputs up to which all ways to exchange two arguments are tried.
const MOST_EXCHANGED: usize = 8;

/// A call with everything bound.
pub struct Bound<'a> {
    /// The dimension variables.
    pub dims: Dims<'a>,
    /// One wire for each input, of its declared type.
    pub wires: SmallVec<[Wire; 8]>,
    /// Where each argument stands; the call's own place for defaults.
    pub places: SmallVec<[Place; 8]>,
}

impl<'a> Checker<'a> {
    /// Binds a call's arguments. None when something is wrong (and reported) or waits.
    pub fn bind_arguments(
        &mut self,
        f: &mut Frame<'a>,
        head: Head<'a>,
        dim: Option<&Dim>,
        given: &[Given<'a>],
        place: Place,
    ) -> Option<Bound<'a>> {
        let slots = self.place_arguments(f, head, given, place)?;
        if slots.iter().flatten().any(|given| matches!(given.wire, Wire::Unknown)) {
            return None;
        }
        let dims = self.bind_dims(f, head, dim, &slots, place)?;
        let mut bound = Bound { dims, wires: SmallVec::new(), places: SmallVec::new() };
        let mut complete = true;
        let said = self.diagnostics.len();
        for ((input, known), slot) in head.inputs.iter().zip(head.known).zip(&slots) {
            let at = slot.map_or(place, |given| given.place);
            let wire = self.argument(f, head, (input, known), *slot, &bound, place);
            complete &= !matches!(wire, Wire::Unknown);
            bound.wires.push(wire);
            bound.places.push(at);
        }
        if self.diagnostics.len() > said && slots.len() <= MOST_EXCHANGED {
            self.exchanged(f, head, &slots, said);
        }
        complete.then_some(bound)
    }

    /// Says so where the arguments fit once two of them are exchanged.
    fn exchanged(&mut self, f: &Frame<'a>, head: Head<'a>, slots: &[Option<&Given<'a>>], said: usize) {
        let fits = |slot: usize, from: usize| match (head.inputs.get(slot), slots.get(from)) {
            (Some(input), Some(Some(given))) => accepts(f, input, &Given { name: None, ..(*given).clone() }),
            _ => true,
        };
        let given: Vec<usize> = (0..slots.len()).filter(|i| slots[*i].is_some()).collect();
        // A name says where an argument goes, and words and lambdas show what they are for.
        let moves = |slot: &&usize| {
            slots[**slot].is_some_and(|given| {
                let known = matches!(given.wire, Wire::Value(_) | Wire::Resource(_) | Wire::Matrix(_));
                known && given.name.is_none() && !matches!(head.inputs[**slot].ty.kind, TypeKind::Node { .. })
            })
        };
        let movable: Vec<usize> = given.iter().filter(moves).copied().collect();
        let pairs = movable.iter().flat_map(|a| movable.iter().map(move |b| (*a, *b)));
        let mends = |(a, b): &(usize, usize)| {
            let from = |slot: usize| {
                if slot == *a {
                    *b
                } else if slot == *b {
                    *a
                } else {
                    slot
                }
            };
            a < b && given.iter().all(|slot| fits(*slot, from(*slot)))
        };
        let mut mending = pairs.filter(mends);
        let (Some((a, b)), None) = (mending.next(), mending.next()) else { return };
        if let (Some(first), Some(second)) = (slots[a], slots[b]) {
            // What is wrong with the second is the same slip.
            let names = [a, b].map(|slot| head.inputs[slot].name.text.as_str());
            let error = self.diagnostics.get_mut(said);
            error.into_iter().for_each(|error| error.exchange((first.place, second.place), names));
            self.diagnostics.truncate(said + 1);
        }
    }

    /// Sorts arguments into the inputs' slots.
    fn place_arguments<'g>(
        &mut self,
        f: &mut Frame<'a>,
        head: Head<'a>,
        given: &'g [Given<'a>],
        place: Place,
    ) -> Option<Slots<'g, 'a>> {
        let mut slots: Slots<'g, 'a> = smallvec![None; head.inputs.len()];
        let mut fine = true;
        let mut unknown: Option<usize> = None;
        for (i, argument) in given.iter().enumerate() {
            let position = match argument.name {
                None => Some(i).filter(|i| *i < slots.len()),
                Some(name) => head.inputs.iter().position(|input| input.name.text == name.text),
            };
            let error = match (position, argument.name) {
                (Some(i), name) if slots[i].is_some() => {
                    let at = name.map_or(argument.place, |name| self.place(f, name.span));
                    let first = slots[i].map_or(at, |first| first.place);
                    sentences::argument_twice(at, head.name, &head.inputs[i].name.text, first)
                }
                (Some(i), _) => {
                    slots[i] = Some(argument);
                    continue;
                }
                (None, Some(name)) => {
                    let near = self.near(&name.text, head.inputs.iter().map(|i| i.name.text.as_str()));
                    let at = self.place(f, name.span);
                    // Several that are not like any input: another node was meant, which is one slip.
                    if let (None, Some(first)) = (&near, unknown.and_then(|i| self.diagnostics.get_mut(i))) {
                        first.related.push((at, "no such input either".to_owned()));
                        continue;
                    }
                    unknown = Some(self.diagnostics.len());
                    sentences::unknown_argument(at, head.name, &name.text, near)
                }
                (None, None) if fine => {
                    let inputs: Vec<&str> =
                        head.inputs.iter().map(|input| input.name.text.as_str()).collect();
                    sentences::too_many_arguments(argument.place, head.name, &inputs)
                }
                // The first of several was reported.
                (None, None) => continue,
            };
            self.report(f, error);
            fine = false;
        }
        for (input, slot) in head.inputs.iter().zip(&slots) {
            if fine && slot.is_none() && input.default.is_none() {
                let ty = types::show(&input.ty);
                self.report(f, sentences::missing_argument(place, head.name, &input.name.text, &ty));
                fine = false;
            }
        }
        fine.then_some(slots)
    }

    /// A dimension variable is the widest among the arguments declared with it.
    fn bind_dims(
        &mut self,
        f: &mut Frame<'a>,
        head: Head<'a>,
        dim: Option<&Dim>,
        slots: &[Option<&Given<'a>>],
        place: Place,
    ) -> Option<Dims<'a>> {
        let mut dims = Dims::new();
        if dim.is_some() && head.dims.is_empty() {
            self.report(f, errors::no_dimension(place, head.name));
            return None;
        }
        for (i, variable) in head.dims.iter().enumerate() {
            let mut width = 1;
            if let Some(dim) = dim.filter(|_| i == 0) {
                match types::width_of(head.name, Some(dim), &f.dims, place) {
                    Ok(explicit) => width = explicit,
                    Err(error) => {
                        self.report(f, error);
                        return None;
                    }
                }
            }
            let mut from = place;
            for ((input, known), slot) in head.inputs.iter().zip(head.known).zip(slots) {
                let varies = match known.ty {
                    InputType::Same(_) => false,
                    InputType::Wide(_, dim) => dim == i,
                    InputType::Open => types::dimension_variable(&input.ty) == Some(&variable.text),
                };
                let Some(given) = slot.filter(|_| varies) else { continue };
                let found = match given.wire {
                    Wire::Value(value) => f.builder.ty(value).width(),
                    Wire::Resource(ref resource) => match dimension_of(&KINDS[resource.kind]).1 {
                        Some(dimension) => dimension,
                        None => continue,
                    },
                    _ => continue,
                };
                if found > 1 && width > 1 && found != width {
                    self.report(f, errors::widths_differ(given.place, width, found, from));
                    return None;
                }
                if found > width {
                    (width, from) = (found, given.place);
                }
            }
            dims.push((&variable.text, width));
        }
        Some(dims)
    }

    /// One input's wire, of its declared type.
    fn argument(
        &mut self,
        f: &mut Frame<'a>,
        head: Head<'a>,
        (input, known): (&'a Input, &Known),
        slot: Option<&Given<'a>>,
        bound: &Bound<'a>,
        place: Place,
    ) -> Wire {
        let (width, resolved);
        let declared = match &known.ty {
            InputType::Same(declared) => declared,
            InputType::Wide(scalar, dim) => {
                width = bound.dims.get(*dim).map_or(1, |(_, width)| *width);
                resolved = Declared::Vector(*scalar, width);
                &resolved
            }
            InputType::Open => {
                match types::resolve(&input.ty, &bound.dims, self.modules[head.module].file) {
                    Ok(declared) => resolved = declared,
                    Err(error) => return self.report(f, error),
                }
                &resolved
            }
        };
        match (slot, &input.default) {
            (Some(given), Some(default)) if is_none(default) && is_absent(declared, &given.wire) => {
                Wire::None
            }
            (Some(given), _) => self.coerce(f, &input.name.text, declared, given),
            (None, Some(default)) => {
                if let Some(constant) = known.default {
                    f.builder.set_place(place);
                    return Wire::Value(f.builder.constant(constant));
                }
                let input = (input.name.text.as_str(), declared);
                self.default(f, head, default, bound, input, place)
            }
            (None, None) => Wire::Unknown,
        }
    }

    /// A default is an expression of the callee's file that may read earlier inputs.
    fn default(
        &mut self,
        f: &mut Frame<'a>,
        head: Head<'a>,
        default: &'a Expr,
        bound: &Bound<'a>,
        (input, declared): (&str, &Declared),
        place: Place,
    ) -> Wire {
        if let ExprKind::Int(_) | ExprKind::Float(_) | ExprKind::Bool(_) = default.kind {
            let wire = self.expr(f, default);
            return self.coerce(f, input, declared, &Given { name: None, wire, place, expr: Some(default) });
        }
        if f.defaults.iter().any(|outer| std::ptr::eq(*outer, default)) {
            return self.report(f, names::recursion(place, head.name));
        }
        if f.defaults.len() == limits::MAX_DEFAULTS {
            return self.report(f, limits::defaults_too_deep(place, head.name));
        }
        let earlier = head.inputs.iter().zip(&bound.wires);
        let scope = earlier.map(|(input, wire)| (input.name.text.as_str(), wire.clone())).collect();
        let module = std::mem::replace(&mut f.module, head.module);
        let dims = std::mem::replace(&mut f.dims, bound.dims.clone());
        let scopes = std::mem::replace(&mut f.scopes, vec![scope]);
        let unknown = std::mem::take(&mut f.unknown);
        let base = std::mem::replace(&mut f.base, 0);
        // A name that the caller binds is not the default's.
        let outer = std::mem::take(&mut f.bound);
        f.foreign += 1;
        f.defaults.push(default);
        let wire = match self.expr(f, default) {
            wire if is_absent(declared, &wire) => wire,
            wire => self.coerce(f, input, declared, &Given { name: None, wire, place, expr: Some(default) }),
        };
        f.defaults.pop();
        f.foreign -= 1;
        (f.module, f.dims, f.scopes) = (module, dims, scopes);
        (f.unknown, f.base, f.bound) = (unknown, base, outer);
        wire
    }

    /// A wire as one of a declared type.
    pub fn coerce(&mut self, f: &mut Frame<'a>, input: &str, declared: &Declared, given: &Given<'a>) -> Wire {
        if let Declared::Node(ty) = declared {
            return match given.wire {
                Wire::Unknown => Wire::Unknown,
                _ => self.node_argument(f, input, ty, given),
            };
        }
        let word = given.word();
        let place = given.place;
        match (declared, &given.wire) {
            (_, Wire::Unknown) => Wire::Unknown,
            (_, Wire::Lambda) => self.report(f, nodes::lambda_as_value(place)),
            (Declared::Matrix(size), wire) => {
                self.coerce_matrix(f, wire, *size, place).map_or(Wire::Unknown, Wire::Matrix)
            }
            (Declared::Vector(scalar, width), wire) => self
                .coerce_named(f, wire, (*scalar, *width), place, Some(input))
                .map_or(Wire::Unknown, Wire::Value),
            (Declared::Choice(words), Wire::Text(_)) => {
                self.report(f, sentences::quoted_choice(place, input, words))
            }
            (Declared::Choice(words), wire) => {
                let written = match wire {
                    Wire::Word(word) => Some(word.text.as_str()),
                    _ => word,
                };
                match written.filter(|word| words.iter().any(|w| w == word)) {
                    Some(word) => Wire::word(word, place),
                    None => self.report(
                        f,
                        sentences::unknown_choice(place, input, words, written.unwrap_or_default()),
                    ),
                }
            }
            (Declared::Resource(kind), Wire::Resource(resource)) if resource.kind == *kind => {
                Wire::Resource(Rc::clone(resource))
            }
            (Declared::Resource(_) | Declared::Numbers, Wire::None) => Wire::None,
            (Declared::Text, Wire::Text(text)) => Wire::Text(text.clone()),
            (Declared::Texts | Declared::Cells, wire @ (Wire::Text(_) | Wire::List(_))) => wire.clone(),
            (Declared::Stops | Declared::Numbers | Declared::Resources, wire @ Wire::List(_)) => wire.clone(),
            (_, Wire::Word(word)) => self.unknown_value(f, &word.text, word.place),
            (_, Wire::Callables(nodes)) => self.report(f, names::node_as_value(place, &nodes.name)),
            (declared, wire) => {
                let found = types::describe(wire, |v| f.builder.ty(v));
                let wanted = match declared {
                    Declared::Resource(kind) => format!("`{}`", KINDS[*kind].name),
                    Declared::Text => "a string".to_owned(),
                    Declared::Texts => "a string or a list of strings".to_owned(),
                    Declared::Stops => "stops such as `[0.5, #8d8f94]`".to_owned(),
                    Declared::Numbers => "a list of numbers".to_owned(),
                    Declared::Resources => "a list of resources".to_owned(),
                    _ => "a string or a list of lists".to_owned(),
                };
                self.report(f, errors::resource_mismatch(place, input, &wanted, &found))
            }
        }
    }

    /// A wire as a single value of any type; None when it is not one (reported) or unknown.
    pub fn value(&mut self, f: &mut Frame<'a>, wire: &Wire, place: Place) -> Option<Value> {
        match wire {
            Wire::Value(value) => return Some(*value),
            Wire::Unknown => {}
            Wire::Word(word) => {
                self.unknown_value(f, &word.text, word.place);
            }
            Wire::Record(outputs) => {
                let names: Vec<String> = outputs.iter().map(|(name, _)| name.to_string()).collect();
                self.report(f, errors::record_as_value(place, &names));
            }
            Wire::Callables(nodes) => {
                self.report(f, names::node_as_value(place, &nodes.name));
            }
            Wire::Lambda => {
                self.report(f, nodes::lambda_as_value(place));
            }
            Wire::Resource(resource) => {
                let readers = self.readers(resource.kind);
                self.report(f, errors::resource_as_value(place, KINDS[resource.kind].name, &readers));
            }
            other => {
                let what = types::describe(other, |v| f.builder.ty(v));
                self.report(f, errors::not_a_value(place, &what));
            }
        }
        None
    }

    /// The library's nodes that read a kind of resource, and what every view has.
    fn readers(&self, kind: usize) -> Vec<String> {
        let library = self.library;
        let mut readers: Vec<String> = Vec::new();
        for name in library.callable_names() {
            let first =
                library.callables(name).iter().filter_map(|callable| self.head(*callable)?.inputs.first());
            if first.into_iter().any(|input| types::is_kind(&input.ty, kind)) {
                readers.push(name.to_owned());
            }
        }
        let sampled = KINDS[kind].fields.iter().any(|field| {
            Some(field.name) == KINDS[kind].view
                && field.kind.view().is_some_and(|view| view.texel == Texel::Sampled)
        });
        if sampled { vec!["sample".to_owned()] } else { readers }
    }

    /// A wire as a value of that scalar and width: ints widen, scalars spread.
    pub fn coerce_value(
        &mut self,
        f: &mut Frame<'a>,
        wire: &Wire,
        scalar: Scalar,
        width: u8,
        place: Place,
    ) -> Option<Value> {
        self.coerce_named(f, wire, (scalar, width), place, None)
    }

    /// The same for an input or output of that name.
    pub fn coerce_named(
        &mut self,
        f: &mut Frame<'a>,
        wire: &Wire,
        (scalar, width): (Scalar, u8),
        place: Place,
        name: Option<&str>,
    ) -> Option<Value> {
        let value = self.value(f, wire, place)?;
        let ty = f.builder.ty(value);
        if ty == Type::Vector(scalar, width) {
            return Some(value);
        }
        let fits = ty.scalar().is_some_and(|found| types::widens(found, scalar));
        if !fits || (ty.width() != 1 && ty.width() != width) {
            let wanted = types::name(Type::Vector(scalar, width));
            let found = types::name(ty);
            self.report(f, errors::mismatch(place, name, &wanted, &found));
            return None;
        }
        f.builder.set_place(place);
        let value = if scalar == Scalar::Float { f.builder.to_float(value) } else { value };
        Some(f.builder.splat(value, width))
    }
}

/// Whether a wire says that a number, a matrix or a node was not given.
pub(super) fn is_absent(declared: &Declared, wire: &Wire) -> bool {
    matches!(wire, Wire::None)
        && matches!(declared, Declared::Vector(..) | Declared::Matrix(_) | Declared::Node(_))
}

/// Whether an input with this default need not be given at all.
fn is_none(default: &Expr) -> bool {
    matches!(&default.kind, ExprKind::Name(name) if name == "none")
}
