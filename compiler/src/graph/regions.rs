//! Where each value of a function has to stand: at its top, or in an arm of a branch.
//!
//! A [`Region`] is a block of the emitted text. A value stands in the innermost one that all its
//! uses share, so what only one arm of an `if` needs is computed in that arm only. Not every `if`
//! has arms: it becomes a *branch* where an arm holds a sample, a texel fetch, a fold or a call of a
//! function that does; any other computes both and selects.
//!
//! Choices by one condition share one branch (a *group*). A choice joins the group that an earlier
//! one began if both its arms come before that one: then it can't depend on the group.
//!
//! Users are met before operands, once with all groups as branches, to see which of them hold
//! something heavy, and once with those alone. Blocks nest [`MAX_DEPTH`] deep, so finding what two
//! regions share takes no longer than that, and the whole is linear.

use super::{Function, FunctionId, Graph, Operation, Value};
use crate::input::is_per_draw;
use rustc_hash::FxHashMap;

/// Blocks inside each other at most, loops among them; choices that are deeper select.
pub const MAX_DEPTH: u32 = 32;

/// What placing has to know of the functions of a graph.
#[derive(Default)]
pub struct Weights {
    heavy: Vec<bool>,
    loops: Vec<u32>,
}

impl Weights {
    /// Looks at every function once, callees first.
    pub fn of(graph: &Graph) -> Weights {
        let mut weights = Weights::default();
        graph.functions.iter().for_each(|function| weights.add(function));
        weights
    }

    /// Looks at one more function, whose callees have been looked at.
    pub fn add(&mut self, function: &Function) {
        let heavy = function.values.iter().any(|operation| self.is_heavy(operation));
        self.heavy.push(heavy);
        self.loops.push(self.loops_in(function));
    }

    /// Whether an operation is worth a branch: a sample, a fetch, a fold, or a call of a function
    /// that holds one.
    pub fn is_heavy(&self, operation: &Operation) -> bool {
        match operation {
            Operation::Sample { .. } | Operation::Texel { .. } | Operation::Fold(_) => true,
            Operation::Call(callee, _) => self.heavy.get(callee.0 as usize).copied().unwrap_or(false),
            _ => false,
        }
    }

    /// How deep the blocks of a function's loops nest; what it calls stands elsewhere and does not
    /// count.
    pub fn loops(&self, function: FunctionId) -> u32 {
        self.loops.get(function.0 as usize).copied().unwrap_or(0)
    }

    fn loops_in(&self, function: &Function) -> u32 {
        function.values.iter().map(|operation| self.loops_of(operation)).max().unwrap_or(0)
    }

    /// How deep the blocks of an operation's loops nest, its own included.
    pub fn loops_of(&self, operation: &Operation) -> u32 {
        match operation {
            Operation::Fold(fold) => {
                let inner = fold.functions().map(|part| self.loops(part)).max();
                // At least the block that ends the loop.
                1 + inner.unwrap_or(0).max(1)
            }
            _ => 0,
        }
    }
}

/// A block: the top of a function or an arm of a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Region(u32);

impl Region {
    /// The top of the function.
    pub const TOP: Region = Region(0);
}

/// One `if` of the emitted text, with all the choices that it makes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Branch {
    /// What decides.
    pub condition: Value,
    /// The blocks of what holds and of what does not.
    pub arms: [Region; 2],
    /// The choices, in arena order. The branch stands where the first stands, and so do all.
    pub choices: Vec<Value>,
}

/// The regions of one function, and what stands in them.
pub struct Regions {
    blocks: Vec<Block>,
    places: Vec<Option<Region>>,
    branches: Vec<Branch>,
    /// For each choice of a branch which one.
    branch_of: FxHashMap<Value, usize>,
}

/// A region with what it is inside of.
struct Block {
    parent: Region,
    depth: u32,
    /// In arena order; of a branch's choices only the first.
    values: Vec<Value>,
}

impl Regions {
    /// The regions of a function whose text stands by itself.
    pub fn of(function: &Function, weights: &Weights) -> Regions {
        Regions::inside(function, weights, 0, &[])
    }

