//! Sources and surfaces.

use glam::{DAffine3, DVec3};
use terrell::course::Course;
use terrell::solid::{Shape, Solid};
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

/// Clear glass without thickness.
pub(crate) fn pane(index: Index) -> Surface {
    let glass = Glass {
        medium: 0,
        index,
        thin: true,
        color: None,
        amount: 1.0,
        amount_texture: None,
        roughness: 0.0,
    };
    Surface::new(Scatter::Glass(Box::new(glass)))
}

/// Different surfaces at different times.
pub(crate) fn mixed(parts: impl IntoIterator<Item = (Course, Surface)>) -> Surface {
    Surface::new(Scatter::Mixed(parts.into_iter().collect()))
}

/// On for the first `lit` of every period from `start` on.
pub(crate) fn blinking(period: f64, lit: f64, start: f64) -> Course {
    Course::Blinking { period, lit, start, inverted: false }
}

/// A ball about a place.
pub(crate) fn ball(radius: f64, centre: DVec3) -> Solid {
    let map = DAffine3::from_translation(centre) * DAffine3::from_scale(DVec3::splat(radius));
    Solid::from(Shape::Sphere).placed(map).unwrap()
}

/// A box from corner to corner.
pub(crate) fn cuboid(lo: DVec3, hi: DVec3) -> Solid {
    let map = DAffine3::from_translation(0.5 * (lo + hi)) * DAffine3::from_scale(hi - lo);
    Solid::from(Shape::Box).placed(map).unwrap()
}

/// All that is behind a place, as seen along a normal.
pub(crate) fn plane(place: DVec3, normal: DVec3) -> Solid {
    let y = normal / normal.length();
    let x = y.any_orthonormal_vector();
    let turn = glam::DMat3::from_cols(x, y, x.cross(y));
    Solid::from(Shape::Plane).placed(DAffine3::from_mat3_translation(turn, place)).unwrap()
}
