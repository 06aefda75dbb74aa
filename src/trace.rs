//! The light loop: what arrives along a sight ray.
//!
//! Rays go back in time from the camera. Radiance is gathered in the observer's terms: a surface that is asked
//! at the observer's wavelength λ answers at λ/ω, where ω is the light's frequency there in units of what
//! the observer sees, and what it answers is multiplied by ω⁻⁵ once.

use crate::lamp::{Connection, Lamp};
use crate::spacetime::{Doppler, Event, SightRay};
use crate::spectrum::{Line, Reflectance, Source, Wavelengths};
use crate::surface::{Glow, Scatter, Surface, before_mirror};
use crate::world::{Hit, Spot, World};
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// What of relativity is shown: each factor as it is, or set to one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effects {
    /// Directions are those of the moving observer.
    pub aberration: bool,
    /// Wavelengths are shifted.
    pub doppler: bool,
    /// Radiance changes by ω⁻⁵, irradiance by D³.
    pub searchlight: bool,
}

impl Effects {
    /// Nature's.
    pub const ALL: Self = Self { aberration: true, doppler: true, searchlight: true };

    /// By what wavelengths are divided on the way to where the light has the frequency `omega`.
    #[inline]
    fn shift(self, omega: f64) -> f64 {
        if self.doppler { omega } else { 1.0 }
    }

    /// The integer power of a frequency ratio by which light is brighter.
    #[inline]
    fn gain(self, ratio: f64, power: i32) -> f64 {
        if self.searchlight { ratio.powi(power) } else { 1.0 }
    }
}

/// All that light needs to know.
#[derive(Debug)]
pub struct Lit<'a> {
    /// The bodies.
    pub world: &'a World,
    /// Surfaces, by the numbers that hits give.
    pub surfaces: &'a [Surface],
    /// Lamps.
    pub lamps: &'a [Lamp],
    /// Radiance that fills each body's rest frame alike from all sides.
    pub ambient: Option<&'a Source>,
    /// What is shown.
    pub effects: Effects,
    /// How many mirrors one after another are followed.
    pub depth: u32,
}

/// Light as the observer sees it.
#[derive(Debug, Clone, Copy)]
pub struct Light<const N: usize> {
    /// Spectral radiance at the observer's wavelengths, W m⁻² sr⁻¹ nm⁻¹.
    pub radiance: [f64; N],
    /// XYZ (cd/m²) of the spectral lines, which no wavelength samples.
    pub lines: DVec3,
}

/// What a picture can show of a sight ray's first hit beside its light.
#[derive(Debug, Clone, Copy)]
pub struct First {
    /// Frequency seen over frequency at the body.
    pub doppler: Doppler,
    /// The event at which the light left the body.
    pub emission: Event,
    /// The number of the body.
    pub body: u32,
}

/// The mirrors between the observer and where the light is now.
#[derive(Clone, Copy)]
struct Path<'p, const N: usize> {
    // What the observer still gets of the light, at its wavelengths.
    throughput: [f64; N],
    // The same, for lines: mirror by mirror.
    mirror: Option<&'p Bounce<'p>>,
    depth: u32,
}

struct Bounce<'p> {
    before: Option<&'p Self>,
    reflectance: &'p Reflectance,
    shift: f64,
}

impl Bounce<'_> {
    /// What the observer gets of light that it sees at one wavelength.
    fn throughput(&self, wavelength_nm: f64) -> f64 {
        let before = self.before.map_or(1.0, |bounce| bounce.throughput(wavelength_nm));
        before * self.reflectance.at(wavelength_nm / self.shift)
    }
}

/// A hit with what the observer's terms become there.
struct Seen<'h, const N: usize> {
    spot: Spot,
    departure: Event,
    // The light's frequency at the surface, in units of what the observer sees.
    omega: f64,
    // ω where wavelengths are concerned: 1 with the Doppler effect switched off.
    shift: f64,
    // The sampled wavelengths in the surface's rest frame, nm.
    nm: [f64; N],
    path: &'h Path<'h, N>,
}

