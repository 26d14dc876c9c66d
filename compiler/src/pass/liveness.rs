//! What the entry's outputs need, through calls and folds.
//!
//! One walk over the whole graph, each value and each input once: a value is live if something live
//! reads it, an output of a function if a live call's is read, an argument if the input it goes to
//! is read. Of a fold an accumulator is live if its result is read, or if the condition or the next
//! value of a live accumulator reads it; a capture if the body or the condition does.
//!
//! A condition belongs to one body: both have the same accumulators and captures.

use crate::graph::{Fold, FunctionId, Graph, Operation, Value};

/// What is live; each list has one entry per function.
pub struct Liveness {
    /// Which values are live.
    pub values: Vec<Vec<bool>>,
    /// Which inputs are read. Of a body and its condition: which accumulators are carried and which
    /// captures one of the two reads.
    pub inputs: Vec<Vec<bool>>,
    /// Which outputs are read.
    pub outputs: Vec<Vec<bool>>,
    /// The calls of each function, and the folds that it is the body or the condition of.
    pub sites: Vec<Vec<Site>>,
}

/// A call or a fold.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Site {
    /// The function that it stands in.
    pub caller: usize,
    /// The call or fold.
    pub value: Value,
    /// How it uses the function.
    pub role: Role,
}

/// What a function is at one of its sites.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Called.
    Callee,
    /// One step of a fold.
    Body,
    /// Tested before each step.
    Condition,
}

impl Liveness {
    /// Finds what the outputs of the entry need.
    pub fn of(graph: &Graph) -> Liveness {
        let functions = &graph.functions;
        let liveness = Liveness {
            values: functions.iter().map(|f| vec![false; f.values.len()]).collect(),
            inputs: functions.iter().map(|f| vec![false; f.inputs.len()]).collect(),
            outputs: functions.iter().map(|f| vec![false; f.outputs.len()]).collect(),
            sites: sites(graph),
        };
        let mut walk = Walk { graph, liveness, next: (functions.len(), Value(0)), pending: Vec::new() };
        let entry = functions.len().saturating_sub(1);
        for i in 0..functions.last().map_or(0, |entry| entry.outputs.len()) {
            walk.output(entry, i);
        }
        (0..functions.len()).rev().for_each(|function| walk.function(function));
        walk.liveness
    }

    /// Whether a value is live.
    pub fn is_live(&self, function: usize, value: Value) -> bool {
        self.values[function].get(value.0 as usize).copied().unwrap_or(false)
    }

    /// The live calls and folds of a function.
    pub fn live_sites(&self, function: usize) -> impl Iterator<Item = &Site> {
        self.sites[function].iter().filter(|site| self.is_live(site.caller, site.value))
    }
}

fn sites(graph: &Graph) -> Vec<Vec<Site>> {
    let mut sites: Vec<Vec<Site>> = graph.functions.iter().map(|_| Vec::new()).collect();
    for (caller, function) in graph.functions.iter().enumerate() {
        for (value, operation) in function.iter() {
            let mut add = |id: FunctionId, role| sites[id.0 as usize].push(Site { caller, value, role });
            match operation {
                Operation::Call(callee, _) => add(*callee, Role::Callee),
                Operation::Fold(fold) => {
                    add(fold.body, Role::Body);
                    fold.condition.into_iter().for_each(|condition| add(condition, Role::Condition));
                }
                _ => {}
            }
        }
    }
    sites
}

struct Walk<'a> {
    graph: &'a Graph,
    liveness: Liveness,
    /// The value that is looked at: those before it are still to come.
    next: (usize, Value),
    /// Live values that were passed over and are to be looked at again.
    pending: Vec<(usize, Value)>,
}

impl<'a> Walk<'a> {
    /// A value is read.
    fn reads(&mut self, function: usize, value: Value) {
        if let Some(live) = self.liveness.values[function].get_mut(value.0 as usize)
            && !std::mem::replace(live, true)
            && (function, value) >= self.next
        {
            self.pending.push((function, value));
        }
    }

