//! Three numbers shifted instead of spectra. Geometry, Doppler factors and the colours at rest are exact.

use crate::shade::Eye;
use glam::{DMat3, DVec3};
use terrell::color::{RGB_FROM_XYZ, XYZ_FROM_RGB, matching, xyz_of};
use terrell::spectrum::Reflectance;

/// XYZ at rest of each channel of a paint in the bodies' light.
fn at_rest(eye: &Eye<'_>) -> DMat3 {
    let ambient = &eye.stage.scene.ambient[0];
    let primaries = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Reflectance::Rgb);
    let [r, g, b] = primaries.map(|primary| xyz_of(|nm| ambient.at(nm) * primary.at(nm)));
    DMat3::from_cols(r, g, b)
}

/// By hue: the wavelength that has the hue is shifted, and the hue of the shifted wavelength is shown.
pub struct ByHue {
    rgb_at_rest: DMat3,
    // The hue (in sixths of a circle) at each nm from 380 to 720.
    hues: Vec<f64>,
    /// By which power of the Doppler factor brightness grows.
    pub power: i32,
}

/// The shortest and longest wavelengths that have a hue, nm.
const HUES_NM: (f64, f64) = (380.0, 720.0);
/// From violet on there are purples, which no wavelength has.
const VIOLET: f64 = 4.5;

impl ByHue {
    pub fn new(eye: &Eye<'_>, power: i32) -> Self {
        let hue_of = |nm: f64| {
            let rgb = *RGB_FROM_XYZ * matching(nm);
            hue(rgb - DVec3::splat(rgb.min_element())).0.min(VIOLET)
        };
        // Hues fall with the wavelength; where rounding of the tables has them rise they are held.
        let mut hues: Vec<f64> = Vec::new();
        for nm in 380..=720 {
            let next = hue_of(f64::from(nm));
            let next = if next > 5.5 { 0.0 } else { next };
            hues.push(hues.last().map_or(VIOLET, |last: &f64| last.min(next)));
        }
        Self { rgb_at_rest: *RGB_FROM_XYZ * at_rest(eye), hues, power }
    }

    /// The hue of the wavelength `nm`; none where no eye sees it.
    fn hue_at(&self, nm: f64) -> Option<f64> {
        let place = nm - HUES_NM.0;
        let row = (place.max(0.0) as usize).min(self.hues.len() - 2);
        let hue = self.hues[row] + (self.hues[row + 1] - self.hues[row]) * (place - row as f64);
        (HUES_NM.0..=HUES_NM.1).contains(&nm).then_some(hue)
    }

    /// A hue moves as far as the nearest wavelength's does (for a colour of the spectrum: to the shifted wavelength's).
    fn shifted(&self, of: f64, doppler: f64) -> Option<f64> {
        // Half of the purples count as red, half as violet.
        let pure = if of > 0.5 * (VIOLET + 6.0) { 0.0 } else { of.min(VIOLET) };
        let at = self.hues.partition_point(|hue| *hue > pure);
        let nm = HUES_NM.0 + at as f64;
        Some(of + self.hue_at(nm / doppler)? - self.hue_at(nm).unwrap_or(0.0))
    }

    pub fn xyz(&self, rgb: [f64; 3], omega: f64) -> DVec3 {
        let seen = self.rgb_at_rest * DVec3::from(rgb);
        let grey = seen.min_element();
        let (from, strength) = hue(seen - DVec3::splat(grey));
        let doppler = 1.0 / omega;
        let pure = self.shifted(from, doppler).map_or(DVec3::ZERO, |to| rgb_of(to) * strength);
        *XYZ_FROM_RGB * (DVec3::splat(grey) + pure).max(DVec3::ZERO) * doppler.powi(self.power)
    }
}

/// Hue in sixths of a circle, and the largest channel, of a colour whose smallest channel is zero.
fn hue(rgb: DVec3) -> (f64, f64) {
    let most = rgb.max_element();
    if most <= 0.0 {
        return (0.0, 0.0);
    }
    let DVec3 { x: r, y: g, z: b } = rgb / most;
    let hue = if r == 1.0 {
        (g - b).rem_euclid(6.0)
    } else if g == 1.0 {
        2.0 + b - r
    } else {
        4.0 + r - g
    };
    (hue, most)
}

fn rgb_of(hue: f64) -> DVec3 {
    let channel = |at: f64| {
        let away = (hue - at).rem_euclid(6.0);
        (2.0 - away.min(6.0 - away)).clamp(0.0, 1.0)
    };
    DVec3::new(channel(0.0), channel(2.0), channel(4.0))
}

