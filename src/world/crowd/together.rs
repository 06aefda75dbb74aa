//! Which rest frames rays that go together can meet.
//!
//! A node is asked once for all of them, by the least and the greatest of their numbers; and a rest frame's own box by all of them,
//! lane by lane.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

use super::Crowd;
use super::node::{Asked, LEAF, ROUNDING, Resting, between};
use crate::simd::{Lanes, Task, with_best};
use crate::spacetime::SightRay;
use crate::tree::{Each, MANY, each};
use smallvec::SmallVec;

/// Rest frames by number, and for each of some rays at which s it may meet it first: infinite if it cannot.
type Meeting = SmallVec<[(u32, Each<f64>); 4]>;

impl Crowd {
    /// The rest frames that any of up to 16 rays may meet before its limit of s, those that may be met first before others.
    pub(in crate::world) fn meeting<'r>(
        &self,
        rays: impl Iterator<Item = (&'r SightRay, f64)> + Clone,
    ) -> impl IntoIterator<Item = (u32, Each<f64>)> {
        let count = rays.clone().count();
        let all = each(|i| if i < count { 0.0 } else { f64::INFINITY });
        let mut met: Meeting = self.endless.iter().map(|number| (*number, all)).collect();
        let asked: Option<SmallVec<[Asked; MANY]>> =
            rays.map(|(ray, s_max)| Asked::new(ray, s_max, &self.units)).collect();
        match (self.root, asked) {
            (None, _) => {}
            (Some(_), None) => met.extend(self.everybody().map(|number| (number, all))),
            (Some(root), Some(asked)) => self.add_meeting(root, &asked, &mut met),
        }
        met
    }

    fn add_meeting(&self, root: u32, asked: &[Asked], met: &mut Meeting) {
        let Some(together) = asked.iter().copied().reduce(|all, one| all.with(&one)) else { return };
        let lanes = Beside::new(asked);
        let known = met.len();
        let mut open: SmallVec<[u32; 64]> = SmallVec::new();
        // (A tree over one alone is a leaf without a box.)
        if root & LEAF != 0 {
            met.push((root & !LEAF, each(|i| if i < asked.len() { 0.0 } else { f64::INFINITY })));
        } else {
            open.push(root);
        }
        while let Some(at) = open.pop() {
            let node = &self.nodes[at as usize];
            let (_, entered) = node.entries(&together);
            for lane in (0..8).filter(|lane| entered >> lane & 1 == 1) {
                let child = node.child[lane];
                if child & LEAF == 0 {
                    open.push(child);
                    continue;
                }
                let first = with_best(Passing { rays: &lanes, by: &node.resting(lane) });
                if first.iter().any(|first| *first < f32::INFINITY) {
                    met.push((child & !LEAF, each(|i| f64::from(first[i]) * lanes.per_length[i])));
                }
            }
        }
        let soonest = |(number, first): &(u32, Each<f64>)| {
            (first.iter().copied().fold(f64::INFINITY, f64::min), *number)
        };
        met[known..].sort_unstable_by(|a, b| {
            let ((a, i), (b, j)) = (soonest(a), soonest(b));
            a.total_cmp(&b).then(i.cmp(&j))
        });
    }
}

/// Rays one beside another.
struct Beside {
    start: [Each<f32>; 3],
    moment: Each<f32>,
    step: [Each<f32>; 3],
    pad: Each<f32>,
    s_max: Each<f32>,
    // What makes s of what a box says, and a little less, for the rounding.
    per_length: Each<f64>,
}

impl Beside {
    fn new(asked: &[Asked]) -> Self {
        let mut all = Self {
            start: [[0.0; MANY]; 3],
            moment: [0.0; MANY],
            step: [[0.0; MANY]; 3],
            pad: [0.0; MANY],
            s_max: [-1.0; MANY],
            per_length: [1.0; MANY],
        };
        for (i, one) in asked.iter().enumerate().take(MANY) {
            for axis in 0..3 {
                all.start[axis][i] = one.start[0][axis];
                all.step[axis][i] = one.step[0][axis];
            }
            all.moment[i] = one.moment[0];
            all.pad[i] = one.pad;
            all.s_max[i] = one.s_max;
            all.per_length[i] = 0.999_999 / one.length;
        }
        all
    }
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
    use crate::spacetime::{Event, FourVector};
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
            let asked: Vec<Asked> = (0..count)
                .map(|i| {
                    let along = (spread(13 * number) + 0.1 * spread(17 * (number + i))).normalize();
                    let own = wide * spread(19 * (number + i));
                    let event = Event::new(1.0 + own.y, spread(23 * number) + own);
                    let ray = SightRay { event, k: FourVector::new(1.0, along) * (1.0 + i as f64) };
                    Asked::new(&ray, 0.5 + spread(29 * i).x, &units).unwrap()
                })
                .collect();
            let together = asked.iter().copied().reduce(|all, one| all.with(&one)).unwrap();
            let (near, all) = node.entries(&together);
            let lanes = Beside::new(&asked);
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
