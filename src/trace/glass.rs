//! Faces of glass: what is reflected and what is let through.
//!
//! All is done in the rest frame of the face, where the frequency and the wave vector's part along the face are the same on
//! both sides. What the wave vector is beyond follows from the dispersion relation of the medium there, which may move
//! relative to the face: with U its four-velocity,
//!
//! ~~~text
//! k·k + (n² - 1)(k·U)² = 0
//! ~~~
//!
//! Fresnel's equations are those of media at rest with the face. Light is without polarisation after each face.

use super::medium::{Inside, Light4, in_medium};
use super::split::Parted;
use super::{Gathered, Leg, Lit, Met, Path, Seen, Step, scaled};
use crate::fresnel;
use crate::spacetime::{FourVector, Rest, SightRay};
use crate::surface::{Glass, Lobes, Look, Medium, Response, Surface, fade};
use crate::world::Hit;
use glam::DVec3;

/// A face between two media, one of which may be none.
struct Face<'m> {
    // Before the light leaves through the face, as rays go (the observer's side), and beyond it.
    near: Option<&'m Medium>,
    far: Option<&'m Medium>,
    // On the observer's side.
    normal: DVec3,
    facet_normal: DVec3,
    // The light that leaves toward the observer, in the rest frame of the face.
    leaving: FourVector<Rest>,
}

/// Light of one wavelength at a face.
#[derive(Clone, Copy)]
struct AtFace {
    reflectance: f64,
    // What arrives from beyond, unless all is reflected.
    refracted: Option<Light4>,
    // What is seen of its radiance: (1 - R)(n/n')².
    part: f64,
}

/// Light of the observer's wavelengths at a face.
struct Lanes<const N: usize> {
    all: [AtFace; N],
}

/// Which way light goes at a face: with `leaving`, away from it along the normal for `sense` 1, toward it for -1.
#[derive(Clone, Copy)]
struct Going {
    leaving: FourVector<Rest>,
    normal: DVec3,
    sense: f64,
}

/// One solution of the dispersion relation.
#[derive(Clone, Copy)]
struct Wave {
    at_face: FourVector<Rest>,
    light: Light4,
    // In the medium's own frame.
    index: f64,
}

