//! The steps that begin nothing: each a loop over the lanes.

use super::super::fused::MOST_ARGUMENTS;
use super::super::mask::{choose, lanes_of};
use super::super::plan::{Components, Register, Step, Targets};
use super::{Code, Machine};
use texgraph_compiler::graph::Constant;
use texgraph_compiler::intrinsic::{LANES, Lanes, ZERO};

impl Machine {
    /// Does a step that begins nothing.
    pub(super) fn step(&mut self, code: Code<'_>, base: usize, step: &Step) {
        let memory = &self.memory;
        let lanes = |register: Register| memory.read(code.known, base, register);
        let texture = |view: Register| code.textures.get(lanes(view)[0] as usize);
        match step {
            Step::Each { row: _, one, all, arguments, to } => {
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
            Step::Whole { row: _, all, width, arguments, to } => {
                all(*width, arguments.map(|argument: Components| argument.map(lanes)), &mut self.vector);
                self.put_vector(base, to);
            }
            Step::Fused(fused) => {
                let mut arguments = [&ZERO; MOST_ARGUMENTS];
                for (to, from) in arguments.iter_mut().zip(&fused.arguments) {
                    *to = lanes(*from);
                }
                (fused.row.run)(&arguments, self.mask, &mut self.fused);
                for (to, lanes) in fused.to.iter().zip(&mut self.fused) {
                    if let Some(Register::Frame(n)) = to {
                        self.memory.put(base + *n as usize, lanes);
                    }
                }
            }
            Step::Lookup { table, index, to } => {
                look_up(table, lanes(*index), &mut self.vector);
                self.put_vector(base, to);
            }
            Step::Sample { view, at, layer, level, to } => {
                match texture(*view) {
                    Some(texture) => {
                        let (at, lod) = (at.map(lanes), [lanes(*level), lanes(*layer)]);
                        self.sampler.sample(texture, at, lod, self.mask, &mut self.vector);
                    }
                    None => *self.vector = [ZERO; 4],
                }
                self.put_vector(base, to);
            }
            Step::Texel { view, at, layer, to } => {
                match texture(*view) {
                    Some(texture) => {
                        let wanted = to.map(|to| to.is_some());
                        texture.fetch(at.map(lanes), lanes(*layer), self.mask, wanted, &mut self.vector);
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
        if let Register::Frame(n) = to {
            self.memory.put(base + n as usize, &mut self.result);
        }
    }

    /// Components go to registers.
    fn put_vector(&mut self, base: usize, to: &Targets) {
        for (to, lanes) in to.iter().zip(self.vector.iter()) {
            if let Some(Register::Frame(n)) = to {
                self.memory.set(base + *n as usize, lanes);
            }
        }
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
