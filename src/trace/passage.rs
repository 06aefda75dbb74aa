//! What becomes of a lamp's light on its way to a surface.
//!
//! Light goes straight on through glass, less what its faces reflect and its inside absorbs: a lamp is a point, and what
//! a lens makes of it (caustics) cannot be found by going back from the surface.

use super::Lit;
use super::direct::Toward;
use crate::fresnel;
use crate::lamp::Connection;
use crate::surface::{Glass, Look, Scatter, Surface, Tint};
use crate::world::{Departure, Hit};

/// What is left of a lamp's light.
#[derive(Debug)]
pub(super) struct Passage<'s> {
    /// At all wavelengths alike.
    pub(super) clear: f64,
    /// What takes its part of each wavelength.
    pub(super) colored: Option<Box<Colored<'s>>>,
}

/// What colours a lamp's light on its way.
#[derive(Debug, Default)]
pub(super) struct Colored<'s> {
    faces: Vec<Face<'s>>,
    insides: Vec<Stretch>,
}

/// A face of glass on the way, which lets `rest + part √tint(λ)` through; a pane has both its faces in one.
#[derive(Debug)]
struct Face<'s> {
    tint: Tint<'s>,
    thin: bool,
    // Frequency there, in the units of the connection.
    omega: f64,
    rest: f64,
    part: f64,
}

/// A crossing of the boundary of a medium.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    medium: u32,
    s: f64,
    // Going back in time the way leads inside.
    entering: bool,
}

impl<'s> Passage<'s> {
    const CLEAR: Self = Self { clear: 1.0, colored: None };

    /// Takes from the light what a surface takes; whether nothing is left.
    fn take(&mut self, surface: &'s Surface, look: &Look<'_>) -> bool {
        let coverage = surface.veil.as_ref().and_then(|veil| veil.coverage.as_ref());
        let share = coverage.map_or(1.0, |coverage| coverage.at(look));
        match &surface.scatter {
            _ if share <= 0.0 => {}
            Scatter::Glass(glass) => self.take_glass(glass, share, look),
            Scatter::Mixed(parts) => {
                let tau = look.spot.event.t - look.hit.placed.clock_zero;
                let present = || parts.iter().map(|(course, part)| (course.at(tau), part));
                if let Some((_, only)) = present().find(|(share, _)| *share >= 1.0) {
                    return self.take(only, look);
                }
                let solid = present().filter(|(_, part)| !part.lets_through());
                self.clear *= 1.0 - share * solid.map(|(share, _)| share).sum::<f64>().min(1.0);
            }
            _ => self.clear *= 1.0 - share,
        }
        self.clear <= 0.0
    }

    fn take_glass(&mut self, glass: &'s Glass, share: f64, look: &Look<'_>) {
        let k = look.spot.k;
        let cosine = look.spot.facet_normal.dot(k.x) / k.x.length();
        let through = 1.0 - fresnel::dielectric(cosine, glass.index.at(589.0));
        let part = share * glass.amount_at(look) * through;
        match &glass.color {
            Some(color) => {
                let colored = self.colored.get_or_insert_default();
                let (tint, thin) = (color.at(look), glass.thin);
                colored.faces.push(Face { tint, thin, omega: k.t, rest: 1.0 - share, part });
            }
            None => self.clear *= 1.0 - share + part,
        }
        if !glass.thin {
            let entering = look.spot.outside;
            let colored = self.colored.get_or_insert_default();
            colored.insides.push(Stretch { medium: glass.medium, s: look.hit.s, entering });
        }
    }
}

impl Colored<'_> {
    /// The sum of s that the light spends in each medium on its way from a lamp at `s_lamp`.
    fn ways(&self, s_lamp: f64) -> Vec<(u32, f64)> {
        let mut media: Vec<u32> = self.insides.iter().map(|stretch| stretch.medium).collect();
        media.sort_unstable();
        media.dedup();
        let way = |medium: u32| {
            let of = self.insides.iter().filter(|stretch| stretch.medium == medium);
            let (sum, open) = of.fold((0.0, 0_i32), |(sum, open), stretch| {
                if stretch.entering { (sum - stretch.s, open + 1) } else { (sum + stretch.s, open - 1) }
            });
            // Entered and not left: the lamp is inside.
            let sum = if open > 0 { sum + s_lamp } else { sum };
            (medium, if sum.is_finite() { sum.max(0.0) } else { 0.0 })
        };
        media.into_iter().map(way).collect()
    }
}

impl Lit<'_> {
    /// What is left of a lamp's light where it arrives; none if nothing is.
    #[inline]
    pub(super) fn passage(&self, toward: &Toward, from: &Departure<'_>) -> Option<Passage<'_>> {
        let connection = &toward.connection;
        match toward.blocked {
            Some(false) => return Some(Passage::CLEAR),
            Some(true) if !self.see_through => return None,
            _ if self.see_through => return self.passage_through(connection, from),
            _ => {}
        }
        (!self.world.blocked(&connection.ray, Some(from), connection.s_lamp, self.crowd.as_ref()))
            .then_some(Passage::CLEAR)
    }

    /// The same where surfaces may let light through.
    fn passage_through(&self, connection: &Connection, from: &Departure<'_>) -> Option<Passage<'_>> {
        let mut passage = Passage::CLEAR;
        let ray = &connection.ray;
        // An edge belongs to two triangles, and counts once.
        let mut met: Vec<(usize, f64)> = Vec::new();
        let blocked =
            self.world.until(ray, Some(from), connection.s_lamp, self.crowd.as_ref(), |hit: Hit<'_>| {
                let Some(surface) = self.surfaces.get(hit.surface()) else { return true };
                if !surface.lets_through() {
                    return true;
                }
                let same = |(number, s): &(usize, f64)| {
                    *number == hit.surface() && (s - hit.s).abs() <= 1e-12 * s.abs()
                };
                if met.iter().any(same) {
                    return false;
                }
                met.push((hit.surface(), hit.s));
                let spot = hit.spot(ray);
                passage.take(surface, &Look { hit: &hit, spot: &spot, radius: 0.0 })
            });
        (!blocked).then_some(passage)
    }

    /// Takes from light what is coloured on its way. `omega`: its frequency, in the units of the connection, where its
    /// wavelengths are `nm`.
    pub(super) fn filter<const N: usize>(
        &self,
        colored: &Colored<'_>,
        connection: &Connection,
        omega: f64,
        nm: &[f64; N],
        light: &mut [f64; N],
    ) {
        for face in &colored.faces {
            let shift = self.effects.shift(omega / face.omega);
            for (value, nm) in light.iter_mut().zip(nm) {
                let tint = face.tint.at(nm * shift).max(0.0);
                *value *= face.rest + face.part * if face.thin { tint } else { tint.sqrt() };
            }
        }
        if colored.insides.is_empty() {
            return;
        }
        for (medium, way) in colored.ways(connection.s_lamp) {
            let Some(medium) = self.media.get(medium as usize) else { continue };
            let Some(absorption) = &medium.absorption else { continue };
            let k = medium.rest_from_lab.light(connection.ray.k);
            let shift = self.effects.shift(omega / k.t);
            for (value, nm) in light.iter_mut().zip(nm) {
                *value *= absorption.after(way * k.t, nm * shift);
            }
        }
    }
}
