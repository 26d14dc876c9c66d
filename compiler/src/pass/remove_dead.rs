//! What no output needs is removed: values, inputs of functions with their arguments, outputs that
//! no caller reads, accumulators and captures of folds, functions that nobody calls.

use super::liveness::Liveness;
use crate::graph::{Function, FunctionId, Graph, Operation, Value};

/// Keeps what the entry's outputs need. The entry keeps its inputs: they are the contract.
pub fn run(graph: Graph) -> Graph {
    with_places(graph).0
}

/// The same, and where each function came to stand.
pub fn with_places(graph: Graph) -> (Graph, Vec<Option<FunctionId>>) {
    let mut live = Liveness::of(&graph);
    if let Some(inputs) = live.inputs.last_mut() {
        inputs.fill(true);
    }
    let entry = graph.functions.len().saturating_sub(1);
    let mut removing = Removing {
        live,
        ids: vec![None; graph.functions.len()],
        outputs: Vec::new(),
        keeps_shape: vec![false; graph.functions.len()],
        values: Vec::new(),
    };
    let mut functions = Vec::with_capacity(graph.functions.len());
    for (i, mut function) in graph.functions.into_iter().enumerate() {
        if i == entry || removing.live.outputs[i].contains(&true) {
            removing.function(i, &mut function);
            removing.ids[i] = Some(FunctionId(functions.len() as u32));
            functions.push(function);
        }
    }
    (Graph { functions, ..graph }, removing.ids)
}

/// Where each of a list comes to stand when the dead ones are gone.
fn places(live: &[bool]) -> Vec<u32> {
    let mut next = 0;
    let place = |live: &bool| {
        let place = next;
        next += u32::from(*live);
        place
    };
    live.iter().map(place).collect()
}

/// Keeps those of a list that are live.
fn retain<T>(list: &mut Vec<T>, live: &[bool]) {
    let mut live = live.iter();
    list.retain(|_| live.next() == Some(&true));
}

/// Removes what is dead from functions.
struct Removing {
    live: Liveness,
    /// Where a function of the graph went.
    ids: Vec<Option<FunctionId>>,
    /// For each function that is left where its outputs came to stand.
    outputs: Vec<Vec<u32>>,
    /// Which functions keep all inputs and outputs.
    keeps_shape: Vec<bool>,
    /// The new values of the function being looked at.
    values: Vec<Value>,
}

impl Removing {
    /// Removes what is dead from one function, after all that it calls.
    fn function(&mut self, place: usize, function: &mut Function) {
        let is_whole = |live: &[bool]| !live.contains(&false);
        let (values, inputs, outputs) =
            (&self.live.values[place], &self.live.inputs[place], &self.live.outputs[place]);
        self.outputs.push(places(outputs));
        let keeps_shape = is_whole(inputs) && is_whole(outputs);
        let is_untouched = keeps_shape
            && is_whole(values)
            && function.functions().all(|used| self.keeps_shape[used.0 as usize]);
        if is_untouched {
            function.replace_functions(|used| self.id(used));
        } else {
            self.rest(place, function);
            function.origin = None;
        }
        self.keeps_shape[place] = keeps_shape;
    }

    /// What is left is in order and nothing in it folds, so it moves up as it is.
    fn rest(&mut self, place: usize, function: &mut Function) {
        let inputs = places(&self.live.inputs[place]);
        self.values.clear();
        let mut next = Value(0);
        for i in 0..function.values.len() {
            self.values.push(next);
            let name = function.names.take(Value(i as u32));
            if !self.live.values[place][i] {
                continue;
            }
            let mut operation = std::mem::replace(&mut function.values[i], Operation::Input(0));
            self.adapt(&mut operation, &inputs, &function.values);
            let to = next.0 as usize;
            function.values[to] = operation;
            function.types[to] = function.types[i];
            function.places[to] = function.places[i];
            if let Some(name) = name {
                function.names.insert(next, name);
            }
            next.0 += 1;
        }
        let left = next.0 as usize;
        function.values.truncate(left);
        function.types.truncate(left);
        function.places.truncate(left);
        retain(&mut function.inputs, &self.live.inputs[place]);
        retain(&mut function.outputs, &self.live.outputs[place]);
        for (_, value) in &mut function.outputs {
            *value = self.values[value.0 as usize];
        }
    }

    fn id(&self, old: FunctionId) -> FunctionId {
        self.ids.get(old.0 as usize).copied().flatten().unwrap_or(old)
    }

    /// Makes an operation one over new values, `before` it, without what is dead.
    fn adapt(&self, operation: &mut Operation, inputs: &[u32], before: &[Operation]) {
        operation.replace_operands(|v| self.values[v.0 as usize]);
        match operation {
            Operation::Input(i) => *i = inputs.get(*i as usize).copied().unwrap_or(0),
            Operation::Output(of, i) => {
                let of = match &before[of.0 as usize] {
                    Operation::Call(callee, _) => *callee,
                    Operation::Fold(fold) => fold.body,
                    _ => return,
                };
                *i = self.outputs[of.0 as usize].get(*i as usize).copied().unwrap_or(0);
            }
            Operation::Call(callee, arguments) => {
                *arguments = kept(arguments, &self.live.inputs[callee.0 as usize]).collect();
                *callee = self.id(*callee);
            }
            Operation::Fold(fold) => {
                let live = &self.live.inputs[fold.body.0 as usize];
                retain(&mut fold.captures, live.get(fold.starts.len() + 1..).unwrap_or(&[]));
                retain(&mut fold.starts, live);
                fold.body = self.id(fold.body);
                fold.condition = fold.condition.map(|condition| self.id(condition));
            }
            _ => {}
        }
    }
}

/// Those operands that go to live inputs.
fn kept(operands: &[Value], live: &[bool]) -> impl Iterator<Item = Value> {
    operands.iter().zip(live).filter(|(_, live)| **live).map(|(operand, _)| *operand)
}
