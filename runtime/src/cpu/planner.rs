//! Makes the steps of all functions, callees first.
//!
//! What is over known registers alone is done at once, on the machine, and is known itself. All
//! else becomes a step with new registers for its results; `registers` then lets them share.

use super::inputs::Source;
use super::machine::{Code, Machine};
use super::plan::{Call, Components, Drawn, Loop, Plan, Planned, Register, Step, Targets};
use super::registers::allocate;
use super::texture::Texture;
use crate::flat::Slope;
use crate::pass::Pass;
use crate::render::{RenderError, Request};
use std::collections::HashMap;
use texgraph_compiler::graph::regions::{Branch, Region, Regions, Weights};
use texgraph_compiler::graph::{
    Axis, Constant, Fold, Function, FunctionId, Graph, Level, Operation, ParamId, Scalar, Type, Value,
};
use texgraph_compiler::intrinsic::{Evaluate, Intrinsic, LANES};
use texgraph_compiler::manifest;

/// The most operations a pixel.
const MAX_OPERATIONS: u64 = 1_000_000_000;

/// Refuses what would take for ever.
fn bound(operations: u64) -> Result<(), RenderError> {
    if operations > MAX_OPERATIONS {
        return Err(RenderError::TooMuchWork { operations, limit: MAX_OPERATIONS });
    }
    Ok(())
}

/// Where the results of a value are.
#[derive(Clone)]
enum State {
    /// Nothing reads it, or nothing could be made of it.
    Absent,
    /// Its components.
    Components(Components),
    /// The components of all outputs of a call, or of all accumulators of a fold.
    Outputs(Vec<Register>),
}

/// Plans a graph.
pub struct Planner<'a> {
    pass: &'a Pass<'a>,
    graph: &'a Graph,
    request: &'a Request,
    textures: &'a [Texture],
    plan: Plan,
    /// The known register of some bits.
    numbers: HashMap<u32, Register>,
    machine: Machine,
    /// Of the function being planned.
    states: Vec<State>,
    planned: Planned,
    /// Registers of the function so far.
    registers: usize,
    /// Operations done while planning the function.
    work: u64,
}

