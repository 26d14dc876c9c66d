//! What each operation makes of what its operands shift by.

use super::super::{Amount, Shift, Source, Why, show_number};
use super::{Known, Walk, numbers};
use crate::graph::{Constant, Function, ParamId, Scalar, Type, Value, ViewId};
use crate::intrinsic::{Arguments, Evaluate, Intrinsic, Tiling};
use crate::manifest::{IndicesSource, Recipe, Wrap};
use crate::resource::Resource;

impl<'a> Walk<'a> {
    pub(super) fn param(&mut self, id: ParamId, component: u8) -> Shift {
        let Some(param) = self.params.get(id.0 as usize) else { return Shift::Same { whole: false } };
        let i = usize::from(component);
        let number = |c: &Constant| match c.scalar() {
            Scalar::Float => f64::from(c.float(i)),
            Scalar::Int | Scalar::Bool => f64::from(c.int(i)),
        };
        let made = || {
            let range = param.range.as_ref().map(|(low, high)| (number(low), number(high)));
            let letter = ["x", "y", "z", "w"].get(i).filter(|_| param.ty.width() > 1);
            let name = letter.map_or(param.name.clone(), |letter| format!("{}.{letter}", param.name));
            let is_int = param.ty.scalar() != Some(Scalar::Float);
            (name, is_int, range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY)))
        };
        Shift::Uniform(self.atoms.of(Source::Param(id, component), made))
    }

    pub(super) fn builtin(
        &mut self,
        function: &Function,
        value: Value,
        intrinsic: Intrinsic,
        arguments: &[&[Shift]],
    ) -> Known {
        if let Some(known) = evaluated(intrinsic, arguments) {
            return known;
        }
        let ty = function.ty(value);
        let components = (0..usize::from(ty.width()))
            .map(|component| self.component(function, value, intrinsic, arguments, component, ty));
        Known::Numbers(components.collect())
    }

    /// One component of what an intrinsic gives.
    pub(super) fn component(
        &mut self,
        function: &Function,
        value: Value,
        intrinsic: Intrinsic,
        arguments: &[&[Shift]],
        component: usize,
        ty: Type,
    ) -> Shift {
        let row = intrinsic.row();
        let is_each = matches!(row.value, Evaluate::Each { .. });
        // What stands elsewhere in the vectors does not matter to one that works on each.
        let own: Vec<&[Shift]> = arguments
            .iter()
            .map(|all| if is_each { all.get(component..=component).unwrap_or(all) } else { all })
            .collect();
        if let Some(Known::Numbers(known)) = evaluated(intrinsic, &own).filter(|_| is_each) {
            return known[0].clone();
        }
        let scalar = ty.scalar().unwrap_or(Scalar::Float);
        let component = if is_each { 0 } else { component };
        let Walk { atoms, .. } = self;
        let mut of = Arguments { arguments: &own, component, row: intrinsic.index(), scalar, atoms };
        // One of two truths may decide, whatever the other is.
        let is_decided = matches!(row.name, "&&" | "||") && own.iter().any(|x| x[0].truth().is_some());
        if let Some(broken) = broken_among(&own).filter(|_| !is_decided) {
            return broken;
        }
        let result = match row.tiling {
            Tiling::By(rule) => rule(&mut of),
            Tiling::Plain => of.all_repeat().map(|()| of.repeated()),
        };
        let name = row.name.trim_start_matches('(').trim_end_matches(')');
        result.unwrap_or_else(|why| self.broken(function, value, name, why))
    }

    pub(super) fn select(
        &mut self,
        function: &Function,
        value: Value,
        by: &Shift,
        yes: &Known,
        no: &Known,
    ) -> Known {
        match by.truth() {
            Some(true) => return yes.clone(),
            Some(false) => return no.clone(),
            None => {}
        }
        if let Shift::Broken(_) = by {
            return Known::Numbers(vec![by.clone(); usize::from(function.ty(value).width())].into());
        }
        let pairs: Vec<(Shift, Shift)> =
            numbers(yes).iter().cloned().zip(numbers(no).iter().cloned()).collect();
        let chosen = pairs.iter().map(|(yes, no)| self.chosen(function, value, by, yes, no));
        Known::Numbers(chosen.collect())
    }

    pub(super) fn chosen(
        &mut self,
        function: &Function,
        value: Value,
        by: &Shift,
        yes: &Shift,
        no: &Shift,
    ) -> Shift {
        if yes == no {
            return yes.clone();
        }
        if let (Some(by), Some(yes), Some(no)) = (by.amount(), yes.amount(), no.amount()) {
            let is_int = yes.is_whole(&self.atoms) && no.is_whole(&self.atoms);
            let ((a, b), (c, d)) = (yes.bounds(&self.atoms), no.bounds(&self.atoms));
            let source = Source::Choice(Box::new([by, yes, no]));
            let made = || ("…".to_owned(), is_int, (a.min(c), b.max(d)));
            return Shift::Uniform(self.atoms.of(source, made));
        }
        let either = yes.or(no, &self.atoms);
        either.unwrap_or_else(|why| self.broken(function, value, "if", why))
    }

    pub(super) fn sizes(&mut self, view: &Known, width: u8) -> Known {
        let Known::View(view) = view else { return repeating(Type::Vector(Scalar::Int, width)) };
        let size = |axis: u8, walk: &mut Walk<'a>| match walk.known_size(*view, axis) {
            Some(size) => Shift::int(size as i32),
            None => {
                let name = walk.resource(*view).map_or(String::new(), |resource| resource.name.clone());
                let letter = ["x", "y", "z"].get(usize::from(axis)).copied().unwrap_or_default();
                let made = || (format!("{name}.size.{letter}"), true, (1.0, 16_384.0));
                Shift::Uniform(walk.atoms.of(Source::Size(*view, axis), made))
            }
        };
        Known::Numbers((0..width).map(|axis| size(axis, self)).collect())
    }

    pub(super) fn resource(&self, view: ViewId) -> Option<&'a Resource> {
        let view = self.views.get(view.0 as usize)?;
        self.resources.get(view.resource as usize)
    }

    /// A size that stands in the file.
    pub(super) fn known_size(&self, view: ViewId, axis: u8) -> Option<u32> {
        match &self.resource(view)?.recipe {
            Recipe::Bake { size, .. } => size.get(usize::from(axis)).copied(),
            Recipe::Indices { source, .. } | Recipe::Line { source, .. } => {
                listed(source).map(|[width, rows]| if axis == 0 { width } else { rows })
            }
            Recipe::Stack { source, depth, .. } => {
                listed(source).map(|[width, rows]| if axis == 0 { width } else { rows / depth })
            }
            _ => None,
        }
    }

    /// What is sampled: at a coordinate, all else as `still`.
    pub(super) fn sampled(
        &mut self,
        view: &Known,
        coordinate: &[Shift],
        still: &[Shift],
    ) -> Result<Shift, Why> {
        if let Some(broken) = broken_among(&[coordinate, still]) {
            return Ok(broken);
        }
        self.still(still)?;
        let resource = if let Known::View(view) = view { self.resource(*view) } else { None };
        let wrap = resource.and_then(|resource| resource.sampler).map_or(Wrap::Clamp, |sampler| sampler.wrap);
        let times = match wrap {
            Wrap::Repeat => 1.0,
            Wrap::Mirror => 2.0,
            Wrap::Clamp => 0.0,
        };
        for shift in coordinate.iter().filter(|shift| !shift.repeats()) {
            let by = shift.show(&self.atoms);
            if times == 0.0 {
                return Err(Why::Wrap { by });
            }
            if shift.step().multiple_of(&Amount::number(times), &self.atoms).is_none() {
                return Err(Why::NotMultiple { by, of: show_number(times) });
            }
        }
        Ok(Shift::Same { whole: false })
    }

    /// What is read at places that must not move.
    pub(super) fn still(&self, places: &[Shift]) -> Result<Shift, Why> {
        if let Some(broken) = broken_among(&[places]) {
            return Ok(broken);
        }
        match places.iter().find(|place| !place.repeats()) {
            Some(moving) => Err(Why::Moves { by: moving.show(&self.atoms) }),
            None => Ok(Shift::Same { whole: false }),
        }
    }

    pub(super) fn lookup(
        &mut self,
        function: &Function,
        value: Value,
        table: &[Constant],
        index: &Shift,
    ) -> Known {
        if let (Shift::Known(index), Some(last)) = (index, table.len().checked_sub(1)) {
            let entry = table[(index.int(0).max(0) as usize).min(last)];
            return Known::Numbers(
                (0..usize::from(entry.width())).map(|i| Shift::Known(entry.component(i))).collect(),
            );
        }
        let result = self.still(std::slice::from_ref(index));
        let whole = table.iter().all(|entry| {
            (0..usize::from(entry.width())).all(|i| Shift::Known(entry.component(i)).is_whole(&self.atoms))
        });
        let result = result.map(|shift| if shift.repeats() { Shift::Same { whole } } else { shift });
        self.spread(function, value, "[]", result)
    }
}

