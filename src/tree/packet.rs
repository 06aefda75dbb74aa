//! Lines that go through a tree together.
//!
//! A node is asked once for all of them: whether any line whose start and slopes lie between theirs may enter a child. Of what is
//! left each box is asked for each line, by the arithmetic of single walks: a line is told exactly those leaves to which its own walk
//! would lead (rounding keeps order, so the bounds of all lie outside of each). Where boxes become so small that few lines enter them
//! together, these go on one by one. Single walks are the oracle.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

use super::Wide;
use super::lines::{Each, Lines, MANY, each, least};
use super::open::Open;
use super::space::{Entered, SLACK, Space};
use super::wide::{LEAF, Node, Visit, blocks_of, walk_on};
use crate::simd::{Lanes, Task, with_best};
use glam::Vec3;
use std::array::from_fn;
use std::ops::Range;

/// So few go on one by one: what they could share is less than what they would have to look at in vain.
const FEW: u32 = 4;

/// The same of each axis.
#[inline(always)]
fn axes<T>(of: impl Fn(usize) -> T) -> [T; 3] {
    [of(0), of(1), of(2)]
}

/// The least of those that have some way to go.
#[inline(always)]
fn least_going(of: &Each<f32>, t_max: &Each<f32>) -> f32 {
    least(&each(|i| if t_max[i] >= 0.0 { of[i] } else { f32::INFINITY }))
}

/// The greatest of those that have some way to go.
#[inline(always)]
fn greatest_going(of: &Each<f32>, t_max: &Each<f32>) -> f32 {
    -least_going(&each(|i| -of[i]), t_max)
}

/// The least and the greatest, by axis.
#[inline(always)]
fn range([x, y, z]: &[Each<f32>; 3], t_max: &Each<f32>) -> [[f32; 3]; 2] {
    [
        [least_going(x, t_max), least_going(y, t_max), least_going(z, t_max)],
        [greatest_going(x, t_max), greatest_going(y, t_max), greatest_going(z, t_max)],
    ]
}

/// Where lines are between two planes, as stretches of s that become shorter.
#[inline(always)]
fn between(
    (first, last): (&mut Each<f64>, &mut Each<f64>),
    (lo, hi): (f64, f64),
    origin: &Each<f64>,
    inverse: &Each<f64>,
) {
    let a = each(|i| (lo - origin[i]) * inverse[i]);
    let b = each(|i| (hi - origin[i]) * inverse[i]);
    *first = each(|i| {
        let enter = if a[i] < b[i] { a[i] } else { b[i] };
        if enter > first[i] { enter } else { first[i] }
    });
    *last = each(|i| {
        let leave = if a[i] > b[i] { a[i] } else { b[i] };
        if leave < last[i] { leave } else { last[i] }
    });
}

/// Numbers brought within plus and minus `most`.
#[inline(always)]
fn within(of: &Each<f64>, most: f64) -> Each<f64> {
    let of = each(|i| if of[i] < -most { -most } else { of[i] });
    each(|i| if of[i] > most { most } else { of[i] })
}

#[inline(always)]
fn finite_inverse(step: &Each<f64>) -> Each<f64> {
    within(&each(|i| 1.0 / step[i]), 1e300)
}

/// What one over the steps is where they have the length 1.
#[inline(always)]
fn by_length(inverse: &Each<f64>, speed: &Each<f64>) -> Each<f32> {
    let inverse = within(&each(|i| inverse[i] * speed[i]), 1e12);
    rounded(|i| inverse[i])
}

/// Where lines are at `first`, in the units of a tree.
#[inline(always)]
fn placed((origin, step, centre): (&Each<f64>, &Each<f64>, f64), first: &Each<f64>, scale: f64) -> Each<f32> {
    rounded(|i| (origin[i] + step[i] * first[i] - centre) * scale)
}

#[inline(always)]
fn rounded(of: impl Fn(usize) -> f64) -> Each<f32> {
    each(|i| of(i) as f32)
}

/// What is done with the leaves.
pub(crate) trait VisitMany {
    /// Whether leaves are told by growing s, roughly.
    const BY_S: bool;

    /// Looks at some blocks for one of the lines, with its limit of s so far, and returns the new one; a negative one ends its walk.
    fn look<L: Lanes>(&mut self, lanes: L, line: usize, blocks: Range<usize>, limit: f64) -> f64;
}

/// One line of them.
struct One<'a, V> {
    visit: &'a mut V,
    line: usize,
}

