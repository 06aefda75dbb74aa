//! What a sight ray meets first, beside its light.

use super::{Lit, MOST_VEILS};
use crate::spacetime::{Doppler, Event, FourVector, SightRay};
use crate::surface::{Look, Surface};

/// What a picture can show of a sight ray's first hit beside its light.
#[derive(Debug, Clone, Copy)]
pub struct First {
    /// Frequency seen over frequency at the body.
    pub doppler: Doppler,
    /// The event at which the light left the body.
    pub emission: Event,
    /// How far back along the ray that is: the distance as who sees the frequency 1 has it, metres.
    pub s: f64,
    /// The normal there, of unit length in the body's rest frame and without a part along its time, on the side that is
    /// seen; in the lab.
    pub normal: FourVector,
    /// The number of the body.
    pub body: u32,
    /// The number of the surface.
    pub surface: u32,
}

impl Lit<'_> {
    /// The first hit of a sight ray.
    pub fn first(&self, ray: &SightRay) -> Option<First> {
        self.first_and(ray, |_, _| ()).map(|(first, ())| first)
    }

    /// The first hit of a sight ray, and something of the surface there.
    pub fn first_and<T>(
        &self,
        ray: &SightRay,
        of: impl Fn(Option<&Surface>, &Look<'_>) -> T,
    ) -> Option<(First, T)> {
        let mut ray = *ray;
        let mut from = None;
        let mut way = 0.0;
        for _ in 0..MOST_VEILS {
            let hit = self.world.nearest_from(&ray, from.as_ref(), self.crowd.as_ref())?;
            let spot = hit.spot(&ray);
            let look = Look { hit: &hit, spot: &spot, radius: 0.0 };
            let surface = self.surfaces.get(hit.surface());
            let veil = surface.and_then(|surface| surface.veil.as_ref());
            way += hit.s;
            if veil.is_none_or(|veil| veil.share(&look) >= 0.5) {
                let normal = look.normal(surface.and_then(|surface| surface.relief.as_ref()));
                let first = First {
                    doppler: Doppler::from_emitted(spot.k.t),
                    emission: ray.at(hit.s),
                    s: way,
                    normal: hit.rest.rest_from_lab.boost().inverse() * FourVector::new(0.0, normal),
                    body: hit.placed.body,
                    surface: hit.surface() as u32,
                };
                return Some((first, of(surface, &look)));
            }
            let beyond = spot.beyond(hit.rest, 0.0);
            ray.event = beyond.event;
            from = Some(beyond);
        }
        None
    }
}
