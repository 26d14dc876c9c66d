//! Runs a function over known numbers.
//!
//! Only what the outputs need is evaluated, of a choice only the arm that is taken; an operation
//! that is not needed may be anything. What is no number (a sample, say) is carried along as
//! unknown, so an argument or an accumulator that turns out not to matter does no harm.
//!
//! A stack of activations stands for recursion, so calls and folds of any depth are fine. No
//! function calls itself, and arguments are evaluated before a call: of each function one
//! activation runs at a time, and the memory of its values is used again by the next.

use super::{Constant, Fold, Function, FunctionId, Operation, Value};
use rustc_hash::FxHashMap;
use std::rc::Rc;

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
/// included; a call counts once for each argument, a step of a fold once for each accumulator, and
/// each of them and each test before a step at least once. Constants, inputs and outputs of calls
/// are free; what is read twice counts once.
///
/// # Errors
/// The outputs need something that is not a number, or the budget is used up.
pub fn evaluate(
    functions: &[Function],
    id: FunctionId,
    arguments: &[Constant],
    budget: &mut u64,
) -> Result<Vec<Constant>, Stopped> {
    let mut machine = Machine {
        functions,
        memories: Vec::new(),
        places: FxHashMap::default(),
        activations: Vec::new(),
        demands: Vec::new(),
        budget,
    };
    machine.enter(id, Inputs::Arguments(arguments.iter().copied().map(Some).collect()))?;
    let outputs = machine.run()?;
    outputs.iter().map(|number| number.ok_or(Stopped::NotConstant)).collect()
}

/// A number, if it is one.
type Number = Option<Constant>;

/// What is known of a value.
#[derive(Clone)]
enum State {
    Number(Number),
    /// The outputs of a call, the accumulators of a fold.
    Outputs(Rc<[Number]>),
}

/// What is known of the values of a function.
#[derive(Default)]
struct Memory {
    /// Each state with the activation that it was known in: those of earlier ones are void.
    states: Vec<(u64, State)>,
    activation: u64,
}

/// A function in execution.
struct Activation<'a> {
    function: &'a Function,
    /// Its memory.
    memory: usize,
    inputs: Inputs,
    /// Where its demands begin.
    base: usize,
    /// The fold that is running, if the last demand is one.
    running: Option<Running<'a>>,
}

/// What an activation was given.
enum Inputs {
    /// By a call.
    Arguments(Rc<[Number]>),
    /// By a fold: the accumulators, the number of the step (a test is not told), the captures.
    Step(Rc<[Number]>, Option<u32>, Rc<[Number]>),
}

impl Inputs {
    fn get(&self, i: usize) -> Number {
        match self {
            Inputs::Arguments(arguments) => arguments.get(i).copied().flatten(),
            Inputs::Step(accumulators, number, captures) => {
                let Some(behind) = i.checked_sub(accumulators.len()) else { return accumulators[i] };
                match (number, behind) {
                    (Some(number), 0) => Some(Constant::ints(&[*number as i32])),
                    (Some(_), _) => captures.get(behind - 1).copied().flatten(),
                    (None, _) => captures.get(behind).copied().flatten(),
                }
            }
        }
    }
}

/// A fold between two steps.
struct Running<'a> {
    fold: &'a Fold,
    taken: u32,
    steps: u32,
    testing: bool,
    accumulators: Rc<[Number]>,
    captures: Rc<[Number]>,
}

struct Machine<'a, 'b> {
    functions: &'a [Function],
    memories: Vec<Memory>,
    /// Which memory a function has.
    places: FxHashMap<FunctionId, usize>,
    activations: Vec<Activation<'a>>,
    /// The values that all activations wait for; the last is looked at next.
    demands: Vec<Value>,
    budget: &'b mut u64,
}

