//! The walk: functions with what their arguments shift by, an explicit stack of those that are under
//! way, and a memory of those that are done.

mod folds;
mod operations;

use super::{Amount, Atoms, Culprit, Shift, Source, What, Why};
use crate::graph::{
    Function, FunctionId, Level, Operation, Param, Place, ResourceView, Scalar, Value, ViewId,
};
use crate::input::is_per_draw;
use crate::resource::Resource;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::rc::Rc;

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
    /// How many steps the loops around it take inside each other.
    steps: u64,
}

/// A loop under way.
struct Run {
    /// The most steps.
    most: u32,
    /// It takes that many, but for its condition.
    is_certain: bool,
    /// It is not walked step by step.
    is_long: bool,
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
        let frame = |request, steps| Frame { request, values: Vec::new(), run: None, steps };
        let mut stack = vec![frame(request.clone(), 1)];
        while let Some(top) = stack.last_mut() {
            match self.walk(top) {
                Some(inner) => {
                    let steps = top.run.as_ref().map_or(1, |run| run.most.into());
                    let steps = top.steps.saturating_mul(steps);
                    stack.push(frame(inner, steps));
                }
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
                let still: Vec<Shift> = still.iter().flat_map(&components).cloned().collect();
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
                let name = &self.functions[callee.0 as usize].name;
                let results = self.call(name, *callee, arguments)?;
                self.returned(function, value, *callee, &results)
            }
            Operation::Fold(fold) => self.fold(function, frame, value, fold)?,
        })
    }

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

    /// What a function gives; it has to be walked first where nobody has.
    fn call(
        &mut self,
        name: &str,
        callee: FunctionId,
        arguments: Rc<[Known]>,
    ) -> Result<Rc<[Known]>, Request> {
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
        let results = function.outputs.iter().map(|(_, value)| self.unknown(function, name, *value));
        Ok(results.collect::<Vec<_>>().into())
    }

    fn unknown(&mut self, function: &Function, name: &str, value: Value) -> Known {
        let broken = self.broken(function, value, name, Why::TooLong);
        Known::Numbers(vec![broken; usize::from(function.ty(value).width())].into())
    }
}

/// The components of a value; a view has none.
fn numbers(known: &Known) -> &[Shift] {
    match known {
        Known::Numbers(components) => components,
        Known::View(_) | Known::Results(_) => &[],
    }
}
