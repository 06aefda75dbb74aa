//! A mesh, or a solid, placed in the rest frame of a body.

use crate::solid::{Crossing, Solid};
use crate::tree::{Bounds, Each, Line, Lines};
use crate::triangles::{Meeting, Triangles};
use glam::{DAffine3, DMat3, DVec2, DVec3, Vec2};
use std::sync::Arc;

/// What is placed.
#[derive(Debug, Clone)]
pub enum Form {
    /// A mesh and its tree, shared by all that are alike.
    Mesh(Arc<Triangles>),
    /// A shape without a file.
    Solid(Arc<Solid>),
}

/// Where a line meets what is placed.
#[derive(Debug, Clone, Copy)]
pub(super) enum Met {
    Triangle(Meeting),
    // With the point, in the solid's own coordinates.
    Solid(Crossing, DVec3),
}

impl Met {
    pub(super) fn s(&self) -> f64 {
        match self {
            Self::Triangle(meeting) => meeting.s,
            Self::Solid(crossing, _) => crossing.s,
        }
    }
}

/// A mesh or a solid placed in the rest frame of a body.
#[derive(Debug, Clone)]
pub struct Placed {
    /// The mesh or the solid.
    pub form: Form,
    /// Where it stands; not singular.
    pub rest_from_form: DAffine3,
    /// Number of the body that it belongs to.
    pub body: u32,
    /// Number of the surface of the mesh's first material.
    pub surfaces: u32,
    /// What the rest frame's clock reads when the body's own reads zero, metres.
    pub clock_zero: f64,
    // The largest coordinate of it, and how long it is; 1 m for what has no end.
    reach: f64,
    extent: f64,
    form_from_rest: DAffine3,
    rest_from_form_normals: DMat3,
}

impl Placed {
    /// Places a form; none if the map is singular (then nothing of it can be seen).
    pub fn new(form: Form, rest_from_form: DAffine3, body: u32, surfaces: u32) -> Option<Self> {
        let form_from_rest = rest_from_form.inverse();
        // Normals go with the inverse transpose, mirrored forms included: their outside stays outside.
        let rest_from_form_normals = form_from_rest.matrix3.transpose();
        let mut placed = Self {
            form,
            rest_from_form,
            body,
            surfaces,
            clock_zero: 0.0,
            reach: rest_from_form.translation.abs().max_element(),
            extent: 1.0,
            form_from_rest,
            rest_from_form_normals,
        };
        if let Some(Bounds { lo, hi }) = placed.bounds() {
            placed.reach = placed.reach.max(lo.abs().max(hi.abs()).max_element());
            placed.extent = (hi - lo).max_element();
        }
        form_from_rest.is_finite().then_some(placed)
    }

    /// The largest coordinate of it, metres.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// How long it is, metres; 1 m for what has no end.
    pub fn extent(&self) -> f64 {
        self.extent
    }

    /// Whether a place in the rest frame is within a solid.
    pub(super) fn contains(&self, x: DVec3) -> bool {
        match &self.form {
            Form::Mesh(_) => false,
            Form::Solid(solid) => solid.contains(self.form_from_rest.transform_point3(x)),
        }
    }

    /// The numbers of its surfaces.
    pub(super) fn all_surfaces(&self) -> impl Iterator<Item = usize> {
        let parts = match &self.form {
            Form::Mesh(triangles) => triangles.mesh.parts.as_slice(),
            Form::Solid(_) => &[],
        };
        let first = parts.is_empty().then_some(0);
        parts.iter().map(|part| part.material).chain(first).map(|number| (self.surfaces + number) as usize)
    }

    /// Its box in the rest frame; none for what has no end.
    pub fn bounds(&self) -> Option<Bounds> {
        let own = match &self.form {
            Form::Mesh(triangles) => triangles.bounds(),
            Form::Solid(solid) => solid.bounded().then(|| solid.bounds())?,
        };
        let bounds = Bounds::of(own.corners().map(|p| self.rest_from_form.transform_point3(p)));
        // More than the rounding of these eight products.
        let pad = (bounds.lo.abs().max(bounds.hi.abs()).max_element()) * 1e-14;
        Some(Bounds { lo: bounds.lo - pad, hi: bounds.hi + pad })
    }

