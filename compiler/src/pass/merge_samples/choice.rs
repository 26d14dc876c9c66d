//! One operation in the place of those in both arms of a choice, over chosen operands.

use crate::graph::regions::{Branch, Regions, Weights};
use crate::graph::{Builder, Fold, Function, Level, Operation, Type, Value};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// The function with everything merged that can be; none if there is nothing.
pub fn merged(function: &Function, weights: &Weights) -> Option<Function> {
    // The library's functions have been here before.
    let has_choices = function.values.iter().any(|operation| matches!(operation, Operation::Select(..)));
    if function.origin.is_some() || !has_choices {
        return None;
    }
    let plan = Plan::of(function, &Regions::of(function, weights), weights);
    (!plan.merged.is_empty()).then(|| Merging::new(function, &plan).run())
}

/// Something costly: an operation of the function, or what several become.
#[derive(Clone, Copy)]
enum Item {
    Own(Value),
    Merged(usize),
}

/// Two that become one.
#[derive(Clone, Copy)]
struct Merged {
    condition: Value,
    /// What is done where the condition holds, and where it does not.
    arms: [Item; 2],
}

/// What becomes of a function.
struct Plan<'a> {
    function: &'a Function,
    merged: Vec<Merged>,
    /// Of operations that are no longer done by themselves the one that does all of it.
    of: FxHashMap<Value, usize>,
}

impl<'a> Plan<'a> {
    /// Inner branches come before those around them, so what an inner one merges may be merged
    /// again.
    fn of(function: &'a Function, regions: &Regions, weights: &Weights) -> Plan<'a> {
        let mut plan = Plan { function, merged: Vec::new(), of: FxHashMap::default() };
        let mut items: FxHashMap<_, Vec<(Value, Item)>> = FxHashMap::default();
        for (value, operation) in function.iter() {
            if let Some(place) = regions.place(value).filter(|_| weights.is_heavy(operation)) {
                items.entry(place).or_default().push((value, Item::Own(value)));
            }
        }
        for Branch { condition, arms, choices } in regions.branches() {
            let [yes, no] = arms.map(|arm| items.remove(&arm).unwrap_or_default());
            let (Some(place), first) = (regions.place(choices[0]), choices[0]) else { continue };
            for arms in plan.pairs(&yes, &no) {
                plan.merged.push(Merged { condition: *condition, arms });
                let around = items.entry(place).or_default();
                let behind = around.partition_point(|(before, _)| *before < first);
                around.insert(behind, (first, Item::Merged(plan.merged.len() - 1)));
            }
        }
        for i in 0..plan.merged.len() {
            // Later ones are around earlier ones.
            for own in plan.operations(Item::Merged(i)) {
                plan.of.insert(own, i);
            }
        }
        plan
    }

    /// Pairs of like items, in the order of both: so none waits for another that waits for it.
    fn pairs(&self, yes: &[(Value, Item)], no: &[(Value, Item)]) -> Vec<[Item; 2]> {
        let mut pairs = Vec::new();
        let mut rest = no;
        for (_, item) in yes {
            if let Some(other) = rest.iter().position(|(_, other)| self.alike(*item, *other)) {
                pairs.push([*item, rest[other].1]);
                rest = &rest[other + 1..];
            }
        }
        pairs
    }

    /// The first operation of an item: all of them are alike.
    fn first(&self, mut item: Item) -> Value {
        loop {
            match item {
                Item::Own(value) => return value,
                Item::Merged(i) => item = self.merged[i].arms[0],
            }
        }
    }

    /// The operations of the function that an item stands for.
    fn operations(&self, item: Item) -> Vec<Value> {
        let (mut all, mut stack) = (Vec::new(), vec![item]);
        while let Some(item) = stack.pop() {
            match item {
                Item::Own(value) => all.push(value),
                Item::Merged(i) => stack.extend(self.merged[i].arms),
            }
        }
        all
    }

    /// Whether two are the same but for operands that can be chosen: views can not.
    fn alike(&self, a: Item, b: Item) -> bool {
        let (a, b) = (self.function.operation(self.first(a)), self.function.operation(self.first(b)));
        let same = match (a, b) {
            (
                Operation::Sample { layer, level, .. },
                Operation::Sample { layer: other_layer, level: other_level, .. },
            ) => {
                let levels = matches!(
                    (level, other_level),
                    (Level::Auto, Level::Auto) | (Level::Level(_), Level::Level(_))
                );
                levels && layer.is_some() == other_layer.is_some()
            }
            (Operation::Call(callee, _), Operation::Call(other, _)) => callee == other,
            (Operation::Fold(fold), Operation::Fold(other)) => {
                let key = |fold: &Fold| (fold.body, fold.condition, fold.most, fold.starts.len());
                key(fold) == key(other)
            }
            _ => false,
        };
        let (a, b) = (operands(a), operands(b));
        let fits = |(a, b): (&Value, &Value)| {
            let (ty, other) = (self.function.ty(*a), self.function.ty(*b));
            ty == other && (!matches!(ty, Type::View(_)) || a == b)
        };
        same && a.len() == b.len() && a.iter().zip(&b).all(fits)
    }
}

fn operands(operation: &Operation) -> Vec<Value> {
    let mut operands = Vec::new();
    operation.for_operands(|v| operands.push(v));
    operands
}

/// A function being made anew. Values are made in the old order, but for what something merged
/// waits for.
struct Merging<'a> {
    function: &'a Function,
    plan: &'a Plan<'a>,
    builder: Builder,
    values: Vec<Option<Value>>,
}

