//! Runs a plan: one operation after the other, calls on a stack of frames of its own, so that no
//! depth of calls overflows the thread's.

use super::plan::{Planned, Step};
use super::texture::Texture;
use glam::{IVec2, Vec2};
use texgraph_compiler::graph::{Constant, Level, Operation, Scalar, Type, Value};

/// Runs planned functions. Made once per thread, it keeps its memory between pixels.
pub struct Machine<'a> {
    functions: &'a [Planned],
    textures: &'a [Texture],
    frames: Vec<Frame>,
    /// The frames' values, one frame after the other.
    values: Vec<Constant>,
    outputs: Vec<Constant>,
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
        self.outputs.clear();
        self.arguments.clear();
        self.arguments.extend(inputs);
        self.enter(function);
        while let Some(frame) = self.frames.last_mut() {
            let planned = &self.functions[frame.function];
            let Some(step) = planned.steps.get(frame.next) else {
                self.leave(planned);
                continue;
            };
            frame.next += 1;
            let frame = *frame;
            if let Operation::Call(callee, arguments) = &step.operation {
                self.arguments.clear();
                for argument in arguments {
                    self.arguments.push(read(planned, &self.values[frame.base..], *argument));
                }
                self.enter(callee.0 as usize);
            } else {
                self.step(planned, frame.base, step);
            }
        }
        &self.outputs
    }

    /// Begins a function whose inputs are the arguments.
    fn enter(&mut self, function: usize) {
        let Some(planned) = self.functions.get(function) else { return };
        let base = self.values.len();
        self.values.extend(self.arguments.iter().take(planned.slots));
        self.values.resize(base + planned.slots, zero());
        self.frames.push(Frame { function, base, next: 0 });
    }

    /// Ends the innermost function: hands its outputs to its caller.
    fn leave(&mut self, planned: &Planned) {
        let Some(frame) = self.frames.pop() else { return };
        let (callers, own) = self.values.split_at_mut(frame.base);
        let output =
            |n: usize| planned.outputs.get(n).copied().flatten().map_or(zero(), |at| read(planned, own, at));
        match self.frames.last() {
            None => self.outputs.extend((0..planned.outputs.len()).map(output)),
            Some(caller) => {
                let calling = &self.functions[caller.function];
                for (n, target) in &calling.steps[caller.next - 1].results {
                    callers[caller.base + target.0 as usize - calling.known.len()] = output(*n as usize);
                }
            }
        }
        self.values.truncate(frame.base);
    }

    fn step(&mut self, planned: &Planned, base: usize, step: &Step) {
        let frame = &self.values[base..];
        let value = evaluate(
            &step.operation,
            |value| read(planned, frame, value),
            self.textures,
            &mut self.arguments,
        );
        self.values[base + step.target.0 as usize - planned.known.len()] = value;
    }
}

fn zero() -> Constant {
    Constant::zero(Scalar::Float, 1)
}

/// A register: one of the function's constants, or a place of its frame.
fn read(planned: &Planned, frame: &[Constant], register: Value) -> Constant {
    let register = register.0 as usize;
    match register.checked_sub(planned.known.len()) {
        None => planned.known[register],
        Some(slot) => frame.get(slot).copied().unwrap_or_else(zero),
    }
}

/// What an operation is worth, calls apart. A view is worth its number. `scratch` is memory to
/// use again.
pub fn evaluate(
    operation: &Operation,
    read: impl Fn(Value) -> Constant,
    textures: &[Texture],
    scratch: &mut Vec<Constant>,
) -> Constant {
    let texture = |view: Value| textures.get(read(view).int(0) as usize);
    let layer = |layer: &Option<Value>| layer.map_or(0, |layer| read(layer).int(0));
    match operation {
        Operation::Constant(constant) => *constant,
        Operation::View(id) => Constant::ints(&[id.0 as i32]),
        Operation::Builtin(intrinsic, arguments) => {
            scratch.clear();
            scratch.extend(arguments.iter().map(|argument| read(*argument)));
            intrinsic.evaluate(scratch)
        }
        Operation::Compose(scalars) => compose(scalars, read),
        Operation::Extract(vector, component) => read(*vector).component(usize::from(*component)),
        Operation::Select(condition, yes, no) => read(if read(*condition).bool(0) { *yes } else { *no }),
        Operation::Sample { view, coordinate, layer: l, level } => {
            let Some(texture) = texture(*view) else { return Constant::zero(Scalar::Float, 4) };
            let lod = match level {
                Level::Auto => 0.0,
                Level::Gradient(x, y) => texture.level(pair(read(*x)), pair(read(*y))),
                Level::Level(level) => read(*level).float(0),
            };
            Constant::floats(&texture.sample(pair(read(*coordinate)), lod, layer(l)).to_array())
        }
        Operation::Texel { view, index, layer: l } => {
            let index = read(*index);
            let index = IVec2::new(index.int(0), index.int(1));
            texture(*view).map_or(Constant::zero(Scalar::Float, 4), |texture| texture.fetch(index, layer(l)))
        }
        Operation::Size(view) => {
            Constant::ints(&texture(*view).map_or([1, 1], |texture| texture.size().to_array()))
        }
        Operation::Lookup(table, index) => {
            let last = table.len().saturating_sub(1);
            let index = usize::try_from(read(*index).int(0)).unwrap_or(0).min(last);
            table.get(index).copied().unwrap_or_else(zero)
        }
        // The plan makes registers of these, and runs calls itself.
        Operation::Input(_)
        | Operation::Param(_)
        | Operation::Call(..)
        | Operation::Fold(_)
        | Operation::Output(..)
        | Operation::Derivative(..) => zero(),
    }
}

fn compose(scalars: &[Value], read: impl Fn(Value) -> Constant) -> Constant {
    let first = scalars.first().map_or(Type::FLOAT, |scalar| read(*scalar).ty());
    let bits = scalars.iter().map(|scalar| read(*scalar).bits().first().copied().unwrap_or(0));
    Constant::new(first.scalar().unwrap_or(Scalar::Float), bits)
}

fn pair(value: Constant) -> Vec2 {
    Vec2::new(value.float(0), value.float(1))
}
