//! Runs a plan: one operation after the other, calls and folds on a stack of frames of its own, so
//! that no depth of them overflows the thread's.
//!
//! A fold is one frame, its body's, whose inputs are the accumulators, the number of the step and
//! the captures: at the end of a step the outputs take the accumulators' places, and the body runs
//! again.

use super::evaluate::{evaluate, zero};
use super::plan::{Planned, Step};
use super::texture::Texture;
use texgraph_compiler::graph::{Constant, Fold, FunctionId, Operation, Value};

/// Runs planned functions. Made once per thread, it keeps its memory between pixels.
pub struct Machine<'a> {
    functions: &'a [Planned],
    textures: &'a [Texture],
    frames: Vec<Frame>,
    /// The frames' values, one frame after the other.
    values: Vec<Constant>,
    outputs: Vec<Constant>,
    /// Memory to use again: what a function is given, or gives.
    arguments: Vec<Constant>,
}

/// A function that is running.
#[derive(Clone, Copy)]
struct Frame {
    function: usize,
    /// Where its values begin.
    base: usize,
    /// The step to do next.
    next: usize,
    role: Role,
}

/// What a function runs for.
#[derive(Clone, Copy)]
enum Role {
    Call,
    Condition,
    Body(Loop),
}

/// A fold that is running.
#[derive(Clone, Copy)]
struct Loop {
    condition: Option<FunctionId>,
    accumulators: usize,
    captures: usize,
    /// The step that is next, or being done.
    step: u32,
    /// How many steps there are.
    steps: u32,
}

