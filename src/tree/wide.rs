//! A tree of eight children, with what it holds in blocks of four: the binary one, collapsed.
//!
//! It is walked as the binary one is, by the same arithmetic on the same boxes, eight at a time. The loops over eight
//! are plain ones that the compiler turns into vector instructions, and are compiled twice: for what every processor of
//! the kind has, and for AVX2, chosen at run time. Both give the same bits, since no product is ever fused with a sum.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

use super::open::Open;
use super::space::{Entered, SLACK, Space};
use super::{Bounds, Line};
use crate::simd::{Lanes, Task, with_best};
use std::array::from_fn;
use std::ops::Range;

/// Eight children: their boxes, lane by lane, and where they go on.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(super) struct Node {
    // By axis, then by side: the smallest coordinates, the largest.
    pub(super) sides: [[[f32; 8]; 2]; 3],
    // An inner child: its index in `nodes`. A leaf: see `leaf`.
    pub(super) child: [u32; 8],
}

/// A child that is a leaf of 1 to 4 blocks: their number less one, and the first of them.
pub(super) const LEAF: u32 = 1 << 31;

/// Blocks of one leaf at most.
pub(super) const BLOCKS: usize = 4;

impl Node {
    /// Boxes that no line meets.
    pub(super) const EMPTY: Self =
        Self { sides: [[[f32::INFINITY; 8], [f32::NEG_INFINITY; 8]]; 3], child: [LEAF; 8] };
}

/// The reference to a leaf.
pub(super) fn leaf(first: usize, blocks: usize) -> u32 {
    LEAF | (blocks as u32 - 1) << 29 | first as u32
}

/// The blocks of a leaf.
#[inline(always)]
pub(super) fn blocks_of(leaf: u32) -> Range<usize> {
    let first = (leaf & 0x1fff_ffff) as usize;
    first..first + (leaf >> 29 & 3) as usize + 1
}

/// The numbers of four items; [`EMPTY`] where there are fewer.
pub(crate) type Numbers = [u32; 4];

/// No item.
pub(crate) const EMPTY: u32 = u32::MAX;

/// A tree over blocks of four items.
#[derive(Debug, Clone)]
pub(crate) struct Wide {
    pub(super) space: Space,
    pub(super) nodes: Vec<Node>,
    pub(super) root: u32,
}

/// What is done with the leaves.
pub(crate) trait Visit {
    /// Whether leaves are told by growing s, roughly.
    const BY_S: bool;

    /// Looks at some blocks, with the limit of s so far, and returns the new one; a negative one ends the walk.
    fn look<L: Lanes>(&mut self, lanes: L, blocks: Range<usize>, limit: f64) -> f64;
}

impl Wide {
    /// Over so many items with these boxes, which must be finite; and the items' numbers, block by block.
    pub(crate) fn build(count: usize, of: impl Fn(usize) -> Bounds + Sync + Send) -> (Self, Vec<Numbers>) {
        let space = Space::around(count, &of);
        if count == 0 {
            return (Self { space, nodes: Vec::new(), root: LEAF }, Vec::new());
        }
        let (nodes, root, blocks) = super::collapse::collapse(&space, count, of);
        (Self { space, nodes, root }, blocks)
    }

    /// The box of all items.
    pub(crate) fn bounds(&self) -> Bounds {
        self.space.bounds
    }

    /// A length below the widening of each box and above the rounding of what is in it, as long as no line starts more than
    /// 1e7 times the size of all away.
    pub(crate) fn grain(&self) -> f64 {
        0.1 * self.space.pad()
    }

    /// Bytes that it takes.
    pub(crate) fn bytes(&self) -> usize {
        self.nodes.len() * size_of::<Node>()
    }

    /// The beginning of a walk; none for a line that meets nothing.
    #[inline]
    pub(crate) fn enter(&self, line: &Line, s_max: f64) -> Option<Entered> {
        self.space.enter(line, s_max)
    }

    /// Tells all blocks that may hold something that the line meets at 0 < s < `s_max`. Returns the last limit.
    #[inline]
    pub(crate) fn walk<V: Visit>(&self, entered: Entered, s_max: f64, visit: &mut V) -> f64 {
        with_best(Walk { tree: self, entered, s_max, visit })
    }

    /// The same without the best instruction set.
    #[cfg(test)]
    pub(crate) fn walk_plainly<V: Visit>(&self, entered: Entered, s_max: f64, visit: &mut V) -> f64 {
        walk_on(crate::simd::Plain, self, self.root, &mut { entered }, s_max, visit)
    }
}

/// A walk to be done.
struct Walk<'a, V> {
    tree: &'a Wide,
    entered: Entered,
    s_max: f64,
    visit: &'a mut V,
}

impl<V: Visit> Task for Walk<'_, V> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> f64 {
        let Self { tree, mut entered, s_max, visit } = self;
        walk_on(lanes, tree, tree.root, &mut entered, s_max, visit)
    }
}

/// A walk from some node on.
#[inline(always)]
pub(super) fn walk_on<L: Lanes, V: Visit>(
    lanes: L,
    tree: &Wide,
    mut at: u32,
    walk: &mut Entered,
    s_max: f64,
    visit: &mut V,
) -> f64 {
    let mut limit = s_max;
    let mut open = Open::new();
    loop {
        let follow = if at & LEAF == 0 {
            let node = &tree.nodes[at as usize];
            let (near, met) = entries(lanes, walk, node);
            open.descend(&near, &node.child, met, V::BY_S)
        } else {
            let before = limit;
            limit = visit.look(lanes, blocks_of(at), limit);
            if limit != before {
                if limit < 0.0 {
                    return limit;
                }
                walk.limit(limit);
            }
            None
        };
        let Some(follow) = follow.or_else(|| open.pop(walk.t_max)) else { return limit };
        at = follow;
    }
}

/// Where the line enters each child, and which it enters before the limit.
#[inline(always)]
fn entries<L: Lanes>(lanes: L, walk: &Entered, node: &Node) -> ([f32; 8], u32) {
    let start = walk.start.to_array();
    let inverse = walk.inverse.to_array();
    let mut near = [0.0_f32; 8];
    let mut far = [f32::MAX; 8];
    for axis in 0..3 {
        let back = usize::from(inverse[axis] < 0.0);
        let sides = &node.sides[axis];
        let (start, inverse) = (start[axis], inverse[axis]);
        near = from_fn(|lane| {
            let enter = (sides[back][lane] - start) * inverse;
            if enter > near[lane] { enter } else { near[lane] }
        });
        far = from_fn(|lane| {
            let leave = (sides[1 - back][lane] - start) * inverse;
            if leave < far[lane] { leave } else { far[lane] }
        });
    }
    let far = far.map(|far| {
        let far = far * SLACK;
        if far < walk.t_max { far } else { walk.t_max }
    });
    (near, lanes.at_most_8(near, far))
}
