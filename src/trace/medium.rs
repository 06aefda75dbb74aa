//! Inside glass and water: which medium light is in, and what it does on the way.

use super::split::Parted;
use super::{Gathered, Leg, Lit, Path, Seen, Step};
use crate::spacetime::{FourVector, Lab, Rest, SightRay};
use crate::surface::{Medium, Surface};
use glam::DVec3;

/// The most bodies of glass within one another.
const MOST: usize = 6;

/// The bodies of glass that a ray is inside of.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Inside {
    media: [u32; MOST],
    count: u8,
}

impl Inside {
    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    pub(super) fn all(&self) -> &[u32] {
        &self.media[..usize::from(self.count)]
    }

    /// With one more; more than can be kept are forgotten.
    pub(super) fn with(mut self, medium: u32) -> Self {
        if !self.all().contains(&medium) && usize::from(self.count) < MOST {
            self.media[usize::from(self.count)] = medium;
            self.count += 1;
        }
        self
    }

    pub(super) fn without(self, medium: u32) -> Self {
        let others = self.all().iter().filter(|other| **other != medium);
        others.fold(Self::default(), |inside, other| inside.with(*other))
    }
}

/// Light in a medium: its wave vector, and what its events step by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Light4 {
    pub(super) wave: FourVector<Lab>,
    pub(super) step: FourVector<Lab>,
}

/// Light along `wave` in a medium at rest: the step is `(n_g, direction)` times the frequency.
pub(super) fn in_medium(medium: &Medium, direction: DVec3, omega: f64, nm: f64) -> Light4 {
    let lab_from_rest = medium.rest_from_lab.inverse();
    let (n, group) = (medium.index.at(nm), medium.index.group(nm));
    let wave = FourVector::<Rest>::new(omega, direction * (omega * n));
    let step = FourVector::<Rest>::new(omega * group, direction * omega);
    Light4 { wave: lab_from_rest.light(wave), step: lab_from_rest.light(step) }
}

