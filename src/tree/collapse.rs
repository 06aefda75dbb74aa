//! From two children to eight: which nodes of obvhs's tree stay, and what becomes a leaf.
//!
//! By the surface area heuristic: the expected cost of a walk is the sum over all nodes of their surface times what they
//! cost when they are met. The least of it, over all trees of eight children that keep boxes of the binary one, is found from
//! the leaves up (Ylitie, Karras and Laine 2017, §3): the cost of each subtree as a forest of at most 1 to 7 trees.

use super::space::Space;
use super::wide::{BLOCKS, EMPTY, Node, Numbers, leaf};
use super::{Bounds, Groups, built};
use obvhs::BvhBuildParams;
use obvhs::bvh2::{Bvh2, node::Bvh2Node};
use smallvec::SmallVec;

/// What a node costs, in blocks. It takes about as long as one; but blocks that are not full cost memory, and so time:
/// with 0.8 the tree takes 66 bytes a triangle, with 1.7 61, with 2.5 57, and is the faster the smaller it is.
const NODE: f32 = 2.5;

/// The tree over these boxes, its root, and what its blocks hold.
pub(super) fn collapse(space: &Space, boxes: &[Bounds]) -> (Vec<Node>, u32, Vec<Numbers>) {
    // Fours stay together in whatever comes below: blocks are fuller, and there is less to weigh.
    let params = BvhBuildParams {
        max_prims_per_leaf: 4,
        collapse_traversal_cost: 8.0,
        ..BvhBuildParams::medium_build()
    };
    let (built, groups) = built(space, boxes, params);
    let mut wide = Widened {
        built: &built,
        groups: &groups,
        sizes: vec![],
        costs: vec![],
        nodes: vec![],
        blocks: vec![],
    };
    wide.weigh();
    let root = wide.adopt();
    wide.nodes.shrink_to_fit();
    (wide.nodes, root, wide.blocks)
}

/// A tree on its way.
struct Widened<'a> {
    built: &'a Bvh2,
    groups: &'a Groups,
    // Items below each node of the binary tree.
    sizes: Vec<u32>,
    // What it costs as a forest of at most 1 to 7 trees.
    costs: Vec<[f32; 7]>,
    nodes: Vec<Node>,
    blocks: Vec<Numbers>,
}

/// Children of a node.
type Few = SmallVec<[u32; 8]>;

