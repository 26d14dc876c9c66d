//! Loops: step by step where there are few, else until nothing changes.

use super::super::{Culprit, Shift, Why};
use super::{Frame, Known, Request, Run, Walk, numbers};
use crate::graph::{Constant, Fold, Function, FunctionId, Value};

/// Loops of more steps are not walked step by step.
const MOST_STEPS: u32 = 128;
/// Nor are loops in loops that take more together.
const MOST_STEPS_TOGETHER: u64 = 8192;
/// Rounds until nothing changes in a loop that is not walked step by step.
const MOST_ROUNDS: u32 = 16;

impl<'a> Walk<'a> {
    pub(super) fn fold(
        &mut self,
        function: &Function,
        frame: &mut Frame,
        value: Value,
        fold: &Fold,
    ) -> Result<Known, Request> {
        let steps = numbers(&frame.values[fold.steps.0 as usize])[0].clone();
        if !steps.repeats() {
            let broken = match self.why_steps_move(&steps) {
                Some(by) => self.broken(function, value, "fold", Why::Moves { by }),
                None => steps,
            };
            return Ok(self.all_broken(function, fold, &broken));
        }
        let known = |v: &Value| frame.values[v.0 as usize].clone();
        let captures: Vec<Known> = fold.captures.iter().map(known).collect();
        let certain = match &steps {
            Shift::Known(steps) => Some(steps.int(0).max(0) as u32),
            _ => None,
        };
        let most = certain.map_or(fold.most, |steps| steps.min(fold.most));
        let together = frame.steps.saturating_mul(most.into());
        let starts = || Run {
            most,
            is_certain: certain.is_some(),
            is_long: most > MOST_STEPS || together > MOST_STEPS_TOGETHER,
            step: 0,
            accumulators: fold.starts.iter().map(known).collect(),
            ended: None,
        };
        let mut run = frame.run.take().unwrap_or_else(starts);
        let result = self.steps(function, value, fold, &captures, &mut run);
        if result.is_err() {
            frame.run = Some(run);
        }
        result
    }

    /// By how much the ends of a loop move: the count of its steps is held to what it may be, so the
    /// culprit may be what the author did not write. None if it is something else.
    pub(super) fn why_steps_move(&self, steps: &Shift) -> Option<String> {
        let Shift::Broken(culprit) = steps else { return Some(steps.show(&self.atoms)) };
        match self.culprits.get(*culprit as usize) {
            Some(Culprit { name, why: Why::Apart { by, .. }, .. })
                if matches!(name.as_str(), "max" | "min") =>
            {
                Some(by.clone())
            }
            _ => None,
        }
    }

    /// All steps of a loop from where it stands.
    pub(super) fn steps(
        &mut self,
        function: &Function,
        value: Value,
        fold: &Fold,
        captures: &[Known],
        run: &mut Run,
    ) -> Result<Known, Request> {
        let is_long = run.is_long;
        let rounds = if is_long { run.most.min(MOST_ROUNDS) } else { run.most };
        while run.step < rounds {
            let goes_on = match fold.condition {
                Some(condition) => self.goes_on(condition, captures, run)?,
                None => Shift::Known(Constant::bools(&[true])),
            };
            match goes_on.truth() {
                Some(false) if is_long => return Ok(Known::Results(run.accumulators.as_slice().into())),
                Some(false) => break,
                Some(true) if run.is_certain => {}
                _ if !goes_on.repeats() => return Ok(self.all_broken(function, fold, &goes_on)),
                _ => {
                    let now = run.accumulators.clone();
                    run.ended = Some(match run.ended.take() {
                        Some(before) => self.joined(function, value, &before, &now),
                        None => now,
                    });
                }
            }
            let number = if is_long { Shift::Same { whole: true } } else { Shift::int(run.step as i32) };
            let number = Known::Numbers([number].into());
            let inputs = run.accumulators.iter().chain([&number]).chain(captures).cloned().collect();
            let next = self.call("fold", fold.body, inputs)?;
            run.step += 1;
            if !is_long {
                run.accumulators = next.to_vec();
                continue;
            }
            let both = self.joined(function, value, &run.accumulators, &next);
            if both == run.accumulators {
                return Ok(Known::Results(both.into()));
            }
            run.accumulators = both;
        }
        if is_long && run.most > rounds {
            let broken = self.broken(function, value, "fold", Why::TooLong);
            return Ok(self.all_broken(function, fold, &broken));
        }
        let last = std::mem::take(&mut run.accumulators);
        Ok(Known::Results(match run.ended.take() {
            Some(before) => self.joined(function, value, &before, &last).into(),
            None => last.into(),
        }))
    }

    /// Whether a loop takes another step.
    pub(super) fn goes_on(
        &mut self,
        condition: FunctionId,
        captures: &[Known],
        run: &Run,
    ) -> Result<Shift, Request> {
        let inputs = run.accumulators.iter().chain(captures).cloned().collect();
        let results = self.call("while", condition, inputs)?;
        Ok(numbers(&results[0])[0].clone())
    }

    /// Accumulators that are the ones or the others.
    pub(super) fn joined(
        &mut self,
        function: &Function,
        value: Value,
        a: &[Known],
        b: &[Known],
    ) -> Vec<Known> {
        let pairs = a.iter().zip(b);
        let joined = pairs.map(|(a, b)| {
            let components = numbers(a).iter().zip(numbers(b)).map(|(a, b)| {
                let either = a.or(b, &self.atoms);
                either.unwrap_or_else(|why| self.broken(function, value, "fold", why))
            });
            Known::Numbers(components.collect())
        });
        joined.collect()
    }

    pub(super) fn all_broken(&self, function: &Function, fold: &Fold, broken: &Shift) -> Known {
        let starts = fold.starts.iter().map(|start| {
            Known::Numbers(vec![broken.clone(); usize::from(function.ty(*start).width())].into())
        });
        Known::Results(starts.collect())
    }
}
