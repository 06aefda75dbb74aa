//! A tree of boxes in one space: built by obvhs, walked here.
//!
//! Boxes are `f32` in units of the tree's own size, so that 1e-6 m and 1e6 m are the same to it; they are
//! padded by more than all rounding of a walk, and what they hold is tested by the caller in `f64`. A line that
//! meets an item's box is therefore never lost. (obvhs's own walk clamps small direction components and
//! misses, so it only builds.)

use glam::{DVec3, Vec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::{BvhBuildParams, bvh2::builder::build_bvh2};
use smallvec::SmallVec;
use std::time::Duration;

/// Half the widening of each box, in units in which the whole tree lies within [-1, 1].
///
/// A walk rounds its start (6e-8), its direction (6e-8 over a length up to 3.5) and the box corners (6e-8).
const PAD: f32 = 1e-6;

/// The points `origin + s step`, s > 0.
#[derive(Debug, Clone, Copy)]
pub struct Line {
    /// Where s is zero.
    pub origin: DVec3,
    /// What one unit of s moves.
    pub step: DVec3,
}

/// An axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub lo: DVec3,
    /// Largest coordinates.
    pub hi: DVec3,
}

impl Bounds {
    /// Of no point.
    pub const EMPTY: Self = Self { lo: DVec3::INFINITY, hi: DVec3::NEG_INFINITY };

    /// The smallest that holds all the points.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self { lo: b.lo.min(p), hi: b.hi.max(p) })
    }

    /// The smallest that holds both.
    pub fn with(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// The eight corners.
    pub fn corners(self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |axis: usize| if i >> axis & 1 == 0 { self.lo[axis] } else { self.hi[axis] };
            DVec3::new(pick(0), pick(1), pick(2))
        })
    }

    /// Where the line is inside, as a stretch of s (which may be empty: first > last).
    ///
    /// `inverse`: one over the line's step, finite also where that is zero.
    #[inline]
    fn stretch(self, line: &Line, inverse: DVec3) -> (f64, f64) {
        let (a, b) = ((self.lo - line.origin) * inverse, (self.hi - line.origin) * inverse);
        (a.min(b).max_element(), a.max(b).min_element())
    }
}

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
    bounds: Bounds,
    // The bounds, widened by more than all padding.
    entrance: Bounds,
    centre: DVec3,
    scale: f64,
    nodes: Vec<Node>,
    items: Vec<u32>,
}

struct Boxed(Aabb);

impl obvhs::Boundable for Boxed {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl Tree {
    /// Over items with these boxes, which must be finite.
    pub fn build(boxes: &[Bounds]) -> Self {
        let bounds = boxes.iter().fold(Bounds::EMPTY, |a, b| a.with(*b));
        if boxes.is_empty() {
            let (nodes, items) = (Vec::new(), Vec::new());
            return Self { bounds, entrance: bounds, centre: DVec3::ZERO, scale: 1.0, nodes, items };
        }
        let centre = 0.5 * bounds.lo + 0.5 * bounds.hi;
        let half = (bounds.hi - centre).max_element();
        // A single point still has a size: that of the rounding at its place.
        let half = half.max(centre.abs().max_element() * 1e-12).max(1e-200);
        let scale = 1.0 / half;
        let unit: Vec<(Vec3, Vec3)> = boxes
            .iter()
            .map(|b| {
                let lo = ((b.lo - centre) * scale).as_vec3() - PAD;
                (lo, ((b.hi - centre) * scale).as_vec3() + PAD)
            })
            .collect();
        let groups = Groups::of_equal(&unit);
        let boxed: Vec<Boxed> =
            groups.first.iter().map(|&i| unit[i as usize]).map(|(lo, hi)| Boxed(aabb(lo, hi))).collect();
        let mut seconds = Duration::ZERO;
        let built = build_bvh2(&boxed, BvhBuildParams::medium_build(), &mut seconds);
        let pad = f64::from(4.0 * PAD) * half;
        let entrance = Bounds { lo: bounds.lo - pad, hi: bounds.hi + pad };
        let items = Vec::with_capacity(boxes.len());
        let mut tree = Self { bounds, entrance, centre, scale, nodes: Vec::new(), items };
        tree.adopt(&built, &groups);
        tree
    }

    /// The box of all items.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Takes over obvhs's nodes, children's boxes moved into their parents, with an explicit stack (a degenerate
    /// tree may be as deep as it has items).
    fn adopt(&mut self, built: &obvhs::bvh2::Bvh2, groups: &Groups) {
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
        self.enter(line, s_max).map_or(s_max, |entered| self.walk_on(entered, s_max, visit))
    }

