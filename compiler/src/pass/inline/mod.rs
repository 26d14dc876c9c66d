//! A node written as a single expression, or that comes to one call, is taken over by its callers; any
//! other stays a function.
//! A fold of a few known steps is written out: its body is taken over once for each, with the
//! number of the step a constant, so a one-octave fBm has no loop. Functions that nothing needs are
//! dropped.
//!
//! What is taken over is decided for whole functions beforehand (see `Plan`), folds are decided
//! when they are met: only then it is known what their steps have become.

mod plan;

use crate::graph::{Builder, Constant, Fold, Function, FunctionId, Graph, Operation, Value};
use plan::{Fate, Plan};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Steps that are written out at most.
const MOST_STEPS: u32 = 4;
/// Values that written-out steps may add to a graph.
const MOST_WRITTEN_OUT: usize = 100_000;

/// Takes single expressions over and writes short folds out, whatever their depth.
pub fn run(mut graph: Graph) -> Graph {
    let plan = Plan::of(&graph);
    let mut made = Made { ids: vec![None; graph.functions.len()], functions: Vec::new() };
    let mut allowance = MOST_WRITTEN_OUT;
    for (i, fate) in plan.fates.iter().enumerate() {
        let new = match fate {
            Fate::Dropped | Fate::TakenOver => continue,
            Fate::Called if plan.stays(&graph.functions[i]) => {
                made.adapted(std::mem::take(&mut graph.functions[i]))
            }
            Fate::Called | Fate::Folded => {
                let function = &graph.functions[i];
                let expanding = Expanding {
                    graph: &graph,
                    made: &made,
                    builder: Builder::with_capacity(function.name.clone(), function.values.len()),
                    allowance: &mut allowance,
                };
                expanding.run(function)
            }
        };
        made.ids[i] = Some(FunctionId(made.functions.len() as u32));
        made.functions.push(new);
    }
    Graph { functions: made.functions, ..graph }
}

/// The functions of a graph, each in its place: what they call that is a single expression is taken
/// over, but stays for others to take over.
pub fn ahead(graph: &Graph) -> Vec<Function> {
    let plan = Plan::of(graph);
    let mut made = Made { ids: vec![None; graph.functions.len()], functions: Vec::new() };
    let mut allowance = MOST_WRITTEN_OUT;
    for (i, (function, fate)) in graph.functions.iter().zip(&plan.fates).enumerate() {
        let builder = Builder::with_capacity(function.name.clone(), function.values.len());
        let expanding = Expanding { graph, made: &made, builder, allowance: &mut allowance };
        let new = Function { inline: function.inline, ..expanding.run(function) };
        made.functions.push(new);
        made.ids[i] = (*fate != Fate::TakenOver).then_some(FunctionId(i as u32));
    }
    made.functions
}

/// The functions that are done.
struct Made {
    functions: Vec<Function>,
    /// Where a function of the graph went.
    ids: Vec<Option<FunctionId>>,
}

impl Made {
    fn id(&self, old: FunctionId) -> Option<FunctionId> {
        self.ids.get(old.0 as usize).copied().flatten()
    }

    /// A function that takes nothing over: only what it calls has moved.
    fn adapted(&self, mut function: Function) -> Function {
        for operation in &mut function.values {
            if let Operation::Call(callee, _) = operation {
                *callee = self.id(*callee).unwrap_or(*callee);
            }
        }
        function
    }

    /// What a condition always gives, if that is known.
    fn always(&self, condition: FunctionId) -> Option<bool> {
        let function = self.functions.get(self.id(condition)?.0 as usize)?;
        match function.operation(function.outputs.first()?.1) {
            Operation::Constant(holds) => Some(holds.bool(0)),
            _ => None,
        }
    }
}

/// A function whose operations are being copied.
struct Copying<'a> {
    function: &'a Function,
    arguments: Vec<Value>,
    next: usize,
    values: Vec<Value>,
    /// The outputs of calls and folds that were taken over, by the call or fold.
    outputs: FxHashMap<Value, Vec<Value>>,
    /// For a step of a fold those that follow.
    steps: Option<Steps>,
    /// It stands in a step that is written out.
    written_out: bool,
    /// It keeps its names; those of what is called would hide the caller's own.
    named: bool,
}

/// The steps of a fold that are still to be written out.
struct Steps {
    next: u32,
    all: u32,
    captures: Vec<Value>,
}

impl<'a> Copying<'a> {
    fn new(function: &'a Function, arguments: Vec<Value>) -> Copying<'a> {
        Copying {
            function,
            arguments,
            next: 0,
            values: Vec::with_capacity(function.values.len()),
            outputs: FxHashMap::default(),
            steps: None,
            written_out: false,
            named: true,
        }
    }

    fn value(&self, old: Value) -> Value {
        self.values.get(old.0 as usize).copied().unwrap_or(Value(0))
    }

    /// The name that a value keeps.
    fn name(&self, old: Value) -> Option<&'a Arc<str>> {
        self.function.names.get(old).filter(|_| self.named)
    }

    /// The value being copied stands for what its outputs will be; only they are read.
    fn stand_in(&mut self) {
        self.values.push(Value(0));
    }

