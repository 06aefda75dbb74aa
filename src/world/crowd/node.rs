//! Eight moving boxes at once.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

use super::moving::{self, Moving};
use crate::simd::{Lanes, Task, with_best};
use crate::spacetime::{Event, SightRay};
use glam::DVec3;
use std::array::from_fn;

/// A child that is a leaf.
pub(super) const LEAF: u32 = 1 << 31;

/// No child.
pub(super) const NOBODY: u32 = u32::MAX;

/// Boxes are this part of the coordinates they are compared with wider, and slopes this part of the light's: more than the rounding of
/// either and of what is done with them.
pub(super) const ROUNDING: f32 = 16.0 * f32::EPSILON;

/// From farther away, in units of the crowd, nothing of it can be told apart.
pub(super) const FARTHEST: f64 = 1e6;

/// Those in which a crowd is about as large as 1, with its middle at the origin.
#[derive(Debug, Clone, Copy)]
pub(super) struct Units {
    pub(super) origin: Event,
    pub(super) scale: f64,
}

impl Units {
    /// Those of some boxes, each at its moment.
    pub(super) fn around<'m>(boxes: impl Iterator<Item = &'m Moving> + Clone) -> Self {
        let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut lo, mut hi) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for one in boxes {
            (first, last) = (first.min(one.moment), last.max(one.moment));
            (lo, hi) = (lo.min(one.lo), hi.max(one.hi));
        }
        let size = 0.5 * (hi - lo).max_element().max(last - first).max(1e-200);
        Self { origin: Event::new(0.5 * first + 0.5 * last, 0.5 * lo + 0.5 * hi), scale: 1.0 / size }
    }
}

/// A ray in these units, or the least and the greatest that rays which go together have; s counts the units, too.
#[derive(Clone, Copy)]
pub(super) struct Asked {
    pub(super) start: [[f32; 3]; 2],
    pub(super) moment: [f32; 2],
    // What it moves by, as its time goes by 1.
    pub(super) step: [[f32; 3]; 2],
    // More than what rounding adds to a distance.
    pub(super) pad: f32,
    pub(super) s_max: f32,
    // One of the ray's own s.
    pub(super) length: f64,
    pub(super) alone: bool,
}

impl Asked {
    /// None for a ray from too far away.
    #[inline]
    pub(super) fn new(ray: &SightRay, s_max: f64, units: &Units) -> Option<Self> {
        let from = ray.event - units.origin;
        let (start, moment) = (from.x * units.scale, from.t * units.scale);
        let length = ray.k.t * units.scale;
        let own = start.abs().max_element() + moment.abs();
        let numbers = ray.event.x.abs().max_element() + ray.event.t.abs();
        let exact = moving::ROUNDING * numbers * units.scale;
        if !(own < FARTHEST && exact < 1.0 && length > 0.0 && length < f64::INFINITY) {
            return None;
        }
        let step = (ray.k.x / ray.k.t).as_vec3().to_array();
        let mut asked = Self {
            start: [start.as_vec3().to_array(); 2],
            moment: [moment as f32; 2],
            step: [step; 2],
            pad: ROUNDING * (own as f32 + 2.0) + exact as f32,
            s_max: f32::MAX,
            length,
            alone: true,
        };
        asked.limit(s_max);
        Some(asked)
    }

    #[inline]
    pub(super) fn limit(&mut self, s_max: f64) {
        self.s_max = (s_max * self.length * 1.000_001).min(f64::from(f32::MAX)) as f32;
    }
}

/// Eight moving boxes, lane by lane, and where they go on.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(super) struct Node {
    moment: [f32; 8],
    // By axis.
    lo: [[f32; 8]; 3],
    hi: [[f32; 8]; 3],
    v_lo: [[f32; 8]; 3],
    v_hi: [[f32; 8]; 3],
    // An inner child: its index in `nodes`. A leaf: the number of a rest frame.
    pub(super) child: [u32; 8],
    // The bits of those lanes that have one.
    there: u32,
    // Whether what is in each box has one velocity.
    rigid: bool,
}

impl Node {
    /// Without any box.
    pub(super) const EMPTY: Self = Self {
        moment: [0.0; 8],
        lo: [[0.0; 8]; 3],
        hi: [[0.0; 8]; 3],
        v_lo: [[0.0; 8]; 3],
        v_hi: [[0.0; 8]; 3],
        child: [NOBODY; 8],
        there: 0,
        rigid: true,
    };

