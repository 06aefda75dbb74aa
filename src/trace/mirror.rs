//! Mirrors, and the mirror images in surfaces with a gloss.

use super::{Gathered, Leg, Lit, Path, Seen, Step};
use crate::spacetime::SightRay;
use crate::surface::{Lobes, Paint, Reflection, Response, Surface, before_mirror, fade};
use glam::DVec3;

impl Lit<'_> {
    pub(super) fn follow_mirror<const N: usize>(
        &self,
        paint: &Paint,
        surface: &Surface,
        seen: &Seen<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        if seen.path.depth == 0 {
            return;
        }
        let tint = paint.at(&seen.look());
        let part = |nm: f64| tint.at(nm);
        let step = Step { before: seen.path.steps, part: &part, shift: seen.shift };
        let path = seen.path.filtered(&tint.at_each(&seen.nm), &step);
        self.reflect(seen.look().normal(surface.relief.as_ref()), &path, seen, gathered);
    }

    /// Light of lamps on a surface with a gloss, and what is mirrored in it.
    pub(super) fn add_gloss<const N: usize>(
        &self,
        surface: &Surface,
        seen: &Seen<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let Some(lobes) = Lobes::of(surface, &seen.look()) else { return };
        let (mut fill, reflections) = lobes.all_round(seen.to_eye());
        // What is not traced of a rough reflection sees the fill light.
        for reflection in reflections.iter().flatten() {
            let traced = if seen.path.depth > 0 { fade(reflection.roughness) } else { 0.0 };
            fill = fill.plus(reflection.response, 1.0 - traced);
        }
        self.add_lobes(&lobes, fill, surface, seen, gathered);
        if seen.path.depth == 0 {
            return;
        }
        for reflection in reflections.iter().flatten() {
            self.add_reflection(&lobes, reflection, seen, gathered);
        }
    }

    fn add_reflection<const N: usize>(
        &self,
        lobes: &Lobes<'_>,
        reflection: &Reflection,
        seen: &Seen<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let traced = fade(reflection.roughness);
        if traced == 0.0 {
            return;
        }
        let response = Response::default().plus(reflection.response, traced);
        let part = |nm: f64| lobes.at(&response, nm);
        let step = Step { before: seen.path.steps, part: &part, shift: seen.shift };
        let path = seen.path.filtered(&seen.nm.map(part), &step);
        self.reflect(reflection.normal, &path, seen, gathered);
    }

    /// Light that reached a mirror: the same frequency in the mirror's rest frame, the normal part of its way reversed.
    pub(super) fn reflect<const N: usize>(
        &self,
        normal: DVec3,
        path: &Path<'_, N>,
        seen: &Seen<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        if path.is_faint(self.faintest) {
            return;
        }
        let leg = if seen.leg.inside.is_empty() {
            let mut arriving = seen.met.spot.k;
            arriving.x = before_mirror(arriving.x, normal);
            if arriving.x.dot(seen.met.spot.facet_normal) >= 0.0 {
                // The interpolated normal would send the ray through the surface: the facet's own does not.
                arriving.x = before_mirror(seen.met.spot.k.x, seen.met.spot.facet_normal);
            }
            let k = seen.met.hit.rest.rest_from_lab.boost().inverse().light(arriving);
            let ray = SightRay { event: seen.met.departure.event, k };
            Leg { ray, from: Some(&seen.met.departure), wave: k, inside: seen.leg.inside }
        } else {
            let Some(leg) = self.reflected_inside(normal, seen) else { return };
            leg
        };
        let path = Path { depth: path.depth - 1, way: seen.way, ..*path };
        self.gather(&leg, seen.lanes, &path, gathered);
    }
}
