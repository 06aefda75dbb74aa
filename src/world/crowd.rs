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

use super::RestFrame;
use crate::spacetime::{Event, SightRay};
use crate::tree::Bounds;
use glam::DVec3;
use smallvec::SmallVec;

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

    /// Where a ray may enter it at 0 <= s < `s_max`; infinite if nowhere.
    fn entry(&self, ray: &SightRay, s_max: f64) -> f64 {
        let ahead = ray.event.t - self.moment;
        // The ray goes back in time: Δ = ahead - s k⁰.
        let turn = (ahead / ray.k.t).clamp(0.0, s_max);
        let late = self.stretch(ray, ahead, (self.v_lo, self.v_hi), (0.0, turn));
        if late.is_finite() {
            return late;
        }
        self.stretch(ray, ahead, (self.v_hi, self.v_lo), (turn, s_max))
    }

    /// The first s of a stretch at which the ray is within the faces, which move with these velocities.
    fn stretch(
        &self,
        ray: &SightRay,
        ahead: f64,
        (v_lo, v_hi): (DVec3, DVec3),
        (from, to): (f64, f64),
    ) -> f64 {
        let (x, k) = (ray.event.x, ray.k);
        let slack = ROUNDING * k.t;
        let pad = ROUNDING * (x.abs().max_element() + ray.event.t.abs() + self.moment.abs());
        // Above the lower faces: room >= s closing, and so below the upper ones.
        let lower = (x - self.lo - v_lo * ahead + pad, k.x - v_lo * k.t - slack);
        let upper = (self.hi + v_hi * ahead - x + pad, v_hi * k.t - k.x - slack);
        let (mut first, mut last) = (from, to);
        for (room, closing) in [lower, upper] {
            for axis in 0..3 {
                let (room, closing) = (room[axis], closing[axis]);
                if closing > 0.0 {
                    last = last.min(room / closing);
                } else if closing < 0.0 {
                    first = first.max(room / closing);
                } else if room < 0.0 {
                    return f64::INFINITY;
                }
            }
        }
        if first <= last * (1.0 + ROUNDING) { first } else { f64::INFINITY }
    }
}

#[derive(Debug, Clone, Copy)]
struct Node {
    moving: Moving,
    // A leaf: the number of a rest frame. Else the second child; the first is the next node.
    leaf: bool,
    next: u32,
}

/// A tree of moving boxes over the rest frames of a world.
#[derive(Debug, Clone)]
pub struct Crowd {
    nodes: Vec<Node>,
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
        let mut crowd = Self { nodes: Vec::with_capacity(2 * leaves.len()), endless };
        if !leaves.is_empty() {
            crowd.add(&mut leaves);
        }
        Some(crowd)
    }

    /// The node over these, after all nodes there are: halves of them in the direction in which they appear widest.
    fn add(&mut self, leaves: &mut [(u32, Moving)]) -> Moving {
        let own = self.nodes.len();
        if let [(number, moving)] = leaves {
            self.nodes.push(Node { moving: *moving, leaf: true, next: *number });
            return *moving;
        }
        let middle = |moving: &Moving| 0.5 * moving.lo + 0.5 * moving.hi;
        let all = Bounds::of(leaves.iter().map(|(_, moving)| middle(moving)));
        let wide = all.hi - all.lo;
        let axis = if wide.x >= wide.y.max(wide.z) { 0 } else { 1 + usize::from(wide.z > wide.y) };
        let half = leaves.len() / 2;
        leaves.select_nth_unstable_by(half, |a, b| {
            middle(&a.1)[axis].total_cmp(&middle(&b.1)[axis]).then(a.0.cmp(&b.0))
        });
        self.nodes.push(Node { moving: leaves[0].1, leaf: false, next: 0 });
        let (one, other) = leaves.split_at_mut(half);
        let one = self.add(one);
        let next = self.nodes.len() as u32;
        let other = self.add(other);
        let moment = 0.5 * one.moment + 0.5 * other.moment;
        let moving = one.at(moment).with(&other.at(moment));
        self.nodes[own] = Node { moving, leaf: false, next };
        moving
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
        if let Some(root) = self.nodes.first() {
            open.push((root.moving.entry(ray, limit), 0));
        }
        while let Some((entry, at)) = open.pop() {
            // Not `entry > limit`: infinite is nowhere, whatever the limit.
            if !(entry.is_finite() && entry <= limit) {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.leaf {
                limit = visit(node.next, limit);
                if limit < 0.0 {
                    return limit;
                }
                continue;
            }
            let entry = |number: u32| (self.nodes[number as usize].moving.entry(ray, limit), number);
            let (near, far) = (entry(at + 1), entry(node.next));
            let (near, far) = if far.0 < near.0 { (far, near) } else { (near, far) };
            open.push(far);
            open.push(near);
        }
        limit
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
