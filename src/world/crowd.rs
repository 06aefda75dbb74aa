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

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

use super::RestFrame;
use crate::spacetime::{Event, SightRay};
use crate::tree::{Bounds, Lanes, Task, with_best};
use glam::DVec3;
use smallvec::SmallVec;
use std::array::from_fn;

/// With fewer rest frames each is asked.
const FEWEST: usize = 8;

/// Boxes are this part of the coordinates they were computed from wider, and slopes this part of the light's: more than all rounding.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What is in a box at a moment, and how fast it may move.
#[derive(Debug, Clone, Copy)]
struct Moving {
    moment: f64,
    lo: DVec3,
    hi: DVec3,
    v_lo: DVec3,
    v_hi: DVec3,
}

impl Moving {
    /// The same at another moment.
    fn at(&self, moment: f64) -> Self {
        let later = moment - self.moment;
        let (a, b) = (self.v_lo * later, self.v_hi * later);
        let pad = ROUNDING * (self.lo.abs().max(self.hi.abs()).max_element() + later.abs());
        Self { moment, lo: self.lo + a.min(b) - pad, hi: self.hi + a.max(b) + pad, ..*self }
    }

    fn with(&self, other: &Self) -> Self {
        Self {
            moment: self.moment,
            lo: self.lo.min(other.lo),
            hi: self.hi.max(other.hi),
            v_lo: self.v_lo.min(other.v_lo),
            v_hi: self.v_hi.max(other.v_hi),
        }
    }
}

/// The number of a rest frame, and its box.
type Leaf = (u32, Moving);

/// Four moving boxes, lane by lane, and where they go on.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
struct Node {
    moment: [f64; 4],
    // By axis.
    lo: [[f64; 4]; 3],
    hi: [[f64; 4]; 3],
    v_lo: [[f64; 4]; 3],
    v_hi: [[f64; 4]; 3],
    // An inner child: its index in `nodes`. A leaf: the number of a rest frame.
    child: [u32; 4],
    // Whether what is in each box has one velocity.
    rigid: bool,
}

/// A child that is a leaf.
const LEAF: u32 = 1 << 31;

impl Node {
    /// Boxes that no ray meets.
    const EMPTY: Self = Self {
        moment: [0.0; 4],
        lo: [[f64::INFINITY; 4]; 3],
        hi: [[f64::NEG_INFINITY; 4]; 3],
        v_lo: [[0.0; 4]; 3],
        v_hi: [[0.0; 4]; 3],
        child: [LEAF; 4],
        rigid: true,
    };

    fn set(&mut self, lane: usize, child: u32, moving: &Moving) {
        self.moment[lane] = moving.moment;
        for axis in 0..3 {
            self.lo[axis][lane] = moving.lo[axis];
            self.hi[axis][lane] = moving.hi[axis];
            self.v_lo[axis][lane] = moving.v_lo[axis];
            self.v_hi[axis][lane] = moving.v_hi[axis];
        }
        self.child[lane] = child;
        self.rigid &= moving.v_lo == moving.v_hi;
    }

    /// Where a ray may enter each box at 0 <= s <= `s_max`; infinite if nowhere.
    #[inline(always)]
    fn entries<L: Lanes>(&self, lanes: L, ray: &SightRay, s_max: f64) -> [f64; 4] {
        let ahead: [f64; 4] = from_fn(|i| ray.event.t - self.moment[i]);
        if self.rigid {
            return self.stretch(lanes, ray, &ahead, [&self.v_lo, &self.v_hi], (&[0.0; 4], &[s_max; 4]));
        }
        // The ray goes back in time: Δ = ahead - s k⁰.
        let turn: [f64; 4] = from_fn(|i| {
            let turn = ahead[i] / ray.k.t;
            let turn = if turn > 0.0 { turn } else { 0.0 };
            if turn < s_max { turn } else { s_max }
        });
        let late = self.stretch(lanes, ray, &ahead, [&self.v_lo, &self.v_hi], (&[0.0; 4], &turn));
        let early = self.stretch(lanes, ray, &ahead, [&self.v_hi, &self.v_lo], (&turn, &[s_max; 4]));
        from_fn(|i| if late[i] < early[i] { late[i] } else { early[i] })
    }

