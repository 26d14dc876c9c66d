//! Places that explain an error, and names that were probably meant.

use super::Texts;
use super::consequences::{site, value};
use super::names::{Binding, Kind, Names, contains};
use crate::diagnostic::{Diagnostic, Place, names as sentences};
use crate::input::INPUTS;
use texgraph_grammar::syntax::{Name, Span, Statement};

/// Other places that are shown of one error at most.
const MOST: usize = 4;

/// Places with what they are.
type Related = Vec<(Span, String)>;

/// Adds to an error what the text around it tells.
pub(super) fn mend(texts: &Texts, diagnostic: &mut Diagnostic) {
    let Some(names) = texts.names(diagnostic) else { return };
    let text = texts.text(diagnostic.place);
    let added = match diagnostic.code {
        "E0101" => unknown_value(texts, names, diagnostic, text),
        "E0110" if is_library_name(names, diagnostic, text) => unknown_value(texts, names, diagnostic, text),
        "E0102" => unknown_node(names, diagnostic, text),
        "E0106" => no_output(names, diagnostic, text),
        "E0107" => no_value(names, diagnostic),
        "E0201" | "E0203" | "E0208" | "E0209" | "E0212" | "E0213" | "E0219" | "E0222" | "E0223" | "E0224"
        | "E0225" => types(texts, names, diagnostic),
        "E0204" | "E0205" | "E0206" | "E0207" | "E0215" => in_call(names, diagnostic),
        "E0220" => no_dimension(names, diagnostic),
        _ => Vec::new(),
    };
    for (span, label) in added {
        let is_apart = |known: Place| known.file != diagnostic.place.file || !overlap(known.span, span);
        let is_new =
            is_apart(diagnostic.place) && diagnostic.related.iter().all(|(known, _)| is_apart(*known));
        if is_new && diagnostic.related.len() < MOST {
            diagnostic.related.push((Place { span, ..diagnostic.place }, label));
        }
    }
}

fn overlap(a: Span, b: Span) -> bool {
    a.start < b.end && b.start < a.end
}

/// A value that nobody declared: a name near it, the one name that nobody reads, or the inputs that
/// it would be one of.
fn unknown_value(texts: &Texts, names: &Names, diagnostic: &mut Diagnostic, text: &str) -> Related {
    let place = diagnostic.place.span;
    let visible = |binding: &&Binding| {
        let is_value = !matches!(binding.kind, Kind::Node | Kind::Texture);
        is_value && contains(binding.scope, place) && !contains(binding.statement, place)
    };
    let visible: Vec<&Binding> = names.bindings.iter().filter(visible).collect();
    let near = near(text, &visible);
    // Others may read what a file without textures declares.
    let is_for_others = |binding: &Binding| binding.kind == Kind::Item && !names.has_texture();
    let unread = only_unread(&visible).filter(|binding| !is_for_others(binding));
    let unread = unread.filter(|_| near.is_none_or(|near| near.reads > 0));
    let mut related = Vec::new();
    if let Some(near) = near {
        if diagnostic.help.is_none() || diagnostic.suggestion.is_some() {
            diagnostic.suggest_name(&near.name.text);
        }
        related.push(declared(near));
    }
    related.extend(unread.map(declared));
    if near.is_none() {
        related.extend(inputs(texts, names, diagnostic, text));
    }
    related
}

/// The brackets of the inputs of the node around an unknown name. A texture has inputs of a few
/// names only.
fn inputs(texts: &Texts, names: &Names, diagnostic: &mut Diagnostic, text: &str) -> Option<(Span, String)> {
    let place = diagnostic.place;
    let node = names.node(place.span)?;
    let known = INPUTS.iter().find(|known| known.name == text);
    if let Some(known) = known {
        let input = format!("{}: {}", known.name, known.types.first()?);
        diagnostic.help = Some(sentences::not_passed_on(&node.name.text, &input));
    } else if names.is_texture(node) {
        return None;
    }
    let first = node.dims.last().map_or(node.name.span.end, |dim| dim.span.end);
    let last = node
        .inputs
        .last()
        .map_or(first, |input| input.default.as_ref().map_or(input.ty.span.end, |default| default.span.end));
    let end = node.outputs.first().map_or(last, |output| output.name.span.start);
    let head = |start, end| texts.text(Place { span: Span { start, end }, ..place });
    let start = first + head(first, end).find('(')? as u32;
    let end = last.max(start) + head(last.max(start), end).find(')')? as u32 + 1;
    let label = format!("the inputs of `{}`", node.name.text);
    Some((Span { start, end }, label)).filter(|_| !head(start, end).contains('\n'))
}

