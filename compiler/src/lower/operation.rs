//! One operation as one expression (or a few).

use super::Lowering;
use super::body::Body;
use super::frame::{Frame, Splat, has_sampler, splat_of};
use super::helper::{self, Drawn, Hash, Pick};
use super::types::{numeric, scalar, size};
use crate::graph::{Axis, Constant, FunctionId, Level, Operation, Scalar, Slot, Type, Value};
use crate::intrinsic::{Form, Helper, Intrinsic, MULTIPLY, MULTIPLY_INT, TO_FLOAT};
use naga::{BinaryOperator, Expression, Handle, Literal, MathFunction, ScalarKind, SwizzleComponent};

impl Lowering<'_> {
    pub(super) fn operation(
        &mut self,
        body: &mut Body,
        frame: &mut Frame,
        value: Value,
        operation: &Operation,
    ) -> Handle<Expression> {
        match operation {
            Operation::Constant(constant) => self.constant(body, constant),
            Operation::Input(_) => frame.get(value),
            Operation::Param(id) => body.params[id],
            Operation::View(id) => body.views[id],
            Operation::Builtin(intrinsic, arguments) => {
                self.builtin(body, frame, value, *intrinsic, arguments)
            }
            Operation::Compose(parts) => self.composed(body, frame, frame.function.ty(value), parts),
            Operation::Extract(vector, i) => {
                let base = self.operand(body, frame, *vector);
                match frame.width(*vector) {
                    1 => base,
                    _ => body.add(Expression::AccessIndex { base, index: u32::from(*i) }),
                }
            }
            Operation::Select(condition, yes, no) => {
                let (condition, accept, reject) =
                    (frame.get(*condition), self.operand(body, frame, *yes), self.operand(body, frame, *no));
                body.add(Expression::Select { condition, accept, reject })
            }
            Operation::Sample { view, coordinate, layer, level } => {
                self.sample(body, frame, *view, *coordinate, *layer, level)
            }
            Operation::Texel { view, index, layer } => {
                let level = body.literal(Literal::I32(0));
                let coordinate = self.operand(body, frame, *index);
                body.add(Expression::ImageLoad {
                    image: frame.get(*view),
                    coordinate,
                    array_index: layer.map(|v| frame.get(v)),
                    sample: None,
                    level: Some(level),
                })
            }
            Operation::Size(view) => {
                let query = naga::ImageQuery::Size { level: None };
                let size = body.add(Expression::ImageQuery { image: frame.get(*view), query });
                body.name(&mut self.names, size, "texels");
                body.convert(size, ScalarKind::Sint)
            }
            Operation::Lookup(table, index) => self.lookup(body, frame, table, *index),
            Operation::Fold(fold) => {
                let accumulators = self.fold(body, frame, value, fold);
                let first = accumulators[0];
                frame.folds.insert(value, accumulators);
                first
            }
            Operation::Call(callee, arguments) => self.call(body, frame, value, *callee, arguments),
            Operation::Output(call, i) => match frame.function.operation(*call) {
                Operation::Call(callee, _) if self.callee(*callee).is_struct => {
                    body.add(Expression::AccessIndex { base: frame.get(*call), index: *i })
                }
                Operation::Fold(_) => frame.folds[call][*i as usize],
                _ => frame.get(*call),
            },
            Operation::Derivative(v, axis, _) => {
                let given = body.gradients.get(&(frame.get(*v), *axis)).copied();
                given.unwrap_or_else(|| derivative(body, frame.get(*v), *axis))
            }
        }
    }

    /// A lowered operand. A constant vector is written out at each use: the writer would give one
    /// that is used twice a name of its own.
    pub(super) fn operand(&mut self, body: &mut Body, frame: &Frame, value: Value) -> Handle<Expression> {
        match frame.constant(value) {
            Some(constant) if constant.width() > 1 => self.constant(body, &constant),
            _ => frame.get(value),
        }
    }

    pub(super) fn constant(&mut self, body: &mut Body, constant: &Constant) -> Handle<Expression> {
        let width = constant.width();
        if width == 1 {
            body.literal(literal(constant, 0))
        } else if constant.is_splat() {
            let value = body.literal(literal(constant, 0));
            body.add(Expression::Splat { size: size(width), value })
        } else {
            let components = (0..usize::from(width)).map(|i| body.literal(literal(constant, i))).collect();
            let ty = self.types.get(&mut self.module.types, constant.ty());
            body.add(Expression::Compose { ty, components })
        }
    }

    /// Runs of components of one vector are written as a swizzle.
    fn composed(&mut self, body: &mut Body, frame: &Frame, ty: Type, parts: &[Value]) -> Handle<Expression> {
        let width = parts.len() as u8;
        if parts.iter().all(|part| part == &parts[0]) {
            let value = frame.get(parts[0]);
            return body.add(Expression::Splat { size: size(width), value });
        }
        let mut components: Vec<Handle<Expression>> = Vec::new();
        let mut rest = parts;
        while let Some(first) = rest.first() {
            let run = self.run(frame, rest);
            components.push(match frame.function.operation(*first) {
                Operation::Extract(vector, _) if run.len() > 1 => self.swizzle(body, frame, *vector, &run),
                _ => frame.get(*first),
            });
            rest = &rest[run.len().max(1)..];
        }
        if let [whole] = components.as_slice() {
            return *whole;
        }
        let ty = self.types.get(&mut self.module.types, ty);
        body.add(Expression::Compose { ty, components })
    }

    /// The components of the first part's vector that follow one another.
    fn run(&self, frame: &Frame, parts: &[Value]) -> Vec<u8> {
        let Operation::Extract(vector, _) = frame.function.operation(parts[0]) else { return Vec::new() };
        let component = |part: &Value| match frame.function.operation(*part) {
            Operation::Extract(of, i) if of == vector && !frame.function.names.contains(*part) => Some(*i),
            _ => None,
        };
        parts.iter().map_while(component).collect()
    }

    fn swizzle(&mut self, body: &mut Body, frame: &Frame, vector: Value, run: &[u8]) -> Handle<Expression> {
        let base = self.operand(body, frame, vector);
        let width = frame.width(vector);
        if width == 1 {
            return body.add(Expression::Splat { size: size(run.len() as u8), value: base });
        }
        if usize::from(width) == run.len() && run.iter().enumerate().all(|(i, c)| i == usize::from(*c)) {
            return base;
        }
        let mut pattern = [SwizzleComponent::X; 4];
        for (slot, i) in pattern.iter_mut().zip(run) {
            *slot = SwizzleComponent::from_index(u32::from(*i));
        }
        body.add(Expression::Swizzle { size: size(run.len() as u8), vector: base, pattern })
    }

    fn sample(
        &mut self,
        body: &mut Body,
        frame: &Frame,
        view: Value,
        coordinate: Value,
        layer: Option<Value>,
        level: &Level,
    ) -> Handle<Expression> {
        let image = frame.get(view);
        let coordinate = self.operand(body, frame, coordinate);
        let level = match level {
            Level::Gradient(x, y) => {
                let (x, y) = (self.operand(body, frame, *x), self.operand(body, frame, *y));
                naga::SampleLevel::Gradient { x, y }
            }
            Level::Level(l) => naga::SampleLevel::Exact(frame.get(*l)),
            Level::Auto => naga::SampleLevel::Zero,
        };
        body.add(Expression::ImageSample {
            image,
            sampler: body.samplers.get(&image).copied().unwrap_or(image),
            gather: None,
            coordinate,
            array_index: layer.map(|v| frame.get(v)),
            offset: None,
            level,
            depth_ref: None,
            clamp_to_edge: false,
        })
    }

    fn call(
        &mut self,
        body: &mut Body,
        frame: &mut Frame,
        value: Value,
        callee: FunctionId,
        arguments: &[Value],
    ) -> Handle<Expression> {
        let mut all = Vec::with_capacity(arguments.len() + 1);
        for argument in arguments {
            let handle = self.operand(body, frame, *argument);
            all.push(handle);
            if has_sampler(frame.function.ty(*argument)) {
                all.extend(body.samplers.get(&handle));
            }
        }
        let reads = &self.reads[callee.0 as usize];
        for id in &reads.params {
            all.push(body.params[id]);
        }
        for id in &reads.views {
            let handle = body.views[id];
            all.push(handle);
            all.extend(body.samplers.get(&handle));
        }
        let callee = self.callee(callee);
        let author = frame.author_of_result(value).filter(|_| !callee.is_struct);
        body.call(callee.handle, all, author.unwrap_or(&callee.result))
    }

    fn builtin(
        &mut self,
        body: &mut Body,
        frame: &mut Frame,
        value: Value,
        intrinsic: Intrinsic,
        arguments: &[Value],
    ) -> Handle<Expression> {
        if let Some(slope) = frame.slope(value) {
            return derivative(body, frame.get(slope.product), slope.axis);
        }
        if let [a, b] = arguments
            && matches!(intrinsic, MULTIPLY | MULTIPLY_INT)
            && let Some(product) =
                self.scaled(body, frame, *a, *b).or_else(|| self.scaled(body, frame, *b, *a))
        {
            return product;
        }
        if let Some(pick) = frame.pick(value) {
            return self.pick(body, frame.get(arguments[0]), pick);
        }
        if let (TO_FLOAT, Some(Splat::Value(int))) = (intrinsic, splat_of(frame.function, arguments[0])) {
            let value = body.convert(frame.get(int), ScalarKind::Float);
            return body.add(Expression::Splat { size: size(frame.width(arguments[0])), value });
        }
        if let Some(drawn) = frame.drawn(value) {
            return self.random(body, frame, value, arguments[0], drawn);
        }
        let mut operands = arguments.iter().map(|v| self.operand(body, frame, *v));
        let Some(arg) = operands.next() else { unreachable!("an intrinsic has an argument") };
        let (arg1, arg2) = (operands.next(), operands.next());
        let ty = frame.function.ty(arguments[0]);
        match (intrinsic.row().form, arg1, arg2) {
            (Form::Operator(symbol @ ("<<" | ">>")), Some(count), _) => {
                self.shift(body, frame, symbol, (arg, count), arguments)
            }
            (Form::Operator(symbol), Some(right), _) => body.binary(binary(symbol, ty), arg, right),
            (Form::Operator(symbol), ..) => {
                let op =
                    if symbol == "!" { naga::UnaryOperator::LogicalNot } else { naga::UnaryOperator::Negate };
                body.add(Expression::Unary { op, expr: arg })
            }
            (Form::Function(name), ..) => {
                body.add(Expression::Math { fun: math(name), arg, arg1, arg2, arg3: None })
            }
            (Form::Convert, ..) => {
                let kind = if ty.is_float() { ScalarKind::Sint } else { ScalarKind::Float };
                body.convert(arg, kind)
            }
            (Form::All, ..) if ty.width() == 1 => arg,
            (Form::All, ..) => {
                body.add(Expression::Relational { fun: naga::RelationalFunction::All, argument: arg })
            }
            (Form::Choose, Some(accept), Some(reject)) => {
                body.add(Expression::Select { condition: arg, accept, reject })
            }
            (Form::Choose, ..) => unreachable!("a choice has three arguments"),
            (Form::Helper(Helper::Hash), ..) => unreachable!("a hash is called"),
            (Form::Expand(_), ..) => unreachable!("expanded before lowering"),
        }
    }

    /// The next of a word on the way to a pick.
    fn pick(&mut self, body: &mut Body, word: Handle<Expression>, pick: Pick) -> Handle<Expression> {
        let Pick::Upper(bits) = pick else { return word };
        let shift = body.literal(Literal::U32(32 - bits));
        let upper = body.binary(BinaryOperator::ShiftRight, word, shift);
        body.convert(upper, ScalarKind::Sint)
    }

    /// Random numbers, those that are read.
    fn random(
        &mut self,
        body: &mut Body,
        frame: &Frame,
        value: Value,
        argument: Value,
        drawn: Drawn,
    ) -> Handle<Expression> {
        let (argument, words) = match helper::words(frame.function, argument, drawn) {
            Some([single]) => (frame.get(*single), 1),
            Some(words) => {
                let ty = Type::Vector(Scalar::Int, words.len() as u8);
                (self.composed(body, frame, ty, words), words.len() as u8)
            }
            None => (self.operand(body, frame, argument), 4),
        };
        let function = self.helper(Hash { words, numbers: drawn.numbers });
        body.call(function, vec![argument], frame.author_of_hash(value).unwrap_or("random"))
    }

    /// A vector times a scalar, where the other factor is a scalar in every component.
    fn scaled(
        &mut self,
        body: &mut Body,
        frame: &Frame,
        vector: Value,
        factor: Value,
    ) -> Option<Handle<Expression>> {
        let scalar = match (splat_of(frame.function, vector), splat_of(frame.function, factor)?) {
            (Some(_), _) => return None,
            (None, Splat::Value(scalar)) => frame.get(scalar),
            (None, Splat::Constant(constant)) => self.constant(body, &constant),
        };
        let vector = self.operand(body, frame, vector);
        Some(body.binary(BinaryOperator::Multiply, vector, scalar))
    }

    /// Shift counts are unsigned in the shader language.
    fn shift(
        &mut self,
        body: &mut Body,
        frame: &Frame,
        symbol: &str,
        (word, count): (Handle<Expression>, Handle<Expression>),
        arguments: &[Value],
    ) -> Handle<Expression> {
        let op = if symbol == "<<" { BinaryOperator::ShiftLeft } else { BinaryOperator::ShiftRight };
        let count = match frame.constant(arguments[1]) {
            Some(c) if c.width() == 1 => body.literal(Literal::U32(c.int(0) as u32)),
            _ => body.convert(count, ScalarKind::Uint),
        };
        body.binary(op, word, count)
    }

    /// An output as a colour of four: what the complete form writes.
    pub(super) fn widened(
        &mut self,
        body: &mut Body,
        mut value: Handle<Expression>,
        slot: &Slot,
    ) -> Handle<Expression> {
        let width = slot.ty.width();
        if !slot.ty.is_float() {
            value = body.convert(value, ScalarKind::Float);
            body.name(&mut self.names, value, &slot.name);
        }
        if width == 4 {
            return value;
        }
        let zero = body.literal(Literal::F32(0.0));
        let one = body.literal(Literal::F32(1.0));
        let components = match width {
            1 => vec![value, value, value, one],
            2 => vec![value, zero, one],
            _ => vec![value, one],
        };
        let ty = super::Types::of(&mut self.module.types, numeric(scalar(Scalar::Float), 4));
        body.add(Expression::Compose { ty, components })
    }
}

