//! A tree of boxes in one space: built by obvhs, walked here.
//!
//! Boxes are `f32` in units of the tree's own size, so that 1e-6 m and 1e6 m are the same to it; they are
//! padded by more than all rounding of a walk, and what they hold is tested by the caller in `f64`. A line that
//! meets an item's box is therefore never lost. (obvhs's own walk clamps small direction components and
//! misses, so it only builds.)

mod collapse;
mod lines;
mod open;
mod packet;
mod space;
mod wide;

use glam::Vec3;
pub(crate) use lines::{Each, each, greatest, least, plus, some_of};
pub use lines::{Lines, MANY};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, builder::build_bvh2};
pub(crate) use open::Open;
use packet::Packet;
pub(crate) use packet::VisitMany;
use rayon::prelude::*;
use smallvec::SmallVec;
pub use space::{Bounds, Line};
use space::{Entered, Space};
use std::time::Duration;
pub(crate) use wide::{EMPTY, Numbers, Visit, Wide};

/// Two children: their boxes, and where they go on.
#[derive(Debug, Clone, Copy)]
struct Node {
    lo: [Vec3; 2],
    hi: [Vec3; 2],
    // An inner child: its index in `nodes`. A leaf: its first place in `items`.
    first: [u32; 2],
    // Items of a leaf; zero for an inner child.
    count: [u32; 2],
}

/// A tree over items known by number and box.
#[derive(Debug, Clone)]
pub struct Tree {
    space: Space,
    nodes: Vec<Node>,
    items: Vec<u32>,
}

#[derive(Clone, Copy)]
struct Boxed(Aabb);

impl obvhs::Boundable for Boxed {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

/// obvhs's tree over the groups of equal boxes.
fn built(
    space: &Space,
    count: usize,
    of: impl Fn(usize) -> Bounds + Sync + Send,
    params: BvhBuildParams,
) -> (Bvh2, Groups) {
    let mut boxed: Vec<Boxed> = (0..count).into_par_iter().map(|i| Boxed(space.padded(&of(i)))).collect();
    let groups = Groups::of_equal(&boxed);
    if groups.ranges.len() < count {
        boxed =
            groups.ranges.iter().map(|(begin, _)| boxed[groups.order[*begin as usize] as usize]).collect();
    }
    let mut seconds = Duration::ZERO;
    (build_bvh2(&boxed, params, &mut seconds), groups)
}

impl Tree {
    /// Over items with these boxes, which must be finite.
    pub fn build(boxes: &[Bounds]) -> Self {
        let of = |i: usize| boxes[i];
        let space = Space::around(boxes.len(), of);
        let mut tree = Self { space, nodes: Vec::new(), items: Vec::with_capacity(boxes.len()) };
        if boxes.is_empty() {
            return tree;
        }
        // What is below a leaf is dear: one box for each.
        let params = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() };
        let (built, groups) = built(&tree.space, boxes.len(), of, params);
        tree.adopt(&built, &groups);
        tree
    }

    /// The box of all items.
    pub fn bounds(&self) -> Bounds {
        self.space.bounds
    }

    /// Takes over obvhs's nodes, children's boxes moved into their parents, with an explicit stack (a degenerate
    /// tree may be as deep as it has items).
    fn adopt(&mut self, built: &Bvh2, groups: &Groups) {
        // A box at infinity is met by no line: the second child of a root that is itself a leaf.
        let nothing = Node { lo: [Vec3::INFINITY; 2], hi: [Vec3::INFINITY; 2], first: [0; 2], count: [0; 2] };
        self.nodes.push(nothing);
        let root = &built.nodes[0];
        let children = root.first_index as usize;
        // (obvhs's node, our parent, which child of it)
        let mut open =
            if root.prim_count > 0 { vec![(0, 0, 0)] } else { vec![(children + 1, 0, 1), (children, 0, 0)] };
        while let Some((source, parent, side)) = open.pop() {
            let node = &built.nodes[source];
            let begin = node.first_index as usize;
            let (first, count) = if node.prim_count > 0 {
                let first = self.items.len() as u32;
                for place in begin..begin + node.prim_count as usize {
                    self.items.extend_from_slice(groups.members(built.primitive_indices[place]));
                }
                (first, self.items.len() as u32 - first)
            } else {
                let own = self.nodes.len();
                self.nodes.push(nothing);
                open.push((begin + 1, own, 1));
                open.push((begin, own, 0));
                (own as u32, 0)
            };
            let slot = &mut self.nodes[parent];
            slot.lo[side] = node.aabb.min.into();
            slot.hi[side] = node.aabb.max.into();
            slot.first[side] = first;
            slot.count[side] = count;
        }
    }

