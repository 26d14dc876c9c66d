//! What no output needs is removed: values, inputs of functions with their arguments, outputs that
//! no caller reads, accumulators and captures of folds, functions that nobody calls.

use super::liveness::Liveness;
use super::taken::Taken;
use crate::graph::{Function, FunctionId, Graph, Operation, Value};
use rustc_hash::FxHashMap;

/// Keeps what the entry's outputs need. The entry keeps its inputs: they are the contract.
pub fn run(graph: Graph) -> Graph {
    let mut live = Liveness::of(&graph);
    if let Some(inputs) = live.inputs.last_mut() {
        inputs.fill(true);
    }
    let entry = graph.functions.len().saturating_sub(1);
    let mut removing = Removing {
        places: live.outputs.iter().map(|live| places(live)).collect(),
        ids: vec![None; graph.functions.len()],
        live,
        values: Vec::new(),
        inner: FxHashMap::default(),
    };
    let mut functions = Vec::new();
    for (i, function) in graph.functions.into_iter().enumerate() {
        if i == entry || removing.live.outputs[i].contains(&true) {
            removing.ids[i] = Some(FunctionId(functions.len() as u32));
            functions.push(removing.function(i, function));
        }
    }
    Graph { functions, ..graph }
}

/// Where each output comes to stand when the dead ones are gone.
fn places(live: &[bool]) -> Vec<u32> {
    let mut next = 0;
    let place = |live: &bool| {
        let place = next;
        next += u32::from(*live);
        place
    };
    live.iter().map(place).collect()
}

/// Makes functions without what is dead.
struct Removing {
    live: Liveness,
    /// For each function where its outputs come to stand.
    places: Vec<Vec<u32>>,
    ids: Vec<Option<FunctionId>>,
    /// The new values of the function being made.
    values: Vec<Value>,
    /// Whose outputs its calls and folds have.
    inner: FxHashMap<Value, FunctionId>,
}

impl Removing {
    /// What is left is in order and nothing in it folds, so it is moved as it is.
    fn function(&mut self, place: usize, function: Function) -> Function {
        let taken = Taken::new(function);
        let mut new = Function { name: taken.name, ..Function::default() };
        let mut inputs = Vec::with_capacity(taken.inputs.len());
        for (slot, live) in taken.inputs.into_iter().zip(&self.live.inputs[place]) {
            inputs.push(new.inputs.len() as u32);
            new.inputs.extend(live.then_some(slot));
        }
        self.values.clear();
        self.inner.clear();
        for part in taken.values {
            self.values.push(Value(new.values.len() as u32));
            if !self.live.is_live(place, part.old) {
                continue;
            }
            if let Some(name) = part.name {
                new.names.insert(Value(new.values.len() as u32), name);
            }
            let operation = match part.operation {
                Operation::Input(i) => Operation::Input(inputs.get(i as usize).copied().unwrap_or(0)),
                operation => self.adapted(part.old, operation),
            };
            new.values.push(operation);
            new.types.push(part.ty);
            new.places.push(part.place);
        }
        for ((slot, value), live) in taken.outputs.into_iter().zip(&self.live.outputs[place]) {
            if *live {
                new.outputs.push((slot, self.values[value.0 as usize]));
            }
        }
        new
    }

    fn id(&self, old: FunctionId) -> FunctionId {
        self.ids.get(old.0 as usize).copied().flatten().unwrap_or(old)
    }

    /// An operation over new values, without what is dead.
    fn adapted(&mut self, old: Value, mut operation: Operation) -> Operation {
        if let Operation::Output(of, i) = &mut operation
            && let Some(inner) = self.inner.get(of)
        {
            *i = self.places[inner.0 as usize].get(*i as usize).copied().unwrap_or(0);
        }
        operation.replace_operands(|v| self.values[v.0 as usize]);
        match &mut operation {
            Operation::Call(callee, arguments) => {
                self.inner.insert(old, *callee);
                *arguments = kept(arguments, &self.live.inputs[callee.0 as usize]).collect();
                *callee = self.id(*callee);
            }
            Operation::Fold(fold) => {
                self.inner.insert(old, fold.body);
                let live = &self.live.inputs[fold.body.0 as usize];
                fold.captures =
                    kept(&fold.captures, live.get(fold.starts.len() + 1..).unwrap_or(&[])).collect();
                fold.starts = kept(&fold.starts, live).collect();
                fold.body = self.id(fold.body);
                fold.condition = fold.condition.map(|condition| self.id(condition));
            }
            _ => {}
        }
        operation
    }
}

/// Those operands that go to live inputs.
fn kept(operands: &[Value], live: &[bool]) -> impl Iterator<Item = Value> {
    operands.iter().zip(live).filter(|(_, live)| **live).map(|(operand, _)| *operand)
}