    /// The regions of a function whose text begins `depth` blocks deep. The values marked in
    /// `first` (by index, operands of marked ones marked too) stand at the top whoever uses them.
    pub fn inside(function: &Function, weights: &Weights, depth: u32, first: &[bool]) -> Regions {
        let live = live(function);
        if !function.values.iter().any(|operation| weights.is_heavy(operation)) {
            return Regions::one(depth, live);
        }
        let mut placing = Placing {
            function,
            first,
            live: &live,
            groups: Groups::of(function, |value| live[value.0 as usize] && !is_marked(first, value)),
            deepest: MAX_DEPTH.saturating_sub(weights.loops_in(function)),
            blocks: Vec::new(),
            places: Vec::new(),
        };
        if placing.groups.all.is_empty() {
            return Regions::one(depth, live);
        }
        placing.place(depth);
        placing.keep_heavy(weights);
        placing.place(depth);
        placing.finish()
    }

    /// A function without branches: all that is live stands at the top.
    fn one(depth: u32, live: Vec<bool>) -> Regions {
        let values = (0..).map(Value).zip(&live).filter(|(_, live)| **live).map(|(value, _)| value).collect();
        Regions {
            blocks: vec![Block { parent: Region::TOP, depth, values }],
            places: live.into_iter().map(|live| live.then_some(Region::TOP)).collect(),
            branches: Vec::new(),
            branch_of: FxHashMap::default(),
        }
    }

    /// Where a value stands; none if nothing needs it.
    pub fn place(&self, value: Value) -> Option<Region> {
        self.places.get(value.0 as usize).copied().flatten()
    }

    /// Whether a value is computed whenever the function is.
    pub fn is_at_top(&self, value: Value) -> bool {
        self.place(value) == Some(Region::TOP)
    }

    /// How many blocks are around what stands in a region.
    pub fn depth(&self, region: Region) -> u32 {
        self.blocks[region.0 as usize].depth
    }

    /// What stands right in a region, operands first. A branch is there as the first of its
    /// choices.
    pub fn values(&self, region: Region) -> &[Value] {
        &self.blocks[region.0 as usize].values
    }

    /// All branches, those inside others before them.
    pub fn branches(&self) -> &[Branch] {
        &self.branches
    }

    /// The branch that makes a choice; none for one that selects.
    pub fn branch(&self, choice: Value) -> Option<&Branch> {
        self.branches.get(*self.branch_of.get(&choice)?)
    }
}

/// Which values an output needs.
fn live(function: &Function) -> Vec<bool> {
    let mut live = vec![false; function.values.len()];
    function.outputs.iter().for_each(|(_, value)| live[value.0 as usize] = true);
    for (value, operation) in function.iter().rev() {
        if live[value.0 as usize] {
            operation.for_operands(|v| live[v.0 as usize] = true);
        }
    }
    live
}

/// Which values of an entry depend on nothing but params, inputs that are the same for a draw, and
/// numbers. They stand before all others. What is worth a branch stays where it is needed.
pub fn draw_rate(entry: &Function, weights: &Weights) -> Vec<bool> {
    let mut draw: Vec<bool> = Vec::with_capacity(entry.values.len());
    for operation in &entry.values {
        let mut all = !weights.is_heavy(operation);
        operation.for_operands(|v| all &= draw[v.0 as usize]);
        draw.push(match operation {
            Operation::Input(i) => entry.inputs.get(*i as usize).is_some_and(|slot| is_per_draw(&slot.name)),
            Operation::Derivative(..) => false,
            _ => all,
        });
    }
    draw
}

fn is_marked(marked: &[bool], value: Value) -> bool {
    marked.get(value.0 as usize).copied().unwrap_or(false)
}

/// Choices by one condition that could share a branch.
struct Group {
    condition: Value,
    /// In arena order.
    choices: Vec<Value>,
    /// Whether it is a branch: all of them at first.
    branches: bool,
    /// The region that all its choices share, as far as they have been met.
    parent: Option<Region>,
    arms: Option<[Region; 2]>,
}

