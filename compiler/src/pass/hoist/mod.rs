//! Work moves to where it is done less often.
//!
//! - Out of folds: what a body or a condition makes of captures, params and constants alone is made
//!   once outside and captured.
//! - To the top: what a called function makes of params, constants and inputs that are the same for
//!   a whole draw at *every* call is made by the caller and passed. The caller is in turn called
//!   from somewhere, so such work ends in the entry, where equal values are one.
//!
//! Both are one mechanism. A function is split into what goes before it and the rest, which takes
//! the results of the former as further inputs; whoever calls or folds the rest takes over what
//! goes before. Rates are found callers first, then functions are split callees first, so that what
//! comes out of one may go on out of the next.
//!
//! What stands in a branch stays there, since it is not needed always; but arithmetic that is the
//! same for a whole draw costs nothing at the top. Constants, inputs, params, views and components
//! are no work. Signatures keep what is no longer read: `remove_dead` cleans up.

mod rate;
mod split;

pub use rate::fixed;

use super::liveness::{Liveness, Role};
use crate::graph::regions::Weights;
use crate::graph::{Builder, Constant, Fold, Function, FunctionId, Graph, Operation, Slot, Value};
use rustc_hash::FxHashMap;
use split::Split;
use std::sync::Arc;

/// Values that moving may add to a graph: functions that call another twice would double what
/// comes out of it again and again.
const MOST_MOVED: usize = 100_000;
/// Inputs of a called function at most, those for what is moved among them; a shader's functions
/// may have 255 parameters, params and textures included.
const MOST_INPUTS: usize = 64;

/// Moves work out of folds, and what is the same for a whole draw to the top.
pub fn run(graph: Graph) -> Graph {
    with_changed(graph).0
}

/// The same, and which functions take what was moved out of them as further inputs: no longer what
/// their callers knew.
pub fn with_changed(mut graph: Graph) -> (Graph, Vec<bool>) {
    let inputs: Vec<usize> = graph.functions.iter().map(|function| function.inputs.len()).collect();
    let live = Liveness::of(&graph);
    let mut hoisting = Hoisting {
        weights: Weights::of(&graph),
        per_draw: rate::per_draw(&graph, &live),
        live: &live,
        functions: Vec::with_capacity(graph.functions.len()),
        before: Vec::with_capacity(graph.functions.len()),
        hands_through: Vec::with_capacity(graph.functions.len()),
        allowance: MOST_MOVED,
    };
    for place in 0..graph.functions.len() {
        let role = Use::of(&graph, &live, place);
        let function = std::mem::take(&mut graph.functions[place]);
        hoisting.function(place, function, &role);
    }
    let functions = hoisting.functions;
    let changed = functions.iter().zip(inputs).map(|(function, before)| function.inputs.len() != before);
    let changed = changed.collect();
    (Graph { functions, ..graph }, changed)
}

/// How a function is used.
enum Use {
    /// Not by others: the entry, or a function that is dead.
    Alone,
    Called,
    /// By a fold: how many inputs change from step to step, and what goes with it if it is a body
    /// or a condition.
    Folded {
        carried: usize,
        partner: Option<usize>,
    },
}

impl Use {
    fn of(graph: &Graph, live: &Liveness, place: usize) -> Use {
        let Some(site) = live.live_sites(place).next() else { return Use::Alone };
        match (graph.functions[site.caller].operation(site.value), site.role) {
            (Operation::Fold(fold), Role::Body) => {
                let partner = fold.condition.map(|condition| condition.0 as usize);
                Use::Folded { carried: fold.starts.len() + 1, partner }
            }
            (Operation::Fold(fold), Role::Condition) => {
                Use::Folded { carried: fold.starts.len(), partner: Some(fold.body.0 as usize) }
            }
            _ => Use::Called,
        }
    }
}

struct Hoisting<'a> {
    weights: Weights,
    live: &'a Liveness,
    /// For each function which inputs are the same for a whole draw.
    per_draw: Vec<Vec<bool>>,
    /// What is left of the functions that are done, each in its old place.
    functions: Vec<Function>,
    /// What goes before each, if anything does: it takes the same inputs (those that the function
    /// had at first) and gives what the rest takes in addition.
    before: Vec<Option<Function>>,
    /// Which of them have an output that is one of their inputs or a constant.
    hands_through: Vec<bool>,
    allowance: usize,
}

