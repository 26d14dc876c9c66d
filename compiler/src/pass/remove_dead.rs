//! What no output needs is removed: values, inputs of functions with their arguments, outputs that
//! no caller reads, accumulators and captures of folds, functions that nobody calls.

use super::liveness::Liveness;
use crate::graph::{Builder, Fold, Function, FunctionId, Graph, Operation, Value};

/// Keeps what the entry's outputs need. The entry keeps its inputs: they are the contract.
pub fn run(graph: Graph) -> Graph {
    let mut live = Liveness::of(&graph);
    if let Some(inputs) = live.inputs.last_mut() {
        inputs.fill(true);
    }
    let places: Vec<Vec<u32>> = live.outputs.iter().map(|live| places(live)).collect();
    let entry = graph.functions.len().saturating_sub(1);
    let mut ids = vec![None; graph.functions.len()];
    let mut functions = Vec::new();
    for i in 0..graph.functions.len() {
        if i == entry || live.outputs[i].contains(&true) {
            let values = Vec::with_capacity(graph.functions[i].values.len());
            let removing = Removing { graph: &graph, live: &live, places: &places, ids: &ids, values };
            functions.push(removing.run(i));
            ids[i] = Some(FunctionId(functions.len() as u32 - 1));
        }
    }
    Graph { functions, ..graph }
}

/// Where each output comes to stand when the dead ones are gone.
fn places(live: &[bool]) -> Vec<u32> {
    let mut next = 0;
    let mut place = |live: &bool| {
        let place = next;
        next += u32::from(*live);
        place
    };
    live.iter().map(|live| place(live)).collect()
}

/// A function being made without what is dead.
struct Removing<'a> {
    graph: &'a Graph,
    live: &'a Liveness,
    places: &'a [Vec<u32>],
    ids: &'a [Option<FunctionId>],
    values: Vec<Value>,
}

impl Removing<'_> {
    fn run(mut self, place: usize) -> Function {
        let function = &self.graph.functions[place];
        let mut builder = Builder::new(function.name.clone());
        let inputs: Vec<Value> = function
            .inputs
            .iter()
            .zip(&self.live.inputs[place])
            .map(|(slot, live)| if *live { builder.input(slot.name.clone(), slot.ty) } else { Value(0) })
            .collect();
        for (old, operation) in function.iter() {
            let value = match operation {
                _ if !self.live.is_live(place, old) => Value(0),
                Operation::Input(i) => inputs.get(*i as usize).copied().unwrap_or(Value(0)),
                _ => {
                    builder.set_place(function.places[old.0 as usize]);
                    let value = builder.push(self.adapted(function, operation), function.ty(old));
                    if let Some(name) = function.names.get(&old) {
                        builder.name(value, name);
                    }
                    value
                }
            };
            self.values.push(value);
        }
        for ((slot, value), live) in function.outputs.iter().zip(&self.live.outputs[place]) {
            if *live {
                builder.output(slot.name.clone(), self.values[value.0 as usize]);
            }
        }
        builder.finish()
    }

    fn id(&self, old: FunctionId) -> FunctionId {
        self.ids.get(old.0 as usize).copied().flatten().unwrap_or(old)
    }

    /// The new values of those operands that go to live inputs.
    fn kept(&self, operands: &[Value], live: &[bool]) -> Vec<Value> {
        let live = operands.iter().zip(live).filter(|(_, live)| **live);
        live.map(|(operand, _)| self.values[operand.0 as usize]).collect()
    }

    /// An operation over new values, without what is dead.
    fn adapted(&self, function: &Function, operation: &Operation) -> Operation {
        match operation {
            Operation::Call(callee, arguments) => {
                let live = &self.live.inputs[callee.0 as usize];
                Operation::Call(self.id(*callee), self.kept(arguments, live))
            }
            Operation::Fold(fold) => {
                let live = &self.live.inputs[fold.body.0 as usize];
                Operation::Fold(Box::new(Fold {
                    body: self.id(fold.body),
                    condition: fold.condition.map(|condition| self.id(condition)),
                    starts: self.kept(&fold.starts, live),
                    steps: self.values[fold.steps.0 as usize],
                    most: fold.most,
                    captures: self.kept(&fold.captures, live.get(fold.starts.len() + 1..).unwrap_or(&[])),
                }))
            }
            Operation::Output(of, i) => {
                let inner = match function.operation(*of) {
                    Operation::Call(callee, _) => *callee,
                    Operation::Fold(fold) => fold.body,
                    _ => return operation.clone(),
                };
                let place = self.places[inner.0 as usize].get(*i as usize).copied().unwrap_or(0);
                Operation::Output(self.values[of.0 as usize], place)
            }
            _ => operation.map_operands(|v| self.values[v.0 as usize]),
        }
    }
}
