//! The walk: functions with what their arguments shift by, an explicit stack of those that are under
//! way, and a memory of those that are done.

use super::{Amount, Atoms, Culprit, Shift, Source, What, Why, show_number};
use crate::graph::{
    Constant, Fold, Function, FunctionId, Level, Operation, Param, ParamId, Place, ResourceView, Scalar,
    Type, Value, ViewId,
};
use crate::input::is_per_draw;
use crate::intrinsic::{Arguments, Evaluate, Intrinsic, Tiling};
use crate::manifest::{IndicesSource, Recipe, Wrap};
use crate::resource::Resource;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::rc::Rc;

/// Loops of more steps are not walked step by step.
const MOST_STEPS: u32 = 128;
/// Rounds until nothing changes in a loop that is not walked step by step.
const MOST_ROUNDS: u32 = 16;
/// Values looked at, one axis; beyond nothing is proved.
const MOST_VALUES: u64 = 1_000_000;

/// What a value is.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Known {
    /// Its components.
    Numbers(Rc<[Shift]>),
    /// The texture that it shows.
    View(ViewId),
    /// The results of a call or fold.
    Results(Rc<[Known]>),
}

/// A function with what it is given.
type Request = (FunctionId, Rc<[Known]>);

/// A program being looked at, the place moving along one axis.
pub struct Walk<'a> {
    functions: &'a [Function],
    params: &'a [Param],
    views: &'a [ResourceView],
    resources: &'a [Resource],
    /// Files below this one are the library's.
    library: u32,
    atoms: Atoms,
    culprits: Vec<Culprit>,
    culprit_numbers: FxHashMap<Culprit, u32>,
    done: FxHashMap<Request, Rc<[Known]>>,
    /// Values that may still be looked at.
    budget: u64,
}

/// A function under way.
struct Frame {
    request: Request,
    values: Vec<Known>,
    /// The loop that it is in.
    run: Option<Run>,
}

/// A loop under way.
struct Run {
    step: u32,
    accumulators: Vec<Known>,
    /// What they are where the loop may have ended before.
    ended: Option<Vec<Known>>,
}

impl<'a> Walk<'a> {
    /// Over the functions of a program, callees first. Files below `library` are the library's.
    pub fn new(
        functions: &'a [Function],
        (params, views, resources): (&'a [Param], &'a [ResourceView], &'a [Resource]),
        library: u32,
    ) -> Walk<'a> {
        Walk {
            functions,
            params,
            views,
            resources,
            library,
            atoms: Atoms::default(),
            culprits: Vec::new(),
            culprit_numbers: FxHashMap::default(),
            done: FxHashMap::default(),
            budget: MOST_VALUES,
        }
    }

    /// What keeps the outputs of a texture from repeating where `uv` moves along an axis by a period,
    /// with the outputs that it breaks; each once, in the order of the outputs.
    pub fn culprits(mut self, entry: FunctionId, axis: usize, period: f32) -> Vec<(Culprit, Vec<SmolStr>)> {
        let functions = self.functions;
        let Some(function) = functions.get(entry.0 as usize) else { return Vec::new() };
        let inputs = function.inputs.iter().enumerate().map(|(i, slot)| {
            let components = (0..slot.ty.width()).map(|component| match slot.name.as_str() {
                "uv" if usize::from(component) == axis => {
                    Shift::Moves { by: Amount::number(period.into()), whole: false }
                }
                name if is_per_draw(name) => {
                    let is_int = slot.ty.scalar() != Some(Scalar::Float);
                    let made = || (name.to_owned(), is_int, (f64::NEG_INFINITY, f64::INFINITY));
                    Shift::Uniform(self.atoms.of(Source::Input(i as u32, component), made))
                }
                _ => Shift::Same { whole: slot.ty.scalar() != Some(Scalar::Float) },
            });
            Known::Numbers(components.collect())
        });
        let request = (entry, inputs.collect());
        let results = self.run(request);
        let mut found: Vec<(Culprit, Vec<SmolStr>)> = Vec::new();
        for ((slot, value), result) in function.outputs.iter().zip(results.iter()) {
            let place = function.places[value.0 as usize];
            if let Some(culprit) = self.broken_by(&slot.name, place, result) {
                match found.iter_mut().find(|(known, _)| *known == culprit) {
                    Some((_, outputs)) => outputs.push(slot.name.clone()),
                    None => found.push((culprit, vec![slot.name.clone()])),
                }
            }
        }
        found
    }

