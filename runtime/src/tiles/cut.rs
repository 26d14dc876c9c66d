//! The minimum cut of a grid: which texels to take from which of two pictures.
//!
//! Texels are the nodes, neighbours are linked both ways, and a texel may be pulled to either side.
//! The cut of least cost is where the maximum flow from the first side to the second is full
//! (Kwatra et al. 2003, "Graphcut Textures"). The flow is found by blocking flows of shortest paths
//! (Dinic 1970), in integers, so the cut is exact and the same on every machine. Of several cuts of
//! one cost it is the one nearest to the first side.

use std::collections::VecDeque;

/// What holds a texel on its side: never cut.
pub const FIXED: u32 = u32::MAX;

/// The dearest link. Two directions of it must fit a word together.
pub const MAX_LINK: u32 = 1 << 30;

/// What it costs to put a texel on the other side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pull {
    /// Lost if the texel is on the second side.
    pub to_first: u32,
    /// Lost if the texel is on the first side.
    pub to_second: u32,
}

impl Pull {
    /// Only the first side.
    pub const FIRST: Pull = Pull { to_first: FIXED, to_second: 0 };
    /// Only the second side.
    pub const SECOND: Pull = Pull { to_first: 0, to_second: FIXED };
}

/// A minimum cut.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cut {
    /// Whether a texel is on the first side, row by row.
    pub is_first: Vec<bool>,
    /// What the cut links and pulls cost.
    pub cost: u64,
}

/// Texels to each side of a cut across which one picture fades into the other.
pub const FADE: usize = 2;

impl Cut {
    /// The share of the first picture in a texel of a grid of this size, 0..1: that of the first side
    /// in the square around it.
    pub fn share(&self, [width, height]: [usize; 2], [x, y]: [usize; 2]) -> f32 {
        let near = |at: usize, most: usize| at.saturating_sub(FADE)..(at + FADE + 1).min(most);
        let rows = near(y, height).flat_map(|y| near(x, width).map(move |x| y * width + x));
        let (first, all) = rows.fold((0u32, 0u32), |(first, all), node| {
            (first + u32::from(self.is_first.get(node).copied().unwrap_or(false)), all + 1)
        });
        first as f32 / all.max(1) as f32
    }
}

/// Cuts a grid of `width` × `height` texels. `link(a, b)` is what it costs to part the neighbours
/// with the indices a and b, at most [`MAX_LINK`].
pub fn minimum(size: [usize; 2], link: impl Fn(usize, usize) -> u32, pull: impl Fn(usize) -> Pull) -> Cut {
    let mut flow = Flow::new(size, link, pull);
    while flow.find_levels() {
        for root in 0..flow.level.len() {
            flow.push_from(root);
        }
    }
    // What can still be reached has a level.
    let is_reached = |node: usize| flow.level[node] != UNREACHED;
    Cut { is_first: texels(size).map(|(_, node)| is_reached(node)).collect(), cost: flow.total }
}

const UNREACHED: u32 = u32::MAX;

/// The directions of links: right, below, left, above. The opposite of d is d ^ 2.
const RIGHT: usize = 0;
const BELOW: usize = 1;

/// All texels of a grid with their nodes. Nodes have a margin of one around the grid, without links,
/// so that every texel has four neighbours.
fn texels([width, height]: [usize; 2]) -> impl Iterator<Item = (usize, usize)> {
    let node = move |texel: usize| (texel / width + 1) * (width + 2) + texel % width + 1;
    (0..width * height).map(move |texel| (texel, node(texel)))
}

struct Flow {
    /// Nodes from a row to the next.
    stride: usize,
    /// What the link to each neighbour still takes.
    room: Vec<[u32; 4]>,
    /// What still comes in from the first side, and goes out to the second.
    from_first: Vec<u32>,
    to_second: Vec<u32>,
    /// Links from the first side.
    level: Vec<u32>,
    /// The neighbour to be tried next.
    next: Vec<u8>,
    queue: VecDeque<usize>,
    /// The flow so far.
    total: u64,
}

