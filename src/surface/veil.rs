//! Where surfaces are not there, and how their normals are turned.

use super::Look;
use crate::texture::Texture;
use glam::DVec3;

/// Where a surface is not there: holes in leaves, and the back of what has none.
#[derive(Debug, Clone)]
pub struct Veil {
    /// By the coverage of its texture.
    pub coverage: Option<Coverage>,
    /// Seen from behind it is not there at all (glTF: not double-sided). It casts its shadow to both sides.
    pub one_sided: bool,
}

/// What part of a surface is there.
#[derive(Debug, Clone)]
pub struct Coverage {
    /// All over.
    pub factor: f32,
    /// Its alpha.
    pub texture: Option<Texture>,
    /// Whether the vertices' alpha counts.
    pub vertex_colors: bool,
    /// There or not, by whether coverage reaches this; none for what is half there.
    pub cutoff: Option<f32>,
}

impl Veil {
    /// The part of the surface that is there at a hit, 0 to 1.
    pub fn share(&self, look: &Look<'_>) -> f64 {
        if self.one_sided && !look.spot.outside {
            return 0.0;
        }
        self.coverage.as_ref().map_or(1.0, |coverage| coverage.at(look))
    }
}

impl Coverage {
    /// The part of the surface that is there, 0 to 1.
    pub fn at(&self, look: &Look<'_>) -> f64 {
        let mut alpha = self.factor;
        if let Some(texture) = &self.texture {
            alpha *= look.texel(texture)[3];
        }
        if self.vertex_colors
            && let Some(color) = look.hit.vertex_color()
        {
            alpha *= color[3];
        }
        match self.cutoff {
            Some(cutoff) => f64::from(u8::from(alpha >= cutoff)),
            None => f64::from(alpha.clamp(0.0, 1.0)),
        }
    }
}

/// A map of normals in the tangent space of the texture (glTF 2.0, §3.9.3).
#[derive(Debug, Clone)]
pub struct NormalMap {
    /// Linear: 0 to 1 means -1 to 1.
    pub texture: Texture,
    /// Of the first two coordinates.
    pub scale: f32,
}

impl NormalMap {
    /// The normal on the side from which the surface is seen; none where there are no texture coordinates.
    pub(super) fn normal(&self, look: &Look<'_>) -> Option<DVec3> {
        let side = if look.spot.outside { 1.0 } else { -1.0 };
        let outward = look.spot.normal * side;
        let (right, up) = look.hit.tangents(self.texture.uv_set, outward)?;
        let [x, y, z, _] = look.texel(&self.texture).map(|c| f64::from(c) * 2.0 - 1.0);
        let scale = f64::from(self.scale);
        let normal = right * (x * scale) + up * (y * scale) + outward * z;
        Some(normal.try_normalize()? * side)
    }
}