/// Whether a name without a call is that of a node of the library: a value may have been meant.
fn is_library_name(names: &Names, diagnostic: &Diagnostic, text: &str) -> bool {
    let place = diagnostic.place.span;
    let is_called = || names.sites.iter().any(|site| site.call.name.span == place);
    !names.has_node(text) && names.base(place).is_none() && !is_called()
}

/// A node that nobody declared.
fn unknown_node(names: &Names, diagnostic: &mut Diagnostic, text: &str) -> Related {
    let place = diagnostic.place.span;
    let nodes = |binding: &&Binding| binding.kind == Kind::Node && !contains(binding.statement, place);
    let nodes: Vec<&Binding> = names.bindings.iter().filter(nodes).collect();
    let near = near(text, &nodes);
    // The library may have a name that is nearer.
    let is_nearer = near.is_some_and(|near| {
        let suggested = diagnostic.suggestion.as_ref().and_then(|suggestion| suggestion.edits.first());
        diagnostic.help.is_none() || suggested.is_some_and(|(_, name)| *name == near.name.text)
    });
    let meant = near.filter(|_| is_nearer);
    if let Some(near) = meant {
        diagnostic.suggest_name(&near.name.text);
    }
    meant.or_else(|| only_unread(&nodes)).map(declared).into_iter().collect()
}

fn near<'n, 'a>(text: &str, among: &[&'n Binding<'a>]) -> Option<&'n Binding<'a>> {
    let near = sentences::nearest(text, among.iter().map(|binding| binding.name.text.as_str()))?;
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
    let unread = if binding.reads == 0 { " and never used" } else { "" };
    (binding.span, format!("`{}` is declared here{unread}", binding.name.text))
}

/// An assignment to something that is no output: the output that lacks a value.
fn no_output(names: &Names, diagnostic: &mut Diagnostic, text: &str) -> Related {
    let Some(body) = names.body(diagnostic.place.span) else { return Vec::new() };
    let assigned: Vec<&str> = body.body.statements.iter().filter_map(assigned).collect();
    let missing: Vec<&Name> =
        body.outputs.iter().copied().filter(|output| !assigned.contains(&output.text.as_str())).collect();
    let near = sentences::nearest(text, missing.iter().map(|name| name.text.as_str()));
    let meant = match (near, missing.as_slice()) {
        (Some(near), _) => missing.iter().find(|name| name.text == near),
        (None, [only]) => Some(only),
        (None, _) => None,
    };
    if let Some(meant) = meant {
        diagnostic.suggest_name(&meant.text);
        return vec![(meant.span, format!("`{}` is declared here and gets no value", meant.text))];
    }
    declared_row(names, &body.outputs).into_iter().collect()
}

/// A row of declarations, with their types.
fn declared_row(names: &Names, row: &[&Name]) -> Option<(Span, String)> {
    let (first, last) = (names.bound(row.first()?)?, names.bound(row.last()?)?);
    let label = if row.len() == 1 { "this is declared" } else { "these are declared" };
    Some((first.span.to(last.span), label.to_owned()))
}

fn assigned(statement: &Statement) -> Option<&str> {
    match statement {
        Statement::Assign { name, .. } => Some(&name.text),
        Statement::Let { .. } => None,
    }
}

/// An output without a value: the end of the body that should give it.
fn no_value(names: &Names, diagnostic: &Diagnostic) -> Related {
    let declares = |name: &&Name| name.span == diagnostic.place.span;
    let body = names.bodies.iter().find(|body| body.outputs.iter().any(|output| declares(&output)));
    let end = body.map(|body| body.body.span.end);
    let label = "the body ends without it".to_owned();
    end.map_or(Vec::new(), |end| vec![(Span { start: end.saturating_sub(1), end }, label)])
}