impl Lit<'_> {
    pub(super) fn add_glass<const N: usize>(
        &self,
        glass: &Glass,
        surface: &Surface,
        seen: &Seen<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let look = seen.look();
        let amount = glass.amount_at(&look);
        if amount < 1.0 || glass.roughness > 0.0 {
            self.add_coat(glass, surface, seen, gathered);
        }
        if seen.path.depth == 0 || amount <= 0.0 && glass.roughness >= 0.5 {
            return;
        }
        if glass.thin {
            self.add_pane(glass, amount, surface, seen, gathered);
        } else {
            self.add_body(glass, amount, surface, seen, gathered);
        }
    }

    /// Highlights of lamps, and the diffuse part of what is not all glass.
    fn add_coat<const N: usize>(
        &self,
        glass: &Glass,
        surface: &Surface,
        seen: &Seen<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let Some(lobes) = Lobes::of(surface, &seen.look()) else { return };
        let cosine = lobes.normal.dot(seen.to_eye()).clamp(0.0, 1.0);
        let through = 1.0 - fresnel::dielectric(cosine, glass.index.at(589.0));
        let diffuse = 1.0 - glass.amount_at(&seen.look());
        // What is not traced of the reflection of a rough face sees the fill light.
        let white =
            if seen.leg.inside.is_empty() { (1.0 - through) * (1.0 - fade(glass.roughness)) } else { 0.0 };
        let fill = Response { base: diffuse * through, white, ..Response::default() };
        self.add_lobes(&lobes, fill, surface, seen, gathered);
    }

    /// A pane without thickness: one reflection, and the rest straight on.
    fn add_pane<const N: usize>(
        &self,
        glass: &Glass,
        amount: f64,
        surface: &Surface,
        seen: &Seen<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let look = seen.look();
        let normal = look.normal(surface.relief.as_ref());
        let cosine = normal.dot(seen.to_eye()).clamp(0.0, 1.0);
        let reflectance = |nm: f64| fresnel::dielectric(cosine, glass.index.at(nm));
        let mirrored = |nm: f64| fade(glass.roughness) * reflectance(nm);
        let step = Step { before: seen.path.steps, part: &mirrored, shift: seen.shift };
        let path = seen.path.filtered(&seen.nm.map(mirrored), &step);
        self.reflect(normal, &path, seen, gathered);

        let tint = glass.color.as_ref().map(|color| color.at(&look));
        let part = |nm: f64| {
            let color = tint.as_ref().map_or(1.0, |tint| tint.at(nm));
            amount * color * (1.0 - reflectance(nm))
        };
        let step = Step { before: seen.path.steps, part: &part, shift: seen.shift };
        let path = seen.path.filtered(&seen.nm.map(part), &step);
        if !path.is_faint(self.faintest) {
            let path = Path { depth: path.depth - 1, way: seen.way, ..path };
            let beyond = seen.met.spot.beyond(seen.met.hit.rest, 0.0);
            self.gather(&seen.straight_on(&beyond), seen.lanes, &path, gathered);
        }
    }

    /// The face of a body of glass.
    fn add_body<const N: usize>(
        &self,
        glass: &Glass,
        amount: f64,
        surface: &Surface,
        seen: &Seen<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let (inside, further, contact) = self.beyond(glass.medium, seen);
        if let Some(hit) = contact {
            return self.meet_in_contact(&hit, seen, gathered);
        }
        let from = seen.met.spot.beyond(seen.met.hit.rest, further);
        let (near, far) = (self.medium_number(&seen.leg.inside), self.medium_number(&inside));
        if near == far {
            // Within something else that decides: nothing happens here.
            let leg = Leg { inside, ..seen.straight_on(&from) };
            let path = Path { depth: seen.path.depth - 1, way: seen.way, ..*seen.path };
            return self.gather(&leg, seen.lanes, &path, gathered);
        }
        let look = seen.look();
        let face = self.face(&inside, look.normal(surface.relief.as_ref()), seen);
        let disperses = |medium: Option<&Medium>| medium.is_some_and(|medium| medium.index.disperses());
        let even = !disperses(face.near) && !disperses(face.far);
        let lanes = Lanes::at(even, seen, |lane| self.at_face(&face, seen, lane));

        let shift = seen.shift;
        let reflectance = |nm: f64| self.at_face(&face, seen, nm * shift).reflectance;
        // The mirror image in a rough face fades; that from within does not.
        let shown = if face.near.is_none() { fade(glass.roughness) } else { 1.0 };
        let mirrored = |nm: f64| shown * reflectance(nm);
        let step = Step { before: seen.path.steps, part: &mirrored, shift };
        let reflected = seen.path.filtered(&lanes.each(|_, at| shown * at.reflectance), &step);
        let alone = reflected.is_faint(self.faintest);
        if !alone {
            self.reflect(face.normal, &reflected, seen, gathered);
        }
        let tint = glass.color.as_ref().map(|color| color.at(&look));
        let part_of = |nm: f64, at: &AtFace| {
            let color = tint.as_ref().map_or(1.0, |tint| tint.at(nm).max(0.0).sqrt());
            // What is not followed goes where the rest goes.
            let rest =
                if alone && at.part > 0.0 && shown >= 1.0 { 1.0 / (1.0 - at.reflectance) } else { 1.0 };
            amount * color * at.part * rest
        };
        let part = |nm: f64| part_of(nm, &self.at_face(&face, seen, nm * shift));
        let step = Step { before: seen.path.steps, part: &part, shift };
        let path = seen.path.filtered(&lanes.each(|i, at| part_of(seen.nm[i], at)), &step);
        let path = Path { depth: path.depth - 1, way: seen.way, ..path };
        if path.is_faint(self.faintest) {
            return;
        }
        let onward = |light: Light4| Leg {
            ray: SightRay { event: from.event, k: light.step },
            from: Some(&from),
            wave: light.wave,
            inside,
        };
        if even || N == 1 {
            if let Some(light) = lanes.all[0].refracted {
                self.gather(&onward(light), seen.lanes, &path, gathered);
            }
            return;
        }
        let apart = lanes.apart(glass.index.at(589.0), seen);
        let follow = &mut |lane: f64, path: &Path<'_, 1>, gathered: &mut Gathered<'_, 1>| {
            if let Some(light) = self.at_face(&face, seen, lane).refracted {
                self.gather(&onward(light), &[lane], path, gathered);
            }
        };
        self.split(seen.lanes, &path, gathered, Parted { wave: seen.leg.wave, apart: &apart, follow });
    }

    /// A surface that lets nothing through and touches a face from beyond: it is seen as from within the medium.
    fn meet_in_contact<const N: usize>(
        &self,
        hit: &Hit<'_>,
        seen: &Seen<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let Some(surface) = self.surfaces.get(hit.surface()) else { return };
        let spot = hit.spot(&seen.leg.ray);
        let omega = hit.rest.rest_from_lab.light(seen.leg.wave).t;
        let shift = self.effects.shift(omega);
        let nm = scaled(seen.lanes, 1.0 / shift);
        // Its light comes and goes on this side of the face, within the medium.
        let met = Met { hit: *hit, spot, toward: &[], ..*seen.met };
        self.meet(surface, &Seen { met: &met, omega, shift, nm, ..*seen }, gathered);
    }

    /// What is beyond a face, how far the last of the surfaces is that touch it (m, rest frame), and whether one of these
    /// lets nothing through.
    fn beyond<const N: usize>(&self, medium: u32, seen: &Seen<'_, N>) -> (Inside, f64, Option<Hit<'_>>) {
        let toggled = |inside: Inside, medium: u32, outside: bool| {
            if outside { inside.with(medium) } else { inside.without(medium) }
        };
        let alone = (toggled(seen.leg.inside, medium, seen.met.spot.outside), 0.0, None);
        let gap = seen.met.spot.grain;
        // Along the ray it is longer by the slant, and no longer than the ray.
        let steep =
            seen.met.spot.k.x.dot(seen.met.spot.facet_normal).abs().max(0.05 * seen.met.spot.k.x.length());
        let reach = (gap / steep).min(0.5 * seen.met.hit.s);
        let ray = SightRay { event: seen.leg.ray.at(seen.met.hit.s - reach), ..seen.leg.ray };
        let mut crossed: Vec<(u32, bool)> = Vec::new();
        let mut contact = None;
        self.world.until(&ray, None, 2.0 * reach, self.crowd.as_ref(), |hit| {
            let Some(surface) = self.surfaces.get(hit.surface()) else { return false };
            let spot = hit.spot(&ray);
            let own = (hit.surface() == seen.met.hit.surface()).then_some(medium);
            if let Some(other) = own.or_else(|| surface.medium()) {
                crossed.push((other, spot.outside));
            } else if surface.is_solid(&Look { hit: &hit, spot: &spot, radius: 0.0 }) {
                contact = Some(hit);
            }
            contact.is_some()
        });
        if let Some(hit) = contact {
            // Its s counts from the start of the ray.
            return (alone.0, 0.0, Some(hit.later(seen.met.hit.s - reach)));
        }
        crossed.sort_unstable();
        crossed.dedup();
        if crossed.iter().all(|(other, _)| *other == medium) {
            return alone;
        }
        // Glass against water is no gap and no overlap.
        let after = crossed.iter().fold(seen.leg.inside, |inside, &(m, outside)| toggled(inside, m, outside));
        (after, 2.0 * gap, None)
    }

    fn face<const N: usize>(&self, inside: &Inside, normal: DVec3, seen: &Seen<'_, N>) -> Face<'_> {
        let leaving = if seen.leg.inside.is_empty() {
            seen.met.spot.k
        } else {
            seen.met.hit.rest.rest_from_lab.light(seen.leg.wave)
        };
        let facet_normal = seen.met.spot.facet_normal;
        let normal = if leaving.x.dot(normal) > 0.0 { normal } else { facet_normal };
        let (near, far) = (self.medium(&seen.leg.inside), self.medium(inside));
        Face { near, far, normal, facet_normal, leaving }
    }

    /// What light of one wavelength (the observer's) does at a face.
    fn at_face<const N: usize>(&self, face: &Face<'_>, seen: &Seen<'_, N>, lane: f64) -> AtFace {
        let on = |normal: DVec3| self.at_face_of(face, normal, seen, lane);
        let at = on(face.normal);
        let through = |at: &AtFace| {
            at.refracted.is_none_or(|light| {
                seen.met.hit.rest.rest_from_lab.light(light.step).x.dot(face.facet_normal) > 0.0
            })
        };
        // The interpolated normal would send the ray back out: the facet's own does not.
        if through(&at) { at } else { on(face.facet_normal) }
    }

    fn at_face_of<const N: usize>(
        &self,
        face: &Face<'_>,
        normal: DVec3,
        seen: &Seen<'_, N>,
        lane: f64,
    ) -> AtFace {
        let near = face.leaving.x.dot(normal).abs();
        let all = AtFace { reflectance: 1.0, refracted: None, part: 0.0 };
        let going = Going { leaving: face.leaving, normal, sense: 1.0 };
        let Some(far) = self.wave(face.far, going, seen, lane) else { return all };
        let q = far.at_face.x.dot(normal).abs();
        let squared = |k: FourVector<Rest>| k.x.length_squared() / (k.t * k.t);
        let (n1, n2) = (squared(face.leaving), squared(far.at_face));
        let s = (near - q) / (near + q);
        let p = (n2 * near - n1 * q) / (n2 * near + n1 * q);
        let reflectance = (0.5 * (s * s + p * p)).min(1.0);
        let index = face.near.map_or(1.0, |medium| {
            let (nm, _) = self.local(medium, seen.leg.wave, lane);
            medium.index.at(nm)
        });
        let ratio = index / far.index;
        AtFace { reflectance, refracted: Some(far.light), part: (1.0 - reflectance) * ratio * ratio }
    }

    /// The light in a medium beside a face; none if it cannot pass.
    fn wave<const N: usize>(
        &self,
        medium: Option<&Medium>,
        going: Going,
        seen: &Seen<'_, N>,
        lane: f64,
    ) -> Option<Wave> {
        let Going { leaving, normal, sense } = going;
        let along = leaving.x - normal * leaving.x.dot(normal);
        let omega = leaving.t;
        let rest = &seen.met.hit.rest.rest_from_lab;
        let Some(medium) = medium else {
            let squared = omega * omega - along.length_squared();
            let wave = FourVector::new(omega, along + normal * (sense * positive_root(squared)?));
            let k = rest.boost().inverse().light(wave);
            return Some(Wave { at_face: wave, light: Light4 { wave: k, step: k }, index: 1.0 });
        };
        if medium.rest_from_lab.velocity() == rest.boost().velocity() {
            let nm = lane / self.effects.shift(omega);
            let index = medium.index.at(nm);
            let squared = index * index * omega * omega - along.length_squared();
            let x = along + normal * (sense * positive_root(squared)?);
            let light = in_medium(medium, x / x.length(), omega, nm);
            return Some(Wave { at_face: FourVector::new(omega, x), light, index });
        }
        self.wave_in_moving(medium, going, seen, lane)
    }

    /// The same in a medium that moves relative to the face: a quadratic in the normal part of the wave vector.
    fn wave_in_moving<const N: usize>(
        &self,
        medium: &Medium,
        going: Going,
        seen: &Seen<'_, N>,
        lane: f64,
    ) -> Option<Wave> {
        let Going { leaving, normal, sense } = going;
        let (omega, along) = (leaving.t, leaving.x - normal * leaving.x.dot(normal));
        let rest = seen.met.hit.rest.rest_from_lab.boost();
        let moving: FourVector<Rest> =
            rest * (medium.rest_from_lab.inverse() * FourVector::new(1.0, DVec3::ZERO));
        let (a, b) = (omega * moving.t - along.dot(moving.x), normal.dot(moving.x));
        let mut nm = lane / self.effects.shift(a);
        let mut found = None;
        // The index depends on the frequency in the medium, and that on the solution.
        for _ in 0..8 {
            let index = medium.index.at(nm);
            let c = index * index - 1.0;
            let (p, q, r) = (c * b * b - 1.0, c * a * b, c * a * a + omega * omega - along.length_squared());
            let root = positive_root(q * q - p * r)?;
            // At the speed of light in the medium one of the two is at infinity.
            let pair = if p.abs() < 1e-12 { [r / (2.0 * q); 2] } else { [(q + root) / p, (q - root) / p] };
            let solutions = pair.map(|normal_part| {
                let at_face = FourVector::<Rest>::new(omega, along + normal * normal_part);
                let inside: FourVector<Rest> = medium.rest_from_lab * (rest.inverse() * at_face);
                let light = in_medium(medium, inside.x / inside.x.length(), inside.t, nm);
                (Wave { at_face, light, index }, inside.t)
            });
            let right = |(wave, frequency): &&(Wave, f64)| {
                *frequency > 0.0 && (rest * wave.light.step).x.dot(normal) * sense > 0.0
            };
            let (wave, frequency) = solutions.iter().find(right)?;
            found = Some(*wave);
            let next = lane / self.effects.shift(*frequency);
            if !medium.index.disperses() || (next - nm).abs() <= 1e-12 * nm {
                break;
            }
            nm = next;
        }
        found
    }

    /// A ray that is reflected within a medium, toward the face it came from.
    pub(super) fn reflected_inside<'s, const N: usize>(
        &self,
        normal: DVec3,
        seen: &'s Seen<'_, N>,
    ) -> Option<Leg<'s>> {
        let leaving = seen.met.hit.rest.rest_from_lab.light(seen.leg.wave);
        let medium = self.medium(&seen.leg.inside);
        let arriving =
            |normal| self.wave(medium, Going { leaving, normal, sense: -1.0 }, seen, seen.lanes[0]);
        let toward = |wave: &Wave| {
            seen.met.hit.rest.rest_from_lab.light(wave.light.step).x.dot(seen.met.spot.facet_normal) < 0.0
        };
        let wave = arriving(normal).filter(toward).or_else(|| arriving(seen.met.spot.facet_normal))?;
        let ray = SightRay { event: seen.met.departure.event, k: wave.light.step };
        Some(Leg { ray, from: Some(&seen.met.departure), wave: wave.light.wave, inside: seen.leg.inside })
    }
}

