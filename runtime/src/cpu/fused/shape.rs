//! What a planned function computes, apart from the names of registers.

use super::super::plan::{Planned, Register, Step};
use siphasher::sip128::{Hasher128, SipHasher13};
use std::collections::{HashMap, HashSet};
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

/// The arithmetic of a function: what is left of its steps without arms and what nobody reads. In
/// arms that are not taken, too, it is computed; nobody reads it there.
pub struct Shape {
    /// Components of the function's inputs.
    pub inputs: usize,
    /// In order: what, of what, and the number of its first value.
    pub operations: Vec<(Operation, Vec<Operand>, u32)>,
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
        let live = live(planned);
        let (mut values, mut count) = (HashMap::new(), 0);
        for (step, _) in planned.steps.iter().zip(&live).filter(|(_, live)| **live) {
            let (operation, operands, results) = match step {
                Step::Each { row, arguments, to, .. } => {
                    (Operation::Each(*row), arguments.to_vec(), vec![Some(*to)])
                }
                Step::Whole { row, width, arguments, to, .. } => {
                    (Operation::Whole(*row, *width), arguments.as_flattened().to_vec(), to.to_vec())
                }
                Step::Select { condition, yes, no, to } => {
                    (Operation::Select, vec![*condition, *yes, *no], vec![Some(*to)])
                }
                Step::Arm { .. } | Step::Join => continue,
                _ => return None,
            };
            let operands = operands.iter().map(|operand| shape.operand(*operand, &values, known));
            let operands = operands.collect::<Option<_>>()?;
            shape.operations.push((operation, operands, count));
            for to in results {
                if let Some(Register::Frame(n)) = to {
                    values.insert(n, count);
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
    fn operand(
        &mut self,
        register: Register,
        values: &HashMap<u32, u32>,
        known: &[Lanes],
    ) -> Option<Operand> {
        match register {
            Register::Frame(n) if (n as usize) < self.inputs => Some(Operand::Input(n)),
            Register::Frame(n) => values.get(&n).copied().map(Operand::Value),
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

    /// Whether this has a hash, and each of the free constants one value.
    pub fn is(&self, hash: u128, free: &[&[u16]]) -> bool {
        let bits = |place: &u16| self.constants.get(usize::from(*place)).map(|(_, bits)| *bits);
        let is_one = |places: &&[u16]| places.iter().all(|place| bits(place) == bits(&places[0]));
        self.hash(free) == hash && free.iter().all(is_one)
    }

    /// Of all but the values of free constants. The same in every build.
    pub fn hash(&self, free: &[&[u16]]) -> u128 {
        let mut hasher = SipHasher13::new();
        let operand = |hasher: &mut SipHasher13, operand: &Operand| match operand {
            Operand::Input(n) => hasher.write(&[&[0], &n.to_le_bytes()[..]].concat()),
            Operand::Value(n) => hasher.write(&[&[1], &n.to_le_bytes()[..]].concat()),
            Operand::Constant(place) if free.iter().any(|places| places.contains(place)) => {
                hasher.write(&[2]);
            }
            Operand::Constant(place) => {
                let bits = self.constants.get(usize::from(*place)).map_or(0, |(_, bits)| *bits);
                hasher.write(&[&[3], &bits.to_le_bytes()[..]].concat());
            }
        };
        hasher.write(&(self.inputs as u64).to_le_bytes());
        for (operation, operands, first) in &self.operations {
            let (name, overload, width) = match operation {
                Operation::Each(row) => (row.row().name, overload(*row), 0),
                Operation::Whole(row, width) => (row.row().name, overload(*row), *width),
                Operation::Select => ("", 0, 0),
            };
            hasher.write(format!("{name}\0{overload} {width} {first}\0").as_bytes());
            operands.iter().for_each(|o| operand(&mut hasher, o));
        }
        hasher.write(b"outputs");
        self.outputs.iter().for_each(|o| operand(&mut hasher, o));
        hasher.finish128().as_u128()
    }
}

/// Which of the rows with its name a row is.
pub fn overload(row: Intrinsic) -> usize {
    let name = row.row().name;
    Intrinsic::all().take_while(|other| *other != row).filter(|other| other.row().name == name).count()
}

/// Which steps the outputs need.
fn live(planned: &Planned) -> Vec<bool> {
    let mut read = HashSet::new();
    read.extend(planned.outputs.iter().copied());
    let mut live = vec![false; planned.steps.len()];
    for (n, step) in planned.steps.iter().enumerate().rev() {
        let mut step = step.clone();
        step.retain_targets(|to| {
            live[n] |= read.contains(to);
            true
        });
        if live[n] {
            step.for_operands(|operand| {
                read.insert(*operand);
            });
        }
    }
    live
}
