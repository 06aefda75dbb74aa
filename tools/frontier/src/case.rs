//! One ray and one plate in motion: in 32 digits, by ours, and by what is commonly done.

use crate::double::{Double, Triple, boost};
use glam::{DAffine3, DVec3, Vec3};
use std::sync::Arc;
use terrell::mesh::Mesh;
use terrell::scene::{Placement, WorldBuilder};
use terrell::spacetime::{Event, FourVector, SightRay, Velocity};
use terrell::triangles::Triangles;
use terrell::world::{Form, World};

/// A plate at right angles to an axis of its rest frame, through its origin, and a sight ray.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// The plate's proper velocity.
    pub u: DVec3,
    /// When and where its origin is.
    pub origin: (f64, DVec3),
    pub eye: (f64, DVec3),
    /// Towards what is seen.
    pub n: DVec3,
}

/// What is asked of the ray.
#[derive(Debug, Clone, Copy)]
pub struct Answer {
    /// Frequency at the plate over frequency seen.
    pub omega: f64,
    /// How far it is, in the lab.
    pub s: f64,
    /// Where the plate is met, in its rest frame.
    pub place: DVec3,
}

/// The truth, in numbers of 32 digits, with the axis of the plate.
pub struct Truth {
    pub answer: Answer,
    axis: usize,
    s: Double,
    place: Triple,
}

impl Case {
    fn ray(&self) -> SightRay {
        SightRay { event: Event::new(self.eye.0, self.eye.1), k: FourVector::new(1.0, -self.n) }
    }

    pub fn truth(&self) -> Truth {
        let minus = |a: f64, b: f64| Double::from(a) - Double::from(b);
        let x = Triple([0, 1, 2].map(|i| minus(self.eye.1[i], self.origin.1[i])));
        let (_, e) = boost(self.u, minus(self.eye.0, self.origin.0), x);
        // The wave vector is null: its direction is what is given.
        let direction = Triple::from(-self.n);
        let k = direction.times(Double::from(1.0) / direction.length());
        let (omega, k) = boost(self.u, 1.0.into(), k);
        let size = k.f64().abs();
        let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0);
        let s = e.0[axis] / k.0[axis];
        let place = e.plus(k.times(-s));
        let answer = Answer { omega: omega.f64(), s: s.f64(), place: place.f64() };
        Truth { answer, axis, s, place }
    }

    /// Ours, through the library.
    pub fn ours(&self, truth: &Truth) -> Option<Answer> {
        let ray = self.ray();
        let world = self.world(truth);
        let hit = world.nearest(&ray)?;
        let spot = hit.spot(&ray);
        Some(Answer { omega: spot.k.t, s: hit.s, place: spot.event.x })
    }

    fn world(&self, truth: &Truth) -> World {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let (p, q) = (axes[(truth.axis + 1) % 3], axes[(truth.axis + 2) % 3]);
        let half =
            4.0 * truth.answer.place.abs().max_element().max(1e-3 * truth.answer.s * truth.answer.omega);
        let corner = |a: f64, b: f64| ((p * a + q * b) * half).as_vec3();
        let positions: Vec<Vec3> =
            vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let mesh = Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
        let form = Form::Mesh(Arc::new(Triangles::new(Arc::new(mesh))));
        let placement = Placement {
            origin: Event::new(self.origin.0, self.origin.1),
            velocity: Velocity::from_proper(self.u),
        };
        let mut builder = WorldBuilder::default();
        builder.add(0, placement, &form, DAffine3::IDENTITY, 0);
        builder.build()
    }
}

/// Ways in which it is commonly done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Way {
    /// γβ is kept, events are subtracted before they are boosted, k is not normalised.
    Careful,
    /// γ = 1/√(1 - β²)
    FromBeta,
    /// Each event is boosted by itself, then they are subtracted.
    EventsAlone,
    /// Unit directions, and the event of the hit transformed back to the lab.
    ByTime,
}

macro_rules! common {
    ($name:ident, $real:ty, $vector:ty, $as:ident) => {
        /// In numbers of this width.
        pub fn $name(case: &Case, truth: &Truth, way: Way) -> Answer {
            let beta = Velocity::from_proper(case.u).beta().$as();
            let mut u = case.u.$as();
            let mut gamma = (1.0 + u.length_squared()).sqrt();
            if way == Way::FromBeta {
                gamma = 1.0 / (1.0 - beta.length_squared()).sqrt();
                u = beta * gamma;
            }
            let apply = |u: $vector, t: $real, x: $vector| {
                let along = u.dot(x);
                (gamma * t - along, x + u * (along / (gamma + 1.0) - t))
            };
            let (et, ex) = (case.eye.0 as $real, case.eye.1.$as());
            let (ot, ox) = (case.origin.0 as $real, case.origin.1.$as());
            let (t, x) = if way == Way::EventsAlone {
                let ((et, ex), (ot, ox)) = (apply(u, et, ex), apply(u, ot, ox));
                (et - ot, ex - ox)
            } else {
                apply(u, et - ot, ex - ox)
            };
            let (omega, k) = apply(u, 1.0, -case.n.$as());
            let wide = |v: $vector| DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z));
            if way == Way::ByTime {
                let n = -k / k.length();
                let d = -x[truth.axis] / n[truth.axis];
                let place = x + n * d;
                let (_, back) = apply(-u, t - d, place);
                let s = (back + ox - ex).length();
                return Answer { omega: f64::from(omega), s: f64::from(s), place: wide(place) };
            }
            let s = x[truth.axis] / k[truth.axis];
            Answer { omega: f64::from(omega), s: f64::from(s), place: wide(x - k * s) }
        }
    };
}

common!(in_f64, f64, DVec3, itself);
common!(in_f32, f32, Vec3, as_vec3);

/// (So that one macro serves both widths.)
trait Itself {
    fn itself(self) -> DVec3;
}

impl Itself for DVec3 {
    fn itself(self) -> DVec3 {
        self
    }
}

impl Truth {
    /// Relative errors of the frequency and of s, and the place's error in metres.
    pub fn errors(&self, answer: Option<Answer>) -> [f64; 3] {
        let Some(answer) = answer else { return [f64::INFINITY; 3] };
        let relative = |a: f64, b: Double| ((Double::from(a) - b) / b).f64().abs();
        let omega = ((answer.omega - self.answer.omega) / self.answer.omega).abs();
        let place = Triple::from(answer.place).plus(self.place.times((-1.0).into())).f64().length();
        [omega, relative(answer.s, self.s), place]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_low_speed_and_near_by_all_ways_agree() {
        let n = DVec3::new(0.48, -0.6, 0.64);
        let case = Case {
            u: DVec3::new(0.1, 0.2, -0.1),
            origin: (-10.0, n * 10.0 + 0.25),
            eye: (0.0, DVec3::ZERO),
            n,
        };
        let truth = case.truth();
        for error in truth.errors(case.ours(&truth)) {
            assert!(error < 1e-14, "{error}");
        }
        for way in [Way::Careful, Way::FromBeta, Way::EventsAlone, Way::ByTime] {
            for error in truth.errors(Some(in_f64(&case, &truth, way))) {
                assert!(error < 1e-13, "{way:?} {error}");
            }
            for error in truth.errors(Some(in_f32(&case, &truth, way))) {
                assert!(error < 1e-4, "{way:?} {error}");
            }
        }
    }
}
