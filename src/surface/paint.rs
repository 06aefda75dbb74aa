//! What part of the light a surface throws back at each place.

use super::Look;
use crate::spectrum::{Beyond, Reflectance, Tone};
use crate::texture::{Footprint, Texture};
use glam::DVec2;
use std::borrow::Cow;

/// A reflectance by place.
#[derive(Debug, Clone)]
pub enum Paint {
    /// The same all over.
    Even(Reflectance),
    /// Colours from a picture or a model file.
    Colors(Colors),
    /// Squares.
    Checker(Box<Checker>),
}

/// Colours from a model file: a factor, a texture and the vertices' colours, multiplied.
#[derive(Debug, Clone)]
pub struct Colors {
    /// Linear sRGB.
    pub color: [f32; 3],
    /// Its RGB.
    pub texture: Option<Texture>,
    /// Whether the vertices' colours count.
    pub vertex_colors: bool,
    /// What they mean in the ultraviolet and in the infrared.
    pub beyond: Beyond,
}

/// Squares of two kinds in the first texture coordinates.
#[derive(Debug, Clone)]
pub struct Checker {
    /// The side of a square, in texture coordinates.
    pub size: f64,
    /// The square from the origin on, and all that touch it at their corners.
    pub even: Reflectance,
    /// The others.
    pub odd: Reflectance,
}

/// The reflectance at one place.
#[derive(Debug, Clone)]
pub enum Tint<'s> {
    /// One reflectance.
    Of(Cow<'s, Reflectance>),
    /// The first, and a share of the second instead of it.
    Between(&'s Reflectance, &'s Reflectance, f64),
}

impl Tint<'_> {
    /// At one wavelength in the surface's rest frame, nm.
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        match self {
            Self::Of(of) => of.at(wavelength_nm),
            Self::Between(a, b, share) => a.at(wavelength_nm) * (1.0 - share) + b.at(wavelength_nm) * share,
        }
    }

    /// At many wavelengths at once.
    #[inline]
    pub fn at_each<const N: usize>(&self, wavelengths_nm: &[f64; N]) -> [f64; N] {
        match self {
            Self::Of(of) => of.at_each(wavelengths_nm),
            Self::Between(a, b, share) => {
                let (mut mixed, b) = (a.at_each(wavelengths_nm), b.at_each(wavelengths_nm));
                for (a, b) in mixed.iter_mut().zip(b) {
                    *a += (b - *a) * share;
                }
                mixed
            }
        }
    }
}

impl Paint {
    /// One reflectance at all wavelengths and places.
    pub fn grey(value: f64) -> Self {
        Self::Even(Reflectance::Constant(value))
    }

    /// How far it is from grey, at most.
    pub fn tone(&self) -> Tone {
        match self {
            Self::Even(reflectance) => reflectance.tone(),
            Self::Colors(colors) => {
                let [r, g, b] = colors.color;
                let even = colors.texture.is_none() && !colors.vertex_colors;
                if even && r == g && g == b { Tone::Grey } else { Tone::Color }
            }
            Self::Checker(checker) => checker.even.tone().max(checker.odd.tone()),
        }
    }

    /// Whether it is another at another place.
    pub fn varies(&self) -> bool {
        match self {
            Self::Even(_) => false,
            Self::Colors(colors) => colors.texture.is_some(),
            Self::Checker(_) => true,
        }
    }

    /// The reflectance at a hit.
    pub fn at(&self, look: &Look<'_>) -> Tint<'_> {
        match self {
            Self::Even(reflectance) => Tint::Of(Cow::Borrowed(reflectance)),
            Self::Colors(colors) => Tint::Of(Cow::Owned(colors.at(look))),
            Self::Checker(checker) => checker.at(look),
        }
    }
}

impl Colors {
    fn at(&self, look: &Look<'_>) -> Reflectance {
        let rgb = self.rgb(look);
        if self.beyond == Beyond::MEAN && rgb[0] == rgb[1] && rgb[1] == rgb[2] {
            Reflectance::Constant(rgb[0])
        } else if self.beyond == Beyond::MEAN {
            Reflectance::Rgb(rgb)
        } else {
            Reflectance::Extended { rgb, beyond: self.beyond }
        }
    }

    /// Linear sRGB at a hit.
    pub fn rgb(&self, look: &Look<'_>) -> [f64; 3] {
        let mut rgb = self.color.map(f64::from);
        let mut multiply = |by: [f32; 4]| {
            for (channel, factor) in rgb.iter_mut().zip(by) {
                *channel *= f64::from(factor);
            }
        };
        if let Some(texture) = &self.texture {
            multiply(look.texel(texture));
        }
        if self.vertex_colors
            && let Some(color) = look.hit.vertex_color()
        {
            multiply(color);
        }
        rgb
    }
}

impl Checker {
    fn at(&self, look: &Look<'_>) -> Tint<'_> {
        let (at, half) = (look.uv() / self.size, half_widths(look.footprint(0)) / self.size);
        let share = odd_share(at, half);
        if share <= 0.0 {
            Tint::Of(Cow::Borrowed(&self.even))
        } else if share >= 1.0 {
            Tint::Of(Cow::Borrowed(&self.odd))
        } else {
            Tint::Between(&self.even, &self.odd, share)
        }
    }
}

/// Half the sides of the rectangle over which the squares are averaged: the box around the footprint.
fn half_widths(footprint: Option<Footprint>) -> DVec2 {
    footprint.map_or(DVec2::ZERO, |of| DVec2::new(of.u.x.hypot(of.v.x), of.u.y.hypot(of.v.y)))
}

/// What part of a rectangle lies in odd squares of side 1.
fn odd_share(at: DVec2, half: DVec2) -> f64 {
    // The mean over the rectangle of the product of two square waves, +1 and -1: ½(1 - the product of both means).
    0.5 * (1.0 - wave_mean(at.x, half.x) * wave_mean(at.y, half.y))
}

/// The mean of the square wave that is +1 on [0, 1) and -1 on [1, 2).
fn wave_mean(at: f64, half: f64) -> f64 {
    if !(at.is_finite() && half <= 1e9) {
        return 0.0;
    }
    // Its integral is a triangle wave.
    let integral = |x: f64| 1.0 - (x - 2.0 * (0.5 * x).floor() - 1.0).abs();
    let sign = if at.rem_euclid(2.0) < 1.0 { 1.0 } else { -1.0 };
    let to_edge = (at - at.floor()).min(at.floor() + 1.0 - at);
    if half <= to_edge { sign } else { (integral(at + half) - integral(at - half)) / (2.0 * half) }
}
