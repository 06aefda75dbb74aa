//! The light loop: what arrives along a sight ray.
//!
//! Rays go back in time from the camera. Radiance is gathered in the observer's terms: a surface that is asked
//! at the observer's wavelength λ answers at λ/ω, where ω is the light's frequency there in units of what
//! the observer sees, and what it answers is multiplied by ω⁻⁵ once.
//!
//! `mod.rs` follows a ray to what it meets; `path.rs` is what a ray is on its way, `packet.rs` follows neighbours together; `direct.rs` is the light of lamps, `passage.rs` what becomes of it on
//! the way to a surface; `mirror.rs` and `glass.rs` send rays on; `split.rs` parts the wavelengths where an index
//! depends on them.

mod caught;
mod direct;
mod first;
mod glass;
mod medium;
mod mirror;
mod packet;
mod passage;
mod path;
mod split;

pub use caught::SeenLine;
pub use first::First;

use crate::lamp::Lamp;
use crate::scene::Sky;
use crate::spacetime::{Event, FourVector, Rest, SightRay};
use crate::spectrum::{Line, Reflectance, Source, Wavelengths};
use crate::surface::{Glow, Medium, Scatter, Surface};
use crate::world::{Crowd, World};
use glam::DVec3;
use path::{Leg, MOST_VEILS, Met, Path, Seen, Step};

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
#[derive(Debug, Clone)]
pub struct Lit<'a> {
    /// The bodies.
    pub world: &'a World,
    /// Which of them a ray can meet, where they have many velocities: see [`Self::seen_from`].
    pub crowd: Option<Crowd>,
    /// An event that is in no medium: sight rays that begin there need not look for one.
    pub in_vacuum: Option<Event>,
    /// Surfaces, by the numbers that hits give.
    pub surfaces: &'a [Surface],
    /// What fills closed bodies of glass, by the numbers that their surfaces give.
    pub media: &'a [Medium],
    /// Lamps.
    pub lamps: &'a [Lamp],
    /// Radiances that fill rest frames alike from all sides, by the numbers that surfaces give.
    pub ambient: &'a [Source],
    /// What is beyond all bodies.
    pub surroundings: &'a [Sky],
    /// Whether any surface lets light through.
    pub see_through: bool,
    /// Whether any surface is asked what a sample sees of it.
    pub footprints: bool,
    /// Wavelengths of all spectral lines of the scene, nm, each in its source's rest frame.
    pub lines: &'a [f64],
    /// What is shown.
    pub effects: Effects,
    /// How many mirrors and faces of glass one after another are followed.
    pub depth: u32,
    /// Rays of which the observer would get less than this part are not followed. At a face of glass the other ray gets
    /// their part, so that no light is lost.
    pub faintest: f64,
}

/// Light as the observer sees it.
#[derive(Debug, Clone, Copy)]
pub struct Light<const N: usize> {
    /// Spectral radiance at the observer's wavelengths, W m⁻² sr⁻¹ nm⁻¹.
    pub radiance: [f64; N],
    /// XYZ (cd/m²) of what no wavelength samples: spectral lines, and colours that glass has parted.
    pub lines: DVec3,
}

/// How wide a sight ray is.
#[derive(Debug, Clone, Copy, Default)]
pub struct Cone {
    /// Half the angle between neighbouring samples, in the frame in which the ray's frequency is 1.
    pub sample: f64,
    /// The same between pixels: points of light are spread as wide.
    pub pixel: f64,
    /// Which of the pixel's samples it is, from 0 to 1: where colours are parted each takes other wavelengths.
    pub phase: f64,
}

/// What has been gathered for a sight ray.
struct Gathered<'g, const N: usize> {
    light: &'g mut Light<N>,
    // Where the spectrum is kept: what no wavelength samples, by the parts of the range of which they are the middles.
    bands: Option<&'g mut [f64; N]>,
    // Where lines are kept apart instead of becoming XYZ.
    caught: Option<Vec<split::Caught>>,
    // The wave vector with which the strongest part of the light has come out of glass, and how strong it is.
    exit: (f64, FourVector),
}

