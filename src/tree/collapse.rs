//! From two children to eight: which nodes of obvhs's tree stay, and what becomes a leaf.
//!
//! By the surface area heuristic: the expected cost of a walk is the sum over all nodes of their surface times what they
//! cost when they are met. The least of it, over all trees of eight children that keep boxes of the binary one, is found from
//! the leaves up (Ylitie, Karras and Laine 2017, §3): the cost of each subtree as a forest of at most 1 to 7 trees.

use super::space::Space;
use super::wide::{BLOCKS, EMPTY, Node, Numbers, leaf};
use super::{Bounds, Groups, built};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, node::Bvh2Node};
use smallvec::SmallVec;
use std::array::from_fn;

/// What a node costs, in blocks. It takes about as long as one; but blocks that are not full cost memory, and so time:
/// with 0.8 the tree takes 66 bytes a triangle, with 1.7 61, with 2.5 57, and is the faster the smaller it is.
const NODE: f32 = 2.5;

/// Down to here the binary tree is taken over by several threads.
const TURNS: u32 = 6;

/// The tree over these boxes, its root, and what its blocks hold.
pub(super) fn collapse(
    space: &Space,
    count: usize,
    of: impl Fn(usize) -> Bounds + Sync + Send,
) -> (Vec<Node>, u32, Vec<Numbers>) {
    // Fours stay together in whatever comes below: blocks are fuller, and there is less to weigh. (obvhs's `medium_build` takes a
    // third longer, for walks that cost half a hundredth less.)
    let params = BvhBuildParams {
        max_prims_per_leaf: 4,
        collapse_traversal_cost: 8.0,
        ..BvhBuildParams::fast_build()
    };
    let (built, groups) = built(space, count, of, params);
    let mut wide = Widened::default().lay((&built, &groups), 0, TURNS);
    drop((built, groups));
    wide.weigh();
    let root = wide.adopt();
    wide.nodes.shrink_to_fit();
    (wide.nodes, root, wide.blocks)
}

/// A node of the binary tree.
struct Laid {
    aabb: Aabb,
    // How much further on its second child is; the first one follows it. Zero for a leaf.
    second: u32,
    // How many items are below.
    items: u32,
    // What it costs as a forest of at most 1 to 7 trees.
    costs: [f32; 7],
}

/// A tree on its way.
#[derive(Default)]
struct Widened {
    // The binary tree and its items in the order of a walk, so that what is near in it is near in memory.
    laid: Vec<Laid>,
    items: Vec<u32>,
    // How many of them are in blocks.
    told: usize,
    nodes: Vec<Node>,
    blocks: Vec<Numbers>,
}

/// Children of a node.
type Few = SmallVec<[u32; 8]>;

impl Widened {
    /// Takes over what is below one of obvhs's nodes, after what is there. The first turns part the work among threads.
    fn lay(mut self, from: (&Bvh2, &Groups), node: u32, turns: u32) -> Self {
        let Bvh2Node { aabb, prim_count, first_index, .. } = from.0.nodes[node as usize];
        if turns == 0 || prim_count > 0 {
            self.lay_all(from, node);
            return self;
        }
        let own = self.laid.len();
        self.laid.push(Laid { aabb, second: 0, items: 0, costs: [0.0; 7] });
        let (mut one, mut two) = rayon::join(
            || self.lay(from, first_index, turns - 1),
            || Self::default().lay(from, first_index + 1, turns - 1),
        );
        one.laid[own].second = (one.laid.len() - own) as u32;
        one.laid.append(&mut two.laid);
        one.items.append(&mut two.items);
        one
    }

    /// The same on one thread; with an explicit stack, since a tree may be as deep as it has items.
    fn lay_all(&mut self, (built, groups): (&Bvh2, &Groups), root: u32) {
        // (obvhs's node, whose second child it is)
        let mut open: Vec<(u32, Option<usize>)> = vec![(root, None)];
        while let Some((node, second_of)) = open.pop() {
            let own = self.laid.len();
            if let Some(parent) = second_of {
                self.laid[parent].second = (own - parent) as u32;
            }
            let Bvh2Node { aabb, prim_count, first_index, .. } = built.nodes[node as usize];
            let before = self.items.len();
            if prim_count > 0 {
                let first = first_index as usize;
                for group in &built.primitive_indices[first..first + prim_count as usize] {
                    self.items.extend_from_slice(groups.members(*group));
                }
            } else {
                open.extend([(first_index + 1, Some(own)), (first_index, None)]);
            }
            let items = (self.items.len() - before) as u32;
            self.laid.push(Laid { aabb, second: 0, items, costs: [0.0; 7] });
        }
    }

    fn at(&self, node: u32) -> &Laid {
        &self.laid[node as usize]
    }

    /// The children of an inner node of the binary tree.
    fn two(&self, node: u32) -> [u32; 2] {
        [node + 1, node + self.at(node).second]
    }

    /// Sizes and costs, from the leaves up.
    fn weigh(&mut self) {
        for node in (0..self.laid.len() as u32).rev() {
            if self.at(node).second > 0 {
                self.laid[node as usize].items =
                    self.two(node).map(|child| self.at(child).items).iter().sum();
            }
            self.laid[node as usize].costs = self.weighed(node);
        }
    }