impl<V: VisitMany> Visit for One<'_, V> {
    const BY_S: bool = V::BY_S;

    #[inline(always)]
    fn look<L: Lanes>(&mut self, lanes: L, blocks: Range<usize>, limit: f64) -> f64 {
        self.visit.look(lanes, self.line, blocks, limit)
    }
}

/// Lines inside a tree: [`Entered`], lane by lane.
pub(super) struct Packet {
    // By axis.
    start: [Each<f32>; 3],
    inverse: [Each<f32>; 3],
    first: Each<f64>,
    length: Each<f64>,
    limits: Each<f64>,
    // Negative where a line has no way left.
    t_max: Each<f32>,
    span: Span,
    farthest: f32,
}

/// Between what all lines of a packet lie, by axis.
#[derive(Debug, Clone, Copy)]
struct Span {
    // The start that comes to the near sides of boxes first, and the one that leaves their far sides last.
    start: [[f32; 3]; 2],
    inverse: [[f32; 3]; 2],
    // Which side of a box is near.
    back: [usize; 3],
    // Axes along which some go forth and some back say nothing.
    told: [bool; 3],
}

impl Span {
    /// Of those that have some way to go.
    #[inline(always)]
    fn of(start: &[Each<f32>; 3], inverse: &[Each<f32>; 3], t_max: &Each<f32>) -> Self {
        let inverse = range(inverse, t_max);
        let start = range(start, t_max);
        let back = axes(|axis| usize::from(inverse[0][axis] < 0.0));
        let bound = |far: usize| axes(|axis| start[usize::from(back[axis] == far)][axis]);
        Self {
            start: [bound(0), bound(1)],
            back,
            told: axes(|axis| inverse[0][axis] * inverse[1][axis] > 0.0),
            inverse,
        }
    }

    /// Before where they enter each child, and which any may enter before the limit.
    #[inline(always)]
    fn entries<L: Lanes>(&self, lanes: L, node: &Node, farthest: f32) -> ([f32; 8], u32) {
        let mut near = [0.0_f32; 8];
        let mut far = [f32::MAX; 8];
        for axis in (0..3).filter(|axis| self.told[*axis]) {
            let back = self.back[axis];
            let sides = &node.sides[axis];
            let [first, last] = self.start.map(|start| start[axis]);
            let [least, most] = self.inverse.map(|inverse| inverse[axis]);
            near = from_fn(|lane| {
                let way = sides[back][lane] - first;
                let (a, b) = (way * least, way * most);
                let enter = if a < b { a } else { b };
                if enter > near[lane] { enter } else { near[lane] }
            });
            far = from_fn(|lane| {
                let way = sides[1 - back][lane] - last;
                let (a, b) = (way * least, way * most);
                let leave = if a > b { a } else { b };
                if leave < far[lane] { leave } else { far[lane] }
            });
        }
        let far = far.map(|far| {
            let far = far * SLACK;
            if far < farthest { far } else { farthest }
        });
        (near, lanes.at_most_8(near, far))
    }
}

impl Packet {
    /// Of lines: each as [`Space::enter`] has it, to the bit. Those that do not meet the box of all have no way to go.
    #[inline(always)]
    pub(super) fn of(space: &Space, lines: &Lines, limits: &Each<f64>) -> Self {
        const LARGEST: f64 = f32::MAX as f64;
        let (origin, step) = (&lines.origin, &lines.step);
        let [x, y, z] = step;
        let inverse = [finite_inverse(x), finite_inverse(y), finite_inverse(z)];
        let (mut first, mut last) = ([0.0_f64; MANY], [f64::INFINITY; MANY]);
        for axis in 0..3 {
            let sides = (space.entrance.lo[axis], space.entrance.hi[axis]);
            between((&mut first, &mut last), sides, &origin[axis], &inverse[axis]);
        }
        let speed = each(|i| (x[i] * x[i] + y[i] * y[i] + z[i] * z[i]).sqrt());
        let length = each(|i| speed[i] * space.scale);
        let start = |axis: usize| (&origin[axis], &step[axis], space.centre[axis]);
        let start = [
            placed(start(0), &first, space.scale),
            placed(start(1), &first, space.scale),
            placed(start(2), &first, space.scale),
        ];
        let [x, y, z] = &inverse;
        let inverse = [by_length(x, &speed), by_length(y, &speed), by_length(z, &speed)];
        let way = each(|i| (limits[i] - first[i] + 4.0 * f64::EPSILON * limits[i]) * length[i] * 1.000_001);
        let t_max = rounded(|i| if way[i] < LARGEST { way[i] } else { LARGEST });
        // What is not a number enters nothing.
        let enters = each(|i| first[i] <= last[i] && first[i] < limits[i]);
        let goes = each(|i| length[i] > 0.0 && length[i] < f64::INFINITY);
        let starts = each(|i| (start[0][i] + start[1][i] + start[2][i]).is_finite());
        let t_max =
            each(|i| if (i < lines.count) & enters[i] & goes[i] & starts[i] { t_max[i] } else { -1.0 });
        let span = Span::of(&start, &inverse, &t_max);
        let mut packet = Self { start, inverse, first, length, limits: *limits, t_max, span, farthest: -1.0 };
        packet.find_farthest();
        packet
    }

