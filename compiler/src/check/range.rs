//! The range of a fold: how many steps there are, how many there can be at most, and where in the
//! range a step stands.
//!
//! A fold counts one int from 0. A box of several components is run through first component
//! fastest, so the place of step s is (s mod c₀, s / c₀ mod c₁, …) from the start on.

use super::{Checker, Frame, types};
use crate::diagnostic::{Place, folds, limits, types as errors};
use crate::graph::bounds::Bounds;
use crate::graph::{Builder, Constant, Operation, Scalar, Value};
use crate::intrinsic::{
    ADD_INT, CHOOSE_INT, COMPONENT_LESS_INT, DIVIDE_INT, EQUAL_INT, GREATER_INT, MAXIMUM_INT, MINIMUM_INT,
    MULTIPLY_INT, RAW_DIVIDE_INT, REMAINDER_INT, SUBTRACT_INT,
};
use texgraph_grammar::syntax::{Expr, Fold};

/// A fold's range as values of the function that holds the fold.
pub struct Steps {
    /// The first place, ints.
    low: Value,
    /// How many places there are along each component, ints, none negative.
    counts: Vec<Value>,
    /// How many steps there are, an int.
    pub steps: Value,
    /// The most steps.
    pub most: u32,
}

/// How deep bounds are looked for.
const MAX_DEPTH: u32 = 64;

impl<'a> Checker<'a> {
    /// The steps of a fold. None when its range is wrong (reported) or waits.
    pub(super) fn steps(&mut self, f: &mut Frame<'a>, fold: &'a Fold, place: Place) -> Option<Steps> {
        let start = self.end_of_range(f, &fold.range.start);
        let end = self.end_of_range(f, &fold.range.end);
        let max = fold.max.as_ref().map(|max| self.max_steps(f, max));
        let (start, end) = (start?, end?);
        let max = match max {
            Some(max) => Some(max?),
            None => None,
        };
        let width = self.common_width(f, fold, [start, end])?;
        let low = f.builder.splat(start, width);
        let end = f.builder.splat(end, width);
        let mut most: u64 = 1;
        let mut counts = Vec::new();
        for i in 0..width {
            let (count, bound) = self.count(f, low, end, i, fold.range.inclusive, max);
            let Some(bound) = bound.or(max.map(u64::from)) else {
                let at = self.place(f, fold.range.span);
                self.report(f, folds::range_unbounded(at));
                return None;
            };
            most = most.saturating_mul(bound);
            counts.push(count);
        }
        let most = max.map_or(most, |max| most.min(u64::from(max)));
        if most > u64::from(limits::MAX_STEPS) {
            let name = f.function_name();
            self.report(f, folds::too_many_steps(place, &name, most));
            return None;
        }
        let steps = total(&mut f.builder, &counts, max);
        Some(Steps { low, counts, steps, most: most as u32 })
    }

    fn end_of_range(&mut self, f: &mut Frame<'a>, end: &'a Expr) -> Option<Value> {
        let at = self.place(f, end.span);
        let wire = self.expr(f, end);
        let value = self.value(f, &wire, at)?;
        let ty = f.builder.ty(value);
        if ty.scalar() != Some(Scalar::Int) {
            self.report(f, errors::mismatch(at, None, "int", &types::name(ty)));
            return None;
        }
        Some(value)
    }

    fn max_steps(&mut self, f: &mut Frame<'a>, max: &'a Expr) -> Option<u32> {
        let at = self.place(f, max.span);
        let wire = self.expr(f, max);
        let value = self.coerce_value(f, &wire, Scalar::Int, 1, at)?;
        let most = f.builder.as_constant(value).and_then(|c| u32::try_from(c.int(0)).ok());
        if most.is_none() {
            self.report(f, folds::max_not_constant(at));
        }
        most
    }

    fn common_width(&mut self, f: &mut Frame<'a>, fold: &Fold, ends: [Value; 2]) -> Option<u8> {
        let [start, end] = ends.map(|value| f.builder.ty(value).width());
        if start > 1 && end > 1 && start != end {
            let [first, second] = [&fold.range.start, &fold.range.end].map(|end| self.place(f, end.span));
            self.report(f, errors::widths_differ(second, start, end, first));
            return None;
        }
        Some(start.max(end))
    }

    /// How many places there are along a component, and how many at most, if that can be told.
    fn count(
        &mut self,
        f: &mut Frame<'a>,
        low: Value,
        end: Value,
        i: u8,
        inclusive: bool,
        max: Option<u32>,
    ) -> (Value, Option<u64>) {
        let level = f.layers.len();
        let (from, to) = (self.bounds(f, level, low, i, 0), self.bounds(f, level, end, i, 0));
        let one = i64::from(inclusive);
        let longest = (to.high - from.low + one).max(0);
        let fits = longest <= i64::from(i32::MAX) && to.low - from.high >= i64::from(i32::MIN);
        let (low, end) = (f.builder.extract(low, i), f.builder.extract(end, i));
        let b = &mut f.builder;
        let (zero, one) = (int(b, 0), int(b, i32::from(inclusive)));
        let span = b.builtin(SUBTRACT_INT, &[end, low]);
        let bounded = from != Bounds::ANY && to != Bounds::ANY || longest <= i64::from(limits::MAX_STEPS);
        if fits {
            let length = b.builtin(ADD_INT, &[span, one]);
            let never_short = to.low - from.high + i64::from(inclusive) >= 0;
            let count = if never_short { length } else { b.builtin(MAXIMUM_INT, &[length, zero]) };
            return (count, bounded.then_some(longest as u64));
        }
        // The difference may wrap: what is longer than an int can tell has at least `max` places.
        let cap = int(b, max.and_then(|max| i32::try_from(max).ok()).unwrap_or(i32::MAX - 1));
        let wrapped = b.builtin(COMPONENT_LESS_INT, &[span, zero]);
        let short = b.builtin(MINIMUM_INT, &[span, cap]);
        let span = b.builtin(CHOOSE_INT, &[wrapped, cap, short]);
        let length = b.builtin(ADD_INT, &[span, one]);
        let empty = b.builtin(GREATER_INT, &[low, end]);
        (b.builtin(CHOOSE_INT, &[empty, zero, length]), None)
    }