impl Lit<'_> {
    /// The medium in which a ray is: of those that overlap, that of the smallest body.
    pub(super) fn medium(&self, inside: &Inside) -> Option<&Medium> {
        self.medium_number(inside).and_then(|medium| self.media.get(medium as usize))
    }

    /// The number of the medium in which a ray is.
    pub(super) fn medium_number(&self, inside: &Inside) -> Option<u32> {
        let volume = |medium: u32| self.media.get(medium as usize).map_or(f64::INFINITY, |m| m.volume);
        let index = |medium: u32| self.media.get(medium as usize).map_or(0.0, |m| m.index.at(589.0));
        // Of two as large the one that refracts more.
        let order = |a: &u32, b: &u32| {
            volume(*a).total_cmp(&volume(*b)).then(index(*b).total_cmp(&index(*a))).then(a.cmp(b))
        };
        inside.all().iter().copied().min_by(order)
    }

    /// Wavelength in a medium of light that the observer sees at one, and the frequency there.
    pub(super) fn local(&self, medium: &Medium, wave: FourVector, lane: f64) -> (f64, f64) {
        let omega = medium.rest_from_lab.light(wave).t;
        (lane / self.effects.shift(omega), omega)
    }

    /// How far s widens a cone in a medium: angles are smaller there by the index.
    pub(super) fn slowed(&self, leg: &Leg<'_>, lane: f64, s: f64) -> f64 {
        let Some(medium) = self.medium(&leg.inside) else { return s };
        let (nm, _) = self.local(medium, leg.wave, lane);
        s / medium.index.at(nm)
    }

    /// The wave vector of light that comes through a medium without end, and what of it is left: all of it, and n² times
    /// its radiance, of a medium that absorbs nothing.
    pub(super) fn escaped(&self, leg: &Leg<'_>, lane: f64) -> (FourVector, f64) {
        let Some(medium) = self.medium(&leg.inside) else { return (leg.wave, 1.0) };
        let inside = medium.rest_from_lab.light(leg.wave);
        let null = FourVector::<Rest>::new(inside.t, inside.x.normalize_or(DVec3::Z) * inside.t);
        let index = medium.index.at(lane / self.effects.shift(inside.t));
        let left = if medium.absorption.is_some() { 0.0 } else { index * index };
        (medium.rest_from_lab.inverse().light(null), left)
    }

    /// A sight ray that may begin within glass: there the camera looks out of a bubble without size, and `L/n²` is what
    /// it sees.
    pub(super) fn start_inside<const N: usize>(
        &self,
        leg: &Leg<'_>,
        lanes: &[f64; N],
        path: &Path<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let inside = self.inside_at(&leg.ray);
        let Some(medium) = self.medium(&inside) else { return self.gather(leg, lanes, path, gathered) };
        let null = medium.rest_from_lab.light(leg.wave);
        let start = |nm: f64| {
            let light = in_medium(medium, null.x / null.x.length(), null.t, nm / self.effects.shift(null.t));
            let ray = SightRay { event: leg.ray.event, k: light.step };
            Leg { ray, from: None, wave: light.wave, inside }
        };
        let part = |nm: f64| 1.0 / (medium.index.at(nm) * medium.index.at(nm));
        let step = Step { before: path.steps, part: &part, shift: self.effects.shift(null.t) };
        if medium.index.disperses() && N > 1 {
            let path = Path { steps: Some(&step), ..*path };
            let follow = &mut |lane: f64, path: &Path<'_, 1>, gathered: &mut Gathered<'_, 1>| {
                self.gather(&start(lane), &[lane], path, gathered);
            };
            let parted = Parted { wave: leg.wave, apart: &[], follow };
            self.split(lanes, &path, gathered, parted);
        } else {
            let shift = step.shift;
            let parts = lanes.map(|lane| part(lane / shift));
            self.gather(&start(lanes[0]), lanes, &path.filtered(&parts, &step), gathered);
        }
    }

    /// The bodies of glass around the start of a ray: those whose nearest surface is seen from inside.
    fn inside_at(&self, ray: &SightRay) -> Inside {
        let mut nearest: Vec<(u32, f64, bool)> = Vec::new();
        self.world.until(ray, None, f64::INFINITY, self.crowd.as_ref(), |hit| {
            let medium = self.surfaces.get(hit.surface()).and_then(Surface::medium);
            let Some(medium) = medium else { return false };
            let outside = hit.spot(ray).outside;
            match nearest.iter_mut().find(|(other, ..)| *other == medium) {
                Some(known) if known.1 <= hit.s => {}
                Some(known) => *known = (medium, hit.s, outside),
                None => nearest.push((medium, hit.s, outside)),
            }
            false
        });
        nearest.sort_unstable_by_key(|(medium, ..)| *medium);
        let around = nearest.iter().filter(|(.., outside)| !outside).map(|(medium, ..)| *medium);
        // Of what has no end the ray may never meet the surface.
        let endless = self
            .world
            .endless_around(ray.event)
            .filter_map(|surface| self.surfaces.get(surface).and_then(Surface::medium));
        around.chain(endless).fold(Inside::default(), Inside::with)
    }

    /// A surface seen through the medium before it: what that absorbs is taken first.
    pub(super) fn meet_through_medium<const N: usize>(
        &self,
        surface: &Surface,
        seen: &Seen<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let absorbing = self.medium(&seen.leg.inside).and_then(|m| Some((m, m.absorption.as_ref()?)));
        let Some((medium, absorption)) = absorbing else { return self.meet(surface, seen, gathered) };
        let shift = self.effects.shift(medium.rest_from_lab.light(seen.leg.wave).t);
        let way = medium.rest_from_lab.light(seen.leg.ray.k).x.length() * seen.met.hit.s;
        let part = |nm: f64| absorption.after(way, nm);
        let step = Step { before: seen.path.steps, part: &part, shift };
        let parts = seen.lanes.map(|lane| part(lane / shift));
        let path = seen.path.filtered(&parts, &step);
        if !path.is_faint(self.faintest) {
            self.meet(surface, &seen.through(&path), gathered);
        }
    }
}
