//! What single operations become.

use super::super::plan::{Call, Components, Loop, Register, Step};
use super::known::constant;
use super::{Planner, State, bound};
use crate::render::RenderError;
use texgraph_compiler::graph::{Fold, Function, Level, Operation, ParamId, Value};
use texgraph_compiler::intrinsic::{Evaluate, Intrinsic, MULTIPLY};

impl Planner<'_> {
    pub(super) fn param(&mut self, id: ParamId) -> Components {
        let (graph, pass) = (self.graph, self.pass);
        let name = graph.params.get(id.0 as usize).map(|param| &param.name);
        let param = name.and_then(|name| pass.manifest.params.iter().find(|param| param.name == *name));
        let value = param.map(|param| constant(&self.request.settings.value(param)));
        value.map_or([Register::ZERO; 4], |value| self.constant(&value))
    }

    pub(super) fn builtin(
        &mut self,
        function: &Function,
        intrinsic: Intrinsic,
        arguments: &[Value],
        width: usize,
    ) -> Components {
        let argument = |k: usize| arguments.get(k).map_or([Register::ZERO; 4], |v| self.components(*v));
        let vectors = [0, 1, 2].map(argument);
        let first = arguments.first().map_or(1, |first| usize::from(function.ty(*first).width()));
        match intrinsic.row().value {
            Evaluate::Each { one, all, .. } => {
                let mut components = [Register::ZERO; 4];
                for (c, component) in components.iter_mut().enumerate().take(width) {
                    let arguments = vectors.map(|vector| vector[c]);
                    if intrinsic == MULTIPLY
                        && let Some(same) = self.times_one(arguments)
                    {
                        *component = same;
                        continue;
                    }
                    let to = self.fresh();
                    [*component] = self.push(Step::Each { row: intrinsic, one, all, arguments, to }, [to]);
                }
                components
            }
            Evaluate::Whole { all, .. } => {
                let (to, results) = self.targets(width);
                let arguments = Box::new([vectors[0], vectors[1]]);
                self.push(Step::Whole { row: intrinsic, all, width: first, arguments, to }, results)
            }
        }
    }

    /// A product with 1.
    fn times_one(&self, [a, b, _]: [Register; 3]) -> Option<Register> {
        let is_one = |register| self.bits(register) == Some(1f32.to_bits());
        if is_one(b) { Some(a) } else { is_one(a).then_some(b) }
    }

    pub(super) fn select(&mut self, condition: Value, yes: Value, no: Value, width: usize) -> Components {
        let condition = self.scalar(condition);
        let (yes, no) = (self.components(yes), self.components(no));
        if let Some(bits) = self.bits(condition) {
            return if bits != 0 { yes } else { no };
        }
        let mut components = [Register::ZERO; 4];
        for (component, (yes, no)) in components.iter_mut().zip(yes.into_iter().zip(no)).take(width) {
            *component = yes;
            if yes != no {
                let to = self.fresh();
                [*component] = self.push(Step::Select { condition, yes, no, to }, [to]);
            }
        }
        components
    }

    pub(super) fn sample(
        &mut self,
        view: Value,
        coordinate: Value,
        layer: Option<Value>,
        level: &Level,
    ) -> Components {
        let view = self.scalar(view);
        let level = match level {
            Level::Auto => Register::ZERO,
            Level::Level(level) => self.scalar(*level),
            Level::Gradient(x, y) => {
                let to = self.fresh();
                let gradient = [self.pair(*x), self.pair(*y)];
                let [level] = self.push(Step::Level { view, gradient, to }, [to]);
                level
            }
        };
        let (to, results) = self.targets(4);
        let layer = layer.map_or(Register::ZERO, |layer| self.scalar(layer));
        self.push(Step::Sample { view, at: self.pair(coordinate), layer, level, to }, results)
    }

    /// The components of one output of a call, or of one accumulator of a fold.
    pub(super) fn output(&mut self, function: &Function, of: Value, n: usize, width: usize) -> Components {
        let before = match function.operation(of) {
            Operation::Call(id, _) => {
                let outputs = self.graph.functions.get(id.0 as usize).map(|callee| &callee.outputs);
                let before = outputs.into_iter().flatten().take(n);
                before.map(|(slot, _)| usize::from(slot.ty.width())).sum()
            }
            Operation::Fold(fold) => {
                let before = fold.starts.iter().take(n);
                before.map(|start| usize::from(function.ty(*start).width())).sum()
            }
            _ => 0,
        };
        let mut components = [Register::ZERO; 4];
        if let State::Outputs(outputs) = &self.states[of.0 as usize] {
            for (to, from) in components.iter_mut().zip(outputs.iter().skip(before)).take(width) {
                *to = *from;
            }
        }
        components
    }

    pub(super) fn call(
        &mut self,
        value: Value,
        function: usize,
        arguments: Vec<Register>,
        cost: u64,
    ) -> Result<(), RenderError> {
        if let Some(outputs) = self.inlined(function, &arguments) {
            self.set(value, State::Outputs(outputs));
            return Ok(());
        }
        // What the callee makes of nothing that it is given is known here too.
        let outputs = self.plan.functions.get(function).map_or(Vec::new(), |callee| callee.outputs.clone());
        let place = |output: Register| if output.is_known() { output } else { self.fresh() };
        let outputs: Vec<Register> = outputs.into_iter().map(place).collect();
        let results = outputs.iter().copied().enumerate().filter(|(_, output)| !output.is_known());
        let results = results.collect();
        let step = Step::Call(Box::new(Call { function, arguments, results }));
        self.push_run(value, step, outputs, cost)
    }

    pub(super) fn fold(
        &mut self,
        function: &Function,
        value: Value,
        fold: &Fold,
        cost: u64,
    ) -> Result<(), RenderError> {
        let starts = self.flat(function, &fold.starts);
        let mut run = Loop {
            body: fold.body.0 as usize,
            condition: fold.condition.map(|condition| condition.0 as usize),
            starts,
            captures: self.flat(function, &fold.captures),
            steps: self.scalar(fold.steps),
            most: fold.most,
            results: Vec::new(),
        };
        let all_known = run.starts.iter().chain(&run.captures).all(|register| register.is_known());
        if !all_known
            && run.condition.is_none()
            && let Some(accumulators) = self.unrolled(&run)
        {
            self.set(value, State::Outputs(accumulators));
            return Ok(());
        }
        let outputs: Vec<Register> = run.starts.iter().map(|_| self.fresh()).collect();
        run.results = outputs.iter().copied().enumerate().collect();
        self.push_run(value, Step::Fold(Box::new(run)), outputs, cost)
    }

    /// Does a call or a fold now if it is over known registers, else leaves it to each run.
    pub(super) fn push_run(
        &mut self,
        value: Value,
        mut step: Step,
        outputs: Vec<Register>,
        cost: u64,
    ) -> Result<(), RenderError> {
        let mut known = true;
        step.for_operands(|operand| known &= operand.is_known());
        let outputs = if known {
            self.work = self.work.saturating_add(cost);
            bound(self.work)?;
            self.compute(step, &outputs)
        } else {
            self.planned.steps.push(step);
            outputs
        };
        self.set(value, State::Outputs(outputs));
        Ok(())
    }
}