impl Flow {
    fn new(size: [usize; 2], link: impl Fn(usize, usize) -> u32, pull: impl Fn(usize) -> Pull) -> Flow {
        let [width, height] = size;
        let count = (width + 2) * (height + 2);
        let mut flow = Flow {
            stride: width + 2,
            room: vec![[0; 4]; count],
            from_first: vec![0; count],
            to_second: vec![0; count],
            level: vec![UNREACHED; count],
            next: vec![0; count],
            queue: VecDeque::new(),
            total: 0,
        };
        for (texel, node) in texels(size) {
            flow.pull(node, pull(texel));
            if texel % width + 1 < width {
                flow.join(node, RIGHT, link(texel, texel + 1));
            }
            if texel + width < width * height {
                flow.join(node, BELOW, link(texel, texel + width));
            }
        }
        flow
    }

    /// What both sides pull goes straight through.
    fn pull(&mut self, node: usize, Pull { to_first, to_second }: Pull) {
        let through = to_first.min(to_second);
        self.total += u64::from(through);
        self.from_first[node] = if to_first == FIXED { FIXED } else { to_first - through };
        self.to_second[node] = if to_second == FIXED { FIXED } else { to_second - through };
    }

    fn join(&mut self, node: usize, direction: usize, cost: u32) {
        let other = self.neighbour(node, direction);
        self.room[node][direction] = cost.min(MAX_LINK);
        self.room[other][direction ^ 2] = cost.min(MAX_LINK);
    }

    /// The neighbour of a texel; of a node in the margin no one asks.
    fn neighbour(&self, node: usize, direction: usize) -> usize {
        match direction {
            RIGHT => node + 1,
            BELOW => node + self.stride,
            2 => node - 1,
            _ => node - self.stride,
        }
    }

    /// Finds how far each texel is from the first side; whether the second side can be reached.
    fn find_levels(&mut self) -> bool {
        self.level.fill(UNREACHED);
        self.next.fill(0);
        self.queue.clear();
        for root in 0..self.level.len() {
            if self.from_first[root] > 0 {
                self.level[root] = 0;
                self.queue.push_back(root);
            }
        }
        let mut is_reached = false;
        while let Some(node) = self.queue.pop_front() {
            // Nothing beyond: a path ends here.
            if self.to_second[node] > 0 {
                is_reached = true;
                continue;
            }
            for direction in 0..4 {
                if self.room[node][direction] == 0 {
                    continue;
                }
                let other = self.neighbour(node, direction);
                if self.level[other] == UNREACHED {
                    self.level[other] = self.level[node] + 1;
                    self.queue.push_back(other);
                }
            }
        }
        is_reached
    }

    /// Pushes all that fits along paths of rising levels from a texel of the first side.
    fn push_from(&mut self, root: usize) {
        let mut path: Vec<(usize, usize)> = Vec::new();
        let mut node = root;
        while self.from_first[root] > 0 {
            if self.to_second[node] > 0 {
                node = self.augment(root, &mut path, node);
            } else if let Some((direction, other)) = self.step(node) {
                path.push((node, direction));
                node = other;
            } else {
                // A dead end: its predecessor tries the next neighbour.
                let Some((last, _)) = path.pop() else { return };
                self.next[last] += 1;
                node = last;
            }
        }
    }

    /// The next step to a higher level that has room.
    fn step(&mut self, node: usize) -> Option<(usize, usize)> {
        while self.next[node] < 4 {
            let direction = usize::from(self.next[node]);
            if self.room[node][direction] > 0 {
                let other = self.neighbour(node, direction);
                if self.level[other] == self.level[node].saturating_add(1) {
                    return Some((direction, other));
                }
            }
            self.next[node] += 1;
        }
        None
    }

