//! A loop that keeps the sample of its winner keeps the winner's coordinate, and one sample is taken
//! after the loop (GPU Gems, 20.2.1).
//!
//! ```text
//! color = if p > best { picture.sample(at) } else { color }
//! ```
//!
//! Such an accumulator, which nothing else reads, becomes three: the coordinate, the layer or level
//! if the sample has one, and whether anything has won.

use crate::graph::{Builder, Constant, Fold, Function, Graph, Level, Operation, Scalar, Type, Value, ViewId};
use rustc_hash::FxHashMap;
use smol_str::format_smolstr;
use std::sync::Arc;

/// An accumulator that is the sample of the step that won last.
#[derive(Clone, Debug, PartialEq)]
struct Winner {
    accumulator: usize,
    picture: Picture,
    condition: Value,
    /// It wins where the condition does not hold.
    is_negated: bool,
    coordinate: Value,
    layer: Option<Value>,
    level: Option<Value>,
}

/// What is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Picture {
    /// A capture of the loop.
    Capture(usize),
    /// A texture of the program, of this type.
    View(ViewId, Type),
}

impl Winner {
    /// What is kept of the winner.
    fn kept(&self) -> impl Iterator<Item = (&'static str, Value)> {
        let all = [("at", Some(self.coordinate)), ("layer", self.layer), ("level", self.level)];
        all.into_iter().filter_map(|(name, value)| Some((name, value?)))
    }
}

/// Moves samples of winners out of all loops.
pub fn run(mut graph: Graph) -> Graph {
    let mut winners = winners(&graph);
    if winners.iter().all(Vec::is_empty) {
        return graph;
    }
    let bodies = bodies(&graph, &mut winners);
    let moved = (0..graph.functions.len()).map(|place| {
        let function = &graph.functions[place];
        let body = bodies[place].unwrap_or(place);
        let folds = function.functions().any(|id| !winners[id.0 as usize].is_empty());
        (folds || !winners[body].is_empty()).then(|| Moving::new(&graph, &winners, place, body).run())
    });
    let moved: Vec<Option<Function>> = moved.collect();
    for (function, moved) in graph.functions.iter_mut().zip(moved) {
        if let Some(moved) = moved {
            *function = moved;
        }
    }
    graph
}

/// For each condition of a loop the body that it goes with. Its inputs are that body's, so where a
/// function is used otherwise too, the winners stay.
fn bodies(graph: &Graph, winners: &mut [Vec<Winner>]) -> Vec<Option<usize>> {
    let mut bodies: Vec<Option<usize>> = vec![None; graph.functions.len()];
    for fold in folds(graph) {
        let Some(condition) = fold.condition else { continue };
        let body = fold.body.0 as usize;
        let first = *bodies[condition.0 as usize].get_or_insert(body);
        if first != body {
            winners[first].clear();
            winners[body].clear();
        }
    }
    let called = graph.functions.iter().flat_map(|function| &function.values);
    let called = called.filter_map(|operation| match operation {
        Operation::Call(callee, _) => Some(*callee),
        Operation::Fold(fold) => Some(fold.body),
        _ => None,
    });
    for id in called {
        let place = id.0 as usize;
        if let Some(body) = bodies[place] {
            winners[body].clear();
            winners[place].clear();
        }
    }
    bodies
}

fn folds(graph: &Graph) -> impl Iterator<Item = &Fold> {
    let operations = graph.functions.iter().flat_map(|function| &function.values);
    operations.filter_map(|operation| match operation {
        Operation::Fold(fold) => Some(&**fold),
        _ => None,
    })
}

/// The winners of each body, in order.
fn winners(graph: &Graph) -> Vec<Vec<Winner>> {
    let mut winners: Vec<Option<Vec<Winner>>> = vec![None; graph.functions.len()];
    for fold in folds(graph) {
        let found = of_fold(graph, fold);
        let known = &mut winners[fold.body.0 as usize];
        match known {
            // One body, several loops: what one of them can't do without stays.
            Some(known) => known.retain(|winner| found.contains(winner)),
            None => *known = Some(found),
        }
    }
    winners.into_iter().map(Option::unwrap_or_default).collect()
}

fn of_fold(graph: &Graph, fold: &Fold) -> Vec<Winner> {
    let body = graph.function(fold.body);
    let uses = uses(body);
    let read = fold.condition.map(|condition| read_inputs(graph.function(condition)));
    let is_read = |i: usize| read.as_ref().is_some_and(|read| read.contains(&(i as u32)));
    let winner = |i: usize| winner(body, fold.starts.len(), i, &uses).filter(|_| !is_read(i));
    (0..fold.starts.len()).filter_map(winner).collect()
}

