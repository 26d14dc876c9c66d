//! Decides which functions are taken over.
//!
//! Expressions that call each other twice would double a graph again and again, and folds would
//! nest deeper than blocks may, so both are bounded. Users come before what they use: what is no
//! longer taken over begins a function of its own, and the bounds with it.

use crate::graph::{Function, Graph, Operation};

/// Folds inside each other in one function at most, where that is a matter of taking over. Blocks
/// of a shader nest a little deeper: there is room for branches.
const MOST_NESTED: u32 = 24;
/// Values that taking over may add to a graph: expressions that call each other twice would double
/// it again and again.
const MOST_TAKEN_OVER: u64 = 200_000;

/// What becomes of a function.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Fate {
    /// Nothing needs it.
    Dropped,
    /// It stays a function, called by those that need it.
    Called,
    /// It stays the body or the condition of folds.
    Folded,
    /// All who call it take it over.
    TakenOver,
}

/// What becomes of every function.
pub struct Plan {
    /// One for each.
    pub fates: Vec<Fate>,
}

/// How a function is needed, as far as its users have been met.
#[derive(Clone, Copy, Default)]
struct Need {
    called: bool,
    /// The body or the condition of a fold: it stands in the function that the fold stands in.
    folded: bool,
    /// Loops around it there.
    loops: u32,
    /// How often it would be taken over.
    copies: u64,
}

impl Plan {
    /// Users are met before what they use.
    pub fn of(graph: &Graph) -> Plan {
        let nests = nests(graph);
        let mut needs = vec![Need::default(); graph.functions.len()];
        let mut fates = vec![Fate::Dropped; graph.functions.len()];
        let mut allowance = MOST_TAKEN_OVER;
        let entry = graph.functions.len().saturating_sub(1);
        for (i, function) in graph.functions.iter().enumerate().rev() {
            let need = needs[i];
            if !need.called && !need.folded && i != entry {
                continue;
            }
            let cost = need.copies.saturating_mul(function.values.len() as u64);
            let over = function.inline && !need.folded && i != entry;
            let over = over && need.loops + nests[i] <= MOST_NESTED && cost <= allowance;
            fates[i] = match (over, need.folded) {
                (true, _) => Fate::TakenOver,
                (false, true) => Fate::Folded,
                (false, false) => Fate::Called,
            };
            allowance -= if over { cost } else { 0 };
            let (loops, copies) = match (over, need.folded) {
                (true, _) => (need.loops, need.copies),
                (false, true) => (need.loops, 1),
                (false, false) => (0, 1),
            };
            spread(function, loops, copies, &mut needs);
        }
        Plan { fates }
    }

    /// Whether a function takes nothing over and has no fold that might be written out.
    pub fn stays(&self, function: &Function) -> bool {
        function.values.iter().all(|operation| match operation {
            Operation::Call(callee, _) => self.fates[callee.0 as usize] == Fate::Called,
            Operation::Fold(_) => false,
            _ => true,
        })
    }
}

/// Notes what a function needs.
fn spread(function: &Function, loops: u32, copies: u64, needs: &mut [Need]) {
    for operation in &function.values {
        match operation {
            Operation::Call(callee, _) => {
                let need = &mut needs[callee.0 as usize];
                need.called = true;
                need.loops = need.loops.max(loops);
                need.copies = need.copies.saturating_add(copies);
            }
            Operation::Fold(fold) => {
                for part in [Some(fold.body), fold.condition].into_iter().flatten() {
                    let need = &mut needs[part.0 as usize];
                    need.folded = true;
                    need.loops = need.loops.max(loops + 1);
                }
            }
            _ => {}
        }
    }
}

/// How deep folds nest in each function once all single expressions are taken over.
fn nests(graph: &Graph) -> Vec<u32> {
    let mut nests: Vec<u32> = Vec::with_capacity(graph.functions.len());
    for function in &graph.functions {
        let nest = function.values.iter().map(|operation| match operation {
            Operation::Call(callee, _) if graph.function(*callee).inline => nests[callee.0 as usize],
            Operation::Fold(fold) => {
                let parts = [Some(fold.body), fold.condition].into_iter().flatten();
                1 + parts.map(|part| nests[part.0 as usize]).max().unwrap_or(0)
            }
            _ => 0,
        });
        let nest = nest.max().unwrap_or(0);
        nests.push(nest);
    }
    nests
}
