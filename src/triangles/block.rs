//! Four triangles at once, and the test of one.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set that was chosen"
)]

use crate::mesh::Mesh;
use crate::simd::Lanes;
use crate::tree::{EMPTY, Line, Numbers};
use std::array::from_fn;

/// Four triangles: their corners as the file has them, coordinate by coordinate, so that a leaf of the tree needs nothing
/// else.
#[derive(Debug, Clone, Copy)]
#[repr(align(32))]
pub(super) struct Block {
    // By axis, then by corner.
    corners: [[[f32; 4]; 3]; 3],
    pub(super) numbers: Numbers,
}

impl Block {
    pub(super) fn of(mesh: &Mesh, numbers: Numbers) -> Self {
        let mut corners = [[[f32::NAN; 4]; 3]; 3];
        for (lane, number) in numbers.into_iter().enumerate().filter(|(_, number)| *number != EMPTY) {
            for (corner, vertex) in mesh.triangles[number as usize].into_iter().enumerate() {
                let place = mesh.positions[vertex as usize];
                for axis in 0..3 {
                    corners[axis][corner][lane] = place[axis];
                }
            }
        }
        Self { corners, numbers }
    }

    #[inline(always)]
    pub(super) fn corner(&self, corner: usize, lane: usize) -> [f32; 3] {
        from_fn(|axis| self.corners[axis][corner][lane])
    }
}

/// A line with the shear that turns it into the z axis: the triangle test is then one in the plane, and an edge
/// gives both its triangles the same numbers, so that no line passes between them.
///
/// Source: Woop, Benthin and Wald, JCGT 2(1), 2013; here in f64 throughout.
#[derive(Debug, Clone, Copy)]
pub struct Sheared {
    // The axis along which the line moves most comes last; the two others keep the hand.
    axes: [usize; 3],
    // Coordinates in that order.
    origin: [f64; 3],
    shear: [f64; 2],
    per_depth: f64,
    depth_per_s: f64,
    grain: f64,
}

impl Sheared {
    /// Of a line, for triangles whose boxes are widened by more than `grain`.
    #[inline]
    pub(super) fn new(line: &Line, grain: f64) -> Self {
        let size = line.step.abs();
        let z = if size.x > size.y {
            if size.x > size.z { 0 } else { 2 }
        } else if size.y > size.z {
            1
        } else {
            2
        };
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if line.step[z] < 0.0 {
            std::mem::swap(&mut x, &mut y);
        }
        let per_depth = 1.0 / line.step[z];
        Self {
            axes: [x, y, z],
            origin: [line.origin[x], line.origin[y], line.origin[z]],
            shear: [line.step[x] * per_depth, line.step[y] * per_depth],
            per_depth,
            depth_per_s: line.step[z],
            grain,
        }
    }

    /// Which of four triangles the line may meet, wherever; by the numbers of [`Self::meet`].
    #[inline(always)]
    pub(super) fn may_meet<L: Lanes>(&self, lanes: L, block: &Block) -> u32 {
        let [x, y, z] = self.axes.map(|axis| &block.corners[axis]);
        let across = |corner: usize| -> [[f64; 4]; 2] {
            let depth: [f64; 4] = from_fn(|i| f64::from(z[corner][i]) - self.origin[2]);
            [
                from_fn(|i| f64::from(x[corner][i]) - self.origin[0] - self.shear[0] * depth[i]),
                from_fn(|i| f64::from(y[corner][i]) - self.origin[1] - self.shear[1] * depth[i]),
            ]
        };
        let [a, b, c] = [across(0), across(1), across(2)];
        let edge = |p: &[[f64; 4]; 2], q: &[[f64; 4]; 2]| -> [f64; 4] {
            from_fn(|i| p[0][i] * q[1][i] - p[1][i] * q[0][i])
        };
        let (u, v, w) = (edge(&c, &b), edge(&a, &c), edge(&b, &a));
        let least =
            |p: [f64; 4], q: [f64; 4]| -> [f64; 4] { from_fn(|i| if p[i] < q[i] { p[i] } else { q[i] }) };
        let most =
            |p: [f64; 4], q: [f64; 4]| -> [f64; 4] { from_fn(|i| if p[i] > q[i] { p[i] } else { q[i] }) };
        lanes.at_most_4([0.0; 4], least(least(u, v), w)) | lanes.at_most_4(most(most(u, v), w), [0.0; 4])
    }

