//! Runs a function over known numbers.
//!
//! Call by need: only what the outputs really need is evaluated, so of a choice only the arm that
//! is taken, of a call only the arguments and outputs that are read, of a fold only the
//! accumulators that matter; an operation that is not needed may be anything. A stack of demands
//! stands for recursion, so calls and folds of any depth are fine.

use super::{Constant, Fold, Function, FunctionId, Operation, Value};
use rustc_hash::FxHashMap;

/// Why there is no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stopped {
    /// A param, a texture or a screen derivative is really needed.
    NotConstant,
    /// More operations than the budget allows.
    Budget,
}

/// The outputs of a function of `functions` for known inputs, in order.
///
/// One unit of `budget` is taken for each operation evaluated, those inside calls and folds
/// included, and one for each step of a fold and each test before one. Constants, inputs and
/// outputs of calls are free; what is read twice counts once.
///
/// # Errors
/// The outputs need something that is not a number, or the budget is used up.
pub fn evaluate(
    functions: &[Function],
    id: FunctionId,
    arguments: &[Constant],
    budget: &mut u64,
) -> Result<Vec<Constant>, Stopped> {
    let function = functions.get(id.0 as usize).ok_or(Stopped::NotConstant)?;
    let mut machine = Machine {
        functions,
        activations: vec![Activation { function, entered: Entered::Start(arguments) }],
        known: FxHashMap::default(),
        calls: FxHashMap::default(),
        folds: FxHashMap::default(),
        budget,
    };
    function.outputs.iter().map(|(_, value)| machine.number((0, *value))).collect()
}

/// A value of an activation.
type Demand = (usize, Value);

/// A function in execution: its values have one meaning each.
#[derive(Clone, Copy)]
struct Activation<'a> {
    function: &'a Function,
    entered: Entered<'a>,
}

