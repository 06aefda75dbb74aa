//! A mesh placed in the rest frame of a body.

use crate::spacetime::{Rest, SightRay};
use crate::tree::{Bounds, Line};
use crate::triangles::{Meeting, Triangles};
use glam::{DAffine3, DMat3, DVec3};
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
    /// What the rest frame's clock reads when the body's own reads zero, metres.
    pub clock_zero: f64,
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
            clock_zero: 0.0,
            mesh_from_rest,
            rest_from_mesh_normals,
        })
    }

    /// Its box in the rest frame.
    pub fn bounds(&self) -> Bounds {
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

    /// The first meeting at 0 < s < `s_max`.
    #[inline]
    pub(super) fn nearest(&self, ray: &SightRay<Rest>, s_max: f64) -> Option<Meeting> {
        self.triangles.nearest(&self.line(ray), s_max)
    }

    /// Whether there is any meeting at 0 < s < `s_max`.
    #[inline]
    pub(super) fn any(&self, ray: &SightRay<Rest>, s_max: f64) -> bool {
        self.triangles.any(&self.line(ray), s_max)
    }

    /// All meetings at 0 < s < `s_max`, in no order, until one is enough: whether it was.
    pub(super) fn until(
        &self,
        ray: &SightRay<Rest>,
        s_max: f64,
        enough: &mut dyn FnMut(Meeting) -> bool,
    ) -> bool {
        self.triangles.until(&self.line(ray), s_max, enough)
    }

    /// The geometry at a meeting.
    pub(super) fn local(&self, meeting: &Meeting) -> Local {
        let mesh = &self.triangles.mesh;
        let corners = self.triangles.corners(meeting.triangle);
        let x = self.rest_from_mesh.transform_point3(mix(corners, meeting.weights));
        let facet = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let corner_normals = mesh.triangles[meeting.triangle as usize]
            .map(|i| mesh.normals.get(i as usize).map_or(DVec3::ZERO, |n| n.as_dvec3()));
        // The corners' coordinates may cancel, within the mesh and with its place: what is left is no measure of rounding.
        let size = |corner: DVec3| self.rest_from_mesh.transform_vector3(corner).abs().max_element();
        let size = corners.map(size).into_iter().fold(0.0, f64::max)
            + self.rest_from_mesh.translation.abs().max_element();
        Local {
            x,
            facet_normal: self.rest_from_mesh_normals * facet,
            normal: self.rest_from_mesh_normals * mix(corner_normals, meeting.weights),
            size,
        }
    }

    /// The triangle's edges from its first corner, in the rest frame, and what they are in texture coordinates.
    pub(super) fn edges(&self, meeting: &Meeting, set: u8) -> Option<([DVec3; 2], [glam::DVec2; 2])> {
        let mesh = &self.triangles.mesh;
        let uvs = mesh.uvs.get(set as usize).filter(|uvs| !uvs.is_empty())?;
        let corners = self.triangles.corners(meeting.triangle);
        let edge = |i: usize| self.rest_from_mesh.transform_vector3(corners[i] - corners[0]);
        let [a, b, c] = mesh.triangles[meeting.triangle as usize].map(|i| uvs[i as usize].as_dvec2());
        Some(([edge(1), edge(2)], [b - a, c - a]))
    }

    /// The file's own tangent (rest frame, of any length) and its hand, if it has them.
    pub(super) fn tangent(&self, meeting: &Meeting) -> Option<(DVec3, f64)> {
        let mesh = &self.triangles.mesh;
        let triangle = mesh.triangles[meeting.triangle as usize];
        let tangents = triangle.map(|i| mesh.tangents.get(i as usize));
        let [Some(a), Some(b), Some(c)] = tangents else { return None };
        let along = |t: &[f32; 4]| DVec3::new(f64::from(t[0]), f64::from(t[1]), f64::from(t[2]));
        let tangent = mix([along(a), along(b), along(c)], meeting.weights);
        // Where the map mirrors, so does the hand.
        let hand = f64::from(a[3]) * self.rest_from_mesh.matrix3.determinant().signum();
        Some((self.rest_from_mesh.transform_vector3(tangent), hand))
    }
}

/// The geometry of a surface at one place, in the rest frame of the body; normals outward, of any length.
pub(super) struct Local {
    pub(super) x: DVec3,
    pub(super) facet_normal: DVec3,
    pub(super) normal: DVec3,
    /// The largest coordinates that the place was computed from.
    pub(super) size: f64,
}

pub(super) fn mix([a, b, c]: [DVec3; 3], (v, w): (f64, f64)) -> DVec3 {
    a + (b - a) * v + (c - a) * w
}
