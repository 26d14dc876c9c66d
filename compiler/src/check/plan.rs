//! The plan of a function: its statements as steps in an order that works, and what is wrong with
//! the names that they bind.

use super::wire::Wire;
use super::{Checker, Frame, Step, Target, globals, order};
use crate::diagnostic::names;
use rustc_hash::{FxHashMap, FxHashSet};
use texgraph_grammar::syntax::{Name, Node, Pattern, Span, Statement};

/// Names of a function that were reported as unknown: each is reported once.
#[derive(Default)]
pub struct Reported {
    names: FxHashSet<String>,
    order: Vec<String>,
}

impl Reported {
    pub(super) fn contains(&self, name: &str) -> bool {
        self.names.contains(name)
    }

    pub(super) fn insert(&mut self, name: &str) {
        if self.names.insert(name.to_owned()) {
            self.order.push(name.to_owned());
        }
    }

    pub(super) fn len(&self) -> usize {
        self.order.len()
    }

    /// Forgets what came later.
    pub(super) fn truncate(&mut self, len: usize) {
        for name in self.order.drain(len.min(self.order.len())..) {
            self.names.remove(&name);
        }
    }
}

/// Statements of a library node that gives several values, at most, for it to be taken over: a call
/// would take a struct and as many lines.
const MOST_STATEMENTS: usize = 3;

impl<'a> Checker<'a> {
    /// Whether callers take a node over instead of calling it.
    fn is_taken_over(&self, module: usize, node: &Node) -> bool {
        let is_library = module < self.library.modules().len();
        match (node.body.statements.len(), node.outputs.len()) {
            (1, 1) => true,
            (statements, outputs) => is_library && outputs > 1 && statements <= MOST_STATEMENTS,
        }
    }

    /// The steps of a node.
    pub(super) fn plan_node(&mut self, f: &mut Frame<'a>, node: &'a Node) {
        f.builder.set_inline(self.is_taken_over(f.module, node));
        let inputs = node.inputs.iter().map(|input| &input.name);
        let head: Vec<&'a Name> = inputs.chain(node.outputs.iter().map(|output| &output.name)).collect();
        self.distinct(f, &head);
        f.steps.reserve(node.body.statements.len());
        for statement in &node.body.statements {
            match statement {
                Statement::Let { pattern, value, .. } => {
                    f.steps.push(Step { target: Target::Let(pattern), value });
                }
                Statement::Assign { name, value } => {
                    self.assign(f, node, name);
                    f.steps.push(Step { target: Target::Output(name), value });
                }
            }
        }
        if !f.bind_steps() {
            self.distinct(f, &bound(node));
        }
        self.outputs_assigned(f, node);
        self.sort(f);
    }

    fn assign(&mut self, f: &mut Frame<'a>, node: &'a Node, name: &Name) {
        // Where one output is declared twice, another was meant: that is said of the head.
        if !is_output(node, name) && !has_equal_outputs(node) {
            let near = self.near(&name.text, node.outputs.iter().map(|o| o.name.text.as_str()));
            let place = self.place(f, name.span);
            self.report(f, names::no_such_output(place, &node.name.text, &name.text, near));
        }
    }

