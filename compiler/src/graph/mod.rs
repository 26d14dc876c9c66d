//! The dataflow graph: what a program computes, with no order of execution.
//!
//! A [`Function`] is an arena of values; a value is an operation over *earlier* values of the same
//! function, hash-consed by the [`Builder`], so equal work exists once. Functions call earlier
//! functions of the same [`Graph`]. Walking both arenas in order therefore meets everything after
//! what it needs, and no pass recurses.

pub mod bounds;
mod builder;
mod constant;
mod dump;
pub mod evaluate;
mod interner;
mod names;
mod operands;
pub mod regions;

pub use builder::Builder;
pub use constant::Constant;
pub use names::Names;
pub use operands::Operands;

use crate::intrinsic::Intrinsic;
use smol_str::SmolStr;
use std::sync::Arc;
use texgraph_grammar::syntax::Span;

/// The type of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Scalar {
    /// 32-bit float.
    Float,
    /// 32-bit signed integer, wrapping.
    Int,
    /// Truth.
    Bool,
}

/// The type of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    /// 1 to 4 components.
    Vector(Scalar, u8),
    /// A texture with its sampler, if it has one.
    View(View),
}

impl Type {
    /// `float`
    pub const FLOAT: Type = Type::Vector(Scalar::Float, 1);
    /// `int`
    pub const INT: Type = Type::Vector(Scalar::Int, 1);
    /// `bool`
    pub const BOOL: Type = Type::Vector(Scalar::Bool, 1);

    /// Components; 1 for a view.
    pub fn width(self) -> u8 {
        match self {
            Type::Vector(_, width) => width,
            Type::View(_) => 1,
        }
    }

    /// The type of a component, if it is a number or a bool.
    pub fn scalar(self) -> Option<Scalar> {
        match self {
            Type::Vector(scalar, _) => Some(scalar),
            Type::View(_) => None,
        }
    }

    /// Whether a derivative of it can be other than 0.
    pub fn is_float(self) -> bool {
        self.scalar() == Some(Scalar::Float)
    }
}

/// What kind of texture a view shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct View {
    /// The shape.
    pub dimension: ViewDimension,
    /// What a texel is.
    pub texel: Texel,
    /// The most samples along the longer gradient, 1 to 16.
    pub anisotropy: u8,
}

impl View {
    /// Components of a coordinate, layer not counted.
    pub fn coordinates(self) -> u8 {
        match self.dimension {
            ViewDimension::D2 | ViewDimension::D2Array => 2,
            ViewDimension::D3 => 3,
        }
    }

    /// The type of what a fetch gives: four floats or four ints.
    pub fn fetched(self) -> Type {
        match self.texel {
            Texel::Sampled => Type::Vector(Scalar::Float, 4),
            Texel::Integer => Type::Vector(Scalar::Int, 4),
        }
    }
}

/// The shape of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ViewDimension {
    /// A picture.
    D2,
    /// Layers of pictures.
    D2Array,
    /// A volume.
    D3,
}

/// What a texel is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Texel {
    /// Floats, read through a sampler or texel by texel.
    Sampled,
    /// Integers, read texel by texel only.
    Integer,
}

/// A value of a function: the index of its operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Value(pub u32);

/// A function of a graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FunctionId(pub u32);

/// A param: index into [`Graph::params`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ParamId(pub u32);

/// A field of a resource that the shader reads: index into [`Graph::views`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ViewId(pub u32);

/// A screen axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Axis {
    /// To the right.
    X,
    /// Down.
    Y,
}

/// What a screen derivative takes what came out of a sample for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sampled {
    /// It is the same in neighbouring pixels.
    Constant,
    /// It changes by what two more samples, one pixel apart, differ from it.
    Changing,
}

/// An operation over earlier values.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// A known number.
    Constant(Constant),
    /// Input of the function, by position.
    Input(u32),
    /// A param of the program.
    Param(ParamId),
    /// A texture of the program.
    View(ViewId),
    /// An intrinsic; arguments have exactly the types that its row asks for.
    Builtin(Intrinsic, Operands),
    /// A vector from scalars of one type, as many as it has components.
    Compose(Operands),
    /// A component of a vector.
    Extract(Value, u8),
    /// The second where the first (a `bool`) holds, else the third; both of one type.
    Select(Value, Value, Value),
    /// A filtered sample.
    Sample {
        /// A view of [`Texel::Sampled`].
        view: Value,
        /// Floats, 0..1 across the texture.
        coordinate: Value,
        /// The layer of an array, an int, clamped.
        layer: Option<Value>,
        /// The level of detail.
        level: Level,
    },
    /// One texel of level 0. The index is inside: the library clamps or wraps it.
    Texel {
        /// Any view.
        view: Value,
        /// Ints.
        index: Value,
        /// The layer of an array, an int.
        layer: Option<Value>,
    },
    /// Size of level 0 in texels, ints, layers not counted.
    Size(Value),
    /// An entry of a constant table, two or more of one type. The index is an int, clamped.
    Lookup(Arc<[Constant]>, Value),
    /// All outputs of a function. Only [`Operation::Output`] may read it.
    Call(FunctionId, Operands),
    /// All accumulators after the last step. Only [`Operation::Output`] may read it.
    Fold(Box<Fold>),
    /// One output of a call, or one accumulator of a fold.
    Output(Value, u32),
    /// Screen derivative, one pixel to the right or down. After `pass::differentiate` only of the
    /// entry's inputs.
    Derivative(Value, Axis, Sampled),
}

