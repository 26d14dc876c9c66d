//! Expressions: names, operators, fields, choices.

use super::constructor::view_field;
use super::types;
use super::wire::Wire;
use super::{Checker, Frame};
use crate::diagnostic::{Place, folds, imports, names, rates, types as errors};
use crate::graph::{Constant, Scalar, Type, Value};
use crate::intrinsic::{COMPONENT, Intrinsic, NEGATE, NEGATE_INT, NOT};
use crate::library::Callable;
use std::rc::Rc;
use texgraph_grammar::syntax::{
    BinaryOperator, ChainLink, Expr, ExprKind, Name, Postfix, Span, UnaryOperator,
};

impl<'a> Checker<'a> {
    /// What an expression gives. Recursion is bounded by the nesting of the text.
    pub(super) fn expr(&mut self, f: &mut Frame<'a>, e: &'a Expr) -> Wire {
        let place = self.place(f, e.span);
        f.builder.set_place(place);
        match &e.kind {
            ExprKind::Int(value) => match value.and_then(|v| i32::try_from(v).ok()) {
                Some(int) => Wire::Value(f.builder.constant(Constant::ints(&[int]))),
                None => self.report(f, errors::int_too_large(place)),
            },
            ExprKind::Float(value) if (*value as f32).is_finite() => {
                Wire::Value(f.builder.constant(Constant::floats(&[*value as f32])))
            }
            ExprKind::Float(_) => self.report(f, errors::float_too_large(place)),
            ExprKind::Bool(value) => Wire::Value(f.builder.constant(Constant::bools(&[*value]))),
            ExprKind::Color(channels) => {
                Wire::Value(f.builder.constant(Constant::floats(&crate::color::linear(*channels))))
            }
            ExprKind::Text(text) => Wire::Text(text.clone()),
            ExprKind::Name(name) => self.name(f, name, place),
            ExprKind::Paren(inner) => self.expr(f, inner),
            ExprKind::Call(call) => self.call(f, call, e.span),
            ExprKind::Postfix { base, links } => self.postfix(f, base, links),
            ExprKind::Unary { operators, operand } => self.unary(f, operators, operand, e.span),
            ExprKind::Chain { first, links } => self.chain(f, first, links),
            ExprKind::If { arms, otherwise } => self.choice(f, arms, otherwise),
            ExprKind::List(items) => {
                let items = items.iter().map(|item| (self.expr(f, item), self.place(f, item.span))).collect();
                Wire::List(Rc::new(items))
            }
            ExprKind::Lambda { .. } => Wire::Lambda,
            ExprKind::Fold(fold) => self.fold(f, fold, e.span),
        }
    }

    /// A name: a wire of the function, or a value of the file. One that is neither may still be a
    /// choice; who needs a value reports it.
    fn name(&mut self, f: &mut Frame<'a>, name: &str, place: Place) -> Wire {
        if let Some(wire) = f.lookup(name) {
            return wire;
        }
        if f.bound.contains(name) {
            // Bound in this body but not made: part of a ring, or wrong; both are reported.
            f.failed = true;
            return Wire::Unknown;
        }
        if let Some((_, width)) = f.dims.iter().find(|(dim, _)| dim == name) {
            return Wire::Value(f.builder.constant(Constant::ints(&[i32::from(*width)])));
        }
        match self.global(f.module, name) {
            Some(global) => self.global_wire(f, global),
            None if name == "none" => Wire::None,
            None => Wire::Word(name.to_owned(), place),
        }
    }

    pub(super) fn is_value(&self, f: &Frame<'a>, name: &str) -> bool {
        f.scopes.iter().any(|scope| scope.contains_key(name)) || self.global(f.module, name).is_some()
    }

