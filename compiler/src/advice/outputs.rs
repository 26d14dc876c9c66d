//! Outputs: what is assigned and was not declared, and the other way round.

use super::{Look, Related};
use crate::diagnostic::{Diagnostic, names as sentences};
use texgraph_grammar::syntax::{Name, Span, Statement};

impl Look<'_, '_> {
    /// An assignment to something that is no output: the output that lacks a value, else all.
    pub(super) fn no_output(&self, diagnostic: &mut Diagnostic) -> Related {
        let Some(body) = self.names.body(self.span()) else { return Vec::new() };
        let assigned: Vec<&str> = body.body.statements.iter().filter_map(assigned).collect();
        let is_missing = |output: &&Name| !assigned.contains(&output.text.as_str());
        let missing: Vec<&Name> = body.outputs.iter().copied().filter(is_missing).collect();
        let near = sentences::nearest(self.text(self.span()), missing.iter().map(|name| name.text.as_str()));
        let meant = match (near, missing.as_slice()) {
            (Some(near), _) => missing.iter().find(|name| name.text == near),
            (None, [only]) => Some(only),
            (None, _) => None,
        };
        let Some(meant) = meant else { return self.row(&body.outputs).into_iter().collect() };
        diagnostic.suggest_name(&meant.text);
        vec![(meant.span, format!("`{}` is declared here and gets no value", meant.text))]
    }

    /// A row of declarations, with their types.
    pub(super) fn row(&self, row: &[&Name]) -> Option<(Span, String)> {
        let (first, last) = (self.names.bound(row.first()?)?, self.names.bound(row.last()?)?);
        let label = if row.len() == 1 { "this is declared" } else { "these are declared" };
        let whole = first.span.to(last.span);
        Some((whole, label.to_owned())).filter(|_| !self.text(whole).contains('\n'))
    }

    /// An output without a value: the end of the body that should give it.
    pub(super) fn no_value(&self, diagnostic: &Diagnostic) -> Related {
        let declares = |outputs: &[&Name]| outputs.iter().any(|output| output.span == self.span());
        let body = self.names.bodies.iter().find(|body| declares(&body.outputs));
        let end = body.map(|body| body.body.span.end).filter(|_| diagnostic.related.is_empty());
        let brace =
            |end: u32| (Span { start: end.saturating_sub(1), end }, "the body ends without it".to_owned());
        end.map(brace).into_iter().collect()
    }
}

fn assigned(statement: &Statement) -> Option<&str> {
    match statement {
        Statement::Assign { name, .. } => Some(&name.text),
        Statement::Let { .. } => None,
    }
}
