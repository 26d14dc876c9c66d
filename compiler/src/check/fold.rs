//! Folds: the body becomes a function of the accumulators, the step and what it reads from outside.
//!
//! A fold over known numbers is worth a number, found here; any other stays in the graph. Which of
//! those are written out is decided later (`pass::inline`).

use super::order::{self, Free};
use super::range::Steps;
use super::wire::Wire;
use super::{Checker, Frame, types};
use crate::diagnostic::{Place, folds, limits, names, types as errors};
use crate::graph::evaluate::{Stopped, evaluate};
use crate::graph::{self, Builder, Constant, Function, FunctionId, Scalar, Type, Value};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;
use std::rc::Rc;
use texgraph_grammar::syntax::{Expr, Fold, Name, Pattern, Span, Statement};

/// The body or condition of a fold in the making, with what it reads of the function around it.
struct Part {
    builder: Builder,
    captures: Vec<Value>,
}

impl<'a> Checker<'a> {
    pub(super) fn fold(&mut self, f: &mut Frame<'a>, fold: &'a Fold, span: Span) -> Wire {
        let place = self.place(f, span);
        let starts = self.starts(f, fold);
        let steps = self.steps(f, fold, place);
        let order = self.fold_order(f, fold);
        let (Some(starts), Some(steps), Some(order)) = (starts, steps, order) else { return Wire::Unknown };
        let body = self.fold_body(f, fold, &order, &starts, &steps);
        let captures = body.as_ref().map_or(&[][..], |body| &body.captures);
        let condition = fold
            .condition
            .as_ref()
            .map(|condition| self.fold_condition(f, fold, condition, &starts, captures));
        if !f.waiting.is_empty() {
            return Wire::Unknown;
        }
        let Some(mut body) = body else { return Wire::Unknown };
        let condition = match condition {
            Some(Some(condition)) => {
                // Both take what either reads.
                let function = condition.builder.function();
                let first = function.inputs.len() - condition.captures.len();
                for slot in &function.inputs[first + body.captures.len()..] {
                    body.builder.input(slot.name.clone(), slot.ty);
                }
                body.captures = condition.captures;
                Some(self.intern(condition.builder.finish()))
            }
            Some(None) => return Wire::Unknown,
            None => None,
        };
        let inner = self.intern(body.builder.finish());
        if !self.nest_fits(f, inner, steps.most, place) {
            return Wire::Unknown;
        }
        f.builder.set_place(place);
        let captures = body.captures;
        let made =
            graph::Fold { body: inner, condition, starts, steps: steps.steps, most: steps.most, captures };
        let Some(results) = self.fold_results(f, made, place) else { return Wire::Unknown };
        let names = fold.accumulators.iter().map(|(name, _)| name.text.clone());
        let mut record: Vec<(SmolStr, Wire)> = names.zip(results.into_iter().map(Wire::Value)).collect();
        if record.len() == 1 { record.remove(0).1 } else { Wire::Record(Rc::new(record)) }
    }

    fn starts(&mut self, f: &mut Frame<'a>, fold: &'a Fold) -> Option<Vec<Value>> {
        let starts = fold.accumulators.iter().map(|(_, start)| {
            let at = self.place(f, start.span);
            let wire = self.expr(f, start);
            self.value(f, &wire, at)
        });
        starts.collect::<Vec<_>>().into_iter().collect()
    }

