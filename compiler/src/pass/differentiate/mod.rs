//! Screen-space derivatives by forward differentiation of the graph, on demand.
//!
//! A sample needs the gradient of its coordinate; a function is made anew for every combination of
//! inputs that change across the screen and outputs whose change is wanted (a `Variant`). Only
//! values that reach a sample or a `dx`/`dy` get a tangent. The rules are in the intrinsic table;
//! what comes out of a fetch, and every integer, counts as constant. So does what comes out of a
//! sample, but in what a `dx` or `dy` is taken of (see `sampled`): there it changes by what two more
//! samples, one pixel apart, differ from it.
//!
//! A fold carries the tangents of the accumulators that need one as further accumulators, and takes
//! those of its captures as further captures. Which accumulators need one may depend on how many
//! steps back one looks, so it is a fixpoint over the body. The condition has no derivative, but
//! takes what its fold carries.
//!
//! Rules say how whole intrinsics change, the guards of a division do not; so total operations
//! become what a shader has here, as values and tangents are made, and not earlier.
//!
//! Analyses first, along arena order, so nothing recurses: `depend` finds what each value changes
//! with, callees first, and `demand` which values need a tangent and so which variants are
//! requested, callers first. Then `make` makes them, callees first.

mod demand;
mod depend;
mod make;
mod sampled;

use super::finished::{Done, Finished};
use crate::graph::{Function, FunctionId, Graph, Operation, Type, Value};
use demand::{Requests, Work};
use depend::KnownOf;
pub use make::Made;
use make::Making;
use rustc_hash::FxHashMap;
use sampled::Marks;
use smallvec::SmallVec;

/// A set of inputs of a function. Those from bit 127 on share it: they may count as dependent when
/// they are not.
type Inputs = u128;

const BITS: usize = Inputs::BITS as usize;

/// How the inputs of a function are numbered in sets, and where their tangents go.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Layout {
    /// The tangents of the inputs before this one stand right before it, those of the others at
    /// the end.
    split: usize,
    /// A condition is not told the number of the step; in sets it is counted as if it were, so that
    /// one set is right for the body and for the condition of a fold.
    skips: bool,
}

impl Layout {
    const CALLED: Layout = Layout { split: usize::MAX, skips: false };

    fn body(accumulators: usize) -> Layout {
        Layout { split: accumulators, skips: false }
    }

    fn condition(accumulators: usize) -> Layout {
        Layout { split: accumulators, skips: true }
    }

    /// Of every function of a graph.
    fn all(graph: &Graph) -> Vec<Layout> {
        let mut layouts = vec![Layout::CALLED; graph.functions.len()];
        for operation in graph.functions.iter().flat_map(|function| &function.values) {
            if let Operation::Fold(fold) = operation {
                layouts[fold.body.0 as usize] = Layout::body(fold.starts.len());
                if let Some(condition) = fold.condition {
                    layouts[condition.0 as usize] = Layout::condition(fold.starts.len());
                }
            }
        }
        layouts
    }

    fn position(self, input: usize) -> usize {
        (input + usize::from(self.skips && input >= self.split)).min(BITS - 1)
    }

    fn bit(self, input: usize) -> Inputs {
        1 << self.position(input)
    }
}

/// A function with tangents: inputs that change, and outputs whose change is wanted.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Variant {
    changing: Inputs,
    wanted: SmallVec<[bool; 16]>,
    /// Its outputs change with what it samples.
    is_sampled: bool,
}

impl Variant {
    /// Whether it takes the tangents of an input.
    fn takes(&self, layout: Layout, input: usize, ty: Type) -> bool {
        ty.is_float() && self.changing & layout.bit(input) != 0
    }

    /// Does all that the other does, too.
    fn join(&mut self, other: &Variant) {
        self.changing |= other.changing;
        self.is_sampled |= other.is_sampled;
        self.wanted.iter_mut().zip(&other.wanted).for_each(|(wanted, other)| *wanted |= other);
    }
}

/// What is known of a graph before variants are made.
struct Analysis<'a> {
    graph: &'a Graph,
    layouts: Vec<Layout>,
    known: Vec<KnownOf>,
    /// Of each function the values that are changed by what is sampled, if any are.
    marks: Option<Vec<Marks>>,
    finished: &'a Finished,
    /// The inputs of the entry change across the screen.
    changes: bool,
}

