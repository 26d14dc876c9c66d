//! Which wire needs which: free names of expressions, and statements in an order that works.

use rustc_hash::{FxHashMap, FxHashSet};
use texgraph_grammar::syntax::{
    Argument, Body, Call, Expr, ExprKind, Fold, Name, Node, Pattern, Postfix, Span, Statement,
};

/// The names that an expression takes from outside.
#[derive(Default, Debug)]
pub struct Free<'a> {
    /// Read as values, in source order.
    pub values: Vec<&'a str>,
    /// Where each of them is read.
    pub places: Vec<Span>,
    /// Called.
    pub calls: Vec<&'a str>,
    /// Of the values, those that an input may take for a choice instead.
    words: Vec<Word<'a>>,
    /// Names bound around the place of the walk, with how many times.
    bound: FxHashMap<&'a str, u32>,
}

/// A bare name given to a named input.
#[derive(Debug)]
struct Word<'a> {
    /// Which of the values it is.
    value: usize,
    call: &'a str,
    input: &'a str,
}

impl<'a> Free<'a> {
    /// Of an expression.
    pub fn of(expr: &'a Expr) -> Free<'a> {
        let mut free = Free::default();
        free.expr(expr);
        free
    }

    /// Of another expression instead.
    pub fn read(&mut self, expr: &'a Expr) {
        self.values.clear();
        self.places.clear();
        self.calls.clear();
        self.words.clear();
        self.expr(expr);
    }

    /// The values less those that are choices: `is_choice` is asked about a call, the name of an
    /// input and a word.
    pub fn reads(&self, is_choice: impl Fn(&str, &str, &str) -> bool) -> impl Iterator<Item = &'a str> {
        let mut words = self.words.iter().peekable();
        self.values.iter().enumerate().filter_map(move |(i, name)| {
            let word = words.next_if(|word| word.value == i);
            word.is_none_or(|word| !is_choice(word.call, word.input, name)).then_some(*name)
        })
    }

    /// Of a further expression too.
    pub fn add(&mut self, expr: &'a Expr) {
        self.expr(expr);
    }

    /// Of a node's body: its inputs and wires are not free in it.
    pub fn of_node(node: &'a Node) -> Free<'a> {
        let mut free = Free::default();
        free.bind(node.inputs.iter().map(|input| input.name.text.as_str()));
        node.inputs.iter().filter_map(|input| input.default.as_ref()).for_each(|default| free.expr(default));
        free.body(&node.body);
        free
    }

    fn name(&mut self, name: &'a str, place: Span) {
        if self.bound.is_empty() || self.bound.get(name).is_none_or(|count| *count == 0) {
            self.values.push(name);
            self.places.push(place);
        }
    }

    fn bind(&mut self, names: impl IntoIterator<Item = &'a str>) {
        names.into_iter().for_each(|name| *self.bound.entry(name).or_insert(0) += 1);
    }

    fn unbind(&mut self, names: impl IntoIterator<Item = &'a str>) {
        for name in names {
            if let Some(count) = self.bound.get_mut(name) {
                *count = count.saturating_sub(1);
            }
        }
    }

    fn body(&mut self, body: &'a Body) {
        self.bind(body.statements.iter().flat_map(names_of));
        body.statements.iter().for_each(|statement| self.expr(value_of(statement)));
        self.unbind(body.statements.iter().flat_map(names_of));
    }

    fn fold(&mut self, fold: &'a Fold) {
        fold.accumulators.iter().for_each(|(_, start)| self.expr(start));
        self.expr(&fold.range.start);
        self.expr(&fold.range.end);
        fold.max.iter().for_each(|max| self.expr(max));
        let accumulators = || fold.accumulators.iter().map(|(name, _)| name.text.as_str());
        self.bind(accumulators());
        fold.condition.iter().for_each(|condition| self.expr(condition));
        self.bind([fold.variable.text.as_str()]);
        self.body(&fold.body);
        self.unbind(accumulators().chain([fold.variable.text.as_str()]));
    }

    /// Recursion is bounded by the nesting of the text.
    fn expr(&mut self, expr: &'a Expr) {
        match &expr.kind {
            ExprKind::Name(name) => self.name(name, expr.span),
            ExprKind::Paren(inner) => self.expr(inner),
            ExprKind::Call(call) => self.call(call),
            ExprKind::Postfix { base, links } => {
                self.expr(base);
                links.iter().for_each(|link| self.link(link));
            }
            ExprKind::Unary { operand, .. } => self.expr(operand),
            ExprKind::Chain { first, links } => {
                self.expr(first);
                links.iter().for_each(|link| self.expr(&link.operand));
            }
            ExprKind::If { arms, otherwise } => {
                arms.iter().flat_map(|(condition, arm)| [condition, arm]).for_each(|e| self.expr(e));
                self.expr(otherwise);
            }
            ExprKind::List(items) => items.iter().for_each(|item| self.expr(item)),
            ExprKind::Lambda { inputs, body } => {
                self.bind(inputs.iter().map(|input| input.text.as_str()));
                self.expr(body);
                self.unbind(inputs.iter().map(|input| input.text.as_str()));
            }
            ExprKind::Fold(fold) => self.fold(fold),
            ExprKind::Int(_)
            | ExprKind::Float(_)
            | ExprKind::Bool(_)
            | ExprKind::Text(_)
            | ExprKind::Color(_) => {}
        }
    }

    fn link(&mut self, link: &'a Postfix) {
        match link {
            Postfix::Field(_) => {}
            Postfix::Method(call, _) => self.call(call),
            Postfix::Index(index, _) => self.expr(index),
        }
    }

    fn call(&mut self, call: &'a Call) {
        self.calls.push(&call.name.text);
        for Argument { name, value } in &call.arguments {
            let before = self.values.len();
            self.expr(value);
            if let (Some(input), ExprKind::Name(_), true) = (name, &value.kind, before < self.values.len()) {
                self.words.push(Word { value: before, call: &call.name.text, input: &input.text });
            }
        }
    }
}

/// The names a statement binds.
pub fn names_of(statement: &Statement) -> impl Iterator<Item = &str> {
    bound(statement).iter().map(|name| name.text.as_str())
}

/// The names a statement binds, with their places.
pub fn bound(statement: &Statement) -> &[Name] {
    match statement {
        Statement::Let { pattern: Pattern::Name(name), .. } | Statement::Assign { name, .. } => {
            std::slice::from_ref(name)
        }
        Statement::Let { pattern: Pattern::Record(names, _), .. } => names,
    }
}

/// The expression of a statement.
pub fn value_of(statement: &Statement) -> &Expr {
    match statement {
        Statement::Let { value, .. } | Statement::Assign { value, .. } => value,
    }
}

/// For each step the steps whose names it reads.
#[derive(Default)]
pub struct Needs {
    steps: Vec<usize>,
    /// Where those of each step end.
    ends: Vec<usize>,
}

impl Needs {
    /// Adds those of the next step.
    pub fn push(&mut self, steps: impl Iterator<Item = usize>) {
        self.steps.extend(steps);
        self.ends.push(self.steps.len());
    }

