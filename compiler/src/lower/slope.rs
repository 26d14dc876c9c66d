//! Derivatives of scaled inputs: the slope of a place times a number that is the same for a whole draw
//! is the slope of the product, which is there anyway. Where nothing else reads the place's own slope,
//! the multiplication is saved, as it is when one writes it by hand.

use crate::graph::regions::Regions;
use crate::graph::{Axis, Function, Operation, Value};
use crate::intrinsic::MULTIPLY;
use rustc_hash::FxHashMap;

/// For each product of a slope the product whose slope it is.
pub type Slopes = FxHashMap<Value, (Value, Axis)>;

/// A function being looked through.
struct Looking<'a> {
    function: &'a Function,
    regions: &'a Regions,
    /// Which values are the same for a whole draw.
    per_draw: &'a [bool],
    /// Derivatives, and how often each is read.
    derivatives: FxHashMap<Value, (Value, Axis, u32)>,
    /// Products of what has derivatives, by the factors.
    products: FxHashMap<(Value, Value), Value>,
    slopes: Slopes,
}

/// Those of an entry. Both products stand at the top, where derivatives may be taken.
pub fn slopes(function: &Function, regions: &Regions, per_draw: &[bool]) -> Slopes {
    let derivatives = function.iter().filter_map(|(value, operation)| match operation {
<<<<<<< HEAD
        Operation::Derivative(of, axis, _) => Some((value, (*of, *axis, true))),
=======
        Operation::Derivative(of, axis, _) => Some((value, (*of, *axis, 0))),
>>>>>>> 652e2c5 (One hash of four numbers serves all; slopes of products only where they save something; snapshots)
        _ => None,
    });
    let derivatives: FxHashMap<_, _> = derivatives.collect();
    if derivatives.is_empty() {
        return Slopes::default();
    }
    let (products, slopes) = Default::default();
    let mut looking = Looking { function, regions, per_draw, derivatives, products, slopes };
    function.iter().for_each(|(value, operation)| looking.operation(value, operation));
    function.outputs.iter().for_each(|(_, value)| looking.read(*value));
    let Looking { derivatives, mut slopes, .. } = looking;
    slopes.retain(|value, _| match function.operation(*value) {
        Operation::Builtin(_, factors) => {
            factors.iter().all(|v| derivatives.get(v).is_none_or(|(_, _, reads)| *reads == 1))
        }
        _ => false,
    });
    slopes
}

impl Looking<'_> {
    fn operation(&mut self, value: Value, operation: &Operation) {
        if let Operation::Builtin(MULTIPLY, factors) = operation
            && self.regions.is_at_top(value)
        {
            let [a, b] = [factors[0], factors[1]];
            for (factor, scale) in [(a, b), (b, a)] {
                if !self.is_per_draw(scale) {
                    continue;
                }
                if let Some((of, axis, _)) = self.derivatives.get(&factor) {
                    if let Some(product) = self.products.get(&(*of, scale)) {
                        self.slopes.insert(value, (*product, *axis));
                    }
                } else {
                    self.products.insert((factor, scale), value);
                }
            }
        }
        operation.for_operands(|v| self.read(v));
    }

    fn is_per_draw(&self, value: Value) -> bool {
        self.per_draw.get(value.0 as usize) == Some(&true)
            || matches!(self.function.operation(value), Operation::Constant(_))
    }

    fn read(&mut self, value: Value) {
        if let Some((_, _, reads)) = self.derivatives.get_mut(&value) {
            *reads += 1;
        }
    }
}