/// A loop: accumulators go through the same function again and again.
///
/// A range over a box is counted by one int here; the body makes the place in the box of it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Fold {
    /// One step. Takes the accumulators, the number of the step (an int from 0) and the captures,
    /// in this order; gives the next accumulators.
    pub body: FunctionId,
    /// Tested before each step; the first time it does not hold ends the loop. Takes the
    /// accumulators and the captures; gives one bool.
    pub condition: Option<FunctionId>,
    /// The accumulators before the first step; at least one.
    pub starts: Vec<Value>,
    /// How many steps there are, an int; none where it is negative.
    pub steps: Value,
    /// The most steps, known when compiling: further ones are not taken.
    pub most: u32,
    /// What body and condition read from outside, beside params and views.
    pub captures: Vec<Value>,
}

impl Fold {
    /// Its body, and its condition if it has one.
    pub fn functions(&self) -> impl Iterator<Item = FunctionId> {
        std::iter::once(self.body).chain(self.condition)
    }

    /// Calls `f` with each operand: the starts, the steps, the captures.
    pub fn for_operands(&self, mut f: impl FnMut(Value)) {
        self.starts.iter().chain([&self.steps]).chain(&self.captures).for_each(|v| f(*v));
    }

    /// The same fold over other operands.
    pub fn map_operands(&self, f: impl FnMut(Value) -> Value) -> Fold {
        let mut copy = self.clone();
        copy.replace_operands(f);
        copy
    }

    /// Puts another value in the place of each operand.
    pub fn replace_operands(&mut self, mut f: impl FnMut(Value) -> Value) {
        let operands = self.starts.iter_mut().chain([&mut self.steps]).chain(&mut self.captures);
        operands.for_each(|v| *v = f(*v));
    }
}

/// The level of detail of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Level {
    /// From the coordinate's derivative; only before `pass::differentiate`.
    Auto,
    /// From these derivatives of the coordinate, in x and y.
    Gradient(Value, Value),
    /// This level, a float, 0 the largest; clamped.
    Level(Value),
}

impl Operation {
    /// Calls `f` with each operand, in order.
    pub fn for_operands(&self, mut f: impl FnMut(Value)) {
        match self {
            Operation::Constant(_) | Operation::Input(_) | Operation::Param(_) | Operation::View(_) => {}
            Operation::Builtin(_, operands) | Operation::Compose(operands) | Operation::Call(_, operands) => {
                operands.iter().copied().for_each(f);
            }
            Operation::Fold(fold) => fold.for_operands(f),
            Operation::Extract(v, _)
            | Operation::Size(v)
            | Operation::Lookup(_, v)
            | Operation::Output(v, _)
            | Operation::Derivative(v, ..) => f(*v),
            Operation::Select(a, b, c) => [*a, *b, *c].into_iter().for_each(f),
            Operation::Sample { view, coordinate, layer, level } => {
                f(*view);
                f(*coordinate);
                layer.iter().copied().for_each(&mut f);
                match level {
                    Level::Auto => {}
                    Level::Gradient(x, y) => [*x, *y].into_iter().for_each(f),
                    Level::Level(l) => f(*l),
                }
            }
            Operation::Texel { view, index, layer } => {
                f(*view);
                f(*index);
                layer.iter().copied().for_each(f);
            }
        }
    }

    /// The same operation over other operands.
    pub fn map_operands(&self, f: impl FnMut(Value) -> Value) -> Operation {
        let mut copy = self.clone();
        copy.replace_operands(f);
        copy
    }

    /// Puts another value in the place of each operand.
    pub fn replace_operands(&mut self, mut f: impl FnMut(Value) -> Value) {
        let mut replace = |v: &mut Value| *v = f(*v);
        match self {
            Operation::Constant(_) | Operation::Input(_) | Operation::Param(_) | Operation::View(_) => {}
            Operation::Builtin(_, operands) | Operation::Compose(operands) | Operation::Call(_, operands) => {
                operands.iter_mut().for_each(replace);
            }
            Operation::Fold(fold) => fold.replace_operands(f),
            Operation::Extract(v, _)
            | Operation::Size(v)
            | Operation::Lookup(_, v)
            | Operation::Output(v, _)
            | Operation::Derivative(v, ..) => replace(v),
            Operation::Select(a, b, c) => [a, b, c].into_iter().for_each(replace),
            Operation::Sample { view, coordinate, layer, level } => {
                replace(view);
                replace(coordinate);
                layer.iter_mut().for_each(&mut replace);
                match level {
                    Level::Auto => {}
                    Level::Gradient(x, y) => [x, y].into_iter().for_each(replace),
                    Level::Level(l) => replace(l),
                }
            }
            Operation::Texel { view, index, layer } => {
                replace(view);
                replace(index);
                layer.iter_mut().for_each(replace);
            }
        }
    }
}

