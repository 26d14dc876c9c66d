//! Operators: which row of the intrinsic table a symbol means for its operands.

use super::wire::Wire;
use super::{Checker, Frame, types};
use crate::diagnostic::{Place, arguments, types as errors};
use crate::graph::{Constant, Scalar, Type, Value};
use crate::intrinsic::{Intrinsic, NEGATE, NEGATE_INT, NOT};
use crate::library::Callable;
use texgraph_grammar::syntax::{
    BinaryOperator, ChainLink, Expr, ExprKind, Name, Span, TypeKind, UnaryOperator,
};

/// A row of the intrinsic table, and the scalar that it takes.
pub type Overload = (Intrinsic, Scalar);

impl<'a> Checker<'a> {
    pub(super) fn unary(
        &mut self,
        f: &mut Frame<'a>,
        operators: &[(UnaryOperator, Span)],
        operand: &'a Expr,
        span: Span,
    ) -> Wire {
        // The least int has no positive counterpart, so its literal only works with its sign.
        if let (ExprKind::Int(Some(2_147_483_648)), [.., (UnaryOperator::Negate, _)]) =
            (&operand.kind, operators)
        {
            let least = f.builder.constant(Constant::ints(&[i32::MIN]));
            return self.prefix(f, &operators[..operators.len() - 1], least, span);
        }
        let wire = self.expr(f, operand);
        let place = self.place(f, operand.span);
        if let Wire::Matrix(columns) = &wire
            && operators.iter().all(|(operator, _)| *operator == UnaryOperator::Negate)
        {
            let odd = operators.len() % 2 == 1;
            return if odd { super::matrix::negated(f, columns) } else { wire };
        }
        match self.value(f, &wire, place) {
            Some(value) => self.prefix(f, operators, value, span),
            None => Wire::Unknown,
        }
    }

    fn prefix(
        &mut self,
        f: &mut Frame<'a>,
        operators: &[(UnaryOperator, Span)],
        mut value: Value,
        span: Span,
    ) -> Wire {
        let place = self.place(f, span);
        f.builder.set_place(place);
        for (operator, _) in operators.iter().rev() {
            let intrinsic = match (operator, f.builder.ty(value)) {
                (UnaryOperator::Negate, Type::Vector(Scalar::Int, _)) => NEGATE_INT,
                (UnaryOperator::Negate, Type::Vector(Scalar::Float, _)) => NEGATE,
                (UnaryOperator::Not, Type::Vector(Scalar::Bool, 1)) => NOT,
                (operator, ty) => {
                    let wanted = if *operator == UnaryOperator::Not { "bool" } else { "float" };
                    return self.report(f, errors::mismatch(place, None, wanted, &types::name(ty)));
                }
            };
            value = f.builder.builtin(intrinsic, &[value]);
        }
        Wire::Value(value)
    }

    pub(super) fn chain(&mut self, f: &mut Frame<'a>, first: &'a Expr, links: &'a [ChainLink]) -> Wire {
        if let [link] = links
            && let Some((input, word, words)) = chosen(f, first)
        {
            return self.compare_choice(f, input, &word, words, link);
        }
        let start = self.place(f, first.span);
        let mut left = self.operand(f, first);
        let mut place = start;
        for link in links {
            let right_place = self.place(f, link.operand.span);
            let right = self.operand(f, &link.operand);
            let whole = Place { span: place.span.to(link.operand.span), ..place };
            left = match (&left, &right) {
                (Wire::Unknown, _) | (_, Wire::Unknown) => Wire::Unknown,
                (Wire::Value(a), Wire::Value(b)) => self
                    .operator(f, link, (*a, place), (*b, right_place), whole)
                    .map_or(Wire::Unknown, Wire::Value),
                (a, b) => self.matrix_operator(f, link, (a, place), (b, right_place), whole),
            };
            place = whole;
        }
        left
    }

    /// `edges == wrap`: whether that word was chosen, which is known in each specialisation.
    fn compare_choice(
        &mut self,
        f: &mut Frame<'a>,
        input: &str,
        word: &str,
        words: &[Name],
        link: &ChainLink,
    ) -> Wire {
        let place = self.place(f, link.operand.span);
        let holds_if_same = match link.operator {
            BinaryOperator::Equal => true,
            BinaryOperator::NotEqual => false,
            _ => return self.report(f, errors::mismatch(place, None, "`==` or `!=`", "another operator")),
        };
        match &link.operand.kind {
            ExprKind::Name(other) if words.iter().any(|known| known.text == *other) => {
                let holds = (word == other.as_str()) == holds_if_same;
                Wire::Value(f.builder.constant(Constant::bools(&[holds])))
            }
            other => {
                let written = if let ExprKind::Name(name) = other { name.as_str() } else { "" };
                let words: Vec<String> = words.iter().map(|known| known.text.to_string()).collect();
                self.report(f, arguments::unknown_choice(place, input, &words, written))
            }
        }
    }