    /// What breaks an output, if anything does.
    fn broken_by(&self, name: &SmolStr, place: Place, result: &Known) -> Option<Culprit> {
        let components = numbers(result);
        let broken = components.iter().find_map(|shift| match shift {
            Shift::Broken(culprit) => self.culprits.get(*culprit as usize).cloned(),
            _ => None,
        });
        broken.or_else(|| {
            let moving = components.iter().find(|shift| !shift.repeats())?;
            let why = Why::Moves { by: moving.show(&self.atoms) };
            Some(Culprit { place, name: name.clone(), why, kind: What::Output })
        })
    }

    /// Walks a function and all that it needs.
    fn run(&mut self, request: Request) -> Rc<[Known]> {
        let mut stack = vec![Frame { request: request.clone(), values: Vec::new(), run: None }];
        while let Some(frame) = stack.last_mut() {
            match self.walk(frame) {
                Some(inner) => stack.push(Frame { request: inner, values: Vec::new(), run: None }),
                None => {
                    let Some(frame) = stack.pop() else { break };
                    let function = &self.functions[frame.request.0.0 as usize];
                    let results =
                        function.outputs.iter().map(|(_, value)| frame.values[value.0 as usize].clone());
                    self.done.insert(frame.request, results.collect());
                }
            }
        }
        self.done.get(&request).cloned().unwrap_or_default()
    }

    /// Goes on with a function until it is done (none) or needs another.
    fn walk(&mut self, frame: &mut Frame) -> Option<Request> {
        let functions = self.functions;
        let function = &functions[frame.request.0.0 as usize];
        while frame.values.len() < function.values.len() {
            let value = Value(frame.values.len() as u32);
            self.budget = self.budget.saturating_sub(1);
            let known = match self.value(function, frame, value) {
                Ok(known) => known,
                Err(request) => return Some(request),
            };
            frame.values.push(known);
        }
        None
    }