    /// The same, with the best instruction set.
    pub(super) fn new(space: &Space, lines: &Lines, limits: &Each<f64>) -> Self {
        with_best(Beginning { space, lines, limits })
    }

    /// One of the lines.
    #[inline(always)]
    fn entered(&self, i: usize) -> Entered {
        let of = |of: &[Each<f32>; 3]| Vec3::new(of[0][i], of[1][i], of[2][i]);
        Entered {
            start: of(&self.start),
            inverse: of(&self.inverse),
            first: self.first[i],
            length: self.length[i],
            t_max: self.t_max[i],
        }
    }

    #[inline(always)]
    fn find_farthest(&mut self) {
        let farthest = greatest_going(&self.t_max, &self.t_max);
        self.farthest = if farthest >= 0.0 { farthest } else { -1.0 };
    }

    /// The lines that enter a box before their limits, bit by bit.
    #[inline(always)]
    fn entering<L: Lanes>(&self, lanes: L, side: impl Fn(usize, usize) -> f32) -> u32 {
        let mut near = [0.0_f32; MANY];
        let mut far = [f32::MAX; MANY];
        for axis in 0..3 {
            let (lo, hi) = (side(axis, 0), side(axis, 1));
            let (start, inverse) = (&self.start[axis], &self.inverse[axis]);
            let a: Each<f32> = each(|i| (lo - start[i]) * inverse[i]);
            let b: Each<f32> = each(|i| (hi - start[i]) * inverse[i]);
            near = each(|i| {
                let enter = if a[i] < b[i] { a[i] } else { b[i] };
                if enter > near[i] { enter } else { near[i] }
            });
            far = each(|i| {
                let leave = if a[i] > b[i] { a[i] } else { b[i] };
                if leave < far[i] { leave } else { far[i] }
            });
        }
        let far: Each<f32> = each(|i| {
            let far = far[i] * SLACK;
            if far < self.t_max[i] { far } else { self.t_max[i] }
        });
        let half = |of: &Each<f32>, first: usize| -> [f32; 8] { from_fn(|i| of[first + i]) };
        lanes.at_most_8(half(&near, 0), half(&far, 0)) | lanes.at_most_8(half(&near, 8), half(&far, 8)) << 8
    }

    /// The same, with the best instruction set.
    pub(super) fn all_entering(&self, lo: Vec3, hi: Vec3) -> u32 {
        with_best(AllEntering { packet: self, sides: [lo, hi] })
    }

    /// The lines that have not come to their end, bit by bit.
    fn going(&self) -> u32 {
        (0..MANY).fold(0, |bits, i| bits | u32::from(self.t_max[i] >= 0.0) << i)
    }

    #[inline(always)]
    fn look<L: Lanes, V: VisitMany>(&mut self, lanes: L, blocks: &Range<usize>, mut met: u32, visit: &mut V) {
        let mut changed = false;
        while met != 0 {
            let i = met.trailing_zeros() as usize & (MANY - 1);
            met &= met - 1;
            let limit = visit.look(lanes, i, blocks.clone(), self.limits[i]);
            if limit != self.limits[i] {
                self.limit(i, limit);
                changed = true;
            }
        }
        if changed {
            self.find_farthest();
        }
    }

    /// Lets some lines go on one by one, below a node.
    #[inline(always)]
    fn part<L: Lanes, V: VisitMany>(&mut self, lanes: L, tree: &Wide, at: u32, mut met: u32, visit: &mut V) {
        while met != 0 {
            let i = met.trailing_zeros() as usize & (MANY - 1);
            met &= met - 1;
            let mut one = One { visit, line: i };
            let limit = walk_on(lanes, tree, at, &mut self.entered(i), self.limits[i], &mut one);
            if limit != self.limits[i] {
                self.limit(i, limit);
            }
        }
        self.find_farthest();
    }

