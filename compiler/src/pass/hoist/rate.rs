//! What is the same for a whole draw.

use crate::graph::{Function, FunctionId, Graph, Operation, Value};
use crate::input::is_per_draw;
use crate::pass::liveness::Liveness;

/// Which inputs of each function are the same for a whole draw wherever it is used: callers before
/// callees.
pub fn per_draw(graph: &Graph, live: &Liveness) -> Vec<Vec<bool>> {
    let mut rates = Rates(graph.functions.iter().map(|f| vec![true; f.inputs.len()]).collect());
    if let (Some(inputs), Some(entry)) = (rates.0.last_mut(), graph.functions.last()) {
        *inputs = entry.inputs.iter().map(|slot| is_per_draw(&slot.name)).collect();
    }
    for (place, function) in graph.functions.iter().enumerate().rev() {
        let fixed = fixed(function, &rates.0[place]);
        for (value, operation) in function.iter() {
            if live.is_live(place, value) {
                rates.spread(operation, &fixed);
            }
        }
    }
    rates.0
}

struct Rates(Vec<Vec<bool>>);

impl Rates {
    /// Notes at which rate an operation feeds the inputs of other functions.
    fn spread(&mut self, operation: &Operation, fixed: &[bool]) {
        match operation {
            Operation::Call(callee, arguments) => self.feed(*callee, 0, arguments, fixed),
            Operation::Fold(fold) => {
                let carried = fold.starts.len();
                self.vary(fold.body, carried + 1);
                self.feed(fold.body, carried + 1, &fold.captures, fixed);
                if let Some(condition) = fold.condition {
                    self.vary(condition, carried);
                    self.feed(condition, carried, &fold.captures, fixed);
                }
            }
            _ => {}
        }
    }

    /// The first inputs change from step to step.
    fn vary(&mut self, id: FunctionId, count: usize) {
        self.0[id.0 as usize].iter_mut().take(count).for_each(|input| *input = false);
    }

    /// The inputs from `first` on are these.
    fn feed(&mut self, id: FunctionId, first: usize, values: &[Value], fixed: &[bool]) {
        for (input, value) in self.0[id.0 as usize].iter_mut().skip(first).zip(values) {
            *input &= fixed[value.0 as usize];
        }
    }
}

/// Which values are made of params, constants and those inputs alone.
pub fn fixed(function: &Function, inputs: &[bool]) -> Vec<bool> {
    let mut fixed: Vec<bool> = Vec::with_capacity(function.values.len());
    for operation in &function.values {
        let is_fixed = match operation {
            Operation::Input(i) => inputs.get(*i as usize).copied().unwrap_or(false),
            Operation::Derivative(..) => false,
            _ => {
                let mut all = true;
                operation.for_operands(|v| all &= fixed[v.0 as usize]);
                all
            }
        };
        fixed.push(is_fixed);
    }
    fixed
}
