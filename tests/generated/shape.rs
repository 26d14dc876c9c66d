//! A syntax tree without its places: what must survive formatting.

use texgraph_grammar::syntax::{
    Argument, Body, Call, Dim, Expr, ExprKind, Field, File, Fold, Input, Item, ItemKind, Name, Node, Pattern,
    Postfix, Range, Span, Statement, Type, TypeKind,
};

/// Every span of a tree made the same. The comments are taken out: how many of which kind there
/// were is what must survive of them.
pub fn without_places(mut file: File) -> File {
    let nowhere = Span::default();
    file.comments.iter_mut().for_each(|comment| comment.span = nowhere);
    file.items.iter_mut().for_each(item);
    file
}

fn item(item: &mut Item) {
    item.span = Span::default();
    match &mut item.kind {
        ItemKind::Use { path, alias } => {
            path.span = Span::default();
            alias.iter_mut().for_each(name);
        }
        ItemKind::Let { name: n, value } => {
            name(n);
            expr(value);
        }
        ItemKind::Param { name: n, ty: t, default, range: r } => {
            name(n);
            ty(t);
            expr(default);
            r.iter_mut().for_each(range);
        }
        ItemKind::Node(n) => node(n),
        ItemKind::Texture { node: n, tiles } => {
            node(n);
            tiles.iter_mut().for_each(expr);
        }
    }
}

fn name(name: &mut Name) {
    name.span = Span::default();
}

fn node(node: &mut Node) {
    name(&mut node.name);
    node.dims.iter_mut().for_each(name);
    for Input { name: n, ty: t, default } in &mut node.inputs {
        name(n);
        ty(t);
        default.iter_mut().for_each(expr);
    }
    node.outputs.iter_mut().for_each(field);
    body(&mut node.body);
}

fn field(field: &mut Field) {
    name(&mut field.name);
    ty(&mut field.ty);
}

fn ty(ty: &mut Type) {
    ty.span = Span::default();
    match &mut ty.kind {
        TypeKind::Named { name: n, dim: d } => {
            name(n);
            d.iter_mut().for_each(dim);
        }
        TypeKind::Choice(words) => words.iter_mut().for_each(name),
        TypeKind::Node { inputs, output } => {
            inputs.iter_mut().for_each(field);
            self::ty(output);
        }
        TypeKind::Record(fields) => fields.iter_mut().for_each(field),
    }
}

fn dim(dim: &mut Dim) {
    match dim {
        Dim::Name(n) => name(n),
        Dim::Number(_, span) => *span = Span::default(),
    }
}

fn range(range: &mut Range) {
    range.span = Span::default();
    expr(&mut range.start);
    expr(&mut range.end);
}

fn body(body: &mut Body) {
    body.span = Span::default();
    for statement in &mut body.statements {
        match statement {
            Statement::Let { span, pattern, value } => {
                *span = Span::default();
                match pattern {
                    Pattern::Name(n) => name(n),
                    Pattern::Record(names, span) => {
                        names.iter_mut().for_each(name);
                        *span = Span::default();
                    }
                }
                expr(value);
            }
            Statement::Assign { name: n, value } => {
                name(n);
                expr(value);
            }
        }
    }
}

/// Recursion is bounded by the nesting of the text.
fn expr(e: &mut Expr) {
    e.span = Span::default();
    match &mut e.kind {
        ExprKind::Int(_)
        | ExprKind::Float(_)
        | ExprKind::Bool(_)
        | ExprKind::Text(_)
        | ExprKind::Color(_)
        | ExprKind::Name(_) => {}
        ExprKind::Paren(inner) => expr(inner),
        ExprKind::Call(c) => call(c),
        ExprKind::Postfix { base, links } => {
            expr(base);
            links.iter_mut().for_each(link);
        }
        ExprKind::Unary { operators, operand } => {
            operators.iter_mut().for_each(|(_, span)| *span = Span::default());
            expr(operand);
        }
        ExprKind::Chain { first, links } => {
            expr(first);
            for link in links {
                link.operator_span = Span::default();
                expr(&mut link.operand);
            }
        }
        ExprKind::If { arms, otherwise } => {
            for (condition, arm) in arms {
                expr(condition);
                expr(arm);
            }
            expr(otherwise);
        }
        ExprKind::List(items) => items.iter_mut().for_each(expr),
        ExprKind::Lambda { inputs, body } => {
            inputs.iter_mut().for_each(name);
            expr(body);
        }
        ExprKind::Fold(f) => fold(f),
    }
}

fn call(call: &mut Call) {
    name(&mut call.name);
    call.dim.iter_mut().for_each(dim);
    for Argument { name: n, value } in &mut call.arguments {
        n.iter_mut().for_each(name);
        expr(value);
    }
}

fn link(link: &mut Postfix) {
    match link {
        Postfix::Field(n) => name(n),
        Postfix::Method(c, span) => {
            call(c);
            *span = Span::default();
        }
        Postfix::Index(index, span) => {
            expr(index);
            *span = Span::default();
        }
    }
}

fn fold(fold: &mut Fold) {
    for (n, start) in &mut fold.accumulators {
        name(n);
        expr(start);
    }
    name(&mut fold.variable);
    range(&mut fold.range);
    fold.max.iter_mut().for_each(expr);
    fold.condition.iter_mut().for_each(expr);
    body(&mut fold.body);
}
