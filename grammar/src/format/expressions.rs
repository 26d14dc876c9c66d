//! Expressions.

use super::Formatter;
use super::layout::{Piece, Style};
use super::writer::Gap;
use crate::syntax::{Argument, Call, ChainLink, Expr, ExprKind, Fold, Postfix, Range, UnaryOperator};

impl Formatter<'_> {
    pub(super) fn expr(&mut self, gap: Gap, expr: &Expr) {
        self.writer.lead(gap);
        match &expr.kind {
            ExprKind::Paren(inner) => {
                self.writer.token(Gap::Glue, "(");
                self.expr(Gap::Glue, inner);
                self.writer.token(Gap::Glue, ")");
            }
            ExprKind::Call(call) => self.call(call),
            ExprKind::Postfix { base, links } => self.postfix(base, links),
            ExprKind::Unary { operators, operand } => {
                for (operator, _) in operators {
                    self.writer.token(Gap::Glue, sign(*operator));
                }
                self.expr(Gap::Glue, operand);
            }
            ExprKind::Chain { first, links } => self.chain(first, links),
            ExprKind::If { arms, otherwise } => self.choose(arms, otherwise),
            ExprKind::List(values) => self.values(values),
            ExprKind::Lambda { inputs, body } => {
                self.names("|", inputs, "|");
                self.expr(Gap::Space, body);
            }
            ExprKind::Fold(fold) => self.fold(fold),
            ExprKind::Int(_)
            | ExprKind::Float(_)
            | ExprKind::Bool(_)
            | ExprKind::Text(_)
            | ExprKind::Color(_)
            | ExprKind::Name(_) => self.writer.copy(Gap::Glue, expr.span),
        }
    }

    fn call(&mut self, call: &Call) {
        self.name(Gap::Glue, &call.name);
        self.dim(call.dim.as_ref());
        self.open_list(Gap::Glue, "(", Style::Even);
        for (index, argument) in call.arguments.iter().enumerate() {
            let gap = self.separator(index);
            self.argument(gap, argument);
        }
        self.close_list(")", call.arguments.is_empty());
    }

    fn argument(&mut self, gap: Gap, argument: &Argument) {
        let Some(name) = &argument.name else {
            return self.expr(gap, &argument.value);
        };
        self.name(gap, name);
        self.writer.token(Gap::Glue, ":");
        self.expr(Gap::Space, &argument.value);
    }

    /// Breaks before a method that follows a call, where that helps.
    fn postfix(&mut self, base: &Expr, links: &[Postfix]) {
        self.writer.open(Style::Links);
        self.expr(Gap::Glue, base);
        self.writer.pieces.push(Piece::IndentIfBroken);
        let mut follows_call = matches!(base.kind, ExprKind::Call(_));
        for link in links {
            let is_method = matches!(link, Postfix::Method(..));
            self.link(if is_method && follows_call { Gap::SoftGlue } else { Gap::Glue }, link);
            follows_call |= is_method;
        }
        self.writer.pieces.push(Piece::DedentIfBroken);
        self.writer.close();
    }

    fn link(&mut self, gap: Gap, link: &Postfix) {
        match link {
            Postfix::Field(name) => {
                self.writer.token(gap, ".");
                self.name(Gap::Glue, name);
            }
            Postfix::Method(call, _) => {
                self.writer.token(gap, ".");
                self.writer.lead(Gap::Glue);
                self.call(call);
            }
            Postfix::Index(index, _) => {
                self.writer.token(gap, "[");
                self.expr(Gap::Glue, index);
                self.writer.token(Gap::Glue, "]");
            }
        }
    }

    fn chain(&mut self, first: &Expr, links: &[ChainLink]) {
        self.writer.open(Style::Even);
        self.expr(Gap::Glue, first);
        self.writer.indent();
        for link in links {
            self.writer.token(Gap::Soft, link.operator.symbol());
            self.expr(Gap::Space, &link.operand);
        }
        self.writer.dedent();
        self.writer.close();
    }

    fn choose(&mut self, arms: &[(Expr, Expr)], otherwise: &Expr) {
        self.writer.open(Style::Even);
        for (index, (condition, value)) in arms.iter().enumerate() {
            if index > 0 {
                self.writer.token(Gap::Space, "else");
            }
            self.writer.token(if index > 0 { Gap::Space } else { Gap::Glue }, "if");
            self.expr(Gap::Space, condition);
            self.arm(value);
        }
        self.writer.token(Gap::Space, "else");
        self.arm(otherwise);
        self.writer.close();
    }

    fn arm(&mut self, value: &Expr) {
        self.writer.token(Gap::Space, "{");
        self.writer.indent();
        self.expr(Gap::Soft, value);
        self.writer.close_bracket(Gap::Soft, "}");
    }

    /// A list; one of plain numbers or names fills its lines.
    fn values(&mut self, values: &[Expr]) {
        let is_plain = values.iter().all(is_plain);
        self.open_list(Gap::Glue, "[", if is_plain { Style::Fill } else { Style::Even });
        for (index, value) in values.iter().enumerate() {
            let gap = self.separator(index);
            self.expr(gap, value);
        }
        self.close_list("]", values.is_empty());
    }

    fn fold(&mut self, fold: &Fold) {
        self.writer.token(Gap::Glue, "fold");
        self.open_list(Gap::Space, "(", Style::Early);
        for (index, (name, start)) in fold.accumulators.iter().enumerate() {
            let gap = self.separator(index);
            self.name(gap, name);
            self.writer.token(Gap::Space, "=");
            self.expr(Gap::Space, start);
        }
        self.close_list(")", false);
        self.writer.token(Gap::Space, "for");
        self.name(Gap::Space, &fold.variable);
        self.writer.token(Gap::Space, "in");
        self.range(&fold.range);
        if let Some(max) = &fold.max {
            self.writer.token(Gap::Space, "max");
            self.expr(Gap::Space, max);
        }
        if let Some(condition) = &fold.condition {
            self.writer.token(Gap::Space, "while");
            self.expr(Gap::Space, condition);
        }
        self.body(&fold.body);
    }

    pub(super) fn range(&mut self, range: &Range) {
        self.expr(Gap::Space, &range.start);
        self.writer.token(Gap::Glue, if range.inclusive { "..=" } else { ".." });
        self.expr(Gap::Glue, &range.end);
    }

    /// Begins a list that stands on one line or has one line for each of its parts.
    pub(super) fn open_list(&mut self, gap: Gap, bracket: &'static str, style: Style) {
        self.writer.lead(gap);
        self.writer.open(style);
        self.writer.token(Gap::Glue, bracket);
        self.writer.indent();
    }

    /// Ends the part before and says what stands before the next one.
    pub(super) fn separator(&mut self, index: usize) -> Gap {
        if index == 0 {
            return Gap::SoftGlue;
        }
        self.writer.token(Gap::Glue, ",");
        Gap::Soft
    }

    pub(super) fn close_list(&mut self, bracket: &'static str, is_empty: bool) {
        if !is_empty {
            self.writer.trailing_comma();
        }
        self.writer.close_bracket(if is_empty { Gap::Glue } else { Gap::SoftGlue }, bracket);
        self.writer.close();
    }
}

fn sign(operator: UnaryOperator) -> &'static str {
    match operator {
        UnaryOperator::Negate => "-",
        UnaryOperator::Not => "!",
    }
}

/// Whether an expression is one token, or one with signs.
fn is_plain(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Unary { operand, .. } => is_plain(operand),
        ExprKind::Int(_) | ExprKind::Float(_) | ExprKind::Bool(_) | ExprKind::Name(_) => true,
        _ => false,
    }
}
