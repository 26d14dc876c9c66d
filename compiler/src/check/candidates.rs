//! What a name before a bracket may mean, and which of several meanings takes the arguments.

use super::arguments::Given;
use super::call::Callee;
use super::head::Head;
use super::types;
use super::wire::Wire;
use super::{Checker, Frame};
use crate::diagnostic::{Place, arguments as sentences, nodes};
use crate::library::{Callable, Library};
use crate::resource::{DIMENSIONAL, KINDS};
use smallvec::SmallVec;
use std::borrow::Cow;
use texgraph_grammar::syntax::{Input, TypeKind};

/// What a name before a bracket may mean: in most cases what the library calls so.
pub type Candidates<'a> = Cow<'a, [Callable]>;

impl<'a> Checker<'a> {
    /// Whether an input of this name, in each of the callables that have one, is a choice with
    /// this word: a value of the same name isn't meant then.
    pub(super) fn is_choice(&self, candidates: &[Callable], input: &str, word: &str) -> bool {
        let heads = candidates.iter().filter_map(|callable| self.head(*callable));
        let mut inputs = heads.flat_map(|head| head.inputs).filter(|i| i.name.text == input).peekable();
        inputs.peek().is_some() && inputs.all(|input| chooses(input, word))
    }

    /// The same of a call whose file and receiver aren't known.
    pub(super) fn is_choice_anywhere(&self, call: &str, input: &str, word: &str) -> bool {
        let own = self.callables.iter().filter_map(|callables| callables.get(call)).flatten();
        let all: Vec<Callable> = self.library.callables(call).iter().chain(own).copied().collect();
        self.is_choice(&all, input, word)
    }

