//! What a sight ray can meet: bodies grouped by rest frame, each mesh with one tree.
//!
//! This is the only place where rays pass between the lab and the rest frames of bodies. A ray enters a rest
//! frame with the limit of s that the frames before it have left; no event is ever transformed back to be compared.

use crate::spacetime::{Event, FourVector, Lab, Poincare, Rest, SightRay};
use crate::tree::{Bounds, Line, Tree};
use crate::triangles::{Meeting, Triangles};
use glam::{DAffine3, DMat3, DVec2, DVec3, Vec2};
use std::sync::Arc;

/// A mesh placed in the rest frame of a body.
#[derive(Debug, Clone)]
pub struct Placed {
    /// The mesh and its tree, shared by all that are alike.
    pub triangles: Arc<Triangles>,
    /// Where it stands; not singular.
    pub rest_from_mesh: DAffine3,
    /// Number of the body that it belongs to.
    pub body: u32,
    /// Number of the surface of the mesh's first material.
    pub surfaces: u32,
    mesh_from_rest: DAffine3,
    rest_from_mesh_normals: DMat3,
}

impl Placed {
    /// Places a mesh; none if the map is singular (then nothing of it can be seen).
    pub fn new(
        triangles: Arc<Triangles>,
        rest_from_mesh: DAffine3,
        body: u32,
        surfaces: u32,
    ) -> Option<Self> {
        let mesh_from_rest = rest_from_mesh.inverse();
        // Normals go with the inverse transpose, mirrored meshes included: their outside stays outside.
        let rest_from_mesh_normals = mesh_from_rest.matrix3.transpose();
        mesh_from_rest.is_finite().then_some(Self {
            triangles,
            rest_from_mesh,
            body,
            surfaces,
            mesh_from_rest,
            rest_from_mesh_normals,
        })
    }

    fn bounds(&self) -> Bounds {
        let corners = self.triangles.bounds().corners().map(|p| self.rest_from_mesh.transform_point3(p));
        let bounds = Bounds::of(corners);
        // More than the rounding of these eight products.
        let pad = (bounds.lo.abs().max(bounds.hi.abs()).max_element()) * 1e-14;
        Bounds { lo: bounds.lo - pad, hi: bounds.hi + pad }
    }

    #[inline]
    fn line(&self, ray: &SightRay<Rest>) -> Line {
        Line {
            origin: self.mesh_from_rest.transform_point3(ray.event.x),
            step: self.mesh_from_rest.transform_vector3(-ray.k.x),
        }
    }
}

/// Everything at rest in one frame.
#[derive(Debug, Clone)]
pub struct RestFrame {
    /// Into the frame.
    pub rest_from_lab: Poincare<Rest, Lab>,
    /// The meshes in it.
    pub placed: Vec<Placed>,
    tree: Tree,
}

impl RestFrame {
    /// Builds the tree over the placed meshes.
    pub fn new(rest_from_lab: Poincare<Rest, Lab>, placed: Vec<Placed>) -> Self {
        let boxes: Vec<Bounds> = placed.iter().map(Placed::bounds).collect();
        Self { rest_from_lab, placed, tree: Tree::build(&boxes) }
    }

    fn nearest(&self, ray: &SightRay, s_max: f64) -> Option<(u32, Meeting)> {
        let ray = ray.to(&self.rest_from_lab);
        let line = Line { origin: ray.event.x, step: -ray.k.x };
        let mut nearest = None;
        self.tree.walk(&line, s_max, |number, limit| {
            let placed = &self.placed[number as usize];
            match placed.triangles.nearest(&placed.line(&ray), limit) {
                Some(meeting) => {
                    nearest = Some((number, meeting));
                    meeting.s
                }
                None => limit,
            }
        });
        nearest
    }

    fn any(&self, ray: &SightRay, s_max: f64) -> bool {
        let ray = ray.to(&self.rest_from_lab);
        let line = Line { origin: ray.event.x, step: -ray.k.x };
        let met = |number: u32, limit| {
            let placed = &self.placed[number as usize];
            if placed.triangles.any(&placed.line(&ray), limit) { -1.0 } else { limit }
        };
        self.tree.walk(&line, s_max, met) < 0.0
    }
}

/// All bodies.
#[derive(Debug, Clone, Default)]
pub struct World {
    /// One for each velocity.
    pub frames: Vec<RestFrame>,
}

/// Where a sight ray meets a body.
#[derive(Debug, Clone, Copy)]
pub struct Hit<'w> {
    /// The ray's parameter, the same in every frame.
    pub s: f64,
    /// The rest frame.
    pub rest: &'w RestFrame,
    /// The mesh.
    pub placed: &'w Placed,
    meeting: Meeting,
}