    /// Reports a name that is no value.
    pub(super) fn unknown_value(&mut self, f: &mut Frame<'a>, name: &str, place: Place) -> Wire {
        if f.unknown.contains(name) {
            f.failed = true;
            return Wire::Unknown;
        }
        if self.alias(f.module, name).is_some() {
            return self.report(f, names::alias_as_value(place, name));
        }
        let module = &self.modules[f.module];
        if module.tree.items.iter().filter_map(super::globals::node_of).any(|node| node.name.text == name)
            || !self.library.callables(name).is_empty()
        {
            return self.report(f, names::node_as_value(place, name));
        }
        f.unknown.insert(name);
        let stem = |import: &crate::module::Import| {
            self.modules[import.module].path.rsplit('/').next()?.strip_suffix(".tex")
        };
        if module.imports.iter().any(|import| import.alias.is_none() && stem(import) == Some(name)) {
            return self.report(f, names::missing_alias(place, name));
        }
        let near = {
            // What the statement itself binds can't be meant.
            let own = f
                .order
                .get(f.next)
                .and_then(|step| f.steps.get(*step))
                .map_or(Vec::new(), super::Step::names);
            let scoped = f.scopes.iter().flat_map(|scope| scope.keys().copied());
            let later = f.steps.iter().flat_map(super::Step::names);
            let items = self.globals[f.module].keys().map(String::as_str);
            let aliases =
                module.imports.iter().filter_map(|import| Some(import.alias.as_ref()?.text.as_str()));
            let known = scoped.chain(later).chain(items).chain(aliases);
            self.near(name, known.filter(|known| !own.contains(known)))
        };
        self.report(f, names::unknown_value(place, name, near))
    }

    /// The module that an alias names.
    fn alias(&self, module: usize, name: &str) -> Option<usize> {
        let mut imports = self.modules[module].imports.iter();
        imports.find(|import| import.alias.as_ref().is_some_and(|alias| alias.text == name)).map(|i| i.module)
    }

    fn postfix(&mut self, f: &mut Frame<'a>, base: &'a Expr, links: &'a [Postfix]) -> Wire {
        let (mut next, mut wire) = match f.progress.get(&links.as_ptr()).filter(|_| f.foreign == 0) {
            Some((next, wire)) => (*next, wire.clone()),
            None => self.first_link(f, base, links),
        };
        while let Some(link) = links.get(next) {
            // A word that something is asked of is a name that nobody declared.
            if let Wire::Word(word, at) = &wire {
                wire = self.unknown_value(f, &word.clone(), *at);
            }
            let before = links[..next].last().map_or(base.span, end_of);
            let place = self.place(f, base.span.to(before));
            let waiting = f.waiting.len();
            let result = match link {
                Postfix::Field(name) => self.field(f, wire.clone(), name),
                Postfix::Method(call, span) => self.method(f, wire.clone(), place, call, *span),
                Postfix::Index(index, span) => self.index(f, wire.clone(), place, index, *span),
            };
            if f.waiting.len() > waiting {
                if f.foreign == 0 && !matches!(wire, Wire::Unknown) {
                    f.progress.insert(links.as_ptr(), (next, wire));
                }
                return Wire::Unknown;
            }
            wire = result;
            next += 1;
        }
        wire
    }

    /// The base, or an item of an imported file together with the link that names it.
    fn first_link(&mut self, f: &mut Frame<'a>, base: &'a Expr, links: &'a [Postfix]) -> (usize, Wire) {
        match (&base.kind, self.alias_of(f, base), links.first()) {
            (ExprKind::Name(alias), Some(module), Some(Postfix::Field(name))) => {
                (1, self.imported_value(f, alias, module, name))
            }
            (ExprKind::Name(alias), Some(module), Some(Postfix::Method(call, span))) => {
                (1, self.imported_call(f, alias, module, call, *span))
            }
            (ExprKind::Name(alias), Some(_), _) => {
                let place = self.place(f, base.span);
                (links.len(), self.report(f, names::alias_as_value(place, alias)))
            }
            _ => (0, self.expr(f, base)),
        }
    }

    pub(super) fn alias_of(&self, f: &Frame<'a>, base: &Expr) -> Option<usize> {
        match &base.kind {
            ExprKind::Name(name) if !self.is_value(f, name) => self.alias(f.module, name),
            _ => None,
        }
    }

