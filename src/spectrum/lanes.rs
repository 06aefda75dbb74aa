//! The wavelengths at which the observer's light is sampled, and how samples become XYZ.

use super::{D65, Reflectance};
use crate::color::{self, LUMENS_PER_WATT};
use glam::{DMat3, DVec3};

/// Shortest and longest of the sampled range, nm.
const RANGE_NM: (f64, f64) = (400.0, 700.0);

/// `N` wavelengths in the observer's rest frame, with the weights that make XYZ of radiances sampled there.
///
/// The weights integrate a spectrum that is linear between the samples against the colour functions
/// exactly. They are then corrected, by the smallest change, so that D65 and the sRGB primaries under it come out
/// exactly for every `N`: at rest an RGB scene has its RGB colours.
#[derive(Debug, Clone)]
pub struct Wavelengths<const N: usize> {
    /// nm.
    pub nm: [f64; N],
    weights: [DVec3; N],
    // Those of every other wavelength alone, the rest zero.
    coarse: [DVec3; N],
}

impl<const N: usize> Default for Wavelengths<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Wavelengths<N> {
    /// How wide the parts of the range are of which the wavelengths are the middles, nm.
    pub const BAND_NM: f64 = (RANGE_NM.1 - RANGE_NM.0) / N as f64;

    /// The number of the part in which a wavelength (nm) lies; none outside the range.
    pub fn band(nm: f64) -> Option<usize> {
        let within = (RANGE_NM.0..RANGE_NM.1).contains(&nm);
        within.then(|| (((nm - RANGE_NM.0) / Self::BAND_NM) as usize).min(N - 1))
    }

    /// The rule with `N` (at least 2) wavelengths, the middles of `N` equal parts of 400 to 700 nm.
    pub fn new() -> Self {
        let step = (RANGE_NM.1 - RANGE_NM.0) / N as f64;
        let nm: [f64; N] = std::array::from_fn(|i| RANGE_NM.0 + step * (i as f64 + 0.5));
        let mut weights = hats(&nm, 1);
        let mut coarse = hats(&nm, 2);
        for axis in 0..3 {
            correct(&mut weights, &nm, axis, 1);
            if N >= 8 {
                correct(&mut coarse, &nm, axis, 2);
            }
        }
        Self { nm, weights, coarse }
    }

    /// XYZ (cd/m²) of a spectral radiance (W m⁻² sr⁻¹ nm⁻¹) sampled at these wavelengths.
    pub fn xyz(&self, radiance: &[f64; N]) -> DVec3 {
        self.weights.iter().zip(radiance).map(|(weight, value)| *weight * *value).sum()
    }

    /// The same from every other wavelength: how far it is from [`Self::xyz`] tells how much their number matters.
    pub fn coarse_xyz(&self, radiance: &[f64; N]) -> DVec3 {
        self.coarse.iter().zip(radiance).map(|(weight, value)| *weight * *value).sum()
    }

    /// XYZ of a line that the observer sees at `wavelength_nm` with the radiance `power`.
    pub fn line_xyz(wavelength_nm: f64, power: f64) -> DVec3 {
        color::matching(wavelength_nm) * (power * LUMENS_PER_WATT)
    }
}

/// The weights of a spectrum that is linear between every `every`th of the wavelengths, and held beyond; zero for the others.
fn hats<const N: usize>(nm: &[f64; N], every: usize) -> [DVec3; N] {
    let last = (N - 1) / every * every;
    let step = nm[every.min(N - 1)] - nm[0];
    let hat = |i: usize, at: f64| (1.0 - ((at.clamp(nm[0], nm[last]) - nm[i]) / step).abs()).max(0.0);
    std::array::from_fn(|i| if i % every == 0 { color::xyz_of(|at| hat(i, at)) } else { DVec3::ZERO })
}

/// Makes one row of the weights of every `every`th wavelength exact for D65 on each primary: the least change, counted in
/// parts of the weight.
fn correct<const N: usize>(weights: &mut [DVec3; N], nm: &[f64; N], axis: usize, every: usize) {
    let primaries = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Reflectance::Rgb);
    let light = |j: usize, at: f64| D65.at(at) * primaries[j].at(at);
    let floor = 1e-4 * weights.iter().map(|w| w[axis]).fold(0.0, f64::max);
    let row = |at: f64| DVec3::new(light(0, at), light(1, at), light(2, at));
    let mut missing: DVec3 = [0, 1, 2].map(|j| color::xyz_of(|at| light(j, at))[axis]).into();
    let mut normal = DMat3::ZERO;
    for (at, weight) in nm.iter().zip(weights.iter()).step_by(every) {
        let row = row(*at);
        missing -= row * weight[axis];
        let scaled = row * (weight[axis] + floor);
        normal += DMat3::from_cols(scaled * row.x, scaled * row.y, scaled * row.z);
    }
    let amounts = normal.inverse() * missing;
    for (at, weight) in nm.iter().zip(weights.iter_mut()).step_by(every) {
        weight[axis] += (weight[axis] + floor) * row(*at).dot(amounts);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn white_error<const N: usize>(rgb: [f64; 3]) -> f64 {
        let rule = Wavelengths::<N>::new();
        let filter = Reflectance::Rgb(rgb);
        let radiance = rule.nm.map(|nm| D65.at(nm) * filter.at(nm));
        let white = color::xyz_of(|nm| D65.at(nm));
        let error =
            |xyz: DVec3| (*color::RGB_FROM_XYZ * (xyz / white.y) - DVec3::from(rgb)).abs().max_element();
        error(rule.xyz(&radiance)).max(if N < 8 { 0.0 } else { error(rule.coarse_xyz(&radiance)) })
    }

    #[test]
    fn colours_under_daylight_come_back_exactly_for_any_number_of_wavelengths() {
        for rgb in [[1.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.2, 0.7, 0.1], [0.0, 0.1, 0.9]] {
            assert!(white_error::<3>(rgb) < 1e-9);
            assert!(white_error::<8>(rgb) < 1e-9);
            assert!(white_error::<16>(rgb) < 1e-9);
            assert!(white_error::<64>(rgb) < 1e-9);
        }
    }
}
