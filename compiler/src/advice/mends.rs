//! Places that explain an error, and names that were probably meant.

use super::Texts;
use super::names::{Binding, Kind, Names, contains};
use crate::diagnostic::{Diagnostic, Place, names as sentences};
use texgraph_grammar::syntax::{Name, Node, Span, Statement};

/// Other places that are shown of one error at most.
const MOST: usize = 4;

/// Adds to an error what the text around it tells.
pub(super) fn mend(texts: &Texts, diagnostic: &mut Diagnostic) {
    let Some(names) = texts.names(diagnostic) else { return };
    let text = texts.text(diagnostic.place);
    let added = match diagnostic.code {
        "E0101" => unknown_value(names, diagnostic, text),
        "E0110" if !names.has_node(text) => unknown_value(names, diagnostic, text),
        "E0102" => unknown_node(names, diagnostic, text),
        "E0106" => no_output(names, diagnostic, text),
        "E0107" => no_value(names, diagnostic),
        "E0201" | "E0203" | "E0208" | "E0209" | "E0212" | "E0213" | "E0222" | "E0223" | "E0224" | "E0225" => {
            types(texts, names, diagnostic)
        }
        "E0204" | "E0206" | "E0207" | "E0215" => in_call(names, diagnostic),
        _ => Vec::new(),
    };
    for (span, label) in added {
        let place = Place { span, ..diagnostic.place };
        let is_new = place != diagnostic.place && diagnostic.related.iter().all(|(known, _)| *known != place);
        if is_new && diagnostic.related.len() < MOST {
            diagnostic.related.push((place, label));
        }
    }
}

/// Places with what they are.
type Related = Vec<(Span, String)>;

/// A value that nobody declared: a name near it, else the one name that nobody reads.
fn unknown_value(names: &Names, diagnostic: &mut Diagnostic, text: &str) -> Related {
    let place = diagnostic.place.span;
    let visible = |binding: &&Binding| {
        let is_value = !matches!(binding.kind, Kind::Node | Kind::Texture);
        is_value && contains(binding.scope, place) && !contains(binding.statement, place)
    };
    let visible: Vec<&Binding> = names.bindings.iter().filter(visible).collect();
    let meant = near(text, &visible).or_else(|| only_unread(&visible));
    meant.map_or(Vec::new(), |binding| did_you_mean(diagnostic, binding))
}

/// A node that nobody declared.
fn unknown_node(names: &Names, diagnostic: &mut Diagnostic, text: &str) -> Related {
    let nodes: Vec<&Binding> = names.bindings.iter().filter(|binding| binding.kind == Kind::Node).collect();
    let near = near(text, &nodes);
    // The library may have a name that is nearer.
    let is_nearer = near.is_some_and(|near| {
        diagnostic.help.as_ref().is_none_or(|help| *help == sentences::did_you_mean(&near.name.text))
    });
    let uncalled = only_unread(&nodes).filter(|_| diagnostic.help.is_none());
    let meant = near.filter(|_| is_nearer).or(uncalled);
    meant.map_or(Vec::new(), |binding| did_you_mean(diagnostic, binding))
}

fn near<'n, 'a>(text: &str, among: &[&'n Binding<'a>]) -> Option<&'n Binding<'a>> {
    let near = sentences::nearest(text, among.iter().map(|binding| binding.name.text.as_str()))?;
    among.iter().copied().find(|binding| binding.name.text == near)
}

/// The one binding that nobody reads: of the innermost scope that has any.
fn only_unread<'n, 'a>(among: &[&'n Binding<'a>]) -> Option<&'n Binding<'a>> {
    let unread =
        || among.iter().copied().filter(|binding| binding.reads == 0 && binding.kind != Kind::Output);
    let width = |binding: &&Binding| binding.scope.end - binding.scope.start;
    let innermost = unread().map(|binding| width(&binding)).min()?;
    let mut unread = unread().filter(|binding| width(binding) == innermost);
    unread.next().filter(|_| unread.next().is_none())
}

fn did_you_mean(diagnostic: &mut Diagnostic, binding: &Binding) -> Related {
    let name = &binding.name.text;
    let unread = if binding.reads == 0 { " and never used" } else { "" };
    diagnostic.help = Some(sentences::did_you_mean(name));
    vec![(binding.span, format!("`{name}` is declared here{unread}"))]
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
        diagnostic.help = Some(sentences::did_you_mean(&meant.text));
        return vec![(meant.span, format!("`{}` is declared here and gets no value", meant.text))];
    }
    let [first, .., last] = body.outputs.as_slice() else {
        return body.outputs.iter().map(|only| (only.span, "this is declared".to_owned())).collect();
    };
    vec![(first.span.to(last.span), "these are declared".to_owned())]
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
    let body = names.bodies.iter().find(|body| body.outputs.iter().any(|output| declares(output)));
    let end = body.map(|body| body.body.span.end);
    let label = "the body ends without it".to_owned();
    end.map_or(Vec::new(), |end| vec![(Span { start: end.saturating_sub(1), end }, label)])
}

/// A value of the wrong type: where it comes from, and where it goes to.
fn types(texts: &Texts, names: &Names, diagnostic: &Diagnostic) -> Related {
    let place = diagnostic.place.span;
    let value = names.taken_apart(place).unwrap_or(place);
    let operands = diagnostic.related.iter().map(|(place, _)| place.span);
    let mut related: Related = std::iter::once(value)
        .chain(operands)
        .filter_map(|place| source(texts, names, diagnostic, place))
        .collect();
    related.extend(wanted_by_input(names, place).or_else(|| wanted_by_output(names, place)));
    related
}

/// Where a value comes from: its name's declaration, or the output of the node that gives it.
fn source(texts: &Texts, names: &Names, diagnostic: &Diagnostic, place: Span) -> Option<(Span, String)> {
    if let Some(binding) = names.meaning(place) {
        // A `let` has the type of its value, which is shown too unless it is long.
        let whole = Place { span: binding.span.to(binding.value), ..diagnostic.place };
        let is_let = binding.value != Span::default() && !texts.text(whole).contains('\n');
        let span = if is_let { whole.span } else { binding.span };
        return Some((span, format!("`{}` is declared here", binding.name.text)));
    }
    let node = names.call(place).and_then(|site| names.callee(site))?;
    let (first, last) = (node.outputs.first()?, node.outputs.last()?);
    Some((first.name.span.to(last.ty.span), format!("`{}` gives this", node.name.text)))
}

/// The input that a value is an argument for.
fn wanted_by_input(names: &Names, place: Span) -> Option<(Span, String)> {
    let (site, position) = names.argument(place)?;
    let node: &Node = names.callee(site)?;
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

/// What is wrong with an argument may be wrong with the name of what is called.
fn in_call(names: &Names, diagnostic: &Diagnostic) -> Related {
    let Some((site, _)) = names.argument(diagnostic.place.span) else { return Vec::new() };
    let mut related = vec![(site.call.name.span, "in this call".to_owned())];
    related.extend(names.callee(site).map(|node| (node.name.span, "which is declared here".to_owned())));
    related
}