impl<'a> Planner<'a> {
    /// Over a plan that knows only [`Register::ZERO`].
    pub fn new(
        pass: &'a Pass<'a>,
        graph: &'a Graph,
        request: &'a Request,
        textures: &'a [Texture],
        plan: Plan,
    ) -> Planner<'a> {
        Planner {
            pass,
            graph,
            request,
            textures,
            plan,
            numbers: [(0, Register::ZERO)].into(),
            machine: Machine::default(),
            states: Vec::new(),
            planned: Planned::default(),
            registers: 0,
            work: 0,
        }
    }

    /// Plans all functions.
    ///
    /// # Errors
    /// A run of one, or what is computed here for it, takes more than [`MAX_OPERATIONS`].
    pub fn finish(mut self) -> Result<Plan, RenderError> {
        let graph = self.graph;
        let weights = Weights::of(graph);
        let mut bodies = vec![false; graph.functions.len()];
        for operation in graph.functions.iter().flat_map(|function| &function.values) {
            if let Operation::Fold(fold) = operation {
                bodies.get_mut(fold.body.0 as usize).into_iter().for_each(|is_body| *is_body = true);
            }
        }
        for (id, function) in graph.functions.iter().enumerate() {
            self.function(id, function, &weights, bodies[id])?;
        }
        Ok(self.plan)
    }

    fn function(
        &mut self,
        id: usize,
        function: &'a Function,
        weights: &Weights,
        is_body: bool,
    ) -> Result<(), RenderError> {
        self.states = vec![State::Absent; function.values.len()];
        self.work = 0;
        self.planned = Planned::default();
        if id == self.plan.entry {
            self.entry_inputs(function);
        } else {
            self.inputs(function);
        }
        // One more for the number of steps of a fold.
        self.registers = self.planned.inputs + 1;
        let regions = Regions::of(function, weights);
        self.region(function, &regions, Region::TOP)?;
        bound(self.planned.cost)?;
        for (_, value) in &function.outputs {
            let components = self.components(*value);
            self.planned.outputs.extend(components.iter().take(usize::from(function.ty(*value).width())));
        }
        let pinned = if is_body { self.planned.inputs + 1 } else { 0 };
        allocate(&mut self.planned, self.registers, pinned);
        if id == self.plan.entry {
            self.plan.output = function.outputs.first().and_then(|(slot, _)| self.drawn(slot.ty));
        }
        self.plan.functions.push(std::mem::take(&mut self.planned));
        Ok(())
    }

    /// A frame begins with the inputs, in order.
    fn inputs(&mut self, function: &Function) {
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
    fn entry_inputs(&mut self, function: &Function) {
        for (value, operation) in function.iter() {
            let components = match operation {
                Operation::Input(n) => self.entry_input(*n, function.ty(value)),
                Operation::Derivative(of, axis) => match function.operation(*of) {
                    Operation::Input(n) => self.entry_derivative(*n, *axis),
                    _ => continue,
                },
                _ => continue,
            };
            self.set(value, State::Components(trimmed(components, function.ty(value))));
        }
        self.planned.inputs = self.plan.inputs.len();
    }

    fn entry_input(&mut self, n: u32, ty: Type) -> Components {
        let pass = self.pass;
        let Some(input) = pass.inputs.get(n as usize) else { return [Register::ZERO; 4] };
        if let Some(value) = self.request.draw().value(&input.name, input.ty) {
            return self.constant(&constant(&value));
        }
        let slope = Slope::of(&input.name, self.request);
        let mut components = [Register::ZERO; 4];
        for (c, to) in components.iter_mut().enumerate().take(usize::from(ty.width())) {
            *to = if slope.is_constant(c) {
                self.number(slope.component(c, 0.5, 0.5).to_bits())
            } else {
                self.plan.inputs.push(Source { slope, component: c });
                Register::Frame(self.plan.inputs.len() as u32 - 1)
            };
        }
        components
    }

    /// In a flat picture a derivative is the same everywhere.
    fn entry_derivative(&mut self, n: u32, axis: Axis) -> Components {
        let pass = self.pass;
        let Some(input) = pass.inputs.get(n as usize) else { return [Register::ZERO; 4] };
        let slope = Slope::of(&input.name, self.request);
        let change = match axis {
            Axis::X => slope.right(),
            Axis::Y => slope.down(),
        };
        change.map(|x| self.number(x.to_bits()))
    }

    /// The entry's only output, widened: three times a scalar, 0 and 1 for what is missing.
    fn drawn(&mut self, ty: Type) -> Option<Drawn> {
        let scalar = ty.scalar()?;
        let one = self.number(if scalar == Scalar::Float { 1f32.to_bits() } else { 1 });
        let components = match self.planned.outputs[..] {
            [x] => [x, x, x, one],
            [x, y] => [x, y, Register::ZERO, one],
            [x, y, z] => [x, y, z, one],
            [x, y, z, w, ..] => [x, y, z, w],
            [] => return None,
        };
        Some(Drawn { scalar, components })
    }

    fn set(&mut self, value: Value, state: State) {
        self.states[value.0 as usize] = state;
    }

    /// The components of a value; 0 for what is absent.
    fn components(&self, value: Value) -> Components {
        match &self.states[value.0 as usize] {
            State::Components(components) => *components,
            _ => [Register::ZERO; 4],
        }
    }

    fn scalar(&self, value: Value) -> Register {
        self.components(value)[0]
    }

    fn pair(&self, value: Value) -> [Register; 2] {
        let [x, y, ..] = self.components(value);
        [x, y]
    }

    /// The components of some values, one after the other.
    fn flat(&self, function: &Function, values: &[Value]) -> Vec<Register> {
        let components = |value: &Value| {
            self.components(*value).into_iter().take(usize::from(function.ty(*value).width()))
        };
        values.iter().flat_map(components).collect()
    }

    /// The known register of some bits.
    fn number(&mut self, bits: u32) -> Register {
        let known = &mut self.plan.known;
        *self.numbers.entry(bits).or_insert_with(|| {
            known.push([bits; LANES]);
            Register::Known(known.len() as u32 - 1)
        })
    }

    fn constant(&mut self, constant: &Constant) -> Components {
        let mut components = [Register::ZERO; 4];
        for (to, bits) in components.iter_mut().zip(constant.bits()) {
            *to = self.number(*bits);
        }
        components
    }

    /// What is known of a known register.
    fn bits(&self, register: Register) -> Option<u32> {
        match register {
            Register::Known(n) => self.plan.known.get(n as usize).map(|lanes| lanes[0]),
            Register::Frame(_) => None,
        }
    }

    fn fresh(&mut self) -> Register {
        self.registers += 1;
        Register::Frame(self.registers as u32 - 1)
    }

    /// New registers for the first components.
    fn targets(&mut self, width: usize) -> (Targets, Components) {
        let (mut targets, mut components) = ([None; 4], [Register::ZERO; 4]);
        for (target, component) in targets.iter_mut().zip(&mut components).take(width) {
            *component = self.fresh();
            *target = Some(*component);
        }
        (targets, components)
    }

    /// Does a step now if it is over known registers, else leaves it to each run. `results` are the
    /// registers that it writes; where they are in the end.
    fn push<const N: usize>(&mut self, mut step: Step, results: [Register; N]) -> [Register; N] {
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
    fn compute(&mut self, mut step: Step, results: &[Register]) -> Vec<Register> {
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

    /// Plans what stands in a region. Regions nest [`MAX_DEPTH`](texgraph_compiler::graph::regions)
    /// deep at most.
    fn region(
        &mut self,
        function: &'a Function,
        regions: &Regions,
        region: Region,
    ) -> Result<(), RenderError> {
        for value in regions.values(region) {
            match regions.branch(*value) {
                Some(branch) => self.branch(function, regions, branch)?,
                None => self.value(function, *value)?,
            }
        }
        Ok(())
    }

    fn branch(
        &mut self,
        function: &'a Function,
        regions: &Regions,
        branch: &Branch,
    ) -> Result<(), RenderError> {
        let condition = self.scalar(branch.condition);
        for (region, holds) in branch.arms.into_iter().zip([true, false]) {
            match self.bits(condition) {
                Some(bits) if (bits != 0) == holds => self.region(function, regions, region)?,
                Some(_) => {}
                None => {
                    self.planned.steps.push(Step::Arm { condition, holds, end: 0 });
                    self.region(function, regions, region)?;
                    self.planned.steps.push(Step::Join);
                }
            }
        }
        branch.choices.iter().try_for_each(|choice| self.value(function, *choice))
    }

    /// Plans one value, whose operands are planned.
    fn value(&mut self, function: &'a Function, value: Value) -> Result<(), RenderError> {
        let operation = function.operation(value);
        let cost = self.cost(operation);
        let before = self.planned.steps.len();
        self.operation(function, value, operation, cost)?;
        if self.planned.steps.len() > before {
            self.planned.cost = self.planned.cost.saturating_add(cost);
        }
        Ok(())
    }

    fn operation(
        &mut self,
        function: &'a Function,
        value: Value,
        operation: &'a Operation,
        cost: u64,
    ) -> Result<(), RenderError> {
        let width = usize::from(function.ty(value).width());
        let components = match operation {
            // The frame begins with them.
            Operation::Input(_) | Operation::Derivative(..) => return Ok(()),
            Operation::Constant(constant) => self.constant(constant),
            Operation::View(id) => [self.number(id.0), Register::ZERO, Register::ZERO, Register::ZERO],
            Operation::Param(id) => self.param(*id),
            Operation::Compose(scalars) => {
                let mut components = [Register::ZERO; 4];
                for (to, scalar) in components.iter_mut().zip(scalars.iter()) {
                    *to = self.scalar(*scalar);
                }
                components
            }
            Operation::Extract(vector, c) => {
                let component = self.components(*vector)[usize::from(*c).min(3)];
                [component, Register::ZERO, Register::ZERO, Register::ZERO]
            }
            Operation::Builtin(intrinsic, arguments) => self.builtin(function, *intrinsic, arguments, width),
            Operation::Select(condition, yes, no) => self.select(*condition, *yes, *no, width),
            Operation::Lookup(table, index) => {
                let (to, results) = self.targets(width);
                self.push(Step::Lookup { table: table.clone(), index: self.scalar(*index), to }, results)
            }
            Operation::Sample { view, coordinate, layer, level } => {
                self.sample(*view, *coordinate, *layer, level)
            }
            Operation::Texel { view, index, layer } => {
                let (to, results) = self.targets(width);
                let layer = layer.map_or(Register::ZERO, |layer| self.scalar(layer));
                let step = Step::Texel { view: self.scalar(*view), at: self.pair(*index), layer, to };
                self.push(step, results)
            }
            Operation::Size(view) => {
                let (to, results) = self.targets(width);
                self.push(Step::Size { view: self.scalar(*view), to }, results)
            }
            Operation::Output(of, n) => self.output(function, *of, *n as usize, width),
            Operation::Call(id, arguments) => {
                let arguments = self.flat(function, arguments);
                return self.call(value, id.0 as usize, arguments, cost);
            }
            Operation::Fold(fold) => return self.fold(function, value, fold, cost),
        };
        self.set(value, State::Components(components));
        Ok(())
    }

    fn param(&mut self, id: ParamId) -> Components {
        let (graph, pass) = (self.graph, self.pass);
        let name = graph.params.get(id.0 as usize).map(|param| &param.name);
        let param = name.and_then(|name| pass.manifest.params.iter().find(|param| param.name == *name));
        let value = param.map(|param| constant(&self.request.settings.value(param)));
        value.map_or([Register::ZERO; 4], |value| self.constant(&value))
    }

    fn builtin(
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
            Evaluate::Each { scalar: _, one, all } => {
                let mut components = [Register::ZERO; 4];
                for (c, component) in components.iter_mut().enumerate().take(width) {
                    let to = self.fresh();
                    let arguments = vectors.map(|vector| vector[c]);
                    [*component] = self.push(Step::Each { one, all, arguments, to }, [to]);
                }
                components
            }
            Evaluate::Whole { one: _, all } => {
                let (to, results) = self.targets(width);
                let arguments = Box::new([vectors[0], vectors[1]]);
                self.push(Step::Whole { all, width: first, arguments, to }, results)
            }
        }
    }

    fn select(&mut self, condition: Value, yes: Value, no: Value, width: usize) -> Components {
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

    fn sample(&mut self, view: Value, coordinate: Value, layer: Option<Value>, level: &Level) -> Components {
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
    fn output(&mut self, function: &Function, of: Value, n: usize, width: usize) -> Components {
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

    fn call(
        &mut self,
        value: Value,
        function: usize,
        arguments: Vec<Register>,
        cost: u64,
    ) -> Result<(), RenderError> {
        // What the callee makes of nothing that it is given is known here too.
        let outputs = self.plan.functions.get(function).map_or(Vec::new(), |callee| callee.outputs.clone());
        let place = |output: Register| if output.is_known() { output } else { self.fresh() };
        let outputs: Vec<Register> = outputs.into_iter().map(place).collect();
        let results = outputs.iter().copied().enumerate().filter(|(_, output)| !output.is_known());
        let results = results.collect();
        let step = Step::Call(Box::new(Call { function, arguments, results }));
        self.push_run(value, step, outputs, cost)
    }

    fn fold(&mut self, function: &Function, value: Value, fold: &Fold, cost: u64) -> Result<(), RenderError> {
        let starts = self.flat(function, &fold.starts);
        let outputs: Vec<Register> = starts.iter().map(|_| self.fresh()).collect();
        let step = Step::Fold(Box::new(Loop {
            body: fold.body.0 as usize,
            condition: fold.condition.map(|condition| condition.0 as usize),
            starts,
            captures: self.flat(function, &fold.captures),
            steps: self.scalar(fold.steps),
            most: fold.most,
            results: outputs.iter().copied().enumerate().collect(),
        }));
        self.push_run(value, step, outputs, cost)
    }

    /// Does a call or a fold now if it is over known registers, else leaves it to each run.
    fn push_run(
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

    /// The work of one operation, that of the functions it runs included.
    fn cost(&self, operation: &Operation) -> u64 {
        let of = |id: FunctionId| self.plan.functions.get(id.0 as usize).map_or(0, |callee| callee.cost);
        match operation {
            Operation::Call(id, _) => of(*id).saturating_add(1),
            Operation::Fold(fold) => {
                let steps = self
                    .bits(self.scalar(fold.steps))
                    .map_or(fold.most, |bits| u32::try_from(bits as i32).unwrap_or(0).min(fold.most));
                let step = of(fold.body).saturating_add(fold.condition.map_or(0, of)).saturating_add(1);
                step.saturating_mul(u64::from(steps)).saturating_add(1)
            }
            _ => 1,
        }
    }
}

/// Only as many components as a type has.
fn trimmed(components: Components, ty: Type) -> Components {
    let width = usize::from(ty.width());
    [0, 1, 2, 3].map(|c| if c < width { components[c] } else { Register::ZERO })
}

/// A manifest's value as the graph carries it.
fn constant(value: &manifest::Value) -> Constant {
    match value {
        manifest::Value::Float(components) => Constant::floats(components),
        manifest::Value::Int(components) => Constant::ints(components),
        manifest::Value::Bool(components) => Constant::bools(components),
    }
}