impl<const N: usize> Lanes<N> {
    fn at(even: bool, seen: &Seen<'_, N>, of: impl Fn(f64) -> AtFace) -> Self {
        Self { all: if even { [of(seen.lanes[0]); N] } else { seen.lanes.map(of) } }
    }

    fn each(&self, of: impl Fn(usize, &AtFace) -> f64) -> [f64; N] {
        std::array::from_fn(|i| of(i, &self.all[i]))
    }

    /// How far neighbours part, in pixels. On its way out the light parts about as much again, and by the index more.
    fn apart(&self, index: f64, seen: &Seen<'_, N>) -> [f64; N] {
        let rest = seen.met.hit.rest.rest_from_lab;
        let directions =
            self.all.map(|at| at.refracted.map(|light| (rest * light.step).x.normalize_or(DVec3::Z)));
        std::array::from_fn(|i| match (directions[i], directions.get(i + 1).copied().flatten()) {
            (Some(a), Some(b)) => pixels(2.0 * index * (a - b).length() * seen.omega, seen),
            _ => 0.0,
        })
    }
}

/// How many pixels wide an angle is for the observer; 0 where pixels have no width.
fn pixels<const N: usize>(angle: f64, seen: &Seen<'_, N>) -> f64 {
    let pixel = seen.path.cone.pixel;
    if pixel > 0.0 { angle / (2.0 * pixel) } else { 0.0 }
}

fn positive_root(squared: f64) -> Option<f64> {
    (squared >= 0.0).then(|| squared.sqrt())
}
