//! What a ray is between two surfaces, what lies behind it, and what it has met.

use super::Cone;
use super::direct::Toward;
use super::medium::Inside;
use crate::spacetime::{FourVector, SightRay};
use crate::surface::Look;
use crate::world::{Departure, Hit, Spot};
use glam::DVec3;

/// The most surfaces with holes that are looked through one after another.
pub(super) const MOST_VEILS: u32 = 100;

/// Part of a sight ray, from one surface to the next.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leg<'w> {
    // The events of the light are `event - s k`. In vacuum k is its wave vector; in a medium it is slower.
    pub(super) ray: SightRay,
    // The body that it leaves.
    pub(super) from: Option<&'w Departure<'w>>,
    // The wave vector.
    pub(super) wave: FourVector,
    pub(super) inside: Inside,
}

/// What lies between the observer and where the light is now.
#[derive(Clone, Copy)]
pub(super) struct Path<'p, const N: usize> {
    // What the observer still gets of the light, at its wavelengths.
    pub(super) throughput: [f64; N],
    // The same, for lines: step by step.
    pub(super) steps: Option<&'p Step<'p>>,
    pub(super) depth: u32,
    pub(super) veils: u32,
    // The sum of s so far, by which the cone has widened.
    pub(super) way: f64,
    pub(super) cone: Cone,
}

/// Something that takes its part of the light, by wavelength where it stands.
pub(super) struct Step<'p> {
    pub(super) before: Option<&'p Self>,
    pub(super) part: &'p dyn Fn(f64) -> f64,
    pub(super) shift: f64,
}

impl Step<'_> {
    /// What the observer gets of light that it sees at one wavelength.
    pub(super) fn throughput(&self, wavelength_nm: f64) -> f64 {
        let before = self.before.map_or(1.0, |step| step.throughput(wavelength_nm));
        before * (self.part)(wavelength_nm / self.shift)
    }
}

impl Leg<'_> {
    /// From where a sight ray arrives.
    pub(super) fn of(ray: &SightRay) -> Self {
        Self { ray: *ray, from: None, wave: ray.k, inside: Inside::default() }
    }
}

impl<'p, const N: usize> Path<'p, N> {
    /// With nothing between as yet.
    pub(super) fn new(depth: u32, cone: Cone) -> Self {
        Self { throughput: [1.0; N], steps: None, depth, veils: MOST_VEILS, way: 0.0, cone }
    }

    /// With the same part taken of all wavelengths.
    pub(super) fn dimmed(&self, part: f64, step: &'p Step<'p>) -> Self {
        Self { throughput: self.throughput.map(|value| value * part), steps: Some(step), ..*self }
    }

    /// With a part taken of each wavelength.
    pub(super) fn filtered(&self, parts: &[f64; N], step: &'p Step<'p>) -> Self {
        let mut throughput = self.throughput;
        for (value, part) in throughput.iter_mut().zip(parts) {
            *value *= part;
        }
        Self { throughput, steps: Some(step), ..*self }
    }

    pub(super) fn is_faint(&self, faintest: f64) -> bool {
        self.throughput.iter().all(|value| *value <= faintest)
    }
}

/// What a ray has met.
#[derive(Clone, Copy)]
pub(super) struct Met<'w> {
    pub(super) hit: Hit<'w>,
    pub(super) spot: Spot,
    pub(super) departure: Departure<'w>,
    // The ways to the lamps, of those that have been asked.
    pub(super) toward: &'w [Option<Toward>],
}

impl<'w> Met<'w> {
    #[inline]
    pub(super) fn new(hit: Hit<'w>, ray: &SightRay) -> Self {
        let spot = hit.spot(ray);
        Self { departure: spot.departure(hit.rest), hit, spot, toward: &[] }
    }
}

/// A hit with what the observer's terms become there.
pub(super) struct Seen<'h, const N: usize> {
    pub(super) met: &'h Met<'h>,
    pub(super) leg: &'h Leg<'h>,
    // The light's frequency at the surface, in units of what the observer sees.
    pub(super) omega: f64,
    // ω where wavelengths are concerned: 1 with the Doppler effect switched off.
    pub(super) shift: f64,
    // The observer's wavelengths, and the same in the surface's rest frame, nm.
    pub(super) lanes: &'h [f64; N],
    pub(super) nm: [f64; N],
    pub(super) path: &'h Path<'h, N>,
    // Half the width of what the sample sees, rest frame, m.
    pub(super) radius: f64,
    // The sum of s up to here.
    pub(super) way: f64,
}

impl<const N: usize> Seen<'_, N> {
    pub(super) fn look(&self) -> Look<'_> {
        Look { hit: &self.met.hit, spot: &self.met.spot, radius: self.radius }
    }

    /// The direction to where the light goes, unit, in the surface's rest frame.
    pub(super) fn to_eye(&self) -> DVec3 {
        self.met.spot.k.x / self.met.spot.k.x.length()
    }

    /// The ray beyond the surface as if that were not there.
    pub(super) fn straight_on<'d>(&self, beyond: &'d Departure<'d>) -> Leg<'d> {
        let ray = SightRay { event: beyond.event, ..self.leg.ray };
        Leg { ray, from: Some(beyond), wave: self.leg.wave, inside: self.leg.inside }
    }

    /// The body's own time.
    pub(super) fn tau(&self) -> f64 {
        self.met.spot.event.t - self.met.hit.placed.clock_zero
    }

    /// The same seen through something more.
    pub(super) fn through<'s>(&'s self, path: &'s Path<'s, N>) -> Seen<'s, N> {
        Seen { path, ..*self }
    }
}
