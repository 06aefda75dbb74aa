//! What colour a surface has by daylight, whatever light there is.

use super::{Look, Scatter, Surface, Tint};
use crate::color::RGB_FROM_XYZ;
use crate::spectrum::{D65, Wavelengths};
use glam::DVec3;
use std::sync::LazyLock;

/// Daylight at the wavelengths of a rule, with the luminance 1.
struct Daylit {
    rule: Wavelengths<16>,
    light: [f64; 16],
}

static DAYLIT: LazyLock<Daylit> = LazyLock::new(|| {
    let rule = Wavelengths::<16>::new();
    let light = rule.nm.map(|nm| D65.at(nm));
    let white = rule.xyz(&light).y;
    Daylit { light: light.map(|value| value / white), rule }
});

impl Daylit {
    /// Linear sRGB of what throws back these parts of it.
    fn color(&self, parts: [f64; 16]) -> DVec3 {
        let mut radiance = self.light;
        for (value, part) in radiance.iter_mut().zip(parts) {
            *value *= part;
        }
        *RGB_FROM_XYZ * self.rule.xyz(&radiance)
    }
}

impl Surface {
    /// Linear sRGB of the surface by D65, in its own rest frame, white being 1: what is diffuse by its colour, mirrors and
    /// metals by what they throw back of light that comes from ahead, glass by its tint. Nothing for what only shines.
    pub fn albedo(&self, look: &Look<'_>) -> DVec3 {
        let of = |tint: Tint<'_>| DAYLIT.color(tint.at_each(&DAYLIT.rule.nm));
        match &self.scatter {
            Scatter::Absorb => DVec3::ZERO,
            Scatter::Diffuse(paint) | Scatter::Mirror(paint) => of(paint.at(look)),
            Scatter::Gloss(gloss) => of(gloss.base.at(look)),
            Scatter::Metal(metal) => DAYLIT.color(DAYLIT.rule.nm.map(|nm| metal.of.reflectance(1.0, nm))),
            Scatter::Glass(glass) => glass.color.as_ref().map_or(DVec3::ONE, |color| of(color.at(look))),
            Scatter::Mixed(parts) => {
                let tau = look.spot.event.t - look.hit.placed.clock_zero;
                let share = |course: &crate::course::Course| course.at(tau);
                parts.iter().map(|(course, part)| part.albedo(look) * share(course)).sum()
            }
        }
    }
}