impl Lit<'_> {
    /// The light that arrives along a sight ray.
    pub fn seen<const N: usize>(&self, ray: &SightRay, wavelengths: &Wavelengths<N>) -> Light<N> {
        let mut light = Light { radiance: [0.0; N], lines: DVec3::ZERO };
        let path = Path { throughput: [1.0; N], mirror: None, depth: self.depth };
        self.gather(ray, wavelengths, &path, &mut light);
        light
    }

    /// The first hit of a sight ray.
    pub fn first(&self, ray: &SightRay) -> Option<First> {
        let hit = self.world.nearest(ray)?;
        let omega = (hit.rest.rest_from_lab * ray.k).t;
        Some(First { doppler: Doppler::from_emitted(omega), emission: ray.at(hit.s), body: hit.placed.body })
    }

    fn gather<const N: usize>(
        &self,
        ray: &SightRay,
        wavelengths: &Wavelengths<N>,
        path: &Path<'_, N>,
        light: &mut Light<N>,
    ) {
        let Some(hit) = self.world.nearest(ray) else { return };
        let Some(surface) = self.surfaces.get(hit.surface()) else { return };
        let spot = hit.spot(ray);
        let omega = spot.k.t;
        let shift = self.effects.shift(omega);
        let nm = scaled(&wavelengths.nm, 1.0 / shift);
        let seen = Seen { departure: spot.departure(hit.rest), spot, omega, shift, nm, path };

        if let Some(glow) = &surface.glow {
            self.add_glow(glow, &hit, &seen, light);
        }
        match &surface.scatter {
            Scatter::Absorb => {}
            Scatter::Diffuse(reflectance) => self.add_scattered(reflectance, &hit, &seen, light),
            Scatter::Painted(paint) => self.add_scattered(&paint.at(&hit), &hit, &seen, light),
            Scatter::Mirror(reflectance) => self.follow_mirror(reflectance, &hit, &seen, wavelengths, light),
        }
    }

    /// Light that the surface emits itself.
    fn add_glow<const N: usize>(&self, glow: &Glow, hit: &Hit<'_>, seen: &Seen<'_, N>, light: &mut Light<N>) {
        let paint = glow.paint.as_ref().map_or(Reflectance::Constant(1.0), |paint| paint.at(hit));
        let filter = paint.at_each(&seen.nm);
        let mut radiance = glow.radiance.at_each(&seen.nm);
        for (value, filter) in radiance.iter_mut().zip(filter) {
            *value *= filter;
        }
        self.add(&radiance, seen, light);
        for line in glow.radiance.lines() {
            let power = line.power * paint.at(line.wavelength_nm);
            self.add_line(Line { power, ..*line }, seen, light);
        }
    }

    /// Light of the lamps that a diffuse surface throws back: `L = ρ/π E`.
    fn add_scattered<const N: usize>(
        &self,
        reflectance: &Reflectance,
        hit: &Hit<'_>,
        seen: &Seen<'_, N>,
        light: &mut Light<N>,
    ) {
        let mut arriving = self.ambient.map_or([0.0; N], |ambient| ambient.at_each(&seen.nm));
        for line in self.ambient.map_or(&[][..], Source::lines) {
            let power = line.power * reflectance.at(line.wavelength_nm);
            self.add_line(Line { power, ..*line }, seen, light);
        }
        for lamp in self.lamps {
            let Some(connection) = lamp.connect(seen.departure) else { continue };
            let k = hit.rest.rest_from_lab * connection.ray.k;
            // The cosine is the receiver's, in its own rest frame.
            let cosine = -k.x.dot(seen.spot.normal) / k.t;
            let above = -k.x.dot(seen.spot.facet_normal);
            if cosine <= 0.0 || above <= 0.0 || self.world.blocked(&connection.ray, connection.s_lamp) {
                continue;
            }
            self.add_lamp(lamp, &connection, (k.t, cosine), reflectance, seen, &mut arriving, light);
        }
        let thrown_back = reflectance.at_each(&seen.nm);
        for (value, part) in arriving.iter_mut().zip(thrown_back) {
            *value *= part;
        }
        self.add(&arriving, seen, light);
    }

    /// One lamp's light on the surface, over π: `E(λ) = D³ I(Dλ) cosθ / r²`, with D = surface's over lamp's frequency.
    #[expect(clippy::too_many_arguments, reason = "the two ends of the light and the two kinds of it")]
    fn add_lamp<const N: usize>(
        &self,
        lamp: &Lamp,
        connection: &Connection,
        (omega, cosine): (f64, f64),
        reflectance: &Reflectance,
        seen: &Seen<'_, N>,
        arriving: &mut [f64; N],
        light: &mut Light<N>,
    ) {
        let doppler = omega / connection.omega;
        let shift = self.effects.shift(doppler);
        let factor = self.effects.gain(doppler, 3) * connection.dilution * cosine * FRAC_1_PI;
        let at_lamp = lamp.source.at_each(&scaled(&seen.nm, shift));
        for (value, intensity) in arriving.iter_mut().zip(at_lamp) {
            *value += factor * intensity;
        }
        for line in lamp.source.lines() {
            // A line's power is integrated over the wavelength, which shrinks by the shift.
            let wavelength_nm = line.wavelength_nm / shift;
            let power = line.power * factor / shift * reflectance.at(wavelength_nm);
            self.add_line(Line { wavelength_nm, power }, seen, light);
        }
    }

    /// Light that reached a mirror: the same frequency in the mirror's rest frame, the normal part of its way reversed.
    fn follow_mirror<const N: usize>(
        &self,
        reflectance: &Reflectance,
        hit: &Hit<'_>,
        seen: &Seen<'_, N>,
        wavelengths: &Wavelengths<N>,
        light: &mut Light<N>,
    ) {
        if seen.path.depth == 0 {
            return;
        }
        let mut arriving = seen.spot.k;
        arriving.x = before_mirror(arriving.x, seen.spot.normal);
        if arriving.x.dot(seen.spot.facet_normal) >= 0.0 {
            // The interpolated normal would send the ray through the surface: the facet's own does not.
            arriving.x = before_mirror(seen.spot.k.x, seen.spot.facet_normal);
        }
        let k = hit.rest.rest_from_lab.boost().inverse() * arriving;
        let mut throughput = reflectance.at_each(&seen.nm);
        for (value, before) in throughput.iter_mut().zip(seen.path.throughput) {
            *value *= before;
        }
        let bounce = Bounce { before: seen.path.mirror, reflectance, shift: seen.shift };
        let path = Path { throughput, mirror: Some(&bounce), depth: seen.path.depth - 1 };
        self.gather(&SightRay { event: seen.departure, k }, wavelengths, &path, light);
    }

    /// Radiance that leaves the surface, as the observer gets it: `L(λ) = ω⁻⁵ L'(λ/ω)`.
    fn add<const N: usize>(&self, radiance: &[f64; N], seen: &Seen<'_, N>, light: &mut Light<N>) {
        let gain = self.effects.gain(seen.omega, -5);
        for ((sum, value), part) in light.radiance.iter_mut().zip(radiance).zip(seen.path.throughput) {
            *sum += gain * value * part;
        }
    }

    /// A line that leaves the surface, as the observer gets it: at λω, with `ω⁻⁴` of its power.
    fn add_line<const N: usize>(&self, line: Line, seen: &Seen<'_, N>, light: &mut Light<N>) {
        let wavelength_nm = line.wavelength_nm * seen.shift;
        let through = seen.path.mirror.map_or(1.0, |bounce| bounce.throughput(wavelength_nm));
        let power = line.power * through * self.effects.gain(seen.omega, -5) * seen.shift;
        light.lines += Wavelengths::<N>::line_xyz(wavelength_nm, power);
    }
}

/// Wavelengths in another rest frame. (A loop, since `map` on an array is not inlined.)
#[inline]
fn scaled<const N: usize>(nm: &[f64; N], factor: f64) -> [f64; N] {
    let mut scaled = *nm;
    for nm in &mut scaled {
        *nm *= factor;
    }
    scaled
}