impl Hoisting<'_> {
    fn function(&mut self, place: usize, function: Function, role: &Use) {
        let outside = self.outside(place, &function, role);
        let is_concerned = self.is_concerned(&function, role, &outside);
        let function = if is_concerned { Rewriting::new(self, place, &function).run() } else { function };
        let partner = match role {
            Use::Folded { partner, .. } => partner.filter(|partner| *partner < place),
            _ => None,
        };
        let padding = partner.map(|partner| self.moved(partner)).unwrap_or_default();
        let split = is_concerned.then(|| self.split(place, &function, role, &outside, &padding)).flatten();
        let (mut rest, before) = match split {
            Some((before, rest)) => (rest, Some(before)),
            None => (function, None),
        };
        if before.is_none() && !padding.is_empty() {
            rest.inputs.extend(padding);
            rest.origin = None;
        }
        let simple =
            |value: &Value| matches!(rest.operation(*value), Operation::Input(_) | Operation::Constant(_));
        self.hands_through.push(rest.outputs.iter().any(|(_, value)| simple(value)));
        self.functions.push(rest);
        self.before.push(before);
        if let Some(partner) = partner {
            // Body and condition have the same captures.
            let moved = self.moved(place);
            if !moved.is_empty() {
                self.functions[partner].origin = None;
            }
            self.functions[partner].inputs.extend(moved);
        }
    }

    /// Which inputs come from where work can go.
    fn outside(&self, place: usize, function: &Function, role: &Use) -> Vec<bool> {
        match role {
            Use::Alone => Vec::new(),
            Use::Called => self.per_draw[place].clone(),
            Use::Folded { carried, .. } => (0..function.inputs.len()).map(|i| i >= *carried).collect(),
        }
    }

    /// Whether a function is worth looking into: it has work that could go, or uses functions that
    /// had.
    fn is_concerned(&self, function: &Function, role: &Use, outside: &[bool]) -> bool {
        let is_changed = |id: &FunctionId| self.before[id.0 as usize].is_some();
        let uses = function.values.iter().any(|operation| match operation {
            Operation::Call(callee, _) => is_changed(callee) || self.hands_through[callee.0 as usize],
            Operation::Fold(fold) => fold.functions().any(|id| is_changed(&id)),
            _ => false,
        });
        uses || !matches!(role, Use::Alone) && split::has_work(function, outside)
    }

    /// What goes before a function gives these.
    fn moved(&self, place: usize) -> Vec<Slot> {
        let before = self.before[place].iter().flat_map(|before| &before.outputs);
        before.map(|(slot, _)| slot.clone()).collect()
    }

    /// What goes before a function and what is left of it, if anything can go.
    fn split(
        &mut self,
        place: usize,
        function: &Function,
        role: &Use,
        outside: &[bool],
        padding: &[Slot],
    ) -> Option<(Function, Function)> {
        let most = match role {
            Use::Alone => return None,
            Use::Called => MOST_INPUTS.saturating_sub(function.inputs.len()),
            Use::Folded { .. } => usize::MAX,
        };
        let split = Split::of(function, outside, &self.per_draw[place], &self.weights, most)?;
        let before = split.before();
        let cost = before.values.len() * self.live.live_sites(place).count();
        if cost > self.allowance {
            return None;
        }
        self.allowance -= cost;
        let rest = split.rest(padding);
        Some((before, rest))
    }
}

/// A function being made anew: its calls and folds pass what was moved out of what they use. What
/// nobody reads becomes 0, so that no work is moved for it.
struct Rewriting<'a> {
    hoisting: &'a Hoisting<'a>,
    place: usize,
    function: &'a Function,
    builder: Builder,
    values: Vec<Value>,
    /// What each call passes.
    arguments: FxHashMap<Value, Vec<Value>>,
}

