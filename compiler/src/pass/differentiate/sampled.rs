//! Where what comes out of a sample counts as changing: in all that a `dx`, `dy` or `footprint` is
//! taken of, in what is handed to a function or a loop that takes one, and in the functions and
//! loops that such a value comes from. It ends at the place of a sample, whose own change is taken
//! without that of other samples.

use super::marked;
use crate::graph::{Fold, Function, FunctionId, Graph, Operation, Sampled, Value};
use crate::intrinsic::Derivative;

/// Which values of a function change with what was sampled.
pub struct Marks {
    /// Where no more is asked than what its own derivatives are taken of.
    own: Vec<bool>,
    /// Where all its outputs are asked for, too.
    whole: Vec<bool>,
    /// Its outputs come from samples.
    samples: bool,
}

impl Marks {
    /// Whether a value does, in a variant of the function.
    pub fn has(&self, is_whole: bool, value: Value) -> bool {
        marked(if is_whole { &self.whole } else { &self.own }, value)
    }

    /// Whether its outputs come from samples at all.
    pub fn samples(&self) -> bool {
        self.samples
    }
}

/// Of each function; none where no derivative asks for it.
pub fn marks(graph: &Graph) -> Option<Vec<Marks>> {
    let mut operations = graph.functions.iter().flat_map(|function| &function.values);
    let is_asked = |operation: &Operation| matches!(operation, Operation::Derivative(.., Sampled::Changing));
    operations.any(is_asked).then(|| {
        let mut walk = Walk { marks: Vec::new(), handed: Vec::new() };
        graph.functions.iter().for_each(|function| walk.function(function));
        walk.marks
    })
}

struct Walk {
    marks: Vec<Marks>,
    /// For each function done the inputs that this reaches: from its own derivatives, and from its
    /// outputs too.
    handed: Vec<[Vec<bool>; 2]>,
}

impl Walk {
    fn function(&mut self, function: &Function) {
        let (own, handed) = self.values(function, false);
        let (whole, handed_whole) = self.values(function, true);
        let samples = function.iter().any(|(value, operation)| {
            marked(&whole, value)
                && match operation {
                    Operation::Sample { .. } => true,
                    Operation::Call(callee, _) => self.marks[callee.0 as usize].samples,
                    Operation::Fold(fold) => self.marks[fold.body.0 as usize].samples,
                    _ => false,
                }
        });
        self.handed.push([handed, handed_whole]);
        self.marks.push(Marks { own, whole, samples });
    }

    /// The values and the inputs.
    fn values(&self, function: &Function, is_whole: bool) -> (Vec<bool>, Vec<bool>) {
        let mut values = vec![false; function.values.len()];
        let mut handed = vec![false; function.inputs.len()];
        if is_whole {
            function.outputs.iter().for_each(|(_, value)| values[value.0 as usize] = true);
        }
        for (value, operation) in function.iter().rev() {
            let is_marked = marked(&values, value);
            let mut mark = |v: Value| values[v.0 as usize] = true;
            match operation {
                Operation::Derivative(v, _, Sampled::Changing) => mark(*v),
                Operation::Call(callee, arguments) => {
                    let handed = arguments.iter().zip(self.handed(*callee, is_marked));
                    handed.filter(|(_, handed)| **handed).for_each(|(v, _)| mark(*v));
                }
                Operation::Fold(fold) if is_marked || self.takes(fold) => {
                    fold.starts.iter().chain(&fold.captures).for_each(|v| mark(*v));
                    mark(value);
                }
                Operation::Input(i) if is_marked => {
                    handed.get_mut(*i as usize).into_iter().for_each(|handed| *handed = true);
                }
                Operation::Builtin(intrinsic, arguments) if is_marked => {
                    if matches!(intrinsic.row().derivative, Derivative::Rule(_)) {
                        arguments.iter().for_each(|v| mark(*v));
                    }
                }
                Operation::Select(_, yes, no) if is_marked => [*yes, *no].into_iter().for_each(mark),
                Operation::Output(of, _) if is_marked => mark(*of),
                Operation::Compose(_) | Operation::Extract(..) if is_marked => operation.for_operands(mark),
                _ => {}
            }
        }
        (values, handed)
    }

    fn handed(&self, id: FunctionId, is_whole: bool) -> &[bool] {
        &self.handed[id.0 as usize][usize::from(is_whole)]
    }

    /// Whether a derivative is taken of what goes from step to step, or of a capture.
    fn takes(&self, fold: &Fold) -> bool {
        let mut functions = std::iter::once(fold.body).chain(fold.condition);
        functions.any(|id| self.handed(id, false).contains(&true))
    }
}
