//! How far the lowering of one function of the graph has come.

use super::body::Variable;
use super::fold::takes_all_steps;
use super::helper::{self, Drawn, Draws, Pick};
use super::slope::{Slope, slopes};
use super::table::MAX_CHOSEN;
use crate::graph::regions::Regions;
use crate::graph::{Constant, Function, Operation, Type, Value};
use crate::intrinsic::{Form, MULTIPLY, MULTIPLY_INT, TO_FLOAT};
use naga::{Expression, Handle};
use rustc_hash::FxHashMap;
use std::cell::OnceCell;
use std::rc::Rc;

/// What a derivative without a name of its own is called.
const SLOPE: &str = "slope";

/// Unnamed operations inside each other at most.
const MAX_NEST: u8 = 16;

/// What a function of the graph is being lowered with. Several can be in the making inside one naga
/// function: the steps of folds stand where the folds stand.
pub struct Frame<'g> {
    pub function: &'g Function,
    pub regions: Rc<Regions>,
    /// Lowered values.
    values: Vec<Option<Handle<Expression>>>,
    /// How deep the unnamed nest of each is: 0 for what is named or needs no name.
    nest: Vec<u8>,
    uses: Vec<u32>,
    /// The accumulators of folds after the last step.
    pub folds: FxHashMap<Value, Vec<Handle<Expression>>>,
    /// Choices that are made right in the variable of the choice around them.
    pub targets: FxHashMap<Value, Variable>,
    /// What the author calls the first output of each call.
    results: FxHashMap<Value, &'g str>,
    /// Inputs that are known numbers.
    known: FxHashMap<Value, Constant>,
    /// Of a fold's step: values that have the name of the accumulator they are the next of.
    next: FxHashMap<Value, String>,
    /// Products that are derivatives of others.
    slopes: Vec<Slope>,
    /// What is read of hashes, once one is met.
    draws: OnceCell<Draws>,
}

impl<'g> Frame<'g> {
    pub fn new(function: &'g Function, regions: Regions) -> Frame<'g> {
        let draws = OnceCell::new();
        Frame {
            function,
            uses: uses(function, &regions, &draws),
            slopes: Vec::new(),
            regions: Rc::new(regions),
            values: vec![None; function.values.len()],
            nest: vec![0; function.values.len()],
            folds: FxHashMap::default(),
            targets: FxHashMap::default(),
            results: results(function),
            known: FxHashMap::default(),
            next: FxHashMap::default(),
            draws,
        }
    }

    /// The frame of a fold's step: what the author calls as the accumulator is called is not that
    /// yet, only its next value.
    pub fn of_step(function: &'g Function, regions: Regions) -> Frame<'g> {
        let mut frame = Frame::new(function, regions);
        for (slot, value) in &function.outputs {
            if function.names.get(*value).is_some_and(|name| **name == *slot.name) {
                frame.next.insert(*value, format!("next_{}", slot.name));
            }
        }
        frame
    }

    /// Finds the products that are slopes of others; `per_draw` marks what is the same for a whole draw.
    pub fn find_slopes(&mut self, per_draw: &[bool]) {
        self.slopes = slopes(self.function, &self.regions, per_draw, &self.uses);
        for Slope { value, product, factors: [derivative, scale], .. } in self.slopes.clone() {
            let Operation::Builtin(_, factors) = self.function.operation(value) else { continue };
            let scale = written_factor(self.function, factors, scale);
            self.uses[product.0 as usize] += 1;
            self.uses[scale.0 as usize] -= 1;
            self.uses[derivative.0 as usize] = 0;
        }
    }

    /// What a product is the slope of.
    pub fn slope(&self, value: Value) -> Option<Slope> {
        self.slopes.iter().find(|slope| slope.value == value).copied()
    }

    /// Says what the function's inputs are, in order.
    pub fn bind(&mut self, inputs: &[Argument]) {
        for (value, operation) in self.function.iter() {
            if let Operation::Input(i) = operation
                && let Some(input) = inputs.get(*i as usize)
            {
                self.values[value.0 as usize] = Some(input.handle);
                self.known.extend(input.known.map(|known| (value, known)));
            }
        }
    }

    /// A lowered value that is no constant vector. Operands come before what uses them, so it is
    /// there.
    pub fn get(&self, value: Value) -> Handle<Expression> {
        match self.values[value.0 as usize] {
            Some(handle) => handle,
            None => unreachable!("a value is lowered after its operands"),
        }
    }

    /// The number, if it is known.
    pub fn constant(&self, value: Value) -> Option<Constant> {
        match self.function.operation(value) {
            Operation::Constant(constant) => Some(*constant),
            _ => self.known.get(&value).copied(),
        }
    }

    /// Whether a value is still to be lowered.
    pub fn is_wanted(&self, value: Value) -> bool {
        self.uses[value.0 as usize] > 0 && self.values[value.0 as usize].is_none()
    }

    /// Whether only one place in the text reads a value.
    pub fn is_used_once(&self, value: Value) -> bool {
        self.uses[value.0 as usize] == 1
    }

    /// Whether a value is written out where it is used, with its operands.
    pub fn is_written_out(&self, value: Value) -> bool {
        self.nest[value.0 as usize] > 0
    }

    /// Notes that a value is lowered; whether it is to be named.
    pub fn set(&mut self, value: Value, handle: Handle<Expression>) -> bool {
        self.values[value.0 as usize] = Some(handle);
        let operation = self.function.operation(value);
        if self.needs_no_name(operation, handle) {
            return false;
        }
        let mut nest = 0;
        operation.for_operands(|v| nest = nest.max(self.nest[v.0 as usize]));
        let nest = nest.saturating_add(1);
        let shared = !is_cheap(operation) && self.uses[value.0 as usize] > 1;
        let is_eager = is_eager(operation) || self.slope(value).is_some();
        if self.author(value).is_some() || is_eager || nest >= MAX_NEST || shared {
            return true;
        }
        self.nest[value.0 as usize] = nest;
        false
    }

    /// Notes what a variable's value is.
    pub fn set_variable(&mut self, value: Value, loaded: Handle<Expression>) {
        self.values[value.0 as usize] = Some(loaded);
    }

    /// What the author calls a value.
    pub fn author(&self, value: Value) -> Option<&'g str> {
        let author = self.function.names.get(value).map(|name| &**name);
        author.filter(|_| !self.next.contains_key(&value))
    }

    /// What the author calls the first output of a call.
    pub fn author_of_result(&self, call: Value) -> Option<&'g str> {
        self.results.get(&call).copied()
    }