    pub(super) fn set(&mut self, lane: usize, child: u32, moving: &Moving, units: &Units) {
        let place = |x: DVec3| ((x - units.origin.x) * units.scale).as_vec3();
        let moment = (moving.moment - units.origin.t) * units.scale;
        self.moment[lane] = moment as f32;
        let (lo, hi) = (place(moving.lo), place(moving.hi));
        // The moment is rounded too, and what is inside moves no faster than light. Of the units' own origin the last digits are lost.
        let own = units.origin.x.abs().max_element() + units.origin.t.abs();
        let far = lo.abs().max(hi.abs()).max_element() + self.moment[lane].abs() + 1.0;
        let pad = ROUNDING * far + (moving::ROUNDING * own * units.scale) as f32;
        for axis in 0..3 {
            self.lo[axis][lane] = lo[axis] - pad;
            self.hi[axis][lane] = hi[axis] + pad;
            self.v_lo[axis][lane] = moving.v_lo[axis] as f32;
            self.v_hi[axis][lane] = moving.v_hi[axis] as f32;
        }
        self.child[lane] = child;
        self.there |= 1 << lane;
        self.rigid &= moving.v_lo == moving.v_hi;
    }

    /// Where a ray may enter each box, and the bits of those that it may enter before the limit; of rays that go together where the
    /// first of them may.
    #[inline]
    pub(super) fn entries(&self, ray: &Asked) -> ([f32; 8], u32) {
        let stretch = |v_lo, v_hi, within| with_best(Stretch { node: self, ray, v_lo, v_hi, within });
        if self.rigid {
            let (near, met) = if ray.alone {
                with_best(Rigid { node: self, ray })
            } else {
                stretch(&self.v_lo, &self.v_hi, (&[0.0; 8], &[ray.s_max; 8]))
            };
            return (near, met & self.there);
        }
        // Rays go back in time: Δ = ahead - s.
        let turn = |side: usize| -> [f32; 8] {
            from_fn(|i| (ray.moment[side] - self.moment[i]).max(0.0).min(ray.s_max))
        };
        let (first, last) = (turn(0), turn(1));
        let (late, met_late) = stretch(&self.v_lo, &self.v_hi, (&[0.0; 8], &last));
        let (early, met_early) = stretch(&self.v_hi, &self.v_lo, (&first, &[ray.s_max; 8]));
        let if_met = |near: f32, met: u32, i: usize| if met >> i & 1 == 1 { near } else { f32::INFINITY };
        (
            from_fn(|i| if_met(late[i], met_late, i).min(if_met(early[i], met_early, i))),
            (met_late | met_early) & self.there,
        )
    }

    /// One of the boxes, of something that has one velocity.
    pub(super) fn resting(&self, lane: usize) -> Resting {
        let of = |all: &[[f32; 8]; 3]| all.map(|axis| axis[lane]);
        Resting { moment: self.moment[lane], lo: of(&self.lo), hi: of(&self.hi), v: of(&self.v_lo) }
    }
}

/// Part of a ray, for each box: the first s at which it is within the faces, which move with these velocities, and the bits
/// of those boxes in which it is at all. (Of rays that go together none is nearer to a face, or comes nearer faster, than is said.)
struct Stretch<'a> {
    node: &'a Node,
    ray: &'a Asked,
    v_lo: &'a [[f32; 8]; 3],
    v_hi: &'a [[f32; 8]; 3],
    within: (&'a [f32; 8], &'a [f32; 8]),
}

impl Task for Stretch<'_> {
    type Output = ([f32; 8], u32);

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Self::Output {
        let Self { node, ray, .. } = self;
        let a: [f32; 8] = from_fn(|i| ray.moment[0] - node.moment[i]);
        let b: [f32; 8] = from_fn(|i| ray.moment[1] - node.moment[i]);
        let pad: [f32; 8] = from_fn(|i| ray.pad + ROUNDING * a[i].abs().max(b[i].abs()));
        let mut within = (*self.within.0, *self.within.1);
        for axis in 0..3 {
            let (start, step) = (ray.start.map(|x| x[axis]), ray.step.map(|k| k[axis]));
            let (lo, hi) = (&node.lo[axis], &node.hi[axis]);
            let (v_lo, v_hi) = (&self.v_lo[axis], &self.v_hi[axis]);
            let moved: [f32; 8] = from_fn(|i| (v_lo[i] * a[i]).min(v_lo[i] * b[i]));
            let room: [f32; 8] = from_fn(|i| start[1] - lo[i] - moved[i] + pad[i]);
            within = beyond(within, &room, &from_fn(|i| step[0] - v_lo[i] - ROUNDING));
            let moved: [f32; 8] = from_fn(|i| (v_hi[i] * a[i]).max(v_hi[i] * b[i]));
            let room: [f32; 8] = from_fn(|i| hi[i] + moved[i] - start[0] + pad[i]);
            within = beyond(within, &room, &from_fn(|i| v_hi[i] - step[1] - ROUNDING));
        }
        let (first, last) = within;
        let last = last.map(|last| last * (1.0 + ROUNDING));
        (first, lanes.at_most_8(first, last))
    }
}

