//! The light of lamps on a surface.

use super::{Gathered, Lit, Met, Seen, scaled};
use crate::lamp::{Connection, Lamp};
use crate::spacetime::{FourVector, Rest};
use crate::spectrum::Source;
use crate::surface::{Lobes, Paint, Response, Surface};
use crate::world::Spot;

/// Light on its way from lamps to the observer, before the surface's own spectra.
struct Arriving<'l, const N: usize> {
    lobes: &'l Lobes<'l>,
    base: [f64; N],
    // What is reflected, and what of it takes the colour of the tint.
    reflected: Option<Reflected<N>>,
}

/// The way of a lamp's light to a surface.
#[derive(Clone, Copy)]
pub(super) struct Toward {
    pub(super) connection: Connection,
    // Its wave vector there.
    pub(super) k: FourVector<Rest>,
    // Whether anything stands in the way, if that has been asked.
    pub(super) blocked: Option<bool>,
}

impl Toward {
    #[inline]
    pub(super) fn new(lamp: &Lamp, met: &Met<'_>) -> Option<Self> {
        let connection = lamp.connect(&met.departure)?;
        Some(Self { k: met.hit.rest.rest_from_lab.light(connection.ray.k), connection, blocked: None })
    }

    /// Whether the lamp shines on the side of the facet that is seen.
    #[inline]
    pub(super) fn is_above(&self, spot: &Spot) -> bool {
        -self.k.x.dot(spot.facet_normal) > 0.0
    }
}

struct Reflected<const N: usize> {
    tint: [f64; N],
    white: [f64; N],
}

impl Lit<'_> {
    /// Light of the lamps, and of the fill light, that a surface throws back.
    pub(super) fn add_diffuse<const N: usize>(
        &self,
        paint: &Paint,
        surface: &Surface,
        seen: &Seen<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let lobes = Lobes::diffuse(paint, surface, &seen.look());
        let fill = Response { base: 1.0, ..Response::default() };
        self.add_lobes(&lobes, fill, surface, seen, gathered);
    }

    /// The same for surfaces whose response is known; `fill`: what it makes of the same radiance from all sides.
    pub(super) fn add_lobes<const N: usize>(
        &self,
        lobes: &Lobes<'_>,
        fill: Response,
        surface: &Surface,
        seen: &Seen<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let mut arriving = Arriving { lobes, base: [0.0; N], reflected: None };
        if let Some(ambient) = self.ambient.get(surface.ambient as usize) {
            self.add_fill(ambient, &fill, seen, &mut arriving, gathered);
        }
        for (number, lamp) in self.lamps.iter().enumerate() {
            let own;
            let toward = match seen.met.toward.get(number) {
                Some(known) => known,
                None => {
                    own = Toward::new(lamp, seen.met);
                    &own
                }
            };
            let Some(toward) = toward else { continue };
            let Toward { connection, k, .. } = toward;
            // The cosine is the receiver's, in its own rest frame.
            let cosine = -k.x.dot(lobes.normal) / k.t;
            if cosine <= 0.0 || !toward.is_above(&seen.met.spot) {
                continue;
            }
            let Some(passage) = self.passage(toward, &seen.met.departure) else { continue };
            let response = lobes.response(|| (-k.x / k.t, seen.to_eye()));
            let light = FromLamp { lamp, connection, omega: k.t, cosine, passage: &passage };
            self.add_lamp(&light, &response, seen, &mut arriving, gathered);
        }
        let mut radiance = match &lobes.base {
            Some(base) => base.at_each(&seen.nm),
            None => [0.0; N],
        };
        for (value, light) in radiance.iter_mut().zip(&arriving.base) {
            *value *= light;
        }
        if let Some(reflected) = &arriving.reflected {
            let tint = lobes.shine.as_ref().and_then(|shine| shine.tint.as_ref());
            let tint = tint.map_or([0.0; N], |tint| tint.at_each(&seen.nm));
            for (i, value) in radiance.iter_mut().enumerate() {
                *value += reflected.tint[i] * tint[i] + reflected.white[i];
            }
        }
        self.add(&radiance, seen, gathered);
    }

    fn add_fill<const N: usize>(
        &self,
        ambient: &Source,
        fill: &Response,
        seen: &Seen<'_, N>,
        arriving: &mut Arriving<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        // In a medium the light that fills it is n² times as bright.
        let dense = self.medium(&seen.leg.inside).map_or(1.0, |medium| {
            let (nm, _) = self.local(medium, seen.leg.wave, seen.lanes[0]);
            medium.index.at(nm) * medium.index.at(nm)
        });
        arriving.add(ambient, &seen.nm, dense, fill, &seen.nm);
        for line in ambient.lines() {
            let nm = line.wavelength_nm;
            self.add_line(line, nm, dense * line.power * arriving.lobes.at(fill, nm), seen, gathered);
        }
    }

    /// One lamp's light on the surface: `E(λ) = D³ I(Dλ) cosθ / r²`, with D = surface's over lamp's frequency.
    fn add_lamp<const N: usize>(
        &self,
        light: &FromLamp<'_>,
        response: &Response,
        seen: &Seen<'_, N>,
        arriving: &mut Arriving<'_, N>,
        gathered: &mut Gathered<'_, N>,
    ) {
        let doppler = light.omega / light.connection.omega;
        let shift = self.effects.shift(doppler);
        let factor =
            self.effects.gain(doppler, 3) * light.connection.dilution * light.cosine * light.passage.clear;
        let at_lamp = scaled(&seen.nm, shift);
        for (course, source) in &light.lamp.light {
            let factor = factor * course.at(light.connection.emitted);
            if factor == 0.0 {
                continue;
            }
            match &light.passage.colored {
                None => arriving.add(source, &at_lamp, factor, response, &seen.nm),
                Some(colored) => {
                    let mut intensity = source.at_each(&at_lamp);
                    self.filter(colored, light.connection, light.omega, &seen.nm, &mut intensity);
                    arriving.add_spectrum(&intensity, factor, response, &seen.nm);
                }
            }
            for line in source.lines() {
                // A line's power is integrated over the wavelength, which shrinks by the shift.
                let wavelength_nm = line.wavelength_nm / shift;
                let mut passes = [1.0];
                if let Some(colored) = &light.passage.colored {
                    self.filter(colored, light.connection, light.omega, &[wavelength_nm], &mut passes);
                }
                let power =
                    line.power * factor / shift * passes[0] * arriving.lobes.at(response, wavelength_nm);
                self.add_line(line, wavelength_nm, power, seen, gathered);
            }
        }
    }
}

