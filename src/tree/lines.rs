//! Lines that go together, coordinate by coordinate, so that the same is done to all of them at once.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

use super::Line;
use crate::simd::{Lanes, Task, with_best};
use glam::{DAffine3, DVec3};
use std::array::from_fn;

/// So many lines go together at most.
pub const MANY: usize = 16;

/// Something of each line.
pub(crate) type Each<T> = [T; MANY];

/// The same of each. (A loop, since `from_fn` is not inlined for so many.)
#[inline(always)]
pub(crate) fn each<T: Copy + Default>(of: impl Fn(usize) -> T) -> Each<T> {
    let mut all = [T::default(); MANY];
    for (i, one) in all.iter_mut().enumerate() {
        *one = of(i);
    }
    all
}

/// The least of all. (By halves, so that it need not go one by one.)
#[inline(always)]
pub(crate) fn least(of: &Each<f32>) -> f32 {
    let mut some: [f32; 8] = from_fn(|i| if of[i] < of[i + 8] { of[i] } else { of[i + 8] });
    for half in [4, 2, 1] {
        for i in 0..half {
            some[i] = if some[i] < some[i + half] { some[i] } else { some[i + half] };
        }
    }
    some[0]
}

/// The greatest of all.
#[inline(always)]
pub(crate) fn greatest(of: &Each<f32>) -> f32 {
    -least(&each(|i| -of[i]))
}

/// Lets `lower` lower the limits of some lines, bit by bit: it sees negative ones for the others, which stay as they are.
#[inline(always)]
pub(crate) fn some_of(lines: u32, limits: &mut Each<f64>, lower: impl FnOnce(&mut Each<f64>)) {
    let mut within = each(|i| if lines >> i & 1 == 1 { limits[i] } else { -1.0 });
    lower(&mut within);
    *limits = each(|i| if lines >> i & 1 == 1 { within[i] } else { limits[i] });
}

/// Lines that go together, coordinate by coordinate.
#[derive(Debug, Clone)]
pub struct Lines {
    // Where s is zero, and what one unit of s moves, by axis.
    pub(crate) origin: [Each<f64>; 3],
    pub(crate) step: [Each<f64>; 3],
    pub(crate) count: usize,
}

impl Lines {
    /// Up to 16 of them.
    pub fn of(lines: impl IntoIterator<Item = Line>) -> Self {
        let mut all = Self { origin: [[0.0; MANY]; 3], step: [[0.0; MANY]; 3], count: 0 };
        for (i, line) in lines.into_iter().take(MANY).enumerate() {
            for axis in 0..3 {
                all.origin[axis][i] = line.origin[axis];
                all.step[axis][i] = line.step[axis];
            }
            all.count = i + 1;
        }
        all
    }

    /// Lets one of them begin somewhere.
    #[inline]
    pub(crate) fn begin(&mut self, i: usize, origin: DVec3) {
        for axis in 0..3 {
            self.origin[axis][i] = origin[axis];
        }
    }

    /// One of them.
    #[inline]
    pub(crate) fn line(&self, i: usize) -> Line {
        let at = |of: &[Each<f64>; 3]| DVec3::new(of[0][i], of[1][i], of[2][i]);
        Line { origin: at(&self.origin), step: at(&self.step) }
    }

    /// The same in other coordinates, as [`DAffine3`] has them, to the bit.
    pub(crate) fn through(&self, map: &DAffine3) -> Self {
        with_best(Through { lines: self, map })
    }
}

/// Lines to be transformed.
struct Through<'a> {
    lines: &'a Lines,
    map: &'a DAffine3,
}

impl Task for Through<'_> {
    type Output = Lines;

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) -> Lines {
        let Self { lines, map } = self;
        let [x, y, z] = map.matrix3.to_cols_array_2d();
        let moved = map.translation.to_array();
        let rows = [[x[0], y[0], z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]];
        let origin = turned(&lines.origin, &rows);
        Lines {
            origin: [plus(&origin[0], moved[0]), plus(&origin[1], moved[1]), plus(&origin[2], moved[2])],
            step: turned(&lines.step, &rows),
            count: lines.count,
        }
    }
}

#[inline(always)]
fn turned(of: &[Each<f64>; 3], rows: &[[f64; 3]; 3]) -> [Each<f64>; 3] {
    [weighed(of, rows[0]), weighed(of, rows[1]), weighed(of, rows[2])]
}

#[inline(always)]
fn weighed([x, y, z]: &[Each<f64>; 3], by: [f64; 3]) -> Each<f64> {
    each(|i| by[0] * x[i] + by[1] * y[i] + by[2] * z[i])
}

#[inline(always)]
pub(crate) fn plus(of: &Each<f64>, moved: f64) -> Each<f64> {
    each(|i| of[i] + moved)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Plain;

    #[test]
    fn lines_are_moved_as_one_by_one_with_all_instruction_sets() {
        let spread = |i: usize, ratio: f64| (i as f64 * ratio).fract() - 0.5;
        let place = |i: usize| {
            DVec3::new(
                spread(i, 0.618_033_988_749),
                spread(i, 0.754_877_666_247),
                spread(i, 0.569_840_290_998),
            )
        };
        for number in 0..100 {
            let line = |i: usize| Line { origin: place(number + 7 * i) * 1e3, step: place(number + 11 * i) };
            let map = DAffine3::from_cols_array(&from_fn(|i| spread(i + number, 0.445_041_867_913)));
            let lines = Lines::of((0..MANY).map(line));
            let plain = Through { lines: &lines, map: &map }.run(Plain);
            let best = lines.through(&map);
            for i in 0..MANY {
                let Line { origin, step } = lines.line(i);
                let expected = (map.transform_point3(origin), map.transform_vector3(step));
                for moved in [plain.line(i), best.line(i)] {
                    assert_eq!((moved.origin, moved.step), expected);
                }
            }
        }
    }
}
