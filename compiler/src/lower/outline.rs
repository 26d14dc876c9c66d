//! Folds inside each other as blocks inside each other, up to a depth: a deeper one becomes a
//! function of its own, so text of any graph nests no deeper than shader compilers take.

use crate::graph::regions::{MAX_DEPTH, Weights};
use crate::graph::{Builder, Fold, Function, FunctionId, Graph, Operation, Value};
use smol_str::{SmolStr, format_smolstr};
use std::borrow::Cow;

/// The blocks of a fold that stays where it is; the rest of [`MAX_DEPTH`] is left to branches.
const MAX_LOOPS: u32 = MAX_DEPTH / 2;

/// The graph with the folds that nest too deep called instead; mostly it stays as it is.
pub fn outlined(graph: &Graph) -> Cow<'_, Graph> {
    let weights = Weights::of(graph);
    let mut operations = graph.functions.iter().flat_map(|function| &function.values);
    if !operations.any(|operation| weights.loops_of(operation) > MAX_LOOPS) {
        return Cow::Borrowed(graph);
    }
    let mut outlining = Outlining::default();
    for function in &graph.functions {
        outlining.function(function);
    }
    Cow::Owned(Graph { functions: outlining.functions, ..graph.clone() })
}

/// A graph in the making.
#[derive(Default)]
struct Outlining {
    functions: Vec<Function>,
    weights: Weights,
    /// For each function of the graph that was, its number in this one.
    ids: Vec<FunctionId>,
}

impl Outlining {
    fn function(&mut self, function: &Function) {
        let mut copy = Function { origin: None, ..function.clone() };
        for operation in &mut copy.values {
            match operation {
                Operation::Call(callee, _) => *callee = self.ids[callee.0 as usize],
                Operation::Fold(fold) => {
                    fold.body = self.ids[fold.body.0 as usize];
                    fold.condition = fold.condition.map(|condition| self.ids[condition.0 as usize]);
                }
                _ => {}
            }
            if self.weights.loops_of(operation) >= MAX_LOOPS
                && let Operation::Fold(fold) = operation
            {
                *operation = self.called(function, fold);
            }
        }
        let id = self.add(copy);
        self.ids.push(id);
    }

    fn add(&mut self, function: Function) -> FunctionId {
        self.weights.add(&function);
        self.functions.push(function);
        FunctionId(self.functions.len() as u32 - 1)
    }

    /// The call of a function that is nothing but a fold over its inputs.
    fn called(&mut self, around: &Function, fold: &Fold) -> Operation {
        let mut builder = Builder::new(format_smolstr!("{}_fold", around.name));
        let step = &self.functions[fold.body.0 as usize];
        let places = fold.starts.len();
        // The step takes the accumulators, its number, the captures; the fold the starts, the
        // number of steps, the captures.
        let names: Vec<SmolStr> = step.inputs.iter().map(|slot| slot.name.clone()).collect();
        let mut operands: Vec<Value> = Vec::new();
        let inner = fold.map_operands(|operand| {
            let name = names.get(operands.len()).filter(|_| operands.len() != places);
            let name = name.map_or("steps", SmolStr::as_str);
            operands.push(operand);
            builder.input(name, around.ty(operand))
        });
        let outputs: Vec<SmolStr> = step.outputs.iter().map(|(slot, _)| slot.name.clone()).collect();
        let accumulators = builder.fold(inner);
        outputs.into_iter().zip(accumulators).for_each(|(name, value)| builder.output(name, value));
        Operation::Call(self.add(builder.finish()), operands.as_slice().into())
    }
}