impl<'a> Analysis<'a> {
    fn of(graph: &'a Graph, finished: &'a Finished) -> Analysis<'a> {
        let layouts = Layout::all(graph);
        let marks = sampled::marks(graph);
        let known = depend::analyse(graph, &layouts, marks.as_deref());
        Analysis { graph, layouts, known, marks, finished, changes: true }
    }

    /// A variant of a function that has been through all passes already.
    fn done(&self, place: usize, variant: &Variant) -> Option<&'a Done> {
        let is_called = self.layouts[place] == Layout::CALLED;
        self.finished.find(&self.graph.functions[place], variant).filter(|_| is_called)
    }

    /// Whether a function's outputs change with what it samples where a value of another function,
    /// in one of that one's variants, comes from it.
    fn is_sampled(&self, id: FunctionId, place: usize, variant: &Variant, by: Value) -> bool {
        let marks = self.marks.as_ref();
        marks.is_some_and(|marks| marks[id.0 as usize].samples() && marks[place].has(variant.is_sampled, by))
    }

    fn layout(&self, id: FunctionId) -> Layout {
        self.layouts[id.0 as usize]
    }
}

/// Replaces every `Level::Auto` by gradients, every inner derivative by its value, and every total
/// operation by what a shader has. What is `finished` already is taken over. If nothing `changes`
/// across the screen, every derivative is 0 and every sample of the finest level.
pub fn run(graph: Graph, finished: &Finished, changes: bool) -> Graph {
    let analysis = Analysis { changes, ..Analysis::of(&graph, finished) };
    let (functions, _) = make_all(&analysis, &Requests::of(&analysis));
    Graph { functions, ..graph }
}

/// What became of a variant of a function.
pub struct MadeOf {
    /// The place of the function in the graph that was.
    pub function: u32,
    /// Which variant.
    pub variant: Variant,
    /// What it is now.
    pub made: Made,
    /// The functions that it calls, by their places in the graph that was, and what it asks of them.
    pub inner: Vec<(u32, Variant)>,
}

/// The same with nothing finished, and what became of each variant of the functions that are called.
pub fn with_variants(graph: Graph) -> (Graph, Vec<MadeOf>) {
    let nothing = Finished::default();
    let analysis = Analysis::of(&graph, &nothing);
    let requests = Requests::of(&analysis);
    let (functions, made) = make_all(&analysis, &requests);
    let mut variants = Vec::new();
    for (i, made) in made.into_iter().enumerate().filter(|(i, _)| analysis.layouts[*i] == Layout::CALLED) {
        let own = requests.of_function(i).zip(made);
        variants.extend(own.map(|((variant, work), made)| MadeOf {
            function: i as u32,
            variant: variant.clone(),
            made,
            inner: work.calls(&analysis.graph.functions[i]),
        }));
    }
    (Graph { functions, ..graph }, variants)
}

/// The functions of all variants, and which they are.
fn make_all(analysis: &Analysis, requests: &Requests) -> (Vec<Function>, Vec<Vec<Made>>) {
    let mut functions = Vec::new();
    let mut taken = FxHashMap::default();
    let mut made: Vec<Vec<Made>> = Vec::with_capacity(analysis.graph.functions.len());
    for i in 0..analysis.graph.functions.len() {
        let variants = requests.of_function(i).map(|(variant, work)| match work {
            Work::Finished(done) => {
                let id = analysis.finished.take_over(done, &mut functions, &mut taken);
                Made { id, tangents: done.tangents.clone() }
            }
            Work::Make(demand) => {
                let (function, tangents) = Making::new(analysis, i, variant, demand, requests, &made).run();
                functions.push(function);
                Made { id: FunctionId(functions.len() as u32 - 1), tangents }
            }
        });
        let variants = variants.collect();
        made.push(variants);
    }
    (functions, made)
}

/// Whether a set of flags holds a value.
fn marked(flags: &[bool], value: Value) -> bool {
    flags.get(value.0 as usize).copied().unwrap_or(false)
}