    /// An operand: a value or a matrix; anything else is reported.
    fn operand(&mut self, f: &mut Frame<'a>, operand: &'a Expr) -> Wire {
        let place = self.place(f, operand.span);
        match self.expr(f, operand) {
            wire @ Wire::Matrix(_) => wire,
            wire => self.value(f, &wire, place).map_or(Wire::Unknown, Wire::Value),
        }
    }

    /// An operator: the first overload that takes both operands without narrowing.
    fn operator(
        &mut self,
        f: &mut Frame<'a>,
        link: &ChainLink,
        (a, a_place): (Value, Place),
        (b, b_place): (Value, Place),
        whole: Place,
    ) -> Option<Value> {
        let (left, right) = (f.builder.ty(a), f.builder.ty(b));
        let Some((intrinsic, scalar)) = self.overload(link.operator, left, right) else {
            let found = [types::name(left), types::name(right)];
            let accepted = self.accepted(link.operator);
            let at = self.place(f, link.operator_span);
            let mut diagnostic = errors::no_overload(at, link.operator.symbol(), &found, &accepted);
            diagnostic = diagnostic
                .related(a_place, format!("`{}`", found[0]))
                .related(b_place, format!("`{}`", found[1]));
            self.report(f, diagnostic);
            return None;
        };
        let scalars_only = link.operator.precedence() == 3
            && !matches!(link.operator, BinaryOperator::Equal | BinaryOperator::NotEqual);
        for (ty, place) in [(left, a_place), (right, b_place)] {
            if scalars_only && ty.width() > 1 {
                self.report(f, errors::not_a_scalar(place, &types::name(ty)));
                return None;
            }
        }
        let width = left.width().max(right.width());
        if left.width() != right.width() && left.width() > 1 && right.width() > 1 {
            self.report(f, errors::widths_differ(b_place, left.width(), right.width(), a_place));
            return None;
        }
        f.builder.set_place(whole);
        let mut operands = [a, b];
        for value in &mut operands {
            if scalar == Scalar::Float {
                *value = f.builder.to_float(*value);
            }
            *value = f.builder.splat(*value, width);
        }
        Some(f.builder.builtin(intrinsic, &operands))
    }

    /// The row of an operator for operands of these types, looked up once.
    fn overload(&mut self, operator: BinaryOperator, left: Type, right: Type) -> Option<Overload> {
        let library = self.library;
        let find = || {
            library.callables(operator.symbol()).iter().find_map(|callable| {
                let Callable::Intrinsic(intrinsic) = callable else { return None };
                let first = library.signature(*callable)?.inputs.first()?;
                let scalar = types::scalar_of(&first.ty)?;
                let fits = |ty: Type| ty.scalar().is_some_and(|found| types::widens(found, scalar));
                (fits(left) && fits(right)).then_some((*intrinsic, scalar))
            })
        };
        *self.overloads.entry((operator, left, right)).or_insert_with(find)
    }

    fn accepted(&self, operator: BinaryOperator) -> Vec<String> {
        let signatures =
            self.library.callables(operator.symbol()).iter().filter_map(|c| self.library.signature(*c));
        let mut accepted: Vec<String> = signatures
            .filter_map(|signature| {
                let first = signature.inputs.first()?;
                Some(match types::scalar_of(&first.ty)? {
                    Scalar::Float => "floats".to_owned(),
                    Scalar::Int => "ints".to_owned(),
                    Scalar::Bool => "bools".to_owned(),
                })
            })
            .collect();
        accepted.dedup();
        accepted
    }
}

/// An input of the node that is a choice: its name, the word that was chosen, and all its words.
fn chosen<'a>(f: &mut Frame<'a>, operand: &'a Expr) -> Option<(&'a str, String, &'a [Name])> {
    let ExprKind::Name(name) = &operand.kind else { return None };
    let Some(Wire::Word(word)) = f.lookup(name) else { return None };
    let input = f.node?.inputs.iter().find(|input| input.name.text == *name)?;
    match &input.ty.kind {
        TypeKind::Choice(words) => Some((name, word.text.clone(), words)),
        _ => None,
    }
}