    fn value(&mut self, function: &Function, frame: &mut Frame, value: Value) -> Result<Known, Request> {
        let known = |v: &Value| frame.values[v.0 as usize].clone();
        let components = |v: &Value| numbers(&frame.values[v.0 as usize]);
        let one = |v: &Value, i: u8| {
            components(v).get(usize::from(i)).cloned().unwrap_or(Shift::Same { whole: false })
        };
        let single = |shift: Shift| Known::Numbers([shift].into());
        Ok(match function.operation(value) {
            Operation::Constant(c) => {
                Known::Numbers((0..usize::from(c.width())).map(|i| Shift::Known(c.component(i))).collect())
            }
            Operation::Input(i) => frame.request.1[*i as usize].clone(),
            Operation::Param(id) => {
                let width = function.ty(value).width();
                Known::Numbers((0..width).map(|i| self.param(*id, i)).collect())
            }
            Operation::View(view) => Known::View(*view),
            Operation::Compose(parts) => Known::Numbers(parts.iter().map(|part| one(part, 0)).collect()),
            Operation::Extract(v, i) => single(one(v, *i)),
            Operation::Output(of, i) => match known(of) {
                Known::Results(results) => results[*i as usize].clone(),
                other => other,
            },
            Operation::Builtin(intrinsic, arguments) => {
                let arguments: Vec<&[Shift]> = arguments.iter().map(components).collect();
                self.builtin(function, value, *intrinsic, &arguments)
            }
            Operation::Select(condition, yes, no) => {
                let (yes, no) = (known(yes), known(no));
                self.select(function, value, &one(condition, 0), &yes, &no)
            }
            Operation::Size(view) => self.sizes(&known(view), function.ty(value).width()),
            Operation::Derivative(v, ..) => {
                let derivative = |shift: &Shift| match shift {
                    Shift::Broken(_) => shift.clone(),
                    Shift::Known(_) | Shift::Uniform(_) => Shift::float(0.0),
                    _ => Shift::Same { whole: false },
                };
                Known::Numbers(components(v).iter().map(derivative).collect())
            }
            Operation::Sample { view, coordinate, layer, level } => {
                let mut still: Vec<Value> = layer.iter().copied().collect();
                match level {
                    Level::Auto => {}
                    Level::Gradient(x, y) => still.extend([*x, *y]),
                    Level::Level(l) => still.push(*l),
                }
                let still: Vec<Shift> = still.iter().flat_map(|v| components(v)).cloned().collect();
                let result = self.sampled(&known(view), components(coordinate), &still);
                self.spread(function, value, "sample", result)
            }
            Operation::Texel { index, layer, .. } => {
                let all: Vec<&Value> = [index].into_iter().chain(layer).collect();
                let all: Vec<Shift> = all.into_iter().flat_map(components).cloned().collect();
                let result = self.still(&all);
                self.spread(function, value, "texel", result)
            }
            Operation::Lookup(table, index) => self.lookup(function, value, table, &one(index, 0)),
            Operation::Call(callee, arguments) => {
                let arguments: Rc<[Known]> = arguments.iter().map(known).collect();
                let results = self.call(*callee, arguments)?;
                self.returned(function, value, *callee, &results)
            }
            Operation::Fold(fold) => self.fold(function, frame, value, fold)?,
        })
    }

    // ── What breaks ──

    /// The number of a culprit.
    fn culprit(&mut self, culprit: Culprit) -> u32 {
        if let Some(number) = self.culprit_numbers.get(&culprit) {
            return *number;
        }
        let number = self.culprits.len() as u32;
        self.culprits.push(culprit.clone());
        self.culprit_numbers.insert(culprit, number);
        number
    }

    fn broken(&mut self, function: &Function, value: Value, name: &str, why: Why) -> Shift {
        let place = function.places[value.0 as usize];
        Shift::Broken(self.culprit(Culprit { place, name: name.into(), why, kind: What::Operation }))
    }

    /// The components of what is read, which are all alike.
    fn spread(&mut self, function: &Function, value: Value, name: &str, result: Result<Shift, Why>) -> Known {
        let ty = function.ty(value);
        let shift = match result {
            Ok(broken @ Shift::Broken(_)) => broken,
            Ok(Shift::Same { whole: true }) => Shift::Same { whole: true },
            Ok(_) => Shift::Same { whole: ty.scalar() != Some(Scalar::Float) },
            Err(why) => self.broken(function, value, name, why),
        };
        Known::Numbers(vec![shift; usize::from(ty.width())].into())
    }