fn derivative(body: &mut Body, expr: Handle<Expression>, axis: Axis) -> Handle<Expression> {
    let axis = match axis {
        Axis::X => naga::DerivativeAxis::X,
        Axis::Y => naga::DerivativeAxis::Y,
    };
    body.add(Expression::Derivative { axis, ctrl: naga::DerivativeControl::None, expr })
}

/// A component of a known number.
pub fn literal(constant: &Constant, i: usize) -> Literal {
    match constant.scalar() {
        Scalar::Float => Literal::F32(constant.float(i)),
        Scalar::Int => Literal::I32(constant.int(i)),
        Scalar::Bool => Literal::Bool(constant.bool(i)),
    }
}

/// The shader language's infix operator of that symbol, for operands of type `ty`.
fn binary(symbol: &str, ty: Type) -> BinaryOperator {
    let single = ty.width() == 1 && ty.scalar() == Some(Scalar::Bool);
    match symbol {
        "+" => BinaryOperator::Add,
        "-" => BinaryOperator::Subtract,
        "*" => BinaryOperator::Multiply,
        "/" => BinaryOperator::Divide,
        "<" => BinaryOperator::Less,
        "<=" => BinaryOperator::LessEqual,
        ">" => BinaryOperator::Greater,
        ">=" => BinaryOperator::GreaterEqual,
        "==" => BinaryOperator::Equal,
        "!=" => BinaryOperator::NotEqual,
        "&" if single => BinaryOperator::LogicalAnd,
        "|" if single => BinaryOperator::LogicalOr,
        "&" => BinaryOperator::And,
        "|" => BinaryOperator::InclusiveOr,
        "^" => BinaryOperator::ExclusiveOr,
        _ => unreachable!("a row of the intrinsic table names an operator that is not lowered: {symbol}"),
    }
}

/// The shader language's function of that name.
fn math(name: &str) -> MathFunction {
    match name {
        "floor" => MathFunction::Floor,
        "ceil" => MathFunction::Ceil,
        "round" => MathFunction::Round,
        "fract" => MathFunction::Fract,
        "abs" => MathFunction::Abs,
        "sign" => MathFunction::Sign,
        "min" => MathFunction::Min,
        "max" => MathFunction::Max,
        "clamp" => MathFunction::Clamp,
        "smoothstep" => MathFunction::SmoothStep,
        "sin" => MathFunction::Sin,
        "cos" => MathFunction::Cos,
        "asin" => MathFunction::Asin,
        "acos" => MathFunction::Acos,
        "atan2" => MathFunction::Atan2,
        "exp" => MathFunction::Exp,
        "exp2" => MathFunction::Exp2,
        "log" => MathFunction::Log,
        "log2" => MathFunction::Log2,
        "pow" => MathFunction::Pow,
        "sqrt" => MathFunction::Sqrt,
        "dot" => MathFunction::Dot,
        "length" => MathFunction::Length,
        "cross" => MathFunction::Cross,
        _ => unreachable!("a row of the intrinsic table names a function that is not lowered: {name}"),
    }
}