impl Lit<'_> {
    /// The same, made ready for rays to one event; for others it is right as well.
    #[must_use]
    pub fn seen_from(&self, event: Event) -> Self {
        let medium = |number: usize| self.surfaces.get(number).and_then(Surface::medium);
        let in_vacuum = (!self.media.is_empty() && !self.world.may_enclose(event, medium)).then_some(event);
        Self { crowd: self.world.crowd(event), in_vacuum, ..self.clone() }
    }

    /// The light that arrives along a sight ray.
    pub fn seen<const N: usize>(&self, ray: &SightRay, wavelengths: &Wavelengths<N>) -> Light<N> {
        self.seen_within(ray, Cone::default(), wavelengths)
    }

    /// The light that arrives along a sight ray of some width.
    pub fn seen_within<const N: usize>(
        &self,
        ray: &SightRay,
        cone: Cone,
        wavelengths: &Wavelengths<N>,
    ) -> Light<N> {
        self.gathered(ray, cone, wavelengths, None)
    }

    /// The same, with what none of the wavelengths samples added to the parts of the range of which they are the middles:
    /// spectral radiance, as the rest.
    pub fn seen_in_bands<const N: usize>(
        &self,
        ray: &SightRay,
        cone: Cone,
        wavelengths: &Wavelengths<N>,
        bands: &mut [f64; N],
    ) -> Light<N> {
        self.gathered(ray, cone, wavelengths, Some(bands))
    }

    /// Whether nothing need be asked to know that a sight ray begins in no medium.
    fn begins_in_vacuum(&self, ray: &SightRay) -> bool {
        self.media.is_empty() || self.in_vacuum == Some(ray.event)
    }

    fn gathered<const N: usize>(
        &self,
        ray: &SightRay,
        cone: Cone,
        wavelengths: &Wavelengths<N>,
        bands: Option<&mut [f64; N]>,
    ) -> Light<N> {
        let mut light = Light { radiance: [0.0; N], lines: DVec3::ZERO };
        let mut gathered = Gathered { light: &mut light, bands, caught: None, exit: (0.0, ray.k) };
        let path = Path::new(self.depth, cone);
        let leg = Leg::of(ray);
        if self.begins_in_vacuum(ray) {
            self.gather(&leg, &wavelengths.nm, &path, &mut gathered);
        } else {
            self.start_inside(&leg, &wavelengths.nm, &path, &mut gathered);
        }
        light
    }

    fn gather<const N: usize>(
        &self,
        leg: &Leg<'_>,
        lanes: &[f64; N],
        path: &Path<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        if gathered.caught.is_some() && leg.inside.is_empty() && path.throughput[0] > gathered.exit.0 {
            gathered.exit = (path.throughput[0], leg.wave);
        }
        match self.world.nearest_from(&leg.ray, leg.from, self.crowd.as_ref()) {
            Some(hit) => {
                self.arrive(&Met::new(hit, &leg.ray), leg, lanes, path, gathered);
            }
            None => self.add_surroundings(leg, lanes, path, gathered),
        }
    }

    /// Where a ray has come to.
    fn arrive<const N: usize>(
        &self,
        met: &Met<'_>,
        leg: &Leg<'_>,
        lanes: &[f64; N],
        path: &Path<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let Met { hit, spot, .. } = met;
        let Some(surface) = self.surfaces.get(hit.surface()) else { return };
        let in_vacuum = leg.inside.is_empty();
        let omega = if in_vacuum { spot.k.t } else { hit.rest.rest_from_lab.light(leg.wave).t };
        if omega <= 0.0 {
            return; // Light in a medium cannot overtake what is faster than it.
        }
        let shift = self.effects.shift(omega);
        let way = path.way + if in_vacuum { hit.s } else { self.slowed(leg, lanes[0], hit.s) };
        let seen = Seen {
            met,
            leg,
            omega,
            shift,
            lanes,
            nm: scaled(lanes, 1.0 / shift),
            path,
            radius: if self.footprints { path.cone.sample * way } else { 0.0 },
            way,
        };
        if in_vacuum {
            self.meet(surface, &seen, gathered);
        } else {
            self.meet_through_medium(surface, &seen, gathered);
        }
    }

    /// A surface, and what is seen through where it is not there.
    fn meet<const N: usize>(&self, surface: &Surface, seen: &Seen<'_, N>, gathered: &mut Gathered<'_, N>) {
        let Some(veil) = &surface.veil else { return self.shade(surface, seen, gathered) };
        let share = veil.share(&seen.look());
        let dim = |part: f64| move |_: f64| part;
        if share > 0.0 {
            let part = dim(share);
            let step = Step { before: seen.path.steps, part: &part, shift: 1.0 };
            self.shade(surface, &seen.through(&seen.path.dimmed(share, &step)), gathered);
        }
        if share < 1.0 && seen.path.veils > 0 {
            let part = dim(1.0 - share);
            let step = Step { before: seen.path.steps, part: &part, shift: 1.0 };
            let path =
                Path { veils: seen.path.veils - 1, way: seen.way, ..seen.path.dimmed(1.0 - share, &step) };
            if !path.is_faint(self.faintest) {
                let beyond = seen.met.spot.beyond(seen.met.hit.rest, 0.0);
                self.gather(&seen.straight_on(&beyond), seen.lanes, &path, gathered);
            }
        }
    }

    fn shade<const N: usize>(&self, surface: &Surface, seen: &Seen<'_, N>, gathered: &mut Gathered<'_, N>) {
        if let Some(glow) = &surface.glow {
            self.add_glow(glow, seen, gathered);
        }
        match &surface.scatter {
            Scatter::Absorb => {}
            Scatter::Diffuse(paint) => self.add_diffuse(paint, surface, seen, gathered),
            Scatter::Gloss(_) | Scatter::Metal(_) => self.add_gloss(surface, seen, gathered),
            Scatter::Mirror(paint) => self.follow_mirror(paint, surface, seen, gathered),
            Scatter::Glass(glass) => self.add_glass(glass, surface, seen, gathered),
            Scatter::Mixed(parts) => {
                for (course, part) in parts {
                    let share = course.at(seen.tau());
                    if share > 0.0 {
                        let dim = |_: f64| share;
                        let step = Step { before: seen.path.steps, part: &dim, shift: 1.0 };
                        self.meet(part, &seen.through(&seen.path.dimmed(share, &step)), gathered);
                    }
                }
            }
        }
    }

    /// Light that the surface emits itself.
    fn add_glow<const N: usize>(&self, glow: &Glow, seen: &Seen<'_, N>, gathered: &mut Gathered<'_, N>) {
        let look = seen.look();
        let white = Reflectance::Constant(1.0);
        let tint = match &glow.paint {
            Some(paint) => paint.at(&look),
            None => crate::surface::Tint::Of(std::borrow::Cow::Borrowed(&white)),
        };
        let filter = tint.at_each(&seen.nm);
        let mut radiance = glow.radiance.at_each(&seen.nm);
        for (value, filter) in radiance.iter_mut().zip(filter) {
            *value *= filter;
        }
        self.add(&radiance, seen, gathered);
        for line in glow.radiance.lines() {
            self.add_line(line, line.wavelength_nm, line.power * tint.at(line.wavelength_nm), seen, gathered);
        }
    }

    /// Light from beyond all bodies.
    fn add_surroundings<const N: usize>(
        &self,
        leg: &Leg<'_>,
        lanes: &[f64; N],
        path: &Path<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        for surroundings in self.surroundings {
            let (escaped, left) = self.escaped(leg, lanes[0]);
            let k: FourVector<Rest> = surroundings.rest_from_lab.light(escaped);
            let shift = self.effects.shift(k.t);
            let cone = (path.cone.sample / k.t, path.cone.pixel / k.t);
            let mut radiance =
                surroundings.sky.radiance(-k.x / k.x.length(), cone, &scaled(lanes, 1.0 / shift));
            let gain = self.effects.gain(k.t, -5) * left;
            for value in &mut radiance {
                *value *= gain;
            }
            add_to(&mut gathered.light.radiance, &radiance, &path.throughput);
            for line in surroundings.sky.lines() {
                gathered.line::<N>(line, line.wavelength_nm * shift, line.power * gain * shift, path);
            }
        }
    }

    /// Radiance that leaves the surface, as the observer gets it: `L(λ) = ω⁻⁵ L'(λ/ω)`.
    fn add<const N: usize>(&self, radiance: &[f64; N], seen: &Seen<'_, N>, gathered: &mut Gathered<'_, N>) {
        let gain = self.effects.gain(seen.omega, -5);
        for ((sum, value), part) in gathered.light.radiance.iter_mut().zip(radiance).zip(seen.path.throughput)
        {
            *sum += gain * value * part;
        }
    }

    /// A line that leaves the surface, as the observer gets it: at λω, with `ω⁻⁴` of its power.
    ///
    /// `of`: the source's own line. The wavelength (nm) and the power are those at the surface.
    fn add_line<const N: usize>(
        &self,
        of: &Line,
        wavelength_nm: f64,
        power: f64,
        seen: &Seen<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let power = power * self.effects.gain(seen.omega, -5) * seen.shift;
        gathered.line::<N>(of, wavelength_nm * seen.shift, power, seen.path);
    }
}

