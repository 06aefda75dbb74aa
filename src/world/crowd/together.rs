//! Which rest frames rays that go together can meet.
//!
//! A node is asked once for all of them, by the least and the greatest of their numbers; and a rest frame's own box by all of them,
//! lane by lane.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

use super::super::rays::Rays;
use super::Crowd;
use super::moving;
use super::node::{Asked, FARTHEST, LEAF, ROUNDING, Resting, Units, between};
use crate::simd::{Lanes, Task, with_best};
use crate::tree::{Each, MANY, each, greatest, least};
use smallvec::SmallVec;

/// A rest frame's number, and where each of some rays may enter its box first: infinite if it cannot.
struct Entered {
    number: u32,
    first: Each<f32>,
}

impl Crowd {
    /// Calls `visit` with every rest frame that any of some rays may meet before its limit of s, and at which s each may meet it first
    /// (infinite if it cannot); roughly those that may be met first before others.
    pub(in crate::world) fn meeting(&self, rays: &Rays<'_>, mut visit: impl FnMut(u32, &Each<f64>)) {
        if rays.count() == 0 {
            return;
        }
        let anywhere = each(|i| if i < rays.count() { 0.0 } else { f64::INFINITY });
        self.endless.iter().for_each(|number| visit(*number, &anywhere));
        let Some(root) = self.root else { return };
        let Some((beside, together)) = with_best(Beginning { rays, units: &self.units }) else {
            return self.everybody().for_each(|number| visit(number, &anywhere));
        };
        // (A tree over one alone is a leaf without a box.)
        if root & LEAF != 0 {
            return visit(root & !LEAF, &anywhere);
        }
        let all = self.entered(root, &beside, &together);
        let mut order: SmallVec<[(f32, u32, u32); MANY]> = SmallVec::new();
        order.extend((0..).zip(&all).map(|(place, one)| (least(&one.first), one.number, place)));
        order.sort_unstable_by(|(a, i, _), (b, j, _)| a.total_cmp(b).then(i.cmp(j)));
        for (_, number, place) in order {
            let first = &all[place as usize].first;
            visit(number, &each(|i| f64::from(first[i]) * beside.per_length[i]));
        }
    }

    fn entered(&self, root: u32, beside: &Beside, together: &Asked) -> SmallVec<[Entered; 8]> {
        let mut all = SmallVec::new();
        let mut open: SmallVec<[u32; 64]> = SmallVec::from_slice(&[root]);
        while let Some(at) = open.pop() {
            let node = &self.nodes[at as usize];
            let (_, mut entered) = node.entries(together);
            while entered != 0 {
                let lane = entered.trailing_zeros() as usize & 7;
                entered &= entered - 1;
                let child = node.child[lane];
                if child & LEAF == 0 {
                    open.push(child);
                    continue;
                }
                let first = with_best(Passing { rays: beside, by: &node.resting(lane) });
                if least(&first) < f32::INFINITY {
                    all.push(Entered { number: child & !LEAF, first });
                }
            }
        }
        all
    }
}

/// Rays one beside another, in the units of a crowd: each as [`Asked`] has it.
struct Beside {
    start: [Each<f32>; 3],
    moment: Each<f32>,
    step: [Each<f32>; 3],
    pad: Each<f32>,
    s_max: Each<f32>,
    // What makes s of what a box says, and a little less, for the rounding.
    per_length: Each<f64>,
}

/// Rays to be brought into the units of a crowd: one beside another, and the least and the greatest of their numbers. None if one of
/// them is from too far away.
struct Beginning<'a> {
    rays: &'a Rays<'a>,
    units: &'a Units,
}

impl Task for Beginning<'_> {
    type Output = Option<(Beside, Asked)>;

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) -> Self::Output {
        let Units { origin, scale } = *self.units;
        let Rays { t, x: [x, y, z], k_t, k, s_max, .. } = self.rays;
        let away = |of: &Each<f64>, from: f64| -> Each<f64> { each(|i| (of[i] - from) * scale) };
        let start = [away(x, origin.x.x), away(y, origin.x.y), away(z, origin.x.z)];
        let moment = away(t, origin.t);
        let length: Each<f64> = each(|i| k_t[i] * scale);
        let own = largest(&start, &moment);
        let numbers = largest(&[*x, *y, *z], t);
        let exact: Each<f64> = each(|i| moving::ROUNDING * numbers[i] * scale);
        let sum: Each<f64> = each(|i| start[0][i] + start[1][i] + start[2][i] + k[0][i] + k[1][i] + k[2][i]);
        // (All are looked at, without a branch for each.)
        let is_number: Each<bool> = each(|i| sum[i].is_finite());
        let is_near: Each<bool> = each(|i| own[i] < FARTHEST);
        let is_exact: Each<bool> = each(|i| exact[i] < 1.0);
        let goes: Each<bool> = each(|i| length[i] > 0.0);
        let ends: Each<bool> = each(|i| length[i] < f64::INFINITY);
        if !(0..MANY).fold(true, |all, i| all & is_number[i] & is_near[i] & is_exact[i] & goes[i] & ends[i]) {
            return None;
        }
        let step = |k: &Each<f64>| -> Each<f32> { each(|i| (k[i] / k_t[i]) as f32) };
        let beside = Beside {
            start: [rounded(&start[0]), rounded(&start[1]), rounded(&start[2])],
            moment: rounded(&moment),
            step: [step(&k[0]), step(&k[1]), step(&k[2])],
            pad: each(|i| ROUNDING * (own[i] as f32 + 2.0) + exact[i] as f32),
            s_max: each(|i| (s_max[i] * length[i] * 1.000_001).min(f64::from(f32::MAX)) as f32),
            per_length: each(|i| 0.999_999 / length[i]),
        };
        let together = Asked {
            start: range(&beside.start),
            moment: [least(&beside.moment), greatest(&beside.moment)],
            step: range(&beside.step),
            pad: greatest(&beside.pad),
            s_max: greatest(&beside.s_max),
            length: 1.0, // Not asked: each has its own.
            alone: false,
        };
        Some((beside, together))
    }
}