    /// The rest of a walk, after its beginning.
    #[inline]
    pub(crate) fn walk_on(
        &self,
        mut walk: Entered,
        s_max: f64,
        mut visit: impl FnMut(u32, f64) -> f64,
    ) -> f64 {
        let mut limit = s_max;
        let mut open = Open::new();
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

    /// The beginning of a walk: moves the start to the box in `f64`, and only then goes to `f32`. None for a line that
    /// meets no box.
    #[inline]
    pub(crate) fn enter(&self, line: &Line, s_max: f64) -> Option<Entered> {
        if self.nodes.is_empty() {
            return None;
        }
        // Finite, so that nothing times zero is not a number.
        let inverse = (1.0 / line.step).clamp(DVec3::splat(-1e300), DVec3::splat(1e300));
        let (first, last) = self.entrance.stretch(line, inverse);
        let first = if first > 0.0 { first } else { 0.0 };
        // Not `first > last`: a line that is not a number meets nothing.
        if !(first <= last && first < s_max) {
            return None;
        }
        let speed = line.step.length();
        let length = speed * self.scale;
        let start = ((line.origin + line.step * first - self.centre) * self.scale).as_vec3();
        // Below 1e-12 of the length a component moves nothing across the tree.
        let inverse = (inverse * speed).clamp(DVec3::splat(-1e12), DVec3::splat(1e12)).as_vec3();
        let mut walk = Entered { start, inverse, first, length, t_max: f32::MAX };
        walk.limit(s_max);
        length.is_finite().then_some(walk)
    }
}

/// A line inside a tree: from the start with unit speed.
pub(crate) struct Entered {
    start: Vec3,
    inverse: Vec3,
    first: f64,
    length: f64,
    t_max: f32,
}

impl Entered {
    /// Where the line enters a box; infinite if it does not.
    #[inline]
    fn entry(&self, lo: Vec3, hi: Vec3) -> f32 {
        let a = (lo - self.start) * self.inverse;
        let b = (hi - self.start) * self.inverse;
        let (near, far) = (a.min(b), a.max(b));
        let enter = near.x.max(near.y).max(near.z.max(0.0));
        let leave = far.x.min(far.y).min(far.z);
        // Ize 2013: two roundings of the far distance.
        if enter <= leave * 1.000_001 { enter } else { f32::INFINITY }
    }

    #[inline]
    fn limit(&mut self, s_max: f64) {
        self.t_max = ((s_max - self.first) * self.length * 1.000_001).min(f64::from(f32::MAX)) as f32;
    }
}

/// Nodes still to be visited, with their entries; on the heap only in very deep trees.
type Open = SmallVec<[(f32, u32); 32]>;

/// The last of them that is entered before the limit.
#[inline]
fn before(open: &mut Open, t_max: f32) -> Option<u32> {
    while let Some((entry, node)) = open.pop() {
        if entry <= t_max {
            return Some(node);
        }
    }
    None
}

fn aabb(lo: Vec3, hi: Vec3) -> Aabb {
    Aabb::new(Vec3A::from(lo), Vec3A::from(hi))
}

/// Items with the same box, told once to the builder: it takes quadratic time over equal boxes.
struct Groups {
    order: Vec<u32>,
    // Where each group begins in `order`, and the end.
    begin: Vec<u32>,
    // One member of each group.
    first: Vec<u32>,
}

impl Groups {
    fn of_equal(boxes: &[(Vec3, Vec3)]) -> Self {
        use rayon::slice::ParallelSliceMut;
        let key = |i: u32| {
            let (lo, hi) = boxes[i as usize];
            [lo.x, lo.y, lo.z, hi.x, hi.y, hi.z].map(f32::to_bits)
        };
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        order.par_sort_unstable_by_key(|&i| (key(i), i));
        let mut begin = Vec::new();
        for place in 0..order.len() {
            if place == 0 || key(order[place]) != key(order[place - 1]) {
                begin.push(place as u32);
            }
        }
        let first = begin.iter().map(|&place| order[place as usize]).collect();
        begin.push(order.len() as u32);
        Self { order, begin, first }
    }

    fn members(&self, group: u32) -> &[u32] {
        let group = group as usize;
        &self.order[self.begin[group] as usize..self.begin[group + 1] as usize]
    }
}
