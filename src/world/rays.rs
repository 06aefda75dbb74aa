//! Sight rays that go together, coordinate by coordinate, and what they are in a rest frame.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

use super::{Departure, RestFrame};
use crate::simd::{Lanes, Task, with_best};
use crate::spacetime::{Lab, Poincare, Rest, SightRay};
use crate::tree::{Each, Lines, MANY, each, plus};

/// Up to 16 rays in the lab, and to which s each goes. (What would follow the last is as the first, and goes nowhere.)
pub(super) struct Rays<'r> {
    of: [Option<(&'r SightRay, Option<&'r Departure<'r>>)>; MANY],
    count: usize,
    pub(super) t: Each<f64>,
    pub(super) x: [Each<f64>; 3],
    pub(super) k_t: Each<f64>,
    pub(super) k: [Each<f64>; 3],
    pub(super) s_max: Each<f64>,
}

impl<'r> Rays<'r> {
    /// From rays, the bodies that they may leave, and their limits of s.
    pub(super) fn of(rays: impl IntoIterator<Item = (&'r SightRay, Option<&'r Departure<'r>>, f64)>) -> Self {
        let mut all = Self {
            of: [None; MANY],
            count: 0,
            t: [0.0; MANY],
            x: [[0.0; MANY]; 3],
            k_t: [0.0; MANY],
            k: [[0.0; MANY]; 3],
            s_max: [-1.0; MANY],
        };
        for (i, (ray, from, s_max)) in rays.into_iter().take(MANY).enumerate() {
            all.of[i] = Some((ray, from));
            all.set(i, ray);
            all.s_max[i] = s_max;
            all.count = i + 1;
        }
        if let Some((first, _)) = all.of[0] {
            (all.count..MANY).for_each(|i| all.set(i, first));
        }
        all
    }

    #[inline]
    fn set(&mut self, i: usize, ray: &SightRay) {
        (self.t[i], self.k_t[i]) = (ray.event.t, ray.k.t);
        for axis in 0..3 {
            (self.x[axis][i], self.k[axis][i]) = (ray.event.x[axis], ray.k.x[axis]);
        }
    }

    /// How many.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The rays in a rest frame, as [`RestFrame::line`] has them, to the bit.
    pub(super) fn within(&self, rest: &RestFrame) -> Lines {
        if rest.rest_from_lab.boost().is_fast() {
            return Lines::of(self.of.iter().flatten().map(|(ray, from)| rest.line(ray, *from)));
        }
        let mut lines = with_best(Moved { rays: self, by: &rest.rest_from_lab });
        for (i, (_, from)) in self.of.iter().flatten().enumerate() {
            if let Some(from) = from.filter(|from| std::ptr::eq(from.rest, rest)) {
                lines.begin(i, from.at.x);
            }
        }
        lines
    }
}

/// Rays to be moved to a frame that is not fast.
struct Moved<'a> {
    rays: &'a Rays<'a>,
    by: &'a Poincare<Rest, Lab>,
}

impl Task for Moved<'_> {
    type Output = Lines;

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) -> Lines {
        let Rays { t, x, k_t, k, .. } = self.rays;
        let (origin, (u, gamma)) = (self.by.origin(), self.by.boost().proper_and_gamma());
        let from = [origin.x.x, origin.x.y, origin.x.z];
        let u = [u.x, u.y, u.z];
        let t: Each<f64> = each(|i| t[i] - origin.t);
        let x = [plus(&x[0], -from[0]), plus(&x[1], -from[1]), plus(&x[2], -from[2])];
        let (by, steps) = (pushes(u, gamma, &t, &x), pushes(u, gamma, k_t, k));
        // (The sum makes a negative zero a positive one, as that with the origin does.)
        let place = |axis: usize| -> Each<f64> { each(|i| 0.0 + (x[axis][i] + u[axis] * by[i])) };
        let step = |axis: usize| -> Each<f64> { each(|i| -(k[axis][i] + u[axis] * steps[i])) };
        Lines {
            origin: [place(0), place(1), place(2)],
            step: [step(0), step(1), step(2)],
            count: self.rays.count,
        }
    }
}

/// How many u a boost adds to the places: see [`Boost`](crate::spacetime::Boost), one by one.
#[inline(always)]
fn pushes(u: [f64; 3], gamma: f64, t: &Each<f64>, [x, y, z]: &[Each<f64>; 3]) -> Each<f64> {
    let along: Each<f64> = each(|i| u[0] * x[i] + u[1] * y[i] + u[2] * z[i]);
    each(|i| along[i] / (gamma + 1.0) - t[i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Plain;
    use crate::spacetime::{Event, FourVector, Velocity};
    use glam::DVec3;

    #[test]
    fn rays_are_moved_as_one_by_one_with_all_instruction_sets() {
        let spread = |i: usize| {
            let part = |ratio: f64| 2.0 * (i as f64 * ratio).fract() - 1.0;
            DVec3::new(part(0.618_033_988_749), part(0.754_877_666_247), part(0.569_840_290_998))
        };
        for number in 0..200 {
            // Some at rest, some fast.
            let beta = [0.0, 0.3, 0.96, 0.97, 0.999_999][number / MANY % 5];
            let velocity = Velocity::from_beta(spread(3 * number).normalize() * beta).unwrap();
            let origin = Event::new(spread(5 * number).x, spread(7 * number));
            let origin = if number % 2 == 0 { origin } else { Event::ORIGIN };
            let rest = RestFrame::new(Poincare::to_moving(velocity, origin), Vec::new());
            let other = RestFrame::new(Poincare::to_moving(velocity, Event::ORIGIN), Vec::new());
            let count = 1 + number % MANY;
            let rays: Vec<SightRay> = (0..count)
                .map(|i| {
                    let event = Event::new(spread(11 * (number + i)).y, 9.0 * spread(13 * (number + i)));
                    // One at the lab's origin, where zeros have signs.
                    let event = if i == 3 { Event::new(-0.0, -DVec3::ZERO) } else { event };
                    SightRay { event, k: FourVector::new(1.0, spread(17 * (number + i)).normalize()) }
                })
                .collect();
            // Some leave a body of this frame, some one of another.
            let departures: Vec<Departure<'_>> = rays
                .iter()
                .enumerate()
                .map(|(i, ray)| {
                    let rest = if i % 2 == 0 { &rest } else { &other };
                    Departure { event: ray.event, rest, at: Event::new(0.0, spread(19 * (number + i))) }
                })
                .collect();
            let from = |i: usize| (!i.is_multiple_of(3)).then(|| &departures[i]);
            let all = Rays::of(rays.iter().enumerate().map(|(i, ray)| (ray, from(i), 1.0)));
            let lines = all.within(&rest);
            let plain = Moved { rays: &all, by: &rest.rest_from_lab }.run(Plain);
            let bits = |x: DVec3| x.to_array().map(f64::to_bits);
            assert_eq!(lines.count, count);
            for (i, ray) in rays.iter().enumerate() {
                let (found, alone) = (lines.line(i), rest.line(ray, from(i)));
                assert_eq!(bits(found.origin), bits(alone.origin), "{number} {i}");
                assert_eq!(bits(found.step), bits(alone.step), "{number} {i}");
                if rest.rest_from_lab.boost().is_fast() {
                    continue;
                }
                assert_eq!(bits(plain.line(i).step), bits(alone.step), "{number} {i}");
                let elsewhere = rest.line(ray, None);
                assert_eq!(bits(plain.line(i).origin), bits(elsewhere.origin), "{number} {i}");
            }
        }
    }
}