    /// What is read of a hash; none for any other value.
    pub fn drawn(&self, value: Value) -> Option<Drawn> {
        if !helper::is_hash(self.function.operation(value)) {
            return None;
        }
        self.draws.get_or_init(|| Draws::of(self.function)).hashes.get(&value).copied()
    }

    /// What a value is on the way to a pick.
    pub fn pick(&self, value: Value) -> Option<Pick> {
        self.draws.get()?.picks.get(&value).copied()
    }

    /// What the author calls a hash, or its only number.
    pub fn author_of_hash(&self, hash: Value) -> Option<&'g str> {
        let only = || self.drawn(hash).filter(|drawn| drawn.numbers <= 1)?.first;
        self.author(hash).or_else(|| self.author(only()?))
    }

    /// The components of a lowered value; of a hash, those that are read.
    pub fn width(&self, value: Value) -> u8 {
        self.drawn(value).map_or(self.function.ty(value).width(), |drawn| drawn.numbers.max(1))
    }

    /// What a value is called, if it has to have a name.
    pub fn name(&self, value: Value) -> &str {
        let next = || self.next.get(&value).map(String::as_str);
        let hint = || match self.slope(value).is_some() {
            true => SLOPE,
            false => hint(self.function.operation(value)),
        };
        self.author(value).or_else(next).unwrap_or_else(hint)
    }

    /// Known, or held by a name or variable of its own.
    fn needs_no_name(&self, operation: &Operation, handle: Handle<Expression>) -> bool {
        match operation {
            Operation::Constant(_)
            | Operation::Param(_)
            | Operation::View(_)
            | Operation::Input(_)
            | Operation::Call(..)
            | Operation::Fold(_) => true,
            // A hash that gives one number.
            Operation::Extract(of, _) => self.values[of.0 as usize] == Some(handle),
            // A call's only output is the call's result.
            Operation::Output(of, _) => {
                matches!(self.function.operation(*of), Operation::Fold(_)) || self.get(*of) == handle
            }
            Operation::Builtin(intrinsic, _) => matches!(intrinsic.row().form, Form::Helper(_)),
            _ => false,
        }
    }
}

/// What a function is given for an input.
#[derive(Clone, Copy)]
pub struct Argument {
    pub handle: Handle<Expression>,
    /// The number, if it is known.
    pub known: Option<Constant>,
}

