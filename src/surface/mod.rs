//! What surfaces do with light, each law in the surface's own rest frame.

mod albedo;
mod glass;
mod gloss;
mod microfacet;
mod paint;
mod veil;

pub use glass::{Absorption, Glass, Medium};
pub use gloss::{Clearcoat, Gloss, Polish};
pub(crate) use gloss::{Lobes, Reflection, Response};
pub use microfacet::{fade, highlight};
pub use paint::{Checker, Colors, Paint, Tint};
pub use veil::{Coverage, NormalMap, Veil};

use crate::course::Course;
use crate::spectrum::{Metal, Source};
use crate::texture::Texture;
use crate::world::{Hit, Spot};
use glam::{DVec2, DVec3};

/// A surface.
#[derive(Debug, Clone)]
pub struct Surface {
    /// What it does with the light that falls on it.
    pub scatter: Scatter,
    /// What it emits; nothing for most.
    pub glow: Option<Glow>,
    /// Where it is not there; none where it is there all over.
    pub veil: Option<Veil>,
    /// Turns its normals.
    pub relief: Option<NormalMap>,
    /// Number of the fill light of its body.
    pub ambient: u32,
}

/// What a surface does with the light that falls on it.
#[derive(Debug, Clone)]
pub enum Scatter {
    /// Nothing.
    Absorb,
    /// Scatters alike to all sides (Lambert).
    Diffuse(Paint),
    /// Throws back as a perfect mirror.
    Mirror(Paint),
    /// A bare metal, by its measured index.
    Metal(Polish<Metal>),
    /// What glTF calls metallic-roughness: diffuse below a dielectric surface, or a metal of a colour.
    Gloss(Box<Gloss>),
    /// Lets light through.
    Glass(Box<Glass>),
    /// Different surfaces at different times of the body's own clock, or several at once: each with its share.
    Mixed(Vec<(Course, Surface)>),
}

/// Emitted light, the same in all directions of the surface's rest frame.
#[derive(Debug, Clone)]
pub struct Glow {
    /// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹.
    pub radiance: Source,
    /// Multiplies it by place; none for one all over.
    pub paint: Option<Paint>,
}

impl Surface {
    /// Solid all over, smooth, and dark of itself.
    pub fn new(scatter: Scatter) -> Self {
        Self { scatter, glow: None, veil: None, relief: None, ambient: 0 }
    }

    /// That shines of itself and does nothing else.
    pub fn glowing(glow: Glow) -> Self {
        Self { glow: Some(glow), ..Self::new(Scatter::Absorb) }
    }

    /// Lit by a fill light, itself and all that it is made of.
    pub fn in_ambient(mut self, ambient: u32) -> Self {
        self.ambient = ambient;
        if let Scatter::Mixed(parts) = &mut self.scatter {
            for (_, part) in parts {
                *part = part.clone().in_ambient(ambient);
            }
        }
        self
    }

    /// The surfaces of which it is made at one time or another, itself included.
    pub fn all(&self) -> Vec<&Self> {
        match &self.scatter {
            Scatter::Mixed(parts) => {
                std::iter::once(self).chain(parts.iter().flat_map(|(_, part)| part.all())).collect()
            }
            _ => vec![self],
        }
    }

    /// Whether it is asked what a sample sees of it: whether any number of it comes from a texture or a checker.
    pub fn is_textured(&self) -> bool {
        let coverage = self.veil.as_ref().and_then(|veil| veil.coverage.as_ref());
        self.relief.is_some()
            || coverage.is_some_and(|coverage| coverage.texture.is_some())
            || self.glow.as_ref().and_then(|glow| glow.paint.as_ref()).is_some_and(Paint::varies)
            || self.scatter.is_textured()
    }

    /// Whether a ray goes on from it as from a mirror or through glass.
    pub fn sends_on(&self) -> bool {
        match &self.scatter {
            Scatter::Absorb | Scatter::Diffuse(_) => false,
            Scatter::Mirror(_) | Scatter::Glass(_) | Scatter::Metal(_) | Scatter::Gloss(_) => true,
            Scatter::Mixed(parts) => parts.iter().any(|(_, part)| part.sends_on()),
        }
    }