/// The same for all of one ray, where what is in each box has one velocity: the box rests, and the ray goes by.
struct Rigid<'a> {
    node: &'a Node,
    ray: &'a Asked,
}

/// A box of one velocity.
pub(super) struct Resting {
    pub(super) moment: f32,
    pub(super) lo: [f32; 3],
    pub(super) hi: [f32; 3],
    pub(super) v: [f32; 3],
}

/// No slope is less, so that nothing is infinite. (Below `ROUNDING` nothing is said by an axis.)
const FLATTEST: f32 = 1e-12;

/// Where a line is between two faces that rest, from `place` with `slope`: the first s, and the last.
#[inline(always)]
pub(super) fn between(place: f32, slope: f32, (lo, hi): (f32, f32), pad: f32) -> (f32, f32) {
    let per_slope = 1.0 / if slope.abs() > FLATTEST { slope } else { FLATTEST };
    let one = (place - hi - pad) * per_slope;
    let other = (place - lo + pad) * per_slope;
    let slack = ROUNDING * (1.0 + per_slope.abs());
    let (enter, leave) = if one < other { (one, other) } else { (other, one) };
    (enter - enter.abs() * slack, leave + leave.abs() * slack)
}

impl Task for Rigid<'_> {
    type Output = ([f32; 8], u32);

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Self::Output {
        let Self { node, ray } = self;
        let ahead: [f32; 8] = from_fn(|i| ray.moment[0] - node.moment[i]);
        let pad: [f32; 8] = from_fn(|i| ray.pad + ROUNDING * ahead[i].abs());
        let (mut first, mut last) = ([0.0_f32; 8], [ray.s_max; 8]);
        for axis in 0..3 {
            let (x, k) = (ray.start[0][axis], ray.step[0][axis]);
            let (lo, hi, v) = (&node.lo[axis], &node.hi[axis], &node.v_lo[axis]);
            for i in 0..8 {
                let (enter, leave) = between(x - v[i] * ahead[i], k - v[i], (lo[i], hi[i]), pad[i]);
                first[i] = if enter > first[i] { enter } else { first[i] };
                last[i] = if leave < last[i] { leave } else { last[i] };
            }
        }
        (first, lanes.at_most_8(first, last))
    }
}

