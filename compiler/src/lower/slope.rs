//! Derivatives of scaled inputs: the slope of a place times a number that is the same for a whole draw
//! is the slope of the product, which is there anyway. Where nothing else reads the place's own slope,
//! the multiplication is saved, as it is when one writes it by hand. Only for the gradients of samples,
//! whose levels do not see how the last bit was rounded.

use crate::graph::regions::Regions;
use crate::graph::{Axis, Function, Level, Operation, Value};
use crate::intrinsic::MULTIPLY;

/// A product that is the slope of another.
#[derive(Clone, Copy)]
pub struct Slope {
    /// The product of a derivative.
    pub value: Value,
    /// The product whose derivative it is.
    pub product: Value,
    /// Along which axis.
    pub axis: Axis,
    /// The derivative that is not needed, and the number that it is scaled by.
    pub factors: [Value; 2],
}

/// The slopes of an entry; few, as each has a derivative of its own. Both products stand at the top,
/// where derivatives may be taken. `per_draw` marks what is the same for a whole draw, `uses` tells how
/// often values are written.
pub fn slopes(function: &Function, regions: &Regions, per_draw: &[bool], uses: &[u32]) -> Vec<Slope> {
    let derivatives = function.iter().filter_map(|(value, operation)| match operation {
        Operation::Derivative(of, axis, _) if uses[value.0 as usize] == 1 => Some((value, *of, *axis)),
        _ => None,
    });
    let is_per_draw = |value: Value| {
        per_draw.get(value.0 as usize) == Some(&true)
            || matches!(function.operation(value), Operation::Constant(_))
    };
    let slope = |(derivative, of, axis)| {
        let (value, scale) = products(function).find_map(|(value, factors)| match factors {
            [a, b] if a == derivative => Some((value, b)),
            [a, b] if b == derivative => Some((value, a)),
            _ => None,
        })?;
        let (product, _) =
            products(function).find(|(_, factors)| [[of, scale], [scale, of]].contains(factors))?;
        let is_written = uses[product.0 as usize] > 0 && uses[value.0 as usize] > 0;
        let are_at_top = regions.is_at_top(value) && regions.is_at_top(product);
        let fits = is_written && are_at_top && product < value && is_per_draw(scale);
        let fits = fits && is_gradient(function, value);
        fits.then_some(Slope { value, product, axis, factors: [derivative, scale] })
    };
    derivatives.filter_map(slope).collect()
}

/// Whether nothing but samples reads a value, as their gradient.
fn is_gradient(function: &Function, value: Value) -> bool {
    let is_fine = |operation: &Operation| {
        let mut is_read = false;
        operation.for_operands(|v| is_read |= v == value);
        !is_read || matches!(operation, Operation::Sample { level: Level::Gradient(..), .. })
    };
    function.values.iter().all(is_fine) && function.outputs.iter().all(|(_, output)| *output != value)
}

/// Products of floats with their factors.
fn products(function: &Function) -> impl Iterator<Item = (Value, [Value; 2])> {
    function.iter().filter_map(|(value, operation)| match operation {
        Operation::Builtin(MULTIPLY, factors) => Some((value, [factors[0], factors[1]])),
        _ => None,
    })
}
