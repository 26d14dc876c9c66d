//! Constructor calls: arguments that are known become a resource.

use super::arguments::{self, Bound, Given};
use super::head::Head;
use super::wire::{ResourceWire, Wire};
use super::{Checker, Frame, ResourceFields};
use crate::diagnostic::{Diagnostic, Place, constructors, nodes as sentences};
use crate::graph::{Constant, FunctionId, ResourceView, Scalar, Texel, Type, View, ViewId};
use crate::manifest::{Recipe, Stop};
use crate::resource::{
    ANISOTROPY, Argument, Arguments, Field, FieldKind, KINDS, Made, Part, Resource, SHARED, made_by,
};
use std::rc::Rc;
use texgraph_grammar::syntax::{Input, TypeKind};

/// Stands for the resource of the shared tables while it is not made.
const SHARED_RESOURCE: u32 = u32::MAX;

impl<'a> Checker<'a> {
    /// Makes the resource of a constructor call, or finds the one made before.
    pub(super) fn construct(
        &mut self,
        f: &mut Frame<'a>,
        kind: usize,
        head: Head<'a>,
        bound: Bound,
        place: Place,
    ) -> Wire {
        if bound.wires.iter().any(has_unknown) {
            return Wire::Unknown;
        }
        let mut values = Vec::new();
        for ((input, wire), at) in head.inputs.iter().zip(&bound.wires).zip(&bound.places) {
            if let Wire::List(items) = wire
                && let Some(Wire::Word(word)) =
                    items.iter().map(|(item, _)| item).find(|item| matches!(item, Wire::Word(_)))
            {
                return self.unknown_value(f, &word.text, word.place);
            }
            match argument(f, &self.resources, input, wire, *at) {
                Ok(argument) => values.push((input.name.text.to_string(), *at, argument)),
                Err(diagnostic) => return self.report(f, diagnostic),
            }
        }
        let mut nodes = bound.wires.iter().zip(&bound.places).filter_map(|(wire, at)| match wire {
            Wire::Node(node) => Some((node, *at)),
            _ => None,
        });
        let bake = match nodes.next() {
            Some((node, at)) if !node.captures.is_empty() => {
                let names = self.captured_names(f, &node.captures);
                return self.report(f, sentences::bake_reads(at, &names));
            }
            node => node.map(|(node, _)| node.function),
        };
        let file = self.modules[f.module].path.clone();
        match (KINDS[kind].make)(&Arguments { place, file, values }) {
            Ok(made) => self.resource(f, made_by(kind), made, bake, place),
            Err(diagnostic) => self.report(f, diagnostic),
        }
    }

    fn resource(
        &mut self,
        f: &mut Frame<'a>,
        kind: usize,
        made: Made,
        bake: Option<FunctionId>,
        place: Place,
    ) -> Wire {
        let same = |r: &Resource| r.place == place && r.recipe == made.recipe && r.bake == bake;
        let known = self.resources.iter().position(same);
        let resource = known.unwrap_or_else(|| {
            let resource = self.resources.len();
            let mut views = Vec::new();
            let mut constants = made.constants.clone();
            let anisotropy = made.sampler.map_or(1, |sampler| sampler.anisotropy);
            // One is left out, so that the library's own specialisations can be taken over.
            if anisotropy > 1 {
                constants.push((ANISOTROPY, Constant::ints(&[i32::from(anisotropy)])));
            }
            for field in KINDS[kind].fields {
                match field.kind {
                    FieldKind::View(view) => {
                        let view = with_anisotropy(view, &constants);
                        views.push(ViewId(self.views.len() as u32));
                        self.views.push(ResourceView { resource: resource as u32, field: field.name, view });
                    }
                    FieldKind::Lent(_) => views.extend(self.lent(made.lender, field.name)),
                    FieldKind::Row => {
                        constants.push(("row", Constant::ints(&[self.rows.len() as i32])));
                        let rows = made.recipe.rows() as usize;
                        self.rows.extend(std::iter::repeat_n(resource as u32, rows));
                        views.push(self.shared_view());
                    }
                    FieldKind::Constant | FieldKind::Size(..) | FieldKind::Texel(..) | FieldKind::As(..) => {}
                }
            }
            self.resource_wires.push(ResourceFields { kind, views, constants });
            self.resources.push(Resource {
                name: self.fresh_name(f.current),
                label: String::new(),
                place,
                recipe: made.recipe,
                sampler: made.sampler,
                bake,
            });
            resource
        });
        self.resource_value(f, resource)
    }

    /// The view of another resource's field.
    fn lent(&self, lender: Option<u32>, name: &str) -> Option<ViewId> {
        let views = &self.resource_wires.get(lender? as usize)?.views;
        views.iter().copied().find(|id| self.views.get(id.0 as usize).is_some_and(|view| view.field == name))
    }

