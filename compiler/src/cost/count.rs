//! Counting: functions callees first, each region by region.

use super::known::Known;
use super::{Arithmetic, Counts, bound};
use crate::graph::regions::{Branch, Region, Regions, Weights, draw_rate};
use crate::graph::{Fold, Function, Graph, Operation, Type, Value};

/// No figure grows beyond this: functions that call each other twice, level upon level, would leave
/// every number behind.
const CAP: f64 = 1e15;

/// Both cases.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Count {
    pub worst: Counts,
    pub typical: Counts,
}

impl Counts {
    fn zip(&self, other: &Counts, f: impl Fn(f64, f64) -> f64 + Copy) -> Counts {
        Counts {
            samples: f(self.samples, other.samples),
            fetches: f(self.fetches, other.fetches),
            reads: f(self.reads, other.reads),
            arithmetic: self.arithmetic.zip(&other.arithmetic, f),
        }
    }

    fn plus(&self, other: &Counts) -> Counts {
        self.zip(other, |a, b| (a + b).min(CAP))
    }

    fn times(&self, factor: f64) -> Counts {
        self.zip(self, |a, _| (a * factor).min(CAP))
    }

    /// Each figure's greater.
    fn max(&self, other: &Counts) -> Counts {
        self.zip(other, f64::max)
    }

    fn arithmetic(arithmetic: Arithmetic) -> Counts {
        Counts { arithmetic, ..Counts::default() }
    }
}

impl Count {
    /// The same in both cases.
    fn always(counts: Counts) -> Count {
        Count { worst: counts, typical: counts }
    }

    fn plus(&self, other: &Count) -> Count {
        Count { worst: self.worst.plus(&other.worst), typical: self.typical.plus(&other.typical) }
    }
}

/// The count of a graph's entry.
pub fn entry(graph: &Graph, known: &Known) -> Count {
    let weights = Weights::of(graph);
    let mut counts: Vec<Count> = Vec::with_capacity(graph.functions.len());
    let entry = graph.entry().0 as usize;
    for (index, function) in graph.functions.iter().enumerate() {
        let first = if index == entry { draw_rate(function, &weights) } else { Vec::new() };
        let counting = Counting {
            index,
            function,
            regions: Regions::inside(function, &weights, 0, &first),
            known,
            callees: &counts,
        };
        let count = counting.region(Region::TOP);
        counts.push(count);
    }
    counts.last().copied().unwrap_or_default()
}

struct Counting<'a> {
    index: usize,
    function: &'a Function,
    regions: Regions,
    known: &'a Known,
    /// The counts of the functions before this one.
    callees: &'a [Count],
}

impl Counting<'_> {
    /// What a region takes with all regions in it. Regions nest at most
    /// [`crate::graph::regions::MAX_DEPTH`] deep.
    fn region(&self, region: Region) -> Count {
        let mut count = Count::default();
        for value in self.regions.values(region) {
            let own = match self.regions.branch(*value) {
                Some(branch) => self.branch(branch),
                None => self.operation(self.function.operation(*value)),
            };
            count = count.plus(&own);
        }
        count
    }

    fn branch(&self, branch: &Branch) -> Count {
        let [yes, no] = branch.arms.map(|arm| self.region(arm));
        let typical = match self.known.number(self.index, branch.condition) {
            Some(holds) if holds.bool(0) => yes.typical,
            Some(_) => no.typical,
            None => yes.typical.plus(&no.typical).times(0.5),
        };
        let test = Counts::arithmetic(Arithmetic::choice(1));
        Count { worst: yes.worst.max(&no.worst), typical }.plus(&Count::always(test))
    }

    fn operation(&self, operation: &Operation) -> Count {
        let ty = |value: &Value| self.function.ty(*value);
        let counts = match operation {
            Operation::Call(callee, _) => return self.callee(callee.0 as usize),
            Operation::Fold(fold) => return self.fold(fold),
            Operation::Sample { .. } => Counts { samples: 1.0, reads: 1.0, ..Counts::default() },
            Operation::Texel { .. } => Counts { fetches: 1.0, reads: 1.0, ..Counts::default() },
            Operation::Builtin(intrinsic, arguments) => {
                let types: Vec<Type> = arguments.iter().map(ty).collect();
                Counts::arithmetic(Arithmetic::intrinsic(*intrinsic, &types))
            }
            Operation::Select(_, yes, _) => Counts::arithmetic(Arithmetic::choice(ty(yes).width())),
            Operation::Derivative(of, ..) => Counts::arithmetic(Arithmetic::derivative(ty(of).width())),
            Operation::Lookup(..) => Counts::arithmetic(Arithmetic::lookup()),
            Operation::Constant(_)
            | Operation::Input(_)
            | Operation::Param(_)
            | Operation::View(_)
            | Operation::Compose(_)
            | Operation::Extract(..)
            | Operation::Size(_)
            | Operation::Output(..) => Counts::default(),
        };
        Count::always(counts)
    }

    fn callee(&self, index: usize) -> Count {
        self.callees.get(index).copied().unwrap_or_default()
    }

    /// Before each step comes the test.
    fn fold(&self, fold: &Fold) -> Count {
        let test = fold.condition.map(|condition| self.callee(condition.0 as usize)).unwrap_or_default();
        let step = self.callee(fold.body.0 as usize).plus(&test);
        Count {
            worst: step.worst.times(f64::from(bound(self.function, fold))),
            typical: step.typical.times(self.known.steps(self.index, self.function, fold)),
        }
    }
}
