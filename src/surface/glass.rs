//! What lets light through: panes without thickness, and the insides of closed bodies.

use super::{Look, Paint};
use crate::spacetime::{Boost, Lab, Rest};
use crate::spectrum::{Index, Reflectance};
use crate::texture::Texture;

/// A smooth surface that lets light through.
#[derive(Debug, Clone)]
pub struct Glass {
    /// What is on its inner side: its number among the scene's media.
    pub medium: u32,
    /// The index there.
    pub index: Index,
    /// A pane without thickness: what it lets through goes straight on.
    pub thin: bool,
    /// Colours what is let through: its square root at each of the two surfaces of a body, all of it at a pane.
    pub color: Option<Paint>,
    /// How much of it lets light through; the rest is diffuse, of the same colour.
    pub amount: f64,
    /// Multiplies the amount, in red.
    pub amount_texture: Option<Texture>,
    /// Of the highlights of lamps. Rays stay sharp.
    pub roughness: f64,
}

/// What fills a closed body.
#[derive(Debug, Clone)]
pub struct Medium {
    /// By wavelength in its own rest frame.
    pub index: Index,
    /// What it takes of the light.
    pub absorption: Option<Absorption>,
    /// Into its rest frame.
    pub rest_from_lab: Boost<Rest, Lab>,
    /// The volume of the body's box, m³: where two media overlap, the smaller body is there.
    pub volume: f64,
}

/// Beer and Lambert's law.
#[derive(Debug, Clone)]
pub struct Absorption {
    /// What is left after the distance.
    pub left: Reflectance,
    /// Metres.
    pub distance: f64,
}

impl Absorption {
    /// What is left of light of one wavelength (rest frame, nm) after a way (rest frame, m): `left^(way/distance)`.
    pub fn after(&self, way: f64, wavelength_nm: f64) -> f64 {
        let left = self.left.at(wavelength_nm);
        if left > 0.0 { libm::exp(libm::log(left) * (way / self.distance)) } else { f64::from(way <= 0.0) }
    }
}

impl Glass {
    /// What part of the surface lets light through at a place.
    pub fn amount_at(&self, look: &Look<'_>) -> f64 {
        match &self.amount_texture {
            Some(texture) => self.amount * f64::from(look.texel(texture)[0]),
            None => self.amount,
        }
    }

    /// The index of refraction.
    pub fn medium_index(&self) -> &Index {
        &self.index
    }
}