    fn weighed(&self, node: u32) -> [f32; 7] {
        let as_leaf = self.as_leaf(node);
        if self.at(node).second == 0 {
            return [as_leaf; 7];
        }
        let [one, two] = self.two(node).map(|child| &self.at(child).costs);
        // By how many trees there are below it, less two.
        let mut shared = [f32::INFINITY; 7];
        for left in 0..7 {
            for right in 0..7 - left {
                shared[left + right] = shared[left + right].min(one[left] + two[right]);
            }
        }
        let mut costs = [as_leaf.min(NODE * self.at(node).aabb.half_area() + shared[6]); 7];
        for trees in 1..7 {
            costs[trees] = costs[trees - 1].min(shared[trees - 1]);
        }
        costs
    }

    /// The cost of a leaf of all that is below.
    fn as_leaf(&self, node: u32) -> f32 {
        let Laid { aabb, second, items, .. } = self.at(node);
        let blocks = items.div_ceil(4);
        let possible = blocks as usize <= BLOCKS || *second == 0;
        if possible { aabb.half_area() * blocks as f32 } else { f32::INFINITY }
    }

    /// How many of the cheapest `trees` trees below an inner node are the first child's.
    fn left_of(&self, node: u32, trees: usize) -> usize {
        let [one, two] = self.two(node).map(|child| &self.at(child).costs);
        let cost = |left: usize| one[left - 1] + two[trees - left - 1];
        (1..trees).reduce(|best, left| if cost(left) < cost(best) { left } else { best }).unwrap_or(1)
    }

    /// The nodes that become the children of this one.
    fn children(&self, node: u32) -> Few {
        let mut children = Few::new();
        let mut open: SmallVec<[(u32, usize); 8]> = SmallVec::new();
        open.push((node, 8));
        while let Some((at, mut trees)) = open.pop() {
            let costs = &self.at(at).costs;
            while at != node && trees > 1 && costs[trees - 1] == costs[trees - 2] {
                trees -= 1;
            }
            if trees == 1 {
                children.push(at);
                continue;
            }
            let [one, two] = self.two(at);
            let left = self.left_of(at, trees);
            open.push((two, trees - left));
            open.push((one, left));
        }
        children
    }

    /// Makes nodes and blocks of the cheapest tree. Returns the reference to its root.
    fn adopt(&mut self) -> u32 {
        let mut root = 0;
        // (a node of the binary tree, our parent and which child of it)
        let mut open = vec![(0_u32, None)];
        while let Some((node, parent)) = open.pop() {
            let is_leaf = self.at(node).costs[0] == self.as_leaf(node);
            let own = if is_leaf {
                self.leaf(node)
            } else {
                let own = self.nodes.len();
                self.nodes.push(Node::EMPTY);
                for (lane, child) in self.children(node).into_iter().enumerate().rev() {
                    self.put(own, lane, child);
                    open.push((child, Some((own, lane))));
                }
                own as u32
            };
            match parent {
                Some((parent, lane)) => self.nodes[parent].child[lane] = own,
                None => root = own,
            }
        }
        root
    }

    /// Gives a child the box of a node of the binary tree.
    fn put(&mut self, own: usize, lane: usize, node: u32) {
        let Aabb { min: lo, max: hi } = self.at(node).aabb;
        for axis in 0..3 {
            self.nodes[own].sides[axis][0][lane] = lo[axis];
            self.nodes[own].sides[axis][1][lane] = hi[axis];
        }
    }

    /// A leaf of all that is below a node, which are the next items; of equal boxes there may be so many that they need
    /// nodes of their own.
    fn leaf(&mut self, node: u32) -> u32 {
        let begin = self.blocks.len();
        let items = &self.items[self.told..][..self.at(node).items as usize];
        let blocks = items.chunks(4).map(|four| from_fn(|i| four.get(i).copied().unwrap_or(EMPTY)));
        self.blocks.extend(blocks);
        self.told += items.len();
        let end = self.blocks.len();
        let mut level: Vec<u32> =
            (begin..end).step_by(BLOCKS).map(|first| leaf(first, BLOCKS.min(end - first))).collect();
        while level.len() > 1 {
            level = level.chunks(8).map(|some| self.bundle(node, some)).collect();
        }
        level[0]
    }

    /// A node whose children all have the box of one of the binary tree's.
    fn bundle(&mut self, node: u32, children: &[u32]) -> u32 {
        let own = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        for (lane, child) in children.iter().enumerate() {
            self.put(own, lane, node);
            self.nodes[own].child[lane] = *child;
        }
        own as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn several_threads_lay_a_tree_as_one_does() {
        let place = |i: usize, ratio: f64| (i as f64 * ratio).fract();
        // Every seventh is there twice.
        let of = |i: usize| {
            let i = if i.is_multiple_of(7) { i + 1 } else { i };
            let lo = DVec3::new(place(i, 0.618_034), place(i, 0.754_878), place(i, 0.569_84));
            Bounds { lo, hi: lo + 0.01 }
        };
        let space = Space::around(5_000, of);
        let (built, groups) = built(&space, 5_000, of, BvhBuildParams::medium_build());
        let lay = |turns| Widened::default().lay((&built, &groups), 0, turns);
        let one = lay(0);
        assert_eq!(one.items.len(), 5_000);
        for turns in [1, 6, 40] {
            let several = lay(turns);
            let nodes = |tree: &Widened| -> Vec<_> {
                tree.laid.iter().map(|node| (node.aabb.min, node.aabb.max, node.second, node.items)).collect()
            };
            assert_eq!(nodes(&several), nodes(&one));
            assert_eq!(several.items, one.items);
        }
    }
}
