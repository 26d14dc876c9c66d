//! Pairs of expressions; operators are sorted by precedence here.

use super::pairs::{Pair, Parts};
use super::{Builder, Rule};
use crate::error::{SyntaxError, SyntaxErrorKind};
use crate::syntax::{
    Argument, BinaryOperator, Call, ChainLink, Expr, ExprKind, Fold, Name, Postfix, Range, Span,
    UnaryOperator,
};

type Built<T> = Result<T, SyntaxError>;

/// Operators of one precedence that still wait for their last operand.
struct OpenChain {
    first: Expr,
    links: Vec<ChainLink>,
    operator: BinaryOperator,
    operator_span: Span,
}

impl OpenChain {
    /// Takes the operand of the waiting operator.
    fn push(&mut self, operand: Expr) {
        let (operator, operator_span) = (self.operator, self.operator_span);
        self.links.push(ChainLink { operator, operator_span, operand });
    }

    /// Takes the last operand.
    fn finish(mut self, operand: Expr) -> Expr {
        let span = self.first.span.to(operand.span);
        self.push(operand);
        Expr { span, kind: ExprKind::Chain { first: Box::new(self.first), links: self.links } }
    }
}

impl<'s> Builder<'s> {
    /// A flat row of operands and operators, nested by precedence with a stack of open chains whose
    /// precedences rise.
    pub(super) fn expr(&mut self, pair: Pair<'s>) -> Built<Expr> {
        let mut parts = self.parts_of(pair);
        let mut operand = self.unary(&mut parts)?;
        let mut open: Vec<OpenChain> = Vec::new();
        while let Some(sign) = parts.next() {
            let operator = self.operator(sign)?;
            let operator_span = sign.span;
            while let Some(chain) = open.pop_if(|chain| chain.operator.precedence() > operator.precedence()) {
                operand = chain.finish(operand);
            }
            let next = self.unary(&mut parts)?;
            let left = std::mem::replace(&mut operand, next);
            match open.last_mut() {
                Some(chain) if chain.operator.precedence() == operator.precedence() => {
                    chain.push(left);
                    self.forbid_chain(operator, operator_span);
                    (chain.operator, chain.operator_span) = (operator, operator_span);
                }
                _ => {
                    // Most chains have one.
                    let links = Vec::with_capacity(1);
                    open.push(OpenChain { first: left, links, operator, operator_span });
                }
            }
        }
        Ok(open.into_iter().rev().fold(operand, |operand, chain| chain.finish(operand)))
    }

    fn forbid_chain(&mut self, operator: BinaryOperator, span: Span) {
        if operator.precedence() == BinaryOperator::Less.precedence() {
            self.errors.push(SyntaxError::new(SyntaxErrorKind::ChainedComparison, span));
        }
    }

    fn operator(&self, pair: Pair<'s>) -> Built<BinaryOperator> {
        use BinaryOperator as Op;
        const ALL: [BinaryOperator; 13] = [
            Op::Multiply,
            Op::Divide,
            Op::Remainder,
            Op::Add,
            Op::Subtract,
            Op::Less,
            Op::LessEqual,
            Op::Greater,
            Op::GreaterEqual,
            Op::Equal,
            Op::NotEqual,
            Op::And,
            Op::Or,
        ];
        let operator = ALL.into_iter().find(|operator| operator.symbol() == pair.text());
        operator.ok_or_else(|| self.missing("an operator"))
    }

    /// The next operand, with the prefixes before it.
    fn unary(&mut self, parts: &mut Parts<'s>) -> Built<Expr> {
        let mut operators = Vec::new();
        while let Some(prefix) = parts.accept(Rule::prefix) {
            let operator = if prefix.text() == "-" { UnaryOperator::Negate } else { UnaryOperator::Not };
            operators.push((operator, prefix.span));
        }
        let operand = self.next(parts, "an operand")?;
        let operand = self.postfix(operand)?;
        let Some((_, first)) = operators.first() else {
            return Ok(operand);
        };
        let span = first.to(operand.span);
        Ok(Expr { span, kind: ExprKind::Unary { operators, operand: Box::new(operand) } })
    }

    fn postfix(&mut self, pair: Pair<'s>) -> Built<Expr> {
        let span = pair.span;
        let mut parts = self.parts_of(pair);
        let base = self.next(&mut parts, "an operand")?;
        let base = self.primary(base)?;
        if parts.len() == 0 {
            return Ok(base);
        }
        let links = self.each(parts, Builder::link)?;
        Ok(Expr { span, kind: ExprKind::Postfix { base: Box::new(base), links } })
    }

    fn link(&mut self, pair: Pair<'s>) -> Built<Postfix> {
        let span = pair.span;
        if pair.rule == Rule::index {
            let index = self.only_expr(pair)?;
            return Ok(Postfix::Index(Box::new(index), span));
        }
        Ok(match self.reference(pair)? {
            (call, true) => Postfix::Method(call, span),
            (call, false) => Postfix::Field(call.name),
        })
    }