/// What repeats, of a type.
fn repeating(ty: Type) -> Known {
    let whole = ty.scalar() != Some(Scalar::Float);
    Known::Numbers(vec![Shift::Same { whole }; usize::from(ty.width())].into())
}

fn broken_among(arguments: &[&[Shift]]) -> Option<Shift> {
    let mut all = arguments.iter().flat_map(|components| components.iter());
    all.find(|shift| matches!(shift, Shift::Broken(_))).cloned()
}

/// What an intrinsic gives for arguments that are all known.
fn evaluated(intrinsic: Intrinsic, arguments: &[&[Shift]]) -> Option<Known> {
    let constants = arguments.iter().map(|components| {
        let bits = components.iter().map(|shift| match shift {
            Shift::Known(c) => Some((c.scalar(), c.bits()[0])),
            _ => None,
        });
        let bits: Vec<(Scalar, u32)> = bits.collect::<Option<_>>()?;
        let scalar = bits.first()?.0;
        Some(Constant::new(scalar, bits.into_iter().map(|(_, bits)| bits)))
    });
    let constants: Vec<Constant> = constants.collect::<Option<_>>()?;
    let result = intrinsic.evaluate(&constants);
    Some(Known::Numbers(
        (0..usize::from(result.width())).map(|i| Shift::Known(result.component(i))).collect(),
    ))
}

/// The size of a map whose numbers stand in the file.
fn listed(source: &IndicesSource) -> Option<[u32; 2]> {
    match source {
        IndicesSource::Rows(rows) => Some([rows.first().map_or(0, Vec::len) as u32, rows.len() as u32]),
        IndicesSource::Path(_) => None,
    }
}
