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

use super::plan::{Call, Components, Loop, Planned, Register, Step, Targets};
use super::texture::Texture;
use texgraph_compiler::graph::Constant;
use texgraph_compiler::intrinsic::{LANES, Lanes, ZERO};

/// A bit for each lane, the first lowest.
pub type Mask = u64;

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
    /// The frames' registers, one frame after the other; as many as were ever needed.
    registers: Vec<Box<Lanes>>,
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
    /// ... and for the next accumulators of a fold.
    next: Vec<Box<Lanes>>,
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
            registers: Vec::new(),
            mask: 0,
            few: true,
            outside: Vec::new(),
            result: Box::new(ZERO),
            vector: Box::new([ZERO; 4]),
            next: Vec::new(),
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
        self.registers.get_mut(n).map(|lanes| &mut **lanes)
    }

    /// A register of the function that has begun first, when it has been done.
    pub fn lanes<'a>(&'a self, code: Code<'a>, register: Register) -> &'a Lanes {
        read(code, &self.registers, 0, register)
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
        let condition = mask_of(read(code, &self.registers, base, condition));
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

    /// Does a step that begins nothing.
    fn step(&mut self, code: Code<'_>, base: usize, step: &Step) {
        let registers = &self.registers;
        let lanes = |register: Register| read(code, registers, base, register);
        let texture = |view: Register| code.textures.get(lanes(view)[0] as usize);
        match step {
            Step::Each { one, all, arguments, to } => {
                let arguments = arguments.map(lanes);
                if self.few {
                    for i in lanes_of(self.mask) {
                        self.result[i] = one(arguments.map(|lanes| lanes[i]));
                    }
                } else {
                    all(arguments, &mut self.result);
                }
                self.put(base, *to);
            }
            Step::Select { condition, yes, no, to } => {
                choose(lanes(*condition), lanes(*yes), lanes(*no), &mut self.result);
                self.put(base, *to);
            }
            Step::Level { view, gradient, to } => {
                if let Some(texture) = texture(*view) {
                    texture.level(gradient.map(|change| change.map(lanes)), self.mask, &mut self.result);
                }
                self.put(base, *to);
            }
            Step::Whole { all, width, arguments, to } => {
                all(*width, arguments.map(|argument: Components| argument.map(lanes)), &mut self.vector);
                self.put_vector(base, to);
            }
            Step::Lookup { table, index, to } => {
                look_up(table, lanes(*index), &mut self.vector);
                self.put_vector(base, to);
            }
            Step::Sample { view, at, layer, level, to } => {
                match texture(*view) {
                    Some(texture) => {
                        let (at, layer, level) = (at.map(lanes), lanes(*layer), lanes(*level));
                        texture.sample(at, level, layer, self.mask, &mut self.vector);
                    }
                    None => *self.vector = [ZERO; 4],
                }
                self.put_vector(base, to);
            }
            Step::Texel { view, at, layer, to } => {
                match texture(*view) {
                    Some(texture) => {
                        texture.fetch(at.map(lanes), lanes(*layer), self.mask, &mut self.vector);
                    }
                    None => *self.vector = [ZERO; 4],
                }
                self.put_vector(base, to);
            }
            Step::Size { view, to } => {
                let [width, height] = texture(*view).map_or([1, 1], |texture| texture.size().to_array());
                *self.vector = [[width as u32; LANES], [height as u32; LANES], ZERO, ZERO];
                self.put_vector(base, to);
            }
            Step::Arm { .. } | Step::Join | Step::Call(_) | Step::Fold(_) => {}
        }
    }

    /// The result goes to a register.
    fn put(&mut self, base: usize, to: Register) {
        if let Register::Frame(n) = to
            && let Some(lanes) = self.registers.get_mut(base + n as usize)
        {
            std::mem::swap(lanes, &mut self.result);
        }
    }

    /// Components go to registers.
    fn put_vector(&mut self, base: usize, to: &Targets) {
        for (to, lanes) in to.iter().zip(self.vector.iter()) {
            if let Some(Register::Frame(n)) = to {
                *self.registers[base + *n as usize] = *lanes;
            }
        }
    }

    /// Begins a function; whether there is one.
    fn enter(&mut self, code: Code<'_>, function: usize, base: usize, role: Role) -> bool {
        let Some(planned) = code.functions.get(function) else { return false };
        let size = base + planned.size;
        if self.registers.len() < size {
            self.registers.resize_with(size, || Box::new(ZERO));
        }
        self.frames.push(Frame { function, base, next: 0, mask: self.mask, role });
        true
    }

    /// Copies registers to some that follow each other.
    fn copy(&mut self, code: Code<'_>, base: usize, from: impl Iterator<Item = Register>, first: usize) {
        for (register, to) in from.zip(first..) {
            match register {
                Register::Known(n) => *self.registers[to] = code.known[n as usize],
                Register::Frame(n) => {
                    let from = *self.registers[base + n as usize];
                    *self.registers[to] = from;
                }
            }
        }
    }

    /// Begins a call.
    fn call(&mut self, code: Code<'_>, planned: &Planned, base: usize, call: &Call) {
        let inside = base + planned.size;
        if self.enter(code, call.function, inside, Role::Call) {
            self.copy(code, base, call.arguments.iter().copied(), inside);
        }
    }

    /// Begins a fold.
    fn fold(&mut self, code: Code<'_>, planned: &Planned, base: usize, fold: &Loop) {
        let inside = base + planned.size;
        if self.enter(code, fold.body, inside, Role::Body(0)) {
            self.copy(code, base, fold.starts.iter().copied(), inside);
            let behind =
                [Register::ZERO].into_iter().chain(fold.captures.iter().copied()).chain([fold.steps]);
            self.copy(code, base, behind, inside + fold.starts.len());
            self.turn(code, fold);
        }
    }

    /// Begins the next step of the innermost fold, by its condition if it has one; or ends the fold.
    fn turn(&mut self, code: Code<'_>, fold: &Loop) {
        let Some(Frame { function, base, next, role: Role::Body(step), .. }) = self.frames.last_mut() else {
            return;
        };
        let (function, base, step, accumulators) = (*function, *base, *step, fold.starts.len());
        let steps = &self.registers[base + accumulators + 1 + fold.captures.len()];
        let active = if step < fold.most { self.mask & above(steps, step) } else { 0 };
        if active == 0 {
            return self.end_fold(fold);
        }
        *next = 0;
        self.want(active);
        *self.registers[base + accumulators] = [step; LANES];
        let Some((condition, body)) = fold.condition.zip(code.functions.get(function)) else { return };
        let inside = base + body.size;
        if self.enter(code, condition, inside, Role::Condition) {
            let captures = accumulators + 1..accumulators + 1 + fold.captures.len();
            let inputs = (0..accumulators).chain(captures).map(|n| Register::Frame(n as u32));
            self.copy(code, base, inputs, inside);
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
                        self.move_result(code, frame.base, output(*n), base, *to);
                    }
                }
            }
            Role::Condition => {
                let holds = planned.outputs.first().copied().unwrap_or(Register::ZERO);
                let holds = mask_of(read(code, &self.registers, frame.base, holds));
                self.want(self.mask & holds);
                if self.mask == 0
                    && let Some(fold) = self.running(code)
                {
                    self.end_fold(fold);
                }
            }
            Role::Body(step) => {
                self.frames.push(Frame { role: Role::Body(step + 1), ..frame });
                if let Some(fold) = self.running(code) {
                    self.advance(code, planned, frame.base, fold.starts.len());
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

    /// The fold that the innermost function is the body of.
    fn running<'a>(&self, code: Code<'a>) -> Option<&'a Loop> {
        let outside = self.frames.get(self.frames.len().checked_sub(2)?)?;
        match code.functions.get(outside.function)?.steps.get(outside.next.checked_sub(1)?)? {
            Step::Fold(fold) => Some(fold),
            _ => None,
        }
    }

    /// The outputs of a body become the accumulators in the lanes that are in the loop.
    fn advance(&mut self, code: Code<'_>, body: &Planned, base: usize, accumulators: usize) {
        if self.next.len() < accumulators {
            self.next.resize_with(accumulators, || Box::new(ZERO));
        }
        let inside = spread(self.mask);
        // An accumulator without a next value keeps its own.
        let own = |n: usize| Register::Frame(n as u32);
        let outputs = || (0..accumulators).map(|n| (n, body.outputs.get(n).copied().unwrap_or(own(n))));
        for ((n, output), next) in outputs().zip(&mut self.next) {
            if output != own(n) {
                let [last, new] = [own(n), output].map(|at| read(code, &self.registers, base, at));
                choose(&inside, new, last, next);
            }
        }
        for ((n, output), next) in outputs().zip(&mut self.next) {
            if output != own(n) {
                std::mem::swap(&mut self.registers[base + n], next);
            }
        }
    }

    /// Ends the innermost fold: its accumulators are its outputs.
    fn end_fold(&mut self, fold: &Loop) {
        let Some(frame) = self.frames.pop() else { return };
        self.want(frame.mask);
        let Some(outside) = self.frames.last() else { return };
        for (n, to) in &fold.results {
            if let Register::Frame(to) = to {
                self.registers.swap(frame.base + n, outside.base + *to as usize);
            }
        }
    }

    /// Copies one output of a function that has been left.
    fn move_result(&mut self, code: Code<'_>, base: usize, from: Register, outside: usize, to: Register) {
        if let Register::Frame(to) = to {
            let lanes = *read(code, &self.registers, base, from);
            *self.registers[outside + to as usize] = lanes;
        }
    }
}

