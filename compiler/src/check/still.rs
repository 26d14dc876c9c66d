//! Warnings of derivatives that are 0 everywhere.

use super::arguments::Given;
use super::head::Head;
use super::wire::Wire;
use super::{Checker, Frame};
use crate::diagnostic::filtering;
use crate::graph::{Function, Operation, Value};
use crate::intrinsic::{Derivative, HASH, HASH4};
use crate::library::Callable;
use rustc_hash::FxHashSet;

/// Nodes of the library that take the footprint of their first input, unless the other is given.
const MEASURES: [(&str, &str); 2] = [("footprint", ""), ("coverage", "width")];

/// Values looked at; of what is made of more nothing is said.
const MOST_VALUES: usize = 1_000;

impl<'a> Checker<'a> {
    /// Warns of a call that measures how its argument changes, where that does not.
    pub(super) fn warn_of_call(
        &mut self,
        f: &Frame<'a>,
        callable: Callable,
        head: &Head<'a>,
        given: &[Given<'a>],
    ) {
        let library = self.library.modules().len();
        let (Callable::Node(module, _), [of, others @ ..]) = (callable, given) else { return };
        if module >= library || f.module < library {
            return;
        }
        let Some((name, width)) = MEASURES.iter().find(|(name, _)| *name == head.name) else { return };
        if width.is_empty() || others.is_empty() {
            self.warn_if_still(f, name, of);
        }
    }

    /// Warns where a value that a user's file differentiates is the same in all pixels but for jumps.
    pub(super) fn warn_if_still(&mut self, f: &Frame<'a>, name: &str, of: &Given<'a>) {
        if let Wire::Value(value) = of.wire
            && f.module >= self.library.modules().len()
            && jumps(f.builder.function(), value)
        {
            self.warnings.push(filtering::footprint_of_nothing(of.place, name));
        }
    }
}

/// Whether a value comes from lookups and hashes, and nothing that it is made of changes smoothly.
fn jumps(function: &Function, value: Value) -> bool {
    let mut seen = FxHashSet::default();
    let mut pending = vec![value];
    let mut is_looked_up = false;
    while let Some(value) = pending.pop() {
        if !seen.insert(value) {
            continue;
        }
        if seen.len() > MOST_VALUES {
            return false;
        }
        match function.operation(value) {
            Operation::Texel { .. } | Operation::Lookup(..) => is_looked_up = true,
            Operation::Builtin(intrinsic, arguments) => match intrinsic.row().derivative {
                Derivative::Zero => is_looked_up |= matches!(*intrinsic, HASH | HASH4),
                Derivative::Rule(_) => pending.extend(arguments.iter()),
            },
            operation @ (Operation::Compose(_) | Operation::Extract(..)) => {
                operation.for_operands(|v| pending.push(v));
            }
            Operation::Select(_, yes, no) => pending.extend([*yes, *no]),
            Operation::Constant(_) | Operation::Param(_) | Operation::Size(_) => {}
            _ if !function.ty(value).is_float() => {}
            _ => return false,
        }
    }
    is_looked_up
}
