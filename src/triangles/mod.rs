//! A mesh with its tree: where a line meets it.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

mod block;

use crate::mesh::Mesh;
use crate::simd::Lanes;
use crate::tree::{Bounds, Each, Line, Lines, MANY, Visit, VisitMany, Wide};
use block::Block;
pub use block::Sheared;
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Where a line meets a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// The number of the triangle.
    pub triangle: u32,
    /// Parameter of the line.
    pub s: f64,
    /// Weights of the second and the third corner.
    pub weights: (f64, f64),
    /// Where the tree keeps its corners.
    pub place: u32,
}

/// A mesh and the tree over its triangles, both in the mesh's own coordinates; built once, shared by all instances.
#[derive(Debug, Clone)]
pub struct Triangles {
    /// The triangles.
    pub mesh: Arc<Mesh>,
    tree: Wide,
    blocks: Vec<Block>,
}

impl Triangles {
    /// Builds the tree.
    pub fn new(mesh: Arc<Mesh>) -> Self {
        let bounds =
            |number: usize| Bounds::of(mesh.triangles[number].map(|i| mesh.positions[i as usize].as_dvec3()));
        let (tree, numbers) = Wide::build(mesh.triangles.len(), bounds);
        let blocks = numbers.into_par_iter().map(|numbers| Block::of(&mesh, numbers)).collect();
        Self { mesh, tree, blocks }
    }

    /// The box of all triangles.
    pub fn bounds(&self) -> Bounds {
        self.tree.bounds()
    }

    /// Bytes that the tree takes, the mesh apart.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + self.blocks.len() * size_of::<Block>()
    }

    /// Corners of a triangle.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.mesh.triangles[triangle as usize].map(|i| self.mesh.positions[i as usize].as_dvec3())
    }

    /// Corners of the triangle of a meeting: those that the walk has just read.
    #[inline]
    pub(crate) fn corners_met(&self, meeting: &Meeting) -> [DVec3; 3] {
        let block = &self.blocks[meeting.place as usize / 4];
        [0, 1, 2].map(|corner| DVec3::from(block.corner(corner, meeting.place as usize % 4).map(f64::from)))
    }

    /// The first meeting at 0 < s < `s_max`; of several at the same s the one with the smallest number.
    pub fn nearest(&self, line: &Line, s_max: f64) -> Option<Meeting> {
        self.walk(line, s_max, |blocks, line| Nearest { blocks, line, met: None })?.met
    }

    /// Whether there is any meeting at 0 < s < `s_max`.
    pub fn any(&self, line: &Line, s_max: f64) -> bool {
        self.walk(line, s_max, |blocks, line| Until { blocks, line, enough: |_| true, stopped: false })
            .is_some_and(|until| until.stopped)
    }

    /// All meetings at 0 < s < `s_max`, in no order, until one is enough: whether it was.
    pub fn until(&self, line: &Line, s_max: f64, enough: &mut dyn FnMut(Meeting) -> bool) -> bool {
        self.walk(line, s_max, |blocks, line| Until { blocks, line, enough, stopped: false })
            .is_some_and(|until| until.stopped)
    }

    /// The same as [`Self::nearest`] for up to 16 lines that go together, each to its limit of s.
    pub fn nearest_many(&self, lines: &Lines, limits: &[f64; MANY]) -> [Option<Meeting>; MANY] {
        let mut nearest = NearestMany { lines: Many::new(self, lines), met: [None; MANY] };
        self.tree.walk_many(lines, limits, &mut nearest);
        nearest.met
    }

    /// The same as [`Self::any`] for up to 16 lines that go together: bit by bit.
    pub fn any_many(&self, lines: &Lines, limits: &[f64; MANY]) -> u32 {
        let mut any = AnyMany { lines: Many::new(self, lines), met: 0 };
        self.tree.walk_many(lines, limits, &mut any);
        any.met
    }

    /// The line, to be tested against triangles one by one: what a walk does to those that it leads to.
    #[inline]
    pub fn sheared(&self, line: &Line) -> Sheared {
        Sheared::new(line, self.tree.grain())
    }

    #[inline]
    fn walk<'a, V: Visit>(
        &'a self,
        line: &Line,
        s_max: f64,
        visit: impl FnOnce(&'a [Block], Sheared) -> V,
    ) -> Option<V> {
        if self.blocks.is_empty() {
            return None;
        }
        let entered = self.tree.enter(line, s_max)?;
        let mut visit = visit(&self.blocks, self.sheared(line));
        self.tree.walk(entered, s_max, &mut visit);
        Some(visit)
    }
}

/// Tells the meetings in some blocks, in their order.
#[inline(always)]
fn meetings<L: Lanes>(
    lanes: L,
    blocks: &[Block],
    among: Range<usize>,
    line: &Sheared,
    mut tell: impl FnMut(Meeting),
) {
    let first = among.start;
    for (number, block) in blocks[among].iter().enumerate() {
        let mut met = line.may_meet(lanes, block);
        while met != 0 {
            let lane = met.trailing_zeros() as usize & 3;
            met &= met - 1;
            if let Some((s, weights)) = line.meet_lane(block, lane) {
                let place = (4 * (first + number) + lane) as u32;
                tell(Meeting { triangle: block.numbers[lane], s, weights, place });
            }
        }
    }
}

/// Looks for the first.
struct Nearest<'a> {
    blocks: &'a [Block],
    line: Sheared,
    met: Option<Meeting>,
}