/// Gaussians in wavelength, with weights that give the colours at rest exactly; shifted and seen by the colour functions.
pub struct Gaussians {
    /// By the logarithm of the Doppler factor: from the paint's channels to XYZ.
    table: Vec<DMat3>,
}

const STEPS: usize = 2048;
/// Doppler factors from e^-REACH to e^REACH.
const REACH: f64 = 6.0;

/// A Gaussian: centre and standard deviation, nm.
type Bell = (f64, f64);

/// Three for what is seen.
pub const NARROW: [Bell; 3] = [(615.0, 8.0), (550.0, 4.0), (463.0, 5.0)];
/// As wide as they may be before one at rest has a negative weight for the colours that matter.
pub const WIDE: [Bell; 3] = [(605.0, 40.0), (545.0, 35.0), (455.0, 30.0)];
/// What stands for the ultraviolet and for the infrared, with the energy that is there, as well as can be.
pub const UNSEEN: [Bell; 4] = [(200.0, 40.0), (320.0, 40.0), (780.0, 60.0), (1000.0, 120.0)];

impl Gaussians {
    pub fn new(eye: &Eye<'_>, seen: [Bell; 3], unseen: &[Bell]) -> Self {
        let ambient = &eye.stage.scene.ambient[0];
        let units = seen.map(|bell| bell_xyz(bell, 1.0));
        let weights = DMat3::from_cols(units[0], units[1], units[2]).inverse() * at_rest(eye);
        // Beyond the visible a paint is the mean of its channels.
        let beyond = unseen
            .iter()
            .map(|bell| (*bell, ambient.at(bell.0) * bell.1 * (std::f64::consts::TAU).sqrt() / 3.0));
        let beyond: Vec<(Bell, f64)> = beyond.collect();
        let at = |step: usize| {
            let doppler = libm::exp((step as f64 / (STEPS - 1) as f64 * 2.0 - 1.0) * REACH);
            let moved = seen.map(|bell| bell_xyz(bell, doppler));
            let unseen: DVec3 = beyond.iter().map(|(bell, weight)| bell_xyz(*bell, doppler) * *weight).sum();
            let at_rest: DVec3 = beyond.iter().map(|(bell, weight)| bell_xyz(*bell, 1.0) * *weight).sum();
            // What reaches into the visible at rest is taken off there, so that colours at rest stay exact.
            let off = DMat3::from_cols(units[0], units[1], units[2]).inverse() * at_rest;
            let seen = DMat3::from_cols(moved[0], moved[1], moved[2]);
            seen * (weights - DMat3::from_cols(off, off, off)) + DMat3::from_cols(unseen, unseen, unseen)
        };
        Self { table: (0..STEPS).map(at).collect() }
    }

    pub fn xyz(&self, rgb: [f64; 3], omega: f64) -> DVec3 {
        let place = (0.5 - 0.5 * libm::log(omega) / REACH) * (STEPS - 1) as f64;
        let place = place.clamp(0.0, (STEPS - 2) as f64);
        let (step, part) = (place as usize, place.fract());
        let rgb = DVec3::from(rgb);
        (self.table[step] * rgb * (1.0 - part) + self.table[step + 1] * rgb * part).max(DVec3::ZERO)
    }
}

/// XYZ of a Gaussian of unit area at rest, seen with a Doppler factor: `L(λ) = D⁵ L'(λD)`.
pub fn bell_xyz((centre, sigma): Bell, doppler: f64) -> DVec3 {
    let (centre, sigma) = (centre / doppler, sigma / doppler);
    // The integral over ±5 standard deviations in as many steps as the colour functions need.
    let (lo, hi) = ((centre - 5.0 * sigma).max(360.0), (centre + 5.0 * sigma).min(830.0));
    if lo >= hi {
        return DVec3::ZERO;
    }
    let steps = (((hi - lo) / (0.2 * sigma).min(2.0)) as usize).clamp(16, 2000);
    let step = (hi - lo) / steps as f64;
    let value = |i: usize| {
        let nm = lo + (i as f64 + 0.5) * step;
        let z = (nm - centre) / sigma;
        matching(nm) * (libm::exp(-0.5 * z * z) / (sigma * std::f64::consts::TAU.sqrt()))
    };
    let area: DVec3 = (0..steps).map(value).sum::<DVec3>() * step * terrell::color::LUMENS_PER_WATT;
    area * doppler.powi(4)
}
