//! A picture all around: equirectangular, from minus to plus half a turn across and from pole to pole downwards.

use crate::color;
use crate::spectrum::{D65, Reflectance};
use crate::texture::{Filter, Footprint, Picture, Texture, Wrap};
use glam::{DAffine2, DQuat, DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, TAU};
use std::sync::Arc;

/// An equirectangular picture of what is infinitely far away.
///
/// Its centre lies at -z, what is right of that towards +x, its upper edge is +y. Linear RGB becomes daylight (D65)
/// through a filter of that colour ([`Reflectance::Rgb`], of any brightness). Alpha is passed over.
#[derive(Debug, Clone)]
pub struct Panorama {
    texture: Texture,
    /// Per unit of the curve of D65.
    factor: f64,
    /// From the surroundings' axes to the picture's.
    inverse: DQuat,
}

impl Panorama {
    /// A picture in which linear RGB (1, 1, 1) is a white of `luminance` cd/m², turned by `rotation`.
    pub fn new(picture: Arc<Picture>, luminance: f64, rotation: DQuat) -> Self {
        let texture = Texture {
            picture,
            wrap: [Wrap::Repeat, Wrap::Clamp],
            filter: Filter::Linear,
            uv_set: 0,
            transform: DAffine2::IDENTITY,
        };
        let factor = luminance / color::xyz_of(|nm| D65.at(nm)).y;
        Self { texture, factor, inverse: rotation.inverse() }
    }

    /// The spectral radiance from a direction: see [`super::Surroundings::radiance`].
    pub fn radiance<const N: usize>(&self, d: DVec3, sigma: f64, nm: &[f64; N]) -> [f64; N] {
        let filter = Reflectance::Rgb(self.rgb(d, sigma));
        let mut radiance = filter.at_each(nm);
        let daylight = &*D65;
        for (value, nm) in radiance.iter_mut().zip(nm) {
            *value *= self.factor * daylight.at(*nm);
        }
        radiance
    }

    /// Linear RGB around a direction. (The one place that knows how a picture is averaged over a cone.)
    fn rgb(&self, d: DVec3, sigma: f64) -> [f64; 3] {
        let d = self.inverse * d;
        // Near the poles a circle is stretched along the rows.
        let (down, across) = (sigma * FRAC_1_PI, sigma / (TAU * libm::hypot(d.x, d.z).max(1e-9)));
        let footprint = Footprint { u: DVec2::new(across.min(0.5), 0.0), v: DVec2::new(0.0, down.min(0.5)) };
        let [r, g, b, _] = self.texture.over(place(d), &footprint);
        [r, g, b].map(|value| f64::from(value).max(0.0))
    }
}

/// Where in the picture a direction lies: right and down from the upper left corner, both from 0 to 1.
fn place(d: DVec3) -> DVec2 {
    let across = libm::atan2(d.x, -d.z) / TAU + 0.5;
    let down = libm::atan2(libm::hypot(d.x, d.z), d.y) * FRAC_1_PI;
    DVec2::new(across, down)
}
