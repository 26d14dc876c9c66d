//! Backward, callers first: which values need a tangent, and which variants that takes.

use super::{Analysis, Inputs, Layout, Variant, depend, marked};
use crate::graph::{Fold, Function, FunctionId, Graph, Level, Operation, Origin, Slot, Value};
use crate::input::is_per_draw;
use crate::pass::finished::Done;
use rustc_hash::FxHashMap;
use smallvec::{SmallVec, smallvec};

/// Variants of a called function at most; one more does all that the others asked for would.
/// Without a bound, calls in calls could ask for every set of inputs.
const MOST_VARIANTS: usize = 16;

/// What one variant needs.
pub struct Demand {
    /// Which values need a tangent.
    pub values: Vec<bool>,
    /// The variant of what each call calls and of the body of each fold.
    pub inner: FxHashMap<Value, Variant>,
}

/// What it takes to have a variant.
pub enum Work<'a> {
    /// Taking it over.
    Finished(&'a Done),
    /// Making it, which needs this.
    Make(Demand),
}

impl Work<'_> {
    /// The functions that a function calls, and what is asked of them.
    pub fn calls(&self, function: &Function) -> Vec<(u32, Variant)> {
        let Work::Make(demand) = self else { return Vec::new() };
        let calls = function.iter().filter_map(|(value, operation)| match operation {
            Operation::Call(callee, _) => Some((callee.0, demand.inner.get(&value)?.clone())),
            _ => None,
        });
        calls.collect()
    }
}

/// What is wanted of every function.
pub struct Requests<'a> {
    variants: Vec<Vec<Variant>>,
    works: Vec<Vec<Work<'a>>>,
}

impl<'a> Requests<'a> {
    /// Walks from the entry to what needs nothing else.
    pub fn of(analysis: &Analysis<'a>) -> Requests<'a> {
        let functions = &analysis.graph.functions;
        let mut requests = Requests {
            variants: functions.iter().map(|_| Vec::new()).collect(),
            works: functions.iter().map(|_| Vec::new()).collect(),
        };
        let Some(entry) = functions.last() else { return requests };
        requests.variants[functions.len() - 1].push(of_entry(entry, analysis.changes));
        for i in (0..functions.len()).rev() {
            let variants = std::mem::take(&mut requests.variants[i]);
            for variant in &variants {
                let work = match analysis.done(i, variant) {
                    Some(done) => {
                        requests.add_done(analysis.graph, i, done);
                        Work::Finished(done)
                    }
                    None => {
                        let demand = Demanding::new(analysis, i, variant).run();
                        requests.add_inner(&functions[i], &demand);
                        Work::Make(demand)
                    }
                };
                requests.works[i].push(work);
            }
            requests.variants[i] = variants;
        }
        requests
    }

    /// The variants of a function, each with what it takes to have it.
    pub fn of_function(&self, i: usize) -> impl Iterator<Item = (&Variant, &Work<'a>)> {
        self.variants[i].iter().zip(&self.works[i])
    }

    /// Which variant of a function serves a request.
    pub fn find(&self, id: FunctionId, request: &Variant) -> Option<(usize, &Variant)> {
        let variants = &self.variants[id.0 as usize];
        let exact = variants.iter().position(|variant| variant == request);
        let place = exact.or(variants.len().checked_sub(1))?;
        variants.get(place).map(|variant| (place, variant))
    }

    fn add_inner(&mut self, function: &Function, demand: &Demand) {
        for (value, operation) in function.iter() {
            let Some(variant) = demand.inner.get(&value) else { continue };
            match operation {
                Operation::Call(callee, _) => self.add(*callee, variant, MOST_VARIANTS),
                Operation::Fold(fold) => {
                    self.add(fold.body, variant, usize::MAX);
                    if let Some(condition) = fold.condition {
                        self.add(condition, &of_condition(variant), usize::MAX);
                    }
                }
                _ => {}
            }
        }
    }

    /// A finished function asks the same of what it calls as when it was made.
    fn add_done(&mut self, graph: &Graph, i: usize, done: &Done) {
        for callee in graph.functions[i].functions() {
            let origin = graph.function(callee).origin;
            let asked = done.inner.iter().filter(|(id, _)| origin == Some(Origin::Checked(*id)));
            asked.for_each(|(_, variant)| self.add(callee, variant, MOST_VARIANTS));
        }
    }

    fn add(&mut self, id: FunctionId, variant: &Variant, most: usize) {
        let variants = &mut self.variants[id.0 as usize];
        if variants.contains(variant) {
            return;
        }
        let full = variants.len() >= most;
        match variants.last_mut() {
            Some(last) if full => last.join(variant),
            _ => variants.push(variant.clone()),
        }
    }
}

/// Of the entry those inputs change that are not the same for a whole draw.
fn of_entry(entry: &Function, changes: bool) -> Variant {
    let is_changing = |slot: &Slot| changes && slot.ty.is_float() && !is_per_draw(&slot.name);
    let changing = entry.inputs.iter().enumerate().filter(|(_, slot)| is_changing(slot));
    let changing = changing.fold(0, |all, (i, _)| all | Layout::CALLED.bit(i));
    Variant { changing, wanted: smallvec![false; entry.outputs.len()], is_sampled: false }
}

/// The variant of a condition that goes with one of its fold's body.
pub fn of_condition(body: &Variant) -> Variant {
    Variant { changing: body.changing, wanted: smallvec![false], is_sampled: body.is_sampled }
}

/// One variant being looked at.
struct Demanding<'a> {
    analysis: &'a Analysis<'a>,
    place: usize,
    function: &'a Function,
    variant: &'a Variant,
    values: Vec<bool>,
    /// For calls and folds the outputs whose tangents are needed.
    outputs: FxHashMap<Value, Vec<u32>>,
}