    /// Whether light may get through it.
    pub fn lets_through(&self) -> bool {
        let part = match &self.scatter {
            Scatter::Mixed(parts) => parts.iter().any(|(_, part)| part.lets_through()),
            scatter => matches!(scatter, Scatter::Glass(_)),
        };
        part || self.veil.as_ref().is_some_and(|veil| veil.coverage.is_some())
    }

    /// Whether nothing is seen through it at a place.
    pub fn is_solid(&self, look: &Look<'_>) -> bool {
        let glass = match &self.scatter {
            Scatter::Mixed(parts) => parts.iter().any(|(_, part)| part.lets_through()),
            scatter => matches!(scatter, Scatter::Glass(_)),
        };
        !glass && self.veil.as_ref().is_none_or(|veil| veil.share(look) >= 1.0)
    }

    /// The number of the medium that it encloses.
    pub fn medium(&self) -> Option<u32> {
        match &self.scatter {
            Scatter::Glass(glass) => (!glass.thin).then_some(glass.medium),
            Scatter::Mixed(parts) => parts.iter().find_map(|(_, part)| part.medium()),
            _ => None,
        }
    }
}

impl Scatter {
    fn is_textured(&self) -> bool {
        match self {
            Self::Absorb | Self::Metal(_) => false,
            Self::Diffuse(paint) | Self::Mirror(paint) => paint.varies(),
            Self::Gloss(gloss) => gloss.is_textured(),
            Self::Glass(glass) => {
                glass.amount_texture.is_some() || glass.color.as_ref().is_some_and(Paint::varies)
            }
            Self::Mixed(parts) => parts.iter().any(|(_, part)| part.is_textured()),
        }
    }
}

/// A hit as its surface is asked about it.
#[derive(Debug, Clone, Copy)]
pub struct Look<'h> {
    /// The hit.
    pub hit: &'h Hit<'h>,
    /// The place.
    pub spot: &'h Spot,
    /// Half the width there, at right angles to the ray, of what one sample sees; metres.
    pub radius: f64,
}

impl Look<'_> {
    /// The linear RGBA of a texture.
    pub fn texel(&self, texture: &Texture) -> [f32; 4] {
        let uv = self.hit.uv(texture.uv_set);
        match self.footprint(texture.uv_set) {
            Some(footprint) => texture.over(uv, &footprint),
            None => texture.rgba(uv),
        }
    }

    /// What one sample sees of the surface, in texture coordinates.
    pub fn footprint(&self, uv_set: u8) -> Option<crate::texture::Footprint> {
        let [u, v] = self.hit.uv_of(uv_set, self.axes()?)?;
        Some(crate::texture::Footprint { u, v })
    }

    /// The half axes on the surface of what one sample sees: across the sight, and along it (longer by the slant).
    fn axes(&self) -> Option<[DVec3; 2]> {
        if self.radius <= 0.0 {
            return None;
        }
        let (k, normal) = (self.spot.k.x, self.spot.facet_normal);
        let cosine = (k.dot(normal) / k.length()).abs().max(1e-6);
        let along = k - normal * k.dot(normal);
        let along = along.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
        Some([normal.cross(along) * self.radius, along * (self.radius / cosine)])
    }

    /// The normal with the relief of a map, on the side from which the surface is seen.
    pub fn normal(&self, relief: Option<&NormalMap>) -> DVec3 {
        relief.and_then(|relief| relief.normal(self)).unwrap_or(self.spot.normal)
    }

    /// Texture coordinates of the first set.
    pub fn uv(&self) -> DVec2 {
        self.hit.uv(0)
    }
}

/// The reverse of a mirror's law: the light that leaves along `leaving` arrived along this vector.
///
/// Both are the directions in which the light moves, of any length, which is kept.
pub fn before_mirror(leaving: DVec3, normal: DVec3) -> DVec3 {
    leaving - normal * (2.0 * leaving.dot(normal))
}