    /// A line of the rest frame, in the form's own coordinates.
    #[inline]
    fn own(&self, line: &Line) -> Line {
        Line {
            origin: self.form_from_rest.transform_point3(line.origin),
            step: self.form_from_rest.transform_vector3(line.step),
        }
    }

    /// The first meeting at 0 < s < `s_max`.
    #[inline]
    pub(super) fn nearest(&self, line: &Line, s_max: f64) -> Option<Met> {
        let line = self.own(line);
        match &self.form {
            Form::Mesh(triangles) => triangles.nearest(&line, s_max).map(Met::Triangle),
            Form::Solid(solid) => {
                let crossing = solid.nearest(&line, 0.0, s_max)?;
                Some(Met::Solid(crossing, line.origin + line.step * crossing.s))
            }
        }
    }

    /// Whether there is any meeting at 0 < s < `s_max`.
    #[inline]
    pub(super) fn any(&self, line: &Line, s_max: f64) -> bool {
        let line = self.own(line);
        match &self.form {
            Form::Mesh(triangles) => triangles.any(&line, s_max),
            Form::Solid(solid) => solid.nearest(&line, 0.0, s_max).is_some(),
        }
    }

    /// The same as [`Self::nearest`] for lines that go together, each to its limit of s.
    pub(super) fn nearest_many(&self, lines: &Lines, limits: &Each<f64>, mut tell: impl FnMut(usize, Met)) {
        if let Form::Mesh(triangles) = &self.form {
            let met = triangles.nearest_many(&lines.through(&self.form_from_rest), limits);
            for (i, meeting) in met.iter().enumerate() {
                meeting.iter().for_each(|meeting| tell(i, Met::Triangle(*meeting)));
            }
        } else {
            for (i, limit) in limits.iter().enumerate().take(lines.count).filter(|(_, limit)| **limit > 0.0) {
                self.nearest(&lines.line(i), *limit).into_iter().for_each(|met| tell(i, met));
            }
        }
    }

    /// The same as [`Self::any`] for lines that go together, bit by bit. Those with negative limits meet nothing.
    pub(super) fn any_many(&self, lines: &Lines, limits: &Each<f64>) -> u32 {
        if let Form::Mesh(triangles) = &self.form {
            return triangles.any_many(&lines.through(&self.form_from_rest), limits);
        }
        let met = |i: &usize| limits[*i] > 0.0 && self.any(&lines.line(*i), limits[*i]);
        (0..lines.count).filter(met).fold(0, |bits, i| bits | 1 << i)
    }

    /// All meetings at 0 < s < `s_max`, in no order, until one is enough: whether it was.
    pub(super) fn until(&self, line: &Line, s_max: f64, enough: &mut dyn FnMut(Met) -> bool) -> bool {
        let line = self.own(line);
        match &self.form {
            Form::Mesh(triangles) => {
                triangles.until(&line, s_max, &mut |meeting| enough(Met::Triangle(meeting)))
            }
            Form::Solid(solid) => {
                let mut stopped = false;
                solid.crossings(&line, 0.0, s_max, &mut |crossing| {
                    stopped = enough(Met::Solid(crossing, line.origin + line.step * crossing.s));
                    !stopped
                });
                stopped
            }
        }
    }

    /// The geometry at a meeting.
    pub(super) fn local(&self, met: &Met) -> Local {
        match (met, &self.form) {
            (Met::Triangle(meeting), Form::Mesh(triangles)) => self.local_of_mesh(triangles, meeting),
            (Met::Solid(crossing, point), Form::Solid(solid)) => {
                let facet = solid.surface_at(crossing, *point);
                let x = self.rest_from_form.transform_point3(facet.place);
                let normal = self.rest_from_form_normals * facet.normal;
                let size = x.abs().max_element().max(self.reach);
                Local { x, facet_normal: normal, normal, size, grain: GRAIN * self.extent }
            }
            _ => Local { x: DVec3::ZERO, facet_normal: DVec3::Z, normal: DVec3::Z, size: 0.0, grain: 0.0 },
        }
    }