impl<'a> Demanding<'a> {
    fn new(analysis: &'a Analysis<'a>, place: usize, variant: &'a Variant) -> Demanding<'a> {
        let function = &analysis.graph.functions[place];
        let values = vec![false; function.values.len()];
        Demanding { analysis, place, function, variant, values, outputs: FxHashMap::default() }
    }

    fn run(mut self) -> Demand {
        for ((_, value), wanted) in self.function.outputs.iter().zip(&self.variant.wanted) {
            if *wanted {
                self.need(*value);
            }
        }
        let mut inner = FxHashMap::default();
        for (value, operation) in self.function.iter().rev() {
            match operation {
                Operation::Sample { coordinate, level, .. }
                    if *level == Level::Auto || marked(&self.values, value) =>
                {
                    self.need(*coordinate);
                }
                Operation::Derivative(v, ..) => self.need(*v),
                Operation::Call(callee, arguments) => {
                    inner.insert(value, self.call(value, *callee, arguments));
                }
                Operation::Fold(fold) => {
                    inner.insert(value, self.fold(value, fold));
                }
                _ if marked(&self.values, value) => self.operands(operation),
                _ => {}
            }
        }
        Demand { values: self.values, inner }
    }

    /// Whether something that changes with these inputs changes in this variant.
    fn changes(&self, depends: Inputs) -> bool {
        depends & self.variant.changing != 0
    }

    /// Whether a value changes.
    fn is_active(&self, value: Value) -> bool {
        self.changes(self.known().depends[value.0 as usize])
    }

    fn known(&self) -> &'a depend::Known {
        self.analysis.known[self.place].get(self.variant.is_sampled)
    }

    /// A function that a value comes from, and whether its outputs change with what it samples.
    fn used(&self, id: FunctionId, by: Value) -> (&'a depend::Known, bool) {
        let is_sampled = self.analysis.is_sampled(id, self.place, self.variant, by);
        (self.analysis.known[id.0 as usize].get(is_sampled), is_sampled)
    }

    fn need(&mut self, value: Value) {
        self.values[value.0 as usize] |= self.is_active(value);
    }

    /// What the tangent of a value is made of.
    fn operands(&mut self, operation: &Operation) {
        match operation {
            Operation::Select(_, yes, no) => [*yes, *no].into_iter().for_each(|v| self.need(v)),
            Operation::Output(of, i) => self.outputs.entry(*of).or_default().push(*i),
            Operation::Builtin(..) | Operation::Compose(_) | Operation::Extract(..) => {
                operation.for_operands(|v| self.need(v));
            }
            _ => {}
        }
    }

    fn call(&mut self, call: Value, callee: FunctionId, arguments: &[Value]) -> Variant {
        let (callee, is_sampled) = self.used(callee, call);
        let mut wanted = smallvec![false; callee.outputs.len()];
        let mut useful = callee.needed;
        for output in self.outputs.remove(&call).unwrap_or_default() {
            useful |= callee.outputs.get(output as usize).copied().unwrap_or(0);
            wanted.get_mut(output as usize).into_iter().for_each(|wanted| *wanted = true);
        }
        let bit = |i: usize| Layout::CALLED.bit(i);
        let useful =
            arguments.iter().enumerate().filter(|(i, v)| useful & bit(*i) != 0 && self.is_active(**v));
        let changing = useful.fold(0, |all, (i, _)| all | bit(i));
        let variant = Variant { changing, wanted, is_sampled };
        for (i, argument) in arguments.iter().enumerate() {
            if variant.takes(Layout::CALLED, i, self.function.ty(*argument)) {
                self.need(*argument);
            }
        }
        variant
    }

    fn fold(&mut self, value: Value, fold: &Fold) -> Variant {
        let (body, is_sampled) = self.used(fold.body, value);
        let layout = self.analysis.layout(fold.body);
        let first = fold.starts.len() + 1;
        let condition = fold.condition.map_or(0, |condition| self.used(condition, value).0.needed);
        let outputs = self.outputs.remove(&value).unwrap_or_default();
        let wanted = outputs.iter().fold(0, |all, output| all | layout.bit(*output as usize));
        let useful = depend::through_steps(layout, &body.outputs, wanted | body.needed | condition);
        // An accumulator may change with more than its start does.
        let own = self.known();
        let carried = own.results.get(&value).into_iter().flatten().copied().enumerate();
        let captured = fold.captures.iter().map(|v| own.depends[v.0 as usize]);
        let captured = captured.enumerate().map(|(i, depends)| (first + i, depends));
        let changing = carried.chain(captured).filter(|(_, depends)| self.changes(*depends));
        let changing = changing.fold(0, |all, (i, _)| all | layout.bit(i)) & useful;
        let mut variant = Variant { changing, wanted: SmallVec::new(), is_sampled };
        let operands = fold.starts.iter().enumerate();
        let operands = operands.chain(fold.captures.iter().enumerate().map(|(i, v)| (first + i, v)));
        for (i, operand) in operands {
            let takes = variant.takes(layout, i, self.function.ty(*operand));
            if takes {
                self.need(*operand);
            }
            if i < first - 1 {
                // Carried from step to step, so it comes out where it goes in.
                variant.wanted.push(takes);
            }
        }
        variant
    }
}