    /// Calls `visit` with every item whose box the line may meet at 0 < s < `s_max`, roughly by growing s.
    ///
    /// `visit` gets the limit so far and returns the new one; a negative one ends the walk. Returns the last limit.
    #[inline]
    pub fn walk(&self, line: &Line, s_max: f64, visit: impl FnMut(u32, f64) -> f64) -> f64 {
        if self.nodes.is_empty() {
            return s_max;
        }
        self.space.enter(line, s_max).map_or(s_max, |entered| self.walk_on(entered, s_max, visit))
    }

    /// Calls `visit` with every item whose box one of some lines may meet at 0 < s < its limit. `visit` gets the limits of those
    /// lines and negative ones for the others, and may lower them; a negative one ends its line's walk.
    pub(crate) fn walk_many(
        &self,
        lines: &Lines,
        limits: &mut Each<f64>,
        mut visit: impl FnMut(u32, &mut Each<f64>),
    ) {
        if self.nodes.is_empty() {
            return;
        }
        let mut packet = Packet::new(&self.space, lines, limits);
        if packet.farthest() < 0.0 {
            return;
        }
        let mut open = Entries::new();
        let mut at = 0_u32;
        loop {
            let node = &self.nodes[at as usize];
            let near = [packet.entry(node.lo[0], node.hi[0]), packet.entry(node.lo[1], node.hi[1])];
            let order = if near[1] < near[0] { [1, 0] } else { [0, 1] };
            let mut next = None;
            for side in order {
                let Some(entry) = near[side].filter(|entry| *entry <= packet.farthest()) else { continue };
                match (node.count[side], next) {
                    (0, None) => next = Some(node.first[side]),
                    (0, Some(_)) => open.push((entry, node.first[side])),
                    _ => {}
                }
                let begin = node.first[side] as usize;
                let items = &self.items[begin..begin + node.count[side] as usize];
                let met =
                    if items.is_empty() { 0 } else { packet.all_entering(node.lo[side], node.hi[side]) };
                for &item in items.iter().filter(|_| met != 0) {
                    some_of(met, limits, |limits| visit(item, limits));
                    packet.limit_all(limits);
                }
            }
            let Some(follow) = next.or_else(|| before(&mut open, packet.farthest())) else { return };
            at = follow;
        }
    }

    /// The rest of a walk, after its beginning.
    #[inline]
    fn walk_on(&self, mut walk: Entered, s_max: f64, mut visit: impl FnMut(u32, f64) -> f64) -> f64 {
        let mut limit = s_max;
        let mut open = Entries::new();
        let mut at = 0_u32;
        loop {
            let node = &self.nodes[at as usize];
            let near = [walk.entry(node.lo[0], node.hi[0]), walk.entry(node.lo[1], node.hi[1])];
            let order = if near[1] < near[0] { [1, 0] } else { [0, 1] };
            let mut next = None;
            for side in order {
                if near[side] > walk.t_max {
                    continue;
                }
                match (node.count[side], next) {
                    (0, None) => next = Some(node.first[side]),
                    (0, Some(_)) => open.push((near[side], node.first[side])),
                    _ => {}
                }
                let begin = node.first[side] as usize;
                for &item in &self.items[begin..begin + node.count[side] as usize] {
                    limit = visit(item, limit);
                }
                if limit < 0.0 {
                    return limit;
                }
                if node.count[side] > 0 {
                    walk.limit(limit);
                }
            }
            let Some(follow) = next.or_else(|| before(&mut open, walk.t_max)) else { return limit };
            at = follow;
        }
    }
}

/// Nodes still to be visited, with their entries; on the heap only in very deep trees.
type Entries = SmallVec<[(f32, u32); 32]>;

