//! Calls of small functions, and folds of a known number of steps: the caller does their steps itself,
//! so that nothing is copied into another frame and back, and what is known of an argument is known
//! inside.

use super::super::plan::{Loop, Planned, Register, Step};
use super::Planner;
use std::rc::Rc;

/// The most steps of a function that callers take over, ...
const MOST_STEPS: usize = 256;
/// ... and the most that a function may come to by that.
const MOST_TOGETHER: usize = 8192;
/// The most steps that a fold may come to.
const MOST_OF_A_FOLD: usize = 2048;

/// A function's steps, if callers are to take it over.
#[derive(Default)]
pub struct Bodies {
    /// As planned of arithmetic alone, if it may be one step or part of one, ...
    pub plain: Option<Rc<Body>>,
    /// ... and as it came out.
    pub fused: Option<Rc<Body>>,
}

/// A function's steps before they share registers: each register has one value.
pub struct Body {
    steps: Vec<Step>,
    inputs: usize,
    outputs: Vec<Register>,
    registers: usize,
}

impl Body {
    /// Of a function, if callers are to take it over.
    pub fn of(planned: &Planned, registers: usize) -> Option<Rc<Body>> {
        let is_small = planned.steps.len() <= MOST_STEPS;
        is_small.then(|| {
            Rc::new(Body {
                steps: planned.steps.clone(),
                inputs: planned.inputs,
                outputs: planned.outputs.clone(),
                registers,
            })
        })
    }
}

/// Where a function's registers are in its caller.
struct Places(Vec<Register>);

impl Places {
    fn of(&self, register: Register) -> Register {
        match register {
            Register::Known(_) => register,
            // What nothing has written stands in an arm that is never taken.
            Register::Frame(n) => self.0.get(n as usize).copied().unwrap_or(Register::ZERO),
        }
    }

    fn set(&mut self, register: Register, place: Register) {
        if let Register::Frame(n) = register
            && let Some(slot) = self.0.get_mut(n as usize)
        {
            *slot = place;
        }
    }
}

impl Planner<'_> {
    /// What callers take over of a function.
    fn body(&self, function: usize) -> Option<&Rc<Body>> {
        let bodies = self.bodies.get(function)?;
        bodies.plain.as_ref().filter(|_| self.plain).or(bodies.fused.as_ref())
    }

    /// Does a call's steps here; the outputs. None where the function is too long for that.
    pub(super) fn inlined(&mut self, function: usize, arguments: &[Register]) -> Option<Vec<Register>> {
        let body = self.body(function)?.clone();
        if self.planned.steps.len() + body.steps.len() > MOST_TOGETHER {
            return None;
        }
        let mut places = Places(vec![Register::ZERO; body.registers]);
        for (n, argument) in arguments.iter().enumerate().take(body.inputs) {
            places.set(Register::Frame(n as u32), *argument);
        }
        self.take_over(&body.steps, &mut places);
        Some(body.outputs.iter().map(|output| places.of(*output)).collect())
    }

    /// Does all steps of a fold here, which has no condition; its accumulators at the end. None where
    /// their number is not known, or too large for that.
    pub(super) fn unrolled(&mut self, fold: &Loop) -> Option<Vec<Register>> {
        let steps = u32::try_from(self.bits(fold.steps)? as i32).unwrap_or(0).min(fold.most);
        let body = self.body(fold.body)?;
        let together = body.steps.len().saturating_mul(steps as usize);
        if together > MOST_OF_A_FOLD || self.planned.steps.len() + together > MOST_TOGETHER {
            return None;
        }
        let mut accumulators = fold.starts.clone();
        for step in 0..steps {
            let number = [self.number(step)];
            let arguments = [&accumulators[..], &number[..], &fold.captures[..]].concat();
            // One without a next value keeps its own.
            for (own, next) in accumulators.iter_mut().zip(self.inlined(fold.body, &arguments)?) {
                *own = next;
            }
        }
        Some(accumulators)
    }

    /// Adds steps of another function. Arms whose condition is known are taken or left now.
    fn take_over(&mut self, steps: &[Step], places: &mut Places) {
        // Whether the arms around a step are still there, ...
        let mut kept = Vec::new();
        // ... and how many of them are inside one that is never taken, that one included.
        let mut left = 0;
        for step in steps {
            if left > 0 {
                left += usize::from(matches!(step, Step::Arm { .. }));
                left -= usize::from(matches!(step, Step::Join));
                continue;
            }
            let mut step = step.clone();
            step.for_operands(|register| *register = places.of(*register));
            match step {
                Step::Arm { condition, holds, .. } => match self.bits(condition) {
                    Some(bits) if (bits != 0) == holds => kept.push(false),
                    Some(_) => left = 1,
                    None => {
                        kept.push(true);
                        self.planned.steps.push(step);
                    }
                },
                Step::Join => {
                    if kept.pop() == Some(true) {
                        self.planned.steps.push(step);
                    }
                }
                Step::Select { condition, yes, no, to } => {
                    match self.bits(condition) {
                        Some(bits) => places.set(to, if bits != 0 { yes } else { no }),
                        None => self.add(step, places),
                    };
                }
                step => self.add(step, places),
            }
        }
    }

    /// Adds a step with registers of its own for its results, or does it now where it can be.
    fn add(&mut self, mut step: Step, places: &mut Places) {
        let mut known = !matches!(step, Step::Call(_) | Step::Fold(_));
        step.for_operands(|operand| known &= operand.is_known());
        if known {
            let mut results = Vec::new();
            step.retain_targets(|register| {
                results.push(*register);
                true
            });
            for (result, number) in results.iter().zip(self.compute(step, &results)) {
                places.set(*result, number);
            }
        } else {
            step.retain_targets(|register| {
                let own = self.fresh();
                places.set(*register, own);
                *register = own;
                true
            });
            self.planned.steps.push(step);
        }
    }
}