/// How an activation came to be: where its inputs come from.
#[derive(Clone, Copy)]
enum Entered<'a> {
    /// From outside.
    Start(&'a [Constant]),
    /// By a call in another activation.
    Call(usize, &'a [Value]),
    /// As a step of a fold, or as the test before one.
    Step(Step<'a>),
}

#[derive(Clone, Copy)]
struct Step<'a> {
    /// The activation that the fold stands in.
    outer: usize,
    fold: &'a Fold,
    /// The step before; the accumulators are the starts when none.
    previous: Option<usize>,
    /// Which step; none for a test, which is not told.
    number: Option<u32>,
}

/// What an input is.
enum Source {
    Number(Constant),
    Value(Demand),
}

/// How far a fold has come.
#[derive(Clone, Copy, Default)]
struct Progress {
    taken: u32,
    last: Option<usize>,
    /// The test before the next step.
    test: Option<usize>,
    done: bool,
}

struct Machine<'a, 'b> {
    functions: &'a [Function],
    activations: Vec<Activation<'a>>,
    known: FxHashMap<Demand, Constant>,
    /// The activation behind a call.
    calls: FxHashMap<Demand, usize>,
    folds: FxHashMap<Demand, Progress>,
    budget: &'b mut u64,
}

/// What is to be done next for a demand.
enum Next {
    /// It is this number.
    Is(Constant),
    /// It waits for another.
    Needs(Demand),
    /// It has no number of its own, and is done: a fold.
    Done,
}

impl<'a> Machine<'a, '_> {
    /// The number behind a demand.
    fn number(&mut self, demand: Demand) -> Result<Constant, Stopped> {
        let mut stack = vec![demand];
        while let Some(top) = stack.last() {
            match self.next(*top)? {
                Next::Is(number) => {
                    self.known.insert(*top, number);
                    stack.pop();
                }
                Next::Needs(other) => stack.push(other),
                Next::Done => {
                    stack.pop();
                }
            }
        }
        self.known.get(&demand).copied().ok_or(Stopped::NotConstant)
    }

    fn next(&mut self, demand: Demand) -> Result<Next, Stopped> {
        if let Some(number) = self.known.get(&demand) {
            return Ok(Next::Is(*number));
        }
        let at = demand.0;
        match self.operation(demand)? {
            Operation::Constant(number) => Ok(Next::Is(*number)),
            Operation::Input(i) => self.input(at, *i as usize),
            Operation::Output(of, i) => self.output(at, *of, *i as usize),
            Operation::Fold(fold) => self.fold(demand, fold),
            Operation::Select(condition, yes, no) => match self.known.get(&(at, *condition)) {
                Some(condition) => {
                    let chosen = (at, if condition.bool(0) { *yes } else { *no });
                    self.forward(chosen, true)
                }
                None => Ok(Next::Needs((at, *condition))),
            },
            operation @ (Operation::Builtin(..)
            | Operation::Compose(_)
            | Operation::Extract(..)
            | Operation::Lookup(..)) => self.strict(at, operation),
            Operation::Param(_)
            | Operation::View(_)
            | Operation::Sample { .. }
            | Operation::Texel { .. }
            | Operation::Size(_)
            | Operation::Call(..)
            | Operation::Derivative(..) => Err(Stopped::NotConstant),
        }
    }

    fn operation(&self, (at, value): Demand) -> Result<&'a Operation, Stopped> {
        self.activations[at].function.values.get(value.0 as usize).ok_or(Stopped::NotConstant)
    }

    fn pay(&mut self) -> Result<(), Stopped> {
        *self.budget = self.budget.checked_sub(1).ok_or(Stopped::Budget)?;
        Ok(())
    }

    /// What is the same as another value.
    fn forward(&mut self, other: Demand, counts: bool) -> Result<Next, Stopped> {
        let Some(number) = self.known.get(&other).copied() else { return Ok(Next::Needs(other)) };
        if counts {
            self.pay()?;
        }
        Ok(Next::Is(number))
    }

    /// What needs all of its operands.
    fn strict(&mut self, at: usize, operation: &Operation) -> Result<Next, Stopped> {
        let mut numbers = Vec::new();
        let mut missing = None;
        operation.for_operands(|v| match self.known.get(&(at, v)) {
            Some(number) => numbers.push(*number),
            None => missing = Some((at, v)),
        });
        if let Some(missing) = missing {
            return Ok(Next::Needs(missing));
        }
        self.pay()?;
        applied(operation, &numbers).map(Next::Is).ok_or(Stopped::NotConstant)
    }

    fn input(&mut self, at: usize, i: usize) -> Result<Next, Stopped> {
        let source = match self.activations[at].entered {
            Entered::Start(arguments) => arguments.get(i).copied().map(Source::Number),
            Entered::Call(caller, arguments) => arguments.get(i).map(|v| Source::Value((caller, *v))),
            Entered::Step(step) => self.step_input(step, i),
        };
        match source.ok_or(Stopped::NotConstant)? {
            Source::Number(number) => Ok(Next::Is(number)),
            Source::Value(other) => self.forward(other, false),
        }
    }

    /// The accumulators, the number of the step (for a step, not for a test), the captures.
    fn step_input(&self, step: Step<'a>, i: usize) -> Option<Source> {
        let Some(behind) = i.checked_sub(step.fold.starts.len()) else {
            return self.accumulator(step.outer, step.fold, step.previous, i).map(Source::Value);
        };
        let capture = match (step.number, behind) {
            (Some(number), 0) => return Some(Source::Number(Constant::ints(&[number as i32]))),
            (Some(_), _) => behind - 1,
            (None, _) => behind,
        };
        step.fold.captures.get(capture).map(|v| Source::Value((step.outer, *v)))
    }

    /// Accumulator `i` after a step, or before the first.
    fn accumulator(&self, outer: usize, fold: &Fold, after: Option<usize>, i: usize) -> Option<Demand> {
        match after {
            Some(step) => self.activations[step].function.outputs.get(i).map(|(_, value)| (step, *value)),
            None => fold.starts.get(i).map(|start| (outer, *start)),
        }
    }

    fn output(&mut self, at: usize, of: Value, i: usize) -> Result<Next, Stopped> {
        let inner = match self.operation((at, of))? {
            Operation::Call(callee, arguments) => {
                let callee = self.call((at, of), *callee, arguments)?;
                self.activations[callee].function.outputs.get(i).map(|(_, value)| (callee, *value))
            }
            Operation::Fold(fold) => match self.folds.get(&(at, of)) {
                Some(Progress { done: true, last, .. }) => self.accumulator(at, fold, *last, i),
                _ => return Ok(Next::Needs((at, of))),
            },
            _ => None,
        };
        self.forward(inner.ok_or(Stopped::NotConstant)?, false)
    }

    /// The activation behind a call.
    fn call(&mut self, call: Demand, callee: FunctionId, arguments: &'a [Value]) -> Result<usize, Stopped> {
        if let Some(entered) = self.calls.get(&call) {
            return Ok(*entered);
        }
        let entered = self.enter(callee, Entered::Call(call.0, arguments))?;
        self.calls.insert(call, entered);
        Ok(entered)
    }

    fn enter(&mut self, id: FunctionId, entered: Entered<'a>) -> Result<usize, Stopped> {
        self.pay()?;
        let function = self.functions.get(id.0 as usize).ok_or(Stopped::NotConstant)?;
        self.activations.push(Activation { function, entered });
        Ok(self.activations.len() - 1)
    }

    /// Takes the steps of a fold, as far as its tests are known.
    fn fold(&mut self, demand: Demand, fold: &'a Fold) -> Result<Next, Stopped> {
        let outer = demand.0;
        let Some(steps) = self.known.get(&(outer, fold.steps)) else {
            return Ok(Next::Needs((outer, fold.steps)));
        };
        let steps = u32::try_from(steps.int(0)).unwrap_or(0).min(fold.most);
        let mut progress = self.folds.get(&demand).copied().unwrap_or_default();
        while progress.taken < steps {
            let step = Step { outer, fold, previous: progress.last, number: None };
            match self.test(step, &mut progress)? {
                Next::Is(holds) if holds.bool(0) => {}
                Next::Needs(other) => {
                    self.folds.insert(demand, progress);
                    return Ok(Next::Needs(other));
                }
                _ => break,
            }
            let step = Step { number: Some(progress.taken), ..step };
            progress = Progress {
                taken: progress.taken + 1,
                last: Some(self.enter(fold.body, Entered::Step(step))?),
                ..Progress::default()
            };
        }
        self.folds.insert(demand, Progress { done: true, ..progress });
        Ok(Next::Done)
    }

    /// Whether a step is to be taken.
    fn test(&mut self, step: Step<'a>, progress: &mut Progress) -> Result<Next, Stopped> {
        let Some(condition) = step.fold.condition else { return Ok(Next::Is(Constant::bools(&[true]))) };
        let test = match progress.test {
            Some(test) => test,
            None => self.enter(condition, Entered::Step(step))?,
        };
        progress.test = Some(test);
        let (_, holds) = self.activations[test].function.outputs.first().ok_or(Stopped::NotConstant)?;
        self.forward((test, *holds), false)
    }
}