struct Groups {
    all: Vec<Group>,
    /// The group of each value, if it is a choice.
    of: Vec<Option<usize>>,
}

impl Groups {
    fn of(function: &Function, belongs: impl Fn(Value) -> bool) -> Groups {
        let mut groups = Groups { all: Vec::new(), of: vec![None; function.values.len()] };
        let mut latest: FxHashMap<Value, usize> = FxHashMap::default();
        for (value, operation) in function.iter().filter(|(value, _)| belongs(*value)) {
            let Operation::Select(condition, yes, no) = operation else { continue };
            let joined = latest.get(condition).copied().filter(|group| {
                let first = groups.all[*group].choices[0];
                *yes < first && *no < first
            });
            let group = joined.unwrap_or(groups.all.len());
            match groups.all.get_mut(group) {
                Some(group) => group.choices.push(value),
                None => groups.all.push(Group::new(*condition, value)),
            }
            latest.insert(*condition, group);
            groups.of[value.0 as usize] = Some(group);
        }
        groups
    }
}

impl Group {
    fn new(condition: Value, first: Value) -> Group {
        Group { condition, choices: vec![first], branches: true, parent: None, arms: None }
    }
}

/// Regions in the making.
struct Placing<'a> {
    function: &'a Function,
    first: &'a [bool],
    live: &'a [bool],
    groups: Groups,
    /// The depth of an arm at most.
    deepest: u32,
    blocks: Vec<Block>,
    places: Vec<Option<Region>>,
}