    fn local_of_mesh(&self, triangles: &Triangles, meeting: &Meeting) -> Local {
        let mesh = &triangles.mesh;
        let corners = triangles.corners_met(meeting);
        let x = self.rest_from_form.transform_point3(mix(corners, meeting.weights));
        let facet = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let corner_normals = mesh.triangles[meeting.triangle as usize]
            .map(|i| mesh.normals.get(i as usize).map_or(DVec3::ZERO, |n| n.as_dvec3()));
        // The corners' coordinates may cancel, within the mesh and with its place: what is left is no measure of rounding.
        let size = |corner: DVec3| self.rest_from_form.transform_vector3(corner).abs().max_element();
        let own = corners.map(size).into_iter().fold(0.0, f64::max);
        let size = own + self.rest_from_form.translation.abs().max_element();
        Local {
            x,
            facet_normal: self.rest_from_form_normals * facet,
            normal: self.rest_from_form_normals * mix(corner_normals, meeting.weights),
            size,
            grain: GRAIN * own,
        }
    }

    /// Two steps along the surface, in the rest frame, and what they are in texture coordinates.
    pub(super) fn edges(&self, met: &Met, set: u8) -> Option<([DVec3; 2], [DVec2; 2])> {
        match (met, &self.form) {
            (Met::Triangle(meeting), Form::Mesh(triangles)) => {
                let mesh = &triangles.mesh;
                let uvs = mesh.uvs.get(set as usize).filter(|uvs| !uvs.is_empty())?;
                let corners = triangles.corners_met(meeting);
                let edge = |i: usize| self.rest_from_form.transform_vector3(corners[i] - corners[0]);
                let [a, b, c] = mesh.triangles[meeting.triangle as usize].map(|i| uvs[i as usize].as_dvec2());
                Some(([edge(1), edge(2)], [b - a, c - a]))
            }
            (Met::Solid(crossing, point), Form::Solid(solid)) => {
                let facet = solid.surface_at(crossing, *point);
                let steps = [facet.tangent_u, facet.tangent_v];
                Some((steps.map(|t| self.rest_from_form.transform_vector3(t)), [DVec2::X, DVec2::Y]))
            }
            _ => None,
        }
    }

    /// Texture coordinates of one set; the upper left corner where there are none.
    pub(super) fn uv(&self, met: &Met, set: u8) -> DVec2 {
        match (met, &self.form) {
            (Met::Triangle(meeting), Form::Mesh(triangles)) => {
                let mesh = &triangles.mesh;
                let uvs: &[Vec2] = mesh.uvs.get(set as usize).map_or(&[], |uvs| uvs);
                let [a, b, c] = mesh.triangles[meeting.triangle as usize]
                    .map(|i| uvs.get(i as usize).map_or(DVec2::ZERO, |uv| uv.as_dvec2()));
                let (v, w) = meeting.weights;
                a + (b - a) * v + (c - a) * w
            }
            (Met::Solid(crossing, point), Form::Solid(solid)) => solid.surface_at(crossing, *point).uv,
            _ => DVec2::ZERO,
        }
    }

    /// The file's own tangent (rest frame, of any length) and its hand, if it has them.
    pub(super) fn tangent(&self, met: &Met) -> Option<(DVec3, f64)> {
        let (Met::Triangle(meeting), Form::Mesh(triangles)) = (met, &self.form) else { return None };
        let mesh = &triangles.mesh;
        let tangents = mesh.triangles[meeting.triangle as usize].map(|i| mesh.tangents.get(i as usize));
        let [Some(a), Some(b), Some(c)] = tangents else { return None };
        let along = |t: &[f32; 4]| DVec3::new(f64::from(t[0]), f64::from(t[1]), f64::from(t[2]));
        let tangent = mix([along(a), along(b), along(c)], meeting.weights);
        // Where the map mirrors, so does the hand.
        let hand = f64::from(a[3]) * self.rest_from_form.matrix3.determinant().signum();
        Some((self.rest_from_form.transform_vector3(tangent), hand))
    }
}

/// The geometry of a surface at one place, in the rest frame of the body; normals outward, of any length.
pub(super) struct Local {
    pub(super) x: DVec3,
    pub(super) facet_normal: DVec3,
    pub(super) normal: DVec3,
    /// The largest coordinates that the place was computed from.
    pub(super) size: f64,
    /// The rounding of the form's own numbers.
    pub(super) grain: f64,
}

/// Twice the rounding of numbers in 32 bits, as meshes have them.
const GRAIN: f64 = 2e-7;

pub(super) fn mix([a, b, c]: [DVec3; 3], (v, w): (f64, f64)) -> DVec3 {
    a + (b - a) * v + (c - a) * w
}