/// A dimension that nobody declared: those that are.
fn no_dimension(names: &Names, diagnostic: &Diagnostic) -> Related {
    let place = diagnostic.place.span;
    let dims: Vec<&Name> = names.node(place).map_or(Vec::new(), |node| node.dims.iter().collect());
    declared_row(names, &dims).into_iter().collect()
}

/// A value of the wrong type: where it comes from, and where it goes to.
fn types(texts: &Texts, names: &Names, diagnostic: &Diagnostic) -> Related {
    let place = diagnostic.place.span;
    let mut values = vec![value(names, place)];
    values.extend(diagnostic.related.iter().map(|(place, _)| place.span));
    if diagnostic.code == "E0219" {
        let parts = names.call(place).into_iter().flat_map(|site| &site.call.arguments);
        let is_plain = |value: &Span| !texts.text(Place { span: *value, ..diagnostic.place }).contains('(');
        values.extend(parts.map(|part| part.value.span).filter(is_plain));
    }
    let sources = values.into_iter().filter_map(|value| source(texts, names, diagnostic, value));
    let mut related: Related = sources.collect();
    related.extend(names.base(place).map(|base| (base, "of this".to_owned())));
    if matches!(diagnostic.code, "E0201" | "E0213" | "E0222" | "E0223") {
        related.extend(wanted_by_input(names, place).or_else(|| wanted_by_output(names, place)));
    }
    related
}

/// Where a value comes from: the declaration of the one name that it is made of, or the output of
/// the node that gives it.
fn source(texts: &Texts, names: &Names, diagnostic: &Diagnostic, value: Span) -> Option<(Span, String)> {
    if let Some(node) = names.call(value).and_then(|site| names.callee(site)) {
        let (first, last) = (node.outputs.first()?, node.outputs.last()?);
        return Some((first.name.span.to(last.ty.span), format!("`{}` gives this", node.name.text)));
    }
    let wires = names.read_within(value).into_iter().filter_map(|wire| names.bindings.get(wire));
    let mut wires = wires.filter(|wire| names.meaning(value).is_some() || wire.kind == Kind::Wire);
    let wire = wires.next().filter(|_| wires.next().is_none())?;
    // A `let` has the type of its value, which is shown too unless it is long.
    let whole = Place { span: wire.span.to(wire.value), ..diagnostic.place };
    let is_let = wire.value != Span::default() && !texts.text(whole).contains('\n');
    let span = if is_let { whole.span } else { wire.span };
    Some((span, format!("`{}` is declared here", wire.name.text)))
}

/// The input that a value is an argument for.
fn wanted_by_input(names: &Names, place: Span) -> Option<(Span, String)> {
    let (site, position) = names.argument(place)?;
    let Some(node) = names.callee(site) else {
        return Some((site.call.name.span, "in this call".to_owned()));
    };
    let named = site.call.arguments.iter().find(|argument| argument.value.span == place);
    let named = named.and_then(|argument| argument.name.as_ref());
    let input = match named {
        Some(name) => node.inputs.iter().find(|input| input.name.text == name.text),
        None => node.inputs.get(position),
    }?;
    Some((input.name.span.to(input.ty.span), format!("`{}` is declared here", input.name.text)))
}

/// The output or accumulator that a value is assigned to.
fn wanted_by_output(names: &Names, place: Span) -> Option<(Span, String)> {
    let name = names.assigned(place)?;
    let declares = |binding: &&Binding| {
        binding.kind == Kind::Output && binding.name.text == name.text && contains(binding.scope, place)
    };
    let output = names.bindings.iter().filter(declares).next_back()?;
    Some((output.span, format!("`{}` is declared here", name.text)))
}

/// What is wrong with an argument may be wrong with the name of what is called, or with its head.
fn in_call(names: &Names, diagnostic: &Diagnostic) -> Related {
    let Some(site) = site(names, diagnostic) else { return Vec::new() };
    let name = site.call.name.span;
    let mut related: Related = Vec::new();
    related.extend(names.base(diagnostic.place.span).map(|base| (base, "of this".to_owned())));
    if !contains(diagnostic.place.span, name) {
        related.push((name, "in this call".to_owned()));
    }
    if let Some(node) = names.callee(site) {
        let inputs: Vec<&Name> = node.inputs.iter().map(|input| &input.name).collect();
        related.extend(declared_row(names, &inputs));
    }
    related
}