    fn of(&self, step: usize) -> &[usize] {
        let start = step.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.steps[start..self.ends[step]]
    }
}

/// Steps so that each comes after those it needs, in source order where that is free; and the
/// rings of steps that need each other, no step in two of them. A step of a ring comes before one
/// that it needs.
pub fn sort(needs: &Needs) -> (Vec<usize>, Vec<Vec<usize>>) {
    let steps = 0..needs.ends.len();
    if steps.clone().all(|step| needs.of(step).iter().all(|needed| *needed < step)) {
        return (steps.collect(), Vec::new());
    }
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        New,
        Open,
        Done,
    }
    let mut state = vec![State::New; steps.len()];
    let mut order = Vec::with_capacity(steps.len());
    let mut rings = Vec::new();
    let mut in_ring = vec![false; steps.len()];
    let mut stack = Vec::new();
    for root in steps {
        if state[root] == State::New {
            stack.push((root, 0));
            state[root] = State::Open;
        }
        while let Some((step, next)) = stack.last_mut() {
            let Some(&needed) = needs.of(*step).get(*next) else {
                state[*step] = State::Done;
                order.push(*step);
                stack.pop();
                continue;
            };
            *next += 1;
            match state[needed] {
                State::Done => {}
                State::New => {
                    state[needed] = State::Open;
                    stack.push((needed, 0));
                }
                State::Open => {
                    let start = stack.iter().position(|(step, _)| *step == needed).unwrap_or(0);
                    let ring: Vec<usize> = stack[start..].iter().map(|(step, _)| *step).collect();
                    // One slip often closes several rings.
                    if ring.iter().all(|step| !in_ring[*step]) {
                        ring.iter().for_each(|step| in_ring[*step] = true);
                        rings.push(ring);
                    }
                }
            }
        }
    }
    (order, rings)
}

/// What calls of a file's nodes read of the file, through any number of further calls.
pub struct Reach<'a> {
    nodes: FxHashMap<&'a str, Vec<&'a Node>>,
    /// What the nodes of a name take from outside, of those that were asked for.
    free: FxHashMap<&'a str, Vec<Free<'a>>>,
}

impl<'a> Reach<'a> {
    /// Of the nodes of a file.
    pub fn new(nodes: impl Iterator<Item = &'a Node>) -> Reach<'a> {
        let mut reach = Reach { nodes: FxHashMap::default(), free: FxHashMap::default() };
        for node in nodes {
            reach.nodes.entry(&node.name.text).or_default().push(node);
        }
        reach
    }

    /// The names read by nodes that are called by these names.
    pub fn values(&mut self, calls: Vec<&'a str>) -> Vec<&'a str> {
        let mut values = Vec::new();
        let mut seen = FxHashSet::default();
        let mut queue = calls;
        while let Some(name) = queue.pop() {
            let Some(nodes) = self.nodes.get(name).filter(|_| seen.insert(name)) else { continue };
            let free = self.free.entry(name);
            for free in free.or_insert_with(|| nodes.iter().map(|node| Free::of_node(node)).collect()) {
                values.extend(&free.values);
                // A node may be passed by its bare name.
                queue.extend(free.calls.iter().chain(&free.values));
            }
        }
        values
    }
}
