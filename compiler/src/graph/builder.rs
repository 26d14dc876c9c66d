//! Makes functions: every value once, constants folded on the way.

use super::{Constant, Function, FunctionId, Level, Operation, Place, Scalar, Slot, Type, Value, View};
use crate::intrinsic::{Intrinsic, TO_FLOAT, TO_INT};
use crate::pass::fold_constants::fold;
use rustc_hash::FxHashMap;

/// A function in the making.
#[derive(Default)]
pub struct Builder {
    function: Function,
    known: FxHashMap<Operation, Value>,
    place: Place,
}

impl Builder {
    /// Starts a function of that name.
    pub fn new(name: impl Into<String>) -> Builder {
        Builder { function: Function { name: name.into(), ..Function::default() }, ..Builder::default() }
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
    pub fn name(&mut self, value: Value, name: &str) {
        if !matches!(self.function.operation(value), Operation::Constant(_) | Operation::Input(_)) {
            self.function.names.entry(value).or_insert_with(|| name.to_owned());
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
        if let Some(value) = self.known.get(&operation) {
            return *value;
        }
        if let Some(folded) = fold(&self.function, &operation) {
            return match folded {
                crate::pass::fold_constants::Folded::Value(value) => value,
                crate::pass::fold_constants::Folded::Operation(simpler) => self.push(simpler, ty),
            };
        }
        let value = Value(self.function.values.len() as u32);
        self.function.values.push(operation.clone());
        self.function.types.push(ty);
        self.function.places.push(self.place);
        self.known.insert(operation, value);
        value
    }

    /// A new input.
    pub fn input(&mut self, name: impl Into<String>, ty: Type) -> Value {
        let position = self.function.inputs.len() as u32;
        self.function.inputs.push(Slot { name: name.into(), ty });
        self.push(Operation::Input(position), ty)
    }

    /// A new output.
    pub fn output(&mut self, name: impl Into<String>, value: Value) {
        let ty = self.ty(value);
        self.function.outputs.push((Slot { name: name.into(), ty }, value));
    }

    /// A known number.
    pub fn constant(&mut self, constant: Constant) -> Value {
        self.push(Operation::Constant(constant), constant.ty())
    }

    /// An intrinsic of arguments that have the types it asks for.
    pub fn builtin(&mut self, intrinsic: Intrinsic, arguments: &[Value]) -> Value {
        let operation = Operation::Builtin(intrinsic, arguments.to_vec());
        if let Some(value) = self.known.get(&operation) {
            return *value;
        }
        // The value defines the intrinsic, its type included.
        let zeros: Vec<Constant> = arguments
            .iter()
            .map(|v| Constant::zero(self.ty(*v).scalar().unwrap_or(Scalar::Int), self.ty(*v).width()))
            .collect();
        let ty = intrinsic.evaluate(&zeros).ty();
        self.push(operation, ty)
    }

    /// A vector from scalars; a single one is itself.
    pub fn compose(&mut self, scalars: &[Value]) -> Value {
        match scalars {
            [single] => *single,
            [first, ..] => {
                let scalar = self.ty(*first).scalar().unwrap_or(Scalar::Float);
                let ty = Type::Vector(scalar, scalars.len() as u8);
                self.push(Operation::Compose(scalars.to_vec()), ty)
            }
            [] => self.constant(Constant::floats(&[0.0])),
        }
    }

    /// A scalar in every component; a vector as it is.
    pub fn splat(&mut self, value: Value, width: u8) -> Value {
        if self.ty(value).width() == 1 && width > 1 {
            self.compose(&vec![value; usize::from(width)])
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
        let call = self.push(Operation::Call(id, arguments), first);
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
    pub fn lookup(&mut self, table: std::sync::Arc<[Constant]>, index: Value) -> Value {
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