/// What is left of stretches of s where `room >= s closing`.
#[inline(always)]
fn beyond((first, last): ([f32; 8], [f32; 8]), room: &[f32; 8], closing: &[f32; 8]) -> ([f32; 8], [f32; 8]) {
    // Along a face it is beyond it, or not, for ever: room / 0. (The sum makes a negative zero a positive one.)
    let s: [f32; 8] = from_fn(|i| room[i] / (closing[i] + 0.0));
    let after: [f32; 8] = from_fn(|i| if closing[i] < 0.0 { s[i] } else { f32::NEG_INFINITY });
    let before: [f32; 8] = from_fn(|i| if closing[i] < 0.0 { f32::INFINITY } else { s[i] });
    (
        from_fn(|i| if after[i] > first[i] { after[i] } else { first[i] }),
        from_fn(|i| if before[i] < last[i] { before[i] } else { last[i] }),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Plain;
    use crate::spacetime::FourVector;

    /// Multiples of a golden ratio, parts of 1: spread evenly enough.
    fn spread(i: u32) -> DVec3 {
        let part = |ratio: f64| 2.0 * (f64::from(i) * ratio).fract() - 1.0;
        DVec3::new(part(0.618_033_988_749), part(0.754_877_666_247), part(0.569_840_290_998))
    }

    /// Draw number `i` of a few between 0 and 1.
    fn part(i: u32) -> f64 {
        0.5 + 0.5 * spread(i).x
    }

    #[test]
    fn a_ray_meets_what_moves_with_a_box_before_and_after_its_moment_and_passes_what_has_gone_on() {
        let (mut late, mut missed) = (0, 0);
        for number in 0..2000_u32 {
            // One velocity, or a range of them.
            let range = if number % 2 == 0 { 0.0 } else { 0.6 };
            let (lo, v_lo) = (0.5 * spread(3 * number), 0.3 * spread(5 * number) - 0.5 * range);
            let (hi, v_hi) = (lo + 0.1, v_lo + range);
            let one = Moving { moment: part(7 * number), lo, hi, v_lo, v_hi };
            let units = Units::around([one].iter());
            let mut node = Node::EMPTY;
            let lane = number as usize % 8;
            node.set(lane, 0, &one, &units);
            assert_eq!(node.rigid, range == 0.0);
            // Something in it, at its corners above all, with one of its velocities, met at a time `after` its moment.
            let after = 4.0 * (2.0 * part(11 * number) - 1.0);
            let corner = |i: u32| (0.5 + spread(i)).clamp(DVec3::ZERO, DVec3::ONE);
            let v = v_lo + (v_hi - v_lo) * corner(13 * number);
            let place = lo + (hi - lo) * corner(17 * number) + v * after;
            let met = Event::new(one.moment + after, place);
            let (s, k) =
                (0.1 + 3.0 * part(19 * number), FourVector::new(1.0, spread(23 * number).normalize()));
            let from = |met: Event| {
                let ray = SightRay { event: met + k * s, k };
                Asked::new(&ray, 10.0, &units).unwrap()
            };
            let ray = from(met);
            let (entries, bits) = node.entries(&ray);
            let reached = (s * ray.length) as f32;
            assert!(bits == 1 << lane && entries[lane] <= reached * 1.001 + 1e-3, "{number}: {after}");
            late += u32::from(after > 0.0);
            // Light that would meet it where it would be if it had not moved, or had moved the other way, goes by (if it does not
            // meet it at another time).
            if range > 0.0 || (v * after).length() < 1.0 {
                continue;
            }
            let elsewhere = from(Event::new(met.t, met.x - 2.0 * v * after));
            let meets = |s: f64| {
                let at = Event::new(met.t, met.x - 2.0 * v * after) + k * (3.0 * part(19 * number) + 0.1 - s);
                let inside = at.x - v * (at.t - one.moment);
                (lo - 0.01).cmple(inside).all() && inside.cmple(hi + 0.01).all()
            };
            if !(0..10_000).any(|i| meets(f64::from(i) * 1e-3)) {
                assert_eq!(node.entries(&elsewhere).1, 0, "{number}");
                missed += 1;
            }
        }
        assert!((800..1200).contains(&late) && missed > 20, "{late} {missed}");
    }

    #[test]
    fn all_instruction_sets_enter_the_same_boxes() {
        let mut entered = 0;
        for number in 0..500 {
            let boxes: [Moving; 7] = from_fn(|i| {
                let i = 7 * number + i as u32;
                let (lo, v_lo) = (spread(3 * i), 0.5 * spread(5 * i));
                let looser = if number % 2 == 0 { 0.0 } else { 0.01 };
                let (hi, v_hi) = (lo + 0.8, v_lo + looser);
                Moving { moment: spread(11 * i).x, lo, hi, v_lo, v_hi }
            });
            let units = Units::around(boxes.iter());
            let mut node = Node::EMPTY;
            for (lane, one) in boxes.iter().enumerate() {
                node.set(lane, lane as u32, one, &units);
            }
            let k = FourVector::new(1.0, spread(13 * number).normalize());
            let ray = SightRay { event: Event::new(1.0, spread(17 * number)), k };
            let ray = Asked::new(&ray, 5.0, &units).unwrap();
            let (start, end) = ([0.0; 8], [ray.s_max; 8]);
            let stretch = || Stretch {
                node: &node,
                ray: &ray,
                v_lo: &node.v_lo,
                v_hi: &node.v_hi,
                within: (&start, &end),
            };
            assert_eq!(with_best(stretch()), stretch().run(Plain));
            let rigid = || Rigid { node: &node, ray: &ray };
            assert_eq!(with_best(rigid()), rigid().run(Plain));
            entered += node.entries(&ray).1.count_ones();
        }
        assert!((100..3000).contains(&entered), "{entered}");
    }
}
