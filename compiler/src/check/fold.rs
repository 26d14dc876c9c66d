//! Folds. For now only those whose steps are all known: their body is written out step by step.

use super::order::{self, Free};
use super::wire::Wire;
use super::{Checker, Frame, types};
use crate::diagnostic::{limits, names, types as errors, unsupported};
use crate::graph::{Constant, Scalar, Value};
use rustc_hash::FxHashMap;
use std::rc::Rc;
use texgraph_grammar::syntax::{Fold, Name, Pattern, Span, Statement};

/// Steps that are written out at most.
const MAX_STEPS: i64 = 256;

impl<'a> Checker<'a> {
    pub(super) fn fold(&mut self, f: &mut Frame<'a>, fold: &'a Fold, span: Span) -> Wire {
        let place = self.place(f, span);
        let mut accumulators: Vec<(&'a str, Value)> = Vec::new();
        for (name, start) in &fold.accumulators {
            let at = self.place(f, start.span);
            let wire = self.expr(f, start);
            let Some(value) = self.value(f, &wire, at) else { return Wire::Unknown };
            accumulators.push((&name.text, value));
        }
        let Some((first, last)) = self.steps(f, fold) else { return Wire::Unknown };
        if last - first > MAX_STEPS && fold.condition.is_none() {
            return self.report(f, limits::too_many_steps(place, last - first));
        }
        let Some(order) = self.fold_order(f, fold) else { return Wire::Unknown };
        for (taken, step) in (first..last).enumerate() {
            match self.goes_on(f, fold, &accumulators) {
                None => return Wire::Unknown,
                Some(false) => break,
                Some(true) if taken as i64 >= MAX_STEPS => {
                    return self.report(f, limits::too_many_steps(place, last - first));
                }
                Some(true) => {}
            }
            match self.fold_step(f, fold, &order, &accumulators, step as i32) {
                Some(next) => accumulators = next,
                None => return Wire::Unknown,
            }
        }
        let mut record: Vec<(String, Wire)> =
            accumulators.iter().map(|(name, value)| ((*name).to_owned(), Wire::Value(*value))).collect();
        if record.len() == 1 { record.remove(0).1 } else { Wire::Record(Rc::new(record)) }
    }

    /// The first step and the one behind the last.
    fn steps(&mut self, f: &mut Frame<'a>, fold: &'a Fold) -> Option<(i64, i64)> {
        let mut ends = Vec::new();
        for end in [&*fold.range.start, &*fold.range.end] {
            let at = self.place(f, end.span);
            let wire = self.expr(f, end);
            let value = self.value(f, &wire, at)?;
            if f.builder.ty(value).width() > 1 {
                self.report(f, unsupported::not_yet(at, "a fold over a box"));
                return None;
            }
            let value = self.coerce_value(f, &Wire::Value(value), Scalar::Int, 1, at)?;
            let Some(known) = f.builder.as_constant(value) else {
                self.report(f, unsupported::not_yet(at, "a fold with a computed range"));
                return None;
            };
            ends.push(i64::from(known.int(0)));
        }
        let last = ends[1] + i64::from(fold.range.inclusive);
        let last = match &fold.max {
            Some(max) => {
                let at = self.place(f, max.span);
                let wire = self.expr(f, max);
                let value = self.coerce_value(f, &wire, Scalar::Int, 1, at)?;
                let most = f.builder.as_constant(value).map_or(0, |c| i64::from(c.int(0)));
                last.min(ends[0] + most)
            }
            None => last,
        };
        Some((ends[0], last.max(ends[0])))
    }

    /// Whether the next step is taken; None when that is wrong or not known.
    fn goes_on(
        &mut self,
        f: &mut Frame<'a>,
        fold: &'a Fold,
        accumulators: &[(&'a str, Value)],
    ) -> Option<bool> {
        let Some(condition) = &fold.condition else { return Some(true) };
        let at = self.place(f, condition.span);
        f.scopes.push(scope(accumulators));
        let wire = self.expr(f, condition);
        f.scopes.pop();
        let value = self.coerce_value(f, &wire, Scalar::Bool, 1, at)?;
        let known = f.builder.as_constant(value);
        if known.is_none() {
            self.report(f, unsupported::not_yet(at, "a fold with a computed `while`"));
        }
        known.map(|known| known.bool(0))
    }

    /// The statements in an order that works; None when there is none, which is reported.
    fn fold_order(&mut self, f: &mut Frame<'a>, fold: &'a Fold) -> Option<Vec<&'a Statement>> {
        let body = &fold.body;
        self.fold_names(f, fold);
        let mut binder: FxHashMap<&str, usize> = FxHashMap::default();
        let lets = body.statements.iter().enumerate().filter(|(_, s)| matches!(s, Statement::Let { .. }));
        for (i, statement) in lets {
            binder.extend(order::names_of(statement).into_iter().map(|name| (name, i)));
        }
        // An accumulator read in the body is its previous value, so only wires make an order.
        let needs: Vec<Vec<usize>> = body
            .statements
            .iter()
            .map(|s| {
                Free::of(order::value_of(s))
                    .values
                    .iter()
                    .filter_map(|name| binder.get(name).copied())
                    .collect()
            })
            .collect();
        let (order, rings) = order::sort(&needs);
        for ring in &rings {
            let names: Vec<&str> =
                ring.iter().filter_map(|i| order::names_of(&body.statements[*i]).first().copied()).collect();
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
        self.distinct(f, bound.into_iter());
        self.distinct(f, assigned.into_iter());
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

    /// One step: the next values of the accumulators.
    fn fold_step(
        &mut self,
        f: &mut Frame<'a>,
        fold: &'a Fold,
        order: &[&'a Statement],
        accumulators: &[(&'a str, Value)],
        step: i32,
    ) -> Option<Vec<(&'a str, Value)>> {
        let mut names = scope(accumulators);
        names.insert(&fold.variable.text, Wire::Value(f.builder.constant(Constant::ints(&[step]))));
        f.scopes.push(names);
        f.foreign += 1;
        let mut next = accumulators.to_vec();
        let mut fine = true;
        for statement in order {
            let wire = self.expr(f, order::value_of(statement));
            fine &= !matches!(wire, Wire::Unknown);
            match statement {
                Statement::Let { pattern: Pattern::Name(name), .. } => self.bind(f, name, wire),
                Statement::Let { pattern: Pattern::Record(names, span), .. } => {
                    let place = self.place(f, *span);
                    self.take_apart(f, names, wire, place);
                }
                Statement::Assign { name, value } => {
                    let place = self.place(f, value.span);
                    fine &= self.advance(f, fold, &mut next, name, &wire, place);
                }
            }
        }
        f.foreign -= 1;
        f.scopes.pop();
        fine.then_some(next)
    }

    fn advance(
        &mut self,
        f: &mut Frame<'a>,
        fold: &Fold,
        next: &mut [(&'a str, Value)],
        name: &Name,
        wire: &Wire,
        place: crate::diagnostic::Place,
    ) -> bool {
        let Some((_, slot)) = next.iter_mut().find(|(known, _)| *known == name.text) else { return false };
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

fn scope<'a>(accumulators: &[(&'a str, Value)]) -> FxHashMap<&'a str, Wire> {
    accumulators.iter().map(|(name, value)| (*name, Wire::Value(*value))).collect()
}
