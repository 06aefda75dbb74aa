//! Fresnel's equations: what part of the light a smooth surface throws back.
//!
//! Indices are those of the body over that of where the light comes from. Reflectances are the same for the light that
//! goes the other way along the same path. Source: Born and Wolf, Principles of Optics, 7th ed., §1.5 and §14.2.

/// Reflectances for the two polarisations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polarised {
    /// Electric field across the plane of incidence.
    pub s: f64,
    /// Electric field within the plane of incidence.
    pub p: f64,
}

impl Polarised {
    /// For light without polarisation.
    #[inline]
    pub fn mean(self) -> f64 {
        0.5 * (self.s + self.p)
    }
}

/// A cosine with which no formula divides zero by zero: any sign, and not quite grazing.
#[inline]
fn cosine(cos_i: f64) -> f64 {
    cos_i.abs().clamp(1e-12, 1.0)
}

/// Between transparent bodies, by polarisation: `cos_i` of the angle between light and normal, `ratio` the index
/// beyond over the index before the surface. 1 for total reflection.
///
/// With `g² = ratio² - sin²i`: `R_s = ((cos i - g)/(cos i + g))²`, `R_p = ((ratio² cos i - g)/(ratio² cos i + g))²`.
#[inline]
pub fn dielectric_polarised(cos_i: f64, ratio: f64) -> Polarised {
    let cos = cosine(cos_i);
    // So written that equal indices give exactly nothing.
    let g = ((ratio - 1.0) * (ratio + 1.0) + cos * cos).max(0.0).sqrt();
    let s = (cos - g) / (cos + g);
    let steep = ratio * ratio * cos;
    let p = (steep - g) / (steep + g);
    Polarised { s: s * s, p: p * p }
}

/// Between transparent bodies, light without polarisation: see [`dielectric_polarised`].
#[inline]
pub fn dielectric(cos_i: f64, ratio: f64) -> f64 {
    dielectric_polarised(cos_i, ratio).mean()
}

/// [`dielectric`] at many wavelengths, each with its own ratio, at one angle.
#[inline]
pub fn dielectric_each<const N: usize>(cos_i: f64, ratios: &[f64; N]) -> [f64; N] {
    let mut parts = *ratios;
    for part in &mut parts {
        *part = dielectric(cos_i, *part);
    }
    parts
}

/// At a metal, by polarisation: `n + ik` is the metal's complex index over the index of where the light comes from.
///
/// With `a² + b² = |ñ² - sin²i|` and `a = Re √(ñ² - sin²i)`. Exact, and for k = 0 the same as [`dielectric_polarised`].
#[inline]
pub fn conductor_polarised(cos_i: f64, n: f64, k: f64) -> Polarised {
    let cos = cosine(cos_i);
    let (cos2, sin2) = (cos * cos, (1.0 - cos) * (1.0 + cos));
    // Real and imaginary part of ñ² - sin²i.
    let real = (n - 1.0) * (n + 1.0) - k * k + cos2;
    let imaginary = 2.0 * n * k;
    let squares = (real * real + imaginary * imaginary).sqrt();
    let a = (0.5 * (squares + real)).max(0.0).sqrt();
    let s = (squares + cos2 - 2.0 * a * cos).max(0.0) / (squares + cos2 + 2.0 * a * cos);
    let both = cos2 * squares + sin2 * sin2;
    let mixed = 2.0 * a * cos * sin2;
    Polarised { s, p: s * (both - mixed).max(0.0) / (both + mixed) }
}

/// At a metal, light without polarisation: see [`conductor_polarised`].
#[inline]
pub fn conductor(cos_i: f64, n: f64, k: f64) -> f64 {
    conductor_polarised(cos_i, n, k).mean()
}

/// [`conductor`] at many wavelengths, each with its own n and k, at one angle.
#[inline]
pub fn conductor_each<const N: usize>(cos_i: f64, n: &[f64; N], k: &[f64; N]) -> [f64; N] {
    let mut parts = *n;
    for (part, k) in parts.iter_mut().zip(k) {
        *part = conductor(cos_i, *part, *k);
    }
    parts
}