    /// The first s of a stretch at which the ray is within the faces, which move with these velocities.
    #[inline(always)]
    fn stretch<L: Lanes>(
        &self,
        lanes: L,
        ray: &SightRay,
        ahead: &[f64; 4],
        [v_lo, v_hi]: [&[[f64; 4]; 3]; 2],
        (from, to): (&[f64; 4], &[f64; 4]),
    ) -> [f64; 4] {
        let slack = ROUNDING * ray.k.t;
        let own = ray.event.x.abs().max_element() + ray.event.t.abs();
        let pad: [f64; 4] = from_fn(|i| ROUNDING * (own + self.moment[i].abs()));
        let mut within = (*from, *to);
        for axis in 0..3 {
            let (x, k) = (ray.event.x[axis], ray.k.x[axis]);
            let (lo, hi, v_lo, v_hi) = (&self.lo[axis], &self.hi[axis], &v_lo[axis], &v_hi[axis]);
            let room: [f64; 4] = from_fn(|i| x - lo[i] - v_lo[i] * ahead[i] + pad[i]);
            within = beyond(within, &room, &from_fn(|i| k - v_lo[i] * ray.k.t - slack));
            let room: [f64; 4] = from_fn(|i| hi[i] + v_hi[i] * ahead[i] - x + pad[i]);
            within = beyond(within, &room, &from_fn(|i| v_hi[i] * ray.k.t - k - slack));
        }
        let (first, last) = within;
        let met = lanes.at_most_4(first, last.map(|last| last * (1.0 + ROUNDING)));
        from_fn(|i| if met >> i & 1 == 1 { first[i] } else { f64::INFINITY })
    }
}

/// What is left of stretches of s where `room >= s closing`.
#[inline(always)]
fn beyond((first, last): ([f64; 4], [f64; 4]), room: &[f64; 4], closing: &[f64; 4]) -> ([f64; 4], [f64; 4]) {
    // Along a face it is beyond it, or not, for ever: room / 0. (The sum makes a negative zero a positive one.)
    let s: [f64; 4] = from_fn(|i| room[i] / (closing[i] + 0.0));
    let after: [f64; 4] = from_fn(|i| if closing[i] < 0.0 { s[i] } else { f64::NEG_INFINITY });
    let before: [f64; 4] = from_fn(|i| if closing[i] < 0.0 { f64::INFINITY } else { s[i] });
    (
        from_fn(|i| if after[i] > first[i] { after[i] } else { first[i] }),
        from_fn(|i| if before[i] < last[i] { before[i] } else { last[i] }),
    )
}

