//! Which values an output needs.
//!
//! Demand spreads from the entry's output over a list of values still to be looked at: an output of
//! a call needs that output of the callee; an accumulator of a fold needs its start and its next
//! value, and where that reads other accumulators, or the condition does, those too.

use texgraph_compiler::graph::{Fold, FunctionId, Graph, Operation, Value};

/// For each function, which of its values an output of the entry needs.
pub fn demand(graph: &Graph, output: usize) -> Vec<Vec<bool>> {
    let mut demand = Demand::new(graph);
    demand.output(graph.entry(), output);
    while let Some((function, value)) = demand.waiting.pop() {
        demand.spread(function, value);
    }
    demand.live
}

struct Demand<'a> {
    graph: &'a Graph,
    live: Vec<Vec<bool>>,
    /// Live values whose operands are not marked yet.
    waiting: Vec<(FunctionId, Value)>,
    /// For each function the folds, and where they stand, whose body or condition it is.
    folds: Vec<Vec<(FunctionId, &'a Fold)>>,
}

impl<'a> Demand<'a> {
    fn new(graph: &'a Graph) -> Demand<'a> {
        let live = graph.functions.iter().map(|function| vec![false; function.values.len()]).collect();
        let mut folds = vec![Vec::new(); graph.functions.len()];
        for (id, function) in (0..).map(FunctionId).zip(&graph.functions) {
            for operation in &function.values {
                let Operation::Fold(fold) = operation else { continue };
                for part in [Some(fold.body), fold.condition].into_iter().flatten() {
                    if let Some(folds) = folds.get_mut(part.0 as usize) {
                        folds.push((id, fold.as_ref()));
                    }
                }
            }
        }
        Demand { graph, live, waiting: Vec::new(), folds }
    }

    fn mark(&mut self, function: FunctionId, value: Value) {
        let live = self.live.get_mut(function.0 as usize).and_then(|live| live.get_mut(value.0 as usize));
        if let Some(live) = live.filter(|live| !**live) {
            *live = true;
            self.waiting.push((function, value));
        }
    }

    fn output(&mut self, function: FunctionId, n: usize) {
        let function_of = self.graph.functions.get(function.0 as usize);
        if let Some((_, value)) = function_of.and_then(|function| function.outputs.get(n)) {
            self.mark(function, *value);
        }
    }

    /// Marks what a live value needs.
    fn spread(&mut self, id: FunctionId, value: Value) {
        let graph = self.graph;
        let function = graph.function(id);
        match function.operation(value) {
            Operation::Output(of, n) => {
                self.mark(id, *of);
                match function.operation(*of) {
                    Operation::Call(callee, _) => self.output(*callee, *n as usize),
                    Operation::Fold(fold) => self.accumulator(id, fold, *n as usize),
                    _ => {}
                }
            }
            Operation::Fold(fold) => {
                self.mark(id, fold.steps);
                fold.captures.iter().for_each(|capture| self.mark(id, *capture));
                if let Some(condition) = fold.condition {
                    self.output(condition, 0);
                }
            }
            Operation::Input(n) => {
                for i in 0..self.folds[id.0 as usize].len() {
                    let (outside, fold) = self.folds[id.0 as usize][i];
                    self.accumulator(outside, fold, *n as usize);
                }
            }
            operation => operation.for_operands(|operand| self.mark(id, operand)),
        }
    }

    /// Marks what accumulator `n` of a fold needs; nothing where the fold has no such accumulator.
    fn accumulator(&mut self, outside: FunctionId, fold: &Fold, n: usize) {
        if let Some(start) = fold.starts.get(n) {
            self.mark(outside, *start);
            self.output(fold.body, n);
        }
    }
}
