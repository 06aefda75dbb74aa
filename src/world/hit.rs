//! Where a sight ray meets a body, and what the surface is like there.

use super::RestFrame;
use super::placed::{Form, Met, Placed};
use crate::spacetime::{Event, FourVector, Lab, Poincare, Rest, SightRay};
use glam::{DVec2, DVec3};

/// Where a sight ray meets a body.
#[derive(Debug, Clone, Copy)]
pub struct Hit<'w> {
    /// The ray's parameter, the same in every frame.
    pub s: f64,
    /// The rest frame.
    pub rest: &'w RestFrame,
    /// What is met.
    pub placed: &'w Placed,
    pub(super) met: Met,
}

/// The surface at a hit, in the rest frame of the body.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    /// The event of the hit.
    pub event: Event<Rest>,
    /// What the sight ray's events step by: the wave vector of the light that leaves the surface, in vacuum.
    pub k: FourVector<Rest>,
    /// The facet's own normal, on the side from which it is seen.
    pub facet_normal: DVec3,
    /// The interpolated normal, on the same side.
    pub normal: DVec3,
    /// Whether it is seen from outside, the side from which corners go counter-clockwise.
    pub outside: bool,
    /// The largest coordinates that the place was computed from, metres: its rounding is a part of them.
    pub size: f64,
    /// Surfaces that are nearer than this touch, metres: what the form's own numbers leave open.
    pub grain: f64,
}

/// Where a ray leaves a body.
#[derive(Debug, Clone, Copy)]
pub struct Departure<'w> {
    /// In the lab.
    pub event: Event,
    /// The body's rest frame.
    pub rest: &'w RestFrame,
    /// The same event there. On the way through the lab and back it would move by a part γ² of its rounding.
    pub at: Event<Rest>,
}

impl Departure<'_> {
    /// The same event in another rest frame.
    #[inline]
    pub fn within(&self, other: &Poincare<Rest, Lab>) -> Event<Rest> {
        if self.rest.rest_from_lab.boost().is_fast() {
            let [t, x, y, z] = self.within_fast(other);
            return Event::new(t, DVec3::new(x, y, z));
        }
        *other * self.event
    }

    #[cold]
    #[inline(never)]
    fn within_fast(&self, other: &Poincare<Rest, Lab>) -> [f64; 4] {
        let own = &self.rest.rest_from_lab;
        let Event { t, x, .. }: Event<Rest> = if own.boost().velocity() == other.boost().velocity() {
            // The same frame but for its origin: past the lab.
            self.at - (*own * other.origin() - Event::ORIGIN)
        } else {
            *other * self.event
        };
        [t, x.x, x.y, x.z]
    }
}

