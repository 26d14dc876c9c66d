//! Folds: a body that runs again until no lane is in the loop.

use super::super::mask::{above, choose, spread};
use super::super::plan::{Loop, Planned, Register, Step};
use super::{Code, Machine, Role};
use texgraph_compiler::intrinsic::{LANES, ZERO};

impl Machine {
    /// Begins a fold.
    pub(super) fn fold(&mut self, code: Code<'_>, planned: &Planned, base: usize, fold: &Loop) {
        let inside = base + planned.size;
        if self.enter(code, fold.body, inside, Role::Body(0)) {
            let number = [&Register::ZERO];
            let inputs = fold.starts.iter().chain(number).chain(&fold.captures).chain([&fold.steps]);
            for (from, to) in inputs.zip(inside..) {
                self.memory.copy(code.known, base, *from, to);
            }
            self.turn(code, fold);
        }
    }

    /// Begins the next step of the innermost fold, by its condition if it has one; or ends the fold.
    pub(super) fn turn(&mut self, code: Code<'_>, fold: &Loop) {
        let Some(frame) = self.frames.last_mut() else { return };
        let Role::Body(step) = frame.role else { return };
        let (base, number) = (frame.base, fold.starts.len() as u32);
        frame.next = 0;
        let steps = Register::Frame(number + 1 + fold.captures.len() as u32);
        let left = above(self.memory.read(code.known, base, steps), step);
        self.want(if step < fold.most { self.mask & left } else { 0 });
        if self.mask == 0 {
            return self.end_fold(code, fold);
        }
        self.memory.set(base + number as usize, &[step; LANES]);
        if let Some(condition) = fold.condition {
            self.test(code, condition, base, fold);
        }
    }

    /// Begins the condition of a fold whose body's registers begin at `base`.
    fn test(&mut self, code: Code<'_>, condition: usize, base: usize, fold: &Loop) {
        let Some(body) = code.functions.get(fold.body) else { return };
        let inside = base + body.size;
        if self.enter(code, condition, inside, Role::Condition) {
            let (accumulators, captures) = (fold.starts.len() as u32, fold.captures.len() as u32);
            let inputs = (0..accumulators).chain(accumulators + 1..accumulators + 1 + captures);
            for (from, to) in inputs.zip(inside..) {
                self.memory.copy(code.known, base, Register::Frame(from), to);
            }
        }
    }

    /// The fold that the innermost function is the body of.
    pub(super) fn running<'a>(&self, code: Code<'a>) -> Option<&'a Loop> {
        let outside = self.frames.get(self.frames.len().checked_sub(2)?)?;
        match code.functions.get(outside.function)?.steps.get(outside.next.checked_sub(1)?)? {
            Step::Fold(fold) => Some(fold),
            _ => None,
        }
    }

    /// The outputs of a body become the accumulators in the lanes that are in the loop. An
    /// accumulator without a next value keeps its own.
    pub(super) fn advance(&mut self, code: Code<'_>, body: &Planned, base: usize, fold: &Loop) {
        let inside = spread(self.mask);
        let changed = || {
            let outputs = body.outputs.iter().take(fold.starts.len()).enumerate();
            outputs.map(|(n, to)| (Register::Frame(n as u32), *to)).filter(|(own, to)| own != to)
        };
        self.next.resize(fold.starts.len(), ZERO);
        for ((own, output), next) in changed().zip(&mut self.next) {
            let [last, new] = [own, output].map(|register| self.memory.read(code.known, base, register));
            choose(&inside, new, last, next);
        }
        for ((own, _), next) in changed().zip(&self.next) {
            if let Register::Frame(n) = own {
                self.memory.set(base + n as usize, next);
            }
        }
    }

    /// Ends the innermost fold: its accumulators are its outputs.
    pub(super) fn end_fold(&mut self, code: Code<'_>, fold: &Loop) {
        let Some(frame) = self.frames.pop() else { return };
        self.want(frame.mask);
        let Some(outside) = self.frames.last() else { return };
        for (n, to) in &fold.results {
            if let Register::Frame(to) = to {
                let from = Register::Frame(*n as u32);
                self.memory.copy(code.known, frame.base, from, outside.base + *to as usize);
            }
        }
    }
}
