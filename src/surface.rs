//! What surfaces do with light, each law in the surface's own rest frame.

use crate::spectrum::{Reflectance, Source};
use crate::texture::Texture;
use crate::world::Hit;
use glam::DVec3;

/// A surface.
#[derive(Debug, Clone)]
pub struct Surface {
    /// What it does with the light that falls on it.
    pub scatter: Scatter,
    /// What it emits; nothing for most.
    pub glow: Option<Glow>,
}

/// What a surface does with the light that falls on it.
#[derive(Debug, Clone)]
pub enum Scatter {
    /// Nothing.
    Absorb,
    /// Scatters alike to all sides (Lambert), one reflectance all over.
    Diffuse(Reflectance),
    /// Scatters alike to all sides, with a reflectance from the file's colours and textures.
    Painted(Paint),
    /// Throws back as a perfect mirror.
    Mirror(Reflectance),
}

/// Emitted light, the same in all directions of the surface's rest frame.
#[derive(Debug, Clone)]
pub struct Glow {
    /// Spectral radiance, W m⁻² sr⁻¹ nm⁻¹.
    pub radiance: Source,
    /// Multiplies it by place; none for one all over.
    pub paint: Option<Paint>,
}

/// Colours from a model file: a factor, a texture and the vertices' colours, multiplied.
#[derive(Debug, Clone)]
pub struct Paint {
    /// Linear sRGB.
    pub color: [f32; 3],
    /// Its RGB.
    pub texture: Option<Texture>,
    /// Whether the vertices' colours count.
    pub vertex_colors: bool,
}

impl Paint {
    /// The reflectance at a hit.
    pub fn at(&self, hit: &Hit<'_>) -> Reflectance {
        let mut rgb = self.color.map(f64::from);
        let mut multiply = |by: [f32; 4]| {
            for (channel, factor) in rgb.iter_mut().zip(by) {
                *channel *= f64::from(factor);
            }
        };
        if let Some(texture) = &self.texture {
            multiply(texture.rgba(hit.uv(texture.uv_set)));
        }
        if self.vertex_colors
            && let Some(color) = hit.vertex_color()
        {
            multiply(color);
        }
        if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
            Reflectance::Constant(rgb[0])
        } else {
            Reflectance::Rgb(rgb)
        }
    }
}

/// The reverse of a mirror's law: the light that leaves along `leaving` arrived along this vector.
///
/// Both are the directions in which the light moves, of any length, which is kept.
pub fn before_mirror(leaving: DVec3, normal: DVec3) -> DVec3 {
    leaving - normal * (2.0 * leaving.dot(normal))
}
