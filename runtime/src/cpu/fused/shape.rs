//! What a planned function computes, apart from the names of registers.

use super::super::plan::{Planned, Register, Step};
use super::Row;
use arrayvec::ArrayVec;
use siphasher::sip128::{Hasher128, SipHasher13};
use std::hash::Hasher;
use texgraph_compiler::intrinsic::{Intrinsic, Lanes};

/// What a step reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operand {
    /// An input's component.
    Input(u32),
    /// What was computed before.
    Value(u32),
    /// A constant, by its place among all.
    Constant(u16),
}

/// What a step computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// A row of one component; gives one value.
    Each(Intrinsic),
    /// A row of whole arguments, of the width of the first; gives four values.
    Whole(Intrinsic, usize),
    /// A choice; gives one value.
    Select,
}

/// What an operation reads.
pub type Operands<T = Operand> = ArrayVec<T, 8>;

/// The arithmetic of a function: what is left of its steps without arms and what nobody reads. In
/// arms that are not taken, too, it is computed; nobody reads it there.
pub struct Shape {
    /// Components of the function's inputs.
    pub inputs: usize,
    /// In order: what, of what, and the number of its first value.
    pub operations: Vec<(Operation, Operands, u32)>,
    /// What the function gives.
    pub outputs: Vec<Operand>,
    /// The constants as they occur: the register and its bits.
    pub constants: Vec<(Register, u32)>,
}

impl Shape {
    /// Of a function whose registers are not shared; none if it does more than arithmetic.
    pub fn of(planned: &Planned, known: &[Lanes]) -> Option<Shape> {
        let mut shape = Shape {
            inputs: planned.inputs,
            operations: Vec::new(),
            outputs: Vec::new(),
            constants: Vec::new(),
        };
        // The value of each register.
        let (mut values, mut count) = (Vec::new(), 0);
        for (operation, operands, results) in needed(planned)? {
            let operands = operands.into_iter().map(|operand| shape.operand(operand, &values, known));
            let operands = operands.collect::<Option<_>>()?;
            shape.operations.push((operation, operands, count));
            for to in results {
                if let Some(Register::Frame(n)) = to {
                    *at(&mut values, n) = Some(count);
                }
                count += 1;
            }
        }
        for output in &planned.outputs {
            let output = shape.operand(*output, &values, known)?;
            shape.outputs.push(output);
        }
        Some(shape)
    }

    /// A constant's place, when there are few enough.
    fn operand(&mut self, register: Register, values: &[Option<u32>], known: &[Lanes]) -> Option<Operand> {
        match register {
            Register::Frame(n) if (n as usize) < self.inputs => Some(Operand::Input(n)),
            Register::Frame(n) => values.get(n as usize).copied().flatten().map(Operand::Value),
            Register::Known(n) => {
                let place = u16::try_from(self.constants.len()).ok()?;
                self.constants.push((register, known.get(n as usize)?[0]));
                Some(Operand::Constant(place))
            }
        }
    }

    /// The register of a constant.
    pub fn constant(&self, place: u16) -> Register {
        self.constants.get(usize::from(place)).map_or(Register::ZERO, |(register, _)| *register)
    }

    /// Whether a row is this one's: the hash is the same, and each of the free constants has one value.
    pub fn is(&self, row: &Row) -> bool {
        let bits = |place: &u16| self.constants.get(usize::from(*place)).map(|(_, bits)| *bits);
        let is_one = |places: &&[u16]| places.iter().all(|place| bits(place) == bits(&places[0]));
        let is_as_long = [self.inputs, self.operations.len()] == [row.inputs, row.operations];
        is_as_long && self.hash(row.free) == row.hash && row.free.iter().all(is_one)
    }

    /// Of all but the values of free constants. The same in every build.
    pub fn hash(&self, free: &[&[u16]]) -> u128 {
        let mut is_free = vec![false; self.constants.len()];
        for place in free.iter().copied().flatten() {
            if let Some(is_free) = is_free.get_mut(usize::from(*place)) {
                *is_free = true;
            }
        }
        let mut text = Vec::new();
        let operand = |text: &mut Vec<u8>, operand: &Operand| {
            let (kind, number) = match *operand {
                Operand::Input(n) => (0, n),
                Operand::Value(n) => (1, n),
                Operand::Constant(place) if is_free[usize::from(place)] => (2, 0),
                Operand::Constant(place) => (3, self.constants[usize::from(place)].1),
            };
            text.push(kind);
            text.extend(number.to_le_bytes());
        };
        for (operation, operands, _) in &self.operations {
            let (name, signature, width) = match operation {
                Operation::Each(row) => (row.row().name, row.row().signature, 0),
                Operation::Whole(row, width) => (row.row().name, row.row().signature, *width as u8),
                Operation::Select => ("", "", 0),
            };
            text.extend([name.as_bytes(), b"\0", signature.as_bytes(), b"\0"].iter().copied().flatten());
            text.push(width);
            operands.iter().for_each(|o| operand(&mut text, o));
        }
        text.extend(b"outputs");
        self.outputs.iter().for_each(|o| operand(&mut text, o));
        let mut hasher = SipHasher13::new();
        hasher.write(&text);
        hasher.finish128().as_u128()
    }
}

/// An operation, the registers it reads and those it writes: one, or four of which some may be missing.
type Needed = (Operation, Operands<Register>, Operands<Option<Register>>);

/// The operations that the outputs need, in order; none if some step is not arithmetic.
fn needed(planned: &Planned) -> Option<Vec<Needed>> {
    let mut operations: Vec<Needed> = Vec::with_capacity(planned.steps.len());
    for step in &planned.steps {
        let (operation, operands, results) = match step {
            Step::Each { row, arguments, to, .. } => {
                (Operation::Each(*row), &arguments[..], &[Some(*to)][..])
            }
            Step::Whole { row, width, arguments, to, .. } => {
                (Operation::Whole(*row, *width), arguments.as_flattened(), &to[..])
            }
            Step::Select { condition, yes, no, to } => {
                (Operation::Select, &[*condition, *yes, *no][..], &[Some(*to)][..])
            }
            Step::Arm { .. } | Step::Join => continue,
            _ => return None,
        };
        operations.push((operation, operands.iter().copied().collect(), results.iter().copied().collect()));
    }
    let mut is_read = Vec::new();
    let read = |is_read: &mut Vec<bool>, register: &Register| {
        if let Register::Frame(n) = register {
            *at(is_read, *n) = true;
        }
    };
    planned.outputs.iter().for_each(|output| read(&mut is_read, output));
    let mut needed = Vec::with_capacity(operations.len());
    for operation in operations.into_iter().rev() {
        let (_, operands, results) = &operation;
        let is_needed =
            |to: &Option<Register>| matches!(to, Some(Register::Frame(n)) if *at(&mut is_read, *n));
        if results.iter().any(is_needed) {
            operands.iter().for_each(|operand| read(&mut is_read, operand));
            needed.push(operation);
        }
    }
    needed.reverse();
    Some(needed)
}

/// A place in a list that is long enough for it.
fn at<T: Default + Clone>(list: &mut Vec<T>, n: u32) -> &mut T {
    let n = n as usize;
    if list.len() <= n {
        list.resize(n + 1, T::default());
    }
    &mut list[n]
}
