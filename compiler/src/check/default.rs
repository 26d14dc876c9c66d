//! Defaults of inputs, checked where they are declared: a call that gives the argument never looks
//! at them.

use super::arguments::is_absent;
use super::types::{self, Declared};
use super::wire::Wire;
use super::{Checker, Frame, Step, Target};
use crate::diagnostic::Place;
use crate::graph::Builder;
use texgraph_grammar::syntax::{Input, Node};

impl<'a> Checker<'a> {
    /// Checks the defaults of a node. Each may read the inputs before it.
    pub(super) fn defaults(&mut self, module: usize, node: &'a Node) {
        let mut f = Frame::empty();
        f.module = module;
        f.builder = Builder::new(node.name.text.clone());
        f.node = Some(node);
        f.dims = node.dims.iter().map(|d| (d.text.as_str(), 2)).collect();
        for input in &node.inputs {
            if let Some(value) = &input.default {
                f.steps.push(Step { target: Target::Default(input), value });
            }
        }
        if f.steps.is_empty() {
            return;
        }
        f.order = (0..f.steps.len()).collect();
        self.declare_until_default(&mut f, 0);
        self.run(f);
    }

    /// Puts the inputs from one on into scope, up to the first that has a default.
    fn declare_until_default(&self, f: &mut Frame<'a>, from: usize) {
        let inputs = f.node.map_or(&[][..], |node| node.inputs.get(from..).unwrap_or_default());
        for input in inputs.iter().take_while(|input| input.default.is_none()) {
            let wire = self.open_wire(f, input);
            f.scopes[0].insert(&input.name.text, wire);
        }
    }

    fn open_wire(&self, f: &mut Frame<'a>, input: &Input) -> Wire {
        match types::resolve(&input.ty, &f.dims, self.modules[f.module].file) {
            Ok(declared @ (Declared::Vector(..) | Declared::Matrix(_))) => {
                super::node::open_input(&mut f.builder, &input.name.text, &declared)
            }
            // What else an input may be has no operators; calls that read it are checked there.
            _ => Wire::Unknown,
        }
    }

    pub(super) fn check_default(&mut self, f: &mut Frame<'a>, input: &'a Input, wire: Wire, place: Place) {
        // A wrong type is reported at the head.
        if let Ok(declared) = types::resolve(&input.ty, &f.dims, self.modules[f.module].file) {
            let given = super::arguments::Given { name: None, wire, place, expr: input.default.as_ref() };
            if !is_absent(&declared, &given.wire) {
                self.coerce(f, &input.name.text, &declared, &given);
            }
        }
        let wire = self.open_wire(f, input);
        f.scopes[0].insert(&input.name.text, wire);
        let position = f.node.and_then(|node| node.inputs.iter().position(|i| std::ptr::eq(i, input)));
        self.declare_until_default(f, position.map_or(usize::MAX, |position| position + 1));
    }
}