impl<'a> Rewriting<'a> {
    fn new(hoisting: &'a Hoisting<'a>, place: usize, function: &'a Function) -> Rewriting<'a> {
        Rewriting {
            hoisting,
            place,
            function,
            builder: Builder::with_capacity(function.name.clone(), function.values.len()),
            values: Vec::with_capacity(function.values.len()),
            arguments: FxHashMap::default(),
        }
    }

    fn run(mut self) -> Function {
        let (function, live) = (self.function, self.hoisting.live);
        let inputs: Vec<Value> =
            function.inputs.iter().map(|slot| self.builder.input(slot.name.clone(), slot.ty)).collect();
        for (old, operation) in function.iter() {
            let value = match operation {
                Operation::Input(i) => inputs.get(*i as usize).copied().unwrap_or(Value(0)),
                // A view that nobody samples is passed on nevertheless: there is no 0 of its type.
                _ if live.is_live(self.place, old) || function.ty(old).scalar().is_none() => {
                    self.copy(old, operation)
                }
                _ => Value(0),
            };
            self.values.push(value);
        }
        for (i, (slot, value)) in function.outputs.iter().enumerate() {
            let value = self.read(*value, live.outputs[self.place][i]);
            self.builder.output(slot.name.clone(), value);
        }
        self.builder.finish()
    }

    /// A new value if it is read, else 0.
    fn read(&mut self, old: Value, live: bool) -> Value {
        let ty = self.function.ty(old);
        match ty.scalar() {
            Some(scalar) if !live => self.builder.constant(Constant::zero(scalar, ty.width())),
            _ => self.values[old.0 as usize],
        }
    }

    fn read_all(&mut self, old: &[Value], live: &[bool]) -> Vec<Value> {
        old.iter().zip(live).map(|(value, live)| self.read(*value, *live)).collect()
    }

    fn copy(&mut self, old: Value, operation: &Operation) -> Value {
        let place = self.function.places[old.0 as usize];
        let new = match operation {
            Operation::Call(callee, arguments) => self.call(old, *callee, arguments),
            Operation::Fold(fold) => Operation::Fold(Box::new(self.fold(fold))),
            _ => operation.map_operands(|v| self.values[v.0 as usize]),
        };
        self.builder.set_place(place);
        let forwarded = match operation {
            Operation::Output(of, i) => self.forwarded(*of, *i as usize),
            _ => None,
        };
        let value = match forwarded {
            Some(value) => value,
            None => self.builder.push(new, self.function.ty(old)),
        };
        if let Some(name) = self.function.names.get(old) {
            self.builder.name(value, Arc::clone(name));
        }
        value
    }

    /// What an output of a call is if the callee only hands it through.
    fn forwarded(&mut self, call: Value, output: usize) -> Option<Value> {
        let arguments = self.arguments.get(&call)?;
        let Operation::Call(callee, _) = self.function.operation(call) else { return None };
        let callee = &self.hoisting.functions[callee.0 as usize];
        match callee.operation(callee.outputs.get(output)?.1) {
            Operation::Input(i) => arguments.get(*i as usize).copied(),
            Operation::Constant(constant) => Some(self.builder.constant(*constant)),
            _ => None,
        }
    }

    fn call(&mut self, old: Value, callee: FunctionId, arguments: &[Value]) -> Operation {
        let mut all = self.read_all(arguments, &self.hoisting.live.inputs[callee.0 as usize]);
        let moved = self.before(callee, &all);
        all.extend(moved);
        self.arguments.insert(old, all.clone());
        Operation::Call(callee, all.as_slice().into())
    }

    fn fold(&mut self, fold: &Fold) -> Fold {
        let live = &self.hoisting.live.inputs[fold.body.0 as usize];
        let starts = self.read_all(&fold.starts, live);
        let steps = self.values[fold.steps.0 as usize];
        let mut captures = self.read_all(&fold.captures, live.get(starts.len() + 1..).unwrap_or(&[]));
        // Accumulators and steps only stand in for inputs that what is moved does not read.
        let body = [starts.as_slice(), &[steps], &captures].concat();
        let condition = [starts.as_slice(), &captures].concat();
        let mut parts = vec![(fold.body, body)];
        parts.extend(fold.condition.map(|id| (id, condition)));
        parts.sort_by_key(|(id, _)| *id);
        for (id, inputs) in parts {
            let moved = self.before(id, &inputs);
            captures.extend(moved);
        }
        Fold { starts, steps, captures, ..*fold }
    }

    /// Takes over what goes before a function.
    fn before(&mut self, id: FunctionId, inputs: &[Value]) -> Vec<Value> {
        let Some(before) = &self.hoisting.before[id.0 as usize] else { return Vec::new() };
        let mut values: Vec<Value> = Vec::with_capacity(before.values.len());
        for (old, operation) in before.iter() {
            self.builder.set_place(before.places[old.0 as usize]);
            let value = match operation {
                Operation::Input(i) => inputs.get(*i as usize).copied().unwrap_or(Value(0)),
                _ => {
                    let copy = operation.map_operands(|v| values[v.0 as usize]);
                    self.builder.push(copy, before.ty(old))
                }
            };
            if let Some(name) = before.names.get(old) {
                self.builder.name(value, Arc::clone(name));
            }
            values.push(value);
        }
        before.outputs.iter().map(|(_, value)| values[value.0 as usize]).collect()
    }
}
