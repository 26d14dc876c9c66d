//! A naga function in the making.

use crate::graph::{Axis, ParamId, ViewId};
use crate::naming::{Names, Scope};
use naga::{BinaryOperator, Block, Expression, Handle, Literal, Scalar, Span, Statement};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

/// The expressions and statements of a naga function, the names taken in it, and where it finds
/// what is not computed.
pub struct Body<'f> {
    function: &'f mut naga::Function,
    /// How many of the expressions stand in statements already, or need none.
    emitted: usize,
    /// The blocks around the current one, outermost first.
    around: Vec<Block>,
    pub scope: Scope,
    pub params: FxHashMap<ParamId, Handle<Expression>>,
    pub views: FxHashMap<ViewId, Handle<Expression>>,
    /// The sampler that goes with a texture.
    pub samplers: FxHashMap<Handle<Expression>, Handle<Expression>>,
    /// Derivatives of inputs that are given.
    pub gradients: FxHashMap<(Handle<Expression>, Axis), Handle<Expression>>,
    /// Numbers that are there already.
    literals: FxHashMap<(Scalar, u32), Handle<Expression>>,
    /// Numbers of calls' results with their names.
    results: Results,
}

/// The names of calls' results in one function, by the number that the text writer gives each.
pub type Results = FxHashMap<u32, SmolStr>;

/// A variable of a function.
#[derive(Clone)]
pub struct Variable {
    handle: Handle<naga::LocalVariable>,
    name: SmolStr,
}

impl Variable {
    /// As it is written.
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl<'f> Body<'f> {
    pub fn new(function: &'f mut naga::Function, scope: Scope) -> Body<'f> {
        Body {
            emitted: function.expressions.len(),
            function,
            around: Vec::new(),
            scope,
            params: FxHashMap::default(),
            views: FxHashMap::default(),
            samplers: FxHashMap::default(),
            gradients: FxHashMap::default(),
            literals: FxHashMap::default(),
            results: FxHashMap::default(),
        }
    }

    fn flush(&mut self) {
        let expressions = &self.function.expressions;
        if self.emitted < expressions.len() {
            let range = expressions.range_from(self.emitted);
            self.emitted = expressions.len();
            self.function.body.push(Statement::Emit(range), Span::UNDEFINED);
        }
    }

    /// An expression, evaluated here. What is known without evaluation may not be.
    pub fn add(&mut self, expression: Expression) -> Handle<Expression> {
        let known = expression.needs_pre_emit() || matches!(expression, Expression::CallResult(_));
        if !known {
            return self.function.expressions.append(expression, Span::UNDEFINED);
        }
        self.flush();
        self.emitted += 1;
        self.function.expressions.append(expression, Span::UNDEFINED)
    }

    pub fn statement(&mut self, statement: Statement) {
        self.flush();
        self.function.body.push(statement, Span::UNDEFINED);
    }

    /// Begins a block: what follows stands in it, until it is closed.
    pub fn open(&mut self) {
        self.flush();
        self.around.push(std::mem::take(&mut self.function.body));
    }

    /// Ends the innermost block that is open.
    pub fn close(&mut self) -> Block {
        self.flush();
        let around = self.around.pop().unwrap_or_default();
        std::mem::replace(&mut self.function.body, around)
    }

    /// Ends the function.
    pub fn finish(mut self, result: Handle<Expression>) -> Results {
        self.statement(Statement::Return { value: Some(result) });
        self.results
    }

    /// Names a value so, or like it.
    pub fn name(&mut self, names: &mut Names, expression: Handle<Expression>, wish: &str) {
        let name = names.placeholder(self.scope.name(wish));
        self.function.named_expressions.insert(expression, name);
    }

    /// A number; there is one expression for each, wherever it is used.
    pub fn literal(&mut self, literal: Literal) -> Handle<Expression> {
        let (scalar, bits) = match literal {
            Literal::F32(float) => (Scalar::F32, float.to_bits()),
            Literal::I32(int) => (Scalar::I32, int as u32),
            Literal::U32(word) => (Scalar::U32, word),
            Literal::Bool(bool) => (Scalar::BOOL, u32::from(bool)),
            _ => return self.add(Expression::Literal(literal)),
        };
        if let Some(handle) = self.literals.get(&(scalar, bits)) {
            return *handle;
        }
        let handle = self.add(Expression::Literal(literal));
        self.literals.insert((scalar, bits), handle);
        handle
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

    /// A call with a result of that name, or one like it.
    pub fn call(
        &mut self,
        function: Handle<naga::Function>,
        arguments: Vec<Handle<Expression>>,
        wish: &str,
    ) -> Handle<Expression> {
        let result = self.add(Expression::CallResult(function));
        self.statement(Statement::Call { function, arguments, result: Some(result) });
        let name = self.scope.name(wish);
        self.results.insert(result.index() as u32, name);
        result
    }

    /// A variable of that name, or one like it; not yet stored to.
    pub fn variable(&mut self, names: &mut Names, wish: &str, ty: Handle<naga::Type>) -> Variable {
        let name = self.scope.name(wish);
        let placeholder = names.placeholder(name.clone());
        self.declare(placeholder, name, ty)
    }

    /// A variable of that name, or one like it, that begins here and is read and stored to in this
    /// block only, and the blocks in it.
    pub fn begin(
        &mut self,
        names: &mut Names,
        wish: &str,
        ty: Handle<naga::Type>,
        start: Handle<Expression>,
    ) -> Variable {
        let name = self.scope.name(wish);
        let placeholder = names.stored(name.clone());
        let variable = self.declare(placeholder, name, ty);
        self.store(&variable, start);
        variable
    }

    fn declare(&mut self, placeholder: String, name: SmolStr, ty: Handle<naga::Type>) -> Variable {
        let variable = naga::LocalVariable { name: Some(placeholder), ty, init: None };
        Variable { handle: self.function.local_variables.append(variable, Span::UNDEFINED), name }
    }

    pub fn store(&mut self, variable: &Variable, value: Handle<Expression>) {
        let pointer = self.add(Expression::LocalVariable(variable.handle));
        self.statement(Statement::Store { pointer, value });
    }

    /// What is in a variable, written as the variable itself: only for as long as nothing else is
    /// stored to it.
    pub fn load(&mut self, names: &mut Names, variable: &Variable) -> Handle<Expression> {
        let loaded = self.load_now(variable);
        self.function.named_expressions.insert(loaded, names.alias(variable.name.clone()));
        loaded
    }

    /// What is in a variable now.
    pub fn load_now(&mut self, variable: &Variable) -> Handle<Expression> {
        let pointer = self.add(Expression::LocalVariable(variable.handle));
        self.add(Expression::Load { pointer })
    }
}