impl Widened<'_> {
    fn source(&self, node: u32) -> &Bvh2Node {
        &self.built.nodes[node as usize]
    }

    /// Sizes and costs, from the leaves up; with an explicit stack, since a tree may be as deep as it has items.
    fn weigh(&mut self) {
        let count = self.built.nodes.len();
        self.sizes = vec![0; count];
        self.costs = vec![[0.0; 7]; count];
        let mut down = Vec::with_capacity(count);
        let mut open = vec![0_u32];
        while let Some(node) = open.pop() {
            down.push(node);
            let source = self.source(node);
            if source.prim_count == 0 {
                open.extend([source.first_index, source.first_index + 1]);
            }
        }
        for node in down.into_iter().rev() {
            let source = *self.source(node);
            let first = source.first_index as usize;
            self.sizes[node as usize] = if source.prim_count > 0 {
                let groups = &self.built.primitive_indices[first..first + source.prim_count as usize];
                groups.iter().map(|group| self.groups.members(*group).len() as u32).sum()
            } else {
                self.sizes[first] + self.sizes[first + 1]
            };
            self.costs[node as usize] = self.weighed(node);
        }
    }

    fn weighed(&self, node: u32) -> [f32; 7] {
        let as_leaf = self.as_leaf(node);
        if self.source(node).prim_count > 0 {
            return [as_leaf; 7];
        }
        let first = self.source(node).first_index as usize;
        let (one, two) = (&self.costs[first], &self.costs[first + 1]);
        // By how many trees there are below it, less two.
        let mut shared = [f32::INFINITY; 7];
        for left in 0..7 {
            for right in 0..7 - left {
                shared[left + right] = shared[left + right].min(one[left] + two[right]);
            }
        }
        let mut costs = [as_leaf.min(NODE * self.source(node).aabb.half_area() + shared[6]); 7];
        for trees in 1..7 {
            costs[trees] = costs[trees - 1].min(shared[trees - 1]);
        }
        costs
    }

    /// The cost of a leaf of all that is below.
    fn as_leaf(&self, node: u32) -> f32 {
        let blocks = self.sizes[node as usize].div_ceil(4);
        let possible = blocks as usize <= BLOCKS || self.source(node).prim_count > 0;
        if possible { self.source(node).aabb.half_area() * blocks as f32 } else { f32::INFINITY }
    }

    /// How many of the cheapest `trees` trees below an inner node are the first child's.
    fn left_of(&self, node: u32, trees: usize) -> usize {
        let first = self.source(node).first_index as usize;
        let (one, two) = (&self.costs[first], &self.costs[first + 1]);
        let cost = |left: usize| one[left - 1] + two[trees - left - 1];
        (1..trees).reduce(|best, left| if cost(left) < cost(best) { left } else { best }).unwrap_or(1)
    }

    /// The nodes that become the children of this one.
    fn children(&self, node: u32) -> Few {
        let mut children = Few::new();
        let mut open: SmallVec<[(u32, usize); 8]> = SmallVec::new();
        open.push((node, 8));
        while let Some((at, mut trees)) = open.pop() {
            let costs = &self.costs[at as usize];
            while at != node && trees > 1 && costs[trees - 1] == costs[trees - 2] {
                trees -= 1;
            }
            if trees == 1 {
                children.push(at);
                continue;
            }
            let first = self.source(at).first_index;
            let left = self.left_of(at, trees);
            open.push((first + 1, trees - left));
            open.push((first, left));
        }
        children
    }

    /// Makes nodes and blocks of the cheapest tree. Returns the reference to its root.
    fn adopt(&mut self) -> u32 {
        let mut root = 0;
        // (obvhs's node, our parent and which child of it)
        let mut open = vec![(0_u32, None)];
        while let Some((node, parent)) = open.pop() {
            let is_leaf = self.costs[node as usize][0] == self.as_leaf(node);
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

    /// Gives a child the box of one of obvhs's nodes.
    fn put(&mut self, own: usize, lane: usize, node: u32) {
        let (lo, hi) = (self.source(node).aabb.min, self.source(node).aabb.max);
        for axis in 0..3 {
            self.nodes[own].sides[axis][0][lane] = lo[axis];
            self.nodes[own].sides[axis][1][lane] = hi[axis];
        }
    }

    /// A leaf of all that is below a node; of equal boxes there may be so many that they need nodes of their own.
    fn leaf(&mut self, node: u32) -> u32 {
        let mut items: SmallVec<[u32; 16]> = SmallVec::new();
        let mut open: SmallVec<[u32; 16]> = SmallVec::from_slice(&[node]);
        while let Some(at) = open.pop() {
            let source = self.source(at);
            let first = source.first_index as usize;
            if source.prim_count == 0 {
                open.extend([source.first_index + 1, source.first_index]);
                continue;
            }
            for group in &self.built.primitive_indices[first..first + source.prim_count as usize] {
                items.extend_from_slice(self.groups.members(*group));
            }
        }
        let begin = self.blocks.len();
        for four in items.chunks(4) {
            self.blocks.push(std::array::from_fn(|i| four.get(i).copied().unwrap_or(EMPTY)));
        }
        let end = self.blocks.len();
        let mut level: Vec<u32> =
            (begin..end).step_by(BLOCKS).map(|first| leaf(first, BLOCKS.min(end - first))).collect();
        while level.len() > 1 {
            level = level.chunks(8).map(|some| self.bundle(node, some)).collect();
        }
        level[0]
    }

    /// A node whose children all have the box of one of obvhs's.
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
