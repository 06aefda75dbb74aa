//! A box in the lab that moves.

use crate::spacetime::{Event, Rest};
use crate::tree::Bounds;
use crate::world::{Placed, RestFrame};
use glam::DVec3;

/// Boxes are this part of the coordinates they were computed from wider: more than all rounding.
pub(super) const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What is in a box at a moment, and how fast it may move.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moving {
    pub(super) moment: f64,
    pub(super) lo: DVec3,
    pub(super) hi: DVec3,
    pub(super) v_lo: DVec3,
    pub(super) v_hi: DVec3,
}

impl Moving {
    /// The same at another moment.
    pub(super) fn at(&self, moment: f64) -> Self {
        let later = moment - self.moment;
        let (a, b) = (self.v_lo * later, self.v_hi * later);
        let pad = ROUNDING * (self.lo.abs().max(self.hi.abs()).max_element() + later.abs());
        Self { moment, lo: self.lo + a.min(b) - pad, hi: self.hi + a.max(b) + pad, ..*self }
    }

    pub(super) fn with(&self, other: &Self) -> Self {
        Self {
            moment: self.moment,
            lo: self.lo.min(other.lo),
            hi: self.hi.max(other.hi),
            v_lo: self.v_lo.min(other.v_lo),
            v_hi: self.v_hi.max(other.v_hi),
        }
    }

    /// That of a rest frame at the moment at which its middle appears from an event; none for what has no end.
    pub(super) fn of(rest: &RestFrame, event: Event) -> Option<Self> {
        let bounds = rest
            .placed
            .iter()
            .map(Placed::bounds)
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
        let left: Event<Rest> = Event::new(seen.t - (seen.x - middle).length(), middle);
        let moment = rest.rest_from_lab.undo(left).t;
        let place = origin.x + beta * (moment - origin.t);
        let pad = ROUNDING
            * (origin.x.abs().max_element()
                + origin.t.abs()
                + moment.abs()
                + event.t.abs()
                + own.lo.abs().max(own.hi.abs()).max_element());
        Some(Self { moment, lo: place + own.lo - pad, hi: place + own.hi + pad, v_lo: beta, v_hi: beta })
    }
}
