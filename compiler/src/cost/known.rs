//! What is known of a graph when its params have their defaults.
//!
//! Three walks over the functions, none of which recurses: callees first with nothing known of
//! their inputs, to learn which outputs are known; callers first, to learn which inputs all callers
//! agree on; and callees first again.

use super::bound;
use crate::graph::evaluate::applied;
use crate::graph::{Constant, Fold, Function, FunctionId, Graph, Operation, Value};

/// Known numbers, function by function.
pub struct Known {
    values: Vec<Numbers>,
    /// Whether a function is called or folded from the entry on.
    reached: Vec<bool>,
}

/// By value: its number, where it is known.
type Numbers = Vec<Option<Constant>>;

impl Known {
    /// The number of a value.
    pub fn number(&self, function: usize, value: Value) -> Option<Constant> {
        self.values.get(function)?.get(value.0 as usize).copied().flatten()
    }

    /// Whether anything runs this function.
    pub fn is_reached(&self, function: usize) -> bool {
        self.reached.get(function).copied().unwrap_or(false)
    }

    /// The steps of a fold of a function in the typical case.
    pub fn steps(&self, index: usize, function: &Function, fold: &Fold) -> f64 {
        let known = self.number(index, fold.steps);
        let most = bound(function, fold);
        let steps = known.map_or(most, |steps| u32::try_from(steps.int(0)).unwrap_or(0).min(most));
        f64::from(steps) * if fold.condition.is_some() { 0.5 } else { 1.0 }
    }
}

/// What is known with all params at their defaults.
pub fn at_defaults(graph: &Graph) -> Known {
    let nothing: Vec<Numbers> =
        graph.functions.iter().map(|function| vec![None; function.inputs.len()]).collect();
    let first = upwards(graph, &nothing);
    let (inputs, reached) = inputs(graph, &first);
    Known { values: upwards(graph, &inputs), reached }
}

/// The numbers of all functions, callees first, for known inputs.
fn upwards(graph: &Graph, inputs: &[Numbers]) -> Vec<Numbers> {
    let mut all: Vec<Numbers> = Vec::with_capacity(graph.functions.len());
    for (function, inputs) in graph.functions.iter().zip(inputs) {
        let numbers = numbers(graph, function, inputs, &all);
        all.push(numbers);
    }
    all
}

/// The numbers of one function, whose callees' are known.
fn numbers(graph: &Graph, function: &Function, inputs: &[Option<Constant>], callees: &[Numbers]) -> Numbers {
    let mut numbers: Numbers = Vec::with_capacity(function.values.len());
    for operation in &function.values {
        let number = match operation {
            Operation::Constant(constant) => Some(*constant),
            Operation::Param(id) => graph.params.get(id.0 as usize).map(|param| param.default),
            Operation::Input(i) => inputs.get(*i as usize).copied().flatten(),
            Operation::Output(of, i) => match function.operation(*of) {
                Operation::Call(callee, _) => output(graph, *callee, *i, callees),
                _ => None,
            },
            Operation::Select(condition, yes, no) => numbers[condition.0 as usize].and_then(|holds| {
                let chosen = if holds.bool(0) { yes } else { no };
                numbers[chosen.0 as usize]
            }),
            _ => known_operands(operation, &numbers).and_then(|operands| applied(operation, &operands)),
        };
        numbers.push(number);
    }
    numbers
}

fn output(graph: &Graph, callee: FunctionId, i: u32, callees: &[Numbers]) -> Option<Constant> {
    let (_, value) = graph.functions.get(callee.0 as usize)?.outputs.get(i as usize)?;
    callees.get(callee.0 as usize)?.get(value.0 as usize).copied().flatten()
}

fn known_operands(operation: &Operation, numbers: &Numbers) -> Option<Vec<Constant>> {
    let mut operands = Some(Vec::new());
    operation.for_operands(|value| match (&mut operands, numbers.get(value.0 as usize).copied().flatten()) {
        (Some(operands), Some(number)) => operands.push(number),
        _ => operands = None,
    });
    operands
}

/// What callers say of an input.
#[derive(Clone, Copy)]
enum Said {
    Nothing,
    Number(Constant),
    Different,
}

/// The inputs on which all callers agree, callers first; and which functions have a caller.
fn inputs(graph: &Graph, outputs: &[Numbers]) -> (Vec<Numbers>, Vec<bool>) {
    let said = |function: &Function| vec![Said::Nothing; function.inputs.len()];
    let mut said: Vec<Vec<Said>> = graph.functions.iter().map(said).collect();
    let mut reached = vec![false; graph.functions.len()];
    reached.iter_mut().rev().take(1).for_each(|entry| *entry = true);
    for caller in (0..graph.functions.len()).rev() {
        if !reached[caller] {
            continue;
        }
        let function = &graph.functions[caller];
        let own = agreed(&said[caller]);
        let numbers = numbers(graph, function, &own, outputs);
        let number = |value: &Value| numbers.get(value.0 as usize).copied().flatten();
        for operation in &function.values {
            for (callee, arguments) in passed(operation) {
                reached[callee.0 as usize] = true;
                for (slot, argument) in said[callee.0 as usize].iter_mut().zip(arguments) {
                    *slot = hear(*slot, argument.as_ref().and_then(number));
                }
            }
        }
    }
    (said.iter().map(|said| agreed(said)).collect(), reached)
}

fn agreed(said: &[Said]) -> Numbers {
    said.iter().map(|said| if let Said::Number(number) = said { Some(*number) } else { None }).collect()
}

fn hear(said: Said, number: Option<Constant>) -> Said {
    match (said, number) {
        (Said::Nothing, Some(number)) => Said::Number(number),
        (Said::Number(known), Some(number)) if known == number => Said::Number(known),
        _ => Said::Different,
    }
}

/// What an operation passes to the inputs of which functions; none for what changes from step to
/// step.
fn passed(operation: &Operation) -> Vec<(FunctionId, Vec<Option<Value>>)> {
    match operation {
        Operation::Call(callee, arguments) => {
            vec![(*callee, arguments.iter().copied().map(Some).collect())]
        }
        Operation::Fold(fold) => {
            let captures = || fold.captures.iter().copied().map(Some);
            let changing = |count: usize| std::iter::repeat_n(None, count);
            let body = changing(fold.starts.len() + 1).chain(captures()).collect();
            let condition = |id| (id, changing(fold.starts.len()).chain(captures()).collect());
            std::iter::once((fold.body, body)).chain(fold.condition.map(condition)).collect()
        }
        _ => Vec::new(),
    }
}
