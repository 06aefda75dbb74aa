//! A tree of moving boxes over rest frames: which of many frames a ray can meet.
//!
//! What a camera sees of a body is where the body was when its light left. So each box is known best at a moment of its own, that
//! at which what is in it appears from a given event, and before and after it is as much wider as the velocities in it
//! differ: at the lab's time t it is within
//!
//! ~~~text
//! lo + min(v_lo Δ, v_hi Δ) <= x <= hi + max(v_lo Δ, v_hi Δ),      Δ = t - t_box
//! ~~~
//!
//! Time is linear along a ray, so on each side of the moment every face is one linear inequality. The boxes hold for all
//! rays; from the event they were made for they are smallest.
//!
//! Nodes are asked in `f32`, eight boxes at once, in units in which the crowd is about as large as 1; each box is wider by more than the
//! rounding, whatever a ray brings with it. From so far away that this is more than the crowd itself, all are asked.

mod moving;
mod node;
mod together;

use super::RestFrame;
use crate::spacetime::{Event, SightRay};
use crate::tree::{Bounds, Open};
use moving::Moving;
use node::{Asked, LEAF, NOBODY, Node, Units};
use smallvec::SmallVec;

/// With fewer rest frames each is asked.
const FEWEST: usize = 8;

/// The number of a rest frame, and its box.
type Leaf = (u32, Moving);

/// A tree of moving boxes over the rest frames of a world.
#[derive(Debug, Clone)]
pub struct Crowd {
    units: Units,
    nodes: Vec<Node>,
    root: Option<u32>,
    // Frames with something that has no end.
    endless: Vec<u32>,
}

impl Crowd {
    /// Over these rest frames, as they appear from an event; none if they are so few that each is better asked.
    pub(super) fn around(frames: &[RestFrame], event: Event) -> Option<Self> {
        if frames.len() < FEWEST {
            return None;
        }
        let mut leaves = Vec::with_capacity(frames.len());
        let mut endless = Vec::new();
        for (number, rest) in frames.iter().enumerate() {
            match Moving::of(rest, event) {
                Some(moving) => leaves.push((number as u32, moving)),
                None => endless.push(number as u32),
            }
        }
        let units = Units::around(leaves.iter().map(|(_, moving)| moving));
        let mut crowd = Self { units, nodes: Vec::with_capacity(leaves.len() / 4), root: None, endless };
        crowd.root = (!leaves.is_empty()).then(|| crowd.add(&mut leaves).0);
        Some(crowd)
    }

    /// What is over these, after all nodes there are: at most eight parts of them, cut in the directions in which they appear
    /// widest. Parts are whole eights where they can be, so that nodes over rest frames alone are full: those boxes are rigid.
    fn add(&mut self, leaves: &mut [Leaf]) -> (u32, Moving) {
        if let [(number, moving)] = leaves {
            return (LEAF | *number, *moving);
        }
        let own = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let whole = if leaves.len() > 8 { 8 } else { 1 };
        let in_two = |leaves| <[_; 2]>::from(halves(leaves, whole));
        let parts = in_two(leaves).into_iter().flat_map(in_two).flat_map(in_two);
        let mut node = Node::EMPTY;
        let mut children: SmallVec<[Moving; 8]> = SmallVec::new();
        for part in parts.filter(|part| !part.is_empty()) {
            let (child, moving) = self.add(part);
            node.set(children.len(), child, &moving, &self.units);
            children.push(moving);
        }
        self.nodes[own] = node;
        let moment = children.iter().map(|child| child.moment / children.len() as f64).sum();
        let all = children[1..].iter().fold(children[0].at(moment), |all, one| all.with(&one.at(moment)));
        (own as u32, all)
    }

    /// Calls `visit` with every rest frame that the ray may meet at 0 < s < `s_max`, roughly by growing s. `visit` gets the
    /// limit so far and returns the new one; a negative one ends the walk. Returns the last limit.
    #[inline]
    pub(super) fn walk(&self, ray: &SightRay, s_max: f64, mut visit: impl FnMut(u32, f64) -> f64) -> f64 {
        let mut limit = s_max;
        for number in &self.endless {
            limit = visit(*number, limit);
            if limit < 0.0 {
                return limit;
            }
        }
        let Some(root) = self.root else { return limit };
        match Asked::new(ray, limit, &self.units) {
            Some(asked) => self.walk_on(asked, root, limit, visit),
            None => {
                let mut everybody = self.everybody();
                everybody
                    .try_fold(limit, |limit, number| Some(visit(number, limit)).filter(|s| *s >= 0.0))
                    .unwrap_or(-1.0)
            }
        }
    }

    #[inline]
    fn walk_on(
        &self,
        mut asked: Asked,
        root: u32,
        s_max: f64,
        mut visit: impl FnMut(u32, f64) -> f64,
    ) -> f64 {
        let mut limit = s_max;
        let mut open = Open::new();
        let mut at = root;
        loop {
            let mut follow = None;
            if at & LEAF == 0 {
                let node = &self.nodes[at as usize];
                let (near, met) = node.entries(&asked);
                follow = open.descend(&near, &node.child, met, true);
            } else {
                limit = visit(at & !LEAF, limit);
                if limit < 0.0 {
                    return limit;
                }
                asked.limit(limit);
            }
            let Some(follow) = follow.or_else(|| open.pop(asked.s_max)) else { return limit };
            at = follow;
        }
    }

    /// All that are in the tree.
    #[cold]
    fn everybody(&self) -> impl Iterator<Item = u32> {
        let children = self.nodes.iter().flat_map(|node| node.child);
        let leaf = |child: &u32| child & LEAF != 0 && *child != NOBODY;
        children.chain(self.root).filter(leaf).map(|child| child & !LEAF)
    }
}

/// One half, and the other, in the direction in which they appear widest; the first of whole numbers of `whole`.
fn halves(leaves: &mut [Leaf], whole: usize) -> (&mut [Leaf], &mut [Leaf]) {
    let half = leaves.len().div_ceil(2).next_multiple_of(whole).min(leaves.len());
    if half < leaves.len() {
        let middle = |moving: &Moving| 0.5 * moving.lo + 0.5 * moving.hi;
        let all = Bounds::of(leaves.iter().map(|(_, moving)| middle(moving)));
        let wide = all.hi - all.lo;
        let axis = if wide.x >= wide.y.max(wide.z) { 0 } else { 1 + usize::from(wide.z > wide.y) };
        leaves.select_nth_unstable_by(half, |a, b| {
            middle(&a.1)[axis].total_cmp(&middle(&b.1)[axis]).then(a.0.cmp(&b.0))
        });
    }
    leaves.split_at_mut(half)
}
