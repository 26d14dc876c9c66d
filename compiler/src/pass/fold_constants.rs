//! Constant folding and the few identities that always pay, applied as values are made.
//!
//! What has known operands becomes a number, by the row that defines it. Multiplication by 0 may
//! fold because values are numbers: what overflows has no defined value.

use crate::graph::bounds::Bounds;
use crate::graph::{Constant, Function, Operation, Scalar, Value};
use crate::intrinsic::{
    ADD, ADD_INT, AND, CHOOSE, CHOOSE_INT, DIVIDE, FLOOR, Intrinsic, LESS_INT, MAXIMUM_INT, MINIMUM_INT,
    MULTIPLY, MULTIPLY_INT, NEGATE, OR, RAW_DIVIDE, SUBTRACT, SUBTRACT_INT,
};
use smallvec::SmallVec;

/// What an operation folds to.
pub enum Folded {
    /// A value that is there already.
    Value(Value),
    /// A simpler operation of the same type.
    Operation(Operation),
}

/// What an operation over values of `function` folds to, if it does.
pub fn fold(function: &Function, operation: &Operation) -> Option<Folded> {
    match operation {
        Operation::Builtin(intrinsic, arguments) => match all_known(function, arguments) {
            Some(known) => Some(Folded::Operation(Operation::Constant(intrinsic.evaluate(&known)))),
            None => identity(function, *intrinsic, arguments),
        },
        Operation::Compose(parts) => compose(function, parts),
        Operation::Extract(vector, i) => extract(function, *vector, *i),
        Operation::Lookup(table, index) => {
            let last = table.len().saturating_sub(1);
            let entry = usize::try_from(known(function, *index)?.int(0)).unwrap_or(0).min(last);
            table.get(entry).map(|entry| Folded::Operation(Operation::Constant(*entry)))
        }
        Operation::Select(condition, yes, no) if yes == no || known(function, *condition).is_some() => {
            let holds = known(function, *condition).is_none_or(|c| c.bool(0));
            Some(Folded::Value(if holds { *yes } else { *no }))
        }
        Operation::Output(of, i) => match function.operation(*of) {
            Operation::Fold(f) if f.most == 0 || known(function, f.steps).is_some_and(|c| c.int(0) <= 0) => {
                f.starts.get(*i as usize).map(|start| Folded::Value(*start))
            }
            _ => None,
        },
        _ => None,
    }
}

/// The numbers of all of these values, if all are known.
fn all_known(function: &Function, values: &[Value]) -> Option<SmallVec<[Constant; 4]>> {
    // Mostly one is not: that is found out first.
    let is_known = |v: &Value| matches!(function.operation(*v), Operation::Constant(_));
    values.iter().all(is_known).then(|| values.iter().filter_map(|v| known(function, *v)).collect())
}

fn known(function: &Function, value: Value) -> Option<Constant> {
    match function.operation(value) {
        Operation::Constant(c) => Some(*c),
        _ => None,
    }
}

/// Whether a value is this number in every component.
fn is(function: &Function, value: Value, number: i32) -> bool {
    known(function, value).is_some_and(|c| {
        (0..usize::from(c.width())).all(|i| match c.scalar() {
            Scalar::Float => c.float(i) == number as f32,
            Scalar::Int | Scalar::Bool => c.int(i) == number,
        })
    })
}

fn identity(function: &Function, intrinsic: Intrinsic, arguments: &[Value]) -> Option<Folded> {
    let is = |i: usize, number: i32| arguments.get(i).is_some_and(|v| is(function, *v, number));
    let keep = |i: usize| Some(Folded::Value(arguments[i]));
    match intrinsic {
        ADD | ADD_INT if is(0, 0) => keep(1),
        ADD | ADD_INT | SUBTRACT | SUBTRACT_INT if is(1, 0) => keep(0),
        SUBTRACT if is(0, 0) => {
            Some(Folded::Operation(Operation::Builtin(NEGATE, [arguments[1]].as_slice().into())))
        }
        MULTIPLY | MULTIPLY_INT if is(0, 0) || is(1, 1) => keep(0),
        MULTIPLY | MULTIPLY_INT if is(1, 0) || is(0, 1) => keep(1),
        DIVIDE | RAW_DIVIDE if is(0, 0) || is(1, 1) => keep(0),
        NEGATE => match function.operation(arguments[0]) {
            Operation::Builtin(NEGATE, inner) => Some(Folded::Value(inner[0])),
            _ => None,
        },
        FLOOR => match function.operation(arguments[0]) {
            Operation::Builtin(FLOOR, _) => keep(0),
            _ => None,
        },
        AND if is(0, 1) || is(1, 0) => keep(1),
        AND if is(1, 1) || is(0, 0) => keep(0),
        OR if is(0, 0) || is(1, 1) => keep(1),
        OR if is(1, 0) || is(0, 1) => keep(0),
        CHOOSE | CHOOSE_INT => choose(function, arguments),
        MINIMUM_INT | MAXIMUM_INT => clamped(function, intrinsic, arguments),
        LESS_INT => below(function, arguments),
        _ => None,
    }
}

/// A choice that is the same in every component, or has no choice.
fn choose(function: &Function, arguments: &[Value]) -> Option<Folded> {
    let &[condition, yes, no] = arguments else { return None };
    if yes == no || is(function, condition, 1) {
        return Some(Folded::Value(yes));
    }
    is(function, condition, 0).then_some(Folded::Value(no))
}

/// The lesser or the greater of a value and a number that it never passes is the value.
fn clamped(function: &Function, intrinsic: Intrinsic, arguments: &[Value]) -> Option<Folded> {
    let &[value, bound] = arguments else { return None };
    let bound = known(function, bound)?;
    let never_passes = (0..bound.width()).all(|i| {
        let (bounds, bound) = (Bounds::within(function, value, i), i64::from(bound.int(usize::from(i))));
        if intrinsic == MINIMUM_INT { bounds.high <= bound } else { bounds.low >= bound }
    });
    never_passes.then_some(Folded::Value(value))
}

/// Whether an int is below another, where the bounds of both tell.
fn below(function: &Function, arguments: &[Value]) -> Option<Folded> {
    let &[a, b] = arguments else { return None };
    let (a, b) = (Bounds::within(function, a, 0), Bounds::within(function, b, 0));
    let known = if a.high < b.low { Some(true) } else { (a.low >= b.high).then_some(false) };
    known.map(|holds| Folded::Operation(Operation::Constant(Constant::bools(&[holds]))))
}

fn compose(function: &Function, parts: &[Value]) -> Option<Folded> {
    if let Some(numbers) = all_known(function, parts) {
        let scalar = numbers.first()?.scalar();
        let whole = Constant::new(scalar, numbers.iter().map(|c| c.bits()[0]));
        return Some(Folded::Operation(Operation::Constant(whole)));
    }
    // All components of one vector in order: the vector itself.
    let Operation::Extract(vector, 0) = function.operation(*parts.first()?) else { return None };
    let whole = usize::from(function.ty(*vector).width()) == parts.len()
        && parts
            .iter()
            .enumerate()
            .all(|(i, v)| *function.operation(*v) == Operation::Extract(*vector, i as u8));
    whole.then_some(Folded::Value(*vector))
}

fn extract(function: &Function, vector: Value, i: u8) -> Option<Folded> {
    match function.operation(vector) {
        Operation::Constant(c) => Some(Folded::Operation(Operation::Constant(c.component(usize::from(i))))),
        Operation::Compose(parts) => parts.get(usize::from(i)).map(|v| Folded::Value(*v)),
        _ => None,
    }
}
