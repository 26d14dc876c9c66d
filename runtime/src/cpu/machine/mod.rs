//! Runs a plan for a batch of pixels: one step after the other, each in all lanes.
//!
//! Lanes that are not wanted, because they took the other arm of a branch or have left a loop, are
//! computed all the same where that is arithmetic: every operation is total, and nobody reads them.
//! A [`Mask`] says which are wanted; it spares textures the others, skips arms and ends folds.
//!
//! Calls and folds are on a stack of frames of its own, so that no depth of them overflows the
//! thread's. A fold is one frame, its body's, whose inputs are the accumulators, the number of the
//! step and the captures: at the end of a step the outputs take the accumulators' places in the
//! lanes that are still in the loop, and the body runs again, until no lane is.

mod fold;
mod memory;
mod step;

use super::fused::MOST_OUTPUTS;
use super::mask::{Mask, mask_of};
use super::plan::{Call, Planned, Register, Step};
use super::sample::Sampler;
use super::texture::Texture;
use memory::Memory;
use texgraph_compiler::intrinsic::{Lanes, ZERO};

/// Fewer lanes than this are computed one by one.
const FEW: u32 = 8;

/// What a machine runs.
#[derive(Clone, Copy)]
pub struct Code<'a> {
    /// Callees first.
    pub functions: &'a [Planned],
    /// What [`Register::Known`] means.
    pub known: &'a [Lanes],
    /// Of each view of the graph.
    pub textures: &'a [Texture],
}

/// Runs planned functions. Made once per thread, it keeps its memory between batches.
pub struct Machine {
    frames: Vec<Frame>,
    memory: Memory,
    /// The wanted lanes, ...
    mask: Mask,
    /// ... and whether they are fewer than [`FEW`].
    few: bool,
    /// Those of the arms around the step being done.
    outside: Vec<Mask>,
    /// Where a step writes before its result changes places with a register.
    result: Box<Lanes>,
    /// The same for whole vectors, ...
    vector: Box<[Lanes; 4]>,
    /// ... for the outputs of a fused row ...
    fused: [Box<Lanes>; MOST_OUTPUTS],
    /// ... and for the next accumulators of a fold.
    next: Vec<Lanes>,
    sampler: Box<Sampler>,
}

/// A function that is running.
#[derive(Clone, Copy)]
struct Frame {
    function: usize,
    /// Where its registers begin.
    base: usize,
    /// The step to do next.
    next: usize,
    /// The lanes that were wanted before.
    mask: Mask,
    role: Role,
}

/// What a function runs for.
#[derive(Clone, Copy)]
enum Role {
    Call,
    Condition,
    /// The body of a fold; the step that is next, or being done.
    Body(u32),
}

impl Default for Machine {
    fn default() -> Machine {
        Machine {
            frames: Vec::new(),
            memory: Memory::default(),
            mask: 0,
            few: true,
            outside: Vec::new(),
            result: Box::new(ZERO),
            vector: Box::new([ZERO; 4]),
            fused: std::array::from_fn(|_| Box::new(ZERO)),
            next: Vec::new(),
            sampler: Box::default(),
        }
    }
}

impl Machine {
    /// Begins a function, for the wanted lanes. Its inputs are the first [`Machine::input`]s.
    pub fn begin(&mut self, code: Code<'_>, function: usize, mask: Mask) {
        self.frames.clear();
        self.outside.clear();
        self.want(mask);
        self.enter(code, function, 0, Role::Call);
    }

    /// A register of the function that has begun first.
    pub fn input(&mut self, n: usize) -> Option<&mut Lanes> {
        self.memory.at(n)
    }

    /// A register of the function that has begun first, when it has been done.
    pub fn lanes<'a>(&'a self, code: Code<'a>, register: Register) -> &'a Lanes {
        self.memory.read(code.known, 0, register)
    }

    /// Goes on until no function runs.
    pub fn work(&mut self, code: Code<'_>) {
        while let Some(frame) = self.frames.last_mut() {
            let Some(planned) = code.functions.get(frame.function) else { return };
            let base = frame.base;
            match planned.steps.get(frame.next) {
                None => self.leave(code, planned),
                Some(step) => {
                    frame.next += 1;
                    match step {
                        Step::Arm { condition, holds, end } => self.arm(code, base, *condition, *holds, *end),
                        Step::Join => self.join(),
                        Step::Call(call) => self.call(code, planned, base, call),
                        Step::Fold(fold) => self.fold(code, planned, base, fold),
                        step => self.step(code, base, step),
                    }
                }
            }
        }
    }

    /// From now on these lanes are wanted.
    fn want(&mut self, mask: Mask) {
        self.mask = mask;
        self.few = mask.count_ones() < FEW;
    }

    /// Goes into an arm, or past it.
    fn arm(&mut self, code: Code<'_>, base: usize, condition: Register, holds: bool, end: usize) {
        let condition = mask_of(self.memory.read(code.known, base, condition));
        let inside = self.mask & if holds { condition } else { !condition };
        if inside != 0 {
            self.outside.push(self.mask);
            self.want(inside);
        } else if let Some(frame) = self.frames.last_mut() {
            frame.next = end;
        }
    }

    /// Leaves an arm.
    fn join(&mut self) {
        if let Some(mask) = self.outside.pop() {
            self.want(mask);
        }
    }

    /// Begins a function; whether there is one.
    fn enter(&mut self, code: Code<'_>, function: usize, base: usize, role: Role) -> bool {
        let Some(planned) = code.functions.get(function) else { return false };
        self.memory.reserve(base + planned.size);
        self.frames.push(Frame { function, base, next: 0, mask: self.mask, role });
        true
    }

    /// Begins a call.
    fn call(&mut self, code: Code<'_>, planned: &Planned, base: usize, call: &Call) {
        let inside = base + planned.size;
        if self.enter(code, call.function, inside, Role::Call) {
            for (from, to) in call.arguments.iter().zip(inside..) {
                self.memory.copy(code.known, base, *from, to);
            }
        }
    }

    /// Ends the innermost function.
    fn leave(&mut self, code: Code<'_>, planned: &Planned) {
        let Some(frame) = self.frames.pop() else { return };
        match frame.role {
            Role::Call => {
                self.want(frame.mask);
                if let Some((base, Step::Call(call))) = self.caller(code) {
                    let output = |n: usize| planned.outputs.get(n).copied().unwrap_or(Register::ZERO);
                    for (n, to) in &call.results {
                        if let Register::Frame(to) = to {
                            self.memory.copy(code.known, frame.base, output(*n), base + *to as usize);
                        }
                    }
                }
            }
            Role::Condition => {
                let holds = planned.outputs.first().copied().unwrap_or(Register::ZERO);
                let holds = mask_of(self.memory.read(code.known, frame.base, holds));
                self.want(self.mask & holds);
                if self.mask == 0
                    && let Some(fold) = self.running(code)
                {
                    self.end_fold(code, fold);
                }
            }
            Role::Body(step) => {
                self.frames.push(Frame { role: Role::Body(step + 1), ..frame });
                if let Some(fold) = self.running(code) {
                    self.advance(code, planned, frame.base, fold);
                    self.turn(code, fold);
                }
            }
        }
    }

    /// The step that the innermost function is in, and where its registers begin.
    fn caller<'a>(&self, code: Code<'a>) -> Option<(usize, &'a Step)> {
        let frame = self.frames.last()?;
        let step = code.functions.get(frame.function)?.steps.get(frame.next.checked_sub(1)?)?;
        Some((frame.base, step))
    }
}