impl Hit<'_> {
    /// The hit as its own rest frame sees it.
    pub fn spot(&self, ray: &SightRay) -> Spot {
        let k = self.rest.rest_from_lab.light(ray.k);
        let t = (self.rest.rest_from_lab * ray.at(self.s)).t;
        let local = self.placed.local(&self.met);
        let facet = unit(local.facet_normal, k.x);
        // Seen from behind: the other side is the outside.
        let outside = facet.dot(k.x) >= 0.0;
        let side = if outside { 1.0 } else { -1.0 };
        let normal = unit(local.normal, facet) * side;
        Spot {
            event: Event::new(t, local.x),
            k,
            facet_normal: facet * side,
            normal,
            outside,
            size: local.size,
            grain: local.grain + 256.0 * f64::EPSILON * local.size,
        }
    }

    /// The same hit on a ray that starts `s` further from it.
    #[must_use]
    pub fn later(self, s: f64) -> Self {
        Self { s: self.s + s, ..self }
    }

    /// Number of the surface met.
    pub fn surface(&self) -> usize {
        let of_mesh = match (&self.met, &self.placed.form) {
            (Met::Triangle(meeting), Form::Mesh(triangles)) => triangles.mesh.material_of(meeting.triangle),
            _ => 0,
        };
        self.placed.surfaces as usize + of_mesh as usize
    }

    /// Texture coordinates of one set; the upper left corner where the mesh has none.
    pub fn uv(&self, set: u8) -> DVec2 {
        self.placed.uv(&self.met, set)
    }

    /// The vertices' colour, linear RGBA; none for a mesh without.
    pub fn vertex_color(&self) -> Option<[f32; 4]> {
        let (Met::Triangle(meeting), Form::Mesh(triangles)) = (&self.met, &self.placed.form) else {
            return None;
        };
        let mesh = &triangles.mesh;
        let [a, b, c] = mesh.triangles[meeting.triangle as usize].map(|i| mesh.colors.get(i as usize));
        let (v, w) = (meeting.weights.0 as f32, meeting.weights.1 as f32);
        let (a, b, c) = (a?, b?, c?);
        Some(std::array::from_fn(|i| a[i] + (b[i] - a[i]) * v + (c[i] - a[i]) * w))
    }

    /// What a step along the surface (rest frame) is in texture coordinates; none without any.
    pub fn uv_of(&self, set: u8, along: [DVec3; 2]) -> Option<[DVec2; 2]> {
        let ([e1, e2], [d1, d2]) = self.placed.edges(&self.met, set)?;
        // along = β e1 + γ e2, solved in the plane of the triangle.
        let (a, b, c) = (e1.dot(e1), e1.dot(e2), e2.dot(e2));
        let det = a * c - b * b;
        if !(det > 0.0) {
            return None;
        }
        let solve = |v: DVec3| {
            let (p, q) = (v.dot(e1), v.dot(e2));
            (d1 * (c * p - b * q) + d2 * (a * q - b * p)) / det
        };
        Some(along.map(solve))
    }

    /// Along growing u, and toward the upper side of the picture, both at right angles to `normal` (which looks
    /// outward), unit length: the axes of a normal map (glTF 2.0, §3.7.2.1).
    pub fn tangents(&self, set: u8, normal: DVec3) -> Option<(DVec3, DVec3)> {
        let (tangent, hand) = match self.placed.tangent(&self.met) {
            Some(own) => own,
            None => {
                let ([e1, e2], [d1, d2]) = self.placed.edges(&self.met, set)?;
                // v grows downward, as glTF has it.
                let det = d1.x * d2.y - d1.y * d2.x;
                let along_u = (e1 * d2.y - e2 * d1.y) * det.signum();
                let outward = self.placed.local(&self.met).facet_normal;
                let along_v = (e2 * d1.x - e1 * d2.x) * det.signum();
                let hand = if outward.cross(along_u).dot(along_v) > 0.0 { -1.0 } else { 1.0 };
                (along_u, hand)
            }
        };
        let tangent = (tangent - normal * tangent.dot(normal)).try_normalize()?;
        Some((tangent, normal.cross(tangent) * hand))
    }
}

/// The unit vector along `v`, or along `otherwise` if `v` has no direction.
fn unit(v: DVec3, otherwise: DVec3) -> DVec3 {
    v.try_normalize().unwrap_or_else(|| otherwise.normalize_or(DVec3::Z))
}

impl Spot {
    /// The hit's event, moved off the facet on the side from which it is seen, by more than its rounding.
    pub fn departure<'w>(&self, rest: &'w RestFrame) -> Departure<'w> {
        self.off(rest, 1.0, 0.0)
    }

    /// The same on the other side, and `more` metres further.
    pub fn beyond<'w>(&self, rest: &'w RestFrame, more: f64) -> Departure<'w> {
        self.off(rest, -1.0, more)
    }

    /// Rays that leave here meet what is in this rest frame from here, not from the lab: only the rounding of places in
    /// the rest frame counts.
    fn off<'w>(&self, rest: &'w RestFrame, side: f64, more: f64) -> Departure<'w> {
        let bound = 64.0 * f64::EPSILON * self.size;
        let x = self.event.x + self.facet_normal * (side * (bound + more));
        let at = Event::new(self.event.t, x);
        Departure { event: rest.rest_from_lab.undo(at), rest, at }
    }
}
