//! One function of the graph as one naga function.
//!
//! A value gets a name in the text if the author named it, if it is used twice, or when its unnamed
//! nest would reach [`MAX_NEST`]; any other is written where it is used.

use super::types::Types;
use super::{Callee, Captures, Lowering, Member};
use crate::graph::{Constant, Function, Operation, ParamId, Type, Value, ViewId};
use crate::intrinsic::{MULTIPLY, MULTIPLY_INT};
use crate::naming::{Scope, camel_case};
use naga::{BinaryOperator, Expression, Handle, Literal, Span, Statement};
use rustc_hash::FxHashMap;

/// Unnamed operations inside each other at most.
const MAX_NEST: u8 = 16;

/// The expressions and statements of a naga function in the making.
pub struct Body<'f> {
    function: &'f mut naga::Function,
    emitter: naga::proc::Emitter,
}

impl<'f> Body<'f> {
    pub fn new(function: &'f mut naga::Function) -> Body<'f> {
        let mut emitter = naga::proc::Emitter::default();
        emitter.start(&function.expressions);
        Body { function, emitter }
    }

    fn flush(&mut self) {
        if let Some((statement, span)) = self.emitter.finish(&self.function.expressions) {
            self.function.body.push(statement, span);
        }
    }

    /// An expression, evaluated here. What is known without evaluation may not be.
    pub fn add(&mut self, expression: Expression) -> Handle<Expression> {
        let known = expression.needs_pre_emit() || matches!(expression, Expression::CallResult(_));
        if !known {
            return self.function.expressions.append(expression, Span::UNDEFINED);
        }
        self.flush();
        let handle = self.function.expressions.append(expression, Span::UNDEFINED);
        self.emitter.start(&self.function.expressions);
        handle
    }

    pub fn statement(&mut self, statement: Statement) {
        self.flush();
        self.function.body.push(statement, Span::UNDEFINED);
        self.emitter.start(&self.function.expressions);
    }

    /// Ends the function.
    pub fn finish(mut self, statement: Statement) {
        self.flush();
        self.function.body.push(statement, Span::UNDEFINED);
    }

    pub fn name(&mut self, expression: Handle<Expression>, placeholder: String) {
        self.function.named_expressions.insert(expression, placeholder);
    }

    pub fn literal(&mut self, literal: Literal) -> Handle<Expression> {
        self.add(Expression::Literal(literal))
    }

    pub fn binary(
        &mut self,
        op: BinaryOperator,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Handle<Expression> {
        self.add(Expression::Binary { op, left, right })
    }

    /// By value: ints round, words keep their bits.
    pub fn convert(&mut self, expr: Handle<Expression>, kind: naga::ScalarKind) -> Handle<Expression> {
        self.add(Expression::As { expr, kind, convert: Some(4) })
    }

    /// A call with a result, and the result's number in the text.
    pub fn call(
        &mut self,
        function: Handle<naga::Function>,
        arguments: Vec<Handle<Expression>>,
    ) -> (Handle<Expression>, u32) {
        let result = self.add(Expression::CallResult(function));
        self.statement(Statement::Call { function, arguments, result: Some(result) });
        (result, result.index() as u32)
    }
}

/// What a function is being lowered with.
pub struct Frame<'g> {
    pub function: &'g Function,
    /// Lowered values.
    pub values: Vec<Option<Handle<Expression>>>,
    /// How deep the unnamed nest of each is.
    nest: Vec<u8>,
    uses: Vec<u32>,
    pub scope: Scope,
    pub params: FxHashMap<ParamId, Handle<Expression>>,
    pub views: FxHashMap<ViewId, Handle<Expression>>,
    /// The sampler that goes with a texture.
    pub samplers: FxHashMap<Handle<Expression>, Handle<Expression>>,
    /// Numbers of calls' results with their names.
    pub results: FxHashMap<u32, String>,
}

impl Lowering<'_> {
    /// Lowers function `index` of the graph; its callees are lowered already.
    pub(super) fn function(&mut self, index: usize) {
        let graph = self.graph;
        let source = &graph.functions[index];
        let captures = self.captures(index);
        let is_entry = index + 1 == graph.functions.len();
        let wish = if is_entry { "texture" } else { source.name.as_str() };
        let name = self.module_name(wish);
        let mut scope = Scope::inside(&self.prefix);
        let arguments = self.arguments(source, &captures, &mut scope);
        let is_struct = source.outputs.len() > 1;
        let result = self.result_type(source, &name);
        let mut function = naga::Function {
            name: Some(self.names.placeholder(name)),
            arguments,
            result: Some(naga::FunctionResult { ty: result, binding: None }),
            ..Default::default()
        };
        let mut body = Body::new(&mut function);
        let mut frame = Frame::new(source, scope);
        self.bind_arguments(&mut body, &mut frame, &captures);
        for (value, operation) in source.iter() {
            self.value(&mut body, &mut frame, value, operation);
        }
        let outputs: Vec<Handle<Expression>> =
            source.outputs.iter().map(|(_, value)| frame.get(*value)).collect();
        let value = match outputs.as_slice() {
            [single] => *single,
            _ => body.add(Expression::Compose { ty: result, components: outputs }),
        };
        body.finish(Statement::Return { value: Some(value) });
        self.results.push(frame.results);
        let handle = self.module.functions.append(function, Span::UNDEFINED);
        self.functions.push(Callee { handle, captures, is_struct, name: source.name.clone() });
    }