/// How often each value is read; outputs count.
fn uses(function: &Function) -> Vec<u32> {
    let mut uses = vec![0; function.values.len()];
    function.outputs.iter().for_each(|(_, value)| uses[value.0 as usize] += 1);
    for operation in &function.values {
        operation.for_operands(|v| uses[v.0 as usize] += 1);
    }
    uses
}

/// The inputs that something is made of; a function may have others.
fn read_inputs(function: &Function) -> Vec<u32> {
    let uses = uses(function);
    let inputs = function.iter().filter_map(|(value, operation)| match operation {
        Operation::Input(i) if uses[value.0 as usize] > 0 => Some(*i),
        _ => None,
    });
    inputs.collect()
}

/// An accumulator of a body as a winner.
fn winner(body: &Function, accumulators: usize, accumulator: usize, uses: &[u32]) -> Option<Winner> {
    let next = body.outputs.get(accumulator)?.1;
    let Operation::Select(condition, yes, no) = *body.operation(next) else { return None };
    let stays = |v: Value| *body.operation(v) == Operation::Input(accumulator as u32);
    let (sample, kept, is_negated) = match (stays(yes), stays(no)) {
        (false, true) => (yes, no, false),
        (true, false) => (no, yes, true),
        _ => return None,
    };
    let once = |v: Value| uses[v.0 as usize] == 1;
    let Operation::Sample { view, coordinate, layer, level } = *body.operation(sample) else { return None };
    let level = match level {
        Level::Auto => None,
        Level::Level(level) => Some(level),
        Level::Gradient(..) => return None,
    };
    let picture = match *body.operation(view) {
        Operation::Input(i) => Picture::Capture((i as usize).checked_sub(accumulators + 1)?),
        Operation::View(id) => Picture::View(id, body.ty(view)),
        _ => return None,
    };
    let fits = once(next) && once(sample) && once(kept);
    fits.then_some(Winner { accumulator, picture, condition, is_negated, coordinate, layer, level })
}

/// A function being made anew.
struct Moving<'a> {
    graph: &'a Graph,
    winners: &'a [Vec<Winner>],
    function: &'a Function,
    /// The body that it is, or that it is the condition of.
    body: usize,
    is_body: bool,
    builder: Builder,
    values: Vec<Value>,
    /// What it is told of the winner of each accumulator that is one: what is kept, and whether there
    /// is one.
    told: FxHashMap<usize, (Vec<Value>, Value)>,
    /// The accumulators of loops whose winners were moved.
    results: FxHashMap<Value, Vec<Value>>,
}

