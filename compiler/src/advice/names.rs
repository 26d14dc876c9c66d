//! The names of one file: where each is bound and where it is read, told by the text alone.

use rustc_hash::FxHashMap;
use texgraph_grammar::syntax::{
    Body, Call, Expr, ExprKind, File, Fold, Item, ItemKind, Name, Node, Pattern, Postfix, Span, Statement,
};

/// What a name is bound by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A `let` or a param of the file.
    Item,
    /// A node.
    Node,
    /// A texture.
    Texture,
    /// `use … as name`
    Alias,
    /// An input of a node, or of a lambda.
    Input,
    /// An output of a node, or an accumulator of a fold: the body assigns it.
    Output,
    /// A `let` of a body, or the step of a fold.
    Wire,
    /// A dimension variable.
    Dimension,
}

/// A name where it is bound.
#[derive(Clone, Debug)]
pub struct Binding<'a> {
    /// The name.
    pub name: &'a Name,
    /// The name with its type, or the name alone.
    pub span: Span,
    /// What binds it.
    pub kind: Kind,
    /// Where it can be read.
    pub scope: Span,
    /// The statement or item that binds it; empty for what a head declares.
    pub statement: Span,
    /// The value of its `let`; empty where there is none.
    pub value: Span,
    /// It is one of several names that take the value apart.
    pub is_part: bool,
    /// How often it is read or called.
    pub reads: u32,
}

/// A call.
pub struct Site<'a> {
    /// The call.
    pub call: &'a Call,
    /// What stands before its name.
    base: Base,
}

/// What stands before the name of a call.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Base {
    None,
    /// `alias.`: the call is of a node of another file.
    File,
    /// The first argument.
    Receiver(Span),
}

/// A list of statements, and whose they are.
pub struct Statements<'a> {
    /// The node; none for a fold's.
    pub node: Option<&'a Node>,
    /// The statements between their braces.
    pub body: &'a Body,
    /// The outputs or accumulators that they assign.
    pub outputs: Vec<&'a Name>,
}

/// What is bound and read in a file.
#[derive(Default)]
pub struct Names<'a> {
    /// Every binding, in source order but for wires, which come before what stands in their body.
    pub bindings: Vec<Binding<'a>>,
    /// Every call.
    pub sites: Vec<Site<'a>>,
    /// The bodies of nodes, textures and folds.
    pub bodies: Vec<Statements<'a>>,
    /// The binding that a name means where it is read.
    meanings: FxHashMap<Span, usize>,
    /// The call that an expression is, and the call and position that it is an argument of.
    calls: FxHashMap<Span, usize>,
    arguments: FxHashMap<Span, (usize, usize)>,
    /// The output, accumulator, param or input that an expression is assigned to.
    assigned: FxHashMap<Span, &'a Name>,
    /// The operator beside an operand.
    operators: FxHashMap<Span, Span>,
    /// The value that names in brackets take apart.
    taken_apart: FxHashMap<Span, Span>,
    /// What stands before the dot of a field or a method.
    bases: FxHashMap<Span, Span>,
    scopes: Vec<FxHashMap<&'a str, usize>>,
    /// The nodes and textures by name, with their bindings; none where several share it.
    nodes: FxHashMap<&'a str, Option<(usize, &'a Node)>>,
}

/// Where something binds.
#[derive(Clone, Copy)]
struct At {
    kind: Kind,
    scope: Span,
    statement: Span,
    value: Span,
    is_part: bool,
}

impl At {
    /// Bound by a head, where it can be read in a stretch of the text.
    fn head(kind: Kind, scope: Span) -> At {
        At { kind, scope, statement: Span::default(), value: Span::default(), is_part: false }
    }
}

impl<'a> Names<'a> {
    /// Of a file.
    pub fn of(file: &'a File) -> Names<'a> {
        let mut names = Names::default();
        names.scopes.push(FxHashMap::default());
        let scope = Span { start: 0, end: u32::MAX };
        file.items.iter().for_each(|item| names.declare(item, scope));
        file.items.iter().for_each(|item| names.item(item));
        names
    }

    /// The binding of a name where it is bound.
    pub fn bound(&self, name: &Name) -> Option<&Binding<'a>> {
        self.bindings.iter().find(|binding| binding.name.span == name.span)
    }

    /// Whether a node is a texture.
    pub fn is_texture(&self, node: &Node) -> bool {
        self.bound(&node.name).is_some_and(|binding| binding.kind == Kind::Texture)
    }

