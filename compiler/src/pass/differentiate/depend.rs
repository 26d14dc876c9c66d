//! Forward, callees first: what every value changes with.

use super::sampled::Marks;
use super::{BITS, Inputs, Layout};
use crate::graph::{Fold, Function, FunctionId, Graph, Level, Operation, Value};
use crate::intrinsic::Derivative;
use rustc_hash::FxHashMap;

/// What is known of a function.
pub struct Known {
    /// For each value the inputs that it changes with.
    pub depends: Vec<Inputs>,
    /// For each fold what its accumulators change with.
    pub results: FxHashMap<Value, Vec<Inputs>>,
    /// For each output the inputs that it changes with.
    pub outputs: Vec<Inputs>,
    /// The inputs whose change is needed inside.
    pub needed: Inputs,
}

/// For each position in a set what stands behind it changes with.
struct Sources([Inputs; BITS]);

impl Sources {
    fn of(layout: Layout, operands: impl Iterator<Item = (usize, Inputs)>) -> Sources {
        let mut sources = Sources([0; BITS]);
        operands.for_each(|(input, depends)| sources.add(layout, input, depends));
        sources
    }

    fn add(&mut self, layout: Layout, input: usize, depends: Inputs) {
        self.0[layout.position(input)] |= depends;
    }

    /// What a set of inputs changes with.
    fn through(&self, mut set: Inputs) -> Inputs {
        let mut all = 0;
        while set != 0 {
            all |= self.0[set.trailing_zeros() as usize];
            set &= set - 1;
        }
        all
    }
}

/// What is known of each function: where no more of it is asked than what its own derivatives are
/// taken of, and where the change of its outputs by what it samples is asked for too.
pub struct KnownOf {
    own: Known,
    /// None where it is as `own`: nothing counts as changed by samples.
    whole: Option<Known>,
}

impl KnownOf {
    pub fn get(&self, is_whole: bool) -> &Known {
        self.whole.as_ref().filter(|_| is_whole).unwrap_or(&self.own)
    }
}

/// Looks at every function once, or twice where samples count as changing.
pub fn analyse(graph: &Graph, layouts: &[Layout], marks: Option<&[Marks]>) -> Vec<KnownOf> {
    let mut known: Vec<KnownOf> = Vec::with_capacity(graph.functions.len());
    for (i, function) in graph.functions.iter().enumerate() {
        let marks = marks.and_then(|marks| marks.get(i));
        let of = |is_whole| Depending::new(function, layouts[i], layouts, &known, marks, is_whole).run();
        let of = KnownOf { own: of(false), whole: marks.filter(|marks| marks.samples()).map(|_| of(true)) };
        known.push(of);
    }
    known
}

/// A function being looked at.
struct Depending<'a> {
    function: &'a Function,
    layout: Layout,
    layouts: &'a [Layout],
    known: &'a [KnownOf],
    marks: Option<&'a Marks>,
    is_whole: bool,
    depends: Vec<Inputs>,
    results: FxHashMap<Value, Vec<Inputs>>,
    needed: Inputs,
}

