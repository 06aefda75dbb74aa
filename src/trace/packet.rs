//! Sight rays that are near one another.
//!
//! What they meet first, and which lamps shine on that, is asked of all together; the rest is done one by one, by the same loop. So
//! each has the light that it has by itself, to the bit.

use super::direct::Toward;
use super::{Cone, Gathered, Leg, Light, Lit, Met, Path};
use crate::spacetime::SightRay;
use crate::spectrum::Wavelengths;
use crate::surface::Scatter;
use crate::tree::MANY;
use crate::world::Departure;
use glam::DVec3;
use smallvec::SmallVec;

/// Something of each of the rays.
type Each<T> = SmallVec<[T; MANY]>;

impl Lit<'_> {
    /// The light that arrives along sight rays, one after another: the same bits as by [`Lit::seen_within`].
    pub fn seen_many<const N: usize>(
        &self,
        rays: &[(SightRay, Cone)],
        wavelengths: &Wavelengths<N>,
        mut tell: impl FnMut(usize, Light<N>),
    ) {
        for (number, rays) in rays.chunks(MANY).enumerate() {
            let mut tell = |i: usize, light| tell(number * MANY + i, light);
            if rays.len() > 1 && rays.iter().all(|(ray, _)| self.begins_in_vacuum(ray)) {
                self.seen_together(rays, wavelengths, tell);
            } else {
                let seen = |(ray, cone): &(SightRay, Cone)| self.seen_within(ray, *cone, wavelengths);
                rays.iter().map(seen).enumerate().for_each(|(i, light)| tell(i, light));
            }
        }
    }

    /// The same of up to 16 that begin in vacuum.
    fn seen_together<const N: usize>(
        &self,
        rays: &[(SightRay, Cone)],
        wavelengths: &Wavelengths<N>,
        mut tell: impl FnMut(usize, Light<N>),
    ) {
        let found = self.world.nearest_many(rays.iter().map(|(ray, _)| ray), self.crowd.as_ref());
        let toward; // Outlives what borrows it.
        let mut met: Each<Option<Met<'_>>> = SmallVec::new();
        for ((ray, _), hit) in rays.iter().zip(found) {
            met.push(hit.map(|hit| Met::new(hit, ray)));
        }
        toward = self.toward_lamps(&met);
        for (met, toward) in met.iter_mut().zip(toward.chunks(self.lamps.len().max(1))) {
            if let Some(met) = met.as_mut().filter(|met| self.asks_lamps(met)) {
                met.toward = toward;
            }
        }
        for (i, (ray, cone)) in rays.iter().enumerate() {
            let mut light = Light { radiance: [0.0; N], lines: DVec3::ZERO };
            let mut gathered = Gathered { light: &mut light, bands: None, caught: None, exit: (0.0, ray.k) };
            let (path, leg) = (Path::new(self.depth, *cone), Leg::of(ray));
            match &met[i] {
                Some(met) => self.arrive(met, &leg, &wavelengths.nm, &path, &mut gathered),
                None => self.add_surroundings(&leg, &wavelengths.nm, &path, &mut gathered),
            }
            tell(i, light);
        }
    }

    /// The ways from each place to each lamp, place by place.
    fn toward_lamps(&self, met: &[Option<Met<'_>>]) -> SmallVec<[Option<Toward>; 2 * MANY]> {
        let mut toward: SmallVec<[Option<Toward>; 2 * MANY]> = SmallVec::new();
        for met in met {
            let met = met.as_ref().filter(|met| self.asks_lamps(met));
            for lamp in self.lamps {
                toward.push(met.and_then(|met| Toward::new(lamp, met)));
            }
        }
        let lamps = self.lamps.len();
        for lamp in 0..lamps {
            let mut which: Each<usize> = SmallVec::new();
            let mut rays: Each<(&SightRay, &Departure<'_>, f64)> = SmallVec::new();
            for (i, met) in met.iter().enumerate() {
                let (Some(met), Some(toward)) = (met, &toward[i * lamps + lamp]) else { continue };
                if toward.is_above(&met.spot) {
                    which.push(i * lamps + lamp);
                    rays.push((&toward.connection.ray, &met.departure, toward.connection.s_lamp));
                }
            }
            if rays.is_empty() {
                continue;
            }
            let blocked = self.world.blocked_many(rays, self.crowd.as_ref());
            for (bit, i) in which.into_iter().enumerate() {
                if let Some(toward) = &mut toward[i] {
                    toward.blocked = Some(blocked >> bit & 1 == 1);
                }
            }
        }
        toward
    }

    /// Whether light of lamps is what is looked for at a surface.
    fn asks_lamps(&self, met: &Met<'_>) -> bool {
        let surface = self.surfaces.get(met.hit.surface());
        surface.is_some_and(|surface| {
            matches!(surface.scatter, Scatter::Diffuse(_) | Scatter::Gloss(_) | Scatter::Metal(_))
        })
    }
}