    /// The function of one step.
    fn fold_body(
        &mut self,
        f: &mut Frame<'a>,
        fold: &'a Fold,
        order: &[&'a Statement],
        starts: &[Value],
        steps: &Steps,
    ) -> Option<Part> {
        let types = starts.iter().map(|start| f.builder.ty(*start)).collect::<Vec<Type>>();
        f.enter("step");
        let accumulators = accumulators(f, fold, &types);
        let plain = steps.are_places(f);
        let name =
            if plain { fold.variable.text.to_string() } else { format!("{}_step", fold.variable.text) };
        let step = f.builder.input(name, Type::INT);
        let at = steps.place_of(f, step);
        f.builder.name(at, fold.variable.text.as_str());
        f.scopes[f.base].insert(&fold.variable.text, Wire::Value(at));
        let mut next = accumulators;
        let mut fine = true;
        for statement in order {
            fine &= self.fold_statement(f, fold, statement, &mut next);
        }
        for (value, (name, _)) in next.iter().zip(&fold.accumulators) {
            f.builder.output(name.text.clone(), *value);
        }
        let (builder, captures) = f.leave();
        fine.then_some(Part { builder, captures })
    }

    fn fold_statement(
        &mut self,
        f: &mut Frame<'a>,
        fold: &'a Fold,
        statement: &'a Statement,
        next: &mut [Value],
    ) -> bool {
        let wire = self.expr(f, order::value_of(statement));
        let known = !matches!(wire, Wire::Unknown);
        match statement {
            Statement::Let { pattern: Pattern::Name(name), .. } => self.bind(f, name, wire),
            Statement::Let { pattern: Pattern::Record(names, span), .. } => {
                let place = self.place(f, *span);
                self.take_apart(f, names, wire, place);
            }
            Statement::Assign { name, value } => {
                let place = self.place(f, value.span);
                return self.advance(f, fold, next, name, &wire, place) && known;
            }
        }
        known
    }

    /// The function that tells whether the next step is taken. It takes the body's captures before
    /// its own.
    fn fold_condition(
        &mut self,
        f: &mut Frame<'a>,
        fold: &'a Fold,
        condition: &'a Expr,
        starts: &[Value],
        captures: &[Value],
    ) -> Option<Part> {
        let at = self.place(f, condition.span);
        let types = starts.iter().map(|start| f.builder.ty(*start)).collect::<Vec<Type>>();
        f.enter("goes_on");
        accumulators(f, fold, &types);
        let level = f.layers.len() - 1;
        for capture in captures {
            f.capture(level, *capture);
        }
        let wire = self.expr(f, condition);
        let holds = self.coerce_value(f, &wire, Scalar::Bool, 1, at);
        if let Some(holds) = holds {
            f.builder.output("goes_on", holds);
        }
        let (builder, captures) = f.leave();
        holds.map(|_| Part { builder, captures })
    }

    /// Whether folds inside each other stay within the bound; if not, that is reported.
    fn nest_fits(&mut self, f: &mut Frame<'a>, body: FunctionId, most: u32, place: Place) -> bool {
        let inner = self.function_steps.get(body.0 as usize).copied().unwrap_or(1);
        let steps = u64::from(most).saturating_mul(inner);
        if steps > u64::from(limits::MAX_STEPS) {
            let name = f.function_name();
            self.report(f, folds::too_many_steps(place, &name, steps));
            return false;
        }
        true
    }

    /// The accumulators after the last step: numbers where all is known.
    fn fold_results(&mut self, f: &mut Frame<'a>, fold: graph::Fold, place: Place) -> Option<Vec<Value>> {
        // Views may be captured for `given` alone; a fold that reads one is found not to be constant.
        let is_view = |value: Value| f.builder.ty(value).scalar().is_none();
        let mut known = true;
        fold.for_operands(|value| known &= f.builder.as_constant(value).is_some() || is_view(value));
        if !known {
            return Some(f.builder.fold(fold));
        }
        let mut alone = Builder::new("fold");
        let inside = fold.map_operands(|value| match f.builder.as_constant(value) {
            Some(constant) => alone.constant(constant),
            None => alone.constant(Constant::ints(&[0])),
        });
        for (i, value) in alone.fold(inside).into_iter().enumerate() {
            alone.output(format!("o{i}"), value);
        }
        self.functions.push(alone.finish());
        let id = FunctionId(self.functions.len() as u32 - 1);
        let worth = evaluate(&self.functions, id, &[], &mut self.budget);
        self.functions.pop();
        match worth {
            Ok(numbers) => Some(numbers.into_iter().map(|number| f.builder.constant(number)).collect()),
            Err(Stopped::NotConstant) => Some(f.builder.fold(fold)),
            Err(Stopped::Budget) => {
                let name = f.function_name();
                self.report(f, limits::too_much_evaluation(place, &name));
                None
            }
        }
    }

    /// The statements in an order that works; None when there is none, which is reported.
    fn fold_order(&mut self, f: &mut Frame<'a>, fold: &'a Fold) -> Option<Vec<&'a Statement>> {
        let body = &fold.body;
        self.fold_names(f, fold);
        let mut binder: FxHashMap<&str, usize> = FxHashMap::default();
        let lets = body.statements.iter().enumerate().filter(|(_, s)| matches!(s, Statement::Let { .. }));
        for (i, statement) in lets {
            binder.extend(order::names_of(statement).map(|name| (name, i)));
        }
        // An accumulator read in the body is its previous value, so only wires make an order.
        let mut free = Free::default();
        let mut needs = order::Needs::default();
        for statement in &body.statements {
            free.read(order::value_of(statement));
            let reads = free.reads(|call, input, word| {
                binder.contains_key(word) && self.is_choice_anywhere(call, input, word)
            });
            needs.push(reads.filter_map(|name| binder.get(name).copied()));
        }
        let (order, rings) = order::sort(&needs);
        for ring in &rings {
            let names: Vec<&str> =
                ring.iter().filter_map(|i| order::names_of(&body.statements[*i]).next()).collect();
            let span = ring.first().map_or(body.span, |i| order::value_of(&body.statements[*i]).span);
            let place = self.place(f, span);
            self.report(f, names::cycle(place, &names));
        }
        rings.is_empty().then(|| order.into_iter().map(|i| &body.statements[i]).collect())
    }

