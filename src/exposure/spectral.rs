//! A picture with its spectrum.

use super::{BRIGHTEST, Exposing, Sampling, by_pixel};
use crate::film::Negative;
use crate::observer::View;
use crate::scene::Scene;
use crate::spectrum::Wavelengths;
use crate::trace::Lit;

/// The spectral radiance of a picture in equal parts of 400 to 700 nm of what the observer sees.
#[derive(Debug, Clone, PartialEq)]
pub struct Bands {
    /// The middle of each part, nm.
    pub nm: Vec<f64>,
    /// Of each part the radiance at its middle, and its share of what is narrower, W m⁻² sr⁻¹ nm⁻¹, row by row.
    pub radiance: Vec<Vec<f32>>,
}

/// The middles of so many parts, nm: the wavelengths that are traced.
pub fn middles(wavelengths: u32) -> Vec<f64> {
    match wavelengths {
        0..=8 => Wavelengths::<8>::new().nm.to_vec(),
        9..=16 => Wavelengths::<16>::new().nm.to_vec(),
        17..=32 => Wavelengths::<32>::new().nm.to_vec(),
        _ => Wavelengths::<64>::new().nm.to_vec(),
    }
}

/// Exposes a picture as [`super::expose`] does, and keeps its spectrum: as many parts as there are wavelengths, at least 8.
/// Spectral lines, and colours that glass has parted, are in the parts where they are seen; what is seen outside of 400 to
/// 700 nm is in none.
pub fn expose_spectral(scene: &Scene, view: &View, sampling: &Sampling) -> (Negative, Bands) {
    let lit = &scene.lit().seen_from(view.tetrad.event);
    match sampling.wavelengths {
        0..=8 => with::<8>(lit, view, sampling),
        9..=16 => with::<16>(lit, view, sampling),
        17..=32 => with::<32>(lit, view, sampling),
        _ => with::<64>(lit, view, sampling),
    }
}

fn with<const N: usize>(lit: &Lit<'_>, view: &View, sampling: &Sampling) -> (Negative, Bands) {
    let exposing = Exposing::<N>::new(view, sampling);
    let pixels = by_pixel(sampling.width, sampling.height, |column, row| {
        let mut apart = [0.0; N];
        let (xyz, radiance) = exposing.pixel((column, row), |ray, cone| {
            lit.seen_in_bands(ray, cone, &exposing.wavelengths, &mut apart)
        });
        let sum = |i: usize| (radiance[i] + apart[i] * exposing.share).min(BRIGHTEST) as f32;
        (xyz, std::array::from_fn::<f32, N, _>(sum))
    });
    let radiance = (0..N).map(|band| pixels.iter().map(|(_, radiance)| radiance[band]).collect()).collect();
    let xyz = pixels.into_iter().map(|(xyz, _)| xyz).collect();
    let negative = Negative { width: sampling.width, height: sampling.height, xyz };
    (negative, Bands { nm: exposing.wavelengths.nm.to_vec(), radiance })
}