    /// Where the line meets one of four triangles.
    #[inline(always)]
    pub(super) fn meet_lane(&self, block: &Block, lane: usize) -> Option<(f64, (f64, f64))> {
        let [a, b, c] = [0, 1, 2].map(|corner| block.corner(corner, lane));
        self.meet([&a, &b, &c])
    }

    /// A corner across the line (x, y) and along it.
    #[inline(always)]
    fn across(&self, corner: &[f32; 3]) -> (f64, f64, f64) {
        let depth = f64::from(corner[self.axes[2]]) - self.origin[2];
        let x = f64::from(corner[self.axes[0]]) - self.origin[0] - self.shear[0] * depth;
        let y = f64::from(corner[self.axes[1]]) - self.origin[1] - self.shear[1] * depth;
        (x, y, depth)
    }

    /// Where it meets a triangle, before and behind: parameter s and the weights of the second and the third corner.
    #[inline(always)]
    pub fn meet(&self, corners: [&[f32; 3]; 3]) -> Option<(f64, (f64, f64))> {
        let [a, b, c] = corners.map(|corner| self.across(corner));
        let edge = |p: (f64, f64, f64), q: (f64, f64, f64)| p.0 * q.1 - p.1 * q.0;
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let sum = u + v + w;
        if sum == 0.0 {
            return None;
        }
        let depth = u * a.2 + v * b.2 + w * c.2;
        let s = depth * self.per_depth / sum;
        let weights = (v / sum, w / sum);
        if self.is_beside(corners, s) {
            Some((s, weights))
        } else {
            Some((self.brought_back(corners, s)?, weights))
        }
    }

    /// Whether the line at s is in the triangle's box, as seen across the line. (Along it s cannot be outside.)
    #[inline(always)]
    fn is_beside(&self, corners: [&[f32; 3]; 3], s: f64) -> bool {
        let depth = s * self.depth_per_s;
        let grain = self.grain + 1e-14 * depth.abs();
        let inside = |i: usize| {
            let (lo, hi) = self.reach(corners, i);
            let at = self.shear[i] * depth;
            lo - grain <= at && at <= hi + grain
        };
        inside(0) && inside(1)
    }

    /// How far a triangle reaches along an axis, from the line's origin.
    #[inline(always)]
    fn reach(&self, corners: [&[f32; 3]; 3], i: usize) -> (f64, f64) {
        let [a, b, c] = corners.map(|corner| corner[self.axes[i]]);
        let (lo, hi) = (if a < b { a } else { b }, if a > b { a } else { b });
        let (lo, hi) = (if c < lo { c } else { lo }, if c > hi { c } else { hi });
        (f64::from(lo) - self.origin[i], f64::from(hi) - self.origin[i])
    }

    /// Where a line lies in a triangle's plane the weights are rounding alone, and with them s: the nearest s at which it is in
    /// the triangle's box; none if it passes that. So what is met does not depend on which boxes were visited before.
    #[cold]
    #[inline(never)]
    fn brought_back(&self, corners: [&[f32; 3]; 3], s: f64) -> Option<f64> {
        let (mut first, mut last) = (f64::NEG_INFINITY, f64::INFINITY);
        for i in 0..3 {
            let step = if i < 2 { self.shear[i] } else { 1.0 };
            let (lo, hi) = self.reach(corners, i);
            let grain = self.grain + 1e-14 * lo.abs().max(hi.abs());
            let (lo, hi) = (lo - grain, hi + grain);
            if step == 0.0 {
                if lo > 0.0 || hi < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = (lo / step, hi / step);
            first = first.max(a.min(b));
            last = last.min(a.max(b));
        }
        let depth = s * self.depth_per_s;
        (first <= last && depth.is_finite()).then(|| depth.clamp(first, last) * self.per_depth)
    }
}