    /// The texture that small tables share. The resource behind it is made at the end, when all its
    /// rows are known.
    fn shared_view(&mut self) -> ViewId {
        let known = self.views.iter().position(|view| view.resource == SHARED_RESOURCE);
        let view = known.unwrap_or_else(|| {
            let field = "table";
            self.views.push(ResourceView { resource: SHARED_RESOURCE, field, view: SHARED });
            self.views.len() - 1
        });
        ViewId(view as u32)
    }

    /// Makes the resource of the shared tables, if there are any.
    pub(super) fn share_tables(&mut self) {
        if self.rows.is_empty() {
            return;
        }
        let resource = self.resources.len() as u32;
        let first = self.rows.first().and_then(|row| self.resources.get(*row as usize));
        let place = first.map(|first| first.place).unwrap_or_default();
        let name = self.fresh_name("tables");
        let label = "Small tables, a row each.".to_owned();
        let recipe = Recipe::Tables { rows: std::mem::take(&mut self.rows) };
        self.resources.push(Resource { name, label, place, recipe, sampler: None, bake: None });
        let shared = self.views.iter_mut().filter(|view| view.resource == SHARED_RESOURCE);
        shared.for_each(|view| view.resource = resource);
    }

    /// A name for a resource that stands inside an expression: that of its wire, made unique.
    fn fresh_name(&self, wish: &str) -> String {
        let taken = |name: &str| self.resources.iter().any(|r| r.name == name);
        if !taken(wish) {
            return wish.to_owned();
        }
        (2..).map(|n| format!("{wish}_{n}")).find(|name| !taken(name)).unwrap_or_default()
    }

    /// A field of a resource.
    pub(super) fn resource_field(
        &mut self,
        f: &mut Frame<'a>,
        resource: &Rc<ResourceWire>,
        name: &str,
    ) -> Option<Wire> {
        if let Some((_, constant)) = resource.constants.iter().find(|(field, _)| *field == name) {
            return Some(Wire::Value(f.builder.constant(*constant)));
        }
        if let Some((_, view)) = resource.views.iter().find(|(field, _)| *field == name) {
            return Some(Wire::View(*view));
        }
        if let Some(other) = seen_as(resource, name) {
            return Some(other);
        }
        if let Some(size) = size_field(f, resource, name) {
            return Some(size);
        }
        if let Some(texel) = texel_field(f, resource, name) {
            return Some(texel);
        }
        let stands_for = KINDS[resource.kind].view?;
        let (_, view) = resource.views.iter().find(|(field, _)| *field == stands_for)?;
        view_field(f, *view, name)
    }
}

/// Whether something in a list is wrong, which was said already.
fn has_unknown(wire: &Wire) -> bool {
    match wire {
        Wire::Unknown => true,
        Wire::List(items) => items.iter().any(|(item, _)| has_unknown(item)),
        _ => false,
    }
}

/// A field that is the resource itself as one of another kind.
fn seen_as(resource: &ResourceWire, name: &str) -> Option<Wire> {
    let field = KINDS[resource.kind].fields.iter().find(|field| field.name == name)?;
    let FieldKind::As(kind, count) = field.kind else { return None };
    let constant = |name: &str| resource.constants.iter().find(|(known, _)| *known == name);
    let count = constant(count).map(|(_, count)| *count).filter(|count| count.int(0) > 0)?;
    let kind = KINDS.iter().position(|known| known.name == kind)?;
    let fields = KINDS[kind].fields;
    let view = |field: &Field| resource.views.iter().find(|(known, _)| *known == field.name).copied();
    let other = fields.iter().filter(|field| field.kind == FieldKind::Constant && field.name != "count");
    let others = other.filter_map(|field| constant(field.name)).chain(constant(ANISOTROPY)).copied();
    Some(Wire::Resource(Rc::new(ResourceWire {
        kind,
        id: None,
        views: fields.iter().filter_map(view).collect(),
        constants: std::iter::once(("count", count)).chain(others).collect(),
    })))
}

/// A field that is the size of a map.
fn size_field(f: &mut Frame<'_>, resource: &ResourceWire, name: &str) -> Option<Wire> {
    let field = KINDS[resource.kind].fields.iter().find(|field| field.name == name)?;
    let FieldKind::Size(view, depth) = field.kind else { return None };
    let (_, view) = resource.views.iter().find(|(known, _)| *known == view)?;
    let size = f.builder.size(*view);
    let across = f.builder.extract(size, 0);
    let Some(depth) = depth else { return Some(Wire::Value(across)) };
    let (_, depth) = resource.constants.iter().find(|(known, _)| *known == depth)?;
    let parts = [across, f.builder.extract(size, 1), f.builder.constant(*depth)];
    Some(Wire::Value(f.builder.compose(&parts)))
}

