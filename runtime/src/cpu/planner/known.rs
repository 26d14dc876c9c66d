//! Known registers, and steps that are done while planning.

use super::super::machine::Code;
use super::super::plan::{Components, Planned, Register, Step, Targets};
use super::Planner;
use std::collections::HashMap;
use texgraph_compiler::graph::Constant;
use texgraph_compiler::intrinsic::LANES;
use texgraph_compiler::manifest;

impl Planner<'_> {
    /// The known register of some bits.
    pub(super) fn number(&mut self, bits: u32) -> Register {
        let known = &mut self.plan.known;
        *self.numbers.entry(bits).or_insert_with(|| {
            known.push([bits; LANES]);
            Register::Known(known.len() as u32 - 1)
        })
    }

    pub(super) fn constant(&mut self, constant: &Constant) -> Components {
        let mut components = [Register::ZERO; 4];
        for (to, bits) in components.iter_mut().zip(constant.bits()) {
            *to = self.number(*bits);
        }
        components
    }

    /// What is known of a known register.
    pub(super) fn bits(&self, register: Register) -> Option<u32> {
        match register {
            Register::Known(n) => self.plan.known.get(n as usize).map(|lanes| lanes[0]),
            Register::Frame(_) => None,
        }
    }

    pub(super) fn fresh(&mut self) -> Register {
        self.registers += 1;
        Register::Frame(self.registers as u32 - 1)
    }

    /// New registers for the first components.
    pub(super) fn targets(&mut self, width: usize) -> (Targets, Components) {
        let (mut targets, mut components) = ([None; 4], [Register::ZERO; 4]);
        for (target, component) in targets.iter_mut().zip(&mut components).take(width) {
            *component = self.fresh();
            *target = Some(*component);
        }
        (targets, components)
    }

    /// Does a step now if it is over known registers, else leaves it to each run. `results` are the
    /// registers that it writes; where they are in the end.
    pub(super) fn push<const N: usize>(&mut self, mut step: Step, results: [Register; N]) -> [Register; N] {
        let mut known = true;
        step.for_operands(|operand| known &= operand.is_known());
        if known {
            let done = self.compute(step, &results);
            return std::array::from_fn(|i| done.get(i).copied().unwrap_or(Register::ZERO));
        }
        self.planned.steps.push(step);
        results
    }

    /// Does a step now, for one lane; where its results are known.
    pub(super) fn compute(&mut self, mut step: Step, results: &[Register]) -> Vec<Register> {
        let mut places = HashMap::new();
        step.retain_targets(|register| {
            let place = Register::Frame(places.len() as u32);
            places.insert(*register, place);
            *register = place;
            true
        });
        let function = self.plan.functions.len();
        self.plan.functions.push(Planned { steps: vec![step], size: places.len(), ..Planned::default() });
        let code = Code { functions: &self.plan.functions, known: &self.plan.known, textures: self.textures };
        self.machine.begin(code, function, 1);
        self.machine.work(code);
        let place = |register: &Register| places.get(register).copied().unwrap_or(*register);
        let bits: Vec<u32> =
            results.iter().map(|register| self.machine.lanes(code, place(register))[0]).collect();
        self.plan.functions.pop();
        bits.into_iter().map(|bits| self.number(bits)).collect()
    }
}

/// A manifest's value as the graph carries it.
pub(super) fn constant(value: &manifest::Value) -> Constant {
    match value {
        manifest::Value::Float(components) => Constant::floats(components),
        manifest::Value::Int(components) => Constant::ints(components),
        manifest::Value::Bool(components) => Constant::bools(components),
    }
}