    /// The type of a function's result: its only output, or a struct of all.
    fn result_type(&mut self, source: &Function, name: &str) -> Handle<naga::Type> {
        let types: Vec<Handle<naga::Type>> =
            source.outputs.iter().map(|(slot, _)| self.types.get(&mut self.module.types, slot.ty)).collect();
        match types.as_slice() {
            [single] => *single,
            _ => {
                let members = source.outputs.iter().zip(types);
                let members =
                    members.map(|((slot, _), ty)| Member { name: slot.name.clone(), ty, binding: None });
                self.structure(&camel_case(name), members.collect())
            }
        }
    }

    /// Inputs, params, views; a sampled view is a texture and a sampler.
    fn arguments(
        &mut self,
        source: &Function,
        captures: &Captures,
        scope: &mut Scope,
    ) -> Vec<naga::FunctionArgument> {
        let mut slots: Vec<(String, Type)> = source.inputs.iter().map(|s| (s.name.clone(), s.ty)).collect();
        for id in &captures.params {
            let param = &self.graph.params[id.0 as usize];
            slots.push((param.name.clone(), param.ty));
        }
        for id in &captures.views {
            let view = &self.graph.views[id.0 as usize];
            let resource = &self.graph.resources[view.resource as usize];
            slots.push((format!("{}_{}", resource.name, view.field), Type::View(view.view)));
        }
        let mut arguments = Vec::new();
        for (wish, ty) in slots {
            let name = scope.name(&wish);
            let sampler =
                format!("{}_sampler", wish.rsplit_once('_').map_or(wish.as_str(), |(resource, _)| resource));
            let placeholder = self.names.placeholder(name);
            let handle = self.types.get(&mut self.module.types, ty);
            arguments.push(naga::FunctionArgument { name: Some(placeholder), ty: handle, binding: None });
            if has_sampler(ty) {
                let placeholder = self.names.placeholder(scope.name(&sampler));
                let ty = Types::sampler(&mut self.module.types);
                arguments.push(naga::FunctionArgument { name: Some(placeholder), ty, binding: None });
            }
        }
        arguments
    }

    fn bind_arguments(&mut self, body: &mut Body, frame: &mut Frame, captures: &Captures) {
        let mut next = 0;
        let mut argument = |body: &mut Body, frame: &mut Frame, ty: Type| {
            let handle = body.add(Expression::FunctionArgument(next));
            next += 1;
            if has_sampler(ty) {
                let sampler = body.add(Expression::FunctionArgument(next));
                next += 1;
                frame.samplers.insert(handle, sampler);
            }
            handle
        };
        let inputs: Vec<Handle<Expression>> = frame
            .function
            .inputs
            .iter()
            .map(|slot| slot.ty)
            .collect::<Vec<_>>()
            .into_iter()
            .map(|ty| argument(body, frame, ty))
            .collect();
        for (value, operation) in frame.function.iter() {
            if let Operation::Input(i) = operation {
                frame.values[value.0 as usize] = inputs.get(*i as usize).copied();
            }
        }
        for id in &captures.params {
            let handle = argument(body, frame, self.graph.params[id.0 as usize].ty);
            frame.params.insert(*id, handle);
        }
        for id in &captures.views {
            let handle = argument(body, frame, Type::View(self.graph.views[id.0 as usize].view));
            frame.views.insert(*id, handle);
        }
    }