    /// Whether the file is one to draw, and not one that others take from.
    pub fn has_texture(&self) -> bool {
        self.bindings.iter().any(|binding| binding.kind == Kind::Texture)
    }

    /// The binding that is meant where a name is read.
    pub fn meaning(&self, place: Span) -> Option<&Binding<'a>> {
        self.meanings.get(&place).and_then(|binding| self.bindings.get(*binding))
    }

    /// Whether nodes of this file have that name.
    pub fn has_node(&self, name: &str) -> bool {
        self.nodes.contains_key(name)
    }

    /// The node of this file that a call names.
    pub fn callee(&self, site: &Site<'a>) -> Option<&'a Node> {
        let named = self.nodes.get(site.call.name.text.as_str()).copied().flatten();
        named.filter(|_| site.base != Base::File).map(|(_, node)| node)
    }

    /// The argument that a place lies in, of a call that is asked for.
    pub fn argument_around(&self, place: Span, is_meant: impl Fn(&str) -> bool) -> Option<Span> {
        let calls = self.sites.iter().filter(|site| is_meant(&site.call.name.text));
        let mut values = calls.flat_map(|site| &site.call.arguments).map(|argument| argument.value.span);
        values.find(|value| contains(*value, place))
    }

    /// The calls whose argument is a lambda that a place lies in.
    pub fn lambdas_around(&self, place: Span) -> impl Iterator<Item = &Site<'a>> {
        self.sites.iter().filter(move |site| {
            site.call.arguments.iter().any(|argument| {
                matches!(argument.value.kind, ExprKind::Lambda { .. }) && contains(argument.value.span, place)
            })
        })
    }

    /// How often the node of this file whose name stands here is called in this file.
    pub fn count_calls(&self, name: Span) -> usize {
        let of_node = |site: &&Site<'a>| self.callee(site).is_some_and(|node| node.name.span == name);
        self.sites.iter().filter(of_node).count()
    }

    /// The call that an expression is.
    pub fn call(&self, place: Span) -> Option<&Site<'a>> {
        self.calls.get(&place).and_then(|site| self.sites.get(*site))
    }

    /// The call that an expression, or the name before it, is an argument of, and which argument it
    /// is; a receiver is the first.
    pub fn argument(&self, place: Span) -> Option<(&Site<'a>, usize)> {
        let (site, position) = self.arguments.get(&place)?;
        Some((self.sites.get(*site)?, *position))
    }

    /// The operator beside an operand.
    pub fn operator(&self, operand: Span) -> Option<Span> {
        self.operators.get(&operand).copied()
    }

    /// What stands before the dot of a field or a method.
    pub fn base(&self, field: Span) -> Option<Span> {
        self.bases.get(&field).copied()
    }

    /// The value that names in brackets take apart.
    pub fn taken_apart(&self, pattern: Span) -> Option<Span> {
        self.taken_apart.get(&pattern).copied()
    }

    /// The output or accumulator that an expression is assigned to, or the param or input whose
    /// default or range it is.
    pub fn assigned(&self, place: Span) -> Option<&'a Name> {
        self.assigned.get(&place).copied()
    }

    /// The innermost body around a place.
    pub fn body(&self, place: Span) -> Option<&Statements<'a>> {
        let around = self.bodies.iter().filter(|inner| contains(inner.body.span, place));
        around.min_by_key(|inner| inner.body.span.end - inner.body.span.start)
    }

    /// The node around a place.
    pub fn node(&self, place: Span) -> Option<&'a Node> {
        let mut nodes = self.bodies.iter().filter_map(|body| body.node);
        nodes.find(|node| contains(whole(node), place))
    }

    /// The bindings that are read within a place.
    pub fn read_within(&self, place: Span) -> Vec<usize> {
        let inside = self.meanings.iter().filter(|(read, _)| contains(place, **read));
        let mut read: Vec<usize> = inside.map(|(_, binding)| *binding).collect();
        read.sort_unstable();
        read.dedup();
        read
    }

    fn declare(&mut self, item: &'a Item, scope: Span) {
        let at = |kind| At { statement: item.span, ..At::head(kind, scope) };
        match &item.kind {
            ItemKind::Use { alias: Some(alias), .. } => self.bind(alias, alias.span, at(Kind::Alias)),
            ItemKind::Use { alias: None, .. } => {}
            ItemKind::Let { name, value } => {
                self.bind(name, name.span, At { value: value.span, ..at(Kind::Item) });
            }
            ItemKind::Param { name, ty, .. } => self.bind(name, name.span.to(ty.span), at(Kind::Item)),
            ItemKind::Node(node) => self.declare_node(node, at(Kind::Node)),
            ItemKind::Texture { node, .. } => self.declare_node(node, at(Kind::Texture)),
        }
    }

    fn declare_node(&mut self, node: &'a Node, at: At) {
        let binding = self.push(&node.name, node.name.span, at);
        let named = self.nodes.entry(&node.name.text);
        named.and_modify(|several| *several = None).or_insert(Some((binding, node)));
    }

    fn push(&mut self, name: &'a Name, span: Span, at: At) -> usize {
        let At { kind, scope, statement, value, is_part } = at;
        self.bindings.push(Binding { name, span, kind, scope, statement, value, is_part, reads: 0 });
        self.bindings.len() - 1
    }

    /// The first binding of a name in a scope holds.
    fn bind(&mut self, name: &'a Name, span: Span, at: At) {
        let binding = self.push(name, span, at);
        if let Some(scope) = self.scopes.last_mut() {
            scope.entry(&name.text).or_insert(binding);
        }
    }

    fn item(&mut self, item: &'a Item) {
        match &item.kind {
            ItemKind::Use { .. } => {}
            ItemKind::Let { value, .. } => self.expr(value),
            ItemKind::Param { name, default, range, .. } => {
                let ends = range.iter().flat_map(|range| [&*range.start, &*range.end]);
                for value in std::iter::once(default).chain(ends) {
                    self.assigned.insert(value.span, name);
                    self.expr(value);
                }
            }
            ItemKind::Node(node) | ItemKind::Texture { node, .. } => self.in_node(item, node),
        }
    }

    fn in_node(&mut self, item: &'a Item, node: &'a Node) {
        self.scopes.push(FxHashMap::default());
        let at = |kind| At::head(kind, item.span);
        node.dims.iter().for_each(|dim| self.bind(dim, dim.span, at(Kind::Dimension)));
        for input in &node.inputs {
            self.bind(&input.name, input.name.span.to(input.ty.span), at(Kind::Input));
        }
        for output in &node.outputs {
            self.bind(&output.name, output.name.span.to(output.ty.span), at(Kind::Output));
        }
        for input in &node.inputs {
            if let Some(default) = &input.default {
                self.assigned.insert(default.span, &input.name);
                self.expr(default);
            }
        }
        let outputs = node.outputs.iter().map(|output| &output.name).collect();
        self.body_of(Statements { node: Some(node), body: &node.body, outputs });
        self.scopes.pop();
    }

    fn body_of(&mut self, statements: Statements<'a>) {
        let body = statements.body;
        self.bodies.push(statements);
        for statement in &body.statements {
            let Statement::Let { pattern, span, value } = statement else { continue };
            let at = At { statement: *span, value: value.span, ..At::head(Kind::Wire, body.span) };
            match pattern {
                Pattern::Name(name) => self.bind(name, name.span, at),
                Pattern::Record(names, place) => {
                    self.taken_apart.insert(*place, value.span);
                    let part = At { is_part: true, ..at };
                    names.iter().for_each(|name| self.bind(name, name.span, part));
                }
            }
        }
        for statement in &body.statements {
            match statement {
                Statement::Let { value, .. } => self.expr(value),
                Statement::Assign { name, value } => {
                    self.assigned.insert(value.span, name);
                    self.expr(value);
                }
            }
        }
    }

    fn fold(&mut self, fold: &'a Fold, span: Span) {
        fold.accumulators.iter().for_each(|(_, start)| self.expr(start));
        [&fold.range.start, &fold.range.end].into_iter().for_each(|end| self.expr(end));
        fold.max.iter().for_each(|max| self.expr(max));
        self.scopes.push(FxHashMap::default());
        let at = |kind| At::head(kind, span);
        fold.accumulators.iter().for_each(|(name, start)| {
            self.bind(name, name.span.to(start.span), at(Kind::Output));
        });
        fold.condition.iter().for_each(|condition| self.expr(condition));
        self.bind(&fold.variable, fold.variable.span, at(Kind::Wire));
        let outputs = fold.accumulators.iter().map(|(name, _)| name).collect();
        self.body_of(Statements { node: None, body: &fold.body, outputs });
        self.scopes.pop();
    }

    fn read(&mut self, name: &str, place: Span) {
        let found = self.scopes.iter().rev().find_map(|scope| scope.get(name).copied());
        self.count(found, place);
    }

    fn count(&mut self, binding: Option<usize>, place: Span) {
        let Some(binding) = binding else { return };
        if let Some(found) = self.bindings.get_mut(binding) {
            found.reads += 1;
            self.meanings.insert(place, binding);
        }
    }

    fn called(&mut self, call: &'a Call, place: Span, base: Base) {
        if base != Base::File {
            self.count_call(&call.name);
        }
        let site = self.sites.len();
        self.sites.push(Site { call, base });
        self.calls.insert(place, site);
        let mut position = 0;
        if let Base::Receiver(receiver) = base {
            self.bases.insert(call.name.span, receiver);
            self.arguments.insert(receiver, (site, position));
            position += 1;
        }
        for (i, argument) in call.arguments.iter().enumerate() {
            let places = [argument.name.as_ref().map(|name| name.span), Some(argument.value.span)];
            for place in places.into_iter().flatten() {
                self.arguments.insert(place, (site, position + i));
            }
            self.expr(&argument.value);
        }
    }

    /// A call may be of an input, which is a node then.
    fn count_call(&mut self, name: &Name) {
        let found = self.scopes.iter().rev().find_map(|scope| scope.get(name.text.as_str()).copied());
        let input = found.filter(|i| self.bindings.get(*i).is_some_and(|found| found.kind == Kind::Input));
        let node = || Some(self.nodes.get(name.text.as_str()).copied()??.0);
        let binding = input.or_else(node);
        self.count(binding, name.span);
    }

    /// Recursion is bounded by the nesting of the text.
    fn expr(&mut self, expr: &'a Expr) {
        match &expr.kind {
            ExprKind::Name(name) => self.read(name, expr.span),
            ExprKind::Paren(inner) => self.expr(inner),
            ExprKind::Call(call) => self.called(call, expr.span, Base::None),
            ExprKind::Postfix { base, links } => {
                self.expr(base);
                let mut before = base.span;
                let file = self.meaning(before).is_some_and(|meant| meant.kind == Kind::Alias);
                for (i, link) in links.iter().enumerate() {
                    self.link(link, before, file && i == 0);
                    before = before.to(end_of(link));
                }
            }
            ExprKind::Unary { operand, .. } => self.expr(operand),
            ExprKind::Chain { first, links } => {
                self.expr(first);
                let mut before = first.span;
                for link in links {
                    self.operators.entry(before).or_insert(link.operator_span);
                    self.operators.insert(link.operand.span, link.operator_span);
                    self.expr(&link.operand);
                    before = before.to(link.operand.span);
                }
            }
            ExprKind::If { arms, otherwise } => {
                arms.iter().flat_map(|(condition, arm)| [condition, arm]).for_each(|e| self.expr(e));
                self.expr(otherwise);
            }
            ExprKind::List(items) => items.iter().for_each(|item| self.expr(item)),
            ExprKind::Lambda { inputs, body } => {
                self.scopes.push(FxHashMap::default());
                let at = At::head(Kind::Input, expr.span);
                inputs.iter().for_each(|input| self.bind(input, input.span, at));
                self.expr(body);
                self.scopes.pop();
            }
            ExprKind::Fold(fold) => self.fold(fold, expr.span),
            ExprKind::Int(_)
            | ExprKind::Float(_)
            | ExprKind::Bool(_)
            | ExprKind::Text(_)
            | ExprKind::Color(_) => {}
        }
    }

    fn link(&mut self, link: &'a Postfix, before: Span, of_file: bool) {
        match link {
            Postfix::Field(name) => drop(self.bases.insert(name.span, before)),
            Postfix::Method(call, span) => {
                let base = if of_file { Base::File } else { Base::Receiver(before) };
                self.called(call, before.to(*span), base);
            }
            Postfix::Index(index, _) => self.expr(index),
        }
    }
}

fn end_of(link: &Postfix) -> Span {
    match link {
        Postfix::Field(name) => name.span,
        Postfix::Method(_, span) | Postfix::Index(_, span) => *span,
    }
}

/// A node from its name to its end.
pub fn whole(node: &Node) -> Span {
    node.name.span.to(node.body.span)
}

/// Whether one stretch lies within another.
pub fn contains(outer: Span, inner: Span) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}