    /// The outputs of the call or fold that was copied last.
    fn deliver(&mut self, outputs: Vec<Value>) {
        self.outputs.insert(Value(self.values.len() as u32 - 1), outputs);
    }
}

/// A function in the making.
struct Expanding<'a, 'b> {
    graph: &'a Graph,
    made: &'b Made,
    builder: Builder,
    /// Values that written-out steps may still add.
    allowance: &'b mut usize,
}

impl<'a> Expanding<'a, '_> {
    fn run(mut self, function: &'a Function) -> Function {
        let inputs =
            function.inputs.iter().map(|slot| self.builder.input(slot.name.clone(), slot.ty)).collect();
        let mut stack = vec![Copying::new(function, inputs)];
        while let Some(top) = stack.last_mut() {
            if let Some(operation) = top.function.values.get(top.next) {
                let inner = self.copy(top, operation);
                stack.extend(inner);
                continue;
            }
            let outputs = top.function.outputs.iter().map(|(_, value)| top.value(*value)).collect();
            let done =
                stack.pop().and_then(|done| done.steps.map(|steps| (done.function, steps, done.named)));
            match (done, stack.last_mut()) {
                (Some((body, steps, named)), _) if steps.next < steps.all => {
                    stack.push(self.step(body, outputs, steps, named));
                }
                (_, Some(caller)) => caller.deliver(outputs),
                (_, None) => self.outputs(function, outputs),
            }
        }
        self.builder.finish()
    }

    fn outputs(&mut self, function: &Function, values: Vec<Value>) {
        for ((slot, _), value) in function.outputs.iter().zip(values) {
            self.builder.output(slot.name.clone(), value);
        }
    }

    /// Copies one operation, or begins what is taken over in its place.
    fn copy(&mut self, top: &mut Copying<'a>, operation: &'a Operation) -> Option<Copying<'a>> {
        let old = Value(top.next as u32);
        top.next += 1;
        self.builder.set_place(top.function.places[old.0 as usize]);
        if top.written_out {
            *self.allowance = self.allowance.saturating_sub(1);
        }
        let value = match operation {
            Operation::Input(i) => top.arguments.get(*i as usize).copied().unwrap_or(Value(0)),
            Operation::Output(of, i) if top.outputs.contains_key(of) => {
                let outputs = top.outputs.get(of);
                outputs.and_then(|outputs| outputs.get(*i as usize)).copied().unwrap_or(Value(0))
            }
            Operation::Call(callee, arguments) if self.made.id(*callee).is_none() => {
                let arguments = arguments.iter().map(|v| top.value(*v)).collect();
                top.stand_in();
                let callee = Copying::new(self.graph.function(*callee), arguments);
                return Some(Copying { named: false, written_out: top.written_out, ..callee });
            }
            Operation::Call(callee, arguments) => {
                let callee = self.made.id(*callee).unwrap_or(*callee);
                let arguments = arguments.iter().map(|v| top.value(*v)).collect();
                self.builder.push(Operation::Call(callee, arguments), top.function.ty(old))
            }
            Operation::Fold(fold) => return self.fold(top, old, fold),
            _ => self.builder.push(operation.map_operands(|v| top.value(v)), top.function.ty(old)),
        };
        top.values.push(value);
        if let Some(name) = top.name(old) {
            self.builder.name(value, Arc::clone(name));
        }
        None
    }

    fn fold(&mut self, top: &mut Copying<'a>, old: Value, fold: &Fold) -> Option<Copying<'a>> {
        let mut new = fold.map_operands(|v| top.value(v));
        let always = fold.condition.and_then(|condition| self.made.always(condition));
        new.condition = fold.condition.filter(|_| always != Some(true));
        let steps = match self.builder.as_constant(new.steps) {
            _ if always == Some(false) => Some(0),
            Some(steps) => Some(u32::try_from(steps.int(0)).unwrap_or(0).min(new.most)),
            None => None,
        };
        let body = self.graph.function(fold.body);
        let short = |n: &u32| {
            *n == 0
                || new.condition.is_none()
                    && *n <= MOST_STEPS
                    && *n as usize * body.values.len() <= *self.allowance
        };
        match steps.filter(short) {
            Some(0) => {
                top.stand_in();
                top.deliver(new.starts);
                None
            }
            Some(all) => {
                top.stand_in();
                let steps = Steps { next: 0, all, captures: new.captures };
                Some(self.step(body, new.starts, steps, top.named))
            }
            None => {
                new.body = self.made.id(new.body).unwrap_or(new.body);
                new.condition = new.condition.and_then(|condition| self.made.id(condition));
                let ty = top.function.ty(old);
                top.values.push(self.builder.push(Operation::Fold(Box::new(new)), ty));
                None
            }
        }
    }

    /// Begins the next step of a fold that is written out.
    fn step(
        &mut self,
        body: &'a Function,
        accumulators: Vec<Value>,
        steps: Steps,
        named: bool,
    ) -> Copying<'a> {
        let mut arguments = accumulators;
        arguments.push(self.builder.constant(Constant::ints(&[steps.next as i32])));
        arguments.extend(&steps.captures);
        let steps = Steps { next: steps.next + 1, ..steps };
        Copying { steps: Some(steps), written_out: true, named, ..Copying::new(body, arguments) }
    }
}
