//! Names that nobody declared: which one was probably meant.

use super::names::{Binding, Kind, contains};
use super::{Look, Related};
use crate::diagnostic::{Diagnostic, Suggestion, names as sentences};
use crate::input::INPUTS;
use texgraph_grammar::syntax::{Node, Span, Statement};

/// What is said of a binding that nobody reads.
const UNUSED: &str = " and never used";

impl<'t, 'a> Look<'t, 'a> {
    /// A value that nobody declared: an output of a wire, a name near it, the one name that nobody
    /// reads, or the inputs that it would be one of.
    pub(super) fn unknown_value(&self, diagnostic: &mut Diagnostic) -> Related {
        let name = self.text(self.span());
        if let Some((record, _)) = self.records_with(name).next() {
            let output = format!("{}.{name}", record.name.text);
            diagnostic.help =
                Some(format!("`{name}` is an output of `{}`: write `{output}`", record.name.text));
            diagnostic.suggestion = Some(Suggestion::replace(self.place, output));
            return vec![declared(record)];
        }
        let visible = self.visible();
        let near = near(name, &visible);
        let mut related = Vec::new();
        if let Some(near) = near {
            if diagnostic.help.is_none() || diagnostic.suggestion.is_some() {
                diagnostic.suggest_name(&near.name.text);
            }
            related.push(declared(near));
        }
        // Others may read what a file without textures declares.
        let is_for_others = |binding: &Binding| binding.kind == Kind::Item && !self.names.has_texture();
        let unread = only_unread(&visible).filter(|binding| !is_for_others(binding));
        related.extend(unread.filter(|_| near.is_none_or(|near| near.reads > 0)).map(declared));
        if near.is_none() {
            related.extend(self.inputs(diagnostic, name));
        }
        if diagnostic.help.is_none() && related.iter().all(|(_, label)| !label.ends_with(UNUSED)) {
            related.extend(self.new_wire(diagnostic, name));
        }
        related
    }

    /// Where a wire of this name could be declared: before the statement that reads it.
    fn new_wire(&self, diagnostic: &mut Diagnostic, name: &str) -> Option<(Span, String)> {
        let statements = &self.names.body(self.span())?.body.statements;
        let whole = |statement: &Statement| match statement {
            Statement::Let { span, .. } => *span,
            Statement::Assign { name, value } => name.span.to(value.span),
        };
        let statement = statements.iter().find(|statement| contains(whole(statement), self.span()))?;
        let first = match statement {
            Statement::Let { span, .. } => Span { start: span.start, end: span.start + 3 },
            Statement::Assign { name, .. } => name.span,
        };
        diagnostic.help = Some(format!("declare it: `let {name} = …`"));
        Some((first, format!("a `let {name} = …` would stand before this")))
    }

    /// The values that can be read here, but for what the statement itself binds.
    fn visible(&self) -> Vec<&'t Binding<'a>> {
        let is_visible = |binding: &&Binding| {
            let is_value = !matches!(binding.kind, Kind::Node | Kind::Texture);
            is_value && contains(binding.scope, self.span()) && !contains(binding.statement, self.span())
        };
        self.names.bindings.iter().filter(is_visible).collect()
    }

    /// The wires that hold several outputs, one of them of this name.
    pub(super) fn records_with(&self, name: &str) -> impl Iterator<Item = (&'t Binding<'a>, &'a Node)> {
        let records = self.visible().into_iter().filter_map(|binding| Some((binding, self.record(binding)?)));
        records.filter(move |(_, node)| node.outputs.iter().any(|output| output.name.text == name))
    }