    /// Results with a culprit of the library named by the author's call that leads to it.
    fn returned(
        &mut self,
        function: &Function,
        value: Value,
        callee: FunctionId,
        results: &[Known],
    ) -> Known {
        let place = function.places[value.0 as usize];
        if place.file < self.library {
            return Known::Results(results.into());
        }
        let name = self.functions[callee.0 as usize].name.clone();
        let lifted = |shift: &Shift, walk: &mut Walk<'a>| {
            let Shift::Broken(number) = shift else { return shift.clone() };
            match walk.culprits.get(*number as usize) {
                Some(Culprit { place: inner, why, .. }) if inner.file < walk.library => {
                    let why = why.clone();
                    Shift::Broken(walk.culprit(Culprit { place, name: name.clone(), why, kind: What::Node }))
                }
                _ => shift.clone(),
            }
        };
        let results = results.iter().map(|result| match result {
            Known::Numbers(components) => {
                Known::Numbers(components.iter().map(|shift| lifted(shift, self)).collect())
            }
            other => other.clone(),
        });
        Known::Results(results.collect())
    }

    // ── Operations ──

    fn param(&mut self, id: ParamId, component: u8) -> Shift {
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

    fn builtin(
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
    fn component(
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

    fn select(&mut self, function: &Function, value: Value, by: &Shift, yes: &Known, no: &Known) -> Known {
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

    fn chosen(&mut self, function: &Function, value: Value, by: &Shift, yes: &Shift, no: &Shift) -> Shift {
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

    fn sizes(&mut self, view: &Known, width: u8) -> Known {
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

    fn resource(&self, view: ViewId) -> Option<&'a Resource> {
        let view = self.views.get(view.0 as usize)?;
        self.resources.get(view.resource as usize)
    }

    /// A size that stands in the file.
    fn known_size(&self, view: ViewId, axis: u8) -> Option<u32> {
        match &self.resource(view)?.recipe {
            Recipe::Bake { size, .. } => size.get(usize::from(axis)).copied(),
            Recipe::Indices { source: IndicesSource::Rows(rows), .. } => {
                let size = if axis == 0 { rows.first().map_or(0, Vec::len) } else { rows.len() };
                Some(size as u32)
            }
            _ => None,
        }
    }

    /// What is sampled: at a coordinate, all else as `still`.
    fn sampled(&mut self, view: &Known, coordinate: &[Shift], still: &[Shift]) -> Result<Shift, Why> {
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
    fn still(&self, places: &[Shift]) -> Result<Shift, Why> {
        if let Some(broken) = broken_among(&[places]) {
            return Ok(broken);
        }
        match places.iter().find(|place| !place.repeats()) {
            Some(moving) => Err(Why::Moves { by: moving.show(&self.atoms) }),
            None => Ok(Shift::Same { whole: false }),
        }
    }

    fn lookup(&mut self, function: &Function, value: Value, table: &[Constant], index: &Shift) -> Known {
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

    /// What a function gives; it has to be walked first where nobody has.
    fn call(&mut self, callee: FunctionId, arguments: Rc<[Known]>) -> Result<Rc<[Known]>, Request> {
        let request = (callee, arguments);
        if let Some(results) = self.done.get(&request) {
            return Ok(Rc::clone(results));
        }
        if self.budget > 0 {
            self.budget -= 1;
            return Err(request);
        }
        // Found out no more.
        let function = &self.functions[callee.0 as usize];
        let results = function.outputs.iter().map(|(_, value)| self.unknown(function, *value));
        Ok(results.collect::<Vec<_>>().into())
    }

    fn unknown(&mut self, function: &Function, value: Value) -> Known {
        let broken = self.broken(function, value, &function.name, Why::TooLong);
        Known::Numbers(vec![broken; usize::from(function.ty(value).width())].into())
    }
}

// ── Loops ──

impl<'a> Walk<'a> {
    fn fold(
        &mut self,
        function: &Function,
        frame: &mut Frame,
        value: Value,
        fold: &Fold,
    ) -> Result<Known, Request> {
        let steps = numbers(&frame.values[fold.steps.0 as usize])[0].clone();
        if !steps.repeats() {
            let broken = match self.why_steps_move(&steps) {
                Some(by) => self.broken(function, value, "fold", Why::Moves { by }),
                None => steps,
            };
            return Ok(self.all_broken(function, fold, &broken));
        }
        let known = |v: &Value| frame.values[v.0 as usize].clone();
        let captures: Vec<Known> = fold.captures.iter().map(known).collect();
        let starts = || Run { step: 0, accumulators: fold.starts.iter().map(known).collect(), ended: None };
        let mut run = frame.run.take().unwrap_or_else(starts);
        let result = self.steps(function, value, fold, &captures, &steps, &mut run);
        if result.is_err() {
            frame.run = Some(run);
        }
        result
    }

    /// By how much the ends of a loop move: the count of its steps is held to what it may be, so the
    /// culprit may be what the author did not write. None if it is something else.
    fn why_steps_move(&self, steps: &Shift) -> Option<String> {
        let Shift::Broken(culprit) = steps else { return Some(steps.show(&self.atoms)) };
        match self.culprits.get(*culprit as usize) {
            Some(Culprit { name, why: Why::Apart { by, .. }, .. })
                if matches!(name.as_str(), "max" | "min") =>
            {
                Some(by.clone())
            }
            _ => None,
        }
    }

    /// All steps of a loop from where it stands.
    fn steps(
        &mut self,
        function: &Function,
        value: Value,
        fold: &Fold,
        captures: &[Known],
        steps: &Shift,
        run: &mut Run,
    ) -> Result<Known, Request> {
        let known = match steps {
            Shift::Known(steps) => Some(steps.int(0).max(0) as u32),
            _ => None,
        };
        let most = known.map_or(fold.most, |steps| steps.min(fold.most));
        let is_long = most > MOST_STEPS;
        let rounds = if is_long { MOST_ROUNDS } else { most };
        while run.step < rounds {
            let goes_on = match fold.condition {
                Some(condition) => self.goes_on(condition, captures, run)?,
                None => Shift::Known(Constant::bools(&[true])),
            };
            match goes_on.truth() {
                Some(false) if is_long => return Ok(Known::Results(run.accumulators.as_slice().into())),
                Some(false) => break,
                Some(true) if known.is_some() => {}
                _ if !goes_on.repeats() => return Ok(self.all_broken(function, fold, &goes_on)),
                _ => {
                    let now = run.accumulators.clone();
                    run.ended = Some(match run.ended.take() {
                        Some(before) => self.joined(function, value, &before, &now),
                        None => now,
                    });
                }
            }
            let number = if is_long { Shift::Same { whole: true } } else { Shift::int(run.step as i32) };
            let number = Known::Numbers([number].into());
            let inputs = run.accumulators.iter().chain([&number]).chain(captures).cloned().collect();
            let next = self.call(fold.body, inputs)?;
            run.step += 1;
            if !is_long {
                run.accumulators = next.to_vec();
                continue;
            }
            let both = self.joined(function, value, &run.accumulators, &next);
            if both == run.accumulators {
                return Ok(Known::Results(both.into()));
            }
            run.accumulators = both;
        }
        if is_long {
            let broken = self.broken(function, value, "fold", Why::TooLong);
            return Ok(self.all_broken(function, fold, &broken));
        }
        let last = std::mem::take(&mut run.accumulators);
        Ok(Known::Results(match run.ended.take() {
            Some(before) => self.joined(function, value, &before, &last).into(),
            None => last.into(),
        }))
    }

    /// Whether a loop takes another step.
    fn goes_on(&mut self, condition: FunctionId, captures: &[Known], run: &Run) -> Result<Shift, Request> {
        let inputs = run.accumulators.iter().chain(captures).cloned().collect();
        let results = self.call(condition, inputs)?;
        Ok(numbers(&results[0])[0].clone())
    }

    /// Accumulators that are the ones or the others.
    fn joined(&mut self, function: &Function, value: Value, a: &[Known], b: &[Known]) -> Vec<Known> {
        let pairs = a.iter().zip(b);
        let joined = pairs.map(|(a, b)| {
            let components = numbers(a).iter().zip(numbers(b)).map(|(a, b)| {
                let either = a.or(b, &self.atoms);
                either.unwrap_or_else(|why| self.broken(function, value, "fold", why))
            });
            Known::Numbers(components.collect())
        });
        joined.collect()
    }

    fn all_broken(&self, function: &Function, fold: &Fold, broken: &Shift) -> Known {
        let starts = fold.starts.iter().map(|start| {
            Known::Numbers(vec![broken.clone(); usize::from(function.ty(*start).width())].into())
        });
        Known::Results(starts.collect())
    }
}

/// The components of a value; a view has none.
fn numbers(known: &Known) -> &[Shift] {
    match known {
        Known::Numbers(components) => components,
        Known::View(_) | Known::Results(_) => &[],
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