    /// Lowers one value and names it where that is called for.
    fn value(&mut self, body: &mut Body, frame: &mut Frame, value: Value, operation: &Operation) {
        let index = value.0 as usize;
        if frame.values[index].is_some() || frame.uses[index] == 0 {
            return;
        }
        let handle = self.operation(body, frame, value, operation);
        frame.values[index] = Some(handle);
        let mut nest = 0;
        operation.for_operands(|v| nest = nest.max(frame.nest[v.0 as usize]));
        let nest = nest.saturating_add(1);
        let plain = matches!(
            operation,
            Operation::Constant(_)
                | Operation::Param(_)
                | Operation::View(_)
                | Operation::Call(..)
                | Operation::Input(_)
        );
        let cheap = matches!(operation, Operation::Extract(..) | Operation::Output(..));
        let eager = matches!(
            operation,
            Operation::Sample { .. } | Operation::Texel { .. } | Operation::Derivative(..)
        );
        let author = frame.function.names.get(&value);
        let named =
            !plain && (author.is_some() || eager || nest >= MAX_NEST || (!cheap && frame.uses[index] > 1));
        if named {
            let wish = author.map_or_else(|| hint(operation).to_owned(), String::clone);
            let name = self.names.placeholder(frame.scope.name(&wish));
            body.name(handle, name);
        }
        frame.nest[index] = if named || plain { 0 } else { nest };
    }
}

/// How often each value is written. A factor that is a scalar in every component is written as
/// that scalar.
fn uses(function: &Function) -> Vec<u32> {
    let mut uses = vec![0; function.values.len()];
    for (_, value) in &function.outputs {
        uses[value.0 as usize] += 1;
    }
    for (value, operation) in function.iter().rev() {
        if uses[value.0 as usize] == 0 {
            continue;
        }
        let factors = match operation {
            Operation::Builtin(MULTIPLY | MULTIPLY_INT, factors) => factors.as_slice(),
            _ => &[],
        };
        let scalars: Vec<Option<Splat>> = factors.iter().map(|v| splat_of(function, *v)).collect();
        match scalars.as_slice() {
            [Some(Splat::Value(scalar)), None] | [None, Some(Splat::Value(scalar))] => {
                let vector = if scalars[0].is_none() { factors[0] } else { factors[1] };
                uses[scalar.0 as usize] += 1;
                uses[vector.0 as usize] += 1;
            }
            _ => operation.for_operands(|v| uses[v.0 as usize] += 1),
        }
    }
    uses
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
        Operation::Constant(c) if c.width() > 1 && c.bits().iter().all(|bits| *bits == c.bits()[0]) => {
            Some(Splat::Constant(c.component(0)))
        }
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

/// What a value without a name of its own is called.
fn hint(operation: &Operation) -> &str {
    match operation {
        Operation::Sample { .. } => "sampled",
        Operation::Texel { .. } => "texel",
        Operation::Size(_) => "size",
        Operation::Select(..) => "chosen",
        Operation::Compose(_) => "vector",
        Operation::Derivative(..) => "slope",
        _ => "t",
    }
}

impl<'g> Frame<'g> {
    fn new(function: &'g Function, scope: Scope) -> Frame<'g> {
        Frame {
            function,
            values: vec![None; function.values.len()],
            nest: vec![0; function.values.len()],
            uses: uses(function),
            scope,
            params: FxHashMap::default(),
            views: FxHashMap::default(),
            samplers: FxHashMap::default(),
            results: FxHashMap::default(),
        }
    }

    /// A lowered value. Operands come before what uses them, so it is there.
    pub fn get(&self, value: Value) -> Handle<Expression> {
        match self.values[value.0 as usize] {
            Some(handle) => handle,
            None => unreachable!("a value is lowered after its operands"),
        }
    }
}