    #[inline(always)]
    fn limit(&mut self, i: usize, limit: f64) {
        self.limits[i] = limit;
        if limit >= 0.0 {
            let mut entered = self.entered(i);
            entered.limit(limit);
            self.t_max[i] = entered.t_max;
        } else {
            self.t_max[i] = -1.0;
        }
    }

    /// New limits of some lines.
    pub(super) fn limit_all(&mut self, limits: &Each<f64>) {
        for (i, limit) in limits.iter().enumerate() {
            if *limit != self.limits[i] && self.t_max[i] >= 0.0 {
                self.limit(i, *limit);
            }
        }
        self.find_farthest();
    }

    /// Before where any enters a box; none if no one does before its limit.
    #[inline]
    pub(super) fn entry(&self, lo: Vec3, hi: Vec3) -> Option<f32> {
        let sides = [lo, hi];
        let (mut near, mut far) = (0.0_f32, f32::MAX);
        let Span { start: [first, last], inverse: [least, most], back, told } = &self.span;
        for axis in (0..3).filter(|axis| told[*axis]) {
            let way = sides[back[axis]][axis] - first[axis];
            near = near.max((way * least[axis]).min(way * most[axis]));
            let way = sides[1 - back[axis]][axis] - last[axis];
            far = far.min((way * least[axis]).max(way * most[axis]));
        }
        (near <= (far * SLACK).min(self.farthest)).then_some(near)
    }

    pub(super) fn farthest(&self) -> f32 {
        self.farthest
    }
}

/// Lines to be brought into a tree.
struct Beginning<'a> {
    space: &'a Space,
    lines: &'a Lines,
    limits: &'a Each<f64>,
}

impl Task for Beginning<'_> {
    type Output = Packet;

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) -> Packet {
        Packet::of(self.space, self.lines, self.limits)
    }
}

/// A box to be asked for all lines.
struct AllEntering<'a> {
    packet: &'a Packet,
    sides: [Vec3; 2],
}

impl Task for AllEntering<'_> {
    type Output = u32;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> u32 {
        self.packet.entering(lanes, |axis, side| self.sides[side][axis])
    }
}

impl Wide {
    /// For each of some lines all blocks that may hold something that it meets at 0 < s < its limit, as [`Wide::walk`] tells them.
    #[inline]
    pub(crate) fn walk_many<V: VisitMany>(&self, lines: &Lines, limits: &Each<f64>, visit: &mut V) {
        with_best(WalkMany { tree: self, lines, limits, visit });
    }
}

#[cfg(test)]
impl Wide {
    /// The same without the best instruction set.
    pub(crate) fn walk_many_plainly<V: VisitMany>(&self, lines: &Lines, limits: &Each<f64>, visit: &mut V) {
        WalkMany { tree: self, lines, limits, visit }.run(crate::simd::Plain);
    }
}

/// Walks to be done.
struct WalkMany<'a, V> {
    tree: &'a Wide,
    lines: &'a Lines,
    limits: &'a Each<f64>,
    visit: &'a mut V,
}

impl<V: VisitMany> Task for WalkMany<'_, V> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { tree, lines, limits, visit } = self;
        let mut packet = Packet::of(&tree.space, lines, limits);
        if packet.farthest < 0.0 {
            return;
        }
        if tree.root & LEAF != 0 {
            let going = packet.going();
            return packet.look(lanes, &blocks_of(tree.root), going, visit);
        }
        let mut open = Open::new();
        let mut at = tree.root;
        loop {
            let (near, met) = packet.span.entries(lanes, &tree.nodes[at as usize], packet.farthest);
            // Not the child, but where it stands: its box is there, too.
            let places = from_fn(|lane| at << 3 | lane as u32);
            let mut next = open.descend(&near, &places, met, V::BY_S);
            at = loop {
                let Some(place) = next.take().or_else(|| open.pop(packet.farthest)) else { return };
                let (node, lane) = (&tree.nodes[(place >> 3) as usize], (place & 7) as usize);
                let child = node.child[lane];
                let met = packet.entering(lanes, |axis, side| node.sides[axis][side][lane]);
                if child & LEAF != 0 {
                    packet.look(lanes, &blocks_of(child), met, visit);
                } else if met.count_ones() > FEW {
                    break child;
                } else {
                    packet.part(lanes, tree, child, met, visit);
                }
                if packet.farthest < 0.0 {
                    return;
                }
            };
        }
    }
}