impl<'a> Merging<'a> {
    fn new(function: &'a Function, plan: &'a Plan<'a>) -> Merging<'a> {
        let mut builder = Builder::with_capacity(function.name.clone(), function.values.len());
        builder.set_inline(function.inline);
        Merging { function, plan, builder, values: vec![None; function.values.len()] }
    }

    fn run(mut self) -> Function {
        let function = self.function;
        let inputs: Vec<Value> =
            function.inputs.iter().map(|slot| self.builder.input(slot.name.clone(), slot.ty)).collect();
        for (value, operation) in function.iter() {
            if let Operation::Input(i) = operation {
                self.values[value.0 as usize] = inputs.get(*i as usize).copied();
            }
        }
        // What is merged is made when the first needs it.
        for (value, _) in function.iter().filter(|(value, _)| !self.plan.of.contains_key(value)) {
            self.make(value);
        }
        for (slot, value) in &function.outputs {
            self.make(*value);
            let value = self.value(*value);
            self.builder.output(slot.name.clone(), value);
        }
        self.builder.finish()
    }

    fn value(&self, old: Value) -> Value {
        self.values[old.0 as usize].unwrap_or(Value(0))
    }

    /// Makes a value, and before it what it needs and is not there yet.
    fn make(&mut self, value: Value) {
        let mut stack = vec![value];
        while let Some(top) = stack.last().copied() {
            if self.values[top.0 as usize].is_some() {
                stack.pop();
                continue;
            }
            let merged = self.plan.of.get(&top).copied();
            let needs = match merged {
                Some(i) => self.needs(i),
                None => operands(self.function.operation(top)),
            };
            let before = stack.len();
            stack.extend(needs.into_iter().filter(|need| self.values[need.0 as usize].is_none()));
            if stack.len() > before {
                continue;
            }
            stack.pop();
            match merged {
                Some(i) => self.merge(i),
                None => self.copy(top),
            }
        }
    }

    /// What something merged is made of: the operands of all that it stands for, and what chooses
    /// between them.
    fn needs(&self, i: usize) -> Vec<Value> {
        let (mut needs, mut stack) = (Vec::new(), vec![Item::Merged(i)]);
        while let Some(item) = stack.pop() {
            match item {
                Item::Own(value) => needs.extend(operands(self.function.operation(value))),
                Item::Merged(i) => {
                    needs.push(self.plan.merged[i].condition);
                    stack.extend(self.plan.merged[i].arms);
                }
            }
        }
        needs
    }

    fn merge(&mut self, i: usize) {
        let first = self.plan.first(Item::Merged(i));
        self.builder.set_place(self.function.places[first.0 as usize]);
        let mut place = 0;
        let operation = self.function.operation(first).map_operands(|_| {
            place += 1;
            self.chosen(Item::Merged(i), place - 1)
        });
        let value = self.builder.push(operation, self.function.ty(first));
        for own in self.plan.operations(Item::Merged(i)) {
            self.values[own.0 as usize] = Some(value);
        }
    }

    /// An operand of an item. Branches nest no deeper than blocks may.
    fn chosen(&mut self, item: Item, operand: usize) -> Value {
        match item {
            Item::Own(value) => self.value(operands(self.function.operation(value))[operand]),
            Item::Merged(i) => {
                let Merged { condition, arms } = self.plan.merged[i];
                let [yes, no] = arms.map(|arm| self.chosen(arm, operand));
                if yes == no {
                    return yes;
                }
                let condition = self.value(condition);
                self.builder.select(condition, yes, no)
            }
        }
    }

    fn copy(&mut self, old: Value) {
        self.builder.set_place(self.function.places[old.0 as usize]);
        let operation = self.function.operation(old).map_operands(|v| self.value(v));
        let value = self.builder.push(operation, self.function.ty(old));
        self.values[old.0 as usize] = Some(value);
        if let Some(name) = self.function.names.get(old) {
            self.builder.name(value, Arc::clone(name));
        }
    }
}