/// A lamp's light where it arrives.
struct FromLamp<'l> {
    lamp: &'l Lamp,
    connection: &'l Connection,
    // Its frequency at the surface, in the units of the connection.
    omega: f64,
    cosine: f64,
    passage: &'l super::passage::Passage<'l>,
}

impl<const N: usize> Arriving<'_, N> {
    /// A source's light, seen at `at_source` (nm), which is `nm` at the surface.
    fn add(
        &mut self,
        source: &Source,
        at_source: &[f64; N],
        factor: f64,
        response: &Response,
        nm: &[f64; N],
    ) {
        if response.shines() {
            self.add_spectrum(&source.at_each(at_source), factor, response, nm);
        } else {
            source.add_each(&mut self.base, at_source, factor * response.base);
        }
    }

    fn add_spectrum(&mut self, light: &[f64; N], factor: f64, response: &Response, nm: &[f64; N]) {
        let base = factor * response.base;
        for (sum, value) in self.base.iter_mut().zip(light) {
            *sum += base * value;
        }
        if response.shines() {
            self.reflect(light, factor, response, nm);
        }
    }

    fn reflect(&mut self, light: &[f64; N], factor: f64, response: &Response, nm: &[f64; N]) {
        let sums = self.reflected.get_or_insert(Reflected { tint: [0.0; N], white: [0.0; N] });
        let metal = self.lobes.metal();
        let (tint, white) = (factor * response.tint, factor * response.white);
        for (i, value) in light.iter().enumerate() {
            sums.tint[i] += tint * value;
            sums.white[i] +=
                white * value * metal.map_or(1.0, |metal| metal.reflectance(response.cosine, nm[i]));
        }
    }
}
