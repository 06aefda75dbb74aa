//! Sources and surfaces.

use terrell::spectrum::{Reflectance, Source, Spectrum};
use terrell::surface::{Glow, Scatter, Surface};

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
    Surface { scatter: Scatter::Absorb, glow: Some(Glow { radiance, paint: None }) }
}

/// Throws a part of the light back to all sides.
pub(crate) fn diffuse(reflectance: f64) -> Surface {
    Surface { scatter: Scatter::Diffuse(Reflectance::Constant(reflectance)), glow: None }
}

/// Throws a part of the light back as a mirror.
pub(crate) fn mirror(reflectance: f64) -> Surface {
    Surface { scatter: Scatter::Mirror(Reflectance::Constant(reflectance)), glow: None }
}

/// Neither shines nor scatters.
pub(crate) fn black() -> Surface {
    Surface { scatter: Scatter::Absorb, glow: None }
}
