//! The inputs of functions: where a frame has them, and what is known of those of the entry.

use super::super::plan::{Components, Register};
use super::known::constant;
use super::{Planner, State};
use crate::flat::Slope;
use texgraph_compiler::graph::{Axis, Function, Operation, Type};

impl Planner<'_> {
    /// A frame begins with the inputs, in order.
    pub(super) fn inputs(&mut self, function: &Function) {
        let mut first = Vec::with_capacity(function.inputs.len());
        for slot in &function.inputs {
            first.push(self.planned.inputs as u32);
            self.planned.inputs += usize::from(slot.ty.width());
        }
        for (value, operation) in function.iter() {
            if let Operation::Input(n) = operation
                && let Some(first) = first.get(*n as usize)
            {
                let components = [0, 1, 2, 3].map(|c| Register::Frame(first + c));
                self.set(value, State::Components(trimmed(components, function.ty(value))));
            }
        }
    }

    /// The entry's frame begins with what changes from pixel to pixel.
    pub(super) fn entry_inputs(&mut self, function: &Function) {
        for (value, operation) in function.iter() {
            let components = match operation {
                Operation::Input(n) => self.entry_input(*n, function.ty(value)),
                Operation::Derivative(of, axis, _) => match function.operation(*of) {
                    Operation::Input(n) => self.entry_derivative(*n, *axis),
                    _ => continue,
                },
                _ => continue,
            };
            self.set(value, State::Components(trimmed(components, function.ty(value))));
        }
        self.planned.inputs = self.plan.inputs.len();
    }

    pub(super) fn entry_input(&mut self, n: u32, ty: Type) -> Components {
        let pass = self.pass;
        let Some(input) = pass.inputs.get(n as usize) else { return [Register::ZERO; 4] };
        if let Some(value) = self.request.draw().value(&input.name, input.ty) {
            return self.constant(&constant(&value));
        }
        let slope = Slope::of(&input.name, self.request);
        let mut components = [Register::ZERO; 4];
        for (c, to) in components.iter_mut().enumerate().take(usize::from(ty.width())) {
            let rise = slope.component(c);
            *to = if rise.is_constant() {
                self.number(rise.at(0.5, 0.5).to_bits())
            } else {
                self.plan.inputs.push(rise);
                Register::Frame(self.plan.inputs.len() as u32 - 1)
            };
        }
        components
    }

    /// In a flat picture a derivative is the same everywhere.
    pub(super) fn entry_derivative(&mut self, n: u32, axis: Axis) -> Components {
        let pass = self.pass;
        let Some(input) = pass.inputs.get(n as usize) else { return [Register::ZERO; 4] };
        let slope = Slope::of(&input.name, self.request);
        let change = match axis {
            Axis::X => slope.right(),
            Axis::Y => slope.down(),
        };
        change.map(|x| self.number(x.to_bits()))
    }
}

/// Only as many components as a type has.
fn trimmed(components: Components, ty: Type) -> Components {
    let width = usize::from(ty.width());
    [0, 1, 2, 3].map(|c| if c < width { components[c] } else { Register::ZERO })
}
