//! A mesh with its tree: where a line meets it.

use crate::mesh::Mesh;
use crate::tree::{Bounds, Line, Tree};
use glam::DVec3;
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
}

/// A mesh and the tree over its triangles, both in the mesh's own coordinates; built once, shared by all instances.
#[derive(Debug, Clone)]
pub struct Triangles {
    /// The triangles.
    pub mesh: Arc<Mesh>,
    tree: Tree,
}

impl Triangles {
    /// Builds the tree.
    pub fn new(mesh: Arc<Mesh>) -> Self {
        let boxes: Vec<Bounds> = mesh
            .triangles
            .iter()
            .map(|t| Bounds::of(t.map(|i| mesh.positions[i as usize].as_dvec3())))
            .collect();
        Self { tree: Tree::build(&boxes), mesh }
    }

    /// The box of all triangles.
    pub fn bounds(&self) -> Bounds {
        self.tree.bounds()
    }

    /// Corners of a triangle.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.mesh.triangles[triangle as usize].map(|i| self.mesh.positions[i as usize].as_dvec3())
    }

    /// The first meeting at 0 < s < `s_max`.
    pub fn nearest(&self, line: &Line, s_max: f64) -> Option<Meeting> {
        let entered = self.tree.enter(line, s_max)?;
        let sheared = Sheared::new(line);
        let mut nearest = None;
        self.tree.walk_on(entered, s_max, |triangle, limit| match self.meet(&sheared, triangle, limit) {
            Some(meeting) => {
                nearest = Some(meeting);
                meeting.s
            }
            None => limit,
        });
        nearest
    }

    /// Whether there is any meeting at 0 < s < `s_max`.
    pub fn any(&self, line: &Line, s_max: f64) -> bool {
        let Some(entered) = self.tree.enter(line, s_max) else { return false };
        let sheared = Sheared::new(line);
        let met = |triangle, limit| if self.meet(&sheared, triangle, limit).is_some() { -1.0 } else { limit };
        self.tree.walk_on(entered, s_max, met) < 0.0
    }

    /// All meetings at 0 < s < `s_max`, in no order, until one is enough: whether it was.
    pub fn until(&self, line: &Line, s_max: f64, enough: &mut dyn FnMut(Meeting) -> bool) -> bool {
        let Some(entered) = self.tree.enter(line, s_max) else { return false };
        let sheared = Sheared::new(line);
        let met = |triangle, limit| match self.meet(&sheared, triangle, limit) {
            Some(meeting) if enough(meeting) => -1.0,
            _ => limit,
        };
        self.tree.walk_on(entered, s_max, met) < 0.0
    }

    #[inline]
    fn meet(&self, line: &Sheared, triangle: u32, limit: f64) -> Option<Meeting> {
        let [a, b, c] = self.mesh.triangles[triangle as usize];
        let corner = |i: u32| self.mesh.positions[i as usize].as_ref();
        let (s, weights) = line.meet([corner(a), corner(b), corner(c)])?;
        (s > 0.0 && s < limit).then_some(Meeting { triangle, s, weights })
    }
}

/// A line with the shear that turns it into the z axis: the triangle test is then one in the plane, and an edge
/// gives both its triangles the same numbers, so that no line passes between them.
///
/// Source: Woop, Benthin and Wald, JCGT 2(1), 2013; here in f64 throughout.
struct Sheared {
    // The axis along which the line moves most comes last; the two others keep the hand.
    axes: [usize; 3],
    // Coordinates in that order.
    origin: [f64; 3],
    shear: [f64; 2],
    per_depth: f64,
}

impl Sheared {
    #[inline]
    fn new(line: &Line) -> Self {
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
        }
    }

    /// A corner across the line (x, y) and along it.
    #[inline]
    fn across(&self, corner: &[f32; 3]) -> (f64, f64, f64) {
        let depth = f64::from(corner[self.axes[2]]) - self.origin[2];
        let x = f64::from(corner[self.axes[0]]) - self.origin[0] - self.shear[0] * depth;
        let y = f64::from(corner[self.axes[1]]) - self.origin[1] - self.shear[1] * depth;
        (x, y, depth)
    }

    /// Parameter s and the weights of the second and the third corner.
    #[inline]
    fn meet(&self, [a, b, c]: [&[f32; 3]; 3]) -> Option<(f64, (f64, f64))> {
        let (a, b, c) = (self.across(a), self.across(b), self.across(c));
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
        Some((depth * self.per_depth / sum, (v / sum, w / sum)))
    }
}