/// A field that is a texel of another field.
fn texel_field(f: &mut Frame<'_>, resource: &ResourceWire, name: &str) -> Option<Wire> {
    let field = KINDS[resource.kind].fields.iter().find(|field| field.name == name)?;
    let FieldKind::Texel(view, at) = field.kind else { return None };
    let (_, view) = resource.views.iter().find(|(known, _)| *known == view)?;
    let (_, at) = resource.constants.iter().find(|(known, _)| *known == at)?;
    let index = f.builder.constant(Constant::ints(&[at.int(0), 0]));
    Some(Wire::Value(f.builder.texel(*view, index, None)))
}

/// A field of a view: its size in texels.
pub fn view_field(f: &mut Frame<'_>, view: crate::graph::Value, name: &str) -> Option<Wire> {
    (name == "size" && matches!(f.builder.ty(view), Type::View(_))).then(|| Wire::Value(f.builder.size(view)))
}

/// The arguments of a ramp with its stops, which are written one after the other, as one list.
pub fn joined_stops<'a>(head: Head<'a>, given: &[Given<'a>]) -> Option<arguments::Arguments<'a>> {
    head.inputs.first().filter(|input| is_named(input, STOPS))?;
    let is_stop = |given: &&Given<'a>| given.name.is_none() && matches!(given.wire, Wire::List(_));
    let stops: Vec<(Wire, Place)> =
        given.iter().take_while(is_stop).map(|given| (given.wire.clone(), given.place)).collect();
    let place =
        stops.iter().map(|(_, place)| *place).reduce(|a, b| Place { span: a.span.to(b.span), ..a })?;
    let rest = given.iter().skip(stops.len()).cloned();
    let joined = Given { name: None, wire: Wire::List(Rc::new(stops)), place, expr: None };
    Some(std::iter::once(joined).chain(rest).collect())
}

/// A wire as a constructor takes it.
fn argument(
    f: &Frame<'_>,
    made: &[Resource],
    input: &Input,
    wire: &Wire,
    place: Place,
) -> Result<Argument, Diagnostic> {
    let name = input.name.text.as_str();
    match wire {
        Wire::Text(text) => Ok(Argument::Text(text.to_string())),
        Wire::Word(word) => Ok(Argument::Word(word.text.clone())),
        Wire::Value(value) => match f.builder.as_constant(*value) {
            Some(constant) => Ok(Argument::Number(constant)),
            None => Err(constructors::not_known(place, name)),
        },
        Wire::Node(_) => Ok(Argument::Node),
        Wire::None => Ok(Argument::Absent),
        Wire::Resource(_) => part(made, name, wire, place).map(|part| Argument::Resources(vec![part])),
        Wire::List(items) if is_named(input, "numbers") => numbers(f, name, items),
        Wire::List(items) if is_named(input, "resources") => {
            let parts = items.iter().map(|(wire, at)| part(made, name, wire, *at));
            parts.collect::<Result<_, _>>().map(Argument::Resources)
        }
        Wire::List(items) if is_named(input, "row") && items.is_empty() => {
            Err(constructors::wrong_argument(place, name, ROW))
        }
        Wire::List(items) if is_named(input, "row") => {
            ints(f, name, items, ROW).map(|row| Argument::Rows(vec![row]))
        }
        Wire::List(items) if is_named(input, "texts") => texts(name, items, place),
        Wire::List(items) if is_named(input, STOPS) => {
            let stops = items.iter().map(|(wire, at)| stop(f, name, wire, *at));
            stops.collect::<Result<_, _>>().map(Argument::Stops)
        }
        Wire::List(items) => rows(f, name, items, place),
        _ => Err(constructors::wrong_argument(place, name, "a constant")),
    }
}

/// Whether an input's type is the plain name.
fn is_named(input: &Input, wanted: &str) -> bool {
    matches!(&input.ty.kind, TypeKind::Named { name, .. } if name.text == wanted)
}

/// The type of a ramp's stops.
const STOPS: &str = "stops";

/// A place and a colour.
fn stop(f: &Frame<'_>, input: &str, wire: &Wire, place: Place) -> Result<Stop, Diagnostic> {
    let Wire::List(parts) = wire else { return Err(constructors::not_a_stop(place)) };
    let mut numbers = Vec::new();
    for (part, at) in parts.iter() {
        let Wire::Value(value) = part else { return Err(constructors::not_a_stop(*at)) };
        let Some(constant) = f.builder.as_constant(*value) else {
            return Err(constructors::not_known(*at, input));
        };
        numbers.push(constant);
    }
    match numbers.as_slice() {
        [at, color] if at.width() == 1 && color.width() == 4 && color.scalar() == Scalar::Float => {
            let at = match at.scalar() {
                Scalar::Float => at.float(0),
                Scalar::Int => at.int(0) as f32,
                Scalar::Bool => return Err(constructors::not_a_stop(place)),
            };
            Ok(Stop { at, color: [0, 1, 2, 3].map(|i| color.float(i)) })
        }
        _ => Err(constructors::not_a_stop(place)),
    }
}

const TEXTS: &str = "a string, or a list of strings";
const NUMBERS: &str = "a list of numbers such as `[3, 1, 1]`";
const ROW: &str = "a string, or a list of ints such as `[0, 1, 1]`";
const ROWS: &str = "a string, or rows of ints such as `[[0, 1], [1, 0]]`";

/// A list of strings.
fn texts(input: &str, items: &[(Wire, Place)], place: Place) -> Result<Argument, Diagnostic> {
    if items.is_empty() {
        return Err(constructors::wrong_argument(place, input, TEXTS));
    }
    let text = |(wire, at): &(Wire, Place)| match wire {
        Wire::Text(text) => Ok(text.to_string()),
        _ => Err(constructors::wrong_argument(*at, input, TEXTS)),
    };
    items.iter().map(text).collect::<Result<_, _>>().map(Argument::Texts)
}

/// A resource that another is made of.
fn part(made: &[Resource], input: &str, wire: &Wire, place: Place) -> Result<Part, Diagnostic> {
    let Wire::Resource(resource) = wire else {
        return Err(constructors::wrong_argument(place, input, "a list of resources"));
    };
    let known = resource.id.and_then(|id| Some((id, made.get(id)?)));
    let (id, known) = known.ok_or_else(|| constructors::not_known(place, input))?;
    Ok(Part {
        index: id as u32,
        kind: KINDS[resource.kind].name,
        recipe: known.recipe.clone(),
        constants: resource.constants.clone(),
        sampler: known.sampler,
        place,
    })
}

/// A list of numbers.
fn numbers(f: &Frame<'_>, input: &str, items: &[(Wire, Place)]) -> Result<Argument, Diagnostic> {
    let number = |(wire, at): &(Wire, Place)| match wire {
        Wire::Value(value) => match f.builder.as_constant(*value) {
            Some(c) if c.width() == 1 && c.scalar() != Scalar::Bool => Ok((c, *at)),
            Some(_) => Err(constructors::wrong_argument(*at, input, NUMBERS)),
            None => Err(constructors::not_known(*at, input)),
        },
        _ => Err(constructors::wrong_argument(*at, input, NUMBERS)),
    };
    items.iter().map(number).collect::<Result<_, _>>().map(Argument::Numbers)
}

/// Rows of ints.
fn rows(f: &Frame<'_>, input: &str, items: &[(Wire, Place)], place: Place) -> Result<Argument, Diagnostic> {
    if items.is_empty() {
        return Err(constructors::wrong_argument(place, input, ROWS));
    }
    let row = |(wire, at): &(Wire, Place)| match wire {
        Wire::List(row) => ints(f, input, row, ROWS),
        _ => Err(constructors::wrong_argument(*at, input, ROWS)),
    };
    items.iter().map(row).collect::<Result<_, _>>().map(Argument::Rows)
}

fn ints(f: &Frame<'_>, input: &str, row: &[(Wire, Place)], wanted: &str) -> Result<Vec<i32>, Diagnostic> {
    row.iter()
        .map(|(wire, at)| match wire {
            Wire::Value(value) => match f.builder.as_constant(*value) {
                Some(c) if c.ty() == Type::Vector(Scalar::Int, 1) => Ok(c.int(0)),
                Some(_) => Err(constructors::wrong_argument(*at, input, wanted)),
                None => Err(constructors::not_known(*at, input)),
            },
            _ => Err(constructors::wrong_argument(*at, input, wanted)),
        })
        .collect()
}

/// A view of a resource with these constants.
pub fn with_anisotropy(view: View, constants: &[(&'static str, Constant)]) -> View {
    if view.texel == Texel::Integer {
        return view;
    }
    let found = constants.iter().find(|(name, _)| *name == ANISOTROPY);
    View { anisotropy: found.map_or(1, |(_, n)| n.int(0).clamp(1, 16) as u8), ..view }
}

/// Placeholders for the constants of a resource input, to check a node that nobody calls.
pub fn placeholder(kind: usize) -> Vec<(&'static str, Constant)> {
    let own = KINDS[kind].fields;
    let seen = own.iter().filter_map(|field| match field.kind {
        FieldKind::As(kind, _) => KINDS.iter().find(|known| known.name == kind),
        _ => None,
    });
    let fields = own.iter().chain(seen.flat_map(|kind| kind.fields));
    let mut constants: Vec<(&'static str, Constant)> = Vec::new();
    for field in fields.filter(|field| field.kind == FieldKind::Constant) {
        if constants.iter().all(|(name, _)| *name != field.name) {
            constants.push((field.name, Constant::ints(&[16])));
        }
    }
    constants
}
