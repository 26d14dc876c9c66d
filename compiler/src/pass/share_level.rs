//! Samples of one picture with one gradient share one level of detail, worked out once.
//!
//! A driver finds the level of each sample by itself, from the gradient: two products with the size, two
//! squared lengths, a logarithm. Where a function samples a picture twice with equal gradients, or a loop
//! samples one with a gradient that no step changes, the level is a value like any other here, and
//! `hoist` takes it out of loops.
//!
//! ρ is the longer of the gradients in texels, the level log2 ρ (WebGPU, *texture sampling*; OpenGL 4.6,
//! 8.14.1). What is magnified is of level 0.

use super::hoist::fixed;
use crate::graph::{Builder, Constant, Function, Graph, Level, Operation, Type, Value};
use crate::intrinsic::{DOT, MAXIMUM, MULTIPLY, RAW_LOG2};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// A picture and a gradient.
type Key = [Value; 3];

/// Works out shared levels once, after differentiation.
pub fn run(mut graph: Graph) -> Graph {
    let carried = carried(&graph);
    let functions = graph.functions.iter_mut().zip(carried);
    // The library's have been here before.
    for (function, carried) in functions.filter(|(function, _)| function.origin.is_none()) {
        let shared = shared(function, carried);
        if !shared.is_empty() {
            *function = Sharing::new(function, shared).run();
        }
    }
    graph
}

/// The same for every sample, shared or not: adapters may take other levels than the definition's, as
/// software drivers do. All functions are this graph's own then, the library's too.
pub fn everywhere(mut graph: Graph) -> Graph {
    for function in &mut graph.functions {
        let keys = function.values.iter().filter_map(|operation| key(function, operation));
        let levels = keys.map(|key| (key, None)).collect();
        *function = Sharing::new(function, levels).run();
    }
    graph
}

/// For the body of each loop how many inputs change from step to step.
fn carried(graph: &Graph) -> Vec<Option<usize>> {
    let mut carried = vec![None; graph.functions.len()];
    for operation in graph.functions.iter().flat_map(|function| &function.values) {
        if let Operation::Fold(fold) = operation {
            carried[fold.body.0 as usize] = Some(fold.starts.len() + 1);
        }
    }
    carried
}

/// Anisotropic samples need their gradient.
fn key(function: &Function, operation: &Operation) -> Option<Key> {
    match operation {
        Operation::Sample { view, level: Level::Gradient(x, y), .. } => match function.ty(*view) {
            Type::View(kind) if kind.anisotropy > 1 => None,
            _ => Some([*view, *x, *y]),
        },
        _ => None,
    }
}

/// The pictures and gradients whose level is worth a value, none of them known yet.
fn shared(function: &Function, carried: Option<usize>) -> FxHashMap<Key, Option<Value>> {
    let mut often: FxHashMap<Key, u32> = FxHashMap::default();
    let keys = function.values.iter().filter_map(|operation| key(function, operation));
    keys.for_each(|key| *often.entry(key).or_default() += 1);
    if often.is_empty() {
        return FxHashMap::default();
    }
    let steady = carried.map(|carried| {
        let inputs: Vec<bool> = (0..function.inputs.len()).map(|i| i >= carried).collect();
        fixed(function, &inputs)
    });
    let is_steady =
        |key: &Key| steady.as_ref().is_some_and(|steady| key.iter().all(|v| steady[v.0 as usize]));
    let worth = often.into_iter().filter(|(key, often)| *often > 1 || is_steady(key));
    worth.map(|(key, _)| (key, None)).collect()
}

/// A function being made anew.
struct Sharing<'a> {
    function: &'a Function,
    /// The level for each picture and gradient, once it is known.
    levels: FxHashMap<Key, Option<Value>>,
    builder: Builder,
    values: Vec<Value>,
}

impl<'a> Sharing<'a> {
    fn new(function: &'a Function, levels: FxHashMap<Key, Option<Value>>) -> Sharing<'a> {
        let mut builder = Builder::with_capacity(function.name.clone(), function.values.len());
        builder.set_expands(true);
        Sharing { function, levels, builder, values: Vec::with_capacity(function.values.len()) }
    }

    fn run(mut self) -> Function {
        let function = self.function;
        let inputs: Vec<Value> =
            function.inputs.iter().map(|slot| self.builder.input(slot.name.clone(), slot.ty)).collect();
        for (old, operation) in function.iter() {
            self.builder.set_place(function.places[old.0 as usize]);
            let value = match operation {
                Operation::Input(i) => inputs.get(*i as usize).copied().unwrap_or(Value(0)),
                _ => {
                    let level = key(function, operation).and_then(|key| self.level(key));
                    let mut copy = operation.map_operands(|v| self.values[v.0 as usize]);
                    if let (Some(shared), Operation::Sample { level, .. }) = (level, &mut copy) {
                        *level = Level::Level(shared);
                    }
                    self.builder.push(copy, function.ty(old))
                }
            };
            self.values.push(value);
            if let Some(name) = function.names.get(old) {
                self.builder.name(value, Arc::clone(name));
            }
        }
        for (slot, value) in &function.outputs {
            self.builder.output(slot.name.clone(), self.values[value.0 as usize]);
        }
        self.builder.finish()
    }

    /// The level of a picture and a gradient, if it is shared.
    fn level(&mut self, key: Key) -> Option<Value> {
        if let Some(level) = *self.levels.get(&key)? {
            return Some(level);
        }
        let [view, x, y] = key.map(|v| self.values[v.0 as usize]);
        let b = &mut self.builder;
        let size = b.size(view);
        let size = b.to_float(size);
        let [x, y] = [x, y].map(|gradient| {
            let texels = b.builtin(MULTIPLY, &[gradient, size]);
            b.builtin(DOT, &[texels, texels])
        });
        let longer = b.builtin(MAXIMUM, &[x, y]);
        let one = b.constant(Constant::floats(&[1.0]));
        let longer = b.builtin(MAXIMUM, &[longer, one]);
        let octaves = b.builtin(RAW_LOG2, &[longer]);
        let half = b.constant(Constant::floats(&[0.5]));
        let level = b.builtin(MULTIPLY, &[octaves, half]);
        b.name(level, "level");
        self.levels.insert(key, Some(level));
        Some(level)
    }
}