/// An operation of known operands, given in order.
fn applied(operation: &Operation, numbers: &[Constant]) -> Option<Constant> {
    let first = numbers.first();
    match operation {
        Operation::Builtin(intrinsic, _) => Some(intrinsic.evaluate(numbers)),
        Operation::Compose(_) => {
            Some(Constant::new(first?.scalar(), numbers.iter().flat_map(|c| c.bits().first().copied())))
        }
        Operation::Extract(_, i) => Some(first?.component(usize::from(*i))),
        Operation::Lookup(table, _) => {
            let last = table.len().saturating_sub(1);
            let entry = usize::try_from(first?.int(0)).unwrap_or(0).min(last);
            table.get(entry).copied()
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::{Builder, ParamId, Type};
    use crate::intrinsic::{ADD_INT, COMPONENT_LESS_INT, MULTIPLY_INT};

    fn int(i: i32) -> Constant {
        Constant::ints(&[i])
    }

    fn run(
        functions: &[Function],
        arguments: &[Constant],
        budget: u64,
    ) -> (Result<Vec<Constant>, Stopped>, u64) {
        let mut left = budget;
        let result = evaluate(functions, FunctionId(functions.len() as u32 - 1), arguments, &mut left);
        (result, budget - left)
    }

    /// x → x + 1
    fn successor() -> Function {
        let mut b = Builder::new("successor");
        let x = b.input("x", Type::INT);
        let one = b.constant(int(1));
        let y = b.builtin(ADD_INT, &[x, one]);
        b.output("y", y);
        b.finish()
    }

    /// (total, product, step, factor) → (total + step, product · factor)
    fn body() -> Function {
        let mut b = Builder::new("body");
        let [total, product, step, factor] =
            ["total", "product", "step", "factor"].map(|name| b.input(name, Type::INT));
        let total = b.builtin(ADD_INT, &[total, step]);
        let product = b.builtin(MULTIPLY_INT, &[product, factor]);
        b.output("total", total);
        b.output("product", product);
        b.finish()
    }

    /// (total, product, factor) → product < 1000
    fn condition() -> Function {
        let mut b = Builder::new("condition");
        let [_, product, _] = ["total", "product", "factor"].map(|name| b.input(name, Type::INT));
        let bound = b.constant(int(1000));
        let less = b.builtin(COMPONENT_LESS_INT, &[product, bound]);
        b.output("less", less);
        b.finish()
    }

    /// (steps, factor) → the accumulators of [`body`] from 0 and 1.
    fn folding(condition: Option<FunctionId>, most: u32) -> Function {
        let mut b = Builder::new("folding");
        let [steps, factor] = ["steps", "factor"].map(|name| b.input(name, Type::INT));
        let starts = vec![b.constant(int(0)), b.constant(int(1))];
        let fold = Fold { body: FunctionId(0), condition, starts, steps, most, captures: vec![factor] };
        for (i, value) in b.fold(fold).into_iter().enumerate() {
            b.output(i.to_string(), value);
        }
        b.finish()
    }

    #[test]
    fn a_fold_takes_its_steps() {
        let functions = [body(), folding(None, 100)];
        assert_eq!(run(&functions, &[int(5), int(3)], 1000).0, Ok(vec![int(10), int(243)]));
        assert_eq!(run(&functions, &[int(0), int(3)], 1000).0, Ok(vec![int(0), int(1)]));
        assert_eq!(run(&functions, &[int(-7), int(3)], 1000).0, Ok(vec![int(0), int(1)]));
        assert_eq!(run(&functions, &[int(i32::MAX), int(1)], 1000).0, Ok(vec![int(4950), int(1)]));
    }

    #[test]
    fn a_condition_ends_a_fold_before_a_step() {
        let functions = [body(), condition(), folding(Some(FunctionId(1)), 100)];
        // 10³ does not hold any more: three steps.
        assert_eq!(run(&functions, &[int(50), int(10)], 1000).0, Ok(vec![int(3), int(1000)]));
        assert_eq!(run(&functions, &[int(2), int(10)], 1000).0, Ok(vec![int(1), int(100)]));
    }

    #[test]
    fn the_budget_is_the_number_of_operations() {
        let functions = [body(), folding(None, 100)];
        // Five steps of two operations each.
        let (result, used) = run(&functions, &[int(5), int(3)], 15);
        assert_eq!((result.is_ok(), used), (true, 15));
        assert_eq!(run(&functions, &[int(5), int(3)], 14).0, Err(Stopped::Budget));
    }

    #[test]
    fn only_what_is_needed_must_be_known() {
        let mut b = Builder::new("chosen");
        let which = b.input("which", Type::BOOL);
        let param = b.push(Operation::Param(ParamId(0)), Type::INT);
        let (one, two) = (b.constant(int(1)), b.constant(int(2)));
        let sum = b.builtin(ADD_INT, &[param, one]);
        let chosen = b.select(which, two, sum);
        b.output("chosen", chosen);
        let functions = [b.finish()];
        assert_eq!(run(&functions, &[Constant::bools(&[true])], 9).0, Ok(vec![int(2)]));
        assert_eq!(run(&functions, &[Constant::bools(&[false])], 9).0, Err(Stopped::NotConstant));
    }

    #[test]
    fn an_argument_that_is_not_read_may_be_anything() {
        let mut b = Builder::new("caller");
        let param = b.push(Operation::Param(ParamId(0)), Type::INT);
        let (steps, start) = (b.constant(int(4)), b.constant(int(0)));
        let fold = Fold {
            body: FunctionId(0),
            condition: None,
            starts: vec![start, param],
            steps,
            most: 4,
            captures: vec![param],
        };
        let total = b.fold(fold)[0];
        b.output("total", total);
        assert_eq!(run(&[body(), b.finish()], &[], 99).0, Ok(vec![int(6)]));
    }

    #[test]
    fn a_table_clamps() {
        let mut b = Builder::new("table");
        let index = b.input("index", Type::INT);
        let entry = b.lookup([int(7), int(8)].into(), index);
        b.output("entry", entry);
        let functions = [b.finish()];
        for (index, entry) in [(i32::MIN, 7), (0, 7), (1, 8), (2, 8)] {
            assert_eq!(run(&functions, &[int(index)], 9).0, Ok(vec![int(entry)]));
        }
    }

    #[test]
    fn ten_thousand_functions_deep() {
        let mut functions = vec![successor()];
        for i in 0..10_000 {
            let mut b = Builder::new("next");
            let x = b.input("x", Type::INT);
            let one = b.constant(int(1));
            let x = b.builtin(ADD_INT, &[x, one]);
            let y = b.call(FunctionId(i), &functions[i as usize], vec![x])[0];
            b.output("y", y);
            functions.push(b.finish());
        }
        assert_eq!(run(&functions, &[int(0)], 1_000_000).0, Ok(vec![int(10_001)]));
    }

    #[test]
    fn folds_within_folds() {
        // Each fold runs the one before it twice: 2¹⁶ successors.
        let mut functions = vec![successor()];
        for i in 0..16_u32 {
            let mut b = Builder::new("twice");
            let x = b.input("x", Type::INT);
            b.input("step", Type::INT);
            let steps = b.constant(int(2));
            let fold = Fold {
                body: FunctionId(i),
                condition: None,
                starts: vec![x],
                steps,
                most: 2,
                captures: Vec::new(),
            };
            let y = b.fold(fold)[0];
            b.output("y", y);
            functions.push(b.finish());
        }
        assert_eq!(run(&functions, &[int(0), int(0)], 1_000_000).0, Ok(vec![int(65_536)]));
        assert_eq!(run(&functions, &[int(0), int(0)], 100_000).0, Err(Stopped::Budget));
    }
}
