//! What stands in a block, and the branches in it.
//!
//! A value gets a name in the text if the author named it, if it is used twice, or when its unnamed
//! nest would grow too deep (see `frame`); any other is written where it is used.

use super::Lowering;
use super::body::{Body, Variable};
use super::frame::Frame;
use super::operation::literal;
use crate::graph::regions::{Branch, Region};
use crate::graph::{Operation, Value};
use naga::Statement;
use std::rc::Rc;

impl Lowering<'_> {
    /// The numbers that a function needs, before all else: each would part the expressions before
    /// it from those behind.
    pub(super) fn numbers(&mut self, body: &mut Body, frame: &mut Frame) {
        for (value, operation) in frame.function.iter() {
            if let Operation::Constant(constant) = operation
                && frame.is_wanted(value)
            {
                for i in 0..usize::from(constant.width()) {
                    body.literal(literal(constant, i));
                }
            }
        }
    }

    /// Lowers the marked values: they stand at the top, before all others.
    pub(super) fn first(&mut self, body: &mut Body, frame: &mut Frame, marked: &[bool]) {
        let marked = marked.iter().enumerate().filter(|(_, marked)| **marked);
        marked.for_each(|(i, _)| self.value(body, frame, Value(i as u32)));
    }

    /// Lowers what stands right in a region, branches with what is in them.
    pub(super) fn block(&mut self, body: &mut Body, frame: &mut Frame, region: Region) {
        let regions = Rc::clone(&frame.regions);
        for value in regions.values(region) {
            match regions.branch(*value) {
                Some(branch) => self.branch(body, frame, branch),
                None => self.value(body, frame, *value),
            }
        }
    }

    /// Lowers one value and names it where that is called for.
    fn value(&mut self, body: &mut Body, frame: &mut Frame, value: Value) {
        if !frame.is_wanted(value) {
            return;
        }
        let operation = frame.function.operation(value);
        if matches!(operation, Operation::Constant(constant) if constant.width() > 1) {
            // Written out wherever it is used.
            return;
        }
        let handle = self.operation(body, frame, value, operation);
        if frame.set(value, handle) {
            body.name(&mut self.names, handle, frame.name(value));
        }
    }

    /// `if` and `else`: each arm stores to the variables of the choices, which are read afterwards.
    fn branch(&mut self, body: &mut Body, frame: &mut Frame, branch: &Branch) {
        let choices: Vec<Choice> =
            branch.choices.iter().map(|value| self.choice(body, frame, *value)).collect();
        let condition = frame.get(branch.condition);
        let [accept, reject] = [0, 1].map(|arm| {
            body.open();
            self.arm(body, frame, branch.arms[arm], &choices, arm);
            body.close()
        });
        body.statement(Statement::If { condition, accept, reject });
        for choice in choices {
            let chosen = body.load(&mut self.names, &choice.variable);
            frame.set_variable(choice.value, chosen);
        }
    }

    fn choice(&mut self, body: &mut Body, frame: &mut Frame, value: Value) -> Choice {
        let operation = frame.function.operation(value);
        let Operation::Select(_, yes, no) = operation else { unreachable!("a branch makes choices") };
        let ty = self.types.get(&mut self.module.types, frame.function.ty(value));
        let target = frame.targets.remove(&value);
        let variable = target.unwrap_or_else(|| body.variable(&mut self.names, frame.name(value), ty));
        Choice { value, arms: [*yes, *no], variable }
    }

    /// One arm of a branch. A choice that is made in it for nothing but another choice is made
    /// right in that one's variable.
    fn arm(&mut self, body: &mut Body, frame: &mut Frame, region: Region, choices: &[Choice], arm: usize) {
        let regions = Rc::clone(&frame.regions);
        let inner = |frame: &Frame, value: Value| {
            regions.place(value) == Some(region)
                && regions.branch(value).is_some()
                && frame.is_used_once(value)
                && frame.author(value).is_none()
        };
        for choice in choices {
            let value = choice.arms[arm];
            if inner(frame, value) {
                frame.targets.insert(value, choice.variable.clone());
            }
        }
        self.block(body, frame, region);
        for choice in choices {
            let value = choice.arms[arm];
            if !inner(frame, value) {
                let value = self.operand(body, frame, value);
                body.store(&choice.variable, value);
            }
        }
    }
}

/// A choice of a branch that is being lowered.
struct Choice {
    value: Value,
    arms: [Value; 2],
    variable: Variable,
}