    fn imported_value(&mut self, f: &mut Frame<'a>, alias: &str, module: usize, name: &Name) -> Wire {
        if let Some(global) = self.globals[module].get(&name.text).cloned() {
            return self.global_wire(f, global);
        }
        let place = self.place(f, name.span);
        let full = format!("{alias}.{}", name.text);
        if !self.own_callables(module, &name.text).is_empty() {
            return self.report(f, names::node_as_value(place, &full));
        }
        let near = self.near_item(module, &name.text);
        self.report(f, imports::no_such_item(place, alias, &name.text, near))
    }

    /// The item of a module that was most likely meant.
    pub(super) fn near_item(&self, module: usize, name: &str) -> Option<String> {
        let known = self.modules[module].tree.items.iter().filter_map(super::globals::name_of);
        self.near(name, known.map(|known| known.text.as_str()))
    }

    fn field(&mut self, f: &mut Frame<'a>, wire: Wire, name: &Name) -> Wire {
        let place = self.place(f, name.span);
        f.builder.set_place(place);
        match &wire {
            Wire::Unknown => Wire::Unknown,
            Wire::Record(outputs) => match outputs.iter().find(|(output, _)| *output == name.text) {
                Some((_, wire)) => wire.clone(),
                None => {
                    let near = self.near(&name.text, outputs.iter().map(|(output, _)| output.as_str()));
                    self.report(f, names::unknown_field(place, "this record", &name.text, near))
                }
            },
            Wire::Resource(resource) => match self.resource_field(f, resource, &name.text) {
                Some(wire) => wire,
                None => self.unknown_resource_field(f, resource.kind, name, place),
            },
            Wire::View(view) => match view_field(f, *view, &name.text) {
                Some(wire) => wire,
                None => self.report(f, names::unknown_field(place, "a view", &name.text, None)),
            },
            Wire::Value(value) => self.swizzle(f, *value, name, place),
            other => {
                let what = types::describe(other, |v| f.builder.ty(v));
                self.report(f, names::unknown_field(place, &what, &name.text, None))
            }
        }
    }

    fn unknown_resource_field(&mut self, f: &mut Frame<'a>, kind: usize, name: &Name, place: Place) -> Wire {
        let kind = &crate::resource::KINDS[kind];
        let near = self.near(&name.text, kind.fields.iter().map(|field| field.name));
        self.report(f, names::unknown_field(place, &format!("`{}`", kind.name), &name.text, near))
    }

    /// `.xyzw` or `.rgba`, one to four of the components there are.
    fn swizzle(&mut self, f: &mut Frame<'a>, value: Value, name: &Name, place: Place) -> Wire {
        let width = f.builder.ty(value).width();
        let components = ["xyzw", "rgba"].iter().find_map(|set| {
            name.text
                .chars()
                .map(|c| set.find(c))
                .collect::<Option<Vec<usize>>>()
                .filter(|found| found.len() <= 4)
        });
        let components = components.filter(|found| found.iter().all(|i| *i < usize::from(width)));
        let Some(components) = components else {
            let ty = types::name(f.builder.ty(value));
            return self.report(f, errors::bad_swizzle(place, &ty, &name.text));
        };
        let scalars: Vec<Value> = components.into_iter().map(|i| f.builder.extract(value, i as u8)).collect();
        Wire::Value(f.builder.compose(&scalars))
    }

    /// `v[i]`: a component, the index clamped.
    fn index(&mut self, f: &mut Frame<'a>, wire: Wire, base: Place, index: &'a Expr, span: Span) -> Wire {
        let place = self.place(f, span);
        let at = self.place(f, index.span);
        let index = self.expr(f, index);
        let table = match &wire {
            Wire::List(items) => match self.table(f, items, base) {
                Some(table) => Some(table),
                None => return Wire::Unknown,
            },
            _ => None,
        };
        let vector = match (&table, &wire) {
            (None, Wire::Value(vector)) => Some(*vector),
            (Some(_), _) | (_, Wire::Matrix(_)) => None,
            (None, other) => {
                self.value(f, other, base);
                return Wire::Unknown;
            }
        };
        let Some(index) = self.coerce_value(f, &index, Scalar::Int, 1, at) else { return Wire::Unknown };
        f.builder.set_place(place);
        if let Some(table) = table {
            return Wire::Value(lookup(f, table, index));
        }
        if let Wire::Matrix(columns) = &wire {
            return self.column(f, columns, index);
        }
        let Some(vector) = vector else { return Wire::Unknown };
        f.builder.set_place(place);
        let width = f.builder.ty(vector).width();
        if let Some(known) = f.builder.as_constant(index) {
            let component = known.int(0).clamp(0, i32::from(width) - 1);
            return Wire::Value(f.builder.extract(vector, component as u8));
        }
        Wire::Value(f.builder.builtin(COMPONENT, &[vector, index]))
    }

