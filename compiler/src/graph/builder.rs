//! Makes functions: every value once, constants folded on the way.

use super::interner::Interner;
use super::{Constant, Function, FunctionId, Level, Operation, Place, Scalar, Slot, Type, Value, View};
use crate::intrinsic::{Form, Intrinsic, TO_FLOAT, TO_INT};
use crate::pass::fold_constants::{Folded, fold};
use smol_str::SmolStr;
use std::sync::Arc;

/// A function in the making.
#[derive(Default)]
pub struct Builder {
    function: Function,
    known: Interner,
    /// Total operations become what a shader has.
    expands: bool,
    place: Place,
}

impl Builder {
    /// Starts a function of that name.
    pub fn new(name: impl Into<SmolStr>) -> Builder {
        Builder { function: Function { name: name.into(), ..Function::default() }, ..Builder::default() }
    }

    /// Starts a function of that name, with room for that many values.
    pub fn with_capacity(name: impl Into<SmolStr>, values: usize) -> Builder {
        let mut builder = Builder { known: Interner::with_capacity(values), ..Builder::new(name) };
        builder.function.values.reserve(values);
        builder.function.types.reserve(values);
        builder.function.places.reserve(values);
        builder
    }

    /// From now on, what has a rule for it is made of the operations that a shader has, with guards
    /// where operands are not known to be fine.
    pub fn set_expands(&mut self, expands: bool) {
        self.expands = expands;
    }

    /// What has been made so far.
    pub fn function(&self) -> &Function {
        &self.function
    }

    /// The function, done.
    pub fn finish(self) -> Function {
        self.function
    }

    /// Where the values to come were written.
    pub fn set_place(&mut self, place: Place) {
        self.place = place;
    }

    /// Where values are said to be written now.
    pub fn place(&self) -> Place {
        self.place
    }

    /// Whether callers should take the operations over.
    pub fn set_inline(&mut self, inline: bool) {
        self.function.inline = inline;
    }

    /// Calls a value by a name, unless it has one already. Constants and inputs keep theirs.
    pub fn name(&mut self, value: Value, name: impl Into<Arc<str>>) {
        let keeps = matches!(self.function.operation(value), Operation::Constant(_) | Operation::Input(_));
        if !keeps && !self.function.names.contains(value) {
            self.function.names.insert(value, name);
        }
    }

    /// The type of a value.
    pub fn ty(&self, value: Value) -> Type {
        self.function.ty(value)
    }

    /// The operation of a value.
    pub fn operation(&self, value: Value) -> &Operation {
        self.function.operation(value)
    }

    /// The number, if it is known.
    pub fn as_constant(&self, value: Value) -> Option<Constant> {
        match self.operation(value) {
            Operation::Constant(c) => Some(*c),
            _ => None,
        }
    }

    /// An operation of a known type: the one there is already, what it folds to, or a new value.
    pub fn push(&mut self, operation: Operation, ty: Type) -> Value {
        let vacant = match self.known.find(&operation, &self.function.values) {
            Ok(value) => return value,
            Err(vacant) => vacant,
        };
        match fold(&self.function, &operation) {
            Some(Folded::Value(value)) => return value,
            Some(Folded::Operation(simpler)) => return self.push(simpler, ty),
            None => {}
        }
        if let Operation::Builtin(intrinsic, arguments) = &operation
            && let Form::Expand(rule) = intrinsic.row().form
            && self.expands
        {
            return rule(self, arguments);
        }
        let value = Value(self.function.values.len() as u32);
        self.function.values.push(operation);
        self.function.types.push(ty);
        self.function.places.push(self.place);
        self.known.insert(vacant, value);
        value
    }

    /// Leaves the first so many values, as if those behind them had never been made. Nothing may use them.
    pub fn rewind(&mut self, values: usize) {
        while self.function.values.len() > values {
            let value = Value(self.function.values.len() as u32 - 1);
            if let Some(operation) = self.function.values.pop() {
                self.known.remove(&operation, value);
            }
        }
        self.function.types.truncate(values);
        self.function.places.truncate(values);
        self.function.names.truncate(values);
    }

    /// A new input.
    pub fn input(&mut self, name: impl Into<SmolStr>, ty: Type) -> Value {
        let position = self.function.inputs.len() as u32;
        self.function.inputs.push(Slot { name: name.into(), ty });
        self.push(Operation::Input(position), ty)
    }

    /// A new output.
    pub fn output(&mut self, name: impl Into<SmolStr>, value: Value) {
        let ty = self.ty(value);
        self.function.outputs.push((Slot { name: name.into(), ty }, value));
    }

    /// A known number.
    pub fn constant(&mut self, constant: Constant) -> Value {
        self.push(Operation::Constant(constant), constant.ty())
    }

    /// An intrinsic of arguments that have the types it asks for.
    pub fn builtin(&mut self, intrinsic: Intrinsic, arguments: &[Value]) -> Value {
        let ty = self.result(intrinsic, arguments);
        self.push(Operation::Builtin(intrinsic, arguments.into()), ty)
    }