    /// The name that was most likely meant. Only the first errors of a file get this help: it looks
    /// at all names there are.
    pub(super) fn near<'n>(&self, name: &str, known: impl IntoIterator<Item = &'n str>) -> Option<String> {
        if self.diagnostics.len() < 100 { names::nearest(name, known) } else { None }
    }

    fn outputs_assigned(&mut self, f: &mut Frame<'a>, node: &'a Node) {
        let assigned: Vec<&Name> = node.body.statements.iter().filter_map(assigned).collect();
        let mut misspelt = assigned.iter().filter(|name| !is_output(node, name)).count();
        for output in &node.outputs {
            if assigned.iter().any(|name| name.text == output.name.text) {
                continue;
            }
            // A misspelt assignment is reported already: one slip, one error.
            if misspelt > 0 {
                misspelt -= 1;
                continue;
            }
            let place = self.place(f, output.name.span);
            let (node_name, name) = (&node.name.text, &output.name.text);
            let error = match node.body.statements.iter().find_map(|statement| let_of(statement, name)) {
                Some(wire) => names::output_shadowed(place, node_name, name, self.place(f, wire)),
                None => names::output_missing(place, node_name, name),
            };
            self.report(f, error);
        }
    }

    /// Reports each name that stands twice; the first one holds.
    pub(super) fn distinct(&mut self, f: &mut Frame<'a>, bound: &[&'a Name]) {
        let mut seen: FxHashMap<&str, &Name> = FxHashMap::default();
        for name in bound {
            let first = *seen.entry(&name.text).or_insert(name);
            if first.span != name.span {
                f.repeated.insert(name.span.start);
                // Nobody knows which of the two is meant where the name is read.
                f.doubtful.insert(&name.text);
                if let Some(wire) = f.scopes.first_mut().and_then(|scope| scope.get_mut(name.text.as_str())) {
                    *wire = Wire::Unknown;
                }
                let (place, first) = (self.place(f, name.span), self.place(f, first.span));
                self.report(f, names::bound_twice(place, &name.text, first));
            }
        }
    }

    /// Puts the steps, whose names are bound, into an order that works. What stands in a ring is
    /// reported and comes in any order: what else is wrong with it is found too.
    pub(super) fn sort(&mut self, f: &mut Frame<'a>) {
        let mut reach = (f.node.is_none()).then(|| globals::reach(&self.modules[f.module]));
        let mut free = order::Free::default();
        let mut needs = order::Needs::default();
        for step in &f.steps {
            free.read(step.value);
            step.ends().into_iter().for_each(|end| free.add(end));
            let through = reach.as_mut().map(|reach| {
                // A node may be passed by its bare name.
                reach.values(free.calls.iter().chain(&free.values).copied().collect())
            });
            let own = free.reads(|call, input, word| {
                f.bound.contains_key(word) && self.is_choice_anywhere(call, input, word)
            });
            let names = own.chain(through.into_iter().flatten());
            needs.push(names.filter_map(|name| f.bound.get(name).copied()));
        }
        let (order, rings) = order::sort(&needs);
        f.order = order;
        for ring in rings {
            self.ring(f, &ring);
        }
    }

    /// Reports a ring, from its first step in the text, at the name that leads to the next one.
    fn ring(&mut self, f: &mut Frame<'a>, ring: &[usize]) {
        let start = ring.iter().enumerate().min_by_key(|(_, step)| **step).map_or(0, |(i, _)| i);
        let steps: Vec<&Step> = ring[start..].iter().chain(&ring[..start]).map(|i| &f.steps[*i]).collect();
        let next: Vec<&str> =
            steps.get(1).or(steps.first()).into_iter().flat_map(|step| step.names()).collect();
        let span = steps.first().map_or(Span::default(), |step| read(step, &next).unwrap_or(step.span()));
        let names: Vec<&'a str> = steps.iter().filter_map(|step| step.names().next()).collect();
        if f.node.is_none() {
            // Nodes that read them must not find them missing.
            let all: Vec<&'a str> = steps.iter().flat_map(|step| step.names()).collect();
            self.globals[f.module]
                .extend(all.into_iter().map(|name| (name.to_owned(), globals::Global::Unknown)));
        }
        let error = names::cycle(self.place(f, span), &names);
        self.report(f, error);
    }
}

/// The names that a node binds, inputs first.
fn bound(node: &Node) -> Vec<&Name> {
    let is_input = |name: &Name| node.inputs.iter().any(|input| input.name.text == name.text);
    let statements = node.body.statements.iter().flat_map(|statement| match statement {
        // That an output has the name of an input is said of the head, and that an input is no
        // output of the assignment.
        Statement::Assign { name, .. } if is_input(name) => &[],
        statement => order::bound(statement),
    });
    node.inputs.iter().map(|input| &input.name).chain(statements).collect()
}

fn is_output(node: &Node, name: &Name) -> bool {
    node.outputs.iter().any(|output| output.name.text == name.text)
}

/// Whether two outputs of a node have one name.
pub(super) fn has_equal_outputs(node: &Node) -> bool {
    let names: FxHashSet<&str> = node.outputs.iter().map(|output| output.name.text.as_str()).collect();
    names.len() < node.outputs.len()
}

/// The name that a statement assigns.
fn assigned(statement: &Statement) -> Option<&Name> {
    match statement {
        Statement::Assign { name, .. } => Some(name),
        Statement::Let { .. } => None,
    }
}

/// Where a `let` binds this name.
fn let_of(statement: &Statement, name: &str) -> Option<Span> {
    let Statement::Let { pattern, .. } = statement else { return None };
    let bound = match pattern {
        Pattern::Name(name) => std::slice::from_ref(name),
        Pattern::Record(names, _) => names,
    };
    bound.iter().find(|bound| bound.text == name).map(|bound| bound.span)
}

/// Where a step reads one of these names.
fn read(step: &Step, names: &[&str]) -> Option<Span> {
    let mut free = order::Free::of(step.value);
    step.ends().into_iter().for_each(|end| free.add(end));
    let found = free.values.iter().zip(&free.places).find(|(name, _)| names.contains(name));
    found.map(|(_, place)| *place)
}