impl<'a> Machine<'a> {
    /// A machine over functions and textures.
    pub fn new(functions: &'a [Planned], textures: &'a [Texture]) -> Machine<'a> {
        Machine {
            functions,
            textures,
            frames: Vec::new(),
            values: Vec::new(),
            outputs: Vec::new(),
            arguments: Vec::new(),
        }
    }

    /// Runs a function; its outputs. Those that were not planned are 0.
    pub fn run(&mut self, function: usize, inputs: impl Iterator<Item = Constant>) -> &[Constant] {
        self.arguments.clear();
        self.arguments.extend(inputs);
        self.outputs.clear();
        self.enter(function, Role::Call);
        self.work();
        &self.outputs
    }

    /// Runs a fold whose operands `read` gives; its accumulators.
    pub fn run_fold(&mut self, fold: &Fold, read: impl Fn(Value) -> Constant) -> &[Constant] {
        self.outputs.clear();
        let started = started(fold, read, &mut self.arguments);
        self.enter_fold(fold.body, started);
        self.work();
        &self.outputs
    }

    /// Goes on until no function runs.
    fn work(&mut self) {
        while let Some(frame) = self.frames.last_mut() {
            let planned = &self.functions[frame.function];
            let step = planned.steps.get(frame.next);
            frame.next += 1;
            let base = frame.base;
            match step {
                Some(step) => self.step(planned, base, step),
                None => self.leave(planned),
            }
        }
    }

    /// Does one step, or begins what it runs.
    fn step(&mut self, planned: &'a Planned, base: usize, step: &'a Step) {
        match &step.operation {
            Operation::Call(callee, arguments) => {
                self.arguments.clear();
                let frame = &self.values[base..];
                self.arguments.extend(arguments.iter().map(|value| read(planned, frame, *value)));
                self.enter(callee.0 as usize, Role::Call);
            }
            Operation::Fold(fold) => {
                let frame = &self.values[base..];
                let started = started(fold, |value| read(planned, frame, value), &mut self.arguments);
                self.enter_fold(fold.body, started);
            }
            operation => {
                let frame = &self.values[base..];
                let read = |value| read(planned, frame, value);
                let value = evaluate(operation, read, self.textures, &mut self.arguments);
                self.values[base + step.target.0 as usize - planned.known.len()] = value;
            }
        }
    }

    /// Begins a function whose inputs are the arguments; whether there is such a function.
    fn enter(&mut self, function: usize, role: Role) -> bool {
        let Some(planned) = self.functions.get(function) else { return false };
        let base = self.values.len();
        self.values.extend(self.arguments.iter().take(planned.slots));
        self.values.resize(base + planned.slots, zero());
        self.frames.push(Frame { function, base, next: 0, role });
        true
    }

    /// Begins a fold whose body's inputs are the arguments.
    fn enter_fold(&mut self, body: FunctionId, fold: Loop) {
        if self.enter(body.0 as usize, Role::Body(fold)) {
            self.turn();
        }
    }

    /// Begins the next step of the innermost fold, by its condition if it has one; or ends the fold.
    fn turn(&mut self) {
        let Some(Frame { role: Role::Body(fold), base, next, .. }) = self.frames.last_mut() else { return };
        if fold.step == fold.steps {
            return self.end_fold();
        }
        *next = 0;
        if let Some(condition) = fold.condition {
            let inputs = &self.values[*base..];
            let captures = inputs.iter().skip(fold.accumulators + 1).take(fold.captures);
            self.arguments.clear();
            self.arguments.extend(inputs.iter().take(fold.accumulators).chain(captures));
            self.enter(condition.0 as usize, Role::Condition);
        }
    }

    /// Ends the innermost function.
    fn leave(&mut self, planned: &Planned) {
        let Some(&frame) = self.frames.last() else { return };
        let own = &self.values[frame.base..];
        let output = |n: usize| planned.outputs.get(n).copied().flatten().map(|at| read(planned, own, at));
        match frame.role {
            Role::Call => {
                self.arguments.clear();
                self.arguments.extend((0..planned.outputs.len()).map(|n| output(n).unwrap_or_else(zero)));
                self.drop_frame(frame);
                self.hand_over();
            }
            Role::Condition => {
                let holds = output(0).is_some_and(|holds| holds.bool(0));
                self.drop_frame(frame);
                if !holds {
                    self.end_fold();
                }
            }
            Role::Body(fold) => {
                // An accumulator that nobody wants keeps its value.
                let next = (0..fold.accumulators).zip(own).map(|(n, last)| output(n).unwrap_or(*last));
                self.arguments.clear();
                self.arguments.extend(next.chain([Constant::ints(&[(fold.step + 1) as i32])]));
                for (slot, next) in self.values[frame.base..].iter_mut().zip(&self.arguments) {
                    *slot = *next;
                }
                if let Some(Frame { role: Role::Body(fold), .. }) = self.frames.last_mut() {
                    fold.step += 1;
                }
                self.turn();
            }
        }
    }

    /// Ends the innermost fold: its accumulators are its outputs.
    fn end_fold(&mut self) {
        let Some(&frame) = self.frames.last() else { return };
        let Role::Body(fold) = frame.role else { return };
        self.arguments.clear();
        self.arguments.extend(self.values[frame.base..].iter().take(fold.accumulators));
        self.drop_frame(frame);
        self.hand_over();
    }

    fn drop_frame(&mut self, frame: Frame) {
        self.frames.pop();
        self.values.truncate(frame.base);
    }

    /// Hands the outputs in `arguments` to who called or folds.
    fn hand_over(&mut self) {
        let Some(caller) = self.frames.last() else {
            std::mem::swap(&mut self.outputs, &mut self.arguments);
            return;
        };
        let planned = &self.functions[caller.function];
        for (n, target) in &planned.steps[caller.next - 1].results {
            let output = self.arguments.get(*n as usize).copied().unwrap_or_else(zero);
            self.values[caller.base + target.0 as usize - planned.known.len()] = output;
        }
    }
}

/// How many steps a fold takes, for what its `steps` is worth.
pub fn fold_steps(fold: &Fold, steps: &Constant) -> u32 {
    u32::try_from(steps.int(0)).unwrap_or(0).min(fold.most)
}

/// A fold at its start; `arguments` become its body's inputs.
fn started(fold: &Fold, read: impl Fn(Value) -> Constant, arguments: &mut Vec<Constant>) -> Loop {
    arguments.clear();
    arguments.extend(fold.starts.iter().map(|start| read(*start)));
    arguments.push(Constant::ints(&[0]));
    arguments.extend(fold.captures.iter().map(|capture| read(*capture)));
    Loop {
        condition: fold.condition,
        accumulators: fold.starts.len(),
        captures: fold.captures.len(),
        step: 0,
        steps: fold_steps(fold, &read(fold.steps)),
    }
}

/// A register: one of the function's constants, or a place of its frame.
fn read(planned: &Planned, frame: &[Constant], register: Value) -> Constant {
    let register = register.0 as usize;
    match register.checked_sub(planned.known.len()) {
        None => planned.known[register],
        Some(slot) => frame.get(slot).copied().unwrap_or_else(zero),
    }
}
