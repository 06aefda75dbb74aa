//! Lamps, spots and suns, each at rest in a frame of its own.

use crate::course::Course;
use crate::spacetime::{FourVector, Lab, Poincare, Rest, SightRay};
use crate::spectrum::Source;
use crate::world::Departure;
use glam::DVec3;

/// A lamp shines no brighter than from this distance, m: one over its square is still a number, whatever it is
/// multiplied by.
const NEAREST: f64 = 1e-15;

/// How a lamp shines in its own rest frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Beam {
    /// Alike to all sides, from one point.
    Point {
        /// Where it stands.
        place: DVec3,
    },
    /// A cone from one point: full inside the inner angle, none outside the outer, and in between the square of the
    /// cosine's part of the way (`KHR_lights_punctual`).
    Spot {
        /// Where it stands.
        place: DVec3,
        /// Where it points, unit length.
        axis: DVec3,
        /// Cosine of the inner half angle.
        cos_inner: f64,
        /// Cosine of the outer half angle.
        cos_outer: f64,
    },
    /// Parallel light.
    Sun {
        /// The way the light goes, unit length.
        axis: DVec3,
    },
}

/// A lamp.
#[derive(Debug, Clone)]
pub struct Lamp {
    /// Into its rest frame.
    pub rest_from_lab: Poincare<Rest, Lab>,
    /// How it shines.
    pub beam: Beam,
    /// Radiant intensity, W sr⁻¹ nm⁻¹, on the axis of a spot; irradiance, W m⁻² nm⁻¹, of a sun. The sum of all, each
    /// with its course in the lamp's own time.
    pub light: Vec<(Course, Source)>,
}

/// The light from a lamp to an event.
#[derive(Debug, Clone, Copy)]
pub struct Connection {
    /// The light, arriving at the event. It left the lamp at s = `s_lamp`.
    pub ray: SightRay,
    /// Where on the ray the lamp is; infinite for a sun.
    pub s_lamp: f64,
    /// When the light left, by the lamp's clock, metres. (A sun: when its wave front passed the place of the clock.)
    pub emitted: f64,
    /// Frequency at the lamp in the units of the ray's wave vector.
    pub omega: f64,
    /// What multiplies the source for a receiver at rest beside the lamp that faces the light: the cone over the
    /// distance squared, m⁻² (a sun: 1).
    pub dilution: f64,
}

impl Lamp {
    /// The light that arrives from the lamp at a surface; none outside a spot's cone or at the lamp itself.
    ///
    /// ~~~text
    /// d = p - x        k = (|d|, -d)        so that the events E - s k go from the receiver (0) to the lamp (1)
    /// ~~~
    pub fn connect(&self, receiver: &Departure<'_>) -> Option<Connection> {
        let event = receiver.within(&self.rest_from_lab);
        let (toward, s_lamp) = match self.beam {
            Beam::Point { place } | Beam::Spot { place, .. } => (place - event.x, 1.0),
            Beam::Sun { axis } => (-axis, f64::INFINITY),
        };
        let distance = toward.length();
        let cone = match self.beam {
            Beam::Spot { axis, cos_inner, cos_outer, .. } => {
                let cos = -toward.dot(axis) / distance;
                let width = cos_inner - cos_outer;
                let part = if width > 0.0 { (cos - cos_outer) / width } else { f64::from(cos >= cos_outer) };
                let part = part.clamp(0.0, 1.0);
                part * part
            }
            _ => 1.0,
        };
        if distance == 0.0 || cone == 0.0 {
            return None;
        }
        let k = self.rest_from_lab.boost().inverse().light(FourVector::new(distance, -toward));
        let apart = distance.max(NEAREST);
        let dilution = if s_lamp.is_finite() { cone / (apart * apart) } else { cone };
        let emitted = event.t - if s_lamp.is_finite() { distance } else { -toward.dot(event.x) };
        Some(Connection {
            ray: SightRay { event: receiver.event, k },
            s_lamp,
            emitted,
            omega: distance,
            dilution,
        })
    }
}