impl<'a> Machine<'a, '_> {
    /// Runs until the first activation is done; its outputs.
    fn run(&mut self) -> Result<Rc<[Number]>, Stopped> {
        loop {
            let Some(top) = self.activations.last() else { return Err(Stopped::NotConstant) };
            match self.demands.last().copied().filter(|_| self.demands.len() > top.base) {
                Some(value) if self.state(value).is_some() => {
                    self.demands.pop();
                }
                Some(value) => self.advance(value)?,
                None => {
                    let outputs = top.function.outputs.iter().map(|(_, value)| self.number(*value)).collect();
                    self.activations.pop();
                    if self.activations.is_empty() {
                        return Ok(outputs);
                    }
                    self.deliver(outputs)?;
                }
            }
        }
    }

    fn pay(&mut self, units: usize) -> Result<(), Stopped> {
        *self.budget = self.budget.checked_sub(units.max(1) as u64).ok_or(Stopped::Budget)?;
        Ok(())
    }

    /// Begins an activation: it waits for all outputs of the function.
    fn enter(&mut self, id: FunctionId, inputs: Inputs) -> Result<(), Stopped> {
        let function = self.functions.get(id.0 as usize).ok_or(Stopped::NotConstant)?;
        let next = self.memories.len();
        let memory = *self.places.entry(id).or_insert(next);
        if memory == next {
            let unknown = (0, State::Number(None));
            self.memories.push(Memory { states: vec![unknown; function.values.len()], activation: 0 });
        }
        self.memories[memory].activation += 1;
        let base = self.demands.len();
        self.demands.extend(function.outputs.iter().rev().map(|(_, value)| *value));
        self.activations.push(Activation { function, memory, inputs, base, running: None });
        Ok(())
    }

    /// What the last activation knows of a value.
    fn state(&self, value: Value) -> Option<&State> {
        let memory = &self.memories[self.activations.last()?.memory];
        let (activation, state) = memory.states.get(value.0 as usize)?;
        (*activation == memory.activation).then_some(state)
    }

    /// The number of a value that the last activation knows.
    fn number(&self, value: Value) -> Number {
        match self.state(value) {
            Some(State::Number(number)) => *number,
            _ => None,
        }
    }

    fn numbers(&self, values: &[Value]) -> Rc<[Number]> {
        values.iter().map(|value| self.number(*value)).collect()
    }

    /// The value that the last activation looks at is this.
    fn know(&mut self, state: State) {
        if let (Some(value), Some(top)) = (self.demands.pop(), self.activations.last()) {
            let memory = &mut self.memories[top.memory];
            if let Some(slot) = memory.states.get_mut(value.0 as usize) {
                *slot = (memory.activation, state);
            }
        }
    }

    /// Whether all operands are known; those that are not are waited for.
    fn has_operands(&mut self, operation: &Operation) -> bool {
        let before = self.demands.len();
        operation.for_operands(|v| {
            if self.state(v).is_none() {
                self.demands.push(v);
            }
        });
        self.demands.len() == before
    }

    /// Does what can be done for a value that is not known.
    fn advance(&mut self, value: Value) -> Result<(), Stopped> {
        let Some(top) = self.activations.last() else { return Ok(()) };
        let Some(operation) = top.function.values.get(value.0 as usize) else {
            return Err(Stopped::NotConstant);
        };
        match operation {
            Operation::Constant(number) => self.know(State::Number(Some(*number))),
            Operation::Input(i) => {
                let number = top.inputs.get(*i as usize);
                self.know(State::Number(number));
            }
            Operation::Select(condition, yes, no) => self.select(*condition, *yes, *no)?,
            Operation::Builtin(..)
            | Operation::Compose(_)
            | Operation::Extract(..)
            | Operation::Lookup(..)
            | Operation::Output(..)
            | Operation::Call(..)
            | Operation::Fold(_) => {
                if self.has_operands(operation) {
                    self.apply(operation)?;
                }
            }
            Operation::Param(_)
            | Operation::View(_)
            | Operation::Sample { .. }
            | Operation::Texel { .. }
            | Operation::Size(_)
            | Operation::Derivative(..) => self.know(State::Number(None)),
        }
        Ok(())
    }

    fn select(&mut self, condition: Value, yes: Value, no: Value) -> Result<(), Stopped> {
        if self.state(condition).is_none() {
            self.demands.push(condition);
            return Ok(());
        }
        let Some(holds) = self.number(condition) else {
            self.know(State::Number(None));
            return Ok(());
        };
        let chosen = if holds.bool(0) { yes } else { no };
        match self.state(chosen).cloned() {
            Some(state) => {
                self.pay(1)?;
                self.know(state);
            }
            None => self.demands.push(chosen),
        }
        Ok(())
    }

    /// An operation whose operands are known.
    fn apply(&mut self, operation: &'a Operation) -> Result<(), Stopped> {
        match operation {
            Operation::Output(of, i) => {
                let number = match self.state(*of) {
                    Some(State::Outputs(outputs)) => outputs.get(*i as usize).copied().flatten(),
                    _ => None,
                };
                self.know(State::Number(number));
            }
            Operation::Call(callee, arguments) => {
                self.pay(arguments.len())?;
                self.enter(*callee, Inputs::Arguments(self.numbers(arguments)))?;
            }
            Operation::Fold(fold) => self.begin(fold)?,
            _ => {
                let mut numbers = Some(Vec::new());
                operation.for_operands(|v| {
                    numbers = numbers.take().zip(self.number(v)).map(|(mut numbers, number)| {
                        numbers.push(number);
                        numbers
                    });
                });
                if numbers.is_some() {
                    self.pay(1)?;
                }
                self.know(State::Number(numbers.and_then(|numbers| applied(operation, &numbers))));
            }
        }
        Ok(())
    }

    /// Begins a fold.
    fn begin(&mut self, fold: &'a Fold) -> Result<(), Stopped> {
        let Some(steps) = self.number(fold.steps) else {
            self.know(State::Number(None));
            return Ok(());
        };
        let steps = u32::try_from(steps.int(0)).unwrap_or(0).min(fold.most);
        let (accumulators, captures) = (self.numbers(&fold.starts), self.numbers(&fold.captures));
        self.go_on(Running { fold, taken: 0, steps, testing: false, accumulators, captures })
    }

    /// Begins the next step of a fold, or the test before it, or ends the fold.
    fn go_on(&mut self, running: Running<'a>) -> Result<(), Stopped> {
        if running.taken == running.steps {
            self.know(State::Outputs(running.accumulators));
            return Ok(());
        }
        match running.fold.condition {
            Some(condition) => {
                self.pay(1)?;
                self.part(condition, None, Running { testing: true, ..running })
            }
            None => self.step(running),
        }
    }

    fn step(&mut self, running: Running<'a>) -> Result<(), Stopped> {
        self.pay(running.accumulators.len())?;
        self.part(running.fold.body, Some(running.taken), running)
    }

    /// Enters the body or the condition of a fold.
    fn part(&mut self, id: FunctionId, number: Option<u32>, running: Running<'a>) -> Result<(), Stopped> {
        let inputs = Inputs::Step(Rc::clone(&running.accumulators), number, Rc::clone(&running.captures));
        if let Some(top) = self.activations.last_mut() {
            top.running = Some(running);
        }
        self.enter(id, inputs)
    }

    /// What was entered last gives these.
    fn deliver(&mut self, outputs: Rc<[Number]>) -> Result<(), Stopped> {
        let running = self.activations.last_mut().and_then(|top| top.running.take());
        let Some(running) = running else {
            self.know(State::Outputs(outputs));
            return Ok(());
        };
        if running.testing {
            match outputs.first().copied().flatten() {
                Some(holds) if holds.bool(0) => return self.step(Running { testing: false, ..running }),
                Some(_) => self.know(State::Outputs(running.accumulators)),
                None => self.know(State::Number(None)),
            }
            return Ok(());
        }
        // What has lost all its numbers will hardly find one again.
        if outputs.iter().all(Option::is_none) {
            self.know(State::Outputs(outputs));
            return Ok(());
        }
        self.go_on(Running { taken: running.taken + 1, accumulators: outputs, ..running })
    }
}