    /// What a component of an int value may be, as far as its operations tell.
    fn bounds(&self, f: &Frame<'a>, level: usize, value: Value, i: u8, depth: u32) -> Bounds {
        let builder = f.builder_of(level);
        let component = usize::from(i.min(builder.ty(value).width().saturating_sub(1)));
        if depth > MAX_DEPTH {
            return Bounds::ANY;
        }
        match builder.operation(value) {
            Operation::Param(id) => match self.params.get(id.0 as usize).and_then(|param| param.range) {
                Some((low, high)) if low.scalar() == Scalar::Int => {
                    Bounds { low: low.int(component).into(), high: high.int(component).into() }.without_wrap()
                }
                _ => Bounds::ANY,
            },
            Operation::Input(n) => {
                let own = builder.function().inputs.len();
                let Some(layer) = level.checked_sub(1).and_then(|outer| f.layers.get(outer)) else {
                    return Bounds::ANY;
                };
                let first = own - layer.captures.len().min(own);
                match (*n as usize).checked_sub(first).and_then(|n| layer.captures.get(n)) {
                    Some(outer) => self.bounds(f, level - 1, *outer, i, depth + 1),
                    None => Bounds::ANY,
                }
            }
            operation => {
                Bounds::of(operation, component as u8, |v, i| self.bounds(f, level, v, i, depth + 1))
            }
        }
    }
}

fn int(b: &mut Builder, n: i32) -> Value {
    b.constant(Constant::ints(&[n]))
}

/// The product of the counts; with `max` that many at most, whatever the product.
fn total(b: &mut Builder, counts: &[Value], max: Option<u32>) -> Value {
    let mut counts = counts.iter();
    let mut total = counts.next().copied().unwrap_or_else(|| int(b, 0));
    let cap = max.map(|max| int(b, i32::try_from(max).unwrap_or(i32::MAX)));
    if let Some(cap) = cap {
        total = b.builtin(MINIMUM_INT, &[total, cap]);
    }
    for count in counts {
        let product = b.builtin(MULTIPLY_INT, &[total, *count]);
        total = match cap {
            None => product,
            Some(cap) => {
                // total · count would pass the most: it is not even multiplied.
                let room = b.builtin(DIVIDE_INT, &[cap, *count]);
                let beyond = b.builtin(GREATER_INT, &[total, room]);
                let zero = int(b, 0);
                let empty = b.builtin(EQUAL_INT, &[*count, zero]);
                let capped = b.select(beyond, cap, product);
                b.select(empty, zero, capped)
            }
        };
    }
    total
}

impl Steps {
    /// Whether the number of a step is its place.
    pub(super) fn are_places(&self, f: &Frame<'_>) -> bool {
        let outer = f.builder_of(f.layers.len().saturating_sub(1));
        self.counts.len() == 1 && outer.as_constant(self.low).is_some_and(|low| low.int(0) == 0)
    }

    /// The place of a step, ints, in the function of the fold's body.
    pub(super) fn place_of(&self, f: &mut Frame<'_>, step: Value) -> Value {
        let level = f.layers.len().saturating_sub(1);
        let low = f.capture(level, self.low);
        let mut rest = step;
        let mut parts = Vec::new();
        for (i, count) in self.counts.iter().enumerate() {
            if i + 1 == self.counts.len() {
                parts.push(rest);
                break;
            }
            let count = f.capture(level, *count);
            let (quotient, part) = divide(&mut f.builder, rest, count);
            parts.push(part);
            rest = quotient;
        }
        let offset = f.builder.compose(&parts);
        f.builder.builtin(ADD_INT, &[low, offset])
    }
}

/// Quotient and rest of two ints, the first not negative, the second not 0 where this runs.
fn divide(b: &mut Builder, a: Value, count: Value) -> (Value, Value) {
    let power = b.as_constant(count).is_some_and(|c| c.int(0) > 0 && (c.int(0) as u32).is_power_of_two());
    if power {
        return (b.builtin(DIVIDE_INT, &[a, count]), b.builtin(REMAINDER_INT, &[a, count]));
    }
    // A constant count of 0 must not reach a division, though no step divides by it.
    let one = int(b, 1);
    let divisor = b.builtin(MAXIMUM_INT, &[count, one]);
    let quotient = b.builtin(RAW_DIVIDE_INT, &[a, divisor]);
    let product = b.builtin(MULTIPLY_INT, &[quotient, divisor]);
    (quotient, b.builtin(SUBTRACT_INT, &[a, product]))
}