impl Placing<'_> {
    /// Places all values, users before operands.
    fn place(&mut self, depth: u32) {
        let function = self.function;
        self.blocks = vec![Block { parent: Region::TOP, depth, values: Vec::new() }];
        self.places = vec![None; function.values.len()];
        function.outputs.iter().for_each(|(_, value)| self.uses(*value, Region::TOP));
        for (value, operation) in function.iter().rev() {
            if self.stands_first(value, operation) && self.live[value.0 as usize] {
                self.uses(value, Region::TOP);
            }
            let Some(here) = self.places[value.0 as usize] else { continue };
            match self.groups.of[value.0 as usize].filter(|group| self.groups.all[*group].branches) {
                Some(group) => self.choice(group, value, here),
                None => operation.for_operands(|operand| self.uses(operand, here)),
            }
        }
    }

    /// What a function starts with is not worth moving; a derivative has to be taken by all pixels.
    fn stands_first(&self, value: Value, operation: &Operation) -> bool {
        let leaf = matches!(
            operation,
            Operation::Input(_)
                | Operation::Constant(_)
                | Operation::Param(_)
                | Operation::View(_)
                | Operation::Derivative(..)
        );
        leaf || is_marked(self.first, value)
    }

    /// Notes that a value is used in a region.
    fn uses(&mut self, value: Value, region: Region) {
        let known = self.places[value.0 as usize];
        self.places[value.0 as usize] = Some(known.map_or(region, |known| self.shared(known, region)));
    }

    /// The innermost region that two are in.
    fn shared(&self, mut a: Region, mut b: Region) -> Region {
        while a != b {
            let (x, y) = (&self.blocks[a.0 as usize], &self.blocks[b.0 as usize]);
            match x.depth.cmp(&y.depth) {
                std::cmp::Ordering::Greater => a = x.parent,
                std::cmp::Ordering::Less => b = y.parent,
                std::cmp::Ordering::Equal => (a, b) = (x.parent, y.parent),
            }
        }
        a
    }

    /// A choice of a branch: the first of them, met last, knows where the branch stands.
    fn choice(&mut self, group: usize, value: Value, here: Region) {
        let parent = self.groups.all[group].parent.map_or(here, |parent| self.shared(parent, here));
        self.groups.all[group].parent = Some(parent);
        if self.groups.all[group].choices[0] != value {
            return;
        }
        let choices = self.groups.all[group].choices.clone();
        let depth = self.blocks[parent.0 as usize].depth + 1;
        if depth > self.deepest {
            self.groups.all[group].branches = false;
            for choice in choices {
                let here = self.places[choice.0 as usize].unwrap_or(parent);
                self.function.operation(choice).for_operands(|operand| self.uses(operand, here));
            }
            return;
        }
        let arms = [self.open(parent, depth), self.open(parent, depth)];
        self.groups.all[group].arms = Some(arms);
        self.uses(self.groups.all[group].condition, parent);
        for choice in choices {
            self.places[choice.0 as usize] = Some(parent);
            if let Operation::Select(_, yes, no) = self.function.operation(choice) {
                self.uses(*yes, arms[0]);
                self.uses(*no, arms[1]);
            }
        }
    }

    fn open(&mut self, parent: Region, depth: u32) -> Region {
        self.blocks.push(Block { parent, depth, values: Vec::new() });
        Region(self.blocks.len() as u32 - 1)
    }

    /// Leaves only the branches that hold something heavy.
    fn keep_heavy(&mut self, weights: &Weights) {
        let mut holds = vec![false; self.blocks.len()];
        for (value, operation) in self.function.iter() {
            if let Some(place) = self.places[value.0 as usize] {
                holds[place.0 as usize] |= weights.is_heavy(operation);
            }
        }
        // Inner regions are opened after what they are inside of.
        for region in (1..self.blocks.len()).rev() {
            holds[self.blocks[region].parent.0 as usize] |= holds[region];
        }
        for group in &mut self.groups.all {
            let arms = group.arms.take();
            group.branches = arms.is_some_and(|arms| arms.iter().any(|arm| holds[arm.0 as usize]));
            group.parent = None;
        }
    }

    /// Sorts the values into their regions.
    fn finish(mut self) -> Regions {
        let mut branches = Vec::new();
        let mut branch_of = FxHashMap::default();
        for group in self.groups.all {
            if let Some(arms) = group.arms {
                branch_of.extend(group.choices.iter().map(|choice| (*choice, branches.len())));
                branches.push(Branch { condition: group.condition, arms, choices: group.choices });
            }
        }
        for (value, place) in (0..).map(Value).zip(&self.places) {
            let branch = branch_of.get(&value).map(|branch| &branches[*branch]);
            if let Some(place) = place
                && branch.is_none_or(|branch| branch.choices[0] == value)
            {
                self.blocks[place.0 as usize].values.push(value);
            }
        }
        Regions { blocks: self.blocks, places: self.places, branches, branch_of }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Builder, Constant, Fold, Level, Texel, Type, View, ViewDimension, ViewId};
    use super::*;
    use crate::intrinsic::{ADD, LESS};

    const SCALAR: Type = Type::FLOAT;

    /// A function in the making, with an input `x` and a picture to sample.
    struct Test {
        b: Builder,
        x: Value,
        picture: Value,
    }

    impl Test {
        fn new() -> Test {
            let mut b = Builder::new("test");
            let x = b.input("x", SCALAR);
            let view = View { dimension: ViewDimension::D2, texel: Texel::Sampled, anisotropy: 1 };
            let picture = b.push(Operation::View(ViewId(0)), Type::View(view));
            Test { b, x, picture }
        }

        /// A value that nothing else is equal to.
        fn number(&mut self, n: i32) -> Value {
            let n = self.b.constant(Constant::floats(&[n as f32]));
            self.b.builtin(ADD, &[self.x, n])
        }

        /// `x < n`
        fn test(&mut self, n: i32) -> Value {
            let n = self.b.constant(Constant::floats(&[n as f32]));
            self.b.builtin(LESS, &[self.x, n])
        }

        /// One component of a sample at `x`.
        fn sample(&mut self, x: Value) -> Value {
            let at = self.b.compose(&[x, x]);
            let level = self.b.constant(Constant::floats(&[0.0]));
            let color = self.b.sample(self.picture, at, None, Level::Level(level));
            self.b.extract(color, 0)
        }

        fn regions(self, outputs: &[Value]) -> (Function, Regions) {
            let Test { mut b, .. } = self;
            outputs.iter().for_each(|value| b.output("out", *value));
            let function = b.finish();
            let graph = Graph { functions: vec![function.clone()], ..Graph::default() };
            let regions = Regions::of(&function, &Weights::of(&graph));
            (function, regions)
        }
    }

    #[test]
    fn an_arm_that_samples_is_a_branch_and_holds_all_it_alone_needs() {
        let mut t = Test::new();
        let (c, far) = (t.test(1), t.number(3));
        let sample = t.sample(far);
        let light = t.number(4);
        let choice = t.b.select(c, sample, light);
        let (_, regions) = t.regions(&[choice]);
        let branch = regions.branch(choice).expect("it branches");
        assert_eq!((branch.condition, branch.choices.as_slice()), (c, [choice].as_slice()));
        let [yes, no] = branch.arms;
        assert!([far, sample].iter().all(|v| regions.place(*v) == Some(yes)));
        assert_eq!(regions.place(light), Some(no));
        assert!(regions.is_at_top(choice) && regions.is_at_top(c));
        assert_eq!((regions.depth(Region::TOP), regions.depth(yes)), (0, 1));
    }

    #[test]
    fn light_arms_select_and_what_others_use_stays_outside() {
        let mut t = Test::new();
        let (c, d) = (t.test(1), t.test(2));
        let light = (t.number(3), t.number(4));
        let selected = t.b.select(c, light.0, light.1);
        let sample = t.sample(light.0);
        // The sum needs the sample whatever is chosen: an arm would hold nothing.
        let shared = t.b.select(d, sample, light.1);
        let sum = t.b.builtin(ADD, &[shared, sample]);
        let (function, regions) = t.regions(&[sum, selected]);
        assert_eq!((regions.branch(selected), regions.branch(shared)), (None, None));
        assert!(function.iter().all(|(v, _)| regions.is_at_top(v)));
    }

    #[test]
    fn choices_on_one_condition_share_a_branch_unless_one_depends_on_the_other() {
        let mut t = Test::new();
        let c = t.test(1);
        let (far, near) = (t.number(3), t.number(4));
        let (a, b) = (t.sample(far), t.sample(near));
        let first = t.b.select(c, a, far);
        let second = t.b.select(c, b, near);
        let next = t.b.builtin(ADD, &[first, second]);
        let again = t.sample(next);
        let third = t.b.select(c, again, near);
        let (_, regions) = t.regions(&[second, third]);
        let branch = regions.branch(first).expect("it branches");
        assert_eq!(branch.choices, [first, second]);
        assert_eq!(regions.branch(second), Some(branch));
        let other = regions.branch(third).expect("it branches");
        assert_eq!(regions.place(again), Some(other.arms[0]));
        // The first choice is needed in the other branch alone, the second outside: both are made
        // where the second is needed.
        assert!(regions.is_at_top(first) && regions.is_at_top(second));
        assert_eq!(regions.place(next), Some(other.arms[0]));
        assert_eq!(regions.values(Region::TOP).iter().filter(|v| **v == second).count(), 0);
    }

    #[test]
    fn a_branch_in_an_arm_is_inside_it() {
        let mut t = Test::new();
        let (c, d, far) = (t.test(1), t.test(2), t.number(3));
        let sample = t.sample(far);
        let inner = t.b.select(d, sample, far);
        let zero = t.number(0);
        let outer = t.b.select(c, inner, zero);
        let (_, regions) = t.regions(&[outer]);
        let (outer, inner_branch) = (regions.branch(outer), regions.branch(inner));
        let (outer, inner_branch) = (outer.expect("it branches"), inner_branch.expect("it branches"));
        assert_eq!(regions.place(inner), Some(outer.arms[0]));
        assert_eq!(regions.place(d), Some(outer.arms[0]));
        assert_eq!(regions.place(far), Some(outer.arms[0]), "both inner arms need it");
        assert_eq!(regions.depth(inner_branch.arms[0]), 2);
    }

    #[test]
    fn calls_and_folds_are_as_heavy_as_what_they_hold() {
        let mut body = Builder::new("body");
        let sum = body.input("sum", SCALAR);
        body.input("i", Type::INT);
        body.output("sum", sum);
        let body = body.finish();
        let mut light = Builder::new("light");
        let x = light.input("x", SCALAR);
        light.output("y", x);
        let light = light.finish();
        let mut looping = Builder::new("looping");
        let x = looping.input("x", SCALAR);
        let steps = looping.constant(Constant::ints(&[9]));
        let fold = Fold {
            body: FunctionId(0),
            condition: None,
            starts: vec![x],
            steps,
            most: 9,
            captures: Vec::new(),
        };
        let total = looping.fold(fold)[0];
        looping.output("y", total);
        let looping = looping.finish();
        let mut b = Builder::new("entry");
        let x = b.input("x", SCALAR);
        let one = b.constant(Constant::floats(&[1.0]));
        let c = b.builtin(LESS, &[x, one]);
        let near = b.call(FunctionId(1), &light, vec![x])[0];
        let far = b.call(FunctionId(2), &looping, vec![x])[0];
        let heavy = b.select(c, far, x);
        let light_choice = b.select(c, near, one);
        b.output("heavy", heavy);
        b.output("light", light_choice);
        let other = b.builtin(LESS, &[one, x]);
        let alone = b.select(other, near, one);
        b.output("alone", alone);
        let graph = Graph { functions: vec![body, light, looping, b.finish()], ..Graph::default() };
        let weights = Weights::of(&graph);
        assert_eq!((0..4).map(|i| weights.loops(FunctionId(i))).collect::<Vec<_>>(), [0, 0, 2, 0]);
        let regions = Regions::of(&graph.functions[3], &weights);
        assert_eq!(regions.branch(heavy).map(|branch| branch.choices.len()), Some(2));
        assert_eq!(regions.branch(alone), None);
    }

    /// `if x < 0 { sample } else if x < 1 { sample } …`
    fn chain(length: i32) -> (Function, Regions, Vec<Value>) {
        let mut t = Test::new();
        let mut chosen = t.number(-1);
        let mut choices = Vec::new();
        for n in 0..length {
            let (c, far) = (t.test(n), t.number(n));
            let sample = t.sample(far);
            chosen = t.b.select(c, sample, chosen);
            choices.push(chosen);
        }
        let (function, regions) = t.regions(&[chosen]);
        (function, regions, choices)
    }

    #[test]
    fn blocks_nest_to_the_limit_and_no_deeper() {
        let (function, regions, choices) = chain(40);
        let branches: Vec<bool> = choices.iter().rev().map(|v| regions.branch(*v).is_some()).collect();
        assert!(branches[..32].iter().all(|b| *b) && !branches[32..].iter().any(|b| *b));
        let deepest = function.iter().filter_map(|(v, _)| regions.place(v)).map(|r| regions.depth(r)).max();
        assert_eq!(deepest, Some(MAX_DEPTH));
        let graph = Graph { functions: vec![function.clone()], ..Graph::default() };
        let inside = Regions::inside(&function, &Weights::of(&graph), 30, &[]);
        assert_eq!(choices.iter().filter(|v| inside.branch(**v).is_some()).count(), 2);
    }

    #[test]
    fn long_chains_take_no_longer_than_their_length() {
        let (function, regions, choices) = chain(100_000);
        assert_eq!(choices.iter().filter(|v| regions.branch(**v).is_some()).count(), 32);
        let placed: usize = (0..regions.blocks.len()).map(|i| regions.blocks[i].values.len()).sum();
        assert_eq!(placed, function.values.len());
    }

    #[test]
    fn marked_values_stand_at_the_top() {
        let mut t = Test::new();
        let (c, far) = (t.test(1), t.number(3));
        let more = t.number(7);
        let at = t.b.builtin(ADD, &[far, more]);
        let sample = t.sample(at);
        let choice = t.b.select(c, sample, t.x);
        t.b.output("out", choice);
        let function = t.b.finish();
        let graph = Graph { functions: vec![function.clone()], ..Graph::default() };
        let mut first = vec![false; function.values.len()];
        first[far.0 as usize] = true;
        let regions = Regions::inside(&function, &Weights::of(&graph), 0, &first);
        assert!(regions.is_at_top(far) && !regions.is_at_top(more) && !regions.is_at_top(at));
    }
}