    /// The type of an intrinsic's value.
    fn result(&self, intrinsic: Intrinsic, arguments: &[Value]) -> Type {
        let width = arguments.first().map_or(1, |v| self.ty(*v).width());
        match intrinsic.row().value.component() {
            Some(scalar) => Type::Vector(scalar, width),
            None => {
                // The value defines the intrinsic, its type included.
                let zero = |v: &Value| {
                    Constant::zero(self.ty(*v).scalar().unwrap_or(Scalar::Int), self.ty(*v).width())
                };
                let zeros: Vec<Constant> = arguments.iter().map(zero).collect();
                intrinsic.evaluate(&zeros).ty()
            }
        }
    }

    /// A vector from scalars; a single one is itself.
    pub fn compose(&mut self, scalars: &[Value]) -> Value {
        match scalars {
            [single] => *single,
            [first, ..] => {
                let scalar = self.ty(*first).scalar().unwrap_or(Scalar::Float);
                let ty = Type::Vector(scalar, scalars.len() as u8);
                self.push(Operation::Compose(scalars.into()), ty)
            }
            [] => self.constant(Constant::floats(&[0.0])),
        }
    }

    /// A scalar in every component; a vector as it is.
    pub fn splat(&mut self, value: Value, width: u8) -> Value {
        if self.ty(value).width() == 1 && width > 1 {
            self.compose(&[value; 4][..usize::from(width.min(4))])
        } else {
            value
        }
    }

    /// A component; the scalar itself for a scalar.
    pub fn extract(&mut self, value: Value, component: u8) -> Value {
        match self.ty(value) {
            Type::Vector(scalar, width) if width > 1 => {
                self.push(Operation::Extract(value, component.min(width - 1)), Type::Vector(scalar, 1))
            }
            _ => value,
        }
    }

    /// One of two values of one type.
    pub fn select(&mut self, condition: Value, yes: Value, no: Value) -> Value {
        let ty = self.ty(yes);
        self.push(Operation::Select(condition, yes, no), ty)
    }

    /// A filtered sample; four floats.
    pub fn sample(&mut self, view: Value, coordinate: Value, layer: Option<Value>, level: Level) -> Value {
        let ty = self.view(view).map_or(Type::FLOAT, View::fetched);
        self.push(Operation::Sample { view, coordinate, layer, level }, ty)
    }

    /// One texel; four floats or ints.
    pub fn texel(&mut self, view: Value, index: Value, layer: Option<Value>) -> Value {
        let ty = self.view(view).map_or(Type::FLOAT, View::fetched);
        self.push(Operation::Texel { view, index, layer }, ty)
    }

    /// The size of level 0 in texels.
    pub fn size(&mut self, view: Value) -> Value {
        let width = self.view(view).map_or(2, View::coordinates);
        self.push(Operation::Size(view), Type::Vector(Scalar::Int, width))
    }

    fn view(&self, value: Value) -> Option<View> {
        match self.ty(value) {
            Type::View(view) => Some(view),
            Type::Vector(..) => None,
        }
    }

    /// A call; its outputs, in order.
    pub fn call(&mut self, id: FunctionId, callee: &Function, arguments: Vec<Value>) -> Vec<Value> {
        let types: Vec<Type> = callee.outputs.iter().map(|(slot, _)| slot.ty).collect();
        let first = types.first().copied().unwrap_or(Type::FLOAT);
        let call = self.push(Operation::Call(id, arguments.as_slice().into()), first);
        types.iter().enumerate().map(|(i, ty)| self.push(Operation::Output(call, i as u32), *ty)).collect()
    }

    /// A fold; its accumulators after the last step, in order.
    pub fn fold(&mut self, fold: super::Fold) -> Vec<Value> {
        let types: Vec<Type> = fold.starts.iter().map(|v| self.ty(*v)).collect();
        let first = types.first().copied().unwrap_or(Type::FLOAT);
        let fold = self.push(Operation::Fold(Box::new(fold)), first);
        types.iter().enumerate().map(|(i, ty)| self.push(Operation::Output(fold, i as u32), *ty)).collect()
    }

    /// An entry of a constant table whose entries have one type; the index is an int, clamped.
    pub fn lookup(&mut self, table: Arc<[Constant]>, index: Value) -> Value {
        let ty = table.first().map_or(Type::FLOAT, Constant::ty);
        self.push(Operation::Lookup(table, index), ty)
    }

    /// Ints as floats; floats as they are.
    pub fn to_float(&mut self, value: Value) -> Value {
        if self.ty(value).scalar() == Some(Scalar::Int) { self.builtin(TO_FLOAT, &[value]) } else { value }
    }

    /// Floats truncated; ints as they are.
    pub fn to_int(&mut self, value: Value) -> Value {
        if self.ty(value).is_float() { self.builtin(TO_INT, &[value]) } else { value }
    }
}