/// The last of them that is entered before the limit.
#[inline]
fn before(open: &mut Entries, t_max: f32) -> Option<u32> {
    while let Some((entry, node)) = open.pop() {
        if entry <= t_max {
            return Some(node);
        }
    }
    None
}

/// Items with the same box, told once to the builder: it takes quadratic time over equal boxes.
struct Groups {
    // All items, and then those that are not alone in their groups once more, group by group.
    order: Vec<u32>,
    // Where each group begins and ends in `order`; groups go by their first members.
    ranges: Vec<(u32, u32)>,
}

impl Groups {
    fn of_equal(boxes: &[Boxed]) -> Self {
        let key = |i: u32| {
            let Aabb { min, max } = boxes[i as usize].0;
            [min.x, min.y, min.z, max.x, max.y, max.z].map(f32::to_bits)
        };
        // Fowler, Noll and Vo's hash, word by word: what differs in it is not equal.
        let hash = |i: u32| {
            key(i).into_iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, word| {
                (hash ^ u64::from(word)).wrapping_mul(0x0000_0100_0000_01b3)
            })
        };
        let count = boxes.len() as u32;
        let hashed: Vec<u64> =
            (0..count).into_par_iter().map(|i| hash(i) >> 32 << 32 | u64::from(i)).collect();
        let mut order: Vec<u32> = (0..count).into_par_iter().collect();
        let mut ranges: Vec<(u32, u32)> = (0..count).into_par_iter().map(|i| (i, i + 1)).collect();
        for alike in repeated(hashed).chunk_by(|a, b| a >> 32 == b >> 32) {
            let mut alike: SmallVec<[u32; 8]> = alike.iter().map(|hashed| *hashed as u32).collect();
            alike.sort_unstable_by_key(|&i| (key(i), i));
            for equal in alike.chunk_by(|&a, &b| key(a) == key(b)).filter(|equal| equal.len() > 1) {
                let begin = order.len() as u32;
                order.extend_from_slice(equal);
                equal.iter().for_each(|item| ranges[*item as usize] = (0, 0));
                ranges[equal[0] as usize] = (begin, order.len() as u32);
            }
        }
        ranges.retain(|(_, end)| *end > 0);
        Self { order, ranges }
    }

    fn members(&self, group: u32) -> &[u32] {
        let (begin, end) = self.ranges[group as usize];
        &self.order[begin as usize..end as usize]
    }
}

/// Sorts those whose upper halves may be there more than once: of most meshes only a few.
fn repeated(hashed: Vec<u64>) -> Vec<u64> {
    // By the first bits of each, more than 16 places for one: whether they were there once, and twice.
    let bits = (hashed.len().ilog2() + 5).clamp(6, 32);
    let mut seen = vec![[0_u64; 2]; 1 << bits >> 6];
    let place = |hashed: u64| ((hashed >> (64 - bits) >> 6) as usize, 1 << (hashed >> (64 - bits) & 63));
    for number in &hashed {
        let (word, bit) = place(*number);
        let [once, twice] = &mut seen[word];
        *twice |= *once & bit;
        *once |= bit;
    }
    let again = |number: &u64| {
        let (word, bit) = place(*number);
        seen[word][1] & bit != 0
    };
    let mut repeated: Vec<u64> = hashed.into_par_iter().filter(again).collect();
    repeated.par_sort_unstable();
    repeated
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_boxes_are_one_group_at_the_place_of_the_first() {
        for count in [1, 2, 1_000] {
            let kind = |i: u32| i * i % 619;
            let boxed =
                |i: u32| Boxed(Aabb::new(Vec3::splat(-1.0).into(), Vec3::splat(kind(i) as f32).into()));
            let groups = Groups::of_equal(&(0..count).map(boxed).collect::<Vec<_>>());
            let firsts = (0..count).filter(|&i| (0..i).all(|before| kind(before) != kind(i)));
            let expected: Vec<Vec<u32>> =
                firsts.map(|first| (first..count).filter(|&i| kind(i) == kind(first)).collect()).collect();
            let found = (0..groups.ranges.len() as u32).map(|group| groups.members(group).to_vec());
            assert_eq!(found.collect::<Vec<_>>(), expected);
        }
    }
}