impl Visit for Nearest<'_> {
    const BY_S: bool = true;

    #[inline(always)]
    fn look<L: Lanes>(&mut self, lanes: L, blocks: Range<usize>, limit: f64) -> f64 {
        nearer(lanes, self.blocks, blocks, &self.line, limit, &mut self.met)
    }
}

/// Puts the first meeting in some blocks in place of the first so far if it comes before; returns the limit of s.
#[inline(always)]
fn nearer<L: Lanes>(
    lanes: L,
    blocks: &[Block],
    among: Range<usize>,
    line: &Sheared,
    mut limit: f64,
    first: &mut Option<Meeting>,
) -> f64 {
    meetings(lanes, blocks, among, line, |meeting| {
        // Both triangles at an edge may be met at the same s.
        let wins = |met: Meeting| meeting.s == met.s && meeting.triangle < met.triangle;
        if meeting.s > 0.0 && (meeting.s < limit || first.is_some_and(wins)) {
            *first = Some(meeting);
            limit = meeting.s;
        }
    });
    limit
}

/// Lines that go together, each made ready for triangles when it comes to the first.
struct Many<'a> {
    triangles: &'a Triangles,
    lines: &'a Lines,
    sheared: Each<Option<Sheared>>,
}

impl<'a> Many<'a> {
    fn new(triangles: &'a Triangles, lines: &'a Lines) -> Self {
        Self { triangles, lines, sheared: [None; MANY] }
    }

    #[inline(always)]
    fn line(&mut self, i: usize) -> &Sheared {
        let Self { triangles, lines, sheared } = self;
        sheared[i].get_or_insert_with(|| triangles.sheared(&lines.line(i)))
    }
}

/// Looks for the first of each line.
struct NearestMany<'a> {
    lines: Many<'a>,
    met: Each<Option<Meeting>>,
}

impl VisitMany for NearestMany<'_> {
    const BY_S: bool = true;

    #[inline(always)]
    fn look<L: Lanes>(&mut self, lanes: L, line: usize, blocks: Range<usize>, limit: f64) -> f64 {
        let all = &self.lines.triangles.blocks;
        nearer(lanes, all, blocks, self.lines.line(line), limit, &mut self.met[line])
    }
}

/// Looks whether each line meets anything.
struct AnyMany<'a> {
    lines: Many<'a>,
    met: u32,
}

impl VisitMany for AnyMany<'_> {
    const BY_S: bool = false;

    #[inline(always)]
    fn look<L: Lanes>(&mut self, lanes: L, line: usize, blocks: Range<usize>, limit: f64) -> f64 {
        let all = &self.lines.triangles.blocks;
        let mut stopped = false;
        meetings(lanes, all, blocks, self.lines.line(line), |meeting| {
            stopped = stopped || (meeting.s > 0.0 && meeting.s < limit);
        });
        self.met |= u32::from(stopped) << line;
        if stopped { -1.0 } else { limit }
    }
}

/// Looks at all until one is enough.
struct Until<'a, F> {
    blocks: &'a [Block],
    line: Sheared,
    enough: F,
    stopped: bool,
}

impl<F: FnMut(Meeting) -> bool> Visit for Until<'_, F> {
    const BY_S: bool = false;

    #[inline(always)]
    fn look<L: Lanes>(&mut self, lanes: L, blocks: Range<usize>, limit: f64) -> f64 {
        let Self { line, enough, stopped, .. } = self;
        meetings(lanes, self.blocks, blocks, line, |meeting| {
            *stopped = *stopped || (meeting.s > 0.0 && meeting.s < limit && enough(meeting));
        });
        if *stopped { -1.0 } else { limit }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Multiples of a golden ratio, parts of 1: spread evenly enough.
    fn spread(i: u32) -> Vec3 {
        let part = |ratio: f64| (f64::from(i) * ratio).fract() - 0.5;
        DVec3::new(part(0.618_033_988_749), part(0.754_877_666_247), part(0.569_840_290_998)).as_vec3()
    }

    #[test]
    fn all_instruction_sets_meet_the_same() {
        let count = 5_000;
        let corner = |i: u32| spread(i / 3) + 0.2 * spread(7 * i);
        let positions = (0..3 * count).map(corner).collect();
        let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mesh = Triangles::new(Arc::new(Mesh { positions, triangles, ..Mesh::default() }));
        let line = |i: u32| {
            let origin = 2.0 * spread(11 * i).as_dvec3();
            Line { origin, step: spread(13 * i).as_dvec3() - origin }
        };
        let mut met = 0;
        for i in 0..20_000 {
            let line = line(i);
            let plain = mesh.tree.enter(&line, f64::INFINITY).and_then(|entered| {
                let mut nearest = Nearest { blocks: &mesh.blocks, line: mesh.sheared(&line), met: None };
                mesh.tree.walk_plainly(entered, f64::INFINITY, &mut nearest);
                nearest.met
            });
            assert_eq!(mesh.nearest(&line, f64::INFINITY), plain);
            met += u32::from(plain.is_some());
        }
        assert!((5_000..20_000).contains(&met), "{met}");
        for first in (0..20_000).step_by(MANY) {
            let some = (0..MANY as u32).map(|i| line(first + i / 4));
            let (lines, limits) = (Lines::of(some), [f64::INFINITY; MANY]);
            let mut plain = NearestMany { lines: Many::new(&mesh, &lines), met: [None; MANY] };
            mesh.tree.walk_many_plainly(&lines, &limits, &mut plain);
            assert_eq!(mesh.nearest_many(&lines, &limits), plain.met);
        }
    }
}
