//! Sources and surfaces.

use terrell::spectrum::{Index, Source, Spectrum};
use terrell::surface::{Glass, Glow, Paint, Scatter, Surface};

/// A black body as a radiance.
pub(crate) fn black_body(kelvin: f64) -> Source {
    Source::new(&Spectrum::BlackBody(kelvin), 1.0)
}

/// The same at every wavelength.
pub(crate) fn flat(value: f64) -> Source {
    Source::new(&Spectrum::Constant(1.0), value)
}

/// All at one wavelength.
pub(crate) fn line(centre_nm: f64, power: f64) -> Source {
    Source::new(&Spectrum::Line { centre_nm, width_nm: 0.0 }, power)
}

/// Shines by itself and throws nothing back.
pub(crate) fn glowing(radiance: Source) -> Surface {
    Surface::glowing(Glow { radiance, paint: None })
}

/// Throws a part of the light back to all sides.
pub(crate) fn diffuse(reflectance: f64) -> Surface {
    Surface::new(Scatter::Diffuse(Paint::grey(reflectance)))
}

/// Throws a part of the light back as a mirror.
pub(crate) fn mirror(reflectance: f64) -> Surface {
    Surface::new(Scatter::Mirror(Paint::grey(reflectance)))
}

/// Neither shines nor scatters.
pub(crate) fn black() -> Surface {
    Surface::new(Scatter::Absorb)
}

/// The surface of a body of clear glass; which glass is said by the body ([`super::Body::filled`]).
pub(crate) fn glass() -> Surface {
    let (index, color) = (Index::Constant(1.0), None);
    let glass =
        Glass { medium: 0, index, thin: false, color, amount: 1.0, amount_texture: None, roughness: 0.0 };
    Surface::new(Scatter::Glass(Box::new(glass)))
}