impl<'a> Depending<'a> {
    fn new(
        function: &'a Function,
        layout: Layout,
        layouts: &'a [Layout],
        known: &'a [KnownOf],
        marks: Option<&'a Marks>,
        is_whole: bool,
    ) -> Depending<'a> {
        Depending {
            function,
            layout,
            layouts,
            known,
            marks,
            is_whole,
            depends: Vec::with_capacity(function.values.len()),
            results: FxHashMap::default(),
            needed: 0,
        }
    }

    fn run(mut self) -> Known {
        let function = self.function;
        for (value, operation) in function.iter() {
            let depends = self.value(value, operation);
            self.depends.push(if function.ty(value).is_float() { depends } else { 0 });
        }
        let Depending { depends, results, needed, .. } = self;
        let outputs = function.outputs.iter().map(|(_, value)| depends[value.0 as usize]).collect();
        Known { depends, results, outputs, needed }
    }

    /// Whether samples count as changing in a value.
    fn is_marked(&self, value: Value) -> bool {
        self.marks.is_some_and(|marks| marks.has(self.is_whole, value))
    }

    /// A function that a value comes from.
    fn used(&self, id: FunctionId, by: Value) -> &'a Known {
        self.known[id.0 as usize].get(self.is_marked(by))
    }

    fn of(&self, value: Value) -> Inputs {
        self.depends[value.0 as usize]
    }

    fn any(&self, values: &[Value]) -> Inputs {
        values.iter().fold(0, |all, value| all | self.of(*value))
    }

    fn value(&mut self, value: Value, operation: &Operation) -> Inputs {
        match operation {
            Operation::Input(i) => self.layout.bit(*i as usize),
            Operation::Builtin(intrinsic, arguments) => match intrinsic.row().derivative {
                Derivative::Zero => 0,
                Derivative::Rule(_) => self.any(arguments),
            },
            Operation::Compose(parts) => self.any(parts),
            Operation::Extract(v, _) => self.of(*v),
            Operation::Select(_, yes, no) => self.of(*yes) | self.of(*no),
            Operation::Output(of, i) => self.output(*of, *i as usize),
            Operation::Sample { coordinate, level, .. } => {
                if *level == Level::Auto {
                    self.needed |= self.of(*coordinate);
                }
                if self.is_marked(value) { self.of(*coordinate) } else { 0 }
            }
            Operation::Derivative(v, ..) => {
                self.needed |= self.of(*v);
                0
            }
            Operation::Call(callee, arguments) => {
                self.needed |= self.through(arguments, self.used(*callee, value).needed);
                0
            }
            Operation::Fold(fold) => {
                let results = self.fold(value, fold);
                self.results.insert(value, results);
                0
            }
            _ => 0,
        }
    }

    /// What an output of a call or fold changes with.
    fn output(&self, of: Value, i: usize) -> Inputs {
        let output = match self.function.operation(of) {
            Operation::Call(callee, arguments) => {
                let output = self.used(*callee, of).outputs.get(i);
                output.map(|output| self.through(arguments, *output))
            }
            _ => self.results.get(&of).and_then(|results| results.get(i)).copied(),
        };
        output.unwrap_or(0)
    }

    /// What a set of the inputs of a called function changes with.
    fn through(&self, arguments: &[Value], set: Inputs) -> Inputs {
        let arguments = arguments.iter().enumerate().filter(|(i, _)| set & Layout::CALLED.bit(*i) != 0);
        arguments.fold(0, |all, (_, value)| all | self.of(*value))
    }

    /// What the accumulators of a fold change with, after any number of steps.
    fn fold(&mut self, value: Value, fold: &Fold) -> Vec<Inputs> {
        let (body, layout) = (self.used(fold.body, value), self.layouts[fold.body.0 as usize]);
        let captures = fold.captures.iter().map(|v| self.of(*v)).enumerate();
        let first = fold.starts.len() + 1;
        let mut sources = Sources::of(layout, captures.map(|(i, depends)| (first + i, depends)));
        let mut accumulators: Vec<Inputs> = fold.starts.iter().map(|v| self.of(*v)).collect();
        // Sets only grow, and inputs beyond the last bit count as one: a few rounds.
        loop {
            let mut changed = false;
            accumulators.iter().enumerate().for_each(|(j, depends)| sources.add(layout, j, *depends));
            for (depends, output) in accumulators.iter_mut().zip(&body.outputs) {
                let more = *depends | sources.through(*output);
                changed |= more != *depends;
                *depends = more;
            }
            if !changed {
                break;
            }
        }
        let condition = fold.condition.map_or(0, |condition| self.used(condition, value).needed);
        let needed = through_steps(layout, &body.outputs, body.needed | condition);
        self.needed |= sources.through(needed);
        accumulators
    }
}

/// The inputs of a body that a set of them comes from, any number of steps before.
pub fn through_steps(layout: Layout, outputs: &[Inputs], mut set: Inputs) -> Inputs {
    loop {
        let reached = outputs.iter().enumerate().filter(|(j, _)| set & layout.bit(*j) != 0);
        let more = reached.fold(set, |all, (_, inputs)| all | inputs);
        if more == set {
            return set;
        }
        set = more;
    }
}