/// The names of calls' first outputs, by call.
fn results(function: &Function) -> FxHashMap<Value, &str> {
    let named = function.names.iter();
    let outputs = named.filter_map(|(value, name)| match function.operation(value) {
        Operation::Output(call, 0) => Some((*call, &**name)),
        _ => None,
    });
    outputs.collect()
}

/// Written again at each use rather than named.
fn is_cheap(operation: &Operation) -> bool {
    matches!(operation, Operation::Extract(..) | Operation::Output(..))
}

/// Named even if used once: the text writer would.
fn is_eager(operation: &Operation) -> bool {
    matches!(operation, Operation::Sample { .. } | Operation::Texel { .. } | Operation::Derivative(..))
}

/// What a value without a name of its own is called.
fn hint(operation: &Operation) -> &'static str {
    match operation {
        Operation::Sample { .. } => "sampled",
        Operation::Texel { .. } => "texel",
        Operation::Size(_) => "size",
        Operation::Select(..) => "chosen",
        Operation::Compose(_) => "vector",
        Operation::Lookup(..) => "entry",
        Operation::Derivative(..) => SLOPE,
        _ => "t",
    }
}

/// How often each value is written. What is a scalar in every component is written as that scalar,
/// once; a branch writes its condition once; a loop counts as many times.
fn uses(function: &Function, regions: &Regions, draws: &OnceCell<Draws>) -> Vec<u32> {
    let mut uses = vec![0; function.values.len()];
    for (_, value) in &function.outputs {
        uses[value.0 as usize] += 1;
    }
    for (value, operation) in function.iter().rev() {
        let own = uses[value.0 as usize];
        if own == 0 {
            continue;
        }
        let mut add = |v: Value, times: u32| uses[v.0 as usize] += times;
        match operation {
            Operation::Builtin(MULTIPLY | MULTIPLY_INT, factors) => {
                factors.iter().for_each(|v| add(written_factor(function, factors, *v), 1));
            }
            Operation::Select(condition, yes, no) => {
                let first = regions.branch(value).is_none_or(|branch| branch.choices[0] == value);
                add(*condition, u32::from(first));
                [*yes, *no].into_iter().for_each(|v| add(v, 1));
            }
            Operation::Fold(fold) => {
                fold.starts.iter().for_each(|v| add(*v, 1));
                fold.captures.iter().for_each(|v| add(*v, 2));
                add(fold.steps, if takes_all_steps(function, fold) { 2 } else { 1 });
            }
            Operation::Compose(parts) if parts.iter().all(|part| *part == parts[0]) => add(parts[0], 1),
            Operation::Builtin(TO_FLOAT, of) => match splat_of(function, of[0]) {
                Some(Splat::Value(scalar)) => add(scalar, 1),
                _ => add(of[0], 1),
            },
            Operation::Lookup(table, index) => {
                add(*index, if table.len() <= MAX_CHOSEN { table.len() as u32 - 1 } else { 1 });
            }
            Operation::Builtin(_, arguments) if helper::is_hash(operation) => {
                let drawn = draws.get_or_init(|| Draws::of(function)).hashes.get(&value);
                match drawn.and_then(|drawn| helper::words(function, arguments[0], *drawn)) {
                    Some(words) => words.iter().for_each(|v| add(*v, 1)),
                    None => add(arguments[0], 1),
                }
            }
            Operation::Extract(vector, _) if !function.names.contains(value) => add(*vector, own),
            _ => operation.for_operands(|v| add(v, 1)),
        }
    }
    uses
}

/// A factor of a product as it is written.
fn written_factor(function: &Function, factors: &[Value], factor: Value) -> Value {
    match splat_of(function, factor) {
        Some(Splat::Value(scalar)) if !factors.iter().all(|v| splat_of(function, *v).is_some()) => scalar,
        _ => factor,
    }
}

/// A scalar that stands in every component of a vector.
#[derive(Clone, Copy)]
pub enum Splat {
    /// A value.
    Value(Value),
    /// A known number.
    Constant(Constant),
}

/// The scalar of a vector that has one in every component.
pub fn splat_of(function: &Function, vector: Value) -> Option<Splat> {
    match function.operation(vector) {
        Operation::Constant(c) if c.width() > 1 && c.is_splat() => Some(Splat::Constant(c.component(0))),
        Operation::Compose(parts) if parts.iter().all(|part| *part == parts[0]) => {
            Some(Splat::Value(parts[0]))
        }
        _ => None,
    }
}

/// Whether a view comes with a sampler.
pub fn has_sampler(ty: Type) -> bool {
    matches!(ty, Type::View(view) if view.texel == crate::graph::Texel::Sampled)
}