    /// Looks at the values of a function, users first; all that can use it has been looked at.
    fn function(&mut self, place: usize) {
        for (value, operation) in self.graph.functions[place].iter().rev() {
            if !self.liveness.values[place][value.0 as usize] {
                continue;
            }
            let (Operation::Input(_) | Operation::Output(..) | Operation::Call(..) | Operation::Fold(_)) =
                operation
            else {
                let live = &mut self.liveness.values[place];
                operation.for_operands(|v| live[v.0 as usize] = true);
                continue;
            };
            self.next = (place, value);
            self.value(place, value, operation);
            while let Some((place, value)) = self.pending.pop() {
                self.value(place, value, self.graph.functions[place].operation(value));
            }
        }
    }

    /// An output of a function is read.
    fn output(&mut self, function: usize, i: usize) {
        if let Some(live) = self.liveness.outputs[function].get_mut(i)
            && !std::mem::replace(live, true)
        {
            let (_, value) = self.graph.functions[function].outputs[i];
            self.reads(function, value);
        }
    }

    /// An input of a function is read, so whatever its sites give for it is.
    fn input(&mut self, function: usize, i: usize) {
        if let Some(live) = self.liveness.inputs[function].get_mut(i)
            && !std::mem::replace(live, true)
        {
            for k in 0..self.liveness.sites[function].len() {
                let site = self.liveness.sites[function][k];
                if self.liveness.is_live(site.caller, site.value) {
                    self.feed(site, i);
                }
            }
        }
    }

    /// What a live site gives for input `i` of its function is read.
    fn feed(&mut self, site: Site, i: usize) {
        match (self.graph.functions[site.caller].operation(site.value), site.role) {
            (Operation::Call(_, arguments), _) => {
                arguments.get(i).into_iter().for_each(|v| self.reads(site.caller, *v));
            }
            (Operation::Fold(fold), role) => {
                let accumulators = fold.starts.len();
                // The step that a body is told comes between accumulators and captures.
                let behind = accumulators + usize::from(role == Role::Body);
                if i < accumulators {
                    self.carry(site.caller, fold, i);
                } else if i >= behind {
                    self.capture(site.caller, fold, i - behind);
                }
            }
            _ => {}
        }
    }

    /// An accumulator is carried: its start, its next value and its places in both signatures.
    fn carry(&mut self, caller: usize, fold: &Fold, i: usize) {
        fold.starts.get(i).into_iter().for_each(|start| self.reads(caller, *start));
        self.output(fold.body.0 as usize, i);
        self.input(fold.body.0 as usize, i);
        fold.condition.into_iter().for_each(|condition| self.input(condition.0 as usize, i));
    }

    fn capture(&mut self, caller: usize, fold: &Fold, i: usize) {
        fold.captures.get(i).into_iter().for_each(|capture| self.reads(caller, *capture));
        let accumulators = fold.starts.len();
        self.input(fold.body.0 as usize, accumulators + 1 + i);
        let condition = fold.condition.into_iter();
        condition.for_each(|condition| self.input(condition.0 as usize, accumulators + i));
    }

    /// What a live value needs.
    fn value(&mut self, function: usize, value: Value, operation: &'a Operation) {
        let source = &self.graph.functions[function];
        match operation {
            Operation::Input(i) => self.input(function, *i as usize),
            Operation::Output(of, i) => {
                self.reads(function, *of);
                match source.operation(*of) {
                    Operation::Call(callee, _) => self.output(callee.0 as usize, *i as usize),
                    Operation::Fold(fold) => self.carry(function, fold, *i as usize),
                    _ => {}
                }
            }
            Operation::Call(callee, _) => {
                self.feed_all(*callee, Site { caller: function, value, role: Role::Callee });
            }
            Operation::Fold(fold) => {
                self.reads(function, fold.steps);
                // A body is always told the number of the step.
                self.input(fold.body.0 as usize, fold.starts.len());
                self.feed_all(fold.body, Site { caller: function, value, role: Role::Body });
                if let Some(condition) = fold.condition {
                    self.output(condition.0 as usize, 0);
                    self.feed_all(condition, Site { caller: function, value, role: Role::Condition });
                }
            }
            operation => operation.for_operands(|v| self.reads(function, v)),
        }
    }

    /// A site became live: it feeds all inputs that are read already.
    fn feed_all(&mut self, id: FunctionId, site: Site) {
        for i in 0..self.liveness.inputs[id.0 as usize].len() {
            if self.liveness.inputs[id.0 as usize][i] {
                self.feed(site, i);
            }
        }
    }
}