/// A tree of moving boxes over the rest frames of a world.
#[derive(Debug, Clone)]
pub struct Crowd {
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
            match moving(rest, event) {
                Some(moving) => leaves.push((number as u32, moving)),
                None => endless.push(number as u32),
            }
        }
        let mut crowd = Self { nodes: Vec::with_capacity(leaves.len() / 2), root: None, endless };
        crowd.root = (!leaves.is_empty()).then(|| crowd.add(&mut leaves).0);
        Some(crowd)
    }

    /// What is over these, after all nodes there are: quarters of them, cut in the directions in which they appear widest.
    fn add(&mut self, leaves: &mut [Leaf]) -> (u32, Moving) {
        if let [(number, moving)] = leaves {
            return (LEAF | *number, *moving);
        }
        let own = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let (one, other) = halves(leaves);
        let quarters = [one, other].map(halves);
        let mut node = Node::EMPTY;
        let mut children: SmallVec<[Moving; 4]> = SmallVec::new();
        for quarter in quarters.into_iter().flat_map(<[_; 2]>::from).filter(|quarter| !quarter.is_empty()) {
            let (child, moving) = self.add(quarter);
            node.set(children.len(), child, &moving);
            children.push(moving);
        }
        self.nodes[own] = node;
        let moment = children.iter().map(|child| child.moment / children.len() as f64).sum();
        let all = children[1..].iter().fold(children[0].at(moment), |all, one| all.with(&one.at(moment)));
        (own as u32, all)
    }

    /// Calls `visit` with every rest frame that the ray may meet at 0 < s < `s_max`, roughly by growing s. `visit` gets the
    /// limit so far and returns the new one; a negative one ends the walk. Returns the last limit.
    pub(super) fn walk(&self, ray: &SightRay, s_max: f64, mut visit: impl FnMut(u32, f64) -> f64) -> f64 {
        let mut limit = s_max;
        for number in &self.endless {
            limit = visit(*number, limit);
            if limit < 0.0 {
                return limit;
            }
        }
        let mut open: SmallVec<[(f64, u32); 32]> = SmallVec::new();
        open.extend(self.root.map(|root| (0.0, root)));
        while let Some((entry, at)) = open.pop() {
            if entry > limit {
                continue;
            }
            if at & LEAF != 0 {
                limit = visit(at & !LEAF, limit);
                if limit < 0.0 {
                    return limit;
                }
                continue;
            }
            let node = &self.nodes[at as usize];
            let entries = with_best(Entries { node, ray, s_max: limit });
            let before = open.len();
            for (entry, child) in entries.into_iter().zip(node.child) {
                if entry.is_finite() {
                    // The nearest last.
                    let farther = open[before..].iter().take_while(|(other, _)| *other >= entry).count();
                    open.insert(before + farther, (entry, child));
                }
            }
        }
        limit
    }
}

/// One half, and the other, in the direction in which they appear widest.
fn halves(leaves: &mut [Leaf]) -> (&mut [Leaf], &mut [Leaf]) {
    let half = leaves.len() / 2;
    if half > 0 {
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

/// The question to be asked of a node.
struct Entries<'a> {
    node: &'a Node,
    ray: &'a SightRay,
    s_max: f64,
}

impl Task for Entries<'_> {
    type Output = [f64; 4];

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> [f64; 4] {
        self.node.entries(lanes, self.ray, self.s_max)
    }
}

/// A rest frame's box in the lab at the moment at which its middle appears from an event; none for what has no end.
fn moving(rest: &RestFrame, event: Event) -> Option<Moving> {
    let bounds = rest
        .placed
        .iter()
        .map(super::Placed::bounds)
        .try_fold(Bounds::EMPTY, |all, one| Some(all.with(one?)))?;
    let boost = rest.rest_from_lab.boost();
    let velocity = boost.velocity();
    let (gamma, proper) = (velocity.gamma(), velocity.proper());
    let beta = velocity.beta();
    // Contracted along the motion: c - u (u·c)/(γ(γ + 1)), with u = γβ.
    let shrunk = |c: DVec3| c - proper * (proper.dot(c) / (gamma * (gamma + 1.0)));
    let own = Bounds::of(bounds.corners().map(shrunk));
    let origin = rest.rest_from_lab.origin();
    // Where the middle appears: its rest frame's light cone, as the lab tells the time.
    let seen = rest.rest_from_lab * event;
    let middle = 0.5 * bounds.lo + 0.5 * bounds.hi;
    let left: Event<crate::spacetime::Rest> = Event::new(seen.t - (seen.x - middle).length(), middle);
    let moment = rest.rest_from_lab.undo(left).t;
    let place = origin.x + beta * (moment - origin.t);
    let pad = ROUNDING
        * (origin.x.abs().max_element()
            + origin.t.abs()
            + moment.abs()
            + event.t.abs()
            + own.lo.abs().max(own.hi.abs()).max_element());
    Some(Moving { moment, lo: place + own.lo - pad, hi: place + own.hi + pad, v_lo: beta, v_hi: beta })
}