impl World {
    /// The first body that the ray meets: the smallest s over all rest frames.
    pub fn nearest(&self, ray: &SightRay) -> Option<Hit<'_>> {
        let mut nearest: Option<Hit<'_>> = None;
        for rest in &self.frames {
            let s_max = nearest.map_or(f64::INFINITY, |hit| hit.s);
            if let Some((number, meeting)) = rest.nearest(ray, s_max) {
                nearest = Some(Hit { s: meeting.s, rest, placed: &rest.placed[number as usize], meeting });
            }
        }
        nearest
    }

    /// Whether anything stands in the way at 0 < s < `s_max`.
    pub fn blocked(&self, ray: &SightRay, s_max: f64) -> bool {
        self.frames.iter().any(|rest| rest.any(ray, s_max))
    }
}

/// The surface at a hit, in the rest frame of the body.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    /// The event of the hit.
    pub event: Event<Rest>,
    /// The wave vector of the light that leaves it.
    pub k: FourVector<Rest>,
    /// The triangle's own normal, on the side from which it is seen.
    pub facet_normal: DVec3,
    /// The interpolated normal, on the same side.
    pub normal: DVec3,
    // The largest coordinates that the place was computed from: its rounding is a part of them.
    size: f64,
}

impl Hit<'_> {
    /// The hit as its own rest frame sees it.
    pub fn spot(&self, ray: &SightRay) -> Spot {
        let mesh = &self.placed.triangles.mesh;
        let corners = self.placed.triangles.corners(self.meeting.triangle);
        let k = self.rest.rest_from_lab * ray.k;
        let t = (self.rest.rest_from_lab * ray.at(self.s)).t;
        let x = self.placed.rest_from_mesh.transform_point3(self.mix(corners));
        let facet = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let facet = unit(self.placed.rest_from_mesh_normals * facet, k.x);
        // Seen from behind: the other side is the outside.
        let side = if facet.dot(k.x) < 0.0 { -1.0 } else { 1.0 };
        let corner_normals = mesh.triangles[self.meeting.triangle as usize]
            .map(|i| mesh.normals.get(i as usize).map_or(DVec3::ZERO, |n| n.as_dvec3()));
        let normal = unit(self.placed.rest_from_mesh_normals * self.mix(corner_normals), facet) * side;
        // The corners' coordinates may cancel, within the mesh and with its place: what is left is no measure of rounding.
        let size = |corner: DVec3| self.placed.rest_from_mesh.transform_vector3(corner).abs().max_element();
        let size = corners.map(size).into_iter().fold(0.0, f64::max)
            + self.placed.rest_from_mesh.translation.abs().max_element();
        Spot { event: Event::new(t, x), k, facet_normal: facet * side, normal, size }
    }

    /// Number of the surface met.
    pub fn surface(&self) -> usize {
        let mesh = &self.placed.triangles.mesh;
        self.placed.surfaces as usize + mesh.material_of(self.meeting.triangle) as usize
    }

    /// Texture coordinates of one set; the upper left corner where the mesh has none.
    pub fn uv(&self, set: u8) -> DVec2 {
        let mesh = &self.placed.triangles.mesh;
        let uvs: &[Vec2] = mesh.uvs.get(set as usize).map_or(&[], |uvs| uvs);
        let [a, b, c] = mesh.triangles[self.meeting.triangle as usize]
            .map(|i| uvs.get(i as usize).map_or(DVec2::ZERO, |uv| uv.as_dvec2()));
        let (v, w) = self.meeting.weights;
        a + (b - a) * v + (c - a) * w
    }

    /// The vertices' colour, linear RGBA; none for a mesh without.
    pub fn vertex_color(&self) -> Option<[f32; 4]> {
        let mesh = &self.placed.triangles.mesh;
        let [a, b, c] = mesh.triangles[self.meeting.triangle as usize].map(|i| mesh.colors.get(i as usize));
        let (v, w) = (self.meeting.weights.0 as f32, self.meeting.weights.1 as f32);
        let (a, b, c) = (a?, b?, c?);
        Some(std::array::from_fn(|i| a[i] + (b[i] - a[i]) * v + (c[i] - a[i]) * w))
    }

    fn mix(&self, [a, b, c]: [DVec3; 3]) -> DVec3 {
        let (v, w) = self.meeting.weights;
        a + (b - a) * v + (c - a) * w
    }
}

/// The unit vector along `v`, or along `otherwise` if `v` has no direction.
fn unit(v: DVec3, otherwise: DVec3) -> DVec3 {
    v.try_normalize().unwrap_or_else(|| otherwise.normalize_or(DVec3::Z))
}

impl Spot {
    /// The hit's event in the lab, moved off the facet by more than its rounding on the way out and back in.
    pub fn departure(&self, rest: &RestFrame) -> Event {
        let gamma = rest.rest_from_lab.boost().velocity().gamma();
        let origin = rest.rest_from_lab.origin();
        let size = |t: f64, x: DVec3| t.abs() + x.abs().max_element();
        let bound = 64.0
            * f64::EPSILON
            * gamma
            * (gamma * (self.size + size(self.event.t, self.event.x)) + size(origin.t, origin.x));
        let event = Event::new(self.event.t, self.event.x + self.facet_normal * bound);
        rest.rest_from_lab.undo(event)
    }
}