impl<const N: usize> Gathered<'_, N> {
    /// A line that the observer would see at a wavelength with a power, but for what lies between.
    fn line<const M: usize>(&mut self, of: &Line, seen_nm: f64, power: f64, path: &Path<'_, M>) {
        let power = power * path.steps.map_or(1.0, |step| step.throughput(seen_nm));
        match &mut self.caught {
            Some(caught) => caught.push(split::Caught::new(of, seen_nm, power)),
            None => self.point(seen_nm, power),
        }
    }

    /// Light of one wavelength.
    fn point(&mut self, seen_nm: f64, power: f64) {
        self.light.lines += Wavelengths::<N>::line_xyz(seen_nm, power);
        if let Some(bands) = &mut self.bands {
            add_to_band(bands, seen_nm, power);
        }
    }
}

/// Adds light of one wavelength to that of N equal parts of the range in which it lies, if it does.
fn add_to_band<const N: usize>(bands: &mut [f64; N], nm: f64, power: f64) {
    if let Some(band) = Wavelengths::<N>::band(nm) {
        bands[band] += power / Wavelengths::<N>::BAND_NM;
    }
}

fn add_to<const N: usize>(sum: &mut [f64; N], values: &[f64; N], parts: &[f64; N]) {
    for ((sum, value), part) in sum.iter_mut().zip(values).zip(parts) {
        *sum += value * part;
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