    /// Pushes along a whole path and goes back to where it is full first.
    fn augment(&mut self, root: usize, path: &mut Vec<(usize, usize)>, end: usize) -> usize {
        let room = path.iter().map(|(node, direction)| self.room[*node][*direction]).min();
        let amount = room.unwrap_or(FIXED).min(self.from_first[root]).min(self.to_second[end]);
        self.total += u64::from(amount);
        for pulled in [&mut self.from_first[root], &mut self.to_second[end]] {
            if *pulled != FIXED {
                *pulled -= amount;
            }
        }
        let mut full = path.len();
        for (i, (node, direction)) in path.iter().copied().enumerate().rev() {
            let other = self.neighbour(node, direction);
            self.room[node][direction] -= amount;
            self.room[other][direction ^ 2] += amount;
            if self.room[node][direction] == 0 {
                full = i;
            }
        }
        let node = path.get(full).map_or(end, |(node, _)| *node);
        path.truncate(full);
        node
    }
}

#[cfg(test)]
mod tests {
    use super::{Cut, FIXED, Pull, minimum};
    use crate::tiles::random;

    const SIZE: [usize; 2] = [4, 3];

    /// What parting the texels so costs.
    fn cost(is_first: &[bool], link: &dyn Fn(usize, usize) -> u32, pull: &dyn Fn(usize) -> Pull) -> u64 {
        let parted = |a: usize, b: usize| if is_first[a] == is_first[b] { 0 } else { u64::from(link(a, b)) };
        let mut sum = 0;
        for (node, is_first_here) in is_first.iter().enumerate() {
            let Pull { to_first, to_second } = pull(node);
            sum += u64::from(if *is_first_here { to_second } else { to_first });
            if node % SIZE[0] + 1 < SIZE[0] {
                sum += parted(node, node + 1);
            }
            if node + SIZE[0] < SIZE[0] * SIZE[1] {
                sum += parted(node, node + SIZE[0]);
            }
        }
        sum
    }

    #[test]
    fn no_other_cut_of_a_small_grid_is_cheaper() {
        let count = SIZE[0] * SIZE[1];
        for seed in 0..60 {
            let link = |a: usize, b: usize| random::at([a as u32, b as u32], seed)[0] % 10;
            let pull = |node: usize| match (random::at([node as u32, 99], seed)[1] % 6, node) {
                (_, 0) => Pull::FIRST,
                (0, _) => Pull { to_first: 4, to_second: 1 },
                (1, _) => Pull { to_first: 0, to_second: 7 },
                (2, _) if node > 6 => Pull::SECOND,
                _ => Pull::default(),
            };
            let Cut { is_first, cost: found } = minimum(SIZE, link, pull);
            assert_eq!(found, cost(&is_first, &link, &pull), "seed {seed}");
            let least = (0..1u32 << count)
                .map(|bits| cost(&(0..count).map(|i| bits >> i & 1 == 1).collect::<Vec<_>>(), &link, &pull))
                .min();
            assert_eq!(Some(found), least, "seed {seed}");
            assert!(found < u64::from(FIXED), "nothing fixed is cut");
        }
    }

    #[test]
    fn a_cut_follows_the_cheap_links() {
        // Column 2 is cheap to leave at its right.
        let link = |a: usize, b: usize| if a % 5 == 2 && b == a + 1 { 1 } else { 50 };
        let cut = minimum([5, 4], link, |node| match node % 5 {
            0 => Pull::FIRST,
            4 => Pull::SECOND,
            _ => Pull::default(),
        });
        assert_eq!(cut.cost, 4);
        assert!((0..20).all(|node| cut.is_first[node] == (node % 5 <= 2)));
        let shares = [0, 1, 2, 3, 4].map(|x| cut.share([5, 4], [x, 1]));
        assert_eq!(shares, [1.0, 0.75, 0.6, 0.5, 1.0 / 3.0], "it fades over two texels to each side");
    }
}