impl<'a> Moving<'a> {
    fn new(graph: &'a Graph, winners: &'a [Vec<Winner>], place: usize, body: usize) -> Moving<'a> {
        let function = &graph.functions[place];
        let mut builder = Builder::with_capacity(function.name.clone(), function.values.len());
        builder.set_inline(function.inline);
        Moving {
            graph,
            winners,
            function,
            body,
            is_body: place == body,
            builder,
            values: Vec::with_capacity(function.values.len()),
            told: FxHashMap::default(),
            results: FxHashMap::default(),
        }
    }

    /// A winner among the accumulators of the function's own loop.
    fn own(&self, accumulator: usize) -> Option<&'a Winner> {
        self.winners[self.body].iter().find(|winner| winner.accumulator == accumulator)
    }

    fn run(mut self) -> Function {
        let function = self.function;
        let inputs = self.inputs();
        for (old, operation) in function.iter() {
            self.builder.set_place(function.places[old.0 as usize]);
            let value = match operation {
                Operation::Input(i) => inputs.get(*i as usize).copied().unwrap_or(Value(0)),
                Operation::Fold(fold) if !self.winners[fold.body.0 as usize].is_empty() => {
                    let results = self.fold(fold);
                    self.results.insert(old, results);
                    Value(0)
                }
                Operation::Output(of, i) if self.results.contains_key(of) => self.result(*of, *i as usize),
                _ if self.is_moved(old) => Value(0),
                _ => {
                    let copy = operation.map_operands(|v| self.values[v.0 as usize]);
                    self.builder.push(copy, function.ty(old))
                }
            };
            self.values.push(value);
            if let Some(name) = function.names.get(old).filter(|_| !self.is_moved(old)) {
                self.builder.name(value, Arc::clone(name));
            }
        }
        self.outputs();
        self.builder.finish()
    }

    /// The inputs, in the place of winners what is kept of them.
    fn inputs(&mut self) -> Vec<Value> {
        let function = self.function;
        let body = &self.graph.functions[self.body];
        let mut inputs = Vec::with_capacity(function.inputs.len());
        for (i, slot) in function.inputs.iter().enumerate() {
            let Some(winner) = self.own(i) else {
                inputs.push(self.builder.input(slot.name.clone(), slot.ty));
                continue;
            };
            let kept = winner.kept().map(|(name, value)| {
                self.builder.input(format_smolstr!("{}_{name}", slot.name), body.ty(value))
            });
            let kept = kept.collect();
            let found = self.builder.input(format_smolstr!("{}_found", slot.name), Type::BOOL);
            self.told.insert(i, (kept, found));
            inputs.push(found);
        }
        inputs
    }

    /// Whether a value is the next of a winner, or the sample that it would be.
    fn is_moved(&self, value: Value) -> bool {
        let next = |winner: &Winner| self.function.outputs[winner.accumulator].1;
        let moved = |winner: &Winner| {
            let Operation::Select(_, yes, no) = self.function.operation(next(winner)) else { return false };
            value == next(winner) || value == if winner.is_negated { *no } else { *yes }
        };
        self.is_body && self.winners[self.body].iter().any(moved)
    }

    fn outputs(&mut self) {
        let function = self.function;
        for (i, (slot, value)) in function.outputs.iter().enumerate() {
            let Some(winner) = self.own(i).filter(|_| self.is_body) else {
                self.builder.output(slot.name.clone(), self.values[value.0 as usize]);
                continue;
            };
            let Some((before, found)) = self.told.get(&i).cloned() else { continue };
            let wins = self.values[winner.condition.0 as usize];
            let kept = winner.kept().map(|(name, value)| (name, self.values[value.0 as usize]));
            let yes = self.builder.constant(Constant::bools(&[true]));
            let next = kept.chain([("found", yes)]).zip(before.into_iter().chain([found]));
            for ((name, wins_with), stays) in next {
                let [yes, no] = if winner.is_negated { [stays, wins_with] } else { [wins_with, stays] };
                let next = self.builder.select(wins, yes, no);
                self.builder.output(format_smolstr!("{}_{name}", slot.name), next);
            }
        }
    }

    /// A loop that keeps what its winners are made of; its accumulators as they were.
    fn fold(&mut self, fold: &Fold) -> Vec<Value> {
        let body = self.graph.function(fold.body);
        let winners = &self.winners[fold.body.0 as usize];
        let mut starts = Vec::new();
        for (i, start) in fold.starts.iter().enumerate() {
            let Some(winner) = winners.iter().find(|winner| winner.accumulator == i) else {
                starts.push(self.values[start.0 as usize]);
                continue;
            };
            for (_, value) in winner.kept() {
                let ty = body.ty(value);
                let zero = Constant::zero(ty.scalar().unwrap_or(Scalar::Float), ty.width());
                starts.push(self.builder.constant(zero));
            }
            starts.push(self.builder.constant(Constant::bools(&[false])));
        }
        let captures: Vec<Value> = fold.captures.iter().map(|v| self.values[v.0 as usize]).collect();
        let steps = self.values[fold.steps.0 as usize];
        let results = self.builder.fold(Fold { starts, steps, captures: captures.clone(), ..fold.clone() });
        let mut results = results.into_iter();
        let mut all = Vec::with_capacity(fold.starts.len());
        for (i, start) in fold.starts.iter().enumerate() {
            let value = match winners.iter().find(|winner| winner.accumulator == i) {
                Some(winner) => {
                    let start = self.values[start.0 as usize];
                    self.sampled(winner, &captures, start, &mut results)
                }
                None => results.next(),
            };
            all.push(value.unwrap_or(Value(0)));
        }
        all
    }

    /// The sample of the winner, or the start where there is none.
    fn sampled(
        &mut self,
        winner: &Winner,
        captures: &[Value],
        start: Value,
        results: &mut impl Iterator<Item = Value>,
    ) -> Option<Value> {
        let coordinate = results.next()?;
        let layer = if winner.layer.is_some() { results.next() } else { None };
        let level = if winner.level.is_some() { results.next() } else { None };
        let found = results.next()?;
        let level = level.map_or(Level::Auto, Level::Level);
        let picture = match winner.picture {
            Picture::Capture(i) => *captures.get(i)?,
            Picture::View(id, ty) => self.builder.push(Operation::View(id), ty),
        };
        let sample = self.builder.sample(picture, coordinate, layer, level);
        Some(self.builder.select(found, sample, start))
    }

    fn result(&self, fold: Value, i: usize) -> Value {
        self.results.get(&fold).and_then(|results| results.get(i)).copied().unwrap_or(Value(0))
    }
}