/// Something with a name and a type: an input or an output of a function.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Slot {
    /// As the author named it.
    pub name: SmolStr,
    /// Its type.
    pub ty: Type,
}

/// A place in the sources: which file, and where in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Place {
    /// Index into the program's [`crate::module::Sources`].
    pub file: u32,
    /// Bytes of that file.
    pub span: Span,
}

/// One function: values in an order where operands come first.
#[derive(Clone, Debug, Default)]
pub struct Function {
    /// The node's (or texture's) name.
    pub name: SmolStr,
    /// What it takes.
    pub inputs: Vec<Slot>,
    /// What it gives.
    pub outputs: Vec<(Slot, Value)>,
    /// Its operations; a [`Value`] is an index into this.
    pub values: Vec<Operation>,
    /// Their types; a call's is that of its first output.
    pub types: Vec<Type>,
    /// What the author calls a value: the first name in source order.
    pub names: Names,
    /// Where a value was first written.
    pub places: Vec<Place>,
    /// Written as a single expression, or nothing but a call of another: callers take its operations over
    /// instead of calling it.
    pub inline: bool,
    /// Which function of the library it is, if it still is what the library made of it.
    pub origin: Option<Origin>,
}

/// A function that the library made ahead, by its place in the library's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// As it is after checking, with the expressions it calls taken over.
    Checked(u32),
    /// As it is after all passes.
    Finished(u32),
}

impl Function {
    /// Has it use other functions in the place of those that it calls and folds over.
    pub fn replace_functions(&mut self, mut f: impl FnMut(FunctionId) -> FunctionId) {
        for operation in &mut self.values {
            match operation {
                Operation::Call(callee, _) => *callee = f(*callee),
                Operation::Fold(fold) => {
                    fold.body = f(fold.body);
                    fold.condition = fold.condition.map(&mut f);
                }
                _ => {}
            }
        }
    }

    /// The functions that it calls and folds over, some of them often.
    pub fn functions(&self) -> impl Iterator<Item = FunctionId> {
        self.values.iter().flat_map(|operation| {
            let (called, fold) = match operation {
                Operation::Call(callee, _) => (Some(*callee), None),
                Operation::Fold(fold) => (None, Some(fold.functions())),
                _ => (None, None),
            };
            called.into_iter().chain(fold.into_iter().flatten())
        })
    }

    /// The operation of a value.
    pub fn operation(&self, value: Value) -> &Operation {
        &self.values[value.0 as usize]
    }

    /// The type of a value.
    pub fn ty(&self, value: Value) -> Type {
        self.types[value.0 as usize]
    }

    /// All values with their operations, operands first.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = (Value, &Operation)> {
        self.values.iter().enumerate().map(|(i, op)| (Value(i as u32), op))
    }
}

/// A param as the graph knows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Param {
    /// As `--set` takes it.
    pub name: String,
    /// Its documentation.
    pub label: String,
    /// Its type, a vector.
    pub ty: Type,
    /// Its default, of that type.
    pub default: Constant,
    /// Least and greatest value, of that type.
    pub range: Option<(Constant, Constant)>,
}

/// A field of a resource that the shader reads through a view.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ResourceView {
    /// Index into [`Graph::resources`].
    pub resource: u32,
    /// The field's name.
    pub field: &'static str,
    /// Its type.
    pub view: View,
}

/// The graph of one pass of a program.
#[derive(Clone, Debug)]
pub struct PassGraph {
    /// What it computes.
    pub graph: Graph,
    /// The resource that it fills, if it is a bake.
    pub bake: Option<u32>,
}

/// Everything one texture computes.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// Callees come before their callers; the last is the entry.
    pub functions: Vec<Function>,
    /// The params of all files, in declaration order.
    pub params: Vec<Param>,
    /// The resources of all files.
    pub resources: Vec<crate::resource::Resource>,
    /// The fields that are read; a [`ViewId`] is an index into this.
    pub views: Vec<ResourceView>,
}

impl Graph {
    /// The function of a texture itself.
    pub fn entry(&self) -> FunctionId {
        FunctionId(self.functions.len().saturating_sub(1) as u32)
    }

    /// A function by its id.
    pub fn function(&self, id: FunctionId) -> &Function {
        &self.functions[id.0 as usize]
    }
}
