//! The registers of a machine.

use super::super::plan::Register;
use texgraph_compiler::intrinsic::{Lanes, ZERO};

/// The registers of all frames, one frame after the other; as many as were ever needed.
#[derive(Default)]
pub struct Memory {
    #[expect(clippy::vec_box, reason = "a result and a register change places")]
    registers: Vec<Box<Lanes>>,
}

impl Memory {
    /// Makes sure that there are so many.
    pub fn reserve(&mut self, count: usize) {
        if self.registers.len() < count {
            self.registers.resize_with(count, || Box::new(ZERO));
        }
    }

    /// What a register of a frame holds that begins at `base`.
    pub fn read<'a>(&'a self, known: &'a [Lanes], base: usize, register: Register) -> &'a Lanes {
        match register {
            Register::Known(n) => known.get(n as usize).unwrap_or(&ZERO),
            Register::Frame(n) => self.registers.get(base + n as usize).map_or(&ZERO, |lanes| &**lanes),
        }
    }

    /// The register at a place.
    pub fn at(&mut self, place: usize) -> Option<&mut Lanes> {
        self.registers.get_mut(place).map(|lanes| &mut **lanes)
    }

    /// Gives a register its lanes.
    pub fn set(&mut self, place: usize, lanes: &Lanes) {
        if let Some(register) = self.registers.get_mut(place) {
            **register = *lanes;
        }
    }

    /// Gives a register its lanes, and back what it had.
    pub fn put(&mut self, place: usize, lanes: &mut Box<Lanes>) {
        if let Some(register) = self.registers.get_mut(place) {
            std::mem::swap(register, lanes);
        }
    }

    /// Copies a register of the frame at `base` to a place.
    pub fn copy(&mut self, known: &[Lanes], base: usize, from: Register, place: usize) {
        let lanes = *self.read(known, base, from);
        self.set(place, &lanes);
    }
}