/// The least and the greatest, by axis.
#[inline(always)]
fn range([x, y, z]: &[Each<f32>; 3]) -> [[f32; 3]; 2] {
    [[least(x), least(y), least(z)], [greatest(x), greatest(y), greatest(z)]]
}

#[inline(always)]
fn rounded(of: &Each<f64>) -> Each<f32> {
    each(|i| of[i] as f32)
}

/// The largest of three coordinates, and a fourth.
#[inline(always)]
fn largest([x, y, z]: &[Each<f64>; 3], t: &Each<f64>) -> Each<f64> {
    each(|i| x[i].abs().max(y[i].abs().max(z[i].abs())) + t[i].abs())
}

/// Rays that go by a box of one velocity: where each may enter it, infinite for those that do not.
struct Passing<'a> {
    rays: &'a Beside,
    by: &'a Resting,
}

impl Task for Passing<'_> {
    type Output = Each<f32>;

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) -> Each<f32> {
        let Self { rays, by } = self;
        let (mut first, mut last) = ([0.0_f32; MANY], rays.s_max);
        for axis in 0..3 {
            let (lo, hi, v) = (by.lo[axis], by.hi[axis], by.v[axis]);
            for i in 0..MANY {
                let ahead = rays.moment[i] - by.moment;
                let pad = rays.pad[i] + ROUNDING * ahead.abs();
                let place = rays.start[axis][i] - v * ahead;
                let (enter, leave) = between(place, rays.step[axis][i] - v, (lo, hi), pad);
                first[i] = if enter > first[i] { enter } else { first[i] };
                last[i] = if leave < last[i] { leave } else { last[i] };
            }
        }
        each(|i| if first[i] <= last[i] { first[i] } else { f32::INFINITY })
    }
}

#[cfg(test)]
mod tests {
    use super::super::moving::Moving;
    use super::super::node::{Node, Units};
    use super::*;
    use crate::simd::Plain;
    use crate::spacetime::{Event, FourVector, SightRay};
    use glam::DVec3;
    use std::array::from_fn;

    /// Multiples of a golden ratio, parts of 1: spread evenly enough.
    fn spread(i: usize) -> DVec3 {
        let part = |ratio: f64| 2.0 * (i as f64 * ratio).fract() - 1.0;
        DVec3::new(part(0.618_033_988_749), part(0.754_877_666_247), part(0.569_840_290_998))
    }

    #[test]
    fn rays_together_enter_what_any_of_them_enters_and_each_where_it_would_alone() {
        let (mut entered, mut spared) = (0, 0);
        for number in 0..1000 {
            // All rigid, or some in a range of velocities.
            let range = if number % 2 == 0 { 0.0 } else { 0.2 };
            let boxes: [Moving; 8] = from_fn(|i| {
                let i = 8 * number + i;
                let (lo, v) = (spread(3 * i), 0.7 * spread(5 * i));
                Moving { moment: spread(11 * i).x, lo, hi: lo + 0.3, v_lo: v, v_hi: v + range }
            });
            let units = Units::around(boxes.iter());
            let mut node = Node::EMPTY;
            boxes.iter().enumerate().for_each(|(lane, one)| node.set(lane, lane as u32, one, &units));
            let count = 1 + number % MANY;
            // From one event, as from a camera, or from several, as to a lamp.
            let wide = [0.0, 0.02, 0.5][number % 3];
            let rays: Vec<(SightRay, f64)> = (0..count)
                .map(|i| {
                    let along = (spread(13 * number) + 0.1 * spread(17 * (number + i))).normalize();
                    let own = wide * spread(19 * (number + i));
                    let event = Event::new(1.0 + own.y, spread(23 * number) + own);
                    let k = FourVector::new(1.0, along) * (1.0 + i as f64);
                    (SightRay { event, k }, 0.5 + spread(29 * i).x)
                })
                .collect();
            let asked: Vec<Asked> =
                rays.iter().map(|(ray, s_max)| Asked::new(ray, *s_max, &units).unwrap()).collect();
            let all = Rays::of(rays.iter().map(|(ray, s_max)| (ray, None, *s_max)));
            let (lanes, together) = with_best(Beginning { rays: &all, units: &units }).unwrap();
            let (near, all) = node.entries(&together);
            for (lane, near) in near.into_iter().enumerate() {
                let by = &node.resting(lane);
                let first = with_best(Passing { rays: &lanes, by });
                assert_eq!(first, Passing { rays: &lanes, by }.run(Plain));
                let alone = asked.iter().map(|ray| node.entries(ray));
                let alone: Vec<f32> = alone
                    .map(|(near, met)| if met >> lane & 1 == 1 { near[lane] } else { f32::INFINITY })
                    .collect();
                assert!(range > 0.0 || alone == first[..count], "{number}");
                assert!(first[count..].iter().all(|first| *first == f32::INFINITY));
                let soonest = alone.iter().copied().fold(f32::INFINITY, f32::min);
                let is_entered = all >> lane & 1 == 1;
                assert!(
                    soonest == f32::INFINITY || is_entered && near <= soonest * 1.001 + 1e-4,
                    "{number}: {near} {soonest}"
                );
                entered += u32::from(soonest < f32::INFINITY);
                spared += u32::from(!is_entered);
            }
        }
        assert!(entered > 300 && spared > 1000, "{entered} {spared}");
    }
}