    /// A name, with its arguments if it is a call.
    fn reference(&mut self, pair: Pair<'s>) -> Built<(Call, bool)> {
        let mut parts = self.parts_of(pair);
        let name = self.next_name(&mut parts)?;
        let dim = parts.accept(Rule::call_dim).map(|dim| self.dim(dim)).transpose()?;
        let arguments = parts.next();
        let is_call = arguments.is_some();
        let arguments = arguments.map(|pair| self.arguments(pair)).transpose()?;
        Ok((Call { name, dim, arguments: arguments.unwrap_or_default() }, is_call))
    }

    fn arguments(&mut self, pair: Pair<'s>) -> Built<Vec<Argument>> {
        let parts = self.parts_of(pair);
        let mut arguments: Vec<Argument> = Vec::with_capacity(parts.len());
        for part in parts {
            let argument = self.argument(part)?;
            let before = arguments.last().and_then(|before| before.name.as_ref());
            if let (None, Some(named)) = (&argument.name, before) {
                let kind = SyntaxErrorKind::PositionalAfterNamed { named: named.text.to_string() };
                self.errors.push(SyntaxError::new(kind, argument.value.span));
            }
            arguments.push(argument);
        }
        Ok(arguments)
    }

    fn argument(&mut self, pair: Pair<'s>) -> Built<Argument> {
        let mut parts = self.parts_of(pair);
        let name = parts.accept(Rule::name).map(|name| self.name(name));
        let value = self.next(&mut parts, "an argument")?;
        let value = if value.rule == Rule::lambda { self.lambda(value)? } else { self.expr(value)? };
        Ok(Argument { name, value })
    }

    fn lambda(&mut self, pair: Pair<'s>) -> Built<Expr> {
        let span = pair.span;
        let mut parts = self.parts_of(pair);
        let inputs = self.next(&mut parts, "a lambda's inputs")?;
        let inputs = self.names(inputs);
        let body = Box::new(self.next_expr(&mut parts)?);
        Ok(Expr { span, kind: ExprKind::Lambda { inputs, body } })
    }

    fn primary(&mut self, pair: Pair<'s>) -> Built<Expr> {
        let span = pair.span;
        let kind = match pair.rule {
            Rule::paren => ExprKind::Paren(Box::new(self.only_expr(pair)?)),
            Rule::list => ExprKind::List(self.each(self.parts_of(pair), Builder::expr)?),
            Rule::choice => self.choice(pair)?,
            Rule::fold => ExprKind::Fold(Box::new(self.fold(pair)?)),
            Rule::reference => match self.reference(pair)? {
                (call, true) => ExprKind::Call(Box::new(call)),
                (call, false) => ExprKind::Name(call.name.text),
            },
            _ => self.literal(pair),
        };
        Ok(Expr { span, kind })
    }

    fn choice(&mut self, pair: Pair<'s>) -> Built<ExprKind> {
        let mut arms = Vec::new();
        let mut parts = self.parts_of(pair);
        loop {
            let head = self.next(&mut parts, "an arm")?;
            if head.rule == Rule::arm {
                let otherwise = Box::new(self.only_expr(head)?);
                return Ok(ExprKind::If { arms, otherwise });
            }
            let condition = self.expr(head)?;
            let arm = self.next(&mut parts, "an arm")?;
            arms.push((condition, self.only_expr(arm)?));
        }
    }

    pub(super) fn range(&mut self, pair: Pair<'s>) -> Built<Range> {
        let span = pair.span;
        let mut parts = self.parts_of(pair);
        let start = Box::new(self.next_expr(&mut parts)?);
        let inclusive = self.next(&mut parts, "`..`")?.text() == "..=";
        let end = Box::new(self.next_expr(&mut parts)?);
        Ok(Range { start, end, inclusive, span })
    }

    fn fold(&mut self, pair: Pair<'s>) -> Built<Fold> {
        let mut parts = self.parts_of(pair);
        let mut accumulators = Vec::new();
        while let Some(accumulator) = parts.accept(Rule::accumulator) {
            accumulators.push(self.accumulator(accumulator)?);
        }
        let variable = self.next_name(&mut parts)?;
        let range = self.next(&mut parts, "a range")?;
        let range = self.range(range)?;
        let max = self.fold_part(&mut parts, Rule::fold_max)?;
        let condition = self.fold_part(&mut parts, Rule::fold_while)?;
        let body = self.next(&mut parts, "a body")?;
        let body = self.body(body)?;
        Ok(Fold { accumulators, variable, range, max, condition, body })
    }

    fn accumulator(&mut self, pair: Pair<'s>) -> Built<(Name, Expr)> {
        let mut parts = self.parts_of(pair);
        Ok((self.next_name(&mut parts)?, self.next_expr(&mut parts)?))
    }

    fn fold_part(&mut self, parts: &mut Parts<'s>, rule: Rule) -> Built<Option<Expr>> {
        parts.accept(rule).map(|part| self.only_expr(part)).transpose()
    }
}