    /// The node with several outputs that a wire holds.
    pub(super) fn record(&self, binding: &Binding) -> Option<&'a Node> {
        let call = self.names.call(binding.value).filter(|_| !binding.is_part)?;
        self.texts.node(&call.call.name.text).filter(|node| node.outputs.len() > 1)
    }

    /// The brackets of the inputs of the node around an unknown name. A texture has inputs of a few
    /// names only.
    fn inputs(&self, diagnostic: &mut Diagnostic, name: &str) -> Option<(Span, String)> {
        let node = self.names.node(self.span())?;
        let known = INPUTS.iter().find(|known| known.name == name);
        if let Some(known) = known {
            let input = format!("{name}: {}", known.types.first()?);
            diagnostic.help = Some(sentences::not_passed_on(&node.name.text, &input));
        } else if self.names.is_texture(node) {
            return None;
        }
        let brackets = self.brackets(node)?;
        let label = format!("the inputs of `{}`", node.name.text);
        Some((brackets, label)).filter(|_| !self.text(brackets).contains('\n'))
    }

    /// The brackets around the inputs of a node.
    fn brackets(&self, node: &Node) -> Option<Span> {
        let name = node.dims.last().map_or(node.name.span, |dim| dim.span).end;
        let last = node.inputs.last().map_or(name, |input| {
            input.default.as_ref().map_or(input.ty.span.end, |default| default.span.end)
        });
        let outputs = node.outputs.first()?.name.span.start;
        let find = |bracket: char, start: u32| {
            let found = self.text(Span { start, end: outputs }).find(bracket)?;
            Some(start + found as u32)
        };
        let start = find('(', name)?;
        Some(Span { start, end: find(')', last.max(start))? + 1 })
    }

    /// Whether a name without a call is that of a node of the library: a value may have been meant.
    pub(super) fn is_library_name(&self) -> bool {
        let is_called = || self.names.sites.iter().any(|site| site.call.name.span == self.span());
        let is_own = self.names.has_node(self.text(self.span()));
        !is_own && self.names.base(self.span()).is_none() && !is_called()
    }

    /// A node that nobody declared: one near it, else the one that nobody calls.
    pub(super) fn unknown_node(&self, diagnostic: &mut Diagnostic) -> Related {
        let is_other =
            |binding: &&Binding| binding.kind == Kind::Node && !contains(binding.statement, self.span());
        let nodes: Vec<&Binding> = self.names.bindings.iter().filter(is_other).collect();
        let near = near(self.text(self.span()), &nodes);
        // The library may have a name that is nearer.
        let suggested = diagnostic.suggestion.as_ref().and_then(|suggestion| suggestion.edits.first());
        let is_nearest = |near: &&Binding| {
            diagnostic.help.is_none() || suggested.is_some_and(|(_, name)| *name == near.name.text)
        };
        let meant = near.filter(is_nearest);
        if let Some(near) = meant {
            diagnostic.suggest_name(&near.name.text);
        }
        meant.or_else(|| only_unread(&nodes)).map(declared).into_iter().collect()
    }
}

fn near<'n, 'a>(name: &str, among: &[&'n Binding<'a>]) -> Option<&'n Binding<'a>> {
    let near = sentences::nearest(name, among.iter().map(|binding| binding.name.text.as_str()))?;
    among.iter().copied().find(|binding| binding.name.text == near)
}

/// The one binding that nobody reads: of the innermost scope that has any.
fn only_unread<'n, 'a>(among: &[&'n Binding<'a>]) -> Option<&'n Binding<'a>> {
    let is_unread =
        |binding: &&Binding| binding.reads == 0 && !matches!(binding.kind, Kind::Output | Kind::Dimension);
    let unread = || among.iter().copied().filter(is_unread);
    let width = |binding: &Binding| binding.scope.end - binding.scope.start;
    let innermost = unread().map(width).min()?;
    let mut unread = unread().filter(|binding| width(binding) == innermost);
    unread.next().filter(|_| unread.next().is_none())
}

fn declared(binding: &Binding) -> (Span, String) {
    let unread = if binding.reads == 0 { UNUSED } else { "" };
    (binding.span, format!("`{}` is declared here{unread}", binding.name.text))
}