    /// What a name may mean in a file, nearest first.
    pub(super) fn callables_of(&self, module: usize, name: &str) -> Candidates<'a> {
        let is_users = module >= self.library.modules().len();
        let library: &'a Library = self.library;
        let library = if is_users && name.starts_with('_') { &[] } else { library.callables(name) };
        let joined = self.modules[module].imports.iter().filter(|import| import.alias.is_none());
        let modules = std::iter::once(module).chain(joined.map(|import| import.module));
        let mut nearer = modules.filter(|_| is_users).flat_map(|module| self.own_callables(module, name));
        match nearer.next() {
            Some(nearest) => [nearest].into_iter().chain(nearer).chain(library).copied().collect(),
            None => Cow::Borrowed(library),
        }
    }

    pub(super) fn own_callables(&self, module: usize, name: &str) -> &[Callable] {
        self.callables[module].get(name).map_or(&[], Vec::as_slice)
    }

    pub(super) fn head(&self, callable: Callable) -> Option<Head<'a>> {
        let library: &'a Library = self.library;
        match callable {
            Callable::Node(module, item) => self.node(module, item).map(|node| Head {
                name: &node.name.text,
                dims: &node.dims,
                inputs: &node.inputs,
                known: self.modules[module].known.get(item).map_or(&[], Vec::as_slice),
                module,
            }),
            Callable::Intrinsic(intrinsic) => library.signature(callable).map(|signature| Head {
                name: intrinsic.row().name,
                dims: &signature.dims,
                inputs: &signature.inputs,
                known: library.known(callable),
                module: 0,
            }),
            Callable::Constructor(kind) => library.signature(callable).map(|signature| Head {
                name: KINDS[kind].name,
                dims: &signature.dims,
                inputs: &signature.inputs,
                known: library.known(callable),
                module: 0,
            }),
        }
    }

    /// Calls the first candidate that takes the arguments; where none does, the one that the user
    /// most likely meant reports why.
    pub(super) fn call_one_of(
        &mut self,
        f: &mut Frame<'a>,
        candidates: &[Callable],
        callee: Callee<'a>,
        given: &[Given<'a>],
        place: Place,
    ) -> Wire {
        if given.iter().any(|given| matches!(given.wire, Wire::Unknown)) {
            f.failed |= f.waiting.is_empty();
            self.words(f, candidates, given);
            return Wire::Unknown;
        }
        if let [Callable::Constructor(kind)] = candidates
            && let Some(dim) = callee.dim
            && DIMENSIONAL.contains(&KINDS[*kind].name)
        {
            return match types::named_in(KINDS[*kind].name, dim, &f.dims, callee.place) {
                Ok(kind) => {
                    let callee = Callee { dim: None, ..callee };
                    self.call_one_of(f, &[Callable::Constructor(kind)], callee, given, place)
                }
                Err(error) => self.report(f, error),
            };
        }
        if let [callable] = candidates
            && let Some(head) = self.head(*callable)
        {
            return self.apply(f, *callable, head, callee.dim, given, place);
        }
        let heads: SmallVec<[(Callable, Head<'a>); 4]> =
            candidates.iter().filter_map(|callable| Some((*callable, self.head(*callable)?))).collect();
        let fits =
            |head: &Head<'a>, n: usize| head.inputs.iter().zip(given).take(n).all(|(i, g)| accepts(f, i, g));
        // The nearest that takes the first argument; of those equally near, one that takes all.
        let nearest =
            heads.iter().find(|(_, head)| fits(head, 1)).map(|(callable, _)| self.distance(f, *callable));
        let near = || heads.iter().filter(|(callable, _)| Some(self.distance(f, *callable)) == nearest);
        let chosen = near()
            .find(|(_, head)| given.len() <= head.inputs.len() && fits(head, given.len()))
            .or_else(|| near().find(|(_, head)| fits(head, 1)))
            .copied();
        match (chosen, heads.as_slice()) {
            (Some((callable, head)), _) => self.apply(f, callable, head, callee.dim, given, place),
            (None, [(callable, head)]) => self.apply(f, *callable, *head, callee.dim, given, place),
            (None, _) => self.no_receiver(f, &heads, callee, given, place),
        }
    }

    /// How far a callable is: of the same file, of another of the user's, of the library.
    fn distance(&self, f: &Frame<'a>, callable: Callable) -> u8 {
        match callable {
            Callable::Node(module, _) if module == f.module => 0,
            Callable::Node(module, _) if module >= self.library.modules().len() => 1,
            _ => 2,
        }
    }

    /// Reports the arguments that are unknown names, in a call that is wrong elsewhere too.
    pub(super) fn words(&mut self, f: &mut Frame<'a>, candidates: &[Callable], given: &[Given<'a>]) {
        let inputs =
            candidates.iter().filter_map(|callable| self.head(*callable)).flat_map(|head| head.inputs);
        let inputs: Vec<&'a Input> = inputs.collect();
        let takes_nodes = inputs.iter().any(|input| matches!(input.ty.kind, TypeKind::Node { .. }));
        for argument in given {
            // The name of a node may be right.
            if let Wire::Word(word) = &argument.wire
                && !inputs.iter().any(|input| chooses(input, &word.text))
                && (!takes_nodes || self.callables_of(f.module, &word.text).is_empty())
            {
                self.unknown_value(f, &word.text, word.place);
            }
        }
    }

    fn no_receiver(
        &mut self,
        f: &mut Frame<'a>,
        heads: &[(Callable, Head<'a>)],
        callee: Callee<'a>,
        given: &[Given<'a>],
        place: Place,
    ) -> Wire {
        let first = given.first();
        if let Some(Wire::Word(word)) = first.map(|given| &given.wire) {
            return self.unknown_value(f, &word.text, word.place);
        }
        if let Some(lambda) = given.iter().find(|given| matches!(given.wire, Wire::Lambda)) {
            return self.report(f, nodes::lambda_as_value(lambda.place));
        }
        let found = first
            .map_or_else(|| "nothing".to_owned(), |given| types::describe(&given.wire, |v| f.builder.ty(v)));
        let accepted = heads.iter().filter_map(|(_, head)| head.inputs.first());
        let accepted: Vec<String> = accepted.map(|input| format!("`{}`", types::show(&input.ty))).collect();
        let at = first.map_or(place, |given| given.place);
        self.report(f, sentences::bad_receiver(at, callee.name, &found, &accepted))
    }
}

/// Whether an input is a choice with this word.
fn chooses(input: &Input, word: &str) -> bool {
    matches!(&input.ty.kind, TypeKind::Choice(words) if words.iter().any(|known| known.text == word))
}

/// Whether an input may take an argument, as far as that can be told before dimensions are bound.
pub(super) fn accepts(f: &Frame<'_>, input: &texgraph_grammar::syntax::Input, given: &Given<'_>) -> bool {
    if given.name.is_some() {
        return true;
    }
    match (&given.wire, types::scalar_of(&input.ty)) {
        (Wire::Value(value), Some(wanted)) => {
            let ty = f.builder.ty(*value);
            let width =
                types::fixed_width(&input.ty).is_none_or(|width| ty.width() == 1 || ty.width() == width);
            width && ty.scalar().is_some_and(|found| types::widens(found, wanted))
        }
        (_, None) if matches!(input.ty.kind, TypeKind::Node { .. }) => {
            given.expr.is_some() || matches!(given.wire, Wire::Node(_))
        }
        (Wire::Matrix(columns), None) => {
            types::matrix(&input.ty).is_some_and(|size| usize::from(size) == columns.len())
        }
        (Wire::Resource(resource), None) => types::is_kind(&input.ty, resource.kind),
        (Wire::Word(_) | Wire::None | Wire::Text(_) | Wire::List(_), None) => true,
        _ => false,
    }
}