/// An operation of known operands, given in order; none for one that is more than its operands.
pub(crate) fn applied(operation: &Operation, numbers: &[Constant]) -> Option<Constant> {
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
        // Five steps of two operations and two accumulators each.
        let (result, used) = run(&functions, &[int(5), int(3)], 20);
        assert_eq!((result.is_ok(), used), (true, 20));
        assert_eq!(run(&functions, &[int(5), int(3)], 19).0, Err(Stopped::Budget));
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
    fn a_fold_that_tests_or_counts_something_unknown_has_no_result() {
        for unknown in ["steps", "condition"] {
            let mut b = Builder::new("caller");
            let param = b.push(Operation::Param(ParamId(0)), Type::INT);
            let (steps, start) = (b.constant(int(4)), b.constant(int(0)));
            let fold = Fold {
                body: FunctionId(0),
                condition: Some(FunctionId(1)),
                starts: vec![start, if unknown == "condition" { param } else { start }],
                steps: if unknown == "steps" { param } else { steps },
                most: 4,
                captures: vec![start],
            };
            let total = b.fold(fold)[0];
            b.output("total", total);
            assert_eq!(run(&[body(), condition(), b.finish()], &[], 99).0, Err(Stopped::NotConstant));
        }
    }

    #[test]
    fn a_fold_of_samples_stops_at_once() {
        let mut b = Builder::new("body");
        let sum = b.input("sum", Type::INT);
        b.input("step", Type::INT);
        let param = b.push(Operation::Param(ParamId(0)), Type::INT);
        let sum = b.builtin(ADD_INT, &[sum, param]);
        b.output("sum", sum);
        let body = b.finish();
        let mut b = Builder::new("caller");
        let (steps, start) = (b.constant(int(60_000)), b.constant(int(0)));
        let fold = Fold {
            body: FunctionId(0),
            condition: None,
            starts: vec![start],
            steps,
            most: 60_000,
            captures: Vec::new(),
        };
        let sum = b.fold(fold)[0];
        b.output("sum", sum);
        let (result, used) = run(&[body, b.finish()], &[], 1000);
        assert_eq!((result, used), (Err(Stopped::NotConstant), 1));
    }

    #[test]
    fn a_call_of_a_call_of_the_same_function() {
        let mut b = Builder::new("caller");
        let mut x = b.input("x", Type::INT);
        for _ in 0..1000 {
            x = b.call(FunctionId(0), &successor(), vec![x])[0];
        }
        b.output("x", x);
        assert_eq!(run(&[successor(), b.finish()], &[int(5)], 2000), (Ok(vec![int(1005)]), 2000));
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