/// What a register holds.
fn read<'a>(code: Code<'a>, registers: &'a [Box<Lanes>], base: usize, register: Register) -> &'a Lanes {
    match register {
        Register::Known(n) => code.known.get(n as usize).unwrap_or(&ZERO),
        Register::Frame(n) => registers.get(base + n as usize).map_or(&ZERO, |lanes| &**lanes),
    }
}

/// The lanes of a mask.
pub fn lanes_of(mut mask: Mask) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    })
}

/// The lanes where a condition holds.
fn mask_of(condition: &Lanes) -> Mask {
    gather(|i| condition[i] != 0)
}

/// The lanes with more steps than have been taken.
fn above(steps: &Lanes, taken: u32) -> Mask {
    gather(|i| i64::from(steps[i] as i32) > i64::from(taken))
}

/// The lanes that are something.
pub fn gather(is: impl Fn(usize) -> bool) -> Mask {
    let bytes: [u8; LANES] = std::array::from_fn(|i| u8::from(is(i)));
    // The product moves the lowest bit of each of eight bytes into its highest byte.
    let eight = |chunk: &[u8; 8]| u64::from_le_bytes(*chunk).wrapping_mul(0x0102_0408_1020_4080) >> 56;
    bytes.as_chunks().0.iter().rev().fold(0, |mask, chunk| mask << 8 | eight(chunk))
}

/// 1 in the lanes of a mask.
fn spread(mask: Mask) -> Lanes {
    std::array::from_fn(|i| (mask >> i) as u32 & 1)
}

/// The first where the condition holds, else the second.
fn choose(condition: &Lanes, yes: &Lanes, no: &Lanes, to: &mut Lanes) {
    for (((to, condition), yes), no) in to.iter_mut().zip(condition).zip(yes).zip(no) {
        *to = if *condition != 0 { *yes } else { *no };
    }
}

/// Entries of a table, the index clamped.
fn look_up(table: &[Constant], index: &Lanes, to: &mut [Lanes; 4]) {
    let last = table.len().saturating_sub(1);
    for (i, index) in index.iter().enumerate() {
        let entry = table.get(usize::try_from(*index as i32).unwrap_or(0).min(last));
        for (c, to) in to.iter_mut().enumerate() {
            to[i] = entry.map_or(0, |entry| entry.int(c) as u32);
        }
    }
}
