//! A function in the making: what is in scope, what is left to do, and what it waits for.

use super::layer::Layer;
use super::plan::Reported;
use super::prepared::Prepared;
use super::types::Dims;
use super::wire::{Key, Wire};
use crate::diagnostic::Place;
use crate::graph::Builder;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;
use texgraph_grammar::syntax::{Expr, Input, Item, ItemKind, Name, Node, Pattern, Postfix, Span};

/// One thing to do in a function: bind names, assign an output, or declare a param.
pub struct Step<'a> {
    pub(super) target: Target<'a>,
    pub(super) value: &'a Expr,
}

/// What a step's value goes to.
#[derive(Clone, Copy)]
pub enum Target<'a> {
    Let(&'a Pattern),
    Output(&'a Name),
    Global(&'a Name, &'a str),
    Param(&'a Item),
    Default(&'a Input),
    /// A node that is rendered on its own, by its item.
    Render(usize),
    /// The period of a texture, by its item.
    Tiles(usize),
}

/// How far a chain of methods has come.
pub struct Progress {
    /// The link that is next.
    pub(super) next: usize,
    /// What it is asked of.
    pub(super) wire: Wire,
    /// How many values there were by then.
    pub(super) values: usize,
}

/// A function in the making.
pub struct Frame<'a> {
    /// None for the `let`s and params of a file.
    pub(super) key: Option<Key>,
    pub(super) node: Option<&'a Node>,
    pub(super) module: usize,
    pub(super) dims: Dims<'a>,
    pub(super) builder: Builder,
    pub(super) scopes: Vec<FxHashMap<&'a str, Wire>>,
    /// The functions around the one that the builder makes, the outermost first.
    pub(super) layers: Vec<Layer>,
    /// The first scope of the function that the builder makes.
    pub(super) base: usize,
    pub(super) steps: Vec<Step<'a>>,
    pub(super) order: Vec<usize>,
    pub(super) next: usize,
    /// The names that the steps bind, and which step does.
    pub(super) bound: FxHashMap<&'a str, usize>,
    /// Where names stand that were bound before: the first binding holds.
    pub(super) repeated: FxHashSet<u32>,
    /// Outputs whose declared type is wrong, and names that are bound twice: what they get is not
    /// looked at.
    pub(super) doubtful: FxHashSet<&'a str>,
    /// Names that nobody declared, reported once.
    pub(super) unknown: Reported,
    /// Nodes that the current step waits for, with the calls.
    pub(super) waiting: Vec<(Key, Place)>,
    pub(super) failed: bool,
    /// How far chains of methods in the current step have come, by their first link: a step that
    /// waited goes on from there.
    pub(super) progress: FxHashMap<*const Postfix, Progress>,
    /// Expressions are evaluated for other names than the step's own: a fold's body, a default.
    pub(super) foreign: u32,
    /// The defaults that are being evaluated, each for the one before.
    pub(super) defaults: Vec<&'a Expr>,
    /// There is nothing to do: the library has made it.
    pub(super) prepared: Option<&'a Prepared>,
    /// Index of the frame that waits for this one.
    pub(super) parent: Option<usize>,
    /// The call in a user's file that leads here.
    pub(super) caller: Option<Place>,
    /// The statement whose value is being made; names made-up resources.
    pub(super) current: &'a str,
}

impl<'a> Frame<'a> {
    pub(super) fn empty() -> Frame<'a> {
        Frame {
            key: None,
            node: None,
            module: 0,
            dims: Dims::new(),
            builder: Builder::default(),
            scopes: vec![FxHashMap::default()],
            layers: Vec::new(),
            base: 0,
            steps: Vec::new(),
            order: Vec::new(),
            bound: FxHashMap::default(),
            repeated: FxHashSet::default(),
            doubtful: FxHashSet::default(),
            unknown: Reported::default(),
            next: 0,
            waiting: Vec::new(),
            failed: false,
            progress: FxHashMap::default(),
            foreign: 0,
            defaults: Vec::new(),
            prepared: None,
            parent: None,
            caller: None,
            current: "",
        }
    }

    /// Notes which step binds each name that is no input; false where one is bound twice.
    pub(super) fn bind_steps(&mut self) -> bool {
        let mut names = 0;
        self.bound.reserve(self.steps.len());
        self.scopes.last_mut().into_iter().for_each(|scope| scope.reserve(self.steps.len()));
        for (i, step) in self.steps.iter().enumerate() {
            for name in step.names() {
                names += 1;
                self.bound.entry(name).or_insert(i);
            }
        }
        let mut is_once = self.bound.len() == names;
        for input in self.node.iter().flat_map(|node| &node.inputs) {
            is_once &= self.bound.remove(input.name.text.as_str()).is_none();
        }
        is_once
    }

    /// The name of the node whose body is being made, whatever stands inside it.
    pub(super) fn function_name(&self) -> SmolStr {
        self.builder_of(0).function().name.clone()
    }
}

impl<'a> Step<'a> {
    /// The names that it binds.
    pub(super) fn names(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        let (one, several) = match self.target {
            Target::Let(Pattern::Record(names, _)) => (None, names.as_slice()),
            target => (Some(target.name()), &[][..]),
        };
        one.into_iter().chain(several.iter().map(|name| name.text.as_str()))
    }

    /// The ends of a param's range.
    pub(super) fn ends(&self) -> Vec<&'a Expr> {
        let Target::Param(item) = self.target else { return Vec::new() };
        match &item.kind {
            ItemKind::Param { range: Some(range), .. } => vec![&*range.start, &*range.end],
            _ => Vec::new(),
        }
    }

    pub(super) fn span(&self) -> Span {
        self.value.span
    }
}

impl<'a> Target<'a> {
    pub(super) fn name(&self) -> &'a str {
        match *self {
            Target::Let(Pattern::Name(name)) | Target::Output(name) | Target::Global(name, _) => &name.text,
            Target::Let(Pattern::Record(names, _)) => names.first().map_or("", |name| &name.text),
            Target::Default(input) => &input.name.text,
            Target::Render(_) => "value",
            Target::Tiles(_) => "tiles",
            Target::Param(item) => match &item.kind {
                ItemKind::Param { name, .. } => &name.text,
                _ => "",
            },
        }
    }
}