    /// Each name of a head and its body is bound once, and each accumulator assigned once.
    fn fold_names(&mut self, f: &mut Frame<'a>, fold: &'a Fold) {
        let mut bound: Vec<&'a Name> = fold.accumulators.iter().map(|(name, _)| name).collect();
        bound.push(&fold.variable);
        let mut assigned = Vec::new();
        for statement in &fold.body.statements {
            match statement {
                Statement::Let { pattern: Pattern::Name(name), .. } => bound.push(name),
                Statement::Let { pattern: Pattern::Record(names, _), .. } => bound.extend(names),
                Statement::Assign { name, .. } => assigned.push(name),
            }
        }
        for name in &assigned {
            self.accumulates(f, fold, name);
        }
        self.distinct(f, &bound);
        self.distinct(f, &assigned);
    }

    /// Reports an assignment to something that is no accumulator.
    fn accumulates(&mut self, f: &mut Frame<'a>, fold: &Fold, name: &Name) {
        let known = || fold.accumulators.iter().map(|(known, _)| known.text.as_str());
        if !known().any(|known| known == name.text) {
            let (at, near) = (self.place(f, name.span), self.near(&name.text, known()));
            self.report(f, names::no_such_accumulator(at, &name.text, near));
            // Reading it is the same slip.
            f.unknown.insert(&name.text);
        }
    }

    fn advance(
        &mut self,
        f: &mut Frame<'a>,
        fold: &Fold,
        next: &mut [Value],
        name: &Name,
        wire: &Wire,
        place: Place,
    ) -> bool {
        let position = fold.accumulators.iter().position(|(known, _)| known.text == name.text);
        let Some(slot) = position.and_then(|i| next.get_mut(i)) else { return false };
        let ty = f.builder.ty(*slot);
        let Some(scalar) = ty.scalar() else { return false };
        let Some(value) = self.value(f, wire, place) else { return false };
        let found = f.builder.ty(value);
        let fits = found.scalar().is_some_and(|from| types::widens(from, scalar));
        if !fits || (found.width() != 1 && found.width() != ty.width()) {
            let start = fold.accumulators.iter().find(|(known, _)| known.text == name.text);
            let start = self.place(f, start.map_or(name.span, |(_, start)| start.span));
            let (wanted, found) = (types::name(ty), types::name(found));
            self.report(f, errors::accumulator(place, &name.text, &wanted, &found, start));
            return false;
        }
        match self.coerce_value(f, &Wire::Value(value), scalar, ty.width(), place) {
            Some(value) => *slot = value,
            None => return false,
        }
        true
    }
}

/// Makes the accumulators inputs of the function being made, and puts them into its scope.
fn accumulators<'a>(f: &mut Frame<'a>, fold: &'a Fold, types: &[Type]) -> Vec<Value> {
    let mut values = Vec::new();
    for ((name, _), ty) in fold.accumulators.iter().zip(types) {
        let value = f.builder.input(name.text.clone(), *ty);
        f.scopes[f.base].entry(&name.text).or_insert(Wire::Value(value));
        values.push(value);
    }
    values
}

/// The most steps that a run of a function takes inside each other: 1 without a fold.
pub fn steps_of(function: &Function, known: &[u64]) -> u64 {
    let of = |id: FunctionId| known.get(id.0 as usize).copied().unwrap_or(1);
    let steps = function.values.iter().map(|operation| match operation {
        graph::Operation::Call(callee, _) => of(*callee),
        graph::Operation::Fold(fold) => u64::from(fold.most).saturating_mul(of(fold.body)),
        _ => 1,
    });
    steps.max().unwrap_or(1).max(1)
}