    fn unary(
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

    fn chain(&mut self, f: &mut Frame<'a>, first: &'a Expr, links: &'a [ChainLink]) -> Wire {
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

    /// The row of an operator for operands of these types, and the scalar that it takes.
    fn overload(&self, operator: BinaryOperator, left: Type, right: Type) -> Option<(Intrinsic, Scalar)> {
        self.library.callables(operator.symbol()).iter().find_map(|callable| {
            let Callable::Intrinsic(intrinsic) = callable else { return None };
            let first = self.library.signature(*callable)?.inputs.first()?;
            let scalar = types::scalar_of(&first.ty)?;
            let fits = |ty: Type| ty.scalar().is_some_and(|found| types::widens(found, scalar));
            (fits(left) && fits(right)).then_some((*intrinsic, scalar))
        })
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

    fn choice(&mut self, f: &mut Frame<'a>, arms: &'a [(Expr, Expr)], otherwise: &'a Expr) -> Wire {
        let mut conditions = Vec::new();
        let mut chosen = Vec::new();
        let mut last = Some(otherwise);
        for (condition, arm) in arms {
            let place = self.place(f, condition.span);
            let wire = self.expr(f, condition);
            let value = self.coerce_value(f, &wire, Scalar::Bool, 1, place);
            match value.and_then(|value| f.builder.as_constant(value)) {
                // A known condition leaves one arm; the other is not even looked at.
                Some(known) if known.bool(0) => {
                    last = Some(arm);
                    break;
                }
                Some(_) => continue,
                None => {}
            }
            conditions.push((value, place));
            chosen.push((self.expr(f, arm), self.place(f, arm.span)));
        }
        if let Some(arm) = last.take() {
            chosen.push((self.expr(f, arm), self.place(f, arm.span)));
        }
        self.select(f, &conditions, chosen)
    }

    /// Nested choices from the arms, the last one unconditional.
    fn select(
        &mut self,
        f: &mut Frame<'a>,
        conditions: &[(Option<Value>, Place)],
        arms: Vec<(Wire, Place)>,
    ) -> Wire {
        if let ([], [(only, _)]) = (conditions, arms.as_slice()) {
            return only.clone();
        }
        if arms.iter().any(|(wire, _)| {
            matches!(wire, Wire::Resource(_) | Wire::View(_) | Wire::Text(_) | Wire::None | Wire::Node(_))
        }) {
            let place = conditions.first().map_or(Place::default(), |(_, place)| *place);
            return self.report(f, rates::choice_not_constant(place));
        }
        if arms.iter().any(|(wire, _)| matches!(wire, Wire::Matrix(_))) {
            return self.select_columns(f, conditions, &arms);
        }
        let values: Vec<Option<Value>> =
            arms.iter().map(|(wire, place)| self.value(f, wire, *place)).collect();
        let Some(values) = values.into_iter().collect::<Option<Vec<Value>>>() else { return Wire::Unknown };
        let Some(values) = self.common_type(f, values, &arms) else { return Wire::Unknown };
        let mut values = values.into_iter().rev();
        let Some(mut result) = values.next() else { return Wire::Unknown };
        for ((condition, _), value) in conditions.iter().rev().zip(values) {
            let Some(condition) = condition else { return Wire::Unknown };
            result = f.builder.select(*condition, value, result);
        }
        Wire::Value(result)
    }

    /// A choice between matrices: column by column.
    fn select_columns(
        &mut self,
        f: &mut Frame<'a>,
        conditions: &[(Option<Value>, Place)],
        arms: &[(Wire, Place)],
    ) -> Wire {
        let size = arms.iter().find_map(|(wire, _)| match wire {
            Wire::Matrix(columns) => Some(columns.len()),
            _ => None,
        });
        let size = size.unwrap_or(2) as u8;
        let matrices = arms.iter().map(|(wire, place)| self.coerce_matrix(f, wire, size, *place));
        let matrices: Vec<Option<Rc<[Value]>>> = matrices.collect();
        let Some(matrices) = matrices.into_iter().collect::<Option<Vec<_>>>() else { return Wire::Unknown };
        let column = |i: usize| {
            let mut values = matrices.iter().rev().map(|matrix| matrix[i]);
            let mut result = values.next()?;
            for ((condition, _), value) in conditions.iter().rev().zip(values) {
                result = f.builder.select((*condition)?, value, result);
            }
            Some(result)
        };
        let columns: Option<Vec<Value>> = (0..usize::from(size)).map(column).collect();
        columns.map_or(Wire::Unknown, |columns| Wire::Matrix(columns.into()))
    }

    /// A list as a table of constants of one type.
    fn table(&mut self, f: &mut Frame<'a>, items: &[(Wire, Place)], place: Place) -> Option<Vec<Constant>> {
        if items.is_empty() {
            self.report(f, folds::empty_table(place));
            return None;
        }
        if items.len() > crate::diagnostic::limits::MAX_TABLE {
            self.report(f, folds::table_too_long(place, items.len()));
            return None;
        }
        let values: Vec<Option<Value>> =
            items.iter().map(|(wire, place)| self.value(f, wire, *place)).collect();
        let values = self.common_type(f, values.into_iter().collect::<Option<_>>()?, items)?;
        let mut entries = Vec::new();
        for (value, (_, at)) in values.iter().zip(items) {
            match f.builder.as_constant(*value) {
                Some(entry) => entries.push(entry),
                None => {
                    self.report(f, folds::entry_not_constant(*at));
                    return None;
                }
            }
        }
        Some(entries)
    }

    /// Arms widen to a common type.
    fn common_type(
        &mut self,
        f: &mut Frame<'a>,
        values: Vec<Value>,
        arms: &[(Wire, Place)],
    ) -> Option<Vec<Value>> {
        let types: Vec<Type> = values.iter().map(|value| f.builder.ty(*value)).collect();
        let float = types.iter().any(|ty| ty.is_float());
        let scalar = if float { Scalar::Float } else { types.first()?.scalar()? };
        let width = types.iter().map(|ty| ty.width()).max()?;
        let wanted = Type::Vector(scalar, width);
        let fits = |ty: &Type| {
            ty.scalar().is_some_and(|found| types::widens(found, scalar))
                && (ty.width() == 1 || ty.width() == width)
        };
        if let Some(odd) = types.iter().position(|ty| !fits(ty)) {
            let like = types.iter().position(fits).unwrap_or(0);
            let (odd_name, like_name) =
                (types::name(types[odd]), types::name(types.get(like).copied().unwrap_or(wanted)));
            self.report(f, errors::arms_differ(arms[odd].1, &like_name, &odd_name, arms[like].1));
            return None;
        }
        let mut common = Vec::new();
        for (value, (_, place)) in values.into_iter().zip(arms) {
            common.push(self.coerce_value(f, &Wire::Value(value), scalar, width, *place)?);
        }
        Some(common)
    }
}

/// An entry of a table, the index clamped.
fn lookup(f: &mut Frame<'_>, table: Vec<Constant>, index: Value) -> Value {
    match table.as_slice() {
        [only] => f.builder.constant(*only),
        _ => f.builder.lookup(table.into(), index),
    }
}

fn end_of(link: &Postfix) -> Span {
    match link {
        Postfix::Field(name) => name.span,
        Postfix::Method(_, span) | Postfix::Index(_, span) => *span,
    }
}
